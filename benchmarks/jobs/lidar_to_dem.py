"""A LAZ file to a GeoTIFF of heights: reading, triangulating, interpolating in rows, writing.

python benchmarks/jobs/lidar_to_dem.py FILE.laz --resolution 1
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from sidebyside import compare, stage

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np


def delone(given: argparse.Namespace, folder: Path) -> str:
    with stage("import"):
        from delone.io import write_raster
        from delone.terrain import TIN
    with stage("read and triangulate"):
        tin = TIN.from_file(given.file, duplicates="mean", planar=True)
    with stage("interpolate"):
        grid = tin.raster(resolution=given.resolution)
    with stage("write"):
        write_raster(folder / "dem.tif", grid)
    return _said(grid.values)


def startinpy(given: argparse.Namespace, folder: Path) -> str:
    with stage("import"):
        import rasterio  # noqa: F401
        import startinpy
    xyz = _read(given.file)
    with stage("triangulate"):
        triangulation = startinpy.DT()
        triangulation.duplicates_handling = "First"
        triangulation.insert(xyz, insertionstrategy="BBox")
    with stage("interpolate"):
        places, shape, corner = _cells(xyz, given.resolution)
        found = triangulation.interpolate({"method": "TIN"}, places).reshape(shape)
    _write(found, corner, given.resolution, folder)
    return _said(found)


def scipy(given: argparse.Namespace, folder: Path) -> str:
    with stage("import"):
        import rasterio  # noqa: F401
        from scipy.interpolate import LinearNDInterpolator
    xyz = _read(given.file)
    with stage("triangulate"):
        surface = LinearNDInterpolator(xyz[:, :2] - xyz[0, :2], xyz[:, 2])
    with stage("interpolate"):
        places, shape, corner = _cells(xyz, given.resolution)
        found = surface(places - xyz[0, :2]).reshape(shape)
    _write(found, corner, given.resolution, folder)
    return _said(found)


def _read(file: str) -> np.ndarray:
    with stage("read"):
        import laspy

        return laspy.read(file).xyz


def _cells(xyz: np.ndarray, size: float) -> tuple[np.ndarray, tuple[int, int], np.ndarray]:
    """The centers of the cells as delone chooses them, their rows and columns, the top left."""
    import numpy as np

    low, high = xyz[:, :2].min(axis=0), xyz[:, :2].max(axis=0)
    columns, rows = np.ceil((high - low) / size).astype(int)
    x = low[0] + size * (np.arange(columns) + 0.5)
    y = high[1] - size * (np.arange(rows) + 0.5)
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return places, (rows, columns), np.array((low[0], high[1]))


def _write(found: np.ndarray, corner: np.ndarray, size: float, folder: Path) -> None:
    with stage("write"):
        import rasterio
        from rasterio.transform import from_origin

        with rasterio.open(
            folder / "dem.tif",
            "w",
            driver="GTiff",
            height=found.shape[0],
            width=found.shape[1],
            count=1,
            dtype="float32",
            nodata=float("nan"),
            compress="deflate",
            transform=from_origin(*corner, size, size),
        ) as file:
            file.write(found.astype("float32"), 1)


def _said(values: np.ndarray) -> str:
    import numpy as np

    return f"{np.isfinite(values).sum():,} cells, mean {np.nanmean(values):.4f}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("file", help="a LAZ file, such as examples/data/ahn3_crop_100m.laz")
    parser.add_argument("--resolution", type=float, default=0.25)
    compare(__doc__, {"delone": delone, "startinpy": startinpy, "SciPy": scipy}, parser)
