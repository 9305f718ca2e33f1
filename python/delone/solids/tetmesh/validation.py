"""Exact validation of tetrahedra with a boundary of given triangles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.blocks import blocks
from delone._tiling.plane.topology import unjoined
from delone._tiling.space.locking import sides
from delone._tiling.space.topology import boundary_faces
from delone.validation import SpaceReport, fault

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["TetMeshReport", "faults", "six_volumes"]


@dataclass(frozen=True, eq=False, kw_only=True)
class TetMeshReport(SpaceReport):
    """The result of ``TetMesh.validate()``: truthy if the mesh is correct.

    The fields are those of `SpaceReport`, of which only `orientation`, `facets` and `neighbors` are
    used: the tetrahedra need not be Delaunay. Further fields:

    Parameters
    ----------
    lost : ndarray of int, shape (k,)
        Rows of `input_faces` that are not faces of a tetrahedron.
    walls : ndarray of int, shape (k,)
        Tetrahedra with a face on the boundary that is not one of `input_faces`.
    touching : ndarray of int, shape (k,)
        Faces of the boundary, as rows of ``boundary``, that cross or touch others other than at
        vertices and edges.
    volume : ndarray of int, shape (1,) or (0,)
        The sign of the volume of the tetrahedra minus that inside the boundary, if not 0.
    uncovered : ndarray of int, shape (k,)
        Values of `face_source` whose faces do not cover the triangles that they replace.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    >>> delone.tetrahedralize(points, faces).validate().lost
    array([], dtype=int64)
    """

    lost: NDArray[np.integer] = fault(
        "input face is not a face of a tetrahedron", "input faces are not faces of tetrahedra"
    )
    walls: NDArray[np.integer] = fault(
        "tetrahedron has a boundary face that is not in the input",
        "tetrahedra have boundary faces that are not in the input",
    )
    touching: NDArray[np.integer] = fault(
        "face of the boundary crosses or touches others",
        "faces of the boundary cross or touch others",
    )
    volume: NDArray[np.integer] = fault(
        "sign of the difference of volumes is not 0",
        "signs of the differences of volumes are not 0",
    )
    uncovered: NDArray[np.integer] = fault(
        "part in one plane is not covered by its faces",
        "parts in one plane are not covered by their faces",
    )

    _SUBJECT: ClassVar[str] = "a mesh of tetrahedra"


def faults(
    points: Floats, simplices: Indices, neighbors: Indices, input_faces: Indices
) -> TetMeshReport:
    """Check tetrahedra, and the surface where there are input faces."""
    found = _core.validate(points, simplices, neighbors)
    wrong = np.union1d(found.neighbors, unjoined(simplices, neighbors))
    tiling = {"orientation": found.orientation, "facets": found.facets, "neighbors": wrong}
    if not len(input_faces):
        return TetMeshReport(**tiling)
    face = sides(simplices, input_faces, len(points)).face
    lost = np.ones(len(input_faces), dtype=bool)
    lost[face[face >= 0]] = False
    boundary = boundary_faces(simplices, neighbors)
    pairs = _core.check_surface3(points, boundary, len(boundary), as_workers(None)).pairs
    difference = six_volumes(points, simplices) - six_volumes(points, boundary)
    return TetMeshReport(
        **tiling,
        lost=np.flatnonzero(lost),
        walls=np.flatnonzero(((face < 0) & (neighbors < 0)).any(axis=1)),
        touching=np.unique(pairs.faces),
        volume=np.array([] if difference == 0 else [1 if difference > 0 else -1], dtype=np.int64),
    )


def six_volumes(points: Floats, simplices: Indices) -> int:
    """Return the sum of 6 times the signed volumes of tetrahedra, or of what triangles enclose.

    The unit is a power of two that depends on the points only. Triangles make tetrahedra with the
    origin, on whose side their normals do not point.
    """
    # Doubles are integers of 53 bits times a power of two; the unit is the least of these.
    fraction, exponent = np.frexp(points)
    least = int(exponent[points != 0].min(initial=0))
    bits = (fraction * 2.0**53).astype(np.int64).astype(object)
    shift = np.where(points != 0, exponent - least, 0).astype(object)
    whole = np.left_shift(bits, shift)
    # Python's integers take memory, and a long array operation cannot be interrupted.
    return sum(_six_volumes(whole, simplices[block]) for block in blocks(len(simplices)))


def _six_volumes(whole: NDArray[np.object_], simplices: Indices) -> int:
    """Return the sum for points of integers."""
    corners = whole[simplices]
    if simplices.shape[1] == 3:
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    else:
        d = corners[:, 3]
        # Seen from the last corner, the others are clockwise.
        a, c, b = corners[:, 0] - d, corners[:, 1] - d, corners[:, 2] - d
    normal = np.stack(
        [b[:, i] * c[:, j] - b[:, j] * c[:, i] for i, j in ((1, 2), (2, 0), (0, 1))], axis=1
    )
    return int((a * normal).sum())
