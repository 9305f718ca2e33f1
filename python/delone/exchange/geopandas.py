"""GeoDataFrames: triangles, edges and Voronoi cells as shapely geometries."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.blocks import blocks
from delone.errors import InputError
from delone.exchange.parts import parts_of
from delone.extras import require

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.exchange.parts import Given

__all__ = ["by_region", "cells_to_geopandas", "shapely_or_say", "to_geopandas"]


def to_geopandas(mesh: Given, crs: Any = None) -> Any:
    """Return a GeoDataFrame of triangles or edges; `crs` is by default that of the mesh.

    A row has the vertices ``v0``, ``v1`` (and ``v2``), the values, and a polygon or a line.
    """
    geopandas = require("geopandas", extra="geo", what="a table of geometries")
    shapely = require("shapely", extra="geo", what="a table of geometries")
    parts = parts_of(mesh)
    rows = parts.simplices
    if rows.shape[1] not in (2, 3):
        raise InputError("a table of geometries cannot be made of tetrahedra, only of triangles")
    columns: dict[str, Any] = {f"v{k}": rows[:, k] for k in range(rows.shape[1])}
    make = shapely.polygons if rows.shape[1] == 3 else shapely.linestrings
    shapes = np.empty(len(rows), dtype=object)
    for block in blocks(len(rows)):
        shapes[block] = make(parts.points[rows[block]])
    return geopandas.GeoDataFrame(
        columns | dict(parts.of_simplices),
        geometry=shapes,
        crs=parts.crs if crs is None else crs,
    )


def shapely_or_say() -> Any:
    """Import shapely, or say how to install it."""
    return require("shapely", extra="geo", what="polygons of Voronoi cells")


def by_region(polygons: NDArray[Any], regions: NDArray[np.int32]) -> NDArray[Any]:
    """Return the polygon of each region number, (n,); an empty one for -1."""
    found: NDArray[Any] = np.append(polygons, shapely_or_say().Polygon())[regions]
    return found


def cells_to_geopandas(polygons: NDArray[Any], data: Any = None, crs: Any = None) -> Any:
    """Return a GeoDataFrame of cells beside the columns of their sites, in their `crs` if any."""
    geopandas = require("geopandas", extra="geo", what="a table of cells")
    if data is None:
        return geopandas.GeoDataFrame(geometry=polygons, crs=crs)
    if hasattr(data, "geometry") and hasattr(data, "crs"):
        crs = data.crs if crs is None else crs
        data = data.drop(columns=data.geometry.name)
    frame = (
        data
        if hasattr(data, "index")
        else require("pandas", extra="geo", what="a table of cells").DataFrame(data)
    )
    if len(frame) != len(polygons):
        raise InputError(f"data has {len(frame)} rows for {len(polygons)} points")
    geometry = geopandas.GeoSeries(polygons, index=frame.index, crs=crs)
    return geopandas.GeoDataFrame(frame.copy(), geometry=geometry)
