"""Surfaces and grids of PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.exchange.parts import kind_of, parts_of, with_third
from delone.extras import require

if TYPE_CHECKING:
    from delone.exchange.parts import Given

__all__ = ["to_pyvista"]

# VTK's number of a tetrahedron.
_TETRA = 10


def to_pyvista(mesh: Given) -> Any:
    """Return a surface or a grid of PyVista.

    Parameters
    ----------
    mesh : Parts, mesh of delone, or pair of points and simplices
        Triangles in 2-D or 3-D, tetrahedra, or edges in 2-D.

    Returns
    -------
    pyvista.PolyData or pyvista.UnstructuredGrid
        A surface of triangles (2-D in the plane z = 0) or lines; a grid of tetrahedra. With the
        values of points and simplices; segments are left out.

    Raises
    ------
    InputError
        The arrays are no mesh.
    MissingExtraError
        pyvista is not installed (extra ``pyvista``).

    Examples
    --------
    >>> from delone.exchange.pyvista import to_pyvista
    >>> to_pyvista(([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])).n_cells
    1
    """
    pyvista = require("pyvista", extra="pyvista", what="to_pyvista")
    parts = parts_of(mesh)
    kind = kind_of(parts, what="a grid of PyVista")
    points, simplices = with_third(parts.points), parts.simplices
    rows = np.column_stack((np.full(len(simplices), simplices.shape[1]), simplices)).ravel()
    if kind == "tetrahedra":
        kinds = np.full(len(simplices), _TETRA, dtype=np.uint8)
        found = pyvista.UnstructuredGrid(rows, kinds, points)
    elif kind == "edges":
        found = pyvista.PolyData(points, lines=rows)
    else:
        found = pyvista.PolyData(points, faces=rows)
    for name, values in parts.of_points.items():
        found.point_data[name] = np.array(values)
    for name, values in parts.of_simplices.items():
        found.cell_data[name] = np.array(values)
    return found
