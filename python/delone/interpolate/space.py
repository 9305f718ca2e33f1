"""Interpolation in 3-D: extrapolation beyond the hull, gradients in tetrahedra.

These are the parts of the interpolators that differ between 2-D and 3-D. On a face of the hull the
interpolants here depend on its three corners, exactly or almost, and extrapolation takes them as
linear there.
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
    """Raise for what is only available in 2-D.

    Parameters
    ----------
    what : str
        What the caller asked for.
    instead : str
        What to use in 3-D.

    Raises
    ------
    InputError
        Always.
    """
    raise InputError(f"{what} is only available in 2-D; in 3-D {instead}")


def face_terms(place: Location, step: Floats, *, base: bool = True) -> Terms:
    """Return the terms of a linear interpolant on the hull, and of how it goes on from there.

    Parameters
    ----------
    place : Location
        Queries outside.
    step : ndarray of float64, shape (k, 3)
        Steps from the nearest points of the hull.
    base : bool, optional
        Include the value at the nearest point; otherwise only the contribution of the step.

    Returns
    -------
    Terms
        For the corners of the faces; without slopes if no gradients are used.
    """
    weights = place.weights if base else np.zeros_like(place.weights)
    slopes = place.weights[..., None] * step[:, None]
    return Terms(place.facet, weights, slopes if step.any() else None)


def slopes(points: Floats, corners: Indices, columns: Floats) -> Floats:
    """Return the gradients of the linear functions with given values at corners of tetrahedra.

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
    # The rows of these maps are the gradients of the barycentric coordinates.
    maps = geometry.transform(points, corners)[:, :SPACE]
    rise = columns[corners[:, :SPACE]] - columns[corners[:, SPACE:]]
    found: Floats = np.einsum("kic,kij->kcj", rise, maps)
    return found


def hull_gradients(mesh: Triangulation, columns: Floats, workers: int) -> Floats:
    """Return the gradients of the best-fitting linear functions at the vertices of the hull.

    Parameters
    ----------
    mesh : Triangulation
        A triangulation of 3-D points.
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
    Neighbors are weighted by the inverse square of their distance, limited by the rounding of the
    values where they nearly coincide. If they do not determine the gradient, or only barely, their
    neighbors are used as well; if these also lie in one plane, the slope across it is 0.
    """
    found = np.zeros((mesh.npoints, columns.shape[1], SPACE))
    rows = np.unique(mesh.boundary)
    around = mesh.vertex_neighbor_vertices
    found[rows] = _core.gradients_local3(mesh.points, *around, columns, rows, workers)
    return found
