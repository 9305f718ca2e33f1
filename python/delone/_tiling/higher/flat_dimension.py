"""Functions for simplices in flats of points with four to eight coordinates, and their locator."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from delone._tiling.higher.dimension import HIGHER, table
from delone._tiling.higher.flats import axes_of
from delone._tiling.plane.dimension import PLANE
from delone._tiling.space.dimension import SPACE

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["FLATS"]

# By the dimension of the flat.
_DIMENSIONS = {2: PLANE, 3: SPACE} | HIGHER
# Squared distances are compared exactly up to this factor times the smallest, plus this number.
_CLOSE, _LEAST = 1 + 2.0**-40, 2.0**-1000


class FlatLocator:
    """The locator in a flat: points are projected to it along the other axes."""

    def __init__(self, points: Floats, simplices: Indices, neighbors: Indices) -> None:
        self._points, self._rows = points, np.unique(simplices)
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

    def nearest(self, xi: Floats, _: int) -> Indices:
        """Return the nearest vertex to each point, the first of several, exactly. O(n) each."""
        sites = self._points[self._rows]
        found = np.full(len(xi), -1, dtype=np.int32)
        for i in np.flatnonzero(np.isfinite(xi).all(axis=1)).tolist():
            with np.errstate(over="ignore"):
                squares = ((sites - xi[i]) ** 2).sum(axis=1)
            least = squares.min()
            close = np.flatnonzero(~(squares > least * _CLOSE + _LEAST))
            found[i] = self._rows[min(close.tolist(), key=lambda row: _square(sites[row], xi[i]))]
        return found


def _square(a: Floats, b: Floats) -> Fraction:
    return sum(((Fraction(x) - Fraction(y)) ** 2 for x, y in zip(a, b, strict=True)), Fraction(0))


# By the number of coordinates and the dimension of a flat.
FLATS = {
    (d, k): table(d, FlatLocator, simplex={2: "triangle", 3: "tetrahedron"}.get(k, "simplex"))
    for d in HIGHER
    for k in range(2, d)
}
