"""
Contour lines over a shaded surface
===================================

Contour lines of lidar points, drawn by matplotlib on delone's triangles, over a shaded raster of the same surface.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource

import delone
from delone.datasets import ahn3
from delone.interpolate import grid

# %%
# One point in eight of those that are ground: contour lines of roofs and trees are of no use. The origin is moved to
# the corner of the tile, so that the axes have short numbers.

survey = ahn3()
ground = np.flatnonzero(survey.attributes["classification"] == 2)[::8]
points, z = survey.points[ground] - survey.points.min(axis=0), survey.z[ground]
mesh = delone.Delaunay(points)
print(mesh, f"heights from {z.min():.2f} to {z.max():.2f} m")

# %%
# Heights of lidar points scatter by a few centimeters. On flat ground contour lines follow that scatter, a usual
# mistake. So each height becomes the mean of the point and its neighbors in the triangulation, a few times.

indptr, indices = mesh.vertex_neighbor_vertices
count = np.diff(indptr)
smooth = z.copy()
for _ in range(8):
    smooth = (smooth + np.add.reduceat(smooth[indices], indptr[:-1])) / (1 + count)
print(f"mean change {np.abs(smooth - z).mean():.3f} m")

# %%
# Under the lines is a raster of the same heights, shaded ten times too high. ``max_distance`` leaves gaps where
# buildings stand. Triangles span them too, so those with long edges are masked.

surface = grid(mesh, smooth, resolution=0.5, max_distance=3)
extent = (surface.x[0], surface.x[-1], surface.y[0], surface.y[-1])
shaded = LightSource(azdeg=315, altdeg=45).hillshade(surface.values, vert_exag=10, dx=0.5, dy=0.5)

triangles = mesh.to_matplotlib()
corners = points[mesh.simplices]
longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
triangles.set_mask(longest > 6)

levels = np.arange(0, 3.5, 0.25)
figure, axes = plt.subplots(1, 2, figsize=(11, 5.4), layout="constrained", sharey=True)
for ax, heights, title in zip(axes, (z, smooth), ("As measured", "Smoothed"), strict=True):
    ax.imshow(shaded, origin="lower", extent=extent, cmap="gray")
    lines = ax.tricontour(triangles, heights, levels=levels, colors="firebrick", linewidths=0.8)
    ax.set(title=title, xlabel="m", aspect="equal")
axes[1].clabel(lines, levels[levels % 0.5 == 0], fontsize=8, fmt="%.1f m")
plt.show()
