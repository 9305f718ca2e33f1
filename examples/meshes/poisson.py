"""
Poisson's equation on an island
===============================

The outline of Gotland is meshed at four sizes. On each mesh, linear elements of scikit-fem solve
:math:`-\\Delta u = f` with *u* given on the coast, for a known solution. The error in the L2 norm
must decrease with the square of the size.

Install: ``pip install "delone[fem,plot]"``.
"""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import skfem
from skfem.models.poisson import laplace

import delone

# %%
# The outline, in kilometers from its center.


def data_folder():
    """Return the folder ``data`` next to the examples, even when this runs as a notebook."""
    here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
    return next(folder / "data" for folder in (here, *here.parents) if (folder / "data").is_dir())


coast = json.loads((data_folder() / "gotland.geojson").read_text())
ring = np.array(coast["geometry"]["coordinates"][0])
center = ring.mean(axis=0)
kilometers = (ring - center) * 111.2 * (np.cos(np.radians(center[1])), 1)
island = {"type": "Polygon", "coordinates": [kilometers.tolist()]}
mesh = delone.mesh(island, size=4)
print(mesh.report)

# %%
# The known solution is a product of waves; *f* is minus its Laplacian. KX and KY are in radians per kilometer.

KX, KY = 0.05, 0.04


def exact(x):
    """Return the solution."""
    return np.sin(KX * x[0]) * np.cosh(0.02 * x[0]) * np.cos(KY * x[1])


def load(x):
    """Return minus the Laplacian of the solution."""
    a, b, c = np.sin(KX * x[0]), np.cosh(0.02 * x[0]), np.cos(KY * x[1])
    da, db = KX * np.cos(KX * x[0]), 0.02 * np.sinh(0.02 * x[0])
    return (KX**2 + KY**2 - 0.02**2) * a * b * c - 2 * da * db * c


def solve(mesh):
    """Solve on one mesh; return the values at the vertices and the error in the L2 norm."""
    basis = skfem.Basis(mesh.to_skfem(), skfem.ElementTriP1())
    stiffness = laplace.assemble(basis)
    right = skfem.LinearForm(lambda v, w: load(w.x) * v).assemble(basis)
    coast = basis.get_dofs().flatten()
    values = np.zeros(basis.N)
    values[coast] = exact(mesh.points[coast].T)
    solution = skfem.solve(*skfem.condense(stiffness, right, x=values, D=coast))
    error = skfem.Functional(lambda w: (w.u - exact(w.x)) ** 2)
    return solution, np.sqrt(error.assemble(basis, u=basis.interpolate(solution)))


# %%
# Four meshes; each halves the size of the previous one.

sizes = (4.0, 2.0, 1.0, 0.5)
errors = []
for size in sizes:
    fine = delone.mesh(island, size=size)
    solution, error = solve(fine)
    errors.append(error)
    print(f"size {size:3g} km: {fine.nsimplex:6,} triangles, error {error:.2e}")

order = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
print(f"order of convergence {order:.2f}")
assert 1.8 < order < 2.3

# %%
# The coarsest mesh, the solution on the finest one, and the errors.

figure, (left, middle, right) = plt.subplots(1, 3, figsize=(10, 4.4), layout="constrained")
left.triplot(mesh.to_matplotlib(), color="0.3", linewidth=0.5)
left.set(title="Mesh, size 4 km", aspect="equal")
middle.tripcolor(fine.to_matplotlib(), solution, shading="gouraud")
middle.set(title="Solution", aspect="equal", xlabel="km", yticks=[])
right.loglog(sizes, errors, "o-")
right.set(title=f"Error, order {order:.2f}", xlabel="size in km")
right.set_xticks(sizes, labels=sizes, minor=False)
right.set_xticks([], minor=True)
plt.show()
