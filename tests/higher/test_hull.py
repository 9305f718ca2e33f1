"""Convex hulls in four to eight dimensions."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import delone
from delone import ConvexHull, Delaunay

SIZES = {4: 60, 5: 40, 6: 24, 7: 16, 8: 14}


def some(d: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(SIZES[d], d))


def as_sets(simplices: np.ndarray) -> set[tuple[int, ...]]:
    return set(map(tuple, np.sort(simplices, axis=1).tolist()))


@pytest.mark.parametrize("d", SIZES)
def test_facets_are_those_of_scipy_in_general_position(d: int) -> None:
    spatial = pytest.importorskip("scipy.spatial")
    points = some(d)
    hull, theirs = ConvexHull(points), spatial.ConvexHull(points)
    assert as_sets(hull.simplices) == as_sets(theirs.simplices)
    assert set(hull.vertices.tolist()) == set(theirs.vertices.tolist())
    assert hull.volume == pytest.approx(theirs.volume, rel=1e-12)
    assert hull.area == pytest.approx(theirs.area, rel=1e-10)
    rows = map(tuple, np.sort(theirs.simplices, axis=1))
    by_facet = dict(zip(rows, theirs.equations, strict=True))
    for facet, equation in zip(np.sort(hull.simplices, axis=1), hull.equations, strict=True):
        assert np.abs(by_facet[tuple(facet)] - equation).max() < 1e-10
    assert hull.validate()
    assert len(hull.facets) == hull.nsimplex


@pytest.mark.parametrize("d", [4, 5, 6])
def test_a_cube_has_its_corners_and_sides(d: int) -> None:
    axes = [np.arange(3.0) * (k + 1) for k in range(d)]
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, d)
    points = np.vstack((points, points[:4]))
    hull = ConvexHull(points[np.random.default_rng(d).permutation(len(points))])
    assert len(hull.vertices) == 2**d
    assert len(hull.facets) == 2 * d
    assert all(len(facet) == 2 ** (d - 1) for facet in hull.facets)
    assert hull.nsimplex == 2 * d * math.factorial(d - 1)
    sides = 2.0 * np.arange(1, d + 1)
    assert hull.volume == pytest.approx(sides.prod(), rel=1e-13)
    assert hull.area == pytest.approx(2 * (sides.prod() / sides).sum(), rel=1e-12)
    normals = np.unique(np.round(hull.equations[:, :d], 12), axis=0)
    assert sorted(map(tuple, normals)) == sorted(map(tuple, np.vstack((np.eye(d), -np.eye(d)))))
    assert hull.validate()
    assert repr(hull) == f"<ConvexHull of {3**d + 4} points: {2**d} vertices, {2 * d} facets>"


def test_simplices_are_those_of_the_triangulation_of_the_vertices() -> None:
    random = np.random.default_rng(5)
    for seed in range(6):
        points = np.random.default_rng(seed).integers(0, 4, (60, 4)).astype(float)
        hull = ConvexHull(points)
        boundary = Delaunay(points[hull.vertices]).convex_hull
        assert as_sets(hull.simplices) == as_sets(hull.vertices[boundary])
        order = random.permutation(60)
        other = ConvexHull(points[order])
        assert (other.points[other.simplices] == hull.points[hull.simplices]).all()
        assert hull.validate()
        assert hull.coplanar.shape[1] == 3


def test_compositions_keep_all_extreme_points() -> None:
    random = np.random.default_rng(1)
    parts = random.integers(0, 7, (200, 5)) / 6
    hull = ConvexHull(parts)
    # A point is extreme if the others do not contain it.
    for row in range(0, 200, 9):
        others = parts[(parts != parts[row]).any(axis=1)]
        first = np.flatnonzero((parts == parts[row]).all(axis=1))[0]
        inside = ConvexHull(others).contains(parts[row])
        assert inside == (first not in hull.vertices)


def test_a_facet_through_the_ends_of_all_axes() -> None:
    # The least and the greatest along each axis lie on one plane, which has a facet.
    random = np.random.default_rng(4)
    ends = np.vstack((np.zeros(4), np.ones(4), np.eye(4)[:3] * 0.5 + 0.25))
    normal = np.array([1.0, 1.0, 1.0, -3.0])
    flat = ends - np.outer(ends @ normal, [0, 0, 0, -1 / 3])
    flat = np.round(flat * 64) / 64
    flat[:, 3] = flat[:, :3].sum(axis=1) / 4
    points = np.vstack((flat * 4, [[2, 2, 2, 1.75]], random.random((3, 4)) * 0.1 + [2, 2, 2, 1.6]))
    hull = ConvexHull(points)
    assert np.isfinite(hull.equations).all()
    assert np.isfinite(hull.area)
    assert (
        np.einsum("kd,nd->kn", hull.equations[:, :4], points) < 1e-12 - hull.equations[:, 4:]
    ).all()


def test_no_point_of_many_is_outside() -> None:
    random = np.random.default_rng(7)
    points = random.normal(size=(2500, 4))
    points[2000:] /= np.linalg.norm(points[2000:], axis=1, keepdims=True) / 6
    hull = ConvexHull(points)
    beyond = points @ hull.equations[:, :4].T + hull.equations[:, 4]
    assert beyond.max() < 1e-12
    assert hull.vertices.min() >= 2000
    assert len(hull.vertices) == 500


def test_points_inside_and_on_the_boundary() -> None:
    for d in (4, 7):
        hull = ConvexHull(some(d, 2))
        center = hull.points.mean(axis=0)
        assert hull.contains(hull.points).all()
        assert hull.contains(center)
        assert not hull.contains(hull.points[hull.vertices] * 2 - center).any()
        assert not hull.contains(np.full((2, d), np.nan)).any()
    flat = ConvexHull([(0, 0), (3, 1), (1, 3)])
    assert flat.contains([(0, 0), (1, 1), (4, 4)]).tolist() == [True, True, False]


def test_files_and_refusals(tmp_path: Path) -> None:
    points = some(5, 3)
    hull = ConvexHull(points)
    hull.save(tmp_path / "hull.npz")
    assert (ConvexHull.load(tmp_path / "hull.npz").simplices == hull.simplices).all()
    assert not hasattr(hull, "plot")
    assert not hasattr(hull, "polygon")
    points[:, 4] = 1.5
    with pytest.raises(delone.DegenerateInputError, match="in a flat of dimension 4") as flat:
        ConvexHull(points)
    assert flat.value.reason == "flat"
    points[3, 2] = np.nan
    with pytest.raises(delone.NonFiniteError):
        ConvexHull(points)
    with pytest.raises(delone.ShapeError):
        ConvexHull(np.ones((30, 9)))
