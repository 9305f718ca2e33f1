"""The exact check of meshes: tiling, segments, Delaunay, angles.

Angles are compared by the squares of their cosines, which are quotients of integers, without square
roots or inverse functions.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Protocol

import numpy as np

from delone._base.arrays import as_points, as_simplices
from delone.testing.constrained import (
    ConstrainedArrays,
    ConstrainedMesh,
    assert_constrained_delaunay,
)
from delone.testing.exact import Mesh, assert_none, opposite_corners, orient, require

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.testing.exact import Integers

__all__ = ["assert_mesh"]


class RefinedMesh(ConstrainedMesh, Protocol):
    """The attributes that are checked; `delone.Mesh` has them."""

    @property
    def point_source(self) -> ArrayLike:
        """The input row of each point, (n,); -1 if it was added."""


def assert_mesh(
    mesh: RefinedMesh,
    points: ArrayLike,
    segments: ArrayLike,
    *,
    squared_cosine: Fraction | None = None,
    spoilt: ArrayLike = (),
    tolerance: float | None = None,
) -> None:
    """Assert, exactly, that a mesh tiles its domain, preserves segments and has no small angle.

    Parameters
    ----------
    mesh : Mesh or the like
        The mesh to check.
    points : array_like, shape (n, 2)
        The points of the input.
    segments : array_like of int, shape (s, 2)
        Segments of the input, as rows of `points`; those with an end outside are ignored.
    squared_cosine : Fraction, optional
        The squared cosine of the minimum angle: 3/4 for 30 degrees.
    spoilt : array_like of int, optional
        Triangles that may have smaller angles.
    tolerance : float, optional
        Maximum distance of vertices from their segment, as in `assert_constrained_delaunay`.

    Raises
    ------
    AssertionError
        Names the fault and the first elements that have it.

    Notes
    -----
    The following is checked: input points are unchanged; triangles are counter-clockwise, neighbors
    mutual; the area of the triangles is that inside the boundary, which consists of subsegments;
    each segment is a chain of edges; each other edge is locally Delaunay, with ties broken by
    coordinates; every point is a vertex; angles.

    Examples
    --------
    >>> from fractions import Fraction
    >>> import delone
    >>> from delone.testing import assert_mesh
    >>> points, ring = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    >>> mesh = delone.mesh((points, ring), max_area=0.1)
    >>> assert_mesh(mesh, points, ring, squared_cosine=Fraction(3, 4))
    >>> try:
    ...     assert_mesh(mesh, points, ring, squared_cosine=Fraction(49, 100))
    ... except AssertionError as error:
    ...     print(str(error).splitlines()[0])
    16 triangles have a smaller angle:
    """
    given, own = as_points(points, ndim=2), as_points(mesh.points, ndim=2)
    source = np.asarray(mesh.point_source)
    old = source >= 0
    require(bool((own[old] == given[source[old]]).all()), "points of the input have moved")
    row = np.full(len(given), -1)
    row[source[old]] = np.flatnonzero(old)
    rows = row[np.asarray(segments, dtype=np.int64).reshape(-1, 2)]
    arrays, rows = _with_rows_for_all(mesh, rows)
    assert_constrained_delaunay(arrays, rows, complete=False, split=True, tolerance=tolerance)
    exact = Mesh.of(own, as_simplices(mesh.simplices, len(own), 2).astype(np.int64))
    _assert_area(exact)
    used = np.zeros(len(own), dtype=bool)
    used[exact.triangles] = True
    require(bool(used.all()), "a point is not a vertex")
    if squared_cosine is not None:
        _assert_angles(exact, squared_cosine, np.asarray(spoilt, dtype=np.int64))


def _with_rows_for_all(mesh: RefinedMesh, rows: Integers) -> tuple[ConstrainedArrays, Integers]:
    """Remove rows with an end outside, and add rows for edges of hulls."""
    inside: NDArray[np.bool_] = np.asarray((rows >= 0).all(axis=1), dtype=bool)
    number = np.cumsum(inside) - 1
    pieces = np.asarray(mesh.segments)
    start, source = (np.asarray(array) for array in mesh.segment_source)
    require(bool(inside[source].all()), "a subsegment comes from a segment with an end outside")
    bare = np.flatnonzero(np.diff(start) == 0)
    first = int(inside.sum())
    filled = np.insert(number[source], start[bare], first + np.arange(len(bare)))
    counts = np.maximum(np.diff(start), 1)
    arrays = ConstrainedArrays(
        points=mesh.points,
        simplices=mesh.simplices,
        neighbors=mesh.neighbors,
        segments=pieces,
        segment_source=(np.concatenate(([0], np.cumsum(counts))), filled),
        constrained=mesh.constrained,
    )
    return arrays, np.concatenate((rows[inside], pieces[bare]))


def _assert_area(mesh: Mesh) -> None:
    corner = np.flatnonzero(opposite_corners(mesh) < 0)
    t, k = np.divmod(corner, 3)
    u, v = mesh.triangles[t, (k + 1) % 3], mesh.triangles[t, (k + 2) % 3]
    boundary = (mesh.x[u] * mesh.y[v] - mesh.x[v] * mesh.y[u]).sum()
    require(
        orient(mesh, *mesh.triangles.T).sum() == boundary,
        "the triangles do not have the area inside their boundary",
    )


def _assert_angles(mesh: Mesh, bound: Fraction, spoilt: Integers) -> None:
    small = np.zeros(len(mesh.triangles), dtype=bool)
    for k in range(3):
        a, b, c = (mesh.triangles[:, (k + i) % 3] for i in range(3))
        bx, by = mesh.x[b] - mesh.x[a], mesh.y[b] - mesh.y[a]
        cx, cy = mesh.x[c] - mesh.x[a], mesh.y[c] - mesh.y[a]
        dot, lengths = bx * cx + by * cy, (bx * bx + by * by) * (cx * cx + cy * cy)
        thin = dot * dot * bound.denominator > lengths * bound.numerator
        small |= np.asarray((dot > 0) & thin, dtype=bool)
    small[spoilt] = False
    assert_none(np.flatnonzero(small), mesh.triangle, "has a smaller angle", "triangle")
