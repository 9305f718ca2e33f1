"""Interpolation in space: where queries lie, what counts beyond the hull, slopes in tetrahedra.

These are the parts of interpolators that tell the plane from space; everything else is the same. On
a face of the hull the interpolants here depend on its three corners alone, or nearly so, and are
taken as linear there for what lies beyond.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._arrays import as_workers
from delone.errors import InputError
from delone.interpolate.hull import Terms
from delone.space import geometry

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.triangulation import Triangulation

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["SPACE", "SpacePlace", "face_terms", "hull_gradients", "place_of", "refuse", "slopes"]

SPACE = 3


def refuse(what: str, instead: str) -> None:
    """Refuse what is there in the plane only.

    Parameters
    ----------
    what : str
        What was asked for.
    instead : str
        What there is in space.

    Raises
    ------
    InputError
        Always.
    """
    raise InputError(f"{what} is for points in the plane; in space {instead}")


@dataclass(frozen=True, eq=False)
class SpacePlace:
    """Where queries in space lie, and what of the hull is nearest.

    Parameters
    ----------
    simplex : ndarray of int32, shape (k,)
        The tetrahedron that holds the query, the first one where there are several; -1 outside.
    barycentric : ndarray of float64, shape (k, 4)
        Weights of its corners; NaN outside.
    nearest : ndarray of float64, shape (k, 3)
        The query itself inside; outside the nearest point of the hull; NaN where it is not finite.
    beside : ndarray of int32, shape (k,)
        Outside, the number of the face with that point; else -1.
    face : ndarray of int32, shape (k, 3)
        Outside, the corners of that face; else -1.
    shares : ndarray of float64, shape (k, 3)
        Outside, how they share in that point; else NaN.
    """

    simplex: Indices
    barycentric: Floats
    nearest: Floats
    beside: Indices
    face: Indices
    shares: Floats

    def at(self, rows: NDArray[np.integer]) -> SpacePlace:
        """Return some of the places.

        Parameters
        ----------
        rows : ndarray of int
            Which, along the first axis.

        Returns
        -------
        SpacePlace
            Those.
        """
        return SpacePlace(*(getattr(self, each.name)[rows] for each in fields(self)))


def place_of(mesh: Triangulation, queries: Floats, workers: int | None) -> SpacePlace:
    """Tell where queries lie.

    Parameters
    ----------
    mesh : Triangulation
        Of points in space.
    queries : ndarray of float64, shape (k, 3)
        Where.
    workers : int or None
        Number of threads.

    Returns
    -------
    SpacePlace
        One for each.
    """
    threads = as_workers(workers)
    index: Any = mesh._locator
    simplex, barycentric, _ = index.locate(queries, threads)
    count = len(queries)
    nearest = np.where((simplex >= 0)[:, None], queries, np.nan)
    beside = np.full(count, -1, dtype=np.int32)
    face = np.full((count, 3), -1, dtype=np.int32)
    shares = np.full((count, 3), np.nan)
    rows = np.flatnonzero((simplex < 0) & np.isfinite(queries).all(axis=1))
    if rows.size:
        hull = np.ascontiguousarray(mesh.convex_hull)
        which, share = _core.nearest_on_faces3(mesh.points, hull, queries[rows], threads)
        beside[rows], face[rows], shares[rows] = which, hull[which], share
        # The corner itself, exactly, where it alone counts.
        terms = np.where(share[..., None] == 0, 0.0, share[..., None] * mesh.points[face[rows]])
        nearest[rows] = terms.sum(axis=1)
    return SpacePlace(simplex, barycentric, nearest, beside, face, shares)


def face_terms(place: SpacePlace, step: Floats, *, base: bool = True) -> Terms:
    """Return the terms of a linear interpolant on the hull, and of how it goes on from there.

    Parameters
    ----------
    place : SpacePlace
        Queries outside.
    step : ndarray of float64, shape (k, 3)
        How far to go from the nearest points of the hull.
    base : bool, optional
        Count the value at the nearest point; otherwise only what the step adds.

    Returns
    -------
    Terms
        For the corners of the faces; without slopes where nothing goes by gradients.
    """
    weights = place.shares if base else np.zeros_like(place.shares)
    slopes = place.shares[..., None] * step[:, None]
    return Terms(place.face, weights, slopes if step.any() else None)


def slopes(points: Floats, corners: Indices, columns: Floats) -> Floats:
    """Return the slopes of the linear functions with given values at corners of tetrahedra.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    corners : ndarray of int32, shape (k, 4)
        Tetrahedra, none of them flat.
    columns : ndarray of float64, shape (n, c)
        Values at the points.

    Returns
    -------
    ndarray of float64, shape (k, c, 3)
        Derivatives by x, y and z.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.interpolate.space import slopes
    >>> points = np.array([(0.0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)])
    >>> slopes(points, np.array([(0, 1, 2, 3)]), np.array([[1.0], [3.0], [5.0], [7.0]]))
    array([[[1., 2., 3.]]])
    """
    # Barycentric coordinates have the rows of these maps for their slopes.
    maps = geometry.transform(points, corners)[:, :SPACE]
    rise = columns[corners[:, :SPACE]] - columns[corners[:, SPACE:]]
    found: Floats = np.einsum("kic,kij->kcj", rise, maps)
    return found


def hull_gradients(mesh: Triangulation, columns: Floats) -> Floats:
    """Return, at vertices of the hull, the slopes of linear functions that fit neighbours best.

    Parameters
    ----------
    mesh : Triangulation
        Of points in space.
    columns : ndarray of float64, shape (n, c)
        Values at the points.

    Returns
    -------
    ndarray of float64, shape (n, c, 3)
        Derivatives by x, y and z; 0 at other vertices.

    Notes
    -----
    Neighbours count by the inverse square of their distance. Where they lie in one plane the slope
    across it is 0.
    """
    found = np.zeros((mesh.npoints, columns.shape[1], 3))
    rows = np.unique(mesh.convex_hull)
    indptr, indices = mesh.vertex_neighbor_vertices
    count = np.diff(indptr)[rows]
    owner = np.repeat(np.arange(len(rows)), count)
    first = np.repeat(indptr[rows].astype(np.int64), count)
    ends = np.cumsum(count)
    beside = indices[first + np.arange(len(owner)) - np.repeat(ends - count, count)]
    way = mesh.points[beside] - mesh.points[rows][owner]
    longest = np.sqrt((way**2).sum(axis=1))
    way /= longest[:, None]
    rise = (columns[beside] - columns[rows][owner]) / longest[:, None]
    begins = ends - count
    matrix = np.add.reduceat(way[:, :, None] * way[:, None], begins, axis=0)
    right = np.add.reduceat(way[:, :, None] * rise[:, None], begins, axis=0)
    solved = np.linalg.pinv(matrix, hermitian=True) @ right
    found[rows] = np.moveaxis(solved, 1, 2)
    return found
