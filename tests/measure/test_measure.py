"""Measures of simplices beside fractions, of every magnitude and thickness, and beyond one task."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, _core, datasets
from delone._tiling.plane.geometry import total
from delone._tiling.plane.quality import below, squared_cosine
from rational import area, cross, dot, exact, minus, ulps

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

SCALES = [1.0, 3.0, 2.0**-1000, 2.0**-350, 2.0**-41, 2.0**61, 2.0**340, 2.0**1000]
THICKNESS = [1.0, 1e-3, 1e-9, 1e-17, 1e-80]


def simplices(ndim: int, thickness: float, scale: float) -> NDArray[np.float64]:
    """Corners of simplices, positively oriented, (k, ndim + 1, ndim)."""
    random = np.random.default_rng(ndim)
    corners = random.random((40, ndim + 1, ndim))
    corners[:, :, -1] *= thickness
    corners[20:, 0] = corners[20:, 1]
    corners[20:, 0, -1] += thickness * 2.0**-30
    corners *= scale
    sign = np.array([_orientation(each) for each in corners])
    corners[sign < 0] = corners[sign < 0][:, [1, 0, *range(2, ndim + 1)]]
    found: NDArray[np.float64] = corners[sign != 0]
    return found


def _orientation(corners: NDArray[np.float64]) -> int:
    size = determinant(corners)
    return (size > 0) - (size < 0)


def determinant(corners: NDArray[np.float64]) -> Fraction:
    """Twice the area of a triangle, or six times the volume of a tetrahedron."""
    p = exact(corners)
    if len(p) == 3:
        return 2 * area(p)
    b, c, d = (minus(q, p[0]) for q in p[1:])
    return dot(b, cross(c, d))


def rounded(number: Fraction) -> float:
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


def flat(corners: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    count, n, ndim = corners.shape
    rows = np.arange(count * n, dtype=np.int32).reshape(count, n)
    return np.ascontiguousarray(corners.reshape(-1, ndim)), rows


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("thickness", THICKNESS)
@pytest.mark.parametrize("ndim", [2, 3])
def test_sizes_and_centers_by_fractions(ndim: int, thickness: float, scale: float) -> None:
    corners = simplices(ndim, thickness, scale)
    size = _core.sizes(*flat(corners), 1)
    center = _core.circumcenters(*flat(corners), 1)
    for found, at, each in zip(size, center, corners, strict=True):
        wanted = rounded(abs(determinant(each)) / math.factorial(ndim))
        assert found == pytest.approx(wanted, rel=1e-14, abs=5e-324)
        for x, true in zip(at.tolist(), circumcenter(each), strict=True):
            if math.isinf(rounded(true)):
                assert x == rounded(true)
            else:
                assert ulps(x, true) <= 4


def circumcenter(corners: NDArray[np.float64]) -> tuple[Fraction, ...]:
    """By Cramer's rule."""
    p = exact(corners)
    rows = [minus(q, p[0]) for q in p[1:]]
    right = [dot(row, row) / 2 for row in rows]
    whole = _determinant(rows)
    found = []
    for k in range(len(rows)):
        replaced = [(*r[:k], x, *r[k + 1 :]) for r, x in zip(rows, right, strict=True)]
        found.append(p[0][k] + _determinant(replaced) / whole)
    return tuple(found)


def _determinant(rows: Any) -> Fraction:
    if len(rows) == 2:
        return Fraction(rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0])
    return dot(rows[0], cross(rows[1], rows[2]))


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("thickness", THICKNESS)
@pytest.mark.parametrize("ndim", [2, 3])
def test_transforms_by_fractions(ndim: int, thickness: float, scale: float) -> None:
    corners = simplices(ndim, thickness, scale)
    maps = _core.transforms(*flat(corners), 1)
    for found, each in zip(maps, corners, strict=True):
        assert (found[-1] == each[-1]).all()
        p = exact(each)
        columns = [minus(q, p[-1]) for q in p[:-1]]
        for i, row in enumerate(found[:-1].tolist()):
            wanted = _row(columns, i)
            length = max(map(abs, wanted))
            for x, true in zip(row, wanted, strict=True):
                if math.isinf(rounded(true)) or math.isinf(x):
                    assert x == pytest.approx(rounded(true), rel=1e-13)
                else:
                    error = abs(Fraction(x) - true)
                    assert error <= length / 10**13 + Fraction(5e-324)


def _row(columns: Any, i: int) -> tuple[Fraction, ...]:
    """The gradient of barycentric coordinate i."""
    whole = _determinant(columns)
    if len(columns) == 2:
        x, y = columns[1 - i]
        sign = 1 if i == 0 else -1
        return sign * y / whole, -sign * x / whole
    return tuple(x / whole for x in cross(columns[(i + 1) % 3], columns[(i + 2) % 3]))


@pytest.mark.parametrize("angle", [1e-9, 20.0, 30.0, 45.0, 59.99])
@pytest.mark.parametrize("scale", SCALES)
def test_below_by_fractions(angle: float, scale: float) -> None:
    bound = Fraction(squared_cosine(angle))
    for thickness in THICKNESS[:4]:
        corners = simplices(2, thickness, scale)
        wanted = [k for k, each in enumerate(corners) if _is_below(each, bound)]
        assert below(*flat(corners), angle).tolist() == wanted


def _is_below(corners: NDArray[np.float64], bound: Fraction) -> bool:
    p = exact(corners)
    for k in range(3):
        a, b = minus(p[k - 2], p[k]), minus(p[k - 1], p[k])
        inner = dot(a, b)
        if inner > 0 and inner * inner > dot(a, a) * dot(b, b) * bound:
            return True
    return False


def test_below_at_the_bound() -> None:
    # 45 degrees exactly, then one unit in the last place more and less.
    at = np.array([[(0, 0), (1, 0), (0, 1)]], dtype=float)
    assert len(below(*flat(at), 45)) == 0
    at[0, 2, 1] = np.nextafter(1, 2)
    assert below(*flat(at), 45).tolist() == [0]
    at = at[:, :, ::-1][:, [1, 0, 2]]
    assert below(*flat(np.ascontiguousarray(at)), 45).tolist() == [0]


def _columns(measure: Callable[..., list[NDArray[np.float64]]]) -> Callable[..., Any]:
    """Measures that come in columns, as the columns of one table."""
    return lambda *arguments: np.column_stack(measure(*arguments))


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_many_simplices_are_measured_row_by_row(workers: int) -> None:
    # More than one task of every function, and of the buckets of edges.
    plane = Delaunay(datasets.uniform(60_000, seed=1))
    solid = Delaunay(datasets.uniform(30_000, seed=2, ndim=3))
    rows = np.random.default_rng(0).integers(0, plane.nsimplex, 200)
    rows[:2] = plane.nsimplex - 1, 1 << 14
    for measure in (
        _core.sizes,
        _core.circumcenters,
        _columns(_core.qualities),
        _core.transforms,
    ):
        whole = measure(plane.points, plane.simplices, workers)
        assert (whole[rows] == measure(plane.points, plane.simplices[rows], 1)).all()
    rows = rows % solid.nsimplex
    rows[0] = solid.nsimplex - 1
    for measure in (
        _core.sizes,
        _core.circumcenters,
        _columns(_core.qualities),
        _core.transforms,
        _core.dihedral_angles3,
    ):
        whole = measure(solid.points, solid.simplices, workers)
        assert (whole[rows] == measure(solid.points, solid.simplices[rows], 1)).all()


@pytest.mark.parametrize("workers", [1, 2, 5])
@pytest.mark.sampled(1)
def test_many_edges_and_faces_are_each_listed_once(workers: int) -> None:
    plane = Delaunay(datasets.uniform(60_000, seed=1))
    found = _core.edges(plane.simplices, plane.neighbors, plane.npoints, workers)
    assert (found == distinct(plane.simplices, 2)).all()
    solid = Delaunay(datasets.uniform(30_000, seed=2, ndim=3))
    found = _core.edges(solid.simplices, solid.neighbors, solid.npoints, workers)
    assert (found == distinct(solid.simplices, 2)).all()
    found = _core.faces3(solid.simplices, solid.neighbors, solid.npoints, workers)
    assert (found == distinct(solid.simplices, 3)).all()


def distinct(simplices: NDArray[np.int32], size: int) -> NDArray[np.int32]:
    columns = combinations(range(simplices.shape[1]), size)
    rows = np.concatenate([np.sort(simplices[:, chosen], axis=1) for chosen in columns])
    found: NDArray[np.int32] = np.unique(rows, axis=0)
    return found


def test_percentiles_are_those_of_their_names() -> None:
    quality = Delaunay(datasets.uniform(300, seed=3)).quality()
    for name, found in quality.summary().items():
        values = getattr(quality, name)
        for percent in (1, 10, 50, 90, 99):
            assert found[f"p{percent}"] == np.percentile(values, percent), (name, percent)


@pytest.mark.parametrize("spread", [3, 60, 1000])
def test_totals_are_rounded_once(spread: int) -> None:
    rng = np.random.default_rng(spread)
    for count in (*range(5), 999, 1001, 5000, 70000, 140000):
        sizes = np.ldexp(rng.random(count), rng.integers(-spread, 5, count))
        sizes[rng.random(count) < 0.1] = 0
        # Ends of a sum halfway between two doubles: what is left decides.
        sizes = np.append(sizes, [1.0, 2.0**-53, 5e-324][: rng.integers(4)])
        rng.shuffle(sizes)
        assert total(sizes) == float(sum(map(Fraction, sizes.tolist()), Fraction(0)))


@pytest.mark.parametrize("count", [3, 3000])
def test_totals_at_the_ends_of_doubles(count: int) -> None:
    assert total(np.full(count, 5e-324)) == count * 5e-324
    assert total(np.full(count, 1e308)) == np.inf
    assert total(np.full(count, 2.0**1000)) == count * 2.0**1000
    assert total(np.append(np.zeros(count), 1.7e308)) == 1.7e308
    assert total(np.append(np.zeros(count), np.inf)) == np.inf
    assert np.isnan(total(np.append(np.zeros(count), np.nan)))
