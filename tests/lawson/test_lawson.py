"""Flips from triangulations of all kinds end in the Delaunay triangulation; angles as proven."""

from __future__ import annotations

import dataclasses
import math
import random
import sys
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, reject
from hypothesis import strategies as st

from delone import Delaunay, LawsonResult, datasets, lawson, predicates
from delone.errors import (
    DegenerateInputError,
    DtypeError,
    InputError,
    LimitError,
    NonFiniteError,
    ShapeError,
)
from delone.reference import lawson as reference_lawson
from delone.reference import orient
from delone.testing import assert_delaunay, triangle_set

if TYPE_CHECKING:
    from numpy.typing import NDArray

Triangle = tuple[int, int, int]
Triangles = list[Triangle]
Points = list[tuple[float, float]]

DOUBLE = st.floats(allow_nan=False, allow_infinity=False)
LATTICE = st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=3, max_size=30)
DOUBLES = st.lists(st.tuples(DOUBLE, DOUBLE), min_size=3, max_size=10)
UNIT = st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1)), min_size=3, max_size=20)
POINTS = st.one_of(LATTICE, DOUBLES, UNIT)
SEEDS = st.integers(0, 2**32)
SQUARE = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (1.0, 0.5)]


def swept(points: Points) -> Triangles:
    """A triangulation with slivers: each point, from left to right, joined to what it sees."""
    first = {point: row for row, point in reversed(list(enumerate(points)))}
    rows = [first[point] for point in sorted(first)]
    turns = (k for k in range(2, len(rows)) if orient(*(points[rows[i]] for i in (0, 1, k))))
    turned = next(turns, None)
    if turned is None:
        reject()
    chain, apex = rows[:turned], rows[turned]
    if orient(points[chain[0]], points[chain[1]], points[apex]) < 0:
        chain.reverse()
    triangles = [(u, v, apex) for u, v in pairwise(chain)]
    hull = [*chain, apex]
    for row in rows[turned + 1 :]:
        seen = [
            orient(points[u], points[v], points[row]) < 0
            for u, v in zip(hull, [*hull[1:], hull[0]], strict=True)
        ]
        # The edges that are seen follow each other: turn the hull so that they come first.
        start = next(k for k in range(len(hull)) if seen[k] and not seen[k - 1])
        hull = hull[start:] + hull[:start]
        count = sum(seen)
        chain = [*hull, hull[0]][: count + 1]
        triangles += [(v, u, row) for u, v in pairwise(chain)]
        hull = [hull[0], row, *hull[count:]]
    return triangles


def shuffled(points: Points, triangles: Triangles, seed: int, times: int) -> Triangles:
    """Any triangulation: edges flipped at random wherever the quadrilateral is strictly convex."""
    rng = random.Random(seed)
    apex: dict[tuple[int, int], int] = {}
    for a, b, c in triangles:
        apex[a, b], apex[b, c], apex[c, a] = c, a, b
    edges = list(apex)
    for _ in range(times):
        u, v = rng.choice(edges)
        if (u, v) not in apex or (v, u) not in apex:
            continue  # flipped away, or on the hull
        p, q = apex[u, v], apex[v, u]
        if all(orient(*(points[i] for i in t)) > 0 for t in ((p, u, q), (q, v, p))):
            del apex[u, v], apex[v, u]
            for a, b, c in ((p, u, q), (q, v, p)):
                apex[a, b], apex[b, c], apex[c, a] = c, a, b
            edges += [(p, q), (u, q), (q, v)]
    return sorted({min((u, v, p), (v, p, u), (p, u, v)) for (u, v), p in apex.items()})


def fan(n: int, hub: int) -> Triangles:
    return [(hub, (hub + k) % n, (hub + k + 1) % n) for k in range(1, n - 1)]


def around(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points of a circle about the origin in their order round it."""
    return points[np.argsort(np.arctan2(points[:, 1], points[:, 0]))]


def cotangents(points: Points, triangle: Triangle) -> list[Fraction]:
    """The angles as exact numbers that fall as the angle rises."""
    a, b, c = (tuple(map(Fraction, points[v])) for v in triangle)
    twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return [
        ((q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1])) / twice
        for p, q, r in ((a, b, c), (b, c, a), (c, a, b))
    ]


def ascending(points: Points, triangles: Triangles) -> list[Fraction]:
    """What sorts like the sorted angles of some triangles."""
    return sorted(-cot for t in triangles for cot in cotangents(points, t))


def replayed(points: Points, triangles: Triangles, result: LawsonResult) -> list[Triangles]:
    """The triangles before each flip and at the end; each flip must find its two triangles."""
    current = triangle_set(triangles)
    states = [sorted(current)]
    assert result.sequence is not None
    for u, v, p, q in result.sequence.tolist():
        gone = triangle_set([(u, v, p), (v, u, q)])
        assert gone <= current
        current = (current - gone) | triangle_set([(p, u, q), (q, v, p)])
        states.append(sorted(current))
    return states


def check(points: Points, triangles: Triangles) -> LawsonResult:
    """All that holds of flips from `triangles`, exactly."""
    result = lawson(points, triangles, record=True)
    assert_delaunay(points, result.simplices, neighbors=result.neighbors)
    mesh = Delaunay(points)
    assert triangle_set(result.simplices) == triangle_set(mesh.simplices)
    states = replayed(points, triangles, result)
    assert states[-1] == sorted(triangle_set(result.simplices))
    assert result.flips == len(states) - 1
    assert result.sequence is not None and result.angles is not None
    assert result.angles.shape == (result.flips + 1, 3 * len(result.simplices))
    for flip in result.sequence.tolist():
        check_flip(points, flip)
    check_angles(points, states[0], result.angles[0])
    check_angles(points, states[-1], result.angles[-1])
    return result


def check_flip(points: Points, flip: list[int]) -> None:
    """The six angles before and after, exactly."""
    u, v, p, q = flip
    old = ascending(points, [(u, v, p), (v, u, q)])
    new = ascending(points, [(p, u, q), (q, v, p)])
    sign = int(predicates.incircle(*(np.array(points[i], dtype=np.float64) for i in flip)))
    assert sign >= 0
    if sign > 0:
        assert new[0] > old[0]
        return
    # On a tie the angles over the four sides stay, and the other two add up to pi.
    at_u, at_v, _ = cotangents(points, (u, v, p))
    at_v_too, at_u_too, _ = cotangents(points, (v, u, q))
    inscribed = [-at_u, -at_v, -at_u_too, -at_v_too]
    assert new[0] == old[0] == min(inscribed)
    for six in (old, new):
        for angle in inscribed:
            six.remove(angle)
        assert sum(six) == 0


def check_angles(points: Points, triangles: Triangles, row: NDArray[np.float64]) -> None:
    most = Fraction(10**300)
    vector = ascending(points, triangles)
    exact = [math.atan2(1.0, float(-max(min(x, most), -most))) for x in vector]
    assert row.tolist() == pytest.approx(exact, rel=1e-13, abs=1e-299)


@given(POINTS, SEEDS)
def test_any_triangulation_becomes_delaunay(points: Points, seed: int) -> None:
    triangles = shuffled(points, swept(points), seed, 5 * len(points))
    result = check(points, triangles)
    expected, _ = reference_lawson(points, triangles)
    assert sorted(triangle_set(result.simplices)) == sorted(triangle_set(expected))


@given(st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=4, max_size=9), SEEDS)
def test_the_sorted_angles_rise_but_at_ties(points: Points, seed: int) -> None:
    triangles = shuffled(points, swept(points), seed, 30)
    result = lawson(points, triangles, record=True)
    states = replayed(points, triangles, result)
    assert result.sequence is not None and result.angles is not None
    vectors = [ascending(points, state) for state in states]
    for (before, after), flip in zip(pairwise(vectors), result.sequence.tolist(), strict=True):
        tie = predicates.incircle(*(np.array(points[i]) for i in flip)) == 0
        assert after[0] == before[0] if tie else after > before
        assert len(after) == len(before)
    assert [vector[0] for vector in vectors] == sorted(vector[0] for vector in vectors)
    for state, row in zip(states, result.angles, strict=True):
        check_angles(points, state, row)


@pytest.mark.parametrize("hub", range(0, 20, 3))
def test_fans_of_points_on_one_circle_are_all_ties(hub: int) -> None:
    points = around(datasets.pythagorean_circle(20))
    smallest = int(np.lexsort(points.T[::-1])[0])
    result = check([tuple(p) for p in points.tolist()], fan(20, hub))
    assert (result.simplices == smallest).any(axis=1).all()
    # A flip puts at most one more edge on the smallest vertex, from which 17 diagonals go.
    there = 17 if hub == smallest else int(min((hub - smallest) % 20, (smallest - hub) % 20) > 1)
    assert result.flips >= 17 - there


def test_a_fan_of_a_parabola_takes_many_flips() -> None:
    points = [(float(x), float(x * x)) for x in range(-12, 13)]
    result = check(points, fan(25, 0))
    assert result.flips > 25 * 22 / 4 - 25


@pytest.mark.parametrize("rises", [True, False])
def test_at_a_tie_the_vector_may_rise_or_fall(rises: bool) -> None:
    third, fourth = ((4.0, -3.0), (-4.0, 3.0)) if rises else ((0.0, -5.0), (5.0, 0.0))
    points = [(-4.0, -3.0), (-3.0, -4.0), third, fourth]
    result = check(points, [(0, 1, 3), (1, 2, 3)])
    assert result.flips == 1 and result.angles is not None
    before, after = result.angles.tolist()
    assert before[0] == after[0]
    assert (after > before) == rises and after != before


def test_lattices_and_clusters() -> None:
    rng = np.random.default_rng(1)
    for points in (
        datasets.grid(49),
        datasets.tilted_grid(49),
        datasets.integer_lattice(60, side=8),
        datasets.near_collinear(30),
        datasets.mixed_exponents(15),
        datasets.duplicates(40),
        rng.standard_normal((50, 2)),
    ):
        rows = [tuple(p) for p in points.tolist()]
        check(rows, swept(rows))


def test_many_points() -> None:
    points = datasets.uniform(30_000, seed=3)
    mesh = Delaunay(points)
    # What tiles the hull of points tiles that of their image under a stretch.
    result = lawson(points, Delaunay(points * [1024, 1]).simplices)
    assert result.flips > 100_000
    assert result.sequence is None and result.angles is None
    assert triangle_set(result.simplices) == triangle_set(mesh.simplices)
    assert_delaunay(points, result.simplices, neighbors=result.neighbors)


def test_hard_inputs(corpus_case: object) -> None:
    points = corpus_case.points  # type: ignore[attr-defined]
    mesh = Delaunay(points)
    result = lawson(points, mesh.simplices)
    assert result.flips == 0
    assert np.array_equal(result.simplices, mesh.simplices)
    assert np.array_equal(result.neighbors, mesh.neighbors)
    rows = [tuple(p) for p in points.tolist()]
    start = shuffled(rows, list(map(tuple, mesh.simplices.tolist())), 5, 300)
    made = lawson(points, start)
    assert triangle_set(made.simplices) == triangle_set(mesh.simplices)
    assert_delaunay(points, made.simplices, neighbors=made.neighbors)


def test_untouched_triangles_keep_their_rows() -> None:
    result = lawson(SQUARE, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)], record=True)
    assert result.flips == 0 and result.sequence is not None and result.angles is not None
    assert result.simplices.tolist() == [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
    assert result.sequence.shape == (0, 4) and result.sequence.dtype == np.int32
    assert result.angles.shape == (1, 12)


def test_a_duplicate_may_be_the_vertex() -> None:
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]
    result = lawson(points, [(4, 1, 3), (1, 2, 3)])
    assert triangle_set(result.simplices) == {(1, 2, 4), (2, 3, 4)}


def test_results_cannot_be_changed() -> None:
    result = lawson(SQUARE[:4], [(0, 1, 3), (1, 2, 3)], record=True)
    assert repr(result) == "<LawsonResult: 2 triangles after 1 flip>"
    with pytest.raises(dataclasses.FrozenInstanceError):
        result.flips = 0  # type: ignore[misc]
    for array in (result.simplices, result.neighbors, result.sequence, result.angles):
        assert array is not None
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


@pytest.mark.parametrize(
    ("triangles", "message"),
    [
        ([(0, 1, 2), (0, 3, 2)], r"simplices\[1\] = \[0, 3, 2\] is not counter-clockwise"),
        ([(0, 1, 1)], r"simplices\[0\] = \[0, 1, 1\] is not counter-clockwise"),
        ([(0, 1, 2), (0, 2, 3)], "point 4 is a vertex of no simplex"),
        ([(0, 1, 4), (1, 2, 4), (0, 4, 3)], "not a convex cycle at the edge"),
        ([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 1, 2)], "0 -> 1 occurs twice"),
        (np.empty((0, 3), dtype=np.int32), "no simplices"),
        ([(0, 1), (1, 2)], "shape"),
    ],
)
def test_what_is_no_triangulation_is_refused(triangles: Triangles, message: str) -> None:
    with pytest.raises(ShapeError, match=message):
        lawson(SQUARE, triangles)


def test_other_errors() -> None:
    nothing = np.empty((0, 3), dtype=np.int32)
    with pytest.raises(DegenerateInputError) as caught:
        lawson([(0, 0), (2, 2), (1, 1)], nothing)
    assert caught.value.chain.tolist() == [0, 2, 1]
    with pytest.raises(DegenerateInputError):
        lawson(np.empty((0, 2)), nothing)
    with pytest.raises(NonFiniteError):
        lawson([(0, 0), (1, 0), (np.nan, 1)], [(0, 1, 2)])
    with pytest.raises(InputError, match="row 0"):
        lawson(SQUARE, [(0, 1, 5)])
    with pytest.raises(DtypeError):
        lawson(SQUARE, [(0.0, 1.0, 2.0)])
    with pytest.raises(DtypeError, match="record must be True or False, got 'a'"):
        lawson(SQUARE[:4], [(0, 1, 3), (1, 2, 3)], record="a")  # type: ignore[arg-type]


def test_records_have_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules["delone.flips"], "_MOST_ANGLES", 11)
    with pytest.raises(LimitError, match="1 flips of 2 triangles have 12 angles"):
        lawson(SQUARE[:4], [(0, 1, 3), (1, 2, 3)], record=True)
    assert lawson(SQUARE[:4], [(0, 1, 3), (1, 2, 3)]).flips == 1
