"""Corners that rounding errors put beside sides of other cells, or beside other corners."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows

__all__ = ["NARROW", "ROUNDING", "beside", "merged"]

# What encloses less than this part of the smallest cell beside it comes from rounding errors, as
# overlaps of cells do.
ROUNDING = 1e-12
# So does what is narrower than this, in radians.
NARROW = 2e-15
# How many arcs are compared at a time, and with how many corners a part of one is.
_LOT, _FEW = 2**16, 32
# The smallest cubes that corners are sorted into are this power of two wide.
_FINEST = -18
_BITS = 20


def merged(places: Floats, ends: Rows, areas: Floats) -> Rows:
    """Return for each place the first one of those that are the same but for rounding errors.

    `ends` are the rows of places where arcs start and end, and `areas` those of their cells.
    """
    same = np.arange(len(places))
    row, vertex = _near(places, ends)
    smallest, longest = _at_corners(places, ends, areas)
    for end in ends[row].T:
        gap = np.linalg.norm(places[vertex] - places[end], axis=1)
        area = np.minimum(smallest[vertex], smallest[end])
        reach = np.maximum(longest[vertex], longest[end])
        # Triangles of the gap and a side.
        close = (gap <= NARROW) | (gap * reach <= 2 * ROUNDING * area)
        pairs = np.column_stack((same[vertex[close]], same[end[close]])).astype(np.int32)
        part = np.asarray(_core.graph_components(pairs, len(places)))
        first = np.full(len(places), len(places))
        np.minimum.at(first, part[same], np.arange(len(places)))
        same = first[part[same]]
    return same


def beside(places: Floats, ends: Rows, areas: Floats) -> tuple[Rows, Rows]:
    """Return arcs, ascending, and places that are on them but for rounding errors."""
    row, vertex = _near(places, ends)
    a, b, v = places[ends[row, 0]], places[ends[row, 1]], places[vertex]
    ahead = ((v - a) * (b - a)).sum(axis=1) > 0
    behind = ((v - b) * (a - b)).sum(axis=1) > 0
    # The area of the triangle; differences keep the digits of small ones.
    across = (np.cross(a - v, b - v) * v).sum(axis=1)
    along = 1 + (a * v).sum(axis=1) + (b * v).sum(axis=1) + (a * b).sum(axis=1)
    size = np.abs(2 * np.arctan2(across, along))
    area = np.minimum(areas[row], _at_corners(places, ends, areas)[0][vertex])
    width = NARROW / 2 * np.linalg.norm(b - a, axis=1)
    close = ahead & behind & (size <= np.maximum(ROUNDING * area, width))
    return row[close], vertex[close]


def _at_corners(places: Floats, ends: Rows, areas: Floats) -> tuple[Floats, Floats]:
    """Return the smallest cell and the longest arc at each place."""
    smallest, longest = np.full(len(places), np.inf), np.zeros(len(places))
    length = np.linalg.norm(places[ends[:, 0]] - places[ends[:, 1]], axis=1)
    for end in ends.T:
        np.minimum.at(smallest, end, areas)
        np.maximum.at(longest, end, length)
    return smallest, longest


def _near(places: Floats, ends: Rows) -> tuple[Rows, Rows]:
    """Return arcs, ascending, and places near them other than their ends, at least all on them."""
    used = np.unique(ends)
    cubes = _Cubes(places[used])
    found = []
    for begin in range(0, len(ends), _LOT):
        lot = ends[begin : begin + _LOT]
        arc = np.arange(begin, begin + len(lot))
        p, q = places[lot[:, 0]], places[lot[:, 1]]
        # Each turn halves parts of arcs that have many corners near them, down to the finest cubes.
        while len(arc):
            middle = p + q
            # Ends that are opposite but for rounding have the center of the sphere between them.
            middle /= np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-300)
            reach = np.linalg.norm(p - middle, axis=1) * 1.01 + 1e-9
            row, near, many = cubes.around(middle, reach)
            found.append(np.column_stack((arc[row], used[near])))
            arc = np.repeat(arc[many], 2)
            p, q = (
                np.stack((p[many], middle[many]), axis=1).reshape(-1, 3),
                np.stack((middle[many], q[many]), axis=1).reshape(-1, 3),
            )
    row, vertex = np.concatenate(found).T
    other = (vertex != ends[row, 0]) & (vertex != ends[row, 1])
    keys = np.unique(row[other] * len(places) + vertex[other])
    return keys // len(places), keys % len(places)


class _Cubes:
    """Points of the unit sphere, sorted into cubes of several sizes."""

    def __init__(self, points: Floats) -> None:
        self._points = points
        self._sorted: dict[int, tuple[Rows, Rows]] = {}

    def around(self, centers: Floats, reach: Floats) -> tuple[Rows, Rows, Bools]:
        """Return centers and the points within `reach` of each, and which centers have too many.

        The points of those are not returned, unless their cubes are the finest.
        """
        level = np.maximum(np.ceil(np.log2(reach)).astype(np.int64), _FINEST)
        rows, points = [np.empty(0, dtype=np.int64)], [np.empty(0, dtype=np.int64)]
        many = np.zeros(len(centers), dtype=bool)
        for each in np.unique(level).tolist():
            at = np.flatnonzero(level == each)
            keys, order = self._at(each)
            x, y, z = self._numbers(centers[at], each).T
            step = np.arange(-1, 2)
            base = (x[:, None, None] + step[:, None] << _BITS) + (y[:, None, None] + step)
            base = (base << _BITS) + z[:, None, None]
            low = np.searchsorted(keys, base.reshape(-1, 9) - 1)
            count = np.searchsorted(keys, base.reshape(-1, 9) + 1, side="right") - low
            if each > _FINEST:
                many[at] = count.sum(axis=1) > _FEW
                count[many[at]] = 0
            total = count.ravel()
            of = np.repeat(np.arange(len(total)), total)
            within = np.arange(len(of)) - np.repeat(np.cumsum(total) - total, total)
            row, point = at[of // 9], order[low.ravel()[of] + within]
            gap = np.linalg.norm(self._points[point] - centers[row], axis=1)
            near = gap <= reach[row]
            rows.append(row[near])
            points.append(point[near])
        return np.concatenate(rows), np.concatenate(points), many

    def _at(self, level: int) -> tuple[Rows, Rows]:
        """Return the numbers of the cubes of points, ascending, and the points in this order."""
        if level not in self._sorted:
            x, y, z = self._numbers(self._points, level).T
            keys = (((x << _BITS) + y) << _BITS) + z
            order = np.argsort(keys, kind="stable")
            self._sorted[level] = keys[order], order
        return self._sorted[level]

    def _numbers(self, points: Floats, level: int) -> Rows:
        numbers: Rows = np.floor(np.ldexp(points + 1.0, -level)).astype(np.int64) + 1
        return numbers
