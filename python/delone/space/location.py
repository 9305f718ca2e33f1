"""Where points lie in tetrahedra: which one, the weights of its corners, the boundary beside.

The core keeps an index of starts for the walks (`Locator3`); what has tetrahedra makes it on the
first query and holds it. Decisions are exact; weights and the nearest points of the boundary are
rounded results of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone._arrays import as_vectors, as_workers
from delone.blocks import blocks
from delone.location import Places

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone import _core

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["SpaceLocation", "find", "locate", "nearest"]


@dataclass(frozen=True, eq=False)
class SpaceLocation(Places):
    """Where points lie in space.

    Parameters
    ----------
    simplex : ndarray of int32, shape (...)
        The tetrahedron that holds the point, the first one where there are several; -1 outside.
    barycentric : ndarray of float64, shape (..., 4)
        Weights of the corners of that tetrahedron: none below 0, of sum 1 up to rounding, exactly 1
        at a corner. NaN outside.
    nearest : ndarray of float64, shape (..., 3)
        The point itself inside; outside the nearest point of the boundary, rounded: it is on the
        face that is nearest by exact distances, of several the first one. NaN where the query is
        not finite.
    beside : ndarray of int32, shape (...)
        Outside, the tetrahedron at that point of the boundary; else -1.
    face : ndarray of int32, shape (..., 3)
        Outside, the corners of the boundary face with that point, counter-clockwise as seen from
        outside; else -1.
    shares : ndarray of float64, shape (..., 3)
        Outside, the weights of these corners in that point, none below 0, of sum 1 up to rounding;
        else NaN.

    Examples
    --------
    >>> from delone import Delaunay
    >>> place = Delaunay([(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]).locate((1, 1, -3))
    >>> int(place.simplex), place.nearest.tolist(), sorted(place.face.tolist())
    (-1, [1.0, 1.0, 0.0], [0, 1, 2])
    """

    simplex: Indices
    barycentric: Floats
    nearest: Floats
    beside: Indices
    face: Indices
    shares: Floats


def locate(
    index: _core.Locator3, points: Floats, xi: ArrayLike, workers: int | None
) -> SpaceLocation:
    """Tell where queries lie.

    Parameters
    ----------
    index : Locator3
        The core's index over the tetrahedra.
    points : ndarray of float64, shape (n, 3)
        Coordinates of the vertices.
    xi : array_like, shape (..., 3)
        Queries.
    workers : int or None
        Number of threads.

    Returns
    -------
    SpaceLocation
        In the shape of the queries.

    Raises
    ------
    ShapeError, DtypeError
        `xi` is no array of real points in space.
    """
    queries = as_vectors(xi, 3, name="xi")
    flat, leading = queries.reshape(-1, 3), queries.shape[:-1]
    found = index.locate(flat, as_workers(workers))
    close = np.empty_like(flat)
    for block in blocks(len(flat)):
        close[block] = np.where((found.simplex[block] >= 0)[:, None], flat[block], np.nan)
    rows = np.flatnonzero(found.beside >= 0)
    close[rows] = on_faces(points, found.face[rows], found.shares[rows])
    return SpaceLocation(
        found.simplex.reshape(leading),
        found.weights.reshape((*leading, 4)),
        close.reshape((*leading, 3)),
        found.beside.reshape(leading),
        found.face.reshape((*leading, 3)),
        found.shares.reshape((*leading, 3)),
    )


def on_faces(points: Floats, face: Indices, shares: Floats) -> Floats:
    """Return points of triangles: within their boxes, and exactly the corners where one counts.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    face : ndarray of int32, shape (k, 3)
        Corners of the triangles.
    shares : ndarray of float64, shape (k, 3)
        Their weights.

    Returns
    -------
    ndarray of float64, shape (k, 3)
        The points.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.location import on_faces
    >>> corners = np.array([(0.0, 0, 0), (4, 0, 0), (0, 4, 0)])
    >>> on_faces(corners, np.array([(0, 1, 2)]), np.array([(0.5, 0.25, 0.25)]))
    array([[1., 1., 0.]])
    """
    corners = points[face]
    found: Floats = np.clip(
        (shares[..., None] * corners).sum(axis=1), corners.min(axis=1), corners.max(axis=1)
    )
    return found


def find(index: _core.Locator3, xi: ArrayLike, workers: int | None) -> Indices:
    """Tell which tetrahedra hold queries.

    Parameters
    ----------
    index : Locator3
        The index over the tetrahedra.
    xi : array_like, shape (..., 3)
        Queries.
    workers : int or None
        Number of threads.

    Returns
    -------
    ndarray of int32, shape (...)
        The first tetrahedron that holds the query, -1 where there is none.

    Raises
    ------
    ShapeError, DtypeError
        `xi` is no array of real points in space.
    """
    queries = as_vectors(xi, 3, name="xi")
    return index.find(queries.reshape(-1, 3), as_workers(workers)).reshape(queries.shape[:-1])


def nearest(index: _core.Locator3, xi: ArrayLike, workers: int | None) -> Indices:
    """Return the vertices of a Delaunay triangulation that are nearest to queries.

    Parameters
    ----------
    index : Locator3
        The index over its tetrahedra.
    xi : array_like, shape (..., 3)
        Queries.
    workers : int or None
        Number of threads.

    Returns
    -------
    ndarray of int32, shape (...)
        The nearest vertex, of several the one of the smallest row; -1 for what is not finite.

    Raises
    ------
    ShapeError, DtypeError
        `xi` is no array of real points in space.
    """
    queries = as_vectors(xi, 3, name="xi")
    return index.nearest(queries.reshape(-1, 3), as_workers(workers)).reshape(queries.shape[:-1])
