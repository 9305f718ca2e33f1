"""
Slivers at a surface
====================

The triangulation of points on a sphere consists of slivers: all vertices are on the surface, so none may move, and
flips improve little. Added points inside make the tetrahedra usable for finite elements.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

import delone

directions = np.random.default_rng(0).normal(size=(400, 3))
shell = delone.Delaunay(directions / np.linalg.norm(directions, axis=1)[:, None])

# %%
# Flips and moves keep the number of points. ``max_points`` allows additional points: first near the worst tetrahedra,
# and only where the new tetrahedra are better, which is proven for each point.

kept = delone.improve(shell)
finer = delone.improve(shell, max_points=2000)
for mesh in shell, kept, finer:
    smallest = mesh.quality().smallest_dihedral
    print(
        f"{mesh.npoints:4} points, {mesh.nsimplex:5,} tetrahedra, angles from {smallest.min():6.3f} degrees"
    )

# %%
# The triangles of the sphere are the same in all three meshes.

figure, axes = plt.subplots(1, 3, figsize=(11, 3), sharey=True, layout="constrained")
for ax, (name, mesh) in zip(
    axes, {"Delaunay": shell, "flips": kept, "added points": finer}.items(), strict=True
):
    share = np.full(mesh.nsimplex, 100 / mesh.nsimplex)
    ax.hist(mesh.quality().smallest_dihedral, bins=np.arange(0, 72, 4), weights=share)
    ax.set(
        title=f"{name}: {mesh.nsimplex:,} tetrahedra", xlabel="smallest dihedral angle (degrees)"
    )
axes[0].set_ylabel("percent of the tetrahedra")
plt.show()
