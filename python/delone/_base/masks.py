"""Rejection of masked entries of arrays, which other functions would treat as numbers."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import DtypeError

if TYPE_CHECKING:
    from typing import TypeGuard

__all__ = ["hides", "is_masked", "refuse_hidden", "refuse_masks"]


# Items that are not arrays.
_PLAIN = frozenset((int, float, list, tuple, np.float64, np.int64))


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
