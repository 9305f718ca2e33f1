"""Columns of text files: numbers if each field is one, otherwise words.

Codes such as ``007`` stay words, because they would change as numbers. Numbers become the
nearest doubles, or integers, and an empty field in a column of numbers is NaN.
"""

from __future__ import annotations

import csv
import re
import warnings
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.counting import counted
from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

__all__ = ["Words", "unique_names"]

# At most 18 digits fit into 64 bits.
_INTEGER = re.compile(r"0|-?[1-9]\d{0,17}")
_DECIMAL = re.compile(r"[+-]?(?:(?:0|[1-9]\d*)(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf)")


class Words:
    """The fields of some columns, collected block by block."""

    def __init__(
        self, names: Sequence[str], columns: Sequence[int], decimal: str, source: str
    ) -> None:
        self._columns, self._decimal, self._source = list(columns), decimal, source
        self._names = unique_names(names, columns, source)
        self._fields: list[list[str]] = [[] for _ in columns]

    def add(self, lines: Sequence[str], delimiter: str | None) -> None:
        """Add the fields of more rows; fields that a short row does not have are empty."""
        if not self._columns:
            return
        if delimiter is None:
            rows = [line.split() for line in lines]
        else:
            try:
                rows = list(csv.reader(lines, delimiter=delimiter, skipinitialspace=True))
            except csv.Error as error:
                raise FileFormatError(f"{self._source}: {error}") from None
        if len(rows) != len(lines):
            raise FileFormatError(f"{self._source} has fields in quotes that go over several lines")
        for column, fields in zip(self._columns, self._fields, strict=True):
            fields += [row[column].strip() if column < len(row) else "" for row in rows]

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return the columns by name."""
        return {
            name: _typed(fields, self._decimal)
            for name, fields in zip(self._names, self._fields, strict=True)
        }


def unique_names(names: Sequence[str], numbers: Sequence[int], source: str) -> list[str]:
    """Return names of columns; one that repeats, or is empty, gets the number of its column.

    A warning says so.
    """
    counts, taken = Counter(names), set(names)
    found, renamed = [], []
    for name, number in zip(names, numbers, strict=True):
        plain = name
        if counts[name] > 1 or not name:
            plain = f"{name or 'column'}_{number}"
            while plain in taken:
                plain += "_"
            taken.add(plain)
            renamed.append(plain)
        found.append(plain)
    if renamed:
        what = counted(len(renamed), "column")
        message = f"{source}: {what} without a name of its own, read as {', '.join(renamed)}"
        warnings.warn(message, UserWarning, stacklevel=2)
    return found


def _typed(fields: list[str], decimal: str) -> NDArray[Any]:
    """Return integers or doubles if all fields are such numbers, else the words."""
    if fields and all(map(_INTEGER.fullmatch, fields)):
        return np.array(list(map(int, fields)), dtype=np.int64)
    plain = [field.replace(decimal, ".").lower() for field in fields]
    if any(plain) and all(_DECIMAL.fullmatch(field) for field in plain if field):
        return np.array([float(field) if field else np.nan for field in plain])
    return np.array(fields, dtype=object)
