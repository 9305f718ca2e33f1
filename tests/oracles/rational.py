"""Points and vectors of fractions, and what tests measure with them. Nothing here rounds."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

Vector: TypeAlias = tuple[Fraction, ...]


def exact(points: Any) -> list[Vector]:
    return [tuple(map(Fraction, point)) for point in np.asarray(points, dtype=float).tolist()]


def minus(p: Sequence[Fraction], q: Sequence[Fraction]) -> Vector:
    return tuple([x - y for x, y in zip(p, q, strict=True)])


def dot(p: Sequence[Fraction], q: Sequence[Fraction]) -> Fraction:
    return sum([x * y for x, y in zip(p, q, strict=True)], Fraction(0))


def cross(p: Sequence[Fraction], q: Sequence[Fraction]) -> Vector:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def area(ring: list[Vector]) -> Fraction:
    """The area of a polygon, negative where it is clockwise."""
    closed = pairwise([*ring, *ring[:1]])
    return sum((ax * by - ay * bx for (ax, ay), (bx, by) in closed), Fraction(0)) / 2


def from_segment(q: Vector, p: Vector, r: Vector) -> tuple[Fraction, Vector]:
    """The squared distance of q from the segment between p and r, and the nearest point."""
    way = minus(r, p)
    share = min(max(dot(way, minus(q, p)) / dot(way, way), Fraction(0)), Fraction(1))
    foot = tuple(x + share * y for x, y in zip(p, way, strict=True))
    return dot(minus(foot, q), minus(foot, q)), foot


def from_triangle(q: Vector, corners: Sequence[Vector]) -> tuple[Fraction, Vector]:
    """The same of a triangle: in its plane where the foot is inside, else on an edge."""
    a, b, c = corners
    e, f, u = minus(b, a), minus(c, a), minus(q, a)
    ee, ef, ff, ue, uf = dot(e, e), dot(e, f), dot(f, f), dot(u, e), dot(u, f)
    v, w = ff * ue - ef * uf, ee * uf - ef * ue
    whole = ee * ff - ef * ef
    if v >= 0 and w >= 0 and v + w <= whole:
        foot = tuple(x + (v * y + w * z) / whole for x, y, z in zip(a, e, f, strict=True))
        return dot(minus(foot, q), minus(foot, q)), foot
    return min(from_segment(q, p, r) for p, r in ((a, b), (b, c), (c, a)))


def ulps(found: float, wanted: Fraction) -> Fraction:
    """The distance of a double from a number, in units in the last place of that."""
    return abs(Fraction(found) - wanted) / Fraction(float(np.spacing(abs(float(wanted)))))
