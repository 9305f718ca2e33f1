"""Topology of tetrahedra: edges, faces, boundary, neighbors.

Needs neither coordinates nor predicates. The input must be a triangulation as the core exports it:
tetrahedra are positively oriented, `neighbors[t, k]` is across the face opposite vertex k, -1
outside.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._arrays import as_workers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Indices = NDArray[np.int32]

__all__ = ["FACES", "boundary_faces", "edges", "faces", "neighbors"]

# The face opposite vertex k, counter-clockwise as seen from outside.
FACES = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]


def edges(simplices: Indices, npoints: int, workers: int | None = None) -> Indices:
    """Return every edge once.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.
    npoints : int
        Number of points.
    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of int32, shape (k, 2)
        The smaller vertex first, rows ascending.

    Notes
    -----
    O(m).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.topology import edges
    >>> edges(np.array([[0, 1, 2, 3]], dtype=np.int32), 4).tolist()
    [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
    """
    return _core.edges3(simplices, npoints, as_workers(workers))


def faces(
    simplices: Indices, neighbors: Indices, npoints: int, workers: int | None = None
) -> Indices:
    """Return every face once.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.
    neighbors : ndarray of int32, shape (m, 4)
        The tetrahedron opposite each vertex.
    npoints : int
        Number of points.
    workers : int or None, optional
        Number of threads; by default all cores.

    Returns
    -------
    ndarray of int32, shape (k, 3)
        Vertices ascending in each row, rows ascending.

    Notes
    -----
    O(m).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.topology import faces
    >>> alone = np.array([[0, 1, 2, 3]], dtype=np.int32), np.full((1, 4), -1, dtype=np.int32)
    >>> faces(*alone, 4).tolist()
    [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    """
    return _core.faces3(simplices, neighbors, npoints, as_workers(workers))


def boundary_faces(simplices: Indices, neighbors: Indices) -> Indices:
    """Return the faces that have a tetrahedron on one side only.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.
    neighbors : ndarray of int32, shape (m, 4)
        The tetrahedron opposite each vertex.

    Returns
    -------
    ndarray of int32, shape (h, 3)
        Counter-clockwise as seen from outside, in the order of the tetrahedra.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.topology import boundary_faces
    >>> boundary_faces(np.array([[0, 1, 2, 3]]), np.array([[-1, 0, -1, 0]])).tolist()
    [[1, 2, 3], [0, 1, 3]]
    """
    simplex, corner = np.nonzero(neighbors < 0)
    return np.take_along_axis(simplices[simplex], np.array(FACES)[corner], axis=1)


def neighbors(simplices: Indices) -> Indices:
    """Return the tetrahedron opposite each vertex.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra, all with the same orientation; no face is used more than twice.

    Returns
    -------
    ndarray of int32, shape (m, 4)
        Tetrahedra, -1 if there is none.

    Notes
    -----
    O(m log m).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.topology import neighbors
    >>> neighbors(np.array([[0, 1, 2, 3], [4, 1, 3, 2]])).tolist()
    [[1, -1, -1, -1], [0, -1, -1, -1]]
    """
    sides = np.sort(simplices[:, FACES].reshape(-1, 3), axis=1)
    order = np.lexsort(sides.T)
    pair = np.flatnonzero((sides[order[1:]] == sides[order[:-1]]).all(axis=1))
    found = np.full(4 * len(simplices), -1, dtype=np.int32)
    one, other = order[pair], order[pair + 1]
    found[one], found[other] = other // 4, one // 4
    return found.reshape(-1, 4)
