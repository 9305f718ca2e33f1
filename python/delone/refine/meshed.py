"""The class Mesh: a quality triangular mesh of a domain, with its segments and regions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone._base.immutable import made_by
from delone.refine.adaptivity import coarsened, finer
from delone.refine.smoothing import smoothed
from delone.refine.state import MeshState
from delone.refine.validation import MeshValidation, validate

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

__all__ = ["Mesh"]


@made_by("create a Mesh with delone.mesh(domain), not with its class")
class Mesh(MeshState):
    """A triangular mesh, created by `delone.mesh`.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 2)
        The vertices: the input points that are used, in their order, then the added points.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `points`, counter-clockwise.
    neighbors : ndarray of int32, shape (m, 3)
        ``neighbors[t, k]`` is the triangle across the edge opposite vertex k of triangle t; -1
        outside.
    segments : ndarray of int32, shape (q, 2)
        The edges into which the input segments were split, including boundary edges that are not on
        a segment.
    segment_source : tuple of ndarray
        The input rows that cover each of these, as compressed rows.
    point_source : ndarray of int32, shape (n,)
        The input row of each point; -1 for added points.
    region : ndarray of int32, shape (m,)
        The region of each triangle.
    report : MeshReport
        Added points by cause, angles, and triangles below the bound.

    Notes
    -----
    All arrays are read-only, and attributes cannot be set. Every point is a vertex of a triangle:
    points outside and duplicates are left out. Each edge that is not a segment is locally Delaunay,
    and ties between cocircular points are broken by coordinates as in `Delaunay`.

    Examples
    --------
    >>> import delone
    >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    >>> mesh = delone.mesh(square, max_area=0.1)
    >>> bool(mesh.report), bool(mesh.areas.max() <= 0.1)
    (True, True)
    >>> float(mesh.areas.sum())
    1.0
    """

    __slots__ = ()

    def refine(
        self,
        marked: ArrayLike | None = None,
        *,
        ratio: float = 0.5,
        min_angle: float | None = None,
        max_area: Any = None,
        size: Any = None,
        max_points: int | None = None,
        progress: Callable[[int, float], object] | None = None,
    ) -> Mesh:
        """Return a mesh that is finer in marked triangles or everywhere.

        Parameters
        ----------
        marked : array_like of bool, shape (m,), or of int, optional
            Triangles to refine: a mask, or their numbers.
        ratio : float, optional
            A triangle of the finer mesh whose center lies in a marked triangle has at most this
            fraction of its area. Triangles that reach into it from outside may be larger.
        min_angle : float, optional
            The bound on angles; by default that of the mesh.
        max_area, size, max_points, progress : optional
            As for `delone.mesh`.

        Returns
        -------
        Mesh
            The finer mesh; its first points are those of this mesh. Without `marked` and sizes,
            only angles are improved, where possible.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `marked` is not a mask or array of triangles of the mesh, or `ratio` is not in (0, 1];
            otherwise as for `delone.mesh`.
        BudgetExceededError
            As for `delone.mesh`.

        Notes
        -----
        Points, segments, markers and regions are inherited; the report counts all added points.
        Triangles near marked ones change if the bound on angles requires it.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> mesh = delone.mesh(square, max_area=0.1)
        >>> finer = mesh.refine(mesh.find_simplex([(0.1, 0.1)]))
        >>> finer.nsimplex > mesh.nsimplex, bool(finer.report)
        (True, True)
        """
        return finer(
            self,
            marked,
            ratio=ratio,
            min_angle=min_angle,
            max_area=max_area,
            size=size,
            max_points=max_points,
            progress=progress,
        )

    def coarsen(self, marked: ArrayLike | None = None) -> Mesh:
        """Return a coarser mesh, where the bound on angles allows it.

        Parameters
        ----------
        marked : array_like of bool, shape (m,), or of int, optional
            Triangles that may become larger: a mask, or their numbers; by default all.

        Returns
        -------
        Mesh
            A mesh without some of the points of these triangles. Input points, points on segments,
            and points that the bound on angles requires remain. If no point can be removed, this
            mesh is returned.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `marked` is not a mask or array of triangles of the mesh.

        Notes
        -----
        One call never removes two neighboring points; call it again to remove more.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> mesh = delone.mesh(square, max_area=0.001)
        >>> coarser = mesh.coarsen()
        >>> coarser.npoints < mesh.npoints, bool(coarser.report)
        (True, True)
        """
        return coarsened(self, marked)

    def smooth(self, max_iter: int = 1, method: str = "lloyd") -> Mesh:
        """Return a mesh whose free points are at better positions.

        Parameters
        ----------
        max_iter : int, optional
            Number of iterations.
        method : {"lloyd", "odt", "laplace"}, optional
            The target of each point: the centroid of the part of its Voronoi cell that its
            triangles cover; the mean of the circumcenters of its triangles, weighted by area, as in
            an optimal Delaunay triangulation (ODT); or the mean of its neighbors.

        Returns
        -------
        Mesh
            The mesh with moved points. Input points, points on segments, and vertices of triangles
            below the bound do not move.

        Raises
        ------
        InputError
            `max_iter` is negative, or `method` is not one of its choices.

        Notes
        -----
        All points move simultaneously, and edges are flipped until the mesh is Delaunay again.
        Where a triangle would be inverted, or an angle would fall below the bound, points move only
        part of the way. Bounds on areas are not enforced.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> mesh = delone.mesh(square, max_area=0.001)
        >>> better = mesh.smooth(5, "odt")
        >>> bool(better.quality().radius_ratio.mean() > mesh.quality().radius_ratio.mean())
        True
        """
        return smoothed(self, max_iter, method)

    def plot_quality(self, ax: Any = None) -> Any:
        """Draw a histogram of the angles, with the bound (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.

        Returns
        -------
        matplotlib Axes
            The axes.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> ax = delone.mesh(square, max_area=0.01).plot_quality()
        """
        return self.quality().plot(ax, bound=float(self._bound[0]))

    def validate(self) -> MeshValidation:
        """Prove that the triangles form a valid Delaunay mesh, or list the faults.

        Returns
        -------
        MeshValidation
            Truthy if there are no faults: triangles are counter-clockwise, neighbors are mutual,
            the boundary consists of segments, each other edge is locally Delaunay, ties are broken
            canonically, and each point is a vertex. `report` assesses the angles.

        Notes
        -----
        Exact, in about the time of the triangulation of its points.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> bool(delone.mesh(square, max_area=0.1).validate())
        True
        """
        return validate(self._points, self._simplices, self._neighbors, self.constrained)
