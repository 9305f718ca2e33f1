"""The constrained Delaunay triangulation: segments as edges, all other edges locally Delaunay.

Start from the Delaunay triangulation. Split each segment at the vertices on it. Insert one piece at
a time by flipping the edges that cross it, then flip every edge that is not a piece by the
canonical circle test, until no flip is possible. Crossing segments are rejected.

Sloan, S. W. (1993), "A fast algorithm for generating constrained Delaunay triangulations",
Computers & Structures 47 (3), 441-450. Sloan processes the crossing edges in turn and postpones
those whose quadrilateral is not convex; here the next edge is chosen so that it always is (see
`insert_segment`), so the loop provably terminates.

Uniqueness of the result is proved by Chew, L. P. (1989), "Constrained Delaunay triangulations",
Algorithmica 4, 97-108.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, pairwise, product
from typing import TYPE_CHECKING, Any, NamedTuple

from delone._base.counting import agreed
from delone.errors import CrossingSegmentsError, InputError
from delone.reference.exact import exact_point, exact_rows, first_rows, orient
from delone.reference.flips import Edge, apexes, flip, make_delaunay, triangles_of
from delone.reference.insertion import Triangle, bowyer_watson

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from delone.reference.exact import ExactNumber, ExactPoint


class ConstrainedTriangulation(NamedTuple):
    """Triangles and subsegments.

    Parameters
    ----------
    triangles : list of tuple of int
        Counter-clockwise triples of row numbers, each starting with its smallest, in ascending
        order.
    sources : dict of tuple of int to list of int
        Each subsegment, the smaller vertex first, in ascending order, with the rows of the segments
        that cover it, ascending.

    Examples
    --------
    >>> from delone.reference import constrained_delaunay
    >>> square = constrained_delaunay([(0, 0), (1, 0), (1, 1), (0, 1)], [(1, 3), (3, 1)])
    >>> square.triangles, square.sources
    ([(0, 1, 3), (1, 2, 3)], {(1, 3): [0, 1]})
    """

    triangles: list[Triangle]
    sources: dict[Edge, list[int]]


def constrained_delaunay(
    points: Sequence[Sequence[Any]], segments: Iterable[Sequence[int]]
) -> ConstrainedTriangulation:
    """Triangulate points so that segments between them are edges, or chains of edges.

    Parameters
    ----------
    points : sequence of pairs of numbers, length n
        Integers, floats, fractions or decimals, all used exactly.
    segments : iterable of pairs of int
        Rows of `points`. They may share ends, overlap, repeat, pass through points, or have zero
        length; they must not cross.

    Returns
    -------
    ConstrainedTriangulation
        The triangles, and the subsegments into which points split the segments, with their sources.
        Of equal points only the first appears.

    Raises
    ------
    CrossingSegmentsError
        Two segments meet at a point that is an end of neither; the error names all such pairs.
    InputError
        A segment refers to a row that does not exist.
    NonFiniteError, DegenerateInputError, ShapeError
        As in `bowyer_watson`.

    Notes
    -----
    Every edge that is not a subsegment is locally Delaunay, with ties broken canonically as defined
    by `incircle_canonical`, so the result depends only on coordinates. The Delaunay triangulation
    takes O(n²) tests, each segment O(n), s subsegments that might cross O(s²), and each subsegment
    that crosses k edges O(k²) flips. Sloan (1993), Chew (1989).

    Examples
    --------
    The longer diagonal of a kite, which is not an edge of the Delaunay triangulation:

    >>> from delone.reference import bowyer_watson, constrained_delaunay
    >>> kite = [(0, 0), (2, -1), (4, 0), (2, 1)]
    >>> bowyer_watson(kite)
    [(0, 1, 3), (1, 2, 3)]
    >>> constrained_delaunay(kite, [(0, 2)])
    ConstrainedTriangulation(triangles=[(0, 1, 2), (0, 2, 3)], sources={(0, 2): [0]})
    """
    exact = exact_rows(points)
    apex = apexes(exact, bowyer_watson(exact))
    sources = pieces(exact, segments)
    refuse_crossings(points, exact, sources)
    inserted: set[Edge] = set()
    for piece in sources:
        insert_segment(exact, apex, *piece)
        inserted.add(piece)
    make_delaunay(exact, apex, fixed=inserted)
    return ConstrainedTriangulation(triangles_of(apex), sources)


def pieces(
    points: Sequence[ExactPoint], segments: Iterable[Sequence[int]]
) -> dict[Edge, list[int]]:
    """Split segments at all points on them; return the pieces with their source rows.

    Pieces are in ascending order, with the smaller vertex first, and vertices are the first rows of
    their points. A segment of zero length has no pieces.
    """
    first = {points[row]: row for row in first_rows(points)}
    sources: dict[Edge, list[int]] = {}
    for row, segment in enumerate(segments):
        ends = [int(end) for end in segment]
        if not all(0 <= end < len(points) for end in ends):
            raise InputError(f"segment {row} refers to a row that does not exist: {ends}")
        # Lexicographic order sorts points on one line along it.
        low, high = sorted(points[end] for end in ends)
        inner = [p for p in first if low < p < high and orient(low, high, p) == 0]
        for a, b in pairwise(sorted({low, high, *inner})):
            u, v = sorted((first[a], first[b]))
            sources.setdefault((u, v), []).append(row)
    return dict(sorted(sources.items()))


def refuse_crossings(
    points: Sequence[Sequence[Any]], exact: Sequence[ExactPoint], sources: dict[Edge, list[int]]
) -> None:
    """Raise an error if pieces, which have no vertex in their interior, cross.

    It names the rows of each pair once, the smaller first, in ascending order, and the points where
    they meet. `points` are as given, `exact` are scaled to integers.
    """
    found: dict[tuple[int, int], tuple[float, float]] = {}
    for one, other in combinations(sources, 2):
        if not cross(*(exact[vertex] for vertex in (*one, *other))):
            continue
        place = meeting(*(points[vertex] for vertex in (*one, *other)))
        for i, j in product(sources[one], sources[other]):
            found[min(i, j), max(i, j)] = place
    if found:
        rows = sorted(found)
        what = agreed(len(rows), "pair of segments crosses", "pairs of segments cross")
        raise CrossingSegmentsError(
            f"{len(rows)} {what}; first: {rows[0]}",
            pairs=rows,
            points=[found[pair] for pair in rows],
        )


def meeting(
    a: Sequence[Any], b: Sequence[Any], c: Sequence[Any], d: Sequence[Any]
) -> tuple[float, float]:
    """Return the point where the lines ab and cd, which are not parallel, meet, rounded once."""
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = map(exact_point, (a, b, c, d))
    ux, uy, vx, vy = bx - ax, by - ay, dx - cx, dy - cy
    t = Fraction((cx - ax) * vy - (cy - ay) * vx) / (ux * vy - uy * vx)
    return float(ax + t * ux), float(ay + t * uy)


def cross(a: ExactPoint, b: ExactPoint, c: ExactPoint, d: ExactPoint) -> bool:
    """Return whether ab and cd have one common point that is an end of neither.

    This is so if the ends of each lie strictly on both sides of the other.
    """
    apart = any(
        max(a[k], b[k]) < min(c[k], d[k]) or max(c[k], d[k]) < min(a[k], b[k]) for k in (0, 1)
    )
    if apart:  # this decides most pairs
        return False
    return orient(a, b, c) * orient(a, b, d) < 0 and orient(c, d, a) * orient(c, d, b) < 0


def insert_segment(points: Sequence[ExactPoint], apex: dict[Edge, int], a: int, b: int) -> None:
    """Flip the edges that cross ab, with no vertex between a and b, until ab is an edge.

    The next crossing edges to flip are those that end in the vertex w farthest to the left of ab;
    of these, the one whose other end is farthest to the right is flipped first; among equally far
    ones, the one farthest along ab. Therefore w is a corner of the convex hull of all triangles
    that ab crosses, and the other end is a corner of the hull of those among them that meet at w:
    at both ends the two triangles of the edge form an angle below 180 degrees, so together they
    form a strictly convex quadrilateral. A flip removes an edge from w and adds none to it, and the
    new edge ends in vertices that had crossing edges before, or in a and b. Each vertex on the left
    is therefore finished once, and all k edges are removed after O(k²) flips.
    """

    def far(w: int, side: int) -> tuple[ExactNumber, ExactNumber]:
        """The distances from ab to one side and along ab, both times the length of ab."""
        (ax, ay), (bx, by), (x, y) = points[a], points[b], points[w]
        dx, dy = bx - ax, by - ay
        return side * (dx * (y - ay) - dy * (x - ax)), dx * (x - ax) + dy * (y - ay)

    def leftmost(edge: Edge) -> tuple[tuple[ExactNumber, ExactNumber], ...]:
        left, right = max(edge, key=lambda w: far(w, 1)), min(edge, key=lambda w: far(w, 1))
        return far(left, 1), far(right, -1)

    crossing = edges_across(points, apex, a, b)
    while crossing:
        edge = max(crossing, key=leftmost)
        crossing.remove(edge)
        p, q = flip(apex, *edge)
        if cross(points[a], points[b], points[p], points[q]):
            crossing.append((p, q))


def edges_across(
    points: Sequence[ExactPoint], apex: Collection[Edge], a: int, b: int
) -> list[Edge]:
    """List the edges that cross ab, each once, the smaller vertex first."""
    return [(u, v) for u, v in apex if u < v and cross(points[a], points[b], points[u], points[v])]
