"""Polygons, such as Voronoi cells in 2-D, as meshes of PyVista and meshio."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.exchange.parts import with_third
from delone.extras import require

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.integer[Any]]

__all__ = ["polygons_to_meshio", "polygons_to_pyvista"]


def polygons_to_pyvista(starts: Indices, corners: Floats, values: Mapping[str, Any]) -> Any:
    """Return polygons as a surface of PyVista.

    Parameters
    ----------
    starts : ndarray of int, shape (k + 1,)
        Where the corners of each polygon begin, and the end.
    corners : ndarray of float64, shape (c, 2)
        Their corners; each polygon has points of its own.
    values : mapping of str to array_like, shape (k,)
        Values of the polygons.

    Returns
    -------
    pyvista.PolyData
        The polygons in the plane z = 0, in order.

    Raises
    ------
    MissingExtraError
        pyvista is not installed (extra ``pyvista``).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.exchange.polygons import polygons_to_pyvista
    >>> square = np.array([(0.0, 0.0), (1, 0), (1, 1), (0, 1)])
    >>> polygons_to_pyvista(np.array([0, 4]), square, {"site": [7]}).n_cells
    1
    """
    pyvista = require("pyvista", extra="pyvista", what="polygons of cells")
    # VTK takes all faces in one stream: the number of corners, then the corners.
    stream = np.insert(np.arange(len(corners)), starts[:-1], np.diff(starts))
    found = (
        pyvista.PolyData(with_third(corners), faces=stream) if len(stream) else pyvista.PolyData()
    )
    for name, each in values.items():
        found.cell_data[name] = np.array(each)
    return found


def polygons_to_meshio(starts: Indices, corners: Floats, values: Mapping[str, Any]) -> Any:
    """Return polygons as a mesh of meshio.

    Parameters
    ----------
    starts : ndarray of int, shape (k + 1,)
        Where the corners of each polygon begin, and the end.
    corners : ndarray of float64, shape (c, 2)
        Their corners; each polygon has points of its own.
    values : mapping of str to array_like, shape (k,)
        Values of the polygons.

    Returns
    -------
    meshio.Mesh
        In the plane z = 0. There is a block of cells for each number of corners, ascending;
        polygons are in order within a block.

    Raises
    ------
    MissingExtraError
        meshio is not installed (extra ``mesh``).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.exchange.polygons import polygons_to_meshio
    >>> square = np.array([(0.0, 0.0), (1, 0), (1, 1), (0, 1)])
    >>> polygons_to_meshio(np.array([0, 4]), square, {"site": [7]}).cells
    [<meshio CellBlock, type: polygon, num cells: 1, tags: []>]
    """
    meshio = require("meshio", extra="mesh", what="polygons of cells")
    sizes = np.diff(starts)
    groups = [np.flatnonzero(sizes == size) for size in np.unique(sizes)]
    blocks = [("polygon", starts[:-1][rows, None] + np.arange(sizes[rows[0]])) for rows in groups]
    data = {name: [np.asarray(each)[rows] for rows in groups] for name, each in values.items()}
    return meshio.Mesh(with_third(corners), blocks, cell_data=data)
