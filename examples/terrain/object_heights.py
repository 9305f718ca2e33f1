"""
Heights of buildings above the ground
=====================================

The difference between two surfaces of one lidar tile: one of all points, and one of the ground points only.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

import delone
from delone.datasets import ahn3
from delone.terrain import TIN, difference

survey = ahn3()
points = np.column_stack((survey.points - survey.points.min(axis=0), survey.z))
ground = survey.attributes["classification"] == 2

# %%
# Walls have points at different heights in nearly the same place. Where points coincide, the surface of all points has
# the highest one, and the ground has the lowest one. ``max_edge`` with ``voids=True`` leaves the canal, which has no
# returns, without heights.

top = TIN.from_points(points, duplicates="max", max_edge=6, voids=True)
bare = TIN.from_points(points[ground], duplicates="min")
model = top.raster(resolution=0.5)
print(top)
print(bare)

# %%
# Subtract a surface from a raster: the surface is evaluated at the centers of cells, so it need not be a raster.
# ``missing`` counts the cells of the canal.

heights = difference(model, bare, units="m")
print(heights)
print(f"{heights.missing} of {heights.values.size} cells without a height")

# %%
# Cells more than 2 m above the ground are buildings here, since this tile has no points of trees. ``cut`` and ``fill``
# are sums over cells: the volumes of the raster above and below the other surface.

built = heights.values > 2
cell = 0.5**2
print(f"built-up area {built.sum() * cell:.0f} square meters, median height", end=" ")
print(f"{np.median(heights.values[built]):.1f} m, volume {heights.cut:.0f} cubic meters")

# %%
# A common mistake is to subtract rasters with different cells: numbers in the same row and column then belong to
# different places. The error says what to do.

try:
    difference(model, bare.raster(resolution=1.0))
except delone.InputError as error:
    print(error)

# %%
# On the map of differences, 0 is white.

figure, axes = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
extent = (0, 100, 0, 100)
shade = top.raster("hillshade", resolution=0.5).values
axes[0].imshow(shade, origin="lower", extent=extent, cmap="gray", vmin=0, vmax=1)
axes[0].set(title="All points", xlabel="m", ylabel="m")
heights.plot(axes[1], limit=15, title="Height above the ground")
plt.show()
