"""Topology of triangles: boundary, half-edges, incidences.

This module needs neither coordinates nor predicates. The input must be a triangulation as the core
exports it: triangles are counter-clockwise, `neighbors[t, k]` is across the edge opposite vertex k,
-1 outside, and the boundary is one cycle. All functions are linear in the number of triangles,
apart from sorting.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.blocks import ROWS, blocks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Indices

__all__ = [
    "among",
    "boundary_edges",
    "boundary_next",
    "edge_keys",
    "half_edges",
    "neighbors",
    "rows_among",
    "triangles_among",
    "unjoined",
    "vertex_neighbor_vertices",
    "vertex_to_simplex",
]

# Tail and head of the half-edge opposite vertex k, counter-clockwise.
_TAIL = np.array([1, 2, 0])
_HEAD = np.array([2, 0, 1])


def boundary_edges(simplices: Indices, neighbors: Indices) -> Indices:
    """Return the edges with a triangle only on their left, in the order of triangles."""
    parts = [np.nonzero(neighbors[block] < 0) for block in blocks(len(neighbors))]
    first = np.zeros(0, dtype=np.int64)
    starts = range(0, len(neighbors), ROWS)
    rows = np.concatenate([first, *(t + k for k, (t, _) in zip(starts, parts, strict=True))])
    corner = np.concatenate([first, *(corner for _, corner in parts)])
    return np.column_stack(half_edges(simplices, rows, corner))


def half_edges(
    simplices: Indices, rows: NDArray[np.integer], corner: NDArray[np.integer]
) -> tuple[Indices, Indices]:
    """Return tails and heads of the edges opposite corners of triangles, counter-clockwise."""
    return simplices[rows, _TAIL[corner]], simplices[rows, _HEAD[corner]]


def boundary_next(boundary: Indices, start: int) -> NDArray[np.int64]:
    """Follow boundary edges, (h, 2), from one of their vertices until they return to it.

    No two edges start at the same vertex. They form one cycle if and only if h vertices are
    returned.
    """
    after = dict(boundary.tolist())
    cycle = [start]
    # Terminates: at most h steps.
    for _ in range(len(boundary) - 1):
        vertex = after.get(cycle[-1], start)
        if vertex == start:
            break
        cycle.append(vertex)
    return np.array(cycle, dtype=np.int64)


def vertex_to_simplex(simplices: Indices, npoints: int) -> Indices:
    """Return the first simplex that has each vertex, or -1; for any number of corners."""
    found = np.full(npoints, -1, dtype=np.int32)
    # If an index is repeated, the last assigned value remains.
    triangles = np.arange(len(simplices) - 1, -1, -1, dtype=np.int32)
    found[simplices[::-1]] = triangles[:, None]
    return found


def rows_among(triangles: Indices, some: Indices) -> Indices:
    """Return the row of each triangle in a subset, (m + 1,); -1 if not in it, and at the end."""
    corners = np.sort(np.concatenate((triangles, some)), axis=1)
    # A stable sort puts a triangle of the first array before the same triangle of the second.
    order = np.lexsort(corners.T)
    same = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    found = np.full(len(triangles) + 1, -1, dtype=np.int32)
    found[order[:-1][same]] = order[1:][same] - len(triangles)
    return found


def triangles_among(
    triangles: NDArray[np.integer], others: NDArray[np.integer]
) -> NDArray[np.bool_]:
    """Return which triangles have the same corners as one of the others."""
    corners = np.sort(np.concatenate((triangles, others)), axis=1).astype(np.int64)
    count = int(corners.max(initial=0)) + 1
    _, pair = np.unique(corners[:, 0] * count + corners[:, 1], return_inverse=True)
    key = pair.reshape(-1) * count + corners[:, 2]
    return among(key[: len(triangles)], key[len(triangles) :])


def vertex_neighbor_vertices(edges: Indices, npoints: int) -> tuple[Indices, Indices]:
    """Return the neighbors of all vertices as compressed rows (indptr, indices), ascending. O(k).

    The k edges must come as from `measures.edges`; otherwise a ShapeError is raised. Those of
    vertex v are ``indices[indptr[v]:indptr[v + 1]]``.
    """
    return _core.around(np.ascontiguousarray(edges, dtype=np.int32), npoints)


def neighbors(simplices: Indices, npoints: int) -> Indices:
    """Return the triangle opposite each vertex, -1 if there is none.

    Triangles have the same orientation, and no directed edge is used twice.
    """
    found: Indices = _core.facet_neighbors(np.ascontiguousarray(simplices, np.int32), npoints)
    return found


def unjoined(simplices: Indices, neighbors: Indices) -> NDArray[np.int64]:
    """Return triangles or tetrahedra without a neighbor across a side that two of them share."""
    t, k = np.nonzero(neighbors < 0)
    d = simplices.shape[1] - 1
    side = np.sort(simplices[t][np.arange(d + 1) != k[:, None]].reshape(-1, d), axis=1)
    order = np.lexsort(side.T)
    same = (side[order[1:]] == side[order[:-1]]).all(axis=1)
    return np.unique(np.concatenate((t[order[1:][same]], t[order[:-1][same]])))


def edge_keys(a: NDArray[np.integer], b: NDArray[np.integer], npoints: int) -> NDArray[np.int64]:
    """Return a key for each edge, the same in both directions, ascending like (smaller, larger)."""
    keys: NDArray[np.int64] = np.minimum(a, b).astype(np.int64) * npoints + np.maximum(a, b)
    return keys


def among(keys: NDArray[np.int64], others: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which numbers are among others, in any order.

    By bisection: the hash table of ``numpy.isin`` is several times slower on keys of edges.
    """
    if not len(others):
        return np.zeros(keys.shape, dtype=bool)
    ordered = np.sort(others)
    place = np.minimum(np.searchsorted(ordered, keys), len(ordered) - 1)
    found: NDArray[np.bool_] = ordered[place] == keys
    return found
