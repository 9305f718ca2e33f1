"""
Heights between lidar points
============================

A raster with a resolution of half a meter covers a lidar tile. Each node gets the height of the triangle at its
position.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Delaunay
from delone.datasets import ahn3
from delone.interpolate import Linear

survey = ahn3()
mesh = Delaunay(survey.points)
print(mesh)

# %%
# :class:`~delone.interpolate.Linear` takes a triangulation and one value for each point. Outside the hull, it returns
# NaN.

low, high = mesh.min_bound, mesh.max_bound
x, y = np.meshgrid(np.arange(low[0], high[0], 0.5), np.arange(low[1], high[1], 0.5))
heights = Linear(mesh, survey.z)(np.stack((x, y), axis=-1))

inside = np.isfinite(heights)
print(f"{heights.size:,} nodes, {np.count_nonzero(inside):,} inside the hull")
print(f"mean height {heights[inside].mean():.2f} m, highest {heights[inside].max():.2f} m")
assert survey.z.min() - 1e-6 <= heights[inside].min()
assert heights[inside].max() <= survey.z.max() + 1e-6

# %%
# The raster as an image.

figure, ax = plt.subplots(figsize=(6.4, 5.4), layout="constrained")
image = ax.imshow(heights, origin="lower", extent=(0, high[0] - low[0], 0, high[1] - low[1]))
figure.colorbar(image, label="height in m")
ax.set(title="Heights of a lidar tile", xlabel="east in m", ylabel="north in m")
plt.show()
