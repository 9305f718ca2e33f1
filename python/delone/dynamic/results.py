"""What a live triangulation returns: changes since the last call, and snapshots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from delone import _core
from delone._base.arrays import as_workers
from delone.dynamic.saving import State
from delone.errors import DtypeError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Changes", "DynamicArrays", "Snapshot"]


class Changes(NamedTuple):
    """The simplices that were removed and added.

    Parameters
    ----------
    gone : ndarray of int64, shape (k, d + 1)
        Simplices that no longer exist, as handles.
    new : ndarray of int64, shape (k, d + 1)
        Simplices that did not exist before, as handles.

    Notes
    -----
    Each begins with its smallest handle (in 3-D, with the two smallest), and is positively
    oriented; rows are ascending. A simplex whose vertices moved, but are still joined, is in
    neither.

    Examples
    --------
    >>> from delone import Dynamic
    >>> live = Dynamic([(0, 0), (2, 0), (0, 2)])
    >>> live.changes().new
    array([[0, 1, 2]])
    >>> _ = live.insert([(2, 2)])
    >>> live.changes().new
    array([[0, 1, 3],
           [0, 3, 2]])
    """

    gone: NDArray[np.int64]
    new: NDArray[np.int64]


class DynamicArrays(NamedTuple):
    """The arrays of one state.

    Parameters
    ----------
    handles : ndarray of int64, shape (n,)
        The handles of the rows of `points`, ascending.
    points : ndarray of float64, shape (n, d)
        The coordinates.
    simplices : ndarray of int32, shape (m, d + 1)
        The simplices as rows of `points`, positively oriented.
    neighbors : ndarray of int32, shape (m, d + 1)
        The simplex opposite each vertex; -1 outside.
    values : ndarray, shape (n, ...), or None
        The caller's values of these points.

    Examples
    --------
    See `Dynamic.arrays`.
    """

    handles: NDArray[np.int64]
    points: NDArray[np.float64]
    simplices: NDArray[np.int32]
    neighbors: NDArray[np.int32]
    values: NDArray[Any] | None


class Snapshot:
    """A state of a `Dynamic`, for `Dynamic.restore`; it never changes.

    Parameters
    ----------
    state : object
        What the core returns; snapshots are made by `Dynamic.snapshot`.
    crs : str, optional
        The reference system of the points.

    Notes
    -----
    Snapshots share with each other what has not changed between them. Pickles and deep copies in
    other processes contain points, segments and handles, share nothing, and restore the same state.

    Examples
    --------
    >>> from delone import Dynamic
    >>> live = Dynamic([(0, 0), (2, 0), (0, 2)])
    >>> before = live.snapshot()
    >>> _ = live.insert([(2, 2)])
    >>> live.restore(before)
    >>> live
    <Dynamic of 3 points: 1 triangle>
    """

    __slots__ = ("_state", "_system")

    @classmethod
    def _again(cls, saved: tuple[Any, ...], crs: str | None = None) -> Snapshot:
        """Return the snapshot of a pickle."""
        return cls(State.unpickled(saved).opened(as_workers(None)).state(), crs)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._again, (tuple(State.of(self._state.open()).pickled()), self._system)

    def __init__(self, state: _core.LiveState, crs: str | None = None) -> None:
        self._state = state
        self._system = crs

    def bytes_beyond(self, other: Snapshot) -> int:
        """Return how much memory this snapshot needs in addition to another one.

        Parameters
        ----------
        other : Snapshot
            The other snapshot.

        Returns
        -------
        int
            Bytes that the two do not share.

        Raises
        ------
        DtypeError
            One of them is 2-D, the other 3-D.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (2, 0), (0, 2)])
        >>> before = live.snapshot()
        >>> live.snapshot().bytes_beyond(before) < 100
        True
        """
        own, theirs = self._state, other._state
        if own.ndim != theirs.ndim:
            raise DtypeError("a 2-D and a 3-D snapshot share nothing")
        return own.own_bytes(theirs)

    def __copy__(self) -> Snapshot:
        return self

    def __deepcopy__(self, memo: dict[int, object]) -> Snapshot:
        return self
