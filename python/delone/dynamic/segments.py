"""Segments of a live triangulation: edges that remain while points are added, removed and moved."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from delone import _core
from delone._base.arrays import as_plain_array, as_workers, require_integers, wrong_shape
from delone._base.immutable import sealed
from delone.constrained import ConstrainedDelaunay
from delone.dynamic import validation
from delone.errors import DtypeError, HandleError, InputError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Indices
    from delone.dynamic.validation import DynamicReport

    Handles = NDArray[np.int64]

T = TypeVar("T")

__all__ = ["FEW", "Segmented", "as_handles", "given_segments", "refuse"]

# Fewer items are edited while holding the GIL, so that they cannot change in the meantime.
FEW = 16


class Segmented:
    """The part of a `Dynamic` that deals with segments."""

    __slots__ = ("_edit", "_live", "_workers")

    _live: _core.Live
    # A separate object for each state.
    _edit: object
    _workers: int | None

    def _plane(self) -> _core.Live:
        """Return the core of a 2-D triangulation."""
        if self._live.ndim == 2:
            return self._live
        raise InputError("segments are for 2-D triangulations; this one is 3-D")

    def _edited(self, change: Callable[..., T], *arguments: Any) -> T:
        """Change the core and invalidate the arrays, even if interrupted.

        A signal may be handled after the core has finished and before anything else happens here,
        so the edit is counted before it starts; it is counted again after it, for readers in other
        threads. If the core has completed nothing, the old arrays are still valid.
        """
        before, known = self._live.edits, self._edit
        self._edit = object()
        try:
            made = change(*arguments)
        except BaseException:
            self._edit = known if self._live.edits == before else object()
            raise
        self._edit = object()
        return made

    def _arrays(self) -> _core.LiveArrays:
        raise NotImplementedError

    @property
    def _has_segments(self) -> bool:
        return self._live.ndim == 2 and self._live.constraints()[0]

    def insert_segments(self, segments: ArrayLike) -> Handles:
        """Insert segments: edges that the triangulation must contain.

        Parameters
        ----------
        segments : array_like of int, shape (s, 2)
            Handles of the points that each segment joins. Segments may repeat, overlap, pass
            through points, and have zero length.

        Returns
        -------
        ndarray of int64, shape (s,)
            Handles of the segments, ascending; they are independent of those of points.

        Raises
        ------
        CrossingSegmentsError
            Segments cross, and `crossing` is ``"raise"``; ``error.pairs`` contains the handles of
            all pairs. Nothing has changed.
        HandleError
            A point does not exist, or is a crossing of segments; nothing has changed.
        BudgetExceededError, DtypeError, ShapeError, MemoryError
            As for `ConstrainedDelaunay`; nothing has changed.

        Notes
        -----
        Edges in the way of a segment are flipped until none is (S. W. Sloan, "A fast algorithm for
        generating constrained Delaunay triangulations", 1993): for k of them in O(k) if most can be
        flipped immediately, and at most O(k^2). Where segments cross, all that are connected by
        crossings are reinserted, and all crossings are compared with the new ones. Everything is
        retriangulated if that is cheaper, or if a segment passes within rounding error of a point
        or of a crossing of others.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (4, 0), (4, 3), (0, 3)])
        >>> live.insert_segments([(1, 3)])
        array([0])
        >>> live.segments
        array([[1, 3]], dtype=int32)
        """
        plane, own = self._plane(), _as_ends(segments)
        flat = np.ascontiguousarray(own.reshape(-1))
        gone, _ = plane.faults(flat)
        refuse(gone, np.empty(0, dtype=np.int64), "handle")
        _refuse_crossings(plane, flat)
        return self._edited(plane.insert_segments, own, as_workers(self._workers))

    def remove_segments(self, segments: ArrayLike) -> None:
        """Remove segments.

        Parameters
        ----------
        segments : array_like of int, shape (s,)
            Their handles, each once.

        Raises
        ------
        HandleError
            A segment does not exist, or is named twice; nothing has changed.
        DtypeError
            `segments` are not integers.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (4, 0), (4, 3), (0, 3)], [(1, 3)])
        >>> live.remove_segments([0])
        >>> len(live.segments), live.nsimplex
        (0, 2)
        """
        plane, own = self._plane(), as_handles(segments, "segments")
        gone, twice = plane.segment_faults(own)
        refuse(gone, twice, "segment")
        self._edited(plane.remove_segments, own, as_workers(self._workers))

    @property
    def segment_handles(self) -> Handles:
        """The handles of the segments, ascending, (s,)."""
        return sealed(self._plane().segments().handles)

    @property
    def input_segments(self) -> Handles:
        """The handles of the ends of each segment, (s, 2), in the order of `segment_handles`."""
        return sealed(self._plane().segments().ends)

    @property
    def crossings(self) -> Handles:
        """Two segments that cross, and the handle of the vertex there, (c, 3); all are handles."""
        return sealed(self._plane().segments().crossings)

    @property
    def constrained(self) -> NDArray[np.bool_]:
        """Whether the edge opposite each vertex is part of a segment, (m, 3)."""
        self._plane()
        return sealed(_marked(self._arrays()))

    @property
    def segments(self) -> Indices:
        """The edges that the segments consist of, as rows of `points`, ascending, (q, 2)."""
        made = self._arrays()
        simplices, marked = made.simplices, _marked(made)
        corners = [simplices[marked[:, k]][:, [(k + 1) % 3, (k + 2) % 3]] for k in range(3)]
        edges = np.sort(np.concatenate(corners), axis=1)
        return sealed(np.unique(edges, axis=0).astype(np.int32))

    def _frozen_segments(self) -> ConstrainedDelaunay:
        """Return the current triangulation with its segments as an object that never changes."""
        # Of one state, whatever other threads do.
        plane = self._plane().state().open()
        made, own = plane.arrays(), plane.segments()
        kept = ~np.isin(made.handles, own.added)
        handles = made.handles[kept]
        rows = np.searchsorted(handles, own.ends).astype(np.int32)
        return ConstrainedDelaunay(
            made.points[kept],
            rows,
            crossing="split" if plane.constraints()[1] else "raise",
            workers=self._workers,
            planar=True,
        )

    def _validated_segments(self) -> DynamicReport:
        """Check the current triangulation with its segments, all of one state."""
        plane = self._plane().state().open()
        split = plane.constraints()[1]
        made, own = plane.arrays(), plane.segments()
        return validation.validate(made, own, split=split, workers=self._workers)

    def _refuse_held(self, handles: Handles, *, ends: bool = True) -> None:
        """Raise an error if some points are crossings, or `ends` of segments that remain."""
        if not self._has_segments:
            return
        held = self._plane().held(handles)
        if not ends:
            held = held[held[:, 1] < 0]
        for handle, segment in held[:1].tolist():
            if segment < 0:
                message = f"handle {handle} is a crossing of segments: it goes with them"
            else:
                message = (
                    f"handle {handle} is an end of segment {segment}: remove that one first, or "
                    'give segments="remove"'
                )
            raise HandleError(message, handles=held[:, 0])


def given_segments(live: _core.Live, segments: ArrayLike, workers: int) -> None:
    """Insert the segments of a constructor, pairs of its rows."""
    ends = _as_ends(segments)
    count = live.counts()[3]
    outside = np.flatnonzero(((ends < 0) | (ends >= count)).any(axis=1))
    if len(outside):
        row = int(outside[0])
        raise InputError(
            f"segment {row} is {tuple(ends[row].tolist())}: rows of points are 0 to {count - 1}"
        )
    if len(ends):
        live.insert_segments(ends, workers)


def refuse(gone: Handles, twice: Handles, noun: str) -> None:
    """Raise an error that names handles that do not exist, or occur twice."""
    if len(gone):
        names = ", ".join(map(str, gone[:5].tolist())) + (", ..." if len(gone) > 5 else "")
        verb, nouns = ("is", noun) if len(gone) == 1 else ("are", f"{noun}s")
        raise HandleError(f"{nouns} {names} {verb} not there", handles=gone)
    if len(twice):
        raise HandleError(f"{noun} {twice[0]} is named twice", handles=twice)


# Exactly integers: booleans and NumPy numbers have their own types.
_INT = frozenset((int,))


def as_handles(handles: ArrayLike, name: str = "handles") -> Handles:
    """Return handles as a contiguous array."""
    # Most edits name a few points, and take less time than the checks below.
    if isinstance(handles, list) and len(handles) <= FEW and _INT.issuperset(map(type, handles)):
        with suppress(OverflowError):
            return np.array(handles, dtype=np.int64)
    array = _as_integers(handles, name)
    if array.size and array.ndim != 1:
        raise wrong_shape(name, "(k,)", array)
    return array.reshape(-1)


def _as_ends(ends: ArrayLike) -> Handles:
    """Return pairs of handles as a contiguous array."""
    array = _as_integers(ends, "ends")
    if array.size and (array.ndim != 2 or array.shape[1] != 2):
        raise wrong_shape("ends", "(s, 2)", array)
    return array.reshape(-1, 2)


def _as_integers(handles: ArrayLike, name: str) -> Handles:
    array = as_plain_array(handles, name)
    if array.ndim == 0:
        raise ShapeError(f"{name} must be an array, got one number: {handles!r:.80}")
    if array.size == 0:
        return np.empty(0, dtype=np.int64)
    require_integers(array, name)
    if array.dtype.kind == "u" and int(array.max()) >= 2**63:
        raise DtypeError(f"{name} must be below 2**63")
    if len(array) > FEW:
        return np.array(array, dtype=np.int64, order="C")
    return np.ascontiguousarray(array, dtype=np.int64)


def _marked(made: _core.LiveArrays) -> NDArray[np.bool_]:
    """Return which edges are parts of segments."""
    marked = made.constrained
    return np.zeros(made.simplices.shape, dtype=bool) if marked is None else marked


def _refuse_crossings(plane: _core.Live, handles: Handles) -> None:
    """Raise an error if some of these handles are crossings."""
    held = plane.held(handles)
    crossed: Handles = held[held[:, 1] < 0, 0]
    if len(crossed):
        raise HandleError(
            f"handle {crossed[0]} is a crossing of segments, not a point that was inserted",
            handles=crossed,
        )
