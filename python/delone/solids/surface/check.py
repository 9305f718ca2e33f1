"""The function that checks a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import LARGEST_LIMIT, as_limit, as_points, as_simplices, as_workers
from delone.solids.surface.report import KINDS, SurfaceCheck

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._core import CheckedSurface

__all__ = ["as_faces", "as_pairs", "check_surface", "checked"]


def check_surface(
    points: ArrayLike,
    faces: ArrayLike,
    *,
    limit: int | None = 100_000,
    workers: int | None = None,
) -> SurfaceCheck:
    """Check exactly what a surface of triangles in 3-D encloses, and which faces cross or touch.

    Parameters
    ----------
    points : array_like of float, shape (n, 3)
        Coordinates. Rows with equal coordinates are one vertex.
    faces : array_like of int, shape (m, 3)
        The vertices of each triangle, rows of `points`.
    limit : int, optional
        The maximum number of pairs of faces to list, crossing pairs first; all are counted. None
        lists all.
    workers : int, optional
        Number of threads; by default one per core. The result does not depend on it.

    Returns
    -------
    SurfaceCheck
        Truthy if no faces cross and the surface encloses a region.

    Raises
    ------
    NonFiniteError
        Coordinates are NaN or infinite.
    ShapeError, DtypeError, InputError
        The arguments are not such arrays, or vertices are not rows of `points`.
    MemoryError
        There is not enough memory.

    See Also
    --------
    resolve_touches : Subdivide faces at the vertices of others on them.

    Notes
    -----
    Every decision is the sign of a determinant, exact for the given doubles; there is no tolerance.
    Two faces may have vertices and edges in common. Any other pair with common points is listed
    with its kind:

    - ``"crossing"``: the interiors cross.
    - ``"edge on edge"``: edges cross at a point that is not a vertex.
    - ``"vertex in face"``: a vertex of one is in the interior of the other.
    - ``"vertex on edge"``: a vertex of one is inside an edge of the other, as at T-junctions.
    - ``"coplanar overlap"``: they overlap in one plane.
    - ``"folded"``: they share an edge and overlap, because they are on the same side of it.

    The first two always cross. The last two cross if some of their edges do; otherwise, and for
    vertices in faces and on edges, the faces touch: `resolve_touches` subdivides them so that they
    have only vertices and edges in common. If no faces cross, then closed, oriented, manifold,
    components and regions refer to the surface after this subdivision, in which faces that repeat
    others count once for what they enclose. If faces cross, they refer to the faces as given.

    Around each edge with more than two faces, the faces are sorted by angle. A face has the same
    region on both sides if its front and back are connected around edges; if there are other faces,
    the surface encloses a region. The number of regions follows from Alexander duality.

    The time is linear, up to a logarithmic factor, if the bounding boxes of faces meet few others;
    around a vertex with k faces, it is k^2. A tree of boxes along a Hilbert curve finds the pairs
    [1]_.

    References
    ----------
    .. [1] I. Kamel and C. Faloutsos, "On packing R-trees", Proceedings of the Second International
       Conference on Information and Knowledge Management (1993), 490-499.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    >>> check = delone.check_surface(points, faces)
    >>> bool(check), check.closed, check.oriented, check.manifold
    (True, True, True, True)
    >>> print(check)
    closed, oriented, manifold surface of 4 faces and 6 edges, volume 0.166667
    1 component, 1 enclosed region
    no faces cross or touch
    """
    given, rows = as_faces(points, faces)
    most = LARGEST_LIMIT if limit is None else as_limit(limit, name="limit")
    return checked(given, rows, most, workers)


def checked(
    points: NDArray[np.float64], faces: NDArray[np.int32], limit: int, workers: int | None
) -> SurfaceCheck:
    """Check a surface, as returned by `as_faces`."""
    found = _core.check_surface3(points, faces, limit, as_workers(workers))
    return _report(points, faces, found)


def as_faces(points: ArrayLike, faces: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return points (n, 3) and faces (m, 3) for the core."""
    given = as_points(points, ndim=3)
    return given, as_simplices(faces, len(given), 2, name="faces")


def as_pairs(
    pairs: _core.FacePairs,
) -> tuple[NDArray[np.int64], NDArray[np.str_], NDArray[np.bool_]]:
    """Return rows, kinds and whether they cross, in the order of rows."""
    order = np.lexsort((pairs.faces[:, 1], pairs.faces[:, 0]))
    kinds = np.array(KINDS)[pairs.kinds[order]]
    return pairs.faces[order].astype(np.int64), kinds, pairs.crossing[order]


def _report(
    points: NDArray[np.float64], faces: NDArray[np.int32], found: CheckedSurface
) -> SurfaceCheck:
    pairs, kinds, crossing = as_pairs(found.pairs)
    counts = dict(zip(KINDS, map(int, found.pairs.counts), strict=True))
    winds = not len(found.boundary) and not len(found.unbalanced)
    return SurfaceCheck(
        nfaces=len(faces),
        nedges=found.nedges,
        duplicate_points=_rows(found.duplicate_points),
        repeated_vertices=_rows(found.repeats),
        collinear=_rows(found.collinear),
        duplicate_faces=_rows(found.duplicate_faces),
        pairs=pairs,
        kinds=kinds,
        crossing=crossing,
        counts=counts,
        ncrossing=found.pairs.ncrossing,
        boundary=_rows(found.boundary),
        nonmanifold_edges=_rows(found.many),
        misoriented_edges=_rows(found.unbalanced),
        nonmanifold_vertices=_rows(found.not_fans),
        component=_rows(found.component),
        ncomponents=found.ncomponents,
        nregions=found.nregions,
        dangling=_rows(found.dangling),
        volume=found.volume if winds else float("nan"),
        volume_sign=found.sign if winds else 0,
        flat=_is_flat(points, faces, found),
    )


def _rows(rows: NDArray[np.int32]) -> NDArray[np.int64]:
    return rows.astype(np.int64)


def _is_flat(points: NDArray[np.float64], faces: NDArray[np.int32], found: CheckedSurface) -> bool:
    """Return whether all faces are in one plane; checked only if nothing is enclosed."""
    if found.nregions or not len(faces):
        return False
    proper = np.ones(len(faces), dtype=bool)
    proper[found.repeats] = proper[found.collinear] = False
    if not proper.any():
        return True
    corners = points[faces[np.argmax(proper)]]
    others = points[np.unique(faces)]
    a, b, c = (np.tile(corner, (len(others), 1)) for corner in corners)
    return not _core.orient3d(a, b, c, others).any()
