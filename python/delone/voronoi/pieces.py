"""Cells that the core has cut to an outline: their rings, and what follows from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone.exchange.geopandas import shapely_or_say
from delone.voronoi.outline import next_corner

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone._core import CellPieces2
    from delone.voronoi.outline import Clip

__all__ = ["Pieces", "cut"]

# What the core returns for a cell.
_DOUBTFUL, _NOTHING, _WHOLE, _PARTS = -1, 0, 1, 2


class Pieces:
    """Parts of cells, each an outer ring and its holes, in the units of the outline.

    For each cell, `doubtful` tells whether exact signs fail to decide what is left, and `traced`
    whether parts are left; measures are those of the cells that have parts. `corners` are those of
    all rings.
    """

    def __init__(self, rows: NDArray[np.int64], found: CellPieces2) -> None:
        self._rows, self._found = rows, found
        self.doubtful = found.left == _DOUBTFUL
        self.traced = found.left == _PARTS
        self.corners = found.points
        self.areas, self.perimeters = found.measures.areas, found.measures.perimeters
        self.centroids = found.measures.centroids

    def sides(self, outside: int, inside: int, cut: int) -> NDArray[np.int8]:
        """Return a number for each cell: whether nothing, all, or a part of it is left."""
        left = self._found.left
        found = np.where(left == _NOTHING, outside, np.where(left == _WHOLE, inside, cut))
        return found.astype(np.int8)

    def edges(self) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return all boundaries: the cell to the left of each edge, its begin and its end."""
        found = self._found
        owner = np.repeat(self._rows, np.diff(found.rings[found.parts[found.cells]]))
        return owner, self.corners, self.corners[next_corner(found.rings, len(self.corners))]

    def ridge_lengths(self, count: int) -> tuple[NDArray[np.int64], Floats]:
        """Return the ridges of which something is left, and the length of each, from one cell."""
        owner, begin, end = self.edges()
        along = self._found.ridges >= 0
        ridges = self._found.ridges[along]
        one = np.full(count, -1, dtype=np.int64)
        one[ridges] = owner[along]
        chosen = np.where(one[ridges] == owner[along], np.hypot(*(end - begin)[along].T), 0.0)
        used = np.flatnonzero(one >= 0)
        lengths: Floats = np.bincount(ridges, chosen, count)[used].astype(np.float64)
        return used.astype(np.int64), lengths

    def polygons(self) -> tuple[NDArray[np.int64], NDArray[Any]]:
        """Return the cells that have parts, ascending, and their polygons or multipolygons.

        They may be invalid: a ring may touch itself.
        """
        shapely = shapely_or_say()

        rings, parts = self._found.rings, self._found.parts
        # Rings repeat their first corner at the end.
        closed = np.insert(self.corners, rings[1:], self.corners[rings[:-1]], axis=0)
        turned = rings + np.arange(len(rings))
        polygons = shapely.from_ragged_array(shapely.GeometryType.POLYGON, closed, (turned, parts))
        cells = self._found.cells
        sizes = np.diff(cells)[self.traced]
        found = polygons[cells[:-1][self.traced]]
        several = np.flatnonzero(sizes > 1)
        if len(several):
            group = np.repeat(np.arange(len(sizes)), sizes)
            mask = sizes[group] > 1
            found[several] = shapely.multipolygons(
                polygons[mask], indices=np.repeat(np.arange(len(several)), sizes[several])
            )
        return self._rows[self.traced], found


def cut(
    starts: Indices,
    corners: Floats,
    ridges: Indices,
    rows: NDArray[np.int64],
    clip: Clip,
    *,
    workers: int,
) -> Pieces:
    """Cut some convex cells to an outline: `rows`, ascending, none without corners.

    The first three arrays are those of all cells: corners in the units of the outline, and the
    ridge along each edge.
    """
    first = corners[starts[:-1][rows]]
    inside = shapely_or_say().contains_xy(clip.scaled, first)
    found = _core.pieces2(
        starts, corners, ridges, rows.astype(np.int32), inside, *clip.rings, workers
    )
    return Pieces(rows, found)
