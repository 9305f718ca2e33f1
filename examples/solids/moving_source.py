"""
Tetrahedra that follow a heat source
====================================

A laser moves over a plate. The mesh is fine where the source is, and becomes coarse again where it was: each step coarsens the
tetrahedra far from the source, smooths the mesh, and refines the tetrahedra near the source.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

import delone

corners = np.array([(x, y, z) for x in (0, 4) for y in (0, 2) for z in (0, 1)], float)
plate = delone.ConvexHull(corners)
mesh = delone.tetrahedralize(plate.points, plate.simplices, size=0.5, boundary="surface")

# %%
# :meth:`~delone.TetMesh.coarsen` removes added interior points as long as no dihedral angle falls below a bound. A single call
# never removes two neighbors, so it is repeated, and after each call :meth:`~delone.TetMesh.smooth` moves the remaining points.
# Then :meth:`~delone.TetMesh.refine` makes marked tetrahedra smaller and removes slivers, with a goal of 20 degrees.


def near(mesh: delone.TetMesh, source: np.ndarray, radius: float) -> np.ndarray:
    """Return which tetrahedra have their center near the source."""
    centers = mesh.points[mesh.simplices].mean(axis=1)
    return np.linalg.norm(centers - source, axis=1) < radius


steps = []
for x in (1.0, 2.0, 3.0):
    source = np.array([x, 1.0, 0.5])
    for _ in range(8):
        mesh = mesh.coarsen(~near(mesh, source, 0.6), min_angle=10).smooth(1, min_angle=10)
    for _ in range(3):
        large = mesh.volumes > 4e-4
        mesh = mesh.refine(large & near(mesh, source, 0.5), ratio=0.3)
    angle = mesh.quality().smallest_dihedral.min()
    steps.append((source, mesh))
    print(f"source at {x}: {mesh.nsimplex:6,} tetrahedra, smallest dihedral angle {angle:.1f}")

# %%
# After each step, the edges halfway through the thickness of the plate, seen from above. Where the source was, the mesh becomes
# coarse again. Points on the surface are not removed.

figure, axes = plt.subplots(3, 1, figsize=(7, 9), sharex=True, layout="constrained")
for ax, (source, mesh) in zip(axes, steps, strict=True):
    middle = np.abs(mesh.points[:, 2] - 0.5) < 0.25
    edges = mesh.edges[middle[mesh.edges].all(axis=1)]
    ax.add_collection(LineCollection(mesh.points[edges, :2], linewidths=0.4))
    ax.plot(source[0], source[1], "o", color="tab:red", markersize=8)
    ax.set(aspect="equal", title=f"{mesh.nsimplex:,} tetrahedra", ylabel="y")
axes[-1].set_xlabel("x")
plt.show()
