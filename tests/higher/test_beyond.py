"""Values at the nearest points of the hull, from 4-D on, and without a mesh in 2-D and 3-D."""

from __future__ import annotations

import itertools
import pickle

import numpy as np
import pytest

import delone
from delone import Delaunay
from delone.interpolate import Linear
from delone.interpolate.beyond import _nearest


def cloud(count: int, d: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).random((count, d))


def far(count: int, d: int, seed: int) -> np.ndarray:
    """Queries of which most are outside a unit cube."""
    return np.random.default_rng(seed).normal(size=(count, d)) * 2


@pytest.mark.parametrize("d", [2, 3])
def test_two_and_three_dimensions_are_those_of_the_mesh(d: int) -> None:
    # There the nearest facet is found by other code.
    points, queries = cloud(60, d, 0), far(300, d, 1)
    values = np.random.default_rng(2).normal(size=(60, 2))
    mesh = Linear(points, values, extrapolate="nearest")(queries)
    lazy = Linear(points, values, extrapolate="nearest", method="lazy")
    assert np.abs(lazy(queries) - mesh).max() < 1e-11
    assert np.abs(lazy.weights_at(queries) @ values - mesh).max() < 1e-11


def brute(points: np.ndarray, query: np.ndarray) -> float:
    """The least distance to a hull, over the nearest points of the planes of all its subsets."""
    d = points.shape[1]
    best = np.linalg.norm(points - query, axis=1).min()
    for size in range(2, d + 2):
        for rows in itertools.combinations(range(len(points)), size):
            base, sides = points[rows[0]], points[list(rows[1:])] - points[rows[0]]
            rest = np.linalg.lstsq(sides.T, query - base, rcond=None)[0]
            if (rest >= 0).all() and rest.sum() <= 1:
                best = min(best, np.linalg.norm(base + rest @ sides - query))
    return float(best)


@pytest.mark.parametrize("d", [2, 3, 4, 5])
def test_nearest_points_by_all_subsets(d: int) -> None:
    points = cloud(9, d, d)
    for query in far(15, d, 7):
        active, shares = _nearest(points, query)
        assert (shares > 0).all()
        assert shares.sum() == pytest.approx(1, abs=1e-14)
        assert len(active) <= d + 1
        away = np.linalg.norm(shares @ points[active] - query)
        assert away == pytest.approx(brute(points, query), abs=1e-9)
        # No point is beyond the plane across the way.
        way = query - shares @ points[active]
        assert ((points - query) @ way <= -(way @ way) * (1 - 1e-9) + 1e-12).all()


@pytest.mark.parametrize(("d", "count"), [(4, 200), (5, 80), (6, 50), (8, 30)])
def test_all_methods_have_the_same_values(d: int, count: int) -> None:
    points, queries = cloud(count, d, d), far(120, d, 3)
    values = np.random.default_rng(4).normal(size=count)
    found = [
        Linear(points, values, extrapolate="nearest", method=method) for method in ("mesh", "lazy")
    ]
    one, two = (each(queries) for each in found)
    assert np.abs(one - two).max() < 1e-11
    assert (one >= values.min()).all() and (one <= values.max()).all()
    weights = found[0].weights_at(queries)
    assert np.abs(weights @ values - one).max() < 1e-13
    assert np.abs(weights @ np.ones(count) - 1).max() < 1e-13
    # The values inside, and those at queries that are moved there, do not change.
    inside = Linear(points, values)(queries)
    there = ~np.isnan(inside)
    assert np.array_equal(one[there], inside[there])
    linear = points @ np.arange(1.0, d + 1)
    outer = Linear(points, linear, extrapolate="nearest")(queries[:30])
    for query, value in zip(queries[:30], outer, strict=True):
        active, shares = _nearest(points, query)
        if np.isnan(Linear(points, linear)(query)):
            assert value == pytest.approx(shares @ linear[active], abs=1e-11)
    # Of the hull there are no gradients.
    assert np.array_equal(np.isnan(found[0].gradient(queries)[:, 0]), ~there)


def test_grids_are_clipped() -> None:
    axes = [[0, 1, 3.0], [0, 2.0, 5], [1, 2.0], [0, 1, 2, 3.0]]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 4)
    values = np.random.default_rng(5).normal(size=len(points))
    queries = far(200, 4, 6) * 3
    grid = Linear(points, values, extrapolate="nearest")
    assert "grid" in repr(grid)
    clipped = np.clip(queries, [0, 0, 1, 0], [3, 5, 2, 3])
    assert np.array_equal(grid(queries), grid(clipped))
    for method in ("mesh", "lazy"):
        other = Linear(points, values, extrapolate="nearest", method=method)
        assert np.abs(other(queries) - grid(queries)).max() < 1e-11
    flat = points[:, :2][:: 2 * 4]
    made = Linear(flat, flat[:, 0], method="grid", extrapolate="nearest")
    assert made([(-5, 9), (7, 1)]).tolist() == [0, 3]


def test_infinite_queries_missing_values_and_pickles() -> None:
    points = cloud(60, 4, 8)
    values = points.sum(axis=1)
    queries = np.vstack((far(20, 4, 9), np.full((1, 4), np.inf), np.full((1, 4), np.nan)))
    for method in ("mesh", "lazy"):
        field = Linear(points, values, extrapolate="nearest", method=method)
        found = field(queries)
        assert np.isnan(found).tolist() == [False] * 20 + [True] * 2
        assert np.array_equal(pickle.loads(pickle.dumps(field))(queries), found, equal_nan=True)
        holes = np.where(np.arange(60) == 3, np.nan, values)
        dropped = Linear(points, holes, extrapolate="nearest", method=method, nan="drop")(queries)
        rest = np.delete(points, 3, axis=0)
        other = Linear(rest, rest.sum(axis=1), extrapolate="nearest", method=method)(queries)
        assert np.allclose(dropped, other, rtol=0, atol=1e-12, equal_nan=True)
        # Differences that no double holds.
        large = Linear(points * 1.5e308, values, extrapolate="nearest", method=method)
        assert np.isfinite(large(-queries[:20] * 1e307)).all()
        near = field(queries[:20], max_distance=0.5)
        assert 0 < np.isnan(near).sum() < 20


def test_thin_hulls_have_values() -> None:
    points = cloud(40, 4, 10)
    points[:, 3] = points[:, 3] * 1e-12 + points[:, 0] / 3
    field = Linear(points, points[:, 1], extrapolate="nearest", method="lazy")
    found = field(far(50, 4, 11))
    assert np.isfinite(found).all()
    assert ((found >= 0) & (found <= 1)).all()


def test_what_is_refused() -> None:
    points = cloud(30, 4, 12)
    for method in ("mesh", "lazy", "auto"):
        with pytest.raises(delone.InputError, match="extrapolate='nearest' has a value everywhere"):
            Linear(points, points[:, 0], method=method, extrapolate="linear")
    flat = cloud(30, 2, 13)
    for option in ({"extrapolate": "linear"}, {"tolerance": 0.1}):
        with pytest.raises(delone.InputError, match="no gradients at the hull and no tolerance"):
            Linear(flat, flat[:, 0], method="lazy", **option)
    own = Linear(Delaunay(points), points[:, 0], extrapolate="nearest")
    assert np.isfinite(own(points[:3] + 5)).all()
