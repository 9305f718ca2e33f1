"""The report of a tetrahedralization: what was added, and which faces were changed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from delone._base.counting import agreed, counted, listed
from delone._base.immutable import ReadOnly

if TYPE_CHECKING:
    from delone._base.types import Rows

__all__ = ["RECOVERY_COUNTS", "RECOVERY_ROWS", "RecoveryReport"]

# The fields of a report that are counts, and those that are arrays.
RECOVERY_COUNTS = (
    "nadded",
    "missing_edges",
    "missing_faces",
    "flips",
    "flipped_edges",
    "flipped_faces",
    "segment_points",
    "face_points",
    "suppressed",
    "joined",
    "thinned",
)
RECOVERY_ROWS = (
    "duplicate_points",
    "subdivided",
    "repeated",
    "degenerate",
    "dangling",
    "outside",
    "recut",
    "recut_source",
    "imprinted",
)
_SHOWN = 5


@dataclass(frozen=True, eq=False, kw_only=True)
class RecoveryReport(ReadOnly):
    """The report of `delone.tetrahedralize`; truthy if each input face is one face of the mesh.

    Parameters
    ----------
    nadded : int
        Number of points added, strictly between the faces.
    missing_edges, missing_faces : int
        Number of edges and faces of the surface that the Delaunay triangulation of its vertices
        lacks.
    flips : int
        Number of flips that recovered some of them.
    flipped_edges, flipped_faces : int
        Number of edges and faces recovered by flips.
    segment_points, face_points : int
        Number of points that were temporarily on edges and faces.
    suppressed : int
        Number of points that replaced them, strictly between the faces.
    joined : int
        Number of places where no point was needed.
    thinned : int
        Number of added points that were removed again.
    duplicate_points : ndarray of int64, shape (k, 2)
        Rows of points with the coordinates of earlier rows, and those rows.
    subdivided : ndarray of int64, shape (k,)
        Input faces that are unions of faces of the mesh, because vertices or edges of other faces
        lie on them.
    repeated : ndarray of int64, shape (k,)
        Input faces that are covered by earlier ones.
    degenerate : ndarray of int64, shape (k,)
        Input faces without area.
    dangling : ndarray of int64, shape (k,)
        Input faces of which a part has the same region on both sides.
    outside : ndarray of int64, shape (k,)
        Input faces without a tetrahedron on either side, at least in part: they are outside, or
        between parts that are left out.
    recut : ndarray of int64, shape (k, 3)
        With ``boundary="surface"``, triangles that were replaced by others in the same plane: input
        faces or parts of them, as rows of points.
    recut_source : ndarray of int64, shape (k, 2)
        The input face of each of these, and the `face_source` of the faces that replace them. The
        triangles and the faces with the same value have the same union.
    imprinted : ndarray of int64, shape (k,)
        With ``imprint=True``, the input face that each face of the cut surface is a part of;
        otherwise empty. All other rows of faces here refer to the cut surface.
    imprint_distance : float
        The largest distance of the cut surface from the input.

    Attributes
    ----------
    ok : bool
        True if each input face is one face of the mesh.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    >>> print(delone.tetrahedralize(points, faces).report)
    0 points added
    each input face is a face of the mesh
    """

    nadded: int
    missing_edges: int
    missing_faces: int
    flips: int
    flipped_edges: int
    flipped_faces: int
    segment_points: int
    face_points: int
    suppressed: int
    joined: int
    thinned: int
    duplicate_points: Rows
    subdivided: Rows
    repeated: Rows
    degenerate: Rows
    dangling: Rows
    outside: Rows
    recut: Rows
    recut_source: Rows
    imprinted: Rows = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    imprint_distance: float = 0.0

    @property
    def ok(self) -> bool:
        """True if each input face is one face of the mesh."""
        changed = (self.subdivided, self.repeated, self.degenerate, self.outside, self.recut)
        return not any(map(len, changed))

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        lines = [f"{counted(self.nadded, 'point')} added"]
        if len(self.imprinted):
            lines.append(
                f"faces cut at each other: {len(self.imprinted):,} parts, at most "
                f"{self.imprint_distance:.2g} from the input"
            )
        if self.missing_edges or self.missing_faces:
            lines.append(
                f"the Delaunay triangulation lacks {counted(self.missing_edges, 'edge')} and "
                f"{counted(self.missing_faces, 'face')}; {counted(self.flips, 'flip')}"
            )
        if len(self.duplicate_points):
            count = len(self.duplicate_points)
            lines.append(
                f"{counted(count, 'point')} with the coordinates of others: "
                f"{listed(self.duplicate_points[:, 0], _SHOWN)}"
            )
        face = "part" if len(self.imprinted) else "input face"
        lines += [
            f"{counted(len(rows), face)} {agreed(len(rows), *words)}: {listed(rows, _SHOWN)}"
            for rows, words in self._sentences()
            if len(rows)
        ]
        if self.ok:
            lines.append(f"each {face} is a face of the mesh")
        return "\n".join(lines)

    def _sentences(self) -> list[tuple[Rows, tuple[str, str]]]:
        union = "a union of faces of the mesh", "unions of faces of the mesh"
        return [
            (self.subdivided, (f"is {union[0]}", f"are {union[1]}")),
            (np.unique(self.recut_source[:, 0]), ("cut again", "cut again")),
            (self.repeated, ("is covered by earlier ones", "are covered by earlier ones")),
            (self.degenerate, ("without area", "without area")),
            (self.dangling, ("inside a region", "inside a region")),
            (self.outside, ("outside the mesh", "outside the mesh")),
        ]
