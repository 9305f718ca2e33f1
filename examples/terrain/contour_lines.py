"""
Contour map over a hillshade
============================

Contour lines of lidar points with index contours and labels, over a hillshade of the same triangles.

Install: ``pip install "delone[plot,geo]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import ahn3
from delone.terrain import TIN

# %%
# Every eighth ground point: contour lines of roofs and trees are not useful. The origin is moved to the corner of the
# tile, so that the axes have short numbers. ``max_edge`` ends the surface at buildings and water, which have no
# points.

survey = ahn3()
ground = np.flatnonzero(survey.attributes["classification"] == 2)[::8]
points = np.column_stack((survey.points - survey.points.min(axis=0), survey.z))[ground]
measured = TIN.from_points(points, max_edge=6)
print(measured)

# %%
# Heights of lidar points scatter by a few centimeters. On flat ground, contour lines follow this scatter; plotting
# them without smoothing is a common mistake. So each height is replaced by the mean of the point and its neighbors in
# the triangulation, a few times.

indptr, indices = measured.vertex_neighbor_vertices
count = np.diff(indptr)
z = measured.z.copy()
for _ in range(8):
    z = (z + np.add.reduceat(z[indices], indptr[:-1])) / (1 + count)
smooth = TIN.from_points(np.column_stack((measured.points, z)), max_edge=6)
print(f"mean change {np.abs(z - measured.z).mean():.3f} m")

# %%
# Contours every 25 cm; every fourth is an index contour. ``smooth=2`` cuts corners, but never lets lines cross.
# Heights in the hillshade are exaggerated ten times, so that streets are visible; it has one value per triangle. On
# the left are the lines of the measured heights.

figure, axes = plt.subplots(1, 2, figsize=(11, 5.4), layout="constrained", sharey=True)
for ax, tin, title in zip(
    axes, (measured, smooth), ("As measured", "Smoothed heights"), strict=True
):
    shade = smooth.hillshade(z_factor=10)
    ax.tripcolor(smooth.to_matplotlib(), shade, cmap="gray", vmin=-0.3, vmax=1)
    contours = tin.contours(interval=0.25, index=4, smooth=2)
    print(title, contours)
    labels = contours.labels(length=8, index=True)
    contours.plot(ax, colors="firebrick", labels=labels)
    ax.set(title=title, xlabel="m", aspect="equal", xlim=(0, 100), ylim=(0, 100))

# %%
# Index contours that are long enough are labeled where they are straightest. For a map in a GIS, use
# ``contours.to_geopandas().to_file(...)``, and ``labels.to_geopandas()`` for the labels with their angles.

print(labels)
print(labels.to_geopandas()[["text", "angle"]].round(0).to_string(index=False))
plt.show()
