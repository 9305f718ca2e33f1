"""
Coordination numbers in a simulation box
========================================

The particles of a simulation have periodic boundaries: a particle that leaves on the right enters on the left. The
neighbors of a particle are those in the periodic Delaunay triangulation. In a flat crystal each particle has six;
others are defects.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Delaunay, PeriodicDelaunay, Voronoi

# %%
# A hexagonal crystal that fits into its box, with thermal noise, and with one particle in fifty missing.

columns, rows = 32, 36
box = np.array((columns, rows * np.sqrt(3) / 2))
i, j = np.meshgrid(np.arange(columns), np.arange(rows))
lattice = np.column_stack(((i + j % 2 / 2).ravel(), (j * np.sqrt(3) / 2).ravel()))
random = np.random.default_rng(12)
kept = random.random(len(lattice)) > 0.02
particles = (lattice[kept] + random.normal(0, 0.09, (kept.sum(), 2))) % box

# %%
# Each edge is counted at both of its ends. With two periods, there are exactly three edges per particle, so the mean is
# six.

mesh = PeriodicDelaunay(particles, periods=box)
coordination = np.bincount(mesh.edges.ravel(), minlength=len(particles))
assert coordination.mean() == 6
for number, count in zip(*np.unique(coordination, return_counts=True), strict=True):
    print(f"{number} neighbors: {count} particles")

# %%
# Bond-orientational order, ψ6: 1 in a perfect hexagonal crystal. Edges that cross the border are translated by
# ``edge_offsets``.

start, end = mesh.edges.T
bond = particles[end] + mesh.edge_offsets * box - particles[start]
turned = np.exp(6j * np.arctan2(bond[:, 1], bond[:, 0]))
total = np.zeros(len(particles), complex)
np.add.at(total, start, turned)
np.add.at(total, end, turned)  # the opposite direction has the same sixth power
order = np.abs(total) / coordination
print(f"mean |ψ6| = {order.mean():.3f}, longest bond {np.linalg.norm(bond, axis=1).max():.2f}")

# %%
# Periodic cells, colored by the number of neighbors. Cells that cross the border are drawn in full, on one of its
# sides.

figure, ax = plt.subplots(figsize=(6.6, 5.6), layout="constrained")
colors = plt.get_cmap("coolwarm", 5)
cells = Voronoi(particles, periods=box)
cells.plot(ax, values=coordination, cmap=colors, points=False, colorbar=False)
ax.collections[0].set_clim(3.5, 8.5)
figure.colorbar(ax.collections[0], ticks=range(4, 9), label="number of neighbors")
ax.plot([0, box[0], box[0], 0, 0], [0, 0, box[1], box[1], 0], color="black", lw=1)
ax.set(title="Defects of a crystal with periodic boundaries", xlim=(-1, box[0] + 1))
ax.set(ylim=(-1, box[1] + 1), xticks=[], yticks=[])
plt.show()

# %%
# A common mistake is a triangulation without periods. Particles at the border then seem to be defects, and long, thin
# triangles along the hull connect particles that are far apart.

open_mesh = Delaunay(particles)
wrong = np.bincount(open_mesh.edges.ravel(), minlength=len(particles)) != coordination
length = np.linalg.norm(np.diff(particles[open_mesh.edges], axis=1)[:, 0], axis=1)
print(f"without periods: {np.count_nonzero(wrong)} wrong numbers, longest edge {length.max():.1f}")
