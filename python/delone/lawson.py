"""Lawson's flips: turn any triangulation of points into the Delaunay triangulation, step by step.

The core flips; this module coerces what goes in and, where asked, computes the angles after each
flip from exact integers.

Lawson, C. L. (1977), "Software for C1 surface interpolation", in Mathematical Software III, edited
by J. R. Rice, Academic Press, 161-194.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from delone import _core
from delone._arrays import as_flag, as_points, as_simplices
from delone.counting import counted
from delone.errors import LimitError
from delone.immutable import ReadOnly

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

    IntegerPoint: TypeAlias = tuple[int, int]

__all__ = ["LawsonResult", "lawson"]

# 128 MiB of angles: for example 3,700 flips of 1,500 triangles.
_MOST_ANGLES = 2**24


@dataclass(frozen=True, eq=False, kw_only=True)
class LawsonResult(ReadOnly):
    """A triangulation made Delaunay, and the flips that it took. The arrays are read-only.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 3)
        The Delaunay triangles, counter-clockwise. Triangles that no flip touched are in their old
        rows.
    neighbors : ndarray of int32, shape (m, 3)
        The triangle opposite each vertex, -1 outside.
    flips : int
        How many edges were flipped.
    sequence : ndarray of int32, shape (flips, 4), or None
        For each flip u, v, p, q: the edge uv, with p on its left and q on its right, became pq.
        None where it was not recorded.
    angles : ndarray of float64, shape (flips + 1, 3 m), or None
        All angles of all triangles in radians, in ascending order: before the first flip and after
        each. None where it was not recorded.

    Examples
    --------
    >>> from delone import lawson
    >>> result = lawson([(0, 0), (3, -1), (6, 0), (3, 1)], [(0, 1, 2), (0, 2, 3)])
    >>> result
    <LawsonResult: 2 triangles after 1 flip>
    """

    simplices: Indices
    neighbors: Indices
    flips: int
    sequence: Indices | None = None
    angles: Floats | None = None

    def __repr__(self) -> str:
        triangles = counted(len(self.simplices), "triangle")
        return f"<LawsonResult: {triangles} after {counted(self.flips, 'flip')}>"


def lawson(points: ArrayLike, simplices: ArrayLike, *, record: bool = False) -> LawsonResult:
    """Make a triangulation the Delaunay triangulation of its points by flipping edges.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Finite coordinates, in any unit.
    simplices : array_like of int, shape (m, 3)
        Triangles, counter-clockwise, that tile the convex hull of `points` and have each distinct
        point for a vertex. Of equal points any one may be the vertex, and stays it.
    record : bool, optional
        Whether to record each flip, and the angles before and after each.

    Returns
    -------
    LawsonResult
        Triangles, neighbours, the number of flips and, where recorded, the flips and the angles.

    Raises
    ------
    ShapeError
        The triangles do not tile the convex hull: one is not counter-clockwise, two lie on the same
        side of an edge, a point is no vertex, or the boundary is not the hull. The message names
        the first culprit.
    DegenerateInputError
        There are no triangles, and the points span none.
    NonFiniteError
        A coordinate is NaN or infinite.
    LimitError
        The record would hold more than 2**24 angles, (flips + 1) times 3 m.
    InputError, DtypeError
        An index is no row of `points`, or an array does not hold numbers.

    Notes
    -----
    An edge uv with the opposite vertices p and q is flipped where q lies inside the circle of u, v
    and p. If all four lie on the circle, it is flipped where the lexicographically smallest of
    them is p or q. The end is the triangulation of `Delaunay`, whatever the start.

    Each flip lowers the surface of the triangles lifted to x² + y²; an edge that is flipped away
    lies above that surface for good. So there are at most n (n - 1) / 2 flips, a bound of the right
    order: the fan of n points of a parabola from the first of them takes about n² / 4. The
    predicates are exact.

    The angles of the record are those of the exact triangles, rounded. At a flip of an edge whose
    circle holds the opposite vertex in its inside, the smallest of the six angles of the two
    triangles gets larger, so the sorted angles rise lexicographically (Lawson 1977; Sibson, R.,
    1978, "Locally equiangular triangulations", The Computer Journal 21). At a flip on a tie they
    need not: four of the six angles are inscribed angles over the sides of the quadrilateral and
    stay, the smallest of all six among them; the other two, which add up to pi, change to two that
    add up to pi and may be larger or smaller. Hence the smallest angle of all never falls, and the
    whole vector falls at ties alone. ``delone.predicates.incircle`` tells which flips are ties.

    Examples
    --------
    The long diagonal of a rhomb becomes the short one:

    >>> import numpy as np
    >>> from delone import lawson
    >>> rhomb = [(0, 0), (3, -1), (6, 0), (3, 1)]
    >>> result = lawson(rhomb, [(0, 1, 2), (0, 2, 3)], record=True)
    >>> result.flips, result.sequence.tolist()
    (1, [[2, 0, 1, 3]])
    >>> np.degrees(result.angles[:, 0]).round(1).tolist()
    [18.4, 36.9]
    """
    points = as_points(points, ndim=2)
    simplices = as_simplices(simplices, len(points), 2)
    made = _core.lawson2(points, simplices, as_flag(record, name="record"))
    sequence = made.sequence
    return LawsonResult(
        simplices=made.simplices,
        neighbors=made.neighbors,
        flips=made.flips,
        sequence=sequence,
        angles=None if sequence is None else _angles(points, simplices, sequence),
    )


def _angles(points: Floats, simplices: Indices, sequence: Indices) -> Floats:
    """Replay the flips and list the sorted angles before the first and after each."""
    shape = (len(sequence) + 1, simplices.size)
    if shape[0] * shape[1] > _MOST_ANGLES:
        raise LimitError(
            f"{len(sequence)} flips of {len(simplices)} triangles have {shape[0] * shape[1]} "
            f"angles, more than the {_MOST_ANGLES} that can be recorded; record fewer triangles"
        )
    exact = _integers(points)
    triangles = simplices.tolist()
    angles = np.array([_corners(*(exact[v] for v in t)) for t in triangles])
    place = {frozenset(t): i for i, t in enumerate(triangles)}
    table = np.empty(shape)
    table[0] = np.sort(angles, axis=None)
    for row, (u, v, p, q) in enumerate(sequence.tolist(), start=1):
        for old, new in (((u, v, p), (p, u, q)), ((v, u, q), (q, v, p))):
            at = place.pop(frozenset(old))
            place[frozenset(new)] = at
            angles[at] = _corners(*(exact[w] for w in new))
        table[row] = np.sort(angles, axis=None)
    return table


def _integers(points: Floats) -> list[IntegerPoint]:
    """Multiply all coordinates by one power of two that makes them integers."""
    ratios = [(x.as_integer_ratio(), y.as_integer_ratio()) for x, y in points.tolist()]
    unit = max(denominator for pair in ratios for _, denominator in pair)
    return [(a * (unit // b), c * (unit // d)) for (a, b), (c, d) in ratios]


def _corners(a: IntegerPoint, b: IntegerPoint, c: IntegerPoint) -> list[float]:
    """Return the angles of a counter-clockwise triangle, each rounded from its exact tangent."""
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    angles = []
    for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
        dot = (q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1])
        # Integers beyond the range of doubles divide to the nearest double.
        scale = max(area, abs(dot))
        angles.append(math.atan2(area / scale, dot / scale))
    return angles
