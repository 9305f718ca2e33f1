from __future__ import annotations

import random
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from delone.errors import CrossingSegmentsError, DegenerateInputError, InputError
from delone.reference import (
    ConstrainedTriangulation,
    bowyer_watson,
    constrained_delaunay,
    incircle_canonical,
    orient,
)
from delone.testing import ConstrainedArrays, assert_constrained_delaunay

Points = list[tuple[int, int]]
Segments = list[tuple[int, int]]
POINTS = st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=3, max_size=16)
ENDS = st.lists(st.tuples(st.integers(0, 15), st.integers(0, 15)), max_size=6)
KITE = [(0, 0), (2, -1), (4, 0), (2, 1)]
SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2)]


def proper(points: Points, s: tuple[int, int], t: tuple[int, int]) -> bool:
    (a, b), (c, d) = ((points[end] for end in segment) for segment in (s, t))
    return orient(a, b, c) * orient(a, b, d) < 0 and orient(c, d, a) * orient(c, d, b) < 0


def plain(points: Points, segments: Segments) -> Segments:
    """The segments with indices in range, without those that cross an earlier one."""
    kept: Segments = []
    for u, v in segments:
        segment = (u % len(points), v % len(points))
        if not any(proper(points, segment, other) for other in kept):
            kept.append(segment)
    return kept


def answer(points: Points, segments: Segments) -> ConstrainedTriangulation:
    try:
        return constrained_delaunay(points, segments)
    except DegenerateInputError:
        assume(False)
        raise


def sees(points: Points, segments: list[tuple[int, int]], a: object, b: object) -> bool:
    """Whether no segment separates two points."""
    for u, v in segments:
        c, d = points[u], points[v]
        if orient(a, b, c) * orient(a, b, d) < 0 and orient(c, d, a) * orient(c, d, b) < 0:  # type: ignore[arg-type]
            return False
    return True


@given(POINTS, ENDS)
def test_the_assertion_accepts_it(points: Points, segments: Segments) -> None:
    segments = plain(points, segments)
    made = answer(points, segments)
    assert_constrained_delaunay(ConstrainedArrays.of(points, *made), segments)


@given(POINTS, ENDS)
def test_no_point_that_is_seen_is_inside_a_circle(points: Points, segments: Segments) -> None:
    """The definition, for all points: seen from inside the triangle, ties broken."""
    segments = plain(points, segments)
    made = answer(points, segments)
    for triangle in made.triangles:
        corners = [points[v] for v in triangle]
        middle = tuple(sum(c[k] for c in corners) for k in (0, 1))
        # Three times everything, so that the middle is on the lattice, too.
        tripled = [(3 * x, 3 * y) for x, y in points]
        for point in set(points) - set(corners):
            hidden = not sees(tripled, list(made.sources), middle, (3 * point[0], 3 * point[1]))
            assert hidden or incircle_canonical(*corners, point) < 0


@given(POINTS)
def test_without_segments_it_is_delaunay(points: Points) -> None:
    assert answer(points, []) == (bowyer_watson(points), {})


@given(POINTS, ENDS, st.randoms(use_true_random=False))
def test_order_does_not_matter(points: Points, segments: Segments, rng: random.Random) -> None:
    segments = plain(points, segments)
    made = answer(points, segments)
    turned = [segment[:: rng.choice((1, -1))] for segment in segments]
    order = rng.sample(range(len(segments)), len(segments))
    shuffled = constrained_delaunay(points, [turned[row] for row in order])
    assert shuffled.triangles == made.triangles
    assert {
        edge: sorted(order[row] for row in rows) for edge, rows in shuffled.sources.items()
    } == (made.sources)


@given(POINTS, ENDS)
def test_demanding_an_edge_that_is_there_changes_nothing(
    points: Points, segments: Segments
) -> None:
    segments = plain(points, segments)
    made = answer(points, segments)
    edges = sorted({(u, v) for t in made.triangles for u, v in pairwise((*t, t[0]))})
    assert constrained_delaunay(points, segments + edges).triangles == made.triangles


def test_a_long_segment_through_many_edges() -> None:
    rng = random.Random(3)
    points = [(rng.randrange(1, 999), rng.randrange(1000)) for _ in range(250)]
    points += [(0, 500), (1000, 499)]
    segments = [(250, 251)]
    made = constrained_delaunay(points, segments)
    assert list(made.sources) == [(250, 251)]
    assert_constrained_delaunay(ConstrainedArrays.of(points, *made), segments)


def test_vertices_on_segments_split_them() -> None:
    points = [*SQUARE, (1, 1), (1, 1)]
    made = constrained_delaunay(points, [(2, 0), (4, 5), (0, 5), (1, 1), (0, 2)])
    assert made.sources == {(0, 4): [0, 2, 4], (2, 4): [0, 4]}
    assert {v for t in made.triangles for v in t} == {0, 1, 2, 3, 4}


def test_overlapping_segments_share_pieces() -> None:
    points = [(0, 0), (1, 0), (2, 0), (3, 0), (0, 3)]
    made = constrained_delaunay(points, [(0, 2), (3, 1)])
    assert made.sources == {(0, 1): [0], (1, 2): [0, 1], (2, 3): [1]}


def test_crossing_segments_are_named_with_their_places() -> None:
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 2), (0.25, -1)]
    with pytest.raises(CrossingSegmentsError, match=r"5 pairs .*\(0, 1\)") as caught:
        constrained_delaunay(points, [(0, 2), (3, 1), (4, 5), (1, 3)])
    assert caught.value.pairs.tolist() == [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]]
    half, on_rise, on_fall = [0.5, 0.5], [4 / 11, 4 / 11], [5 / 13, 8 / 13]
    assert caught.value.points.tolist() == [half, on_rise, half, on_fall, on_fall]


def test_a_crossing_at_a_vertex_is_none() -> None:
    made = constrained_delaunay([*SQUARE, (1, 1)], [(0, 2), (1, 3)])
    assert made.sources == {(0, 4): [0], (1, 4): [1], (2, 4): [0], (3, 4): [1]}


@given(POINTS, ENDS)
def test_crossings_are_those_of_a_direct_search(points: Points, segments: Segments) -> None:
    segments = [(u % len(points), v % len(points)) for u, v in segments]

    def at_vertex(s: tuple[int, int], t: tuple[int, int]) -> bool:
        return any(
            orient(points[s[0]], points[s[1]], p) == orient(points[t[0]], points[t[1]], p) == 0
            for p in points
        )

    wanted = [
        [i, j]
        for i, s in enumerate(segments)
        for j, t in enumerate(segments)
        if i < j and proper(points, s, t) and not at_vertex(s, t)
    ]
    try:
        answer(points, segments)
        found = []
    except CrossingSegmentsError as error:
        found = error.pairs.tolist()
        for (i, j), place in zip(found, error.points.tolist(), strict=True):
            for end in (segments[i], segments[j]):
                (ax, ay), (bx, by) = (points[v] for v in end)
                off = (bx - ax) * (place[1] - ay) - (by - ay) * (place[0] - ax)
                assert abs(off) < 1e-12
    assert found == wanted


def test_rows_that_are_not_there_are_refused() -> None:
    with pytest.raises(InputError, match=r"segment 1 .* \[0, 4\]"):
        constrained_delaunay(KITE, [(0, 2), (0, 4)])
    with pytest.raises(InputError, match="segment 0"):
        constrained_delaunay(KITE, np.array([(-1, 2)]))


def test_a_kite_gets_its_longer_diagonal() -> None:
    assert constrained_delaunay(KITE, np.array([(2, 0)])).triangles == [(0, 1, 2), (0, 2, 3)]
