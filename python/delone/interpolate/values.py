"""Values at sites: conversion, and the policies for NaN and duplicates.

All interpolation code takes a `Field`: one row of doubles for each point, whatever the shape and
dtype of the values. Complex values are pairs of real ones, because every interpolator here is
linear in the values. Points that coincide have equal rows after `Field.merged`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_plain_array
from delone.counting import agreed, counted
from delone.errors import ConflictingValuesError, DtypeError, InputError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

__all__ = ["DUPLICATES", "NAN", "Field", "as_field", "chosen"]

DUPLICATES = ("raise", "mean", "first", "last", "min", "max")
NAN = ("raise", "drop", "propagate")

_LARGEST_EXACT_INTEGER = 2**53
_NAMED = 5


@dataclass(frozen=True, eq=False)
class Field:
    """Values of all points as real columns.

    Parameters
    ----------
    columns : ndarray of float64, shape (n, c)
        C-contiguous; real and imaginary parts are adjacent columns.
    trailing : tuple of int
        Shape of the values of one point.
    is_complex : bool
        Whether pairs of columns are complex numbers.
    """

    columns: Floats
    trailing: tuple[int, ...]
    is_complex: bool

    def __len__(self) -> int:
        return len(self.columns)

    @property
    def not_finite(self) -> NDArray[np.int64]:
        """The rows with NaN or infinity."""
        # A sum of finite numbers may overflow, but checking it first clears almost every field.
        with np.errstate(all="ignore"):
            if np.isfinite(self.columns.sum()):
                return np.empty(0, dtype=np.int64)
        return np.flatnonzero(~np.isfinite(self.columns).all(axis=1))

    def at(self, rows: NDArray[np.integer]) -> Field:
        """Return the values of some points.

        Parameters
        ----------
        rows : ndarray of int
            Rows of the points.

        Returns
        -------
        Field
            Their values.
        """
        return replace(self, columns=np.ascontiguousarray(self.columns[rows]))

    def merged(self, first: NDArray[np.integer], policy: str) -> Field:
        """Give points that coincide the same value.

        Parameters
        ----------
        first : ndarray of int, shape (n,)
            The first row with the same coordinates, for each row.
        policy : str
            One of `DUPLICATES`.

        Returns
        -------
        Field
            Equal rows for equal points; the field itself if no values differ.

        Raises
        ------
        ConflictingValuesError
            The policy is ``"raise"`` and values differ.
        InputError
            The policy would have to order complex numbers.
        """
        again = np.flatnonzero(first != np.arange(len(first)))
        if not again.size:
            return self
        at_first = self.columns[first[again]]
        differ = ~((self.columns[again] == at_first) | _both_nan(self.columns[again], at_first))
        rows = again[differ.any(axis=1)]
        if not rows.size and policy == "raise":
            return self
        if policy == "raise":
            raise self._told_apart(rows, first)
        return replace(self, columns=self._merge(again, first, policy))

    def _told_apart(
        self, rows: NDArray[np.int64], first: NDArray[np.integer]
    ) -> ConflictingValuesError:
        named = ", ".join(f"{row} and {first[row]}" for row in rows[:_NAMED].tolist())
        more = ", ..." if len(rows) > _NAMED else ""
        choices = ", ".join(map(repr, DUPLICATES[1:]))
        return ConflictingValuesError(
            f"{len(rows)} {agreed(len(rows), 'duplicate has', 'duplicates have')} a different "
            f"value: rows {named}{more}; "
            f"choose duplicates={choices}",
            rows=np.column_stack((rows, first[rows])),
        )

    def _merge(self, again: NDArray[np.int64], first: NDArray[np.integer], policy: str) -> Floats:
        columns = self.columns.copy()
        owner = first[again]
        if policy == "last":
            # Assignments to the same row happen in order, so the last one wins.
            columns[owner] = self.columns[again]
        elif policy == "mean":
            # As an offset from the first, so that the mean of equal numbers is that number.
            offset = np.zeros_like(columns)
            count = np.ones(len(columns))
            np.add.at(offset, owner, self.columns[again] - self.columns[owner])
            np.add.at(count, owner, 1.0)
            some = np.unique(owner)
            columns[some] += offset[some] / count[some, None]
        elif policy in ("min", "max"):
            if self.is_complex:
                raise InputError(f"duplicates={policy!r}: complex values have no order")
            extreme = np.minimum if policy == "min" else np.maximum
            extreme.at(columns, owner, self.columns[again])
        columns[again] = columns[owner]
        return columns

    def shaped(self, columns: Floats, leading: tuple[int, ...]) -> NDArray[Any]:
        """Return interpolated columns in the shape and dtype of the values.

        Parameters
        ----------
        columns : ndarray of float64, shape (k, c)
            One row for each query.
        leading : tuple of int
            Shape of the queries.

        Returns
        -------
        ndarray of float64 or complex128, shape leading + trailing
            The values.
        """
        found = np.ascontiguousarray(columns)
        if self.is_complex:
            found = found.view(np.complex128)
        return found.reshape(leading + self.trailing)


def as_field(values: ArrayLike, count: int, *, name: str = "values") -> Field:
    """Convert values to a field without rounding.

    Parameters
    ----------
    values : array_like, shape (count, ...)
        Real or complex numbers.
    count : int
        Number of points.
    name : str, optional
        Name of the argument in error messages.

    Returns
    -------
    Field
        The values; NaN included.

    Raises
    ------
    ShapeError
        The number of values is not the number of points.
    DtypeError
        The values are masked, not numeric, or not representable as doubles.

    Examples
    --------
    >>> from delone.interpolate.values import as_field
    >>> as_field([1 + 2j, 3], 2).columns
    array([[1., 2.],
           [3., 0.]])
    """
    if isinstance(values, np.ma.MaskedArray):
        raise DtypeError(f"{name} is a masked array; fill it: {name}.filled(numpy.nan)")
    array = as_plain_array(values, name)
    if array.dtype.kind not in "iufc":
        raise DtypeError(f"{name} must hold numbers, got dtype {array.dtype}")
    if array.ndim == 0 or len(array) != count:
        raise ShapeError(f"{name} must have shape ({count},) or ({count}, ...), got {array.shape}")
    is_complex = array.dtype.kind == "c"
    plain = np.require(array, np.complex128 if is_complex else np.float64, ["C", "A"])
    _refuse_rounded(array, plain, name)
    width = int(np.prod(array.shape[1:], dtype=np.int64))
    columns = plain.reshape(count, width)
    if is_complex:
        columns = columns.view(np.float64)
    return Field(columns, array.shape[1:], is_complex)


def chosen(what: str, value: str, choices: tuple[str, ...]) -> str:
    """Validate an argument that must be one of several strings.

    Parameters
    ----------
    what : str
        Name of the argument.
    value : str
        The value given.
    choices : tuple of str
        The valid values.

    Returns
    -------
    str
        The value.

    Raises
    ------
    InputError
        It is not one of the choices.

    Examples
    --------
    >>> from delone.interpolate.values import chosen
    >>> chosen("nan", "drop", ("raise", "drop"))
    'drop'
    """
    if not isinstance(value, str) or value not in choices:
        raise InputError(f"{what} must be one of {', '.join(map(repr, choices))}, got {value!r}")
    return value


def require_finite_values(field: Field, name: str = "values") -> None:
    """Raise if a value is NaN or infinite.

    Parameters
    ----------
    field : Field
        The values.
    name : str, optional
        Name of the argument in error messages.

    Raises
    ------
    NonFiniteError
        Names the first rows.
    """
    rows = field.not_finite
    if rows.size:
        first = ", ".join(map(str, rows[:10].tolist()))
        raise NonFiniteError(
            f"{name}: {len(rows)} of {counted(len(field), 'row')} "
            f"{agreed(len(rows), 'holds', 'hold')} NaN or infinity; first: {first}; "
            "choose nan='drop' or nan='propagate'",
            rows=rows[:10],
            count=len(rows),
        )


def _both_nan(a: Floats, b: Floats) -> NDArray[np.bool_]:
    both: NDArray[np.bool_] = np.isnan(a) & np.isnan(b)
    return both


def _refuse_rounded(array: NDArray[Any], plain: NDArray[Any], name: str) -> None:
    """Raise for integers and extended floats that doubles cannot represent."""
    if array.dtype.kind in "iu" and array.dtype.itemsize >= 8:
        with np.errstate(all="ignore"):
            wrong = (array > _LARGEST_EXACT_INTEGER) | (array < -_LARGEST_EXACT_INTEGER)
    elif array.dtype.kind in "fc" and array.dtype.itemsize > plain.dtype.itemsize:
        wrong = (array != plain) & ~np.isnan(array)
    else:
        return
    if wrong.any():
        row = int(np.flatnonzero(wrong.reshape(len(array), -1).any(axis=1))[0])
        raise DtypeError(
            f"{name}: row {row} has a number that float64 cannot represent; round it first"
        )
