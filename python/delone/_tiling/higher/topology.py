"""Topology of simplices with any number of corners: the facets of the boundary.

This module needs neither coordinates nor predicates. Simplices are positively oriented, and
``neighbors[t, k]`` is the simplex across the facet opposite vertex k, or -1 outside.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Indices, Rows

__all__ = ["boundary_facets", "distinct", "neighbors"]


def boundary_facets(simplices: Indices, neighbors: Indices) -> Indices:
    """Return the facets with a simplex on one side only, (h, d), in the order of the simplices.

    An interior point followed by the corners of a facet is positively oriented, as in 2-D and 3-D.
    """
    simplex, corner = np.nonzero(neighbors < 0)
    count = simplices.shape[1]
    # All corners but one; swap the last two if the number of that corner is odd.
    order = np.array([[k for k in range(count) if k != left] for left in range(count)])
    order[1::2, -2:] = order[1::2, :-3:-1]
    found: Indices = np.take_along_axis(simplices[simplex], order[corner], axis=1)
    return found


def distinct(numbers: Rows) -> Rows:
    """Return the distinct numbers, sorted; ``np.unique`` may hash them, which takes longer."""
    ascending = np.sort(numbers)
    kept = np.ones(len(ascending), dtype=bool)
    np.not_equal(ascending[1:], ascending[:-1], out=kept[1:])
    return ascending[kept]


def neighbors(simplices: Indices) -> Indices:
    """Return the simplex opposite each vertex, or -1. O(m log m).

    Simplices are not neighbors across a facet that more than two of them share.
    """
    count, width = simplices.shape
    left = [[k for k in range(width) if k != corner] for corner in range(width)]
    facets = np.sort(simplices[:, left].reshape(-1, width - 1), axis=1)
    order = np.lexsort(facets.T[::-1])
    same = (facets[order[1:]] == facets[order[:-1]]).all(axis=1)
    # Runs of two equal facets.
    pair = same & ~np.append(False, same[:-1]) & ~np.append(same[1:], False)
    first, second = order[:-1][pair], order[1:][pair]
    found = np.full(count * width, -1, dtype=np.int32)
    found[first], found[second] = second // width, first // width
    return found.reshape(count, width)
