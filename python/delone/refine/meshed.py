"""The class Mesh: triangles of bounded angles that fill a domain, with its segments and regions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.errors import DtypeError
from delone.refine.adaptivity import coarsened, finer
from delone.refine.smoothing import smoothed
from delone.refine.state import MeshState
from delone.refine.validation import MeshValidation, validate

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

__all__ = ["Mesh"]


class Mesh(MeshState):
    """A mesh of triangles, as `delone.mesh` makes it.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 2)
        The vertices: those of the input that are used, in their order, then those that were added.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `points`, counter-clockwise.
    neighbors : ndarray of int32, shape (m, 3)
        ``neighbors[t, k]`` is the triangle across the edge opposite vertex k of triangle t; -1
        outside.
    segments : ndarray of int32, shape (q, 2)
        The edges into which the segments of the input were cut, those on hulls without a segment
        included.
    segment_source : tuple of ndarray
        The rows of the input that cover each of these, as compressed rows.
    point_source : ndarray of int32, shape (n,)
        The row of the input that each point is; -1 where it was added.
    region : ndarray of int32, shape (m,)
        The region of each triangle.
    report : MeshReport
        Points by cause, angles, and the triangles that the input spoils.

    Notes
    -----
    All arrays are read-only, and attributes cannot be set. Every point is a vertex of a triangle:
    what lies outside, or repeats another row, is left out. Each edge that is no segment is locally
    Delaunay, ties between cocircular points go by coordinates as in `Delaunay`.

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

    def __init__(self, *given: Any, **options: Any) -> None:
        raise DtypeError("a Mesh is made by delone.mesh(domain), not by its class")

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
        """Make a mesh that is finer, where triangles are marked or everywhere.

        Parameters
        ----------
        marked : array_like of bool, shape (m,), or of int, optional
            Triangles that are too large: a mask, or their numbers.
        ratio : float, optional
            A triangle of the finer mesh whose centre lies in a marked one has at most this share of
            its area. Those that reach into it from outside may be larger.
        min_angle : float, optional
            By default what the mesh was made with.
        max_area, size, max_points, progress : optional
            As for `delone.mesh`.

        Returns
        -------
        Mesh
            The finer mesh; its first points are those of this one. Without `marked` and sizes only
            angles are improved, where there is room to.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `marked` names no triangles of the mesh, or `ratio` is not in (0, 1]; otherwise as for
            `delone.mesh`.
        BudgetExceededError
            As for `delone.mesh`.

        Notes
        -----
        Points, segments, markers and regions are inherited; the report counts all points added.
        Neighbours of marked triangles change as far as the bound of angles asks for it.

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
        """Make a mesh that is coarser, where that is safe.

        Parameters
        ----------
        marked : array_like of bool, shape (m,), or of int, optional
            Triangles that may become larger; by default all.

        Returns
        -------
        Mesh
            A mesh without some of the points of these triangles. Points of the input and points on
            segments stay, and so does what is needed for the bound of angles. The mesh itself where
            no point can go.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `marked` names no triangles of the mesh.

        Notes
        -----
        In one call no two neighbouring points go; call it again for more.

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
        """Make a mesh whose free points are at better places.

        Parameters
        ----------
        max_iter : int, optional
            How many rounds.
        method : {"lloyd", "odt", "laplace"}, optional
            Towards what a point moves: the centre of its Voronoi cell, as far as its triangles
            make it up; the mean of the circumcentres of its triangles, weighted by area, which is
            that of an optimal Delaunay triangulation; or the mean of its neighbours.

        Returns
        -------
        Mesh
            The mesh with moved points. Those of the input and on segments stay, and so do all of
            triangles that the input spoils.

        Raises
        ------
        InputError
            `max_iter` is negative, or `method` none of the three.

        Notes
        -----
        The points are triangulated anew in each round, so the mesh is Delaunay. Where an angle
        would fall below the bound, points go back. Caps of areas are not looked at.

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
        """Draw the histogram of the angles, with the bound (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.

        Returns
        -------
        matplotlib Axes
            What was drawn on.

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
        """Prove that the triangles fit each other and are Delaunay, or name what is wrong.

        Returns
        -------
        MeshValidation
            Truthy if all is right: triangles are counter-clockwise, neighbors are mutual, the
            boundary consists of segments, each other edge is locally Delaunay, ties are broken
            canonically, and each point is a vertex. `report` judges the angles.

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
