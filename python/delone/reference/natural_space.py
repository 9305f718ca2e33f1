"""Laplace weights in 3-D from their definition: faces of a Voronoi cell, in exact arithmetic.

The face between the cells of a query and a site is clipped from a rectangle in the plane halfway
between them, by one half-space for each other site. Its area divided by their distance is the
weight (N. H. Christ, R. Friedberg and T. D. Lee, "Weights of links and plaquettes in a random
lattice", 1982). An area in an inclined plane is not rational, but if the rectangle has the sides u
and v x u, the area divided by |v| is. Time is at most O(n³) for each query.
"""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from typing import TYPE_CHECKING, Any, TypeAlias

from delone.errors import InputError
from delone.reference.exact import exact_number
from delone.reference.space import cross

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone.reference.exact import ExactNumber

Vector: TypeAlias = tuple[int, int, int]
Place: TypeAlias = tuple[Fraction, Fraction]

__all__ = ["area", "clip", "laplace_in_space"]


def laplace_in_space(points: Sequence[Sequence[Any]], query: Sequence[Any]) -> dict[int, Fraction]:
    """Return the Laplace weights of a query in 3-D, by the rows of the sites.

    Only weights above 0 are listed; they sum to 1.
    """
    seen = _seen_from(query, points)
    here = [row for row, v in enumerate(seen) if not any(v)]
    if here:
        return {here[0]: Fraction(1)}
    parts = {row: _shared(seen, row) for row in range(len(seen))}
    total = sum(parts.values())
    return {row: part / total for row, part in parts.items() if part > 0}


def _seen_from(query: Sequence[Any], points: Sequence[Sequence[Any]]) -> list[Vector]:
    """Points relative to the query, as exact integers, up to one common factor."""
    q = [exact_number(x) for x in query]
    rows = [[exact_number(x) - o for x, o in zip(p, q, strict=True)] for p in points]
    scale = lcm(*(Fraction(x).denominator for row in rows for x in row))
    return [(int(x * scale), int(y * scale), int(z * scale)) for x, y, z in rows]


def _shared(seen: list[Vector], row: int) -> Fraction:
    """The area of the face between the cells of the query and a site, over their distance."""
    v = seen[row]
    # A side perpendicular to v, from the axis least parallel to it, and one to both.
    axis = min(range(3), key=lambda k: abs(v[k]))
    u = cross(v, ((1, 0, 0), (0, 1, 0), (0, 0, 1))[axis])
    w = cross(v, u)
    # Corners of the cell are quotients of determinants, within this distance.
    size = Fraction(1 + 100 * max(abs(x) for p in seen for x in p) ** 6)
    face = [(-size, -size), (size, -size), (size, size), (-size, size)]
    for other in seen:
        if other != v:
            # Nearer to the query than to the other site, on v / 2 + s u + t w.
            room = Fraction(_dot(other, other) - _dot(v, other), 2)
            a, b = _dot(u, other), _dot(w, other)
            face = clip(face, [room - a * s - b * t for s, t in face])
    if any(abs(x) == size for place in face for x in place):
        raise InputError("the query is not strictly inside the convex hull of the points")
    return _dot(u, u) * area(face)


def clip(polygon: list[Place], depths: list[Fraction]) -> list[Place]:
    """The part of a convex polygon where a linear function, given at the corners, is at least 0."""
    kept: list[Place] = []
    for i, (corner, depth) in enumerate(zip(polygon, depths, strict=True)):
        before, above = polygon[i - 1], depths[i - 1]
        if (depth > 0 > above) or (depth < 0 < above):
            share = above / (above - depth)
            s, t = (p + share * (r - p) for p, r in zip(before, corner, strict=True))
            kept.append((s, t))
        if depth >= 0:
            kept.append(corner)
    return kept


def area(polygon: list[Place]) -> Fraction:
    """The area of a counter-clockwise polygon."""
    sides = zip(polygon, polygon[1:] + polygon[:1], strict=True)
    return sum((p[0] * r[1] - p[1] * r[0] for p, r in sides), Fraction(0)) / 2


def _dot(p: Sequence[ExactNumber], q: Sequence[ExactNumber]) -> ExactNumber:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
