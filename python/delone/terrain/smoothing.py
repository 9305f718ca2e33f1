"""Smooth contours that do not cross: corners are cut, and restored where lines would cross.

Corner cutting: G. Chaikin, "An algorithm for high-speed curve generation", Computer Graphics and
Image Processing 3 (1974). Each round replaces a corner by two points, on a quarter of the way to
its neighbors. Whether lines cross is decided exactly, for all pairs; where two do, the corners next
to both are restored, and everything is cut again without them. Each pass restores at least one
corner, and without cut corners nothing crosses, so this terminates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import CrossingSegmentsError

if TYPE_CHECKING:
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
        crossing = _crossing(cut, begin)
        if not len(crossing):
            return cut, begin
        beside = np.unique(np.concatenate((corner[crossing], corner[crossing + 1])))
        if sharp[beside].all():
            # Only corners farther away are left.
            beside = np.unique(np.concatenate((beside - 1, beside + 1)))
            beside = beside[(beside >= 0) & (beside < len(sharp))]
            if sharp[beside].all():
                sharp[:] = True
        sharp[beside] = True


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
        before, after = np.arange(len(points)) - 1, np.arange(len(points)) + 1
        before[first] = np.where(closed, last - 1, first)
        after[last] = np.where(closed, first + 1, last)
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


def _reclosed(
    points: Floats, first: Rows, stop: Rows, closed: Bools, corner: Rows
) -> tuple[Floats, Rows, Rows]:
    """Let closed lines end with their first points again."""
    at = stop[closed]
    grown = np.insert(points, at, points[first[closed]], axis=0)
    corners = np.insert(corner, at, corner[first[closed]])
    lengths = stop - first + closed
    return grown, np.concatenate(([0], np.cumsum(lengths))), corners


def _crossing(points: Floats, starts: Rows) -> Rows:
    """Return the starts of segments that cross others, as rows of `points`."""
    row = np.arange(len(points) - 1)
    row = np.delete(row, starts[1:-1] - 1)
    try:
        mesh = ConstrainedDelaunay(points, np.column_stack((row, row + 1)), planar=True)
    except CrossingSegmentsError as error:
        found: Rows = np.unique(row[error.pairs])
        return found
    # A line that now passes through a point of another touches it where it did not before.
    found = np.unique(row[mesh.report.through[:, 0]]).astype(np.int64)
    return found
