"""Lawson's flips: turn any triangulation of a point set into the Delaunay triangulation.

Lawson, C. L. (1977), "Software for C1 surface interpolation", in Mathematical Software III, edited
by J. R. Rice, Academic Press, 161-194.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from delone.errors import InputError
from delone.reference.exact import exact_rows, incircle_canonical, orient
from delone.reference.insertion import Triangle, smallest_first

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from delone.reference.exact import ExactPoint

Edge: TypeAlias = tuple[int, int]


def lawson(
    points: Sequence[Sequence[Any]], triangles: Iterable[Sequence[int]]
) -> tuple[list[Triangle], int]:
    """Flip edges until every one of them is Delaunay, ties broken canonically.

    Parameters
    ----------
    points : sequence of pairs of numbers, length n
        Integers, floats, fractions or decimals, all used exactly.
    triangles : iterable of triples of int
        A triangulation of the points' convex hull, counter-clockwise.

    Returns
    -------
    triangles : list of tuple of int
        Counter-clockwise, each starting with its smallest vertex, in ascending order.
    flips : int
        The number of edges that were flipped.

    Raises
    ------
    InputError
        A triangle is not counter-clockwise, or two of them lie on the same side of an edge.
    NonFiniteError
        A coordinate is NaN or infinite.

    Notes
    -----
    A flip replaces the diagonal uv of the quadrilateral u, q, v, p by pq. It is made only if q is
    inside the circle of u, v, p, and then the quadrilateral is strictly convex: the part of the
    circle beyond uv lies within the angle at p. Each flip lowers the surface of the lifted (and
    symbolically perturbed) triangles, so no triangulation repeats and the loop terminates after
    O(n²) flips. Lawson (1977).

    Examples
    --------
    A square with the wrong diagonal (the smallest point, (0, 0), should be on it):

    >>> from delone.reference import lawson
    >>> lawson([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 3), (1, 2, 3)])
    ([(0, 1, 2), (0, 2, 3)], 1)
    """
    exact = exact_rows(points)
    apex = apexes(exact, triangles)
    flips = make_delaunay(exact, apex)
    return triangles_of(apex), flips


def make_delaunay(
    points: Sequence[ExactPoint], apex: dict[Edge, int], fixed: Collection[Edge] = ()
) -> int:
    """Flip edges until every one that is not fixed is locally Delaunay, ties broken canonically.

    Modifies `apex`, see `apexes`, and returns the number of flips. Fixed edges have their smaller
    vertex first.
    """
    waiting = [(u, v) for u, v in apex if u < v]
    flips = 0
    while waiting:
        u, v = waiting.pop()
        if (u, v) not in apex or (v, u) not in apex or (min(u, v), max(u, v)) in fixed:
            continue  # already flipped, an edge of the hull, or one to keep
        p, q = apex[u, v], apex[v, u]
        if incircle_canonical(points[u], points[v], points[p], points[q]) <= 0:
            continue
        flip(apex, u, v)
        waiting += [(u, q), (q, v), (v, p), (p, u)]
        flips += 1
    return flips


def flip(apex: dict[Edge, int], u: int, v: int) -> Edge:
    """Replace the edge uv by the other diagonal of its two triangles, and return that.

    The triangles must form a strictly convex quadrilateral.
    """
    p, q = apex.pop((u, v)), apex.pop((v, u))
    #        p                 p
    #      /   \             / | \
    #     u ─── v    ->     u  |  v
    #      \   /             \ | /
    #        q                 q
    for a, b, c in ((p, u, q), (q, v, p)):
        apex[a, b], apex[b, c], apex[c, a] = c, a, b
    return p, q


def triangles_of(apex: dict[Edge, int]) -> list[Triangle]:
    """List the triangles of a map of apexes, each from its smallest vertex, in ascending order."""
    return sorted({smallest_first((u, v, p)) for (u, v), p in apex.items()})


def apexes(points: Sequence[ExactPoint], triangles: Iterable[Sequence[int]]) -> dict[Edge, int]:
    """Map each directed edge to the third vertex of the triangle on its left.

    There are three entries per triangle, and flips need no other topology.
    """
    apex: dict[Edge, int] = {}
    for triangle in triangles:
        a, b, c = (int(vertex) for vertex in triangle)
        if orient(points[a], points[b], points[c]) <= 0:
            raise InputError(f"triangle {(a, b, c)} is not counter-clockwise")
        for u, v, p in ((a, b, c), (b, c, a), (c, a, b)):
            if (u, v) in apex:
                raise InputError(f"two triangles lie on the left of the edge {(u, v)}")
            apex[u, v] = p
    return apex
