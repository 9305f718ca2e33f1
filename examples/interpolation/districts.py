"""
Transfer inhabitants from districts to hexagons
===============================================

Populations are known for districts but needed on a regular grid. The inhabitants of each district are divided among
the hexagons in proportion to the shared areas, and nobody is lost.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

from delone import Overlaps, Voronoi

# %%
# Districts are the cells of a Voronoi diagram, smaller toward the center of a town 10 km across, with about 2,000
# inhabitants each.

rng = np.random.default_rng(4)
sites = 5 + rng.normal(size=(400, 2)) * 1.8
sites = sites[np.all((sites > 0) & (sites < 10), axis=1)]
districts = Voronoi(sites, clip=(0, 0, 10, 10))
people = rng.poisson(2000, len(sites))
density = people / districts.cell_areas

# %%
# Hexagons of 1 km, which extend beyond the town.

side = 1 / np.sqrt(3)
turns = np.radians(np.arange(30, 390, 60))
corners = side * np.column_stack((np.cos(turns), np.sin(turns)))
centers = [(k + 0.5 * (row % 2), row * 1.5 * side) for row in range(13) for k in range(11)]
hexagons = [corners + center for center in centers]

overlaps = Overlaps(districts, hexagons)
print(overlaps, overlaps.report)

# %%
# "sum" transfers amounts: the total is preserved, up to rounding, because the hexagons cover all districts.

arrived = overlaps.transfer({"people": people}, {"people": "sum"})["people"]
print(f"{people.sum()} inhabitants of districts, {np.nansum(arrived):.6f} in hexagons")

fig, axes = plt.subplots(1, 2, figsize=(11, 5), sharex=True, sharey=True, layout="constrained")
areas = overlaps.target_areas
rings = [districts.cell(k).parts[0][0] for k in range(len(sites))]
for ax, cells, values, title in (
    (axes[0], rings, density, "districts"),
    (axes[1], hexagons, arrived / areas, "hexagons"),
):
    drawn = PolyCollection(cells, array=values, cmap="viridis", edgecolors="white", linewidths=0.3)
    drawn.set_clim(0, 40000)
    ax.add_collection(drawn)
    ax.set_aspect("equal")
    ax.set(title=title, xlabel="km")
    ax.autoscale_view()
axes[0].set_ylabel("km")
fig.colorbar(drawn, ax=axes, label="inhabitants per km²", extend="max")
plt.show()
