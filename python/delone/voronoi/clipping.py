"""What a clip leaves of cells: boxes by the core, outlines by shapely where the outline passes.

A cell is convex, and most cells of a clipped diagram lie wholly inside or outside. The core cuts
all cells to a box a little larger than the outline, finds the cells that the outline comes near,
and joins the others to groups on one side of it; one point of each group tells on which. Only the
cells that the outline comes near are intersected with it. Where the outline has many corners, cells
and outline are halved together until there are few on both sides, so that no cell meets corners
that are far from it. The same crossing may come out differently then for the two cells that have
it: corners that differ by rounding alone are made one.

GEOS computes with squares and products of coordinates, which must neither over- nor underflow:
where coordinates are very large or small, it gets them multiplied by a power of two.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone.errors import InputError
from delone.voronoi import torus
from delone.voronoi.shapes import shapely_or_say

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Dual = dict[str, NDArray[Any]]

__all__ = ["Clip", "Clipped", "as_clip", "as_scaled", "cells", "unit_of"]

# Outlines with fewer corners than this are not halved, nor are fewer cells than this.
_FEW_CORNERS, _FEW_CELLS = 256, 8
# By this share of its extent the box is larger than the outline that is in it.
_MARGIN = 2.0**-6
_POLYGON, _MULTIPOLYGON = 3, 6
_OUTSIDE, _INSIDE, _CUT = 0, 1, 2
# Coordinates up to these magnitudes GEOS gets as they are.
_SMALL, _LARGE = 2.0**-100, 2.0**100
# Corners of cut cells within this share of the largest coordinate, 64 units in the last place, are
# one corner, and so many places apart at most along the direction in which they are sorted.
_SAME, _PLACES = 2.0**-46, 4


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


def as_clip(
    clip: Any,
    points: Floats,
    *,
    fix: bool,
    periods: tuple[float | None, float | None] | None = None,
) -> Clip | None:
    """Return what a caller wants to clip to.

    Parameters
    ----------
    clip : None, "box", sequence of 4 floats, or geometry
        As for `delone.Voronoi`.
    points : ndarray of float64, shape (n, 2)
        The sites.
    fix : bool
        Repair an invalid geometry.
    periods : tuple of two floats or None, optional
        The periods of the sites.

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
    if periods is not None:
        return _strip(clip, points, periods)
    if isinstance(clip, str):
        if clip != "box":
            raise InputError(f"clip must be 'box', four numbers or a polygon, got {clip!r}")
        return _box([*points.min(axis=0), *points.max(axis=0)])
    geometry = _geometry(clip)
    return _box(clip) if geometry is None else _outline(geometry, fix)


def _strip(clip: Any, points: Floats, periods: tuple[float | None, float | None]) -> Clip:
    """A box that is infinite where sites come again."""
    if None not in periods:
        raise InputError(
            "cells that come again in x and in y have no border that a clip could cut them to; "
            "intersect their polygons() with it instead"
        )
    axis = 0 if periods[1] is None else 1
    whole = "(-inf, ymin, inf, ymax)" if axis == 0 else "(xmin, -inf, xmax, inf)"
    only = f"with one period clip must be 'box' or four numbers {whole}"
    if isinstance(clip, str) and clip == "box":
        box = np.concatenate((points.min(axis=0), points.max(axis=0)))
        box[[axis, axis + 2]] = -np.inf, np.inf
    elif isinstance(clip, str) or hasattr(clip, "geom_type") or hasattr(clip, "geometry"):
        raise InputError(f"{only}; intersect polygons() with others instead")
    else:
        try:
            box = np.array([float(x) for x in clip])
        except (TypeError, ValueError):
            raise InputError(f"{only}, got {clip!r:.80}") from None
    low, high = (float(x) for x in box[[1 - axis, 3 - axis]]) if len(box) == 4 else (np.nan,) * 2
    if not (np.isfinite([low, high]).all() and (box[[axis, axis + 2]] == [-np.inf, np.inf]).all()):
        raise InputError(f"{only}, got {clip!r:.80}")
    if not low < high:
        raise InputError(f"the box of clip has no area: {low!r} must be below {high!r}")
    left, bottom, right, top = box.tolist()
    return Clip(bounds=(left, bottom, right, top))


def _together(geometries: Any) -> Any:
    """All polygons of a table as one; what is invalid stays so, and is named later."""
    shapely = shapely_or_say()

    found = np.array([each for each in geometries if each is not None], dtype=object)
    if len(found) == 1:
        return found[0]
    others = np.setdiff1d(shapely.get_type_id(found), (_POLYGON, _MULTIPOLYGON))
    if len(others):
        raise InputError("clip must hold polygons, and nothing else")
    if shapely.is_valid(found).all():
        return shapely.union_all(found)
    return shapely.multipolygons(shapely.get_parts(found))


def _geometry(clip: Any) -> Any:
    """A geometry of shapely for whatever stands for one, None for what does not."""
    if hasattr(clip, "geometry") and hasattr(clip.geometry, "values"):
        return _together(clip.geometry.values)
    if hasattr(clip, "geom_type"):
        return clip
    if isinstance(clip, dict) or hasattr(clip, "__geo_interface__"):
        return _of_mapping(clip)
    return None


def _of_mapping(mapping: Any) -> Any:
    """A geometry from a mapping of the form of GeoJSON, a feature's included."""
    shape = shapely_or_say().geometry.shape
    mapping = getattr(mapping, "__geo_interface__", mapping)
    if mapping.get("type") == "FeatureCollection":
        return _together([shape(each["geometry"]) for each in mapping["features"]])
    try:
        return shape(mapping["geometry"] if mapping.get("type") == "Feature" else mapping)
    except Exception as error:
        raise InputError(f"clip {mapping!r:.80} is no geometry: {error}") from error


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
    unit = unit_of(shapely.get_coordinates(geometry))
    in_units = _times(geometry, unit)
    if not shapely.is_valid(in_units):
        if not fix:
            reason = shapely.is_valid_reason(in_units)
            where = "" if unit == 1 else f" (in units of {1 / unit!r})"
            raise InputError(
                f"the outline of clip is invalid: {reason}{where}; repair it, or pass fix=True"
            )
        in_units = _areal(np.array([shapely.make_valid(in_units)]))[0]
        geometry = _times(in_units, 1 / unit)
    if not shapely.area(in_units) > 0:
        raise InputError("the outline of clip has no area")
    left, bottom, right, top = shapely.bounds(geometry).tolist()
    margin = _MARGIN * max(right / 2 - left / 2, top / 2 - bottom / 2) * 2
    largest = float(np.finfo(np.float64).max)
    with np.errstate(over="ignore"):
        wide = np.array([left, bottom, right, top]) + margin * np.array([-1, -1, 1, 1])
    bounds = np.clip(wide, -largest, largest).tolist()
    return Clip(bounds=tuple(bounds), outline=geometry)


def unit_of(coordinates: Floats) -> float:
    """Return a power of two by which products of coordinates stay in range.

    Parameters
    ----------
    coordinates : ndarray of float64
        Finite numbers.

    Returns
    -------
    float
        1 unless they are very large or very small.
    """
    largest = float(np.abs(coordinates).max(initial=0.0))
    if largest == 0 or _SMALL < largest < _LARGE:
        return 1.0
    # Both it and its inverse are doubles.
    return math.ldexp(1.0, int(np.clip(-math.frexp(largest)[1], -1022, 1022)))


def as_scaled(clip: Any, factor: float) -> Any:
    """Return a box or an outline multiplied by a power of two.

    Parameters
    ----------
    clip : tuple of 4 floats, or geometry
        As `delone.Voronoi.clip` gives it.
    factor : float
        The power of two.

    Returns
    -------
    tuple of 4 floats, or geometry
        Of the same kind.
    """
    if isinstance(clip, tuple):
        return tuple(x * factor for x in clip)
    return _times(clip, factor)


def _times(geometry: Any, factor: float) -> Any:
    if factor == 1:
        return geometry
    return shapely_or_say().transform(geometry, lambda places: places * factor)


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
        return _after(self.starts, len(self.corners))

    def _edge_lengths(self) -> Floats:
        """The length of each edge from a corner to the next."""
        return _distances(self.corners, self.corners[self._next()])

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
        return ((ring,),) if len(ring) > 2 else ()

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
        lengths[finite] = _distances(first, second)
        return lengths

    def polygons(self) -> NDArray[Any]:
        found = super().polygons()
        found[self._open] = None
        return found


class _InOutline(Clipped):
    """Cells cut to an outline; those on it are geometries of their own."""

    def __init__(self, whole: Clipped, outline: Any, workers: int) -> None:
        super().__init__(whole.starts, whole.corners, whole.ridges, whole.ridge_count, workers)
        # What shapely sees is in these units; all else is in those of the points.
        self._scale = unit_of(shapely_or_say().get_coordinates(outline))
        self._outline = _times(outline, self._scale)
        self._side = _sides(whole, self._outline, self._scale)
        self._rows = np.flatnonzero(self._side == _CUT)
        starts, corners = _taken(self.starts, self.corners * self._scale, self._rows)
        cut = _intersections(_as_polygons(starts, corners), self._outline)
        cut = _with_shared_corners(cut, corners, self._outline)
        self._measure(cut)
        self._cut = _times(cut, 1 / self._scale)

    def _measure(self, cut: NDArray[Any]) -> None:
        shapely = shapely_or_say()

        outside = self._side == _OUTSIDE
        self.areas[outside] = self.perimeters[outside] = 0
        self.centroids[outside] = np.nan
        self.areas[self._rows] = shapely.area(cut) / self._scale / self._scale
        self.perimeters[self._rows] = shapely.length(cut) / self._scale
        centers = shapely.get_coordinates(_points_or_nan(shapely.centroid(cut)))
        self.centroids[self._rows] = centers / self._scale

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
        ends = np.stack((self.corners[cut], self.corners[self._next()[cut]]), axis=1) * self._scale
        pieces = _intersections(shapely.linestrings(ends), self._outline, areal=False)
        lengths[self.ridges[cut]] = shapely.length(pieces) / self._scale
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
    points: Floats,
    weights: Floats | None,
    dual: Dual,
    clip: Clip | None,
    *,
    periods: tuple[float | None, float | None] | None = None,
    workers: int,
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
    periods : tuple of two floats or None, optional
        The periods of the sites.
    workers : int
        How many threads may work.

    Returns
    -------
    Clipped
        Polygons and their measures.
    """
    if clip is None:
        return _Bounded(dual, workers)
    if periods is not None:
        return _in_strip(points, weights, dual, clip, periods=periods, workers=workers)
    cut = _core.voronoi_clip2(points, weights, dual, clip.bounds, workers)
    whole = Clipped(*cut, len(dual["sites"]), workers)
    return whole if clip.outline is None else _InOutline(whole, clip.outline, workers)


def _in_strip(
    points: Floats,
    weights: Floats | None,
    dual: Dual,
    clip: Clip,
    *,
    periods: tuple[float | None, float | None],
    workers: int,
) -> Clipped:
    """Cells with one period, each around its site, cut in the other direction."""
    at, heavy, cells_alone = torus.unrolled(points, weights, dual, periods)
    # As wide as no cell is: none reaches further than its neighbours.
    reach = np.concatenate((at, dual["vertices"]))
    low, high = reach.min(axis=0), reach.max(axis=0)
    with np.errstate(over="ignore"):
        wide = np.concatenate((low - (high - low), high + (high - low)))
    bounds = np.where(np.isfinite(clip.bounds), clip.bounds, wide)
    largest = float(np.finfo(np.float64).max)
    left, bottom, right, top = np.clip(bounds, -largest, largest).tolist()
    starts, corners, entries = _core.voronoi_clip2(
        at, heavy, cells_alone, (left, bottom, right, top), workers
    )
    ridges = np.where(entries < 0, -1, np.append(dual["region_ridges"], -1)[entries])
    return Clipped(starts, corners, ridges.astype(np.int32), len(dual["sites"]), workers)


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
    _make_sound(found, starts, corners)
    return found


def _make_sound(polygons: NDArray[Any], starts: Indices, corners: Floats) -> None:
    """Give cells whose corners rounding has put in no convex order their hull.

    Cells a few units in the last place wide may have lost their area, too: those become empty.
    """
    shapely = shapely_or_say()

    after = _after(starts, len(corners))
    a, b, c = corners, corners[after], corners[after[after]]
    with np.errstate(all="ignore"):
        (px, py), (qx, qy) = (b - a).T, (c - b).T
        left, right = px * qy, py * qx
        doubtful = ~(left - right > 2.0**-50 * (np.abs(left) + np.abs(right)))
    rows = np.unique(np.repeat(np.arange(len(polygons)), np.diff(starts))[doubtful])
    unit = unit_of(corners)
    rows = rows[~shapely.is_valid(_times(polygons[rows], unit))]
    if len(rows):
        hulls = shapely.convex_hull(_times(polygons[rows], unit))
        hulls[shapely.get_type_id(hulls) != _POLYGON] = shapely.Polygon()
        polygons[rows] = _times(hulls, 1 / unit)


def _distances(a: Floats, b: Floats) -> Floats:
    """Lengths, infinite beyond the range of doubles."""
    with np.errstate(over="ignore"):
        lengths: Floats = np.hypot(*(b - a).T)
    return lengths


def _after(starts: Indices, count: int) -> NDArray[np.int64]:
    """The corner after each corner."""
    after = np.arange(1, count + 1)
    filled = np.diff(starts) > 0
    after[starts[1:][filled] - 1] = starts[:-1][filled]
    return after


def _taken(starts: Indices, corners: Floats, rows: NDArray[np.int64]) -> tuple[Indices, Floats]:
    """Some of the polygons."""
    sizes = np.diff(starts)
    mask = np.zeros(len(sizes), dtype=bool)
    mask[rows] = True
    chosen = np.concatenate(([0], np.cumsum(sizes[rows]))).astype(np.int32)
    return chosen, corners[np.repeat(mask, sizes)]


def _sides(whole: Clipped, outline: Any, scale: float) -> NDArray[np.int8]:
    """Whether cells lie outside, inside, or where the outline, which is scaled, passes."""
    shapely = shapely_or_say()

    rings = shapely.get_rings(shapely.get_parts(outline))
    coordinates, ring = shapely.get_coordinates(rings, return_index=True)
    same = ring[1:] == ring[:-1]
    segments = np.column_stack((coordinates[:-1][same], coordinates[1:][same]))
    group, _count = _core.touched2(
        whole.starts, whole.corners * scale, whole.ridges, np.ascontiguousarray(segments)
    )
    side = np.full(len(group), _CUT, dtype=np.int8)
    side[np.diff(whole.starts) == 0] = _OUTSIDE
    free = np.flatnonzero(group >= 0)
    _, first = np.unique(group[free], return_index=True)
    shapely.prepare(outline)
    inside = shapely.contains_xy(outline, whole.centroids[free[first]] * scale)
    side[free] = np.where(inside, _INSIDE, _OUTSIDE)[group[free]]
    return side


def _intersections(geometries: NDArray[Any], outline: Any, *, areal: bool = True) -> NDArray[Any]:
    """Intersect many small geometries with one that may have very many corners."""
    shapely = shapely_or_say()

    found = np.full(len(geometries), shapely.Polygon(), dtype=object)
    boxes = shapely.bounds(geometries)
    # What is empty has no box.
    _halve(geometries, boxes, np.flatnonzero(~np.isnan(boxes[:, 0])), outline, found)
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


def _with_shared_corners(cut: NDArray[Any], corners: Floats, outline: Any) -> NDArray[Any]:
    """Make corners one that differ by rounding alone: crossings that were computed more than once.

    Corners of whole cells and of the outline stay where they are.
    """
    shapely = shapely_or_say()

    places, owner = shapely.get_coordinates(cut, return_index=True)
    if not len(places):
        return cut
    distinct, number = np.unique(_as_complex(places), return_inverse=True)
    known = np.isin(distinct, _as_complex(np.vstack((corners, shapely.get_coordinates(outline)))))
    # Known corners first: those that are met are called by the least number.
    rank = np.empty(len(distinct), dtype=np.int64)
    by_rank = np.argsort(~known, kind="stable")
    rank[by_rank] = np.arange(len(distinct))
    close = float(np.abs(places).max()) * _SAME
    order = np.argsort(distinct.real * 0.8 + distinct.imag * 0.6)
    name = rank[order]
    for shift in range(1, min(_PLACES, len(order) - 1) + 1):
        way = distinct[order[shift:]] - distinct[order[:-shift]]
        near = (np.abs(way.real) <= close) & (np.abs(way.imag) <= close)
        near &= ~(known[order[shift:]] & known[order[:-shift]])
        least = np.minimum(name[shift:], name[:-shift])
        name[shift:] = np.where(near, least, name[shift:])
        name[:-shift] = np.where(near, least, name[:-shift])
    moved = distinct.copy()
    moved[order] = distinct[by_rank[name]]
    if np.array_equal(moved, distinct):
        return cut
    new = moved[number.reshape(-1)]
    changed = np.unique(owner[new != _as_complex(places)])
    mask = np.isin(owner, changed)
    mended = shapely.set_coordinates(
        cut[changed].copy(), np.column_stack((new.real, new.imag))[mask]
    )
    sound = shapely.is_valid(mended)
    found = cut.copy()
    found[changed[sound]] = mended[sound]
    return found


def _as_complex(places: Floats) -> NDArray[np.complex128]:
    found: NDArray[np.complex128] = np.ascontiguousarray(places + 0.0).view(np.complex128)[:, 0]
    return found


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
