"""Lengths of edges, and comparisons of them, which are exact."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._arrays import as_workers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

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


def lowest(
    points: Floats, edges: Indices, lengths: Floats, share: float, workers: int | None
) -> Indices:
    """Return the edges that are not longer than the one at a rank, given in percent."""
    if not len(edges):
        return edges
    rank = max(math.ceil(share / 100 * len(edges)), 1) - 1
    at_rank = np.partition(lengths, rank)[rank]
    # Of several with the same rounded length, the longest.
    tied = edges[lengths == at_rank]
    longest = tied[0]
    while True:
        shorter = _not_longer(points, tied, points[longest], workers)
        if len(shorter) == len(tied):
            return _not_longer(points, edges, points[longest], workers)
        keys = tied[:, 0].astype(np.int64) << 32 | tied[:, 1]
        rest = ~np.isin(keys, shorter[:, 0].astype(np.int64) << 32 | shorter[:, 1])
        tied = tied[rest]
        longest = tied[0]


def _not_longer(points: Floats, edges: Indices, ends: Floats, workers: int | None) -> Indices:
    """Return the edges that are not longer than the one between two points, (2, d)."""
    core = _core.not_longer2 if points.shape[1] == 2 else _core.not_longer3
    return core(
        points, np.ascontiguousarray(edges), np.ascontiguousarray(ends), as_workers(workers)
    )
