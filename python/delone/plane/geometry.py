"""Measures of triangles: areas, circumcenters, barycentric transforms.

The core computes them in stages: values that suffer cancellation in thin triangles are computed
again with more digits. Points must be finite, and triangles exactly counter-clockwise.
"""

from __future__ import annotations

from math import fsum, inf
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._arrays import as_mesh, as_workers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["areas", "circumcenters", "edge_normals", "total", "transform"]


def areas(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return the areas of triangles.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.

    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of float64, shape (m,)
        With a relative error below 1e-13, unless the area is beyond the range of doubles (then inf,
        or rounded to a subnormal number).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import areas
    >>> areas(np.array([(0, 0), (4, 0), (0, 3.0)]), np.array([[0, 1, 2]], dtype=np.int32))
    array([6.])
    """
    return _core.areas2(*as_mesh(points, simplices), as_workers(workers))


def transform(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return the affine maps from coordinates to barycentric coordinates.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.

    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of float64, shape (m, 3, 2)
        For each triangle, the inverse of the matrix whose columns are the vectors from the last
        corner to the first two, and below it the last corner. Entries have a relative error below
        1e-13, unless they are beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import transform
    >>> transform(np.array([(4, 0), (4, 2), (2, 1.0)]), np.array([[0, 1, 2]], dtype=np.int32))
    array([[[ 0.25, -0.5 ],
            [ 0.25,  0.5 ],
            [ 2.  ,  1.  ]]])
    """
    return _core.transforms2(*as_mesh(points, simplices), as_workers(workers))


def circumcenters(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return the centers of the circles through the corners of triangles.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.

    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of float64, shape (m, 2)
        Each coordinate within 4 units in the last place; infinite if it is beyond the range of
        doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import circumcenters
    >>> circumcenters(np.array([(0, 0), (4, 0), (2, 1.0)]), np.array([[0, 1, 2]], dtype=np.int32))
    array([[ 2. , -1.5]])
    """
    return _core.circumcenters2(*as_mesh(points, simplices), as_workers(workers))


def edge_normals(points: Floats, edges: Indices) -> Floats:
    """Return the unit normals of edges, to their right.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    edges : ndarray of int32, shape (k, 2)
        Tails and heads, with different coordinates.

    Returns
    -------
    ndarray of float64, shape (k, 2)
        With an error below 1e-15.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import edge_normals
    >>> edge_normals(np.array([(1, 1), (1, 5.0)]), np.array([[0, 1], [1, 0]]))
    array([[ 1.,  0.],
           [-1.,  0.]])
    """
    # Halve the coordinates if their difference overflows, and scale by a power of two, so that
    # small differences keep their bits.
    ends = points[edges]
    with np.errstate(over="ignore"):
        along = ends[:, 1] - ends[:, 0]
        wide = ~np.isfinite(along).all(axis=1)
    along[wide] = ends[wide, 1] / 2 - ends[wide, 0] / 2
    exponent = np.frexp(np.abs(along).max(axis=1))[1]
    along = np.ldexp(along, -exponent[:, None])
    normals = np.column_stack((along[:, 1], -along[:, 0]))
    normals /= np.hypot(normals[:, 0], normals[:, 1])[:, None]
    # Adding 0 turns -0 into 0.
    return normals + 0.0


def total(sizes: Floats) -> float:
    """Return the sum of sizes, rounded once.

    Parameters
    ----------
    sizes : ndarray of float64, shape (m,)
        Lengths, areas or volumes; not negative.

    Returns
    -------
    float
        Infinite if the sum is beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import total
    >>> total(np.array([0.1] * 10)), total(np.array([1e308, 1e308]))
    (1.0, inf)
    """
    try:
        return fsum(sizes.tolist())
    except OverflowError:
        return inf
