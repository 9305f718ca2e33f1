from __future__ import annotations

import inspect
from fractions import Fraction

import numpy as np
import pytest

from delone import datasets
from delone.errors import InputError
from delone.reference import orient

ALL = pytest.mark.parametrize("name", sorted(datasets.GENERATORS))


@ALL
@pytest.mark.parametrize("n", [0, 1, 2, 3, 7, 1000])
def test_returns_n_finite_points(name: str, n: int) -> None:
    points = datasets.GENERATORS[name](n)
    assert points.shape == (n, 2)
    assert points.dtype == np.float64
    assert points.flags.c_contiguous
    assert np.isfinite(points).all()


@ALL
@pytest.mark.parametrize("n", [-1, 2.5, "3", None, True])
def test_a_bad_number_is_an_input_error(name: str, n: object) -> None:
    with pytest.raises(InputError, match="n must be an integer of at least 0"):
        datasets.GENERATORS[name](n)


@ALL
def test_a_number_of_numpy_will_do(name: str) -> None:
    assert len(datasets.GENERATORS[name](np.int64(7))) == 7


@ALL
def test_seed_decides(name: str) -> None:
    generate = datasets.GENERATORS[name]
    np.testing.assert_array_equal(generate(200, seed=5), generate(200, seed=5))
    assert (generate(200, seed=5) != generate(200, seed=6)).any()


@ALL
def test_takes_n_and_then_keywords_only(name: str) -> None:
    first, *rest = inspect.signature(datasets.GENERATORS[name]).parameters.values()
    assert first.name == "n"
    assert {p.name for p in rest} >= {"seed"}
    assert all(p.kind is p.KEYWORD_ONLY and p.default is not p.empty for p in rest)


@ALL
def test_spans_an_area(name: str) -> None:
    points = datasets.GENERATORS[name](50, seed=1).tolist()
    low, high = min(points), max(points)
    assert any(orient(low, high, point) for point in points)


def test_all_are_public() -> None:
    assert set(datasets.GENERATORS) <= set(datasets.__all__)


def test_uniform_in_three_dimensions() -> None:
    assert datasets.uniform(10, ndim=3).shape == (10, 3)


@pytest.mark.parametrize("name", ["grid", "tilted_grid", "circle", "spiral"])
def test_seed_only_shuffles_the_regular_ones(name: str) -> None:
    generate = datasets.GENERATORS[name]
    shuffled, ordered = generate(90, seed=3), generate(90, seed=None)
    assert sorted(shuffled.tolist()) == sorted(ordered.tolist())
    assert shuffled.tolist() != ordered.tolist()


def test_grid_is_square_and_full() -> None:
    assert sorted(datasets.grid(9).tolist()) == [[x, y] for x in range(3) for y in range(3)]
    assert datasets.grid(10).max() == 3


def test_clusters_span_ten_orders_of_magnitude() -> None:
    points = datasets.gaussian_clusters(5000)
    nearest = np.diff(np.sort(points[:, 0]))
    assert nearest.min() < 1e-12
    assert np.ptp(points[:, 0]) > 1


def test_near_collinear_stays_within_ulps_and_leaves_the_line() -> None:
    x, y = datasets.near_collinear(500, ulps=2).T
    off = (y - (x / 3 + 1)) / np.spacing(y)
    assert np.abs(off).max() <= 2
    assert len(np.unique(off)) == 5


def test_duplicates_repeat_places() -> None:
    points = datasets.duplicates(4000)
    assert 900 < len(np.unique(points, axis=0)) <= 1000
    assert len(np.unique(datasets.duplicates(100, distinct=3), axis=0)) == 3


def test_collinear_lines_are_exactly_collinear() -> None:
    points = datasets.collinear_lines(60, lines=3)
    for line in range(3):
        on_line = points[line::3].tolist()
        low, high = min(on_line), max(on_line)
        assert low != high
        assert all(orient(low, high, point) == 0 for point in on_line)


def test_utm_is_rounded_to_the_nearest_millimetre() -> None:
    points = datasets.utm_millimeters(1000)
    millimetres = np.round(points * 1000)
    np.testing.assert_array_equal(millimetres / 1000, points)
    assert (points.min(axis=0) >= [500_000, 5_400_000]).all()
    assert (points.max(axis=0) <= [501_000, 5_401_000]).all()


@pytest.mark.parametrize("n", [3, 100, 5000, 236_196])
def test_pythagorean_circle_is_exact_and_distinct(n: int) -> None:
    points = datasets.pythagorean_circle(n)
    assert len(np.unique(points, axis=0)) == n
    # Python integers: the squares have up to 100 bits.
    x, y = points.astype(np.int64).astype(object).T
    assert len(set(x * x + y * y)) == 1
    assert np.abs(points).max() < 2**53


def test_pythagorean_circle_has_an_end() -> None:
    with pytest.raises(InputError, match="236196"):
        datasets.pythagorean_circle(236_197)


def test_mixed_exponents_have_all_magnitudes() -> None:
    values = np.abs(datasets.mixed_exponents(1000))
    assert (values == 0).any() and (values > 1e290).any()
    assert ((values > 0) & (values < np.finfo(float).tiny)).any()
    assert np.signbit(datasets.mixed_exponents(1000)).any()


def test_kuzmin_has_the_stated_share_within_a_radius() -> None:
    radius = np.hypot(*datasets.kuzmin(20_000).T)
    for r in (0.5, 1.0, 3.0):
        share = 1 - 1 / np.sqrt(1 + r * r)
        assert abs((radius <= r).mean() - share) < 0.02


def test_circle_lies_within_rounding_of_the_circle() -> None:
    for x, y in datasets.circle(50, radius=4.0).tolist():
        square = Fraction(x) ** 2 + Fraction(y) ** 2
        assert abs(square - 16) < Fraction(1, 10**13)


def test_integer_lattice_stays_on_its_side() -> None:
    points = datasets.integer_lattice(500, side=6)
    assert set(points.ravel().tolist()) == {0, 1, 2, 3, 4, 5}
