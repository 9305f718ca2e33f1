"""
Voronoi cells of stations on the globe
======================================

The part of the Earth that is nearest to each station, and its area. There are no gaps at the date line or the poles.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import datasets, sphere

# %%
# Stations are denser on land: of 3000 random positions, few of those at sea are kept.

random = np.random.default_rng(4)
places = sphere.Delaunay(xyz=random.normal(size=(3000, 3))).lonlat
coast = sphere.from_geometry(datasets.land())
on_land = coast.polygon_of_simplex[coast.find_simplex(places)] >= 0
stations = places[on_land | (random.uniform(size=3000) < 0.1)]

# %%
# With a radius in kilometers, areas are in square kilometers. They sum to the area of the globe.

diagram = sphere.Voronoi(lonlat=stations, radius=6371)
print(f"{len(stations)} stations, {diagram.cell_areas.sum() / 1e6:.1f} million square kilometers")
assert np.isclose(diagram.cell_areas.sum(), 4 * np.pi * 6371**2)

# %%
# Two views: the Atlantic, and the North Pole.

figure, axes = plt.subplots(1, 2, figsize=(9, 4.4), layout="constrained")
for ax, view in zip(axes, ((-30, 20), (0, 90)), strict=True):
    diagram.plot(
        ax,
        values=np.log10(diagram.cell_areas),
        view=view,
        coast=datasets.land(),
        points=False,
        colorbar=False,
    )
figure.colorbar(axes[0].images[0], ax=axes, label="log10 of square kilometers", shrink=0.8)
plt.show()
