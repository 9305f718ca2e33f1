"""The base classes of triangulations in any dimension, with what follows from points and simplices.

A class holds arrays and the table of functions of its dimension (`dimension`). Everything here is
derived from these on first use and kept. Objects never change, so any number of threads may share
one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone._base.arrays import as_queries, as_workers
from delone._base.duplicates import vertices_of
from delone._base.immutable import kept, sealed
from delone._tiling import location, measures
from delone._tiling.complex import Complex
from delone._tiling.dimension import FLAT_OR_SOLID, only
from delone._tiling.higher import flats
from delone._tiling.higher.dimension import HIGHER
from delone._tiling.higher.flat_dimension import FLATS
from delone._tiling.plane.dimension import PLANE
from delone._tiling.plane.location import along
from delone._tiling.plane.topology import vertex_neighbor_vertices, vertex_to_simplex
from delone._tiling.space.dimension import SPACE
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone._tiling.dimension import Dimension

__all__ = ["HullTiling", "PointTriangulation", "Triangulation", "require_whole"]

# By the number of coordinates.
_DIMENSIONS = {2: PLANE, 3: SPACE} | HIGHER


class Triangulation(Complex):
    """Triangles in 2-D, tetrahedra in 3-D, simplices in up to 8-D, and what follows from them."""

    __slots__ = ()

    @property
    def _dimension(self) -> Dimension:
        """The functions of this dimension."""
        d, k = self._points.shape[1], self._simplices.shape[1] - 1
        return _DIMENSIONS[d] if k == d else FLATS[d, k]

    @property
    def _is_flat(self) -> bool:
        """Whether all points are in a flat, and the simplices have fewer corners than usual."""
        return bool(self._simplices.shape[1] <= self._points.shape[1])

    def _tiling(self) -> tuple[Indices, Indices]:
        """Return simplices and neighbors of a tiling of the convex hull that holds these."""
        return self._simplices, self._neighbors

    @property
    def _number(self) -> Indices | None:
        """The number here of each simplex of `_tiling`, or -1, also at the end; None if equal."""
        return None

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
    @kept
    def boundary(self) -> Indices:
        """The facets with a simplex on one side only, (h, d), in the order of the simplices.

        In 2-D, edges, each with the triangulation to its left; in 3-D, triangles, counter-clockwise
        as seen from outside; in more dimensions, simplices of d corners, by the same sign rule.
        """
        return sealed(self._dimension.boundary(self._simplices, self._neighbors))

    @property
    @kept
    def edges(self) -> Indices:
        """Every edge once, (k, 2): the smaller vertex first, rows ascending."""
        topology = self._simplices, self._neighbors, self.npoints, self._workers
        return sealed(measures.edges(*topology))

    @property
    @only(FLAT_OR_SOLID, "`edges` and `boundary` exist in every dimension")
    @kept
    def faces(self) -> Indices:
        """Every triangle once, (k, 3): vertices and rows ascending.

        In 2-D, the simplices; in 3-D, their faces.
        """
        topology = self._simplices, self._neighbors, self.npoints, self._workers
        return sealed(self._dimension.faces(*topology))

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The vertex of each row, (n,): the first row with the same coordinates."""
        return sealed(np.arange(self.npoints, dtype=np.int32))

    @property
    @kept
    def vertex_to_simplex(self) -> Indices:
        """The first simplex of each point, or of the point that it repeats, (n,); -1 if none."""
        first = vertex_to_simplex(self._simplices, self.npoints)
        return sealed(first[self.duplicate_of])

    @property
    @kept
    def coplanar(self) -> Indices:
        """The duplicates, (k, 3): row, a simplex of its vertex (-1 if it has none), its vertex."""
        row = np.flatnonzero(self.duplicate_of != np.arange(self.npoints)).astype(np.int32)
        first = self.duplicate_of[row]
        return sealed(np.column_stack((row, self.vertex_to_simplex[first], first)))

    @property
    @kept
    def vertex_neighbor_vertices(self) -> tuple[Indices, Indices]:
        """Neighbors of vertices as compressed rows (indptr, indices).

        Those of vertex v are ``indices[indptr[v]:indptr[v + 1]]``, ascending. A duplicate has none.
        """
        indptr, indices = vertex_neighbor_vertices(self.edges, self.npoints)
        return sealed(indptr), sealed(indices)

    @property
    @kept
    def transform(self) -> Floats:
        """Affine maps to barycentric coordinates, (m, d + 1, d).

        With ``inverse, r = transform[t, :d], transform[t, d]``, where r is the last vertex of
        simplex t, ``c = inverse @ (x - r)`` are the first d barycentric coordinates of x, and
        ``1 - c.sum()`` is the last. No simplex is flat, so no row is NaN, however thin the simplex.
        In 2-D, entries have a relative error below 1e-13; in more dimensions, rows have an error
        below 1e-13 of their length. Values beyond the range of doubles are infinite.
        """
        if self._is_flat:
            raise AttributeError(
                "transform is not available for points in a flat: `locate` returns barycentric "
                "coordinates",
                name="transform",
                obj=self,
            )
        return sealed(measures.transform(self._points, self._simplices, self._workers))

    @property
    @kept
    def circumcenters(self) -> Floats:
        """Centers of the circles or spheres through the corners of simplices, (m, d).

        Each coordinate is within 4 units in the last place. Centers of thin simplices are far away,
        and infinite beyond the range of doubles. In a flat, they lie in it, up to rounding.
        """
        if self._is_flat:
            return sealed(flats.circumcenters(self._points, self._simplices))
        return sealed(measures.circumcenters(self._points, self._simplices, self._workers))

    @kept
    def _sizes(self) -> Floats:
        if self._is_flat:
            return sealed(flats.sizes(self._points, self._simplices))
        return sealed(measures.sizes(self._points, self._simplices, self._workers))

    @property
    @only(2, "tetrahedra have `volumes`")
    def areas(self) -> Floats:
        """Areas of the triangles, (m,), in the square of the unit of the points; 2-D only.

        All positive, with a relative error below 1e-13, except beyond the range of doubles.
        """
        return self._sizes()

    @property
    @only((3, *HIGHER), "triangles have `areas`")
    def volumes(self) -> Floats:
        """Volumes of the simplices, (m,), in the unit of the points to the power d; not in 2-D.

        All positive, with a relative error below 1e-13, except beyond the range of doubles.
        """
        return self._sizes()

    @only(FLAT_OR_SOLID, "`volumes` and `circumcenters` exist in every dimension")
    @kept
    def quality(self) -> Any:
        """Measure the shapes of the simplices.

        Returns
        -------
        Quality or TetQuality
            In 2-D angles, areas and ratios of radii and edges; in 3-D dihedral angles, volumes and
            the same ratios.

        Examples
        --------
        >>> from delone import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).quality().largest_angle
        array([90.])
        >>> Delaunay([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]).quality().largest_dihedral
        array([90.])
        """
        return self._dimension.quality(self._points, self._simplices, self._workers)

    @property
    @kept
    def _locator(self) -> Any:
        """The index over the simplices."""
        return self._dimension.locator(self._points, self._simplices, self._neighbors)

    @property
    @kept
    def _whole_locator(self) -> Any:
        """The index over the simplices of the whole convex hull."""
        if self._number is None:
            return self._locator
        return self._dimension.locator(self._points, *self._tiling())

    @property
    @kept
    def _sites(self) -> tuple[Any, Indices | None]:
        """An index that finds the nearest vertex, and the rows of its points; None for all."""
        triangulate = self._dimension.delaunay
        if triangulate is None:
            return self._locator, None
        rows = np.unique(self._simplices)
        if not len(rows):
            return None, rows
        sites = self._points[rows]
        return self._dimension.locator(sites, *triangulate(sites, as_workers(self._workers))), rows

    def find_simplex(self, xi: ArrayLike, *, tolerance: float = 0.0) -> Indices:
        """Find the simplices that contain points.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points to locate. NaN and infinity are outside.
        tolerance : float, optional
            Points that are at most this far outside, in the unit of the points, are in the simplex
            at the nearest point of the boundary, such as points that lie on a side up to rounding.
            By default 0. The distance is compared exactly, which takes about 20 microseconds for
            each point at about this distance. Only in 2-D and 3-D.

        Returns
        -------
        ndarray of int32, shape (...)
            The simplex with the point inside or on its boundary, the first one if there are
            several; -1 if there is none, that is, outside or in a hole. The shape is () for a
            single point.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., d).
        InputError
            `tolerance` is negative or NaN.

        Notes
        -----
        Points are taken along a space-filling curve, and each is reached by a visibility walk from
        the previous one; for k points this takes O(k log k) time plus that of the walks, in any
        order. A visibility walk terminates in every Delaunay triangulation (L. De Floriani et al.,
        "On sorting triangles in a Delaunay tessellation", 1991); a straight walk is used where
        triangles are constrained, and a tree of boxes where there are holes.

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

        A point on a slanted side is rarely on it exactly:

        >>> mesh = Delaunay([(0, 0), (3, 1), (1, 3)])
        >>> place = (0.9, 0.3)
        >>> mesh.find_simplex(place), mesh.find_simplex(place, tolerance=1e-15)
        (array(-1, dtype=int32), array(0, dtype=int32))
        """
        if tolerance != 0:
            return self.locate(xi, tolerance=tolerance).simplex
        queries = as_queries(xi, self._dimension.ndim, self.crs)
        return location.find(self._dimension, self._locator, queries, self._workers)

    def nearest(self, xi: ArrayLike) -> Indices:
        """Find the vertices that are nearest to points.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points, inside or outside.

        Returns
        -------
        ndarray of int32, shape (...)
            The nearest vertex of a simplex, the one with the smallest row if there are several; -1
            if a coordinate is NaN or infinite.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., d).

        Notes
        -----
        Exact: distances are compared by predicates. In 2-D, the search goes from vertex to vertex:
        in a Delaunay triangulation, a neighbor of each vertex is nearer until the nearest one is
        reached. For any other triangulation, the first call computes a Delaunay triangulation of
        the vertices. In 3-D, and at vertices of high degree, the search uses a tree of boxes over
        the vertices.

        Examples
        --------
        >>> from delone import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).nearest([(0.9, 0.2), (5, 6), (0.5, 0.5)])
        array([1, 2, 0], dtype=int32)
        """
        queries = as_queries(xi, self._dimension.ndim, self.crs)
        return location.nearest(self._dimension, self._sites, queries, self._workers)

    def locate(self, xi: ArrayLike, *, tolerance: float = 0.0) -> location.Location:
        """Locate points: simplices, barycentric weights, nearest points of the boundary.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points to locate.
        tolerance : float, optional
            Points that are at most this far outside, in the unit of the points, are inside, at the
            nearest point of the boundary, such as points that lie on a side up to rounding. By
            default 0. The distance is compared exactly. Only in 2-D and 3-D.

        Returns
        -------
        Location
            With fields `simplex`, `barycentric`, `closest`, `beside`, `facet` and `weights`. In
            more than three dimensions the nearest points of the boundary are not sought: the last
            four are NaN or -1 outside.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., d).
        InputError
            `tolerance` is negative or NaN.

        Notes
        -----
        Which simplex, and inside or outside, is exact. Weights are rounded, but none is negative,
        and at a vertex they are exactly 1 and 0. The first call builds an index, which takes a
        fraction of the time of the triangulation; points are taken along a space-filling curve,
        each starting from the simplex of the previous one. Where the boundary is not convex, a tree
        of boxes finds what a walk cannot reach, and the nearest facet.

        Examples
        --------
        >>> from delone import Delaunay
        >>> mesh = Delaunay([(0, 0), (4, 0), (0, 4)])
        >>> place = mesh.locate([(1, 2), (3, 3)])
        >>> place.simplex
        array([ 0, -1], dtype=int32)
        >>> place.barycentric[0] @ mesh.points[mesh.simplices[0]]
        array([1., 2.])
        >>> place.closest
        array([[1., 2.],
               [2., 2.]])
        >>> mesh.locate((3, 3), tolerance=1.5).barycentric @ mesh.points[mesh.simplices[0]]
        array([2., 2.])
        """
        return location.locate_near(
            self._dimension,
            self._locator,
            self._points,
            self._simplices,
            as_queries(xi, self._dimension.ndim, self.crs),
            tolerance=tolerance,
            workers=self._workers,
        )

    @only(2, "locate points of the segment with `find_simplex`")
    def walk(self, a: ArrayLike, b: ArrayLike) -> Indices:
        """Return the triangles along a segment; 2-D only.

        Parameters
        ----------
        a, b : array_like, shape (2,)
            Ends of the segment, inside or outside.

        Returns
        -------
        ndarray of int32, shape (k,)
            The triangles that contain more than one point of the segment, in order from a to b.
            Where it runs along an edge, the triangle to its left, or the only adjacent one. Parts
            outside and in holes are skipped; a segment of length zero is located as a point.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError
            An end is not a finite 2-D point.
        AttributeError
            The points are 3-D.

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
        return along(self._whole_locator, tiling, self._number, start, end)

    @only(2, "geopandas has no polyhedra")
    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Convert to a table of polygons (extra ``geo``); 2-D only.

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each triangle. The geometry of a GeoDataFrame is
            replaced; its reference system and index are kept.
        crs : optional
            Reference system of the coordinates, anything that geopandas accepts; by default that of
            the geometries that were triangulated, if any.

        Returns
        -------
        geopandas.GeoDataFrame
            One row for each triangle: its vertices ``v0``, ``v1`` and ``v2``, values such as
            ``region``, and its geometry, of a surface with heights.

        Raises
        ------
        MissingExtraError
            geopandas or shapely is not installed.
        InputError
            `data` does not have one row for each triangle.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> frame = ConstrainedDelaunay([(0, 0), (1, 0), (0, 1)], []).to_geopandas()
        >>> frame.region.tolist(), frame.area.tolist()
        ([0], [0.5])
        """
        from delone.exchange.geopandas import to_geopandas

        parts, heights = self._parts(), getattr(self, "z", None)
        if heights is not None:
            parts = parts._replace(points=np.column_stack((parts.points, heights)))
        return to_geopandas(parts, crs, data)

    @only(2, "matplotlib has no tetrahedral meshes")
    def to_matplotlib(self) -> Any:
        """Convert to a matplotlib triangulation (extra ``plot``); 2-D only.

        Returns
        -------
        matplotlib.tri.Triangulation
            For ``tripcolor``, ``tricontour`` and similar functions.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.

        Examples
        --------
        >>> from delone import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).to_matplotlib().triangles.shape
        (1, 3)
        """
        from delone.exchange.matplotlib import to_matplotlib

        return to_matplotlib(self._parts())

    @only(FLAT_OR_SOLID, "scikit-fem has no meshes of more dimensions")
    def to_skfem(self, *, order: int = 1) -> Any:
        """Convert to a scikit-fem mesh (extra ``fem``).

        Parameters
        ----------
        order : {1, 2}, optional
            With 2, elements of second order, with a node in the middle of each edge: nodes are the
            points and then the `edges`, row by row.

        Returns
        -------
        skfem.MeshTri or skfem.MeshTet
            With subdomains ``"region 0"`` and so on where there are regions. Segments are
            boundaries: ``"marker 0"`` and so on if they have markers, like those of a `Mesh`;
            otherwise, all of them are ``"segments"``.

        Raises
        ------
        InputError
            `order` is neither 1 nor 2.
        MissingExtraError
            scikit-fem is not installed.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> list(delone.mesh(square).to_skfem().boundaries)
        ['marker 0']
        >>> list(delone.ConstrainedDelaunay(*square).to_skfem().boundaries)
        ['segments']
        """
        from delone.exchange.skfem import to_skfem

        return to_skfem(self._parts(), order=order)

    @only(FLAT_OR_SOLID, "DOLFINx has no meshes of more dimensions")
    def to_dolfinx_arrays(self, *, order: int = 1) -> dict[str, NDArray[Any]]:
        """Convert to the arrays from which DOLFINx makes a mesh.

        Parameters
        ----------
        order : {1, 2}, optional
            With 2, elements of second order, with a node in the middle of each edge: nodes are the
            points and then the `edges`, row by row.

        Returns
        -------
        dict of ndarray
            ``cells`` and ``x`` for ``dolfinx.mesh.create_mesh``; with regions ``cell_tags``, and
            with segments or marked faces ``facets`` (their nodes) and ``facet_tags`` (markers). Of
            these, ``dolfinx.io.distribute_entity_data`` and ``meshtags_from_entities`` make tags.

        Raises
        ------
        InputError
            `order` is neither 1 nor 2.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> sorted(delone.mesh(square).to_dolfinx_arrays())
        ['cell_tags', 'cells', 'facet_tags', 'facets', 'x']
        """
        from delone.exchange.dolfinx import to_dolfinx_arrays

        return to_dolfinx_arrays(self._parts(), order=order)


def require_whole(mesh: Triangulation | None, what: str) -> None:
    """Raise if the points of a triangulation are in a flat."""
    if mesh is not None and mesh._is_flat:
        raise InputError(
            f"the points of the triangulation lie in a flat, where {what} is not available: pass "
            "only the columns that determine the others; distances are then those in these columns"
        )


class HullTiling(Triangulation):
    """A triangulation that is part of a triangulation of the convex hull of its points."""

    __slots__ = ()

    @property
    @kept
    def convex_hull(self) -> Indices:
        """The facets of the convex hull, (h, d), as in SciPy: `boundary` without holes and bays.

        `hull` contains the vertices.
        """
        return sealed(self._dimension.boundary(*self._tiling()))

    @property
    @kept
    def hull(self) -> NDArray[np.int64]:
        """The vertices on the convex hull, (h,), including those inside its sides.

        In 2-D, counter-clockwise from the lexicographically smallest point on; in 3-D, ascending.
        """
        return sealed(self._dimension.hull(self._points, self.convex_hull))


class PointTriangulation(HullTiling):
    """A triangulation of given points, some of which may be equal."""

    __slots__ = ("_duplicates",)

    _ARRAYS: ClassVar[tuple[str, ...]] = ("points", "simplices", "neighbors", "duplicates")

    _duplicates: Indices

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The vertex of each row, (n,): the first row with the same coordinates."""
        return sealed(vertices_of(self._duplicates, self.npoints))
