"""GeoTIFF output with rasterio (extra ``raster``), verified by reading it back.

When GDAL closes a file, it does not report whether the last blocks were written: on a full disk, a
truncated file looks like a success. Each file is therefore read back before it replaces an existing
one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.io.systems import plain_system

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["write_geotiff"]

# Blocks of a tiled GeoTIFF are 256 rows high.
_ROWS = 256


def write_geotiff(
    path: Path,
    values: NDArray[np.float64],
    *,
    corner: tuple[float, float],
    cell: tuple[float, float],
    name: str,
    crs: str | None,
    units: str | None = None,
) -> None:
    """Write doubles, (rows, columns), lowest row first, and compare them with the file's contents.

    `corner` is the left and the upper edge; NaN marks cells without a value. A memory map is read
    in parts.
    """
    rasterio = require("rasterio", extra="raster", what="writing GeoTIFF files")
    profile = {
        "driver": "GTiff",
        "height": values.shape[0],
        "width": values.shape[1],
        "count": 1,
        "dtype": "float64",
        "nodata": np.nan,
        "crs": plain_system(crs, path.suffix),
        "transform": rasterio.Affine(cell[0], 0.0, corner[0], 0.0, -cell[1], corner[1]),
        "compress": "deflate",
        "predictor": 3,
        "tiled": True,
        "BIGTIFF": "IF_SAFER",
    }
    with rasterio.open(path, "w", **profile) as file:
        for window, part in _parts(values):
            file.write(part, 1, window=window)
        file.set_band_description(1, name)
        if units is not None:
            file.set_band_unit(1, units)
    with rasterio.open(path) as file:
        for window, part in _parts(values):
            if not np.array_equal(file.read(1, window=window), part, equal_nan=True):
                raise OSError("some of the values are missing from the file")


def _parts(values: NDArray[np.float64]) -> Iterator[tuple[Any, NDArray[np.float64]]]:
    """Yield the window and the values of each block of rows, from the top."""
    height, width = values.shape
    for row in range(0, height, _ROWS):
        stop = min(row + _ROWS, height)
        yield ((row, stop), (0, width)), values[height - stop : height - row][::-1]
