"""What a clip leaves of cells: boxes by the core, outlines by shapely where the outline passes.

A cell is convex, and most cells of a clipped diagram lie wholly inside or outside. The core cuts
all cells to a box a little larger than the outline, finds the cells that the outline comes near,
and joins the others to groups on one side of it; one point of each group tells on which. Only the
cells that the outline comes near are intersected with it. Where the outline has many corners, cells
and outline are halved together until there are few on both sides, so that no cell meets corners
that are far from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone.errors import InputError
from delone.voronoi.shapes import shapely_or_say

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Dual = dict[str, NDArray[Any]]

__all__ = ["Clip", "Clipped", "as_clip", "cells"]

# Outlines with fewer corners than this are not halved, nor are fewer cells than this.
_FEW_CORNERS, _FEW_CELLS = 256, 8
# By this share of its extent the box is larger than the outline that is in it.
_MARGIN = 2.0**-6
_POLYGON, _MULTIPOLYGON = 3, 6
_OUTSIDE, _INSIDE, _CUT = 0, 1, 2


@dataclass(frozen=True, eq=False, kw_only=True)
class Clip:
    """Where cells end.

    Parameters
    ----------
    bounds : tuple of float
        The box ``(xmin, ymin, xmax, ymax)``.
    outline : shapely geometry, optional
        The outline; None for the box itself.
    """

    bounds: tuple[float, float, float, float]
    outline: Any = None

    @property
    def name(self) -> str:
        """What it is, in a few words."""
        return "a box" if self.outline is None else f"a {self.outline.geom_type}"


def as_clip(clip: Any, points: Floats, *, fix: bool) -> Clip | None:
    """Return what a caller wants to clip to.

    Parameters
    ----------
    clip : None, "box", sequence of 4 floats, or geometry
        As for `delone.Voronoi`.
    points : ndarray of float64, shape (n, 2)
        The sites.
    fix : bool
        Repair an invalid geometry.

    Returns
    -------
    Clip or None
        None for no clip.

    Raises
    ------
    InputError
        It has no area, is no polygon, or is invalid.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.voronoi.clipping import as_clip
    >>> as_clip("box", np.array([(0.0, 0), (2, 1)]), fix=False).bounds
    (0.0, 0.0, 2.0, 1.0)
    """
    if clip is None:
        return None
    if isinstance(clip, str):
        if clip != "box":
            raise InputError(f"clip must be 'box', four numbers or a polygon, got {clip!r}")
        return _box([*points.min(axis=0), *points.max(axis=0)])
    if hasattr(clip, "geom_type"):
        return _outline(clip, fix)
    return _box(clip)


def _box(numbers: Any) -> Clip:
    try:
        left, bottom, right, top = (float(x) for x in numbers)
    except (TypeError, ValueError):
        raise InputError(
            f"clip must be 'box', four numbers (xmin, ymin, xmax, ymax) or a polygon, got "
            f"{numbers!r}"
        ) from None
    if not np.isfinite([left, bottom, right, top]).all():
        raise InputError("the box of clip must be finite")
    if not (left < right and bottom < top):
        raise InputError(
            f"the box of clip has no area: xmin {left!r} must be below xmax {right!r}, and ymin "
            f"{bottom!r} below ymax {top!r}"
        )
    return Clip(bounds=(left, bottom, right, top))


def _outline(geometry: Any, fix: bool) -> Clip:
    shapely = shapely_or_say()

    if shapely.get_type_id(geometry) not in (_POLYGON, _MULTIPOLYGON):
        raise InputError(f"clip must be a polygon or a multipolygon, got a {geometry.geom_type}")
    geometry = shapely.force_2d(geometry)
    if not np.isfinite(shapely.get_coordinates(geometry)).all():
        raise InputError("the outline of clip has a coordinate that is NaN or infinite")
    if not shapely.is_valid(geometry):
        if not fix:
            reason = shapely.is_valid_reason(geometry)
            raise InputError(
                f"the outline of clip is invalid: {reason}; repair it, or pass fix=True"
            )
        geometry = _areal(np.array([shapely.make_valid(geometry)]))[0]
    if not shapely.area(geometry) > 0:
        raise InputError("the outline of clip has no area")
    left, bottom, right, top = shapely.bounds(geometry).tolist()
    margin = _MARGIN * max(right - left, top - bottom)
    largest = float(np.finfo(np.float64).max)
    bounds = np.clip(
        [left - margin, bottom - margin, right + margin, top + margin], -largest, largest
    ).tolist()
    return Clip(bounds=tuple(bounds), outline=geometry)


class Clipped:
    """What is left of the cells, in the order of the cells.

    Parameters
    ----------
    starts, corners, ridges : ndarray
        Convex polygons: their corners, and the ridge along which each edge lies.
    ridge_count : int
        Number of ridges.
    workers : int
        How many threads may work.

    Attributes
    ----------
    areas, perimeters : ndarray of float64, shape (c,)
        Measures.
    centroids : ndarray of float64, shape (c, 2)
        Centres of gravity.
    """

    def __init__(
        self, starts: Indices, corners: Floats, ridges: Indices, ridge_count: int, workers: int
    ) -> None:
        self.starts, self.corners, self.ridges = starts, corners, ridges
        self.ridge_count = ridge_count
        self.areas, self.centroids, self.perimeters = _core.measures2(starts, corners, workers)

    def _next(self) -> NDArray[np.int64]:
        """The corner after each corner."""
        after = np.arange(1, len(self.corners) + 1)
        filled = np.diff(self.starts) > 0
        after[self.starts[1:][filled] - 1] = self.starts[:-1][filled]
        return after

    def _edge_lengths(self) -> Floats:
        """The length of each edge from a corner to the next."""
        lengths: Floats = np.hypot(*(self.corners[self._next()] - self.corners).T)
        return lengths

    def ridge_lengths(self) -> Floats:
        """Return how long what is left of each ridge is."""
        lengths = np.zeros(self.ridge_count)
        along = self.ridges >= 0
        lengths[self.ridges[along]] = self._edge_lengths()[along]
        return lengths

    def ring(self, cell: int) -> Floats:
        """Return the corners of a cell."""
        return self.corners[self.starts[cell] : self.starts[cell + 1]]

    def edges(self) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return all boundaries: cell, begin and end of each edge, the cell to its left."""
        owner = np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))
        return owner, self.corners, self.corners[self._next()]

    def parts(self, cell: int) -> tuple[tuple[Floats, ...], ...]:
        """Return the rings of each part of a cell."""
        ring = self.ring(cell)
        return ((ring,),) if len(ring) else ()

    def polygons(self) -> NDArray[Any]:
        """Return the cells as geometries."""
        return _as_polygons(self.starts, self.corners)


class _Bounded(Clipped):
    """The bounded cells, where nothing is clipped; the others are infinite."""

    def __init__(self, dual: Dual, workers: int) -> None:
        starts, vertices = dual["starts"], dual["region_vertices"]
        sizes = np.diff(starts)
        gaps = np.concatenate(([0], np.cumsum(vertices < 0)))
        self._open = (gaps[starts[1:]] > gaps[starts[:-1]]) | (sizes == 0)
        kept = np.repeat(~self._open, sizes)
        sizes[self._open] = 0
        bounded = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        super().__init__(
            bounded,
            dual["vertices"][vertices[kept]],
            dual["region_ridges"][kept],
            len(dual["sites"]),
            workers,
        )
        self._dual = dual
        self.areas[self._open] = np.inf
        self.perimeters[self._open] = np.inf

    def ridge_lengths(self) -> Floats:
        ends = self._dual["ends"]
        lengths = np.full(len(ends), np.inf)
        finite = (ends >= 0).all(axis=1)
        first, second = self._dual["vertices"][ends[finite]].swapaxes(0, 1)
        lengths[finite] = np.hypot(*(second - first).T)
        return lengths

    def polygons(self) -> NDArray[Any]:
        found = super().polygons()
        found[self._open] = None
        return found


class _InOutline(Clipped):
    """Cells cut to an outline; those on it are geometries of their own."""

    def __init__(self, whole: Clipped, outline: Any, workers: int) -> None:
        super().__init__(whole.starts, whole.corners, whole.ridges, whole.ridge_count, workers)
        self._outline = outline
        self._side = _sides(whole, outline)
        self._rows = np.flatnonzero(self._side == _CUT)
        starts, corners = _taken(self.starts, self.corners, self._rows)
        self._cut = _intersections(_as_polygons(starts, corners), outline)
        self._measure()

    def _measure(self) -> None:
        shapely = shapely_or_say()

        outside = self._side == _OUTSIDE
        self.areas[outside] = self.perimeters[outside] = 0
        self.centroids[outside] = np.nan
        self.areas[self._rows] = shapely.area(self._cut)
        self.perimeters[self._rows] = shapely.length(self._cut)
        self.centroids[self._rows] = shapely.get_coordinates(
            _points_or_nan(shapely.centroid(self._cut))
        )

    def ridge_lengths(self) -> Floats:
        shapely = shapely_or_say()

        owner = np.repeat(np.arange(len(self._side)), np.diff(self.starts))
        lengths = np.zeros(self.ridge_count)
        along = self.ridges >= 0
        inside = along & (self._side[owner] == _INSIDE)
        lengths[self.ridges[inside]] = self._edge_lengths()[inside]
        # A ridge between two cells on the outline is met twice, with one result.
        cut = np.flatnonzero(along & (self._side[owner] == _CUT))
        cut = cut[lengths[self.ridges[cut]] == 0]
        _, once = np.unique(self.ridges[cut], return_index=True)
        cut = cut[once]
        ends = np.stack((self.corners[cut], self.corners[self._next()[cut]]), axis=1)
        pieces = _intersections(shapely.linestrings(ends), self._outline, areal=False)
        lengths[self.ridges[cut]] = shapely.length(pieces)
        return lengths

    def edges(self) -> tuple[NDArray[np.int64], Floats, Floats]:
        shapely = shapely_or_say()

        owner, begin, end = super().edges()
        inside = self._side[owner] == _INSIDE
        parts, cell = shapely.get_parts(shapely.orient_polygons(self._cut), return_index=True)
        rings, part = shapely.get_rings(parts, return_index=True)
        corners, ring = shapely.get_coordinates(rings, return_index=True)
        same = ring[1:] == ring[:-1]
        return (
            np.concatenate((owner[inside], self._rows[cell[part[ring[:-1][same]]]])),
            np.concatenate((begin[inside], corners[:-1][same])),
            np.concatenate((end[inside], corners[1:][same])),
        )

    def parts(self, cell: int) -> tuple[tuple[Floats, ...], ...]:
        shapely = shapely_or_say()

        if self._side[cell] != _CUT:
            return super().parts(cell) if self._side[cell] == _INSIDE else ()
        geometry = self._cut[np.searchsorted(self._rows, cell)]
        found = []
        for part in shapely.get_parts(shapely.orient_polygons(geometry)):
            rings = shapely.get_rings(part)
            found.append(tuple(shapely.get_coordinates(ring)[:-1] for ring in rings))
        return tuple(part for part in found if part)

    def polygons(self) -> NDArray[Any]:
        outside = np.flatnonzero(self._side == _OUTSIDE)
        sizes = np.diff(self.starts)
        sizes[outside] = 0
        kept = np.repeat(self._side != _OUTSIDE, np.diff(self.starts))
        starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        found = _as_polygons(starts, self.corners[kept])
        found[self._rows] = self._cut
        return found


def cells(
    points: Floats, weights: Floats | None, dual: Dual, clip: Clip | None, workers: int
) -> Clipped:
    """Return what is left of the cells of a diagram.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        The sites.
    weights : ndarray of float64, shape (n,), optional
        Their weights.
    dual : dict of ndarray
        The arrays of the diagram.
    clip : Clip, optional
        Where cells end.
    workers : int
        How many threads may work.

    Returns
    -------
    Clipped
        Polygons and their measures.
    """
    if clip is None:
        return _Bounded(dual, workers)
    cut = _core.voronoi_clip2(points, weights, dual, clip.bounds, workers)
    whole = Clipped(*cut, len(dual["sites"]), workers)
    return whole if clip.outline is None else _InOutline(whole, clip.outline, workers)


def _as_polygons(starts: Indices, corners: Floats) -> NDArray[Any]:
    """Polygons of shapely, empty where there are no corners."""
    shapely = shapely_or_say()

    sizes = np.diff(starts)
    filled = sizes > 0
    # Rings repeat their first corner at the end.
    begins = starts[:-1][filled]
    closed = np.insert(corners, starts[1:][filled], corners[begins], axis=0)
    rings = np.concatenate(([0], np.cumsum(sizes[filled] + 1)))
    parts = np.concatenate(([0], np.cumsum(filled)))
    offsets = (rings.astype(np.int64), parts.astype(np.int64))
    found: NDArray[Any] = shapely.from_ragged_array(shapely.GeometryType.POLYGON, closed, offsets)
    return found


def _taken(starts: Indices, corners: Floats, rows: NDArray[np.int64]) -> tuple[Indices, Floats]:
    """Some of the polygons."""
    sizes = np.diff(starts)
    mask = np.zeros(len(sizes), dtype=bool)
    mask[rows] = True
    chosen = np.concatenate(([0], np.cumsum(sizes[rows]))).astype(np.int32)
    return chosen, corners[np.repeat(mask, sizes)]


def _sides(whole: Clipped, outline: Any) -> NDArray[np.int8]:
    """Whether cells lie outside, inside, or where the outline passes."""
    shapely = shapely_or_say()

    rings = shapely.get_rings(shapely.get_parts(outline))
    coordinates, ring = shapely.get_coordinates(rings, return_index=True)
    same = ring[1:] == ring[:-1]
    segments = np.column_stack((coordinates[:-1][same], coordinates[1:][same]))
    group, _count = _core.touched2(
        whole.starts, whole.corners, whole.ridges, np.ascontiguousarray(segments)
    )
    side = np.full(len(group), _CUT, dtype=np.int8)
    side[np.diff(whole.starts) == 0] = _OUTSIDE
    free = np.flatnonzero(group >= 0)
    _, first = np.unique(group[free], return_index=True)
    shapely.prepare(outline)
    inside = shapely.contains_xy(outline, whole.centroids[free[first]])
    side[free] = np.where(inside, _INSIDE, _OUTSIDE)[group[free]]
    return side


def _intersections(geometries: NDArray[Any], outline: Any, *, areal: bool = True) -> NDArray[Any]:
    """Intersect many small geometries with one that may have very many corners."""
    shapely = shapely_or_say()

    found = np.empty(len(geometries), dtype=object)
    boxes = shapely.bounds(geometries)
    _halve(geometries, boxes, np.arange(len(geometries)), outline, found)
    return _areal(found) if areal else found


def _halve(
    geometries: NDArray[Any],
    boxes: Floats,
    rows: NDArray[np.int64],
    outline: Any,
    found: NDArray[Any],
) -> None:
    """Intersect some of the geometries; each call has half as many as the one before it."""
    shapely = shapely_or_say()

    if len(rows) <= _FEW_CELLS or shapely.get_num_coordinates(outline) <= _FEW_CORNERS:
        found[rows] = shapely.intersection(geometries[rows], outline)
        return
    centers = boxes[rows, :2] / 2 + boxes[rows, 2:] / 2
    axis = int(np.argmax(np.ptp(centers, axis=0)))
    order = rows[np.argsort(centers[:, axis], kind="stable")]
    for half in np.array_split(order, 2):
        low, high = boxes[half, :2].min(axis=0), boxes[half, 2:].max(axis=0)
        margin = _MARGIN * (high - low).max()
        around = shapely.box(*(low - margin), *(high + margin))
        local = _areal(np.array([shapely.intersection(outline, around)]))[0]
        _halve(geometries, boxes, half, local, found)


def _areal(geometries: NDArray[Any]) -> NDArray[Any]:
    """Leave out the points and lines in which areas touch."""
    shapely = shapely_or_say()

    mixed = np.flatnonzero(~np.isin(shapely.get_type_id(geometries), (_POLYGON, _MULTIPOLYGON)))
    for row in mixed:
        parts = shapely.get_parts(geometries[row])
        parts = shapely.get_parts(parts)
        areas = parts[shapely.get_type_id(parts) == _POLYGON]
        geometries[row] = shapely.union_all(areas) if len(areas) else shapely.Polygon()
    return geometries


def _points_or_nan(points: NDArray[Any]) -> NDArray[Any]:
    """Points, those that are empty with NaN for coordinates."""
    shapely = shapely_or_say()

    points[shapely.is_empty(points)] = shapely.Point(np.nan, np.nan)
    return points
