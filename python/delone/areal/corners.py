"""Rings that cross themselves at a corner: two pairs of sides meet there and alternate around it.

Sides that cross elsewhere are found by the core. Rings may touch themselves at corners: then one of
the pairs is between the sides of the other one, or they share a side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows

__all__ = ["crossing_at_corners"]

# Rings of at most this many sides cross themselves at no corner.
_FEW = 4


def crossing_at_corners(arrays: tuple[Floats, Rows, Rows, Bools]) -> Rows:
    """Return the cells that have a ring that crosses itself at one of its corners, exactly.

    `arrays` are the corners in the plane or as directions, where the corners of each ring start,
    where the rings of each cell start, and which rings are holes.
    """
    places, ends, cells, _ = arrays
    ring = np.repeat(np.arange(len(ends) - 1), np.diff(ends))
    rows = np.flatnonzero(np.diff(ends)[ring] > _FEW)
    if not len(rows):
        return np.zeros(0, dtype=np.int64)
    # Equal corners of a ring that do not follow each other are candidates.
    order = rows[np.lexsort((*places[rows].T, ring[rows]))]
    same = (ring[order[1:]] == ring[order[:-1]]) & (places[order[1:]] == places[order[:-1]]).all(1)
    if not same.any():
        return np.zeros(0, dtype=np.int64)
    found = []
    repeated = np.unique(ring[order[1:]][same])
    number = np.searchsorted(cells, repeated, side="right") - 1
    for one, cell in zip(repeated.tolist(), number.tolist(), strict=True):
        if _crosses_itself(places[ends[one] : ends[one + 1]]):
            found.append(cell)
    return np.unique(np.array(found, dtype=np.int64))


def _crosses_itself(ring: Floats) -> bool:
    """Return whether the sides at two equal corners of a ring alternate."""
    ring = ring[(ring != np.roll(ring, 1, axis=0)).any(axis=1)]
    count = len(ring)
    _, label, size = np.unique(ring, axis=0, return_inverse=True, return_counts=True)
    label = label.reshape(-1)
    # All pairs of equal corners.
    pairs = [
        (i, j)
        for k in np.flatnonzero(size > 1)
        for rows in (np.flatnonzero(label == k).tolist(),)
        for n, i in enumerate(rows)
        for j in rows[n + 1 :]
    ]
    if not pairs:
        return False
    first, second = np.array(pairs).T
    corner = ring[first]
    before, after = ring[first - 1], ring[(first + 1) % count]
    ends = ring[second - 1], ring[(second + 1) % count]
    inside = [_between(corner, before, after, end) for end in ends]
    return bool((inside[0] * inside[1] < 0).any())


def _between(corner: Floats, p: Floats, q: Floats, x: Floats) -> NDArray[np.int8]:
    """Return 1 where x is seen between p and q, counterclockwise, -1 where not, 0 on the sides."""
    to_p, to_q, turn = (_turn(corner, *two) for two in ((p, x), (x, q), (p, q)))
    # On a side, or in its direction.
    on_p = (to_p == 0) & (((p - corner) * (x - corner)).sum(axis=1) > 0)
    on_q = (to_q == 0) & (((q - corner) * (x - corner)).sum(axis=1) > 0)
    small = (to_p > 0) & (to_q > 0)
    # Not between q and p.
    large = ~((to_q < 0) & (to_p < 0))
    # Both sides on a line through the corner: a half plane, or no angle at all.
    straight = ((p - corner) * (q - corner)).sum(axis=1) < 0
    inside = np.where(turn > 0, small, np.where(turn < 0, large, to_p > 0))
    found = np.where(inside, np.int8(1), np.int8(-1))
    found[on_p | on_q | ((turn == 0) & ~straight)] = 0
    return found


def _turn(corner: Floats, p: Floats, q: Floats) -> NDArray[np.int8]:
    """Return the exact sign of the turn from p to q around a corner."""
    corner, p, q = (np.ascontiguousarray(each) for each in (corner, p, q))
    if corner.shape[1] == 2:
        return _core.orient2d(corner, p, q)
    # Around the direction of the corner, seen from outside of the sphere.
    return -_core.orient3d(corner, p, q, np.zeros_like(corner))
