"""Entries of cells and ridges as lists, and pairs of sites as compressed rows."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._core import Diagram3

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["compressed", "gaps_once", "ridge_lists"]


def compressed(
    pairs: NDArray[np.int64], lengths: Floats, npoints: int
) -> tuple[Indices, Indices, Floats]:
    """Return symmetric pairs as compressed rows, with what belongs to each pair.

    Parameters
    ----------
    pairs : ndarray of int64, shape (r, 2)
        Rows that belong together.
    lengths : ndarray of float64, shape (r,)
        What belongs to each pair.
    npoints : int
        Number of rows.

    Returns
    -------
    tuple of ndarray
        Where each row begins, its partners ascending, and what belongs to them.
    """
    here = np.concatenate((pairs[:, 0], pairs[:, 1]))
    there = np.concatenate((pairs[:, 1], pairs[:, 0]))
    order = np.argsort(here * npoints + there)
    indptr = np.zeros(npoints + 1, dtype=np.int32)
    np.cumsum(np.bincount(here, minlength=npoints), out=indptr[1:])
    return indptr, there[order].astype(np.int32), np.tile(lengths, 2)[order]


def gaps_once(region: list[int]) -> list[int]:
    """Return a cell with each run of -1 written once, also where it runs over the end.

    Parameters
    ----------
    region : list of int
        Vertices in order around the cell, -1 for an end at infinity.

    Returns
    -------
    list of int
        The same, a gap a single -1.

    Examples
    --------
    >>> from delone.voronoi.lists import gaps_once
    >>> gaps_once([-1, 4, 7, -1]), gaps_once([-1, -1])
    ([4, 7, -1], [-1])
    """
    kept = [v for i, v in enumerate(region) if v >= 0 or region[i - 1] >= 0]
    return kept or region[:1]


def ridge_lists(dual: Diagram3) -> list[list[int]]:
    """Return the vertices of each ridge in their order around it; -1, which comes first, if open.

    Parameters
    ----------
    dual : Diagram3
        The diagram.

    Returns
    -------
    list of list of int
        Vertices, ridge by ridge.
    """
    starts, entries = dual.ridge_starts.tolist(), dual.ridge_entries.tolist()
    return [_from_the_gap(entries[a:b]) for a, b in itertools.pairwise(starts)]


def _from_the_gap(entries: list[int]) -> list[int]:
    """The vertices of a ridge, those that follow its gap first; -1 for the gap."""
    if min(entries) >= 0:
        return entries
    found = [v for v in entries if v >= 0]
    if entries[0] < 0:
        return [-1, *found]
    # Closed, with a vertex beyond the range of doubles.
    gap = next(i for i, v in enumerate(entries) if v < 0)
    turned = entries[gap:] + entries[:gap]
    return [-1, *(v for v in turned if v >= 0)]
