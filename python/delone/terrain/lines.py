"""Lines and rings with heights, as arrays: breaklines, boundaries, profiles.

Rings have one meaning everywhere: each polygon has its own holes, and several polygons form a
union. Rings that belong to no polygon (arrays and closed lines) together form one polygon by the
even-odd rule.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_plain_array, as_points, require_finite, wrong_shape
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.georeference import transformed
from delone.constrained.geodata import geometries_in, is_shapely, no_geometry, parts_of
from delone.errors import InputError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = [
    "LOOSE",
    "Ring",
    "line_of",
    "lines_of",
    "require_areas",
    "rings_by_feature",
    "rings_of",
]

# The polygon number of rings that belong to none.
LOOSE = 0


class Ring(NamedTuple):
    """A line or ring, and its polygon."""

    points: Floats  # (k, 3), heights NaN where there are none
    polygon: int | None = None  # None for a separate polygon


def lines_of(given: Any, *, name: str, crs: str | None) -> list[Floats]:
    """Return lines as arrays (k, 3); heights are NaN where there are none, as in the input.

    Accepted are shapely geometries, GeoDataFrames, a `GeometrySet`, arrays (k, 2) or (k, 3), and
    sequences of these. Polygons become their rings, closed. Lines that declare a reference
    system other than `crs` are transformed.
    """
    return [line.points for line in _placed(given, name, crs)]


def _placed(given: Any, name: str, crs: str | None) -> list[Ring]:
    """Return lines and rings with points, in a reference system."""
    several = isinstance(given, list | tuple) and not _is_line(given)
    number, found = count(1), []
    for item in given if several else [given]:
        for line, polygon in _each(item, name, number):
            if len(line):
                points = transformed(item, line, crs, name=name, to="the surface")
                found.append(Ring(points, polygon))
    return found


def rings_of(given: Any, *, name: str, crs: str | None) -> list[Ring]:
    """Return closed rings; arrays that do not repeat their first point at the end are closed."""
    return [_closed(ring, name) for ring in _placed(given, name, crs)]


def _closed(ring: Ring, name: str) -> Ring:
    points = ring.points
    if not (points[0, :2] == points[-1, :2]).all():
        points = np.vstack((points, points[:1]))
    if len(points) < 4:
        raise InputError(f"{name}: a ring needs at least three points, got {len(points) - 1}")
    return ring._replace(points=points)


def rings_by_feature(given: Any, *, name: str, crs: str | None) -> list[list[Ring]]:
    """Return the closed rings of each feature of a layer, none where it has no geometry.

    A feature is a row of a table, a geometry of a sequence or collection of features, or one of
    several rings given as arrays, which are separate polygons here.
    """
    found: list[list[Ring]] = []
    for row, feature in enumerate(_features(given)):
        own = f"{name}, feature {row}"
        _require_areas(feature, own)
        rings = [ring for ring in _each(feature, own, count(1)) if len(ring.points)]
        found.append([_closed(ring, own) for ring in rings])
    # All at once, because each call of a transformation has a fixed cost.
    every = [ring.points for rings in found for ring in rings]
    if every:
        moved = transformed(given, np.concatenate(every), crs, name=name, to="the surface")
        parts = iter(np.split(moved, np.cumsum([len(points) for points in every])[:-1]))
        found = [[ring._replace(points=next(parts)) for ring in rings] for rings in found]
    return found


def _features(given: Any) -> list[Any]:
    """Return the features of a layer."""
    if hasattr(given, "geometries") and hasattr(given, "feature_heights"):  # a GeometrySet
        return list(given.geometries)
    if hasattr(given, "geometry") and hasattr(given.geometry, "values"):
        return list(given.geometry.values)
    if not isinstance(given, Mapping) and not is_shapely(given):
        given = getattr(given, "__geo_interface__", given)
    if isinstance(given, Mapping):
        several = given.get("type") == "FeatureCollection"
        features: Any = given.get("features") if several else None
        listed = hasattr(features, "__iter__") and not isinstance(features, Mapping | str | bytes)
        return list(features) if listed else [given]
    if is_shapely(given) or _is_line(given):
        return [given]
    if hasattr(given, "__iter__") and not isinstance(given, str | bytes):
        return list(given)
    return [given]


def require_areas(given: Any, name: str) -> None:
    """Reject geometries that are neither polygons nor closed lines; arrays are rings."""
    if _is_line(given) or isinstance(given, Ring):
        return
    features = _features(given)
    for row, feature in enumerate(features):
        if isinstance(feature, list | tuple) or hasattr(feature, "geometry"):
            require_areas(feature, name)
        else:
            _require_areas(feature, name if len(features) == 1 else f"{name}, feature {row}")


def _require_areas(feature: Any, name: str) -> None:
    """Reject a geometry that is neither a polygon nor a closed line."""
    mapping = feature if isinstance(feature, Mapping) else None
    if mapping is not None:
        geometry = mapping.get("geometry") if mapping.get("type") == "Feature" else mapping
        if not geometry:
            return
        feature = _shape(geometry, name)
    if not is_shapely(feature) or feature.is_empty:
        return
    for part in getattr(feature, "geoms", [feature]):
        kind = part.geom_type
        if kind in ("Point", "LineString") and not (kind == "LineString" and part.is_closed):
            raise InputError(
                f"{name} is not a polygon but contains a {kind}: select the polygons, or close "
                "the line"
            )


def line_of(given: Any, *, name: str, crs: str | None) -> Floats:
    """Return one line of at least two points, (k, 2)."""
    lines = lines_of(given, name=name, crs=crs)
    if len(lines) != 1 or len(lines[0]) < 2:
        found = "one of one point" if len(lines) == 1 else counted(len(lines), "line")
        raise InputError(f"{name} must be one line of at least two points, got {found}")
    points = np.ascontiguousarray(lines[0][:, :2])
    if (points == points[0]).all():
        raise InputError(f"{name} has no length: it needs two points that differ")
    return points


def _each(given: Any, name: str, number: count[int]) -> Iterator[Ring]:
    """Yield lines with the polygons that they belong to, which `number` numbers."""
    if given is None:
        return
    if isinstance(given, Ring):
        yield given._replace(polygon=next(number))
    elif is_shapely(given):
        yield from _of_geometry(given, name, number)
    elif hasattr(given, "geometries") and hasattr(given, "feature_heights"):  # a GeometrySet
        yield from _of_set(given, name, number)
    elif hasattr(given, "geometry") and hasattr(given.geometry, "values"):
        yield from _each(list(given.geometry.values), name, number)
    elif isinstance(given, Mapping) or hasattr(given, "__geo_interface__"):
        yield from _of_mapping(given, name, number)
    elif _is_line(given):
        yield Ring(_of_array(as_plain_array(given, name), name), LOOSE)
    elif hasattr(given, "__iter__") and not isinstance(given, str | bytes):
        for item in given:
            yield from _each(item, name, number)
    else:
        raise InputError(
            f"{name}: {given!r:.60} is not a line: give shapely geometries, or arrays of shape "
            "(k, 2) or (k, 3)"
        )


def _of_set(given: Any, name: str, number: count[int]) -> Iterator[Ring]:
    """Yield the lines of a GeometrySet; a height in a column applies to a whole line."""
    for row, geometry in enumerate(given.geometries):
        for line in _each(geometry, name, number):
            if given.feature_heights is not None:
                line.points[:, 2] = given.feature_heights[row]
            yield line


def _of_mapping(given: Any, name: str, number: count[int]) -> Iterator[Ring]:
    """Yield the lines of GeoJSON, and of objects with a GeoJSON-like interface."""
    for geometry in geometries_in(given, name):
        shape = geometry if is_shapely(geometry) else _shape(geometry, name)
        yield from _of_geometry(shape, name, number)


def _shape(mapping: Any, name: str) -> Any:
    """Return the shapely geometry of a GeoJSON geometry."""
    shape = require("shapely.geometry", extra="geo", what="GeoJSON").shape
    try:
        # NaN is refused later, with its row.
        with np.errstate(invalid="ignore"):
            return shape(mapping)
    # What shapely raises depends on the fault; most often it lacks a key.
    except Exception as error:
        refusal = no_geometry(mapping, name)
        try:
            parts_of(mapping, name=name)
        except ShapeError as wrong:
            # The row of coordinates that are not numbers.
            refusal.args = (f"{refusal}: {wrong}",)
        except InputError:
            pass
        raise refusal from error


def _is_line(given: Any) -> bool:
    """Whether an array or a sequence is one line: its items are points."""
    if isinstance(given, np.ndarray):
        return bool(given.dtype != object)
    if not isinstance(given, list | tuple) or not given or is_shapely(given[0]):
        return False
    try:
        first = np.asarray(given[0], dtype=np.float64)
    except (TypeError, ValueError):
        return False
    return first.ndim == 1


def _of_array(array: NDArray[Any], name: str) -> Floats:
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise wrong_shape(f"{name}: a line", "(k, 2) or (k, 3)", array)
    points = as_points(array, name=name)
    found = np.full((len(points), 3), np.nan)
    found[:, : points.shape[1]] = points
    return _checked(found, name)


def _checked(points: Floats, name: str) -> Floats:
    """Reject points that are not finite; a height of NaN means none."""
    require_finite(np.where(np.isnan(points) & (np.arange(3) == 2), 0.0, points), name=name)
    return points


def _of_geometry(geometry: Any, name: str, number: count[int]) -> Iterator[Ring]:
    """Yield the lines and rings of a shapely geometry."""
    import shapely

    kind = geometry.geom_type
    if kind in ("Point", "MultiPoint"):
        raise InputError(f"{name}: a {kind} is not a line")
    if hasattr(geometry, "geoms"):
        for part in geometry.geoms:
            yield from _of_geometry(part, name, number)
        return
    if kind == "Polygon":
        polygon, lines = next(number), [geometry.exterior, *geometry.interiors]
    else:
        polygon, lines = LOOSE, [geometry]
    for line in lines:
        yield Ring(_checked(shapely.get_coordinates(line, include_z=True), name), polygon)
