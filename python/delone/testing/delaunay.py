"""The exact check of Delaunay triangulations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone._base.arrays import as_flag, as_points, require_finite
from delone.testing.checks import (
    assert_counter_clockwise,
    assert_hull_and_area,
    assert_locally_delaunay,
    assert_neighbors,
    assert_vertices,
)
from delone.testing.exact import Mesh, SpaceMesh, as_rows, require, spans_no_area
from delone.testing.space import assert_delaunay_space

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def assert_delaunay(
    points: ArrayLike,
    simplices: ArrayLike,
    *,
    neighbors: ArrayLike | None = None,
    canonical: bool = True,
) -> None:
    """Assert, exactly, that simplices are the Delaunay triangulation of points.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3)
        Finite coordinates.
    simplices : array_like of int, shape (m, d + 1)
        Vertices of the triangles or tetrahedra, as rows of `points`.
    neighbors : array_like of int, shape (m, d + 1), optional
        The simplex opposite each vertex, -1 outside. By default neighbors are not checked.
    canonical : bool, optional
        Whether cocircular vertices must be fanned from their lexicographically smallest one, as
        delone does. False accepts every Delaunay triangulation.

    Raises
    ------
    AssertionError
        Names the fault and the first elements that have it, with their coordinates.
    InputError
        `points` is not an array of finite points.

    Notes
    -----
    The following is checked: the dtype and range of indices; all triangles are counter-clockwise,
    no directed edge is used twice, and the vertices are all distinct points, of equal points only
    the first; the boundary is the exact convex hull, with the points on its edges as vertices;
    there are 2n - h - 2 triangles, with the total area of the hull; each inner edge is locally
    Delaunay, and canonical if four points share a circle; neighbors are those across the edges. For
    points that span no area, only the empty triangulation passes.

    In 3-D: tetrahedra are positively oriented, and each face is used once from either side; the
    boundary is one closed surface, convex at each edge; Euler's formula and the volume hold; each
    inner face is locally Delaunay, and canonical if five points share a sphere; for up to 64
    points, it is also checked that no sphere contains a point.

    O(n log n) exact operations; 10,000 points take well under a second. The local test is
    sufficient by a theorem of B. Delaunay (1934), "Sur la sphère vide".

    Examples
    --------
    >>> from delone.testing import assert_delaunay
    >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    >>> assert_delaunay(square, [(0, 1, 2), (0, 2, 3)])
    >>> assert_delaunay(square, [(0, 1, 3), (1, 2, 3)], canonical=False)
    >>> assert_delaunay(square, [(0, 1, 3), (1, 2, 3)])
    Traceback (most recent call last):
    ...
    AssertionError: 1 edge is not canonical: the smallest of four cocircular points is not on it:
      edge 1 (1.0, 0.0), 3 (0.0, 1.0) between 0 (0.0, 0.0), 2 (1.0, 1.0)
    """
    as_flag(canonical, name="canonical")
    points = as_points(points)
    require_finite(points)
    if points.shape[1] == 3:
        tetrahedra = as_rows(simplices, len(points), noun="tetrahedron", width=4)
        assert_delaunay_space(SpaceMesh.of(points, tetrahedra), neighbors, canonical=canonical)
        return
    triangles = as_rows(simplices, len(points))
    mesh = Mesh.of(points, triangles)
    if spans_no_area(mesh):
        require(len(triangles) == 0, f"{len(triangles)} triangles of points that span no area")
    else:
        assert_vertices(mesh, triangles)
        assert_counter_clockwise(mesh)
        assert_hull_and_area(mesh)
        assert_locally_delaunay(mesh, canonical)
    if neighbors is not None:
        assert_neighbors(mesh, neighbors)
