"""
Plotting a large triangulation
==============================

A triangulation of 212,550 lidar points, plotted in three ways: as a shaded surface, as the density of its points, and
as a detail with individual triangles.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Delaunay, datasets

# %%
# Triangles smaller than a few pixels are drawn as an image: otherwise, the edges alone would blacken the plot.
# ``shade=True`` adds hill shading.

survey = datasets.ahn3()
mesh = Delaunay(survey.points)
figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.4), layout="constrained")
mesh.plot(left, z=survey.z, hull=False, shade=True, title="Height in m")

# %%
# Without ``z``, a large plot shows the density of the points: gaps are water and roofs that absorb the laser light.

mesh.plot(middle, title="Density of the points")

# %%
# For a detail, triangulate the points in a window slightly larger than the plot, so that its border is not visible.

low = survey.points.min(axis=0) + np.array((62, 30))
window = ((survey.points > low - 1) & (survey.points < low + 7)).all(axis=1)
detail = Delaunay(survey.points[window])
detail.plot(right, z=survey.z[window], colorbar=False, title="A detail of 6 m")
right.set(xlim=(low[0], low[0] + 6), ylim=(low[1], low[1] + 6))
plt.show()

# %%
# A common mistake is to pass all triangles to ``triplot``: it draws 600,000 edges, takes seconds, and shows a black
# square. Another is to pass ``z`` with the wrong length; the error says how many values are needed:

try:
    mesh.plot(z=survey.z[:1000])
except ValueError as error:
    print(error)
