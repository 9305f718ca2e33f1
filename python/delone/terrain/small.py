"""Small contours and small polygons between contours: what is left out, and what replaces it.

A polygon that fills a hole of another one becomes part of it, with everything inside. The polygons
inside are found by the sides that polygons share bit for bit, without geometry.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows

__all__ = ["Rings", "ring_areas", "without_small"]


class Rings(NamedTuple):
    """Polygons: points of rings, the start of each ring, and of each polygon in the rings."""

    points: Floats
    rings: Rows
    polygons: Rows


def ring_areas(points: Floats, starts: Rows) -> Floats:
    """Return the areas of closed lines, positive if counterclockwise; 0 for others, rounded."""
    if len(starts) < 2:
        return np.zeros(0)
    sizes = np.diff(starts)
    # Relative to the start of each, so that large coordinates lose no digits.
    x, y = (points - np.repeat(points[starts[:-1]], sizes, axis=0)).T
    twice = np.zeros(len(points))
    twice[1:] = x[:-1] * y[1:] - x[1:] * y[:-1]
    # Not from the end of a line to the start of the next.
    twice[starts[:-1]] = 0.0
    closed = (points[starts[:-1]] == points[starts[1:] - 1]).all(axis=1)
    return np.where(closed, np.add.reduceat(twice, starts[:-1]) / 2, 0.0)


def without_small(given: Rings, least: float) -> tuple[Rings, Rows]:
    """Leave out polygons in holes with an area below `least`; holes of the surface stay.

    Also return the rows of the polygons that remain.
    """
    owner = np.repeat(np.arange(len(given.polygons) - 1), np.diff(given.polygons))
    inner = np.ones(len(owner), dtype=bool)
    inner[given.polygons[:-1]] = False
    small = inner & (np.abs(ring_areas(given.points, given.rings)) < least)
    beside = _beside(given, owner)
    gone = np.zeros(len(given.polygons) - 1, dtype=bool)
    filled = np.zeros(len(owner), dtype=bool)
    for ring in np.flatnonzero(small).tolist():
        inside = _inside(beside, owner, ring, given.polygons)
        if inside is not None:
            filled[ring] = True
            gone[inside] = True
    rows = np.flatnonzero(~gone)
    return _only(given, ~filled & ~gone[owner], owner, rows), rows


def _beside(given: Rings, owner: Rows) -> list[Rows]:
    """Return for each ring the polygons on the other side of its sides, -1 where there are none."""
    _, vertex = np.unique(given.points, axis=0, return_inverse=True)
    vertex = vertex.ravel()
    first = np.delete(np.arange(len(vertex)), given.rings[1:] - 1)
    ring = np.repeat(np.arange(len(owner)), np.diff(given.rings) - 1)
    # Polygons are to the left of their sides; on the other side of u-v is the polygon of v-u.
    count = np.int64(len(vertex))
    keys = vertex[first].astype(np.int64) * count + vertex[first + 1]
    wanted = vertex[first + 1].astype(np.int64) * count + vertex[first]
    order = np.argsort(keys)
    at = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    found = np.where(keys[order][at] == wanted, owner[ring[order[at]]], -1)
    return np.split(found, np.cumsum(np.diff(given.rings) - 1)[:-1])


def _inside(beside: list[Rows], owner: Rows, ring: int, polygons: Rows) -> list[int] | None:
    """Return the polygons in a hole; None if a part of it is not covered by polygons."""
    around = int(owner[ring])
    found: set[int] = set()
    front = set(beside[ring].tolist())
    # Each round adds new polygons, so this terminates.
    while front:
        if -1 in front:
            return None
        found |= front
        after: set[int] = set()
        for polygon in front:
            for each in range(int(polygons[polygon]), int(polygons[polygon + 1])):
                after |= set(beside[each].tolist())
        front = after - found - {around}
    return sorted(found)


def _only(given: Rings, kept: Bools, owner: Rows, rows: Rows) -> Rings:
    """Return the rings that are kept of the polygons that are kept."""
    sizes = np.diff(given.rings)
    rings = np.concatenate(([0], np.cumsum(sizes[kept])))
    counts = np.bincount(owner[kept], minlength=len(given.polygons) - 1)[rows]
    points = np.ascontiguousarray(given.points[np.repeat(kept, sizes)])
    return Rings(points, rings, np.concatenate(([0], np.cumsum(counts))))
