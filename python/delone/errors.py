"""All exceptions that delone raises deliberately.

All derive from `DeloneError`, so that one ``except`` clause catches everything that the package
raises. Each class also derives from the built-in exception that users of NumPy or SciPy expect, and
provides the evidence (rows, reason, chain, extra) as attributes, because a program cannot use a
message. All of them can be pickled, so they cross process boundaries.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

__all__ = [
    "BudgetExceededError",
    "BusyError",
    "ConflictingValuesError",
    "CrossingFacesError",
    "CrossingSegmentsError",
    "CrowdedFacesError",
    "DanglingFacesError",
    "DegenerateInputError",
    "DeloneError",
    "DirectionError",
    "DtypeError",
    "EditConflictError",
    "FileFormatError",
    "HandleError",
    "InputError",
    "InternalError",
    "LimitError",
    "MissingExtraError",
    "NonFiniteError",
    "OpenSurfaceError",
    "OutputError",
    "OutsideError",
    "ShapeError",
]


def _row_numbers(rows: Iterable[int] | NDArray[np.integer]) -> NDArray[np.int64]:
    array = np.array(rows if isinstance(rows, np.ndarray) else list(rows), dtype=np.int64)
    array.flags.writeable = False
    return array


class DeloneError(Exception):
    """Base class of all exceptions that delone raises deliberately.

    Examples
    --------
    >>> import delone
    >>> try:
    ...     delone.Delaunay([(0, 0), (1, 1)])
    ... except delone.DeloneError as error:
    ...     print(error)
    2 distinct points are too few for a triangle: at least three that are not collinear are needed
    """

    def __setstate__(self, state: dict[str, Any] | None) -> None:
        super().__setstate__(state)
        # NumPy does not pickle the writeable flag of arrays.
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False


class InputError(DeloneError, ValueError):
    """An argument has an invalid value; also a ValueError.

    Examples
    --------
    >>> import delone
    >>> try:
    ...     delone.Delaunay([(0, 0), (1, 0), (0, 1)], method="magic")
    ... except ValueError as error:
    ...     print(str(error)[:27])
    method must be one of 'auto
    """


class ShapeError(InputError):
    """An array has the wrong number of axes, or an axis has the wrong length.

    Examples
    --------
    >>> import delone
    >>> try:
    ...     delone.Delaunay([0, 1, 2])
    ... except delone.ShapeError as error:
    ...     print(error)
    points must have shape (n, d) with d from 2 to 8, got (3,)
    """


class DtypeError(InputError, TypeError):
    """An array or argument cannot be converted exactly to float64 (or to indices).

    Also a TypeError.

    Examples
    --------
    >>> import delone
    >>> try:
    ...     delone.Delaunay([(0, 0), (2**53 + 1, 0), (0, 1)])
    ... except TypeError as error:
    ...     print(type(error).__name__)
    DtypeError
    """


class NonFiniteError(InputError):
    """Some coordinates are NaN or infinite.

    Parameters
    ----------
    message : str
        The message.
    rows : iterable of int, optional
        Row numbers of the first bad points, at most ten.
    count : int, optional
        Total number of bad rows. By default the length of `rows`.

    Attributes
    ----------
    rows : ndarray of int64
        Row numbers of the first bad points.
    count : int
        Total number of bad rows.

    Examples
    --------
    >>> import delone
    >>> try:
    ...     delone.Delaunay([(0, 0), (1, float("nan")), (1, 1), (0, 1)])
    ... except delone.NonFiniteError as error:
    ...     print(error.count, error.rows)
    1 [1]
    """

    rows: NDArray[np.int64]
    count: int

    def __init__(
        self,
        message: str = "points contain NaN or infinity",
        *,
        rows: Iterable[int] | NDArray[np.integer] = (),
        count: int | None = None,
    ) -> None:
        super().__init__(message)
        self.rows = _row_numbers(rows)[:10]
        self.count = len(self.rows) if count is None else int(count)


class DegenerateInputError(InputError):
    """The points span no area or volume: too few are distinct, or all are on a line or plane.

    Parameters
    ----------
    message : str
        The message.
    reason : str, optional
        ``"too few points"``, ``"collinear"``, in 3-D ``"coplanar"``, and on the sphere
        ``"one great circle"``.
    chain : iterable of int, optional
        Row numbers of the distinct points, in their order along the line.
    plane : PlaneTriangulation, optional
        The 2-D triangulation of coplanar points.

    Attributes
    ----------
    reason : str
        ``"too few points"``, ``"collinear"``, ``"coplanar"`` or ``"one great circle"``; empty if
        unknown.
    chain : ndarray of int64
        Row numbers of the distinct points, in their order along the line or around the circle; in
        lexicographic order if they are on neither.
    plane : PlaneTriangulation or None
        For 3-D points that lie in one plane but not on one line, at least three of them, the
        Delaunay triangulation in that plane; with weights, the regular triangulation.

    Examples
    --------
    >>> import delone
    >>> try:
    ...     delone.Delaunay([(2, 2), (0, 0), (1, 1)])
    ... except delone.DegenerateInputError as error:
    ...     print(error.reason, error.chain)
    collinear [1 2 0]
    """

    reason: str
    chain: NDArray[np.int64]
    plane: Any

    def __init__(
        self,
        message: str = "the points span no area",
        *,
        reason: str = "",
        chain: Iterable[int] | NDArray[np.integer] = (),
        plane: Any = None,
    ) -> None:
        super().__init__(message)
        self.reason = reason
        self.chain = _row_numbers(chain)
        self.plane = plane


class DirectionError(InputError):
    """Rows are not directions: zero vectors, latitudes beyond a pole, longitudes of many turns.

    Parameters
    ----------
    message : str
        The message.
    rows : iterable of int, optional
        Row numbers of the first such rows, at most ten.
    count : int, optional
        Total number of such rows. By default the length of `rows`.

    Attributes
    ----------
    rows : ndarray of int64
        Row numbers of the first such rows.
    count : int
        Total number of such rows.

    Examples
    --------
    >>> import delone
    >>> from delone import sphere
    >>> try:
    ...     sphere.Delaunay(lonlat=[(0, 0), (10, 95), (20, 0)])
    ... except delone.DirectionError as error:
    ...     print(error.count, error.rows)
    1 [1]
    """

    rows: NDArray[np.int64]
    count: int

    def __init__(
        self,
        message: str = "some rows are not directions",
        *,
        rows: Iterable[int] | NDArray[np.integer] = (),
        count: int | None = None,
    ) -> None:
        super().__init__(message)
        self.rows = _row_numbers(rows)[:10]
        self.count = len(self.rows) if count is None else int(count)


class CrossingSegmentsError(InputError):
    """Segments cross, and crossings are not allowed.

    Parameters
    ----------
    message : str
        The message.
    pairs : array_like of int, shape (c, 2), optional
        Rows of the crossing segments.
    points : array_like of float, shape (c, 2), optional
        The crossing points.

    Attributes
    ----------
    pairs : ndarray of int64, shape (c, 2)
        Rows of the crossing segments, each pair once.
    points : ndarray of float64, shape (c, 2)
        The crossing points, each coordinate rounded once.

    Examples
    --------
    >>> import delone
    >>> corners = [(0, 0), (3, 0), (3, 1), (0, 1)]
    >>> try:
    ...     delone.ConstrainedDelaunay(corners, [(0, 2), (1, 3)])
    ... except delone.CrossingSegmentsError as error:
    ...     print(error.pairs, error.points)
    [[0 1]] [[1.5 0.5]]
    """

    pairs: NDArray[np.int64]
    points: NDArray[np.float64]

    def __init__(
        self,
        message: str = "segments cross",
        *,
        pairs: ArrayLike = (),
        points: ArrayLike = (),
    ) -> None:
        super().__init__(message)
        self.pairs = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        self.points = np.array(points, dtype=np.float64).reshape(-1, 2)
        self.pairs.flags.writeable = False
        self.points.flags.writeable = False


class CrossingFacesError(InputError):
    """Faces of a surface cross, or overlap so that no subdivision at vertices separates them.

    Parameters
    ----------
    message : str
        The message.
    pairs : array_like of int, shape (c, 2), optional
        Rows of the crossing faces.
    kinds : array_like of str, shape (c,), optional
        How the faces of each pair cross.
    count : int, optional
        The number of all such pairs. By default the length of `pairs`.

    Attributes
    ----------
    pairs : ndarray of int64, shape (c, 2)
        Rows of the crossing faces, each pair once.
    kinds : ndarray of str, shape (c,)
        ``"crossing"``, ``"edge on edge"``, ``"coplanar overlap"`` or ``"folded"``.
    count : int
        The number of all such pairs; `pairs` contains the first ones.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, -1), (1, 1, 1), (9, 9, 0)]
    >>> try:
    ...     delone.check_surface(points, [(0, 1, 2), (3, 4, 5)]).raise_if_bad()
    ... except delone.CrossingFacesError as error:
    ...     print(error.pairs, error.kinds)
    [[0 1]] ['crossing']
    """

    pairs: NDArray[np.int64]
    kinds: NDArray[np.str_]
    count: int

    def __init__(
        self,
        message: str = "faces cross",
        *,
        pairs: ArrayLike = (),
        kinds: ArrayLike = (),
        count: int | None = None,
    ) -> None:
        super().__init__(message)
        self.pairs = np.array(pairs, dtype=np.int64).reshape(-1, 2)
        self.kinds = np.array(kinds, dtype=np.str_).reshape(-1)
        self.count = len(self.pairs) if count is None else int(count)
        self.pairs.flags.writeable = False
        self.kinds.flags.writeable = False


class OpenSurfaceError(InputError):
    """A surface encloses nothing, because it has a boundary.

    Parameters
    ----------
    message : str
        The message.
    edges : array_like of int, shape (k, 2), optional
        Rows of the ends of the boundary edges.

    Attributes
    ----------
    edges : ndarray of int64, shape (k, 2)
        Rows of the ends of the boundary edges.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> try:
    ...     delone.check_surface(points, [(0, 2, 1), (0, 1, 3), (1, 2, 3)]).raise_if_bad()
    ... except delone.OpenSurfaceError as error:
    ...     print(error.edges.tolist())
    [[0, 2], [0, 3], [2, 3]]
    """

    edges: NDArray[np.int64]

    def __init__(
        self, message: str = "the surface has a boundary", *, edges: ArrayLike = ()
    ) -> None:
        super().__init__(message)
        self.edges = np.array(edges, dtype=np.int64).reshape(-1, 2)
        self.edges.flags.writeable = False


class CrowdedFacesError(InputError):
    """Faces of a surface are so close that no double lies between them where a point is needed.

    Parameters
    ----------
    message : str
        The message.
    faces : array_like of int, shape (k,), optional
        Rows of these faces.

    Attributes
    ----------
    faces : ndarray of int64, shape (k,)
        Rows of these faces.

    Examples
    --------
    >>> from delone import CrowdedFacesError
    >>> CrowdedFacesError(faces=[3, 5]).faces.tolist()
    [3, 5]
    """

    faces: NDArray[np.int64]

    def __init__(self, message: str = "no room between faces", *, faces: ArrayLike = ()) -> None:
        super().__init__(message)
        self.faces = np.array(faces, dtype=np.int64).reshape(-1)
        self.faces.flags.writeable = False


class DanglingFacesError(InputError):
    """Beside faces that end inside a solid, there is no double for a point that they need.

    Parameters
    ----------
    message : str
        The message.
    faces : array_like of int, shape (k,), optional
        Rows of faces with an edge that is not part of any other face.

    Attributes
    ----------
    faces : ndarray of int64, shape (k,)
        Rows of these faces.

    Examples
    --------
    >>> from delone import DanglingFacesError
    >>> DanglingFacesError(faces=[3, 5]).faces.tolist()
    [3, 5]
    """

    faces: NDArray[np.int64]

    def __init__(self, message: str = "faces end inside", *, faces: ArrayLike = ()) -> None:
        super().__init__(message)
        self.faces = np.array(faces, dtype=np.int64).reshape(-1)
        self.faces.flags.writeable = False


class ConflictingValuesError(InputError):
    """Points that coincide have different values, and no policy selects one.

    Parameters
    ----------
    message : str
        The message.
    rows : array_like of int, shape (k, 2), optional
        Rows of points, each with the first row of the same coordinates.

    Attributes
    ----------
    rows : ndarray of int64, shape (k, 2)
        Two rows of points at each place, the later one first; rows of lines follow those of points.

    Examples
    --------
    >>> import delone
    >>> try:
    ...     delone.interpolate.Linear([(0, 0), (1, 0), (0, 1), (1, 0)], [1.0, 2.0, 3.0, 2.5])
    ... except delone.ConflictingValuesError as error:
    ...     print(error.rows)
    [[3 1]]
    """

    rows: NDArray[np.int64]

    def __init__(
        self, message: str = "points have several values", *, rows: ArrayLike = ()
    ) -> None:
        super().__init__(message)
        self.rows = np.array(rows, dtype=np.int64).reshape(-1, 2)
        self.rows.flags.writeable = False


class OutsideError(InputError):
    """A polygon, or a side slope, leaves the surface of a TIN.

    Parameters
    ----------
    message : str
        The message.
    place : tuple of float, optional
        A position where it does.

    Attributes
    ----------
    place : tuple of float, or None
        A position where it does.

    Examples
    --------
    >>> import delone
    >>> from delone.terrain import TIN
    >>> ground = TIN.from_points([(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0)])
    >>> try:
    ...     ground.flatten([(1, 1), (12, 1), (1, 8)], 1.0)
    ... except delone.OutsideError as error:
    ...     print(error.place)
    (12.0, 1.0)
    """

    place: tuple[float, float] | None

    def __init__(
        self,
        message: str = "outside the surface",
        *,
        place: tuple[float, float] | None = None,
    ) -> None:
        super().__init__(message)
        self.place = None if place is None else (float(place[0]), float(place[1]))


class BudgetExceededError(DeloneError, RuntimeError):
    """The result needs more vertices than the limit given, or than the default limit.

    Parameters
    ----------
    message : str
        The message.
    limit : int, optional
        The limit on added vertices.
    found : int, optional
        The number found when the computation stopped; there may be more.
    segments : iterable of int, optional
        The rows of up to five segments that need the most vertices, in descending order.
    place : tuple of float, optional
        Location: the point where the first two of these segments meet, or else where the last
        vertex would have been added.

    Attributes
    ----------
    limit : int
        The limit on added vertices.
    found : int
        The number found when the computation stopped; there may be more.
    segments : tuple of int
        The rows of up to five segments that need the most vertices; empty if unknown.
    place : tuple of float, or None
        Location: the point where the first two of these segments meet, or else where the last
        vertex would have been added.

    Examples
    --------
    >>> import delone
    >>> square = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1)]]}
    >>> try:
    ...     delone.mesh(square, max_area=0.001, max_points=10)
    ... except delone.BudgetExceededError as error:
    ...     print(error.limit, error.found > error.limit)
    10 True
    """

    limit: int
    found: int
    segments: tuple[int, ...]
    place: tuple[float, float] | None

    def __init__(
        self,
        message: str = "too many vertices to add",
        *,
        limit: int = 0,
        found: int = 0,
        segments: Iterable[int] = (),
        place: tuple[float, float] | None = None,
    ) -> None:
        super().__init__(message)
        self.limit = int(limit)
        self.found = int(found)
        self.segments = tuple(map(int, segments))
        self.place = place


class BusyError(DeloneError, RuntimeError):
    """Another process is writing there: `delone.distributed` allows one run per folder.

    Parameters
    ----------
    message : str
        The message.
    pid : int, optional
        The process id, 0 if unknown.
    host : str, optional
        The name of the machine.

    Attributes
    ----------
    pid : int
        The process id, 0 if unknown.
    host : str
        The name of the machine.

    Examples
    --------
    >>> from delone import BusyError
    >>> BusyError(pid=4711, host="survey").pid
    4711
    """

    pid: int
    host: str

    def __init__(
        self, message: str = "another process is writing there", *, pid: int = 0, host: str = ""
    ) -> None:
        super().__init__(message)
        self.pid = int(pid)
        self.host = str(host)


class LimitError(InputError):
    """The input is too large for an index or a buffer of this build.

    Examples
    --------
    >>> import delone
    >>> try:
    ...     delone.Voronoi([(1e308, 0), (1.1e308, 1)], periods=(1e308, None))
    ... except delone.LimitError as error:
    ...     print(error)
    the next copy of a site lies beyond the range of doubles
    """


class InternalError(DeloneError, RuntimeError):
    """An internal check failed: this is a bug in delone, not an error of the caller.

    The message ends with a request to report it.

    Parameters
    ----------
    message : str
        Description of the failure.

    Attributes
    ----------
    points : ndarray of float64 or None
        The points that caused it, to include in a report: ``np.save("report.npy", e.points)``.

    Examples
    --------
    >>> from delone import InternalError
    >>> print(InternalError("a walk did not end"))
    a walk did not end. This is a bug in delone; please report it together with the input.
    """

    points: NDArray[np.float64] | None = None
    REQUEST = "This is a bug in delone; please report it together with the input."

    def __init__(self, message: str = "an internal check failed") -> None:
        # Unpickling calls the constructor with the complete text, which must not grow again.
        super().__init__(message if self.REQUEST in message else f"{message}. {self.REQUEST}")


class EditConflictError(DeloneError, RuntimeError):
    """Another thread edited a `Dynamic` during a transaction of several edits.

    Parameters
    ----------
    message : str
        The message.

    Examples
    --------
    >>> from delone import EditConflictError
    >>> raise EditConflictError("edited meanwhile")
    Traceback (most recent call last):
    delone.errors.EditConflictError: edited meanwhile
    """


class HandleError(DeloneError, KeyError):
    """Handles do not identify points of a `Dynamic`, or occur twice; also a KeyError.

    Parameters
    ----------
    message : str
        The message.
    handles : array_like of int, optional
        The handles.

    Attributes
    ----------
    handles : ndarray of int64
        The handles that do not exist or occur twice.

    Examples
    --------
    >>> import delone
    >>> live = delone.Dynamic([(0, 0), (1, 0), (0, 1)])
    >>> try:
    ...     live.remove([1, 7])
    ... except KeyError as error:
    ...     print(error, error.handles)
    handle 7 is not there [7]
    """

    handles: NDArray[np.int64]

    def __init__(self, message: str = "a handle is not there", *, handles: ArrayLike = ()) -> None:
        super().__init__(message)
        self.handles = np.array(handles, dtype=np.int64).reshape(-1)
        self.handles.flags.writeable = False

    def __str__(self) -> str:
        # A KeyError would show the message in quotes.
        return str(self.args[0])


class FileFormatError(DeloneError, ValueError):
    """A file is truncated, corrupt, or not in the format that its name or header says.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone import FileFormatError, io
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "torn.npy"
    ...     _ = file.write_bytes(b"NUMPY")
    ...     try:
    ...         io.read_points(file)
    ...     except FileFormatError as error:
    ...         print("torn.npy" in str(error))
    True
    """


class OutputError(DeloneError, OSError):
    """A file cannot be written: a full disk, a quota, a limit, or another failure.

    Also an OSError, with its attributes. No part of the new file remains, and an existing file is
    unchanged.

    Attributes
    ----------
    errno : int or None
        The error number; None if a library does not report it.
    strerror : str or None
        The system's message.
    filename : str or None
        The file to be written.

    Examples
    --------
    >>> import errno
    >>> from delone import OutputError
    >>> error = OutputError(errno.ENOSPC, "No space left on device", "mesh.vtu")
    >>> isinstance(error, OSError), error.filename
    (True, 'mesh.vtu')
    """


class MissingExtraError(DeloneError, ImportError):
    """A required optional library is not installed.

    Parameters
    ----------
    message : str
        The message.
    extra : str, optional
        The extra of delone that installs the library.

    Attributes
    ----------
    extra : str
        The extra to install, as in ``pip install "delone[las]"``.

    Examples
    --------
    >>> from delone import MissingExtraError
    >>> print(MissingExtraError(extra="las"))
    install it with: pip install "delone[las]"
    """

    extra: str

    def __init__(self, message: str = "", *, extra: str = "") -> None:
        super().__init__(message or f'install it with: pip install "delone[{extra}]"')
        self.extra = extra
