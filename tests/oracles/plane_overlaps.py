"""Areas that polygons in the plane share, in rational numbers and by another method than delone's.

The plane is cut into strips at the abscissas of all corners and crossings. In a strip nothing
crosses, so that the sides there are sorted, and the parts of both polygons are trapezoids.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    Place = tuple[Fraction, Fraction]
    Side = tuple[Place, Place]

__all__ = ["area", "shared_area"]


def _sides(rings: Sequence[Sequence[Sequence[float]]]) -> list[Side]:
    found = []
    for ring in rings:
        places = [(Fraction(float(x)), Fraction(float(y))) for x, y in ring]
        sides = zip(places, [*places[1:], places[0]], strict=True)
        found += [(min(a, b), max(a, b)) for a, b in sides if a[0] != b[0]]
    return found


def _at(side: Side, x: Fraction) -> Fraction:
    (ax, ay), (bx, by) = side
    return ay + (by - ay) * (x - ax) / (bx - ax)


def _cuts(sides: list[Side]) -> list[Fraction]:
    found = {place[0] for side in sides for place in side}
    for k, e in enumerate(sides):
        for f in sides[:k]:
            low, high = max(e[0][0], f[0][0]), min(e[1][0], f[1][0])
            if low >= high:
                continue
            below, above = _at(e, low) - _at(f, low), _at(e, high) - _at(f, high)
            if below * above < 0:
                found.add(low + (high - low) * below / (below - above))
    return sorted(found)


def shared_area(
    first: Sequence[Sequence[Sequence[float]]], second: Sequence[Sequence[Sequence[float]]]
) -> Fraction:
    """Return the area in both polygons, each given by its rings, by the even-odd rule."""
    p, q = _sides(first), _sides(second)
    cuts = _cuts(p + q)
    total = Fraction(0)
    for low, high in pairwise(cuts):
        middle = (low + high) / 2
        marks = sorted(
            (_at(side, middle), of)
            for of, sides in enumerate((p, q))
            for side in sides
            if side[0][0] <= low and side[1][0] >= high
        )
        inside = [False, False]
        last = Fraction(0)
        for y, of in marks:
            if all(inside):
                total += (y - last) * (high - low)
            inside[of] = not inside[of]
            last = y
    return total


def area(rings: Sequence[Sequence[Sequence[float]]]) -> Fraction:
    """Return the area of a polygon."""
    return shared_area(rings, rings)
