"""Values at sites: conversion, and the policies for NaN and duplicates.

All interpolation code takes a `Field`: one row of doubles for each point, whatever the shape and
dtype of the values. Complex values are pairs of real ones, because every interpolator here is
linear in the values. Points that coincide have equal rows after `Field.merged`.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_plain_array, refuse_hidden, wrong_shape
from delone._base.counting import agreed, counted
from delone._base.values import refuse_rounded, require_real
from delone.errors import ConflictingValuesError, InputError, NonFiniteError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

__all__ = [
    "DUPLICATES",
    "NAN",
    "Field",
    "as_field",
    "differing",
    "no_values",
    "of_field",
    "require_finite_values",
]

DUPLICATES = ("raise", "mean", "first", "last", "min", "max")
NAN = ("raise", "drop", "propagate")

_LARGEST_EXACT_INTEGER = 2**53
_NAMED = 5


@dataclass(frozen=True, eq=False)
class Field:
    """Values of all points as real columns."""

    columns: Floats  # (n, c), C-contiguous; real and imaginary parts are adjacent columns
    trailing: tuple[int, ...]  # shape of the values of one point
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

    def patterns(self) -> list[NDArray[np.int64]]:
        """The values of a point, as groups that are missing at the same points, by first member.

        Real and imaginary parts are one value.
        """
        if not self.not_finite.size:
            return [np.arange(self._width)]
        missing = ~np.isfinite(self.columns)
        if self.is_complex:
            missing = missing[:, 0::2] | missing[:, 1::2]
        packed = np.packbits(missing, axis=0).T
        groups: dict[bytes, list[int]] = {}
        for k, pattern in enumerate(packed):
            groups.setdefault(pattern.tobytes(), []).append(k)
        return [np.array(group) for group in groups.values()]

    @property
    def _width(self) -> int:
        """How many values a point has."""
        return int(self.columns.shape[1]) // (2 if self.is_complex else 1)

    def only(self, which: NDArray[np.int64]) -> Field:
        """Some of the values of each point, (n, k)."""
        columns = np.column_stack((2 * which, 2 * which + 1)).ravel() if self.is_complex else which
        part = np.ascontiguousarray(self.columns[:, columns])
        return replace(self, columns=part, trailing=(len(which),))

    def joined(
        self, parts: list[tuple[NDArray[np.int64], NDArray[Any]]], further: int = 0
    ) -> NDArray[Any]:
        """Join results for parts of the values; they are the last axes but `further` ones."""
        first = parts[0][1]
        axis = first.ndim - 1 - further
        leading, last = first.shape[:axis], first.shape[axis + 1 :]
        found = np.empty((*leading, self._width, *last), first.dtype)
        every: tuple[Any, ...] = (slice(None),) * axis
        for which, part in parts:
            found[(*every, which)] = part
        return found.reshape((*leading, *self.trailing, *last))

    def at(self, rows: NDArray[np.integer]) -> Field:
        """The values of some points."""
        return replace(self, columns=np.ascontiguousarray(self.columns[rows]))

    def merged(self, first: NDArray[np.integer], policy: str) -> Field:
        """Give points that coincide, by the `first` row of each point, the same value.

        Raises if the policy is ``"raise"`` and values differ, or would have to order complex
        numbers.
        """
        again = np.flatnonzero(first != np.arange(len(first)))
        if not again.size:
            return self
        if policy != "raise":
            return replace(self, columns=self._merge(again, first, policy))
        a, b = self.columns[again], self.columns[first[again]]
        rows = again[~((a == b) | (np.isnan(a) & np.isnan(b))).all(axis=1)]
        if rows.size:
            raise self._told_apart(rows, first)
        return self

    def _told_apart(
        self, rows: NDArray[np.int64], first: NDArray[np.integer]
    ) -> ConflictingValuesError:
        named = ", ".join(f"{row} and {first[row]}" for row in rows[:_NAMED].tolist())
        more = ", ..." if len(rows) > _NAMED else ""
        choices = ", ".join(map(repr, DUPLICATES[1:]))
        return ConflictingValuesError(
            f"{len(rows)} {agreed(len(rows), 'duplicate has', 'duplicates have')} a different "
            f"value: rows {named}{more}; choose duplicates={choices}",
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
                raise InputError(f"duplicates={policy!r:.80}: complex values have no order")
            extreme = np.minimum if policy == "min" else np.maximum
            extreme.at(columns, owner, self.columns[again])
        columns[again] = columns[owner]
        return columns

    def shaped(self, columns: Floats, leading: tuple[int, ...]) -> NDArray[Any]:
        """Interpolated columns, (k, c), in the dtype of the values, of shape leading + trailing."""
        found = np.ascontiguousarray(columns)
        if self.is_complex:
            found = found.view(np.complex128)
        return found.reshape(leading + self.trailing)


def as_field(values: ArrayLike, count: int, *, name: str = "values") -> Field:
    """Convert values, (count, ...), to a field without rounding; NaN is allowed."""
    refuse_hidden(values, name)
    array = as_plain_array(values, name)
    require_real(array, name, kinds="iufc")
    if array.ndim == 0 or len(array) != count:
        raise wrong_shape(name, f"({count},) or ({count}, ...)", array)
    is_complex = array.dtype.kind == "c"
    plain = np.require(array, np.complex128 if is_complex else np.float64, ["C", "A"])
    refuse_rounded(array, plain, name)
    width = int(np.prod(array.shape[1:], dtype=np.int64))
    columns = plain.reshape(count, width)
    if is_complex:
        columns = columns.view(np.float64)
    return Field(columns, array.shape[1:], is_complex)


def no_values() -> InputError:
    """Return the error for an interpolator without values."""
    return InputError("no values: pass them to the constructor or to the call")


def differing(groups: int) -> InputError:
    """Return the error for groups of fields that have different sites."""
    return InputError(
        f"nan='drop' removes different sites from {groups} groups of fields, which have no sites "
        "or weights in common: give the fields of one group"
    )


@contextmanager
def of_field(number: int) -> Iterator[None]:
    """Add to input errors which of several fields they concern."""
    try:
        yield
    except InputError as error:
        error.add_note(f"of the fields among values, number {number}")
        raise


def require_finite_values(field: Field) -> None:
    """Raise NonFiniteError, which names the first rows, if a value is NaN or infinite."""
    rows = field.not_finite
    if rows.size:
        first = ", ".join(map(str, rows[:10].tolist()))
        raise NonFiniteError(
            f"values: {len(rows)} of {counted(len(field), 'row')} "
            f"{agreed(len(rows), 'holds', 'hold')} NaN or infinity; first: {first}; "
            "choose nan='drop' or nan='propagate'",
            rows=rows[:10],
            count=len(rows),
        )
