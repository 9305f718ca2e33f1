"""Location, nearest vertices, edges, areas and circumcenters, against integers and known solids."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest

import directions as oracle
from delone import sphere

OCTAHEDRON = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]


def lattice(size):
    return [v for v in itertools.product(range(-size, size + 1), repeat=3) if any(v)]


def meshes():
    rng = np.random.default_rng(3)
    cap = rng.normal(size=(25, 3))
    cap[:, 2] = 2 + np.abs(cap[:, 2])
    small = lattice(1)
    yield sphere.Delaunay(xyz=rng.normal(size=(40, 3)))
    yield sphere.Delaunay(xyz=cap)
    yield sphere.Delaunay(xyz=small)
    yield sphere.Delaunay(xyz=[v for v in small if v[2] >= 0])
    yield sphere.Delaunay(xyz=[v for v in small if v[2] > 0 or v == (1, 0, 0)])
    yield sphere.Delaunay(xyz=[(9, 1, 0), (9, 0, 1), (9, -1, 0), (9, 0, -1)])


QUERIES = [*lattice(2), *np.random.default_rng(4).normal(size=(150, 3)).tolist()]


@pytest.mark.parametrize("mesh", list(meshes()))
def test_the_first_triangle_that_contains_a_direction(mesh):
    whole = [oracle.whole(v) for v in mesh.vectors.tolist()]
    found = mesh.find_simplex(np.array(QUERIES, dtype=float))
    corners = [[whole[v] for v in t] for t in mesh.simplices.tolist()]
    for query, t in zip(QUERIES, found.tolist(), strict=True):
        q = oracle.whole(query)
        want = -1
        for i, (a, b, c) in enumerate(corners):
            if min(oracle.orient(a, b, q), oracle.orient(b, c, q), oracle.orient(c, a, q)) >= 0:
                want = i
                break
        assert t == want, query
    # Answers do not depend on each other.
    alone = [int(mesh.find_simplex(query)) for query in QUERIES[:60]]
    assert alone == found[:60].tolist()


@pytest.mark.parametrize("mesh", list(meshes()))
def test_the_nearest_vertex_has_the_largest_cosine(mesh):
    whole = [oracle.whole(v) for v in mesh.vectors.tolist()]
    found = mesh.nearest(np.array(QUERIES, dtype=float))

    def is_nearer(q, a, b):
        left, right = oracle.dot(a, q), oracle.dot(b, q)
        return oracle.sign_of_roots([(left, oracle.dot(b, b)), (-right, oracle.dot(a, a))]) > 0

    for query, v in zip(QUERIES, found.tolist(), strict=True):
        q, want = oracle.whole(query), 0
        for i in range(1, len(whole)):
            if is_nearer(q, whole[i], whole[want]):
                want = i
        assert v == want, query


def test_queries_in_degrees_radians_and_any_shape():
    corners = [(170, 0), (-170, 0), (180, 10), (180, -10)]
    mesh = sphere.Delaunay(lonlat=corners)
    turned = sphere.Delaunay(lonlat=np.radians(corners), degrees=False)
    queries = np.array([[(180, 1), (-180, 1), (540, 1)], [(0, 0), (171, 0), (175, 9)]])
    found = mesh.find_simplex(queries)
    assert found.shape == (2, 3)
    assert (found[0] == found[0, 0]).all()
    assert (found >= 0).tolist() == [[True, True, True], [False, True, False]]
    inside = turned.find_simplex(np.radians(queries)) >= 0
    assert np.array_equal(inside, found >= 0)
    assert mesh.find_simplex((180, 1)).shape == ()
    assert np.array_equal(mesh.nearest(np.empty((0, 2))), np.empty(0, dtype=np.int32))


def test_queries_without_a_direction_have_no_answer():
    mesh = sphere.Delaunay(xyz=OCTAHEDRON)
    queries = [(0.0, 0.0, 0.0), (np.nan, 1.0, 1.0), (np.inf, 1.0, 1.0), (1.0, 2.0, 3.0)]
    assert (mesh.find_simplex(queries) >= 0).tolist() == [False, False, False, True]
    assert mesh.nearest(queries).tolist() == [-1, -1, -1, 4]


def test_many_queries_by_several_workers_are_the_same():
    rng = np.random.default_rng(5)
    vectors, queries = rng.normal(size=(3000, 3)), rng.normal(size=(40_000, 3))
    one, three = (sphere.Delaunay(xyz=vectors, workers=k) for k in (1, 3))
    assert np.array_equal(one.find_simplex(queries), three.find_simplex(queries))
    nearest = one.nearest(queries)
    assert np.array_equal(nearest, three.nearest(queries))
    best = (queries[::100] @ one.points.T).max(axis=1)
    assert np.allclose((queries * one.points[nearest]).sum(axis=1)[::100], best, rtol=1e-12)


def test_edges_and_boundary():
    mesh = sphere.Delaunay(xyz=OCTAHEDRON)
    pairs = [(i, j) for i, j in itertools.combinations(range(6), 2) if i // 2 != j // 2]
    assert mesh.edges.tolist() == [list(pair) for pair in pairs]
    assert mesh.boundary.shape == (0, 2)
    half = sphere.Delaunay(xyz=OCTAHEDRON[:5])
    assert half.nsimplex == 4
    # Counter-clockwise around the pole that is there.
    assert sorted(half.boundary.tolist()) == [[0, 2], [1, 3], [2, 1], [3, 0]]


def test_areas_of_solids():
    octants = sphere.Delaunay(xyz=OCTAHEDRON).areas
    assert np.allclose(octants, np.pi / 2, rtol=1e-15)
    cube = sphere.Delaunay(xyz=list(itertools.product((-1, 1), repeat=3))).areas
    assert np.allclose(cube, np.pi / 3, rtol=1e-15)
    # Three on the equator nearly, seen from the pole: a hemisphere nearly.
    wide = [(1, 0, 1e-9), (-0.5, 3**0.5 / 2, 1e-9), (-0.5, -(3**0.5) / 2, 1e-9)]
    assert sphere.Delaunay(xyz=wide).areas[0] == pytest.approx(2 * np.pi, rel=1e-8)
    rng = np.random.default_rng(2)
    assert sphere.Delaunay(xyz=rng.normal(size=(5000, 3))).areas.sum() == pytest.approx(4 * np.pi)


@pytest.mark.parametrize("height", [1e-3, 1e-9, 1e-16, 1e-18, 1e-30, 1e-200])
def test_areas_of_slivers(height):
    # A long side on the equator and an apex next to its middle: twice the tangent of half the area
    # is height times a known factor.
    vectors = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, height)]
    (area,) = sphere.Delaunay(xyz=vectors).areas
    # The determinant is height / |c|, and 1 + ab + bc + ca is 1 + 2 / |c| for unit vectors.
    length = float(np.sqrt(2 + height * height))
    want = 2 * np.arctan2(height / length, 1 + 2 / length)
    assert area == pytest.approx(want, rel=1e-14)


def test_areas_of_slivers_of_neighboring_doubles():
    # Near a great circle that is not a coordinate plane, to one unit in the last place.
    a, b = np.array([0.3, 0.4, 0.5]), np.array([-0.2, 0.7, 0.1])
    c = a + b
    for step in range(1, 40):
        moved = c.copy()
        moved[step % 3] += step * 1.1e-16
        det = oracle.det(*(oracle.whole(v) for v in (a, b, moved)))
        if not det:
            continue
        scales = [
            next(Fraction(x) / y for x, y in zip(v, oracle.whole(v), strict=True) if y)
            for v in (a, b, moved)
        ]
        exact = float(abs(det) * scales[0] * scales[1] * scales[2])
        lengths = [np.linalg.norm(v) for v in (a, b, moved)]
        u, v, w = (x / n for x, n in zip((a, b, moved), lengths, strict=True))
        want = 2 * np.arctan2(exact / np.prod(lengths), 1 + u @ v + v @ w + w @ u)
        (area,) = sphere.Delaunay(xyz=[a, b, moved]).areas
        assert area == pytest.approx(want, rel=1e-13)


def test_circumcenters_are_equally_far():
    rng = np.random.default_rng(6)
    for scale in (1.0, 1e-6, 1e-9):
        vectors = np.array([0.2, 0.5, -0.4]) + scale * rng.normal(size=(200, 3))
        mesh = sphere.Delaunay(xyz=vectors)
        assert np.allclose(np.linalg.norm(mesh.circumcenters, axis=1), 1, rtol=1e-15)
        corners = mesh.points[mesh.simplices]
        away = np.linalg.norm(corners - mesh.circumcenters[:, None], axis=2)
        # Rounded directions are 1e-16 off, and thin triangles have far centers.
        assert np.all(np.ptp(away, axis=1) < 1e-15)
        assert np.all((corners[:, 0] * mesh.circumcenters).sum(axis=1) > 0)
    octants = sphere.Delaunay(xyz=OCTAHEDRON)
    assert np.allclose(np.abs(octants.circumcenters), 3**-0.5, rtol=1e-15)
