"""Polyhedra, such as Voronoi cells in 3-D, as PyVista and meshio meshes.

Each of the k polyhedra has its own points in the mesh, and a value, (k,), for each name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from delone._base.extras import require

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

__all__ = ["polyhedra_to_meshio", "polyhedra_to_pyvista"]

# VTK's number for polyhedra.
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
    """Return a `pyvista.UnstructuredGrid` with a cell for each polyhedron, in order."""
    pyvista = require("pyvista", extra="pyvista", what="polyhedra of cells")
    points: list[NDArray[np.float64]] = [np.empty((0, 3))]
    # VTK reads all cells as one stream of integers.
    stream: list[int] = []
    count = 0
    for cell in cells:
        faces = [len(cell.faces)]
        for face in cell.faces:
            faces += [len(face), *(np.asarray(face) + count).tolist()]
        stream += [len(faces), *faces]
        points.append(cell.vertices)
        count += len(cell.vertices)
    grid = pyvista.UnstructuredGrid(
        np.array(stream, dtype=np.int64),
        np.full(len(points) - 1, _POLYHEDRON, dtype=np.uint8),
        np.concatenate(points),
    )
    for name, each in (values or {}).items():
        grid.cell_data[name] = np.array(each)
    return grid


def polyhedra_to_meshio(
    cells: Iterable[Polyhedron], values: Mapping[str, Any] | None = None
) -> Any:
    """Return a `meshio.Mesh` with a block of cells for each number of corners, ascending."""
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
