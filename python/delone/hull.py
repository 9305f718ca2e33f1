"""The class ConvexHull: a 2-D or 3-D convex hull as immutable arrays."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core, predicates
from delone._arrays import require_finite
from delone.counting import counted
from delone.delaunay import Delaunay
from delone.errors import InternalError
from delone.exchange.parts import Parts
from delone.immutable import Immutable, kept, own_copy, sealed
from delone.plane import geometry as plane
from delone.space import geometry as space

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["ConvexHull"]


class ConvexHull(Immutable):
    """The convex hull of points in the plane or in space.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3)
        Finite coordinates, in any unit: floats of up to 64 bits, integers up to 2**53. They are
        copied and taken as the exact numbers which they denote.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    simplices : ndarray of int32, shape (h, d)
        Edges or triangles, as rows of `points`: with the hull to the left of edges, triangles
        counter-clockwise as seen from outside. In space each begins with its lexicographically
        smallest point; in the plane they follow each other counter-clockwise.
    neighbors : ndarray of int32, shape (h, d)
        ``neighbors[i, k]`` is the simplex that shares all vertices of simplex i but vertex k.
    vertices : ndarray of int32, shape (v,)
        The extreme points: counter-clockwise from the lexicographically smallest on in the plane,
        ascending in space.
    facets : tuple of ndarray of int32
        The sides of the hull: in the plane its edges, in space polygons of their extreme points,
        counter-clockwise as seen from outside, from the lexicographically smallest on.
    facet_of : ndarray of int32, shape (h,)
        The facet of each simplex.

    Raises
    ------
    DegenerateInputError
        The points span no area, or no volume, as `Delaunay` says it.
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        `points` is no array of real points in the plane or in space.
    MemoryError
        There is not enough memory.
    KeyboardInterrupt
        Ctrl-C was pressed. Nothing is left behind.

    See Also
    --------
    Delaunay.convex_hull : The boundary of a triangulation, all points on it being vertices.

    Notes
    -----
    The answer is exact. A vertex is an extreme point, so points in the middle of an edge or a facet
    are none; of rows with the same coordinates the first is the vertex. A facet with more than
    three vertices is triangulated by the Delaunay rule in its plane, and ties by coordinates, so
    that one set of points has one hull, in one order of its arrays, however its rows are ordered;
    it is the boundary of ``Delaunay(points[hull.vertices])``.

    In the plane O(n log n) time (A. M. Andrew, 1979), in space O(n log n) expected (K. L. Clarkson
    and P. W. Shor, 1989); points that are well inside cost a few comparisons. Names, dtypes and
    meanings are those of ``scipy.spatial.ConvexHull``. All arrays are read-only; whatever is not
    listed above is computed on first use and kept.

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

    __slots__ = (
        "_duplicates",
        "_facet_of",
        "_neighbors",
        "_points",
        "_polygons",
        "_simplices",
        "_starts",
        "_vertices",
    )

    _duplicates: Indices
    _facet_of: Indices
    _neighbors: Indices
    _points: Floats
    _polygons: Indices
    _simplices: Indices
    _starts: Indices
    _vertices: Indices

    def __init__(self, points: ArrayLike) -> None:
        if hasattr(self, "_points"):
            raise AttributeError("a ConvexHull never changes: make another one")
        own = own_copy(points, ndim=None)
        require_finite(own)
        arrays = _in_plane(own) if own.shape[1] == 2 else _in_space(own)
        if arrays is None:
            Delaunay(own)  # which says what the points span instead
            error = InternalError("the hull of points that span a simplex is flat")
            error.points = own
            raise error
        self._fill(arrays | {"points": own})

    def _fill(self, arrays: dict[str, NDArray[Any]]) -> None:
        self._hold(**{name: sealed(array) for name, array in arrays.items()})

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d)."""
        return self._points

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
    def ndim(self) -> int:
        """Number of coordinates, 2 or 3."""
        return int(self._points.shape[1])

    @property
    def npoints(self) -> int:
        """Number of points."""
        return len(self._points)

    @property
    def nsimplex(self) -> int:
        """Number of edges or triangles."""
        return len(self._simplices)

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
    def coplanar(self) -> Indices:
        """The rows that repeat a vertex, (k, 3): row, a simplex of the vertex, the vertex."""
        row, first = self._duplicates.T
        simplex = np.full(self.npoints, -1, dtype=np.int32)
        order = np.arange(self.nsimplex - 1, -1, -1, dtype=np.int32)
        simplex[self._simplices[::-1]] = order[:, None]
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
        else:
            normals = space.face_normals(self._points, corners)
        with np.errstate(all="ignore"):
            offsets = -(normals * self._points[corners[:, 0]]).sum(axis=1)
            # Partial sums may leave the range where the offset does not.
            far = ~np.isfinite(offsets)
            quarters = self._points[corners[far, 0]] / 4
            offsets[far] = -4 * (normals[far] * quarters).sum(axis=1)
        # Adding 0 makes -0 the 0 that it is.
        return sealed(np.column_stack((normals, offsets + 0.0))[self._facet_of])

    @property
    @kept
    def volume(self) -> float:
        """The volume; in the plane, as in SciPy, the area.

        With a relative error below 1e-13; inf, or rounded among the subnormal numbers, where it is
        beyond the range of doubles.
        """
        base = int(self._polygons[0])  # the lexicographically smallest, whatever the rows
        if self.ndim == 2:
            fan = np.column_stack((np.full(self.nsimplex, base), self._simplices))
            fan = fan[(self._simplices != base).all(axis=1)]
            return plane.total(plane.areas(self._points, fan))
        a, b, c = self._simplices.T
        cones = np.column_stack((a, c, b, np.full(self.nsimplex, base)))
        above = predicates.orient3d(*(self._points[cones[:, k]] for k in range(4))) > 0
        return plane.total(space.volumes(self._points, cones[above]))

    @property
    @kept
    def area(self) -> float:
        """The area of the surface; in the plane, as in SciPy, the perimeter; inf beyond doubles."""
        if self.ndim == 2:
            with np.errstate(over="ignore"):
                along = np.subtract(*self._points[self._simplices.T])
                return plane.total(np.hypot(*along.T))
        return plane.total(space.face_areas(self._points, self._simplices))

    def __reduce__(self) -> tuple[Any, ...]:
        names = ("points", *_ARRAYS)
        return _restored, (type(self), {name: getattr(self, f"_{name}") for name in names})

    def _parts(self) -> Parts:
        """What other libraries and files take."""
        return Parts(self._points, self._simplices, of_simplices={"facet_of": self._facet_of})

    def __repr__(self) -> str:
        if not hasattr(self, "_points"):  # the constructor failed, or has not run
            return "<ConvexHull of nothing yet>"
        vertices = f"{len(self._vertices)} vertices"
        if self.ndim == 3:
            vertices += f", {len(self._starts) - 1} facets"
        return f"<ConvexHull of {counted(self.npoints, 'point')}: {vertices}>"


_ARRAYS = (
    "simplices",
    "neighbors",
    "vertices",
    "facet_of",
    "polygons",
    "starts",
    "duplicates",
)


def _restored(cls: type[ConvexHull], arrays: dict[str, NDArray[Any]]) -> ConvexHull:
    hull = cls.__new__(cls)
    hull._fill(arrays)
    return hull


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
