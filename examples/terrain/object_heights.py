"""
Heights of buildings above the ground
=====================================

The difference of two elevation models of one lidar tile: with all points, and with the ground points only.

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
# Walls have points at different heights in nearly the same place. Where points coincide, the highest one counts for
# the surface of all points, and the lowest one for the ground. ``max_edge`` with ``voids=True`` leaves the canal, which has
# no returns, without heights.

top = TIN.from_points(points, duplicates="max", max_edge=6, voids=True)
bare = TIN.from_points(points[ground], duplicates="min")
model = top.raster(resolution=0.5)
print(top)
print(bare)

# %%
# A raster minus a surface: the surface is evaluated at the centers of the cells, so its raster is not needed.
# ``missing`` counts the cells of the canal.

heights = difference(model, bare, units="m")
print(heights)
print(f"{heights.missing} of {heights.values.size} cells without a height")

# %%
# Cells more than 2 m above the ground are buildings here, since this tile has no points of trees. ``fill`` and ``cut``
# are sums over cells: what the raster has above and below the other surface.

built = heights.values > 2
cell = 0.5**2
print(f"built-up area {built.sum() * cell:.0f} square meters, median height", end=" ")
print(f"{np.median(heights.values[built]):.1f} m, volume {heights.cut:.0f} cubic meters")

# %%
# A common mistake is to subtract rasters whose cells are not the same: by row and column, the numbers are of different
# places. The error says what to do.

try:
    difference(model, bare.raster(resolution=1.0))
except delone.InputError as error:
    print(error)

# %%
# The differences on the map, white at 0.

figure, axes = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
extent = (0, 100, 0, 100)
shade = top.raster("hillshade", resolution=0.5).values
axes[0].imshow(shade, origin="lower", extent=extent, cmap="gray", vmin=0, vmax=1)
axes[0].set(title="All points", xlabel="m", ylabel="m")
heights.plot(axes[1], limit=15, title="Height above the ground")
plt.show()
