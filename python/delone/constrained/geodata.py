"""Conversion of geometries to arrays.

Shapely reads its geometries in bulk. Objects that only have ``__geo_interface__``, and mappings of
that form, are read here, so that no library is needed for them. Either way a geometry becomes
parts: runs of coordinates, each a ring (closed without repeating its first point), a line or
points. Third coordinates are dropped; missing and empty geometries have no parts.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_points, refuse_masks
from delone._base.counting import agreed
from delone.errors import DtypeError, InputError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = [
    "EXTERIOR",
    "INTERIOR",
    "LINE",
    "POINTS",
    "Parts",
    "geometries_in",
    "is_geometry",
    "is_shapely",
    "no_geometry",
    "parts_of",
    "polygon_of",
    "require_finite_geometries",
    "require_finite_parts",
    "rings_of_numbers",
    "steps_of",
]

POINTS, LINE, EXTERIOR, INTERIOR = range(4)
# Shapely's type numbers.
_POLYGON, _COLLECTION = 3, 7
# By type: points, lines, rings that do not belong to a polygon, outer rings; last, no geometry.
_KIND_OF = np.array([POINTS, LINE, LINE, EXTERIOR, LINE])


class Parts(NamedTuple):
    """Runs of coordinates, and the kind of each."""

    # (n, 2): all parts, one after another.
    coordinates: Floats
    # (p + 1,): the start of each part in the coordinates.
    starts: NDArray[np.int64]
    # (p,): POINTS, LINE, EXTERIOR or INTERIOR.
    kinds: NDArray[np.int64]
    # (p,): the geometry of each part, in input order.
    geometries: NDArray[np.int64]


def parts_of(geometries: Any, *, name: str = "geometries") -> Parts:
    """Split geometries, in order, into parts; each row of a table or feature is a geometry.

    They are shapely geometries, GeoDataFrames, GeoSeries, objects with
    ``__geo_interface__``, mappings of that form, None, or iterables of these; or a ring of
    coordinates, (n, 2), or a sequence of rings, which are one polygon by the even-odd rule.
    """
    found: list[Parts] = []
    count = 0
    try:
        for batch in _batches(geometries, name):
            if isinstance(batch, np.ndarray):
                parts, length = _split(batch), len(batch)
            else:
                parts, length = _of_runs(_of_mapping(batch, name)), 1
            found.append(parts._replace(geometries=parts.geometries + count))
            count += length
    except RecursionError:
        raise InputError(f"{name}: collections are too deeply nested") from None
    except NotImplementedError:  # raised by shapely for curves
        raise InputError(f"{name}: curves are not supported, only straight lines") from None
    return _joined(found)


def require_finite_parts(parts: Parts) -> None:
    """Reject NaN and infinity, and name the geometries that have them."""
    part = np.repeat(np.arange(len(parts.geometries)), np.diff(parts.starts))
    require_finite_geometries(parts.coordinates, parts.geometries[part])


def require_finite_geometries(coordinates: Floats, geometries: NDArray[Any]) -> None:
    """The same for rows of coordinates, and the geometry of each row."""
    finite = np.isfinite(coordinates)
    if not finite.all():
        bad = np.unique(geometries[~finite.all(axis=1)])
        first = ", ".join(map(str, bad[:10].tolist()))
        raise NonFiniteError(
            f"{len(bad)} {agreed(len(bad), 'geometry has', 'geometries have')} NaN or infinity; "
            f"first: {first}",
            rows=bad[:10],
            count=len(bad),
        )


def steps_of(parts: Parts) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the segments of lines and rings as rows of coordinates, and the part of each."""
    counts = np.diff(parts.starts)
    part = np.repeat(np.arange(len(counts)), counts)
    tail = np.arange(len(part))
    head = tail + 1
    # The last row of a ring continues to its first row, the last row of a line does not continue.
    head[parts.starts[1:] - 1] = parts.starts[:-1]
    ring = parts.kinds >= EXTERIOR
    leads = np.repeat(parts.kinds != POINTS, counts)
    last = parts.starts[1:] - 1
    leads[last[~ring]] = False
    # A ring of one point has no side.
    leads[last[ring & (counts == 1)]] = False
    return np.column_stack((tail, head))[leads], part[leads]


def _batches(given: Any, name: str) -> Iterator[Any]:
    """Yield arrays of shapely geometries, and mappings, in input order."""
    if given is None:
        yield np.array([None], dtype=object)
    elif hasattr(given, "geom_type") and is_shapely(given):
        yield np.array([given], dtype=object)
    elif hasattr(given, "geometry") and hasattr(given.geometry, "values"):
        yield np.asarray(given.geometry.values, dtype=object)
    elif isinstance(getattr(given, "geometries", None), np.ndarray):  # a GeometrySet
        yield from _batches(given.geometries, name)
    elif isinstance(given, Mapping) or hasattr(given, "__geo_interface__"):
        for geometry in geometries_in(given, name):
            yield _object_array([geometry]) if is_shapely(geometry) else geometry
    elif isinstance(given, str | bytes | os.PathLike):
        raise InputError(_string_error(given, name))
    elif not hasattr(given, "__iter__") or isinstance(given, type):
        raise no_geometry(given, name)
    else:
        refuse_masks(given, name)
        rings = rings_of_numbers(given, name)
        if rings is None:
            yield from _of_iterable(given, name)
        else:
            yield polygon_of(rings)


def rings_of_numbers(given: Any, name: str) -> list[Floats] | None:
    """Return a ring of coordinates, or each of a sequence of rings; None for anything else.

    A ring has two columns and at least three rows.
    """
    if not isinstance(given, list | tuple | np.ndarray) or not len(given):
        return None
    if _is_ring(given):
        return [as_points(given, ndim=2, name=name)]
    if not all(isinstance(each, list | tuple | np.ndarray) and _is_ring(each) for each in given):
        return None
    return [as_points(each, ndim=2, name=name) for each in given]


def polygon_of(rings: list[Floats]) -> dict[str, Any]:
    """Return rings of coordinates as one polygon."""
    return {"type": "Polygon", "coordinates": rings}


def _is_ring(given: list[Any] | tuple[Any, ...] | NDArray[Any]) -> bool:
    if isinstance(given, np.ndarray) and given.dtype.kind != "O":
        return given.ndim == 2 and given.shape[1] == 2 and len(given) > 2
    return len(given) > 2 and all(
        isinstance(each, list | tuple | np.ndarray)
        and len(each) == 2
        and all(isinstance(number, int | float | np.number) for number in each)
        for each in given
    )


def _string_error(given: Any, name: str) -> str:
    """Return an error message for a string: it is a file name or WKT."""
    text = os.fsdecode(given)
    if not isinstance(given, os.PathLike) and "(" in text:
        return f"{name}: {text!r:.80} is not a geometry: read WKT with shapely.from_wkt"
    return (
        f"{name}: {text!r:.80} is the name of a file, not a geometry: read it with "
        f"delone.io.read_geometries({text!r:.80})"
    )


def is_shapely(given: Any) -> bool:
    """Return whether an object is a shapely geometry, without importing shapely."""
    shapely = sys.modules.get("shapely")
    return shapely is not None and isinstance(given, shapely.Geometry)


def is_geometry(given: Any) -> bool:
    """Return whether an object is one geometry or a table of geometries, not coordinates."""
    names = "geom_type", "__geo_interface__"
    return isinstance(given, Mapping) or any(hasattr(given, name) for name in names)


def _of_iterable(given: Iterable[Any], name: str) -> Iterator[Any]:
    """Yield runs of shapely geometries as arrays, so that they are read in bulk."""
    run: list[Any] = []
    for item in given:
        if item is None or is_shapely(item):
            run.append(item)
            continue
        if run:
            yield _object_array(run)
            run = []
        if isinstance(item, int | float | np.number):
            box = "a box is shapely.box(xmin, ymin, xmax, ymax)"
            raise InputError(f"{name}: {item!r:.80} is not a geometry: {box}")
        yield from _batches(item, name)
    if run:
        yield _object_array(run)


def _object_array(items: list[Any]) -> NDArray[Any]:
    array = np.empty(len(items), dtype=object)
    array[:] = items
    return array


def geometries_in(given: Any, name: str) -> Iterator[Any]:
    """Yield the geometries of GeoJSON, one for each feature, as mappings or shapely geometries.

    A feature may be None, without a geometry, or an object with ``__geo_interface__``.
    """
    if given is None:
        yield {"type": "GeometryCollection", "geometries": []}
    elif is_shapely(given):
        yield given
    else:
        mapping = given if isinstance(given, Mapping) else _interface(given, name)
        kind = mapping.get("type")
        if kind == "FeatureCollection":
            for feature in _listed(mapping, "features", name):
                yield from geometries_in(feature, name)
        elif kind == "Feature":
            geometry = mapping.get("geometry", mapping)
            inner = geometry if isinstance(geometry, Mapping) else None
            if inner is not None and inner.get("type") in {"Feature", "FeatureCollection"}:
                raise no_geometry(dict(mapping), name)
            yield from geometries_in(geometry, name)
        else:
            _listed(mapping, "geometries" if kind == "GeometryCollection" else "coordinates", name)
            yield mapping


def _interface(given: Any, name: str) -> Mapping[str, Any]:
    mapping = getattr(given, "__geo_interface__", None)
    if isinstance(mapping, Mapping):
        return mapping
    raise no_geometry(given, name)


def _kind_of(mapping: Any, name: str) -> Any:
    if not isinstance(mapping, Mapping):
        raise no_geometry(mapping, name)
    return mapping.get("type")


def _listed(mapping: Mapping[str, Any], member: str, name: str) -> Any:
    """Return a member of a mapping in GeoJSON form that must be a list."""
    found = mapping.get(member)
    if not hasattr(found, "__iter__") or isinstance(found, Mapping | str | bytes):
        raise no_geometry(dict(mapping), name)
    return found


def _split(geometries: NDArray[Any]) -> Parts:
    """Split shapely geometries into parts, in bulk."""
    if all(item is None for item in geometries.tolist()):
        return _joined([])
    shapely = sys.modules["shapely"]
    rows = np.arange(len(geometries))
    if (shapely.get_type_id(geometries) > _COLLECTION).any():
        raise NotImplementedError("a curve that shapely can hold")
    while (shapely.get_type_id(geometries) > _POLYGON).any():
        geometries, index = shapely.get_parts(geometries, return_index=True)
        rows = rows[index]
    kinds = _KIND_OF[shapely.get_type_id(geometries)]
    # Making rings takes longer than reading coordinates.
    several = shapely.get_num_interior_rings(geometries) > 0
    if several.any():
        rings, index = shapely.get_rings(geometries[several], return_index=True)
        # The rings of a polygon take its place in the order.
        items = np.concatenate((geometries[~several], rings))
        at = np.concatenate((np.flatnonzero(~several), np.flatnonzero(several)[index]))
        kinds = np.concatenate((kinds[~several], _ring_kinds(index)))
        order = np.argsort(at, kind="stable")
        geometries, kinds, rows = items[order], kinds[order], rows[at[order]]
    coordinates, part = shapely.get_coordinates(geometries, return_index=True)
    return _closed(coordinates, part, kinds, rows)


def _ring_kinds(polygon: NDArray[np.int64]) -> NDArray[np.int64]:
    first = np.ones(len(polygon), dtype=bool)
    first[1:] = polygon[1:] != polygon[:-1]
    return np.where(first, EXTERIOR, INTERIOR)


def _closed(
    coordinates: Floats,
    part: NDArray[np.int64],
    kinds: NDArray[np.int64],
    geometries: NDArray[np.int64],
) -> Parts:
    """Drop empty parts, and the last point of each ring that repeats its first one."""
    counts = np.bincount(part, minlength=len(kinds))
    starts = np.concatenate(([0], np.cumsum(counts)))
    ring = np.flatnonzero((kinds >= EXTERIOR) & (counts > 1))
    first, last = starts[ring], starts[ring + 1] - 1
    x, y = (coordinates[first] == coordinates[last]).T
    repeats = x & y
    stays = np.ones(len(coordinates), dtype=bool)
    stays[last[repeats]] = False
    counts[ring[repeats]] -= 1
    full = counts > 0
    return Parts(
        np.ascontiguousarray(coordinates[stays]),
        np.concatenate(([0], np.cumsum(counts[full]))),
        kinds[full],
        geometries[full],
    )


def _of_runs(runs: Iterable[tuple[Floats, int]]) -> Parts:
    """Return the parts of one geometry, given as coordinates and kinds."""
    rows = [np.empty((0, 2))]
    kinds: list[int] = []
    for coordinates, kind in runs:
        rows.append(coordinates)
        kinds.append(kind)
    counts = np.array([len(each) for each in rows[1:]], dtype=np.int64)
    part = np.repeat(np.arange(len(kinds)), counts)
    none = np.zeros(len(kinds), dtype=np.int64)
    return _closed(np.concatenate(rows), part, np.array(kinds, dtype=np.int64), none)


def no_geometry(given: object, name: str) -> InputError:
    """Return the error for something that is not a geometry."""
    return InputError(f"{name}: {given!r:.80} is not a geometry")


def _of_mapping(mapping: Any, name: str) -> Iterator[tuple[Floats, int]]:
    """Split a mapping in GeoJSON form into runs of coordinates, and the kind of each."""
    kind = _kind_of(mapping, name)
    if kind == "GeometryCollection":
        for geometry in _listed(mapping, "geometries", name):
            if geometry is not None:
                yield from _of_mapping(geometry, name)
        return
    if not isinstance(kind, str):
        raise no_geometry(dict(mapping), name)
    coordinates = _listed(mapping, "coordinates", name)
    if kind in ("Point", "MultiPoint"):
        for point in [coordinates] if kind == "Point" else coordinates:
            yield _run([point], kind), POINTS
    elif kind in ("LineString", "MultiLineString"):
        for line in [coordinates] if kind == "LineString" else coordinates:
            yield _run(line, kind), LINE
    elif kind in ("Polygon", "MultiPolygon"):
        for polygon in [coordinates] if kind == "Polygon" else coordinates:
            rings = _listed({**mapping, "coordinates": polygon}, "coordinates", name)
            for i, ring in enumerate(rings):
                yield _run(ring, kind), INTERIOR if i else EXTERIOR
    else:
        raise InputError(f"{name}: unknown geometry type {kind!r:.80}")


def _run(coordinates: Any, what: str) -> Floats:
    plain = type(coordinates) is np.ndarray and coordinates.dtype == np.float64
    if plain and coordinates.shape[1:] == (2,):  # as `as_points` returns rings
        ring: Floats = coordinates
        return ring
    refuse_masks(coordinates, f"a {what}")
    try:
        pairs = [tuple(row)[:2] for row in coordinates if len(row)]
        refuse_masks(list(chain.from_iterable(pairs)), f"a {what}")
        rows = np.array(pairs, dtype=np.float64)
    except DtypeError:
        raise
    except (TypeError, ValueError) as error:
        raise _no_pairs(coordinates, what) from error
    except OverflowError as error:
        raise InputError(
            f"a {what} has a coordinate beyond the range of doubles: {error}"
        ) from error
    if rows.size == 0:
        return np.empty((0, 2))
    if rows.ndim != 2 or rows.shape[1] != 2:
        raise _no_pairs(coordinates, what)
    return rows


def _no_pairs(coordinates: Any, what: str) -> ShapeError:
    """Return the error for coordinates that no array can hold, with the first row at fault."""
    message = f"the coordinates of a {what} are not pairs of numbers"
    for number, row in enumerate(coordinates if hasattr(coordinates, "__iter__") else ()):
        try:
            [float(each) for each in tuple(row)[:2]]
            if len(row) == 1:
                raise ValueError
        except (TypeError, ValueError):
            return ShapeError(f"{message}: row {number} is {row!r:.60}")
    return ShapeError(message)


def _joined(parts: Iterable[Parts]) -> Parts:
    none = Parts(
        np.empty((0, 2)),
        np.zeros(1, dtype=np.int64),
        np.empty(0, dtype=np.int64),
        np.empty(0, dtype=np.int64),
    )
    many = [none, *parts]
    if len(many) == 2:
        return many[1]
    counts = np.concatenate([np.diff(each.starts) for each in many])
    return Parts(
        np.concatenate([each.coordinates for each in many]),
        np.concatenate(([0], np.cumsum(counts))),
        np.concatenate([each.kinds for each in many]),
        np.concatenate([each.geometries for each in many]),
    )
