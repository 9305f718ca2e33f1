"""Triangles that are thinner than the resolution of coordinates, where contours cannot be drawn.

Points along a straight line that is not parallel to an axis lie on it up to rounding only, so a
hull has triangles there whose height is a few units in the last place. Contours in them run along
the outline, and rounded, they may cross. If that happens, such triangles at the outline are left
out, the outermost first, and counted: the outline then passes through their inner corners. In
others, points of contours are united, or contours pass at corners.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone.plane import geometry

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone.terrain.surface import Sheet

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["drawn"]

# A triangle is thin if its height is below so many units in the last place of its coordinates, and
# below such a share of its longest side. This decides how it is drawn, not whether: otherwise,
# contours that would cross are united, or pass at corners.
_UNITS = 16
_SHARE = 2.0**-20


class _Part(NamedTuple):
    """Some triangles of a surface, with all its points."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    heights: Floats


def drawn(compute: Callable[[Sheet, Bools, bool], Any], sheet: Sheet) -> tuple[Any, int]:
    """Compute contours or bands, and return the number of triangles that are left out for them."""
    collapsed = np.zeros(len(sheet.simplices), dtype=bool)
    left_out, far = 0, False
    # Each round leaves out or collapses at least one triangle, or is the first that unites points
    # that are far apart. If all are collapsed, contours follow edges.
    while True:
        made = compute(sheet, collapsed, far)
        if not len(made.tangled):
            return made, left_out
        outer = _at_the_outline(sheet, made.tangled)
        if outer.any():
            left_out += int(outer.sum())
            sheet, collapsed = _without(sheet, outer), collapsed[~outer]
        elif not far:
            far = True
        else:
            collapsed[made.tangled] = True


def _at_the_outline(sheet: Sheet, tangled: Indices) -> Bools:
    """Return thin triangles that can be left out one by one at the outline, near given ones."""
    simplices, neighbors = sheet.simplices, sheet.neighbors
    thin, longest = _thin(sheet)
    # Thin triangles beside each other, and which of these groups have one in which contours cross.
    beyond = thin[neighbors] & (neighbors >= 0)
    group = _core.components2(neighbors, ~(beyond & thin[:, None]))
    wanted = np.zeros(int(group.max(initial=-1)) + 1, dtype=bool)
    wanted[group[tangled]] = True
    candidates = np.flatnonzero(thin & wanted[group])
    outer = np.zeros(len(simplices), dtype=bool)
    # A triangle is at the outline if nothing is left beyond its longest side.
    across = neighbors[candidates, longest[candidates]]
    while len(candidates):
        free = (across < 0) | outer[across]
        if not free.any():
            break
        outer[candidates[free]] = True
        candidates, across = candidates[~free], across[~free]
    return outer


def _thin(sheet: Sheet) -> tuple[Bools, NDArray[np.intp]]:
    """Return which triangles are thin, and the corner opposite the longest side of each."""
    points, simplices = sheet.points, sheet.simplices
    corners = points[simplices]
    with np.errstate(over="ignore", invalid="ignore"):
        sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
        lengths = np.hypot(sides[..., 0], sides[..., 1])
        longest = lengths.argmax(axis=1)
        most = lengths.max(axis=1)
        height = 2 * geometry.areas(points, simplices) / most
        unit = np.spacing(np.abs(corners).max(axis=(1, 2)))
        thin: Bools = (height <= _UNITS * unit) & (height < _SHARE * most)
    return thin, longest


def _without(sheet: Sheet, dropped: Bools) -> Sheet:
    """Return a surface without some of its triangles."""
    number = np.full(len(dropped) + 1, -1, dtype=np.int32)
    number[:-1][~dropped] = np.arange(np.count_nonzero(~dropped), dtype=np.int32)
    return _Part(
        sheet.points,
        np.ascontiguousarray(sheet.simplices[~dropped]),
        np.ascontiguousarray(number[sheet.neighbors[~dropped]]),
        sheet.heights,
    )
