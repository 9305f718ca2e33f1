"""Diagrams as tables of geopandas."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["chosen", "shapely_or_say", "table"]


def shapely_or_say() -> Any:
    """Import shapely, or say how to install it."""
    from delone.extras import require

    return require("shapely", extra="geo", what="polygons of Voronoi cells")


def chosen(polygons: NDArray[Any], regions: NDArray[np.int32]) -> NDArray[Any]:
    """Return the geometry of each region number, an empty polygon for -1.

    Parameters
    ----------
    polygons : ndarray of object, shape (c,)
        Geometries.
    regions : ndarray of int32, shape (n,)
        Their numbers, or -1.

    Returns
    -------
    ndarray of object, shape (n,)
        Geometries.
    """
    shapely = shapely_or_say()

    found: NDArray[Any] = np.append(polygons, shapely.Polygon())[regions]
    return found


def table(polygons: NDArray[Any], data: Any, crs: Any) -> Any:
    """Return cells beside the columns of their sites.

    Parameters
    ----------
    polygons : ndarray of object, shape (n,)
        Geometries.
    data : DataFrame, mapping or None
        Columns to carry.
    crs : any
        Reference system; by default that of `data`.

    Returns
    -------
    GeoDataFrame
        A row for each polygon.

    Raises
    ------
    InputError
        `data` has another number of rows.
    """
    from delone.extras import require

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
