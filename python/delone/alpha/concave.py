"""Concave hulls: one polygon around points, carved from their convex hull along long edges."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_flag, as_workers, require_finite
from delone._base.georeference import warn_of_degrees
from delone._base.immutable import own_copy, sealed
from delone._base.numbers import as_between, as_nonnegative
from delone._tiling.complex import Stored, points_alone
from delone.alpha.shape import ConcaveHull
from delone.delaunay import Delaunay
from delone.errors import DegenerateInputError, InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["concave_hull"]


def concave_hull(
    points: ArrayLike | Stored,
    *,
    max_edge: float | None = None,
    ratio: float | None = None,
    holes: bool = False,
    workers: int | None = None,
    planar: bool = False,
) -> ConcaveHull:
    """Return a concave hull: a polygon with all points inside it or on its boundary.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or Delaunay
        Finite coordinates in any unit. A `Delaunay` triangulation is used directly.
    max_edge : float, optional
        The length, in the unit of the points, above which boundary edges are removed if possible; 0
        or more, possibly infinity. Either this or `ratio` must be given.
    ratio : float, optional
        From 0 to 1: the same limit, interpolated between the lengths of the shortest and the
        longest edge of the triangulation, as in ``shapely.concave_hull``. 1 keeps the convex hull.
    holes : bool, optional
        Whether to carve holes inside as well; 2-D only.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Returns
    -------
    ConcaveHull
        The triangles or tetrahedra that are kept, with `polygon`, `boundary` and measures. Points
        that span no area (in 3-D, no volume) have none, and an empty polygon.

    Raises
    ------
    InputError
        Not one of `max_edge` and `ratio` is given, or it is out of range; or `holes` in 3-D.
    NonFiniteError, ShapeError, DtypeError
        As for `Delaunay`.

    See Also
    --------
    AlphaComplex : Any number of parts, by the radius of circles.

    Notes
    -----
    In 2-D, boundary edges are processed from longest to shortest. If an edge is longer than the
    limit and the opposite corner of its triangle is inside, the triangle is removed. If that corner
    is already on the boundary, the edge remains. So the hull is one simple polygon, whatever the
    limit, and some longer edges may remain. With `holes`, a triangle with a longer edge and no
    corner on the boundary starts a hole, which is carved in the same way; triangles with the
    longest edges come first. Holes touch neither each other nor the outline.

    In 3-D, a tetrahedron behind a face with a longer edge is removed, unless it is the last one of
    a point. The remaining tetrahedra need not form a manifold: see ``ConcaveHull.is_manifold``.

    Lengths are compared exactly, and equal lengths by the coordinates of their ends, so the result
    does not depend on the order of the rows. The limit that a ratio gives is rounded. O(n log n)
    time.

    References
    ----------
    M. Duckham, L. Kulik, M. Worboys and A. Galton, "Efficient generation of simple polygons for
    characterizing the shape of a set of points in the plane", Pattern Recognition 41 (2008).

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)]
    >>> delone.concave_hull(points, max_edge=3).area
    12.0
    >>> delone.concave_hull(points, ratio=1).area
    16.0
    """
    name, limit = _limit(max_edge, ratio)
    wants_holes = as_flag(holes, name="holes")
    threads = as_workers(workers)
    if isinstance(points, Delaunay):
        mesh: Any = points
    else:
        plain: Any = points
        if isinstance(points, Stored):
            plain = points_alone(points, what="a concave hull")
        own = own_copy(plain, ndim=None)
        warn_of_degrees(plain, own, planar=planar)
        require_finite(own)
        mesh = _triangulation(own, threads)
        if mesh is None:
            size = own.shape[1] + 1
            nothing = sealed(np.empty((0, size), dtype=np.int32))
            flat = np.empty(0, dtype=bool)
            made = ConcaveHull._made(sealed(own), nothing, nothing, flat, workers)
            return made._refer(points)
    given = mesh.points, mesh.simplices, mesh.neighbors
    if wants_holes and mesh.ndim != 2:
        raise InputError("holes=True is only available in 2-D: points are 3-D")
    flags = _core.erode(*given, name, limit, wants_holes)
    return ConcaveHull._made(*given, flags, workers)._refer(points)


def _limit(max_edge: float | None, ratio: float | None) -> tuple[str, float]:
    if (max_edge is None) == (ratio is None):
        raise InputError("pass either max_edge, a length, or ratio, from 0 to 1")
    if ratio is not None:
        return "ratio", as_between(ratio, 0, 1, name="ratio")
    length = as_nonnegative(max_edge, name="max_edge")
    return "length", length


def _triangulation(points: Any, workers: int) -> Delaunay | None:
    if not len(points):
        return None
    try:
        return Delaunay(points, workers=workers, planar=True)
    except DegenerateInputError:
        return None
