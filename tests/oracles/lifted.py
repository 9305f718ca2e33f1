"""Regular triangulations by brute force, in fractions: every simplex with no lift below it."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rational import Vector

__all__ = ["determinant", "is_below", "regular", "standing"]


def determinant(rows: Sequence[Sequence[Fraction]]) -> Fraction:
    """By expansion along the first row."""
    if len(rows) == 1:
        return rows[0][0]
    total = Fraction(0)
    for k, value in enumerate(rows[0]):
        if value:
            minor = determinant([(*row[:k], *row[k + 1 :]) for row in rows[1:]])
            total += -value * minor if k % 2 else value * minor
    return total


def is_below(corners: Sequence[Vector], q: Vector) -> bool:
    """Whether the lift of q is below the plane of the corners; the last coordinate is the weight.

    On a tie each height is lowered by an infinitesimal, infinitely larger for a site that comes
    first in lexicographic order.
    """
    sites = [*corners, q]
    flat = [(*site[:-1], Fraction(1)) for site in sites]
    cofactors = []
    for i in range(len(sites)):
        minor = determinant([row for j, row in enumerate(flat) if j != i])
        cofactors.append(-minor if i % 2 else minor)
    heights = [sum(x * x for x in site[:-1]) - site[-1] for site in sites]
    value = sum((h * c for h, c in zip(heights, cofactors, strict=True)), Fraction(0))
    if not value:
        first = min((i for i in range(len(sites)) if cofactors[i]), key=lambda i: sites[i][:-1])
        value = -cofactors[first]
    return (value < 0) == (cofactors[-1] > 0)


def is_flat(corners: Sequence[Vector]) -> bool:
    return not determinant([(*corner[:-1], Fraction(1)) for corner in corners])


def standing(sites: Sequence[Vector]) -> list[int]:
    """For each site the first of the heaviest ones with its coordinates."""
    found = []
    for site in sites:
        equal = [i for i, other in enumerate(sites) if other[:-1] == site[:-1]]
        found.append(max(equal, key=lambda i: (sites[i][-1], -i)))
    return found


def regular(
    sites: Sequence[Vector], among: Iterable[tuple[int, ...]] | None = None
) -> set[frozenset[int]]:
    """The simplices of sites with coordinates and a weight each, of those among some."""
    rows = sorted(set(standing(sites)))
    size = len(sites[0])
    found = set()
    for simplex in combinations(rows, size) if among is None else among:
        corners = [sites[i] for i in simplex]
        others = (sites[i] for i in rows if i not in simplex)
        if not is_flat(corners) and not any(is_below(corners, q) for q in others):
            found.add(frozenset(simplex))
    return found
