"""Simplified lines that do not cross and stay on the same side of all other lines.

A point between two others is left out if no other point of any line, and no vertex of the outline,
is inside or on the triangle of the three, which is decided exactly. Moving the line across an
empty triangle is an isotopy: no line crosses another one, itself or the outline, closed lines still
enclose what they enclosed, and lines that touch still touch at the same points, because two points
are never joined twice. This is the condition of A. Saalfeld, "Topologically consistent line
simplification with the Douglas-Peucker algorithm", CaGIS 26 (1999), for one point at a time, in the
way in which M. Visvalingam and J. Whyatt leave out points (The Cartographic Journal 30, 1993).

Every point that is left out is within the tolerance of the segment that replaces it. In each round,
points are left out that deviate less than both of their neighbors; ties are broken by coordinates.
The triangles of such points remain empty when others are left out, so that one round equals leaving
them out one by one.

Points where lines touch are kept, and divide lines into parts. A closed line without such points
keeps the first of its points by coordinates. So the result depends on the points of lines, but not
on where they begin or how they are joined, and borders of bands get the same points as contours.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.predicates import orient2d

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows

__all__ = ["kept_points", "simplified"]

# Number of points in boxes of triangles that are compared at a time.
_PAIRS = 1 << 22
# Cells are rebuilt when less than this fraction of their points is left.
_WORTH = 0.6
# The minimum number of distinct points of a closed line.
_LEAST = 3
# Closed lines with at most this many distinct points lose one point per round.
_FEW = 2 * _LEAST


@dataclass(eq=False)
class _State:
    """Points of all lines, and which of them are left."""

    points: Floats
    number: Rows  # points at the same place have the same number
    fixed: Bools
    last: Bools  # where a line ends, or follows the outline
    part: Rows  # the number of each part between fixed points
    closed: Bools  # of each part
    alive: Bools
    blocker: Rows  # a point in the triangle of each point, -1 if none is known
    deviation: Floats  # what leaving out each point would cost, NaN if that has to be computed
    cells: _Cells | None = None  # of the points left when they were built


def simplified(
    points: Floats, starts: Rows, tolerance: float, outline: Floats | None = None
) -> tuple[Floats, Rows]:
    """Return lines with fewer points, within a distance of all points that are left out.

    Closed lines may start at a different point. Lines stay on their side of an outline, edges (k,
    2, 2).
    """
    if len(starts) < 2:
        return points, starts
    points = points[_turned(points, starts, outline)]
    alive = kept_points(points, starts, tolerance, outline)
    counts = np.add.reduceat(alive.astype(np.int64), starts[:-1])
    return points[alive], np.concatenate(([0], np.cumsum(counts)))


def kept_points(
    points: Floats, starts: Rows, tolerance: float, outline: Floats | None = None
) -> Bools:
    """Return which points of lines remain; closed lines keep the one at which they begin."""
    if len(starts) < 2:
        return np.ones(len(points), dtype=bool)
    count = len(points)
    state = _state(*_with_vertices(points, starts, outline), outline)
    # Each round leaves out a point, or finds a blocker, which remains one until a point is left
    # out.
    while _round(state, tolerance):
        pass
    return state.alive[:count]


def _with_vertices(points: Floats, starts: Rows, outline: Floats | None) -> tuple[Floats, Rows]:
    """Return lines together with the vertices of the outline, each as a line of one point."""
    if outline is None or not len(outline):
        return points, starts
    corners = np.unique(outline.reshape(-1, 2), axis=0)
    ends = np.arange(1, len(corners) + 1) + len(points)
    return np.concatenate((points, corners)), np.concatenate((starts, ends))


def _turned(points: Floats, starts: Rows, outline: Floats | None) -> Rows:
    """Return points in an order in which closed lines begin where they touch something.

    If they touch nothing, they begin at the point with the smallest coordinates.
    """
    first, last = starts[:-1], starts[1:] - 1
    closed = (points[first] == points[last]).all(axis=1) & (last > first)
    number, single = _numbers(*_with_vertices(points, starts, outline))
    touching = (np.bincount(number[single], minlength=len(number))[number] > 1)[: len(points)]
    number, single = number[: len(points)], single[: len(points)]
    # Numbers follow coordinates.
    key = np.where(touching, number, number + number.max() + 1)
    best = np.minimum.reduceat(key, first)
    line = np.repeat(np.arange(len(first)), np.diff(starts))
    at = np.flatnonzero((key == best[line]) & single)[::-1]
    begin = first.copy()
    begin[line[at]] = at
    begin = np.where(closed, begin, first)
    size = np.where(closed, last - first, last - first + 1)[line]
    place = np.arange(len(points)) - first[line]
    found: Rows = first[line] + (place + (begin - first)[line]) % size
    return found


def _numbers(points: Floats, starts: Rows) -> tuple[Rows, Bools]:
    """Return a number for each place, in the order of coordinates.

    The second result is False where a closed line ends: its two ends are one point.
    """
    order = np.lexsort((points[:, 1], points[:, 0]))
    new = (np.diff(points[order], axis=0) != 0).any(axis=1)
    number = np.empty(len(points), dtype=np.int64)
    number[order] = np.concatenate(([0], np.cumsum(new)))
    first, last = starts[:-1], starts[1:] - 1
    single = np.ones(len(points), dtype=bool)
    single[last[(number[first] == number[last]) & (last > first)]] = False
    return number, single


def _state(points: Floats, starts: Rows, outline: Floats | None) -> _State:
    first, last = starts[:-1], starts[1:] - 1
    # Where lines touch, both keep the point.
    number, single = _numbers(points, starts)
    fixed = np.bincount(number[single], minlength=len(points))[number] > 1
    fixed[first], fixed[last] = True, True
    # The points between two fixed ones belong to the part that begins at the first of these.
    part = np.cumsum(fixed) - 1
    ends = np.flatnonzero(fixed)
    closed = number[ends] == number[np.append(ends[1:], ends[:1])]
    end = np.zeros(len(points), dtype=bool)
    end[last] = True
    if outline is not None:
        # Where a line follows the outline, so may another one, with nothing between them.
        at = np.flatnonzero(fixed[:-1] & fixed[1:] & ~end[:-1])
        end[at[_among(points, at, outline)]] = True
    return _State(
        points,
        number,
        fixed,
        end,
        part,
        closed,
        np.ones(len(points), dtype=bool),
        np.full(len(points), -1, dtype=np.int64),
        np.full(len(points), np.nan),
    )


def _among(points: Floats, at: Rows, edges: Floats) -> Bools:
    """Return which sides of lines, by the rows where they begin, are among edges."""
    sides = np.stack((points[at], points[at + 1]), axis=1)
    both = np.concatenate((sides, edges))
    swap = (both[:, 0, 0] > both[:, 1, 0]) | (
        (both[:, 0, 0] == both[:, 1, 0]) & (both[:, 0, 1] > both[:, 1, 1])
    )
    both = np.where(swap[:, None, None], both[:, ::-1], both).reshape(-1, 4)
    _, number = np.unique(both, axis=0, return_inverse=True)
    number = number.ravel()
    return np.isin(number[: len(at)], number[len(at) :])


def _round(state: _State, tolerance: float) -> bool:
    """Leave out points; False if none can be left out."""
    rows = np.flatnonzero(state.alive)
    place = np.flatnonzero(~state.fixed[rows])
    u, v, w = rows[place - 1], rows[place], rows[place + 1]
    new = np.isnan(state.deviation[v])
    state.deviation[v[new]] = _deviations(state.points, u[new], w[new])
    deviation = state.deviation[v]
    # Including the fixed point at which the part begins.
    counts = np.bincount(state.part[rows], minlength=len(state.closed))
    few = state.closed & (counts <= _FEW)
    enough = ~(state.closed & (counts <= _LEAST))[state.part[v]]
    possible = (deviation <= tolerance) & enough & (state.blocker[v] < 0)
    chosen = _independent(state.points, rows, place[possible], deviation[possible])
    chosen = _one_of_few(state, v[possible], deviation[possible], chosen, few)
    if not chosen.any():
        return False
    u, v, w = (each[possible][chosen] for each in (u, v, w))
    found = _inside(state, rows, u, v, w)
    twice = _joined_twice(state, rows, u, v, w)
    # Until one of its neighbors is left out, nothing changes for such a point.
    found[twice] = v[twice]
    state.blocker[v] = found
    gone = v[found < 0]
    state.alive[gone] = False
    # Triangles with a removed corner have changed, and points in others may have been removed.
    beside = np.concatenate((u[found < 0], w[found < 0]))
    state.blocker[beside] = -1
    state.deviation[beside] = np.nan
    freed = (state.blocker >= 0) & ~state.alive[state.blocker]
    state.blocker[freed] = -1
    return True


def _deviations(points: Floats, u: Rows, w: Rows) -> Floats:
    """Return the largest distance of the points between rows u and w from the segment u-w."""
    counts = w - u - 1
    owner = np.repeat(np.arange(len(u)), counts)
    between = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts) + u[owner] + 1
    a, way = points[u], points[w] - points[u]
    size = (way**2).sum(axis=1)
    away = points[between] - a[owner]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (away * way[owner]).sum(axis=1) / size[owner]
    share = np.where(size[owner] > 0, np.clip(share, 0.0, 1.0), 0.0)
    distance = np.hypot(*(away - share[:, None] * way[owner]).T)
    found: Floats = np.maximum.reduceat(distance, np.cumsum(counts) - counts) if len(u) else size
    return found


def _independent(points: Floats, rows: Rows, place: Rows, deviation: Floats) -> Bools:
    """Return which points deviate less than those of their neighbors that may also be left out."""
    rank = np.full(len(rows) + 1, np.iinfo(np.int64).max)
    x, y = points[rows[place]].T
    order = np.lexsort((y, x, deviation))
    rank[place[order]] = np.arange(len(place))
    found: Bools = (rank[place] < rank[place - 1]) & (rank[place] < rank[place + 1])
    return found


def _one_of_few(state: _State, v: Rows, deviation: Floats, chosen: Bools, few: Bools) -> Bools:
    """In closed parts with few points, keep only the first of the chosen points."""
    rows = np.flatnonzero(chosen & few[state.part[v]])
    x, y = state.points[v[rows]].T
    order = rows[np.lexsort((y, x, deviation[rows], state.part[v[rows]]))]
    again = np.diff(state.part[v[order]], prepend=-1) == 0
    found = chosen.copy()
    found[order[again]] = False
    return found


def _joined_twice(state: _State, rows: Rows, u: Rows, v: Rows, w: Rows) -> Bools:
    """Return the points without which two fixed points would be joined twice."""
    found = np.zeros(len(u), dtype=bool)
    some = np.flatnonzero(state.fixed[u] & state.fixed[w])
    if not len(some):
        return found
    side = np.flatnonzero(state.fixed[rows[:-1]] & state.fixed[rows[1:]] & ~state.last[rows[:-1]])
    known = _joints(state, rows[side], rows[side + 1])
    wanted = _joints(state, u[some], w[some])
    # Of several in this round, the first by coordinates.
    order = np.lexsort((state.number[v[some]], wanted))
    again = np.zeros(len(some), dtype=bool)
    again[order[1:]] = np.diff(wanted[order]) == 0
    found[some] = again | np.isin(wanted, known)
    return found


def _joints(state: _State, a: Rows, b: Rows) -> Rows:
    """Return a number for each pair of places."""
    one, other = state.number[a], state.number[b]
    found: Rows = np.minimum(one, other) * np.int64(len(state.points)) + np.maximum(one, other)
    return found


def _inside(state: _State, rows: Rows, u: Rows, v: Rows, w: Rows) -> NDArray[np.int64]:
    """Return a point inside or on each triangle other than its corners, -1 if there is none."""
    points = state.points
    corners = points[np.stack((u, v, w))]
    low, high = corners.min(axis=0), corners.max(axis=0)
    cells = state.cells
    # Removed points are skipped until there are many of them.
    if cells is None or len(rows) < _WORTH * len(cells.order):
        cells = state.cells = _Cells.of(points, rows, low, high)
    found = np.full(len(u), -1, dtype=np.int64)
    total = cells.counts(low, high)
    ends = np.cumsum(total)
    start = 0
    # Each block has at least one triangle, so this terminates.
    while start < len(u):
        before = ends[start - 1] if start else 0
        stop = max(start + 1, int(np.searchsorted(ends, before + _PAIRS, side="right")))
        part = slice(start, stop)
        triangle, point = cells.pairs(low[part], high[part])
        triangle += start
        p = points[point]
        inside = ((p >= low[triangle]) & (p <= high[triangle])).all(axis=1) & state.alive[point]
        for corner in corners:
            inside &= (p != corner[triangle]).any(axis=1)
        triangle, point = triangle[inside], point[inside]
        a, b, c = (corner[triangle] for corner in corners)
        p = points[point]
        signs = np.stack([orient2d(*ends_, p) for ends_ in ((a, b), (b, c), (c, a))])
        on = (signs >= 0).all(axis=0) | (signs <= 0).all(axis=0)
        # Of several the first by coordinates, whatever the order of lines.
        triangle, point, (x, y) = triangle[on], point[on], p[on].T
        order = np.lexsort((y, x, triangle))[::-1]
        found[triangle[order]] = point[order]
        start = stop
    return found


class _Cells(NamedTuple):
    """Points in the cells of a grid, row by row, as ranges of a sorted array."""

    origin: Floats
    size: Floats
    columns: int
    rows: int
    start: Rows
    order: Rows

    @classmethod
    def of(cls, points: Floats, rows: Rows, low: Floats, high: Floats) -> _Cells:
        """Sort points into cells about as large as boxes, not many more cells than points."""
        places = points[rows]
        origin = places.min(axis=0)
        extent = np.maximum(places.max(axis=0) - origin, np.finfo(float).tiny)
        most = max(1, int(np.sqrt(len(rows))))
        box = np.maximum(np.median(high - low, axis=0), extent / (4 * most))
        shape = np.clip(np.ceil(extent / box), 1, 4 * most).astype(np.int64)
        columns, count = int(shape[0]), int(shape[1])
        size = extent / shape
        cell = _cell(places, origin, size, shape)
        key = cell[:, 1] * columns + cell[:, 0]
        order = np.argsort(key, kind="stable")
        start = np.concatenate(([0], np.cumsum(np.bincount(key, minlength=columns * count))))
        return cls(origin, size, columns, count, start, rows[order])

    def _spans(self, low: Floats, high: Floats) -> tuple[Rows, Rows, Rows]:
        """Return the ranges of points in the rows of cells that boxes meet, and the boxes."""
        shape = np.array((self.columns, self.rows))
        first, last = (_cell(each, self.origin, self.size, shape) for each in (low, high))
        height = last[:, 1] - first[:, 1] + 1
        box = np.repeat(np.arange(len(low)), height)
        row = np.arange(len(box)) - np.repeat(np.cumsum(height) - height, height) + first[box, 1]
        start = self.start[row * self.columns + first[box, 0]]
        stop = self.start[row * self.columns + last[box, 0] + 1]
        return box, start, stop

    def counts(self, low: Floats, high: Floats) -> Rows:
        """Return the number of points in the cells of each box."""
        box, start, stop = self._spans(low, high)
        return np.bincount(box, stop - start, minlength=len(low)).astype(np.int64)

    def pairs(self, low: Floats, high: Floats) -> tuple[Rows, Rows]:
        """Return boxes and the points in their cells."""
        box, start, stop = self._spans(low, high)
        sizes = stop - start
        at = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        return np.repeat(box, sizes), self.order[np.repeat(start, sizes) + at]


def _cell(
    places: Floats, origin: Floats, size: Floats, shape: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Return the column and row of places; monotone, so the cells of a box cover what is inside."""
    found: NDArray[np.int64] = np.floor((places - origin) / size).astype(np.int64)
    return np.clip(found, 0, shape - 1)
