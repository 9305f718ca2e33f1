"""What `read_mesh` returns: the triangles or tetrahedra of a file, and what belongs to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from delone._base.counting import counted

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["MeshFile"]


@dataclass(frozen=True, eq=False, kw_only=True)
class MeshFile:
    """The triangles or tetrahedra of a file, not validated.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Horizontal coordinates; for tetrahedra all three, (n, 3).
    simplices : ndarray of int32, shape (m, 3)
        Triangles; (m, 4) for tetrahedra.
    neighbors : ndarray of int32, of the same shape, optional
        The simplex opposite each vertex; None if the format does not store them.
    z : ndarray of float64, shape (n,), optional
        Heights.
    source : str, optional
        The file.
    markers : ndarray of int32, shape (m,), optional
        A number for each triangle of a surface: in TetGen's formats, the references in MESH, the
        physical groups in MSH (the first one of a triangle; a name such as "marker 7" or "region 7"
        gives 7), and VTK and VTU cell values named marker.
    holes : ndarray of float64, shape (k, 3), optional
        Points in holes, in .poly and .smesh.
    regions : ndarray of float64, shape (k, 4), optional
        Points in regions, and their numbers, in .poly and .smesh.
    region : ndarray of int32, shape (m,), optional
        A number for each tetrahedron: VTK and VTU cell values named region, the references in MESH,
        the physical groups in MSH (as for markers; 0 without a group), the first attribute in
        TetGen's ELE if it consists of integers, and that of a `TetMesh` in npz.
    faces : ndarray of int32, shape (f, 3), optional
        The triangles of a file of tetrahedra: faces of the input, or of the boundary.
    face_markers : ndarray of int32, shape (f,), optional
        A number for each of these faces, from the same places as `markers`.

    Examples
    --------
    See `read_mesh`.
    """

    points: NDArray[np.float64]
    simplices: NDArray[np.int32]
    neighbors: NDArray[np.int32] | None = None
    z: NDArray[np.float64] | None = None
    source: str = ""
    markers: NDArray[np.int32] | None = None
    holes: NDArray[np.float64] | None = None
    regions: NDArray[np.float64] | None = None
    region: NDArray[np.int32] | None = None
    faces: NDArray[np.int32] | None = None
    face_markers: NDArray[np.int32] | None = None

    def __repr__(self) -> str:
        kind = "triangle" if self.simplices.shape[1] == 3 else "tetrahedron"
        points, simplices = len(self.points), len(self.simplices)
        return f"<MeshFile of {counted(points, 'point')}: {counted(simplices, kind)}>"
