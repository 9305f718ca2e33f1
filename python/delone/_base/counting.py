"""Counts with singular or plural nouns and verbs, for messages and representations."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

__all__ = ["agreed", "counted", "gigabytes", "grouped", "listed"]

# Larger numbers are shown in scientific notation.
_HUGE = 10**15
# Fewer bytes are shown as they are.
_TINY = 10_000
# Fewer GB are shown in MB.
_SMALL = 0.05
# Nouns that do not take an s.
_MANY = {
    "tetrahedron": "tetrahedra",
    "geometry": "geometries",
    "vertex": "vertices",
    "pass": "passes",
    "simplex": "simplices",
}


def counted(count: int, noun: str) -> str:
    """Return a number and its noun, given in the singular: "1 point", "0 vertices"."""
    return f"{count} {noun if count == 1 else _MANY.get(noun, noun + 's')}"


def agreed(count: int, one: str, many: str) -> str:
    """Return the words for one or, unless the number is 1, those for many."""
    return one if count == 1 else many


def listed(items: Sequence[object] | NDArray[Any], most: int) -> str:
    """Return the first items, separated by commas, with dots at the end if there are more."""
    return ", ".join(map(str, items[:most])) + (", ..." if len(items) > most else "")


def grouped(count: int) -> str:
    """Return a number with commas, or in scientific notation if it has more than 15 digits."""
    return f"{count:,}" if count < _HUGE else f"{Decimal(count):.3E}"


def gigabytes(size: int) -> str:
    """Return a number of bytes in GB, or if it is small in MB or bytes, with its unit."""
    if size < _TINY:
        return f"{size:,} bytes"
    if size < _SMALL * 10**9:
        return f"{size / 10**6:,.3g} MB"
    shown = f"{size / 10**9:,.1f}" if size < _HUGE * 10**9 else grouped(size // 10**9)
    return f"{shown} GB"
