"""The error for which simplified tiles have at most a given number of triangles.

Errors are taken from a scale with eight steps for each factor of two, ``2 ** (k / 8)``; below the
resolution of heights, the error is 0. The result is the step with at most the given number of
triangles whose next finer step has more. Triangles are counted with exactly the lines of the
result.

Counting the triangles for one error also gives the numbers for larger errors, though with finer
lines than those errors would have. These numbers determine the next step to try.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from delone._base.counting import counted
from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone._base.types import Rows

__all__ = ["STEPS", "fitting"]

# Steps of the scale for each factor of two: about 9 %.
STEPS = 8
# Errors larger than this many units in the last place leave room for rounding along lines.
_UNITS = 64
# The first error is this many steps below the range of heights: a sixteenth of it.
_FIRST = 4 * STEPS
# The most steps by which a guess is finer than the error before it: a factor of eight.
_FARTHEST = 3 * STEPS
# After this many guesses, the search is a bisection.
_GUESSES = 4


def fitting(
    count: Callable[[float, list[float]], Rows],
    heights: tuple[float, float],
    points: int,
    most: int,
) -> float:
    """Return the smallest error of the scale with at most `most` triangles.

    `count` returns the numbers of triangles for an error and for larger ones, all with the lines
    simplified for the first error; so only the first number is exact.
    """
    low, high = heights
    resolution = math.ulp(max(abs(low), abs(high)))
    # Halves do not overflow. Below a few units in the last place, lines keep all points.
    extent = max(high / 2 - low / 2, _UNITS * resolution)
    coarsest = math.ceil(STEPS * (math.log2(extent) + 1))
    zero = math.floor(STEPS * math.log2(resolution)) - 1
    # `fits` has few enough triangles and `exceeds` too many. Each round moves one of them.
    fits, exceeds = coarsest + 1, zero - 1
    # A surface of n points has fewer than 2n triangles.
    k = zero if most >= 2 * points else max(zero, coarsest - _FIRST)
    rounds = 0
    while fits - exceeds > 1:
        steps = list(range(k, coarsest + 1))
        counts = count(_error(k, zero), [_error(each, zero) for each in steps])
        few = counts <= most
        rounds += 1
        if few[0]:
            fits = k
            guess = k - _finer(counts, most)
        else:
            exceeds = k
            guess = k + int(np.argmax(few)) if few.any() else (k + fits) // 2
        if exceeds == coarsest:
            raise InputError(_too_few(most, int(counts[0])))
        k = (fits + exceeds) // 2 if rounds > _GUESSES else guess
        k = max(exceeds + 1, min(min(fits, coarsest + 1) - 1, k))
    return _error(fits, zero)


def _too_few(most: int, present: int) -> str:
    return (
        f"max_triangles={most} is below the {counted(present, 'triangle')} of cuts between tiles "
        "and hull: allow more, or make larger tiles"
    )


def _error(k: int, zero: int) -> float:
    if k <= zero:
        return 0.0
    with np.errstate(over="ignore"):
        return float(min(np.exp2(k / STEPS), np.finfo(float).max))


def _finer(counts: Rows, most: int) -> int:
    """Return how many steps finer to try next, at least one, to reach the number of triangles."""
    j = min(STEPS, len(counts) - 1)
    growth = math.log(max(int(counts[0]), 2) / max(int(counts[j]), 1)) / j if j else 0.0
    if growth <= 0:
        return _FARTHEST
    return max(1, min(_FARTHEST, math.floor(math.log(most / max(int(counts[0]), 1)) / growth)))
