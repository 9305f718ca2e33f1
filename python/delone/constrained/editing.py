"""Changes to a constrained triangulation, collected in a block and applied together at its end.

A triangulation is immutable and canonical, so a changed copy is the triangulation of the changed
input. With a live triangulation behind the result, the cost would still not be proportional to the
size of the edit, because the new object needs its own arrays. With 200,000 points and 40,000
segments, in units of the time of a new triangulation, building the live one takes 1.5, inserting a
point into it 0.0003, and extracting its simplices and neighbors 0.3, in a different order from
those of a new one, and without the rows of segments along each edge. So a single edit would take
nearly twice as long, and only chains of three or more would benefit. For these, there are blocks
with many changes, and `Dynamic`.
"""

from __future__ import annotations

import operator
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Self, TypeVar

import numpy as np

from delone._base.arrays import (
    as_points,
    as_segments,
    require_finite,
    require_integers,
    wrong_shape,
)
from delone._base.counting import agreed, counted
from delone._base.duplicates import first_rows
from delone._tiling.plane.topology import among, edge_keys
from delone.constrained.segmented import Origin, Segmented
from delone.errors import DeloneError, DtypeError, InputError

if TYPE_CHECKING:
    from types import TracebackType

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["EditRows", "Editing"]

M = TypeVar("M", bound=Segmented)


class EditRows(NamedTuple):
    """The new rows of all points and segments after an edit.

    Parameters
    ----------
    points : ndarray of int32, shape (n,)
        For each row of points in the edit, its row in the result; -1 for removed points, and for
        vertices that the triangulation added.
    segments : ndarray of int32, shape (s,)
        For each row of segments in the edit, its row in `input_segments` of the result; -1 for
        removed segments.
    """

    points: Indices
    segments: Indices


class Editing(Generic[M]):
    """Changes to a `ConstrainedDelaunay`: the context manager that ``edit()`` returns.

    Parameters
    ----------
    mesh : ConstrainedDelaunay
        The triangulation to start from. It does not change.

    Raises
    ------
    DeloneError
        At the end of the block, any error of the constructor of `ConstrainedDelaunay`, and
        `InputError` if a point is removed that a segment still uses.

    Notes
    -----
    Rows of points are those of the mesh; inserted points follow, from ``mesh.npoints`` on. Rows of
    segments are those of ``mesh.input_segments``; inserted segments follow. Row numbers do not
    change within the block: all changes are applied together at its end, and their order does not
    matter. `rows` maps old rows to new ones.

    The result is the same as that of `ConstrainedDelaunay` for the changed points and segments,
    with the options and seeds of the mesh, so removing exactly undoes inserting. The triangulation
    is recomputed, in O(n log n): a new immutable object has to copy all arrays anyway. Many changes
    in one block cost as much as one.

    Vertices that the mesh added at crossings are not input. They cannot be removed; they disappear
    with their crossings.

    Examples
    --------
    >>> from delone import ConstrainedDelaunay
    >>> mesh = ConstrainedDelaunay([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2)])
    >>> with mesh.edit() as edit:
    ...     center, = edit.insert_points([(2, 1)])
    ...     edit.insert_segment(1, center)
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
        self._removed_points: list[NDArray[np.int64]] = []
        self._removed_segments: list[NDArray[np.int64]] = []
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
            raise DeloneError("there is no result: the edit has not ended, or ended with an error")
        return self._result

    @property
    def rows(self) -> EditRows:
        """The new rows of all points and segments, once the block has ended."""
        if self._rows is None:
            raise DeloneError("there are no rows: the edit has not ended, or ended with an error")
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
            Their rows in this edit.

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
        """Remove points.

        Parameters
        ----------
        rows : array_like of int, shape (k,)
            Rows of points. If another row with the same coordinates remains, so does the vertex.

        Raises
        ------
        InputError
            A row is out of range, or is a vertex that was added at a crossing.
        ShapeError, DtypeError
            `rows` is not an integer array with one axis.

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
        removed = _rows(rows, self._npoints, "points")
        self._require_input(removed)
        self._removed_points.append(removed)

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
            Their rows in this edit.

        Raises
        ------
        InputError
            A row is out of range, or is a vertex that was added at a crossing.
        ShapeError, DtypeError
            `segments` is not an integer array of shape (k, 2).

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
        """Remove one segment.

        Parameters
        ----------
        row : int
            The row of the segment; or, with `end`, the row of its first point.
        end : int, optional
            The row of its last point. Every segment that joins the two vertices is removed, in
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
        """Remove segments.

        Parameters
        ----------
        segments : array_like of int, shape (k,) or (k, 2)
            Rows of segments; or pairs of rows of points: then every segment that joins the two
            vertices is removed, in either direction.

        Raises
        ------
        InputError
            A row is out of range, or no segment joins the two vertices.
        ShapeError, DtypeError
            `segments` is not an integer array of shape (k,) or (k, 2).

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
            removed = self._joining(as_segments(segments, self._npoints))
        else:
            removed = _rows(segments, self._nsegments, "segments")
        self._removed_segments.append(removed)

    def _require_open(self) -> None:
        if self._ended:
            raise DeloneError("this edit has ended: start a new one")

    def _require_input(self, rows: NDArray[np.integer]) -> None:
        added = (rows >= self._ninput) & (rows < self._mesh.npoints)
        if added.any():
            first = ", ".join(map(str, np.unique(rows[added])[:10].tolist()))
            raise InputError(
                f"points {first} were added at crossings; insert points with their coordinates to "
                "make them part of the input"
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
        keeps_point = _all_but(len(points), self._removed_points)
        keeps_point[self._ninput : self._mesh.npoints] = False
        keeps_segment = _all_but(len(segments), self._removed_segments)
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
        old = self._mesh._given
        new = Origin.of_arrays(count - len(old.segments))
        return Origin._make(map(np.concatenate, zip(old.origin, new, strict=True)))

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
                f"{agreed(len(lost), 'it as well: row', 'them as well: rows')} {shown}"
            )


def _row(row: int) -> int:
    if not isinstance(row, bool | np.bool_):
        with suppress(TypeError):
            return operator.index(row)
    raise DtypeError(f"a row must be an integer, got {row!r:.80}")


def _rows(rows: ArrayLike, count: int, name: str) -> NDArray[np.int64]:
    array = np.asarray(rows)
    if array.ndim > 1:
        raise wrong_shape(f"rows of {name}", "(k,)", array)
    if array.size == 0:
        return np.empty(0, dtype=np.int64)
    require_integers(array, f"rows of {name}")
    wrong = (array < 0) | (array >= count)
    if wrong.any():
        first = ", ".join(map(str, array[wrong][:10].tolist()))
        raise InputError(f"rows of {name} must be from 0 to {count - 1}, got {first}")
    return np.atleast_1d(array).astype(np.int64)


def _all_but(count: int, removed: list[NDArray[np.int64]]) -> NDArray[np.bool_]:
    keeps = np.ones(count, dtype=bool)
    for rows in removed:
        keeps[rows] = False
    return keeps


def _numbers(keeps: NDArray[np.bool_]) -> Indices:
    return np.where(keeps, np.cumsum(keeps) - 1, -1).astype(np.int32)
