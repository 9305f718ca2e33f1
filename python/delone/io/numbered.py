"""Files of numbers with comments: how Triangle's and TetGen's formats number points and markers.

Numbers of points start at 0 or 1 and follow each other. What a file declares is compared with what
it contains before memory is allocated.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = [
    "Lines",
    "Numbers",
    "as_markers",
    "as_rows",
    "first_number",
    "parsed",
    "read_text",
    "table",
]

# Point numbers and markers have 32 bits.
_LARGEST = 1 << 31


def truncated(path: Path) -> FileFormatError:
    """Return the error for a file that ends too early."""
    return FileFormatError(f"{path} is truncated: it declares more than it contains")


def _not_numbers(path: Path, error: Exception | None = None) -> FileFormatError:
    why = "" if error is None else f": {error}"
    return FileFormatError(f"{path} contains something other than numbers{why}")


def _no_counts(path: Path) -> FileFormatError:
    return FileFormatError(f"{path} has no counts where they are expected")


def refuse_columns(
    path: Path, columns: Sequence[str | int] | None, attributes: Sequence[str]
) -> None:
    """Reject a choice of columns, which these formats fix."""
    if columns is not None or attributes:
        raise FileFormatError(f"{path}: the columns of these files cannot be chosen")


def require_nodes(node: Path, path: Path) -> None:
    """Reject a file without the file of its points."""
    if not node.exists():
        raise FileNotFoundError(f"{node}: no such file; {path.name} needs it for its points")


def require_dimension(found: int, wanted: int, path: Path) -> None:
    """Reject points in another dimension."""
    if found != wanted:
        raise FileFormatError(f"{path}: points have {found} coordinates, not {wanted}")


def read_text(path: Path) -> list[str]:
    """Return the lines of a file without comments; blank ones are left out."""
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise _not_numbers(path, error) from error
    lines = (line.partition("#")[0].strip() for line in text.splitlines())
    return [line for line in lines if line]


def parsed(body: bytes, path: Path) -> Floats:
    """Return the numbers of a text, in order; anything else in it is an error."""
    if not body.strip():
        return np.empty(0)
    try:
        with warnings.catch_warnings():
            # NumPy warns and stops at text that is not a number.
            warnings.simplefilter("error", DeprecationWarning)
            found: Floats = np.fromstring(body, dtype=np.float64, sep=" ")
    except (DeprecationWarning, ValueError) as error:
        raise _not_numbers(path) from error
    return found


class Numbers:
    """The numbers of a file, without its comments, in order."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            words = " ".join(read_text(path)).split()
            self._values = np.array(words, dtype=np.float64)
        except ValueError as error:
            raise _not_numbers(path, error) from error
        self._at = 0

    def take(self, rows: int, columns: int) -> Floats:
        """Return the next numbers, (rows, columns)."""
        end = self._at + rows * columns
        if rows < 0 or columns < 0 or end > len(self._values):
            raise truncated(self.path)
        found = self._values[self._at : end].reshape(rows, columns)
        self._at = end
        return found

    def head(self, count: int) -> list[int]:
        """Return the next counts."""
        found = self.take(1, count)[0]
        if not np.isfinite(found).all() or (found != np.floor(found)).any() or (found < 0).any():
            raise _no_counts(self.path)
        return [int(n) for n in found]

    @property
    def ended(self) -> bool:
        """Whether all numbers have been read."""
        return self._at >= len(self._values)


class Lines:
    """The lines of a file, without its comments, for formats in which line breaks matter."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lines = read_text(path)
        self._at = 0

    @property
    def ended(self) -> bool:
        """Whether all lines have been read."""
        return self._at >= len(self._lines)

    @property
    def left(self) -> int:
        """How many lines are left."""
        return len(self._lines) - self._at

    def require(self, count: int) -> None:
        """Raise an error if fewer lines are left than the file declares."""
        if count > self.left:
            raise truncated(self.path)

    def word(self) -> str:
        """Return the word that opens the file, with or without numbers after it."""
        word, _, rest = (self._lines[0] if self._lines else "").partition(" ")
        self._lines[:1] = [rest] if rest.strip() else []
        return word

    def numbers(self) -> list[float]:
        """Return the numbers of the next line."""
        self.require(1)
        line, self._at = self._lines[self._at], self._at + 1
        try:
            return [float(word) for word in line.split()]
        except ValueError as error:
            raise _not_numbers(self.path, error) from error

    def counts(self, least: int) -> list[int]:
        """Return the integers of the next line, at least `least`; the first ones are counts."""
        found = self.numbers()
        whole = [int(n) for n in found if abs(n) < _LARGEST and n == int(n)]
        if len(whole) < max(least, len(found)) or min(whole[:least]) < 0:
            raise _no_counts(self.path)
        return whole

    def rows(self, count: int, columns: int) -> Floats:
        """Return the next `count` lines, (count, columns); further columns are left out."""
        self.require(count)
        rows = [self.numbers()[:columns] for _ in range(count)]
        if any(len(row) < columns for row in rows):
            raise FileFormatError(f"{self.path} has lines with fewer than {columns} numbers")
        return np.array(rows, dtype=np.float64).reshape(count, columns)

    def polygon(self) -> tuple[list[float], list[float]]:
        """Return the corners of a polygon, which may span several lines, and what follows them."""
        head = self.numbers()
        if not head or not 1 <= head[0] < _LARGEST or head[0] != int(head[0]):
            raise FileFormatError(f"{self.path} has no number of corners where it is expected")
        count, found = int(head[0]), head[1:]
        while len(found) < count:
            found += self.numbers()
        return found[:count], found[count:]


def first_number(numbers: Floats, path: Path) -> int:
    """Return the number of the first point; the others follow consecutively."""
    if not len(numbers):
        return 0
    first = float(numbers[0])
    if not 0 <= first < _LARGEST or first != int(first):
        raise FileFormatError(f"{path}: the first point has the number {first:.17g}")
    wrong = np.flatnonzero(numbers != first + np.arange(len(numbers)))
    if len(wrong):
        row = int(wrong[0])
        raise FileFormatError(
            f"{path}: points are not numbered consecutively: row {row} has the number "
            f"{numbers[row]:.17g}, not {int(first) + row}"
        )
    return int(first)


def as_markers(numbers: Floats, path: Path, what: str = "marker") -> NDArray[np.int32]:
    """Return a column of markers, or of similar numbers, as integers."""
    good = (np.abs(numbers) < _LARGEST) & (numbers == np.floor(numbers))
    if not good.all():
        row = int(np.flatnonzero(~good.all(axis=1))[0])
        raise FileFormatError(
            f"{path}: the {what} in row {row} is {numbers[row, 0]:.17g}, not a 32-bit integer"
        )
    return numbers.astype(np.int32)


def as_rows(numbers: Floats, first: int, file: Path, n: int) -> NDArray[np.int32]:
    """Return point numbers as rows of n points."""
    rows = numbers - first
    if (rows != np.floor(rows)).any() or (rows < 0).any() or (rows >= n).any():
        raise FileFormatError(f"{file} refers to points that do not exist")
    return rows.astype(np.int32)


def table(head: str, columns: Sequence[NDArray[Any]]) -> str:
    """Return the text of numbered rows with all digits."""
    lists = [block.tolist() for block in columns]
    lines = [head]
    for i, rows in enumerate(zip(*lists, strict=True)):
        lines.append(" ".join([str(i), *(repr(value) for row in rows for value in row)]))
    return "\n".join(lines) + "\n"
