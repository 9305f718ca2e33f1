"""Rejection of masked arrays, which other functions would treat as plain arrays."""

from __future__ import annotations

from typing import Any

import numpy as np

from delone.errors import DtypeError

__all__ = ["refuse_masks"]


def refuse_masks(given: Any, name: str) -> None:
    """Reject a masked array, or a list of them, before the mask is silently dropped."""
    rows = given if isinstance(given, list | tuple) else ()
    if isinstance(given, np.ma.MaskedArray) or any(
        isinstance(row, np.ma.MaskedArray) for row in rows
    ):
        raise DtypeError(
            f"{name} is a masked array; pass only the valid rows, "
            "for example np.ma.compress_rows(points), or points.data if none is masked"
        )
