"""
Even out points: Lloyd relaxation and stippling
===============================================

Lloyd's method moves each point to the centroid of its Voronoi cell, again and again. Random points become evenly
spaced; with a density they become a picture made of dots, or sampling sites that are denser where it matters.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Voronoi, lloyd
from delone.datasets import uniform

# %%
# Thirty steps of Lloyd's method, in the unit square. The energy, the mean squared distance to the nearest site,
# decreases with each step.

box = (0, 0, 1, 1)
before = Voronoi(uniform(400, seed=2), clip=box)
relaxed = lloyd(before.points, box, max_iter=30)
after = relaxed.diagram
assert (np.diff(relaxed.energies) < 0).all()
for name, diagram in (("before", before), ("after", after)):
    areas = diagram.cell_areas
    print(f"{name}: areas {areas.min():.5f} to {areas.max():.5f}", end=", ")
    print(f"spread {areas.std() / areas.mean():.2f}")

# %%
# The cells on the same color scale: the evener the areas, the paler.

figure, axes = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained")
for ax, diagram, title in zip(axes, (before, after), ("Random", "30 steps"), strict=True):
    relative = (diagram.cell_areas * len(diagram.points)).clip(0, 2)
    relative[:2] = relative[:2].clip(0, 2)
    diagram.plot(ax, values=relative, cmap="RdBu", colorbar=False)
    ax.set(title=title, xticks=[], yticks=[])
plt.show()
