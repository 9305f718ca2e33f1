"""Constants that mark cells without a height in rasters that do not declare them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_number
from delone._base.counting import counted
from delone.errors import FileFormatError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools

__all__ = ["as_nodata", "is_nodata", "require_declared"]

# What programs write: nines, the limits of two-byte integers, and the largest floats.
_CUSTOMARY = (-9999.0, 9999.0, -99999.0, 99999.0, -32768.0, -32767.0, 32767.0)
_LARGE = 1e30


def as_nodata(given: Any) -> float | None:
    """Return the value of cells without a height: None, or a number, which may be NaN."""
    return None if given is None else as_number(given, name="nodata")


def is_nodata(values: NDArray[Any], nodata: float | None) -> Bools:
    """Return which values are `nodata`, after rounding to the type of the values."""
    if nodata is None or np.isnan(nodata):
        return np.zeros(values.shape, dtype=bool)
    with np.errstate(over="ignore"):
        rounded = values.dtype.type(nodata) if values.dtype.kind == "f" else nodata
    return np.asarray((values == nodata) | (values == rounded))


def require_declared(
    values: NDArray[Any], nodata: float | None, where: str, *, file: bool = True
) -> None:
    """Reject heights that are a customary nodata constant, far outside the range of all others.

    Far means by more than the width of that range. NaN as `nodata` says that every value is a
    height.
    """
    if not len(values) or (nodata is not None and np.isnan(nodata)):
        return
    values = values.astype(np.float64, copy=False)
    odd = np.isin(values, _CUSTOMARY) | (np.abs(values) >= _LARGE)
    if not odd.any():
        return
    rest = values[~odd]
    found = np.unique(values[odd], return_counts=True)
    for number, count in zip(*(each.tolist() for each in found), strict=True):
        if len(rest):
            low, high = float(rest.min()), float(rest.max())
            if max(low - number, number - high) <= high - low:
                continue
            others = f"all others are from {low:.6g} to {high:.6g}"
        else:
            others = "no other value is there"
        error = FileFormatError if file else InputError
        raise error(
            f"{where}: {counted(count, 'cell')} of {number:.10g}, which programs write where "
            f"there is no height, and {others}: give nodata={number!r:.30} (--nodata) to leave "
            "these cells out, or nodata=nan if all values are heights"
        )
