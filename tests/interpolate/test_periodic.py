"""Interpolation on periodic sites, against plain triangulations of copies that are spelled out."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from delone import PeriodicDelaunay
from delone.errors import ConflictingValuesError, InputError, LimitError, NonFiniteError
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor, Nearest, grid

METHODS = [
    (Linear, {}),
    (Nearest, {}),
    (NaturalNeighbor, {}),
    (NaturalNeighbor, {"kind": "laplace"}),
    (NaturalNeighbor, {"kind": "sibson1"}),
    (NaturalNeighbor, {"kind": "farin", "gradients": "plane"}),
    (CloughTocher, {"gradients": "local"}),
]
PERIODS = [(360.0, None), (None, 40.0), (360.0, 40.0)]


def sites(n: int, seed: int = 0) -> tuple[Any, Any]:
    rng = np.random.default_rng(seed)
    return rng.random((n, 2)) * [359.0, 39.0] - [180.0, 7.0], rng.random(n)


def spelled_out(points: Any, values: Any, periods: Any, reach: int = 6) -> tuple[Any, Any]:
    steps = [np.arange(-reach, reach + 1) * length if length else [0.0] for length in periods]
    moves = np.array([(x, y) for x in steps[0] for y in steps[1]])
    return (points + moves[:, None]).reshape(-1, 2), np.tile(values, len(moves))


def queries(periods: Any, seed: int = 1) -> Any:
    """Points of the window, and the same points moved by whole periods."""
    rng = np.random.default_rng(seed)
    lengths = [length or 0.0 for length in periods]
    inner = rng.random((300, 2)) * [359.0, 39.0] - [180.0, 7.0]
    return inner, inner + rng.integers(-3, 4, (300, 2)) * lengths


@pytest.mark.parametrize("periods", PERIODS)
@pytest.mark.parametrize(("kind", "options"), METHODS)
@pytest.mark.parametrize("n", [4, 90])
def test_what_copies_that_are_spelled_out_say(
    kind: Any, options: dict[str, Any], periods: Any, n: int
) -> None:
    points, values = sites(n)
    given, same = queries(periods)
    made = kind(PeriodicDelaunay(points, periods=periods), values, extrapolate="nearest", **options)
    reach = 6 if n == 90 or None not in periods else 40
    plain = kind(*spelled_out(points, values, periods, reach), extrapolate="nearest", **options)
    np.testing.assert_allclose(made(given), plain(given), rtol=0, atol=1e-9)
    np.testing.assert_allclose(made(same), made(given), rtol=0, atol=1e-9)
    slopes = made.gradient(given), plain.gradient(given)
    np.testing.assert_allclose(*slopes, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("periods", PERIODS)
def test_gradients_that_are_estimated_together(periods: Any) -> None:
    for n in (5, 90):
        points, values = sites(n)
        given, same = queries(periods)
        options: Any = {"extrapolate": "nearest", "tol": 1e-13}
        made = CloughTocher(PeriodicDelaunay(points, periods), values, **options)
        copies = spelled_out(points, values, periods, 30 if n == 5 else 8)
        plain = CloughTocher(*copies, **options)
        np.testing.assert_allclose(made(given), plain(given), rtol=0, atol=1e-6)
        np.testing.assert_allclose(made(same), made(given), rtol=0, atol=1e-9)
        second = made.hessian(given), made.hessian(same)
        np.testing.assert_allclose(*second, rtol=1e-6, atol=1e-9)


def test_natural_neighbors_many_periods_away() -> None:
    """In a gap that is many periods high a query takes area from sites far to its side."""
    rng = np.random.default_rng(5)
    low = rng.random((6, 2)) * [0.9, 0.1]
    points = np.concatenate((low, low + np.array([0.05, 9.0])))
    values = rng.random(12)
    made = NaturalNeighbor(PeriodicDelaunay(points, periods=(1, None)), values)
    plain = NaturalNeighbor(*spelled_out(points, values, (1, None), 60))
    middle = np.column_stack((np.linspace(0.1, 0.9, 50), np.full(50, 4.6)))
    np.testing.assert_allclose(made(middle), plain(middle), rtol=0, atol=1e-12)
    away = spelled_out(points, values, (1, None), 2)
    assert np.abs(NaturalNeighbor(*away)(middle) - plain(middle)).max() > 1e-4


def test_both_sides_of_the_antimeridian() -> None:
    points = [(179.9, 0.0), (-179.9, 0.0), (179.8, 1.0), (-179.8, 1.0), (0.0, 0.5)]
    height = Linear(PeriodicDelaunay(points, periods=(360, None)), [1.0, 3.0, 1.0, 3.0, 50.0])
    np.testing.assert_allclose(height([(180, 0), (-180, 0), (540, 0)]), 2.0, atol=1e-9)
    assert height((180, 1)) == pytest.approx(2.0)


def test_beyond_the_strip() -> None:
    points, values = sites(60)
    made = {
        how: Linear(PeriodicDelaunay(points, periods=(360, None)), values, extrapolate=how)
        for how in ("nan", "nearest", "linear", "raise")
    }
    copies = spelled_out(points, values, (360, None))
    out = np.array([(33.0, 50.0), (-300.0, -20.0)])
    assert np.isnan(made["nan"](out)).all()
    for how in ("nearest", "linear"):
        found = Linear(*copies, extrapolate=how)(out)
        np.testing.assert_allclose(made[how](out), found, rtol=0, atol=1e-9)
    with pytest.raises(InputError, match="outside the hull: rows 0, 1"):
        made["raise"](out)
    # There is no left and no right outside.
    assert np.isfinite(made["raise"]([(1e6, 10.0), (-1e6, 10.0)])).all()
    odd = made["nearest"]([(np.nan, 0), (np.inf, 0), (0, np.nan)])
    assert np.isnan(odd).all()


def test_weights_name_the_sites() -> None:
    points, values = sites(40)
    periodic = PeriodicDelaunay(points, periods=(360, 40))
    _, where = queries((360, 40))
    for kind, options in METHODS:
        made = kind(periodic, values, **options)
        table = made.weights_at(where)
        assert table.indices.min() >= 0 and table.indices.max() < 40
        np.testing.assert_allclose(table @ values, made(where), rtol=0, atol=1e-12)
        np.testing.assert_allclose(made(where, values=2 * values), 2 * made(where), atol=1e-12)


def test_of_equally_near_copies_that_of_the_smaller_row_counts() -> None:
    points = [(0.0, 0.0), (3.0, 0.0), (1.5, 1.0)]
    for order in ([0, 1, 2], [1, 0, 2]):
        there = np.array(points)[order]
        near = Nearest(PeriodicDelaunay(there, periods=(4, None)), [10.0, 20.0, 30.0])
        assert near((3.5, 0)) == 10


def test_policies_for_values() -> None:
    points, values = sites(50)
    twice, more = np.concatenate((points, points[:3])), np.append(values, [5.0, 6.0, 7.0])
    given, _ = queries((360, None))
    mesh = PeriodicDelaunay(twice, periods=(360, None))
    with pytest.raises(ConflictingValuesError) as raised:
        Linear(mesh, more)
    assert raised.value.rows.tolist() == [[50, 0], [51, 1], [52, 2]]
    means = np.append((values[:3] + more[50:]) / 2, values[3:])
    plain = Linear(PeriodicDelaunay(points, periods=(360, None)), means)
    made = Linear(mesh, more, duplicates="mean")
    np.testing.assert_allclose(made(given), plain(given), atol=1e-12)
    np.testing.assert_allclose(made.weights_at(given) @ more, plain(given), atol=1e-12)
    gaps = np.where(np.arange(50) % 7 == 0, np.nan, values)
    periodic = PeriodicDelaunay(points, periods=(360, None))
    with pytest.raises(NonFiniteError):
        Linear(periodic, gaps)
    kept = np.isfinite(gaps)
    rest = NaturalNeighbor(PeriodicDelaunay(points[kept], periods=(360, None)), values[kept])
    dropped = NaturalNeighbor(periodic, gaps, nan="drop")
    np.testing.assert_array_equal(dropped(given), rest(given))
    np.testing.assert_array_equal(dropped(given, values=gaps * 1), rest(given))
    later = NaturalNeighbor(periodic, values, nan="drop")
    np.testing.assert_array_equal(later(given, values=gaps), rest(given))
    copy = pickle.loads(pickle.dumps(dropped))
    np.testing.assert_array_equal(copy(given), rest(given))


def test_copies_that_rounding_makes_one_keep_their_values() -> None:
    points = np.array([(0.0, 0.0), (1e-17, 0.0), (100.0, 5.0), (200.0, -5.0)])
    made = Linear(PeriodicDelaunay(points, periods=(360, None)), [1.0, 2.0, 3.0, 4.0])
    assert made(points).tolist() == [1.0, 2.0, 3.0, 4.0]


def test_rasters_are_a_period_wide() -> None:
    points, values = sites(50)
    found = grid(
        PeriodicDelaunay(points, periods=(360, None)), values, shape=(36, 4), method="sibson"
    )
    low = points[:, 0].min()
    assert found.extent[:2] == pytest.approx((low, low + 360))
    assert found.extent[2:] == pytest.approx((points[:, 1].min(), points[:, 1].max()))
    wide = grid(
        PeriodicDelaunay(points, periods=(360, None)),
        values,
        shape=(72, 4),
        method="sibson",
        bounds=(0, 0, 720, 20),
    )
    np.testing.assert_allclose(wide.values[:, :36], wide.values[:, 36:], atol=1e-9)


def test_what_is_refused() -> None:
    points, values = sites(20)
    heavy = PeriodicDelaunay(points, (360, None), weights=np.ones(20))
    with pytest.raises(InputError, match="without weights"):
        Linear(heavy, values)
    far = np.array([(0.0, 0.0), (1e307, 1.0), (5e307, 3.0)])
    with pytest.raises(LimitError, match="range of doubles"):
        Linear(PeriodicDelaunay(far, (1.5e308, None)), [1, 2, 3])
