"""2-D clips: boxes and outlines, converted to shapely geometries from what callers pass.

GEOS computes squares and products of coordinates, which must neither overflow nor underflow: very
large or small coordinates are multiplied by a power of two before they are passed to it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.georeference import transformed
from delone.constrained.geodata import is_shapely, parts_of, rings_of_numbers
from delone.errors import InputError, ShapeError
from delone.exchange.geopandas import shapely_or_say

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = [
    "Clip",
    "areal_parts",
    "as_clip",
    "as_scaled",
    "in_system",
    "next_corner",
    "of_wkb",
    "times",
    "unit_of",
]

# The box around an outline is larger by this fraction of its extent.
_MARGIN = 2.0**-6
_POLYGON, _MULTIPOLYGON = 3, 6
# Coordinates of magnitudes between these are passed to GEOS unchanged.
_SMALL, _LARGE = 2.0**-100, 2.0**100


@dataclass(frozen=True, eq=False, kw_only=True)
class Clip:
    """Where cells end: the box (xmin, ymin, xmax, ymax), and the outline within it, if any."""

    bounds: tuple[float, float, float, float]
    outline: Any = None

    @property
    def name(self) -> str:
        """A short description."""
        return "a box" if self.outline is None else f"a {self.outline.geom_type}"

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Tell which points are inside, including the boundary."""
        left, bottom, right, top = self.bounds
        x, y = points.T
        found: NDArray[np.bool_] = (left <= x) & (x <= right) & (bottom <= y) & (y <= top)
        if self.outline is not None:
            near = np.flatnonzero(found)
            shapely = shapely_or_say()
            found[near] = shapely.intersects_xy(self.scaled, points[near] * self.unit)
        return found

    @cached_property
    def unit(self) -> float:
        """The power of two by which the outline is multiplied; see `unit_of`."""
        return unit_of(shapely_or_say().get_coordinates(self.outline))

    @cached_property
    def scaled(self) -> Any:
        """The outline in these units, its interior to the left of its rings, prepared."""
        shapely = shapely_or_say()
        found = shapely.orient_polygons(times(self.outline, self.unit))
        shapely.prepare(found)
        return found

    @cached_property
    def rings(self) -> tuple[NDArray[np.int32], Floats]:
        """The corners of its rings, in these units, as compressed rows; none is repeated."""
        shapely = shapely_or_say()
        rings = shapely.get_rings(shapely.get_parts(self.scaled))
        corners, ring = shapely.get_coordinates(rings, return_index=True)
        # Consecutive equal corners, including the first and the last, are merged.
        last = np.append((ring[1:] != ring[:-1]), True)
        same = np.append((corners[1:] == corners[:-1]).all(axis=1), False)
        kept = ~(last | same)
        sizes = np.bincount(ring[kept], minlength=len(rings))
        starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        return starts, np.ascontiguousarray(corners[kept])


def in_system(clip: Any, crs: str | None) -> Any:
    """Return a clip in the reference system of the sites, if it declares one."""
    if isinstance(clip, np.ndarray | str | list | tuple) or not hasattr(clip, "crs"):
        return clip
    geometry, shapely = _geometry(clip), shapely_or_say()
    places = shapely.get_coordinates(geometry)
    moved = transformed(clip, places, crs, name="clip", to="the sites")
    return geometry if moved is places else shapely.transform(geometry, lambda _: moved)


def as_clip(
    clip: Any,
    points: Floats,
    *,
    fix: bool,
    periods: tuple[float | None, float | None] | None = None,
) -> Clip | None:
    """Return the clip that a caller of `Voronoi` gave; None and a `Clip` are returned unchanged."""
    if clip is None or isinstance(clip, Clip):
        return clip
    if periods is not None:
        return _strip(clip, points, periods)
    if isinstance(clip, str):
        if clip != "box":
            raise InputError(f"clip must be 'box', four numbers or a polygon, got {clip!r:.80}")
        return _box([*points.min(axis=0), *points.max(axis=0)])
    geometry = _of_rings(clip) if isinstance(clip, list | tuple | np.ndarray) else _geometry(clip)
    return _box(clip) if geometry is None else _outline(geometry, fix)


def _of_rings(clip: Any) -> Any:
    """Return the geometry of rings of coordinates or of several geometries; None for a box."""
    rings = rings_of_numbers(clip, "clip")
    if rings is None:
        if len(clip) and all(is_shapely(each) or isinstance(each, Mapping) for each in clip):
            return _together([_geometry(each) for each in clip])
        return None
    shapely = shapely_or_say()
    _require_finite(np.concatenate(rings))
    if len(rings) == 1:
        return shapely.Polygon(rings[0])
    lines = shapely.MultiLineString([np.vstack((ring, ring[:1])) for ring in rings])
    if not shapely.is_simple(lines):
        raise InputError("the rings of clip cross or touch: pass a polygon")
    # By the even-odd rule, without new points.
    return shapely.build_area(lines)


def _strip(clip: Any, points: Floats, periods: tuple[float | None, float | None]) -> Clip:
    """Return a box that is infinite in the direction in which sites repeat."""
    if None not in periods:
        raise InputError(
            "clip is not available with two periods, where all cells are bounded; intersect their "
            "polygons() with it instead"
        )
    axis = 0 if periods[1] is None else 1
    whole = "(-inf, ymin, inf, ymax)" if axis == 0 else "(xmin, -inf, xmax, inf)"
    only = f"with one period clip must be 'box' or four numbers {whole}"
    if isinstance(clip, str) and clip == "box":
        box = np.concatenate((points.min(axis=0), points.max(axis=0)))
        box[[axis, axis + 2]] = -np.inf, np.inf
    elif isinstance(clip, str) or hasattr(clip, "geom_type") or hasattr(clip, "geometry"):
        raise InputError(f"{only}; intersect polygons() with other shapes instead")
    else:
        try:
            box = np.array([float(x) for x in clip])
        except (TypeError, ValueError):
            raise InputError(f"{only}, got {clip!r:.80}") from None
    low, high = (float(x) for x in box[[1 - axis, 3 - axis]]) if len(box) == 4 else (np.nan,) * 2
    if not (np.isfinite([low, high]).all() and (box[[axis, axis + 2]] == [-np.inf, np.inf]).all()):
        raise InputError(f"{only}, got {clip!r:.80}")
    if not low < high:
        raise InputError(f"the box of clip has no area: {low!r:.80} must be below {high!r:.80}")
    left, bottom, right, top = box.tolist()
    return Clip(bounds=(left, bottom, right, top))


def _together(geometries: Any) -> Any:
    """Return all polygons of a table as one; invalid ones are kept, and reported later."""
    shapely = shapely_or_say()
    found = np.array([each for each in geometries if each is not None], dtype=object)
    if len(found) == 1:
        return found[0]
    others = np.setdiff1d(shapely.get_type_id(found), (_POLYGON, _MULTIPOLYGON))
    if len(others):
        raise InputError("clip must contain only polygons")
    if shapely.is_valid(found).all():
        return shapely.union_all(found)
    return shapely.multipolygons(shapely.get_parts(found))


def _geometry(clip: Any) -> Any:
    """Return a shapely geometry, converted if necessary, or None for other kinds of input."""
    if hasattr(clip, "geometry") and hasattr(clip.geometry, "values"):
        return _together(clip.geometry.values)
    if hasattr(clip, "geom_type"):
        return clip
    if hasattr(clip, "geometries"):  # a GeometrySet
        return _together(clip.geometries)
    if isinstance(clip, Mapping) or hasattr(clip, "__geo_interface__"):
        return _of_mapping(clip)
    return None


def _of_mapping(mapping: Any) -> Any:
    """Return a geometry from a GeoJSON-like mapping, including features and collections."""
    shape = shapely_or_say().geometry.shape
    mapping = getattr(mapping, "__geo_interface__", mapping)
    try:
        if mapping.get("type") == "FeatureCollection":
            return _together([shape(_typed(each["geometry"])) for each in mapping["features"]])
        plain = mapping["geometry"] if mapping.get("type") == "Feature" else mapping
        return shape(_typed(plain))
    except Exception as error:
        if isinstance(error, InputError):
            raise
        try:
            parts_of(mapping, name="clip")
        except ShapeError:
            # It names the row of coordinates that are not numbers.
            raise
        except InputError:
            pass
        raise _no_geometry(mapping, error) from error


def _typed(mapping: Any) -> Any:
    """Return a mapping that has a type; shapely would not report that it is missing."""
    kind = mapping.get("type") if isinstance(mapping, Mapping) else None
    if not isinstance(kind, str):
        why = "it has no type" if kind is None else f"its type is {kind!r:.40}"
        raise _no_geometry(mapping, why)
    return mapping


def _no_geometry(mapping: Any, why: object) -> InputError:
    return InputError(f"clip {mapping!r:.80} is not a geometry: {why}")


def _box(numbers: Any) -> Clip:
    try:
        left, bottom, right, top = (float(x) for x in numbers)
    except (TypeError, ValueError):
        raise InputError(
            f"clip must be 'box', four numbers (xmin, ymin, xmax, ymax) or a polygon, got "
            f"{numbers!r:.80}"
        ) from None
    if not np.isfinite([left, bottom, right, top]).all():
        raise InputError("the box of clip must be finite")
    if not (left < right and bottom < top):
        raise InputError(
            f"the box of clip has no area: xmin {left!r:.30} must be below xmax {right!r:.30}, "
            f"and ymin {bottom!r:.30} below ymax {top!r:.30}"
        )
    return Clip(bounds=(left, bottom, right, top))


def of_wkb(data: bytes) -> Any:
    """Return the geometry of well-known binary."""
    shapely = shapely_or_say()
    try:
        return shapely.from_wkb(data)
    except shapely.errors.ShapelyError as error:
        raise InputError(f"the outline is not well-known binary: {error}") from error


def _require_finite(coordinates: Floats) -> None:
    """Reject an outline with NaN or infinity."""
    if not np.isfinite(coordinates).all():
        raise InputError("the outline of clip has a coordinate that is NaN or infinite")


def _outline(geometry: Any, fix: bool) -> Clip:
    shapely = shapely_or_say()
    if shapely.get_type_id(geometry) not in (_POLYGON, _MULTIPOLYGON):
        raise InputError(f"clip must be a polygon or a multipolygon, got a {geometry.geom_type}")
    geometry = shapely.force_2d(geometry)
    _require_finite(shapely.get_coordinates(geometry))
    unit = unit_of(shapely.get_coordinates(geometry))
    in_units = times(geometry, unit)
    if not shapely.is_valid(in_units):
        if not fix:
            reason = shapely.is_valid_reason(in_units)
            where = "" if unit == 1 else f" (in units of {1 / unit!r})"
            raise InputError(
                f"the outline of clip is invalid: {reason}{where}; repair it, or pass fix=True"
            )
        in_units = areal_parts(np.array([shapely.make_valid(in_units)]))[0]
        geometry = times(in_units, 1 / unit)
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
    """Return a power of two that keeps products of coordinates in range; mostly 1."""
    largest = float(np.abs(coordinates).max(initial=0.0))
    if largest == 0 or _SMALL < largest < _LARGE:
        return 1.0
    # Both it and its inverse are doubles.
    return math.ldexp(1.0, int(np.clip(-math.frexp(largest)[1], -1022, 1022)))


def as_scaled(clip: Any, factor: float) -> Any:
    """Return a box (a tuple) or an outline multiplied by a power of two."""
    if isinstance(clip, tuple):
        return tuple(x * factor for x in clip)
    return times(clip, factor)


def times(geometry: Any, factor: float) -> Any:
    """Return geometries multiplied by a power of two, the same ones if it is 1."""
    if factor == 1:
        return geometry
    return shapely_or_say().transform(geometry, lambda places: places * factor)


def areal_parts(geometries: NDArray[Any]) -> NDArray[Any]:
    """Remove the points and lines where areas touch."""
    shapely = shapely_or_say()
    mixed = np.flatnonzero(~np.isin(shapely.get_type_id(geometries), (_POLYGON, _MULTIPOLYGON)))
    for row in mixed:
        parts = shapely.get_parts(geometries[row])
        parts = shapely.get_parts(parts)
        areas = parts[shapely.get_type_id(parts) == _POLYGON]
        geometries[row] = shapely.union_all(areas) if len(areas) else shapely.Polygon()
    return geometries


def next_corner(starts: NDArray[Any], count: int) -> NDArray[np.int64]:
    """Return the corner after each of `count` corners of closed rings, which begin at `starts`."""
    after = np.arange(1, count + 1)
    filled = np.diff(starts) > 0
    after[starts[1:][filled] - 1] = starts[:-1][filled]
    return after
