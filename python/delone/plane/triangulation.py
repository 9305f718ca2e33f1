"""What the classes of triangulations have in common: immutable arrays and what follows from them.

`points`, `simplices` and `neighbors` come from the core; everything else here follows from them on
first use (`topology` without coordinates, `geometry` with them) and is kept. Objects never change
after the constructor, so any number of threads may use one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core, location
from delone._arrays import as_vectors, as_workers
from delone.exchange.parts import Parts
from delone.immutable import Immutable, kept, sealed
from delone.plane import geometry, topology

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Triangulation", "first_rows"]


class Triangulation(Immutable):
    """Read-only arrays of triangles, and what follows from them; the base of public classes."""

    __slots__ = (
        "_duplicates",
        "_neighbors",
        "_points",
        "_simplices",
        "_stages",
        "_workers",
    )

    _duplicates: Indices
    _neighbors: Indices
    _points: Floats
    _simplices: Indices
    _stages: dict[str, float]
    _workers: int | None

    def _fill(
        self, arrays: dict[str, NDArray[Any]], stages: dict[str, float], workers: int | None
    ) -> None:
        """Set everything there is; afterwards nothing can be set."""
        self._hold(
            stages=stages,
            workers=workers,
            **{name: sealed(array) for name, array in arrays.items()},
        )

    def _tiling(self) -> tuple[Indices, Indices]:
        """Triangles and neighbours of the whole convex hull."""
        return self._simplices, self._neighbors

    @property
    def _number(self) -> Indices | None:
        """What each triangle of `_tiling` is here, -1 and for the last entry; None for itself."""
        return None

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d), where d is `ndim`."""
        return self._points

    @property
    def simplices(self) -> Indices:
        """The simplices as rows of `points`, (m, d + 1).

        Triangles are counter-clockwise, tetrahedra positively oriented.
        """
        return self._simplices

    @property
    def neighbors(self) -> Indices:
        """The simplex opposite each vertex, (m, d + 1); -1 outside."""
        return self._neighbors

    @property
    def ndim(self) -> int:
        """Number of coordinates, 2."""
        return 2

    @property
    def npoints(self) -> int:
        """Number of points, duplicates included."""
        return len(self._points)

    @property
    def nsimplex(self) -> int:
        """Number of simplices: triangles, or tetrahedra."""
        return len(self._simplices)

    @property
    def stages(self) -> dict[str, float]:
        """Seconds of each part of the construction; empty after loading from a file."""
        return dict(self._stages)

    @property
    @kept
    def min_bound(self) -> Floats:
        """The least coordinates, (d,)."""
        return sealed(self._points.min(axis=0))

    @property
    @kept
    def max_bound(self) -> Floats:
        """The greatest coordinates, (d,)."""
        return sealed(self._points.max(axis=0))

    @property
    @kept
    def edges(self) -> Indices:
        """Every edge once, (k, 2): the smaller vertex first, rows ascending."""
        return sealed(topology.edges(self._simplices, self._neighbors, self.npoints, self._workers))

    @property
    @kept
    def convex_hull(self) -> Indices:
        """The edges of the convex hull, (h, 2), each with the triangulation to its left.

        Their order is that of the triangles; `hull` has the vertices in order.
        """
        return sealed(topology.boundary_edges(*self._tiling()))

    @property
    @kept
    def hull(self) -> NDArray[np.int64]:
        """The vertices on the convex hull, (h,), counter-clockwise, collinear ones included.

        The first is the lexicographically smallest point.
        """
        rows = self.convex_hull[:, 0]
        x, y = self._points[rows].T
        start = int(rows[np.lexsort((y, x))[0]])
        return sealed(topology.boundary_next(self.convex_hull, start))

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The vertex of each row, (n,): the first row with the same coordinates."""
        first = np.arange(self.npoints, dtype=np.int32)
        first[self._duplicates[:, 0]] = self._duplicates[:, 1]
        return sealed(first)

    @property
    @kept
    def vertex_to_simplex(self) -> Indices:
        """A simplex of each point, (n,): the first that has it, or what it repeats, for a vertex.

        -1 where there is none.
        """
        first = topology.vertex_to_simplex(self._simplices, self.npoints)
        return sealed(first[self.duplicate_of])

    @property
    @kept
    def coplanar(self) -> Indices:
        """The duplicates, (k, 3): row, a simplex of its vertex (-1 if it has none), its vertex."""
        row, first = self._duplicates.T
        return sealed(np.column_stack((row, self.vertex_to_simplex[first], first)))

    @property
    @kept
    def vertex_neighbor_vertices(self) -> tuple[Indices, Indices]:
        """Neighbours of vertices as compressed rows (indptr, indices).

        Those of vertex v are ``indices[indptr[v]:indptr[v + 1]]``, ascending. A duplicate has none.
        """
        indptr, indices = topology.vertex_neighbor_vertices(self.edges, self.npoints)
        return sealed(indptr), sealed(indices)

    @property
    @kept
    def transform(self) -> Floats:
        """Affine maps to barycentric coordinates, (m, 3, 2).

        With ``inverse, r = transform[t, :2], transform[t, 2]``, where r is the last vertex of
        triangle t, ``c = inverse @ (x - r)`` are the first two barycentric coordinates of x, and
        ``1 - c.sum()`` is the third. No triangle is flat, so no row is NaN, however thin the
        triangle; entries have a relative error below 1e-13. What exceeds the range of doubles is
        infinite.
        """
        return sealed(geometry.transform(self._points, self._simplices, self._workers))

    @property
    @kept
    def areas(self) -> Floats:
        """Areas of the triangles, (m,), in the square of the unit of the points.

        All positive, with a relative error below 1e-13, except beyond the range of doubles.
        """
        return sealed(geometry.areas(self._points, self._simplices, self._workers))

    @property
    @kept
    def circumcenters(self) -> Floats:
        """Centres of the circles through the corners of triangles, (m, 2).

        Each coordinate within 4 units in the last place. Those of thin triangles are far away, and
        infinite beyond the range of doubles.
        """
        return sealed(geometry.circumcenters(self._points, self._simplices, self._workers))

    @property
    @kept
    def _locator(self) -> _core.Locator2:
        return location.locator(self._points, self._simplices, self._neighbors)

    @property
    @kept
    def _whole_locator(self) -> _core.Locator2:
        """The index over the triangles of the whole convex hull."""
        if self._number is None:
            return self._locator
        return location.locator(self._points, *self._tiling())

    @property
    @kept
    def _sites(self) -> tuple[_core.Locator2 | None, Indices | None]:
        """An index over a Delaunay triangulation of the vertices, and which rows these are."""
        rows = np.unique(self._simplices)
        if not len(rows):
            return None, rows
        sites = self._points[rows]
        made = _core.triangulate2(sites, "auto", as_workers(self._workers))
        return location.locator(sites, made.simplices, made.neighbors), rows

    def find_simplex(
        self, xi: ArrayLike, bruteforce: bool = False, tol: float | None = None
    ) -> Indices:
        """Tell which triangles hold points.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Points to locate. NaN and infinity are outside.
        bruteforce : bool, optional
            Accepted as in SciPy. No search is exhaustive: the walk cannot fail.
        tol : float, optional
            Accepted as in SciPy. It has no effect: the answer is exact.

        Returns
        -------
        ndarray of int32, shape (...)
            The triangle that has the point inside or on its boundary, the first one where there are
            several, or -1 where there is none: outside, or in a hole. The shape is () for a single
            point.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points in the plane.

        Notes
        -----
        Points are taken along a space-filling curve, and each is reached by a visibility walk from
        the one before; for k points that takes O(k log k + walks) time, whatever their order. A
        visibility walk ends in every Delaunay triangulation (L. De Floriani et al., "On sorting
        triangles in a Delaunay tessellation", 1991); a straight walk helps where triangles are
        constrained, and a tree of boxes where there are holes.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay, Delaunay
        >>> mesh = Delaunay([(0, 0), (1, 0), (0, 1)])
        >>> mesh.find_simplex([(0.25, 0.25), (0.5, 0.5), (0.75, 0.75)])
        array([ 0,  0, -1], dtype=int32)
        >>> points = [(0, 0), (6, 0), (0, 6), (1, 1), (2, 1), (1, 2)]
        >>> mesh = ConstrainedDelaunay(points, [(3, 4), (4, 5), (5, 3)], holes=[(1.2, 1.2)])
        >>> (mesh.find_simplex([(1.2, 1.2), (1, 1), (0.5, 0.5)]) >= 0).tolist()
        [False, True, True]
        """
        queries = as_vectors(xi, 2, name="xi")
        found = self._locator.find(queries.reshape(-1, 2), as_workers(self._workers))
        return found.reshape(queries.shape[:-1])

    def nearest(self, xi: ArrayLike) -> Indices:
        """Return the vertices that are nearest to points.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Points, in triangles or not.

        Returns
        -------
        ndarray of int32, shape (...)
            The nearest vertex of a triangle, the one of the smallest row where there are several;
            -1 where a coordinate is NaN or infinite.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points in the plane.

        Notes
        -----
        Exact: distances are compared by predicates. From vertex to vertex: as long as the nearest
        one is not reached, one of the neighbours in a Delaunay triangulation is nearer. Where
        constraints make another one of it, the first call triangulates the vertices without them,
        for what is nearest need not be seen.

        Examples
        --------
        >>> from delone import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).nearest([(0.9, 0.2), (5, 6), (0.5, 0.5)])
        array([1, 2, 0], dtype=int32)
        """
        return location.nearest(self._sites, xi, self._workers)

    def locate(self, xi: ArrayLike) -> location.Location:
        """Tell where points lie: triangle, weights of its corners, nearest point of the boundary.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Points to locate.

        Returns
        -------
        Location
            With fields `simplex`, `barycentric`, `nearest`, `beside`, `edge`, `along`.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points in the plane.

        Notes
        -----
        Which triangle, and inside or outside, is exact. The weights are rounded, but none is
        negative, and at a vertex they are exactly 1, 0 and 0. The first location of a triangulation
        makes an index, in a small part of the time of the triangulation itself; queries are taken
        along a space-filling curve, each from the triangle of the one before.

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
        return location.locate(self._locator, self._points, xi, self._workers)

    def walk(self, a: ArrayLike, b: ArrayLike) -> Indices:
        """Return the triangles along a segment.

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
        start, end = location.segment_ends(a, b)
        if (start == end).all():
            holder = np.atleast_1d(self.find_simplex(start))
            return holder[holder >= 0]
        tiling = (self._points, *self._tiling())
        return location.along(self._whole_locator, tiling, self._number, start, end)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the triangulation with matplotlib (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.
        **options
            As in `delone.plot.plot`.

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
        >>> from delone import Delaunay
        >>> ax = Delaunay([(0, 0), (1, 0), (0, 1)]).plot()
        >>> ax.get_aspect()
        1.0
        """
        from delone.plot import plot

        return plot(self, ax, **options)

    @classmethod
    def _from_arrays(
        cls, arrays: dict[str, NDArray[Any]], stages: dict[str, float], workers: int | None
    ) -> Self:
        mesh = cls.__new__(cls)
        mesh._fill(arrays, stages, workers)
        return mesh

    def _arrays(self) -> dict[str, NDArray[Any]]:
        """Everything from which the object can be made again."""
        raise NotImplementedError

    def _parts(self) -> Parts:
        """What other libraries and files take."""
        return Parts(self._points, self._simplices)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._from_arrays, (self._arrays(), self._stages, self._workers)


def first_rows(points: Floats) -> NDArray[np.int64]:
    """Return for each point the first row with the same coordinates."""
    order = np.lexsort(points.T)
    ordered = points[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    # The sort is stable, so that the first of equal rows comes first.
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[np.flatnonzero(new)][np.cumsum(new) - 1]
    return first
