"""Topology of triangles: edges, boundary, incidences.

Needs neither coordinates nor predicates. The input must be a triangulation as the core exports it:
triangles are counter-clockwise, `neighbors[t, k]` is across the edge opposite vertex k, -1 outside,
and the boundary is one cycle. All functions are linear in the number of triangles, apart from
sorting.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._arrays import as_workers
from delone.blocks import ROWS, blocks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Indices = NDArray[np.int32]

__all__ = [
    "among",
    "boundary_edges",
    "boundary_next",
    "edge_keys",
    "edges",
    "neighbors",
    "rows_among",
    "vertex_neighbor_vertices",
    "vertex_to_simplex",
]

# Tail and head of the half-edge opposite vertex k, counter-clockwise.
_TAIL = np.array([1, 2, 0])
_HEAD = np.array([2, 0, 1])


def edges(
    simplices: Indices, neighbors: Indices, npoints: int, workers: int | None = None
) -> Indices:
    """Return every edge once.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 3)
        Triangles.
    neighbors : ndarray of int32, shape (m, 3)
        The triangle opposite each vertex.
    npoints : int
        Number of points.
    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of int32, shape (k, 2)
        The smaller vertex first, rows ascending.

    Notes
    -----
    O(m).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import edges
    >>> alone = np.array([[0, 1, 2]], dtype=np.int32), np.full((1, 3), -1, dtype=np.int32)
    >>> edges(*alone, 3).tolist()
    [[0, 1], [0, 2], [1, 2]]
    """
    return _core.edges2(simplices, neighbors, npoints, as_workers(workers))


def boundary_edges(simplices: Indices, neighbors: Indices) -> Indices:
    """Return the edges that have a triangle on one side only.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 3)
        Triangles.
    neighbors : ndarray of int32, shape (m, 3)
        The triangle opposite each vertex.

    Returns
    -------
    ndarray of int32, shape (h, 2)
        Directed edges, with the triangle to the left, in the order of the triangles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import boundary_edges
    >>> boundary_edges(np.array([[0, 1, 2]]), np.array([[-1, -1, -1]])).tolist()
    [[1, 2], [2, 0], [0, 1]]
    """
    parts = [np.nonzero(neighbors[block] < 0) for block in blocks(len(neighbors))]
    first = np.zeros(0, dtype=np.int64)
    starts = range(0, len(neighbors), ROWS)
    rows = np.concatenate([first, *(t + k for k, (t, _) in zip(starts, parts, strict=True))])
    corner = np.concatenate([first, *(corner for _, corner in parts)])
    return np.column_stack((simplices[rows, _TAIL[corner]], simplices[rows, _HEAD[corner]]))


def boundary_next(boundary: Indices, start: int) -> NDArray[np.int64]:
    """Follow boundary edges from a vertex until they return to it.

    Parameters
    ----------
    boundary : ndarray of int32, shape (h, 2)
        Directed edges, of which no two start at the same vertex.
    start : int
        A vertex of the boundary.

    Returns
    -------
    ndarray of int64, shape (k,)
        The vertices from `start` on. k equals h if and only if the edges form one cycle.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import boundary_next
    >>> boundary_next(np.array([[1, 2], [2, 0], [0, 1]]), 2).tolist()
    [2, 0, 1]
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
    """Return one triangle of each vertex.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 3)
        Triangles.
    npoints : int
        Number of points.

    Returns
    -------
    ndarray of int32, shape (npoints,)
        The first triangle that has the vertex; -1 if there is none.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import vertex_to_simplex
    >>> vertex_to_simplex(np.array([[0, 1, 3], [1, 4, 3]]), 5).tolist()
    [0, 0, -1, 0, 1]
    """
    found = np.full(npoints, -1, dtype=np.int32)
    # If an index is repeated, the last value assigned remains.
    triangles = np.arange(len(simplices) - 1, -1, -1, dtype=np.int32)
    found[simplices[::-1]] = triangles[:, None]
    return found


def rows_among(triangles: Indices, some: Indices) -> Indices:
    """Return the row of each triangle in a subset.

    Parameters
    ----------
    triangles : ndarray of int32, shape (m, 3)
        Distinct triangles.
    some : ndarray of int32, shape (k, 3)
        A subset of them, whose corners may be rotated.

    Returns
    -------
    ndarray of int32, shape (m + 1,)
        Rows of `some`, -1 for triangles that are not in it; the last entry is -1.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import rows_among
    >>> rows_among(np.array([(0, 1, 2), (2, 1, 3)]), np.array([(1, 3, 2)]))
    array([-1,  0, -1], dtype=int32)
    """
    corners = np.sort(np.concatenate((triangles, some)), axis=1)
    # A stable sort puts a triangle of the first array before the same triangle of the second.
    order = np.lexsort(corners.T)
    same = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    found = np.full(len(triangles) + 1, -1, dtype=np.int32)
    found[order[:-1][same]] = order[1:][same] - len(triangles)
    return found


def vertex_neighbor_vertices(edges: Indices, npoints: int) -> tuple[Indices, Indices]:
    """Return the neighbors of all vertices as compressed rows.

    Parameters
    ----------
    edges : ndarray of int32, shape (k, 2)
        Every edge once, the smaller vertex first, rows ascending.
    npoints : int
        Number of points.

    Returns
    -------
    indptr : ndarray of int32, shape (npoints + 1,)
        The start of the neighbors of each vertex.
    indices : ndarray of int32, shape (2 k,)
        The neighbors of vertex v are ``indices[indptr[v]:indptr[v + 1]]``, ascending.

    Notes
    -----
    O(k).

    Raises
    ------
    ShapeError
        The edges are in a different order.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import vertex_neighbor_vertices
    >>> indptr, indices = vertex_neighbor_vertices(np.array([[0, 1], [0, 2], [1, 2]]), 3)
    >>> indices[indptr[1]:indptr[2]].tolist()
    [0, 2]
    """
    return _core.around(np.ascontiguousarray(edges, dtype=np.int32), npoints)


def neighbors(simplices: Indices, npoints: int) -> Indices:
    """Return the triangle opposite each vertex.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 3)
        Triangles, all with the same orientation; no directed edge is used twice.
    npoints : int
        Number of points.

    Returns
    -------
    ndarray of int32, shape (m, 3)
        Triangles, -1 if there is none.

    Notes
    -----
    O(m log m).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import neighbors
    >>> neighbors(np.array([[0, 1, 2], [0, 2, 3]]), 4).tolist()
    [[-1, 1, -1], [-1, -1, 0]]
    """
    tail = simplices[:, _TAIL].ravel().astype(np.int64)
    head = simplices[:, _HEAD].ravel().astype(np.int64)
    keys, reverse = tail * npoints + head, head * npoints + tail
    order = np.argsort(keys)
    place = np.minimum(np.searchsorted(keys, reverse, sorter=order), max(len(keys) - 1, 0))
    partner = order[place]
    found = np.where(keys[partner] == reverse, partner // 3, -1)
    return found.astype(np.int32).reshape(-1, 3)


def edge_keys(a: NDArray[np.integer], b: NDArray[np.integer], npoints: int) -> NDArray[np.int64]:
    """Return a key for each edge, the same in both directions.

    Parameters
    ----------
    a, b : ndarray of int, of one shape
        Ends of the edges.
    npoints : int
        Number of points.

    Returns
    -------
    ndarray of int64
        Keys in the shape of the ends; they ascend with the smaller end, then with the larger one.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import edge_keys
    >>> edge_keys(np.array([0, 3]), np.array([2, 1]), 10).tolist()
    [2, 13]
    """
    keys: NDArray[np.int64] = np.minimum(a, b).astype(np.int64) * npoints + np.maximum(a, b)
    return keys


def among(keys: NDArray[np.int64], others: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which numbers are among others.

    Parameters
    ----------
    keys : ndarray of int64
        Numbers.
    others : ndarray of int64, shape (k,)
        Others, in any order.

    Returns
    -------
    ndarray of bool
        In the shape of `keys`.

    Notes
    -----
    O(log k) for each. The hash table of ``numpy.isin`` is several times slower on keys of edges.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.topology import among
    >>> among(np.array([1, 5, 9]), np.array([9, 1]))
    array([ True, False,  True])
    """
    if not len(others):
        return np.zeros(keys.shape, dtype=bool)
    ordered = np.sort(others)
    place = np.minimum(np.searchsorted(ordered, keys), len(ordered) - 1)
    found: NDArray[np.bool_] = ordered[place] == keys
    return found
