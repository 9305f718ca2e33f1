"""Lawson's flips: turn any triangulation of points into the Delaunay triangulation, step by step.

The core flips edges; this module validates the input and, if requested, computes the angles after
each flip from exact integers.

Lawson, C. L. (1977), "Software for C1 surface interpolation", in Mathematical Software III, edited
by J. R. Rice, Academic Press, 161-194.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from delone import _core
from delone._base.arrays import as_flag, as_points, as_simplices
from delone._base.counting import counted
from delone._base.immutable import ReadOnly
from delone.errors import LimitError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices

    IntegerPoint: TypeAlias = tuple[int, int]

__all__ = ["LawsonResult", "lawson"]

# 128 MiB of angles: for example, 3,700 flips of 1,500 triangles.
_MOST_ANGLES = 2**24


@dataclass(frozen=True, eq=False, kw_only=True)
class LawsonResult(ReadOnly):
    """A triangulation made Delaunay, and the flips required. The arrays are read-only.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 3)
        The Delaunay triangles, counter-clockwise. Triangles that no flip changed keep their rows.
    neighbors : ndarray of int32, shape (m, 3)
        The triangle opposite each vertex, -1 outside.
    flips : int
        Number of flipped edges.
    sequence : ndarray of int32, shape (flips, 4), or None
        For each flip u, v, p, q: the edge uv, with p on its left and q on its right, became pq.
        None if it was not recorded.
    angles : ndarray of float64, shape (flips + 1, 3 m), or None
        All angles of all triangles in radians, in ascending order: before the first flip and after
        each. None if it was not recorded.

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
        Counter-clockwise triangles that tile the convex hull of `points` and have each distinct
        point as a vertex. Of equal points, any one may be the vertex, and remains it.
    record : bool, optional
        Whether to record each flip, and the angles before and after each.

    Returns
    -------
    LawsonResult
        Triangles, neighbors, the number of flips and, if recorded, the flips and the angles.

    Raises
    ------
    ShapeError
        The triangles do not tile the convex hull: one is not counter-clockwise, two lie on the same
        side of an edge, a point is not a vertex, or the boundary is not the hull. The message names
        the first fault.
    DegenerateInputError
        There are no triangles, and the points span no area.
    NonFiniteError
        A coordinate is NaN or infinite.
    LimitError
        The record would contain more than 2**24 angles, (flips + 1) times 3 m.
    InputError, DtypeError
        An index is not a row of `points`, or an array is not numeric.

    Notes
    -----
    An edge uv with the opposite vertices p and q is flipped if q lies inside the circle of u, v and
    p. If all four are cocircular, it is flipped if the lexicographically smallest of them is p or
    q. The result is the triangulation of `Delaunay`, whatever the start.

    Each flip lowers the surface of the triangles lifted to x² + y², and a flipped edge lies above
    that surface from then on. Therefore there are at most n (n - 1) / 2 flips. The bound has the
    right order of magnitude: a fan of n points (x, x²) from the first of them can take nearly n² /
    2. The predicates are exact.

    The recorded angles are those of the exact triangles, rounded. If an edge is flipped because the
    opposite vertex is strictly inside the circle, the smallest of the six angles of the two
    triangles increases, so the sorted angles increase lexicographically (Lawson 1977; Sibson, R.,
    1978, "Locally equiangular triangulations", The Computer Journal 21). When a tie is flipped,
    they may not: four of the six angles are inscribed angles over the sides of the quadrilateral
    and remain, including the smallest of all six; the other two, which add up to pi, change to two
    that add up to pi and may be larger or smaller. Hence the smallest angle of all never decreases,
    and the whole vector decreases only at ties. ``delone.predicates.incircle`` identifies flips of
    ties.

    Examples
    --------
    The long diagonal of a rhombus is replaced by the short one:

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
    """Replay the flips and return the sorted angles before the first and after each."""
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
    """Multiply all coordinates by a power of two that makes them integers."""
    ratios = [(x.as_integer_ratio(), y.as_integer_ratio()) for x, y in points.tolist()]
    unit = max(denominator for pair in ratios for _, denominator in pair)
    return [(a * (unit // b), c * (unit // d)) for (a, b), (c, d) in ratios]


def _corners(a: IntegerPoint, b: IntegerPoint, c: IntegerPoint) -> list[float]:
    """Return the angles of a counter-clockwise triangle, each rounded from its exact tangent."""
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    angles = []
    for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
        dot = (q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1])
        # The quotient of integers beyond the range of doubles is the nearest double.
        scale = max(area, abs(dot))
        angles.append(math.atan2(area / scale, dot / scale))
    return angles
