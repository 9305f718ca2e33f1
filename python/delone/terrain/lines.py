"""Lines and rings with heights, as arrays: breaklines, boundaries, profiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_plain_array, as_points, require_finite
from delone.errors import InputError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["line_of", "lines_of", "rings_of"]


def lines_of(given: Any, *, name: str) -> list[Floats]:
    """Return lines as arrays (k, 3); heights are NaN where there are none, also in the input.

    Taken are geometries of shapely, tables of them, a `GeometrySet`, arrays (k, 2) or (k, 3), and
    sequences of these. Polygons become their rings, closed.
    """
    return [line for line in _each(given, name) if len(line)]


def rings_of(given: Any, *, name: str) -> list[Floats]:
    """Return closed rings: arrays that do not repeat their first point at the end are closed."""
    rings = []
    for ring in lines_of(given, name=name):
        closed = ring if (ring[0, :2] == ring[-1, :2]).all() else np.vstack((ring, ring[:1]))
        if len(closed) < 4:
            raise InputError(f"{name}: a ring needs at least three points, got {len(closed) - 1}")
        rings.append(closed)
    return rings


def line_of(given: Any, *, name: str) -> Floats:
    """Return one line of at least two points, (k, 2)."""
    lines = lines_of(given, name=name)
    if len(lines) != 1 or len(lines[0]) < 2:
        raise InputError(f"{name} must be one line of at least two points, got {given!r:.60}")
    return np.ascontiguousarray(lines[0][:, :2])


def _each(given: Any, name: str) -> Iterator[Floats]:
    if given is None:
        return
    if hasattr(given, "geom_type"):
        yield from _of_geometry(given, name)
    elif hasattr(given, "geometries") and hasattr(given, "heights"):  # a GeometrySet
        for row, geometry in enumerate(given.geometries):
            for line in _each(geometry, name):
                if given.heights is not None:
                    line[:, 2] = given.heights[row]
                yield line
    elif hasattr(given, "geometry") and hasattr(given.geometry, "values"):
        yield from _each(list(given.geometry.values), name)
    elif isinstance(given, np.ndarray) and given.dtype != object:
        yield _of_array(given, name)
    elif _is_line(given):
        yield _of_array(as_plain_array(given, name), name)
    elif hasattr(given, "__iter__") and not isinstance(given, str | bytes):
        for item in given:
            yield from _each(item, name)
    else:
        raise InputError(
            f"{name}: {given!r:.60} is not a line: give geometries of shapely, or arrays of shape "
            "(k, 2) or (k, 3)"
        )


def _is_line(given: Any) -> bool:
    """Whether a sequence is one line: its items are points."""
    if not isinstance(given, list | tuple) or not given or hasattr(given[0], "geom_type"):
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


def _of_geometry(geometry: Any, name: str) -> Iterator[Floats]:
    """Yield the lines and rings of a geometry of shapely."""
    import shapely

    kind = geometry.geom_type
    if kind in ("Point", "MultiPoint"):
        raise InputError(f"{name}: a {kind} is not a line")
    if hasattr(geometry, "geoms"):
        for part in geometry.geoms:
            yield from _of_geometry(part, name)
        return
    lines = [geometry.exterior, *geometry.interiors] if kind == "Polygon" else [geometry]
    for line in lines:
        yield _checked(shapely.get_coordinates(line, include_z=True), name)
