"""Point location in triangles: the nearest points of boundary edges, and walks along segments."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["across_line", "along", "located", "on_edges"]


def located(
    index: _core.Locator2, xi: Floats, workers: int
) -> tuple[Indices, Floats, Indices, Indices, Floats]:
    """Locate points in triangles.

    Parameters
    ----------
    index : Locator2
        The index over the triangles.
    xi : ndarray of float64, shape (k, 2)
        The points.
    workers : int
        Number of threads.

    Returns
    -------
    simplex, barycentric, beside, facet, weights : ndarray
        As in `delone.location.Location`.
    """
    found = index.locate(xi, workers)
    weights = np.column_stack((1.0 - found.along, found.along))
    return found.simplex, found.weights, found.beside, found.edge, weights


def on_edges(points: Floats, edge: Indices, weights: Floats) -> Floats:
    """Return points on edges; if a weight is 1, exactly that end.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    edge : ndarray of int32, shape (k, 2)
        Ends of the edges.
    weights : ndarray of float64, shape (k, 2)
        Weights of the ends; their sum is 1.

    Returns
    -------
    ndarray of float64, shape (k, 2)
        The points.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.location import on_edges
    >>> on_edges(np.array([(0.0, 0), (4, 2)]), np.array([(0, 1)]), np.array([(0.75, 0.25)]))
    array([[1. , 0.5]])
    """
    start, end = points[edge[:, 0]], points[edge[:, 1]]
    return weights[:, :1] * start + weights[:, 1:] * end


def along(
    index: _core.Locator2,
    tiling: tuple[Floats, Indices, Indices],
    number: Indices | None,
    a: Floats,
    b: Floats,
) -> Indices:
    """Return the triangles along a segment.

    Parameters
    ----------
    index : Locator2
        The index over all triangles of the convex hull.
    tiling : tuple
        Their points, simplices and neighbors.
    number : ndarray of int32, shape (m + 1,), or None
        The row of each triangle among those that are kept, -1 if it is removed; the last entry is
        -1. None if all are kept.
    a, b : ndarray of float64, shape (2,)
        Ends of the segment, finite; they must differ if `number` is given.

    Returns
    -------
    ndarray of int32, shape (k,)
        Triangles from a to b.
    """
    met = index.along(a, b)
    if number is None:
        return met
    found = number[met]
    removed = found < 0
    found[removed] = number[across_line(*tiling, met[removed], a, b)]
    kept: Indices = found[found >= 0]
    return kept


def across_line(  # noqa: PLR0917 (a tiling is three arrays)
    points: Floats, simplices: Indices, neighbors: Indices, triangle: Indices, a: Floats, b: Floats
) -> Indices:
    """Return the neighbors of triangles across their edges on the line through two points.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices, neighbors : ndarray of int32, shape (m, 3)
        Triangles, and those across their edges.
    triangle : ndarray of int32, shape (k,)
        Some of them.
    a, b : ndarray of float64, shape (2,)
        The points, which differ.

    Returns
    -------
    ndarray of int32, shape (k,)
        Triangles, -1 if there is no such edge, or no triangle beyond it.
    """
    corners = points[simplices[triangle]].reshape(-1, 2)
    start, end = np.broadcast_to(a, corners.shape).copy(), np.broadcast_to(b, corners.shape).copy()
    off = (_core.orient2d(start, end, corners) != 0).reshape(-1, 3)
    found = neighbors[triangle, off.argmax(axis=1)]
    return np.where(off.sum(axis=1) == 1, found, np.int32(-1))
