"""Clipped 2-D cells: the core cuts them to boxes and outlines, shapely in degenerate cases.

A cell is convex, and most cells of a clipped diagram lie entirely inside or outside. The core cuts
all cells to a box slightly larger than the outline, finds the cells near the outline, and joins the
others into groups on one side of it; one point of each group decides which side. Only the cells
near the outline are cut to it: by the core if exact signs decide (`pieces`), by shapely if
corners and edges of both coincide (`overlay`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone.exchange.geopandas import shapely_or_say
from delone.voronoi import pieces, torus
from delone.voronoi.outline import next_corner, times
from delone.voronoi.overlay import as_polygons, intersections, with_shared_corners

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone._core import Diagram2
    from delone.voronoi.outline import Clip
    from delone.voronoi.torus import PeriodicDual

__all__ = ["Clipped", "cells"]

_OUTSIDE, _INSIDE, _CUT = 0, 1, 2


class Clipped:
    """The clipped cells, convex polygons in the order of the cells, and their measures.

    `ridges` contains the ridge along which each edge lies. `areas` and `perimeters`, (c,), are
    infinite for unbounded cells; `centroids`, (c, 2), are NaN for unbounded and empty ones.
    """

    def __init__(
        self, starts: Indices, corners: Floats, ridges: Indices, ridge_count: int, workers: int
    ) -> None:
        self.starts, self.corners, self.ridges = starts, corners, ridges
        self.ridge_count = ridge_count
        measures = _core.measures2(starts, corners, workers)
        self.areas, self.centroids = measures.areas, measures.centroids
        self.perimeters = measures.perimeters

    def _next(self) -> NDArray[np.int64]:
        """Return the corner after each corner."""
        return next_corner(self.starts, len(self.corners))

    def _edge_lengths(self) -> Floats:
        """Return the length of the edge from each corner to the next."""
        return _distances(self.corners, self.corners[self._next()])

    def ridge_sizes(self) -> Floats:
        """Return the length of each clipped ridge; infinite for an unbounded one."""
        lengths = np.zeros(self.ridge_count)
        along = self.ridges >= 0
        lengths[self.ridges[along]] = self._edge_lengths()[along]
        return lengths

    def edges(self) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return all boundaries: cell, begin and end of each edge, the cell to its left."""
        owner = np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))
        return owner, self.corners, self.corners[self._next()]

    def parts(self, cell: int) -> tuple[tuple[Floats, ...], ...]:
        """Return the rings of each part of a cell."""
        ring = self.corners[self.starts[cell] : self.starts[cell + 1]]
        return ((ring,),) if len(ring) > 2 else ()

    def simple(self) -> tuple[Indices, Floats, NDArray[np.int64]]:
        """Return polygons without holes as compressed rows, and the cell of each.

        Together they cover the cells.
        """
        rows = np.flatnonzero(np.diff(self.starts) > 2)
        return *_taken(self.starts, self.corners, rows), rows

    def polygons(self) -> NDArray[Any]:
        """Return the cells as geometries."""
        return as_polygons(self.starts, self.corners)


class _Bounded(Clipped):
    """The bounded cells without a clip; the measures of the others are infinite."""

    def __init__(self, dual: Diagram2, workers: int) -> None:
        starts, vertices = dual.region_starts, dual.region_vertices
        sizes = np.diff(starts)
        gaps = np.concatenate(([0], np.cumsum(vertices < 0)))
        self._unbounded = (gaps[starts[1:]] > gaps[starts[:-1]]) | (sizes == 0)
        kept = np.repeat(~self._unbounded, sizes)
        sizes[self._unbounded] = 0
        bounded = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        super().__init__(
            bounded,
            dual.vertices[vertices[kept]],
            dual.region_ridges[kept],
            len(dual.sites),
            workers,
        )
        self._dual = dual
        self.areas[self._unbounded] = np.inf
        self.perimeters[self._unbounded] = np.inf

    def ridge_sizes(self) -> Floats:
        ends = self._dual.ends
        lengths = np.full(len(ends), np.inf)
        finite = (ends >= 0).all(axis=1)
        first, second = self._dual.vertices[ends[finite]].swapaxes(0, 1)
        lengths[finite] = _distances(first, second)
        return lengths

    def polygons(self) -> NDArray[Any]:
        found = super().polygons()
        found[self._unbounded] = None
        return found


class _InOutline(Clipped):
    """Cells cut to an outline: by the core if exact signs decide, otherwise by shapely."""

    def __init__(self, whole: Clipped, clip: Clip, workers: int) -> None:
        super().__init__(whole.starts, whole.corners, whole.ridges, whole.ridge_count, workers)
        # Cells on the outline are in these units, all others in those of the points.
        self._scale = clip.unit
        self._outline = clip.scaled
        corners = whole.corners * clip.unit
        self._side = _sides(whole, corners, clip)
        rows = np.flatnonzero(self._side == _CUT)
        found = pieces.cut(whole.starts, corners, whole.ridges, rows, clip, workers=workers)
        self._side[rows] = found.sides(_OUTSIDE, _INSIDE, _CUT)
        self._pieces = found
        self._doubtful = rows[found.doubtful]
        self._overlaid = self._overlay(self._doubtful, found.corners)
        self._measure(rows)

    def _overlay(self, rows: NDArray[np.int64], known: Floats) -> NDArray[Any]:
        """Intersect some of the cells with the outline as geometries."""
        if not len(rows):
            return np.empty(0, dtype=object)
        starts, corners = _taken(self.starts, self.corners * self._scale, rows)
        cut = intersections(as_polygons(starts, corners), self._outline)
        return with_shared_corners(cut, np.concatenate((corners, known)), self._outline)

    def _measure(self, rows: NDArray[np.int64]) -> None:
        shapely = shapely_or_say()
        outside = self._side == _OUTSIDE
        self.areas[outside] = self.perimeters[outside] = 0
        self.centroids[outside] = np.nan
        found, traced = self._pieces, self._pieces.traced
        with np.errstate(over="ignore"):
            self.areas[rows[traced]] = found.areas[traced] / self._scale / self._scale
        self.perimeters[rows[traced]] = found.perimeters[traced] / self._scale
        self.centroids[rows[traced]] = found.centroids[traced] / self._scale
        if len(self._doubtful):
            cut = self._overlaid
            self.areas[self._doubtful] = shapely.area(cut) / self._scale / self._scale
            self.perimeters[self._doubtful] = shapely.length(cut) / self._scale
            centers = shapely.centroid(cut)
            centers[shapely.is_empty(centers)] = shapely.Point(np.nan, np.nan)
            self.centroids[self._doubtful] = shapely.get_coordinates(centers) / self._scale

    def _geometries(self) -> tuple[NDArray[np.int64], NDArray[Any]]:
        """Return the cells on the outline, and the clipped geometry of each."""
        if self._cut is None:
            rows, traced = self._pieces.polygons()
            wrong = np.flatnonzero(~shapely_or_say().is_valid(traced))
            if len(wrong):
                # Rings that touch themselves, possibly because of rounding.
                traced[wrong] = self._overlay(rows[wrong], self._pieces.corners)
            rows = np.concatenate((rows, self._doubtful))
            order = np.argsort(rows)
            found = np.concatenate((traced, self._overlaid))[order]
            self._cut = rows[order], times(found, 1 / self._scale)
        return self._cut

    _cut: tuple[NDArray[np.int64], NDArray[Any]] | None = None

    def ridge_sizes(self) -> Floats:
        shapely = shapely_or_say()
        owner = np.repeat(np.arange(len(self._side)), np.diff(self.starts))
        lengths = np.zeros(self.ridge_count)
        along = self.ridges >= 0
        inside = along & (self._side[owner] == _INSIDE)
        lengths[self.ridges[inside]] = self._edge_lengths()[inside]
        ridges, traced = self._pieces.ridge_lengths(self.ridge_count)
        lengths[ridges] = traced / self._scale
        # A ridge between two undecided cells occurs twice, with the same result.
        doubtful = np.zeros(len(self._side), dtype=bool)
        doubtful[self._doubtful] = True
        known = np.zeros(self.ridge_count, dtype=bool)
        known[self.ridges[along & ~doubtful[owner]]] = True
        cut = np.flatnonzero(along & doubtful[owner])
        cut = cut[~known[self.ridges[cut]]]
        if len(cut):
            _, once = np.unique(self.ridges[cut], return_index=True)
            cut = cut[once]
            ends = np.stack((self.corners[cut], self.corners[self._next()[cut]]), axis=1)
            lines = shapely.linestrings(ends * self._scale)
            found = intersections(lines, self._outline, areal=False)
            lengths[self.ridges[cut]] = shapely.length(found) / self._scale
        return lengths

    def edges(self) -> tuple[NDArray[np.int64], Floats, Floats]:
        owner, begin, end = super().edges()
        inside = self._side[owner] == _INSIDE
        groups = [(owner[inside], begin[inside], end[inside])]
        cell, begin, end = self._pieces.edges()
        groups.append((cell, begin / self._scale, end / self._scale))
        if len(self._doubtful):
            groups.append(self._doubtful_edges())
        owner, begin, end = (np.concatenate(column) for column in zip(*groups, strict=True))
        return owner, begin, end

    def _doubtful_edges(self) -> tuple[NDArray[np.int64], Floats, Floats]:
        shapely = shapely_or_say()
        turned = shapely.orient_polygons(times(self._overlaid, 1 / self._scale))
        parts, cell = shapely.get_parts(turned, return_index=True)
        rings, part = shapely.get_rings(parts, return_index=True)
        corners, ring = shapely.get_coordinates(rings, return_index=True)
        same = ring[1:] == ring[:-1]
        owner = self._doubtful[cell[part[ring[:-1][same]]]]
        return owner, corners[:-1][same], corners[1:][same]

    def parts(self, cell: int) -> tuple[tuple[Floats, ...], ...]:
        shapely = shapely_or_say()
        if self._side[cell] != _CUT:
            return super().parts(cell) if self._side[cell] == _INSIDE else ()
        rows, cut = self._geometries()
        geometry = cut[np.searchsorted(rows, cell)]
        found = []
        for part in shapely.get_parts(shapely.orient_polygons(geometry)):
            rings = shapely.get_rings(part)
            found.append(tuple(shapely.get_coordinates(ring)[:-1] for ring in rings))
        return tuple(part for part in found if part)

    def simple(self) -> tuple[Indices, Floats, NDArray[np.int64]]:
        shapely = shapely_or_say()
        inside = np.flatnonzero((self._side == _INSIDE) & (np.diff(self.starts) > 2))
        starts, corners = _taken(self.starts, self.corners, inside)
        cells, cut = self._geometries()
        parts, row = shapely.get_parts(cut, return_index=True)
        parts, cells = parts[~shapely.is_empty(parts)], cells[row][~shapely.is_empty(parts)]
        # Polygons with holes become triangles.
        holed = np.flatnonzero(shapely.get_num_interior_rings(parts))
        triangles, row = shapely.get_parts(
            shapely.constrained_delaunay_triangles(parts[holed]), return_index=True
        )
        rings = shapely.get_exterior_ring(
            shapely.orient_polygons(np.concatenate((np.delete(parts, holed), triangles)))
        )
        places, ring = shapely.get_coordinates(rings, return_index=True)
        last = np.append(ring[1:] != ring[:-1], True)[: len(ring)]
        sizes = np.concatenate((np.diff(starts), np.bincount(ring[~last], minlength=len(rings))))
        cell = np.concatenate((inside, np.delete(cells, holed), cells[holed][row]))
        begins = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        return begins, np.concatenate((corners, places[~last])), cell

    def polygons(self) -> NDArray[Any]:
        outside = np.flatnonzero(self._side == _OUTSIDE)
        sizes = np.diff(self.starts)
        sizes[outside] = 0
        kept = np.repeat(self._side != _OUTSIDE, np.diff(self.starts))
        starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        found = as_polygons(starts, self.corners[kept])
        rows, cut = self._geometries()
        found[rows] = cut
        return found


def cells(
    points: Floats,
    weights: Floats | None,
    dual: Diagram2 | PeriodicDual,
    clip: Clip | None,
    *,
    periods: tuple[float | None, float | None] | None = None,
    workers: int,
) -> Clipped:
    """Return the clipped cells of a diagram, or without a clip its bounded cells."""
    cells_alone = dual.cells if isinstance(dual, torus.PeriodicDual) else dual
    if clip is None:
        return _Bounded(cells_alone, workers)
    if isinstance(dual, torus.PeriodicDual):
        assert periods is not None
        return _in_strip(points, weights, dual, clip, periods=periods, workers=workers)
    cut = _core.voronoi_clip2(points, weights, dual, clip.bounds, workers)
    whole = Clipped(cut.starts, cut.corners, cut.ridges, len(dual.sites), workers)
    return whole if clip.outline is None else _InOutline(whole, clip, workers)


def _in_strip(
    points: Floats,
    weights: Floats | None,
    dual: PeriodicDual,
    clip: Clip,
    *,
    periods: tuple[float | None, float | None],
    workers: int,
) -> Clipped:
    """Return cells with one period, each around its site, cut in the other direction."""
    at, at_weights, cells_alone = torus.unrolled(points, weights, dual, periods)
    # Wider than any cell: none extends farther than its neighbors.
    reach = np.concatenate((at, dual.cells.vertices))
    low, high = reach.min(axis=0), reach.max(axis=0)
    with np.errstate(over="ignore"):
        wide = np.concatenate((low - (high - low), high + (high - low)))
    bounds = np.where(np.isfinite(clip.bounds), clip.bounds, wide)
    largest = float(np.finfo(np.float64).max)
    left, bottom, right, top = np.clip(bounds, -largest, largest).tolist()
    cut = _core.voronoi_clip2(at, at_weights, cells_alone, (left, bottom, right, top), workers)
    # The entries are the ridges of the cells.
    entries, of_entries = cut.ridges, np.append(dual.cells.region_ridges, -1)
    ridges = np.where(entries < 0, -1, of_entries[entries]).astype(np.int32)
    return Clipped(cut.starts, cut.corners, ridges, len(dual.cells.sites), workers)


def _distances(a: Floats, b: Floats) -> Floats:
    """Return lengths, infinite beyond the range of doubles."""
    with np.errstate(over="ignore"):
        lengths: Floats = np.hypot(*(b - a).T)
    return lengths


def _taken(starts: Indices, corners: Floats, rows: NDArray[np.int64]) -> tuple[Indices, Floats]:
    """Return some of the polygons."""
    sizes = np.diff(starts)
    mask = np.zeros(len(sizes), dtype=bool)
    mask[rows] = True
    chosen = np.concatenate(([0], np.cumsum(sizes[rows]))).astype(np.int32)
    return chosen, corners[np.repeat(mask, sizes)]


def _sides(whole: Clipped, corners: Floats, clip: Clip) -> NDArray[np.int8]:
    """Return which cells lie outside, inside, or on the outline; corners are in its units."""
    shapely = shapely_or_say()
    rings, places = clip.rings
    segments = np.column_stack((places, places[next_corner(rings, len(places))]))
    group, _count = _core.touched2(whole.starts, corners, whole.ridges, segments)
    side = np.full(len(group), _CUT, dtype=np.int8)
    side[np.diff(whole.starts) == 0] = _OUTSIDE
    free = np.flatnonzero(group >= 0)
    _, first = np.unique(group[free], return_index=True)
    inside = shapely.contains_xy(clip.scaled, whole.centroids[free[first]] * clip.unit)
    side[free] = np.where(inside, _INSIDE, _OUTSIDE)[group[free]]
    return side
