"""Interpolation in space: what counts beyond the hull, slopes in tetrahedra.

These are the parts of interpolators that tell the plane from space; everything else is the same. On
a face of the hull the interpolants here depend on its three corners alone, or nearly so, and are
taken as linear there for what lies beyond.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone.errors import InputError
from delone.interpolate.hull import Terms
from delone.space import geometry

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.location import Location
    from delone.triangulation import Triangulation

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["SPACE", "face_terms", "hull_gradients", "refuse", "slopes"]

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


def face_terms(place: Location, step: Floats, *, base: bool = True) -> Terms:
    """Return the terms of a linear interpolant on the hull, and of how it goes on from there.

    Parameters
    ----------
    place : Location
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
    weights = place.weights if base else np.zeros_like(place.weights)
    slopes = place.weights[..., None] * step[:, None]
    return Terms(place.facet, weights, slopes if step.any() else None)


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


def hull_gradients(mesh: Triangulation, columns: Floats, workers: int) -> Floats:
    """Return, at vertices of the hull, the slopes of linear functions that fit neighbors best.

    Parameters
    ----------
    mesh : Triangulation
        Of points in 3-D.
    columns : ndarray of float64, shape (n, c)
        Values at the points.
    workers : int
        Number of threads.

    Returns
    -------
    ndarray of float64, shape (n, c, 3)
        Derivatives by x, y and z; 0 at other vertices.

    Notes
    -----
    Neighbors count by the inverse square of their distance, but no more than rounded values allow
    where they nearly coincide. Where they determine no slope, or hardly, their neighbors are asked
    as well; where these lie in one plane, too, the slope across it is 0.
    """
    found = np.zeros((mesh.npoints, columns.shape[1], SPACE))
    rows = np.unique(mesh.boundary)
    around = mesh.vertex_neighbor_vertices
    found[rows] = _core.gradients_local3(mesh.points, *around, columns, rows, workers)
    return found
