"""Functions for simplices in flats of points with four to eight coordinates, and their locator."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._tiling.higher.dimension import HIGHER, table
from delone._tiling.higher.flats import axes_of
from delone._tiling.plane.dimension import PLANE
from delone._tiling.space.dimension import SPACE

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["FLATS"]

# By the dimension of the flat.
_DIMENSIONS = {2: PLANE, 3: SPACE} | HIGHER


class FlatLocator:
    """The locator in a flat: points are projected to it along the other axes."""

    def __init__(self, points: Floats, simplices: Indices, neighbors: Indices) -> None:
        self._points, self._simplices = points, simplices
        self._sites: _core.LocatorN | None = None
        self._axes = axes_of(points, simplices[0])
        self._within = _DIMENSIONS[len(self._axes)]
        self._index = self._within.locator(self._projected(points), simplices, neighbors)

    def _projected(self, points: Floats) -> Floats:
        return np.ascontiguousarray(points[:, self._axes])

    def find(self, xi: Floats, workers: int) -> Indices:
        """Return the simplices that contain the projections of points."""
        found: Indices = self._index.find(self._projected(xi), workers)
        return found

    def within(self, xi: Floats, workers: int) -> tuple[Indices, Floats]:
        """Return simplices and barycentric coordinates of projections."""
        simplex, weights, *_ = self._within.located(self._index, self._projected(xi), workers)
        weights[simplex < 0] = np.nan
        return simplex, weights

    def nearest(self, xi: Floats, workers: int) -> Indices:
        """Return the nearest vertex to each point, the first of several, exactly."""
        if self._sites is None:
            # The tree of boxes over the vertices of simplices, of which no more is needed than that
            # all vertices are in one of them: as many rows as fit, the last one again and again.
            corners = self._points.shape[1] + 1
            rows = np.unique(self._simplices)
            rows = np.pad(rows, (0, -len(rows) % corners), mode="edge").reshape(-1, corners)
            self._sites = _core.LocatorN(self._points, rows, np.full_like(rows, -1))
        return self._sites.nearest(xi, workers)


# By the number of coordinates and the dimension of a flat.
FLATS = {
    (d, k): table(d, FlatLocator, simplex={2: "triangle", 3: "tetrahedron"}.get(k, "simplex"))
    for d in HIGHER
    for k in range(2, d)
}
