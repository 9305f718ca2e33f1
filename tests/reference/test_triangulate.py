from __future__ import annotations

import random
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from delone import datasets
from delone.errors import DegenerateInputError, InputError, NonFiniteError, ShapeError
from delone.reference import bowyer_watson, incircle_canonical, lawson, orient
from delone.testing import assert_delaunay, triangle_set

DOUBLE = st.floats(allow_nan=False, allow_infinity=False)
LATTICE = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=3, max_size=40)
DOUBLES = st.lists(st.tuples(DOUBLE, DOUBLE), min_size=3, max_size=12)
UNIT = st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1)), min_size=3, max_size=25)
POINTS = st.one_of(LATTICE, DOUBLES, UNIT)
TEXTBOOK = [(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)]

Triangles = list[tuple[int, int, int]]


def triangulated(points: list[tuple[float, float]]) -> Triangles:
    try:
        return bowyer_watson(points)
    except DegenerateInputError:
        assume(False)
        raise


def as_coordinates(points: list[tuple[float, float]], triangles: Triangles) -> set[object]:
    """Triangles by coordinates, from the smallest on, so that row numbers do not matter."""
    corners = ([points[vertex] for vertex in t] for t in triangles)
    return {tuple(t[(t.index(min(t)) + k) % 3] for k in range(3)) for t in corners}


def sweep(points: list[tuple[float, float]]) -> Triangles:
    """Any triangulation: add the points from left to right to what they see of the hull."""
    rows = sorted({p: row for row, p in reversed(list(enumerate(points)))}.values())
    rows.sort(key=lambda row: points[row])
    turned = next(k for k in range(2, len(rows)) if orient(*(points[rows[i]] for i in (0, 1, k))))
    chain, apex = rows[:turned], rows[turned]
    if orient(points[chain[0]], points[chain[1]], points[apex]) < 0:
        chain.reverse()
    triangles = [(u, v, apex) for u, v in pairwise(chain)]
    hull = [*chain, apex]
    for row in rows[turned + 1 :]:
        edges = list(zip(hull, hull[1:] + hull[:1], strict=True))
        seen = [orient(points[u], points[v], points[row]) < 0 for u, v in edges]
        triangles += [(v, u, row) for (u, v), visible in zip(edges, seen, strict=True) if visible]
        start = next(k for k in range(len(hull)) if seen[k] and not seen[k - 1])
        count = sum(seen)
        turned_hull = hull[start:] + hull[:start]
        hull = [turned_hull[0], row, *turned_hull[count:]]
    return triangles


def test_the_textbook_example() -> None:
    triangles = bowyer_watson(TEXTBOOK)
    assert triangles == [(0, 1, 4), (0, 4, 3), (1, 2, 4), (2, 3, 4)]
    assert_delaunay(TEXTBOOK, triangles)


@given(POINTS)
def test_bowyer_watson_is_delaunay(points: list[tuple[float, float]]) -> None:
    assert_delaunay(points, triangulated(points))


@given(st.one_of(LATTICE, UNIT))
def test_no_point_is_inside_any_circle(points: list[tuple[float, float]]) -> None:
    """The definition itself, for all points and not for neighbours alone, ties broken."""
    for triangle in triangulated(points):
        corners = [points[vertex] for vertex in triangle]
        for point in set(points) - set(corners):
            assert incircle_canonical(*corners, point) < 0


@given(POINTS, st.randoms(use_true_random=False))
def test_order_does_not_matter(points: list[tuple[float, float]], rng: random.Random) -> None:
    wanted = as_coordinates(points, triangulated(points))
    rng.shuffle(points)
    assert as_coordinates(points, bowyer_watson(points)) == wanted


@given(LATTICE, st.integers(-1070, 1000))
def test_scaling_by_powers_of_two_changes_nothing(
    points: list[tuple[int, int]], power: int
) -> None:
    wanted = triangulated(points)
    assert bowyer_watson([(np.ldexp(x, power), np.ldexp(y, power)) for x, y in points]) == wanted


@given(LATTICE, st.integers(-(2**50), 2**50), st.integers(-(2**50), 2**50))
def test_exact_translation_changes_nothing(points: list[tuple[int, int]], dx: int, dy: int) -> None:
    wanted = triangulated(points)
    assert bowyer_watson([(float(x + dx), float(y + dy)) for x, y in points]) == wanted


@given(POINTS)
def test_lawson_reaches_the_same_triangles(points: list[tuple[float, float]]) -> None:
    wanted = triangulated(points)
    start = sweep(points)
    triangles, flips = lawson(points, start)
    assert triangles == wanted
    assert (flips == 0) == (triangle_set(start) == set(wanted))
    assert lawson(points, triangles) == (wanted, 0)


@pytest.mark.parametrize("side", [2, 3, 5, 9])
def test_lattices_draw_the_diagonal_of_the_smallest_corner(side: int) -> None:
    points = [(x, y) for x in range(side) for y in range(side)]
    triangles = bowyer_watson(points)
    assert len(triangles) == 2 * (side - 1) ** 2
    for t in triangles:
        a, b, c = (points[v] for v in t)
        low = min(a, b, c)
        assert {(x - low[0], y - low[1]) for x, y in (a, b, c)} in (
            {(0, 0), (1, 0), (1, 1)},
            {(0, 0), (0, 1), (1, 1)},
        )


def test_an_exact_circle_is_fanned_from_its_smallest_point() -> None:
    points = datasets.pythagorean_circle(36)
    smallest = int(np.lexsort((points[:, 1], points[:, 0]))[0])
    triangles = bowyer_watson(points)
    assert len(triangles) == 34
    assert all(smallest in t for t in triangles)


@pytest.mark.parametrize("name", sorted(datasets.GENERATORS))
def test_every_generator(name: str) -> None:
    points = datasets.GENERATORS[name](120, seed=2)
    assert_delaunay(points, bowyer_watson(points))


def test_fractions_need_no_float() -> None:
    points = [(Fraction(x, 3), Fraction(y, 7)) for x, y in TEXTBOOK]
    assert len(bowyer_watson(points)) == 4


def test_duplicates_map_to_their_first_row() -> None:
    triangles = bowyer_watson([(0.0, 0), (1, 0), (-0.0, 0), (0, 1), (1, 0), (0, 1)])
    assert triangles == [(0, 1, 3)]


def test_degenerate_cases(degenerate_case: tuple[str, np.ndarray, str, str]) -> None:
    _, points, _, reason = degenerate_case
    with pytest.raises(DegenerateInputError) as caught:
        bowyer_watson(points.tolist())
    assert caught.value.reason == reason
    rows = caught.value.chain.tolist()
    places = [tuple(p) for p in points.tolist()]
    assert [places[row] for row in rows] == sorted(set(places))
    assert all(places.index(places[row]) == row for row in rows)


def test_bad_points_are_named() -> None:
    with pytest.raises(NonFiniteError) as caught:
        bowyer_watson([(0, 0), (np.nan, 0), (1, 0), (0, np.inf), (0, 1)])
    assert caught.value.rows.tolist() == [1, 3]
    with pytest.raises(ShapeError, match="row 1 has 3"):
        bowyer_watson([(0, 0), (1, 0, 0), (0, 1)])


def test_lawson_refuses_what_is_no_triangulation() -> None:
    with pytest.raises(InputError, match="counter-clockwise"):
        lawson(TEXTBOOK, [(1, 0, 4)])
    with pytest.raises(InputError, match="left of the edge"):
        lawson(TEXTBOOK, [(0, 1, 4), (0, 1, 2)])
