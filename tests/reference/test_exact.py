from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from itertools import permutations
from math import nextafter, prod

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from delone.errors import DegenerateInputError
from delone.reference import circumcircle, exact_point, incircle, incircle_canonical, orient

SMALL = st.tuples(st.integers(0, 5), st.integers(0, 5))
DOUBLE = st.floats(allow_nan=False, allow_infinity=False)
ANY = st.tuples(DOUBLE, DOUBLE)


def parity(order: tuple[int, ...]) -> int:
    swaps = sum(a > b for i, a in enumerate(order) for b in order[i + 1 :])
    return -1 if swaps % 2 else 1


@pytest.mark.parametrize(
    "half",
    [0.5, np.float32(0.5), np.float16(0.5), np.longdouble(0.5), Fraction(1, 2), Decimal("0.5")],
)
def test_exact_point_takes_every_kind_of_number(half: object) -> None:
    assert exact_point((half, 3)) == (Fraction(1, 2), 3)


def test_exact_point_does_not_overflow_numpy_integers() -> None:
    x, y = exact_point(np.array([2**62, -(2**62)]))
    assert x * x - y == 2**124 + 2**62


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_exact_point_refuses_what_is_no_number(bad: float) -> None:
    with pytest.raises((ValueError, OverflowError)):
        exact_point((bad, 0.0))


def test_orient_is_exact_where_floats_are_not() -> None:
    below = nextafter(0.1, 0)
    assert orient((0, 0), (0.1, 0.1), (0.3, 0.3)) == 0
    assert orient((0, 0), (0.1, below), (0.3, 0.3)) == 1
    assert orient((0, 0), (below, 0.1), (0.3, 0.3)) == -1
    assert orient((1e300, 1e300), (-1e300, -1e300), (5e-324, 0.0)) == -1 * orient(
        (1e300, 1e300), (-1e300, -1e300), (-5e-324, 0.0)
    )


@given(ANY, ANY, ANY)
def test_orient_is_antisymmetric(a: object, b: object, c: object) -> None:
    points = (a, b, c)
    sign = orient(*points)  # type: ignore[arg-type]
    for order in permutations(range(3)):
        assert orient(*(points[i] for i in order)) == parity(order) * sign  # type: ignore[arg-type]


@given(SMALL, SMALL, SMALL, SMALL)
def test_incircle_agrees_with_the_distance_to_the_centre(
    a: tuple[int, int], b: tuple[int, int], c: tuple[int, int], d: tuple[int, int]
) -> None:
    turn = orient(a, b, c)
    assume(turn != 0)
    (x, y), squared_radius = circumcircle(a, b, c)
    power = squared_radius - (d[0] - x) ** 2 - (d[1] - y) ** 2
    assert incircle(a, b, c, d) == turn * ((power > 0) - (power < 0))


@given(ANY, ANY, ANY)
def test_circumcircle_passes_through_its_points(
    a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]
) -> None:
    assume(orient(a, b, c) != 0)
    (x, y), squared_radius = circumcircle(a, b, c)
    for px, py in map(exact_point, (a, b, c)):
        assert (px - x) ** 2 + (py - y) ** 2 == squared_radius


def test_circumcircle_of_a_line_is_refused() -> None:
    with pytest.raises(DegenerateInputError) as caught:
        circumcircle((0, 0), (1, 1), (2, 2))
    assert caught.value.reason == "collinear"


@given(st.lists(st.one_of(SMALL, ANY), min_size=4, max_size=4, unique=True))
def test_canonical_keeps_strict_signs_and_breaks_ties(points: list[tuple[float, float]]) -> None:
    strict, canonical = incircle(*points), incircle_canonical(*points)
    a, b, *others = points
    if all(orient(a, b, c) == 0 for c in others):
        assert strict == canonical == 0
    else:
        assert canonical != 0
        assert strict in (0, canonical)
        for order in permutations(range(4)):
            turned = incircle_canonical(*(points[i] for i in order))
            assert turned == parity(order) * canonical


@given(st.lists(SMALL, min_size=4, max_size=4, unique=True))
def test_canonical_is_the_limit_of_lowered_heights(points: list[tuple[int, int]]) -> None:
    """The symbolic rule against numbers: each point lowered by a power of a tiny number."""
    tiny = Fraction(1, 10**6)
    rank = {point: k for k, point in enumerate(sorted(points))}
    matrix = [(x, y, x * x + y * y - tiny ** (rank[x, y] + 1), 1) for x, y in points]
    determinant = sum(
        parity(order) * prod(matrix[i][order[i]] for i in range(4))
        for order in permutations(range(4))
    )
    assert incircle_canonical(*points) == (determinant > 0) - (determinant < 0)


def test_canonical_diagonal_starts_at_the_smallest_corner() -> None:
    for signs in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        square = [(x * signs[0], y * signs[1]) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        if orient(*square[:3]) < 0:
            square.reverse()
        k = square.index(min(square))
        a, b, c, d = square[k:] + square[:k]
        assert incircle_canonical(a, b, c, d) == -1  # the diagonal a c stays
        assert incircle_canonical(b, c, d, a) == 1  # the diagonal b d goes
