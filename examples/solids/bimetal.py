"""
A strip of two metals that bends
================================

A strip of steel and aluminum bends when it is heated, because aluminum expands more. One surface with a wall inside
encloses both metals, two seeds label the materials, and second-order elements give the curvature of Timoshenko's
formula.

Install: ``pip install "delone[fem,pyvista]" scipy``.
"""

import numpy as np
import pyvista
import skfem
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, div, eye, sym_grad, trace

import delone

# %%
# A rectangle is meshed and extruded twice, so both bodies have the same triangles in their common wall. Both pass
# these triangles, and the mesh contains them once.

LENGTH, WIDTH, LAYER = 10.0, 1.0, 0.25
STEEL, ALUMINUM = 0, 1
rectangle = [(0, 0), (LENGTH, 0), (LENGTH, WIDTH), (0, WIDTH)]
flat = delone.mesh(rectangle, size=0.5).to_pyvista()
flat.clear_data()
body = flat.extrude((0, 0, LAYER), capping=True).triangulate()
lower, faces = body.points.astype(float), body.regular_faces
upper = lower + np.array([0, 0, LAYER])
# Points with the same coordinates are one vertex; scikit-fem should not see the others.
points, row = np.unique(np.concatenate((lower, upper)), axis=0, return_inverse=True)
mesh = delone.tetrahedralize(
    points,
    row.reshape(-1)[np.concatenate((faces, faces + len(lower)))],
    inside="enclosed",
    regions=[(5.1, 0.4, 0.1, STEEL), (5.1, 0.4, LAYER + 0.1, ALUMINUM)],
)
print(mesh.report)
mesh = delone.improve(mesh)
assert mesh.validate()
volumes = [mesh.volumes[mesh.region == label].sum() for label in (STEEL, ALUMINUM)]
assert np.allclose(volumes, LENGTH * WIDTH * LAYER)

# %%
# Values indexed by ``mesh.region`` are element values in scikit-fem: Young's modulus in GPa and expansion in 1/K. One
# end is clamped, and the strip is heated by 100 K.

YOUNG, EXPANSION = np.array([200.0, 70.0]), np.array([12e-6, 23e-6])
POISSON, HEATED = 0.3, 100.0
basis = skfem.Basis(mesh.to_skfem(), skfem.ElementVector(skfem.ElementTetP2()), intorder=2)
ones = np.ones_like(basis.dx)
young = YOUNG[mesh.region][:, None] * ones
lame = {
    "lam": young * POISSON / (1 + POISSON) / (1 - 2 * POISSON),
    "mu": young / 2 / (1 + POISSON),
}
strain = EXPANSION[mesh.region][:, None] * ones * HEATED


@skfem.BilinearForm
def stiffness(u, v, w):
    """Return the work of the elastic stresses."""
    strains = sym_grad(u)
    return ddot(w.lam * eye(trace(strains), 3) + 2 * w.mu * strains, sym_grad(v))


@skfem.LinearForm
def heat(v, w):
    """Return the work of the stresses that would prevent the expansion."""
    return (3 * w.lam + 2 * w.mu) * w.strain * div(v)


matrix = stiffness.assemble(basis, **lame)
right = heat.assemble(basis, **lame, strain=strain)
held = basis.get_dofs(basis.mesh.facets_satisfying(lambda x: x[0] == 0, boundaries_only=True))
matrix, right, u, inner = skfem.condense(matrix, right, D=held)
u[inner] = splu(
    matrix.tocsc(),
    permc_spec="MMD_AT_PLUS_A",
    diag_pivot_thresh=0.0,
    options={"SymmetricMode": True},
).solve(right)

# %%
# There are three degrees of freedom for each point, then three for each edge. Away from the ends, the deflection is a
# parabola, and its curvature is
# :math:`6 \\Delta\\alpha\\, \\Delta T (1 + m)^2 / (h (3 (1 + m)^2 + (1 + mn)(m^2 + 1/mn)))` with thicknesses in the
# ratio :math:`m = 1` and moduli in the ratio :math:`n`.

moved = u.reshape(-1, 3)
nodes = mesh.to_pyvista(order=2).points
middle = (nodes[:, 0] > 2) & (nodes[:, 0] < 8)
curvature = 2 * np.polyfit(nodes[middle, 0], moved[middle, 2], 2)[0]
n = YOUNG[STEEL] / YOUNG[ALUMINUM]
expected = 6 * (EXPANSION[STEEL] - EXPANSION[ALUMINUM]) * HEATED * 4
expected /= 2 * LAYER * (12 + (1 + n) * (1 + 1 / n))
print(f"{len(u):,} unknowns; curvature {curvature:.6f}, by the formula {expected:.6f}")
assert abs(curvature / expected - 1) < 0.02

# %%
# The strip and its materials, with the displacement enlarged ten times.

grid = mesh.to_pyvista(order=2)
grid.points = nodes + 10 * moved
plotter = pyvista.Plotter(window_size=(900, 500))
plotter.add_mesh(
    grid.extract_surface(algorithm="dataset_surface"),
    scalars="region",
    cmap=["#5b7a99", "#d9a441"],
    show_scalar_bar=False,
)
plotter.add_title("Steel and aluminum, heated by 100 K, enlarged ten times", font_size=10)
plotter.camera_position = [(5.5, -10.5, 2.5), (5.1, 0.5, -0.75), (0, 0, 1)]
plotter.show()
