"""Points and lines of a survey are merged where they are nearer to each other than `snap`."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.terrain.gathering import BOUNDARY, HULL, LEVEL, SOFT, Lines
from delone.terrain.heights import conflict
from delone.terrain.merging import merged, near_segments, onto

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Indices, Rows

__all__ = ["Joined", "joined"]


class Joined(NamedTuple):
    """Points and lines after merging, which points remain, and how many moved how far."""

    points: Floats  # (n, 3), all of them
    kept: Bools  # (n,), False for those that are part of a line now, or on a shore
    lines: Lines
    points_leveled: int  # on shores of level polygons, which are left out
    points_moved: int
    line_points_moved: int
    largest_move: float


def joined(points: Floats, lines: Lines, limit: float, policy: str, tolerance: float) -> Joined:
    """Merge points of lines, then points with lines, then points with each other.

    Points that are merged with a shore of a level polygon are left out: it has one height.
    """
    places = lines.points[:, :2]
    fixed = np.zeros(len(places), dtype=bool)
    fixed[lines.segments[lines.kinds >= BOUNDARY]] = True
    soft = np.ones(len(places), dtype=bool)
    soft[lines.segments[lines.kinds != SOFT]] = False
    order = np.empty(len(places), dtype=np.int64)
    by = (lines.points[:, 2], places[:, 1], places[:, 0], soft, lines.draped, ~fixed)
    order[np.lexsort(by)] = np.arange(len(places))
    first = merged(places, order, limit, fixed)
    moves = [np.hypot(*(first.places - places)[first.moved].T)]
    lines = lines._replace(
        points=np.column_stack((first.places, lines.points[:, 2])),
        segments=_from_smaller(first.places, lines.segments),
    )
    used = lines.segments[lines.kinds != HULL]
    # Points of lines, then their sides, then other points.
    vertices = first.places[np.unique(used)]
    second = onto(points[:, :2], vertices, limit)
    shores = first.places[np.unique(lines.segments[lines.kinds == LEVEL])]
    leveled = second.moved & _at(second.places, shores)
    away = np.hypot(*(second.places - points[:, :2])[~leveled].T)
    rest = np.flatnonzero(~second.moved)
    ends = first.places[used]
    row, segment, share, distance = near_segments(points[rest, :2], ends, limit)
    row, segment = rest[row], np.flatnonzero(lines.kinds != HULL)[segment]
    beside = lines.kinds[segment] != LEVEL
    leveled[row[~beside]] = True
    row, segment, share, distance = (each[beside] for each in (row, segment, share, distance))
    lines = _threaded(points, lines, row, segment, share, policy, tolerance)
    kept = ~leveled
    kept[row] = False
    alone = np.flatnonzero(kept & ~second.moved)
    rank = np.empty(len(alone), dtype=np.int64)
    rank[np.lexsort(points[alone].T[::-1])] = np.arange(len(alone))
    third = merged(points[alone, :2], rank, limit)
    moves += [away, distance, np.hypot(*(third.places - points[alone, :2]).T)]
    found = points.copy()
    found[second.moved, :2] = second.places[second.moved]
    found[alone, :2] = third.places
    return Joined(
        found,
        kept,
        lines,
        int(leveled.sum()),
        int((away > 0).sum()) + len(row) + int(third.moved.sum()),
        int(first.moved.sum()),
        max(float(each.max(initial=0.0)) for each in moves),
    )


def _at(places: Floats, known: Floats) -> Bools:
    """Which places are equal to one of others."""
    _, number = np.unique(np.concatenate((known, places)), axis=0, return_inverse=True)
    found: Bools = np.isin(number[len(known) :], number[: len(known)])
    return found


def _from_smaller(places: Floats, segments: Indices) -> Indices:
    """Return segments from the smaller end on, so that no direction is rounded differently."""
    (ax, ay), (bx, by) = places[segments[:, 0]].T, places[segments[:, 1]].T
    turned = (ax > bx) | ((ax == bx) & (ay > by))
    return np.where(turned[:, None], segments[:, ::-1], segments)


def _threaded(  # noqa: PLR0917
    points: Floats,
    lines: Lines,
    row: Rows,
    segment: Rows,
    share: Floats,
    policy: str,
    tolerance: float,
) -> Lines:
    """Let lines take the place of points beside them.

    A line without heights gets a point there. One with heights stays as it is if they agree; else
    the policy decides.
    """
    a, b = lines.segments[segment].T
    start, way = lines.points[a], lines.points[b] - lines.points[a]
    foot = start + share[:, None] * way
    z = points[row, 2]
    without = lines.draped[a] & lines.draped[b]
    differs = ~without & (np.abs(z - foot[:, 2]) > tolerance)
    if differs.any() and policy == "raise":
        low, high = np.minimum(z, foot[:, 2])[differs], np.maximum(z, foot[:, 2])[differs]
        raise conflict(
            points[row[differs], :2], row[differs], low, high, "a line and a point", "duplicates"
        )
    both = np.stack((z, foot[:, 2]))
    resolved = {"min": both.min(axis=0), "max": both.max(axis=0)}.get(policy, both.mean(axis=0))
    foot[:, 2] = np.where(without, z, resolved)
    added = np.flatnonzero(without | differs)
    if not len(added):
        return lines
    added = added[np.lexsort((z[added], share[added], segment[added]))]
    number = len(lines.points) + np.arange(len(added))
    # Each further point comes after the start of its segment, in the order along it.
    count = np.bincount(segment[added], minlength=len(lines.segments)) + 1
    owner = np.repeat(np.arange(len(lines.segments)), count)
    first = np.cumsum(count) - count
    place = np.arange(len(added)) - np.searchsorted(segment[added], segment[added])
    at = first[segment[added]] + place
    segments = lines.segments[owner]
    segments[at, 1] = segments[at + 1, 0] = number
    return Lines(
        np.concatenate((lines.points, foot[added])),
        np.concatenate((lines.draped, without[added])),
        segments,
        lines.kinds[owner],
        lines.polygons[owner],
    )
