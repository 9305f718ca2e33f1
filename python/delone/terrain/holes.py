"""Holes of polygons between contours, each in the polygon around it.

Where the resolution of coordinates is coarse, points of contours are merged, and a narrow part of a
band becomes a point: one polygon becomes several that touch. The core returns these one after
another, and assigns all of their holes to the last one. Here, such holes are compared with the
outer rings, exactly, and each is assigned to the innermost polygon around it.

A hole is represented by a point just to the right of its leftmost vertex, inside the hole. The
point is inside a ring if an odd number of sides of the ring are below it. Rings and holes never
cross, so a side through that vertex is below the point if a side of the hole at the vertex is above
the side.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from delone.errors import InternalError
from delone.predicates import orient2d
from delone.terrain.small import Rings

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows

__all__ = ["with_holes_inside"]

# Pairs of a hole and a side that are compared at once.
_PAIRS = 1 << 20


def with_holes_inside(given: Rings, band: Rows) -> Rings:
    """Return the same polygons, each with the holes that are inside its outer ring."""
    owner = np.repeat(np.arange(len(band)), np.diff(given.polygons))
    outer = np.zeros(len(owner), dtype=bool)
    outer[given.polygons[:-1]] = True
    holes = _doubtful(given, band, owner)
    if not len(holes):
        return given
    corners = _corners(given, holes)
    wrong = ~_inside(given, owner[holes], corners)
    for row in np.flatnonzero(wrong).tolist():
        same = np.flatnonzero(band == band[owner[holes[row]]])
        owner[holes[row]] = _around(given, same, corners[:, row])
    return _sorted(given, owner, outer) if wrong.any() else given


def _doubtful(given: Rings, band: Rows, owner: Rows) -> Rows:
    """Return the holes that may belong to an earlier polygon of the band, one without holes."""
    counts = np.diff(given.polygons)
    # For each polygon with holes, the first of the polygons without holes just before it.
    begin = np.searchsorted(band, band)
    last = np.flatnonzero(counts > 1)
    begin[last] = np.maximum(begin[last], np.concatenate(([0], last[:-1] + 1)))
    last = last[begin[last] < last]
    if not len(last):
        return last
    low = np.minimum.reduceat(given.points, given.rings[:-1], axis=0)
    high = np.maximum.reduceat(given.points, given.rings[:-1], axis=0)
    first = given.polygons[:-1]
    # The box around all polygons before each; every other result of reduceat is not needed.
    runs = np.stack((begin[last], last), axis=1).ravel()
    left = np.full((len(band), 2), np.inf)
    right = -left
    left[last] = np.minimum.reduceat(low[first], runs, axis=0)[::2]
    right[last] = np.maximum.reduceat(high[first], runs, axis=0)[::2]
    within = ((low >= left[owner]) & (high <= right[owner])).all(axis=1)
    return np.setdiff1d(np.flatnonzero(within), first)


def _outer_points(given: Rings, polygons: Rows) -> tuple[Rows, Rows]:
    """Return the positions of the points of outer rings, without the last ones, and the ring."""
    starts = given.rings[given.polygons[polygons]]
    sizes = given.rings[given.polygons[polygons] + 1] - starts - 1
    ring = np.repeat(np.arange(len(polygons)), sizes)
    at = np.arange(len(ring)) - np.repeat(np.cumsum(sizes) - sizes, sizes) + starts[ring]
    return at, ring


def _corners(given: Rings, holes: Rows) -> Floats:
    """Return the leftmost vertices of holes and the vertices before and after, (3, h, 2)."""
    starts = given.rings[holes]
    sizes = given.rings[holes + 1] - starts - 1
    hole = np.repeat(np.arange(len(holes)), sizes)
    place = np.arange(len(hole)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    x, y = given.points[starts[hole] + place].T
    # Sorted by hole, then by coordinates: the first of each hole.
    order = np.lexsort((y, x, hole))
    least = place[order[np.cumsum(sizes) - sizes]]
    around = [(least + step) % sizes for step in (0, -1, 1)]
    found: Floats = given.points[starts + np.stack(around)]
    return found


def _inside(given: Rings, polygon: Rows, corners: Floats) -> Bools:
    """Return whether each hole is inside the outer ring of a polygon.

    Sides are sorted into strips by x, so that each hole meets the sides of one strip.
    """
    rows, which = np.unique(polygon, return_inverse=True)
    a, b, of = _sides(given, rows)
    count = np.bincount(of, minlength=len(rows))
    # About as many strips as a strip has sides.
    strips = np.maximum(1, np.sqrt(count).astype(np.int64))
    first = np.cumsum(strips) - strips
    start = np.cumsum(count) - count
    low, high = np.minimum.reduceat(a[:, 0], start), np.maximum.reduceat(b[:, 0], start)
    # Coordinates are halved, so that the largest ones do not overflow.
    width = np.maximum(high / 2 - low / 2, np.finfo(float).tiny)

    def strip(x: Floats, ring: Rows) -> Rows:
        """Return strips, monotone in x: a side is in the strips of all places above or below it."""
        share = np.clip((x / 2 - low[ring] / 2) / width[ring], 0.0, 1.0)
        within = np.floor(share * strips[ring]).astype(np.int64)
        found: Rows = first[ring] + np.minimum(within, strips[ring] - 1)
        return found

    left, right = strip(a[:, 0], of), strip(b[:, 0], of)
    spans = right - left + 1
    side = np.repeat(np.arange(len(of)), spans)
    key = np.arange(len(side)) - np.repeat(np.cumsum(spans) - spans, spans) + left[side]
    order = np.argsort(key, kind="stable")
    ends = np.cumsum(np.bincount(key, minlength=int(strips.sum())))
    mine = strip(corners[0, :, 0], which)
    stop = ends[mine]
    sizes = stop - np.where(mine > 0, ends[mine - 1], 0)
    below = np.zeros(len(polygon), dtype=np.int64)
    done = np.cumsum(sizes)
    begin = 0
    # Each block has at least one hole, so this terminates.
    while begin < len(polygon):
        before = done[begin - 1] if begin else 0
        end = max(begin + 1, int(np.searchsorted(done, before + _PAIRS, side="right")))
        size = sizes[begin:end]
        hole = np.repeat(np.arange(begin, end), size)
        at = np.arange(len(hole)) - np.repeat(np.cumsum(size), size) + stop[hole]
        meets = _below(a[side[order[at]]], b[side[order[at]]], corners[:, hole])
        below += np.bincount(hole[meets], minlength=len(below))
        begin = end
    found: Bools = below % 2 == 1
    return found


def _sides(given: Rings, polygons: Rows) -> tuple[Floats, Floats, Rows]:
    """Return the sides of outer rings that are not vertical, from left to right, and their ring."""
    at, of = _outer_points(given, polygons)
    a, b = given.points[at], given.points[at + 1]
    wide = a[:, 0] != b[:, 0]
    a, b, of = a[wide], b[wide], of[wide]
    swap = (a[:, 0] > b[:, 0])[:, None]
    return np.where(swap, b, a), np.where(swap, a, b), of


def _below(a: Floats, b: Floats, corners: Floats) -> Bools:
    """Return whether sides are below the points that represent holes, exactly."""
    at, before, after = corners
    found: Bools = (a[:, 0] <= at[:, 0]) & (at[:, 0] < b[:, 0])
    rows = np.flatnonzero(found)
    a, b = a[rows], b[rows]
    side = orient2d(a, b, at[rows]).astype(np.int64)
    on = np.flatnonzero(side == 0)
    for neighbor in (before, after):
        side[on] += orient2d(a[on], b[on], neighbor[rows[on]])
    found[rows] = side > 0
    return found


def _around(given: Rings, polygons: Rows, corner: Floats) -> int:
    """Return the innermost of some polygons whose outer ring is around a hole."""
    a, b, of = _sides(given, polygons)
    meets = _below(a, b, np.broadcast_to(corner[:, None], (3, len(of), 2)))
    around = polygons[np.bincount(of[meets], minlength=len(polygons)) % 2 == 1]
    if not len(around):
        raise InternalError("a hole between contours is in no polygon")
    # Outer rings around the same hole are nested, because they do not cross.
    rows: list[int] = around.tolist()
    return min(rows, key=lambda row: _area(given, row))


def _area(given: Rings, polygon: int) -> Fraction:
    """Return twice the area inside an outer ring, exactly."""
    ring = int(given.polygons[polygon])
    points = given.points[given.rings[ring] : given.rings[ring + 1]].tolist()
    exact = [(Fraction(x), Fraction(y)) for x, y in points]
    return sum((a * d - b * c for (a, b), (c, d) in pairwise(exact)), Fraction(0))


def _sorted(given: Rings, owner: Rows, outer: Bools) -> Rings:
    """Return rings in the order of their polygons, outer ones first."""
    order = np.lexsort((~outer, owner))
    sizes = np.diff(given.rings)[order]
    rings = np.concatenate(([0], np.cumsum(sizes)))
    at = np.arange(rings[-1]) + np.repeat(given.rings[order] - rings[:-1], sizes)
    counts = np.bincount(owner)
    return Rings(given.points[at], rings, np.concatenate(([0], np.cumsum(counts))))
