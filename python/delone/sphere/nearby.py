"""Directions outside a hull that are no farther from its boundary than an angle, exactly.

Rounded chords decide where they differ from the angle by more than their errors. Elsewhere squares
of cosines, which are fractions of integers, are compared with that of the angle to 60 digits.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from delone.sphere.exact import cross, dot, whole
from delone.sphere.outside import chords

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices, Rows
    from delone.sphere.exact import Vector

__all__ = ["nearby"]

# Larger than the errors of rounded angles, in radians.
_DOUBT = 2.0**-44
_PI = Fraction(3141592653589793238462643383279502884197169399375105820974944592307816406, 10**72)
# Cosines that agree to this many digits with that of an angle such as 60 degrees are equal.
_DIGITS = 10**60


def nearby(
    vectors: Floats, units: Floats, arcs: Indices, queries: Floats, limit: float, *, degrees: bool
) -> Rows:
    """Return, for each query, an arc that is at most an angle away, or -1 if there is none.

    `units` are the rounded unit vectors of `vectors`; queries have any length.
    """
    found = np.full(len(queries), -1, dtype=np.int64)
    if not len(arcs):
        return found
    limit = min(limit, 180.0 if degrees else 4.0)
    angle = np.radians(limit) if degrees else limit
    cosine = _square_of_cosine(Fraction(limit) * (_PI / 180 if degrees else 1))
    scaled = queries / np.abs(queries).max(axis=1, keepdims=True)
    scaled /= np.linalg.norm(scaled, axis=1, keepdims=True)
    for block, squares in chords(units, arcs, scaled):
        away = 2 * np.arcsin(np.minimum(np.sqrt(squares) / 2, 1.0))
        nearest = away.argmin(axis=1)
        least = away[np.arange(len(away)), nearest]
        found[block] = np.where(least <= angle - _DOUBT, nearest, -1)
        doubtful = np.flatnonzero(np.abs(least - angle) < _DOUBT)
        for row in doubtful.tolist():
            query = whole(queries[block.start + row].tolist())
            for arc in np.flatnonzero(np.abs(away[row] - angle) < 2 * _DOUBT).tolist():
                a, b = (whole(vectors[end].tolist()) for end in arcs[arc].tolist())
                if _largest_cosine(query, a, b) >= cosine:
                    found[block.start + row] = arc
                    break
    return found


def _square_of_cosine(angle: Fraction) -> Fraction:
    """Return the square of the cosine of an angle, with the sign of the cosine."""
    if angle >= _PI:
        return Fraction(-1)
    # From the series of the cosine, whose terms decrease from the third one on.
    total, term, k = Fraction(0), Fraction(1), 0
    angle = Fraction(round(angle * _DIGITS**2), _DIGITS**2)
    square = angle * angle
    while abs(term) > Fraction(1, 100 * _DIGITS):
        total += term
        k += 2
        term = -term * square / (k * (k - 1))
        term = Fraction(round(term * _DIGITS**2), _DIGITS**2)
    return Fraction(round(total * abs(total) * _DIGITS), _DIGITS)


def _largest_cosine(query: Vector, a: Vector, b: Vector) -> Fraction:
    """Return the square of the cosine of the angle from a direction to an arc, with its sign."""
    normal = cross(a, b)
    if dot(cross(normal, a), query) > 0 and dot(cross(b, normal), query) > 0:
        sine = dot(query, normal)
        return 1 - Fraction(sine * sine, dot(query, query) * dot(normal, normal))
    ends = ((dot(query, end), dot(end, end)) for end in (a, b))
    return max(Fraction(x * abs(x), dot(query, query) * size) for x, size in ends)
