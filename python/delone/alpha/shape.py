"""The simplices of a triangulation that are kept: alpha shapes, concave hulls, their outlines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.counting import counted
from delone._base.immutable import kept, made_by, sealed
from delone._tiling import measures
from delone._tiling.complex import Exchanged, Filed
from delone._tiling.plane import geometry as plane
from delone._tiling.space import geometry as space
from delone._tiling.space.topology import FACES
from delone.alpha.outline import rings_of
from delone.alpha.values import Given, Valued, simplices_of
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.exchange.parts import Parts

__all__ = ["AlphaShape", "ConcaveHull", "Kept"]


class Kept(Exchanged, Filed):
    """The triangles or tetrahedra of a triangulation that are kept, and their boundary."""

    __slots__ = ("_flags", "_neighbors", "_points", "_tops", "_workers")

    _flags: Bools
    _neighbors: Indices
    _points: Floats
    _tops: Indices
    _workers: int | None

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d)."""
        return self._points

    @property
    def ndim(self) -> int:
        """Number of coordinates, 2 or 3."""
        return int(self._points.shape[1])

    @property
    def is_kept(self) -> Bools:
        """Whether each triangle (in 3-D tetrahedron) of the triangulation is kept, (m,)."""
        return self._flags

    @property
    @kept
    def simplices(self) -> Indices:
        """The triangles, in 3-D tetrahedra, that are kept, (k, d + 1)."""
        return sealed(self._solid.copy())

    @property
    def _is_full(self) -> bool:
        return int(self._tops.shape[1]) == self.ndim + 1

    @property
    @kept
    def _solid(self) -> Indices:
        """The triangles, in 3-D the tetrahedra."""
        if not self._is_full:
            return np.empty((0, self.ndim + 1), dtype=np.int32)
        return self._tops[self._flags]

    @property
    @kept
    def _labels(self) -> Indices:
        """The part of each triangle or tetrahedron, -1 for those that are not kept."""
        return sealed(_core.alpha_labels(self._flags, self._neighbors))

    @property
    def nparts(self) -> int:
        """Number of parts: triangles with a common edge (tetrahedra with a face) are in one."""
        return int(self._labels.max(initial=-1)) + 1 if self._is_full else 0

    @property
    @kept
    def boundary(self) -> Indices:
        """Return the edges (in 3-D triangles) with a triangle (tetrahedron) on one side only.

        Returns
        -------
        ndarray of int32, shape (b, d)
            Rows of `points`. Edges have the shape to their left; triangles are counter-clockwise as
            seen from outside.

        Examples
        --------
        >>> import delone
        >>> delone.AlphaComplex([(0, 0), (4, 0), (0, 3)]).shape(6.25).boundary.tolist()
        [[0, 1], [1, 2], [2, 0]]
        """
        if not self._is_full:
            return sealed(np.empty((0, self.ndim), dtype=np.int32))
        other = self._neighbors
        is_bare = self._flags[:, None] & ((other < 0) | ~self._flags[other])
        simplex, corner = np.nonzero(is_bare)
        sides = np.array([[1, 2], [2, 0], [0, 1]] if self.ndim == 2 else FACES)
        return sealed(np.take_along_axis(self._tops[simplex], sides[corner], axis=1))

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        return Parts(self._points, self.simplices, crs=self.crs)

    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Convert to a table of polygons (extra ``geo``); 2-D only.

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each polygon. The geometry of a GeoDataFrame is
            replaced; its reference system and index are kept.
        crs : optional
            Reference system of the coordinates, anything that geopandas accepts; by default that of
            the points, if they declared one.

        Returns
        -------
        geopandas.GeoDataFrame
            One row for each of `polygons`, in their order.

        Raises
        ------
        MissingExtraError
            geopandas or shapely is not installed.
        InputError
            The points are 3-D or periodic; or `data` does not have one row for each polygon.

        Examples
        --------
        >>> import delone
        >>> shape = delone.AlphaComplex([(0, 0), (4, 0), (0, 3)]).shape(6.25)
        >>> shape.to_geopandas(crs="EPSG:28992").area.tolist()
        [6.0]
        """
        from delone.exchange.geopandas import beside

        own = self.crs if crs is None else crs
        return beside(self.polygons(), data, own, of="polygons")

    @kept
    def polygons(self) -> NDArray[Any]:
        """Return the triangles' union as shapely polygons (extra ``geo``); 2-D only.

        Returns
        -------
        ndarray of object, shape (k,)
            One polygon for each part, with its holes: shells counter-clockwise, each ring starting
            at its lexicographically smallest point, and sorted by it. All are valid, even if a part
            touches itself or another one at a point.

        Raises
        ------
        MissingExtraError
            shapely is not installed.
        InputError
            The points are 3-D or periodic.

        Examples
        --------
        >>> import delone
        >>> delone.AlphaComplex([(0, 0), (4, 0), (0, 3)]).shape(6.25).polygons()[0].area
        6.0
        """
        if self.ndim == 3:
            raise InputError(
                "polygons are only available in 2-D: `boundary` contains the triangles"
            )
        self._require_plane()
        from delone.exchange.outlines import to_polygons

        if not self._is_full:
            return np.empty(0, dtype=object)
        return to_polygons(rings_of(self._points, self._tops, self._neighbors, self._labels))

    def _require_plane(self) -> None:
        """Reject polygons of periodic points."""

    @property
    @kept
    def area(self) -> float:
        """The area of the triangles; in 3-D that of the boundary."""
        if self.ndim == 2:
            return plane.total(self._areas())
        return plane.total(space.face_areas(self._points, self.boundary, self._workers))

    def _areas(self) -> Floats:
        """The areas of the triangles that are kept."""
        return measures.sizes(self._points, self._solid, self._workers)

    @property
    @kept
    def perimeter(self) -> float:
        """The length of the boundary; 2-D only."""
        if self.ndim == 3:
            raise InputError("a perimeter is only available in 2-D: `area` is that of the boundary")
        self._require_plane()
        with np.errstate(over="ignore"):
            along = np.subtract(*self._points[self.boundary.T])
            return plane.total(np.hypot(*along.T))

    @property
    @kept
    def volume(self) -> float:
        """The volume of the tetrahedra; 3-D only."""
        if self.ndim == 2:
            raise InputError("a volume is only available in 3-D: `area` is that of the triangles")
        return plane.total(measures.sizes(self._points, self._solid, self._workers))

    @property
    @kept
    def is_manifold(self) -> bool:
        """Whether the boundary is a manifold: around each of its points, one ring or two edges.

        In 2-D, whether its rings are disjoint; in 3-D, whether it is a surface that does not touch
        itself at points or edges. True without a boundary.
        """
        sides = self.boundary
        if self.ndim == 2:
            return bool((np.bincount(sides.ravel()) <= 2).all())
        corners = sides[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
        edges = np.sort(corners, axis=1).astype(np.int64)
        keys = edges[:, 0] * len(self._points) + edges[:, 1]
        order = np.argsort(keys, kind="stable")
        _, uses = np.unique(keys, return_counts=True)
        if not (uses == 2).all():
            return False
        # Corners of triangles with a common edge, at each of its ends, are neighbors.
        slot = np.arange(len(sides) * 3).reshape(-1, 3)
        ends = slot[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
        one, other = ends[order[::2]], ends[order[1::2]]
        # The two triangles run along their edge in opposite directions.
        pairs = np.concatenate(
            (np.stack((one[:, 0], other[:, 1]), 1), np.stack((one[:, 1], other[:, 0]), 1))
        )
        found = _core.graph_components(pairs.astype(np.int32), slot.size)
        return int(found.max(initial=-1)) + 1 == len(np.unique(sides))


@made_by("create an AlphaShape with AlphaComplex.shape(alpha), not with its class")
class AlphaShape(Kept):
    """The simplices of an `AlphaComplex` with values up to alpha, from ``AlphaComplex.shape``.

    Attributes
    ----------
    alpha : float
        The squared radius.
    points : ndarray of float64, shape (n, d)
        The coordinates.
    simplices : ndarray of int32, shape (k, d + 1)
        The triangles, in 3-D tetrahedra, that are kept.
    is_kept : ndarray of bool, shape (m,)
        Whether each simplex of the highest dimension of the complex is kept.

    Notes
    -----
    A shape may have edges and points that belong to no triangle. `simplices_of` and the numbers of
    components and holes include them; `simplices`, `boundary`, `polygons` and the measures include
    only the triangles (in 3-D, the tetrahedra).

    Examples
    --------
    >>> import delone
    >>> shape = delone.AlphaComplex([(0, 0), (4, 0), (0, 3), (4, 3), (9, 9)]).shape(6.25)
    >>> shape.area, shape.perimeter, len(shape.polygons()), shape.betti
    (12.0, 14.0, 1, (2, 0))
    """

    __slots__ = ("_alpha", "_given", "_valued")

    _alpha: float
    _given: Given
    _valued: Valued

    @classmethod
    def _made(cls, given: Given, valued: Valued, alpha: float, workers: int | None) -> Self:
        found = cls.__new__(cls)
        found._hold(
            alpha=alpha,
            flags=sealed(valued.values[-1] <= alpha),
            given=given,
            neighbors=valued.neighbors,
            points=sealed(given.points),
            tops=valued.simplices[-1],
            valued=valued,
            workers=workers,
        )
        return found

    @classmethod
    def _again(cls, given: Given, alpha: float, workers: int | None) -> Self:
        """Return the shape of points, recomputed."""
        return cls._made(given, given.valued(as_workers(workers)), alpha, workers)

    def __reduce__(self) -> tuple[Any, ...]:
        return self._again, (self._given, self._alpha, self._workers)

    def _saved(self) -> dict[str, NDArray[Any]]:
        return self._given.saved() | {"alpha": np.array([self._alpha])}

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls._again(Given.loaded(arrays), float(arrays["alpha"][0]), None)

    @property
    def alpha(self) -> float:
        """The squared radius."""
        return self._alpha

    def simplices_of(self, k: int) -> Indices:
        """Return the simplices of one dimension that are kept.

        Parameters
        ----------
        k : int
            The dimension: 0 for vertices, 1 for edges, 2 for triangles, 3 for tetrahedra.

        Returns
        -------
        ndarray of int32, shape (m, k + 1)
            Rows of `points`, in the order of ``AlphaComplex.simplices_of``.

        Raises
        ------
        InputError
            `k` is not from 0 to `ndim`.

        Examples
        --------
        >>> import delone
        >>> delone.AlphaComplex([(0, 0), (4, 0), (0, 3)]).shape(4).simplices_of(1).tolist()
        [[0, 1], [0, 2]]
        """
        rows, values = simplices_of(self._valued, k, self.ndim)
        return sealed(rows[values <= self._alpha])

    @property
    @kept
    def loose_edges(self) -> Indices:
        """The edges that belong to no triangle, (k, 2); 2-D only."""
        if self.ndim == 3:
            raise InputError("loose_edges are only available in 2-D")
        edges = self.simplices_of(1)
        sides = np.ascontiguousarray(self.simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2))
        rows = _core.facet_rows(sides, np.ascontiguousarray(edges), len(self._points), False)
        return sealed(edges[rows < 0])

    @property
    @kept
    def _sizes(self) -> tuple[int, ...]:
        return tuple(int((values <= self._alpha).sum()) for values in self._valued.values)

    @property
    def euler_characteristic(self) -> int:
        """Vertices minus edges plus triangles (minus tetrahedra)."""
        return sum(-size if k % 2 else size for k, size in enumerate(self._sizes))

    @property
    @kept
    def ncomponents(self) -> int:
        """Number of connected components, including single points and edges."""
        rows = self.simplices_of(0)[:, 0]
        edges = np.ascontiguousarray(self.simplices_of(1))
        found = _core.graph_components(edges, len(self._points))
        return len(np.unique(found[rows]))

    @property
    @kept
    def betti(self) -> tuple[int, ...]:
        """Numbers of components, of loops and, in 3-D, of voids; on a torus, of closed surfaces."""
        parts, euler = self.ncomponents, self.euler_characteristic
        if self.ndim == 2:
            if self._valued.periodic is None:
                return parts, parts - euler
            closed = int(bool(self._flags.all()) and bool((self._neighbors >= 0).all()))
            return parts, parts + closed - euler, closed
        voids = self._voids()
        return parts, parts + voids - euler, voids

    def _voids(self) -> int:
        """Number of parts of the complement that are not outside.

        Tetrahedra without a kept face between them are in one part.
        """
        if not self._is_full:
            return 0
        count, size = len(self._tops), len(self._points)
        opposite = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]

        def keys(rows: Indices) -> NDArray[np.int64]:
            u, v, w = np.sort(rows.reshape(-1, 3), axis=1).astype(np.int64).T
            found: NDArray[np.int64] = (u * size + v) * size + w
            return found

        barred = np.isin(keys(self._tops[:, opposite]), keys(self.simplices_of(2))).reshape(-1, 4)
        is_open = ~barred & ~self._flags[:, None]
        t, k = np.nonzero(is_open)
        other = self._neighbors[t, k]
        edges = np.column_stack((t, np.where(other < 0, count, other))).astype(np.int32)
        found = _core.graph_components(np.ascontiguousarray(edges), count + 1)
        return len(np.unique(found[np.append(np.flatnonzero(~self._flags), count)])) - 1

    def _require_plane(self) -> None:
        if self._valued.periodic is not None:
            raise InputError(
                "outlines of periodic points are not available, since they may go around the "
                "period: `boundary` has the edges"
            )

    def _areas(self) -> Floats:
        mesh = self._valued.periodic
        return super()._areas() if mesh is None else mesh.areas[self._flags]

    def __repr__(self) -> str:
        if not hasattr(self, "_cache"):
            return "<AlphaShape of nothing yet>"
        plural = ("vertices", "edges", "triangles", "tetrahedra")
        names = ("vertex", "edge", "triangle", "tetrahedron")
        listed = (
            f"{size} {names[k] if size == 1 else plural[k]}" for k, size in enumerate(self._sizes)
        )
        head = f"{counted(len(self._points), 'point')} with alpha {self._alpha:g}"
        return f"<AlphaShape of {head}: {', '.join(listed)}>"


@made_by("create a ConcaveHull with delone.concave_hull(points), not with its class")
class ConcaveHull(Kept):
    """A concave hull: what `concave_hull` keeps of a Delaunay triangulation.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    simplices : ndarray of int32, shape (k, d + 1)
        The triangles, in 3-D tetrahedra, that are kept.
    is_kept : ndarray of bool, shape (m,)
        Whether each simplex of the triangulation is kept.

    Examples
    --------
    >>> import delone
    >>> hull = delone.concave_hull([(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)], max_edge=3)
    >>> hull
    <ConcaveHull of 5 points: 3 triangles, 5 edges>
    >>> hull.polygon().exterior.coords[:3]
    [(0.0, 0.0), (4.0, 0.0), (2.0, 1.0)]
    """

    __slots__ = ()

    @classmethod
    def _made(
        cls,
        points: Floats,
        tops: Indices,
        neighbors: Indices,
        flags: Bools,
        workers: int | None,
    ) -> Self:
        found = cls.__new__(cls)
        found._hold(
            flags=sealed(flags),
            neighbors=sealed(neighbors),
            points=sealed(points),
            tops=sealed(tops),
            workers=None if workers is None else as_workers(workers),
        )
        return found

    def __reduce__(self) -> tuple[Any, ...]:
        arrays = self._points, self._tops, self._neighbors, self._flags
        return self._made, (*arrays, self._workers)

    def _saved(self) -> dict[str, NDArray[Any]]:
        return {
            "points": self._points,
            "simplices": self._tops,
            "neighbors": self._neighbors,
            "kept": self._flags,
        }

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        points, tops, neighbors = (
            sealed(arrays[name]) for name in ("points", "simplices", "neighbors")
        )
        return cls._made(points, tops, neighbors, arrays["kept"], None)

    def polygon(self) -> Any:
        """Return the hull as one shapely polygon (extra ``geo``); 2-D only.

        Returns
        -------
        shapely.Polygon
            Valid; empty if the points span no area.

        Raises
        ------
        MissingExtraError
            shapely is not installed.
        InputError
            The points are 3-D.

        Examples
        --------
        >>> import delone
        >>> delone.concave_hull([(0, 0), (4, 0), (4, 4), (0, 4)], ratio=0).polygon().area
        16.0
        """
        from delone._base.extras import require

        found = self.polygons()
        if len(found):
            return found[0]
        return require("shapely", extra="geo", what="a polygon").Polygon()

    def __repr__(self) -> str:
        if not hasattr(self, "_cache"):
            return "<ConcaveHull of nothing yet>"
        whole = ("triangle", "edge") if self.ndim == 2 else ("tetrahedron", "triangle")
        many = ("triangles", "edges") if self.ndim == 2 else ("tetrahedra", "triangles")
        sizes = len(self._solid), len(self.boundary)
        listed = (
            f"{size} {one if size == 1 else more}"
            for size, one, more in zip(sizes, whole, many, strict=True)
        )
        return f"<ConcaveHull of {counted(len(self._points), 'point')}: {', '.join(listed)}>"
