"""Compressed rows: of cells, of ridges, and of pairs of sites; and the same as lists."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["as_lists", "from_the_gap", "of_pairs", "one_gap"]


def of_pairs(
    pairs: NDArray[np.int64], values: Floats, npoints: int
) -> tuple[Indices, Indices, Floats]:
    """Return symmetric pairs as compressed rows, with the value of each pair.

    Parameters
    ----------
    pairs : ndarray of int64, shape (r, 2)
        Pairs of rows.
    values : ndarray of float64, shape (r,)
        The value of each pair.
    npoints : int
        Number of rows.

    Returns
    -------
    tuple of ndarray
        Where each row begins, its partners ascending, and their values.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.voronoi.rows import of_pairs
    >>> [each.tolist() for each in of_pairs(np.array([(0, 2), (1, 0)]), np.array([5.0, 6.0]), 3)]
    [[0, 2, 3, 4], [1, 2, 0, 0], [6.0, 5.0, 6.0, 5.0]]
    """
    here = np.concatenate((pairs[:, 0], pairs[:, 1]))
    there = np.concatenate((pairs[:, 1], pairs[:, 0]))
    order = np.argsort(here * npoints + there)
    indptr = np.zeros(npoints + 1, dtype=np.int32)
    np.cumsum(np.bincount(here, minlength=npoints), out=indptr[1:])
    return indptr, there[order].astype(np.int32), np.tile(values, 2)[order]


def as_lists(indptr: Indices, indices: Indices) -> list[list[int]]:
    """Return compressed rows as lists.

    Parameters
    ----------
    indptr : ndarray of int32, shape (r + 1,)
        Where each row begins, and the end.
    indices : ndarray of int32
        The entries.

    Returns
    -------
    list of list of int
        The entries of each row.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.voronoi.rows import as_lists
    >>> as_lists(np.array([0, 2, 3]), np.array([-1, 4, 7]))
    [[-1, 4], [7]]
    """
    starts, entries = indptr.tolist(), indices.tolist()
    return [entries[a:b] for a, b in itertools.pairwise(starts)]


def one_gap(starts: Indices, entries: Indices) -> tuple[Indices, Indices]:
    """Return cyclic rows with each run of -1 written once, also a run across the end.

    Parameters
    ----------
    starts : ndarray of int32, shape (c + 1,)
        Where each row begins, and the end.
    entries : ndarray of int32
        Vertices in order around a cell, -1 for an end at infinity.

    Returns
    -------
    indptr, indices : ndarray of int32
        The same, each gap a single -1; the arrays themselves if no two gaps are adjacent.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.voronoi.rows import as_lists, one_gap
    >>> starts = np.array([0, 4, 6], dtype=np.int32)
    >>> as_lists(*one_gap(starts, np.array([-1, 4, 7, -1, -1, -1], dtype=np.int32)))
    [[4, 7, -1], [-1]]
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
    # A row of nothing but gaps keeps the first.
    total = np.concatenate(([0], np.cumsum(repeated)))
    infinite = filled & (total[starts[1:]] - total[starts[:-1]] == sizes)
    repeated[starts[:-1][infinite]] = False
    return _some(starts, entries, ~repeated)


def from_the_gap(starts: Indices, entries: Indices) -> tuple[Indices, Indices]:
    """Return ridges with their vertices in order, an unbounded one beginning with a single -1.

    Parameters
    ----------
    starts : ndarray of int32, shape (r + 1,)
        Where each ridge begins, and the end.
    entries : ndarray of int32
        Vertices in order around each ridge, negative for rays and for vertices beyond the range of
        doubles.

    Returns
    -------
    indptr, indices : ndarray of int32
        The vertices from the first negative entry on, which becomes -1; others are left out.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.voronoi.rows import as_lists, from_the_gap
    >>> starts = np.array([0, 3, 7], dtype=np.int32)
    >>> as_lists(*from_the_gap(starts, np.array([4, 5, 6, 0, 1, -1, 3], dtype=np.int32)))
    [[4, 5, 6], [-1, 3, 0, 1]]
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
