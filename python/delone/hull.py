"""The class ConvexHull: a convex hull in 2 to 8 dimensions as immutable arrays."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from delone import _core, predicates
from delone._base.arrays import as_choice, as_queries, as_workers, require_finite
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.immutable import kept, own_copy, sealed
from delone._tiling import measures
from delone._tiling.complex import Complex
from delone._tiling.dimension import only
from delone._tiling.higher import hull as higher
from delone._tiling.higher.dimension import MOST
from delone._tiling.higher.flats import axes_of
from delone._tiling.higher.hull import hull_arrays
from delone._tiling.higher.size import require_room
from delone._tiling.higher.thin import warn_of_rounding
from delone._tiling.plane import geometry as plane
from delone._tiling.plane.topology import vertex_to_simplex
from delone._tiling.space import geometry as space
from delone.delaunay import Delaunay
from delone.errors import InputError, InternalError
from delone.validation import ValidationReport, fault

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.exchange.parts import Parts
    from delone.validation import Sentences

__all__ = ["ConvexHull"]


@dataclass(frozen=True, eq=False, kw_only=True)
class HullReport(ValidationReport):
    """The result of ``ConvexHull.validate()``: truthy if the hull is correct.

    Parameters
    ----------
    neighbors : ndarray of int, shape (k,)
        Simplices whose neighbors are not mutual.
    concave : ndarray of int, shape (k, 2)
        Adjacent simplices that do not meet at a convex angle or, within one facet, are not
        coplanar.
    outside : ndarray of int, shape (k,)
        Rows of points outside.
    vertices : ndarray of int, shape (k,)
        Rows that are only in one of `vertices` and `facets`.
    facets : ndarray of int, shape (k,)
        Facets that are not the polygons of their simplices.

    Examples
    --------
    >>> from delone import ConvexHull
    >>> bool(ConvexHull([(0, 0), (2, 0), (0, 2), (1, 1)]).validate())
    True
    """

    concave: NDArray[np.integer] = fault(
        "pair of simplices is not convex", "pairs of simplices are not convex", width=2
    )
    outside: NDArray[np.integer] = fault("point is outside", "points are outside")
    vertices: NDArray[np.integer] = fault(
        "row is only in one of vertices and facets", "rows are only in one of vertices and facets"
    )
    facets: NDArray[np.integer] = fault(
        "facet is not the polygon of its simplices",
        "facets are not the polygons of their simplices",
    )

    _SUBJECT: ClassVar[str] = "a convex hull"
    _SAID: ClassVar[Sentences] = {
        "neighbors": ("simplex has wrong neighbors", "simplices have wrong neighbors")
    }


class ConvexHull(Complex):
    """The convex hull of points with two to eight coordinates.

    Parameters
    ----------
    points : array_like, shape (n, d)
        Finite coordinates, two to eight for each point, in any unit: floats of up to 64 bits,
        integers up to 2**53. They are copied, and results are exact for them.
    workers : int, optional
        Maximum number of threads for measures; by default one per core. The hull itself uses one
        thread.
    max_bytes : int, optional
        From 4-D on: the maximum memory of the hull, as for `Delaunay`; by default the free memory.
    flat : {"raise", "project"}, optional
        From 4-D on, what to do with points that all lie in a flat of k < d dimensions: raise
        DegenerateInputError (the default), or return their hull in the flat. `simplices` then have
        k corners, `volume` and `area` are measured in the flat, and the normals of `equations` are
        directions in it. `contains` projects points to the flat, as `Delaunay` does.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    simplices : ndarray of int32, shape (h, d)
        Edges with the hull to their left, or triangles, counter-clockwise as seen from outside, as
        rows of `points`. In 3-D, each begins with its lexicographically smallest point; in 2-D,
        they follow each other counter-clockwise. In more dimensions, simplices of d corners, which
        are positively oriented when they follow an interior point.
    neighbors : ndarray of int32, shape (h, d)
        ``neighbors[i, k]`` is the simplex that shares all vertices of simplex i but vertex k.
    vertices : ndarray of int32, shape (v,)
        The extreme points: in 2-D counter-clockwise, starting with the lexicographically smallest;
        otherwise ascending.
    facets : tuple of ndarray of int32
        The sides of the hull: in 2-D its edges, in 3-D polygons of their extreme points,
        counter-clockwise as seen from outside, starting with the lexicographically smallest; in
        more dimensions their extreme points, ascending.
    facet_of : ndarray of int32, shape (h,)
        The facet of each simplex.

    Raises
    ------
    DegenerateInputError
        The points span no area, or no volume; the error is the same as for `Delaunay`.
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        `points` is not a real array of shape (n, d), with d from 2 to 8.
    TooLargeError
        From 4-D on: the facets would not fit into memory, or `max_bytes`; it is a MemoryError.
    MemoryError
        There is not enough memory.
    KeyboardInterrupt
        Ctrl-C was pressed. No partial result remains.

    Warns
    -----
    NearlyFlatWarning
        From 4-D on: the points lie in a flat except for rounding errors.

    See Also
    --------
    Delaunay.convex_hull : The boundary of a triangulation, in which all points on it are vertices.

    Notes
    -----
    The result is exact. A vertex is an extreme point, so points in the middle of an edge or a facet
    are not vertices; of rows with the same coordinates the first is the vertex. A facet with more
    than d vertices is triangulated by the Delaunay rule in its plane, with ties broken by
    coordinates. A set of points therefore has one hull, with one order of its arrays, independent
    of the order of its rows; it is the boundary of ``Delaunay(points[hull.vertices])``.

    Time is O(n log n) in 2-D (A. M. Andrew, 1979) and O(n log n) expected in 3-D (K. L. Clarkson
    and P. W. Shor, 1989); points far inside need only a few comparisons. Names, dtypes and meanings
    are those of ``scipy.spatial.ConvexHull``. All arrays are read-only; attributes that are not
    listed above are computed on first use and kept.

    Examples
    --------
    >>> from delone import ConvexHull
    >>> cube = ConvexHull([(x, y, z) for x in (0, 1, 2) for y in (0, 1, 2) for z in (0, 1, 2)])
    >>> cube
    <ConvexHull of 27 points: 8 vertices, 6 facets>
    >>> cube.volume, cube.area, cube.simplices.shape
    (8.0, 24.0, (12, 3))
    >>> cube.points[cube.facets[0]].tolist()
    [[0.0, 0.0, 0.0], [0.0, 0.0, 2.0], [0.0, 2.0, 2.0], [0.0, 2.0, 0.0]]
    """

    __slots__ = ("_duplicates", "_facet_of", "_inside", "_polygons", "_starts", "_vertices")

    _ARRAYS = (
        "points",
        "simplices",
        "neighbors",
        "vertices",
        "facet_of",
        "inside",
        "polygons",
        "starts",
        "duplicates",
    )

    _duplicates: Indices
    _facet_of: Indices
    # From 4-D on, a point for each simplex that is not in its plane.
    _inside: Indices
    _polygons: Indices
    _starts: Indices
    _vertices: Indices

    def __init__(
        self,
        points: ArrayLike,
        *,
        workers: int | None = None,
        max_bytes: int | None = None,
        flat: str = "raise",
    ) -> None:
        stays = as_choice(flat, ("raise", "project"), name="flat") == "project"
        # Three points span a plane, however many coordinates they have.
        own = own_copy(points, ndim=None, most=MOST, few=stays)
        require_finite(own)
        if own.shape[1] > 3:
            require_room(own, max_bytes, hull=True)
        elif max_bytes is not None:
            raise InputError("max_bytes is only available from 4-D on, where facets are many")
        if stays and own.shape[1] in _ARRAYS_OF:
            raise InputError('flat="project" is only available from 4-D on')
        if workers is not None:
            as_workers(workers)
        if own.shape[1] in _ARRAYS_OF:
            arrays = _ARRAYS_OF[own.shape[1]](own)
        else:
            arrays = hull_arrays(own, stays=stays)
        if arrays is None:
            Delaunay(own)  # The error says what the points span instead.
            error = InternalError("the hull of points that span a simplex is flat")
            error.points = own
            raise error
        if own.shape[1] == arrays["simplices"].shape[1] and own.shape[1] not in _ARRAYS_OF:
            warn_of_rounding(own)
        without = {"inside": np.empty(0, dtype=np.int32)}
        self._fill(without | arrays | {"points": own}, {}, workers)
        self._refer(points)

    def validate(self) -> HullReport:
        """Prove that this is the convex hull of the points, or list the faults.

        Returns
        -------
        HullReport
            Truthy if there are no faults: neighbors are mutual, adjacent simplices meet at a convex
            angle or lie in one facet, no point is outside, and `vertices` and `facets` are those of
            the simplices.

        Notes
        -----
        The proof is exact and takes as long as locating all points.

        Examples
        --------
        >>> from delone import ConvexHull
        >>> print(ConvexHull([(0, 0), (2, 0), (0, 2), (1, 1)]).validate())
        a convex hull
        """
        mutual = (self._neighbors[self._neighbors] == np.arange(self.nsimplex)[:, None, None]).any(
            axis=2
        )
        row, k = np.nonzero(np.ones_like(self._neighbors, dtype=bool))
        beside = self._neighbors[row, k]
        others = self._simplices[beside]
        apart = (others[:, :, None] != self._simplices[row][:, None, :]).all(axis=2)
        apex = others[np.arange(len(others)), apart.argmax(axis=1)]
        signs, inner = self._sides(row, apex)
        same = self._facet_of[row] == self._facet_of[beside]
        wrong = (signs != np.where(same, 0, inner)) | (apart.sum(axis=1) != 1)
        return HullReport(
            neighbors=np.flatnonzero(~mutual.all(axis=1)),
            concave=np.column_stack((row[wrong], beside[wrong])),
            outside=np.flatnonzero(~self.contains(self._points)),
            vertices=np.setxor1d(self._vertices, self._polygons),
            facets=self._wrong_facets(),
        )

    def _sides(self, row: Rows, apex: Indices) -> tuple[NDArray[np.integer], int]:
        """Return the exact signs of points relative to simplices, and the sign of the inside."""
        if self.ndim > 3:
            cones = np.column_stack((apex, self._simplices[row])).astype(np.int32)
            return higher.orientations(self._points, cones, self._flat_axes), 1
        corners = [self._points[self._simplices[row, j]] for j in range(self.ndim)]
        orient: Any = predicates.orient2d if self.ndim == 2 else predicates.orient3d
        return orient(*corners, self._points[apex]), 1 if self.ndim == 2 else -1

    def _wrong_facets(self) -> NDArray[np.int64]:
        """Return the facets whose sides are not those between their simplices and other facets."""
        tail, size = self._polygons, np.diff(self._starts)
        facet = np.repeat(np.arange(len(size)), size)
        if self.ndim > 3:
            listed = np.column_stack((facet, tail))
            width = self._simplices.shape[1]
            pairs = (np.repeat(self._facet_of, width), self._simplices.reshape(-1))
            own = np.unique(np.column_stack(pairs), axis=0)
        elif self.ndim == 2:
            own = np.column_stack((self._facet_of, self._simplices))
            listed = np.column_stack((facet[::2], tail.reshape(-1, 2)))
        else:
            t, k = np.nonzero(self._facet_of[self._neighbors] != self._facet_of[:, None])
            ends = (self._simplices[t, (k + i) % 3] for i in (1, 2))
            own = np.column_stack((self._facet_of[t], *ends))
            head = np.roll(tail, -1)
            head[self._starts[1:] - 1] = tail[self._starts[:-1]]
            listed = np.column_stack((facet, tail, head))
        sides, times = np.unique(np.concatenate((own, listed)), axis=0, return_counts=True)
        return np.unique(sides[times != 2, 0]).astype(np.int64)

    def _saved(self) -> dict[str, NDArray[Any]]:
        return {"points": self._points}

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        points = arrays["points"]
        return cls(points, flat="raise" if points.shape[1] in _ARRAYS_OF else "project")

    @property
    def simplices(self) -> Indices:
        """Edges or triangles as rows of `points`, (h, d)."""
        return self._simplices

    @property
    def neighbors(self) -> Indices:
        """The simplex that shares all vertices but one, (h, d)."""
        return self._neighbors

    @property
    def vertices(self) -> Indices:
        """The extreme points, (v,)."""
        return self._vertices

    @property
    def facet_of(self) -> Indices:
        """The facet of each simplex, (h,)."""
        return self._facet_of

    @property
    @kept
    def facets(self) -> tuple[Indices, ...]:
        """The sides of the hull, as rows of `points`."""
        ends = self._starts.tolist()
        return tuple(self._polygons[start:end] for start, end in pairwise(ends))

    @property
    @kept
    def edges(self) -> Indices:
        """Every edge of `simplices` once, (k, 2): the smaller vertex first, rows ascending."""
        if self.ndim > 3:
            pairs = combinations(range(self._simplices.shape[1]), 2)
            ends = [self._simplices[:, pair] for pair in pairs]
            return sealed(np.unique(np.sort(np.concatenate(ends), axis=1), axis=0))
        if self.ndim == 3:
            topology = self._simplices, self._neighbors, self.npoints, as_workers(self._workers)
            return sealed(_core.edges(*topology))
        return sealed(np.unique(np.sort(self._simplices, axis=1), axis=0))

    @property
    @kept
    def coplanar(self) -> Indices:
        """The rows that repeat a vertex, (k, 3): row, a simplex of the vertex, the vertex."""
        row, first = self._duplicates.T
        simplex = vertex_to_simplex(self._simplices, self.npoints)
        return sealed(np.column_stack((row, simplex[first], first)))

    @property
    @kept
    def equations(self) -> Floats:
        """Outer unit normals and offsets of the simplices, (h, d + 1).

        ``normal @ x + offset`` is 0 on a facet, up to rounding, and negative inside. Simplices of
        one facet have one equation.
        """
        first = np.unique(self._facet_of, return_index=True)[1]
        corners = self._simplices[first]
        if self.ndim == 2:
            normals = plane.edge_normals(self._points, corners)
        elif self.ndim > 3:
            normals = higher.normals(self._points, corners, self._inside[first])
        else:
            normals = space.face_normals(self._points, corners, self._workers)
        with np.errstate(all="ignore"):
            offsets = -(normals * self._points[corners[:, 0]]).sum(axis=1)
            # Partial sums may leave the range of doubles even if the offset does not.
            far = ~np.isfinite(offsets)
            quarters = self._points[corners[far, 0]] / 4
            offsets[far] = -4 * (normals[far] * quarters).sum(axis=1)
        # Adding 0 turns -0 into 0.
        return sealed(np.column_stack((normals, offsets + 0.0))[self._facet_of])

    @property
    @kept
    def volume(self) -> float:
        """The volume; in 2-D, as in SciPy, the area.

        The relative error is below 1e-13. Beyond the range of doubles, the value is inf, or rounded
        to a subnormal number.
        """
        base = int(self._polygons[0])  # the lexicographically smallest, whatever the order of rows
        if self.ndim == 2:
            fan = np.column_stack((np.full(self.nsimplex, base), self._simplices))
            fan = fan[(self._simplices != base).all(axis=1)]
            return plane.total(measures.sizes(self._points, fan, self._workers))
        if self.ndim > 3:
            fan = np.column_stack((np.full(self.nsimplex, base, np.int32), self._simplices))
            above = higher.orientations(self._points, fan, self._flat_axes) > 0
            return plane.total(higher.sizes(self._points, fan[above], self._workers))
        a, b, c = self._simplices.T
        cones = np.column_stack((a, c, b, np.full(self.nsimplex, base)))
        above = predicates.orient3d(*(self._points[cones[:, k]] for k in range(4))) > 0
        return plane.total(measures.sizes(self._points, cones[above], self._workers))

    @property
    @kept
    def area(self) -> float:
        """The area of the surface; in 2-D, as in SciPy, the perimeter; inf beyond doubles."""
        if self.ndim == 2:
            with np.errstate(over="ignore"):
                along = np.subtract(*self._points[self._simplices.T])
                return plane.total(np.hypot(*along.T))
        if self.ndim > 3:
            surface = self._points, self._simplices, self._inside, self._workers
            return plane.total(higher.areas(*surface))
        return plane.total(space.face_areas(self._points, self._simplices, self._workers))

    def contains(self, xi: ArrayLike) -> Bools:
        """Return which points are in the hull, including its boundary.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points. NaN and infinity are outside.

        Returns
        -------
        ndarray of bool, shape (...)
            Whether each is inside or on the boundary, exactly.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., d).

        Notes
        -----
        This uses the triangulation of the vertices, which the first call computes and keeps.

        Examples
        --------
        >>> from delone import ConvexHull
        >>> ConvexHull([(0, 0), (2, 0), (0, 2)]).contains([(1, 1), (1.5, 1)]).tolist()
        [True, False]
        """
        queries = as_queries(xi, self.ndim, self.crs)
        found: Bools = self._tiling.find_simplex(queries) >= 0
        return found

    @property
    @kept
    def _tiling(self) -> Delaunay:
        """The triangulation of the vertices."""
        flat = "raise" if self._flat_axes is None else "project"
        corners = self._points[self._vertices]
        return Delaunay(corners, workers=self._workers, planar=True, flat=flat)

    @property
    @kept
    def _flat_axes(self) -> list[int] | None:
        """The axes of the flat that contains the points; None if they span the whole space."""
        if self._simplices.shape[1] == self.ndim:
            return None
        corners = np.append(self._simplices[0], self._inside[0])
        return axes_of(self._points, corners)

    @only(2, "`facets` are the polygons of a hull in 3-D")
    def polygon(self) -> Any:
        """Return the hull as one shapely polygon (extra ``geo``); 2-D only.

        Returns
        -------
        shapely.Polygon
            Counter-clockwise, without the points in the middle of a side.

        Raises
        ------
        MissingExtraError
            shapely is not installed.

        Examples
        --------
        >>> import delone
        >>> delone.ConvexHull([(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)]).polygon().area
        16.0
        """
        shapely = require("shapely", extra="geo", what="a polygon")
        return shapely.Polygon(self._points[self._vertices])

    @only(2, "write the surface with `to_meshio` or delone.io.write_mesh", beyond="use `save`")
    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Convert to a table with one polygon (extra ``geo``); 2-D only.

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row. The geometry of a GeoDataFrame is replaced; its
            reference system and index are kept.
        crs : optional
            Reference system of the coordinates, anything that geopandas accepts; by default that of
            the points, if they declared one.

        Returns
        -------
        geopandas.GeoDataFrame
            One row.

        Raises
        ------
        MissingExtraError
            geopandas or shapely is not installed.
        InputError
            `data` does not have one row.

        Examples
        --------
        >>> import delone
        >>> hull = delone.ConvexHull([(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)])
        >>> hull.to_geopandas({"name": ["site"]}).area.tolist()
        [16.0]
        """
        from delone.exchange.geopandas import beside

        own = self.crs if crs is None else crs
        return beside(np.array([self.polygon()]), data, own, of="hulls")

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        facets = {"facet_of": self._facet_of}
        return Parts(self._points, self._simplices, of_simplices=facets, crs=self.crs)

    def _described(self) -> str:
        vertices = f"{len(self._vertices)} vertices"
        if self.ndim > 2:
            vertices += f", {len(self._starts) - 1} facets"
        return f"{counted(self.npoints, 'point')}: {vertices}"


def _in_plane(points: Floats) -> dict[str, NDArray[Any]] | None:
    vertices, duplicates = _core.hull2(points)
    count = len(vertices)
    if count < 3:
        return None
    number = np.arange(count, dtype=np.int32)
    simplices = np.column_stack((vertices, np.roll(vertices, -1)))
    return {
        "simplices": simplices,
        # The edge that shares the head comes after, the one that shares the tail before.
        "neighbors": np.column_stack((np.roll(number, -1), np.roll(number, 1))),
        "vertices": vertices,
        "facet_of": number,
        "polygons": simplices.reshape(-1).copy(),
        "starts": np.arange(0, 2 * count + 1, 2, dtype=np.int32),
        "duplicates": duplicates,
    }


def _in_space(points: Floats) -> dict[str, NDArray[Any]] | None:
    found = _core.hull3(points)
    if found is None:
        return None
    extreme = np.zeros(len(points), dtype=bool)
    extreme[found.polygons] = True
    return {
        "simplices": found.simplices,
        "neighbors": found.neighbors,
        "vertices": np.flatnonzero(extreme).astype(np.int32),
        "facet_of": found.facet_of,
        "polygons": found.polygons,
        "starts": found.starts,
        "duplicates": found.duplicates,
    }


# By the number of coordinates; the others are those of `delone._tiling.higher`.
_ARRAYS_OF: dict[int, Callable[[Floats], dict[str, NDArray[Any]] | None]] = {
    2: _in_plane,
    3: _in_space,
}
