"""Polygons, such as Voronoi cells in 2-D, as PyVista and meshio meshes in the plane z = 0.

Their corners, (c, 2), are given one polygon after another; `starts`, (k + 1,), tells where those of
each begin, and the end. Each polygon has its own points, and a value, (k,), for each name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.exchange.parts import with_third

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from delone._base.types import Floats

    Indices = NDArray[np.integer[Any]]

__all__ = ["polygons_to_meshio", "polygons_to_pyvista"]


def polygons_to_pyvista(starts: Indices, corners: Floats, values: Mapping[str, Any]) -> Any:
    """Return a `pyvista.PolyData` of the polygons in order."""
    pyvista = require("pyvista", extra="pyvista", what="polygons of cells")
    # VTK reads all faces as one stream: the number of corners, then the corners.
    stream = np.insert(np.arange(len(corners)), starts[:-1], np.diff(starts))
    found = (
        pyvista.PolyData(with_third(corners), faces=stream) if len(stream) else pyvista.PolyData()
    )
    for name, each in values.items():
        found.cell_data[name] = np.array(each)
    return found


def polygons_to_meshio(starts: Indices, corners: Floats, values: Mapping[str, Any]) -> Any:
    """Return a `meshio.Mesh` with a block of cells for each number of corners, ascending."""
    meshio = require("meshio", extra="mesh", what="polygons of cells")
    sizes = np.diff(starts)
    groups = [np.flatnonzero(sizes == size) for size in np.unique(sizes)]
    blocks = [("polygon", starts[:-1][rows, None] + np.arange(sizes[rows[0]])) for rows in groups]
    data = {name: [np.asarray(each)[rows] for rows in groups] for name, each in values.items()}
    return meshio.Mesh(with_third(corners), blocks, cell_data=data)
