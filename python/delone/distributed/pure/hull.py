"""Strictly extreme points of a set, computed piece by piece: the hull of hulls is the hull."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone.distributed.pure.rows import coordinates

if TYPE_CHECKING:
    from delone.distributed.pure.rows import Rows

__all__ = ["extreme_rows"]


def extreme_rows(rows: Rows) -> Rows:
    """Return the strictly extreme rows, the first of equal ones.

    They are the corners of the hull; the two ends of a line; one row where all are equal.
    """
    return rows[np.sort(_core.hull2(coordinates(rows))[0])]
