"""PyVista surfaces and grids."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.exchange.parts import kind_of, parts_of, with_third
from delone.exchange.second import as_order, of_order

if TYPE_CHECKING:
    from delone.exchange.parts import Given

__all__ = ["to_pyvista"]

# VTK's numbers for tetrahedra, and for edges, triangles and tetrahedra of second order.
_TETRA = 10
_SECOND = {"edges": 21, "triangles": 22, "surface": 22, "tetrahedra": 24}


def to_pyvista(mesh: Given, *, order: int = 1) -> Any:
    """Return a PolyData of triangles (2-D at z = 0) or edges, an UnstructuredGrid of tetrahedra.

    They contain the values of points and simplices; segments are left out. With ``order=2``, all
    are an UnstructuredGrid.
    """
    pyvista = require("pyvista", extra="pyvista", what="to_pyvista")
    parts = parts_of(mesh)
    kind = kind_of(parts, what="a grid of PyVista")
    parts = of_order(parts, as_order(order))
    points, simplices = with_third(parts.points), parts.simplices
    rows = np.column_stack((np.full(len(simplices), simplices.shape[1]), simplices)).ravel()
    if kind == "tetrahedra" or parts.order == 2:
        number = _TETRA if parts.order == 1 else _SECOND[kind]
        kinds = np.full(len(simplices), number, dtype=np.uint8)
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
