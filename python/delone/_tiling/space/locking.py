"""Which faces of tetrahedra are given triangles, and the cells between them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone._tiling.space.topology import FACES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Indices

__all__ = ["Sides", "cells", "directions", "is_odd", "sides"]


class Sides(NamedTuple):
    """The given triangles among the faces of tetrahedra."""

    # (m, 4): the row of the triangle opposite each corner, or -1.
    face: Indices
    # (m, 4): 1 where its normal points out of the tetrahedron, else -1; arbitrary without one.
    out: NDArray[np.int8]


def sides(simplices: Indices, faces: Indices, npoints: int) -> Sides:
    """Find triangles, each given once, among the faces of positive tetrahedra."""
    known = np.ascontiguousarray(faces, dtype=np.int32)
    face = np.full(simplices.shape, -1, dtype=np.int32)
    for k in range(4):
        opposite = np.delete(simplices, k, axis=1).astype(np.int32)
        face[:, k] = _core.facet_rows(known, opposite, npoints, False)
    return Sides(face, directions(simplices, faces, face))


def directions(simplices: Indices, faces: Indices, face: Indices) -> NDArray[np.int8]:
    """Return `Sides.out`, given the triangle opposite each corner; O(m)."""
    tetrahedron, corner = np.nonzero(face >= 0)
    outward = simplices[tetrahedron[:, None], np.array(FACES)[corner]]
    given = faces[face[tetrahedron, corner]]
    # Rotated so that both begin with the same vertex.
    first = np.argmax(given == outward[:, :1], axis=1)
    same = given[np.arange(len(given)), (first + 1) % 3] == outward[:, 1]
    out = np.ones(simplices.shape, dtype=np.int8)
    out[tetrahedron, corner] = np.where(same, 1, -1)
    return out


def is_odd(simplices: Indices) -> NDArray[np.bool_]:
    """Return whether each row is an odd permutation of its ascending order."""
    odd = np.zeros(len(simplices), dtype=bool)
    width = simplices.shape[1]
    for j in range(1, width):
        for i in range(j):
            odd ^= simplices[:, i] > simplices[:, j]
    return odd


def cells(neighbors: Indices, locked: NDArray[np.bool_]) -> Indices:
    """Return the cell number of each tetrahedron; cells are separated by locked faces."""
    open_ones = np.where(locked, np.int32(-1), neighbors)
    return _core.alpha_labels(np.ones(len(neighbors), dtype=bool), open_ones)
