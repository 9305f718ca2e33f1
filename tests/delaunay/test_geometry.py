"""Areas, circumcentres and transforms against rational arithmetic, near the origin and far off."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from delone import Delaunay, datasets

TINY = 1e-13
NORMAL = Fraction(2) ** -1022
LARGEST = Fraction(float(np.finfo(np.float64).max))


def offsets() -> list[Any]:
    unit = np.random.default_rng(2).random((150, 2))
    cases = [
        pytest.param(unit + np.array([1.0, 1.3]) * offset, id=f"offset-{offset:.0e}")
        for offset in (1e6, 1e7, 1e8, 1e9)
    ]
    return cases + [
        pytest.param(generate(150, seed=3), id=name)
        for name, generate in datasets.GENERATORS.items()
    ]


@pytest.fixture(params=offsets())
def mesh(request: pytest.FixtureRequest) -> Delaunay:
    return Delaunay(request.param)


def exact_corners(mesh: Delaunay, t: int) -> list[tuple[Fraction, Fraction]]:
    return [(Fraction(x), Fraction(y)) for x, y in mesh.points[mesh.simplices[t]].tolist()]


def assert_close(found: float, expected: Fraction, slack: Fraction = Fraction(0)) -> None:
    """Relative error below 1e-13, where doubles have their full precision."""
    if not np.isfinite(found):
        assert not np.isnan(found)
        assert abs(expected) > LARGEST
        return
    bound = max(abs(expected) * Fraction(TINY), NORMAL / 2**51) + slack
    assert abs(Fraction(found) - expected) <= bound


def test_areas(mesh: Delaunay) -> None:
    assert mesh.areas.shape == (mesh.nsimplex,)
    for t in range(mesh.nsimplex):
        (ax, ay), (bx, by), (cx, cy) = exact_corners(mesh, t)
        assert_close(mesh.areas[t], ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2)


def test_circumcenters(mesh: Delaunay) -> None:
    for t in range(mesh.nsimplex):
        (ax, ay), (bx, by), (ox, oy) = exact_corners(mesh, t)
        ax, ay, bx, by = ax - ox, ay - oy, bx - ox, by - oy
        twice, a, b = 2 * (ax * by - ay * bx), ax * ax + ay * ay, bx * bx + by * by
        x, y = (by * a - ay * b) / twice, (ax * b - bx * a) / twice
        slack = (abs(x) + abs(y)) * Fraction(TINY)
        for found, expected in zip(mesh.circumcenters[t], (x + ox, y + oy), strict=True):
            assert_close(found, expected, slack)


def test_transform_has_scipys_meaning(mesh: Delaunay) -> None:
    assert mesh.transform.shape == (mesh.nsimplex, 3, 2)
    assert np.array_equal(mesh.transform[:, 2], mesh.points[mesh.simplices[:, 2]])
    for t in range(mesh.nsimplex):
        (ax, ay), (bx, by), (ox, oy) = exact_corners(mesh, t)
        ax, ay, bx, by = ax - ox, ay - oy, bx - ox, by - oy
        determinant = ax * by - ay * bx
        inverse = (by, -bx, -ay, ax)
        for found, entry in zip(mesh.transform[t, :2].ravel(), inverse, strict=True):
            assert_close(found, entry / determinant)


def test_transform_agrees_with_scipy() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    points = np.random.default_rng(1).random((50, 2))
    ours, theirs = Delaunay(points), spatial.Delaunay(points)
    # The maps depend on the order of corners; barycentric coordinates of a point do not.
    queries = np.random.default_rng(2).random((100, 2))
    for mesh in (ours, theirs):
        found = mesh.find_simplex(queries)
        inside = found >= 0
        maps = mesh.transform[found[inside]]
        two = np.einsum("kij,kj->ki", maps[:, :2], queries[inside] - maps[:, 2])
        weights = np.column_stack((two, 1 - two.sum(axis=1)))
        assert (weights > -1e-12).all()
        back = np.einsum("kc,kci->ki", weights, points[mesh.simplices[found[inside]]])
        assert np.allclose(back, queries[inside], rtol=0, atol=1e-12)


def test_the_thinnest_triangle_has_an_area() -> None:
    # Its cross product is one unit of 2**-104 of two products of magnitude 1.
    h = 2.0**-52
    mesh = Delaunay([(0, 0), (1 + h, 1), (1, 1 - h)])
    assert mesh.areas.tolist() == [h * h / 2]
    assert np.isfinite(mesh.transform).all()


def test_the_textbook_circle() -> None:
    mesh = Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
    below = next(t for t in range(4) if set(mesh.simplices[t].tolist()) == {0, 1, 4})
    assert mesh.circumcenters[below].tolist() == [2.0, -1.5]


def test_infinite_only_beyond_the_range() -> None:
    mesh = Delaunay([(0, 0), (1e300, 0), (0, 1e300), (1e300, 1e300)])
    assert np.isinf(mesh.areas).all()
    assert np.array_equal(mesh.circumcenters, [[5e299, 5e299]] * 2)
    assert (np.abs(mesh.transform[:, :2]) <= 1e-300).all()
    assert not np.isnan(mesh.transform).any()
