"""What `improve` keeps of a mesh with input faces: the core keeps faces between labels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._tiling.space.locking import cells, sides

if TYPE_CHECKING:
    from delone._base.types import Indices

__all__ = ["Kept"]


class Kept(NamedTuple):
    """Labels under which no input face can be lost."""

    labels: Indices
    # The caller's label of each of these.
    own: Indices

    @classmethod
    def of_mesh(cls, mesh: Any) -> Kept:
        """Return the labels of a TetMesh."""
        if len(mesh.input_faces):
            return cls.of(mesh.simplices, mesh.neighbors, mesh.input_faces, mesh.region)
        own, labels = np.unique(mesh.region, return_inverse=True)
        return cls(labels.reshape(-1).astype(np.int32), own)

    @classmethod
    def of(cls, simplices: Indices, neighbors: Indices, faces: Indices, labels: Indices) -> Kept:
        """Return a label for each cell and region, and one for each tetrahedron at some sheets.

        A face inside a cell has that cell on both sides: the tetrahedron on one side gets its own
        label.
        """
        face = sides(simplices, faces, int(simplices.max()) + 1).face
        cell = cells(neighbors, face >= 0)
        beyond = np.where(neighbors < 0, np.int32(-1), cell[neighbors])
        tetrahedron, corner = np.nonzero((face >= 0) & (beyond == cell[:, None]))
        _, first = np.unique(face[tetrahedron, corner], return_index=True)
        alone = np.unique(tetrahedron[first])
        key = cell.astype(np.int64)
        key[alone] = int(cell.max(initial=0)) + 1 + np.arange(len(alone))
        _, first, found = np.unique(
            np.column_stack((labels, key)), axis=0, return_index=True, return_inverse=True
        )
        return cls(found.reshape(-1).astype(np.int32), labels[first])
