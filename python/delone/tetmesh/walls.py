"""What `improve` keeps of a mesh with input faces: the core keeps faces between labels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone.space.locking import cells, sides

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._types import Indices
    from delone.tetmesh.tetmesh import TetMesh

__all__ = ["Kept"]


class Kept(NamedTuple):
    """Labels under which no input face can be lost."""

    mesh: TetMesh
    labels: Indices
    # The caller's label of each of these.
    own: Indices

    @classmethod
    def of(cls, mesh: TetMesh, labels: Indices) -> Kept:
        """Return a label for each cell and region, and one for each tetrahedron at some sheets.

        A face inside of a cell has that cell on both sides: the tetrahedron on one side gets a
        label of its own.
        """
        face = sides(mesh.simplices, mesh.input_faces, mesh.npoints).face
        cell = cells(mesh.neighbors, face >= 0)
        beyond = np.where(mesh.neighbors < 0, np.int32(-1), cell[mesh.neighbors])
        tetrahedron, corner = np.nonzero((face >= 0) & (beyond == cell[:, None]))
        _, first = np.unique(face[tetrahedron, corner], return_index=True)
        alone = np.unique(tetrahedron[first])
        key = cell.astype(np.int64)
        key[alone] = int(cell.max(initial=0)) + 1 + np.arange(len(alone))
        _, first, found = np.unique(
            np.column_stack((labels, key)), axis=0, return_index=True, return_inverse=True
        )
        return cls(mesh, found.reshape(-1).astype(np.int32), labels[first])

    def arrays(self, labels: Indices) -> dict[str, NDArray[Any]]:
        """Return the arrays of the improved mesh whose tetrahedra have these labels."""
        mesh = self.mesh
        return {
            "region": self.own[labels],
            "input_faces": mesh.input_faces,
            "face_source": mesh.face_source,
            "face_markers": mesh.face_markers,
        }
