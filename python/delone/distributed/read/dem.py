"""Rasters from tiled triangulations: linear interpolation into a file, tile by tile.

Each node gets its value from the triangle of the whole set that contains it, whichever tile
contains that triangle, so there are no seams. Values are stored in a temporary file next to the
target, so that the memory needed is that of one tile.
"""

from __future__ import annotations

import errno
import shutil
from tempfile import TemporaryFile
from typing import IO, TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_choice
from delone._base.atomic import replacing
from delone._base.counting import gigabytes, grouped
from delone._base.extras import require
from delone.distributed.arguments import as_path
from delone.errors import FileFormatError
from delone.interpolate.raster import raster_nodes
from delone.io.geotiff import write_geotiff
from delone.terrain import slopes

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from numpy.typing import NDArray

    from delone import _core
    from delone._base.types import Floats
    from delone.distributed.read.folder import TileFolder
    from delone.distributed.read.tile import Tile

__all__ = ["Shown", "write_dem"]

# What a raster may contain.
WHAT = ("value", "slope", "aspect", "hillshade")
# Nodes per block.
_BLOCK = 1 << 18


class Shown(NamedTuple):
    """What a raster contains: values, or a measure of triangles and the light for it."""

    what: str
    azimuth: float
    altitude: float
    z_factor: float


def write_dem(  # noqa: PLR0917
    tin: TileFolder,
    resolution: float | tuple[float, float],
    out: str | os.PathLike[str],
    value: str,
    crs: str | None,
    shown: Shown,
) -> Path:
    """Write a GeoTIFF; see `TiledDelaunay.to_raster`."""
    as_choice(shown.what, WHAT, name="what")
    require("rasterio", extra="raster", what="writing GeoTIFF files")
    tin._require(value)
    target = as_path(out, name="out")
    if target.suffix.lower() not in (".tif", ".tiff"):
        raise FileFormatError(f"{target}: rasters of tiles can only be written as .tif")
    left, bottom, right, top = tin.bounds
    x, y = raster_nodes(
        ([left, bottom], [right, top]),
        resolution=resolution,
        room=lambda columns, rows: _require_room(target, columns, rows),
    )
    sides = np.broadcast_to(np.asarray(resolution, dtype=np.float64), (2,)).tolist()
    # The system removes a file without a name when its process is killed.
    with replacing(target) as beside, TemporaryFile(dir=beside.parent) as waiting:
        values = _empty_values(waiting, len(x), len(y))
        for number, known in enumerate(tin.manifest["tiles"]):
            if known["extent"] is not None:
                tile = tin.tile(number)
                _fill(tin._locator(tile), tile, known["extent"], x, y, values, (value, shown))
        name = value if shown.what == "value" else shown.what
        corner = (float(x[0]) - sides[0] / 2, float(y[-1]) + sides[1] / 2)
        cell = sides[0], sides[1]
        write_geotiff(beside, values, corner=corner, cell=cell, name=name, crs=crs)
        del values
    return target


def _require_room(target: Path, columns: int, rows: int) -> None:
    """Reject a raster whose temporary values do not fit on the disk."""
    needed, free = 8 * columns * rows, shutil.disk_usage(target.absolute().parent).free
    if needed > free:
        raise OSError(
            errno.ENOSPC,
            f"a raster of {grouped(columns)} x {grouped(rows)} cells needs {gigabytes(needed)} "
            f"on disk while it is computed, but {gigabytes(free)} is free; choose larger cells",
            str(target),
        )


def _empty_values(file: IO[bytes], columns: int, rows: int) -> NDArray[np.float64]:
    """Fill a file with NaN and map it into memory.

    The file is written before it is mapped: on a full disk, a mapping kills the process.
    """
    nothing = np.full((max(1, _BLOCK // columns), columns), np.nan)
    for start in range(0, rows, len(nothing)):
        file.write(nothing[: rows - start].data)
    file.flush()
    return np.memmap(file, dtype=np.float64, mode="r+", shape=(rows, columns))


def _fill(  # noqa: PLR0917
    locator: _core.Locator2,
    tile: Tile,
    extent: list[float],
    x: Floats,
    y: Floats,
    values: Any,
    of: tuple[str, Shown],
) -> None:
    """Set the values of nodes that lie in triangles of the tile and have no value yet."""
    columns = slice(*np.searchsorted(x, [extent[0], np.nextafter(extent[2], np.inf)]).tolist())
    first, last = np.searchsorted(y, [extent[1], np.nextafter(extent[3], np.inf)]).tolist()
    width = columns.stop - columns.start
    if width <= 0:
        return
    value, shown = of
    field = np.ascontiguousarray(tile.attributes[value], dtype=np.float64)[:, None].copy()
    of_triangles = None if shown.what == "value" else _measure(tile, field[:, 0], shown)
    step = max(1, _BLOCK // width)
    for start in range(first, last, step):
        rows = slice(start, min(start + step, last))
        block = values[rows, columns]
        r, c = np.nonzero(np.isnan(block))
        if len(r):
            queries = np.stack([x[columns][c], y[rows][r]], axis=1)
            if of_triangles is None:
                block[r, c] = locator.linear(field, queries, 0, 1).reshape(-1)
            else:
                home = locator.find(queries, 1)
                block[r, c] = np.where(home < 0, np.nan, of_triangles[home])
            values[rows, columns] = block


def _measure(tile: Tile, z: Floats, shown: Shown) -> Floats:
    """Return a measure of the triangles of a tile."""
    gradients = slopes.gradient(tile.points, np.ascontiguousarray(z), tile.simplices)
    light = shown._asdict()
    return slopes.measure(gradients, light.pop("what"), light)
