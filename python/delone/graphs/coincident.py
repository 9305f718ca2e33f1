"""Rows of points with the same coordinates: which rows they are, and edges at all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._base.duplicates import first_rows

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["clique", "repeated"]


def repeated(points: Floats) -> Indices:
    """Return the rows that repeat earlier rows, and the first of these, (k, 2)."""
    if not len(points):
        return np.empty((0, 2), dtype=np.int32)
    first = first_rows(points)
    rows = np.flatnonzero(first != np.arange(len(points)))
    return np.column_stack((rows, first[rows])).astype(np.int32)


def clique(edges: Indices, vertex: Indices) -> Indices:
    """Return edges between all rows of two joined vertices and all rows of one vertex.

    `vertex` contains the first coincident row of each row, (n,).
    """
    order = np.argsort(vertex, kind="stable")
    size = np.bincount(vertex, minlength=len(vertex))
    start = np.concatenate(([0], np.cumsum(size)))
    own = np.flatnonzero(size > 1)
    loops = np.column_stack((own, own))
    ends = np.concatenate((vertex[edges], loops))
    tail, head = ends.T
    # All pairs of the rows of both ends.
    times = size[tail] * size[head]
    number = np.arange(times.sum()) - np.repeat(np.cumsum(times) - times, times)
    across = np.repeat(size[head], times)
    first = order[np.repeat(start[tail], times) + number // across]
    second = order[np.repeat(start[head], times) + number % across]
    pairs = np.column_stack((first, second)).astype(np.int32)
    found: Indices = pairs[first != second]
    return found
