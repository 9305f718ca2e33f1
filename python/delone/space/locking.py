"""Which faces of tetrahedra are given triangles, and the cells between these."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone.space.topology import FACES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Indices = NDArray[np.int32]
    Keys = NDArray[np.int64]

__all__ = ["Sides", "cells", "directions", "is_odd", "sides"]

# Whether the face opposite each corner of a positive tetrahedron, ascending, faces outward.
_OUTWARD = np.array([1, -1, 1, -1], dtype=np.int8)


class Sides(NamedTuple):
    """What the faces of tetrahedra are."""

    # (m, 4): the row of the triangle opposite each corner, or -1.
    face: Indices
    # (m, 4): 1 where its normal points out of the tetrahedron, else -1; arbitrary without one.
    out: NDArray[np.int8]


def sides(simplices: Indices, faces: Indices, npoints: int) -> Sides:
    """Find triangles, each given once, among the faces of positive tetrahedra; O(m log m)."""
    order = np.argsort(simplices, axis=1)
    corners = np.take_along_axis(simplices, order, axis=1).astype(np.int64)
    sign = np.where(is_odd(simplices), -1, 1).astype(np.int8)[:, None] * _OUTWARD
    rows = np.argsort(faces, axis=1)
    ascending = np.take_along_axis(faces, rows, axis=1).astype(np.int64)
    turned = np.where(is_odd(faces), -1, 1).astype(np.int8)
    lines = np.unique(ascending[:, 0] * npoints + ascending[:, 1])
    keys = _keys(lines, ascending, npoints)
    by_key = np.argsort(keys)
    keys = keys[by_key]
    face = np.full(simplices.shape, -1, dtype=np.int32)
    out = np.ones(simplices.shape, dtype=np.int8)
    for k in range(4):
        wanted = _keys(lines, np.delete(corners, k, axis=1), npoints)
        at = np.minimum(np.searchsorted(keys, wanted), max(len(keys) - 1, 0))
        same = (wanted >= 0) & (keys[at] == wanted) if len(keys) else wanted < -1
        found = np.flatnonzero(same)
        row = by_key[at[found]]
        face[found, order[found, k]] = row
        out[found, order[found, k]] = sign[found, k] * turned[row]
    return Sides(face, out)


def _keys(lines: Keys, triangles: Keys, npoints: int) -> Keys:
    """Return a number for each ascending triangle, -1 if its first two corners are not in a line.

    Rows are below 2**31, so that no product overflows.
    """
    first = triangles[:, 0] * npoints + triangles[:, 1]
    if not len(lines):
        return np.full(len(first), -1, dtype=np.int64)
    at = np.minimum(np.searchsorted(lines, first), len(lines) - 1)
    found: Keys = np.where(lines[at] == first, at * npoints + triangles[:, 2], -1)
    return found


def directions(simplices: Indices, faces: Indices, face: Indices) -> NDArray[np.int8]:
    """Return `Sides.out`, if it is known which triangle is opposite each corner; O(m)."""
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
    """Return the number of the cell of each tetrahedron: what is connected without locked faces."""
    open_ones = np.where(locked, np.int32(-1), neighbors)
    return _core.alpha_labels3(np.ones(len(neighbors), dtype=bool), open_ones)
