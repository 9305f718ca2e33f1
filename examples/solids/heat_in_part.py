"""
Heat in a part from STL files
=============================

A block of aluminum with a plug of steel, each a surface in an STL file, is filled with tetrahedra that keep all
triangles. scikit-fem solves the heat equation with the conductivity of each region.

Install: ``pip install "delone[fem,mesh,pyvista]"``.
"""

import tempfile
from pathlib import Path

import meshio
import numpy as np
import skfem
from skfem.helpers import dot, grad

import delone

# %%
# The two files: a square with a disk in it is meshed in 2-D, and the triangles of each region become a prism.

SIZE, LAYERS = 0.25, 4
turn = 2 * np.pi * np.arange(28) / 28
t = np.arange(-2, 2, SIZE)
quarter = np.column_stack((t, np.full(len(t), -2.0)))
quarters = [quarter, quarter[:, ::-1] * (-1, 1), -quarter, quarter[:, ::-1] * (1, -1)]
rings = [np.concatenate(quarters), np.column_stack((np.cos(turn), np.sin(turn)))]
rows = [np.arange(64), 64 + np.arange(28)]
segments = np.concatenate([np.column_stack((row, np.roll(row, -1))) for row in rows])
BLOCK, PLUG = 0, 1
seeds = [(1.5, 1.5, BLOCK), (0, 0, PLUG)]
flat = delone.mesh((np.concatenate(rings), segments), regions=seeds, size=SIZE, fixed=True)


def prism(triangles):
    """Return the points and triangles of a prism, seen from outside."""
    n = flat.npoints
    levels = np.linspace(0, 1, LAYERS + 1)
    points = np.concatenate([np.column_stack((flat.points, np.full(n, z))) for z in levels])
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    a, b = edges[~np.isin(edges @ (n, 1), edges @ (1, n))].T
    # Both prisms must have the same diagonals in their common wall; otherwise, their faces cross.
    up = a < b
    wall = np.concatenate(
        (
            np.column_stack((a, b, np.where(up, b, a) + n)),
            np.column_stack((np.where(up, a, b), b + n, a + n)),
        )
    )
    walls = [wall + k * n for k in range(LAYERS)]
    return points, np.concatenate((triangles[:, ::-1], triangles + LAYERS * n, *walls))


folder = Path(tempfile.mkdtemp())
for name, label in {"block": BLOCK, "plug": PLUG}.items():
    points, faces = prism(flat.simplices[flat.region == label])
    meshio.Mesh(points, [("triangle", faces)]).write(folder / f"{name}.stl", binary=False)

# %%
# Both surfaces are combined: equal points are one vertex, and the common wall separates two regions, which are
# labeled by seeds. A common mistake is to give no size: then nearly all vertices are on the surface, and the solution
# has no values inside. With a size, points are added between the faces, and slivers are removed.

files = [delone.io.read_mesh(folder / f"{name}.stl") for name in ("block", "plug")]
first, second = (np.column_stack((file.points, file.z)) for file in files)
points = np.concatenate((first, second))
faces = np.concatenate((files[0].simplices, files[1].simplices + len(first)))

seeds = [(1.51, 1.5, 0.49, BLOCK), (0.02, 0.01, 0.49, PLUG)]
bare = delone.tetrahedralize(points, faces, regions=seeds)
mesh = delone.tetrahedralize(points, faces, regions=seeds, size=SIZE)
print(mesh, mesh.validate(), sep="\n")
assert bare.nadded < 20
assert mesh.validate()

# %%
# Heat is produced in the plug, and the sides of the block are kept at zero. Rows of points that are not vertices,
# such as the duplicates, are left out of the system.

basis = skfem.Basis(mesh.to_skfem(), skfem.ElementTetP1())
ones = np.ones_like(basis.dx)
conductivity = np.where(mesh.region == PLUG, 50.0, 200.0)[:, None] * ones
produced = np.where(mesh.region == PLUG, 1000.0, 0.0)[:, None] * ones
stiffness = skfem.BilinearForm(lambda u, v, w: w.k * dot(grad(u), grad(v)))
heat = skfem.LinearForm(lambda v, w: w.q * v).assemble(basis, q=produced)
matrix = stiffness.assemble(basis, k=conductivity)
vertices = np.unique(mesh.simplices)
sides = vertices[np.abs(mesh.points[vertices, :2]).max(axis=1) == 2]
temperature = skfem.solve(*skfem.condense(matrix, heat, I=np.setdiff1d(vertices, sides)))

# %%
# In the plug, the temperature decreases as in a long cylinder, by :math:`q r^2 / 4 k` from the center to the wall.

radius = np.hypot(*mesh.points[vertices, :2].T)
wall = temperature[vertices[np.isclose(radius, 1)]].mean()
drop, formula = temperature.max() - wall, 1000 / (4 * 50)
print(f"{mesh.nsimplex:,} tetrahedra; from center to wall {drop:.2f}, by the formula {formula:.2f}")
assert abs(drop - formula) < 0.2
plotter = mesh.plot(values=temperature, cut="y", cmap="plasma", colorbar=False, below=None)
plotter.add_title("Temperature in block and plug, cut open", font_size=10)
plotter.camera.zoom(0.95)
plotter.show()
