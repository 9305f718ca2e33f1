"""Smooth contours that do not cross: corners are cut, and restored where lines would cross.

Corner cutting: G. Chaikin, "An algorithm for high-speed curve generation", Computer Graphics and
Image Processing 3 (1974). Each round replaces a corner by two points, on a quarter of the way to
its neighbors. Whether lines cross or meet is decided exactly, for all pairs; where two do and did
not before, the corners next to both are restored, and everything is cut again without them. Each
pass restores at least one corner, and with all corners the given lines are returned, so this
terminates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import CrossingSegmentsError
from delone.predicates import orient2d

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows
    from delone.terrain.surface import Surface

__all__ = ["smoothed"]

_SHARE = 0.25


def smoothed(points: Floats, starts: Rows, tin: Surface | None, rounds: int) -> tuple[Floats, Rows]:
    """Return lines with corners cut `rounds` times, and their starts.

    Corners on hard breaklines of the surface, if there is one, are kept.
    """
    if not len(points):
        return points, starts
    sharp = np.array(_repeated(points, starts))
    if tin is not None:
        sharp |= _on_hard_lines(points, tin)
    while True:  # each pass restores a corner
        cut, begin, corner = _cut(points, starts, sharp, rounds)
        if sharp.all():
            return cut, begin  # the given lines, which may cross
        crossing, met = _crossing(cut, begin)
        beside = np.unique(np.concatenate((corner[crossing], corner[crossing + 1])))
        if len(beside) and sharp[beside].all():
            # Only corners farther away are left.
            beside = np.unique(np.concatenate((beside - 1, beside + 1)))
            beside = beside[(beside >= 0) & (beside < len(sharp))]
            if sharp[beside].all():
                sharp[:] = True
        # Lines meet only where they did before, in corners that are kept, and on the same side.
        touched = corner[met]
        turned = corner[_changed_order(cut, begin, met)]
        beside = np.concatenate((beside, touched[~sharp[touched]], turned[~sharp[turned]]))
        if not len(beside):
            return cut, begin
        sharp[beside] = True


def _changed_order(points: Floats, starts: Rows, met: Rows) -> Rows:
    """Return the neighbors of points where two lines meet and the second changes its side.

    `met` are rows of points at the same place as others.
    """
    before, after, inner = _around(points, starts)
    met = met[inner[met]]
    _, place = np.unique(points[met], axis=0, return_inverse=True)
    order = np.argsort(place.ravel(), kind="stable")
    met, place = met[order], place.ravel()[order]
    found = [np.empty(0, dtype=np.int64)]
    # All pairs at a place: terminates, because places have finitely many rows.
    for step in range(1, len(met)):
        first = np.flatnonzero(place[step:] == place[:-step])
        if not len(first):
            break
        a, b = met[first], met[first + step]
        sides = [_side(points, before[a], a, after[a], other[b]) for other in (before, after)]
        crosses = sides[0] * sides[1] <= 0
        some = np.column_stack((before[a], after[a], before[b], after[b]))[crosses]
        found.append(some.ravel())
    return np.unique(np.concatenate(found))


def _side(points: Floats, p: Rows, v: Rows, q: Rows, x: Rows) -> NDArray[np.int8]:
    """Return on which side of the path from p over v to q points lie: 1 left, -1 right, 0 on it."""
    one = orient2d(points[p], points[v], points[x])
    two = orient2d(points[v], points[q], points[x])
    turn = orient2d(points[p], points[v], points[q])
    convex = np.where(turn > 0, np.minimum(one, two), np.maximum(one, two))
    found: NDArray[np.int8] = np.sign(convex).astype(np.int8)
    return found


def _on_hard_lines(points: Floats, tin: Surface) -> Bools:
    """Which points are on breaklines that are not soft, up to rounding."""
    hard = tin.breaklines[~tin.soft]
    if not len(hard):
        return np.zeros(len(points), dtype=bool)
    simplex = tin.locate(points)
    corners = tin.simplices[simplex.simplex]
    on = simplex.barycentric < 1e-9
    ends = corners[:, [[1, 2], [2, 0], [0, 1]]]
    keys = np.sort(ends, axis=2).astype(np.int64) @ np.array([tin.npoints, 1])
    lines = np.sort(hard, axis=1).astype(np.int64) @ np.array([tin.npoints, 1])
    return np.asarray((on & np.isin(keys, lines)).any(axis=1))


def _repeated(points: Floats, starts: Rows) -> Bools:
    """Return which points lines have in common, where they touch."""
    _, place, count = np.unique(points, axis=0, return_inverse=True, return_counts=True)
    last = starts[1:] - 1
    closed = (points[starts[:-1]] == points[last]).all(axis=1)
    count = count - np.bincount(place.ravel()[last[closed]], minlength=len(count))
    found: Bools = count[place.ravel()] > 1
    return found


def _cut(points: Floats, starts: Rows, sharp: Bools, rounds: int) -> tuple[Floats, Rows, Rows]:
    """Cut corners; also return the corner from which each point comes."""
    corner = np.arange(len(points))
    for _ in range(rounds):
        first, last = starts[:-1], starts[1:] - 1
        closed = (points[first] == points[last]).all(axis=1)
        keep = sharp[corner]
        end = np.zeros(len(points), dtype=bool)
        end[first] = end[last] = True
        before, after, _ = _around(points, starts)
        whole = keep | (end & ~np.isin(np.arange(len(points)), np.r_[first[closed], last[closed]]))
        # The last point of a closed line is its first one.
        drop = np.zeros(len(points), dtype=bool)
        drop[last[closed]] = True
        number = np.where(drop, 0, np.where(whole, 1, 2))
        at = np.concatenate(([0], np.cumsum(number)))
        found = np.empty((at[-1], 2))
        source = np.repeat(corner, number)
        one, two = np.flatnonzero(number == 1), np.flatnonzero(number == 2)
        found[at[one]] = points[one]
        found[at[two]] = points[two] + _SHARE * (points[before[two]] - points[two])
        found[at[two] + 1] = points[two] + _SHARE * (points[after[two]] - points[two])
        points, starts, corner = _reclosed(found, at[first], at[last + 1], closed, source)
    return points, starts, corner


def _around(points: Floats, starts: Rows) -> tuple[Rows, Rows, Bools]:
    """Return the rows before and after each point of a line, and whether there are both."""
    first, last = starts[:-1], starts[1:] - 1
    closed = (points[first] == points[last]).all(axis=1)
    before, after = np.arange(len(points)) - 1, np.arange(len(points)) + 1
    before[first] = np.where(closed, last - 1, first)
    after[last] = np.where(closed, first + 1, last)
    inner = np.ones(len(points), dtype=bool)
    inner[first] = closed
    # The last point of a closed line is its first one.
    inner[last] = False
    return before, after, inner


def _reclosed(
    points: Floats, first: Rows, stop: Rows, closed: Bools, corner: Rows
) -> tuple[Floats, Rows, Rows]:
    """Let closed lines end with their first points again."""
    at = stop[closed]
    grown = np.insert(points, at, points[first[closed]], axis=0)
    corners = np.insert(corner, at, corner[first[closed]])
    lengths = stop - first + closed
    return grown, np.concatenate(([0], np.cumsum(lengths))), corners


def _crossing(points: Floats, starts: Rows) -> tuple[Rows, Rows]:
    """Return the starts of segments that cross others, and the points that meet others.

    Both as rows of `points`; if segments cross, not all points that meet others are known yet.
    """
    row = np.arange(len(points) - 1)
    row = np.delete(row, starts[1:-1] - 1)
    try:
        mesh = ConstrainedDelaunay(points, np.column_stack((row, row + 1)), planar=True)
    except CrossingSegmentsError as error:
        found: Rows = np.unique(row[error.pairs])
        return found, found[:0]
    # A line that now passes through a point of another touches it where it did not before.
    found = np.unique(row[mesh.report.through[:, 0]]).astype(np.int64)
    first, last = starts[:-1], starts[1:] - 1
    closed = (points[first] == points[last]).all(axis=1)
    ends = np.zeros(len(points), dtype=bool)
    ends[last[closed]] = True
    count = np.bincount(mesh.duplicate_of[~ends], minlength=len(points))
    return found, np.flatnonzero((count[mesh.duplicate_of] > 1) & ~ends)
