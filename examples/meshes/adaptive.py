r"""
Adaptive refinement: solve, estimate, refine
============================================

At a reentrant corner, the gradient of the solution is infinite, and uniformly smaller triangles help little. An error
indicator marks the triangles that matter; :meth:`~delone.Mesh.refine` splits them and keeps the bound on angles.

Install: ``pip install "delone[fem,plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import skfem
from skfem.models.poisson import laplace

import delone

# %%
# The domain has the shape of an L, with its corner at the origin. The function :math:`r^{2/3} \sin(2 \varphi / 3)` is
# harmonic, and zero on the two sides at the corner. It is given on the boundary.

ring = [(0, 0), (0, -1), (1, -1), (1, 1), (-1, 1), (-1, 0)]
domain = {"type": "Polygon", "coordinates": [ring]}


def exact(x):
    """Return the solution."""
    return np.hypot(*x) ** (2 / 3) * np.sin((np.arctan2(x[1], x[0]) + np.pi / 2) * 2 / 3)


def solve(mesh):
    """Return the values of linear elements at the points, and their error in the L2 norm."""
    basis = skfem.Basis(mesh.to_skfem(), skfem.ElementTriP1(), intorder=6)
    given = basis.get_dofs().flatten()
    values = basis.zeros()
    values[given] = exact(mesh.points[given].T)
    values = skfem.solve(*skfem.condense(laplace.assemble(basis), x=values, D=given))
    error = skfem.Functional(lambda w: (w.u - exact(w.x)) ** 2)
    return values, np.sqrt(error.assemble(basis, u=basis.interpolate(values)))


# %%
# The indicator of a triangle is the jump of the gradient across its three edges, times their lengths. ``neighbors``
# contains the triangles across the edges; -1, at the boundary, contributes nothing.


def indicator(mesh, values):
    """Return the error indicator of each triangle, squared."""
    corners, u = mesh.points[mesh.simplices], values[mesh.simplices]
    sides = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    normals = np.stack((-sides[..., 1], sides[..., 0]), axis=-1)
    gradient = np.einsum("tk,tkd->td", u, normals) / (2 * mesh.areas[:, None])
    jump = gradient[:, None] - gradient[mesh.neighbors]
    jump[mesh.neighbors < 0] = 0
    return np.sum(np.sum(jump**2, axis=2) * np.sum(sides**2, axis=2), axis=1)


def worst(squares, share):
    """Return the fewest triangles that together have this share of the error."""
    order = np.argsort(-squares)
    return order[: 1 + np.searchsorted(np.cumsum(squares[order]), share * squares.sum())]


# %%
# Each round solves, estimates and refines, up to 8,000 triangles.

adaptive = []
mesh = delone.mesh(domain, size=0.4)
while mesh.nsimplex < 8000:
    values, error = solve(mesh)
    adaptive.append((mesh.nsimplex, error))
    if mesh.nsimplex < 1000:
        shown = mesh
    mesh = mesh.refine(worst(indicator(mesh, values), 0.5), ratio=0.5)
    assert mesh.report

even = []
for size in (0.4, 0.2, 0.1, 0.05, 0.025):
    fine = delone.mesh(domain, size=size)
    even.append((fine.nsimplex, solve(fine)[1]))

for name, rounds in (("adaptive", adaptive), ("even", even)):
    count, error = np.log(rounds[1:]).T
    print(
        f"{name}: {len(rounds)} meshes, error ~ triangles ** {np.polyfit(count, error, 1)[0]:.2f}"
    )

# %%
# A common mistake is to pass triangles that were marked on a different mesh. Triangle numbers change with each
# refinement, and the number of values no longer matches; compute the indicators again.

try:
    mesh.refine(indicator(shown, np.zeros(shown.npoints)) > 1)
except delone.DeloneError as error:
    print(f"{type(error).__name__}: {error}")

# %%
# One of the meshes, and the errors.

figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4.6), layout="constrained")
left.triplot(shown.to_matplotlib(), color="0.2", linewidth=0.5)
left.set(aspect="equal", title=f"{shown.nsimplex} triangles, refined adaptively")
right.loglog(*np.transpose(even), "s-", label="even size")
right.loglog(*np.transpose(adaptive), "o-", label="adaptive")
right.set(xlabel="triangles", title="Error in the mean square")
right.legend()
plt.show()
