"""Arrays of cells for the core: bounds, corners, and rings of shapely geometries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import (
    as_plain_array,
    as_points,
    as_workers,
    require_finite,
    wrong_shape,
)
from delone._base.extras import require
from delone._base.georeference import crs_of, is_geographic
from delone.constrained.geodata import no_geometry, require_finite_geometries
from delone.errors import DtypeError, InputError, ShapeError
from delone.sphere.coordinates import BEYOND, directions_of, units_of
from delone.sphere.flat import flat_polygon

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Rows
    from delone.sphere.voronoi import Voronoi

# Shapely's numbers of polygons, multipolygons and no geometry, and of collections.
_AREAL = (3, 6, -1)
_COLLECTION = 7
_FEWEST = 3

__all__ = [
    "WIDE",
    "Rings",
    "as_bounds",
    "as_corners",
    "as_starts",
    "boxes",
    "corners",
    "geometries",
    "merged_corners",
    "rows",
    "shapes",
    "tangents_of",
    "voronoi",
]

# Wider columns are cut, because directions do not represent whole turns.
WIDE = 90.0


class Rings(NamedTuple):
    """Corners, where rings start in them, where cells start in rings, and which rings are holes."""

    vectors: Floats
    rings: Rows
    cells: Rows
    holes: NDArray[np.bool_]


def as_bounds(values: ArrayLike, *, name: str, degrees: bool) -> Floats:
    """Return the bounds of columns or rows as edges between them, in degrees."""
    array = as_plain_array(values, name)
    flat = as_points(array.reshape(-1, 1), name=name, ndim=1)[:, 0]
    require_finite(flat.reshape(-1, 1), name=name)
    if array.ndim == 2 and array.shape[1] == 2:
        first, second = flat.reshape(-1, 2).T
        # The bounds of each entry may be in the opposite order.
        orders = (first, second), (second, first)
        apart = [one[1:] != other[:-1] for one, other in orders]
        best = int(apart[1].sum() < apart[0].sum())
        first, second = orders[best]
        if apart[best].any():
            at = int(np.flatnonzero(apart[best])[0])
            raise InputError(
                f"{name}: the bounds of entries {at} and {at + 1} do not meet: give edges, or "
                "make cells with gaps by Grid.from_mesh"
            )
        flat = np.concatenate((first, second[-1:]))
    elif array.ndim != 1:
        raise wrong_shape(name, "(n + 1,) or (n, 2)", array)
    if len(flat) < 2:
        raise ShapeError(f"{name} must have at least 2 edges, got {len(flat)}")
    steps = np.diff(flat)
    if not ((steps > 0).all() or (steps < 0).all()):
        wrong = int(np.flatnonzero(steps * (1 if steps[0] > 0 else -1) <= 0)[0])
        raise InputError(f"{name} must ascend or descend, which it does not after entry {wrong}")
    turns = flat if degrees else np.degrees(flat)
    return _on_earth(turns, name)


def _on_earth(edges: Floats, name: str) -> Floats:
    """Return edges with exact poles and whole turns, or reject those that are beyond them."""
    top = float(np.abs(edges).max())
    if name == "lat":
        if top > 90 * BEYOND:
            raise InputError(f"lat: {top:g} degrees is beyond a pole: are these radians?")
        return np.clip(edges, -90.0, 90.0)
    span = abs(float(edges[-1] - edges[0]))
    if span > 360 * BEYOND or top > 1080:
        raise InputError(f"lon spans {span:g} degrees, more than one turn")
    if span * BEYOND >= 360:
        edges = edges.copy()
        edges[-1] = edges[0] + np.copysign(360.0, edges[-1] - edges[0])
    return edges


def tangents_of(lat: Floats) -> Floats:
    """Return the tangents of latitudes in degrees, infinite at the poles."""
    places = np.column_stack((np.zeros(len(lat)), lat))
    sloped = _core.sphere_directions(places, True, as_workers(None))
    found = np.copysign(np.inf, lat)
    np.divide(sloped[:, 2], sloped[:, 0], out=found, where=np.abs(lat) != 90)
    return found


def rows(lat: Floats, columns: list[Floats]) -> tuple[Any, ...]:
    """Return arrays for the core of rows of cells between meridians, numbered as given."""
    tangents = tangents_of(lat)
    both = np.sort(np.column_stack((tangents[:-1], tangents[1:])), axis=1)
    made: dict[int, tuple[Floats, NDArray[np.int32]]] = {}
    meridians, numbers, first = [], [], 0
    for edges in columns:
        if id(edges) not in made:
            made[id(edges)] = _meridians(edges)
        directions, own = made[id(edges)]
        meridians.append(directions)
        numbers.append(np.where(own >= 0, own + np.int32(first), np.int32(-1)))
        first += len(edges) - 1
    if first >= 2**31:
        raise InputError(f"a grid of {first} cells exceeds the limit of {2**31 - 1}")
    starts = np.cumsum([0, *(len(m) for m in meridians)]).astype(np.int64)
    flat = np.concatenate(numbers).astype(np.int32)
    return both, starts, np.concatenate(meridians), flat, first


def _meridians(edges: Floats) -> tuple[Floats, NDArray[np.int32]]:
    """Return the directions of meridians from west to east, and the column east of each."""
    own = np.arange(len(edges) - 1, dtype=np.int32)
    if edges[0] > edges[-1]:
        edges, own = edges[::-1], own[::-1]
    # Narrow columns remain as they are; wide ones are cut into equal parts.
    parts = np.maximum(np.ceil(np.diff(edges) / WIDE), 1).astype(np.int64)
    west, number = np.repeat(edges[:-1], parts), np.repeat(own, parts)
    within = np.arange(len(west)) - np.repeat(np.cumsum(parts) - parts, parts)
    west = west + within * np.repeat(np.diff(edges) / parts, parts)
    lon = np.append(west, edges[-1])
    places = np.column_stack((lon, np.zeros(len(lon))))
    directions = _core.sphere_directions(places, True, as_workers(None))[:, :2]
    if lon[-1] == lon[0] + 360:
        # The sum is rounded, but a full turn ends where it starts.
        directions[-1] = directions[0]
    return np.ascontiguousarray(directions), np.append(number, np.int32(-1))


def as_corners(
    lon: ArrayLike, lat: ArrayLike, *, degrees: bool, workers: int | None
) -> tuple[Floats, Rows, tuple[int, ...]]:
    """Return vectors of arrays of corners, (m, 3), the corners of cells, (n, k), and the shape."""
    x, y = as_plain_array(lon, "lon"), as_plain_array(lat, "lat")
    if x.shape != y.shape or x.ndim not in {2, 3} or 0 in x.shape:
        raise ShapeError(
            "lon and lat must both have shape (rows + 1, columns + 1) or (rows, columns, k), got "
            f"{x.shape} and {y.shape}"
        )
    flat = np.column_stack((x.ravel(), y.ravel()))
    vectors = directions_of(flat, None, degrees=degrees, workers=workers, any_turns=True)
    at = np.arange(len(vectors), dtype=np.int64).reshape(x.shape)
    if x.ndim == 3:
        return vectors, at.reshape(-1, x.shape[2]), x.shape[:2]
    if min(x.shape) < 2:
        raise ShapeError(f"lon and lat must have two rows and columns at least, got {x.shape}")
    around = at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]
    shape = x.shape[0] - 1, x.shape[1] - 1
    return vectors, np.stack(around, axis=2).reshape(-1, 4), shape


def as_starts(
    xyz: ArrayLike | None,
    lonlat: ArrayLike | None,
    starts: ArrayLike | None,
    *,
    degrees: bool,
    workers: int | None,
) -> tuple[Floats, Rows]:
    """Return corners, (k, 3), and where the corners of each cell start."""
    given = xyz if xyz is not None else lonlat
    if given is not None:
        array = as_plain_array(given, "lonlat" if xyz is None else "xyz")
        if array.ndim == 3:
            if starts is not None:
                raise ShapeError("starts are not needed for corners of shape (n, c, columns)")
            starts = np.arange(array.shape[0] + 1, dtype=np.int64) * array.shape[1]
            given = array.reshape(-1, array.shape[2])
    if xyz is not None:
        vectors = directions_of(lonlat, given, degrees=degrees, workers=workers)
    else:
        vectors = directions_of(given, None, degrees=degrees, workers=workers, any_turns=True)
    if starts is None:
        raise ShapeError("give starts, or corners of shape (n, c, columns)")
    where = as_plain_array(starts, "starts")
    if where.ndim != 1 or where.dtype.kind not in "iu" or not len(where):
        raise ShapeError(f"starts must be integers of shape (n + 1,), got {where.shape}")
    where = where.astype(np.int64)
    if where[0] != 0 or where[-1] != len(vectors) or (np.diff(where) < 0).any():
        raise ShapeError(f"starts must ascend from 0 to the number of corners, {len(vectors)}")
    return vectors, where


def merged_corners(vectors: Floats, merge: float) -> tuple[Floats, int]:
    """Return vectors with those closer than `merge` merged, and how many changed.

    Corners are compared along a line on which few coincide by chance. Each takes the place of the
    first corner to which a chain of close corners leads.
    """
    if not merge or len(vectors) < 2:
        return vectors, 0
    units = units_of(vectors, None)
    at = units @ np.array([0.35355339, 0.61237244, 0.70710678])
    order = np.argsort(at, kind="stable")
    sorted_at, places = at[order], units[order]
    width = merge + 1e-15
    step, close = 1, np.arange(len(order) - 1)
    pairs = []
    while True:
        # A corner that is far from one further along the line is far from all those beyond.
        close = close[close + step < len(order)]
        close = close[sorted_at[close + step] - sorted_at[close] <= width]
        if not len(close):
            break
        apart = ((places[close + step] - places[close]) ** 2).sum(axis=1)
        near = close[apart <= merge**2]
        pairs.append((order[near], order[near + step]))
        if step == 1:
            # The equal corner next to it finds the remaining close corners.
            close = close[apart > 0]
        step += 1
    if not pairs:
        return vectors, 0
    found = vectors[
        _first(len(vectors), *(np.concatenate(ends) for ends in zip(*pairs, strict=True)))
    ]
    changed = int((found != vectors).any(axis=1).sum())
    return (found, changed) if changed else (vectors, 0)


def _first(count: int, one: Rows, other: Rows) -> Rows:
    """Return the smallest number that pairs connect each number to, by doubling steps."""
    first = np.arange(count)
    while len(one):
        least = np.minimum(first[one], first[other])
        np.minimum.at(first, first[one], least)
        np.minimum.at(first, first[other], least)
        first = first[first]
        apart = first[one] != first[other]
        one, other = one[apart], other[apart]
    # Numbers that were reached early follow the others.
    while not np.array_equal(again := first[first], first):
        first = again
    return first


def _no_shape(given: Any) -> InputError:
    """Return the error for something that is not a shapely geometry."""
    error = no_geometry(given, "polygons")
    if isinstance(given, Mapping) and "type" in given:
        error.args = (f"{error} of shapely: convert it with shapely.geometry.shape",)
    return error


def _shapes(table: Any) -> NDArray[Any]:
    """Return shapely geometries; rings of coordinates become polygons."""
    shapely = require("shapely", extra="geo", what="a grid of polygons")
    if isinstance(table, shapely.Geometry):
        table = [table]
    if isinstance(table, str | bytes | Mapping | type) or not hasattr(table, "__iter__"):
        raise _no_shape(table)
    rows = list(table)
    items = np.empty(len(rows), dtype=object)
    for row, item in enumerate(rows):
        if isinstance(item, list | tuple | np.ndarray):
            # Shapely warns of NaN, which is refused when all geometries are known.
            with np.errstate(invalid="ignore"):
                items[row] = shapely.Polygon(_ring(item, row))
        elif item is None or isinstance(item, shapely.Geometry):
            items[row] = item
        else:
            raise _no_shape(item)
    return items


def _ring(given: Any, row: int) -> Floats:
    """Return a ring of longitudes and latitudes."""
    ring = as_plain_array(given, f"ring {row}")
    if ring.ndim != 2 or ring.shape[1] != 2 or len(ring) < _FEWEST:
        raise wrong_shape(f"ring {row}", "(k, 2) with at least 3 corners", ring)
    return as_points(ring, ndim=2, name=f"ring {row}")


def geometries(given: Any, *, degrees: bool, workers: int | None) -> Rings:
    """Return the rings of polygons, one cell for each geometry."""
    shapely = require("shapely", extra="geo", what="a grid of polygons")
    crs = crs_of(given)
    if crs is not None and not is_geographic(crs):
        raise InputError(
            "the polygons have a projected reference system: transform them with to_crs(4326)"
        )
    items = _shapes(getattr(given, "geometry", given))
    # Collections may contain collections.
    parts, of_item = items, np.arange(len(items))
    while (shapely.get_type_id(parts) == _COLLECTION).any():
        parts, of_part = shapely.get_parts(parts, return_index=True)
        of_item = of_item[of_part]
    kinds = shapely.get_type_id(parts)
    wrong = np.flatnonzero(~np.isin(kinds, _AREAL))
    if len(wrong):
        what = shapely.GeometryType(kinds[wrong[0]]).name
        raise InputError(f"geometry {of_item[wrong[0]]} is or contains a {what}, not a polygon")
    parts, of_part = shapely.get_parts(parts, return_index=True)
    of_item = of_item[of_part]
    rings, of_part = shapely.get_rings(parts, return_index=True)
    holes = np.concatenate(([False], of_part[1:] == of_part[:-1])) if len(of_part) else of_part
    places, of_ring = shapely.get_coordinates(rings, return_index=True)
    # The last place of a ring repeats the first.
    kept = np.concatenate((of_ring[1:] == of_ring[:-1], [False])) if len(of_ring) else of_ring
    places, of_ring = places[kept.astype(bool)], of_ring[kept.astype(bool)]
    if not len(places):
        raise InputError("there are no polygons")
    require_finite_geometries(places, of_item[of_part[of_ring]])
    vectors = directions_of(places, None, degrees=degrees, workers=workers, any_turns=True)
    count = np.bincount(of_ring, minlength=len(rings))
    per_item = np.bincount(of_item[of_part], minlength=len(items))
    return Rings(
        vectors,
        np.concatenate(([0], np.cumsum(count))).astype(np.int64),
        np.concatenate(([0], np.cumsum(per_item))).astype(np.int64),
        np.asarray(holes, dtype=np.bool_),
    )


def voronoi(diagram: Voronoi) -> tuple[Floats, Rows]:
    """Return the corners of the cells of a diagram, and where those of each site start."""
    if not hasattr(diagram, "_region"):
        raise DtypeError(f"diagram must be a delone.sphere.Voronoi, got {type(diagram).__name__}")
    if diagram._region is not None:
        raise InputError("the diagram is clipped: use Grid.from_polygons(diagram.to_geopandas())")
    if diagram.triangulation is None:
        raise InputError("all sites are on one great circle: cells are lunes, not polygons")
    indptr, entries = diagram.region_rows
    cells = diagram.point_region.astype(np.int64)
    counts = np.diff(indptr).astype(np.int64)[cells]
    starts = np.concatenate(([0], np.cumsum(counts)))
    within = np.arange(starts[-1]) - np.repeat(starts[:-1], counts)
    rows_of = np.repeat(indptr[cells].astype(np.int64), counts) + within
    return diagram.vertices[entries[rows_of]], starts


def _runs(arrays: tuple[Any, ...]) -> tuple[Rows, Rows, Rows, Rows]:
    """Return the row, the western and eastern meridian, and the number of each cell."""
    _, starts, _, numbers, _ = arrays
    row = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    usable = numbers >= 0
    usable[starts[1:] - 1] = False
    change = np.ones(len(numbers), dtype=bool)
    change[1:] = (numbers[1:] != numbers[:-1]) | (row[1:] != row[:-1])
    west = np.flatnonzero(usable & change)
    last = np.flatnonzero(usable & np.append(change[1:] | ~usable[1:], True))
    order = np.argsort(numbers[west], kind="stable")
    return row[west][order], west[order], last[order] + 1, numbers[west][order].astype(np.int64)


def corners(arrays: tuple[Any, ...]) -> tuple[Floats, Rows, Rows]:
    """Return the four corners of each cell between meridians and parallels, and their starts."""
    tangents, _, meridians, _, count = arrays
    row, west, east, _ = _runs(arrays)
    found = np.empty((count, 4, 3))
    for k, (at, level) in enumerate(((west, 0), (east, 0), (east, 1), (west, 1))):
        t, m = tangents[row, level], meridians[at]
        pole = np.isinf(t)
        found[:, k, :2] = np.where(pole[:, None], 0.0, m)
        height = np.where(pole, 0.0, t) * np.hypot(m[:, 0], m[:, 1])
        found[:, k, 2] = np.where(pole, np.sign(t), height)
    rings = np.arange(count + 1, dtype=np.int64)
    return found.reshape(-1, 3), rings * 4, rings


def boxes(arrays: tuple[Any, ...]) -> NDArray[np.object_]:
    """Return cells between meridians and parallels as shapely polygons in degrees."""
    shapely = require("shapely", extra="geo", what="polygons of cells")
    tangents, _, meridians, _, count = arrays
    row, west, east, number = _runs(arrays)
    lon = np.degrees(np.arctan2(meridians[:, 1], meridians[:, 0]))
    lat = np.degrees(np.arctan(tangents))
    found = np.empty(count, dtype=object)
    for r, a, b, k in zip(row.tolist(), west.tolist(), east.tolist(), number.tolist(), strict=True):
        x = lon[a]
        x = -180.0 if x == 180.0 else x
        # A cell of one turn has the same meridian in the west and in the east.
        y = x + ((lon[b] - x) % 360 or 360.0)
        south, north = lat[r]
        if y <= 180:
            found[k] = shapely.box(x, south, y, north)
        else:
            sides = shapely.box(x, south, 180, north), shapely.box(-180, south, y - 360, north)
            found[k] = shapely.multipolygons(list(sides))
    return found


def shapes(arrays: tuple[Any, ...], areas: Floats, step: float) -> NDArray[np.object_]:
    """Return cells with arcs of great circles as shapely polygons in degrees."""
    shapely = require("shapely", extra="geo", what="polygons of cells")
    vectors, starts, cells, holes = arrays
    count = len(starts) - 1
    alone = np.arange(count + 1, dtype=np.int64)
    known = _core.CellGrid.polygons(vectors, starts, alone, np.zeros(count, dtype=np.bool_))
    checked = known.check(False, as_workers(None))
    units = units_of(vectors, None)
    found = np.full(len(cells) - 1, shapely.Polygon(), dtype=object)
    for k in np.flatnonzero(areas > 0).tolist():
        parts: list[list[Floats]] = []
        for r in range(int(cells[k]), int(cells[k + 1])):
            if checked.faults[r] == 1:
                continue
            ring = _distinct(units[starts[r] : starts[r + 1]])
            # Outer rings and holes both have the cell on their left.
            ring = ring[::-1] if bool(checked.turned[r]) != bool(holes[r]) else ring
            if holes[r] and parts:
                parts[-1].append(ring)
            else:
                parts.append([ring])
        made = [flat_polygon(part, step) for part in parts]
        found[k] = made[0] if len(made) == 1 else shapely.union_all(made)
    return found


def _distinct(ring: Floats) -> Floats:
    """Return a ring without corners that repeat the previous one."""
    kept = (ring != np.roll(ring, 1, axis=0)).any(axis=1)
    found: Floats = ring[kept]
    return found
