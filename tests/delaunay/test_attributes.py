"""Attributes that follow from the triangles, against their definitions and against SciPy."""

from __future__ import annotations

import numpy as np
import pytest

from delone import Delaunay, datasets
from delone.predicates import orient2d

NAMES = ["uniform", "grid", "duplicates", "collinear_lines", "circle", "near_collinear"]


@pytest.fixture(params=NAMES)
def mesh(request: pytest.FixtureRequest) -> Delaunay:
    return Delaunay(datasets.GENERATORS[request.param](200, seed=1))


def all_edges(mesh: Delaunay) -> set[tuple[int, int]]:
    return {
        (min(u, v), max(u, v))
        for a, b, c in mesh.simplices.tolist()
        for u, v in ((a, b), (b, c), (c, a))
    }


def test_sizes(mesh: Delaunay) -> None:
    assert mesh.ndim == 2
    assert mesh.npoints == len(mesh.points) == 200
    assert mesh.nsimplex == len(mesh.simplices) == len(mesh.neighbors)
    assert mesh.min_bound.tolist() == mesh.points.min(axis=0).tolist()
    assert mesh.max_bound.tolist() == mesh.points.max(axis=0).tolist()


def test_dtypes_are_those_of_scipy(mesh: Delaunay) -> None:
    spatial = pytest.importorskip("scipy.spatial")
    theirs = spatial.Delaunay(np.random.default_rng(0).random((20, 2)))
    for name in (
        "points",
        "simplices",
        "neighbors",
        "convex_hull",
        "coplanar",
        "vertex_to_simplex",
        "transform",
        "min_bound",
        "max_bound",
    ):
        ours = getattr(mesh, name)
        assert ours.dtype == getattr(theirs, name).dtype, name
        assert ours.ndim == getattr(theirs, name).ndim, name
        assert ours.shape[1:] == getattr(theirs, name).shape[1:], name
    for ours, other in zip(
        mesh.vertex_neighbor_vertices, theirs.vertex_neighbor_vertices, strict=True
    ):
        assert ours.dtype == other.dtype


def test_edges_are_all_sides_once_in_order(mesh: Delaunay) -> None:
    edges = [tuple(edge) for edge in mesh.edges.tolist()]
    assert edges == sorted(all_edges(mesh))
    distinct = mesh.npoints - len(mesh.coplanar)
    assert len(edges) == 3 * distinct - len(mesh.hull) - 3
    assert mesh.nsimplex == 2 * distinct - len(mesh.hull) - 2


def test_neighbors_are_opposite_vertices(mesh: Delaunay) -> None:
    for t, (triangle, beyond) in enumerate(
        zip(mesh.simplices.tolist(), mesh.neighbors.tolist(), strict=True)
    ):
        for k in range(3):
            if beyond[k] >= 0:
                shared = set(triangle) - {triangle[k]}
                assert shared < set(mesh.simplices[beyond[k]].tolist())
                assert t in mesh.neighbors[beyond[k]]


def test_hull_is_convex_and_holds_all_points(mesh: Delaunay) -> None:
    hull = mesh.hull
    after = np.roll(hull, -1)
    assert {tuple(e) for e in mesh.convex_hull.tolist()} == set(
        zip(hull.tolist(), after.tolist(), strict=True)
    )
    assert len(mesh.convex_hull) == len(hull) == len(set(hull.tolist()))
    corners = mesh.points[hull], mesh.points[after]
    for start, end in zip(*corners, strict=True):
        assert (orient2d(start, end, mesh.points) >= 0).all()
    assert mesh.points[hull[0]].tolist() == min(mesh.points.tolist())


def test_duplicates_and_coplanar(mesh: Delaunay) -> None:
    rows = (mesh.points + 0.0).tolist()
    first = [rows.index(row) for row in rows]
    assert mesh.duplicate_of.tolist() == first
    expected = [i for i, f in enumerate(first) if i != f]
    assert mesh.coplanar[:, 0].tolist() == expected
    for _, triangle, vertex in mesh.coplanar.tolist():
        assert vertex in mesh.simplices[triangle]
    assert mesh.coplanar[:, 2].tolist() == [first[i] for i in expected]


def test_vertex_to_simplex_gives_the_first_triangle(mesh: Delaunay) -> None:
    triangles = mesh.simplices.tolist()
    for row, t in enumerate(mesh.vertex_to_simplex.tolist()):
        vertex = int(mesh.duplicate_of[row])
        assert t == next(i for i, triangle in enumerate(triangles) if vertex in triangle)


def test_vertex_neighbor_vertices(mesh: Delaunay) -> None:
    indptr, indices = mesh.vertex_neighbor_vertices
    edges = all_edges(mesh)
    assert len(indptr) == mesh.npoints + 1
    for vertex in range(mesh.npoints):
        around = indices[indptr[vertex] : indptr[vertex + 1]].tolist()
        assert around == sorted(u + v - vertex for u, v in edges if vertex in (u, v))


def test_general_position_agrees_with_scipy() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    points = np.random.default_rng(8).random((500, 2))
    ours, theirs = Delaunay(points), spatial.Delaunay(points)
    place = {tuple(sorted(t)): i for i, t in enumerate(theirs.simplices.tolist())}
    assert {tuple(sorted(t)) for t in ours.simplices.tolist()} == set(place)
    queries = np.random.default_rng(9).random((2000, 2)) * 1.2 - 0.1
    found, expected = ours.find_simplex(queries), theirs.find_simplex(queries)
    assert ((found < 0) == (expected < 0)).all()
    order = np.array([place[tuple(sorted(t))] for t in ours.simplices.tolist()])
    assert (order[found[found >= 0]] == expected[found >= 0]).all()


def test_stages_are_named_times() -> None:
    mesh = Delaunay(datasets.uniform(1000))
    assert mesh.stages
    assert all(isinstance(name, str) for name in mesh.stages)
    assert all(seconds >= 0 for seconds in mesh.stages.values())
    mesh.stages.clear()
    assert mesh.stages


def test_repr_says_what_there_is() -> None:
    assert repr(Delaunay([(0, 0), (1, 0), (0, 1)])) == "<Delaunay of 3 points: 1 triangle>"
    mesh = Delaunay([(0, 0), (1, 0), (0, 1), (1, 1), (1, 0)])
    assert repr(mesh) == "<Delaunay of 5 points (1 duplicate): 2 triangles>"


def test_signed_zeros_are_one_place() -> None:
    mesh = Delaunay([(0.0, 0.0), (1, 0), (0, 1), (-0.0, 0.0), (0.0, -0.0)])
    assert mesh.duplicate_of.tolist() == [0, 1, 2, 0, 0]
    assert np.signbit(mesh.points[3, 0])
