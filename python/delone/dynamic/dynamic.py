"""The class Dynamic: a Delaunay triangulation whose points are inserted, removed and moved."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Literal, Self, overload

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_limit, as_workers
from delone._base.counting import counted
from delone._base.georeference import crs_of, warn_of_degrees
from delone._base.immutable import own_copy
from delone._tiling.complex import Drawn, Filed
from delone.constrained import ConstrainedDelaunay
from delone.delaunay import Delaunay
from delone.dynamic.given import as_ndim, given_points, own_points
from delone.dynamic.measured import Measured
from delone.dynamic.results import Changes, Snapshot
from delone.dynamic.saving import State, require_few_handles
from delone.dynamic.segments import FEW, as_handles, given_segments, refuse
from delone.errors import DtypeError, EditConflictError, InputError, ShapeError

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from numpy.typing import ArrayLike, NDArray

    from delone.validation import ValidationReport

    Handles = NDArray[np.int64]

__all__ = ["Dynamic"]


class Dynamic(Measured, Drawn, Filed):
    """A 2-D or 3-D Delaunay triangulation with points that can be inserted, removed and moved.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or triangulation, optional
        Finite coordinates, as for `Delaunay`, or a triangulation, whose points are used; by default
        none. Their handles are 0 to n - 1. The segments of a `ConstrainedDelaunay` are used as
        well.
    segments : array_like of int, shape (s, 2), optional
        2-D only: edges that the triangulation must contain, as pairs of rows of `points`. Their
        handles are 0 to s - 1.
    crossing : {"raise", "split"}, optional
        Whether crossing segments raise an error, or are split at a new vertex; by default as in
        `points`, and otherwise ``"raise"``.
    ndim : int, optional
        The number of coordinates, 2 or 3; by default that of `points`, and 2 without points.
    workers : int, optional
        Maximum number of threads when all points are triangulated together; by default one per
        core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning, here and in
        `insert`.

    Raises
    ------
    NonFiniteError, ShapeError, DtypeError
        As for `Delaunay`.
    CrossingSegmentsError, BudgetExceededError, InputError
        As for `ConstrainedDelaunay`.
    LimitError
        There are more than 2**28 points, 2**27 in 3-D, or 2**32 - 2 handles have been assigned.
    MemoryError
        There is not enough memory.

    Warns
    -----
    GeographicWarning
        The points are longitudes and latitudes; `delone.sphere` triangulates them on the sphere.

    See Also
    --------
    Delaunay : A triangulation that never changes.
    ConstrainedDelaunay : The same with segments.

    Notes
    -----
    After each edit, the simplices are exactly those of a new `Delaunay` of the same points: ties
    are broken by coordinates, so a set of points has one triangulation, whatever the edits were.

    A *handle* is an int64 that identifies a point as long as the point exists, even when it moves.
    A handle is never reused, not even after `restore`. Rows of `points` are in ascending order of
    handles, so rows change when points are removed, but handles do not. Each point has its own
    handle: of points with the same coordinates, the one with the smallest handle is the vertex, and
    another one replaces it when it is removed (`duplicates`).

    Points that all lie on one line or, in 3-D, in one plane have no simplices. The points are kept,
    and simplices appear with the first point that is not on that line or plane.

    With segments, the simplices are those of a new `ConstrainedDelaunay` of the same points and
    segments. A segment joins two handles and moves with its endpoints; endpoints cannot be removed.
    With ``crossing="split"``, the crossing of two segments is a vertex with its own handle, which
    is removed with the segments. The time of an edit of a crossing segment depends on the segments
    that are connected to it by crossings (`insert_segments`).

    An edit is atomic: after any error, including Ctrl-C and a failed allocation, nothing has
    changed. If Ctrl-C arrives after the edit is complete, only its return value is lost: check
    ``len``; the handles of the inserted points are the last of `handles`. Edits from several
    threads run one after another.

    An insertion walks from the last edit, or from a tree of starting points; its time is
    proportional to the number of simplices that it replaces (A. Bowyer; D. F. Watson, both 1981). A
    removal fills the star of the point with m simplices of its k neighbors in O(k m), or
    retriangulates all points if that is faster. A point that moves within its star keeps its
    connections: in 2-D, flips (C. L. Lawson, 1977) restore the triangulation; in 3-D, this is done
    only if no flip is needed. Batches are sorted along a space-filling curve, and large ones
    retriangulate all points. Arrays such as `simplices` are built on first use after an edit, in
    linear time; `plot` draws the result of `freeze`. Each handle takes 12 bytes, even after its
    point is removed.

    Examples
    --------
    >>> from delone import Dynamic
    >>> live = Dynamic([(0, 0), (4, 0), (4, 3), (0, 3)])
    >>> center, = live.insert([(2, 1)])
    >>> live
    <Dynamic of 5 points: 4 triangles>
    >>> live.move([center], [(1, 1)])
    >>> live.remove([1])
    >>> live.handles
    array([0, 2, 3, 4])
    >>> live.freeze()
    <Delaunay of 4 points: 3 triangles>
    """

    __slots__ = ("__weakref__", "_planar")

    # Whether warnings about degrees are off.
    _planar: bool

    @property
    def crs(self) -> str | None:
        """The reference system of the points, if the first ones declared one."""
        return self._system

    def __init__(
        self,
        points: ArrayLike | Delaunay | ConstrainedDelaunay | None = None,
        segments: ArrayLike | None = None,
        *,
        crossing: str | None = None,
        ndim: int | None = None,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        dimension = as_ndim(ndim)
        if points is None:
            points = np.empty((0, dimension or 2))
        given = given_points(points)
        if isinstance(points, ConstrainedDelaunay):
            given = points.points[: points.npoints - points.nadded]
            segments = points.input_segments if segments is None else segments
            crossing = crossing or points._options.crossing
        own = own_copy(given, ndim=dimension)
        warn_of_degrees(given, own, planar=planar)
        core = _core.Live(own, None, 0, as_workers(workers))
        split = as_choice(crossing or "raise", ("raise", "split"), name="crossing") == "split"
        if core.ndim == 2:
            core.split_crossings(split)
            given_segments(core, () if segments is None else segments, as_workers(workers))
        elif segments is not None:
            raise InputError("segments are for 2-D points; these are 3-D")
        self._begin(core, workers, bool(planar), crs_of(points))

    def _begin(
        self,
        core: _core.Live,
        workers: int | None,
        planar: bool = False,
        system: str | None = None,
    ) -> None:
        self._live = core
        self._planar = planar
        self._system = system
        self._workers = workers
        self._edit = object()
        self._present = None
        self._whole = None
        self._index = None
        self._known = -1, np.empty(0, dtype=np.int64)

    @classmethod
    def _of(
        cls,
        core: _core.Live,
        workers: int | None,
        planar: bool = False,
        system: str | None = None,
    ) -> Self:
        made = cls.__new__(cls)
        made._begin(core, workers, planar, system)
        return made

    @classmethod
    def _again(cls, saved: tuple[Any, ...], options: tuple[Any, ...]) -> Self:
        """Return the triangulation of a pickle; options are as for `_of`."""
        workers, planar, *system = options
        core = State.unpickled(saved).opened(as_workers(workers))
        return cls._of(core, workers, bool(planar), *system)

    @property
    def _options(self) -> tuple[int | None, bool, str | None]:
        """The options of a copy, as for `_of`."""
        return self._workers, self._planar, self._system

    def _state(self) -> State:
        """Return the current state, a consistent one whatever other threads do."""
        return State.of(self._live.state().open())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._again, (tuple(self._state().pickled()), self._options)

    def __copy__(self) -> Self:
        return self._of(self._live.state().open(), *self._options)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.__copy__()

    def __len__(self) -> int:
        """Return the number of points."""
        return self._live.counts()[0]

    def __contains__(self, handle: object) -> bool:
        """Return whether the point with this handle exists."""
        if isinstance(handle, bool) or not isinstance(handle, int | np.integer):
            return False
        if not 0 <= handle < self._live.counts()[3]:
            return False
        gone, _ = self._live.faults(np.array([handle], dtype=np.int64))
        return len(gone) == 0

    def __repr__(self) -> str:
        npoints, vertices, nsimplex, _ = self._live.counts()
        points = counted(npoints, "point")
        if npoints > vertices:
            points += f" ({counted(npoints - vertices, 'duplicate')})"
        if self._has_segments:
            points += f" and {counted(len(self.segment_handles), 'segment')}"
        simplices = counted(nsimplex, "triangle" if self.ndim == 2 else "tetrahedron")
        return f"<{type(self).__name__} of {points}: {simplices}>"

    # Edits.

    def insert(self, points: ArrayLike) -> Handles:
        """Insert points.

        Parameters
        ----------
        points : array_like, shape (k, d)
            Finite coordinates. A point at an existing position becomes a duplicate. Points that
            declare a reference system other than `crs` are transformed, with pyproj (extra
            ``geo``).

        Returns
        -------
        ndarray of int64, shape (k,)
            Their handles, ascending.

        Raises
        ------
        NonFiniteError, ShapeError, DtypeError, LimitError, MemoryError
            As for the constructor; nothing has changed.

        Warns
        -----
        GeographicWarning
            As for the constructor.
        CRSWarning
            `crs` or the reference system of `points` is known, and the other one is not.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (1, 0), (0, 1)])
        >>> live.insert([(1, 1), (0, 0)])
        array([3, 4])
        >>> live.duplicates
        array([[4, 0]])
        """
        # The first points of all decide the reference system.
        system = self._system if self._live.counts()[3] else crs_of(points)
        array = own_points(points, self.ndim, system)
        warn_of_degrees(points, array, planar=self._planar)
        threads = 1 if len(array) <= FEW else as_workers(self._workers)
        found = self._edited(self._live.insert, array, threads)
        self._system = system
        return found

    @overload
    def remove(self, handles: ArrayLike, *, segments: Literal["raise"] = "raise") -> None: ...

    @overload
    def remove(self, handles: ArrayLike, *, segments: Literal["remove"]) -> Handles: ...

    def remove(self, handles: ArrayLike, *, segments: str = "raise") -> Handles | None:
        """Remove points.

        Parameters
        ----------
        handles : array_like of int, shape (k,)
            Their handles, each once.
        segments : {"raise", "remove"}, optional
            Whether removing an endpoint of segments raises an error, or also removes these
            segments.

        Returns
        -------
        ndarray of int64, shape (s,), or None
            With ``segments="remove"``, the handles of the removed segments, ascending; otherwise
            None.

        Raises
        ------
        HandleError
            A handle does not exist, occurs twice, is an endpoint of segments that are not to be
            removed, or is a crossing of segments; nothing has changed.
        DtypeError
            `handles` are not integers.
        InputError
            `segments` is not one of its choices.

        Notes
        -----
        Points and their segments are removed in one edit. As in `remove_segments`, its time depends
        on the size of the change: segments that crossed them are reinserted.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (1, 0), (0, 1), (1, 1)], [(0, 3)])
        >>> live.remove([0], segments="remove")
        array([0])
        >>> live.simplices
        array([[0, 2, 1]], dtype=int32)
        """
        own = as_handles(handles)
        also = as_choice(segments, ("raise", "remove"), name="segments") == "remove"
        core, threads = self._live, self._threads(own)
        try:
            if also and core.ndim == 2:
                return self._edited(core.remove_with_segments, own, threads)
            self._edited(core.remove, own, threads)
        except ShapeError:
            self._refuse(own)
            self._refuse_held(own, ends=not also)
            raise
        return np.empty(0, dtype=np.int64) if also else None

    def move(self, handles: ArrayLike, points: ArrayLike) -> None:
        """Move points and their segments, all in one edit.

        Parameters
        ----------
        handles : array_like of int, shape (k,)
            Their handles, each once.
        points : array_like, shape (k, d)
            The new positions, as for `insert`. Points that coincide with others become duplicates.

        Raises
        ------
        HandleError
            A handle does not exist, occurs twice, or is a crossing of segments; nothing has
            changed.
        CrossingSegmentsError
            Segments would cross, and `crossing` is ``"raise"``; nothing has changed.
        NonFiniteError, ShapeError, DtypeError
            As for the constructor, or the numbers of points and handles differ.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (1, 0), (0, 1), (1, 1)])
        >>> live.move([0, 3], [(1, 1), (0, 0)])
        >>> live.points[0]
        array([1., 1.])
        """
        own, places = as_handles(handles), own_points(points, self.ndim, self._system)
        try:
            self._edited(self._live.relocate, own, places, self._threads(own))
        except ShapeError:
            self._refuse(own)
            if len(own) == len(places):
                self._refuse_held(own)
            raise

    def _threads(self, items: Handles) -> int:
        return 1 if len(items) <= FEW else as_workers(self._workers)

    def _refuse(self, handles: Handles) -> None:
        gone, twice = self._live.faults(handles)
        refuse(gone, twice, "handle")

    # States.

    @contextmanager
    def edits(self) -> Iterator[Self]:
        """Make several edits as one.

        Yields
        ------
        Dynamic
            A draft: a separate triangulation in the current state. When the block ends, its edits
            are applied to this triangulation. If the block raises an exception, including Ctrl-C,
            nothing has changed.

        Raises
        ------
        EditConflictError
            This triangulation was edited outside the draft in the meantime; that edit is kept, and
            the draft is discarded.

        Notes
        -----
        Until the block ends, all other readers see the old state. The draft shares the memory of
        this triangulation except for its changes. Handles are assigned as in this triangulation;
        those of a discarded draft are assigned again.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (4, 0), (4, 3), (0, 3)])
        >>> with live.edits() as draft:
        ...     center, = draft.insert([(2, 1)])
        ...     draft.remove([0])
        >>> live.handles
        array([1, 2, 3, 4])
        """
        known, draft = self._draft()
        yield draft
        if draft._live.edits and not self._take(draft, known):
            raise EditConflictError(
                "the triangulation was edited outside the draft in the meantime: the draft is "
                "discarded, and its edits must be repeated"
            )

    def _draft(self) -> tuple[int, Self]:
        """Return a copy of the current state, and the number of edits that led to it."""
        while True:
            known = self._live.edits
            state = self._live.state()
            # Otherwise, another thread has completed an edit.
            if self._live.edits == known:
                return known, self._of(state.open(), *self._options)

    def _take(self, draft: Self, known: int) -> bool:
        """Adopt the state of a draft, unless there have been unknown edits."""
        taken: bool = self._edited(_restore, self._live, draft._live.state(), known)
        if taken:
            self._system = draft._system
        return taken

    def _saved(self) -> dict[str, NDArray[Any]]:
        return self._state().arrays()

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, max_handles: int | None = None) -> Self:
        """Read a file that `save` wrote: points, segments and their handles, without snapshots.

        Parameters
        ----------
        path : str or path-like
            The file.
        max_handles : int, optional
            The maximum number of handles of points, or of segments, ever assigned. By default
            10,000,000, or 64 for each point or segment if that is more.

        Returns
        -------
        Dynamic
            A triangulation in the same state, which assigns the same handles next. `workers` is
            None.

        Raises
        ------
        FileFormatError
            The file is truncated or of another class, its arrays contradict each other, or it has
            too many handles.
        OSError
            The file cannot be read, or is not a regular file.
        TypeError
            `path` is not a path. File objects are not accepted.

        Notes
        -----
        The points and segments are retriangulated. Snapshots can be pickled.

        Examples
        --------
        >>> import os, tempfile
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (1, 0), (0, 1), (1, 1)])
        >>> live.remove([0])
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "live.npz")
        ...     live.save(path)
        ...     Dynamic.load(path).handles
        array([1, 2, 3])
        """
        from delone._tiling import archive

        most = None if max_handles is None else as_limit(max_handles, name="max_handles")
        arrays = archive.read(path, Dynamic.__name__)
        state, system = State.from_arrays(arrays), arrays.get("crs")
        require_few_handles(path, state, most)
        try:
            core = state.opened(as_workers(None))
            return cls._of(core, None, system=None if system is None else str(system) or None)
        except InputError as error:
            raise archive.refusal(path, error) from error

    def snapshot(self) -> Snapshot:
        """Return the current state, to be restored later.

        Returns
        -------
        Snapshot
            The state. Any number of threads may use it.

        Notes
        -----
        Time and memory are proportional to the changes since the last snapshot; the first one
        copies everything.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (1, 0), (0, 1), (1, 1)])
        >>> full = live.snapshot()
        >>> live.remove([0, 1])
        >>> removed = live.snapshot()
        >>> live.restore(full)
        >>> len(live)
        4
        >>> live.restore(removed)
        >>> len(live)
        2
        """
        return Snapshot(self._live.state(), self._system)

    def restore(self, snapshot: Snapshot) -> None:
        """Return to a state.

        Parameters
        ----------
        snapshot : Snapshot
            A state of this triangulation, or of another one, whose points and handles replace those
            of this one.

        Raises
        ------
        DtypeError
            `snapshot` is not a `Snapshot`, or has a different number of coordinates.

        Notes
        -----
        Handles assigned since the snapshot no longer exist, and are not assigned again. Time is
        proportional to the changes in between.

        Examples
        --------
        See `snapshot`.
        """
        if not isinstance(snapshot, Snapshot):
            raise DtypeError(f"snapshot must be a Snapshot, got {type(snapshot).__name__}")
        self._edited(_restore, self._live, snapshot._state, None)
        self._system = snapshot._system

    def changes(self) -> Changes:
        """Return the simplices that were removed and added since the last call.

        Returns
        -------
        Changes
            Simplices as handles. In the first call, all are new.

        Notes
        -----
        Time is proportional to the changes, except in the first call.

        Examples
        --------
        >>> from delone import Dynamic
        >>> live = Dynamic([(0, 0), (4, 0), (0, 4), (9, 9)])
        >>> _ = live.changes()
        >>> live.remove([0])
        >>> live.changes().gone
        array([[0, 1, 2]])
        """
        gone, new = self._live.changes()
        return Changes(gone, new)

    def freeze(self) -> Delaunay | ConstrainedDelaunay:
        """Return the current triangulation as an immutable object.

        Returns
        -------
        Delaunay or ConstrainedDelaunay
            Equal to ``Delaunay(live.points)`` up to the order of the simplices, in linear time.
            With segments, a new `ConstrainedDelaunay` of the points and segments, whose rows are in
            the order of handles, with crossings at the end.

        Raises
        ------
        DegenerateInputError
            There is no simplex.

        Examples
        --------
        >>> from delone import Dynamic
        >>> bool(Dynamic([(0, 0), (1, 0), (0, 1)]).freeze().validate())
        True
        """
        made = self._arrays()
        if made.constrained is not None:
            return self._frozen_segments()._with_crs(self._system)
        return self._frozen(made)

    def _drawn(self) -> Delaunay | ConstrainedDelaunay:
        return self.freeze()

    def _frozen(self, made: _core.LiveArrays) -> Delaunay:
        """Return arrays without segments as a triangulation that never changes."""
        if not len(made.simplices):
            return Delaunay(made.points, workers=self._workers, planar=True)._refer(self)
        arrays: dict[str, NDArray[Any]] = {
            "points": made.points,
            "simplices": made.simplices,
            "neighbors": made.neighbors,
            "duplicates": made.duplicates,
        }
        return Delaunay._from_arrays(arrays, (), self._workers)._refer(self)

    def validate(self) -> ValidationReport:
        """Prove that this is the canonical Delaunay triangulation, or list the faults.

        Returns
        -------
        ValidationReport
            The report on the current arrays: a `ValidationReport`, in 3-D a `SpaceReport`, and with
            segments a `DynamicReport`, which also compares the edges of segments and the crossings
            with those of a new `ConstrainedDelaunay`.

        Raises
        ------
        DegenerateInputError
            There is no simplex to validate.

        Examples
        --------
        >>> from delone import Dynamic
        >>> print(Dynamic([(0, 0), (1, 0), (0, 1)]).validate())
        a canonical Delaunay triangulation
        """
        made = self._arrays()
        if made.constrained is not None:
            return self._validated_segments()
        return self._frozen(made).validate()


def _restore(core: _core.Live, state: _core.LiveState, known: int | None) -> bool:
    """Restore a state of the same dimension, unless there are unknown edits."""
    own, other = core.ndim, state.ndim
    if own != other:
        raise DtypeError(f"a {other}-D snapshot cannot be restored to a {own}-D triangulation")
    return core.restore(state, known)
