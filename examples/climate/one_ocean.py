"""
The ocean as one cell
=====================

No hemisphere contains the ocean. The corners of such a cell do not determine on which side of them it is, but their
order does: pass ``winding``. Here the coast of Antarctica is the outer ring, and all other land masses are holes. The
mean of a field over this cell uses the exact part of each grid cell.

Install: ``pip install "delone[geo,plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import shapely

from delone import datasets, sphere

# %%
# The coasts, one ring for each land mass. The ring of Antarctica has corners at the south pole that close it in the plane.
# On the sphere they are not needed.

coasts = [np.array(rings[0]) for rings in datasets.land()["coordinates"]]
coasts = [ring[ring[:, 1] > -90] for ring in coasts]
land = sphere.Grid.from_polygons([shapely.Polygon(ring) for ring in coasts])
south = int(np.argmax([np.ptp(ring[:, 0]) * (ring[:, 1].max() < -60) for ring in coasts]))
antarctica = coasts.pop(south)
print(f"Antarctica with {len(antarctica)} corners, {len(coasts)} other land masses")

# %%
# The coast of Antarctica runs west, so Antarctica is to the left of it. Reversed, it has the ocean to its left, and that is
# the cell with ``winding="ccw"``. Without ``winding``, an error says that the side is not known.

shape = shapely.Polygon(antarctica[::-1], coasts)
ocean = sphere.Grid.from_polygons([shape], winding="ccw")
print(ocean.report)
print(
    f"ocean {ocean.areas[0] / (4 * np.pi):.4f} of the sphere, land {land.areas.sum() / (4 * np.pi):.4f}"
)
assert np.isclose(ocean.areas.sum() + land.areas.sum(), 4 * np.pi, rtol=1e-14)

# %%
# A sea surface temperature on cells of 5 degrees, and its mean over the ocean. Cells whose centers are at sea, a common
# shortcut, give a different mean.

grid = sphere.Grid.from_lonlat(np.arange(-180, 181, 5), np.arange(-90, 91, 5))
lon, lat = np.radians(grid.centers_lonlat.T)
celsius = -2 + 30 * np.cos(lat) ** 2 + 2 * np.sin(2 * lon) * np.cos(lat)
overlaps = sphere.Overlaps(grid, ocean)
mean = overlaps.to_weights("normalized").apply(celsius)[0]
sea = overlaps.covered_source
shortcut = np.average(celsius, weights=grid.areas * (sea > 0.5))
print(f"mean {mean:.3f} °C, by whole cells {shortcut:.3f} °C")
assert np.isclose((sea * grid.areas).sum(), ocean.areas[0], rtol=1e-14)

# %%
# The part of each grid cell that belongs to the one cell, and the coasts.

figure, ax = plt.subplots(figsize=(8, 4.8), layout="constrained")
grid.plot(ax, values=sea, coast=datasets.land(), title="Part of each cell that is ocean")
plt.show()
