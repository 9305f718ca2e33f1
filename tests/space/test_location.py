"""locate of tetrahedra against its definition: in exact numbers, with holes, at every scale."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from delone import Delaunay, datasets
from delone.predicates import orient3d
from rational import dot, exact, from_triangle, minus

SCALES = [1.0, 2.0**1019, 2.0**-1030, 5e-324]


def check_outside(mesh: Any, queries: Any) -> int:
    """The nearest points of the boundary; returns how many queries are outside."""
    place = mesh.locate(queries)
    assert np.array_equal(place.simplex, mesh.find_simplex(queries))
    points = exact(mesh.points)
    open_faces = np.argwhere(mesh.neighbors < 0)
    corners = [np.delete(mesh.simplices[t], k).tolist() for t, k in open_faces]
    faces = [[points[v] for v in face] for face in corners]
    rows = np.flatnonzero(place.simplex < 0)
    for i in rows:
        query, nearest = exact([queries[i], place.closest[i]])
        least = min(from_triangle(query, face)[0] for face in faces)
        away = minus(query, nearest)
        # The point is rounded: to about a unit in the last place of its coordinates.
        size = max(map(abs, [*query, *nearest]))
        slack = size / 2**46 + Fraction(5e-324) * 8
        assert abs(dot(away, away) - least) <= slack * (slack + 2 * max(map(abs, away)))
        assert set(place.facet[i].tolist()) <= set(mesh.simplices[place.beside[i]].tolist())
        assert sorted(place.facet[i].tolist()) in [sorted(face) for face in corners]
        inner = np.setdiff1d(mesh.simplices[place.beside[i]], place.facet[i])[0]
        assert orient3d(*mesh.points[place.facet[i]], mesh.points[inner]) < 0
        assert (place.weights[i] >= 0).all()
        assert place.weights[i].sum() == pytest.approx(1, rel=1e-15)
    inside = place.simplex >= 0
    assert np.array_equal(place.closest[inside], queries[inside])
    assert (place.beside[inside] == -1).all() and (place.facet[inside] == -1).all()
    assert np.isnan(place.weights[inside]).all()
    return len(rows)


@pytest.mark.parametrize("scale", SCALES)
def test_outside_the_nearest_point_of_the_hull(scale: float) -> None:
    rng = np.random.default_rng(5)
    points = rng.integers(-12, 13, (30, 3)) * 1.0
    queries = rng.integers(-15, 16, (60, 3)) * 1.0
    mesh = Delaunay(points * scale)
    assert check_outside(mesh, queries * scale) > 20


def test_uniform_points() -> None:
    mesh = Delaunay(datasets.uniform(40, ndim=3, seed=4))
    assert check_outside(mesh, np.random.default_rng(5).random((60, 3)) * 4 - 1.5) > 40


def with_a_hole(seed: int) -> Any:
    """Tetrahedra of a cube without those around some vertices, made a TetMesh."""
    whole = Delaunay(datasets.uniform(60, ndim=3, seed=seed))
    middle = np.abs(whole.points - 0.5).max(axis=1) < 0.2
    left = whole.simplices[~middle[whole.simplices].any(axis=1)]
    return delone.improve((whole.points, left), min_angle=0)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.sampled(1)
def test_tetrahedra_with_a_hole(seed: int) -> None:
    mesh = with_a_hole(seed)
    rng = np.random.default_rng(seed)
    queries = np.concatenate((rng.random((40, 3)) * 1.4 - 0.2, 0.5 + 0.2 * rng.random((20, 3))))
    queries = np.concatenate((queries, mesh.points[:20]))
    corners = mesh.points[mesh.simplices]
    found = mesh.find_simplex(queries)
    for query, simplex in zip(queries, found.tolist(), strict=True):
        signs = []
        for k in range(4):
            moved = corners.copy()
            moved[:, k] = query
            signs.append(orient3d(*np.moveaxis(moved, 1, 0)) >= 0)
        holders = np.flatnonzero(np.logical_and.reduce(signs))
        assert simplex == (holders[0] if len(holders) else -1)
    assert check_outside(mesh, queries) > 10


def test_what_is_no_number_is_nowhere() -> None:
    for mesh in (Delaunay(datasets.uniform(50, ndim=3)), with_a_hole(0)):
        place = mesh.locate([(np.nan, 0.5, 0.5), (0.5, np.inf, 0.5)])
        assert place.simplex.tolist() == place.beside.tolist() == [-1, -1]
        assert np.isnan(place.closest).all() and np.isnan(place.weights).all()


@pytest.mark.parametrize("shape", [(3,), (0, 3), (3, 4, 3), (2, 0, 3)])
def test_any_leading_shape(shape: tuple[int, ...]) -> None:
    queries = np.random.default_rng(0).random(shape) * 2
    for mesh in (Delaunay(datasets.uniform(50, ndim=3)), with_a_hole(0)):
        place = mesh.locate(queries)
        assert place.simplex.shape == place.beside.shape == shape[:-1]
        assert place.barycentric.shape == (*shape[:-1], 4)
        assert place.closest.shape == place.facet.shape == place.weights.shape == shape
        assert place.at(np.array([], dtype=int)).facet.size == 0 if shape[:-1] else True


def brute(mesh: Any, queries: Any) -> Any:
    """The first tetrahedron that holds each query, of all."""
    found = np.full(len(queries), -1)
    for t in reversed(range(len(mesh.simplices))):
        corners = mesh.points[mesh.simplices[t]]
        inside = np.ones(len(queries), dtype=bool)
        for k in range(4):
            with_query = [queries if j == k else corners[j] for j in range(4)]
            inside &= orient3d(*with_query) >= 0
        found[inside] = t
    return found


def check_turns(mesh: Any, near: Any, far: Any) -> None:
    turns = np.stack((near, far), axis=1).reshape(-1, 3)
    for queries in (near, far, turns, turns[np.lexsort(turns.T)], far[:7]):
        expected = brute(mesh, queries)
        assert mesh.find_simplex(queries).tolist() == expected.tolist()
        assert (expected < 0).sum() > 0
        for row in range(0, len(queries), 41):
            assert mesh.find_simplex(queries[row]) == expected[row]


@pytest.mark.parametrize("scale", SCALES)
def test_what_is_outside_is_told_whatever_was_asked_before(scale: float) -> None:
    """Faces that proved one query to be outside are asked again: inside and out come in turns."""
    rng = np.random.default_rng(8)
    mesh = Delaunay(rng.integers(-9, 10, (40, 3)) * scale)
    near = rng.integers(-11, 12, (300, 3)) * scale
    check_turns(mesh, near, rng.integers(-15, 16, (300, 3)) * scale)


def test_holes_are_outside_and_prove_nothing() -> None:
    rng = np.random.default_rng(8)
    near = 0.5 + 0.6 * (rng.random((300, 3)) - 0.5)
    check_turns(with_a_hole(0), near, rng.random((300, 3)) * 3 - 1)


def test_linear_asks_no_more_than_it_needs() -> None:
    rng = np.random.default_rng(9)
    points = rng.random((200, 3))
    mesh, queries = Delaunay(points), rng.random((400, 3)) * 3 - 1
    place = mesh.locate(queries)
    values = delone.interpolate.Linear(mesh, points @ (1, 2, 3))(queries)
    assert np.array_equal(np.isnan(values), place.simplex < 0)
    inside = place.simplex >= 0
    assert values[inside] == pytest.approx(queries[inside] @ (1, 2, 3), rel=1e-12)
