"""
Even out points: Lloyd relaxation and stippling
===============================================

Lloyd's method moves each point to the centroid of its Voronoi cell, again and again. Random points become evenly
spaced. With a density, they form a picture made of dots, or sampling sites that are denser in important areas.

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
# The cells on the same color scale: the more even the areas, the paler the colors.

figure, axes = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained")
for ax, diagram, title in zip(axes, (before, after), ("Random", "30 steps"), strict=True):
    relative = diagram.cell_areas * len(diagram.points)
    diagram.plot(ax, values=relative, cmap="RdBu", colorbar=False)
    ax.collections[0].set_clim(0, 2)
    ax.set(title=title, xticks=[], yticks=[])
plt.show()

# %%
# Stippling: with a density, sites concentrate where it is high. Here the density is the darkness of a shaded ball.
# ``density`` takes an array of positions of shape (n, 2) and returns a number for each.


def darkness(positions):
    """Return how dark the picture is, from 0.03 for the background to 1."""
    x, y = 2.4 * positions.T - 1.2
    height = np.sqrt(np.clip(1 - x**2 - y**2, 0, None))
    light = np.clip((2 * height - x + y) / np.sqrt(6), 0, 1)
    return np.where(x**2 + y**2 < 1, 1.05 - light, 0.03)


random = np.random.default_rng(5)
anywhere = random.random((60_000, 2))
start = anywhere[random.random(len(anywhere)) < darkness(anywhere)][:6000]
dots = lloyd(start, box, max_iter=20, density=lambda xy: darkness(xy) ** 2).points
figure, ax = plt.subplots(figsize=(5.4, 5.6), layout="constrained")
ax.scatter(*dots.T, s=3, color="black", linewidths=0)
ax.set(title=f"Stippling: {len(dots):,} dots", aspect="equal", xticks=[], yticks=[])
plt.show()

# %%
# The number of dots per area is proportional to the square root of the density, so the density is squared. A common
# mistake is to start with evenly spread sites: each step moves a site by less than the size of its cell, and after
# twenty steps, dark areas are still too bright. So draw the first sites from the density.
