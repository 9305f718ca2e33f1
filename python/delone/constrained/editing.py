"""Changes to a constrained triangulation: collected in a block, applied together at its end.

A triangulation is immutable and canonical, so a changed one is the triangulation of the changed
input. To change the triangles in place would not pay: the new object needs arrays of its own, and
to copy them costs time in proportion to the whole, as triangulating does.
"""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Self, TypeVar

import numpy as np

from delone._arrays import as_points, as_segments, require_finite
from delone.constrained.segmented import Origin, Segmented
from delone.counting import agreed, counted
from delone.duplicates import first_rows
from delone.errors import DeloneError, DtypeError, InputError, ShapeError
from delone.plane.topology import among, edge_keys

if TYPE_CHECKING:
    from types import TracebackType

    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["EditRows", "Editing"]

M = TypeVar("M", bound=Segmented)


class EditRows(NamedTuple):
    """Where the rows of an edit went.

    Parameters
    ----------
    points : ndarray of int32, shape (n,)
        For each row of points that the edit knew its row in the result; -1 where it was removed,
        and for vertices that the triangulation had added.
    segments : ndarray of int32, shape (s,)
        For each row of segments that the edit knew its row among the result's `input_segments`; -1
        where it was removed.
    """

    points: Indices
    segments: Indices


class Editing(Generic[M]):
    """Changes to a `ConstrainedDelaunay`, which `edit` makes; used by ``with``.

    Parameters
    ----------
    mesh : ConstrainedDelaunay
        What to start from. It stays as it is.

    Raises
    ------
    DeloneError
        At the end of the block, whatever the constructor of `ConstrainedDelaunay` raises, and
        `InputError` where a point is removed that a segment still uses.

    Notes
    -----
    Rows of points are those of the mesh; inserted ones follow behind ``mesh.npoints``. Rows of
    segments are those of ``mesh.input_segments``; inserted ones follow. Numbers do not change
    within the block: all changes are applied together at its end, and in what order they came does
    not matter. `rows` tells where everything went.

    The result is the same as that of `ConstrainedDelaunay` for the changed points and segments,
    with the options and seeds of the mesh; so removing takes back what inserting did. It is
    triangulated anew, in O(n log n): a new immutable object has to copy all arrays anyway. Many
    changes in one block cost as much as one.

    Vertices that the mesh added where segments cross are no input. They cannot be removed, they go
    with their crossings.

    Examples
    --------
    >>> from delone import ConstrainedDelaunay
    >>> mesh = ConstrainedDelaunay([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2)])
    >>> with mesh.edit() as edit:
    ...     centre, = edit.insert_points([(2, 1)])
    ...     edit.insert_segment(1, centre)
    ...     edit.remove_segment(0)
    >>> edit.result
    <ConstrainedDelaunay of 5 points and 1 segment: 4 triangles>
    >>> edit.rows.segments.tolist()
    [-1, 0]
    """

    def __init__(self, mesh: M) -> None:
        self._mesh = mesh
        self._ninput = mesh.npoints - mesh.nadded
        self._points: list[Floats] = [mesh.points]
        self._segments: list[Indices] = [mesh.input_segments]
        self._npoints = mesh.npoints
        self._nsegments = len(mesh.input_segments)
        self._gone_points: list[NDArray[np.int64]] = []
        self._gone_segments: list[NDArray[np.int64]] = []
        self._result: M | None = None
        self._rows: EditRows | None = None
        self._ended = False

    def __enter__(self) -> Self:
        self._require_open()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._require_open()
        self._ended = True
        if kind is None:
            self._apply()

    @property
    def result(self) -> M:
        """The new triangulation, once the block has ended."""
        if self._result is None:
            raise DeloneError("there is no result: the edit has not ended, or ended by an error")
        return self._result

    @property
    def rows(self) -> EditRows:
        """Where all rows of points and segments went, once the block has ended."""
        if self._rows is None:
            raise DeloneError("there are no rows: the edit has not ended, or ended by an error")
        return self._rows

    def insert_points(self, points: ArrayLike) -> NDArray[np.int64]:
        """Add points.

        Parameters
        ----------
        points : array_like, shape (k, 2)
            Finite coordinates.

        Returns
        -------
        ndarray of int64, shape (k,)
            The rows by which this edit knows them.

        Raises
        ------
        NonFiniteError, ShapeError, DtypeError
            As for `ConstrainedDelaunay`.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> mesh = ConstrainedDelaunay([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2)])
        >>> with mesh.edit() as edit:
        ...     print(edit.insert_points([(2, 1), (1, 2)]))
        [4 5]
        """
        self._require_open()
        new = as_points(points, ndim=2).copy()
        require_finite(new)
        self._points.append(new)
        self._npoints += len(new)
        return np.arange(self._npoints - len(new), self._npoints)

    def remove_points(self, rows: ArrayLike) -> None:
        """Take points away.

        Parameters
        ----------
        rows : array_like of int, shape (k,)
            Rows of points. A row that stays and has the same coordinates keeps the vertex.

        Raises
        ------
        InputError
            A row is out of range, or a vertex that was added where segments cross.
        ShapeError, DtypeError
            `rows` are no integers in one row.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> mesh = ConstrainedDelaunay([(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)], [(0, 2)])
        >>> with mesh.edit() as edit:
        ...     edit.remove_points([4])
        >>> edit.result.npoints, edit.rows.points.tolist()
        (4, [0, 1, 2, 3, -1])
        """
        self._require_open()
        gone = _rows(rows, self._npoints, "points")
        self._require_input(gone)
        self._gone_points.append(gone)

    def insert_segment(self, a: int, b: int) -> None:
        """Add one segment.

        Parameters
        ----------
        a, b : int
            Rows of points.

        Raises
        ------
        InputError, DtypeError
            As for `insert_segments`.

        Examples
        --------
        See `Editing`.
        """
        self.insert_segments([(_row(a), _row(b))])

    def insert_segments(self, segments: ArrayLike) -> NDArray[np.int64]:
        """Add segments.

        Parameters
        ----------
        segments : array_like of int, shape (k, 2)
            Pairs of rows of points.

        Returns
        -------
        ndarray of int64, shape (k,)
            The rows by which this edit knows them.

        Raises
        ------
        InputError
            A row is out of range, or a vertex that was added where segments cross.
        ShapeError, DtypeError
            `segments` are no pairs of integers.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> mesh = ConstrainedDelaunay([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2)])
        >>> with mesh.edit() as edit:
        ...     print(edit.insert_segments([(0, 1), (1, 2)]))
        [1 2]
        """
        self._require_open()
        new = as_segments(segments, self._npoints).copy()
        self._require_input(new)
        self._segments.append(new)
        self._nsegments += len(new)
        return np.arange(self._nsegments - len(new), self._nsegments)

    def remove_segment(self, row: int, end: int | None = None) -> None:
        """Take one segment away.

        Parameters
        ----------
        row : int
            The row of the segment; or, with `end`, the row of the point where it begins.
        end : int, optional
            The row of the point where it ends. Every segment that joins the two vertices goes, in
            either direction.

        Raises
        ------
        InputError, DtypeError
            As for `remove_segments`.

        Examples
        --------
        See `Editing` and `ConstrainedDelaunay.edit`.
        """
        first = _row(row)
        self.remove_segments([first] if end is None else [(first, _row(end))])

    def remove_segments(self, segments: ArrayLike) -> None:
        """Take segments away.

        Parameters
        ----------
        segments : array_like of int, shape (k,) or (k, 2)
            Rows of segments; or pairs of rows of points: then every segment that joins the two
            vertices goes, in either direction.

        Raises
        ------
        InputError
            A row is out of range, or no segment joins the two vertices.
        ShapeError, DtypeError
            `segments` are no integers in one or two columns.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> mesh = ConstrainedDelaunay([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2), (0, 1)])
        >>> with mesh.edit() as edit:
        ...     edit.remove_segments([(2, 0)])
        >>> edit.result.segments.tolist()
        [[0, 1]]
        """
        self._require_open()
        if np.ndim(segments) == 2:
            gone = self._joining(as_segments(segments, self._npoints))
        else:
            gone = _rows(segments, self._nsegments, "segments")
        self._gone_segments.append(gone)

    def _require_open(self) -> None:
        if self._ended:
            raise DeloneError("this edit has ended: begin another one")

    def _require_input(self, rows: NDArray[np.integer]) -> None:
        added = (rows >= self._ninput) & (rows < self._mesh.npoints)
        if added.any():
            first = ", ".join(map(str, np.unique(rows[added])[:10].tolist()))
            raise InputError(
                f"points {first} were added where segments cross; insert a point with their "
                "coordinates to have it as input"
            )

    def _joining(self, ends: Indices) -> NDArray[np.int64]:
        """Return the rows of segments that join pairs of vertices."""
        vertex = first_rows(np.concatenate(self._points))
        present = vertex[np.concatenate(self._segments)]
        keys = edge_keys(present[:, 0], present[:, 1], self._npoints)
        wanted = edge_keys(vertex[ends[:, 0]], vertex[ends[:, 1]], self._npoints)
        absent = ~among(wanted, keys)
        if absent.any():
            first = ", ".join("{}-{}".format(*pair) for pair in ends[absent][:10].tolist())
            raise InputError(f"no segment joins the points {first}")
        return np.flatnonzero(among(keys, wanted))

    def _apply(self) -> None:
        points, segments = np.concatenate(self._points), np.concatenate(self._segments)
        keeps_point = _all_but(len(points), self._gone_points)
        keeps_point[self._ninput : self._mesh.npoints] = False
        keeps_segment = _all_but(len(segments), self._gone_segments)
        self._require_ends(segments, keeps_point, keeps_segment)
        rows = EditRows(_numbers(keeps_point), _numbers(keeps_segment))
        origin = self._origins(len(segments))
        self._result = type(self._mesh)._of_geometries(
            points[keeps_point],
            rows.points[segments[keeps_segment]],
            Origin._make(values[keeps_segment] for values in origin),
            **self._mesh._arguments(),
        )
        self._rows = rows

    def _origins(self, count: int) -> Origin:
        """Return the origin of each segment; new ones have none."""
        origin, old = Origin.of_arrays(count), self._mesh._given
        for values, known in zip(origin, old.origin, strict=True):
            values[: len(old.segments)] = known
        return origin

    def _require_ends(
        self, segments: Indices, keeps_point: NDArray[Any], keeps_segment: NDArray[Any]
    ) -> None:
        lost = np.flatnonzero(keeps_segment & ~keeps_point[segments].all(axis=1))
        if lost.size:
            shown = ", ".join(
                f"{row} ({segments[row, 0]}-{segments[row, 1]})" for row in lost[:10].tolist()
            )
            raise InputError(
                f"{counted(len(lost), 'segment')} would lose an end; remove "
                f"{agreed(len(lost), 'it, too: row', 'them, too: rows')} {shown}"
            )


def _row(row: int) -> int:
    if isinstance(row, bool | np.bool_):
        raise DtypeError(f"a row must be an integer, got {row}")
    try:
        return operator.index(row)
    except TypeError:
        raise DtypeError(f"a row must be an integer, got {row!r}") from None


def _rows(rows: ArrayLike, count: int, name: str) -> NDArray[np.int64]:
    array = np.asarray(rows)
    if array.ndim > 1:
        raise ShapeError(f"rows of {name} must have shape (k,), got {array.shape}")
    if array.size == 0:
        return np.empty(0, dtype=np.int64)
    if array.dtype.kind not in "iu":
        raise DtypeError(f"rows of {name} must be integers, got dtype {array.dtype}")
    wrong = (array < 0) | (array >= count)
    if wrong.any():
        first = ", ".join(map(str, array[wrong][:10].tolist()))
        raise InputError(f"rows of {name} leave the range 0 to {count - 1}: {first}")
    return np.atleast_1d(array).astype(np.int64)


def _all_but(count: int, gone: list[NDArray[np.int64]]) -> NDArray[np.bool_]:
    keeps = np.ones(count, dtype=bool)
    for rows in gone:
        keeps[rows] = False
    return keeps


def _numbers(keeps: NDArray[np.bool_]) -> Indices:
    return np.where(keeps, np.cumsum(keeps) - 1, -1).astype(np.int32)
