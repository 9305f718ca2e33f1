"""The nearest of sites that lie on one line, which have no triangulation to search."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from delone._base.arrays import as_vectors

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["nearest"]

# Relative to the sum of absolute products: five roundings of 2**-53 each, with a margin.
_ROUNDING = 2.0**-50
# Sums above this lose less to underflow than `_ROUNDING` allows.
_SMALLEST = 2.0**-960


def nearest(points: Floats, chain: Indices, xi: ArrayLike) -> Indices:
    """Return the rows of the nearest sites, (...): the smaller of two, -1 for queries not finite.

    `chain` contains the rows of the sites in their order along the line; it is not empty.
    """
    queries = as_vectors(xi, points.shape[1], name="xi")
    flat = queries.reshape(-1, points.shape[1])
    rows = np.flatnonzero(np.isfinite(flat).all(axis=1))
    at = flat[rows]
    # Bisectors are parallel and in the order of the sites: binary search for the first one that a
    # point is not beyond.
    low, high = np.zeros(len(rows), dtype=np.int64), np.full(len(rows), len(chain) - 1)
    while len(going := np.flatnonzero(low < high)):
        middle = (low[going] + high[going]) // 2
        beyond = _sides(points[chain[middle]], points[chain[middle + 1]], at[going]) > 0
        low[going[beyond]] = middle[beyond] + 1
        high[going[~beyond]] = middle[~beyond]
    last = np.minimum(low + 1, len(chain) - 1)
    tied = (low < last) & (_sides(points[chain[low]], points[chain[last]], at) == 0)
    best = np.where(tied, np.minimum(chain[low], chain[last]), chain[low])
    found = np.full(len(flat), -1, dtype=np.int32)
    found[rows] = best
    return found.reshape(queries.shape[:-1])


def _sides(a: Floats, b: Floats, q: Floats) -> NDArray[np.int8]:
    """Return 1 for points nearer to b than to a, -1 for points nearer to a, 0 for ties, exactly."""
    with np.errstate(all="ignore"):
        p, r, along = q - a, q - b, b - a
        # |q - a|**2 - |q - b|**2 = (q - a + q - b) (b - a)
        value = ((p + r) * along).sum(axis=1)
        total = ((np.abs(p) + np.abs(r)) * np.abs(along)).sum(axis=1)
        certain = (np.abs(value) > _ROUNDING * total) & (total > _SMALLEST) & np.isfinite(total)
    found = np.where(certain, np.sign(value), 0).astype(np.int8)
    for row in np.flatnonzero(~certain).tolist():
        u, v, w = ([Fraction(x) for x in each[row].tolist()] for each in (a, b, q))
        exact = sum(
            ((2 * z - x - y) * (y - x) for x, y, z in zip(u, v, w, strict=True)), Fraction(0)
        )
        found[row] = (exact > 0) - (exact < 0)
    return found
