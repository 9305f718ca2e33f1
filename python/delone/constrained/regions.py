"""Areas between segments: which are outside, which are holes, how they are numbered and labelled.

An area is a connected component of triangles that share edges which are no segments; the core finds
these components. Everything here is arithmetic on their numbers. `Tiling` holds all triangles of
the convex hull. Whether a seed lies on a segment is asked of the exact predicates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = [
    "Tiling",
    "corners",
    "crossed",
    "labels",
    "located",
    "numbered",
    "on_edges",
    "outside",
]


class Tiling(NamedTuple):
    """All triangles of the convex hull, whether they are kept or not."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    constrained: Bools


def outside(tiling: Tiling, component: Indices) -> Bools:
    """Tell which components are reached from outside of the hull without crossing a segment.

    Parameters
    ----------
    tiling : Tiling
        The triangles.
    component : ndarray of int32, shape (m,)
        Component of each triangle.

    Returns
    -------
    ndarray of bool, shape (c,)
        One entry for each component.
    """
    found = np.zeros(int(component.max(initial=-1)) + 1, dtype=bool)
    open_to = ((tiling.neighbors < 0) & ~tiling.constrained).any(axis=1)
    found[component[open_to]] = True
    return found


def located(
    tiling: Tiling, seeds: Floats, segments: Indices, workers: int
) -> tuple[Indices, Bools]:
    """Tell in which triangles seeds lie, and which of them lie on a segment.

    Parameters
    ----------
    tiling : Tiling
        The triangles.
    seeds : ndarray of float64, shape (k, 2)
        The seeds.
    segments : ndarray of int32, shape (q, 2)
        All subsegments.
    workers : int
        Number of threads.

    Returns
    -------
    triangle : ndarray of int32, shape (k,)
        Triangles of the tiling; -1 outside.
    on_segment : ndarray of bool, shape (k,)
        Whether the seed is a point of a segment, its ends included.
    """
    points, simplices, neighbors, constrained = tiling
    triangle = _core.find_simplex2(points, simplices, neighbors, seeds, workers)
    on_edge = on_edges(tiling, triangle, seeds)
    on_segment: Bools = np.any(on_edge & constrained[triangle], axis=1)
    rows, corner = corners(on_edge)
    has_segment = np.zeros(len(points), dtype=bool)
    has_segment[segments] = True
    on_segment[rows] = has_segment[simplices[triangle[rows], corner]]
    on_segment[triangle < 0] = False
    return triangle, on_segment


def on_edges(tiling: Tiling, triangle: Indices, queries: Floats) -> Bools:
    """Tell on which edges of their triangles points lie, (k, 3); any answer for triangle -1."""
    points, simplices = tiling.points, tiling.simplices
    found = np.empty((len(queries), 3), dtype=bool)
    for k in range(3):
        tail, head = simplices[triangle, k - 2], simplices[triangle, k - 1]
        found[:, k] = _core.orient2d(points[tail], points[head], queries) == 0
    return found


def corners(on_edge: Bools) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows that lie on two edges, and the corner where these meet."""
    rows = np.flatnonzero(on_edge.sum(axis=1) == 2)
    return rows, np.argmin(on_edge[rows], axis=1)


def numbered(points: Floats, simplices: Indices, component: Indices) -> Indices:
    """Number components in an order that hangs on coordinates alone.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.
    component : ndarray of int32, shape (m,)
        Component of each triangle, numbered in any way.

    Returns
    -------
    ndarray of int32, shape (m,)
        Components from 0 on, in the order of their smallest triangles. Triangles are compared by
        their smallest corners, then their middle ones, then their largest; corners by x, then y.

    Notes
    -----
    O(n log n).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.constrained.regions import numbered
    >>> square = np.array([(1.0, 0), (1, 1), (0, 1), (0, 0)])
    >>> numbered(square, np.array([(1, 3, 0), (1, 2, 3)]), np.array([0, 1])).tolist()
    [1, 0]
    """
    count = int(component.max(initial=-1)) + 1
    rank = np.empty(len(points), dtype=np.int64)
    rank[np.lexsort((points[:, 1], points[:, 0]))] = np.arange(len(points))
    ranks = np.sort(rank[simplices], axis=1)
    least = np.full(count, len(points), dtype=np.int64)
    np.minimum.at(least, component, ranks[:, 0])
    # Only triangles at the smallest vertex of their component can be its smallest.
    rows = np.flatnonzero(ranks[:, 0] == least[component])
    rows = rows[np.lexsort(ranks[rows].T[::-1])]
    present, where = np.unique(component[rows], return_index=True)
    new = np.full(count, -1, dtype=np.int32)
    new[present[np.argsort(where)]] = np.arange(len(present), dtype=np.int32)
    return new[component]


def labels(component: Indices, of_seed: Indices, given: Indices) -> tuple[Indices, Indices]:
    """Give components the labels of the seeds in them.

    Parameters
    ----------
    component : ndarray of int32, shape (m,)
        Component of each triangle.
    of_seed : ndarray of int32, shape (k,)
        Component of each seed, -1 where it lies in none.
    given : ndarray of int32, shape (k,)
        Label of each seed.

    Returns
    -------
    label : ndarray of int32, shape (m,)
        Label of each triangle, that of the first seed of its component; -1 without one.
    repeated : ndarray of int32, shape (r, 2)
        Seeds whose component has a label, and the seed that gave it.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.constrained.regions import labels
    >>> label, repeated = labels(np.array([0, 1, 0]), np.array([0, -1, 0]), np.array([7, 8, 9]))
    >>> label.tolist(), repeated.tolist()
    ([7, -1, 7], [[2, 0]])
    """
    seeds = np.flatnonzero(of_seed >= 0).astype(np.int32)
    first = np.full(int(component.max(initial=-1)) + 1, -1, dtype=np.int32)
    # Where an index is repeated, the last value is the one that stays.
    first[of_seed[seeds[::-1]]] = seeds[::-1]
    label = np.full(len(first), -1, dtype=np.int32)
    label[first >= 0] = given[first[first >= 0]]
    later = seeds[first[of_seed[seeds]] != seeds]
    return label[component], np.column_stack((later, first[of_seed[later]]))


def crossed(tiling: Tiling, along: Indices, a: Floats, b: Floats) -> Indices:
    """Return the edges of segments that a straight way crosses, in order.

    Parameters
    ----------
    tiling : Tiling
        The triangles.
    along : ndarray of int32, shape (k,)
        The triangles that the way meets, in order.
    a, b : ndarray of float64, shape (2,)
        The ends of the way.

    Returns
    -------
    ndarray of int32, shape (c, 2)
        Ends of the edges.
    """
    corner = np.tile(np.arange(3), len(along))
    triangle = np.repeat(along, 3)
    tail, head = (tiling.simplices[triangle, (corner + i) % 3] for i in (1, 2))
    u, v = tiling.points[tail], tiling.points[head]
    start, end = np.broadcast_to(a, u.shape).copy(), np.broadcast_to(b, u.shape).copy()
    of_a, of_b = _core.orient2d(u, v, start), _core.orient2d(u, v, end)
    sides = _core.orient2d(start, end, u) * _core.orient2d(start, end, v)
    proper = (sides < 0) & (of_a * of_b < 0) & tiling.constrained[triangle, corner]
    # The way leaves a triangle by an edge that has its end outside. What it enters by it has left
    # before, except where it enters the hull.
    leaves = proper & (of_b < 0)
    enters = proper & (of_a < 0) & (tiling.neighbors[triangle, corner] < 0)
    rows = np.concatenate((np.flatnonzero(enters), np.flatnonzero(leaves)))
    return np.column_stack((tail[rows], head[rows]))
