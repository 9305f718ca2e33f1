"""Lengths of edges, and their exact comparison."""

from __future__ import annotations

import math
import sys
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_workers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices


# More than the relative error of a rounded length, and more than the absolute error of the
# smallest.
_ROUNDED, _SMALLEST = 2.0**-48, 2.0**-1070

__all__ = ["lengths_of", "lowest", "squares", "up_to"]


def lengths_of(points: Floats, edges: Indices) -> Floats:
    """Return the lengths of edges; squares neither overflow nor underflow."""
    with np.errstate(over="ignore", invalid="ignore"):
        along = points[edges[:, 1]] - points[edges[:, 0]]
        found: Floats = np.hypot(along[:, 0], along[:, 1])
        return np.hypot(found, along[:, 2]) if points.shape[1] == 3 else found


def squares(points: Floats, edges: Indices) -> Floats:
    """Return the squared lengths of edges."""
    with np.errstate(over="ignore", under="ignore"):
        along = points[edges[:, 1]] - points[edges[:, 0]]
        found: Floats = (along * along).sum(axis=1)
        return found


def up_to(points: Floats, edges: Indices, limit: float, workers: int | None) -> Indices:
    """Return the edges that are not longer than a number."""
    if math.isinf(limit):
        return edges
    ends = np.zeros((2, points.shape[1]))
    ends[1, 0] = limit
    return _not_longer(points, edges, ends, workers)


def lowest(points: Floats, edges: Indices, lengths: Floats, share: float) -> Indices:
    """Return the edges that are not longer than the one at a rank, given in percent.

    Rounded lengths leave only those close to that of the rank, which are compared as fractions.
    """
    if not len(edges):
        return edges
    rank = max(math.ceil(Fraction(share) * len(edges) / 100), 1) - 1
    at_rank = min(float(np.partition(lengths, rank)[rank]), sys.float_info.max)
    # Differences and roots are rounded a few times each; among the smallest doubles, by one unit.
    slack = at_rank * _ROUNDED + _SMALLEST
    shorter = lengths < at_rank - slack
    near = np.flatnonzero(~shorter & ~(lengths > at_rank + slack))
    squared, which = _exact_squares(points, edges[near])
    order = sorted(range(len(squared)), key=squared.__getitem__)
    counts = np.bincount(which, minlength=len(squared))[order]
    # The length at the rank, and all equal ones.
    last = int(np.searchsorted(np.cumsum(counts), rank - np.count_nonzero(shorter), side="right"))
    longest = squared[order[last]]
    kept = shorter
    kept[near] = np.array([each <= longest for each in squared])[which]
    return edges[kept]


def _exact_squares(points: Floats, edges: Indices) -> tuple[list[Fraction], NDArray[np.intp]]:
    """Distinct squared lengths of edges as fractions, and the one of each edge."""
    tails, heads = points[edges[:, 0]], points[edges[:, 1]]
    with np.errstate(over="ignore", invalid="ignore"):
        step = heads - tails
        # What rounding took from the difference, exactly.
        back = step - heads
        lost = (heads - (step - back)) + (-tails - back)
    # If differences are beyond the range of doubles, use the coordinates themselves.
    keys = np.hstack((step, lost) if np.isfinite(lost).all() else (tails, heads))
    rows, which = np.unique(keys, axis=0, return_inverse=True)
    ndim = points.shape[1]
    sign = 1 if np.isfinite(lost).all() else -1
    squares = [
        sum(
            ((Fraction(row[ndim + k]) + sign * Fraction(row[k])) ** 2 for k in range(ndim)),
            Fraction(0),
        )
        for row in rows.tolist()
    ]
    return squares, which.reshape(-1)


def _not_longer(points: Floats, edges: Indices, ends: Floats, workers: int | None) -> Indices:
    """Return the edges that are not longer than the one between two points, (2, d)."""
    return _core.not_longer(
        points, np.ascontiguousarray(edges), np.ascontiguousarray(ends), as_workers(workers)
    )
