"""The class Delaunay of directions: a triangulation of the sphere, or of a hull on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_flag, as_workers
from delone._base.counting import counted
from delone._base.duplicates import vertices_of
from delone._base.immutable import kept, sealed
from delone._base.numbers import as_nonnegative
from delone._tiling import measures
from delone._tiling.plane import topology
from delone.errors import InternalError
from delone.exchange.parts import Parts
from delone.sphere.coordinates import directions_of, queries_of
from delone.sphere.globe import OnGlobe
from delone.sphere.nearby import nearby

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices, Rows
    from delone.sphere.validation import SphereReport

__all__ = ["Delaunay"]

# Fewer points use a single thread.
_FEW = 1000
# The arrays of an object, by name.
_ARRAYS = ("vectors", "simplices", "neighbors", "duplicates")
# The classes in files; subclasses defined elsewhere are stored as these.
_STORED = ("Delaunay", "ConstrainedDelaunay")


class Delaunay(OnGlobe):
    """The Delaunay triangulation of directions: of geographic points or vectors.

    Parameters
    ----------
    lonlat : array_like, shape (n, 2), optional
        Longitudes and latitudes, in degrees unless `degrees` is false. Longitudes may be from -180
        to 180, from 0 to 360, or anything up to three turns.
    xyz : array_like, shape (n, 3), optional
        Vectors from the center of the sphere. Their lengths do not matter: a vector represents
        exactly its direction. Give either this or `lonlat`.
    degrees : bool, optional
        Whether `lonlat`, and longitudes and latitudes of queries, are in degrees (the default) or
        in radians.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.

    Attributes
    ----------
    vectors : ndarray of float64, shape (n, 3)
        The vectors for whose directions the result is exact: `xyz`, or (cos lon, sin lon, tan lat).
    points : ndarray of float64, shape (n, 3)
        The unit vectors of these directions, rounded.
    lonlat : ndarray of float64, shape (n, 2)
        Longitudes, -180 to 180, and latitudes in degrees, rounded.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `vectors`, counter-clockwise seen from outside.
    neighbors : ndarray of int32, shape (m, 3)
        ``neighbors[t, k]`` is the triangle across the edge opposite vertex k of triangle t; -1
        beyond the boundary of a hull.
    duplicates : ndarray of int32, shape (d, 2)
        Rows that have the direction of an earlier row, and the first such row, which is the vertex.
    covers_sphere : bool
        Whether the triangles cover the whole sphere; otherwise all points are in one hemisphere.

    Raises
    ------
    DegenerateInputError
        Fewer than three directions are distinct, or all are on one great circle; ``error.chain``
        has them in order around it.
    DirectionError
        A vector is zero, a latitude is beyond a pole, or a longitude exceeds three turns;
        ``error.rows`` has the first such rows.
    NonFiniteError
        A coordinate is NaN or infinite; ``error.rows`` has the first such rows.
    ShapeError, DtypeError
        The input is not a real array of shape (n, 2) or (n, 3); both or neither are given.
    LimitError
        There are more than 2**27 points.
    MemoryError
        There is not enough memory.
    KeyboardInterrupt
        Ctrl-C was pressed. No partial result remains.

    Warns
    -----
    LongitudeWarning
        Longitudes span more than 360 degrees: two conventions seem to be mixed. The directions are
        the same in both.

    Notes
    -----
    The triangles are those whose circle on the sphere contains no other direction: the facets of
    the convex hull of the directions whose inner side faces the center. If all points are in one
    hemisphere, facets of the hull that face the other way would span the empty part of the sphere;
    they are not triangles. Each distinct direction is a vertex, at any spacing.

    Predicates are exact for the given vectors, square roots included; rounded unit vectors would
    not be on the sphere. If more than three directions are on one empty circle, their polygon is a
    fan from its smallest vertex in an order of directions, so a set of directions has one
    triangulation, independent of the order and the lengths of its rows. Longitudes and latitudes
    become vectors by sines and cosines that are the same on all platforms: degrees are reduced
    exactly, points of one meridian are exactly on one great circle, and poles and the date line are
    exact. Other grid points on a parallel tie only if they are mirror images of each other.

    Insertion along a space-filling curve (Bowyer; Watson, both 1981): O(n log n) on scattered
    points, O(n²) at worst. All arrays are read-only; areas, circumcenters and edges are computed on
    first use and kept.

    Examples
    --------
    >>> from delone import sphere
    >>> mesh = sphere.Delaunay(lonlat=[(0, 90), (0, 0), (120, 0), (-120, 0), (30, -60)])
    >>> mesh
    <Delaunay of 5 directions: 6 triangles, the whole sphere>
    >>> round(float(mesh.areas.sum()) / 3.141592653589793, 9)
    4.0

    All in one hemisphere:

    >>> sphere.Delaunay(xyz=[(1, 0, 9), (0, 1, 9), (-1, 0, 9), (0, -1, 9), (0, 0, 1)])
    <Delaunay of 5 directions: 4 triangles>
    """

    __slots__ = (
        "_degrees",
        "_duplicates",
        "_neighbors",
        "_simplices",
        "_vectors",
    )

    _degrees: bool
    _duplicates: Indices
    _neighbors: Indices
    _simplices: Indices
    _vectors: Floats

    def __init__(
        self,
        *,
        lonlat: ArrayLike | None = None,
        xyz: ArrayLike | None = None,
        degrees: bool = True,
        workers: int | None = None,
    ) -> None:
        as_flag(degrees, name="degrees")
        vectors = directions_of(lonlat, xyz, degrees=degrees, workers=workers)
        self._build(vectors, degrees, workers)

    def _build(self, vectors: Floats, degrees: bool, workers: int | None) -> None:
        """Triangulate vectors that nobody else can change."""
        threads = 1 if workers is None and len(vectors) < _FEW else as_workers(workers)
        try:
            made = _core.sphere_delaunay(vectors, threads)
        except InternalError as error:
            error.points = vectors
            raise
        self._fill(
            {
                "vectors": vectors,
                "simplices": made.simplices,
                "neighbors": made.neighbors,
                "duplicates": made.duplicates,
            },
            degrees,
            workers,
        )

    @classmethod
    def _of_vectors(cls, vectors: Floats, degrees: bool, workers: int | None) -> Self:
        made = cls.__new__(cls)
        made._build(vectors, degrees, workers)
        return made

    def _fill(self, arrays: dict[str, NDArray[Any]], degrees: bool, workers: int | None) -> None:
        held = {name: sealed(array) for name, array in arrays.items()}
        self._hold(degrees=degrees, workers=workers, **held)

    @classmethod
    def _from_arrays(
        cls, arrays: dict[str, NDArray[Any]], degrees: bool, workers: int | None
    ) -> Self:
        made = cls.__new__(cls)
        made._fill(arrays, degrees, workers)
        return made

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {name: getattr(self, f"_{name}") for name in _ARRAYS}

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._from_arrays, (self._arrays(), self._degrees, self._workers)

    @classmethod
    def _stored_as(cls) -> str:
        return next(f"sphere.{each.__name__}" for each in cls.__mro__ if each.__name__ in _STORED)

    def _saved(self) -> dict[str, NDArray[Any]]:
        return self._arrays() | {"options": np.array([self._degrees], dtype=np.int64)}

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        own = {name: arrays[name] for name in _ARRAYS}
        return cls._from_arrays(own, bool(arrays["options"][0]), None)

    def _described(self) -> str:
        whole = ", the whole sphere" if self.covers_sphere else ""
        return f"{self._counts()}: {counted(self.nsimplex, 'triangle')}{whole}"

    def _counts(self) -> str:
        """What is triangulated, for ``repr``."""
        points = counted(self.npoints, "direction")
        if duplicates := len(self._duplicates):
            points += f" ({counted(duplicates, 'duplicate')})"
        return points

    def _parts(self) -> Parts:
        longitude, latitude = self.lonlat.T
        values = {"longitude": longitude, "latitude": latitude}
        return Parts(self.points, self.simplices, of_points=values)

    @property
    def simplices(self) -> Indices:
        """The triangles as rows of `vectors`, counter-clockwise seen from outside, (m, 3)."""
        return self._simplices

    @property
    def neighbors(self) -> Indices:
        """The triangle opposite each vertex, (m, 3); -1 beyond the boundary of a hull."""
        return self._neighbors

    @property
    def duplicates(self) -> Indices:
        """Rows that have the direction of an earlier row, and the first such row, (d, 2)."""
        return self._duplicates

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The vertex of each row, (n,): the first row with the same direction."""
        return sealed(vertices_of(self._duplicates, self.npoints))

    @property
    def nsimplex(self) -> int:
        """Number of triangles."""
        return len(self._simplices)

    @property
    def covers_sphere(self) -> bool:
        """Whether the triangles cover the whole sphere."""
        # A hull on the sphere of n vertices, h on its boundary, has 2 n - h - 2 triangles.
        return self.nsimplex == 2 * (self.npoints - len(self._duplicates)) - 4

    @property
    @kept
    def edges(self) -> Indices:
        """Every edge once, (k, 2): the smaller vertex first, rows ascending."""
        workers = self._workers
        return sealed(measures.edges(self._simplices, self._neighbors, self.npoints, workers))

    @property
    @kept
    def boundary(self) -> Indices:
        """The edges of the boundary of a hull, (h, 2), with triangles to their left."""
        return sealed(topology.boundary_edges(self._simplices, self._neighbors))

    @property
    @kept
    def areas(self) -> Floats:
        """The areas of the triangles in steradians, (m,), accurate even for slivers.

        The whole sphere has 4 pi. Multiply by the square of the radius, which is 6371.0088 km for
        the Earth.
        """
        found = _core.sphere_areas(self._vectors, self._simplices, as_workers(self._workers))
        return sealed(found)

    @property
    @kept
    def circumcenters(self) -> Floats:
        """The unit vectors, rounded, that are equally far from the three corners, (m, 3)."""
        workers = as_workers(self._workers)
        return sealed(_core.sphere_circumcenters(self._vectors, self._simplices, workers))

    @property
    @kept
    def _locator(self) -> _core.SphereLocator:
        workers = as_workers(self._workers)
        return _core.SphereLocator(self._vectors, self._simplices, self._neighbors, workers)

    def find_simplex(self, xi: ArrayLike, *, tolerance: float = 0.0) -> Indices:
        """Return the triangles that contain directions.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length.
        tolerance : float, optional
            Directions outside a hull, at most this angle from its boundary, count as in the nearest
            triangle; in the unit of the constructor.

        Returns
        -------
        ndarray of int32, shape (...)
            The triangle of each, boundaries included; on an edge or a vertex, the triangle with the
            smallest number. -1 outside a hull, and for NaN and vectors of length zero.

        Raises
        ------
        InputError
            `tolerance` is negative or NaN.
        DirectionError
            A latitude is beyond a pole, or a longitude exceeds three turns.
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., 2) or (..., 3).

        Notes
        -----
        Exact. Directions are located along a space-filling curve, each starting from the triangle
        of the previous one; the results do not depend on the order. With a `tolerance`, which is
        also exact, directions outside are compared with all edges of the boundary.

        Examples
        --------
        >>> from delone import sphere
        >>> mesh = sphere.Delaunay(lonlat=[(170, 0), (-170, 0), (180, 10), (180, -10)])
        >>> mesh.find_simplex([(180, 1), (0, 0)]) >= 0
        array([ True, False])
        """
        limit = as_nonnegative(tolerance, name="tolerance")
        found = self._ask(xi, self._locator.find)
        if not limit or self.covers_sphere:
            return found
        queries = queries_of(xi, degrees=self._degrees, workers=self._workers).reshape(-1, 3)
        flat = found.reshape(-1)
        outside, arc = self._nearby(queries, flat, limit)
        triangles, _ = np.nonzero(self._neighbors < 0)
        flat[outside] = triangles[arc]
        return flat.reshape(found.shape)

    def _nearby(self, queries: Floats, simplex: Indices, limit: float) -> tuple[Rows, Rows]:
        """Return the queries outside but near the boundary, and a boundary edge for each."""
        known = np.isfinite(queries).all(axis=1) & queries.any(axis=1)
        outside = np.flatnonzero((simplex < 0) & known)
        arc = nearby(
            self._vectors, self.points, self.boundary, queries[outside], limit,
            degrees=self._degrees,
        )  # fmt: skip
        return outside[arc >= 0], arc[arc >= 0]

    def nearest(self, xi: ArrayLike) -> Indices:
        """Return the rows of the points nearest to directions.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length.

        Returns
        -------
        ndarray of int32, shape (...)
            The vertex at the smallest angle from each; of several, the smallest row. -1 for NaN and
            vectors of length zero.

        Raises
        ------
        DirectionError
            A latitude is beyond a pole, or a longitude exceeds three turns.
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., 2) or (..., 3).

        Notes
        -----
        Exact, square roots included: a walk to the triangle, and then from vertex to nearer vertex.
        Beyond a hull, the points of its boundary are compared.

        Examples
        --------
        >>> from delone import sphere
        >>> mesh = sphere.Delaunay(lonlat=[(170, 0), (-170, 0), (180, 10), (180, -10)])
        >>> mesh.nearest([(175, 1), (-171, 1)])
        array([0, 1], dtype=int32)
        """
        return self._ask(xi, self._locator.nearest)

    def validate(self) -> SphereReport:
        """Prove that this is the canonical Delaunay triangulation, or list the faults.

        Returns
        -------
        SphereReport
            Truthy if there are no faults: triangles are counter-clockwise and tile the sphere or
            the exact hull, neighbors are mutual, each distinct direction is a vertex, each edge is
            locally Delaunay, and ties are broken canonically.

        Notes
        -----
        Exact for the given vectors, square roots included. Signs that rounded determinants do not
        prove, such as those of points a meter apart or exact ties, are computed with integers in
        Python. This takes about 20 microseconds per sign, or a minute for a million triangles a
        centimeter wide.

        Examples
        --------
        >>> from delone import sphere
        >>> print(sphere.Delaunay(lonlat=[(0, 0), (90, 0), (0, 90), (45, 45)]).validate())
        a canonical Delaunay triangulation of directions
        """
        from delone.sphere.validation import validate

        arrays = self._simplices, self._neighbors, self._duplicates
        return validate(self._vectors, self.points, *arrays)

    def to_meshio(self) -> Any:
        """Convert to a meshio mesh (extra ``mesh``), with x, y, z on the unit sphere.

        Returns
        -------
        meshio.Mesh
            The triangles, and the longitude and latitude of each point in degrees as values.

        Raises
        ------
        MissingExtraError
            meshio is not installed.

        Examples
        --------
        >>> from delone import sphere
        >>> mesh = sphere.Delaunay(lonlat=[(0, 0), (90, 0), (0, 90)])
        >>> mesh.to_meshio().cells_dict["triangle"].shape
        (1, 3)
        """
        from delone.exchange.meshio import to_meshio

        return to_meshio(self._parts())

    def to_pyvista(self) -> Any:
        """Convert to a PyVista surface (extra ``pyvista``) on the unit sphere.

        Returns
        -------
        pyvista.PolyData
            The triangles, and the longitude and latitude of each point in degrees as values.

        Raises
        ------
        MissingExtraError
            PyVista is not installed.

        Examples
        --------
        >>> from delone import sphere
        >>> sphere.Delaunay(lonlat=[(0, 0), (90, 0), (0, 90)]).to_pyvista().n_cells
        1
        """
        from delone.exchange.pyvista import to_pyvista

        return to_pyvista(self._parts())

    def _draw(self, ax: Any, points: bool | None, options: dict[str, Any]) -> Any:
        from delone.sphere.picture import plot_mesh

        return plot_mesh(self, ax, points, options)

    def _ask(self, xi: ArrayLike, answer: Any) -> Indices:
        queries = queries_of(xi, degrees=self._degrees, workers=self._workers)
        found: Indices = answer(queries.reshape(-1, 3), as_workers(self._workers))
        return found.reshape(queries.shape[:-1])
