"""The exact decimals that doubles represent, and the doubles nearest to their multiples.

A double that prints with up to 15 digits represents the decimal that it prints as: a double
preserves this many digits. All others represent themselves.
"""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

__all__ = ["exact", "multiples", "outer", "spacing"]

_DIGITS = 15


def exact(number: float) -> Fraction:
    """Return the number that a finite double represents."""
    text = repr(float(number))
    digits = Decimal(text).normalize().as_tuple().digits
    return Fraction(text) if len(digits) <= _DIGITS else Fraction(float(number))


def multiples(base: Fraction, step: Fraction, numbers: Iterable[int]) -> NDArray[np.float64]:
    """Return the doubles nearest to ``base + k * step``, for each k of `numbers`.

    Raises OverflowError if one is beyond the range of doubles.
    """
    scale = lcm(base.denominator, step.denominator)
    first, each = int(base * scale), int(step * scale)
    # The quotient of two integers is rounded correctly.
    return np.array([(first + k * each) / scale for k in numbers], dtype=np.float64)


def spacing(nodes: NDArray[np.float64]) -> Fraction:
    """Return the distance of evenly spaced nodes; 0 if there is only one."""
    if len(nodes) < 2:
        return Fraction(0)
    return (exact(nodes[-1]) - exact(nodes[0])) / (len(nodes) - 1)


def outer(nodes: NDArray[np.float64]) -> tuple[float, float]:
    """Return the outer edges of the cells around evenly spaced nodes."""
    half = spacing(nodes) / 2
    return float(exact(nodes[0]) - half), float(exact(nodes[-1]) + half)
