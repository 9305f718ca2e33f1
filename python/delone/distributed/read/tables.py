"""Tiles as tables: partitions of a Dask data frame, polygons in GeoParquet."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from delone._base.arrays import as_choice
from delone._base.extras import require
from delone.distributed.arguments import as_path
from delone.distributed.read.folder import TileFolder
from delone.errors import InputError

__all__ = ["dask_frame", "write_geoparquet"]


def dask_frame(tin: TileFolder, table: str) -> Any:
    """Return a Dask data frame; see `TiledDelaunay.to_dask_dataframe`."""
    as_choice(table, ("triangles", "vertices"), name="table")
    frames = require("dask.dataframe", extra="dask", what="a Dask data frame")
    folder = str(tin.path.absolute())
    meta = partition(0, folder, table).iloc[:0]
    return frames.from_map(partition, range(tin.ntiles), folder=folder, table=table, meta=meta)


def partition(number: int, folder: str, table: str) -> Any:
    """Return the part of a table in one tile, as a pandas data frame."""
    pandas = require("pandas", extra="dask", what="a Dask data frame")
    tile = TileFolder._at(folder).tile(number)
    if table == "triangles":
        corners = tile.ids[tile.simplices]
        return pandas.DataFrame({name: corners[:, k] for k, name in enumerate("abc")})
    columns = {"x": tile.points[:, 0], "y": tile.points[:, 1]} | tile.attributes
    frame = pandas.DataFrame({name: values[tile.owned] for name, values in columns.items()})
    return frame.set_index(pandas.Index(tile.ids[tile.owned], name="id"))


def write_geoparquet(tin: TileFolder, folder: str | os.PathLike[str]) -> None:
    """Write triangles as polygons; see `TiledDelaunay.to_geoparquet`."""
    geopandas = require("geopandas", extra="geo", what="writing GeoParquet")
    shapely = require("shapely", extra="geo", what="writing GeoParquet")
    target = as_path(folder, name="folder")
    if target.exists():
        raise InputError(f"{target} already exists: choose another folder")
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    try:
        for tile in tin.tiles():
            corners = tile.points[tile.simplices]
            rings = np.concatenate([corners, corners[:, :1]], axis=1)
            ids = tile.ids[tile.simplices]
            columns = {name: ids[:, k] for k, name in enumerate("abc")}
            frame = geopandas.GeoDataFrame(columns, geometry=shapely.polygons(rings), crs=tin.crs)
            frame.to_parquet(temporary / f"tile={tile.number:06}.parquet")
        temporary.chmod(0o755)
        os.replace(temporary, target)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
