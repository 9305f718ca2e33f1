"""The nearest point of a boundary in space, convex or not, against every face in rationals."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import DegenerateInputError, Delaunay, improve
from rational import exact, from_triangle, minus

if TYPE_CHECKING:
    from numpy.typing import NDArray


def check(points: Any, queries: NDArray[np.float64]) -> None:
    """The nearest point to a rounding of the hull's size; the same face in any order of queries."""
    mesh = Delaunay(points)
    place = mesh.locate(queries)
    assert (mesh.locate(queries[::-1]).facet[::-1] == place.facet).all()
    sites = exact(mesh.points)
    size = max(abs(x) for p in sites for x in p)
    for row in np.flatnonzero(place.simplex < 0):
        q, found = exact([queries[row], place.closest[row]])
        faces = mesh.convex_hull.tolist()
        _, nearest = min(from_triangle(q, [sites[v] for v in face]) for face in faces)
        assert max(map(abs, minus(found, nearest))) <= size * Fraction(1, 2**51)


CUBE = [*product((-2.0, 2.0), repeat=3), (0.0, 0.0, 0.0)]


@pytest.mark.parametrize("far", [3.0, 1e6, 1e12, 1e18, 1e100, 1e300])
@pytest.mark.sampled(1)
def test_far_away(far: float) -> None:
    """Rounded distances tell nothing there: the answer was once on the far side of the hull."""
    directions = [q for q in product((-1.0, -0.3, 0.0, 0.7), repeat=3) if any(q)]
    check(CUBE, np.array(directions) * far)
    check(np.random.default_rng(7).random((60, 3)), np.array(directions) * far)


def test_faces_whose_distances_are_one_double() -> None:
    """Two faces at nearly a right angle, where the farther one's distance rounds to the same."""
    check([(0, 1, 0), (1e-9, 0, 1), (0, 0, 0), (-1, -1, -1)], np.array([(1.0, 0, 0)]))


def check_part(points: Any, kept: Any, queries: NDArray[np.float64]) -> None:
    """The same of some of the tetrahedra: of several faces that are nearest, the first one."""
    whole = Delaunay(np.unique(np.array(points, dtype=float) + 0.0, axis=0))
    rows = np.flatnonzero(np.resize(np.array(kept), whole.nsimplex))
    mesh = improve((whole.points, whole.simplices[rows]), max_iter=0)
    place = mesh.locate(queries)
    assert (mesh.locate(queries[::-1]).facet[::-1] == place.facet).all()
    assert (place.simplex == mesh.find_simplex(queries)).all()
    sites = exact(mesh.points)
    used = [sites[v] for v in np.unique(mesh.simplices)]
    size = max(abs(x) for p in used for x in p)
    for row in np.flatnonzero(place.simplex < 0):
        q, found = exact([queries[row], place.closest[row]])
        faces = mesh.boundary.tolist()
        feet = [from_triangle(q, [sites[v] for v in face]) for face in faces]
        first = min(range(len(faces)), key=lambda i: feet[i][0])
        assert place.facet[row].tolist() == faces[first]
        off = max(map(abs, minus(found, feet[first][1])))
        assert off <= size * Fraction(1, 2**51) + Fraction(5e-324)


# Which tetrahedra there are, again and again; never none.
KEPT = st.lists(st.booleans(), max_size=8).map(lambda rest: [True, *rest])
STAR = [True] * 6 + [False] * 6


@pytest.mark.parametrize("far", [3.0, 1e6, 1e8, 1e12, 1e18, 1e100, 1e300])
@pytest.mark.sampled(1)
def test_far_away_from_what_is_not_convex(far: float) -> None:
    """Half of a cube about its centre: the answer was on the far side from 1e8 sizes on."""
    directions = [q for q in product((-1.0, -0.3, 0.0, 0.7), repeat=3) if any(q)]
    check_part(CUBE, STAR, np.array(directions) * far)
    cloud = np.random.default_rng(7).random((24, 3))
    check_part(cloud, [True, False, True, False, False], np.array(directions) * far)


@pytest.mark.parametrize("size", [1e-320, 1e-300, 1.0, 1e300])
def test_every_second_tetrahedron_of_a_grid(size: float) -> None:
    grid = np.array(list(product((0.0, 1.0, 2.0), repeat=3)))
    queries = [(1e7, 0.9, 0.6), (1e8, 0.5, 0.2), (1.0, 9.0, 1.0), (-3.0, -3.0, -3.0), (0, 7, 1)]
    check_part(grid * size, [True, False], np.array(queries) * size)
    check_part(grid * size, [True, False], np.array([(1.7e308, 0.0, 0.0), (1e300, -1e300, 0)]))


def test_the_nearest_of_equally_distant_walls_is_the_first() -> None:
    """From the middle of a hollow cube all six walls are as far, from beside it one is not."""
    grid = np.array(list(product(range(4), repeat=3)), dtype=float)
    whole = Delaunay(grid)
    middles = whole.points[whole.simplices].mean(axis=1)
    kept = (np.abs(middles - 1.5) > 0.5).any(axis=1)
    near = [(1.5, 1.5, 1.5), (1.5 + 2**-52, 1.5, 1.5), (1.5, 1.5, 1.5 - 2**-52), (1.25, 1.5, 1.75)]
    check_part(grid, kept, np.array(near))


@given(
    st.lists(st.tuples(*[st.integers(0, 3)] * 3), min_size=4, max_size=10),
    KEPT,
    st.lists(st.tuples(*[st.integers(-4, 8)] * 3), min_size=1, max_size=5),
    st.sampled_from([0, -1074, -500, 500, 900]),
    st.sampled_from([0, 20, 60, 120]),
)
def test_parts_of_lattices(
    points: list[Any], kept: list[bool], queries: list[Any], power: int, far: int
) -> None:
    """Ties of every kind, from near by and from afar."""
    try:
        check_part(np.array(points) * 2.0**power, kept, np.array(queries) * 2.0**power * 2.0**far)
    except DegenerateInputError:
        return


@given(
    st.lists(st.tuples(*[st.integers(0, 3)] * 3), min_size=4, max_size=12),
    st.lists(st.tuples(*[st.integers(-4, 8)] * 3), min_size=1, max_size=6),
    st.sampled_from([0, -1000, -500, 500, 900]),
)
def test_lattices(points: list[Any], queries: list[Any], power: int) -> None:
    """Queries that lie exactly above edges, corners and diagonals of facets."""
    try:
        check(np.array(points) * 2.0**power, np.array(queries) * 2.0**power)
    except DegenerateInputError:
        return


COORDINATES = st.floats(-1e3, 1e3, allow_subnormal=False)


@given(
    st.lists(st.tuples(*[COORDINATES] * 3), min_size=4, max_size=8),
    st.lists(st.tuples(*[COORDINATES] * 3), min_size=1, max_size=4),
    st.integers(-40, 60),
)
def test_any_doubles(points: list[Any], queries: list[Any], power: int) -> None:
    """Needles, twins, and queries at all distances."""
    try:
        check(points, np.array(queries) * 2.0**power)
    except DegenerateInputError:
        return


@given(
    st.lists(st.tuples(*[COORDINATES] * 3), min_size=4, max_size=8),
    KEPT,
    st.lists(st.tuples(*[COORDINATES] * 3), min_size=1, max_size=4),
    st.integers(-40, 60),
)
def test_parts_at_any_doubles(
    points: list[Any], kept: list[bool], queries: list[Any], power: int
) -> None:
    """Needles that stand alone, and queries at all distances."""
    try:
        check_part(points, kept, np.array(queries) * 2.0**power)
    except DegenerateInputError:
        return
