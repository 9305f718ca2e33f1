"""Linear interpolation in the simplices that contain the queries, without the other simplices.

The core uses linear programming to find the simplex of the canonical Delaunay triangulation that
contains a query, and proves that it is correct. So the values equal those of the triangulation up
to rounding, in any dimension.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.blocks import ROWS, blocks
from delone._tiling.higher.dimension import MOST
from delone.interpolate.space import slopes

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["Lazily"]


class Lazily:
    """Sites that are interpolated without a triangulation."""

    def __init__(self, points: Floats, workers: int) -> None:
        self.points = points
        self.workers = workers
        # Reject degenerate sites now.
        self._sites  # noqa: B018

    @cached_property
    def _sites(self) -> Any:
        return _core.LazyN(self.points)

    @property
    def first(self) -> Indices:
        """The first row of each site with the same coordinates."""
        first = np.arange(len(self.points), dtype=np.int32)
        repeats, earlier = self._sites.duplicates.T
        first[repeats] = earlier
        return first

    def within(self, queries: Floats) -> tuple[Indices, Floats]:
        """Return rows of corners, (k, d + 1), -1 outside, and their weights, NaN outside."""
        found: tuple[Indices, Floats] = self._sites.within(queries, self.workers)
        return found

    def values(self, queries: Floats, columns: Floats) -> Floats:
        """Return values, (k, c), NaN outside."""
        corners, weights = self.within(queries)
        found = np.full((len(queries), columns.shape[1]), np.nan)
        inside = np.flatnonzero(corners[:, 0] >= 0)
        for block in blocks(len(inside)):
            rows = inside[block]
            sums = np.zeros((len(rows), columns.shape[1]))
            for k in range(corners.shape[1]):
                weight = weights[rows, k, None]
                # A corner with weight 0 has no effect, even if its value is NaN.
                sums += np.where(weight == 0, 0.0, weight * columns[corners[rows, k]])
            found[rows] = sums
        return found

    def gradients(self, queries: Floats, columns: Floats) -> Floats:
        """Return gradients, (k, c, d), NaN outside."""
        count, d = queries.shape
        corners, _ = self.within(queries)
        found = np.full((count, columns.shape[1], d), np.nan)
        inside = np.flatnonzero(corners[:, 0] >= 0)
        of = slopes if d <= MOST else _slopes
        # The matrices of a block take as much memory as one column of a block elsewhere.
        step = max(1, ROWS // d**2)
        for start in range(0, len(inside), step):
            rows = inside[start : start + step]
            found[rows] = of(self.points, corners[rows], columns)
        return found

    def __getstate__(self) -> dict[str, Any]:
        # The core's index is rebuilt when it is needed.
        return {"points": self.points, "workers": self.workers}

    def __str__(self) -> str:
        count, d = self.points.shape
        return f"{count} points in {d}-D"


def _slopes(points: Floats, corners: Indices, columns: Floats) -> Floats:
    """Return gradients, (k, c, d), of linear functions on nondegenerate simplices, (k, d + 1)."""
    last = points[corners[:, -1:]]
    sides = points[corners[:, :-1]] - last
    rise = columns[corners[:, :-1]] - columns[corners[:, -1:]]
    # Scale each side to length 1, so that pinv does not treat thin simplices as flat.
    length = np.linalg.norm(sides, axis=2, keepdims=True)
    found: Floats = (np.linalg.pinv(sides / length) @ (rise / length)).transpose(0, 2, 1)
    return found
