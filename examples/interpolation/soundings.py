"""
Depths between ship soundings
=============================

Ships measure depths along their tracks: soundings are dense along a track, with wide gaps between tracks. Natural
neighbor interpolation is smooth between the soundings and exact at each of them, and it needs no parameter.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import baja
from delone.interpolate import NaturalNeighbor

survey = baja()
near = (np.abs(survey.points - (247.0, 24.0)) < 1.0).all(axis=1)
points, depth = survey.points[near], survey.z[near]
print(f"{len(points):,} soundings between {depth.min():.0f} m and {depth.max():.0f} m")

# %%
# The same position may have been measured more than once. ``duplicates="mean"`` takes the mean of such soundings.
# Degrees of longitude are shorter than degrees of latitude, so the positions are scaled to kilometers first.

kilometers = (points - (246.0, 23.0)) * 111.2 * (np.cos(np.radians(24.0)), 1)
depth_at = NaturalNeighbor(kilometers, depth, duplicates="mean")
x, y = np.meshgrid(np.linspace(0, 200, 401), np.linspace(0, 220, 441))
raster = depth_at(np.stack((x, y), axis=-1))
inside = np.isfinite(raster)
assert raster[inside].min() >= depth.min() - 1e-6
assert raster[inside].max() <= depth.max() + 1e-6

# %%
# The surface and the tracks.

figure, ax = plt.subplots(figsize=(6.6, 6), layout="constrained")
image = ax.pcolormesh(x, y, raster, cmap="viridis", rasterized=True)
ax.plot(*kilometers.T, ",", color="white", alpha=0.5)
figure.colorbar(image, label="depth in m")
ax.set(title="Sea floor off Baja California", xlabel="km", ylabel="km", aspect="equal")
plt.show()
