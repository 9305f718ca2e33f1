"""
A cut through tetrahedra
========================

The tetrahedra of points in a box, colored by volume. Half of them are omitted to show the inside.

Install: ``pip install "delone[pyvista]"``.
"""

import delone
from delone.datasets import uniform

points = uniform(3000, seed=2, ndim=3) * (2.0, 1.0, 1.0)
solid = delone.Delaunay(points)
print(f"{solid.nsimplex:,} tetrahedra, volumes up to {solid.volumes.max():.2e}")

# %%
# ``cut="x"`` omits one half. :meth:`~delone.Delaunay.plot` returns a PyVista plotter.

plotter = solid.plot(values=solid.volumes, cut="x")
plotter.show()
