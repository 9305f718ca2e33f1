"""The nearest point of a convex boundary in space, against every face in rationals."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import DegenerateInputError, Delaunay
from rational import exact, from_triangle, minus

if TYPE_CHECKING:
    from numpy.typing import NDArray


def check(points: Any, queries: NDArray[np.float64]) -> None:
    """The nearest point to a rounding of the hull's size; the same face in any order of queries."""
    mesh = Delaunay(points)
    place = mesh.locate(queries)
    assert (mesh.locate(queries[::-1]).face[::-1] == place.face).all()
    sites = exact(mesh.points)
    size = max(abs(x) for p in sites for x in p)
    for row in np.flatnonzero(place.simplex < 0):
        q, found = exact([queries[row], place.nearest[row]])
        faces = mesh.convex_hull.tolist()
        _, nearest = min(from_triangle(q, [sites[v] for v in face]) for face in faces)
        assert max(map(abs, minus(found, nearest))) <= size * Fraction(1, 2**51)


CUBE = [*product((-2.0, 2.0), repeat=3), (0.0, 0.0, 0.0)]


@pytest.mark.parametrize("far", [3.0, 1e6, 1e12, 1e18, 1e100, 1e300])
def test_far_away(far: float) -> None:
    """Rounded distances tell nothing there: the answer was once on the far side of the hull."""
    directions = [q for q in product((-1.0, -0.3, 0.0, 0.7), repeat=3) if any(q)]
    check(CUBE, np.array(directions) * far)
    check(np.random.default_rng(7).random((60, 3)), np.array(directions) * far)


def test_faces_whose_distances_are_one_double() -> None:
    """Two faces at nearly a right angle, where the farther one's distance rounds to the same."""
    check([(0, 1, 0), (1e-9, 0, 1), (0, 0, 0), (-1, -1, -1)], np.array([(1.0, 0, 0)]))


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
