"""The exact check of Delaunay triangulations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone._arrays import as_flag, as_points, require_finite
from delone.testing.checks import (
    assert_counter_clockwise,
    assert_hull_and_area,
    assert_locally_delaunay,
    assert_neighbors,
    assert_vertices,
)
from delone.testing.exact import Mesh, as_rows, require, spans_no_area
from delone.testing.space import SpaceMesh, assert_delaunay_space

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
        The simplex opposite each vertex, -1 outside. By default neighbours are not looked at.
    canonical : bool, optional
        Whether cocircular vertices must be fanned from their lexicographically smallest one, as
        delone does. False accepts every Delaunay triangulation.

    Raises
    ------
    AssertionError
        Names what is wrong and the first culprits, with their coordinates.
    InputError
        `points` is no array of finite points.

    Notes
    -----
    Checked are: the type and range of indices; that all triangles are counter-clockwise, no
    directed edge is used twice, every distinct point is a vertex, and of equal points only the
    first; that the boundary is the exact convex hull, with the points on its edges as vertices;
    that there are 2n - h - 2 triangles, of the same area as the hull; that each inner edge is
    locally Delaunay, and canonical where four points share a circle; that neighbours are those
    across the edges. Of points which span no area, only the empty triangulation passes.

    In space: that tetrahedra are positively oriented, and each face is used once from either side;
    that the boundary is one closed surface, convex at each edge; Euler's formula and the volume;
    that each inner face is locally Delaunay, and canonical where five points share a sphere; for up
    to 64 points also that no sphere has any point inside.

    O(n log n) exact operations, for 10,000 points well below a second. That the local test suffices
    is shown by Delaunay, B. (1934), "Sur la sphère vide".

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
        assert_vertices(mesh)
        assert_counter_clockwise(mesh)
        assert_hull_and_area(mesh)
        assert_locally_delaunay(mesh, canonical)
    if neighbors is not None:
        assert_neighbors(mesh, neighbors)
