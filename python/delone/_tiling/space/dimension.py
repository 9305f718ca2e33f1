"""The table of functions for tetrahedra in 3-D."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._tiling.dimension import Dimension
from delone._tiling.space import location, quality, topology

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["SPACE"]


def _hull(_: Floats, boundary: Indices) -> NDArray[np.int64]:
    """Return the vertices of a boundary, ascending."""
    return np.unique(boundary).astype(np.int64)


SPACE = Dimension(
    ndim=3,
    simplex="tetrahedron",
    boundary=topology.boundary_faces,
    hull=_hull,
    faces=topology.faces,
    quality=quality.measured,
    locator=_core.Locator3,
    located=location.located,
    on_facets=location.on_faces,
    delaunay=None,
)
