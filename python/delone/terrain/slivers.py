"""Triangles that are thinner than the resolution of coordinates, where contours cannot be drawn.

Contours in them run along the outline, and rounded, they may cross. If that happens, such triangles
at the outline are left out, the outermost first, and counted: the outline then passes through their
inner corners. In other triangles, points of contours are merged, or contours pass through corners.
How thin a triangle is determines how contours are computed, not whether.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._tiling.plane import slivers

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone._base.types import Bools, Floats, Indices
    from delone.terrain.surface import Sheet

__all__ = ["at_the_outline", "drawn"]


class _Part(NamedTuple):
    """Some triangles of a surface, with all its points."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    heights: Floats


def drawn(compute: Callable[[Sheet, Bools, bool], Any], sheet: Sheet) -> tuple[Any, Sheet, int]:
    """Compute contours or bands.

    Also return the surface without the triangles that are left out, and their number.
    """
    collapsed = np.zeros(len(sheet.simplices), dtype=bool)
    left_out, far = 0, False
    # Each round leaves out or collapses at least one triangle, or is the first to merge points that
    # are far apart. If all are collapsed, contours follow edges.
    while True:
        made = compute(sheet, collapsed, far)
        if not len(made.tangled):
            return made, sheet, left_out
        outer = at_the_outline(sheet, made.tangled)
        if outer.any():
            left_out += int(outer.sum())
            sheet, collapsed = _without(sheet, outer), collapsed[~outer]
        elif not far:
            far = True
        else:
            collapsed[made.tangled] = True


def at_the_outline(sheet: Sheet, tangled: Indices) -> Bools:
    """Return thin triangles that can be left out one by one at the outline, near given ones."""
    simplices, neighbors = sheet.simplices, sheet.neighbors
    thin, _, longest = slivers.shapes(sheet.points, simplices)
    # Groups of adjacent thin triangles, and which groups have one in which contours cross.
    beyond = thin[neighbors] & (neighbors >= 0)
    group = _core.components2(neighbors, ~(beyond & thin[:, None]))
    wanted = np.zeros(int(group.max(initial=-1)) + 1, dtype=bool)
    wanted[group[tangled]] = True
    candidates = np.flatnonzero(thin & wanted[group])
    outer = np.zeros(len(simplices), dtype=bool)
    # A triangle is at the outline if no triangle is left beyond its longest side.
    across = neighbors[candidates, longest[candidates]]
    while len(candidates):
        free = (across < 0) | outer[across]
        if not free.any():
            break
        outer[candidates[free]] = True
        candidates, across = candidates[~free], across[~free]
    return outer


def _without(sheet: Sheet, dropped: Bools) -> Sheet:
    """Return a surface without some of its triangles."""
    simplices, neighbors = slivers.without(sheet.simplices, sheet.neighbors, dropped)
    return _Part(sheet.points, simplices, neighbors, sheet.heights)
