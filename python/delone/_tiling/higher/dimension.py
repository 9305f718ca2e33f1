"""The tables of functions for simplices in four to eight dimensions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._tiling.dimension import Dimension, absent
from delone._tiling.higher.topology import boundary_facets

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["HIGHER", "MOST", "table"]

# Maximum number of coordinates of a triangulation.
MOST = 8


def _hull(_: Floats, boundary: Indices) -> NDArray[np.int64]:
    """Return the vertices of a boundary in ascending order."""
    return np.unique(boundary).astype(np.int64)


def _located(
    index: Any, xi: Floats, workers: int
) -> tuple[Indices, Floats, Indices, Indices, Floats]:
    """Locate points, (k, d). Return the fields of a `Location` except `closest`.

    For queries outside the hull, the nearest facets are not computed.
    """
    simplex, weights = index.within(xi, workers)
    count, d = xi.shape
    beside, facet = np.full(count, -1, np.int32), np.full((count, d), -1, np.int32)
    return simplex, weights, beside, facet, np.full((count, d), np.nan)


def _on_facets(points: Floats, facet: Indices, weights: Floats) -> Floats:
    """Return points on facets; all are NaN, because `located` does not return facets."""
    found: Floats = (weights[..., None] * points[facet]).sum(axis=1)
    return found


def table(d: int, locator: Any, *, simplex: str = "simplex") -> Dimension:
    """Return the functions for simplices of points with d coordinates."""
    return Dimension(
        ndim=d,
        simplex=simplex,
        boundary=boundary_facets,
        hull=_hull,
        faces=absent,
        quality=absent,
        locator=locator,
        located=_located,
        on_facets=_on_facets,
        delaunay=None,
    )


HIGHER = {d: table(d, _core.LocatorN) for d in range(4, MOST + 1)}
