"""The table of functions for triangles in 2-D."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._tiling.dimension import Dimension
from delone._tiling.plane import location, quality, topology

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["PLANE"]


def _hull(points: Floats, boundary: Indices) -> NDArray[np.int64]:
    """Return the vertices of a boundary that is one cycle, starting at the smallest point."""
    rows = boundary[:, 0]
    x, y = points[rows].T
    return topology.boundary_next(boundary, int(rows[np.lexsort((y, x))[0]]))


def _faces(simplices: Indices, _: Indices, __: int, ___: int | None) -> Indices:
    """Return every triangle once, vertices and rows ascending."""
    found = np.sort(simplices, axis=1)
    return found[np.lexsort(found.T[::-1])]


def _delaunay(points: Floats, workers: int) -> tuple[Indices, Indices]:
    made = _core.triangulate2(points, "auto", workers)
    return made.simplices, made.neighbors


PLANE = Dimension(
    ndim=2,
    simplex="triangle",
    boundary=topology.boundary_edges,
    hull=_hull,
    faces=_faces,
    quality=quality.measured,
    locator=_core.Locator2,
    located=location.located,
    on_facets=location.on_edges,
    delaunay=_delaunay,
)
