"""GeoDataFrames: triangles, edges and Voronoi cells as shapely geometries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.blocks import blocks
from delone._base.extras import require
from delone.errors import InputError
from delone.exchange.parts import parts_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from delone.exchange.parts import Given

__all__ = ["beside", "by_region", "columns_beside", "shapely_or_say", "to_geopandas"]


def to_geopandas(mesh: Given, crs: Any = None, data: Any = None) -> Any:
    """Return a GeoDataFrame of triangles or edges; `crs` is by default that of the mesh.

    A row contains the vertices ``v0``, ``v1`` (and ``v2``), the values, and a polygon or a line.
    """
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
    columns |= dict(parts.of_simplices)
    own = parts.crs if crs is None else crs
    of = "triangles" if rows.shape[1] == 3 else "edges"
    return beside(shapes, data, own, columns=columns, of=of)


def shapely_or_say() -> Any:
    """Import shapely, or say how to install it."""
    return require("shapely", extra="geo", what="polygons of Voronoi cells")


def by_region(polygons: NDArray[Any], regions: NDArray[np.int32]) -> NDArray[Any]:
    """Return the polygon of each region number, (n,); an empty one for -1."""
    found: NDArray[Any] = np.append(polygons, shapely_or_say().Polygon())[regions]
    return found


def beside(
    shapes: NDArray[Any],
    data: Any = None,
    crs: Any = None,
    *,
    columns: Mapping[str, Any] | None = None,
    of: str = "points",
) -> Any:
    """Return a GeoDataFrame of geometries with `columns` and those of `data`.

    The index and, without `crs`, the reference system are those of `data`. `of` is the name of a
    row in errors.
    """
    geopandas = require("geopandas", extra="geo", what="a table of geometries")
    own = dict(columns or {})
    if _is_nothing(data):
        return geopandas.GeoDataFrame(own, geometry=shapes, crs=crs)
    if hasattr(data, "geometry") and hasattr(data, "crs"):
        crs = data.crs if crs is None else crs
        data = data.drop(columns=data.geometry.name)
    pandas = require("pandas", extra="geo", what="a table of geometries")
    frame = _checked(_framed(pandas, data), len(shapes), {*own, "geometry"}, of)
    geometry = geopandas.GeoSeries(shapes, index=frame.index, crs=crs)
    whole = pandas.concat([pandas.DataFrame(own, index=frame.index), frame], axis=1)
    return geopandas.GeoDataFrame(whole, geometry=geometry)


def columns_beside(
    own: Mapping[str, Any], data: Any = None, *, of: str, repeats: Sequence[int] | None = None
) -> Any:
    """Return a DataFrame of columns with those of `data`, without its index and geometry.

    `repeats` is the number of rows of the table for each row of `data`, by default one.
    """
    pandas = require("pandas", extra="geo", what="a table")
    table = pandas.DataFrame(dict(own))
    if _is_nothing(data):
        return table
    if hasattr(data, "geometry") and hasattr(data, "crs"):
        data = data.drop(columns=data.geometry.name)
    count = len(table) if repeats is None else len(repeats)
    frame = _checked(_framed(pandas, data), count, set(own), of)
    rows = np.repeat(np.arange(count), 1 if repeats is None else repeats)
    return pandas.concat([table, frame.iloc[rows].reset_index(drop=True)], axis=1)


def _is_nothing(data: Any) -> bool:
    """Return whether there are no columns: None, or a mapping without any."""
    return data is None or (isinstance(data, Mapping) and not data)


def _framed(pandas: Any, data: Any) -> Any:
    """Return a DataFrame of a table or columns."""
    try:
        return pandas.DataFrame(data)
    except ValueError as error:
        raise InputError(f"data is not a table or a mapping of columns: {error}") from error


def _checked(frame: Any, count: int, taken: set[str], of: str) -> Any:
    """Reject a table with a different number of rows, or with column names that are in use."""
    if len(frame) != count:
        raise InputError(f"data has {len(frame)} rows for {count} {of}")
    if found := [name for name in frame.columns if name in taken]:
        raise InputError(f"data has a column {found[0]!r:.60}, as the table itself: rename it")
    return frame
