"""Rows of points that repeat earlier rows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["first_rows", "vertices_of"]


def first_rows(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return for each point, (n, d), the first row with the same coordinates, (n,)."""
    order = np.lexsort(points.T)
    ordered = points[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    # The sort is stable, so that the first of equal rows comes first.
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[np.flatnonzero(new)][np.cumsum(new) - 1]
    return first


def vertices_of(duplicates: NDArray[np.int32], count: int) -> NDArray[np.int32]:
    """Return the vertex of each of `count` rows, given the duplicates, (k, 2)."""
    first = np.arange(count, dtype=np.int32)
    first[duplicates[:, 0]] = duplicates[:, 1]
    return first
