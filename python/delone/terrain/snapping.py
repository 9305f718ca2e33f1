"""Making points and segments coincide if they differ only by rounding errors.

Otherwise, a polygon whose edge is meant to be on edges of a surface would leave triangles of the
ground next to it that are as narrow as a rounding error, with heights of the ground next to those
of the polygon.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Floats, Rows
    from delone.terrain.pads import Pad
    from delone.terrain.surface import Surface

__all__ = ["closeness", "settled", "threaded"]

# Distances of at most this many rounding errors count as zero.
_ROUNDINGS = 64
# Number of pairs that are compared at a time.
_PAIRS = 1 << 20
_EPS = float(np.finfo(np.float64).eps)


def closeness(*points: Floats) -> float:
    """Return the distance below which points coincide, from the largest coordinate."""
    return _ROUNDINGS * _EPS * max(float(np.abs(each).max()) for each in points)


def settled(pad: Pad, tin: Surface) -> Pad:
    """Return a pad whose points are replaced by points of a surface that are that close."""
    limit = closeness(tin.points, pad.points)
    nearest = tin.points[tin.nearest(pad.points)]
    close = np.abs(nearest - pad.points).max(axis=1) <= limit
    return pad._replace(points=np.where(close[:, None], nearest, pad.points))


def threaded(points: Floats, segments: Rows, vertices: Rows) -> tuple[Rows, Rows]:
    """Return segments routed through the vertices close to them, and the row of each."""
    row, share, vertex = _beside(points, segments, vertices)
    order = np.lexsort((vertex, share, row))
    row, vertex = row[order], vertex[order]
    passed = np.unique(row)
    whole = np.setdiff1d(np.arange(len(segments)), passed)
    # Chains: the start of each segment, its vertices, its end.
    owner = np.concatenate((passed, row, passed))
    kind = np.repeat((0, 1, 2), (len(passed), len(row), len(passed)))
    chain = np.concatenate((segments[passed, 0], vertex, segments[passed, 1]))
    order = np.lexsort((np.arange(len(owner)), kind, owner))
    owner, chain = owner[order], chain[order]
    same = owner[1:] == owner[:-1]
    pieces = np.column_stack((chain[:-1], chain[1:]))[same]
    return np.concatenate((segments[whole], pieces)), np.concatenate((whole, owner[:-1][same]))


def _beside(points: Floats, segments: Rows, vertices: Rows) -> tuple[Rows, Floats, Rows]:
    """Return segments, fractions along them, and the vertices that are close to them there.

    Vertices are compared only with segments whose x range contains theirs.
    """
    limit = closeness(points)
    order = vertices[np.argsort(points[vertices, 0], kind="stable")]
    x = points[order, 0]
    ends = points[segments]
    low = np.searchsorted(x, ends[:, :, 0].min(axis=1) - limit, side="left")
    high = np.searchsorted(x, ends[:, :, 0].max(axis=1) + limit, side="right")
    total = np.cumsum(high - low)
    found = [(np.empty(0, dtype=np.int64), np.empty(0), np.empty(0, dtype=np.int64))]
    start = 0
    # Each block has at least one segment, so this terminates.
    while start < len(segments):
        before = total[start - 1] if start else 0
        stop = max(start + 1, int(np.searchsorted(total, before + _PAIRS, side="right")))
        count = (high - low)[start:stop]
        row = start + np.repeat(np.arange(len(count)), count)
        place = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count) + low[row]
        found.append(_close(points, ends, row, order[place], limit))
        start = stop
    row, share, vertex = (np.concatenate(column) for column in zip(*found, strict=True))
    return row, share, vertex


def _close(
    points: Floats, ends: Floats, row: Rows, vertex: Rows, limit: float
) -> tuple[Rows, Floats, Rows]:
    """Return close pairs of segments and vertices, with the fraction along the segment."""
    a, b = ends[row, 0], ends[row, 1]
    along = b - a
    length = np.hypot(*along.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = along / length[:, None]
        from_a = points[vertex] - a
        way = (from_a * unit).sum(axis=1)
        across = np.abs(unit[:, 0] * from_a[:, 1] - unit[:, 1] * from_a[:, 0])
        share = way / length
    near = np.flatnonzero((across <= limit) & (way > limit) & (way < length - limit))
    return row[near], share[near], vertex[near]
