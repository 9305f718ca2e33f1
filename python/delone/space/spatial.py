"""What a triangulation offers that may be of the plane or of space; the base of `Delaunay`.

In the plane everything is handed on to `Triangulation`. In space, what follows from tetrahedra
comes from the modules beside this one, under the same names where it is the same thing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core, location
from delone.immutable import kept, sealed
from delone.plane.quality import measured as measured_triangles
from delone.plane.triangulation import Triangulation
from delone.space import geometry, topology
from delone.space import location as places
from delone.space.quality import measured as measured_tetrahedra

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Spatial"]


class Spatial(Triangulation):
    """Read-only arrays of triangles or tetrahedra, and what follows from them."""

    __slots__ = ()

    @property
    def ndim(self) -> int:
        """Number of coordinates, 2 or 3."""
        return int(self._points.shape[1])

    def _only(self, ndim: int, name: str, instead: str) -> None:
        if self.ndim != ndim:
            where = "in the plane" if ndim == 2 else "in space"
            raise AttributeError(f"{name} is there {where} only: {instead}")

    @property
    @kept
    def edges(self) -> Indices:
        """Every edge once, (k, 2): the smaller vertex first, rows ascending."""
        if self.ndim == 2:
            return super().edges
        return sealed(topology.edges(self._simplices, self.npoints, self._workers))

    @property
    @kept
    def faces(self) -> Indices:
        """Every triangular face of tetrahedra once, (k, 3): vertices and rows ascending.

        In space only: in the plane the faces are `simplices`.
        """
        self._only(3, "faces", "the faces of the plane are `simplices`")
        return sealed(topology.faces(self._simplices, self._neighbors, self.npoints, self._workers))

    @property
    @kept
    def convex_hull(self) -> Indices:
        """The boundary, (h, 2) or (h, 3), in the order of the simplices.

        In the plane its edges, each with the triangulation to its left; in space its triangles,
        counter-clockwise as seen from outside.
        """
        if self.ndim == 2:
            return super().convex_hull
        return sealed(topology.boundary_faces(self._simplices, self._neighbors))

    @property
    @kept
    def hull(self) -> NDArray[np.int64]:
        """The vertices on the convex hull, (h,), those inside its sides included.

        In the plane counter-clockwise from the lexicographically smallest point on, in space in
        ascending order.
        """
        if self.ndim == 2:
            return super().hull
        return sealed(np.unique(self.convex_hull).astype(np.int64))

    @property
    @kept
    def transform(self) -> Floats:
        """Affine maps to barycentric coordinates, (m, d + 1, d).

        With ``inverse, r = transform[t, :d], transform[t, d]``, where r is the last vertex of
        simplex t, ``c = inverse @ (x - r)`` are the first d barycentric coordinates of x, and
        ``1 - c.sum()`` is the last. No simplex is flat, so no row is NaN, however thin the simplex;
        in the plane entries have a relative error below 1e-13, in space rows have one below 1e-13
        of their length. What exceeds the range of doubles is infinite.
        """
        if self.ndim == 2:
            return super().transform
        return sealed(geometry.transform(self._points, self._simplices, self._workers))

    @property
    @kept
    def areas(self) -> Floats:
        """Areas of the triangles, (m,), in the square of the unit of the points; plane only.

        All positive, with a relative error below 1e-13, except beyond the range of doubles.
        """
        self._only(2, "areas", "tetrahedra have `volumes`")
        return super().areas

    @property
    @kept
    def volumes(self) -> Floats:
        """Volumes of the tetrahedra, (m,), in the cube of the unit of the points; space only.

        All positive, with a relative error below 1e-13, except beyond the range of doubles.
        """
        self._only(3, "volumes", "triangles have `areas`")
        return sealed(geometry.volumes(self._points, self._simplices, self._workers))

    @property
    @kept
    def circumcenters(self) -> Floats:
        """Centres of the circles or spheres through the corners of simplices, (m, d).

        Each coordinate within 4 units in the last place. Those of thin simplices are far away, and
        infinite beyond the range of doubles.
        """
        if self.ndim == 2:
            return super().circumcenters
        return sealed(geometry.circumcenters(self._points, self._simplices, self._workers))

    @property
    @kept
    def _locator(self) -> _core.Locator2:
        if self.ndim == 2:
            return super()._locator
        # Another class, with the methods that are called in space.
        index: Any = _core.Locator3(self._points, self._simplices, self._neighbors)
        return index  # type: ignore[no-any-return]

    @property
    def _solid_locator(self) -> _core.Locator3:
        index: Any = self._locator
        return index  # type: ignore[no-any-return]

    def find_simplex(
        self, xi: ArrayLike, bruteforce: bool = False, tol: float | None = None
    ) -> Indices:
        """Tell which simplices hold points.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points to locate. NaN and infinity are outside.
        bruteforce : bool, optional
            Accepted as in SciPy. No search is exhaustive: the walk cannot fail.
        tol : float, optional
            Accepted as in SciPy. It has no effect: the answer is exact.

        Returns
        -------
        ndarray of int32, shape (...)
            The triangle or tetrahedron that has the point inside or on its boundary, the first one
            where there are several, or -1 where there is none. The shape is () for a single point.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points of this dimension.

        Notes
        -----
        Points are taken along a space-filling curve, and each is reached by a visibility walk from
        the one before; for k points that takes O(k log k + walks) time, whatever their order. A
        visibility walk ends in every Delaunay triangulation (L. De Floriani et al., "On sorting
        triangles in a Delaunay tessellation", 1991).

        Examples
        --------
        >>> from delone import Delaunay
        >>> mesh = Delaunay([(0, 0), (1, 0), (0, 1)])
        >>> mesh.find_simplex([(0.25, 0.25), (0.5, 0.5), (0.75, 0.75)])
        array([ 0,  0, -1], dtype=int32)
        """
        if self.ndim == 2:
            return super().find_simplex(xi, bruteforce, tol)
        return places.find(self._solid_locator, xi, self._workers)

    def nearest(self, xi: ArrayLike) -> Indices:
        """Return the vertices that are nearest to points.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points, inside of the convex hull or not.

        Returns
        -------
        ndarray of int32, shape (...)
            The nearest vertex, the one of the smallest row where there are several; -1 where a
            coordinate is NaN or infinite.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points of this dimension.

        Notes
        -----
        Exact: distances are compared by predicates. From vertex to vertex: as long as the nearest
        one is not reached, one of the neighbours is nearer.

        Examples
        --------
        >>> from delone import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).nearest([(0.9, 0.2), (5, 6), (0.5, 0.5)])
        array([1, 2, 0], dtype=int32)
        """
        if self.ndim == 2:
            return super().nearest(xi)
        return places.nearest(self._solid_locator, xi, self._workers)

    def locate(self, xi: ArrayLike) -> Any:
        """Tell where points lie: simplex, weights of its corners, nearest point of the boundary.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points to locate.

        Returns
        -------
        Location or SpaceLocation
            With fields `simplex`, `barycentric`, `nearest` and `beside`; in the plane `edge` and
            `along`, in space `face` and `shares` tell where on the boundary outer points come to
            lie.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points of this dimension.

        Notes
        -----
        Which simplex, and inside or outside, is exact. The weights are rounded, but none is
        negative, and at a vertex they are exactly 1 and 0. The first location of a triangulation
        makes an index, in a small part of the time of the triangulation itself; queries are taken
        along a space-filling curve, each from the simplex of the one before.

        Examples
        --------
        >>> from delone import Delaunay
        >>> mesh = Delaunay([(0, 0), (4, 0), (0, 4)])
        >>> place = mesh.locate([(1, 2), (3, 3)])
        >>> place.simplex
        array([ 0, -1], dtype=int32)
        >>> place.barycentric[0] @ mesh.points[mesh.simplices[0]]
        array([1., 2.])
        >>> place.nearest
        array([[1., 2.],
               [2., 2.]])
        """
        if self.ndim == 2:
            return location.locate(self._locator, self._points, xi, self._workers)
        return places.locate(self._solid_locator, self._points, xi, self._workers)

    def walk(self, a: ArrayLike, b: ArrayLike) -> Indices:
        """Return the triangles along a segment; plane only.

        Parameters
        ----------
        a, b : array_like, shape (2,)
            Ends of the segment.

        Returns
        -------
        ndarray of int32, shape (k,)
            The triangles that have more than a point of the segment, in order from a to b. Where it
            runs along an edge, the triangle to the left of it, or the only one there is. Parts
            outside are skipped; a segment of length zero is a point to be found.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError
            An end is no finite point.
        AttributeError
            The points are in space.

        Notes
        -----
        Exact. Linear in the number of triangles met, after a walk to the first.

        Examples
        --------
        >>> from delone import Delaunay
        >>> mesh = Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
        >>> len(mesh.walk((-1, 0.5), (5, 1)))
        3
        """
        self._only(2, "walk", "`find_simplex` takes points of a segment")
        return super().walk(a, b)

    @kept
    def quality(self) -> Any:
        """Measure the simplices.

        Returns
        -------
        Quality or TetQuality
            In the plane angles, areas and ratios of radii and edges; in space dihedral angles,
            volumes and the same ratios.

        Examples
        --------
        >>> from delone import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).quality().largest_angle
        array([90.])
        >>> Delaunay([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]).quality().largest_dihedral
        array([90.])
        """
        if self.ndim == 2:
            return measured_triangles(self._points, self._simplices, self._workers)
        return measured_tetrahedra(self._points, self._simplices, self._workers)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the triangulation.

        Parameters
        ----------
        ax : matplotlib Axes or pyvista Plotter, optional
            Where to draw; by default on a new one.
        **options
            As for `delone.plot.plot`.

        Returns
        -------
        matplotlib Axes or pyvista Plotter
            What was drawn on; matplotlib (extra ``plot``) in the plane, pyvista (extra ``pyvista``)
            in space.

        Raises
        ------
        MissingExtraError
            The library is not installed.

        Examples
        --------
        >>> from delone import Delaunay
        >>> ax = Delaunay([(0, 0), (1, 0), (0, 1)]).plot()
        >>> ax.get_aspect()
        1.0
        """
        from delone.plot import plot

        return plot(self, ax, **options)
