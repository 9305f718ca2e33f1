"""More points than fit in memory: a lidar tile split into smaller ones, validated, and rasterized.

The same lines work for a thousand files, and with a Dask client as ``executor``. It needs the extra
``dask``, and ``raster`` for the GeoTIFF. Run it: ``python examples/tiles.py``.
"""

import tempfile
from pathlib import Path

import numpy as np

from delone import Delaunay, distributed
from delone.datasets import ahn3
from delone.testing import same_triangles


def main() -> None:
    """Triangulate in tiles, compare with memory, prove, and interpolate."""
    survey = ahn3()
    points = np.column_stack([survey.points, survey.z])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tin = distributed.triangulate(points, folder / "ahn3.tin", tile_points=5000)
        report = tin.manifest
        print(f"{tin}: {report['rounds']} rounds, {report['given']:,} points exchanged")

        assert same_triangles(tin.simplices(), Delaunay(survey.points).simplices)
        assert tin.validate()
        print("the same triangles as in memory; proved tile by tile")

        dem = tin.to_raster(0.5, folder / "dem.tif")
        print(f"{dem.name}: {dem.stat().st_size:,} bytes, heights without seams")


if __name__ == "__main__":
    main()
