"""Conversion and checks of arrays with one entry per item: values, labels and marks.

Items are points, segments, triangles and the like.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_plain_array, refuse_hidden, require_integers, wrong_shape
from delone.errors import DtypeError, InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Indices

__all__ = [
    "as_labels",
    "as_marks",
    "as_values",
    "refuse_rounded",
    "require_mapping",
    "require_real",
    "require_shape",
]

# Beyond this, not every integer is a float64.
_LARGEST_EXACT_INTEGER = 2**53


def as_values(
    values: ArrayLike | None, count: int, *, name: str = "z"
) -> NDArray[np.float64] | None:
    """Return one float64 value for each of `count` points; None for None."""
    if values is None:
        return None
    refuse_hidden(values, name)
    array = as_plain_array(values, name)
    require_real(array, name, kinds="iufb")
    require_shape(array, (count,), name)
    return np.ascontiguousarray(array, dtype=np.float64)


def as_labels(labels: ArrayLike | None, count: int, *, name: str) -> Indices:
    """Return one 32-bit integer for each of `count` items, from (count,) or (count, 1).

    None means zeros.
    """
    if labels is None:
        return np.zeros(count, dtype=np.int32)
    array = as_plain_array(labels, name)
    if array.shape == (count, 1):
        array = array.ravel()
    require_shape(array, (count,), name)
    if array.size:
        require_integers(array, name)
    ends = np.iinfo(np.int32)
    if array.size and (int(array.min()) < ends.min or int(array.max()) > ends.max):
        raise InputError(f"{name} must be 32-bit integers")
    return np.ascontiguousarray(array, dtype=np.int32)


def as_marks(marks: ArrayLike, count: int, *, name: str, of: str) -> Bools:
    """Return a mask of `count` items, such as "points", from a mask or rows."""
    array = as_plain_array(marks, name)
    if array.dtype.kind == "b":
        require_shape(array, (count,), name)
        return np.array(array)
    found = np.zeros(count, dtype=bool)
    if array.shape == (0,):
        return found
    if array.ndim != 1:
        raise wrong_shape(name, "(k,)", array)
    if array.dtype.kind not in "iu":
        raise DtypeError(f"{name} must be a mask or rows of {of}, got dtype {array.dtype}")
    low, high = int(array.min()), int(array.max())
    if low < 0 or high >= count:
        wrong = low if low < 0 else high
        raise InputError(f"{name} must be rows of {of}, from 0 to {count - 1}, got {wrong}")
    found[array] = True
    return found


def require_shape(array: NDArray[Any], shape: tuple[int, ...], name: str) -> None:
    """Reject an array of another shape."""
    if array.shape != shape:
        raise wrong_shape(name, shape, array)


def require_real(array: NDArray[Any], name: str, *, kinds: str = "iuf") -> None:
    """Reject an array whose dtype is not one of `kinds`, by default those of real numbers."""
    if array.dtype.kind not in kinds:
        what = "numbers" if "c" in kinds else "real numbers"
        raise DtypeError(f"{name} must hold {what}, got dtype {array.dtype}")


def require_mapping(given: Any, name: str) -> None:
    """Reject anything but a mapping of names to arrays."""
    if not hasattr(given, "items"):
        raise DtypeError(f"{name} must be a mapping of names to arrays, got {given!r:.60}")


def refuse_rounded(array: NDArray[Any], plain: NDArray[Any], name: str) -> None:
    """Reject integers and extended floats that doubles, `plain`, cannot represent."""
    if array.dtype.kind in "iu" and array.dtype.itemsize >= 8:
        with np.errstate(all="ignore"):
            wrong = (array > _LARGEST_EXACT_INTEGER) | (array < -_LARGEST_EXACT_INTEGER)
    elif array.dtype.kind in "fc" and array.dtype.itemsize > plain.dtype.itemsize:
        wrong = (array != plain) & ~np.isnan(array)
    else:
        return
    if wrong.any():
        row = int(np.argwhere(np.atleast_1d(wrong))[0, 0])
        raise DtypeError(
            f"{name}: row {row} has a number that float64 cannot represent; round it first"
        )
