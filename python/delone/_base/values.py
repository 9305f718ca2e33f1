"""Values at points, converted to float64 and checked for length."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._base.arrays import as_plain_array
from delone._base.masks import refuse_hidden
from delone.errors import DtypeError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["as_values"]


def as_values(
    values: ArrayLike | None, count: int, *, name: str = "z"
) -> NDArray[np.float64] | None:
    """Return one float64 value for each of `count` points; None for None."""
    if values is None:
        return None
    refuse_hidden(values, name)
    array = as_plain_array(values, name)
    if array.dtype.kind not in "iufb":
        raise DtypeError(f"{name} must hold real numbers, got dtype {array.dtype}")
    if array.shape != (count,):
        raise ShapeError(f"{name} must have shape ({count},), got {array.shape}")
    return np.ascontiguousarray(array, dtype=np.float64)
