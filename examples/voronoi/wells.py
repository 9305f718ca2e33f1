"""
The area around each well
=========================

The Voronoi cell of a well is the land that is closer to it than to any other well. Cells are clipped to the outline
of a region, and their areas add up to the area of the region.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

import delone
from delone.datasets import uniform

region = [(0, 0), (9, -1), (12, 5), (7, 6), (4, 9), (-1, 5)]
wells = uniform(60, seed=5) * (13, 10) - (1, 1)
cells = delone.Voronoi(wells, clip={"type": "Polygon", "coordinates": [region]})
areas = cells.cell_areas
print(f"{np.count_nonzero(areas)} of {len(wells)} cells reach the region")
print(f"areas from {areas[areas > 0].min():.2f} to {areas.max():.2f}, in all {areas.sum():.2f}")

# %%
# The cells, colored by area.

figure, ax = plt.subplots(figsize=(7, 5), layout="constrained")
cells.plot(ax, values=areas)
ax.set(title="Land around each well")
plt.show()
