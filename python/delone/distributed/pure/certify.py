"""Which triangles are certain, and which tiles to query about the others.

A triangle of the points that a tile knows belongs to the triangulation of the whole set if no point
of the set is in conflict with it: inside its circle, or on it if the tie is broken that way.
Unknown points of other tiles lie outside the box of the tile, so a closed circumdisk inside the
box, rounded outward by the core, is a proof. Every other disk is sent as a query to the tiles whose
points it may meet beyond the box.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.distributed.pure.tiles import Tiles

__all__ = ["Known", "corners_of"]


@dataclass(frozen=True, eq=False)
class Known:
    """The region in which a tile knows all points: the cell of `tile`, and a closed box.

    The box (left, bottom, right, top) is infinite where there are no points beyond. `extents`,
    (tiles, 4), are bounding boxes of points, inside out for none; corners of the hull, which all
    tiles know, are ignored.
    """

    tile: int
    box: Floats
    tiles: Tiles
    extents: Floats

    def certain(self, points: Floats, simplices: Indices, own: int, *, threads: int = 1) -> Bools:
        """Return which triangles have one of the first `own` points, and their disk in the box."""
        left, bottom, right, top = self.box.tolist()
        return _core.within2(points, simplices, own, (left, bottom, right, top), threads)

    def questions(
        self, points: Floats, simplices: Indices, rows: Rows, among: Sequence[int] | None = None
    ) -> tuple[Rows, Rows]:
        """Return pairs of a row of `simplices` and a tile whose points its disk may contain.

        `among` restricts the tiles. The part in the box is ignored, because all points there are
        known.
        """
        disks = _core.disks2(points, simplices.take(rows, axis=0))
        low, high = disks[:, :2] - disks[:, 2:], disks[:, :2] + disks[:, 2:]
        triangle, tile = self.tiles.overlaps(low, high)
        other = tile != self.tile if among is None else np.isin(tile, among)
        triangle, tile = triangle[other], tile[other]
        extent = self.extents[tile]
        # The intersection of a disk and a tile lies in the intersection of their boxes.
        left = np.maximum(low[triangle], extent[:, :2])
        right = np.minimum(high[triangle], extent[:, 2:])
        meets = (left <= right).all(axis=1) & self._reaches(disks[triangle], extent)
        known = (left >= self.box[:2]).all(axis=1) & (right <= self.box[2:]).all(axis=1)
        asked = meets & ~known
        return rows[triangle[asked]], tile[asked]

    @staticmethod
    def _reaches(disks: Floats, extent: Floats) -> Bools:
        """Whether a disk may meet a box; True if rounding leaves it undecided."""
        center, radius = disks[:, :2], disks[:, 2]
        with np.errstate(over="ignore"):
            off = np.maximum(np.maximum(extent[:, :2] - center, center - extent[:, 2:]), 0.0)
            answer: Bools = ~(np.hypot(*off.T) * (1 - 1e-14) > radius)
        return answer


def corners_of(points: Floats, simplices: Indices) -> Floats:
    """Return the coordinates of corners, (n, 6)."""
    return np.ascontiguousarray(points[simplices].reshape(-1, 6))
