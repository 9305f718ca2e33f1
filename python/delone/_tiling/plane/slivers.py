"""Triangles that are thinner than the resolution of coordinates, and those at an outline.

Points along a straight line that is not parallel to an axis lie on it only up to rounding, so a
hull has triangles there whose height is a few units in the last place. Their sides join points that
are far apart and skip those between them: nothing that is derived from them describes the data.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._tiling import measures

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices

    Rows = NDArray[np.intp]

__all__ = ["at_outline", "shapes", "without"]

# A triangle is thin if its height is below this many units in the last place of its coordinates,
# and below this fraction of its longest side. It is straight if the sine of its largest angle is
# small.
_UNITS = 16
_SHARE = 2.0**-20
_BENT = 2.0**-16
# Areas below it may have lost digits to underflow.
_LEAST = 1e-290


class Shapes(NamedTuple):
    """Which triangles are thin."""

    thin: Bools
    # Thin, and the middle corner is on the line of the others up to rounding.
    straight: Bools
    # The corner opposite the longest side.
    longest: Rows


def shapes(points: Floats, simplices: Indices) -> Shapes:
    """Return which triangles are thin.

    Triangles whose area no double can represent relative to the largest coordinates are not thin.
    """
    corners = points[simplices]
    # Units of the largest coordinate, without rounding: nothing overflows.
    corners = np.ldexp(corners, -int(np.frexp(np.abs(corners).max(initial=0.0))[1]))
    sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    lengths = np.hypot(sides[..., 0], sides[..., 1])
    short, middle, most = np.sort(lengths, axis=1).T
    rows = np.arange(3 * len(simplices), dtype=np.int32).reshape(-1, 3)
    twice = 2 * measures.sizes(corners.reshape(-1, 2), rows)
    unit = np.spacing(np.abs(corners).max(axis=(1, 2), initial=0.0))
    thin = (twice <= _UNITS * unit * most) & (twice < _SHARE * most**2) & (twice > _LEAST)
    return Shapes(thin, thin & (twice < _BENT * short * middle), lengths.argmax(axis=1))


def at_outline(points: Floats, simplices: Indices, neighbors: Indices) -> Bools:
    """Return the straight triangles that can be left out one by one at the outline.

    Each has its longest side at the outline once those before it are left out. Triangles at a
    corner are kept if all triangles of the corner would be left out.
    """
    dropped = np.zeros(len(simplices), dtype=bool)
    front = np.flatnonzero((neighbors < 0).any(axis=1))
    # Each round leaves out at least one triangle.
    while len(front):
        _, straight, longest = shapes(points, simplices[front])
        across = neighbors[front, longest]
        now = front[straight & ((across < 0) | dropped[across])]
        if not len(now):
            break
        dropped[now] = True
        behind = np.unique(neighbors[now])
        front = behind[(behind >= 0) & ~dropped[behind]].astype(np.intp)
    if dropped.any():
        alone = np.ones(len(points), dtype=bool)
        alone[simplices[~dropped]] = False
        dropped[alone[simplices].any(axis=1)] = False
    return dropped


def without(simplices: Indices, neighbors: Indices, dropped: Bools) -> tuple[Indices, Indices]:
    """Return the triangles that are not dropped, and their neighbors."""
    number = np.full(len(dropped) + 1, -1, dtype=np.int32)
    number[:-1][~dropped] = np.arange(np.count_nonzero(~dropped), dtype=np.int32)
    kept = np.ascontiguousarray(simplices[~dropped])
    return kept, np.ascontiguousarray(number[neighbors[~dropped]])
