"""Whether planar triangles cover the same area as others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows

    # Triangles and the number of the part that each belongs to.
    Labeled = tuple[NDArray[Any], NDArray[Any]]

__all__ = ["PLANES", "differing"]

# The coordinates that remain if one is dropped, in the order that keeps orientations.
PLANES = ((1, 2), (2, 0), (0, 1))


def differing(points: Floats, given: Labeled, made: Labeled) -> Rows:
    """Return the parts of `given` triangles that those `made` do not cover, each once, exactly.

    Where all triangles of a part are in one plane and turn in one direction, how often they cover a
    place is determined by the sum of their oriented edges. So equal sums mean equal unions, and if
    those given do not overlap, nor do those made.
    """
    parts, first = np.unique(given[1], return_index=True)
    mine = np.isin(made[1], parts)
    faces = np.concatenate((given[0], made[0][mine])).astype(np.int64)
    number = np.searchsorted(parts, np.concatenate((given[1], made[1][mine])))
    way = np.where(np.arange(len(faces)) < len(given[0]), 1, -1)
    wrong = np.zeros(len(parts), dtype=bool)
    wrong[number[~_alike(points, given[0][first][number], faces)]] = True
    wrong[_with_other_edges(faces, number, way)] = True
    return parts[wrong].astype(np.int64)


def _alike(points: Floats, first: NDArray[Any], faces: Rows) -> NDArray[np.bool_]:
    """Return whether triangles are in the planes of others and turn in the same direction."""
    alike = np.zeros(len(faces), dtype=bool)
    todo = np.arange(len(faces))
    for kept in PLANES:
        flat = np.ascontiguousarray(points[:, kept])
        of_first = _core.orient2d(*(flat[v] for v in first[todo].T))
        rows, todo = todo[of_first != 0], todo[of_first == 0]
        turn = _core.orient2d(*(flat[v] for v in faces[rows].T))
        alike[rows] = turn == of_first[of_first != 0]
    a, b, c = (points[v] for v in first.T)
    for v in faces.T:
        alike &= _core.orient3d(a, b, c, points[v]) == 0
    return alike


def _with_other_edges(faces: Rows, number: Rows, way: Rows) -> Rows:
    """Return the numbers of parts whose oriented edges do not sum to nothing."""
    a, b = faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()
    keys = np.column_stack((np.repeat(number, 3), np.minimum(a, b), np.maximum(a, b)))
    sign = np.repeat(way, 3) * np.where(a < b, 1, -1)
    distinct, at = np.unique(keys, axis=0, return_inverse=True)
    total = np.bincount(at.reshape(-1), sign, minlength=len(distinct))
    found: Rows = distinct[total != 0, 0]
    return found
