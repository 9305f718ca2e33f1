"""Pictures of the tutorial from an STL file to a solution, drawn from what delone computes."""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pyvista
import skfem
from skfem.models.poisson import laplace, unit_load

import delone


def solution() -> None:
    """The bracket as a file has it, and the temperature in it, cut open."""
    turn = 2 * np.pi * np.append(np.arange(16), 0) / 16
    circle = 0.5 * np.column_stack((np.cos(turn), np.sin(turn)))
    outline = [(0, 0), (6, 0), (6, 2), (2, 2), (2, 5), (0, 5), (0, 0)]
    holes = [(circle + center).tolist() for center in ((1, 4), (5, 1))]
    flat = delone.mesh({"type": "Polygon", "coordinates": [outline, *holes]}, size=0.9)
    plane = flat.to_pyvista()
    plane.clear_data()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bracket.stl"
        plane.extrude((0, 0, 0.75), capping=True).triangulate().save(path)
        hull = delone.tetrahedralize(path)
        mesh = delone.tetrahedralize(path, boundary="surface", size=0.4)
    basis = skfem.Basis(mesh.to_skfem(), skfem.ElementTetP2())
    matrix, right = laplace.assemble(basis), unit_load.assemble(basis)
    u = skfem.solve(*skfem.condense(matrix, right, D=basis.get_dofs()))
    # Cut at half the thickness, with the values of all nodes.
    grid = mesh.to_pyvista(order=2)
    grid.point_data["u"] = u
    shapes = {
        "the triangles of the file": (hull.to_pyvista(), {"color": "#b8e0f0", "show_edges": True}),
        "the temperature, cut at half the thickness": (
            grid.clip("z"),
            {"scalars": "u", "cmap": "plasma", "show_scalar_bar": False},
        ),
    }
    _, row = plt.subplots(1, 2, figsize=(11, 4), layout="constrained")
    for ax, (title, (shape, options)) in zip(row, shapes.items(), strict=True):
        plotter = pyvista.Plotter(off_screen=True, window_size=(900, 640))
        plotter.set_background("white")
        plotter.add_mesh(shape, **options)
        plotter.camera_position = [(9, -6, 9), (3, 2.2, 0), (0, 0, 1)]
        ax.imshow(plotter.screenshot(return_img=True))
        plotter.close()
        ax.set_title(title, fontsize="medium")
        ax.set_axis_off()
