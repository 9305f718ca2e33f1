"""Tiles: the half-open cells of a k-d tree over a sample, and the initial halo of each.

A cell includes its lower sides and leaves its upper ones to its neighbors, so each point of the
plane lies in exactly one cell, and equal points are in the same tile. Cuts are coordinates of
sampled points (J. L. Bentley, "Multidimensional binary search trees", 1975); cells at the margin
extend to infinity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows

__all__ = ["HALO", "Tiles", "plant", "strips"]

# Points in the initial halo of a tile, in units of the square root of the number of its points.
# With half as many, there are several times as many triangles to query about; with twice as many,
# hardly fewer.
HALO = 11.0


@dataclass(frozen=True, eq=False)
class Tiles:
    """A k-d tree whose leaves are numbered tiles.

    Node i cuts `axis[i]` at `cut[i]`, points below it are on the left; `children`, (nodes, 2), are
    nodes or ``~tile``. `cells`, (tiles, 4), are left, bottom, right and top, infinite at the
    margin.
    """

    axis: NDArray[np.int8]
    cut: Floats
    children: Rows
    cells: Floats

    def __len__(self) -> int:
        return len(self.cells)

    def locate(self, points: Floats) -> NDArray[np.int32]:
        """Return the tile of each point, (n,)."""
        if not len(self.cut):
            return np.zeros(len(points), dtype=np.int32)
        tile = np.empty(len(points), dtype=np.int32)
        columns = points[:, 0].copy(), points[:, 1].copy()
        # A list of rows for each node, so that the points of a cell are processed together.
        open_nodes: list[tuple[int, Rows | None]] = [(0, None)]
        while open_nodes:
            node, rows = open_nodes.pop()
            column = columns[self.axis[node]]
            right = (column if rows is None else column.take(rows)) >= self.cut[node]
            for side, child in ((~right, self.children[node, 0]), (right, self.children[node, 1])):
                some = np.flatnonzero(side) if rows is None else rows.compress(side)
                if child < 0:
                    tile[some] = ~child
                elif len(some):
                    open_nodes.append((int(child), some))
        return tile

    def overlaps(self, low: Floats, high: Floats) -> tuple[Rows, Rows]:
        """Return all pairs of a closed box, (n, 2) and (n, 2), and a cell that it meets."""
        if not len(self.cut):
            return np.arange(len(low)), np.zeros(len(low), dtype=np.int64)
        box, node = np.arange(len(low)), np.zeros(len(low), dtype=np.int64)
        boxes, tiles = [box[:0]], [node[:0]]
        while len(box):
            axis, cut = self.axis[node], self.cut[node]
            left, right = ~(low[box, axis] >= cut), ~(high[box, axis] < cut)
            pair = np.concatenate([box[left], box[right]])
            child = np.concatenate([self.children[node[left], 0], self.children[node[right], 1]])
            leaf = child < 0
            boxes.append(pair[leaf])
            tiles.append(~child[leaf])
            box, node = pair[~leaf], child[~leaf]
        found_box, found_tile = np.concatenate(boxes), np.concatenate(tiles)
        order = np.lexsort((found_tile, found_box))
        return found_box[order], found_tile[order]


def plant(sample: Floats, tiles: int) -> Tiles:
    """Return a tree that splits the sample, (n, 2), into up to `tiles` parts of similar size.

    There are fewer if too few points of the sample are distinct.
    """
    axes: list[int] = []
    cuts: list[float] = []
    children: list[list[int]] = []
    cells: list[list[float]] = []

    def grow(points: Floats, count: int, cell: list[float]) -> int:
        place = _cut(points, count) if count > 1 else None
        if place is None:
            cells.append(cell)
            return ~(len(cells) - 1)
        axis, cut = place
        node = len(axes)
        axes.append(axis)
        cuts.append(cut)
        children.append([0, 0])
        right = points[:, axis] >= cut
        below, above = cell.copy(), cell.copy()
        below[2 + axis] = above[axis] = cut
        children[node][0] = grow(points[~right], count // 2, below)
        children[node][1] = grow(points[right], count - count // 2, above)
        return node

    grow(sample, tiles, [-math.inf, -math.inf, math.inf, math.inf])
    return Tiles(
        np.array(axes, dtype=np.int8),
        np.array(cuts, dtype=np.float64),
        np.array(children, dtype=np.int64).reshape(-1, 2),
        np.array(cells, dtype=np.float64),
    )


def _cut(points: Floats, count: int) -> tuple[int, float] | None:
    """Choose a cut: the longer axis first, near the middle, with points on both sides."""
    if not len(points):
        return None
    with np.errstate(over="ignore"):
        sides = points.max(axis=0) - points.min(axis=0)
    for axis in np.argsort(-sides, kind="stable").tolist():
        values = np.sort(points[:, axis])
        cut = values[len(values) * (count // 2) // count]
        if cut == values[0]:
            # Many equal coordinates: use the next larger one, if there is one.
            cut = values[min(np.searchsorted(values, cut, side="right"), len(values) - 1)]
        if cut > values[0]:
            return int(axis), float(cut)
    return None


# Beyond the range of doubles a strip is infinite, which is still correct.
@np.errstate(over="ignore")
def strips(tiles: Tiles, sample: Floats, count: int) -> Floats:
    """Return the box that each tile knows initially: its cell, and a strip along each side.

    A strip is as wide as the one inside the cell that contains one side's share of the halo,
    according to the sample of `count` points, but not so wide that it contains far more than that:
    the density on the other side of a cut may be much higher.
    """
    owner = tiles.locate(sample)
    order = np.argsort(owner, kind="stable")
    starts = np.searchsorted(owner[order], np.arange(len(tiles) + 1))
    by_tile = sample[order]
    share = len(sample) / max(count, 1)
    boxes = tiles.cells.copy()
    for tile, cell in enumerate(tiles.cells):
        own = by_tile[starts[tile] : starts[tile + 1]]
        wanted = max(1, math.ceil(HALO / 4 * math.sqrt(len(own) * share)))
        for side in range(4):
            axis, sign = side % 2, 1.0 if side >= 2 else -1.0
            if not math.isfinite(cell[side]) or not len(own):
                continue
            inside = np.sort(sign * (cell[side] - own[:, axis]))
            width = float(inside[min(wanted, len(inside)) - 1])
            outside = _beyond(tiles, by_tile, starts, cell, side, width)
            if len(outside) > 2 * wanted:
                width = float(np.partition(outside, 2 * wanted)[2 * wanted])
            boxes[tile, side] = cell[side] + sign * width
    return boxes


def _beyond(  # noqa: PLR0917
    tiles: Tiles, by_tile: Floats, starts: Rows, cell: Floats, side: int, width: float
) -> Floats:
    """Distances of sampled points beyond a side of a cell, within a strip of this width."""
    axis, high = side % 2, side >= 2
    box = cell.copy()
    box[side] = cell[side] + (width if high else -width)
    box[(side + 2) % 4] = cell[side]
    near = tiles.overlaps(box[None, :2], box[None, 2:])[1]
    points = np.concatenate([by_tile[starts[t] : starts[t + 1]] for t in near.tolist()])
    within = ((points >= box[:2]) & (points <= box[2:])).all(axis=1)
    distance = points[within, axis] - cell[side]
    found = distance if high else -distance
    return np.asarray(found[found > 0] if not high else found)
