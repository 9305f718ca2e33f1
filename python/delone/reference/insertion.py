"""Bowyer-Watson: insert points one by one, each into the cavity that it sees.

There is no super-triangle. A triangle of any finite size is wrong for some input, so the outside
of the hull is covered by *ghost* triangles instead: one for each hull edge, with a third vertex at
infinity. The "circle" of a ghost is the open half-plane beyond its edge, and the loop below treats
both kinds of triangle alike.

Bowyer, A. (1981), "Computing Dirichlet tessellations", The Computer Journal 24 (2), 162-166.
Watson, D. F. (1981), "Computing the n-dimensional Delaunay tessellation with application to Voronoi
polytopes", The Computer Journal 24 (2), 167-172.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from delone.errors import DegenerateInputError
from delone.reference.exact import exact_rows, first_rows, incircle_canonical, orient
from delone.reference.space import tetrahedra

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from delone.reference.exact import ExactPoint

Triangle: TypeAlias = tuple[int, int, int]

INFINITE = -1


def bowyer_watson(points: Sequence[Sequence[Any]]) -> list[Any]:
    """Triangulate points by the algorithm of Bowyer and Watson.

    Parameters
    ----------
    points : sequence of pairs or triples of numbers, length n
        Integers, floats, fractions or decimals, all used exactly.

    Returns
    -------
    list of tuple of int
        Triangles as counter-clockwise triples of row numbers, each starting with its smallest, in
        ascending order. In 3-D, positively oriented tetrahedra, with ascending row numbers except
        that the last two are exchanged if the orientation requires it. Of equal points only the
        first appears.

    Raises
    ------
    NonFiniteError
        A coordinate is NaN or infinite.
    DegenerateInputError
        Fewer than three points are distinct, or all lie on one line. In 3-D, fewer than four are
        distinct, or all lie on one line or in one plane.
    ShapeError
        A point has a different number of coordinates than the first one, or not two or three.

    Notes
    -----
    Every triangle is tested against every point: O(n²) exact tests. Cocircular points are
    triangulated canonically, as defined by `incircle_canonical`, so the result does not depend on
    the order of the points. Points on the edges of the hull are vertices. Bowyer (1981), Watson
    (1981).

    Examples
    --------
    >>> from delone.reference import bowyer_watson
    >>> bowyer_watson([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
    [(0, 1, 4), (0, 4, 3), (1, 2, 4), (2, 3, 4)]

    The corners of a cube, which are on one sphere:

    >>> cube = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> len(bowyer_watson(cube))
    6
    """
    if len(points) and len(points[0]) == 3:
        return tetrahedra(points)
    exact = exact_rows(points)
    rows = first_rows(exact)
    a, b, c = first_triangle(exact, rows)
    triangles = {(a, b, c), (b, a, INFINITE), (c, b, INFINITE), (a, c, INFINITE)}
    for row in rows:
        if row in (a, b, c):
            continue
        cavity = {t for t in triangles if in_conflict(exact, t, row)}
        triangles -= cavity
        triangles |= {(u, v, row) for u, v in boundary(cavity)}
    return sorted(smallest_first(t) for t in triangles if INFINITE not in t)


def in_conflict(points: Sequence[ExactPoint], triangle: Triangle, row: int) -> bool:
    """Return whether a point lies inside the circle of a triangle, which may be a ghost.

    For a ghost: whether the point is beyond its hull edge, or on that edge between its ends.
    """
    if INFINITE not in triangle:
        a, b, c = (points[vertex] for vertex in triangle)
        return incircle_canonical(a, b, c, points[row]) > 0
    # Rotate the triangle so that infinity is last: u, v is the hull edge, the outside is left.
    k = triangle.index(INFINITE)
    u, v, p = points[triangle[k - 2]], points[triangle[k - 1]], points[row]
    side = orient(u, v, p)
    return side > 0 or (side == 0 and min(u, v) < p < max(u, v))


def boundary(cavity: Iterable[Triangle]) -> set[tuple[int, int]]:
    """Return the directed edges that bound a set of triangles, with the set on their left.

    These are the edges whose reverse is not in the set.
    """
    edges = {(t[k - 1], t[k]) for t in cavity for k in range(3)}
    return {(u, v) for u, v in edges if (v, u) not in edges}


def first_triangle(points: Sequence[ExactPoint], rows: Sequence[int]) -> Triangle:
    """Return the first two distinct points and the first one that is not on their line."""
    chain = sorted(rows, key=lambda row: points[row])
    if len(rows) < 3:
        raise DegenerateInputError(
            f"a triangulation needs three distinct points, got {len(rows)}",
            reason="too few points",
            chain=chain,
        )
    a, b, *others = rows
    for c in others:
        side = orient(points[a], points[b], points[c])
        if side != 0:
            return (a, b, c) if side > 0 else (b, a, c)
    raise DegenerateInputError(
        f"all {len(rows)} distinct points lie on one line", reason="collinear", chain=chain
    )


def smallest_first(triangle: Triangle) -> Triangle:
    """Return the same triangle, rotated so that its smallest vertex is first."""
    a, b, c = triangle
    return min((a, b, c), (b, c, a), (c, a, b))
