"""Point location in tetrahedra: the nearest points of boundary faces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone import _core

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["located", "on_faces"]


def located(
    index: _core.Locator3, xi: Floats, workers: int
) -> tuple[Indices, Floats, Indices, Indices, Floats]:
    """Locate points in tetrahedra.

    Parameters
    ----------
    index : Locator3
        The index over the tetrahedra.
    xi : ndarray of float64, shape (k, 3)
        The points.
    workers : int
        Number of threads.

    Returns
    -------
    simplex, barycentric, beside, facet, weights : ndarray
        As in `delone.location.Location`.
    """
    found = index.locate(xi, workers)
    return found.simplex, found.weights, found.beside, found.face, found.shares


def on_faces(points: Floats, face: Indices, weights: Floats) -> Floats:
    """Return points on triangles, inside their boxes; exactly the corner if one weight is 1.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    face : ndarray of int32, shape (k, 3)
        Corners of the triangles.
    weights : ndarray of float64, shape (k, 3)
        Weights of the corners.

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
        (weights[..., None] * corners).sum(axis=1), corners.min(axis=1), corners.max(axis=1)
    )
    return found
