"""Laplace weights in space where doubles do not tell them: by the hull, twins, lattices, scales."""

from __future__ import annotations

import itertools
import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from delone import DegenerateInputError, Delaunay
from delone.interpolate import NaturalNeighbor
from delone.reference import natural_weights, orient3d

CORPUS = Path(__file__).parents[1] / "corpus" / "space"
INCLINED = np.array([(0, 0, 0), (0, 2, 1), (1, 1, 2), (2, 0, 1), (2, 2, 2)], dtype=float)
SITES = (
    np.array([(6, 30, 5), (15, 86, 97), (97, 85, 21), (98, 2, 88), (1, 57, 46), (60, 40, 50)]) / 100
)


def weights(points: Any, query: Any) -> Any:
    table = NaturalNeighbor(points, kind="laplace").weights_at(query)
    assert np.min(table.weights, initial=0) >= 0
    full = np.zeros(len(points))
    full[table.indices] = table.weights
    return full


def expected(mesh: Delaunay, query: Any) -> Any:
    """The definition in fractions; on the hull at a place that is a little further inside."""
    points = mesh.points.tolist()
    place = [Fraction(x) for x in query.tolist()]
    if any(orient3d(*(points[v] for v in face), place) == 0 for face in mesh.convex_hull):
        middle = [sum(map(Fraction, axis)) / len(points) for axis in zip(*points, strict=True)]
        place = [x + (m - x) / 2**200 for x, m in zip(place, middle, strict=True)]
    exact = natural_weights(points, place, kind="laplace")
    return np.array([float(exact.get(row, 0)) for row in range(len(points))])


def agree(points: Any, query: Any) -> None:
    """Compare with the definition where the query is in the hull."""
    try:
        mesh = Delaunay(points)
    except DegenerateInputError:
        return
    if mesh.find_simplex(query) < 0:
        return
    found = weights(points, query)
    np.testing.assert_allclose(found, expected(mesh, query), rtol=0, atol=1e-11)
    # By Fractions, as differences of what is far apart and sums of what is large have no doubles.
    exact = [[Fraction(x) for x in row] for row in (*points.tolist(), query.tolist())]
    size = max(abs(x - o) for row in exact for x, o in zip(row, exact[-1], strict=True))
    for k in range(3):
        mean = sum(
            Fraction(w) * (row[k] - exact[-1][k]) for w, row in zip(found, exact, strict=False)
        )
        assert abs(mean) <= size * Fraction(1e-11)


def test_just_inside_of_faces_with_several_spheres() -> None:
    agree(INCLINED, np.array((0.900234050015268, 1.6768237683578744, 1.2885289091865713)))


@given(st.integers(0, 2**32 - 1), st.integers(-60, -1), st.integers(-1000, 900))
def test_beside_the_hull(seed: int, exponent: int, scale: int) -> None:
    rng = np.random.default_rng(seed)
    points = np.unique(rng.integers(0, 3, (int(rng.integers(5, 14)), 3)), axis=0).astype(float)
    try:
        mesh = Delaunay(points)
    except DegenerateInputError:
        return
    face = points[mesh.convex_hull[rng.integers(len(mesh.convex_hull))]]
    query = rng.dirichlet((1, 1, 1)) @ face
    query += np.ldexp(1.0, exponent) * (points.mean(axis=0) - query)
    agree(np.ldexp(points, scale), np.ldexp(query, scale))


@given(
    st.integers(0, 2**32 - 1),
    st.integers(0, 3),
    st.lists(st.integers(-2, 2), min_size=3, max_size=3),
)
def test_within_units_in_the_last_place_of_vertices_edges_and_faces(
    seed: int, corners: int, steps: list[int]
) -> None:
    rng = np.random.default_rng(seed)
    lattice = rng.random() < 0.5
    points = rng.integers(0, 3, (12, 3)).astype(float) if lattice else rng.random((12, 3))
    points = np.unique(points, axis=0)
    try:
        mesh = Delaunay(points)
    except DegenerateInputError:
        return
    simplex = mesh.simplices[rng.integers(mesh.nsimplex)]
    shares = rng.dirichlet(np.ones(corners + 1))
    query = shares @ points[rng.permutation(simplex)[: corners + 1]]
    for k, step in enumerate(steps):
        for _ in range(abs(step)):
            query[k] = np.nextafter(query[k], step * np.inf)
    agree(points, query)


@given(
    st.lists(
        st.tuples(
            st.lists(st.floats(-1, 1), min_size=3, max_size=3),
            st.floats(-20, -3),
            st.integers(0, 5),
        ),
        min_size=1,
        max_size=4,
    ),
    st.lists(st.floats(0.05, 0.95), min_size=3, max_size=3),
)
@example([([0.0, 0.0, 0.0], -3.0, 5)], [0.5, 0.5, 0.4])
def test_of_twins_at_any_gap(
    twins: list[tuple[list[float], float, int]], place: list[float]
) -> None:
    further = [np.nextafter(SITES[i], 1) + 10.0**gap * np.array(way) for way, gap, i in twins]
    agree(np.unique(np.vstack((SITES, further)), axis=0), np.array(place))


@given(
    st.integers(-1074, -20),
    st.integers(-1000, 960),
    st.lists(st.booleans(), min_size=3, max_size=3),
    st.integers(0, 3),
)
@example(-476, -199, [True, False, True], 0)
@example(-476, -199, [True, False, True], 1)
@example(-476, -199, [True, False, True], 2)
@example(-476, -199, [True, False, True], 3)
@pytest.mark.deep
def test_of_twins_far_closer_than_doubles_tell_elsewhere(
    exponent: int, scale: int, axes: list[bool], place: int
) -> None:
    """Beside the origin a site may have another at any distance."""
    assume(any(axes))
    gap = np.ldexp(1.0, max(exponent, -1074 - scale))
    cube = np.array(list(itertools.product((-1, 0, 1), repeat=3)), dtype=float)
    points = np.vstack((cube, gap * np.array(axes)))
    query = ((0.5, 0.5, 0.25), (0.25, -0.5, 0), (gap / 2, gap, gap), (0.5, 1, 0.25))[place]
    agree(np.ldexp(points, scale), np.ldexp(np.array(query), scale))


@given(st.integers(0, 2**32 - 1), st.floats(-18, -2))
def test_needles_and_sheets(seed: int, exponent: float) -> None:
    rng = np.random.default_rng(seed)
    shape = np.where(rng.random(3) < 0.5, 1.0, 10.0**exponent)
    points = rng.random((10, 3)) * shape
    agree(points, rng.dirichlet(np.ones(10)) @ points)


@given(st.integers(0, 2**32 - 1))
def test_of_magnitudes_far_apart(seed: int) -> None:
    rng = np.random.default_rng(seed)
    bits = rng.integers(-200, 200, (9, 3))
    points = np.unique(np.ldexp(rng.uniform(-1, 1, (9, 3)), bits), axis=0)
    agree(points, np.ldexp(rng.uniform(-1, 1, 3), rng.integers(-200, 200)))


@given(st.integers(0, 2**32 - 1))
def test_inside_of_spheres_with_many_sites(seed: int) -> None:
    rng = np.random.default_rng(seed)
    signs = np.array(list(itertools.product((-1, 1), repeat=3)))
    orbit = {tuple(s * np.array(p)) for p in itertools.permutations((1, 4, 8)) for s in signs}
    points = rng.permutation(np.array(sorted(orbit), dtype=float))[:14]
    query = rng.integers(-64, 65, 3) / 8
    agree(points, query)


@pytest.mark.parametrize("path", sorted(CORPUS.glob("*.json")), ids=lambda path: path.stem)
@pytest.mark.sampled(3)
def test_on_the_corpus(path: Path) -> None:
    points = np.array(json.loads(path.read_text(encoding="utf-8"))["points"], dtype=float)
    # The definition is of distinct sites.
    points = np.unique(points, axis=0)
    rng = np.random.default_rng(0)
    for _ in range(20):
        corners = rng.permutation(points)[:4]
        agree(points, rng.dirichlet(np.ones(4)) @ corners)
        agree(points, rng.dirichlet(np.ones(3)) @ corners[:3])


def test_on_faces_of_the_hull_the_areas_in_their_planes_count() -> None:
    square = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (4, 4, 0), (1, 2, 0)]
    points = np.array([*square, (2, 2, 5)], dtype=float)
    turn = np.array([(2, -2, 1), (1, 2, 2), (2, 1, -2)], dtype=float)  # thrice an isometry
    sibson = NaturalNeighbor(np.array(square, dtype=float)[:, :2], kind="sibson")
    for place in ((2.0, 2.0, 0.0), (3.0, 2**-30, 0.0), (2**-40, 1.0, 0.0), (1.0, 2 + 2**-50, 0.0)):
        table = sibson.weights_at(place[:2])
        wanted = np.zeros(6)
        wanted[table.indices] = table.weights
        query = np.array(place)
        np.testing.assert_allclose(weights(points, query), wanted, rtol=0, atol=1e-12)
        np.testing.assert_allclose(weights(points @ turn, query @ turn), wanted, rtol=0, atol=1e-12)
