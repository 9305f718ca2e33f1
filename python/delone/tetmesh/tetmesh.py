"""The class TetMesh: tetrahedra with any boundary, which need not be Delaunay."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone.counting import counted
from delone.immutable import made_by
from delone.tetmesh.planes import differing
from delone.tetmesh.recovery import RECOVERY_COUNTS, RECOVERY_ROWS, RecoveryReport
from delone.tetmesh.report import CAUSES, COUNTS, ImproveReport
from delone.tetmesh.validation import TetMeshReport, faults
from delone.triangulation import Triangulation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._types import Floats, Indices
    from delone.exchange.parts import Parts

__all__ = ["TetMesh"]

_ANGLES = ("min_angle", "smallest_before", "smallest_after", "largest_before", "largest_after")
_HISTOGRAMS = ("bounds", "before", "after", "weights", "below")
_NO_ROWS = np.empty(0, dtype=np.int32)
_NOTHING: dict[str, NDArray[Any]] = {
    "input_faces": np.empty((0, 3), dtype=np.int32),
    "face_source": _NO_ROWS,
    "face_markers": _NO_ROWS,
    "holes": np.empty((0, 3)),
}
_NO_COUNTS = np.empty(0, dtype=np.int64)
_NO_NUMBERS = np.empty(0)
# What a file has of the report that there is not.
_UNIMPROVED: dict[str, NDArray[Any]] = {
    **dict.fromkeys(("angles", "bounds", "weights"), _NO_NUMBERS),
    **dict.fromkeys(("counts", "before", "after", "below", "cause"), _NO_COUNTS),
}
_UNRECOVERED: dict[str, NDArray[Any]] = {
    "recovery": _NO_COUNTS,
    **dict.fromkeys(RECOVERY_ROWS, _NO_COUNTS),
    "duplicate_points": np.empty((0, 2), dtype=np.int64),
    "recut": np.empty((0, 3), dtype=np.int64),
    "recut_source": np.empty((0, 2), dtype=np.int64),
}


@made_by(
    "create a TetMesh with delone.tetrahedralize(points, faces) or delone.improve(mesh), not with "
    "its class"
)
class TetMesh(Triangulation):
    """A tetrahedral mesh, created by `delone.tetrahedralize` or `delone.improve`.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 3)
        The input points, row by row, then those that were added. `improve` moves some of them.
    simplices : ndarray of int32, shape (m, 4)
        The tetrahedra as rows of `points`, positively oriented.
    neighbors : ndarray of int32, shape (m, 4)
        ``neighbors[t, k]`` is the tetrahedron across the face opposite vertex k of tetrahedron t;
        -1 outside.
    region : ndarray of int32, shape (m,)
        The region of each tetrahedron.
    input_faces : ndarray of int32, shape (k, 3)
        The triangles of the surface, which are faces of tetrahedra, oriented as in the input.
    face_source : ndarray of int32, shape (k,)
        The row of the input face that each of these is, or is a part of; of faces that were cut
        again, one in the same plane part (see `RecoveryReport`).
    face_markers : ndarray of int32, shape (k,)
        The marker of that input face.
    holes : ndarray of float64, shape (h, 3)
        A point in each region that these faces enclose and that is left empty.
    nadded : int
        The number of points that `tetrahedralize` added; they are the last rows.
    report : RecoveryReport or ImproveReport
        What `tetrahedralize` added, or what `improve` changed.

    Notes
    -----
    All arrays are read-only, and attributes cannot be set. The order of tetrahedra depends on
    coordinates only. Without a surface, as for ``improve`` of a `Delaunay`, there are no
    `input_faces`. The tetrahedra need not be Delaunay.

    Examples
    --------
    >>> import delone
    >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
    >>> mesh = delone.improve(corner)
    >>> mesh
    <TetMesh of 4 points: 1 tetrahedron>
    >>> mesh.boundary.shape, mesh.volumes
    ((4, 3), array([0.16666667]))
    """

    __slots__ = (
        "_face_markers",
        "_face_source",
        "_holes",
        "_input_faces",
        "_nadded",
        "_region",
        "_report",
    )

    _ARRAYS = (
        "points",
        "simplices",
        "neighbors",
        "region",
        "input_faces",
        "face_source",
        "face_markers",
        "holes",
    )

    _face_markers: Indices
    _face_source: Indices
    _holes: Floats
    _input_faces: Indices
    _nadded: int
    _region: Indices
    _report: ImproveReport | RecoveryReport

    @classmethod
    def _of(
        cls,
        arrays: dict[str, NDArray[Any]],
        report: ImproveReport | RecoveryReport,
        nadded: int = 0,
        workers: int | None = None,
    ) -> Self:
        """Return the mesh of arrays; without `input_faces` if these are left out."""
        given = _NOTHING | arrays
        mesh = cls._from_arrays({name: given[name] for name in cls._ARRAYS}, {}, workers)
        object.__setattr__(mesh, "_report", report)
        object.__setattr__(mesh, "_nadded", nadded)
        return mesh

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._of, (self._arrays(), self._report, self._nadded, self._workers)

    def _saved(self) -> dict[str, NDArray[Any]]:
        report = self._report
        added = np.array([self._nadded], dtype=np.int64)
        if isinstance(report, RecoveryReport):
            return self._arrays() | _UNIMPROVED | _saved_recovery(report) | {"added": added}
        return (
            self._arrays()
            | _UNRECOVERED
            | {
                "added": added,
                "angles": np.array([getattr(report, name) for name in _ANGLES]),
                "counts": np.array([getattr(report, name) for name in COUNTS], dtype=np.int64),
                "cause": np.array([CAUSES.index(cause) for cause in report.cause], dtype=np.int64),
                **{name: getattr(report, name) for name in _HISTOGRAMS},
            }
        )

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        nadded = int(arrays["added"][0])
        if len(arrays["recovery"]):
            return cls._of(arrays, _loaded_recovery(arrays), nadded)
        counts: dict[str, Any] = dict(zip(COUNTS, arrays["counts"].tolist(), strict=True))
        counts["exhausted"] = bool(counts["exhausted"])
        angles: dict[str, Any] = dict(zip(_ANGLES, arrays["angles"].tolist(), strict=True))
        histograms: dict[str, Any] = {name: arrays[name] for name in _HISTOGRAMS}
        cause = np.array(CAUSES)[arrays["cause"]]
        report = ImproveReport(**angles, **counts, **histograms, cause=cause)
        return cls._of(arrays, report, nadded)

    @property
    def region(self) -> Indices:
        """The region of each tetrahedron, (m,)."""
        return self._region

    @property
    def input_faces(self) -> Indices:
        """The triangles of the surface as rows of `points`, (k, 3), oriented as in the input."""
        return self._input_faces

    @property
    def face_source(self) -> Indices:
        """The input face that each of `input_faces` is, or is a part of, (k,)."""
        return self._face_source

    @property
    def face_markers(self) -> Indices:
        """The marker of each of `input_faces`, (k,); 0 if no markers were given."""
        return self._face_markers

    @property
    def holes(self) -> Floats:
        """A point in each region that faces enclose and that is left empty, (h, 3)."""
        return self._holes

    @property
    def nadded(self) -> int:
        """The number of points that `tetrahedralize` added, the last rows of `points`."""
        return self._nadded

    @property
    def report(self) -> ImproveReport | RecoveryReport:
        """What `tetrahedralize` added, or what `improve` changed."""
        return self._report

    def validate(self) -> TetMeshReport:
        """Prove that the tetrahedra fit each other and the surface, or list the faults.

        Returns
        -------
        TetMeshReport
            Truthy if there are no faults: tetrahedra are positively oriented, no oriented face is
            used twice, so that two tetrahedra with a common face lie on its two sides, and
            these are neighbors of each other. If there are `input_faces`, each is a face of a
            tetrahedron, each face of the boundary is one of them, the boundary neither crosses nor
            touches itself, and the volume of the tetrahedra equals the volume that it encloses.
            Faces that were cut again cover what they replace.

        Notes
        -----
        Exact: volumes are compared as integers. With `input_faces` this is a proof that the
        tetrahedra do not overlap and fill what the boundary encloses. Otherwise, overlaps between
        parts of a mesh without a common face are not detected. The time is linear, up to a
        logarithm. Tetrahedra need not be Delaunay.

        Examples
        --------
        >>> import delone
        >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        >>> faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
        >>> print(delone.tetrahedralize(points, faces).validate())
        a mesh of tetrahedra
        """
        found = faults(self._points, self._simplices, self._neighbors, self._input_faces)
        if isinstance(self._report, RecoveryReport) and len(self._report.recut):
            given = self._report.recut, self._report.recut_source[:, 1]
            wrong = differing(self._points, given, (self._input_faces, self._face_source))
            found = replace(found, uncovered=wrong)
        return found

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the surface and the tetrahedra with small dihedral angles (extra ``pyvista``).

        Parameters
        ----------
        ax : pyvista.Plotter, optional
            Where to draw; by default a new plotter.
        **options
            As for `delone.plot.plot`; after `improve`, ``below`` is by default the goal.

        Returns
        -------
        pyvista.Plotter
            The plotter; ``show()`` displays it.

        Raises
        ------
        MissingExtraError
            PyVista is not installed.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).plot().show()  # doctest: +SKIP
        """
        goal = getattr(self._report, "min_angle", None)
        return super().plot(ax, **({} if goal is None else {"below": goal}) | options)

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        values = {"region": self._region, "smallest_dihedral": self.quality().smallest_dihedral}
        found = Parts(self._points, self._simplices, of_simplices=values)
        if not len(self.input_faces) or not self.face_markers.any():
            return found
        return found._replace(segments=self.input_faces, of_segments={"marker": self.face_markers})

    def _described(self) -> str:
        return f"{counted(self.npoints, 'point')}: {counted(self.nsimplex, 'tetrahedron')}"


def _saved_recovery(report: RecoveryReport) -> dict[str, NDArray[Any]]:
    counts = np.array([getattr(report, name) for name in RECOVERY_COUNTS], dtype=np.int64)
    return {"recovery": counts} | {name: getattr(report, name) for name in RECOVERY_ROWS}


def _loaded_recovery(arrays: dict[str, NDArray[Any]]) -> RecoveryReport:
    counts: dict[str, Any] = dict(zip(RECOVERY_COUNTS, arrays["recovery"].tolist(), strict=True))
    rows: dict[str, Any] = {name: arrays[name] for name in RECOVERY_ROWS}
    return RecoveryReport(**counts, **rows)
