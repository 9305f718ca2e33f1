"""Points in a unit in which squares of distances are doubles.

The exact comparisons of distances in the core have the same result in every unit, but take much
longer if rounded squares are zero or infinite.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Floats

__all__ = ["rescaled"]

# Binary exponents of the largest coordinate for which points are left unchanged.
_USUAL = range(-300, 301)


def rescaled(points: Floats, *others: float) -> tuple[Floats, int]:
    """Return points times a power of two, and its exponent; 0 if that is not needed or not exact.

    The same applies to `others`, positive lengths that will be multiplied by the same power.
    """
    largest = float(np.abs(points).max(initial=0.0))
    exponent = int(np.frexp(largest)[1])
    if not largest or exponent in _USUAL:
        return points, 0
    found = np.ldexp(points, -exponent)
    # Small coordinates next to large ones may leave the range of doubles at the other end.
    exact = np.array_equal(np.ldexp(found, exponent), points)
    for length in others:
        there = float(np.ldexp(length, -exponent))
        exact = exact and float(np.ldexp(there, exponent)) == length
    return (found, -exponent) if exact else (points, 0)
