"""Lines and rings with heights, as arrays: breaklines, boundaries, profiles.

Rings have one meaning everywhere: each polygon has its own holes, and several polygons are a union.
Rings that belong to no polygon (arrays and closed lines) are together one polygon, whose inside is
what an odd number of them contain.
"""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._arrays import as_plain_array, as_points, require_finite
from delone.constrained.geodata import is_shapely
from delone.errors import InputError, ShapeError
from delone.extras import require
from delone.georeference import transformed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from delone._types import Floats

__all__ = ["Ring", "line_of", "lines_of", "rings_of"]

# The polygon of rings that belong to none.
_LOOSE = 0


class Ring(NamedTuple):
    """A line or ring, and its polygon."""

    points: Floats  # (k, 3), heights NaN where there are none
    polygon: int | None = None  # None for a polygon of its own


def lines_of(given: Any, *, name: str, crs: str | None) -> list[Floats]:
    """Return lines as arrays (k, 3); heights are NaN where there are none, also in the input.

    Accepted are shapely geometries, GeoDataFrames, a `GeometrySet`, arrays (k, 2) or (k, 3), and
    sequences of these. Polygons become their rings, closed. Lines that declare another reference
    system than `crs` are transformed.
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
    """Return closed rings: arrays that do not repeat their first point at the end are closed."""
    rings = []
    for ring, polygon in _placed(given, name, crs):
        closed = ring if (ring[0, :2] == ring[-1, :2]).all() else np.vstack((ring, ring[:1]))
        if len(closed) < 4:
            raise InputError(f"{name}: a ring needs at least three points, got {len(closed) - 1}")
        rings.append(Ring(closed, polygon))
    return rings


def line_of(given: Any, *, name: str, crs: str | None) -> Floats:
    """Return one line of at least two points, (k, 2)."""
    lines = lines_of(given, name=name, crs=crs)
    if len(lines) != 1 or len(lines[0]) < 2:
        raise InputError(f"{name} must be one line of at least two points, got {given!r:.60}")
    return np.ascontiguousarray(lines[0][:, :2])


def _each(given: Any, name: str, number: count[int]) -> Iterator[Ring]:
    """Yield lines with the polygons that they belong to; `number` numbers these."""
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
    elif isinstance(given, dict) or hasattr(given, "__geo_interface__"):
        yield from _of_mapping(given, name, number)
    elif _is_line(given):
        yield Ring(_of_array(as_plain_array(given, name), name), _LOOSE)
    elif hasattr(given, "__iter__") and not isinstance(given, str | bytes):
        for item in given:
            yield from _each(item, name, number)
    else:
        raise InputError(
            f"{name}: {given!r:.60} is not a line: give shapely geometries, or arrays of shape "
            "(k, 2) or (k, 3)"
        )


def _of_set(given: Any, name: str, number: count[int]) -> Iterator[Ring]:
    """Yield the lines of a GeometrySet; heights in a column are those of whole lines."""
    for row, geometry in enumerate(given.geometries):
        for line in _each(geometry, name, number):
            if given.feature_heights is not None:
                line.points[:, 2] = given.feature_heights[row]
            yield line


def _of_mapping(given: Any, name: str, number: count[int]) -> Iterator[Ring]:
    """Yield the lines of GeoJSON, and of objects with an interface of that form."""
    mapping = given if isinstance(given, dict) else given.__geo_interface__
    if mapping.get("type") == "FeatureCollection":
        yield from _each(mapping["features"], name, number)
    elif mapping.get("type") == "Feature":
        yield from _each(mapping["geometry"], name, number)
    else:
        shape = require("shapely.geometry", extra="geo", what="GeoJSON").shape
        yield from _of_geometry(shape(mapping), name, number)


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
        raise ShapeError(f"{name}: a line must have shape (k, 2) or (k, 3), got {array.shape}")
    points = as_points(array, name=name)
    found = np.full((len(points), 3), np.nan)
    found[:, : points.shape[1]] = points
    return _checked(found, name)


def _checked(points: Floats, name: str) -> Floats:
    """Refuse points that are not finite; a height that is NaN is none."""
    require_finite(np.where(np.isnan(points) & (np.arange(3) == 2), 0.0, points), name=name)
    return points


def _of_geometry(geometry: Any, name: str, number: count[int]) -> Iterator[Ring]:
    """Yield the lines and rings of a geometry of shapely."""
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
        polygon, lines = _LOOSE, [geometry]
    for line in lines:
        yield Ring(_checked(shapely.get_coordinates(line, include_z=True), name), polygon)
