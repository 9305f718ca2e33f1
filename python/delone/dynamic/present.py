"""The current state of a live triangulation as arrays, and queries in it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_queries
from delone._base.immutable import sealed
from delone._base.renames import renamed
from delone._tiling import location
from delone._tiling.plane.dimension import PLANE
from delone._tiling.space.dimension import SPACE
from delone.delaunay import Delaunay
from delone.dynamic.given import as_any_values, as_values
from delone.dynamic.results import DynamicArrays
from delone.dynamic.segments import Segmented, as_handles, refuse
from delone.errors import HandleError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone._tiling.dimension import Dimension, Locator
    from delone._tiling.location import Location

    Handles = NDArray[np.int64]

__all__ = ["Present"]


@renamed(corners="corners_at")
class Present(Segmented):
    """What a `Dynamic` provides about its current state."""

    __slots__ = ("_index", "_known", "_present", "_system")

    # The reference system of the points.
    _system: str | None

    # The arrays of a state, and the object that identifies it.
    _present: tuple[object, _core.LiveArrays] | None
    # The point location index, and the arrays that it belongs to.
    _index: tuple[_core.LiveArrays, Locator] | None
    # The number of an edit, and the handles of all points after it.
    _known: tuple[int, Handles]

    def _arrays(self) -> _core.LiveArrays:
        """Return the arrays of the current state, built once after each edit."""
        edit, present = self._edit, self._present
        if present is None or present[0] is not edit:
            made = self._live.arrays()
            for array in (made.handles, made.points, made.simplices, made.neighbors):
                sealed(array)
            sealed(made.duplicates)
            present = (edit, made)
            self._present = present
        return present[1]

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d), in ascending order of handles."""
        return self._arrays().points

    @property
    def handles(self) -> Handles:
        """The handles of the rows of `points`, ascending, (n,)."""
        return self._arrays().handles

    @property
    def simplices(self) -> Indices:
        """The simplices as rows of `points`, positively oriented, (m, d + 1)."""
        return self._arrays().simplices

    @property
    def neighbors(self) -> Indices:
        """The simplex opposite each vertex, (m, d + 1); -1 outside."""
        return self._arrays().neighbors

    @property
    def duplicates(self) -> Handles:
        """Handles of duplicates, and the vertex of each, (k, 2): the smallest handle there."""
        made = self._arrays()
        return sealed(made.handles[made.duplicates])

    @property
    def ndim(self) -> int:
        """The number of coordinates, 2 or 3."""
        return self._live.ndim

    @property
    def npoints(self) -> int:
        """The number of points, including duplicates."""
        return self._live.counts()[0]

    @property
    def nsimplex(self) -> int:
        """The number of simplices; 0 if all points are on one line or in one plane."""
        return self._live.counts()[2]

    @property
    def workers(self) -> int | None:
        """Maximum number of threads; None for one per core. The result does not depend on it."""
        return self._workers

    # Queries.

    def find_simplex(self, xi: ArrayLike, *, tolerance: float = 0.0) -> Indices:
        """Find the simplices that contain points.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points to locate. NaN and infinity are outside.
        tolerance : float, optional
            Points outside at most this far away are inside; as in `Delaunay.find_simplex`.

        Returns
        -------
        ndarray of int32, shape (...)
            Rows of `simplices`, the first one if there are several; -1 outside.

        Raises
        ------
        InputError
            `tolerance` is negative or NaN.

        Notes
        -----
        The arrays are rebuilt after an edit; `corners_at` and `interpolate` do not need them.

        Examples
        --------
        >>> from delone import Dynamic
        >>> Dynamic([(0, 0), (1, 0), (0, 1)]).find_simplex([(0.25, 0.25), (2, 2)])
        array([ 0, -1], dtype=int32)
        """
        queries = as_queries(xi, self.ndim, self._system)
        if self.nsimplex == 0:
            return np.full(queries.shape[:-1], -1, dtype=np.int32)
        if tolerance != 0:
            return self.locate(queries, tolerance=tolerance).simplex
        return location.find(_dimension(self.ndim), self._locator()[1], queries, self._workers)

    def locate(self, xi: ArrayLike, *, tolerance: float = 0.0) -> Location:
        """Locate points: simplices, barycentric weights, nearest points of the boundary.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points to locate.
        tolerance : float, optional
            Points outside at most this far away are inside; as in `Delaunay.locate`.

        Returns
        -------
        Location
            Its `simplex` and `beside` are rows of `simplices`, its `facet` rows of `points`.

        Raises
        ------
        DegenerateInputError
            There is no simplex.
        InputError
            `tolerance` is negative or NaN.

        Examples
        --------
        >>> from delone import Dynamic
        >>> Dynamic([(0, 0), (4, 0), (0, 4)]).locate((1, 2)).barycentric.max()
        np.float64(0.5)
        """
        made, index = self._locator()
        return location.locate_near(
            _dimension(self.ndim),
            index,
            made.points,
            made.simplices,
            as_queries(xi, self.ndim, self._system),
            tolerance=tolerance,
            workers=self._workers,
        )

    def _locator(self) -> tuple[_core.LiveArrays, Locator]:
        """Return the current arrays, and their point location index."""
        made, index = self._arrays(), self._index
        if not len(made.simplices):
            # The error says why there is none.
            Delaunay(made.points, workers=self._workers, planar=True)
        if index is None or index[0] is not made:
            locator = _dimension(self.ndim).locator
            index = (made, locator(made.points, made.simplices, made.neighbors))
            self._index = index
        return index

    def corners_at(self, xi: ArrayLike) -> tuple[Handles, Floats]:
        """Return corners and weights of the simplices that contain points.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points to locate.

        Returns
        -------
        handles : ndarray of int64, shape (..., d + 1)
            The handles of the corners of a simplex with the point inside or on its boundary; -1
            outside.
        weights : ndarray of float64, shape (..., d + 1)
            Their barycentric weights; NaN outside.

        Notes
        -----
        The search is a walk in the current state and needs no arrays: it is cheap between edits.

        Examples
        --------
        >>> from delone import Dynamic
        >>> handles, weights = Dynamic([(0, 0), (4, 0), (0, 4)]).corners_at((1, 2))
        >>> sorted(zip(handles.tolist(), weights.tolist(), strict=True))
        [(0, 0.25), (1, 0.25), (2, 0.5)]
        """
        queries = as_queries(xi, self.ndim, self._system)
        flat = np.ascontiguousarray(queries.reshape(-1, self.ndim))
        handles, weights = self._live.corners(flat)
        shape = (*queries.shape[:-1], self.ndim + 1)
        return handles.reshape(shape), weights.reshape(shape)

    def nearest(self, xi: ArrayLike) -> Handles:
        """Find the points that are nearest to others.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points, inside or outside.

        Returns
        -------
        ndarray of int64, shape (...)
            The handle of the nearest point, the smallest if there are several; -1 if a coordinate
            is NaN or infinite, or there is no point.

        Notes
        -----
        The result is exact. The search is a walk in the current state and needs no arrays: it is
        cheap between edits.

        Examples
        --------
        >>> from delone import Dynamic
        >>> Dynamic([(0, 0), (1, 0), (0, 1)]).nearest([(0.9, 0.2), (0.5, 0.5)])
        array([1, 0])
        """
        queries = as_queries(xi, self.ndim, self._system)
        flat = np.ascontiguousarray(queries.reshape(-1, self.ndim))
        return self._live.nearest(flat).reshape(queries.shape[:-1])

    def arrays(self, values: ArrayLike | None = None) -> DynamicArrays:
        """Return all arrays of one state, whatever other threads do.

        Parameters
        ----------
        values : array_like, shape (k, ...), optional
            A value for each handle: that of handle h is ``values[h]``. There may be more values
            than handles, as in an array that grows.

        Returns
        -------
        DynamicArrays
            Handles, points, simplices, neighbors, and the values of these points.

        Raises
        ------
        ShapeError
            There are fewer values than the largest handle needs, or rows of unequal length.
        DtypeError
            Values are masked.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (4, 0), (4, 3), (0, 3)])
        >>> live.remove([1])
        >>> state = live.arrays(values=[10.0, 11.0, 12.0, 13.0])
        >>> state.handles, state.values
        (array([0, 2, 3]), array([10., 12., 13.]))
        """
        made, own = self._arrays(), None
        if values is not None:
            given = as_any_values(values)
            least = int(made.handles[-1]) + 1 if len(made.handles) else 0
            if given.ndim == 0 or len(given) < least:
                raise ShapeError(
                    f"values must have {least} rows or more, one for each handle, got {given.shape}"
                )
            own = given[made.handles]
        return DynamicArrays(made.handles, made.points, made.simplices, made.neighbors, own)

    def rows_of(self, handles: ArrayLike) -> NDArray[np.int64]:
        """Return the rows of `points` that have these handles.

        Parameters
        ----------
        handles : array_like of int, shape (k,)
            Handles; they may repeat.

        Returns
        -------
        ndarray of int64, shape (k,)
            The row of each.

        Raises
        ------
        HandleError
            A handle does not exist.
        DtypeError
            `handles` are not integers.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (4, 0), (4, 3), (0, 3)])
        >>> live.remove([1])
        >>> live.rows_of([3, 0])
        array([2, 0])
        """
        wanted = as_handles(handles)
        return _places(self._arrays().handles, wanted)

    def interpolate(
        self, xi: ArrayLike, values: ArrayLike, *, handles: ArrayLike | None = None
    ) -> NDArray[Any]:
        """Interpolate values linearly in the current simplices.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Where to interpolate.
        values : array_like, shape (n, ...)
            A real or complex value for each row of `points`; for duplicates, that of the vertex is
            used.
        handles : array_like of int, shape (n,), optional
            The handles that the values belong to, in any order, each once. All points must be
            among them; others are not used. By default, those of the current rows.

        Returns
        -------
        ndarray of float64 or complex128, shape (..., ...)
            The values; NaN outside.

        Raises
        ------
        ShapeError
            The number of values differs from that of points, or of handles.
        DtypeError
            `values` are not numbers, are masked, or cannot be represented as float64.
        HandleError
            A point is not among `handles`, or one is named twice.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (4, 0), (0, 4)])
        >>> live.remove([0])
        >>> _ = live.insert([(4, 4)])
        >>> live.interpolate((3, 3), live.points.sum(axis=1))
        array(6.)
        """
        given = as_values(values)
        queries = as_queries(xi, self.ndim, self._system)
        flat = np.ascontiguousarray(queries.reshape(-1, self.ndim))
        # One call for everything that must be of one state, whatever other threads do.
        edit, own = self._known
        corners, weights, now, changed = self._live.weights(flat, edit)
        if changed is not None:
            own = changed
            self._known = now, own
        if handles is not None:
            given = _of_handles(given, as_handles(handles), own)
        if given.ndim == 0 or len(given) != len(own):
            raise ShapeError(f"values must have {len(own)} rows, one per point, got {given.shape}")
        shape = (*queries.shape[:-1], *given.shape[1:])
        if not len(own):
            return np.full(shape, np.nan)
        rows = np.searchsorted(own, corners).clip(max=len(own) - 1)
        shares = weights.reshape(*weights.shape, *(1,) * (given.ndim - 1))
        found = (shares * given[rows]).sum(axis=1)
        return np.asarray(found).reshape(shape)


def _places(own: Handles, wanted: Handles) -> NDArray[np.int64]:
    """Return the positions of handles among others, which ascend."""
    place = np.searchsorted(own, wanted).clip(max=max(len(own) - 1, 0))
    there = own[place] == wanted if len(own) else np.zeros(len(wanted), dtype=bool)
    refuse(np.unique(wanted[~there]), np.empty(0, dtype=np.int64), "handle")
    return place


def _of_handles(values: NDArray[Any], handles: Handles, own: Handles) -> NDArray[Any]:
    """Return the values of handles in the order of the current rows."""
    if values.ndim == 0 or len(values) != len(handles):
        raise ShapeError(
            f"values must have {len(handles)} rows, one per handle, got {values.shape}"
        )
    order = np.argsort(handles, kind="stable")
    ascending = handles[order]
    twice = ascending[1:][ascending[1:] == ascending[:-1]]
    refuse(np.empty(0, dtype=np.int64), twice, "handle")
    missing = own[~np.isin(own, ascending)]
    if len(missing):
        raise HandleError(
            f"handle {missing[0]} is a point without a value: it is not among `handles`",
            handles=missing,
        )
    found: NDArray[Any] = values[order[_places(ascending, own)]]
    return found


def _dimension(ndim: int) -> Dimension:
    """Return the functions for a number of coordinates."""
    return PLANE if ndim == 2 else SPACE
