"""The arrays of a 2-D diagram: from the core, or from the order of sites that lie on one line.

A `Diagram2`, as the core's `voronoi2` returns it, has the same meaning in both cases:

* ridge r has the sites ``sites[r]`` and the ends ``ends[r]``: vertex v, or ``~i`` for ray i with
  direction ``rays[i]``. The ray leads to the vertex ``beyond[i]``, outside the range of doubles and
  with infinite coordinates, or is unbounded if that is NaN. The first site of a ridge lies to the
  left of the direction from its first end to its second.
* cell c has the site ``site[c]`` and the entries ``region_starts[c]:region_starts[c + 1]``:
  counter-clockwise, a vertex (-1 for an end at infinity) in ``region_vertices`` and the ridge from
  there to the next in ``region_ridges``.
* ``region[p]`` is the cell of point p; -1 if it has none.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from delone._core import Diagram2

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["foot", "of_chain"]

# Squares of lengths between these are not affected by underflow or overflow.
_SMALLEST, _LARGEST = 2.0**-900, 2.0**900


def of_chain(points: Floats, chain: Indices) -> Diagram2:
    """Return the diagram of distinct sites on one line, half-planes and strips, as from the core.

    `chain` contains the rows of the sites in their order along the line; it is not empty.
    """
    k = len(chain)
    ridges = np.arange(k - 1, dtype=np.int32)
    region = np.full(len(points), -1, dtype=np.int32)
    region[chain] = np.arange(k)
    along = _directions(points[chain[:-1]], points[chain[1:]])
    up = np.column_stack((-along[:, 1], along[:, 0]))
    # Each cell has the ridge to the site after it, then that to the site before it.
    entries = np.repeat(np.arange(k, dtype=np.int32), 2) - np.tile([0, 1], k).astype(np.int32)
    kept = (entries >= 0) & (entries < k - 1)
    counts = kept.reshape(k, 2).sum(axis=1)
    return Diagram2(
        vertices=np.empty((0, 2)),
        simplex_vertex=np.empty(0, dtype=np.int32),
        sites=np.column_stack((chain[:-1], chain[1:])).astype(np.int32),
        ends=~np.column_stack((2 * ridges, 2 * ridges + 1)),
        rays=np.stack((-up, up), axis=1).reshape(-1, 2) + 0.0,
        beyond=np.full((2 * (k - 1), 2), np.nan),
        region=region,
        site=chain.astype(np.int32),
        region_starts=np.concatenate(([0], np.cumsum(counts))).astype(np.int32),
        region_vertices=np.full(2 * (k - 1), -1, dtype=np.int32),
        region_ridges=entries[kept],
    )


def _directions(a: Floats, b: Floats) -> Floats:
    """Return vectors from a to b, which differ, normalized to length 1."""
    with np.errstate(over="ignore"):
        vector = b - a
    overflown = ~np.isfinite(vector).all(axis=1)
    vector[overflown] = b[overflown] / 2 - a[overflown] / 2
    share = vector / np.abs(vector).max(axis=1, initial=0.0)[:, None]
    unit: Floats = share / np.hypot(*share.T)[:, None]
    # A direction that is not along an axis must not be rounded to one.
    lost = (unit == 0) & (vector != 0)
    unit[lost] = np.copysign(5e-324, vector[lost])
    return unit


def foot(a: Floats, b: Floats, weights: Floats | None = None) -> Floats:
    """Return where bisectors intersect the lines through their sites, (k, 2); `weights` is (k, 2).

    If that is beyond the range of doubles, return the point of the bisector nearest to the origin
    of the plane, or infinity if that is also beyond the range. Sites differ in each row.
    """
    with np.errstate(all="ignore"):
        total = a + b
        found: Floats = np.where(np.isfinite(total), total / 2, a / 2 + b / 2)
        if weights is None:
            return found
        along = b - a
        square = (along * along).sum(axis=1)
        share = (weights[:, 0] - weights[:, 1]) / square / 2
        found += np.where(share[:, None] == 0, 0.0, along * share[:, None])
        safe = (square > _SMALLEST) & (square < _LARGEST) & np.isfinite(found).all(axis=1)
    for row in np.flatnonzero(~safe & (weights[:, 0] != weights[:, 1])).tolist():
        found[row] = _exact_foot(a[row].tolist(), b[row].tolist(), *weights[row].tolist())
    return found


def _exact_foot(a: list[float], b: list[float], u: float, v: float) -> list[float]:
    """Return the same in fractions; beyond the range, the point of the bisector nearest to 0."""
    p, q = [Fraction(x) for x in a], [Fraction(x) for x in b]
    d = [y - x for x, y in zip(p, q, strict=True)]
    square = d[0] * d[0] + d[1] * d[1]
    weight = Fraction(u) - Fraction(v)
    right = sum(y * y - x * x for x, y in zip(p, q, strict=True)) + weight
    try:
        share = weight / square / 2
        return [float((p[k] + q[k]) / 2 + d[k] * share) for k in range(2)]
    except OverflowError:
        share = right / square / 2
    try:
        return [float(d[k] * share) for k in range(2)]
    except OverflowError:
        return [np.inf, np.inf]
