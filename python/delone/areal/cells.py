"""Cells in the plane: polygons, triangles and Voronoi cells as arrays for the core."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_plain_array
from delone._base.counting import agreed, counted
from delone._base.georeference import as_crs, common_crs, is_geographic, transformed
from delone.areal.nested import badly_nested, nesting_problem
from delone.constrained.geodata import EXTERIOR, INTERIOR, parts_of, require_finite_parts
from delone.errors import CrossingSegmentsError, DtypeError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows

__all__ = ["Cells", "as_cells"]

# Squares of larger coordinates leave the range of doubles, as do those of smaller extents.
_LARGEST, _SMALLEST = 2.0**500, 2.0**-500
# What the core reports for a cell without area, and for one whose sides cross.
_EMPTY, _CROSSING = 1, 4


class Cells(NamedTuple):
    """Cells of the core, their areas, and what was found in them."""

    made: _core.PlaneCells
    areas: Floats
    empty: Rows
    turned: Rows
    crs: str | None


def as_cells(given: Any, *, name: str, crs: str | None, to: str, workers: int) -> Cells:
    """Return the cells of geometries, a triangulation or a Voronoi diagram.

    `crs` is the reference system of other data, `to`, into which these are transformed.
    """
    if hasattr(given, "lonlat"):
        raise InputError(f"{name} is on the sphere: use delone.sphere.Overlaps")
    if not isinstance(given, np.ndarray) and getattr(given, "ndim", 2) == 3:
        raise InputError(f"{name} is 3-D; overlaps are those of areas in the plane")
    if getattr(given, "periods", None) is not None:
        raise InputError(f"{name} is periodic: its cells have no single place")
    if hasattr(given, "simplices") and hasattr(given, "points"):
        points, rings, cells, holes = _of_triangles(given.points, given.simplices)
    else:
        points, rings, cells, holes = _of_polygons(given, name)
    own = common_crs(given) if hasattr(given, "crs") else None
    for system in (own, crs):
        if system is not None and is_geographic(system):
            raise InputError(
                f"{name} is in longitudes and latitudes, where areas are not those of a plane: "
                "transform it with geopandas to_crs, or use sphere.Overlaps of sphere.Grid"
            )
    if to:
        points = np.ascontiguousarray(transformed(given, points, crs, name=name, to=to))
    _require_range(points, name)
    arrays = points, rings, cells, holes
    made = _core.PlaneCells(*arrays)
    known = made.check(True, workers)
    wrong = np.flatnonzero(known.faults == _CROSSING)
    if len(wrong):
        first = ", ".join(map(str, wrong[:10].tolist()))
        count = len(wrong)
        raise CrossingSegmentsError(
            f"{name}: {counted(count, 'polygon')} {agreed(count, 'has', 'have')} sides that cross "
            f"or are repeated; first: {first}: repair them, for example with shapely.make_valid "
            'and method="structure"'
        )
    nested = badly_nested(arrays, _core.PlaneCells, workers)
    if len(nested):
        raise InputError(f"{name}: {nesting_problem(nested, 'polygon')}")
    empty = np.flatnonzero(known.faults == _EMPTY)
    return Cells(made, known.areas, empty, np.flatnonzero(known.turned), as_crs(own) or crs)


def _of_triangles(points: Floats, simplices: NDArray[Any]) -> tuple[Floats, Rows, Rows, Bools]:
    """Return the arrays of the core for triangles."""
    count = len(simplices)
    corners = np.ascontiguousarray(np.asarray(points)[simplices.ravel()], dtype=np.float64)
    numbers = np.arange(count + 1, dtype=np.int64)
    return corners, 3 * numbers, numbers, np.zeros(count, dtype=np.bool_)


def _of_polygons(given: Any, name: str) -> tuple[Floats, Rows, Rows, Bools]:
    """Return the arrays of the core for geometries; those of a diagram if it is one."""
    if callable(getattr(given, "polygons", None)):
        given = given.polygons()
        open_cells = [k for k, cell in enumerate(given) if cell is None]
        if open_cells:
            count = len(open_cells)
            raise InputError(
                f"{name}: {counted(count, 'cell')} of the diagram {agreed(count, 'is', 'are')} "
                f"unbounded, first cell {open_cells[0]}: make the diagram with clip="
            )
    if given is None or isinstance(given, str | bytes | int | float):
        raise DtypeError(
            f"{name} must be polygons, a triangulation or a Voronoi diagram, got "
            f"{type(given).__name__}"
        )
    # Each ring of a list is a polygon here; elsewhere, the list is one polygon.
    if isinstance(given, np.ndarray) and given.ndim == 3:
        given = list(given)
    if isinstance(given, list | tuple) and all(
        isinstance(item, np.ndarray | list | tuple) and as_plain_array(item[:1], name).ndim == 2
        for item in given
    ):
        rings = [as_plain_array(item, name) for item in given]
        given = [{"type": "Polygon", "coordinates": [ring]} for ring in rings]
    parts = parts_of(given, name=name)
    require_finite_parts(parts)
    kinds = parts.kinds
    areal = (kinds == EXTERIOR) | (kinds == INTERIOR)
    if not areal.all():
        row = int(parts.geometries[np.flatnonzero(~areal)[0]])
        raise InputError(f"{name}: geometry {row} is not a polygon")
    count = _count(given)
    per_cell = np.bincount(parts.geometries, minlength=count)
    cells = np.concatenate(([0], np.cumsum(per_cell))).astype(np.int64)
    points = np.ascontiguousarray(parts.coordinates, dtype=np.float64)
    return points, parts.starts.astype(np.int64), cells, kinds == INTERIOR


def _count(given: Any) -> int:
    """Return the number of geometries, of which the last ones may have no parts."""
    if hasattr(given, "geometry"):
        return len(given.geometry)
    if isinstance(given, Mapping) and "features" in given:
        return len(given["features"])
    if isinstance(given, Mapping) or not hasattr(given, "__len__"):
        return 1
    # A ring of positions is one geometry.
    return 1 if len(given) and np.ndim(next(iter(given))) == 1 else len(given)


def _require_range(points: Floats, name: str) -> None:
    """Reject coordinates whose areas are beyond the range of doubles."""
    if not len(points):
        return
    # By columns, which takes a fraction of the time.
    low, high = (np.array([find(column) for column in points.T]) for find in (np.min, np.max))
    top = float(np.maximum(-low, high).max())
    extent = float((high / 2 - low / 2).max())
    if top > _LARGEST or (0 < extent < _SMALLEST):
        raise InputError(
            f"{name}: coordinates up to {top:.6g} and an extent of {extent * 2:.6g} have areas "
            "beyond the range of doubles: multiply them by a power of two"
        )
