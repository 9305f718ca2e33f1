"""Rows that repeat earlier rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["first_rows", "groups_of", "vertices_of"]


def first_rows(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return for each point, (n, d), the first row with the same coordinates, (n,)."""
    first, group = groups_of(points)
    return first[group]


def groups_of(rows: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first of each group of equal rows, in lexicographic order, and the group of each.

    NaN equals nothing, so each row with NaN is a group of its own.
    """
    order = np.lexsort(rows.T[::-1])
    ordered = rows[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    # The sort is stable, so that the first of equal rows comes first.
    return order[new], group


def vertices_of(duplicates: NDArray[np.int32], count: int) -> NDArray[np.int32]:
    """Return the vertex of each of `count` rows, given the duplicates, (k, 2)."""
    first = np.arange(count, dtype=np.int32)
    first[duplicates[:, 0]] = duplicates[:, 1]
    return first
