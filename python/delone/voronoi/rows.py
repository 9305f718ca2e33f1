"""Compressed rows: of cells, of ridges, and of pairs of sites; and the same as lists."""

from __future__ import annotations

import gc
import itertools
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["as_lists", "from_the_gap", "of_pairs", "one_gap"]


def of_pairs(
    pairs: NDArray[np.int64], values: Floats, npoints: int
) -> tuple[Indices, Indices, Floats]:
    """Return symmetric pairs, (r, 2), as compressed rows: starts, partners (ascending), values."""
    here = np.concatenate((pairs[:, 0], pairs[:, 1]))
    there = np.concatenate((pairs[:, 1], pairs[:, 0]))
    order = np.argsort(here * npoints + there)
    indptr = np.zeros(npoints + 1, dtype=np.int32)
    np.cumsum(np.bincount(here, minlength=npoints), out=indptr[1:])
    return indptr, there[order].astype(np.int32), np.tile(values, 2)[order]


def as_lists(indptr: Indices, indices: Indices) -> list[list[int]]:
    """Return compressed rows as lists."""
    starts, entries = indptr.tolist(), indices.tolist()
    # Lists of integers have no reference cycles, and searching for them takes longer than making
    # the lists.
    collects = gc.isenabled()
    gc.disable()
    try:
        return [entries[a:b] for a, b in itertools.pairwise(starts)]
    finally:
        if collects:
            gc.enable()


def one_gap(starts: Indices, entries: Indices) -> tuple[Indices, Indices]:
    """Return cyclic rows with each run of -1 written once, including a run across the end.

    The arrays themselves if no two gaps are adjacent.
    """
    gaps = entries < 0
    if not gaps.any():
        return starts, entries
    sizes = np.diff(starts)
    filled = sizes > 0
    before = np.roll(gaps, 1)
    before[starts[:-1][filled]] = gaps[starts[1:][filled] - 1]
    repeated = gaps & before
    if not repeated.any():
        return starts, entries
    # A row that contains only gaps keeps the first.
    total = np.concatenate(([0], np.cumsum(repeated)))
    infinite = filled & (total[starts[1:]] - total[starts[:-1]] == sizes)
    repeated[starts[:-1][infinite]] = False
    return _some(starts, entries, ~repeated)


def from_the_gap(starts: Indices, entries: Indices) -> tuple[Indices, Indices]:
    """Return ridges with their vertices in order, an unbounded one beginning with a single -1.

    `entries` are negative for rays and for vertices beyond the range of doubles. Each row is
    rotated to begin with its first negative entry, which becomes -1; the others are left out.
    """
    negative = np.flatnonzero(entries < 0)
    if not len(negative):
        return starts, entries
    ridge, first = np.unique(np.searchsorted(starts, negative, "right") - 1, return_index=True)
    gap = negative[first]
    # Rays are at both ends of a ridge; only a vertex beyond the range may be inside.
    inside = gap > starts[ridge]
    turned = entries.copy()
    for row, at in zip(ridge[inside].tolist(), gap[inside].tolist(), strict=True):
        begin, end = starts[row], starts[row + 1]
        turned[begin:end] = np.roll(entries[begin:end], begin - at)
    kept = turned >= 0
    kept[starts[ridge]] = True
    return _some(starts, np.maximum(turned, -1), kept)


def _some(starts: Indices, entries: Indices, kept: NDArray[np.bool_]) -> tuple[Indices, Indices]:
    """Return the entries that are marked, as compressed rows."""
    total = np.concatenate(([0], np.cumsum(kept)))
    return total[starts].astype(np.int32), entries[kept]
