"""
Long and thin triangles of a part
=================================

Files of machine parts have triangles that are as long as the part and as thin as one step around a hole. Tetrahedra at such
triangles have small angles, whatever is added inside. With ``boundary="surface"``, the triangles are divided as well.

Install: ``pip install "delone[plot,pyvista]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

import delone

# %%
# A bushing, as a CAD program writes it: two triangles for each of 48 steps, on each of its four sides. It is turned, and its
# coordinates are rounded to single precision, as in an STL file. So the two triangles of a step, and those of the ends, are
# no longer exactly in one plane.

n = 48
angle = 2 * np.pi * np.arange(n) / n
circle = np.column_stack((np.cos(angle), np.sin(angle), np.zeros(n)))
up = np.array([0, 0, 3.0])
rings = (circle, circle + up, 0.6 * circle + up, 0.6 * circle)
turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
points = (np.concatenate(rings) @ turn).astype(np.float32).astype(float)
k = np.arange(n)
after = (k + 1) % n
faces = np.concatenate(
    [
        np.column_stack(corners)
        for low, high in ((0, n), (n, 2 * n), (2 * n, 3 * n), (3 * n, 0))
        for corners in (
            (low + k, low + after, high + after),
            (low + k, high + after, high + k),
        )
    ]
)
print(delone.check_surface(points, faces))

# %%
# Three meshes: with all triangles kept, with triangles and edges divided where shapes require it, and with triangles joined
# that are within 0.00001 of one plane. Without the tolerance, each edge between two triangles has to stay.

meshes = {
    "faces": delone.tetrahedralize(points, faces, radius_edge=2),
    "surface": delone.tetrahedralize(points, faces, boundary="surface", radius_edge=2),
    "surface, tolerance": delone.tetrahedralize(
        points, faces, boundary="surface", radius_edge=2, tolerance=1e-5
    ),
}
for name, mesh in meshes.items():
    report = mesh.report
    print(
        f"{name}: {mesh.nsimplex:,} tetrahedra, smallest angle "
        f"{mesh.quality().smallest_dihedral.min():.1f} degrees, {report.on_segments} points on "
        f"edges, {report.on_facets} on faces, within {report.surface_distance:.1g}"
    )

# %%
# The smallest dihedral angles of all tetrahedra.

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for name, mesh in meshes.items():
    axes.hist(
        mesh.quality().smallest_dihedral,
        np.arange(0, 72, 2),
        density=True,
        histtype="step",
        label=name,
    )
axes.set(xlabel="smallest dihedral angle in degrees", ylabel="share of tetrahedra per degree")
axes.legend()
plt.show()

# %%
# One half of the last mesh.

plotter = meshes["surface, tolerance"].plot(cut="y")
plotter.camera.zoom(1.8)
plotter.show()
