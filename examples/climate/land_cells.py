"""
Mean over land from stations: Voronoi cells clipped to the coast
================================================================

Each station represents the land that is closer to it than to any other station. The Voronoi cells of stations on the
globe are clipped to the coast, and their areas are the weights of a mean over land. No projection is needed, and
nothing is cut at the date line.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import datasets, sphere

land = datasets.land()

# %%
# Stations on land, far more of them in Europe and North America than elsewhere.

random = np.random.default_rng(8)
places = sphere.Delaunay(xyz=random.normal(size=(12000, 3))).lonlat
coast = sphere.from_geometry(land)
on_land = coast.polygon_of_simplex[coast.find_simplex(places)] >= 0
east, north = places.T
crowded = (north > 30) & (north < 62) & ((np.abs(east + 95) < 35) | (np.abs(east - 15) < 30))
stations = places[on_land & (crowded | (random.uniform(size=12000) < 0.05))]

# %%
# The cells end at the coast. Their areas add up to the area of the land. Where there are islands, a cell can have
# several parts.

cells = sphere.Voronoi(lonlat=stations, clip=land, radius=6371)
total = cells.cell_areas.sum()
whole = coast.areas[coast.polygon_of_simplex >= 0].sum() * 6371**2
assert np.isclose(total, whole)
parts = np.array([len(polygons) for polygons in cells.polygons()])
print(
    f"{len(stations)} stations, {total / 1e6:.1f} million square km of land; "
    f"{(parts > 1).sum()} cells in several parts, one in {parts.max()}"
)

# %%
# A temperature that depends on latitude. The plain mean is dominated by the dense stations of the middle latitudes.


def temperature(latitude):
    """Return a temperature in degrees C."""
    return 40 * np.cos(np.radians(latitude)) ** 2 - 14


grid = sphere.Delaunay(xyz=random.normal(size=(200_000, 3))).lonlat
truth = temperature(grid[coast.polygon_of_simplex[coast.find_simplex(grid)] >= 0, 1]).mean()
values = temperature(stations[:, 1])
weighted = np.average(values, weights=cells.cell_areas)
print(f"true mean {truth:.1f} C, weighted {weighted:.1f} C, plain {values.mean():.1f} C")
assert abs(weighted - truth) < 0.2 * abs(values.mean() - truth)

# %%
# On a sphere, a ring has a finite area on both sides. By default, a polygon is the smaller of the two, whatever the
# direction of its ring, which is clockwise in shapefiles. ``winding="ccw"`` selects the left side, here all of the
# Earth except the island, with a warning.

island = [(47, -25), (44, -16), (50, -16)]
ring = {"type": "Polygon", "coordinates": [island]}
for winding in ("smaller", "ccw"):
    found = sphere.Voronoi(lonlat=stations, clip=ring, winding=winding, radius=6371)
    print(f"winding={winding!r}: {found.cell_areas.sum() / 1e6:.1f} million square km")

# %%
# Large cells have large weights.

figure, axes = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained")
for ax, view in zip(axes, ((5, 30), (-165, 50)), strict=True):
    cells.plot(
        ax,
        values=np.log10(cells.cell_areas),
        view=view,
        colorbar=False,
        points=False,
        linewidth=0.4,
    )
figure.colorbar(axes[0].images[0], ax=axes, label="log10 of square kilometers", shrink=0.8)
plt.show()
