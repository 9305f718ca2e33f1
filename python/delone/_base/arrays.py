"""Conversion of callers' arguments; values without an exact meaning, and masks, are rejected.

After `as_points`, every other module may assume a native, aligned, C-contiguous float64 array of
shape (n, 2) or (n, 3) with exactly the values that the caller wrote. Anything that float64 cannot
represent exactly raises an error that names it: an exact result for rounded input is a wrong
result.

Finiteness is not checked here, because the core reads every coordinate anyway; `require_finite` is
for callers that do not use the core.
"""

from __future__ import annotations

import contextlib
import operator
import os
import sys
from typing import TYPE_CHECKING, Any, TypeGuard, TypeVar

import numpy as np

from delone._base.counting import agreed, counted
from delone._base.georeference import column_words, transformed
from delone._base.uneven import uneven
from delone.errors import DtypeError, InputError, LimitError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

Scalar = TypeVar("Scalar", bound=np.generic)

_FLOAT64 = np.dtype(np.float64)
_INT32 = np.dtype(np.int32)
# Every integer of at most this magnitude is a float64; the next one, 2**53 + 1, is not.
_LARGEST_EXACT_INTEGER = 2**53
# Points with more columns are interpolated, but not triangulated.
_MOST_COLUMNS = 8
# Those that linear interpolation without a triangulation takes.
_MOST_INTERPOLATED = 64
_LARGEST_INDEX = 2**31 - 1
# A larger limit has no effect: no call adds more points than an int32 can number.
LARGEST_LIMIT = 2**31 - 1
# More threads only cost memory for stacks: the result does not depend on their number.
_MOST_WORKERS = 256
# Names of columns that contain x and y of points, and of third columns that contain row numbers.
_PLANAR_COLUMNS = (
    ("x", "y"),
    ("lon", "lat"),
    ("long", "lat"),
    ("lng", "lat"),
    ("longitude", "latitude"),
    ("easting", "northing"),
)
_NUMBERS_OF_ROWS = {"id", "fid", "gid", "oid", "index", "row", "number", "nr", "no", "label"}
# Items that are not arrays.
_PLAIN = frozenset((int, float, list, tuple, np.float64, np.int64))
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
    points: ArrayLike,
    *,
    ndim: int | None = None,
    most: int = 3,
    name: str = "points",
    few: bool | None = None,
) -> NDArray[np.float64]:
    """Return points as a C-contiguous float64 array with exactly the values given, including NaN.

    From 2 to `most` columns from anything array-like; `ndim` requires a number. Two or three rows
    of more columns are only taken for points with `few`; if that is False, the error says how to
    pass three points. No copy is made if none is needed, so the result may be the input itself,
    even if read-only: never modify it.
    """
    wanted = range(2, most + 1) if ndim is None else (ndim,)
    if _is_right(points, wanted) and (few or not _is_across(points, wanted)):
        return points
    array = as_plain_array(_coordinates(points, ndim, name), name)
    _refuse_columns(points, array, name)
    refuse_geometries(array, name)
    _refuse_kind(array, name)
    _refuse_shape(array, wanted, name, few=few)
    if array.dtype.kind in "iu":
        _refuse_large_integers(array, name)
    elif array.dtype.itemsize > 8:
        _refuse_lossy_longdouble(array, name)
    elif isinstance(points, list | tuple):
        _refuse_rounded_integers(points, array, name)
    # The core reads the memory directly, so alignment matters as much as contiguity.
    return np.require(array, dtype=np.float64, requirements=["C", "A"])


def _coordinates(points: Any, ndim: int | None, name: str) -> Any:
    """Return the coordinates of point geometries; anything else is returned unchanged.

    Geometries are those of a GeoDataFrame, GeoSeries or sequence of shapely points.
    """
    held = points
    # Without shapely loaded, no object can be a shapely geometry.
    is_numbers = isinstance(points, np.ndarray) and points.dtype.kind != "O"
    if is_numbers or "shapely" not in sys.modules:
        return points
    with contextlib.suppress(AttributeError):  # a GeoDataFrame without a geometry column
        if hasattr(points, "crs") and hasattr(points, "geometry"):
            held = points.geometry
    if isinstance(held, list | tuple):
        if not any(hasattr(each, "geom_type") for each in held[:8]):
            return points
        every = np.empty(len(held), dtype=object)
        every[:] = held
    elif getattr(getattr(held, "dtype", None), "kind", "") == "O":
        every = np.asarray(held)
    else:
        return points  # such as a table of numbers
    if every.ndim != 1:
        return points
    if not any(hasattr(each, "geom_type") for each in every[:8]):
        return points
    return _of_points(sys.modules["shapely"], every, ndim, name)


def _of_points(
    shapely: Any, every: NDArray[Any], ndim: int | None, name: str
) -> NDArray[np.float64]:
    """Return the coordinates of shapely points, (n,); reject others, and heights in 2-D."""
    strange = np.flatnonzero(~shapely.is_valid_input(every))
    if len(strange):
        kind = type(every[strange[0]]).__name__
        raise DtypeError(f"{name} contains geometries, and a {kind} in row {strange[0]}")
    kinds = shapely.get_type_id(every)
    if len(other := np.flatnonzero(kinds > 0)):
        raise DtypeError(
            f"{name} contains geometries that are not points, the first in row {other[0]}, a "
            f"{every[other[0]].geom_type}: shapely.get_coordinates({name}) returns the coordinates "
            "of all; delone.from_geometry accepts all kinds of geometries"
        )
    empty = np.flatnonzero((kinds < 0) | shapely.is_empty(every))
    if len(empty):
        rows = ", ".join(map(str, empty[:10].tolist()))
        raise NonFiniteError(
            f"{name}: {len(empty)} of {counted(len(every), 'row')} "
            f"{agreed(len(empty), 'is', 'are')} missing or an empty point; first: {rows}",
            rows=empty[:10],
            count=len(empty),
        )
    if ndim == 3:
        found: NDArray[np.float64] = shapely.get_coordinates(every, include_z=True)
        return found
    if shapely.has_z(every).any():
        raise InputError(
            f"{name} are points with heights: pass shapely.force_2d({name}) for points in 2-D, or "
            f"shapely.get_coordinates({name}, include_z=True) for points in 3-D"
        )
    flat: NDArray[np.float64] = shapely.get_coordinates(every)
    return flat


def as_vectors(values: ArrayLike, d: int, *, name: str = "points") -> NDArray[np.float64]:
    """Return points with any leading axes, (..., d), with exactly the values given: `as_points`."""
    if (
        type(values) is np.ndarray
        and values.dtype is _FLOAT64
        and values.flags.carray
        and values.ndim > 0
        and values.shape[-1] == d
    ):
        return values
    array = as_plain_array(_coordinates(values, d, name), name)
    if array.shape == (0,):
        # An empty list does not determine the length of the last axis.
        return np.empty((0, d))
    if array.ndim == 0 or array.shape[-1] != d:
        _refuse_kind(array, name)
        raise wrong_shape(name, f"(..., {d})", array)
    if array.ndim == 2:
        # Coordinates of geometries are floats already, so no integer can have been rounded.
        found = array if getattr(values, "ndim", 2) == 1 else values
        return as_points(found, ndim=d, name=name)
    if array.ndim == 1 and isinstance(values, list | tuple):
        array = as_points([values], ndim=d, name=name)
        return array.reshape(d)
    return as_points(array.reshape(-1, d), ndim=d, name=name).reshape(array.shape)


def as_queries(
    xi: ArrayLike, d: int, crs: str | None, *, name: str = "xi", to: str = "the points"
) -> NDArray[np.float64]:
    """Return queries, (..., d), in the reference system of the data that they are about.

    `crs` is that system, and `to` describes the data; see `transformed`.
    """
    queries = as_vectors(xi, d, name=name)
    if type(xi) is np.ndarray or not hasattr(xi, "crs"):
        return queries
    flat = queries.reshape(-1, d)
    return transformed(xi, flat, crs, name=name, to=to).reshape(queries.shape)


def require_finite(points: NDArray[np.float64], *, name: str = "points") -> None:
    """Reject points, (n, d), with a NaN or infinite coordinate; the error lists the first ten."""
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
    """Return rows of points, (m, d + 1), as int32; the first row out of range is named."""
    if npoints > _LARGEST_INDEX:
        raise LimitError(
            f"{npoints} points exceed {_LARGEST_INDEX}, the largest number of an int32"
        )
    return _as_indices(simplices, d + 1, 0, npoints, name)


def as_segments(segments: ArrayLike, npoints: int, *, name: str = "segments") -> NDArray[np.int32]:
    """Return pairs of points, (s, 2), as int32; the first ten rows out of range are named."""
    if (
        type(segments) is np.ndarray
        and segments.dtype is _INT32
        and segments.flags.carray
        and segments.ndim == 2
        and segments.shape[1] == 2
        # The bits of negative numbers are those of the largest ones.
        and segments.view(np.uint32).max(initial=0) < npoints
    ):
        return segments  # hot path for small inputs
    array = as_plain_array(segments, name)
    if array.shape in ((0,), (0, 2)):
        return np.empty((0, 2), dtype=np.int32)
    if array.ndim != 2 or array.shape[1] != 2:
        raise wrong_shape(name, "(s, 2)", array)
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
    """Return finite seeds, (k, 2) or, with further numbers, (k, columns); None means no seeds."""
    if seeds is None:
        return np.empty((0, 2))
    array = as_plain_array(seeds, name)
    if array.size == 0 and array.ndim <= 2:
        return np.empty((0, 2))
    found = as_points(seeds, ndim=2 if columns == 2 else None, name=name)
    require_finite(found, name=name)
    return found


def as_choice(value: str, choices: tuple[str, ...], *, name: str) -> str:
    """Return a string argument if it is one of the given choices; otherwise raise an error."""
    if isinstance(value, str) and value in choices:
        return value
    raise InputError(f"{name} must be one of {', '.join(map(repr, choices))}, got {value!r:.60}")


def as_neighbors(
    neighbors: ArrayLike, nsimplex: int, d: int, *, name: str = "neighbors"
) -> NDArray[np.int32]:
    """Return simplex numbers, (nsimplex, d + 1), as int32: opposite each vertex, -1 outside."""
    array = _as_indices(neighbors, d + 1, -1, nsimplex, name)
    if len(array) != nsimplex:
        raise ShapeError(f"{name} has {len(array)} rows, but there are {nsimplex} simplices")
    return array


def as_count(n: int, *, name: str = "n") -> int:
    """Return an integer of at least 0 as a Python integer; booleans are rejected."""
    return _as_integer(n, 0, f"{name} must be an integer of at least 0")


def as_least(n: int, least: int, *, name: str) -> int:
    """Return an integer of at least `least` as a Python integer; booleans are rejected."""
    return _as_integer(n, least, f"{name} must be an integer of at least {least}")


def as_limit(n: int, *, name: str) -> int:
    """Return a count that means "at most", like `as_count`; the core counts in 32 bits."""
    return min(as_count(n, name=name), LARGEST_LIMIT)


def as_number(value: float, *, name: str) -> float:
    """Return a real number, including NaN and infinity, as a float; no booleans, no text."""
    if isinstance(value, np.ndarray):
        plain = not is_masked(value) and value.ndim == 0 and value.dtype.kind in "iuf"
    else:
        plain = not isinstance(value, bool | np.bool_ | str | bytes)
    if plain:
        with contextlib.suppress(TypeError, ValueError, OverflowError):
            return float(value)
    raise DtypeError(f"{name} must be a real number, got {value!r:.60}")


def as_flag(flag: bool, *, name: str) -> bool:
    """Return a Python or NumPy boolean as a Python bool; other truthy objects are rejected."""
    if isinstance(flag, bool | np.bool_):
        return bool(flag)
    raise DtypeError(f"{name} must be True or False, got {flag!r:.60}")


def as_optional_flag(flag: bool | None, *, name: str) -> bool | None:
    """Return a boolean as a Python bool, or None, as for `as_flag`."""
    if flag is None:
        return None
    if isinstance(flag, bool | np.bool_):
        return bool(flag)
    raise DtypeError(f"{name} must be True, False or None, got {flag!r:.60}")


def as_callback(function: Any, *, name: str) -> Any:
    """Return a function, or None; anything else raises an error before the computation."""
    if function is None or callable(function):
        return function
    raise DtypeError(f"{name} must be a function or None, got {function!r:.60}")


def as_workers(workers: int | None) -> int:
    """Return a number of threads, at least 1 and at most 256; None means one per usable core."""
    if workers is None:
        return min(_usable_cores(), _MOST_WORKERS)
    wanted = "workers must be None (all cores) or an integer of at least 1"
    return min(_as_integer(workers, 1, wanted), _MOST_WORKERS)


def _as_integer(value: int, least: int, wanted: str) -> int:
    if isinstance(value, bool | np.bool_) or is_masked(value):
        raise DtypeError(f"{wanted}, got {value!s:.60}")
    try:
        number = operator.index(value)
    except TypeError:
        raise DtypeError(f"{wanted}, got {value!r:.60}") from None
    if number < least:
        raise InputError(f"{wanted}, got {number!s:.60}")
    return number


def wrong_shape(name: str, wanted: object, array: NDArray[Any]) -> ShapeError:
    """Return the error for an array of the wrong shape."""
    return ShapeError(f"{name} must have shape {wanted}, got {array.shape}")


def require_integers(array: NDArray[Any], name: str) -> None:
    """Reject an array of anything but integers."""
    if array.dtype.kind not in "iu":
        raise DtypeError(f"{name} must hold integers, got dtype {array.dtype}")


def as_text(text: Any, *, name: str) -> str:
    """Return a string; anything else raises an error."""
    if isinstance(text, str):
        return text
    raise DtypeError(f"{name} must be a string, got {text!r:.60}")


def as_index(n: int, low: int, high: int, *, name: str) -> int:
    """Return an integer in a closed range as a Python integer; booleans are rejected."""
    wanted = f"{name} must be an integer from {low} to {high}"
    number = _as_integer(n, low, wanted)
    if number > high:
        raise InputError(f"{wanted}, got {number!s:.60}")
    return number


def is_masked(value: Any) -> TypeGuard[np.ma.MaskedArray[Any, Any]]:
    """Return whether `value` is a masked array, without an import of `numpy.ma`.

    That import takes 10 ms, three times as long as triangulating 10,000 points, and without it,
    there are no masked arrays.
    """
    return "numpy.ma" in sys.modules and isinstance(value, np.ma.MaskedArray)


def hides(value: Any) -> bool:
    """Return whether `value` is a masked array, or a masked number, with masked entries.

    NetCDF files are read as masked arrays, most of which mask nothing: these count as plain arrays.
    """
    return is_masked(value) and bool(np.ma.is_masked(value))


def refuse_hidden(values: Any, name: str) -> None:
    """Reject masked values, and suggest NaN for missing ones."""
    if hides(values):
        raise DtypeError(f"{name} is a masked array; fill it: {name}.filled(numpy.nan)")


def refuse_masks(given: Any, name: str) -> None:
    """Reject masked entries, even of arrays in a list, before they are treated as numbers."""
    rows = given if isinstance(given, list | tuple) else ()
    # Checking only the types is several times faster than checking each item.
    odd = not _PLAIN.issuperset(map(type, rows)) and any(map(hides, rows))
    if odd or hides(given):
        count = int(np.ma.getmaskarray(given).sum()) if is_masked(given) else sum(map(hides, rows))
        raise DtypeError(
            f"{name} is a masked array, with {count} masked: pass only the valid rows, for example "
            f"np.ma.compress_rows({name})"
        )


def frozen(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a read-only view of an array; the array itself is unchanged."""
    view = array.view()
    view.flags.writeable = False
    return view


def _is_right(points: Any, wanted: Sequence[int]) -> TypeGuard[NDArray[np.float64]]:
    """Return whether no conversion is needed; this is on the hot path of small inputs."""
    return (
        type(points) is np.ndarray
        and points.dtype is _FLOAT64
        and points.flags.carray
        and points.ndim == 2
        and points.shape[1] in wanted
    )


def as_plain_array(points: Any, name: str) -> NDArray[Any]:
    """Return an ndarray of any dtype and shape, but reject masked arrays and uneven rows."""
    refuse_masks(points, name)
    try:
        return np.asarray(points)
    except ValueError as error:
        if not isinstance(points, list | tuple):
            raise
        raise ShapeError(uneven(points, name)) from error


def _refuse_columns(points: Any, array: NDArray[Any], name: str) -> None:
    """Reject a table whose columns named x and y are not the first two, or not the only ones.

    A third column may be a coordinate.
    """
    listed: Any = getattr(points, "columns", None)
    if array.ndim != 2 or not hasattr(listed, "__iter__") or len(names := list(listed)) < 2:
        return
    words = [column_words(column) for column in names]
    for first, second in _PLANAR_COLUMNS:
        x = [k for k, each in enumerate(words) if first in each]
        y = [k for k, each in enumerate(words) if second in each]
        if len(x) != 1 or len(y) != 1:
            continue
        right = x + y == [0, 1] and (
            len(names) == 2 or (len(names) == 3 and not words[2] & _NUMBERS_OF_ROWS)
        )
        if not right:
            pair = [names[x[0]], names[y[0]]]
            shown = ", ".join(f"{each}"[:30] for each in names[:8])
            more = ", ..." if len(names) > 8 else ""
            raise InputError(
                f"{name} is a table with the columns {shown}{more}, which would be read as "
                f"coordinates in this order: pass {name}[{pair}] for points in 2-D"
            )


def refuse_geometries(array: NDArray[Any], name: str) -> None:
    """Reject geometries, even in one column of a table, and say how to get coordinates."""
    # In a table, geometries are one column, after any number of others.
    first = array[:1] if array.ndim > 1 else np.atleast_1d(array)[:8]
    if array.dtype.kind == "O" and any(hasattr(each, "geom_type") for each in first.ravel()):
        raise DtypeError(
            f"{name} contains geometries, not numbers: for points pass their coordinates, "
            f"shapely.get_coordinates({name}) or {name}.get_coordinates().to_numpy(); "
            "delone.from_geometry accepts all kinds of geometries"
        )


def _refuse_kind(array: NDArray[Any], name: str) -> None:
    kind = array.dtype.kind
    if kind in "fiu":
        return
    if kind == "O" and not array.ndim and hasattr(array.item(), "points"):
        held = name if hasattr(array.item(), name) else "points"
        owner = type(array.item()).__name__
        raise DtypeError(f"{name} is an object of type {owner}, not numbers: pass its {held}")
    what = _REFUSED_KINDS.get(kind, f"dtype {array.dtype}")
    hint = "convert them to numbers that float64 can represent exactly"
    if kind == "U" and not array.ndim:
        hint = "read a file with delone.io.read_points(path)"
    if kind == "V" and array.dtype.names:
        hint = "for example np.column_stack((a['x'], a['y']))"
    elif kind == "c":
        hint = "for example np.column_stack((z.real, z.imag))"
    raise DtypeError(f"{name} contains {what} (dtype {array.dtype}), not real numbers; {hint}")


def _refuse_shape(
    array: NDArray[Any], wanted: Sequence[int], name: str, *, few: bool | None = None
) -> None:
    if array.ndim == 2 and array.shape[1] in wanted and (few or not _is_across(array, wanted)):
        return
    shapes = " or ".join(f"(n, {d})" for d in wanted)
    if len(wanted) > 2:
        shapes = f"(n, d) with d from {wanted[0]} to {wanted[-1]}"
    hint = ""
    if array.ndim == 2 and (array.shape[0] in wanted or _is_across(array, wanted)):
        hint = "; transpose it"
        if few is False and len(array) == 3 and array.shape[1] in wanted:
            hint += ', or if these are three points, pass flat="project"'
    elif array.ndim == 2 and wanted[-1] == _MOST_COLUMNS < array.shape[1] <= _MOST_INTERPOLATED:
        hint = "; to interpolate between points with more coordinates, use "
        hint += "delone.interpolate.Linear, which does not triangulate them"
    raise ShapeError(f"{name} must have shape {shapes}, got {array.shape}{hint}")


def _is_across(array: NDArray[Any], wanted: Sequence[int]) -> bool:
    """Return whether the array is transposed: two or three rows, x, y and z, of many columns."""
    return len(wanted) > 2 and array.shape[1] > 3 and array.shape[0] in (2, 3)


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
        raise wrong_shape(name, f"(m, {columns})", array)
    require_integers(array, name)
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
    """Return points and simplices as the core requires them: contiguous, with 32-bit indices."""
    return np.ascontiguousarray(points), np.ascontiguousarray(simplices, dtype=np.int32)
