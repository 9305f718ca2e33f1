"""One surface of simplified tiles, which are joined along their borders.

Only points and edges at borders are compared, so memory is that of the pieces and of the result.
The tiles on both sides of a cut have the same edges along it, and these edges block visibility
across the cut. So the constrained Delaunay triangulations of all tiles together are that of all
points with these edges. Where a cut ends at a slanted side of the hull, its rounded end may be
inside the hull. The triangles between such ends and the hull are added, but they are not part of
the surface.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._tiling.plane import topology
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import InternalError
from delone.terrain.building import Built
from delone.terrain.simplifying import inside_of

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices, Rows

__all__ = ["Piece", "assembled"]


class Piece(NamedTuple):
    """The simplified surface of a tile. Each point is a corner of a triangle."""

    points: Floats  # (n, 3)
    simplices: Indices
    neighbors: Indices


class _Sides(NamedTuple):
    """Edges with a triangle on their left and none on their right."""

    triangle: Rows
    corner: Rows  # opposite the edge
    tail: Indices
    head: Indices

    def only(self, rows: Rows) -> _Sides:
        """Return some of them."""
        return _Sides(self.triangle[rows], self.corner[rows], self.tail[rows], self.head[rows])


def assembled(pieces: list[Piece], crs: str | None) -> Built:
    """Return the surface of all pieces, which are taken from the list to free their memory."""
    numbers = _numbers(pieces)
    count = sum(len(piece.simplices) for piece in pieces)
    points = np.empty((1 + max((int(each.max()) for each in numbers if len(each)), default=-1), 2))
    z = np.empty(len(points))
    simplices, neighbors = (np.empty((count, 3), dtype=np.int32) for _ in range(2))
    end = 0
    while pieces:  # each round takes one
        piece, number = pieces.pop(), numbers.pop()
        start, end = end, end + len(piece.simplices)
        points[number], z[number] = piece.points[:, :2], piece.points[:, 2]
        simplices[start:end] = number[piece.simplices]
        neighbors[start:end] = np.where(piece.neighbors < 0, -1, piece.neighbors + start)
    shared, outline = _linked(neighbors, _sides(simplices, neighbors), len(points))
    outer = _beyond(points, outline)
    kept = np.arange(count + len(outer)) < count
    if len(outer):
        simplices = np.concatenate((simplices, outer))
        inside = topology.neighbors(outer, len(points))
        neighbors = np.concatenate((neighbors, np.where(inside < 0, -1, inside + count)))
        neighbors = neighbors.astype(np.int32)
        more, _ = _linked(neighbors, _sides(simplices, neighbors), len(points))
        shared = np.concatenate((shared, more))
    segments = np.unique(np.sort(shared, axis=1), axis=0).astype(np.int32)
    soft = np.ones(len(segments), dtype=bool)
    return Built(points, z, simplices, neighbors, kept, segments, soft, crs, None)


def _numbers(pieces: list[Piece]) -> list[Rows]:
    """Return the row of each point of each piece in the result: points at borders occur once."""
    rims = [_rim(piece) for piece in pieces]
    places = [piece.points[rim, :2] for piece, rim in zip(pieces, rims, strict=True)]
    _, first, same = np.unique(
        np.concatenate([np.empty((0, 2)), *places]), axis=0, return_index=True, return_inverse=True
    )
    same = same.ravel()
    heights = np.concatenate(
        [np.empty(0), *(piece.points[rim, 2] for piece, rim in zip(pieces, rims, strict=True))]
    )
    if (heights != heights[first][same]).any():
        raise InternalError("simplified tiles have different heights at their borders")
    row_of = np.empty(len(first), dtype=np.int64)
    found, taken, at = [], 0, 0
    for piece, rim in zip(pieces, rims, strict=True):
        place = same[at : at + len(rim)]
        earlier = first[place] < at
        new = np.ones(len(piece.points), dtype=bool)
        new[rim[earlier]] = False
        number = taken - 1 + np.cumsum(new)
        row_of[place[~earlier]] = number[rim[~earlier]]
        number[rim] = row_of[place]
        found.append(number)
        taken, at = taken + int(new.sum()), at + len(rim)
    return found


def _rim(piece: Piece) -> Rows:
    """Return the points at the border of a piece."""
    return np.unique(topology.boundary_edges(piece.simplices, piece.neighbors))


def _sides(simplices: Indices, neighbors: Indices) -> _Sides:
    """Return the edges without a triangle on their right."""
    triangle, corner = np.nonzero(neighbors < 0)
    return _Sides(triangle, corner, *topology.half_edges(simplices, triangle, corner))


def _linked(neighbors: Indices, sides: _Sides, npoints: int) -> tuple[Indices, _Sides]:
    """Make triangles with a common edge neighbors; return these edges, and the other sides."""
    keys = topology.edge_keys(sides.tail, sides.head, npoints)
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order[1:]] == keys[order[:-1]])
    one, other = sides.only(order[same]), sides.only(order[same + 1])
    if (np.diff(same) == 1).any() or (one.tail != other.head).any():
        raise InternalError("simplified tiles overlap at their borders")
    neighbors[one.triangle, one.corner] = other.triangle
    neighbors[other.triangle, other.corner] = one.triangle
    alone = np.ones(len(keys), dtype=bool)
    alone[order[same]] = alone[order[same + 1]] = False
    return np.column_stack((one.tail, one.head)), sides.only(np.flatnonzero(alone))


def _beyond(points: Floats, outline: _Sides) -> Indices:
    """Return the triangles between the outline and the hull of its points."""
    edges = np.column_stack((outline.tail, outline.head)).astype(np.int32)
    rows = np.unique(edges)
    if not len(rows):
        return np.empty((0, 3), dtype=np.int32)
    if len(np.unique(outline.tail)) < len(edges) or (
        len(topology.boundary_next(edges, int(edges[0, 0]))) < len(edges)
    ):
        raise InternalError("the borders of simplified tiles differ")
    local = np.searchsorted(rows, edges).astype(np.int32)
    mesh = ConstrainedDelaunay(points[rows], local, planar=True)
    return rows[mesh.simplices[~inside_of(mesh, local)]].astype(np.int32)
