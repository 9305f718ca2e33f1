"""Which triangles are certain, and whom the others are to be asked of.

A triangle of what a tile knows is one of the whole set where no point at all is in conflict with
it: inside its circle, or on it where the tie goes that way. Points of other tiles that a tile does
not know lie outside of its box, so a closed circumdisk in the box, rounded outward by the core, is
proof. Every other disk is put to the tiles whose points it may meet beyond the box.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from delone.distributed.pure.tiles import Tiles

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Numbers = NDArray[np.int64]

__all__ = ["Known", "corners_of"]


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
        The box of the points of each tile, inside out where it has none. Corners of the hull, which
        all tiles know, do not count.
    """

    tile: int
    box: Floats
    tiles: Tiles
    extents: Floats

    def certain(self, points: Floats, simplices: Indices, own: int, *, threads: int = 1) -> Bools:
        """Return which triangles have their corners among the first `own` points, and certainty.

        That is, their disks lie in the box.
        """
        left, bottom, right, top = self.box.tolist()
        return _core.within2(points, simplices, own, (left, bottom, right, top), threads)

    def questions(
        self, points: Floats, simplices: Indices, rows: Numbers, among: Sequence[int] | None = None
    ) -> tuple[Numbers, Numbers]:
        """Return all pairs of a row of `simplices` and another tile that it must be put to.

        These are the tiles, if need be among some, whose points its disk may meet. What lies in the
        box is left out: there all points are known.
        """
        disks = _core.disks2(points, simplices.take(rows, axis=0))
        low, high = disks[:, :2] - disks[:, 2:], disks[:, :2] + disks[:, 2:]
        triangle, tile = self.tiles.overlaps(low, high)
        other = tile != self.tile if among is None else np.isin(tile, among)
        triangle, tile = triangle[other], tile[other]
        extent = self.extents[tile]
        # What a disk and a tile have in common lies in the box that their boxes have in common.
        left = np.maximum(low[triangle], extent[:, :2])
        right = np.minimum(high[triangle], extent[:, 2:])
        meets = (left <= right).all(axis=1) & self._reaches(disks[triangle], extent)
        known = (left >= self.box[:2]).all(axis=1) & (right <= self.box[2:]).all(axis=1)
        asked = meets & ~known
        return rows[triangle[asked]], tile[asked]

    @staticmethod
    def _reaches(disks: Floats, extent: Floats) -> Bools:
        """Whether a disk may meet a box: yes, where rounding leaves a doubt."""
        center, radius = disks[:, :2], disks[:, 2]
        with np.errstate(over="ignore"):
            off = np.maximum(np.maximum(extent[:, :2] - center, center - extent[:, 2:]), 0.0)
            answer: Bools = ~(np.hypot(*off.T) * (1 - 1e-14) > radius)
        return answer


def corners_of(points: Floats, simplices: Indices) -> Floats:
    """Return the coordinates of corners, (n, 6)."""
    return np.ascontiguousarray(points[simplices].reshape(-1, 6))
