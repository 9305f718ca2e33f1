"""The exact area that rings enclose by the even-odd rule, whatever they cross and cover.

Vertical slabs between neighbouring abscissas of the vertices are cut further where sides cross, so
that the sides of a slab have an order; every second gap between them is inside. All in fractions.
"""

from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Side(NamedTuple):
    """A side that is not vertical, from left to right."""

    x: Fraction
    y: Fraction
    end: Fraction
    slope: Fraction

    def at(self, x: Fraction) -> Fraction:
        """Return the height at an abscissa."""
        return self.y + (x - self.x) * self.slope


def sides(rings: Iterable[NDArray[np.float64]]) -> list[Side]:
    """Return the sides of implicitly closed rings that are not vertical, by their left ends."""
    found = []
    for ring in rings:
        exact = [(Fraction(x), Fraction(y)) for x, y in ring.tolist()]
        for p, q in pairwise([*exact, *exact[:1]]):
            if p[0] != q[0]:
                (x, y), (end, top) = sorted((p, q))
                found.append(Side(x, y, end, (top - y) / (end - x)))
    return sorted(found)


def crossings(active: list[Side], left: Fraction, right: Fraction) -> set[Fraction]:
    """Return the abscissas strictly inside a slab at which two of its sides cross."""
    found: set[Fraction] = set()
    placed: list[tuple[Fraction, Side]] = []
    for height, side in sorted((side.at(left), side) for side in active):
        end, place = side.at(right), len(placed)
        while place and placed[place - 1][0] > end:
            place -= 1
            other = placed[place][1]
            found.add(left + (height - other.at(left)) / (other.slope - side.slope))
        placed.insert(place, (end, side))
    return found - {left}


def slab_area(active: list[Side], left: Fraction, right: Fraction) -> Fraction:
    """Return the area inside one slab in which no sides cross."""
    doubled = sorted(side.at(left) + side.at(right) for side in active)
    return (right - left) * (sum(doubled[1::2]) - sum(doubled[::2])) / 2


def area(rings: Iterable[NDArray[np.float64]]) -> Fraction:
    """Return the exact area inside the rings by the even-odd rule."""
    waiting = sides(rings)[::-1]
    abscissas = sorted({side.x for side in waiting} | {side.end for side in waiting})
    total, active = Fraction(0), list[Side]()
    for left, right in pairwise(abscissas):
        active = [side for side in active if side.end > left]
        while waiting and waiting[-1].x == left:
            active.append(waiting.pop())
        cuts = sorted({left, right} | crossings(active, left, right))
        total += sum(slab_area(active, *cut) for cut in pairwise(cuts))
    return total


def triangle_area(points: NDArray[np.float64], simplices: NDArray[np.integer]) -> Fraction:
    """Return the exact sum of the areas of triangles, each counted as positive."""
    exact = [(Fraction(x), Fraction(y)) for x, y in points.tolist()]
    total = Fraction(0)
    for i, j, k in simplices.tolist():
        (ax, ay), (bx, by), (cx, cy) = exact[i], exact[j], exact[k]
        total += abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
    return total / 2
