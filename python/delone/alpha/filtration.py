"""The class AlphaComplex: all simplices of a Delaunay triangulation with exact values."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_flag, as_least, as_number, as_workers, require_finite
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.georeference import warn_of_degrees
from delone._base.immutable import kept, own_copy, sealed
from delone._tiling.complex import Stored, points_alone
from delone._tiling.dimension import FLAT_OR_SOLID, only
from delone._tiling.higher.dimension import MOST
from delone.alpha.shape import AlphaShape
from delone.alpha.values import Given, Valued, known_mesh, of_periodic, of_points, simplices_of
from delone.errors import InputError
from delone.periodic import PeriodicDelaunay
from delone.regular import RegularTriangulation, as_weights

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["AlphaComplex"]

_NAMES = (
    ("vertex", "vertices"),
    ("edge", "edges"),
    ("triangle", "triangles"),
    ("tetrahedron", "tetrahedra"),
)


class AlphaComplex(Stored):
    """The alpha complex of points: all Delaunay simplices with the alpha at which each appears.

    Parameters
    ----------
    points : array_like, shape (n, d), or a triangulation
        Finite coordinates in any unit, two to eight. A `Delaunay`, a `RegularTriangulation` or a
        `PeriodicDelaunay` is used directly, with its weights and periods.
    weights : array_like, shape (n,), optional
        Finite weights in squared units of the points: squared radii of balls around them, as for
        `RegularTriangulation`. If `points` is one, its weights are used.
    periodic : tuple of two floats or None, optional
        The periods in x and y of 2-D points, as for `PeriodicDelaunay`.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Raises
    ------
    NonFiniteError
        A coordinate or weight is NaN or infinite.
    ShapeError, DtypeError
        `points` is not a real array of shape (n, d) with d from 2 to 8, or the number of weights is
        different.
    InputError
        `periodic` is given with points that are not 2-D or has no valid period, or points lie a
        period or more apart.
    DegenerateInputError
        Periodic points form no triangle, or points with four or more coordinates no simplex.
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
    concave_hull : One polygon, without a parameter that depends on the density of points.

    Notes
    -----
    The value of a simplex is the **square of a radius**, as in GUDHI and CGAL: that of the smallest
    ball through its vertices that has no other point inside. To convert: ``alpha = radius**2``; the
    ``alpha`` of the package alphashape is ``1 / radius``, so ``alpha = 1 / theirs**2``. With
    weights w, the ball is orthogonal to those around the vertices; a vertex has the value ``-w``,
    or more if a neighbor covers it, and hidden points have no simplex.

    A simplex whose smallest ball has no adjacent point inside (an exact test) has the squared
    radius of that ball as its value; any other simplex has the smallest value of its cofaces. Each
    value is the double nearest to the exact one. Rounding is monotone, so no face has a larger
    value than a coface, and no repair is needed.

    Degenerate points in 2-D and 3-D also have a complex: coplanar 3-D points have triangles and
    edges, points on one line a path, a single point a vertex, and no points an empty complex. Rows
    that repeat another row are not vertices. O(n log n) time in 2-D.

    From 4-D on, most of the time and memory is for faces: a simplex has 2^(d + 1) - 2 of them, each
    shared with others. `estimate` predicts the number of simplices. There is no `shape`.

    References
    ----------
    H. Edelsbrunner and E. P. Mücke, "Three-dimensional alpha shapes", ACM Transactions on Graphics
    13 (1994). With weights: H. Edelsbrunner, "Weighted alpha shapes", 1992.

    Examples
    --------
    >>> import delone
    >>> complex = delone.AlphaComplex([(0, 0), (4, 0), (0, 3), (4, 3), (9, 9)])
    >>> complex
    <AlphaComplex of 5 points: 5 vertices, 8 edges, 4 triangles>
    >>> complex.values_of(1).tolist()
    [4.0, 2.25, 6.25, 2.25, 64.66, 4.0, 49.5625, 15.25]
    >>> complex.shape(6.25).area
    12.0
    """

    __slots__ = ("_points", "_valued", "_weights")

    _points: Floats
    _valued: Valued
    _weights: Floats | None

    def __init__(
        self,
        points: ArrayLike | Stored,
        weights: ArrayLike | None = None,
        periodic: Sequence[float | None] | None = None,
        *,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        threads, given = as_workers(workers), points
        mesh = known_mesh(points)
        if isinstance(points, PeriodicDelaunay):
            if weights is not None or periodic is not None:
                raise InputError(
                    "points is a PeriodicDelaunay, which has its own weights and periods: pass its "
                    "points to choose others"
                )
            own, own_weights = points.points, points.weights
            valued = of_periodic(points, threads)
        elif mesh is not None and weights is None and periodic is None:
            own = mesh.points
            own_weights = getattr(mesh, "weights", None)
            valued = of_points(own, own_weights, threads, mesh)
        else:
            if isinstance(points, RegularTriangulation):
                weights = points.weights if weights is None else weights
                points = points.points
            plain: Any = points
            if isinstance(points, Stored):
                plain = points_alone(points, what="an alpha complex")
            own = own_copy(plain, ndim=None, most=MOST)
            warn_of_degrees(plain, own, planar=planar)
            require_finite(own)
            own_weights = None if weights is None else sealed(as_weights(weights, len(own)))
            valued = Given(own, own_weights, periodic).valued(threads)
        self._fill(own, own_weights, valued, workers)
        self._refer(given)

    def _fill(
        self, points: Floats, weights: Floats | None, valued: Valued, workers: int | None
    ) -> None:
        for rows, values in zip(valued.simplices, valued.values, strict=True):
            rows.flags.writeable = values.flags.writeable = False
        self._hold(points=sealed(points), weights=weights, valued=valued, workers=workers)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), *self._given, self._workers)

    def _saved(self) -> dict[str, NDArray[Any]]:
        return self._given.saved()

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls(*Given.loaded(arrays), planar=True)

    @property
    def _given(self) -> Given:
        return Given(self._points, self._weights, self.periods)

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d)."""
        return self._points

    @property
    def weights(self) -> Floats | None:
        """The weights, (n,); None without weights."""
        return self._weights

    @property
    def periods(self) -> tuple[float | None, float | None] | None:
        """The periods in x and y; None without periods."""
        mesh = self._valued.periodic
        return None if mesh is None else mesh.periods

    @property
    def ndim(self) -> int:
        """Number of coordinates."""
        return int(self._points.shape[1])

    @property
    def npoints(self) -> int:
        """Number of points, including those that are not vertices."""
        return len(self._points)

    @property
    def dimension(self) -> int:
        """The highest dimension of a simplex; -1 if there are no points."""
        found = self._valued.simplices
        return len(found) - 1 if len(found[0]) else -1

    @property
    def simplices(self) -> Indices:
        """The triangles, in 3-D tetrahedra, or simplices of the triangulation, (m, d + 1)."""
        if self.dimension == self.ndim:
            return simplices_of(self._valued, self.ndim, self.ndim)[0]
        return sealed(np.empty((0, self.ndim + 1), dtype=np.int32))

    def simplices_of(self, k: int) -> Indices:
        """Return the simplices of one dimension.

        Parameters
        ----------
        k : int
            The dimension: 0 for vertices, 1 for edges, 2 for triangles, 3 for tetrahedra, and so
            on.

        Returns
        -------
        ndarray of int32, shape (m, k + 1)
            Rows of `points`. Faces of triangles, tetrahedra and larger simplices have ascending
            rows, in ascending order; those of the highest dimension are those of the triangulation.
            For periodic points, one simplex of each class of translates; both ends of an edge may
            be the same row.

        Raises
        ------
        InputError
            `k` is not from 0 to `ndim`.

        Examples
        --------
        >>> import delone
        >>> delone.AlphaComplex([(0, 0), (4, 0), (0, 3)]).simplices_of(1).tolist()
        [[0, 1], [0, 2], [1, 2]]
        """
        return simplices_of(self._valued, k, self.ndim)[0]

    def values_of(self, k: int) -> Floats:
        """Return the values of the simplices of one dimension, in the order of `simplices_of`.

        Parameters
        ----------
        k : int
            The dimension.

        Returns
        -------
        ndarray of float64, shape (m,)
            Squared radii, in squared units of the points; with weights, they may be negative.
            Infinite where a value exceeds the range of doubles.

        Raises
        ------
        InputError
            `k` is not from 0 to `ndim`.

        Examples
        --------
        >>> import delone
        >>> delone.AlphaComplex([(0, 0), (4, 0), (0, 3)]).values_of(1)
        array([4.  , 2.25, 6.25])
        """
        return simplices_of(self._valued, k, self.ndim)[1]

    @property
    @kept
    def order(self) -> Indices:
        """The order of the filtration, (s, 2): the dimension and the number of each simplex.

        Simplices are ordered by value, then by dimension, then by the sorted coordinates of their
        vertices. So every face comes before its cofaces, and the order does not depend on that of
        the rows.
        """
        rank = np.empty(self.npoints, dtype=np.int64)
        rank[np.lexsort(self._points.T[::-1])] = np.arange(self.npoints)
        parts = list(zip(self._valued.simplices, self._valued.values, strict=True))
        width = len(parts)
        keys = np.full((sum(len(rows) for rows, _ in parts), width), -1, dtype=np.int64)
        which = np.empty((len(keys), 2), dtype=np.int32)
        start = 0
        for k, (rows, _) in enumerate(parts):
            end = start + len(rows)
            keys[start:end, : k + 1] = np.sort(rank[rows], axis=1)
            which[start:end, 0], which[start:end, 1] = k, np.arange(len(rows))
            start = end
        values = np.concatenate([values for _, values in parts])
        sequence = np.lexsort((*keys.T[::-1], which[:, 0], values))
        return sealed(which[sequence])

    @property
    @kept
    def spectrum(self) -> Floats:
        """The distinct values of all simplices, ascending: where the shape changes."""
        return sealed(np.unique(np.concatenate(self._valued.values)))

    @only(FLAT_OR_SOLID, "select rows of `simplices_of(k)` by `values_of(k)`")
    def shape(self, alpha: float) -> AlphaShape:
        """Return the simplices with values up to alpha.

        Parameters
        ----------
        alpha : float
            A squared radius, possibly infinity. Not negative, unless there are weights.

        Returns
        -------
        AlphaShape
            The simplices, their boundary, polygons and measures.

        Raises
        ------
        InputError
            `alpha` is NaN, or negative and there are no weights.

        Examples
        --------
        >>> import delone
        >>> complex = delone.AlphaComplex([(0, 0), (4, 0), (0, 3), (4, 3), (9, 9)])
        >>> complex.shape(2.5 ** 2)
        <AlphaShape of 5 points with alpha 6.25: 5 vertices, 5 edges, 2 triangles>
        """
        limit = as_number(alpha, name="alpha")
        if math.isnan(limit) or (limit < 0 and self._weights is None):
            least = "not NaN" if self._weights is not None else "at least 0"
            raise InputError(f"alpha is a squared radius and must be {least}, got {alpha!r:.60}")
        made = AlphaShape._made(self._given, self._valued, limit, self._workers)
        return made._refer(self)

    def optimal(self, components: int = 1, *, holes: bool = False) -> float:
        """Return the smallest alpha whose shape contains all points in few parts.

        Parameters
        ----------
        components : int, optional
            The maximum number of parts; triangles (in 3-D, tetrahedra) with a common edge (face)
            are in one part. From 4-D on, simplices with a common facet are.
        holes : bool, optional
            Whether the shape may have holes, in 3-D voids.

        Returns
        -------
        float
            A squared radius, one of `spectrum`. All vertices are corners of triangles (tetrahedra)
            of its shape. If there is no such alpha, the largest value.

        Raises
        ------
        InputError
            `components` is not a positive integer, or there are no points.

        Notes
        -----
        Uses disjoint sets: of triangles in the order of their values and, for holes, of the other
        triangles and the outside in the opposite order.

        Examples
        --------
        >>> import delone
        >>> delone.AlphaComplex([(0, 0), (4, 0), (0, 3), (4, 3), (9, 9)]).optimal()
        49.5625
        """
        most = as_least(components, 1, name="components")
        allowed = as_flag(holes, name="holes")
        if self.dimension < 0:
            raise InputError("there are no points, and so no alpha: pass at least one point")
        if self.dimension < self.ndim:
            return float(self.spectrum[-1])
        parts, gaps = self._counts
        top, values = self._valued.simplices[-1], self._valued.values[-1]
        order, ends = self._steps
        least = np.full(self.npoints, np.inf)
        for corner in top.T:
            np.minimum.at(least, corner, values)
        covered = least[self._valued.simplices[0][:, 0]].max()
        at = values[order[ends]]
        fits = (at >= covered) & (parts[ends] <= most)
        if not allowed:
            fits &= gaps[ends] == 0
        return float(at[int(fits.argmax())])

    @property
    @kept
    def _steps(self) -> tuple[Indices, NDArray[np.int64]]:
        """The simplices of the highest dimension, by value, and the last one of each value."""
        values = self._valued.values[-1]
        order = np.argsort(values, kind="stable").astype(np.int32)
        last = np.flatnonzero(np.diff(values[order], append=np.nan) != 0)
        return order, last

    @property
    @kept
    def _counts(self) -> tuple[Indices, Indices]:
        """The numbers of parts, and of holes, after each simplex of the highest dimension."""
        order, _ = self._steps
        neighbors = self._valued.neighbors
        parts = _core.alpha_counts(order, neighbors, outside=False)
        has_outside = bool((neighbors < 0).any())
        rest = _core.alpha_counts(np.ascontiguousarray(order[::-1]), neighbors, outside=has_outside)
        gaps = np.append(rest[::-1][1:], int(has_outside)) - int(has_outside)
        return parts, gaps.astype(np.int32)

    def to_gudhi(self) -> Any:
        """Convert to a GUDHI simplex tree, for persistent homology.

        Returns
        -------
        gudhi.SimplexTree
            All simplices with their values as filtration.

        Raises
        ------
        MissingExtraError
            GUDHI is not installed.
        InputError
            The points are periodic: simplices with the same vertices may differ.

        Examples
        --------
        >>> import delone
        >>> tree = delone.AlphaComplex([(0, 0), (4, 0), (0, 3)]).to_gudhi()  # doctest: +SKIP
        >>> tree.num_simplices()  # doctest: +SKIP
        7
        """
        if self._valued.periodic is not None:
            raise InputError(
                "a tree of simplices cannot hold periodic ones, since several may have the same "
                "vertices: use simplices, values and order"
            )
        gudhi = require("gudhi", extra="gudhi", what="a tree of simplices")
        tree = gudhi.SimplexTree()
        for rows, values in zip(self._valued.simplices, self._valued.values, strict=True):
            # Copies: GUDHI misreads arrays that have a stride of zero.
            tree.insert_batch(np.array(rows.T, order="C"), np.array(values))
        return tree

    def _described(self) -> str:
        listed = (_named(len(rows), k) for k, rows in enumerate(self._valued.simplices))
        return f"{counted(self.npoints, 'point')}: {', '.join(listed)}"


def _named(count: int, k: int) -> str:
    """A number of simplices of dimension `k` in words."""
    names = _NAMES[k] if k < len(_NAMES) else (f"{k}-simplex", f"{k}-simplices")
    return f"{count} {names[count != 1]}"


def _again(
    cls: type[AlphaComplex], points: Floats, weights: Any, periodic: Any, workers: Any
) -> AlphaComplex:
    return cls(points, weights, periodic, workers=workers, planar=True)
