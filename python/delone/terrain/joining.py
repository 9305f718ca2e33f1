"""Merging of points and lines of a survey that are closer to each other than `snap`."""

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
    """Points and lines after merging, which points remain, how many moved, and how far."""

    points: Floats  # (n, 3), all of them
    kept: Bools  # (n,), False for those that are now part of a line, or on a shore
    lines: Lines
    points_leveled: int  # on shores of level polygons, which are left out
    points_moved: int
    line_points_moved: int
    largest_move: float


def joined(points: Floats, lines: Lines, limit: float, policy: str, tolerance: float) -> Joined:
    """Merge points of lines, then points with lines, then points with each other.

    Points merged with the shore of a level polygon are left out, because the shore has one height.
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
    lines, closed = _with_ends(lines, fixed, limit, tolerance)
    moves.append(closed)
    first = first._replace(places=np.ascontiguousarray(lines.points[:, :2]))
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
        int(first.moved.sum()) + int((closed > 0).sum()),
        max(float(each.max(initial=0.0)) for each in moves),
    )


def _at(places: Floats, known: Floats) -> Bools:
    """Return which places are equal to one of others."""
    _, number = np.unique(np.concatenate((known, places)), axis=0, return_inverse=True)
    found: Bools = np.isin(number[len(known) :], number[: len(known)])
    return found


def _from_smaller(places: Floats, segments: Indices) -> Indices:
    """Return segments from the smaller end, so that rounding does not depend on the direction."""
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
    """Let lines replace points next to them.

    A line without heights gets a point there. A line with heights is unchanged if the heights
    agree; otherwise, the policy decides.
    """
    a, b = lines.segments[segment].T
    start, way = lines.points[a], lines.points[b] - lines.points[a]
    foot = start + share[:, None] * way
    z = points[row, 2]
    without = lines.draped[a] & lines.draped[b]
    differs = ~without & (np.abs(z - foot[:, 2]) > tolerance)
    if differs.any() and policy == "raise":
        low, high = np.minimum(z, foot[:, 2])[differs], np.maximum(z, foot[:, 2])[differs]
        rows = np.column_stack((row[differs], row[differs]))
        places = points[row[differs], :2]
        raise conflict(places, rows, low, high, "a line and a point", "duplicates")
    both = np.stack((z, foot[:, 2]))
    resolved = {"min": both.min(axis=0), "max": both.max(axis=0)}.get(policy, both.mean(axis=0))
    foot[:, 2] = np.where(without, z, resolved)
    added = np.flatnonzero(without | differs)
    return _through(lines, foot[added], without[added], segment[added], share[added])


def _with_ends(lines: Lines, fixed: Bools, limit: float, tolerance: float) -> tuple[Lines, Floats]:
    """Move ends of lines onto the sides of others that they nearly reach, and return how far.

    The other line gets a point there. If heights agree, the point has that of the end; otherwise,
    heights are compared as where lines cross.
    """
    own = np.flatnonzero(lines.kinds != HULL)
    places, number = np.unique(lines.points[:, :2], axis=0, return_inverse=True)
    number = number.reshape(-1)
    count = np.bincount(number[lines.segments[own]].ravel(), minlength=len(places))
    used = np.unique(lines.segments[own])
    ends = used[(count[number[used]] == 1) & ~fixed[used]]
    row, segment, share, distance = near_segments(
        lines.points[ends, :2], lines.points[lines.segments[own]][..., :2], limit
    )
    if not len(row):
        return lines, distance
    end, segment = ends[row], own[segment]
    a, b = lines.segments[segment].T
    foot = lines.points[a] + share[:, None] * (lines.points[b] - lines.points[a])
    without = lines.draped[a] & lines.draped[b]
    z = lines.points[end, 2]
    slack = tolerance + 8 * np.spacing(np.abs(z))
    same = ~without & ~lines.draped[end] & (np.abs(z - foot[:, 2]) <= slack)
    foot[same, 2] = z[same]
    points = lines.points.copy()
    points[end, :2] = foot[:, :2]
    moved = lines._replace(points=points)
    return _through(moved, foot, without, segment, share), distance


def _through(lines: Lines, foot: Floats, without: Bools, segment: Rows, share: Floats) -> Lines:
    """Route segments through points at given fractions of their lengths."""
    if not len(foot):
        return lines
    added = np.lexsort((foot[:, 2], share, segment))
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
