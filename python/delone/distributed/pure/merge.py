"""The open region of a tile, and how answers of other tiles close it.

After the first triangulation, most of a tile is certain and never processed again. The rest is a
region bounded by certain edges and by the hull. `Border` holds its vertices and those edges. New
points lie in the region, so a triangulation of its vertices and the new points contains the
bounding edges, and between them the same triangles as one of all points that the tile knows. An
insertion therefore costs time proportional to the length of the border, however many points the
tile has.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone.distributed.pure.certify import corners_of
from delone.distributed.pure.rows import coordinates
from delone.errors import InternalError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.distributed.pure.certify import Known
    from delone.distributed.pure.rows import Rows

__all__ = ["Border", "advance", "belongs", "cut_out"]


@dataclass(frozen=True, eq=False)
class Border:
    """The open region of a tile: its vertices with their tiles, and the certain edges around it.

    The edges, (k, 2), are pairs of vertices with the region on their left.
    """

    rows: Rows
    owner: Indices
    edges: Indices


def belongs(simplices: Indices, owner: Indices, tile: int) -> Bools:
    """Return which triangles belong to a tile: the one with the lowest number at their corners."""
    a, b, c = (owner[simplices[:, k]] for k in range(3))
    mine: Bools = np.minimum(np.minimum(a, b), c) == tile
    return mine


def cut_out(
    rows: Rows, owner: Indices, simplices: Indices, neighbors: Indices, certain: Bools
) -> Border:
    """Return the uncertain triangles: their vertices, and their edges to certain triangles."""
    left = np.flatnonzero(~certain)
    some, beside = simplices[left], neighbors[left]
    t, k = np.nonzero((beside >= 0) & certain[beside])
    edges = np.stack([some[t, (k + 1) % 3], some[t, (k + 2) % 3]], axis=1)
    vertices = np.unique(some)
    return Border(
        rows[vertices], owner[vertices], np.searchsorted(vertices, edges).astype(np.int32)
    )


def advance(
    border: Border, known: Known, news: Rows, partial: Sequence[int]
) -> tuple[Border | None, Rows, Indices, Floats, NDArray[np.int64]]:
    """Insert `news`, the answers to all queries about a border, each point once.

    Return the region that is still open, or None; vertices, and triangles of them, (k, 3), that
    have become certain and have a vertex of the tile; corners, (m, 6), and tiles, (m,), of the next
    queries.
    """
    rows = np.concatenate([border.rows, news])
    owner = np.concatenate([border.owner, known.tiles.locate(coordinates(news))])
    points = coordinates(rows)
    made = _core.triangulate2(points, "auto", 1)
    simplices, neighbors = made.simplices, made.neighbors
    if len(made.duplicates):
        raise InternalError("two vertices of a border are the same point")
    inside = _within(simplices, neighbors, border.edges)
    # A triangle without a new corner existed before, no answer refuted it, and it is certain.
    # Points in conflict with one that has a new corner were in conflict with a queried triangle:
    # only the `partial` tiles, which returned some of their points, are queried again.
    certain = inside & (owner[simplices] == known.tile).any(axis=1)
    fresh = (simplices >= len(border.rows)).any(axis=1)
    triangle, tile = known.questions(points, simplices, np.flatnonzero(certain & fresh), partial)
    certain[triangle] = False
    left = None
    if len(triangle):
        # Everything beyond the bounding edges is certain as well.
        left = cut_out(rows, owner, simplices, neighbors, certain | ~inside)
    return left, rows, simplices[certain], corners_of(points, simplices[triangle]), tile


def _within(simplices: Indices, neighbors: Indices, edges: Indices) -> Bools:
    """Which triangles lie in the region left of its bounding edges; all if there are none."""
    if not len(edges):
        return np.ones(len(simplices), dtype=bool)
    sides = np.stack([np.roll(simplices, -1, axis=1), np.roll(simplices, -2, axis=1)], axis=2)
    n = np.int64(simplices.max()) + 1
    key = sides[..., 0] * n + sides[..., 1]
    mine = np.isin(key, edges[:, 0] * n + edges[:, 1])
    if np.count_nonzero(mine) != len(edges):
        raise InternalError("a certain edge is missing from a border")
    beyond = np.isin(key, edges[:, 1] * n + edges[:, 0])
    label = _core.components2(neighbors, np.ascontiguousarray(mine | beyond))
    return np.isin(label, label[mine.any(axis=1)])
