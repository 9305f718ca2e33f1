"""Topology of tetrahedra: faces, boundary, neighbors.

This module needs neither coordinates nor predicates. The input must be a triangulation as the core
exports it: tetrahedra are positively oriented, `neighbors[t, k]` is across the face opposite vertex
k, -1 outside.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_workers

if TYPE_CHECKING:
    from delone._base.types import Indices

__all__ = ["FACES", "boundary_faces", "faces", "neighbors"]

# The face opposite vertex k, counter-clockwise as seen from outside.
FACES = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]


def faces(
    simplices: Indices, neighbors: Indices, npoints: int, workers: int | None = None
) -> Indices:
    """Return every face once, (k, 3): vertices and rows ascending. O(m)."""
    return _core.faces3(simplices, neighbors, npoints, as_workers(workers))


def boundary_faces(simplices: Indices, neighbors: Indices) -> Indices:
    """Return faces with a tetrahedron on one side only, counter-clockwise as seen from outside."""
    simplex, corner = np.nonzero(neighbors < 0)
    return np.take_along_axis(simplices[simplex], np.array(FACES)[corner], axis=1)


def neighbors(simplices: Indices) -> Indices:
    """Return the tetrahedron opposite each vertex, -1 if there is none.

    Tetrahedra have the same orientation, and no face is used more than twice.
    """
    npoints = int(simplices.max(initial=-1)) + 1
    found: Indices = _core.facet_neighbors(np.ascontiguousarray(simplices, np.int32), npoints)
    return found
