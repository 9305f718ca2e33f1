"""A segment passes through each vertex whose pixel it meets, whatever other points there are."""

from __future__ import annotations

import json
from fractions import Fraction
from itertools import combinations, pairwise, permutations
from pathlib import Path

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from delone import ConstrainedDelaunay

CORPUS = Path(__file__).parents[1] / "corpus"

Point = tuple[float, float]
Segment = tuple[Point, Point]

# Doubles from one end of their range to the other, so that pixels have all sizes.
SMALL = [0.0, 1.0, -1.0, 3.0, 0.1, 5e-324, -1e-300, 1.1e-160, -7e-12]
LARGE = [2.0**53, 1.06e86, -3e100, 3e100, -1.5e132, 2.09e288, -2.09e288]
COORDINATES = st.sampled_from(SMALL + LARGE) | st.integers(-3, 3).map(float)
CLOSE = st.integers(0, 5).map(lambda i: 2.0**51 + i)
POINTS = st.lists(st.tuples(COORDINATES, COORDINATES), min_size=4, max_size=7, unique=True) | (
    st.lists(st.tuples(CLOSE, st.integers(0, 5).map(float)), min_size=4, max_size=9, unique=True)
)


def read(name: str) -> tuple[np.ndarray, list[list[int]]]:
    case = json.loads((CORPUS / f"{name}.json").read_text(encoding="utf-8"))
    return np.array(case["points"], dtype=float), case["segments"]


def test_a_pixel_behind_another_edge() -> None:
    points, segments = read("pixel-of-a-crossing-behind-an-edge")
    for order in permutations(segments):
        mesh = ConstrainedDelaunay(points, list(order), crossing="split")
        assert mesh.nadded == 1
        found = {tuple(sorted(ends)) for ends in mesh.segments.tolist()}
        assert found == {(0, 6), (1, 5), (1, 6), (2, 6), (4, 6), (5, 6)}


def test_a_pixel_hidden_behind_a_vertex() -> None:
    points, segments = read("pixel-hidden-behind-a-vertex")
    own = list(map(tuple, points.tolist()))
    wanted = snapped(own, segments)
    assert wanted is not None
    assert pieces(own, segments) == wanted
    assert pieces([*own, (3e100, -1.0)], segments) == wanted


@given(POINTS, st.data())
def test_pieces_are_those_of_a_direct_search(points: list[Point], data: st.DataObject) -> None:
    segments = data.draw(ends_among(len(points)))
    assume(is_solid(points))
    wanted = snapped(points, segments)
    assume(wanted is not None)
    assert pieces(points, segments) == wanted


@given(POINTS, st.data())
def test_unrelated_points_change_no_piece(points: list[Point], data: st.DataObject) -> None:
    segments = data.draw(ends_among(len(points)))
    assume(is_solid(points))
    before = pieces(points, segments)
    more = data.draw(st.lists(st.tuples(COORDINATES, COORDINATES), min_size=1, max_size=3))
    own = [(points[a], points[b]) for a, b in segments] + [(p, q) for p, q in map(tuple, before)]
    met = set(points).union(*before)
    far = {p for p in more if p not in met and not any(passes(r, s, p) for r, s in own)}
    assume(far)
    order = data.draw(st.permutations([*points, *sorted(far)]))
    there = [[order.index(points[v]) for v in ends] for ends in segments]
    assert pieces(order, there) == before


def ends_among(count: int) -> st.SearchStrategy[list[list[int]]]:
    rows = st.integers(0, count - 1)
    return st.lists(st.lists(rows, min_size=2, max_size=2, unique=True), min_size=2, max_size=5)


def is_solid(points: list[Point]) -> bool:
    return any(turn(p, q, r) for p, q, r in combinations(points, 3))


def pieces(points: list[Point], segments: list[list[int]]) -> set[frozenset[Point]]:
    """The edges that the segments consist of."""
    mesh = ConstrainedDelaunay(points, segments, crossing="split", planar=True)
    places = [(x + 0.0, y + 0.0) for x, y in mesh.points.tolist()]
    return {frozenset((places[u], places[v])) for u, v in mesh.segments.tolist()}


def snapped(points: list[Point], segments: list[list[int]]) -> set[frozenset[Point]] | None:
    """Return the same by a search of all pairs; None if some of the edges cross once more."""
    given = list(dict.fromkeys(tuple(sorted((points[a], points[b]))) for a, b in segments))
    met: dict[Segment, set[Point]] = {own: set() for own in given}
    for one, other in combinations(given, 2):
        if (x := crossing(one, other)) is not None:
            place = (float(x[0]), float(x[1]))
            is_exact = x == tuple(map(Fraction, place))
            if not (is_exact and place in points):
                met[one].add(place)
                met[other].add(place)
    rounded = set().union(*met.values()) - set(points)
    everything = rounded.union(points)
    found = set()
    for (p, q), own in met.items():
        near = everything if own else rounded
        stops = {v for v in everything if passes(p, q, v) and (v in near or not turn(p, q, v))}
        stops = sorted(stops | own | {p, q}, key=lambda v: (v[0], v[1] if p[1] <= q[1] else -v[1]))
        for u, v in pairwise(stops):
            on = [w for w in everything if is_inside(u, v, w)]
            found |= set(map(frozenset, pairwise(sorted([u, v, *on]))))
    edges = [tuple(sorted(edge)) for edge in found]
    if any(crossing(one, other) is not None for one, other in combinations(edges, 2)):
        return None
    return found


def turn(p: Point, q: Point, r: Point) -> Fraction:
    (px, py), (qx, qy), (rx, ry) = (map(Fraction, v) for v in (p, q, r))
    return (qx - px) * (ry - py) - (qy - py) * (rx - px)


def crossing(one: Segment, other: Segment) -> tuple[Fraction, Fraction] | None:
    """Return where the interiors of two segments cross."""
    (a, b), (c, d) = one, other
    if turn(a, b, c) * turn(a, b, d) >= 0 or turn(c, d, a) * turn(c, d, b) >= 0:
        return None
    share = turn(c, d, a) / (turn(c, d, a) - turn(c, d, b))
    x, y = (Fraction(a[k]) + share * (Fraction(b[k]) - Fraction(a[k])) for k in range(2))
    return x, y


def is_inside(p: Point, q: Point, v: Point) -> bool:
    """Whether v is on a segment, and no end."""
    return v not in (p, q) and in_box(p, q, v) and not turn(p, q, v)


def in_box(p: Point, q: Point, v: Point) -> bool:
    return all(min(p[k], q[k]) <= v[k] <= max(p[k], q[k]) for k in range(2))


def passes(p: Point, q: Point, v: Point) -> bool:
    """Whether a segment meets the points that round to v in one coordinate and have its other."""
    if v in (p, q) or not in_box(p, q, v):
        return False
    if not turn(p, q, v):
        return True
    for k in range(2):
        if p[k] == q[k]:
            return False
        share = (Fraction(v[k]) - Fraction(p[k])) / (Fraction(q[k]) - Fraction(p[k]))
        other = Fraction(p[1 - k]) + share * (Fraction(q[1 - k]) - Fraction(p[1 - k]))
        if float(other) == v[1 - k]:
            return True
    return False
