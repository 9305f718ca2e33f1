"""
Plotting a large triangulation
==============================

A triangulation of 212,550 lidar points in three ways: as a shaded surface, as the density of its points, and a detail
with single triangles.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Delaunay, datasets

# %%
# Triangles smaller than a few pixels are drawn as an image: with single triangles the edges alone would blacken the
# plot. ``shade=True`` adds hill shading.

survey = datasets.ahn3()
mesh = Delaunay(survey.points)
figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.4), layout="constrained")
mesh.plot(left, z=survey.z, hull=False, shade=True, title="Height in m")

# %%
# Without ``z`` a large plot shows how dense the points are: gaps are water and roofs that swallowed the light.

mesh.plot(middle, title="Density of the points")

# %%
# For a detail, triangulate the points in a window that is a little larger than what is shown, so that its border is
# out of sight.

low = survey.points.min(axis=0) + np.array((62, 30))
window = ((survey.points > low - 1) & (survey.points < low + 7)).all(axis=1)
detail = Delaunay(survey.points[window])
detail.plot(right, z=survey.z[window], colorbar=False, title="A detail of 6 m")
right.set(xlim=(low[0], low[0] + 6), ylim=(low[1], low[1] + 6))
plt.show()

# %%
# A common mistake is to pass all triangles to ``triplot``: it draws 600,000 edges, takes seconds, and shows a black
# square. Another one is ``z`` of the wrong length; the error says how many values are needed:

try:
    mesh.plot(z=survey.z[:1000])
except ValueError as error:
    print(error)
