"""What of a tile is still open, and how answers of other tiles close it.

After its first triangulation most of a tile is certain and never looked at again. The rest is a
region bounded by certain edges and by the hull. `Border` holds its vertices and those edges. New
points lie in the region, so that a triangulation of the region's vertices and of the new points
has the bounding edges, and between them the same triangles as one of all that the tile knows: what
is inserted costs as much as the border is long, however many points the tile has.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone.distributed.rows import coordinates, first_of_each
from delone.errors import InternalError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.distributed.certify import Known, Questions
    from delone.distributed.rows import Rows

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Border", "advance", "belongs", "cut_out"]


@dataclass(frozen=True, eq=False)
class Border:
    """The open region of a tile.

    Parameters
    ----------
    rows : ndarray of records, shape (n,)
        Its vertices.
    owner : ndarray of int32, shape (n,)
        The tile of each.
    edges : ndarray of int32, shape (k, 2)
        The certain edges that bound it, as vertices, with the region on their left.
    pending : ndarray of int32, shape (m, 3)
        The triangles that others have been asked about, as vertices.
    """

    rows: Rows
    owner: Indices
    edges: Indices
    pending: Indices


def belongs(simplices: Indices, owner: Indices, tile: int) -> Bools:
    """Return which triangles belong to a tile: the one with the lowest number at their corners."""
    a, b, c = (owner[simplices[:, k]] for k in range(3))
    mine: Bools = np.minimum(np.minimum(a, b), c) == tile
    return mine


def cut_out(simplices: Indices, neighbors: Indices, certain: Bools) -> tuple[Indices, Indices]:
    """Return the vertices of the triangles that are not certain, ascending, and their bounds.

    These are the edges against triangles that are certain, as positions among the vertices.
    """
    open_rows = np.flatnonzero(~certain)
    some, beside = simplices[open_rows], neighbors[open_rows]
    t, k = np.nonzero((beside >= 0) & certain[beside])
    edges = np.stack([some[t, (k + 1) % 3], some[t, (k + 2) % 3]], axis=1)
    vertices = np.unique(some)
    return vertices, np.searchsorted(vertices, edges).astype(np.int32)


def advance(
    border: Border, known: Known, news: Rows, refuted: Bools
) -> tuple[Border | None, Rows, Indices, Questions | None]:
    """Take in the answers to all questions about a border.

    Parameters
    ----------
    border : Border
        What was open.
    known : Known
        What the tile knew at first.
    news : ndarray of records
        The points in conflict that other tiles have told.
    refuted : ndarray of bool, shape (m,)
        Which of the pending triangles have points in conflict.

    Returns
    -------
    Border or None
        What is open now; None where nothing is.
    ndarray of records
        The vertices of the triangles that follow.
    ndarray of int32, shape (k, 3)
        Triangles that have become certain and have a vertex of the tile.
    Questions or None
        What to ask about the pending triangles of the new border.
    """
    kept = border.pending[~refuted]
    if not len(news):
        if refuted.any():
            raise InternalError("a triangle was refuted without a point")
        return None, border.rows, border.pending, None
    fresh = first_of_each(news)
    fresh = fresh[~np.isin(fresh["id"], border.rows["id"])]
    rows = np.concatenate([border.rows, fresh])
    owner = np.concatenate([border.owner, known.tiles.locate(coordinates(fresh))])
    points = coordinates(rows)
    simplices, neighbors, twins, _ = _core.triangulate2(points, "auto", 1)
    if len(twins):
        raise InternalError("two vertices of a border are the same point")
    inside = _within(simplices, neighbors, border.edges)
    needed = inside & (owner[simplices] == known.tile).any(axis=1)
    certain = needed & _among(simplices, kept)
    doubtful = np.flatnonzero(needed & ~certain)
    questions = known.questions(points, simplices[doubtful])
    asked = np.zeros(len(doubtful), dtype=bool)
    asked[questions.triangle] = True
    certain[doubtful[~asked]] = True
    found = simplices[certain]
    if not asked.any():
        return None, rows, found, None
    # What lies beyond the bounding edges is certain as well.
    vertices, edges = cut_out(simplices, neighbors, certain | ~inside)
    pending = np.searchsorted(vertices, simplices[doubtful[asked]]).astype(np.int32)
    left = Border(rows[vertices], owner[vertices], edges, pending)
    number = np.cumsum(asked) - 1
    return left, rows, found, _renumbered(questions, number)


def _renumbered(questions: Questions, number: NDArray[np.int64]) -> Questions:
    return type(questions)(number[questions.triangle], questions.tile)


def _within(simplices: Indices, neighbors: Indices, edges: Indices) -> Bools:
    """Which triangles lie in the region left of the edges that bound it; all without edges."""
    if not len(edges):
        return np.ones(len(simplices), dtype=bool)
    sides = np.stack([np.roll(simplices, -1, axis=1), np.roll(simplices, -2, axis=1)], axis=2)
    n = np.int64(simplices.max()) + 1
    key = sides[..., 0] * n + sides[..., 1]
    mine = np.isin(key, edges[:, 0] * n + edges[:, 1])
    if np.count_nonzero(mine) != len(edges):
        raise InternalError("a certain edge has gone from a border")
    beyond = np.isin(key, edges[:, 1] * n + edges[:, 0])
    label = _core.components2(neighbors, np.ascontiguousarray(mine | beyond))
    return np.isin(label, label[mine.any(axis=1)])


def _among(simplices: Indices, some: Indices) -> Bools:
    """Which triangles are among some others, wherever their corners begin."""
    if not len(some):
        return np.zeros(len(simplices), dtype=bool)
    both = np.sort(np.concatenate([some, simplices]), axis=1)
    number = np.unique(both, axis=0, return_inverse=True)[1].reshape(-1)
    return np.isin(number[len(some) :], number[: len(some)])
