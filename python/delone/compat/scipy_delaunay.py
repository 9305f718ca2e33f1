"""SciPy's ``Delaunay`` and ``tsearch`` on delone triangulations."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import delaunay
from delone._base.arrays import as_number
from delone._tiling.dimension import FLAT_OR_SOLID
from delone._tiling.higher.dimension import MOST
from delone.compat.qhull import Incremental, as_queries, told_as_qhull_does, triangulate
from delone.dynamic import Dynamic
from delone.errors import DtypeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Delaunay", "tsearch"]

# SciPy's bound on the reciprocal condition number below which a transform is not given.
_ILL_CONDITIONED = 1000 * np.finfo(np.float64).eps
# How far above the highest point Qhull's option Qz lifts its point at infinity.
_INFINITE_POINT = 1.1


class Delaunay(Incremental):
    """Delaunay triangulation with the interface of ``scipy.spatial.Delaunay``.

    Parameters
    ----------
    points : array_like, shape (npoints, ndim)
        Two to eight coordinates of each point.
    furthest_site : bool, optional
        Whether to compute the furthest-site triangulation: that of the extreme points, whose
        circles contain all points. Only available in 2-D.
    incremental : bool, optional
        Whether `add_points` may be called.
    qhull_options : str, optional
        As in SciPy. Options about rounding have no effect, because nothing is rounded. These
        include ``QJ``, so that duplicates remain duplicates, and ``QbB``, ``C-0`` and ``A-1``.
        ``Qu`` is the same as `furthest_site`. Without ``Qc``, `coplanar` is empty. The default is
        ``"Qbb Qc Qz Q12"``, without ``Qbb`` and ``Qz`` in incremental mode.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, ndim)
        Coordinates; the given array itself if it has this dtype and layout, as in SciPy.
    simplices : ndarray of int32, shape (nsimplex, ndim + 1)
        Triangles, counter-clockwise, or simplices of more dimensions, positively oriented.
    neighbors : ndarray of int32, shape (nsimplex, ndim + 1)
        The simplex opposite each vertex, -1 outside.
    equations : ndarray of float64, shape (nsimplex, ndim + 2)
        Normal and offset of the plane through the lifted corners of each simplex.
    paraboloid_scale, paraboloid_shift : float
        Points are lifted to ``scale * (x**2).sum() + shift``.
    transform : ndarray of float64, shape (nsimplex, ndim + 1, ndim)
        Affine maps to barycentric coordinates; NaN for nearly flat simplices, as in SciPy.
    vertex_to_simplex : ndarray of int32, shape (npoints,)
        A triangle of each point, -1 if there is none.
    convex_hull : ndarray of int32, shape (nfaces, ndim)
        Facets of the convex hull.
    coplanar : ndarray of int32, shape (ncoplanar, 3)
        Each duplicate, a triangle of its vertex, and its vertex.
    vertex_neighbor_vertices : tuple of two ndarrays of int32
        ``indices[indptr[k]:indptr[k + 1]]`` are the neighbors of vertex k.
    good : ndarray of int32, shape (nsimplex,)
        Ones.
    furthest_site : bool
        As given.
    ndim, npoints, nsimplex : int
        Sizes.
    min_bound, max_bound : ndarray of float64, shape (ndim,)
        The minimum and maximum coordinates.

    Raises
    ------
    QhullError
        The points span no area, or in 3-D no volume; a coordinate is infinite; an option is
        unknown. This is ``scipy.spatial.QhullError`` if SciPy is installed.
    ValueError
        A coordinate is NaN, the array has a wrong shape or dtype, or an option requires other
        triangles.
    DimensionError
        The points have more than eight coordinates, or more than two if `furthest_site` is set.
        (A NotImplementedError and a ValueError.)

    Notes
    -----
    The documentation of the module lists the differences from SciPy.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.compat.scipy import Delaunay
    >>> tri = Delaunay(np.array([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)]))
    >>> t = tri.find_simplex((2, 0.5))
    >>> b = tri.transform[t, :2] @ (np.array([2, 0.5]) - tri.transform[t, 2])
    >>> weights = dict(zip(tri.simplices[t].tolist(), [*b.tolist(), 1 - b.sum()]))
    >>> [float(weights[vertex]) for vertex in (0, 1, 4)]
    [0.25, 0.25, 0.5]
    """

    _most = MOST
    # The mesh into which points are inserted, once there are some.
    _live: Dynamic | None

    def __init__(
        self,
        points: ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
    ) -> None:
        self.furthest_site = bool(furthest_site)
        self._begin(points, qhull_options, incremental)

    def _set(self, points: Floats) -> None:
        self._live = None
        self._take(triangulate(points, self.furthest_site), points)

    def _append(self, more: Floats) -> None:
        if self.furthest_site or self.ndim not in FLAT_OR_SOLID:
            return super()._append(more)
        live = self._live if self._live is not None else Dynamic(self._mesh)
        with told_as_qhull_does(np.concatenate((self._points, more)), self._what):
            live.insert(more)
        self._live = live
        mesh = live._frozen(live._arrays())
        return self._take(mesh, mesh.points)

    def _take(self, mesh: delaunay.Delaunay, points: Floats) -> None:
        self._points, self._mesh = points, mesh
        self._forget()
        self.ndim, self.npoints, self.nsimplex = mesh.ndim, mesh.npoints, mesh.nsimplex

    @cached_property
    def simplices(self) -> Indices:
        """The simplices, (nsimplex, ndim + 1): triangles, counter-clockwise, or tetrahedra."""
        return self._mesh.simplices.copy()

    @cached_property
    def neighbors(self) -> Indices:
        """The simplex opposite each vertex, (nsimplex, ndim + 1); -1 outside."""
        return self._mesh.neighbors.copy()

    @cached_property
    def convex_hull(self) -> Indices:
        """Edges or triangles of the convex hull, (nfaces, ndim)."""
        return self._mesh.convex_hull.copy()

    @cached_property
    def vertex_to_simplex(self) -> Indices:
        """A simplex of each point, (npoints,); -1 if there is none."""
        found = self._mesh.vertex_to_simplex.copy()
        if not self._options.coplanar:
            found[self._mesh.coplanar[:, 0]] = -1
        return found

    @cached_property
    def vertex_neighbor_vertices(self) -> tuple[Indices, Indices]:
        """Neighbors of vertices as compressed rows (indptr, indices)."""
        indptr, indices = self._mesh.vertex_neighbor_vertices
        return indptr.copy(), indices.copy()

    @cached_property
    def coplanar(self) -> Indices:
        """The duplicates, (ncoplanar, 3): row, a simplex of its vertex, its vertex."""
        if self._options.coplanar:
            return self._mesh.coplanar.copy()
        return np.empty((0, 3), dtype=np.int32)

    @cached_property
    def good(self) -> Indices:
        """Ones, (nsimplex,): no option excludes a simplex."""
        return np.ones(self._mesh.nsimplex, dtype=np.int32)

    @cached_property
    def min_bound(self) -> Floats:
        """The smallest coordinates, (ndim,)."""
        return self._mesh.min_bound.copy()

    @cached_property
    def max_bound(self) -> Floats:
        """The largest coordinates, (ndim,)."""
        return self._mesh.max_bound.copy()

    @cached_property
    def transform(self) -> Floats:
        """Affine maps to barycentric coordinates, NaN for nearly flat simplices.

        A simplex is nearly flat by SciPy's definition: the reciprocal condition number of the
        matrix of edge vectors, in the 1-norm, is below 1000 eps. The maps of these triangles are in
        ``delone.Delaunay.transform``.
        """
        maps = self._mesh.transform.copy()
        corners = self._mesh.points[self._mesh.simplices]
        with np.errstate(all="ignore"):
            last = self.ndim
            vectors = np.abs(corners[:, :last] - corners[:, last:]).sum(axis=2).max(axis=1)
            inverse = np.abs(maps[:, :last]).sum(axis=1).max(axis=1)
            condition = vectors * inverse
        maps[~(condition <= 1 / _ILL_CONDITIONED)] = np.nan
        return maps

    @cached_property
    def _paraboloid(self) -> tuple[float, float]:
        """Scale and shift, as Qhull's options Qbb and Qz define them."""
        if not self._options.scaled:
            return 1.0, 0.0
        points = self._mesh.points
        with np.errstate(over="ignore"):
            heights = (points * points).sum(axis=1)
        low, high = float(heights.min()), float(heights.max())
        if self._options.infinite_point and not self.furthest_site:
            high *= _INFINITE_POINT
        scale = float(np.abs(points).max()) / (high - low)
        return scale, -low * scale

    @cached_property
    def paraboloid_scale(self) -> float:
        """Factor of the lifted coordinate."""
        return self._paraboloid[0]

    @cached_property
    def paraboloid_shift(self) -> float:
        """Offset of the lifted coordinate."""
        return self._paraboloid[1]

    @cached_property
    def _normals(self) -> tuple[Floats, Floats]:
        """Horizontal parts of the normals before normalization, and their lengths.

        The plane over a circle with center c is z = s (2 c x + r² - c²) + t, so that its normal is
        (2 s c, -1), which points down, out of the lower side of the lifted hull.
        """
        horizontal = 2 * self.paraboloid_scale * self._mesh.circumcenters
        length = np.ones(len(horizontal))
        for k in range(self.ndim):
            length = np.hypot(length, horizontal[:, k])
        return horizontal, length

    @cached_property
    def equations(self) -> Floats:
        """Normal and offset of the plane through the lifted corners of each simplex."""
        horizontal, length = self._normals
        corner = self._mesh.points[self._mesh.simplices[:, 0]]
        # The offset makes the equation 0 at a lifted corner.
        offset = self.lift_points(corner)[:, -1] - (horizontal * corner).sum(axis=1)
        down = np.column_stack((horizontal, -np.ones(len(length)), offset)) / length[:, None]
        return -down if self.furthest_site else down

    def lift_points(self, x: ArrayLike) -> Floats:
        """Lift points to the paraboloid.

        Parameters
        ----------
        x : array_like, shape (..., ndim)
            Points.

        Returns
        -------
        ndarray of float64, shape (..., ndim + 1)
            Their coordinates and ``paraboloid_scale * (x**2).sum() + paraboloid_shift``.

        Raises
        ------
        IndexError
            `x` is a scalar.
        ValueError
            `x` has a wrong number of coordinates.

        Examples
        --------
        >>> from delone.compat.scipy import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)], qhull_options="Qc").lift_points((2, 3))
        array([ 2.,  3., 13.])
        """
        x = as_queries(x, self.ndim)
        height = self.paraboloid_scale * (x * x).sum(axis=-1) + self.paraboloid_shift
        return np.concatenate((x, height[..., None]), axis=-1)

    def plane_distance(self, xi: ArrayLike) -> Floats:
        """Return the distances of lifted points to the planes of all simplices.

        Parameters
        ----------
        xi : array_like, shape (..., ndim)
            Points.

        Returns
        -------
        ndarray of float64, shape (..., nsimplex)
            Positive if the lifted point is on the outer side of the plane: for a point inside the
            circumcircle or circumsphere of a simplex, or outside it in a furthest-site
            triangulation.

        Raises
        ------
        IndexError
            `xi` is a scalar.
        ValueError
            `xi` has a wrong number of coordinates.

        Notes
        -----
        Computed from differences to a corner, so that no precision is lost far from the origin.
        Time and memory are proportional to the number of pairs of points and simplices.

        Examples
        --------
        >>> from delone.compat.scipy import Delaunay
        >>> tri = Delaunay([(0, 0), (1, 0), (0, 1)])
        >>> tri.plane_distance([(0.5, 0.5), (2, 2)]) > 0
        array([[ True],
               [False]])
        """
        xi = as_queries(xi, self.ndim)
        _, length = self._normals
        corner = self._mesh.points[self._mesh.simplices[:, 0]]
        center = self._mesh.circumcenters
        x = xi[..., None, :]
        # r² - |x - c|² with r² = |v - c|² of a corner v is (v - x) (v + x - 2 c).
        power = ((corner - x) * ((corner - center) + (x - center))).sum(axis=-1)
        distance: Floats = self.paraboloid_scale * power / length
        return -distance if self.furthest_site else distance

    def __array__(self, *_: Any, **__: Any) -> NDArray[Any]:
        # SciPy's interpolators treat any object except their own class as an array of points.
        raise DtypeError(
            "a Delaunay of delone.compat.scipy is not an array of points: pass its points. "
            "SciPy's interpolators accept only SciPy's class; those of delone.compat.scipy accept "
            "this one: from delone.compat.scipy import LinearNDInterpolator"
        )

    def find_simplex(
        self, xi: ArrayLike, bruteforce: bool = False, tol: float | None = None
    ) -> Indices:
        """Find the simplices that contain points, exactly.

        Parameters
        ----------
        xi : array_like, shape (..., ndim)
            Points.
        bruteforce
            Accepted as in SciPy, without effect.
        tol : float, optional
            Points outside whose barycentric coordinates in the simplex at the nearest point of the
            boundary are at least ``-tol``, exactly, are in that simplex. By default 0, where SciPy
            has 100 machine epsilons. Without effect in more than three dimensions.

        Returns
        -------
        ndarray of int32, shape (...)
            Simplices, the first one if there are several, -1 outside.

        Raises
        ------
        IndexError
            `xi` is a scalar.
        ValueError
            `xi` has a wrong number of coordinates.

        Examples
        --------
        >>> from delone.compat.scipy import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).find_simplex([(0.25, 0.25), (1, 1)])
        array([ 0, -1], dtype=int32)
        """
        if isinstance(xi, Delaunay):
            raise IndexError("points to locate are coordinates, got a triangulation")
        queries = as_queries(xi, self.ndim)
        if tol is None:
            return self._mesh.find_simplex(queries)
        limit = Fraction(as_number(tol, name="tol"))
        place = self._mesh.locate(queries)
        found, beside = place.simplex.reshape(-1).copy(), place.beside.reshape(-1)
        flat = np.reshape(queries, (-1, self.ndim))
        for row in np.flatnonzero(beside >= 0).tolist():
            corners = self._mesh.points[self._mesh.simplices[beside[row]]]
            if min(_barycentric(corners, flat[row])) >= -limit:
                found[row] = beside[row]
        return found.reshape(place.simplex.shape)


def _barycentric(corners: Floats, query: Floats) -> list[Fraction]:
    """The barycentric coordinates of a point, exactly."""
    origin, *others = ([Fraction(x) for x in each] for each in corners.tolist())
    sides = [[x - y for x, y in zip(each, origin, strict=True)] for each in others]
    to = [Fraction(x) - y for x, y in zip(query.tolist(), origin, strict=True)]
    whole = _determinant(sides)
    inner = [_determinant([*sides[:k], to, *sides[k + 1 :]]) / whole for k in range(len(sides))]
    return [1 - sum(inner, Fraction(0)), *inner]


def _determinant(rows: list[list[Fraction]]) -> Fraction:
    """Of 2 or 3 rows."""
    if len(rows) == 2:
        return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]
    (a, b, c), *rest = rows
    minors = [_determinant([[row[j], row[k]] for row in rest]) for j, k in ((1, 2), (0, 2), (0, 1))]
    return a * minors[0] - b * minors[1] + c * minors[2]


def tsearch(tri: Any, xi: ArrayLike) -> Indices:
    """Find the simplices that contain points: ``tri.find_simplex(xi)``.

    Parameters
    ----------
    tri : Delaunay
        A triangulation.
    xi : array_like, shape (..., ndim)
        Points.

    Returns
    -------
    ndarray of int32, shape (...)
        Triangles, -1 outside.

    Examples
    --------
    >>> from delone.compat.scipy import Delaunay, tsearch
    >>> tsearch(Delaunay([(0, 0), (1, 0), (0, 1)]), (0.25, 0.25))
    array(0, dtype=int32)
    """
    found: Indices = tri.find_simplex(xi)
    return found
