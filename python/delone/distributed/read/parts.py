"""Some triangles of all tiles, as one mesh in memory.

A triangle has the same number in all tiles, and a vertex is identified by its row in the source, so
tiles need not be aligned: common parts have the same numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._tiling.plane import topology
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import InternalError
from delone.terrain.building import Built
from delone.terrain.tin import TIN

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.distributed.read.folder import TileFolder
    from delone.distributed.read.tile import Tile

__all__ = [
    "Patch",
    "Piece",
    "Sheet",
    "gathered",
    "heights_of",
    "joined",
    "piece_of",
    "sheet_of",
    "surface_of",
]


class Sheet(NamedTuple):
    """What the core needs of a surface."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    heights: Floats


class Patch(NamedTuple):
    """Triangles of several tiles."""

    points: Floats
    z: Floats
    simplices: Indices  # as rows of `points`
    numbers: Rows  # of the triangles in all tiles

    def sheet(self) -> Sheet:
        """Return the arrays for the core."""
        beyond = topology.neighbors(self.simplices, len(self.points))
        return Sheet(self.points, self.simplices, beyond, self.z)


def heights_of(tile: Tile, value: str) -> Floats:
    """Return the values of the vertices of a tile."""
    return np.ascontiguousarray(tile.attributes[value], dtype=np.float64)


def sheet_of(tile: Tile, value: str) -> Sheet:
    """Return the surface of a tile."""
    simplices = np.ascontiguousarray(tile.simplices)
    beyond = topology.neighbors(simplices, len(tile.points))
    return Sheet(np.ascontiguousarray(tile.points), simplices, beyond, heights_of(tile, value))


class Piece(NamedTuple):
    """Triangles of one tile, by the rows of their corners in the source."""

    ids: Rows  # of the corners, each once
    places: Floats  # (n, 3), with heights
    corners: Rows  # (m, 3)
    numbers: Rows  # of the triangles in all tiles


def piece_of(tin: TileFolder, tile: Tile, value: str, chosen: Bools) -> Piece:
    """Return some triangles of a tile."""
    some = np.flatnonzero(chosen)
    found = tile.simplices[some]
    used = np.unique(found)
    places = np.column_stack((tile.points[used], heights_of(tile, value)[used]))
    return Piece(tile.ids[used], places, tile.ids[found], tin.starts[tile.number] + some)


def joined(pieces: Iterable[Piece]) -> Patch:
    """Return the triangles of pieces as one mesh."""
    none = np.empty(0, dtype=np.int64)
    nothing = Piece(none, np.empty((0, 3)), none.reshape(0, 3), none)
    ids, places, corners, numbers = map(np.concatenate, zip(nothing, *pieces, strict=True))
    rows, first = np.unique(ids, return_index=True)
    at = places[first]
    simplices = np.searchsorted(rows, corners).astype(np.int32)
    return Patch(np.ascontiguousarray(at[:, :2]), at[:, 2].copy(), simplices, numbers)


def gathered(
    tin: TileFolder, value: str, tiles: Iterable[int], choose: Callable[[Tile], Bools]
) -> Patch:
    """Return the triangles of some tiles that `choose` accepts."""
    read = (tin.tile(number) for number in tiles)
    return joined([piece_of(tin, tile, value, choose(tile)) for tile in read])


def surface_of(patch: Patch, crs: str | None) -> TIN:
    """Return a TIN of the triangles.

    Each of them is also a triangle of the Delaunay triangulation of their corners: no point is in
    its circumcircle, and of points on it the first one in lexicographic order is among its corners.
    """
    none = np.empty((0, 2), dtype=np.int32)
    mesh = ConstrainedDelaunay(patch.points, none, planar=True)
    kept = topology.triangles_among(mesh.simplices, patch.simplices)
    if np.count_nonzero(kept) != len(patch.simplices):
        raise InternalError("triangles of tiles are not those of their corners")
    soft = np.empty(0, dtype=bool)
    made = Built(mesh.points, patch.z, mesh.simplices, mesh.neighbors, kept, none, soft, crs, None)
    return TIN._built(made, None)
