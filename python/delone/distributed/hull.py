"""The strictly extreme points of a set, piece by piece: the hull of hulls is the hull.

Most points lie in a polygon of 8 extreme ones, with certainty, and are left out; of the rest the
core's triangulation has the hull (S. G. Akl and G. T. Toussaint, "A fast convex hull algorithm",
1978).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone.distributed.rows import coordinates
from delone.errors import DegenerateInputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.distributed.rows import Rows

    Floats = NDArray[np.float64]
    Numbers = NDArray[np.int64]

__all__ = ["extreme_rows"]

# Points at a time, whose coordinates stay in the cache.
_BLOCK = 1 << 15


def extreme_rows(rows: Rows) -> Rows:
    """Return the rows that are strictly extreme, of equal ones the first.

    They are the corners of the hull; the two ends of a line; one row where all are equal.
    """
    if not len(rows):
        return rows
    points = coordinates(rows)
    kept = _outside(points)
    return rows[np.sort(kept[_corners(points[kept])])]


def _outside(points: Floats) -> Numbers:
    """Rows of points that a polygon of 8 of them does not certainly exclude, ascending."""
    if len(points) < 64:
        return np.arange(len(points))
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        # Which are chosen is a matter of speed alone: any points make a polygon of points.
        x, y = points[:, 0], points[:, 1]
        ways = (x, y, x / 2 + y / 2, x / 2 - y / 2)
        far = {int(end(way)) for way in ways for end in (np.argmin, np.argmax)}
        corners = points[sorted(far)]
        corners = corners[_corners(corners)]
        if len(corners) < 3:
            return np.arange(len(points))
        blocks = [points[start : start + _BLOCK] for start in range(0, len(points), _BLOCK)]
        kept = np.concatenate([~_inside(_around(corners), block) for block in blocks])
    return np.flatnonzero(kept)


def _inside(polygon: Floats, points: Floats) -> NDArray[np.bool_]:
    """Which points certainly lie strictly left of all sides: none of those is extreme."""
    inside = np.ones(len(points), dtype=bool)
    x, y = points[:, 0].copy(), points[:, 1].copy()
    for (ax, ay), (bx, by) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        left, right = (bx - ax) * (y - ay), (by - ay) * (x - ax)
        # Shewchuk's bound is 3.4e-16 of the sum; the last term is beyond all underflow.
        inside &= left - right > 1e-15 * (np.abs(left) + np.abs(right)) + 1e-290
    return inside


def _around(corners: Floats) -> Floats:
    """Corners of a convex polygon, counter-clockwise, by exact turns."""
    order = np.lexsort((corners[:, 1], corners[:, 0]))
    first, last, middle = corners[order[0]], corners[order[-1]], corners[order[1:-1]]
    a, b = (np.broadcast_to(end, middle.shape).copy() for end in (first, last))
    below = _core.orient2d(a, b, np.ascontiguousarray(middle)) < 0
    return np.concatenate([[first], middle[below], [last], middle[~below][::-1]])


def _corners(points: Floats) -> Numbers:
    """Rows of the strictly extreme points, of equal ones the first."""
    try:
        simplices, neighbors, _, _ = _core.triangulate2(points, "auto", 1)
    except DegenerateInputError as error:
        chain = error.chain
        return chain[[0, -1]] if len(chain) > 1 else chain[:1]
    t, k = np.nonzero(neighbors < 0)
    tail, head = simplices[t, (k + 1) % 3], simplices[t, (k + 2) % 3]
    after = np.empty(len(points), dtype=np.int64)
    after[tail] = head
    beyond = after[head]
    a, b, c = (np.ascontiguousarray(points[v]) for v in (tail, head, beyond))
    turns = _core.orient2d(a, b, c)
    return head[turns > 0].astype(np.int64)
