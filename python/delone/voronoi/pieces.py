"""Cells that the core has cut to an outline: their rings, and what follows from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone.exchange.geopandas import shapely_or_say
from delone.voronoi.outline import next_corner

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._core import CellPieces2
    from delone.voronoi.outline import Clip

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Pieces", "cut"]

# What the core returns for a cell.
_DOUBTFUL, _NOTHING, _WHOLE, _PARTS = -1, 0, 1, 2


class Pieces:
    """Parts of cells, each an outer ring and its holes, in the units of the outline.

    Parameters
    ----------
    rows : ndarray of int64, shape (k,)
        The cells, ascending.
    found : CellPieces2
        The result of the core.

    Attributes
    ----------
    doubtful, traced : ndarray of bool, shape (k,)
        Whether exact signs do not decide what is left; whether parts are left.
    corners : ndarray of float64, shape (p, 2)
        The corners of all rings.
    areas, perimeters : ndarray of float64, shape (k,)
        Measures of the cells that have parts.
    centroids : ndarray of float64, shape (k, 2)
        Their centers of gravity.
    """

    def __init__(self, rows: NDArray[np.int64], found: CellPieces2) -> None:
        self._rows, self._found = rows, found
        self.doubtful = found.left == _DOUBTFUL
        self.traced = found.left == _PARTS
        self.corners = found.points
        self.areas, self.perimeters = found.measures.areas, found.measures.perimeters
        self.centroids = found.measures.centroids

    def sides(self, outside: int, inside: int, cut: int) -> NDArray[np.int8]:
        """Return one of three numbers for each cell.

        Parameters
        ----------
        outside, inside, cut : int
            For cells of which nothing is left, for whole cells, and for the others.

        Returns
        -------
        ndarray of int8, shape (k,)
            The numbers.
        """
        left = self._found.left
        found = np.where(left == _NOTHING, outside, np.where(left == _WHOLE, inside, cut))
        return found.astype(np.int8)

    def _owner(self) -> NDArray[np.int64]:
        """Return the cell of each corner."""
        found = self._found
        return np.repeat(self._rows, np.diff(found.rings[found.parts[found.cells]]))

    def edges(self) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return all boundaries.

        Returns
        -------
        owner : ndarray of int64, shape (p,)
            The cell to the left of each edge.
        begin, end : ndarray of float64, shape (p, 2)
            Where it begins and ends.
        """
        after = next_corner(self._found.rings, len(self.corners))
        return self._owner(), self.corners, self.corners[after]

    def ridge_lengths(self, count: int) -> tuple[NDArray[np.int64], Floats]:
        """Return the lengths of clipped ridges, each computed from one of its cells.

        Parameters
        ----------
        count : int
            Number of ridges.

        Returns
        -------
        ridges : ndarray of int64
            Those of which something is left.
        lengths : ndarray of float64
            Their lengths.
        """
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
        """Return geometries.

        Returns
        -------
        rows : ndarray of int64, shape (t,)
            The cells that have parts, ascending.
        polygons : ndarray of object, shape (t,)
            Polygons, and multipolygons if there are several parts. They may be invalid: a ring may
            touch itself.
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
    """Cut some convex cells to an outline.

    Parameters
    ----------
    starts, corners, ridges : ndarray
        All cells: their corners in the units of the outline, and the ridge along each edge.
    rows : ndarray of int64, shape (k,)
        Those to cut, ascending, none without corners.
    clip : Clip
        The outline.
    workers : int
        Number of threads.

    Returns
    -------
    Pieces
        The clipped cells.
    """
    first = corners[starts[:-1][rows]]
    inside = shapely_or_say().contains_xy(clip.scaled, first)
    found = _core.pieces2(
        starts, corners, ridges, rows.astype(np.int32), inside, *clip.rings, workers
    )
    return Pieces(rows, found)
