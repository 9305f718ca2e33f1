"""3-D plots of tetrahedra and of surfaces of triangles with PyVista.

Tetrahedra hide each other, so those beyond a plane can be left out, and each can be shrunk
toward its center.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_choice, as_flag, as_number, as_plain_array
from delone._base.extras import require
from delone._base.numbers import as_share
from delone._base.values import as_values
from delone.errors import InputError
from delone.plot.plotter import add_points, as_pyvista_cmap, new_plotter
from delone.plot.protocols import has, hint, kind_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats
    from delone.plot.protocols import Simplices

__all__ = ["plot"]

_AXES = {"x": 0, "y": 1, "z": 2}
_VTK_TETRA = 10  # VTK's number of this type of cell
_FACE, _EDGE, _SKIN = "#9ecae1", "#08306b", "#2f6f9f"


def plot(
    mesh: Simplices,
    ax: Any = None,
    *,
    values: ArrayLike | None = None,
    cut: str = "none",
    shrink: float = 1.0,
    below: float | None = None,
    points: bool = False,
    cmap: Any = "viridis",
    colorbar: bool = True,
    off_screen: bool | None = None,
) -> Any:
    """Draw tetrahedra or a surface of triangles; for the options see `delone.plot.plot`.

    If there are as many simplices as points, `values` belong to the points. With `below`, they are
    the smallest dihedral angles by default.
    """
    pyvista = require("pyvista", extra="pyvista", what="drawing in 3-D")
    as_choice(cut, ("none", *_AXES), name="cut")
    dots, bar = as_flag(points, name="points"), as_flag(colorbar, name="colorbar")
    _require_simplices(mesh)
    share, colors = as_share(shrink, name="shrink"), as_pyvista_cmap(cmap)
    shown, angles = _in_front(mesh, cut), None
    if below is not None:
        bound, angles = as_number(below, name="below"), _smallest_dihedrals(mesh)
        shown &= angles < bound
    chosen = _chosen(mesh, angles if values is None else values, shown)
    plotter = new_plotter(ax, off_screen=off_screen)
    if below is not None:
        _draw_surface(pyvista, plotter, mesh)
    look: dict[str, Any] = {"color": _FACE}
    if chosen is not None:
        name = "values" if values is not None else "smallest dihedral angle in degrees"
        look = {"scalars": name, "cmap": colors, "show_scalar_bar": bar}
    if below is not None and values is None:
        look["clim"] = (0, bound)
    if shown.any():
        grid = _grid(pyvista, mesh, shown)
        _add_values(grid, look.get("scalars"), chosen)
        _draw_simplices(plotter, grid, share, look)
    if dots:
        add_points(plotter, mesh.points)
    return plotter


def _require_simplices(mesh: Any) -> None:
    """Reject anything but 3-D simplices, and name what draws it."""
    kind = kind_of(mesh)
    if kind == "tetrahedra":
        return
    instead = "delone.plot.plot draws it" if kind else hint(mesh)
    raise InputError(f"a {type(mesh).__name__} is not a mesh in 3-D: {instead}")


def _in_front(mesh: Simplices, cut: str) -> NDArray[np.bool_]:
    """Return the simplices whose center is in the lower half of the box of the points."""
    if cut == "none":
        return np.ones(len(mesh.simplices), dtype=bool)
    along = mesh.points[:, _AXES[cut]]
    middle = along.min() / 2 + along.max() / 2
    width = mesh.simplices.shape[1]
    center = sum(along[mesh.simplices[:, k]] / width for k in range(width))
    found: NDArray[np.bool_] = center <= middle
    return found


def _smallest_dihedrals(mesh: Any) -> Floats:
    if mesh.simplices.shape[1] != 4 or not has(mesh, "quality"):
        raise InputError(f"below is for tetrahedra, and a {type(mesh).__name__} has none")
    angles: Floats = mesh.quality().smallest_dihedral
    return angles


def _chosen(mesh: Simplices, values: ArrayLike | None, shown: NDArray[np.bool_]) -> Floats | None:
    """Return the values of all points or of the simplices shown."""
    if values is None:
        return None
    array = as_plain_array(values, "values")
    npoints, nsimplex = len(mesh.points), len(mesh.simplices)
    if array.shape not in ((npoints,), (nsimplex,)):
        raise InputError(
            f"values must be one for each of {npoints} points or {nsimplex} simplices, "
            f"got shape {array.shape}"
        )
    numbers = as_values(array, len(array), name="values")
    return numbers if numbers is None or len(numbers) == npoints else numbers[shown]


def _grid(pyvista: Any, mesh: Simplices, shown: NDArray[np.bool_]) -> Any:
    """Return the simplices shown as a PyVista mesh."""
    points, simplices = np.array(mesh.points), mesh.simplices[shown]
    if simplices.shape[1] == 4:
        return pyvista.UnstructuredGrid({_VTK_TETRA: simplices}, points)
    return pyvista.PolyData.from_regular_faces(points, simplices)


def _add_values(grid: Any, name: str | None, values: Floats | None) -> None:
    """Add values of points or of simplices to a PyVista mesh."""
    if values is not None:
        data = grid.point_data if len(values) == grid.n_points else grid.cell_data
        data[name] = values


def _draw_simplices(plotter: Any, grid: Any, shrink: float, look: dict[str, Any]) -> None:
    whole = shrink == 1
    if not whole:
        grid = grid.shrink(shrink)
    # Ambient light shows the colors in the shade.
    plotter.add_mesh(grid, show_edges=whole, edge_color=_EDGE, line_width=1, ambient=0.4, **look)


def _draw_surface(pyvista: Any, plotter: Any, mesh: Simplices) -> None:
    opposite = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]
    faces = mesh.simplices[:, opposite].reshape(-1, 3)
    # A face on the boundary belongs to a single tetrahedron.
    _, first, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
    )
    surface = pyvista.PolyData.from_regular_faces(np.array(mesh.points), faces[first[count == 1]])
    plotter.add_mesh(surface, color=_SKIN, opacity=0.15, show_edges=True)
