"""
Heat in a ball of tetrahedra
============================

Points in a ball are triangulated, slivers are removed, and scikit-fem solves Poisson's equation on the tetrahedra.
The plot shows the ball cut open.

Install: ``pip install "delone[fem,pyvista]"``.
"""

import numpy as np
import skfem
from skfem.models.poisson import laplace

import delone

# %%
# The mesh fills the convex hull of the points, and no points are added. So the points on the sphere are as dense as
# those inside: a spiral on the sphere, and a slightly jittered lattice inside. Lattice points next to the sphere are
# left out, because they would make flat tetrahedra that cannot be improved.

SIZE = 0.12
count = round(4 * np.pi / (0.87 * SIZE**2))
row = np.arange(count) + 0.5
height, angle = 1 - 2 * row / count, np.pi * (1 + np.sqrt(5)) * row
ring = np.sqrt(1 - height**2)
sphere = np.column_stack((ring * np.cos(angle), ring * np.sin(angle), height))
axis = np.arange(-1, 1 + SIZE, SIZE)
lattice = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
lattice += np.random.default_rng(0).uniform(-0.2 * SIZE, 0.2 * SIZE, lattice.shape)
inside = lattice[np.linalg.norm(lattice, axis=1) < 1 - 0.6 * SIZE]

# %%
# A Delaunay triangulation of points contains slivers, which are almost flat: a common mistake is to solve on it
# without improving it. :func:`delone.improve` changes tetrahedra and moves interior points until no dihedral angle is
# below the target.

plain = delone.Delaunay(np.concatenate((sphere, inside)))
ball = delone.improve(plain, min_angle=20)
print(ball.report)
assert plain.quality().smallest_dihedral.min() < 1
assert ball.quality().smallest_dihedral.min() >= 20

# %%
# A heat source off the center; the temperature is zero on the sphere.


def source(x):
    """Return the heat produced at positions."""
    return 80 * np.exp(-12 * ((x[0] - 0.15) ** 2 + (x[1] + 0.3) ** 2 + (x[2] - 0.25) ** 2))


basis = skfem.Basis(ball.to_skfem(), skfem.ElementTetP1())
heat = skfem.LinearForm(lambda v, w: source(w.x) * v).assemble(basis)
boundary = basis.get_dofs().flatten()
temperature = skfem.solve(*skfem.condense(laplace.assemble(basis), heat, D=boundary))
print(
    f"{ball.nsimplex:,} tetrahedra, temperatures from {temperature.min():.3f} to {temperature.max():.2f}"
)
assert set(boundary) == set(ball.boundary.ravel())
assert temperature.min() > -1e-9

# %%
# Nodes of scikit-fem are rows of ``ball.points``, so the temperatures are values of the mesh. ``cut="x"`` removes the
# half in front.

plotter = ball.plot(values=temperature, cut="x", cmap="plasma", below=None, colorbar=False)
plotter.add_title("Temperature, cut open", font_size=10)
plotter.camera.zoom(1.3)
plotter.show()
