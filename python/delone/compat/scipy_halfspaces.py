"""Drop-in replacement for ``scipy.spatial.HalfspaceIntersection``.

>>> import numpy as np
>>> from delone.compat.scipy import HalfspaceIntersection
>>> triangle = np.array([(-1, 0, 0), (0, -1, 0), (1, 1, -1)])
>>> found = HalfspaceIntersection(triangle, np.array([0.25, 0.25]))
>>> sorted(found.intersections.tolist())
[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]

A half-space ``a x + b <= 0`` that contains the interior point p corresponds to the dual point
``-a / (a p + b)``, and corners of the intersection correspond to facets of the convex hull of the
dual points. All decisions are exact for the given half-spaces, although most dual points must be
rounded. Differences from SciPy:

* Facets and corners ascend by their half-spaces. In 2-D and 3-D, the vertices of a dual facet are
  in order around it, counterclockwise as seen from outside; in more dimensions they ascend.
* Half-spaces whose boundaries meet exactly at one point have one corner there. If they miss it by
  rounding errors, there are several corners, which SciPy merges within a tolerance.
* If the intersection is unbounded, the dual facet that represents this has an infinite row in
  `intersections`. SciPy returns a point outside the intersection there.
* Corners are computed from the half-spaces, not from the dual hull, and are correctly rounded,
  except in rare cases near the midpoint between two doubles.
* Points with more than eight coordinates are rejected.
* `add_halfspaces` computes the intersection of the new half-spaces with those that are not
  redundant.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import factorial
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_plain_array, is_masked, wrong_shape
from delone._base.values import require_real, require_shape
from delone._tiling.higher.dimension import MOST
from delone._tiling.higher.rational import kernel
from delone.compat.qhull import DimensionError, QhullError, read_options
from delone.compat.qhull_options import HALFSPACES
from delone.errors import DtypeError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices, Rows

__all__ = ["HalfspaceIntersection"]

# The fewest columns: two coordinates and an offset.
_FEWEST = 3


class HalfspaceIntersection:
    """Intersection of half-spaces with the interface of ``scipy.spatial.HalfspaceIntersection``.

    Parameters
    ----------
    halfspaces : array_like, shape (nineq, ndim + 1)
        Rows ``(a, b)`` for ``a @ x + b <= 0``, in two to eight dimensions.
    interior_point : array_like, shape (ndim,)
        A point that is strictly inside all of them.
    incremental : bool, optional
        Whether `add_halfspaces` may be called.
    qhull_options : str, optional
        As in SciPy. Options about rounding have no effect. With ``Qt``, dual facets are
        triangulated, and a corner is repeated for each simplex.

    Attributes
    ----------
    halfspaces : ndarray of float64, shape (nineq, ndim + 1)
        The half-spaces.
    interior_point : ndarray of float64, shape (ndim,)
        The interior point.
    intersections : ndarray of float64, shape (ninter, ndim)
        The corners, one for each dual facet; infinite if the intersection is unbounded.
    dual_points : ndarray of float64, shape (nineq, ndim)
        The dual point of each half-space.
    dual_facets : list of list of int
        The half-spaces that meet in each corner.
    dual_vertices : ndarray of int, shape (nvertices,)
        The half-spaces that are not redundant, ascending.
    dual_equations : ndarray of float64, shape (ninter, ndim + 1)
        Outer normals and offsets of the dual facets.
    dual_area, dual_volume : float
        Surface area and volume of the dual hull; in 2-D perimeter and area.
    ndim, nineq : int
        Sizes.

    Raises
    ------
    QhullError
        The point is not strictly inside; there are too few half-spaces for a corner; a number is
        infinite; an option is unknown.
    ValueError
        A number is NaN, an array has a wrong shape or dtype or is masked, or an option requires a
        different result.
    DimensionError
        There are more than eight coordinates.

    Notes
    -----
    Whether the point is inside, which half-spaces are redundant, which boundaries meet at one
    point, and whether the intersection is bounded are decided exactly, for the given doubles; among
    half-spaces that are multiples of each other, the first one counts. Corners, dual points and
    measures are rounded. The time is that of a convex hull of the dual points: expected O(n log n)
    in 2-D and 3-D, and O(n^(ndim // 2)) in more dimensions.

    Dual points are quotients, and most of them are not doubles. But whether one is outside a dual
    facet depends on the sign of a determinant of rows of `halfspaces`, which are given exactly.
    Rounded dual points decide most signs, with a bound that covers their errors; integer arithmetic
    decides the others.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.compat.scipy import HalfspaceIntersection
    >>> sides = np.array([(1, 0, 1, -1), (-1, 0, 1, -1), (0, 1, 1, -1), (0, -1, 1, -1)])
    >>> pyramid = np.vstack((sides, [(0, 0, -1, 0)]))
    >>> found = HalfspaceIntersection(pyramid, np.array([0.1, 0.02, 0.3]))
    >>> sorted(map(len, found.dual_facets)), found.dual_vertices.tolist()
    ([3, 3, 3, 3, 4], [0, 1, 2, 3, 4])
    """

    dual_points: Floats
    nineq: int

    def __init__(
        self,
        halfspaces: ArrayLike,
        interior_point: ArrayLike,
        incremental: bool = False,
        qhull_options: str | None = None,
    ) -> None:
        self._open = bool(incremental)
        text = "" if qhull_options is None else qhull_options
        self._options = read_options(text, incremental=self._open, what=HALFSPACES)
        self._text = text
        rows = _as_rows(halfspaces)
        point = _as_doubles(interior_point, "interior_point")
        require_shape(point, (rows.shape[1] - 1,), "interior_point")
        self.interior_point = point
        self._set(rows)

    def __reduce__(self) -> tuple[Any, ...]:
        # The results are the same, whether half-spaces are added or given at once.
        return type(self), (self.halfspaces, self.interior_point, self._open, self._text)

    def _set(self, rows: Floats, kept: Rows | None = None) -> None:
        """Compute the results for the half-spaces; nothing changes if that fails.

        `kept` are the rows, ascending, that may not be redundant. The dual points of all other rows
        are already known.
        """
        point = self.interior_point
        if not (np.isfinite(rows).all() and np.isfinite(point).all()):
            raise QhullError("halfspaces and interior_point must be finite")
        made, why, named = _core.halfspaces(rows if kept is None else rows[kept], point)
        if made is None:
            raise QhullError(_reason(why, rows, named if kept is None else kept[named]))
        dual: Floats = made.dual_points
        facets: Indices | Rows = made.facets
        simplices: Indices | Rows = made.simplices
        if kept is not None:
            dual = np.empty((len(rows), len(point)))
            dual[: self.nineq], dual[kept] = self.dual_points, made.dual_points
            facets, simplices = kept[facets], kept[simplices]
        self.dual_points, self._facets, self._simplices = dual, facets, simplices
        self.halfspaces, self._made = rows, made
        self.ndim, self.nineq = len(point), len(rows)
        self.intersections, self.dual_equations = made.points, made.equations
        if self._options.triangulated:
            self.intersections = made.points[made.corner_of]
            self.dual_equations = made.equations[made.corner_of]
        for name in ("dual_facets", "dual_vertices", "_dual_measures"):
            self.__dict__.pop(name, None)

    @cached_property
    def dual_facets(self) -> list[list[int]]:
        """The half-spaces that meet in each corner."""
        simplices: list[list[int]] = self._simplices.tolist()
        if self._options.triangulated or len(simplices) == len(self._made.points):
            return simplices
        rows, starts = self._facets.tolist(), self._made.starts.tolist()
        return [rows[start:end] for start, end in pairwise(starts)]

    @cached_property
    def dual_vertices(self) -> NDArray[np.signedinteger[Any]]:
        """The half-spaces that are not redundant."""
        return np.unique(self._facets).astype(np.int_)

    @property
    def dual_area(self) -> float:
        """Surface area of the dual hull; in 2-D its perimeter."""
        return self._dual_measures[0]

    @property
    def dual_volume(self) -> float:
        """Volume of the dual hull; in 2-D its area."""
        return self._dual_measures[1]

    @cached_property
    def _dual_measures(self) -> tuple[float, float]:
        """Area and volume of the dual hull: sums over pyramids from its center to its simplices."""
        middle = self.dual_points[self.dual_vertices].mean(axis=0)
        volumes = np.abs(np.linalg.det(self.dual_points[self._simplices] - middle))
        volumes /= factorial(self.ndim)
        equations = self._made.equations
        heights = -(equations[:, :-1] @ middle + equations[:, -1])[self._made.corner_of]
        return float((self.ndim * volumes / heights).sum()), float(volumes.sum())

    def add_halfspaces(self, halfspaces: ArrayLike, restart: bool = False) -> None:
        """Add half-spaces.

        Parameters
        ----------
        halfspaces : array_like, shape (k, ndim + 1) or (ndim + 1,)
            Half-spaces to append to `halfspaces`.
        restart : bool, optional
            Accepted as in SciPy, without effect.

        Raises
        ------
        RuntimeError
            `incremental` was not set, or `close` has been called.
        QhullError, ValueError
            As in the constructor; nothing is changed.

        Examples
        --------
        >>> import numpy as np
        >>> from delone.compat.scipy import HalfspaceIntersection
        >>> square = np.array([(-1, 0, 0), (1, 0, -1), (0, -1, 0), (0, 1, -1)])
        >>> found = HalfspaceIntersection(square, np.array([0.5, 0.5]), incremental=True)
        >>> found.add_halfspaces([(1, 1, -1.5)])
        >>> len(found.intersections)
        5
        """
        if not self._open:
            raise RuntimeError("incremental mode is not enabled, or already closed")
        more = _as_rows(np.atleast_2d(np.asanyarray(halfspaces)))
        if more.shape[1] != self.ndim + 1:
            raise wrong_shape("halfspaces", f"(k, {self.ndim + 1})", more)
        rows = np.concatenate((self.halfspaces, more))
        # Redundant half-spaces remain redundant.
        self._set(rows, np.concatenate((self.dual_vertices, np.arange(self.nineq, len(rows)))))

    def close(self) -> None:
        """End incremental mode; `add_halfspaces` raises from then on."""
        self._open = False


def _as_rows(halfspaces: ArrayLike) -> Floats:
    """Half-spaces as rows of doubles, with errors of SciPy's types."""
    rows = _as_doubles(halfspaces, "halfspaces")
    if rows.ndim != 2 or rows.shape[1] < _FEWEST:
        raise ShapeError(
            f"halfspaces must be a 2D array of shape (nineq, 3 or more), got {rows.shape}"
        )
    if rows.shape[1] > MOST + 1:
        raise DimensionError(
            f"this function of delone.compat.scipy is only available in up to {MOST} dimensions; "
            f"for {rows.shape[1] - 1} coordinates use scipy.spatial"
        )
    bad = np.flatnonzero(np.isnan(rows).any(axis=1))
    if bad.size:
        raise NonFiniteError(
            f"halfspaces: {len(bad)} of {len(rows)} rows contain NaN; first: {bad[0]}",
            rows=bad[:10],
            count=len(bad),
        )
    return rows


def _as_doubles(values: ArrayLike, name: str) -> Floats:
    """A copy of an array as doubles: later changes of the array have no effect."""
    if is_masked(values):
        raise DtypeError(f"{name} must not be a masked array")
    given = as_plain_array(values, name)
    require_real(given, name, kinds="biufO")
    try:
        return np.array(given, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError) as error:
        raise DtypeError(f"{name} must contain real numbers: {error}") from None


def _reason(why: str, rows: Floats, named: Indices | Rows) -> str:
    """Why there is no intersection with corners."""
    if why == "flat":
        meeting = _common_point(rows[named])
        if meeting is None:
            return "there is no corner of the half-spaces: their boundaries are parallel to a line"
        return f"all boundaries meet in {meeting}, so the dual points span no volume"
    row = int(named[0])
    if why == "too close":
        return f"interior_point is too close to the boundary of half-space {row}"
    return (
        f"interior_point is not a feasible point: it is not strictly inside half-space {row}, "
        f"{rows[row].tolist()}"
    )


def _common_point(rows: Floats) -> list[float] | None:
    """The point at which the boundaries of independent half-spaces meet, if it is the only one."""
    count, width = rows.shape
    if count != width - 1:
        return None
    *point, end = kernel([[*map(Fraction, row)] for row in rows.tolist()])
    return [float(x / end) for x in point] if end else None
