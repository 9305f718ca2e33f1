"""Signs against rational arithmetic, and what the functions make of arrays."""

from __future__ import annotations

from fractions import Fraction
from itertools import permutations, product
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import predicates, reference
from delone.errors import DtypeError, InputError, NonFiniteError, ShapeError
from delone.predicates import incircle, insphere, orient2d, orient3d

DOUBLE = st.floats(allow_nan=False, allow_infinity=False)
SMALL = st.integers(-3, 3)
# Few values, from all over the range, so that combinations are often degenerate.
MIXED = st.sampled_from(
    [
        0.0,
        -0.0,
        5e-324,
        -5e-324,
        1e-320,
        2.2250738585072014e-308,
        1e-160,
        0.1,
        0.30000000000000004,
        1.0,
        1.0000000000000002,
        -1.0,
        3.0,
        2.0**53,
        1e160,
        1.7976931348623157e308,
        -1.7976931348623157e308,
    ]
)


def plane(coordinate: st.SearchStrategy[Any]) -> st.SearchStrategy[tuple[Any, Any]]:
    return st.tuples(coordinate, coordinate)


def space(coordinate: st.SearchStrategy[Any]) -> st.SearchStrategy[tuple[Any, Any, Any]]:
    return st.tuples(coordinate, coordinate, coordinate)


def sign(number: Fraction | int) -> int:
    return (number > 0) - (number < 0)


def determinant(rows: list[list[Fraction]]) -> Fraction:
    if not rows:
        return Fraction(1)
    first, rest = rows[0], rows[1:]
    return sum(
        (-1) ** k * entry * determinant([row[:k] + row[k + 1 :] for row in rest])
        for k, entry in enumerate(first)
        if entry
    ) + Fraction(0)


def exact(*points: Any) -> list[list[Fraction]]:
    return [[Fraction(x) for x in point] for point in points]


def minus(points: list[list[Fraction]], origin: list[Fraction]) -> list[list[Fraction]]:
    return [[x - o for x, o in zip(p, origin, strict=True)] for p in points]


def exact_orient(*points: Any) -> int:
    first, *others = exact(*points)
    return sign(determinant(minus(others, first)))


def exact_in_sphere(*points: Any, perturbation: Fraction = Fraction(0)) -> int:
    """Sign of the lifted determinant, positive inside positively oriented corners.

    Heights are lowered by the powers of `perturbation`, the first for the smallest point.
    """
    rows = exact(*points)
    rank = {tuple(row): i for i, row in enumerate(sorted(rows), start=1)}
    lifted = [
        [*row, sum(x * x for x in row) - perturbation ** rank[tuple(row)] * bool(perturbation)]
        for row in rows
    ]
    dimension = len(rows[0])
    # In even dimensions lifting keeps the orientation of the frame, in odd ones it turns it over.
    return sign(determinant(minus(lifted[:-1], lifted[-1]))) * (-1) ** dimension


@pytest.mark.parametrize("coordinate", [DOUBLE, SMALL, MIXED], ids=["any", "small", "mixed"])
@given(data=st.data())
def test_orient2d_is_exact(coordinate: st.SearchStrategy[Any], data: st.DataObject) -> None:
    points = [data.draw(plane(coordinate)) for _ in range(3)]
    assert orient2d(*points) == exact_orient(*points)


@pytest.mark.parametrize("coordinate", [DOUBLE, SMALL, MIXED], ids=["any", "small", "mixed"])
@given(data=st.data())
def test_orient3d_is_exact(coordinate: st.SearchStrategy[Any], data: st.DataObject) -> None:
    points = [data.draw(space(coordinate)) for _ in range(4)]
    assert orient3d(*points) == exact_orient(*points)


@pytest.mark.parametrize("coordinate", [DOUBLE, SMALL, MIXED], ids=["any", "small", "mixed"])
@given(data=st.data())
def test_incircle_is_exact(coordinate: st.SearchStrategy[Any], data: st.DataObject) -> None:
    points = [data.draw(plane(coordinate)) for _ in range(4)]
    assert incircle(*points) == exact_in_sphere(*points)


@pytest.mark.parametrize("coordinate", [DOUBLE, SMALL, MIXED], ids=["any", "small", "mixed"])
@given(data=st.data())
def test_insphere_is_exact(coordinate: st.SearchStrategy[Any], data: st.DataObject) -> None:
    points = [data.draw(space(coordinate)) for _ in range(5)]
    assert insphere(*points) == exact_in_sphere(*points)


def test_the_oracle_knows_inside() -> None:
    assert exact_in_sphere((0, 0), (1, 0), (0, 1), (0.5, 0.5)) == 1
    corners = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)
    assert exact_orient(*corners) == 1
    assert exact_in_sphere(*corners, (0.5, 0.5, 0.5)) == 1


def test_orient2d_on_a_raster_of_neighbouring_doubles() -> None:
    # The classroom example: points around (0.5, 0.5) in steps of one unit in the last place.
    steps = 0.5 + np.arange(-24, 25) * 2.0**-53
    x, y = np.meshgrid(steps, steps)
    grid = np.stack((x, y), axis=-1)
    found = orient2d((12.0, 12.0), (24.0, 24.0), grid)
    assert np.array_equal(found, np.sign(y - x))


def test_incircle_of_the_neighbours_of_a_point_on_the_circle() -> None:
    a, b, c, d = np.array([(5, 0), (3, 4), (-4, 3), (0, -5)]) + 2.0**30
    assert incircle(a, b, c, d) == 0
    for dx, dy in product((-1, 0, 1), repeat=2):
        moved = d + np.array((dx, dy)) * 2.0**-22
        assert incircle(a, b, c, moved) == exact_in_sphere(a, b, c, moved)


@given(st.lists(plane(SMALL), min_size=4, max_size=4, unique=True))
def test_canonical_incircle_is_the_limit_of_a_perturbation(points: list[Any]) -> None:
    # Determinants of these integers are below 10**6, so that no power of 10**-9 outweighs a lower.
    expected = exact_in_sphere(*points, perturbation=Fraction(1, 10**9))
    assert incircle(*points, ties="canonical") == expected
    assert incircle(*points, ties="canonical") == reference.incircle_canonical(*points)
    if any(exact_orient(*three) for three in permutations(points, 3)):
        assert expected != 0


@given(st.lists(space(st.integers(-2, 2)), min_size=5, max_size=5, unique=True))
def test_canonical_insphere_is_the_limit_of_a_perturbation(points: list[Any]) -> None:
    expected = exact_in_sphere(*points, perturbation=Fraction(1, 10**9))
    assert insphere(*points, ties="canonical") == expected
    if any(exact_orient(*four) for four in permutations(points, 4)):
        assert expected != 0


@given(st.lists(plane(DOUBLE), min_size=4, max_size=4))
def test_signs_follow_the_order_of_the_arguments(points: list[Any]) -> None:
    a, b, c, d = points
    assert orient2d(a, b, c) == orient2d(b, c, a) == -orient2d(b, a, c)
    for ties in ("zero", "canonical"):
        base = incircle(a, b, c, d, ties=ties)
        assert base == incircle(b, c, a, d, ties=ties) == -incircle(b, a, c, d, ties=ties)
        assert base == -incircle(a, b, d, c, ties=ties)


def test_arguments_broadcast() -> None:
    a = np.zeros((3, 1, 2))
    b = np.array([(1.0, 0), (0, 1)])
    c = np.array([(1.0, 1.0)])
    found = orient2d(a, b, c)
    assert found.shape == (3, 2)
    assert found.dtype == np.int8
    assert found.tolist() == [[1, -1]] * 3


def test_single_points_give_a_number() -> None:
    found = incircle((0, 0), (1, 0), (0, 1), (1, 1))
    assert found.shape == ()
    assert found.dtype == np.int8
    assert int(found) == 0


def test_no_points_give_no_signs() -> None:
    none = np.empty((0, 3))
    assert orient3d(none, none, none, none).shape == (0,)


@pytest.mark.parametrize("dtype", [np.float32, np.int64, ">f8", np.float16, np.uint8])
def test_dtypes_widen_exactly(dtype: Any) -> None:
    points = np.array([(0, 0), (4, 0), (4, 3), (0, 3)], dtype=dtype)
    assert incircle(*points) == 0
    assert orient2d(*points[:3]) == 1


def test_any_layout_is_read_right() -> None:
    a, b, c = np.random.default_rng(0).random((3, 50, 2))
    expected = orient2d(a, b, c)
    assert np.array_equal(orient2d(np.asfortranarray(a), b[::-1][::-1], c.tolist()), expected)
    wide = np.zeros((50, 7))
    wide[:, 2:6:3] = a
    assert np.array_equal(orient2d(wide[:, 2:6:3], b, c), expected)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_refused_by_row(bad: float) -> None:
    points = np.zeros((4, 2))
    points[2, 1] = bad
    with pytest.raises(NonFiniteError, match=r"^b: ") as caught:
        orient2d(np.zeros((4, 2)), points, (1, 1))
    assert caught.value.rows.tolist() == [2]


def test_what_has_no_exact_meaning_is_refused() -> None:
    with pytest.raises(ShapeError, match="a"):
        orient2d((1, 2, 3), (0, 0), (1, 1))
    with pytest.raises(ShapeError):
        orient2d(1.0, (0, 0), (1, 1))  # type: ignore[arg-type]
    with pytest.raises(ShapeError, match="broadcast"):
        orient2d(np.zeros((3, 2)), np.zeros((2, 2)), (1, 1))
    with pytest.raises(DtypeError):
        orient2d((1j, 0), (0, 0), (1, 1))
    with pytest.raises(DtypeError):
        orient2d((2**53 + 1, 0), (0, 0), (1, 1))
    with pytest.raises(InputError, match="ties"):
        incircle((0, 0), (1, 0), (0, 1), (1, 1), ties="none")  # type: ignore[arg-type]


def test_the_module_offers_four_predicates() -> None:
    assert sorted(predicates.__all__) == ["incircle", "insphere", "orient2d", "orient3d"]


@pytest.mark.parametrize("axes", [33, 40, 64, 70])
def test_too_many_axes_are_a_shape_error(axes: int) -> None:
    points: Any = (0.0, 0.0)
    for _ in range(axes - 1):
        points = [points]
    with pytest.raises(ShapeError, match=r"^b has"):
        orient2d((0, 0), points, (1, 1))


def test_as_many_axes_as_numpy_broadcasts() -> None:
    assert orient2d(np.zeros((1,) * 31 + (2,)), (0, 0), (1, 1)).ndim == 31
