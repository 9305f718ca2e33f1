"""The class TetMesh: tetrahedra with any boundary, which need not be Delaunay."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.counting import counted
from delone._base.immutable import made_by
from delone._tiling.triangulation import Triangulation
from delone.solids.tetmesh import saving
from delone.solids.tetmesh.planes import differing
from delone.solids.tetmesh.refinement import as_bounds, refined
from delone.solids.tetmesh.relaxing import coarsened, smoothed
from delone.solids.tetmesh.validation import TetMeshReport, faults

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.exchange.parts import Parts
    from delone.solids.tetmesh.saving import Report

__all__ = ["TetMesh"]

_NO_ROWS = np.empty(0, dtype=np.int32)
_NOTHING: dict[str, NDArray[Any]] = {
    "input_faces": np.empty((0, 3), dtype=np.int32),
    "face_source": _NO_ROWS,
    "face_markers": _NO_ROWS,
    "holes": np.empty((0, 3)),
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
        The input points, row by row, then those that were added. `improve` and `smooth` move some
        of them.
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
        The row of the input face that each of these is or is part of; for retriangulated faces, a
        row of the same flat part (see `RecoveryReport`).
    face_markers : ndarray of int32, shape (k,)
        The marker of that input face.
    holes : ndarray of float64, shape (h, 3)
        A point in each region that these faces enclose and that is empty.
    nadded : int
        The number of points that `tetrahedralize`, `refine` and `improve` added, without those that
        were removed again; they are the last rows.
    report : RecoveryReport, ImproveReport or RefinementReport
        What `tetrahedralize` added, or what `improve`, `refine`, `coarsen` or `smooth` changed.

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
    _report: Report

    @classmethod
    def _of(
        cls,
        arrays: dict[str, NDArray[Any]],
        report: Report,
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
        added = np.array([self._nadded], dtype=np.int64)
        return self._arrays() | saving.of_report(self._report) | {"added": added}

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls._of(arrays, saving.report_of(arrays), int(arrays["added"][0]))

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
        """A point in each region that faces enclose and that is empty, (h, 3)."""
        return self._holes

    @property
    def nadded(self) -> int:
        """The number of points that were added, the last rows of `points`."""
        return self._nadded

    @property
    def report(self) -> Report:
        """What `tetrahedralize` added, or what the last operation changed."""
        return self._report

    def validate(self) -> TetMeshReport:
        """Prove that the tetrahedra fit each other and the surface, or list the faults.

        Returns
        -------
        TetMeshReport
            Truthy if there are no faults: tetrahedra are positively oriented, no oriented face is
            used twice, so two tetrahedra with a common face lie on opposite sides of it, and they
            are each other's neighbors. If there are `input_faces`, each is a face of a tetrahedron,
            each face of the boundary is one of them, the boundary neither crosses nor touches
            itself, and the volume of the tetrahedra equals the volume that it encloses.
            Retriangulated faces cover what they replace.

        Notes
        -----
        Exact: volumes are compared as integers. With `input_faces`, this proves that the tetrahedra
        do not overlap and fill what the boundary encloses. Otherwise, overlaps between parts of a
        mesh without a common face are not detected. The time is O(n log n). Tetrahedra need not be
        Delaunay.

        Examples
        --------
        >>> import delone
        >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        >>> faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
        >>> print(delone.tetrahedralize(points, faces).validate())
        a mesh of tetrahedra
        """
        found = faults(self._points, self._simplices, self._neighbors, self._input_faces)
        # Points on faces are rounded, and cover nothing exactly.
        recovery = saving.recovery_of(self._report)
        if recovery is not None and len(recovery.recut):
            given = recovery.recut, recovery.recut_source[:, 1]
            wrong = differing(self._points, given, (self._input_faces, self._face_source))
            found = replace(found, uncovered=wrong)
        return found

    def refine(
        self,
        marked: ArrayLike | None = None,
        *,
        ratio: float = 0.5,
        radius_edge: float | None = 2.0,
        max_volume: Any = None,
        size: Any = None,
        min_angle: float | None = None,
        boundary: str = "faces",
        tolerance: float = 0.0,
        max_points: int | None = None,
        progress: Callable[[int], object] | None = None,
    ) -> TetMesh:
        """Return a mesh with smaller or better tetrahedra, everywhere or where they are marked.

        Parameters
        ----------
        marked : array_like of bool, shape (m,), or of int, optional
            Tetrahedra to refine: a mask, or their numbers.
        ratio : float, optional
            A tetrahedron of the finer mesh whose center lies in a marked tetrahedron has at most
            this fraction of its volume.
        radius_edge : float or None, optional
            The largest circumradius of a tetrahedron divided by its shortest edge, at least 1; for
            the regular tetrahedron it is 0.61. None for no bound.
        max_volume : float or mapping, optional
            Largest volume of a tetrahedron, or a mapping from regions to volumes.
        size : float, mapping, callable or tuple, optional
            Target edge length: no tetrahedron is larger than the regular one with that edge, and no
            edge is longer than twice the size. A number; a mapping from regions to numbers; a
            function that takes positions (k, 3) and returns k lengths; or ``(mesh, values)``, a 3-D
            triangulation with a length for each of its points, linear in between. Lengths by
            position are evaluated at the center of each tetrahedron and, if that extends over more
            than 1/16 of the mesh, at ten positions inside: smaller spots may be missed.
        min_angle : float, optional
            The goal for the smallest dihedral angle in degrees, by default 20: at the end, slivers
            are removed as by `delone.improve`, with added points where no other change helps. 0 for
            no such step.
        boundary : {"faces", "surface"}, optional
            What is kept: all `input_faces` and faces between regions, bit for bit; or the surface,
            on which points are added where sizes and shapes require them: planar parts are
            triangulated again, and edges between these are divided.
        tolerance : float, optional
            With ``boundary="surface"``, adjacent faces with one marker whose vertices are all
            within this distance of one plane, and that face the same direction, are one planar
            part, in the unit of the points. Faces move by up to twice the distance. By default 0: a
            planar part is exactly in one plane.
        max_points : int, optional
            Maximum number of added points; by default 2,000,000. Sizes that require far more raise
            an error before the refinement starts; otherwise it stops at the limit, and the report
            says so.
        progress : callable, optional
            Called from time to time with the number of points added in this round, and after each
            pass that removes slivers with the number added so far.

        Returns
        -------
        TetMesh
            The finer mesh. Its first points are those of this mesh; the removal of slivers may have
            moved some that are not on faces. Its `report` says what was added, and what violates
            the bounds.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `marked` is not a mask or array of tetrahedra of the mesh; a size is NaN, zero or
            negative (the message gives the position); faces that `tolerance` moves would cross
            others; an argument is invalid.
        BudgetExceededError
            The sizes require more points than `max_points`; the error contains the estimate.
        LimitError
            Coordinates are below 1e-307, where doubles do not have full accuracy.
        KeyboardInterrupt
            Ctrl-C was pressed.

        Notes
        -----
        Delaunay refinement (J. R. Shewchuk 1998): the circumcenter of a tetrahedron that is too
        large, or whose radius-edge ratio is too large, becomes a vertex, unless it is beyond a face
        or too close to one. With ``boundary="surface"``, a point on that face or edge is added
        instead; for shapes only where the ratio is above 2, and not nearer to others than a share
        of the edges and heights of the input there. Where faces or edges meet at small angles, no
        point makes their tetrahedra better.

        New edges are not shorter than the shortest edge of the tetrahedron that is refined, or half
        of its size; at points on faces for shapes, not shorter than a share of the edges and
        heights of the input. So the refinement ends. With ``boundary="faces"``, tetrahedra at faces
        that are larger than the size remain, and the report lists them.

        Points on faces are rounded to doubles; `RefinementReport.surface_distance` is an upper
        bound on their distance from the faces. All tetrahedra are positively oriented, exactly, and
        the result does not depend on the order of rows. One thread is used; the time is about 10
        microseconds for each tetrahedron, and memory is linear.

        References
        ----------
        .. [1] J. R. Shewchuk, "Tetrahedral mesh generation by Delaunay refinement", 14th Symposium
           on Computational Geometry (1998).

        Examples
        --------
        A cube with edges of about a fifth of its side:

        >>> import delone
        >>> corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        >>> cube = delone.ConvexHull(corners)
        >>> coarse = delone.tetrahedralize(cube.points, cube.simplices)
        >>> mesh = coarse.refine(size=0.2, boundary="surface")
        >>> bool(mesh.report), 1500 < mesh.nsimplex < 2500, bool(mesh.validate())
        (True, True, True)

        Finer at one corner:

        >>> near = mesh.refine(mesh.find_simplex([(0.1, 0.1, 0.1)]), ratio=0.1)
        >>> near.nsimplex > mesh.nsimplex
        True
        """
        bounds = as_bounds(
            ratio=ratio,
            radius_edge=radius_edge,
            size=size,
            max_volume=max_volume,
            min_angle=min_angle,
            boundary=boundary,
            tolerance=tolerance,
            max_points=max_points,
            progress=progress,
        )
        finer: TetMesh = refined(self, marked, bounds)
        return finer

    def coarsen(
        self, marked: ArrayLike | None = None, *, min_angle: float | None = None
    ) -> TetMesh:
        """Return a coarser mesh, where the bound on angles allows it.

        Parameters
        ----------
        marked : array_like of bool, shape (m,), or of int, optional
            Tetrahedra whose points may be removed: a mask, or their numbers; by default all.
        min_angle : float, optional
            The bound on dihedral angles in degrees; by default the goal that this mesh was improved
            for, or 20. Angles below it do not become smaller.

        Returns
        -------
        TetMesh
            A mesh without some of the added interior points; its ``report`` is an `ImproveReport`
            with the number of removed points. Input points, points on the surface or between
            regions, and points that the bound requires remain. If no point can be removed, the
            result is this mesh itself, with the report that it already has.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `marked` is not a mask or array of tetrahedra of the mesh, or `min_angle` is out of
            range.

        Notes
        -----
        A point is removed by contracting the edge to the neighbor for which the worst new
        tetrahedron is best. An exact predicate decides that new tetrahedra are positively oriented,
        and bounds on rounding errors prove what is said about angles. A single call never removes
        two neighboring points; call it again to remove more. The result does not depend on the
        order of rows. One thread is used. Time and memory are linear, with about 10 microseconds
        per point.

        Examples
        --------
        >>> import delone
        >>> corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        >>> cube = delone.ConvexHull(corners)
        >>> mesh = delone.tetrahedralize(cube.points, cube.simplices, size=0.2, boundary="surface")
        >>> coarser = mesh.coarsen()
        >>> coarser.npoints < mesh.npoints, coarser.report.smallest_after >= 20
        (True, True)
        """
        coarser: TetMesh = coarsened(self, marked, min_angle)
        return coarser

    def smooth(
        self,
        max_iter: int = 1,
        method: str = "lloyd",
        *,
        fixed: ArrayLike | None = None,
        min_angle: float | None = None,
    ) -> TetMesh:
        """Return a mesh with interior points moved to better positions.

        Parameters
        ----------
        max_iter : int, optional
            Number of iterations.
        method : {"lloyd", "odt", "laplace"}, optional
            The target of each point: the centroid of its Voronoi cell, as far as its tetrahedra
            cover it; the mean of the circumcenters of its tetrahedra, weighted by volume, as in an
            optimal Delaunay triangulation (ODT); or the mean of its neighbors.
        fixed : array_like of bool, shape (n,), or of int, optional
            Points that must not move: a mask, or rows.
        min_angle : float, optional
            The bound on dihedral angles in degrees; by default the goal that this mesh was improved
            for, or 20. Angles below it do not become smaller.

        Returns
        -------
        TetMesh
            The mesh with moved points; its ``report`` is an `ImproveReport`. Points on the
            boundary, on input faces and between regions do not move.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `max_iter` is negative, `method` is not one of its choices, `fixed` is not a mask or
            array of rows of the points, or `min_angle` is out of range.

        Notes
        -----
        Points move one after another, in the order of their coordinates. Each moves to its target
        or, if an angle would fall below the bound, half of the way, and so on down to 1/16. An
        exact predicate ensures that tetrahedra stay positively oriented. No edge is flipped;
        `delone.improve` does that. The result does not depend on the order of rows. One thread is
        used. The time is about 10 microseconds per point and iteration, and memory is linear.

        References
        ----------
        .. [1] L. Chen and J. Xu, "Optimal Delaunay triangulations", Journal of Computational
           Mathematics 22 (2004).

        Examples
        --------
        >>> import delone
        >>> corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        >>> cube = delone.ConvexHull(corners)
        >>> mesh = delone.tetrahedralize(cube.points, cube.simplices, size=0.2, boundary="surface")
        >>> better = mesh.smooth(5)
        >>> bool(better.quality().radius_ratio.mean() > mesh.quality().radius_ratio.mean())
        True
        """
        smoother: TetMesh = smoothed(self, (max_iter, method), fixed, min_angle)
        return smoother

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
