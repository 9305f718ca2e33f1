"""Conversion of the arguments of callers; values without an exact meaning are rejected.

After `as_points`, every other module may assume a native, aligned, C-contiguous float64 array of
shape (n, 2) or (n, 3) with exactly the values that the caller wrote. Anything that float64 cannot
represent exactly raises an error that names it: an exact result for rounded input is a wrong
result.

Finiteness is not checked here, because the core reads every coordinate anyway; `require_finite` is
for callers that do not use the core.
"""

from __future__ import annotations

import operator
import os
import sys
from typing import TYPE_CHECKING, Any, TypeGuard, TypeVar

import numpy as np

from delone._masks import refuse_masks
from delone.counting import agreed, counted
from delone.errors import DtypeError, InputError, LimitError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Scalar = TypeVar("Scalar", bound=np.generic)

_FLOAT64 = np.dtype(np.float64)
# Every integer of at most this magnitude is a float64; the next one, 2**53 + 1, is not.
_LARGEST_EXACT_INTEGER = 2**53
_LARGEST_INDEX = 2**31 - 1
# More threads only cost memory for stacks: the result does not depend on their number.
_MOST_WORKERS = 256
_REFUSED_KINDS = {
    "b": "booleans",
    "c": "complex numbers",
    "M": "dates",
    "m": "time spans",
    "O": "Python objects",
    "S": "byte strings",
    "T": "strings",
    "U": "strings",
    "V": "records",
}


def as_points(
    points: ArrayLike, *, ndim: int | None = None, name: str = "points"
) -> NDArray[np.float64]:
    """Return points as a float64 C-contiguous array with exactly the values given.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3)
        Floats of up to 64 bits, integers up to 2**53 in magnitude, in any memory layout or byte
        order, or anything that converts to such an array.
    ndim : {2, 3}, optional
        Required number of coordinates. By default both are accepted.
    name : str, optional
        Name of the argument in error messages.

    Returns
    -------
    ndarray of float64, shape (n, 2) or (n, 3)
        Aligned, native, C-contiguous. This is the input itself if possible, including read-only
        arrays; never modify it.

    Raises
    ------
    ShapeError
        Wrong number of axes or coordinates, or rows of unequal length.
    DtypeError
        Booleans, complex numbers, objects, strings, dates, records or masked arrays; integers
        beyond 2**53; extended precision that float64 cannot represent.

    Notes
    -----
    NaN and infinity are accepted. O(n) time; no copy if none is needed.

    Examples
    --------
    >>> from delone._arrays import as_points
    >>> as_points([(0, 0), (4, 0), (4, 3)])
    array([[0., 0.],
           [4., 0.],
           [4., 3.]])
    """
    if _is_right(points, ndim):
        return points
    array = as_plain_array(points, name)
    _refuse_geometries(array, name)
    _refuse_kind(array, name)
    _refuse_shape(array, ndim, name)
    if array.dtype.kind in "iu":
        _refuse_large_integers(array, name)
    elif array.dtype.itemsize > 8:
        _refuse_lossy_longdouble(array, name)
    elif isinstance(points, list | tuple):
        _refuse_rounded_integers(points, array, name)
    # The core reads the memory directly, so alignment matters as much as contiguity.
    return np.require(array, dtype=np.float64, requirements=["C", "A"])


def as_vectors(values: ArrayLike, d: int, *, name: str = "points") -> NDArray[np.float64]:
    """Return points with any leading axes, with exactly the values given.

    Parameters
    ----------
    values : array_like, shape (..., d)
        Anything that `as_points` accepts, and single points, grids of points and so on.
    d : {2, 3}
        Number of coordinates.
    name : str, optional
        Name of the argument in error messages.

    Returns
    -------
    ndarray of float64, shape (..., d)
        Aligned, native, C-contiguous.

    Raises
    ------
    ShapeError
        The last axis does not have d entries, or rows have unequal lengths.
    DtypeError
        As in `as_points`.

    Examples
    --------
    >>> from delone._arrays import as_vectors
    >>> as_vectors((0, 1), 2)
    array([0., 1.])
    """
    if (
        type(values) is np.ndarray
        and values.dtype is _FLOAT64
        and values.flags.carray
        and values.ndim > 0
        and values.shape[-1] == d
    ):
        return values
    array = as_plain_array(values, name)
    if array.shape == (0,):
        # An empty list does not determine the length of the last axis.
        return np.empty((0, d))
    if array.ndim == 0 or array.shape[-1] != d:
        _refuse_kind(array, name)
        raise ShapeError(f"{name} must have shape (..., {d}), got {array.shape}")
    if array.ndim == 2:
        return as_points(values, ndim=d, name=name)
    if array.ndim == 1 and isinstance(values, list | tuple):
        array = as_points([values], ndim=d, name=name)
        return array.reshape(d)
    return as_points(array.reshape(-1, d), ndim=d, name=name).reshape(array.shape)


def require_finite(points: NDArray[np.float64], *, name: str = "points") -> None:
    """Reject points with a NaN or infinite coordinate.

    Parameters
    ----------
    points : ndarray of float64, shape (n, d)
        The points.
    name : str, optional
        What the argument is called in the error message.

    Raises
    ------
    NonFiniteError
        Names the first ten such rows and their number.

    Examples
    --------
    >>> import numpy as np
    >>> from delone._arrays import require_finite
    >>> require_finite(np.array([[0.0, 1.0], [np.nan, 2.0]]))
    Traceback (most recent call last):
    ...
    delone.errors.NonFiniteError: points: 1 of 2 rows holds NaN or infinity; first: 1
    """
    finite = np.isfinite(points)
    if finite.all():
        return
    rows = np.flatnonzero(~finite.all(axis=1))
    first = ", ".join(map(str, rows[:10].tolist()))
    message = (
        f"{name}: {len(rows)} of {counted(len(points), 'row')} "
        f"{agreed(len(rows), 'holds', 'hold')} NaN or infinity; first: {first}"
    )
    raise NonFiniteError(message, rows=rows[:10], count=len(rows))


def as_simplices(
    simplices: ArrayLike, npoints: int, d: int, *, name: str = "simplices"
) -> NDArray[np.int32]:
    """Return simplices as an int32 C-contiguous array of valid vertex indices.

    Parameters
    ----------
    simplices : array_like of int, shape (m, d + 1)
        Vertex indices.
    npoints : int
        Number of points that the indices refer to.
    d : {2, 3}
        Dimension of the points.
    name : str, optional
        Name of the argument in error messages.

    Returns
    -------
    ndarray of int32, shape (m, d + 1)
        The input itself if no conversion is needed.

    Raises
    ------
    ShapeError
        The shape is not (m, d + 1).
    DtypeError
        The values are not integers.
    InputError
        An index below 0 or beyond the last point; the first such row is named.
    LimitError
        There are more points than int32 can number.

    Examples
    --------
    >>> from delone._arrays import as_simplices
    >>> as_simplices([[0, 1, 2]], 3, 2)
    array([[0, 1, 2]], dtype=int32)
    """
    if npoints > _LARGEST_INDEX:
        raise LimitError(
            f"{npoints} points exceed {_LARGEST_INDEX}, the largest number of an int32"
        )
    return _as_indices(simplices, d + 1, 0, npoints, name)


def as_segments(segments: ArrayLike, npoints: int, *, name: str = "segments") -> NDArray[np.int32]:
    """Return segments as an int32 C-contiguous array of valid vertex indices.

    Parameters
    ----------
    segments : array_like of int, shape (s, 2)
        Vertex indices; an empty sequence means no segments.
    npoints : int
        Number of points that the indices refer to.
    name : str, optional
        Name of the argument in error messages.

    Returns
    -------
    ndarray of int32, shape (s, 2)
        The input itself if no conversion is needed.

    Raises
    ------
    ShapeError
        The shape is not (s, 2).
    DtypeError
        The values are not integers.
    InputError
        Indices below 0 or beyond the last point; the first ten such rows are named.

    Examples
    --------
    >>> from delone._arrays import as_segments
    >>> as_segments([(0, 1), (1, 3), (2, -1)], 3)
    Traceback (most recent call last):
    ...
    delone.errors.InputError: segments: 2 of 3 rows have indices outside 0 to 2; first: rows 1, 2
    """
    array = as_plain_array(segments, name)
    if array.shape in ((0,), (0, 2)):
        return np.empty((0, 2), dtype=np.int32)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ShapeError(f"{name} must have shape (s, 2), got {array.shape}")
    if array.dtype.kind not in "iu":
        raise DtypeError(f"{name} must hold integers (rows of points), got dtype {array.dtype}")
    if int(array.min()) < 0 or int(array.max()) >= npoints:
        rows = np.flatnonzero(((array < 0) | (array >= npoints)).any(axis=1))
        first = ", ".join(map(str, rows[:10].tolist()))
        raise InputError(
            f"{name}: {len(rows)} of {counted(len(array), 'row')} "
            f"{agreed(len(rows), 'has', 'have')} indices outside 0 to {npoints - 1}; "
            f"first: {agreed(min(len(rows), 10), 'row', 'rows')} {first}"
        )
    return np.require(array, dtype=np.int32, requirements=["C", "A"])


def as_seeds(seeds: ArrayLike | None, *, name: str, columns: int = 2) -> NDArray[np.float64]:
    """Return seed points of areas.

    Parameters
    ----------
    seeds : array_like, shape (k, 2) or (k, columns), or None
        Finite points, with further columns after their coordinates; None or empty means no seeds.
    name : str
        Name of the argument in error messages.
    columns : {2, 3}, optional
        The maximum number of columns.

    Returns
    -------
    ndarray of float64, shape (k, 2) or (k, columns)
        The input itself if no conversion is needed.

    Raises
    ------
    ShapeError, DtypeError
        As in `as_points`.
    NonFiniteError
        A number is NaN or infinite.

    Examples
    --------
    >>> from delone._arrays import as_seeds
    >>> as_seeds([(1, 2)], name="holes")
    array([[1., 2.]])
    >>> as_seeds(None, name="holes").shape
    (0, 2)
    """
    if seeds is None:
        return np.empty((0, 2))
    array = as_plain_array(seeds, name)
    if array.size == 0 and array.ndim <= 2:
        return np.empty((0, 2))
    found = as_points(seeds, ndim=2 if columns == 2 else None, name=name)
    require_finite(found, name=name)
    return found


def as_choice(value: str, choices: tuple[str, ...], *, name: str) -> str:
    """Validate a string argument with given choices.

    Parameters
    ----------
    value : str
        The argument.
    choices : tuple of str
        The valid choices.
    name : str
        Name of the argument in error messages.

    Returns
    -------
    str
        The argument.

    Raises
    ------
    InputError
        It is not one of the choices.

    Examples
    --------
    >>> from delone._arrays import as_choice
    >>> as_choice("hull", ("hull", "outline"), name="boundary")
    'hull'
    """
    if isinstance(value, str) and value in choices:
        return value
    raise InputError(f"{name} must be one of {', '.join(map(repr, choices))}, got {value!r}")


def as_neighbors(
    neighbors: ArrayLike, nsimplex: int, d: int, *, name: str = "neighbors"
) -> NDArray[np.int32]:
    """Return neighbors as an int32 C-contiguous array of simplex numbers or -1.

    Parameters
    ----------
    neighbors : array_like of int, shape (nsimplex, d + 1)
        Number of the simplex opposite each vertex, -1 outside.
    nsimplex : int
        Number of simplices.
    d : {2, 3}
        Dimension of the points.
    name : str, optional
        Name of the argument in error messages.

    Returns
    -------
    ndarray of int32, shape (nsimplex, d + 1)
        The input itself if no conversion is needed.

    Raises
    ------
    ShapeError
        The shape is not (nsimplex, d + 1).
    DtypeError
        The values are not integers.
    InputError
        A number below -1 or beyond the last simplex; the first such row is named.

    Examples
    --------
    >>> from delone._arrays import as_neighbors
    >>> as_neighbors([[-1, -1, -1]], 1, 2)
    array([[-1, -1, -1]], dtype=int32)
    """
    array = _as_indices(neighbors, d + 1, -1, nsimplex, name)
    if len(array) != nsimplex:
        raise ShapeError(f"{name} has {len(array)} rows, but there are {nsimplex} simplices")
    return array


def as_count(n: int, *, name: str = "n") -> int:
    """Return a count as a Python integer.

    Parameters
    ----------
    n : int
        At least 0.
    name : str, optional
        Name of the argument in error messages.

    Returns
    -------
    int
        The number.

    Raises
    ------
    InputError
        The number is negative (a ValueError), or not an integer (also a TypeError).

    Examples
    --------
    >>> from delone._arrays import as_count
    >>> as_count(3)
    3
    """
    wanted = f"{name} must be an integer of at least 0"
    if isinstance(n, bool | np.bool_ | np.ma.MaskedArray):
        raise DtypeError(f"{wanted}, got {n}")
    try:
        number = operator.index(n)
    except TypeError:
        raise DtypeError(f"{wanted}, got {n!r}") from None
    if number < 0:
        raise InputError(f"{wanted}, got {number}")
    return number


def as_number(value: float, *, name: str) -> float:
    """Return a real number as a Python float.

    Parameters
    ----------
    value : float
        A Python or NumPy number, including NaN and infinity; not a boolean or string.
    name : str
        Name of the argument in error messages.

    Returns
    -------
    float
        The number, rounded to a double.

    Raises
    ------
    DtypeError
        It is not a real number, or is beyond the range of doubles.

    Examples
    --------
    >>> from delone._arrays import as_number
    >>> as_number(3, name="tol")
    3.0
    >>> as_number("3", name="tol")
    Traceback (most recent call last):
    ...
    delone.errors.DtypeError: tol must be a real number, got '3'
    """
    plain = not isinstance(value, bool | np.bool_ | str | bytes | np.ndarray) or (
        isinstance(value, np.ndarray) and value.ndim == 0 and value.dtype.kind in "iuf"
    )
    plain = plain and not isinstance(value, np.ma.MaskedArray)
    try:
        if plain:
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise DtypeError(f"{name} must be a real number, got {value!r:.60}")


def as_flag(flag: bool, *, name: str) -> bool:
    """Return a boolean as a Python bool.

    Parameters
    ----------
    flag : bool
        A Python or NumPy boolean; no other truthy or falsy object.
    name : str
        Name of the argument in error messages.

    Returns
    -------
    bool
        The value.

    Raises
    ------
    DtypeError
        It is not a boolean.

    Examples
    --------
    >>> from delone._arrays import as_flag
    >>> as_flag(True, name="flips")
    True
    >>> as_flag(None, name="flips")
    Traceback (most recent call last):
    ...
    delone.errors.DtypeError: flips must be True or False, got None
    """
    if isinstance(flag, bool | np.bool_):
        return bool(flag)
    raise DtypeError(f"{name} must be True or False, got {flag!r:.60}")


def as_optional_flag(flag: bool | None, *, name: str) -> bool | None:
    """Return a boolean as a Python bool, or None.

    Parameters
    ----------
    flag : bool or None
        As for `as_flag`, or None.
    name : str
        Name of the argument in error messages.

    Returns
    -------
    bool or None
        The value.

    Raises
    ------
    DtypeError
        It is neither a boolean nor None.

    Examples
    --------
    >>> from delone._arrays import as_optional_flag
    >>> as_optional_flag(None, name="shade")
    >>> as_optional_flag("no", name="shade")
    Traceback (most recent call last):
    ...
    delone.errors.DtypeError: shade must be True, False or None, got 'no'
    """
    if flag is None or isinstance(flag, bool | np.bool_):
        return None if flag is None else bool(flag)
    raise DtypeError(f"{name} must be True, False or None, got {flag!r:.60}")


def as_workers(workers: int | None) -> int:
    """Return how many threads to use.

    Parameters
    ----------
    workers : int or None
        None means one per core that this process may use.

    Returns
    -------
    int
        At least 1 and at most 256, to which larger numbers are reduced: the result does not depend
        on the number of threads, and each costs memory.

    Raises
    ------
    InputError
        The number is below 1 (a ValueError), or not an integer (also a TypeError).

    Examples
    --------
    >>> from delone._arrays import as_workers
    >>> as_workers(3)
    3
    >>> as_workers(0)
    Traceback (most recent call last):
    ...
    delone.errors.InputError: workers must be None (all cores) or an integer of at least 1, got 0
    """
    if workers is None:
        return min(_usable_cores(), _MOST_WORKERS)
    wanted = "workers must be None (all cores) or an integer of at least 1"
    if isinstance(workers, bool | np.bool_):
        raise DtypeError(f"{wanted}, got {workers}")
    try:
        number = operator.index(workers)
    except TypeError:
        raise DtypeError(f"{wanted}, got {workers!r}") from None
    if number < 1:
        raise InputError(f"{wanted}, got {number}")
    return min(number, _MOST_WORKERS)


def frozen(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a read-only view of an array; the array itself is unchanged.

    Parameters
    ----------
    array : ndarray
        Any array.

    Returns
    -------
    ndarray
        The same memory, not writeable.

    Examples
    --------
    >>> import numpy as np
    >>> from delone._arrays import frozen
    >>> frozen(np.zeros(3)).flags.writeable
    False
    """
    view = array.view()
    view.flags.writeable = False
    return view


def _is_right(points: Any, ndim: int | None) -> TypeGuard[NDArray[np.float64]]:
    """Return whether no conversion is needed; this is on the hot path of small inputs."""
    return (
        type(points) is np.ndarray
        and points.dtype is _FLOAT64
        and points.flags.carray
        and points.ndim == 2
        and points.shape[1] in ((2, 3) if ndim is None else (ndim,))
    )


def as_plain_array(points: Any, name: str) -> NDArray[Any]:
    """Return a plain ndarray, of any dtype and shape.

    Parameters
    ----------
    points : array_like
        The argument.
    name : str
        Name of the argument in error messages.

    Returns
    -------
    ndarray
        The array. Masked arrays are rejected, because masks would be silently dropped.

    Raises
    ------
    DtypeError
        A masked array.
    ShapeError
        Rows of unequal length.

    Examples
    --------
    >>> from delone._arrays import as_plain_array
    >>> as_plain_array([[1, 2], [3]], "values")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    delone.errors.ShapeError: values has rows of unequal length: ...
    """
    refuse_masks(points, name)
    try:
        return np.asarray(points)
    except ValueError as error:
        if not isinstance(points, list | tuple):
            raise
        raise ShapeError(f"{name} has rows of unequal length: {error}") from error


def _refuse_geometries(array: NDArray[Any], name: str) -> None:
    if array.dtype.kind == "O" and any(hasattr(each, "geom_type") for each in array.ravel()[:8]):
        raise DtypeError(
            f"{name} contains geometries, not numbers: for points pass their coordinates, "
            f"shapely.get_coordinates({name}) or {name}.get_coordinates().to_numpy(); "
            "delone.from_geometry accepts all kinds of geometries"
        )


def _refuse_kind(array: NDArray[Any], name: str) -> None:
    kind = array.dtype.kind
    if kind in "fiu":
        return
    what = _REFUSED_KINDS.get(kind, f"dtype {array.dtype}")
    hint = "convert them to numbers that float64 can represent exactly"
    if kind == "U" and not array.ndim:
        hint = "read a file with delone.io.read_points(path)"
    if kind == "V" and array.dtype.names:
        hint = "for example np.column_stack((a['x'], a['y']))"
    elif kind == "c":
        hint = "for example np.column_stack((z.real, z.imag))"
    raise DtypeError(f"{name} contains {what} (dtype {array.dtype}), not real numbers; {hint}")


def _refuse_shape(array: NDArray[Any], ndim: int | None, name: str) -> None:
    wanted = (2, 3) if ndim is None else (ndim,)
    if array.ndim == 2 and array.shape[1] in wanted:
        return
    shapes = " or ".join(f"(n, {d})" for d in wanted)
    hint = ""
    if array.ndim == 2 and array.shape[0] in wanted:
        hint = "; transpose it"
    raise ShapeError(f"{name} must have shape {shapes}, got {array.shape}{hint}")


def _refuse_large_integers(array: NDArray[Any], name: str) -> None:
    if array.dtype.itemsize < 8 or array.size == 0:
        return
    limit = _LARGEST_EXACT_INTEGER
    if int(array.max()) <= limit and int(array.min()) >= -limit:
        return
    # Not abs(): the magnitude of the smallest int64 is not an int64.
    outside = array > limit
    if array.dtype.kind == "i":
        outside |= array < -limit
    row = int(np.flatnonzero(outside.any(axis=1))[0])
    _raise_large_integer(row, array[row].tolist(), name)


def _refuse_rounded_integers(points: Any, array: NDArray[Any], name: str) -> None:
    """Reject Python integers that NumPy rounded because the list also contains floats."""
    large = np.abs(array) >= _LARGEST_EXACT_INTEGER
    for row in np.flatnonzero(large.any(axis=1)).tolist():
        for value in points[row]:
            if isinstance(value, int | np.integer) and abs(int(value)) > _LARGEST_EXACT_INTEGER:
                _raise_large_integer(row, list(points[row]), name)


def _raise_large_integer(row: int, values: list[Any], name: str) -> None:
    raise DtypeError(
        f"{name}: row {row} is {values}, beyond the 2**53 up to which float64 represents every "
        "integer; subtract an offset first"
    )


def _refuse_lossy_longdouble(array: NDArray[Any], name: str) -> None:
    with np.errstate(over="ignore"):
        narrow = array.astype(np.float64)
    same = (narrow == array) | np.isnan(array)
    if same.all():
        return
    row = int(np.flatnonzero(~same.all(axis=1))[0])
    raise DtypeError(
        f"{name}: row {row} has more precision or range than float64 ({array.dtype}); "
        "round it with .astype(np.float64) if that is intended"
    )


def _as_indices(
    values: ArrayLike, columns: int, lowest: int, end: int, name: str
) -> NDArray[np.int32]:
    array = as_plain_array(values, name)
    if array.ndim != 2 or array.shape[1] != columns:
        raise ShapeError(f"{name} must have shape (m, {columns}), got {array.shape}")
    if array.dtype.kind not in "iu":
        raise DtypeError(f"{name} must hold integers, got dtype {array.dtype}")
    if array.size and (int(array.min()) < lowest or int(array.max()) >= end):
        bad = array >= end
        if array.dtype.kind == "i":
            bad |= array < lowest
        row = int(np.flatnonzero(bad.any(axis=1))[0])
        raise InputError(
            f"{name}: row {row} is {array[row].tolist()}, outside the range {lowest} to {end - 1}"
        )
    return np.require(array, dtype=np.int32, requirements=["C", "A"])


def _usable_cores() -> int:
    if sys.version_info >= (3, 13):
        return os.process_cpu_count() or 1
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def as_mesh(
    points: NDArray[np.float64], simplices: NDArray[np.integer[Any]]
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return points and simplices as the core requires them: contiguous, with 32-bit indices.

    Parameters
    ----------
    points : ndarray of float64, shape (n, d)
        Coordinates.
    simplices : ndarray of int, shape (m, k)
        Rows of points.

    Returns
    -------
    points : ndarray of float64, shape (n, d)
        The points, copied only if they are not contiguous.
    simplices : ndarray of int32, shape (m, k)
        The simplices.
    """
    return np.ascontiguousarray(points), np.ascontiguousarray(simplices, dtype=np.int32)
