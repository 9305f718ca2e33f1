"""Results of point location: triangle, barycentric weights, nearest point of the boundary.

The core keeps an index of starts for the walks (`Locator2`); a triangulation makes it on the first
query and holds it. Decisions are exact; weights and the nearest points of the boundary are rounded
results of them.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._arrays import as_vectors, as_workers, require_finite
from delone.blocks import blocks
from delone.errors import ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = [
    "Location",
    "Places",
    "across_line",
    "along",
    "locate",
    "locator",
    "nearest",
    "segment_ends",
]


class Places:
    """Rows of arrays, one for each point; the base of `Location` and of its like in space."""

    def at(self, rows: NDArray[np.integer]) -> Self:
        """Return some of the places.

        Parameters
        ----------
        rows : ndarray of int
            Which, along the first axis.

        Returns
        -------
        Self
            Those.
        """
        own: Any = self
        return type(self)(*(getattr(self, each.name)[rows] for each in fields(own)))


@dataclass(frozen=True, eq=False)
class Location(Places):
    """Where points lie.

    Parameters
    ----------
    simplex : ndarray of int32, shape (...)
        The triangle that holds the point, the first one where there are several; -1 outside.
    barycentric : ndarray of float64, shape (..., 3)
        Weights of the corners of that triangle: none below 0, of sum 1 up to rounding, exactly 1 at
        a corner. NaN outside.
    nearest : ndarray of float64, shape (..., 2)
        The point itself inside; outside the nearest point of the boundary, rounded. NaN where the
        query is not finite.
    beside : ndarray of int32, shape (...)
        Outside, the triangle at that point of the boundary; else -1.
    edge : ndarray of int32, shape (..., 2)
        Outside, the boundary edge with that point, the triangle to its left; else -1.
    along : ndarray of float64, shape (...)
        Outside, how far along that edge the point is, from 0 to 1; else NaN.

    Examples
    --------
    >>> from delone import Delaunay
    >>> place = Delaunay([(0, 0), (4, 0), (0, 4)]).locate([(1, 2), (3, 3)])
    >>> place.simplex.tolist(), sorted(place.barycentric[0].tolist())
    ([0, -1], [0.25, 0.25, 0.5])
    >>> place.edge[1].tolist(), float(place.along[1]), place.nearest[1].tolist()
    ([1, 2], 0.5, [2.0, 2.0])
    """

    simplex: Indices
    barycentric: Floats
    nearest: Floats
    beside: Indices
    edge: Indices
    along: Floats


def locator(points: Floats, simplices: Indices, neighbors: Indices) -> _core.Locator2:
    """Return the core's index over triangles, for any number of queries by any number of threads.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices, neighbors : ndarray of int32, shape (m, 3)
        Triangles, and the ones across their edges.

    Returns
    -------
    Locator2
        Its methods are those of the core.
    """
    return _core.Locator2(points, simplices, neighbors)


def locate(index: _core.Locator2, points: Floats, xi: ArrayLike, workers: int | None) -> Location:
    """Tell where queries lie.

    Parameters
    ----------
    index : Locator2
        The index over the triangles.
    points : ndarray of float64, shape (n, 2)
        Coordinates of the vertices.
    xi : array_like, shape (..., 2)
        Queries.
    workers : int or None
        Number of threads.

    Returns
    -------
    Location
        In the shape of the queries.

    Raises
    ------
    ShapeError, DtypeError
        `xi` is no array of real points in the plane.
    """
    queries = as_vectors(xi, 2, name="xi")
    flat, leading = queries.reshape(-1, 2), queries.shape[:-1]
    found = index.locate(flat, as_workers(workers))
    nearest = np.empty_like(flat)
    for block in blocks(len(flat)):
        nearest[block] = np.where((found.simplex[block] >= 0)[:, None], flat[block], np.nan)
    rows = np.flatnonzero(found.beside >= 0)
    nearest[rows] = on_edges(points, found.edge[rows], found.along[rows])
    return Location(
        found.simplex.reshape(leading),
        found.weights.reshape((*leading, 3)),
        nearest.reshape((*leading, 2)),
        found.beside.reshape(leading),
        found.edge.reshape((*leading, 2)),
        found.along.reshape(leading),
    )


def on_edges(points: Floats, edge: Indices, share: Floats) -> Floats:
    """Return points of edges, exactly the ends where the share is 0 or 1.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    edge : ndarray of int32, shape (k, 2)
        Ends of the edges.
    share : ndarray of float64, shape (k,)
        From 0 to 1.

    Returns
    -------
    ndarray of float64, shape (k, 2)
        The points.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.location import on_edges
    >>> on_edges(np.array([(0.0, 0), (4, 2)]), np.array([(0, 1)]), np.array([0.25]))
    array([[1. , 0.5]])
    """
    weight = share[:, None]
    start, end = points[edge[:, 0]], points[edge[:, 1]]
    return (1.0 - weight) * start + weight * end


def nearest(
    sites: tuple[_core.Locator2 | None, Indices | None], xi: ArrayLike, workers: int | None
) -> Indices:
    """Return the sites that are nearest to queries.

    Parameters
    ----------
    sites : tuple
        The index over a Delaunay triangulation, None without triangles, and the row of each of its
        points; None where that is the same.
    xi : array_like, shape (..., 2)
        Queries.
    workers : int or None
        Number of threads.

    Returns
    -------
    ndarray of int32, shape (...)
        Rows; -1 for what is not finite.

    Raises
    ------
    ShapeError, DtypeError
        `xi` is no array of real points in the plane.
    """
    queries = as_vectors(xi, 2, name="xi")
    index, rows = sites
    if index is None:
        return np.full(queries.shape[:-1], -1, dtype=np.int32)
    found = index.nearest(queries.reshape(-1, 2), as_workers(workers))
    if rows is not None:
        found = np.where(found >= 0, rows[found], np.int32(-1))
    return found.reshape(queries.shape[:-1])


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
        Their points, simplices and neighbours.
    number : ndarray of int32, shape (m + 1,), or None
        What each triangle is among those that count, -1 where it is none; the last entry is -1.
        None where all count.
    a, b : ndarray of float64, shape (2,)
        Ends of the segment, finite; they differ where there are numbers.

    Returns
    -------
    ndarray of int32, shape (k,)
        Triangles from a to b.
    """
    met = index.along(a, b)
    if number is None:
        return met
    found = number[met]
    gone = found < 0
    found[gone] = number[across_line(*tiling, met[gone], a, b)]
    kept: Indices = found[found >= 0]
    return kept


def across_line(  # noqa: PLR0917 (a tiling is three arrays)
    points: Floats, simplices: Indices, neighbors: Indices, triangle: Indices, a: Floats, b: Floats
) -> Indices:
    """Return the neighbours of triangles across their edges on the line through two points.

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
        Triangles, -1 where there is no such edge or nothing beyond it.
    """
    corners = points[simplices[triangle]].reshape(-1, 2)
    start, end = np.broadcast_to(a, corners.shape).copy(), np.broadcast_to(b, corners.shape).copy()
    off = (_core.orient2d(start, end, corners) != 0).reshape(-1, 3)
    found = neighbors[triangle, off.argmax(axis=1)]
    return np.where(off.sum(axis=1) == 1, found, np.int32(-1))


def segment_ends(a: ArrayLike, b: ArrayLike) -> tuple[Floats, Floats]:
    """Return the ends of a segment.

    Parameters
    ----------
    a, b : array_like, shape (2,)
        The ends.

    Returns
    -------
    a, b : ndarray of float64, shape (2,)
        The same.

    Raises
    ------
    ShapeError, DtypeError
        An end is no point in the plane.
    NonFiniteError
        An end is not finite.
    """
    return _end(a, "a"), _end(b, "b")


def _end(point: ArrayLike, name: str) -> Floats:
    end = as_vectors(point, 2, name=name)
    if end.ndim != 1:
        raise ShapeError(f"{name} must be one point, got shape {end.shape}")
    require_finite(end.reshape(1, 2), name=name)
    return end
