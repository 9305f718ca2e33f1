"""Bands with simpler borders: a border that two of them share is simplified once.

Borders between two bands are cut into lines at points where more than two of them meet, where
bands that are not neighbors in height meet, and at the outline of the surface, which stays as it
is. These lines are those of contours at the same levels, and `generalizing` leaves out the same
points in both. A point that is left out is no longer in any ring, so polygons still share their
points. Borders and contours may differ at the outline, where points are closer than the resolution
of coordinates.

If the line that remains is an edge of the outline, the polygon between them has no area, and is
left out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.terrain.generalizing import kept_points
from delone.terrain.small import Rings

if TYPE_CHECKING:
    from delone._base.types import Bools, Rows

__all__ = ["simplified_borders"]


class _Sides(NamedTuple):
    """The sides of rings, each from a vertex to the next one."""

    first: Rows  # positions in the points of the rings
    ring: Rows
    u: Rows  # numbers of vertices
    v: Rows
    rise: Rows  # by how many bands the polygon is higher than the one beyond
    outer: Bools  # whether no polygon is beyond


def simplified_borders(given: Rings, band: Rows, tolerance: float) -> tuple[Rings, Rows, int]:
    """Leave out points of borders that are within a distance of the remaining border.

    Return polygons, the rows of those that still have an area, and the number of points that were
    left out, each counted once.
    """
    places, vertex = np.unique(given.points, axis=0, return_inverse=True)
    vertex = vertex.ravel()
    sides = _sides(given, vertex, len(places), band)
    movable = _movable(sides, len(places))
    lines, starts = _lines(given, sides, vertex, movable)
    outline = places[np.stack((sides.u[sides.outer], sides.v[sides.outer]), axis=1)]
    kept = kept_points(places[lines], starts, tolerance, outline)
    gone = np.zeros(len(places), dtype=bool)
    gone[lines[~kept]] = True
    rings, rows = _without(given, gone[vertex])
    return rings, rows, int(gone.sum())


def _sides(given: Rings, vertex: Rows, count: int, band: Rows) -> _Sides:
    """Return the sides of all rings, and which polygon is beyond each."""
    polygon = np.repeat(np.arange(len(given.polygons) - 1), np.diff(given.polygons))
    first = np.delete(np.arange(len(vertex)), given.rings[1:] - 1)
    ring = np.repeat(np.arange(len(polygon)), np.diff(given.rings) - 1)
    u, v = vertex[first], vertex[first + 1]
    # Polygons are to the left of their sides; on the other side of u-v is the polygon of v-u.
    keys, wanted = u * np.int64(count) + v, v * np.int64(count) + u
    order = np.argsort(keys)
    at = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)]
    outer = keys[at] != wanted
    of = band[polygon[ring]].astype(np.int64)
    return _Sides(first, ring, u, v, np.where(outer, 0, of - of[at]), outer)


def _movable(sides: _Sides, count: int) -> Bools:
    """Return the vertices through which only one border, between neighboring bands, passes."""
    special = sides.outer | (np.abs(sides.rise) != 1)
    fixed = np.zeros(count, dtype=bool)
    fixed[sides.u[special]], fixed[sides.v[special]] = True, True
    # Both bands of a border contain the vertex once.
    found: Bools = ~fixed & (np.bincount(sides.u, minlength=count) == 2)
    return found


def _lines(given: Rings, sides: _Sides, vertex: Rows, movable: Bools) -> tuple[Rows, Rows]:
    """Return the borders as lines of vertices, with the higher polygon to their left.

    A border is part of the ring of its higher polygon. It runs between two vertices that stay; if
    the ring has none, the border is the whole ring.
    """
    size = np.diff(given.rings) - 1
    start = np.cumsum(size) - size
    # Rotate each ring, so that it begins with a vertex that stays, or with its smallest vertex.
    place = np.arange(len(sides.u)) - start[sides.ring]
    count = len(movable)
    key = np.minimum.reduceat(np.where(movable[sides.u], count + sides.u, place), start)
    turn = np.where(key < count, key, 0)
    smallest = np.flatnonzero(sides.u == (key - count)[sides.ring])
    turn[sides.ring[smallest]] = place[smallest]
    at = start[sides.ring] + (place + turn[sides.ring]) % size[sides.ring]
    u, v = sides.u[at], sides.v[at]
    # Sides between polygons of the same band are used once.
    level = (sides.rise[at] == 0) & ~sides.outer[at] & (u < v)
    wanted = (sides.rise[at] > 0) | level
    # A line begins where a ring begins, and at vertices that stay.
    begins = wanted & (~movable[u] | (place == 0))
    u, v, begins = u[wanted], v[wanted], begins[wanted]
    first = np.flatnonzero(begins)
    if not len(first):
        return first, np.zeros(1, dtype=np.int64)
    ends = np.append(first[1:], len(u))
    # Each line has one point more than it has sides.
    points = np.insert(u, ends, v[ends - 1])
    starts = np.append(first, len(u)) + np.arange(len(first) + 1)
    return points, starts


def _without(given: Rings, gone: Bools) -> tuple[Rings, Rows]:
    """Return rings without some of their points; those with fewer than three have no area."""
    last = np.zeros(len(gone), dtype=bool)
    last[given.rings[1:] - 1] = True
    kept = ~gone & ~last
    size = np.add.reduceat(kept.astype(np.int64), given.rings[:-1])
    polygon = np.repeat(np.arange(len(given.polygons) - 1), np.diff(given.polygons))
    flat = (size < 3)[given.polygons[:-1]]
    ring = (size >= 3) & ~flat[polygon]
    kept &= np.repeat(ring, np.diff(given.rings))
    size, of = size[ring], polygon[ring]
    # Each ring ends with its first point.
    ends = np.cumsum(size)
    points = given.points[kept]
    points = np.insert(points, ends, points[ends - size], axis=0)
    rows = np.flatnonzero(~flat)
    counts = np.bincount(of, minlength=len(flat))[rows]
    rings = np.concatenate(([0], ends + np.arange(1, len(ends) + 1)))
    return Rings(points, rings, np.concatenate(([0], np.cumsum(counts)))), rows
