"""The class TetMesh: tetrahedra with any boundary, which need not be Delaunay."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from delone import _core
from delone.counting import counted
from delone.errors import DtypeError
from delone.plane.topology import unjoined
from delone.tetmesh.report import CAUSES, COUNTS, ImproveReport
from delone.triangulation import Triangulation
from delone.validation import SpaceReport

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.exchange.parts import Parts

    Indices = NDArray[np.int32]

__all__ = ["TetMesh"]

_ANGLES = ("min_angle", "smallest_before", "smallest_after", "largest_before", "largest_after")
_HISTOGRAMS = ("bounds", "before", "after", "weights", "below")


class TetMeshReport(SpaceReport):
    """The result of ``TetMesh.validate()``: truthy if the mesh is correct."""

    _SUBJECT: ClassVar[str] = "a mesh of tetrahedra"


class TetMesh(Triangulation):
    """A tetrahedral mesh, created by `delone.improve`.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 3)
        The input points, row by row, some of them moved.
    simplices : ndarray of int32, shape (m, 4)
        The tetrahedra as rows of `points`, positively oriented.
    neighbors : ndarray of int32, shape (m, 4)
        ``neighbors[t, k]`` is the tetrahedron across the face opposite vertex k of tetrahedron t;
        -1 outside.
    region : ndarray of int32, shape (m,)
        The region of each tetrahedron.
    report : ImproveReport
        Changes by kind, angles before and after, and tetrahedra below the goal.

    Notes
    -----
    All arrays are read-only, and attributes cannot be set. The order of tetrahedra depends on
    coordinates only.

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

    __slots__ = ("_region", "_report")

    _ARRAYS = ("points", "simplices", "neighbors", "region")

    _region: Indices
    _report: ImproveReport

    def __init__(self, *given: Any, **options: Any) -> None:
        raise DtypeError("create a TetMesh with delone.improve(mesh), not with its class")

    @classmethod
    def _of(
        cls,
        arrays: dict[str, NDArray[Any]],
        report: ImproveReport,
        workers: int | None = None,
    ) -> Self:
        mesh = cls._from_arrays({name: arrays[name] for name in cls._ARRAYS}, {}, workers)
        object.__setattr__(mesh, "_report", report)
        return mesh

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._of, (self._arrays(), self._report, self._workers)

    def _saved(self) -> dict[str, NDArray[Any]]:
        report = self._report
        return self._arrays() | {
            "angles": np.array([getattr(report, name) for name in _ANGLES]),
            "counts": np.array([getattr(report, name) for name in COUNTS], dtype=np.int64),
            "cause": np.array([CAUSES.index(cause) for cause in report.cause], dtype=np.int64),
            **{name: getattr(report, name) for name in _HISTOGRAMS},
        }

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        counts: dict[str, Any] = dict(zip(COUNTS, arrays["counts"].tolist(), strict=True))
        counts["exhausted"] = bool(counts["exhausted"])
        angles: dict[str, Any] = dict(zip(_ANGLES, arrays["angles"].tolist(), strict=True))
        histograms: dict[str, Any] = {name: arrays[name] for name in _HISTOGRAMS}
        cause = np.array(CAUSES)[arrays["cause"]]
        report = ImproveReport(**angles, **counts, **histograms, cause=cause)
        return cls._of(arrays, report)

    @property
    def region(self) -> Indices:
        """The region of each tetrahedron, (m,); 0 if no regions were given."""
        return self._region

    @property
    def report(self) -> ImproveReport:
        """Changes by kind, angles before and after, and tetrahedra below the goal."""
        return self._report

    def validate(self) -> SpaceReport:
        """Prove that the tetrahedra fit each other, or list the faults.

        Returns
        -------
        SpaceReport
            Truthy if there are no faults: tetrahedra are positively oriented, no oriented face is
            used twice, so that two tetrahedra with a common face lie on its two sides, and
            these are neighbors of each other. Its other fields are empty: the tetrahedra need not
            be Delaunay.

        Notes
        -----
        Exact and linear. Overlaps between parts of a mesh without a common face are not detected.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> print(delone.improve(corner).validate())
        a mesh of tetrahedra
        """
        found = _core.validate3(self._points, self._simplices, self._neighbors)
        return TetMeshReport(
            orientation=found.orientation,
            facets=found.facets,
            neighbors=np.union1d(found.neighbors, unjoined(self._simplices, self._neighbors)),
        )

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the surface and the tetrahedra with small dihedral angles (extra ``pyvista``).

        Parameters
        ----------
        ax : pyvista.Plotter, optional
            Where to draw; by default a new plotter.
        **options
            As for `delone.plot.plot`; ``below`` is by default the goal of the report.

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
        return super().plot(ax, **{"below": self._report.min_angle} | options)

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        values = {"region": self._region, "smallest_dihedral": self.quality().smallest_dihedral}
        return Parts(self._points, self._simplices, of_simplices=values)

    def _described(self) -> str:
        return f"{counted(self.npoints, 'point')}: {counted(self.nsimplex, 'tetrahedron')}"
