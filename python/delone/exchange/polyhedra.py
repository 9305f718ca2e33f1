"""Polyhedra, such as Voronoi cells in 3-D, as meshes of PyVista and meshio."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from delone.extras import require

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

__all__ = ["polyhedra_to_meshio", "polyhedra_to_pyvista"]

# VTK's number of a polyhedron.
_POLYHEDRON = 42


class Polyhedron(Protocol):
    """Corners, and faces as rows of them."""

    @property
    def vertices(self) -> NDArray[np.float64]:
        """The corners, (c, 3)."""

    @property
    def faces(self) -> Sequence[NDArray[Any]]:
        """The corners of each face in order, as rows of `vertices`."""


def polyhedra_to_pyvista(
    cells: Iterable[Polyhedron], values: Mapping[str, Any] | None = None
) -> Any:
    """Return polyhedra as a grid of PyVista.

    Parameters
    ----------
    cells : iterable of objects with ``vertices`` and ``faces``
        The polyhedra. Each has points of its own in the grid.
    values : mapping of str to array_like, shape (k,), optional
        Values of the polyhedra.

    Returns
    -------
    pyvista.UnstructuredGrid
        A cell for each polyhedron, in order.

    Raises
    ------
    MissingExtraError
        pyvista is not installed (extra ``pyvista``).

    Examples
    --------
    >>> from delone import Voronoi
    >>> from delone.exchange.polyhedra import polyhedra_to_pyvista
    >>> sites = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]
    >>> cell = Voronoi(sites, clip=((0, 0, 0), (2, 2, 2))).cell(0)
    >>> grid = polyhedra_to_pyvista([cell])
    >>> grid.n_cells, grid.n_points
    (1, 8)
    """
    pyvista = require("pyvista", extra="pyvista", what="polyhedra of cells")
    points: list[NDArray[np.float64]] = [np.empty((0, 3))]
    # VTK takes all cells in one stream of integers.
    stream: list[int] = []
    count = kinds = 0
    for cell in cells:
        faces = [len(cell.faces)]
        for face in cell.faces:
            faces += [len(face), *(np.asarray(face) + count).tolist()]
        stream += [len(faces), *faces]
        points.append(cell.vertices)
        count += len(cell.vertices)
        kinds += 1
    grid = pyvista.UnstructuredGrid(
        np.array(stream, dtype=np.int64),
        np.full(kinds, _POLYHEDRON, dtype=np.uint8),
        np.concatenate(points),
    )
    for name, each in (values or {}).items():
        grid.cell_data[name] = np.array(each)
    return grid


def polyhedra_to_meshio(
    cells: Iterable[Polyhedron], values: Mapping[str, Any] | None = None
) -> Any:
    """Return polyhedra as a mesh of meshio.

    Parameters
    ----------
    cells : iterable of objects with ``vertices`` and ``faces``
        The polyhedra. Each has points of its own in the mesh.
    values : mapping of str to array_like, shape (k,), optional
        Values of the polyhedra.

    Returns
    -------
    meshio.Mesh
        There is a block of cells for each number of corners, ascending; polyhedra are in order
        within a block.

    Raises
    ------
    MissingExtraError
        meshio is not installed (extra ``mesh``).

    Examples
    --------
    >>> from delone import Voronoi
    >>> from delone.exchange.polyhedra import polyhedra_to_meshio
    >>> sites = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]
    >>> cell = Voronoi(sites, clip=((0, 0, 0), (2, 2, 2))).cell(0)
    >>> polyhedra_to_meshio([cell]).cells
    [<meshio CellBlock, type: polyhedron8, num cells: 1, tags: []>]
    """
    meshio = require("meshio", extra="mesh", what="polyhedra of cells")
    points: list[NDArray[np.float64]] = [np.empty((0, 3))]
    blocks: dict[int, list[list[NDArray[Any]]]] = {}
    rows: dict[int, list[int]] = {}
    count = 0
    for row, cell in enumerate(cells):
        size = len(cell.vertices)
        blocks.setdefault(size, []).append([np.asarray(face) + count for face in cell.faces])
        rows.setdefault(size, []).append(row)
        points.append(cell.vertices)
        count += size
    return meshio.Mesh(
        np.concatenate(points),
        [(f"polyhedron{size}", blocks[size]) for size in sorted(blocks)],
        cell_data={
            name: [np.asarray(each)[rows[size]] for size in sorted(rows)]
            for name, each in (values or {}).items()
        },
    )
