"""Measures of tetrahedra: volumes, circumcenters, barycentric transforms.

The core computes them in stages: values that suffer cancellation in slivers are computed again with
more digits. Points must be finite, and tetrahedra exactly positively oriented.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone import _core
from delone._arrays import as_mesh, as_workers

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["circumcenters", "face_areas", "face_normals", "transform", "volumes"]


def volumes(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return the volumes of tetrahedra.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.

    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of float64, shape (m,)
        With a relative error below 1e-13, unless the volume is beyond the range of doubles (then
        inf, or rounded to a subnormal number).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import volumes
    >>> corners = np.array([(0, 0, 0), (3, 0, 0), (0, 2, 0), (0, 0, 4.0)])
    >>> volumes(corners, np.array([[0, 1, 2, 3]], dtype=np.int32))
    array([4.])
    """
    return _core.volumes3(*as_mesh(points, simplices), as_workers(workers))


def transform(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return the affine maps from coordinates to barycentric coordinates.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.

    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of float64, shape (m, 4, 3)
        For each tetrahedron, the inverse of the matrix whose columns are the vectors from the last
        corner to the first three, and below it the last corner. Each row has an error below 1e-13
        of its length, unless it is beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import transform
    >>> corners = np.array([(4, 0, 0), (0, 2, 0), (0, 0, 8), (0, 0, 0.0)])
    >>> transform(corners, np.array([[0, 2, 1, 3]], dtype=np.int32))
    array([[[0.25 , 0.   , 0.   ],
            [0.   , 0.   , 0.125],
            [0.   , 0.5  , 0.   ],
            [0.   , 0.   , 0.   ]]])
    """
    return _core.transforms3(*as_mesh(points, simplices), as_workers(workers))


def circumcenters(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return the centers of the spheres through the corners of tetrahedra.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.

    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of float64, shape (m, 3)
        Each coordinate within 4 units in the last place; infinite if it is beyond the range of
        doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import circumcenters
    >>> corners = np.array([(0, 0, 0), (4, 0, 0), (0, 2, 0), (0, 0, 6.0)])
    >>> circumcenters(corners, np.array([[0, 1, 2, 3]], dtype=np.int32))
    array([[2., 1., 3.]])
    """
    return _core.circumcenters3(*as_mesh(points, simplices), as_workers(workers))


def face_normals(points: Floats, faces: Indices, workers: int | None = None) -> Floats:
    """Return the unit normals of triangles in 3-D.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    faces : ndarray of int32, shape (m, 3)
        Triangles, none of them degenerate.

    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of float64, shape (m, 3)
        Pointing to the side from which the triangle is counter-clockwise, with an error below
        1e-14.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import face_normals
    >>> corners = np.array([(0, 0, 5), (2, 0, 5), (0, 3, 5.0)])
    >>> face_normals(corners, np.array([[0, 1, 2]], dtype=np.int32))
    array([[0., 0., 1.]])
    """
    return _core.face_normals3(*as_mesh(points, faces), as_workers(workers))


def face_areas(points: Floats, faces: Indices, workers: int | None = None) -> Floats:
    """Return the areas of triangles in 3-D.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    faces : ndarray of int32, shape (m, 3)
        Triangles, none of them degenerate.

    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of float64, shape (m,)
        With a relative error below 1e-14, unless the area is beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import face_areas
    >>> corners = np.array([(0, 0, 5), (2, 0, 5), (0, 3, 5.0)])
    >>> face_areas(corners, np.array([[0, 1, 2]], dtype=np.int32))
    array([3.])
    """
    return _core.face_areas3(*as_mesh(points, faces), as_workers(workers))
