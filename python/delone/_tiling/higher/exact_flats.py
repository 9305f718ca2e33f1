"""Measures of simplices of fewer dimensions than their points have, by fractions and rounded once.

All follow from the inner products of the steps from the first corner to the others. Where rounded
arithmetic loses digits, `flats` calls these functions for single simplices. O(k^3) fractions.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Floats

__all__ = ["center", "normal", "size"]

# Bits of integers under a root; the root has half of them.
_BITS = 160


def size(corners: Floats) -> float:
    """Return the measure of a simplex, (k + 1, d): the root of Gram's determinant over k!."""
    steps = _steps(corners)
    determinant = _solved(_products(steps, steps), [])[0]
    return _rounded(_root(determinant) / math.factorial(len(steps)))


def center(corners: Floats) -> list[float]:
    """Return the center in the flat of the sphere through the corners."""
    steps = _steps(corners)
    inner = _products(steps, steps)
    shares = _solved(inner, [row[i] / 2 for i, row in enumerate(inner)])[1]
    return [
        _rounded(
            Fraction(x)
            + sum((s * step[k] for s, step in zip(shares, steps, strict=True)), Fraction())
        )
        for k, x in enumerate(corners[0].tolist())
    ]


def normal(facet: Floats, inside: Floats) -> Floats:
    """Return the unit normal of a facet, (k, d), in the flat that also contains an inside point."""
    *along, toward = _steps(np.vstack((facet, inside)))
    products = [_dot(step, toward) for step in along]
    shares = _solved(_products(along, along), products)[1]
    # The part of the way to the inside that is at a right angle to the facet.
    away = [
        sum((s * step[k] for s, step in zip(shares, along, strict=True)), Fraction()) - x
        for k, x in enumerate(toward)
    ]
    largest = max(map(abs, away))
    found = np.array([float(x / largest) for x in away])
    return np.asarray(found / np.linalg.norm(found))


def _steps(corners: Floats) -> list[list[Fraction]]:
    first, *others = ([Fraction(x) for x in row] for row in corners.tolist())
    return [[x - y for x, y in zip(row, first, strict=True)] for row in others]


def _dot(a: list[Fraction], b: list[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction())


def _products(a: list[list[Fraction]], b: list[list[Fraction]]) -> list[list[Fraction]]:
    return [[_dot(x, y) for y in b] for x in a]


def _solved(matrix: list[list[Fraction]], right: list[Fraction]) -> tuple[Fraction, list[Fraction]]:
    """Return the determinant of a positive definite matrix, and the solution for a right side."""
    rows = [[*row, *right[i : i + 1]] for i, row in enumerate(matrix)]
    determinant = Fraction(1)
    for k, pivot in enumerate(rows):
        determinant *= pivot[k]
        for i, row in enumerate(rows):
            if i != k and row[k]:
                factor = row[k] / pivot[k]
                rows[i] = [x - factor * y for x, y in zip(row, pivot, strict=True)]
    return determinant, [row[-1] / row[k] for k, row in enumerate(rows)] if right else []


def _root(square: Fraction) -> Fraction:
    """Return a square root with half of `_BITS` correct bits."""
    bits = square.numerator.bit_length() - square.denominator.bit_length()
    shift = (_BITS - bits) // 2
    scaled = square * Fraction(4) ** shift
    return math.isqrt(scaled.numerator // scaled.denominator) / Fraction(2) ** shift


def _rounded(value: Fraction) -> float:
    """Return the nearest double; infinity beyond the range."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf
