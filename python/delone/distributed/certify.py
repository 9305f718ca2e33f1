"""Which triangles are certain, and whom the others are to be asked of.

A triangle of what a tile knows is one of the whole set where no point at all is in conflict with
it: inside its circle, or on it where the tie goes that way. Points of other tiles that a tile does
not know lie outside of its box, so a closed circumdisk in the box, rounded outward by the core, is
proof. Every other disk is put to the tiles whose points it may meet beyond the box.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.distributed.tiles import Tiles

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Numbers = NDArray[np.int64]

__all__ = ["Known", "Questions", "corners_of"]

# Triangles at a time: their disks stay in the cache.
_BLOCK = 1 << 16


@dataclass(frozen=True, eq=False)
class Questions:
    """Triangles that other tiles must be asked about: pairs of a triangle and a tile."""

    triangle: Numbers
    tile: Numbers


@dataclass(frozen=True, eq=False)
class Known:
    """What one tile knows of where points are.

    Parameters
    ----------
    tile : int
        The tile, all of whose points are known.
    box : ndarray of float64, shape (4,)
        Left, bottom, right and top of a closed box in which all points of all tiles are known;
        infinite where there are no points beyond.
    tiles : Tiles
        The cells.
    extents : ndarray of float64, shape (tiles, 4)
        The box of the points of each tile, inside out where it has none.
    """

    tile: int
    box: Floats
    tiles: Tiles
    extents: Floats

    def certain(self, points: Floats, simplices: Indices, *, threads: int = 1) -> Bools:
        """Return which triangles have their disks in the box."""
        left, bottom, right, top = self.box
        found = np.empty(len(simplices), dtype=bool)

        def look(start: int) -> None:
            some = slice(start, start + _BLOCK)
            x, y, r = _core.disks2(points, simplices[some]).T
            found[some] = (x - r >= left) & (x + r <= right) & (y - r >= bottom) & (y + r <= top)

        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(look, range(0, len(simplices), _BLOCK)))
        return found

    def questions(self, points: Floats, simplices: Indices) -> Questions:
        """Return all pairs of a triangle and another tile whose points its disk may meet.

        What lies in the box is left out: there all points are known.
        """
        disks = _core.disks2(points, simplices)
        low, high = disks[:, :2] - disks[:, 2:], disks[:, :2] + disks[:, 2:]
        triangle, tile = self.tiles.overlaps(low, high)
        other = tile != self.tile
        triangle, tile = triangle[other], tile[other]
        extent = self.extents[tile]
        # What a disk and a tile have in common lies in the box that their boxes have in common.
        left = np.maximum(low[triangle], extent[:, :2])
        right = np.minimum(high[triangle], extent[:, 2:])
        meets = (left <= right).all(axis=1) & self._reaches(disks[triangle], extent)
        known = (left >= self.box[:2]).all(axis=1) & (right <= self.box[2:]).all(axis=1)
        asked = meets & ~known
        return Questions(triangle[asked], tile[asked])

    @staticmethod
    def _reaches(disks: Floats, extent: Floats) -> Bools:
        """Whether a disk may meet a box: yes, where rounding leaves a doubt."""
        center, radius = disks[:, :2], disks[:, 2]
        with np.errstate(over="ignore"):
            off = np.maximum(np.maximum(extent[:, :2] - center, center - extent[:, 2:]), 0.0)
            squared = (off * off).sum(axis=1)
            answer: Bools = ~(squared * (1 - 1e-14) > radius * radius)
        return answer


def corners_of(points: Floats, simplices: Indices) -> Floats:
    """Return the coordinates of corners, (n, 6)."""
    return np.ascontiguousarray(points[simplices].reshape(-1, 6))
