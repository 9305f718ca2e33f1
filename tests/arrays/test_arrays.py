from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from delone import Delaunay, interpolate
from delone._base import arrays as _arrays
from delone._base import values as _values
from delone.errors import DtypeError, InputError, LimitError, NonFiniteError, ShapeError

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
HAS_EXTENDED_PRECISION = np.finfo(np.longdouble).nmant > 52


class OnlyArray:
    def __init__(self, array: np.ndarray) -> None:
        self.array = array

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return self.array


def read_only(array: np.ndarray) -> np.ndarray:
    array = array.copy()
    array.flags.writeable = False
    return array


def unaligned(array: np.ndarray) -> np.ndarray:
    memory = np.zeros(array.nbytes + 1, dtype=np.uint8)
    view = memory[1:].view(np.float64).reshape(array.shape)
    view[:] = array
    assert not view.flags.aligned
    return view


@pytest.mark.parametrize(
    "make",
    [
        np.ndarray.tolist,
        lambda a: tuple(map(tuple, a.tolist())),
        list,
        lambda a: a.astype(np.float16),
        lambda a: a.astype(np.float32),
        lambda a: a.astype(np.longdouble),
        lambda a: a.astype(np.uint8),
        lambda a: a.astype(np.int64),
        lambda a: a.astype(np.uint64),
        lambda a: a.astype(">f8"),
        lambda a: a.astype(">i4"),
        np.asfortranarray,
        lambda a: np.repeat(np.repeat(a, 2, axis=0), 3, axis=1)[::2, ::3],
        lambda a: a[::-1].copy()[::-1],
        read_only,
        unaligned,
        lambda a: a.view(np.matrix),
        OnlyArray,
    ],
)
def test_accepts_every_layout_with_the_same_values(make: Any) -> None:
    given = make(SQUARE)
    points = _arrays.as_points(given)
    assert type(points) is np.ndarray
    assert points.dtype == np.float64 and points.dtype.isnative
    assert points.flags.c_contiguous and points.flags.aligned
    np.testing.assert_array_equal(points, SQUARE)


def test_does_not_copy_what_is_right() -> None:
    assert _arrays.as_points(SQUARE) is SQUARE
    frozen = read_only(SQUARE)
    assert _arrays.as_points(frozen) is frozen


@given(hnp.arrays(np.float32, (5, 2), elements=st.floats(width=32, allow_nan=False)))
def test_widens_float32_exactly(values: np.ndarray) -> None:
    assert _arrays.as_points(values).tolist() == values.tolist()


def test_lets_nan_pass_and_keeps_signed_zero() -> None:
    points = _arrays.as_points([[np.nan, np.inf], [-0.0, 0.0]])
    assert np.isnan(points[0, 0]) and np.isinf(points[0, 1])
    assert np.signbit(points[1, 0])


@pytest.mark.parametrize(
    "shape", [(), (0,), (4,), (4, 1), (4, 4), (2, 2, 2), (0, 1), (4, 0)], ids=str
)
def test_refuses_shapes(shape: tuple[int, ...]) -> None:
    with pytest.raises(ShapeError, match=r"sites must have shape \(n, 2\) or \(n, 3\)"):
        _arrays.as_points(np.zeros(shape), name="sites")


def test_ndim_narrows_the_shape() -> None:
    assert _arrays.as_points(np.zeros((4, 3)), ndim=3).shape == (4, 3)
    assert _arrays.as_points(np.zeros((0, 2)), ndim=2).shape == (0, 2)
    with pytest.raises(ShapeError, match=r"shape \(n, 2\), got \(4, 3\)"):
        _arrays.as_points(np.zeros((4, 3)), ndim=2)
    with pytest.raises(ShapeError, match="transpose"):
        _arrays.as_points(np.zeros((2, 9)))


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (np.zeros((3, 2), dtype=complex), "complex numbers"),
        (np.zeros((3, 2), dtype=bool), "booleans"),
        (np.zeros((3, 2), dtype=object), "Python objects"),
        ([[None, 1.0]], "Python objects"),
        ([[Fraction(1, 3), 1]], "Python objects"),
        ([[Decimal("0.1"), 1]], "Python objects"),
        ([["1", "2"]], "strings"),
        (np.zeros((3, 2), dtype="S3"), "byte strings"),
        (np.zeros((3, 2), dtype="M8[s]"), "dates"),
        (np.zeros((3, 2), dtype="m8[s]"), "time spans"),
        (np.zeros(3, dtype=[("x", float), ("y", float)]), "column_stack"),
        (np.ma.masked_array(SQUARE, mask=SQUARE > 0), "masked array, with 4 masked: pass only"),
        ([np.ma.masked_array([1.0, 2.0], mask=[True, False])], "masked"),
    ],
)
def test_refuses_kinds_by_name(values: Any, words: str) -> None:
    with pytest.raises(DtypeError, match=words):
        _arrays.as_points(values)


@pytest.mark.parametrize("mask", [np.ma.nomask, False, np.zeros(SQUARE.shape, dtype=bool)])
def test_takes_masked_arrays_that_mask_nothing(mask: Any) -> None:
    # What files of NetCDF are read as.
    given = np.ma.masked_array(SQUARE.copy(), mask=mask)
    found = _arrays.as_points(given)
    assert type(found) is np.ndarray and np.array_equal(found, SQUARE)
    assert _values.as_values(given[:, 0], len(SQUARE)).tolist() == SQUARE[:, 0].tolist()
    mesh, plain = (Delaunay(each) for each in (given, SQUARE))
    assert np.array_equal(mesh.simplices, plain.simplices)
    linear = interpolate.Linear(given, given[:, 1])
    assert linear(given[:1]).tolist() == SQUARE[:1, 1].tolist()
    given[0, 0] = 77.0
    assert mesh.points[0, 0] == SQUARE[0, 0] != 77.0


@pytest.mark.parametrize(
    ("rows", "what"),
    [
        ([[1, 2], [3]], "points has rows of unequal length: row 0 has 2, row 1 has 1"),
        (
            [[1, 2], [1, 2], 3],
            "points has rows of unequal length: row 0 has 2, row 2 is a single value",
        ),
        ([3, [1, 2]], "points has rows of unequal length: row 0 is a single value, row 1 has 2"),
        ([[[1, 2]], [[1, 2, 3]], [[1, 2]]], "points has rows of unequal shape"),
        (
            [[1, [2]], [3, 4]],
            "points has rows of unequal length in row 0: row 0 is a single value, row 1 has 1",
        ),
    ],
)
def test_refuses_ragged_rows(rows: object, what: str) -> None:
    with pytest.raises(ShapeError) as caught:
        _arrays.as_points(rows)
    assert str(caught.value) == what


@pytest.mark.parametrize(
    "values",
    [
        np.array([[0, 0], [2**53 + 1, 0]]),
        np.array([[0, 0], [0, -(2**53) - 1]]),
        np.array([[0, 0], [-(2**63), 0]]),
        np.array([[0, 0], [2**64 - 1, 0]], dtype=np.uint64),
        [[0.5, 0], [2**53 + 1, 0]],
        [[0.5, 0], (0, -(2**53) - 1)],
        [[-1, 0], [2**63, 0]],
    ],
)
def test_refuses_integers_that_would_be_rounded(values: Any) -> None:
    with pytest.raises(DtypeError, match=r"row 1 .* beyond the 2\*\*53"):
        _arrays.as_points(values)


@pytest.mark.parametrize("value", [2**53, -(2**53)])
@pytest.mark.parametrize("other", [0, 0.5])
def test_accepts_the_largest_exact_integers(value: int, other: float) -> None:
    assert _arrays.as_points([[value, other]]).tolist() == [[value, other]]


def test_large_floats_are_no_large_integers() -> None:
    assert _arrays.as_points([[1e300, 2.0**60], [0, 1]]).tolist() == [[1e300, 2.0**60], [0, 1]]


@pytest.mark.skipif(not HAS_EXTENDED_PRECISION, reason="longdouble is float64 on this platform")
def test_refuses_extended_precision_that_float64_lacks() -> None:
    third = np.full((3, 2), np.longdouble(1) / 4)
    third[2, 1] = np.longdouble(1) / 3
    with pytest.raises(DtypeError, match="row 2"):
        _arrays.as_points(third)
    with pytest.raises(DtypeError, match="row 0"):
        _arrays.as_points(np.full((1, 2), np.longdouble("1e400")))
    third[2, 1] = np.nan
    assert np.isnan(_arrays.as_points(third)[2, 1])


def test_require_finite_names_rows() -> None:
    points = np.zeros((40, 2))
    _arrays.require_finite(points)
    points[3::2, 1] = np.nan
    points[0, 0] = -np.inf
    with pytest.raises(NonFiniteError, match="sites: 20 of 40 rows") as caught:
        _arrays.require_finite(points, name="sites")
    assert caught.value.rows.tolist() == [0, 3, 5, 7, 9, 11, 13, 15, 17, 19]
    assert caught.value.count == 20


def test_as_simplices_converts_and_keeps() -> None:
    right = np.array([[0, 1, 2]], dtype=np.int32)
    assert _arrays.as_simplices(right, 3, 2) is right
    for values in ([[0, 1, 2]], right.astype(np.uint64), right.astype(">i8"), right[:, ::-1]):
        array = _arrays.as_simplices(values, 3, 2)
        assert array.dtype == np.int32 and array.flags.c_contiguous
        np.testing.assert_array_equal(array, np.asarray(values))
    assert _arrays.as_simplices(np.empty((0, 4), int), 0, 3).shape == (0, 4)


@pytest.mark.parametrize("bad", [-1, 3, 2**40, -(2**40)])
def test_as_simplices_names_the_row_out_of_range(bad: int) -> None:
    with pytest.raises(InputError, match=r"row 1 is .* outside the range 0 to 2"):
        _arrays.as_simplices([[0, 1, 2], [0, bad, 1]], 3, 2)


def test_as_simplices_refuses() -> None:
    with pytest.raises(ShapeError, match=r"\(m, 3\)"):
        _arrays.as_simplices([[0, 1, 2, 3]], 4, 2)
    with pytest.raises(DtypeError, match="integers"):
        _arrays.as_simplices([[0.0, 1.0, 2.0]], 3, 2)
    with pytest.raises(DtypeError, match="integers"):
        _arrays.as_simplices([[True, False, True]], 3, 2)
    with pytest.raises(LimitError, match="int32"):
        _arrays.as_simplices([[0, 1, 2]], 2**31, 2)


def test_as_neighbors() -> None:
    assert _arrays.as_neighbors([[-1, 1, -1], [-1, 0, -1]], 2, 2).dtype == np.int32
    with pytest.raises(ShapeError, match="2 simplices"):
        _arrays.as_neighbors([[-1, -1, -1]], 2, 2)
    with pytest.raises(InputError, match="row 0"):
        _arrays.as_neighbors([[-2, -1, -1]], 1, 2)
    with pytest.raises(InputError, match="row 0"):
        _arrays.as_neighbors([[1, -1, -1]], 1, 2)


def test_as_workers() -> None:
    assert _arrays.as_workers(None) >= 1
    assert _arrays.as_workers(1) == 1
    assert _arrays.as_workers(np.int16(7)) == 7
    assert _arrays.as_workers(10**30) == 256
    for wrong in (0, -1, True, np.True_, 1.0, "2", [1]):
        with pytest.raises(ValueError, match="workers must be"):
            _arrays.as_workers(wrong)  # type: ignore[arg-type]


def test_frozen_is_a_view_that_cannot_be_written() -> None:
    array = np.zeros(3)
    view = _arrays.frozen(array)
    assert np.shares_memory(view, array) and array.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        view[0] = 1


def test_tables_with_other_columns_are_not_3d() -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame({"id": range(4), "x": SQUARE[:, 0], "y": SQUARE[:, 1]})
    for each in (table, table[["x", "y", "id"]], table.rename(columns={"x": "Lon", "y": "Lat"})):
        with pytest.raises(InputError, match=r"pass points\[\['(x|Lon)', '(y|Lat)'\]\]"):
            _arrays.as_points(each)
    assert _arrays.as_points(table[["x", "y"]]).shape == (4, 2)
    assert _arrays.as_points(table.rename(columns={"id": "z"})[["x", "y", "z"]]).shape == (4, 3)
    assert _arrays.as_points(table.rename(columns={"x": "a", "y": "b"})).shape == (4, 3)
