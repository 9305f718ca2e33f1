"""The function that subdivides faces where they touch."""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone import _core
from delone._base.arrays import as_workers
from delone.solids.surface.check import as_faces, as_pairs
from delone.solids.surface.report import crossing_error

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

__all__ = ["resolve_touches"]

# Pairs that an error lists.
_LISTED = 100_000


def resolve_touches(
    points: ArrayLike, faces: ArrayLike, *, workers: int | None = None
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Subdivide faces at vertices and edges of others on them; no point is added or moved.

    In the result, two faces have nothing in common but vertices and edges.

    Parameters
    ----------
    points : array_like of float, shape (n, 3)
        Coordinates. Rows with equal coordinates are one vertex, their first row.
    faces : array_like of int, shape (m, 3)
        The vertices of each triangle, rows of `points`.
    workers : int, optional
        Number of threads; by default one per core. The result does not depend on it.

    Returns
    -------
    faces : ndarray of int32, shape (k, 3)
        The vertices of each triangle, oriented like its source. Degenerate triangles are left out;
        triangles of several sources, where faces repeat others or overlap, occur once.
    source : ndarray of int32, shape (k,)
        The first face of the input that contains each triangle, ascending.

    Raises
    ------
    CrossingFacesError
        Faces cross at points that are not vertices of both, or interiors cross; see
        `check_surface`.
    NonFiniteError, ShapeError, DtypeError, InputError, MemoryError
        As for `check_surface`.

    See Also
    --------
    check_surface : Find faces that touch or cross.

    Notes
    -----
    Each face becomes the constrained Delaunay triangulation of the vertices on it, projected along
    an axis, with the edges of others on it as segments. All decisions are exact. The set of
    triangles does not depend on the order of points and faces. T-junctions are closed, faces with
    collinear corners disappear, and where faces overlap in one plane, only one copy of each
    triangle remains.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (2, 0, 0), (2, -1, 0)]
    >>> faces, source = delone.resolve_touches(points, [(0, 1, 2), (3, 0, 4), (3, 4, 1)])
    >>> source.tolist()
    [0, 0, 1, 2]
    >>> sorted(sorted(face) for face in faces[:2].tolist())
    [[0, 2, 3], [1, 2, 3]]
    """
    given, rows = as_faces(points, faces)
    made, pairs = _core.resolve_touches3(given, rows, _LISTED, as_workers(workers))
    if made is None:
        found, kinds, crossing = as_pairs(pairs)
        raise crossing_error(found[crossing], kinds[crossing], pairs.ncrossing)
    return made
