"""
A lidar survey in tiles
=======================

A lidar tile is split into smaller tiles, triangulated into a folder, validated, rasterized, and contoured. The same
code works for a thousand files, and with a Dask client as ``executor``. The union of the tiles is exactly the
triangulation of all points.

Install: ``pip install "delone[dask,raster,plot]"``.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import rasterio

from delone import Delaunay, distributed
from delone.datasets import ahn3
from delone.testing import same_triangles

survey = ahn3()
points = np.column_stack((survey.points, survey.z))

folder = tempfile.TemporaryDirectory()
tin = distributed.triangulate(points, Path(folder.name, "ahn3.tin"), tile_points=20_000)
print(tin)
print(f"{tin.manifest['rounds']} rounds, {tin.manifest['given']:,} points exchanged between tiles")

# %%
# The triangles are the same as those computed in memory, and each tile is proven correct.

assert same_triangles(tin.read_simplices(), Delaunay(survey.points).simplices)
assert tin.validate()

# %%
# A digital elevation model as a GeoTIFF. There are no seams between the tiles.

with rasterio.open(tin.to_raster(0.5, Path(folder.name, "dem.tif"))) as dem:
    heights = dem.read(1, masked=True)

# %%
# The contours are the same lines as those of one surface in memory: no line ends at the border of a tile.

contours = tin.contours(interval=1, min_length=15, simplify=0.2)
print(contours)
print(tin.volume_to(float(np.median(survey.z))))
folder.cleanup()

figure, ax = plt.subplots(figsize=(6.4, 5.4), layout="constrained")
left, bottom, right, top = tin.bounds
image = ax.imshow(heights, extent=(left, right, bottom, top))
contours.plot(ax, color="white", labels=contours.labels(index=True))
figure.colorbar(image, label="height in m")
ax.ticklabel_format(useOffset=False)
ax.set(title="Elevation model and contours from tiles", xlabel="east in m", ylabel="north in m")
plt.show()
