"""Counts with singular or plural nouns and verbs, for messages and representations."""

from __future__ import annotations

from decimal import Decimal

__all__ = ["agreed", "counted", "gigabytes", "grouped"]

# Larger numbers are shown in scientific notation.
_HUGE = 10**15
# Nouns that do not take an s.
_MANY = {"tetrahedron": "tetrahedra", "vertex": "vertices", "pass": "passes"}


def counted(count: int, noun: str) -> str:
    """Return a number and its noun.

    Parameters
    ----------
    count : int
        The number.
    noun : str
        The singular noun.

    Returns
    -------
    str
        The number and the noun, which is in the plural unless the number is 1.

    Examples
    --------
    >>> from delone.counting import counted
    >>> counted(1, "point"), counted(2, "point"), counted(0, "vertex")
    ('1 point', '2 points', '0 vertices')
    """
    return f"{count} {noun if count == 1 else _MANY.get(noun, noun + 's')}"


def agreed(count: int, one: str, many: str) -> str:
    """Return the words that agree with a number.

    Parameters
    ----------
    count : int
        The number.
    one, many : str
        The words for 1, and for any other number.

    Returns
    -------
    str
        One of the two.

    Examples
    --------
    >>> from delone.counting import agreed
    >>> agreed(1, "point comes", "points come"), agreed(2, "is", "are")
    ('point comes', 'are')
    """
    return one if count == 1 else many


def grouped(count: int) -> str:
    """Return a number with commas, or in scientific notation if it has more than 15 digits.

    Parameters
    ----------
    count : int
        A number of any size.

    Returns
    -------
    str
        The number.

    Examples
    --------
    >>> from delone.counting import grouped
    >>> grouped(1_250_000), grouped(4 * 10**300)
    ('1,250,000', '4.000E+300')
    """
    return f"{count:,}" if count < _HUGE else f"{Decimal(count):.3E}"


def gigabytes(size: int) -> str:
    """Return a number of bytes in GB.

    Parameters
    ----------
    size : int
        A number of any size.

    Returns
    -------
    str
        The number and its unit.

    Examples
    --------
    >>> from delone.counting import gigabytes
    >>> gigabytes(1_250_000_000), gigabytes(8 * 10**600)
    ('1.2 GB', '8.000E+591 GB')
    """
    shown = f"{size / 10**9:,.1f}" if size < _HUGE * 10**9 else grouped(size // 10**9)
    return f"{shown} GB"
