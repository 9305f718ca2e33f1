"""
Elasticity of a bracket, and the error
======================================

A bracket is held at one hole and pulled down at the other. Its surface is filled with tetrahedra, scikit-fem computes
how far it bends with first- and second-order elements, and a finer mesh shows the error of both.

Install: ``pip install "delone[fem,pyvista]" scipy``.
"""

import numpy as np
import pyvista
import skfem
from scipy.sparse.linalg import splu
from skfem.models.elasticity import lame_parameters, linear_elasticity

import delone

# %%
# For the surface, an L with two holes is meshed in 2-D and extruded. :doc:`/tutorials/part` begins with an STL file.

THICKNESS, RADIUS, SIZE = 0.6, 0.5, 0.5
HELD, PULLED = 1, 2
CENTERS = {HELD: (1, 4), PULLED: (5, 1)}
turn = 2 * np.pi * np.append(np.arange(12), 0) / 12
circle = RADIUS * np.column_stack((np.cos(turn), np.sin(turn)))
outline = [(0, 0), (6, 0), (6, 2), (2, 2), (2, 5), (0, 5), (0, 0)]
rings = [outline, *((circle + center).tolist() for center in CENTERS.values())]
flat = delone.mesh({"type": "Polygon", "coordinates": rings}, size=1.2).to_pyvista()
flat.clear_data()
surface = flat.extrude((0, 0, THICKNESS), capping=True).triangulate()
points, faces = surface.points.astype(float), surface.regular_faces

# %%
# Markers: faces with all corners on the rim of a hole. They are boundaries in scikit-fem.

markers = np.zeros(len(faces), dtype=int)
for marker, center in CENTERS.items():
    distance = np.hypot(*(points[faces][:, :, :2] - center).T)
    markers[(np.abs(distance - RADIUS) < 1e-6).all(axis=0)] = marker

# %%
# Tetrahedra of a given size. Extruded faces are not consistently oriented, so everything that they enclose is filled.

mesh = delone.tetrahedralize(
    points, faces, inside="enclosed", face_markers=markers, boundary="surface", size=SIZE
)
print(mesh, f"dihedral angles of {mesh.quality().smallest_dihedral.min():.0f} degrees or more")
assert mesh.validate()

# %%
# Linear elasticity: the held rim does not move, and a force of 1 is spread over the pulled one. The work of the force
# says how far the bracket bends.


def rim(solid, marker):
    """Return the facets of a hole; refined meshes have no named boundaries."""
    x, y = CENTERS[marker]
    return solid.facets_satisfying(
        lambda at: np.hypot(at[0] - x, at[1] - y) < RADIUS, boundaries_only=True
    )


def solve(solid, element):
    """Return the displacements and the work of the force."""
    element = skfem.ElementVector(element)
    basis = skfem.Basis(solid, element, intorder=2)
    pulled = skfem.FacetBasis(solid, element, facets=rim(solid, PULLED), intorder=2)
    area = pulled.dx.sum()
    force = skfem.LinearForm(lambda v, w: -v[1] / area).assemble(pulled)
    stiffness = linear_elasticity(*lame_parameters(1.0, 0.3)).assemble(basis)
    held = basis.get_dofs(rim(solid, HELD))
    matrix, right, u, inner = skfem.condense(stiffness, force, D=held)
    u[inner] = splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    ).solve(right)
    return u, force @ u


coarse = mesh.to_skfem()
assert np.array_equal(np.sort(rim(coarse, HELD)), np.sort(coarse.boundaries["marker 1"]))
fine = coarse.refined()
first, second = skfem.ElementTetP1(), skfem.ElementTetP2()
_, exact = solve(fine, second)
errors = {}
for name, solid, element in (
    ("first order", coarse, first),
    ("first order, refined", fine, first),
    ("second order", coarse, second),
):
    u, work = solve(solid, element)
    errors[name] = 1 - work / exact
    print(f"{name}: {len(u):,} unknowns, {errors[name]:.1%} too stiff")

# %%
# Second order is far better than first order with the same number of unknowns. A common mistake is to trust first-order
# elements in bending: they are too stiff, and there is no warning.

assert 4 * errors["second order"] < errors["first order, refined"] < errors["first order"]

# %%
# The deformed bracket, including the nodes in the middle of edges. scikit-fem has three degrees of freedom for each
# point, then three for each edge, in the order of the nodes of :meth:`delone.TetMesh.to_pyvista`.

grid = mesh.to_pyvista(order=2)
moved = u.reshape(-1, 3)
grid.point_data["displacement"] = np.linalg.norm(moved, axis=1)
grid.points = grid.points + moved * (0.7 / np.abs(moved).max())

plotter = pyvista.Plotter(window_size=(900, 640))
plotter.add_mesh(surface.clean().extract_feature_edges(30), color="gray", line_width=2)
plotter.add_mesh(
    grid.extract_surface(algorithm="dataset_surface"),
    scalars="displacement",
    cmap="viridis",
    show_scalar_bar=False,
)
plotter.add_title("Displacement of a bracket, enlarged", font_size=10)
plotter.camera_position = [(9, -6, 11), (3, 2, 0), (0, 0, 1)]
plotter.show()
