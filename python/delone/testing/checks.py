"""The parts of an exact check, each of which names its faults."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.testing.exact import (
    Mesh,
    assert_none,
    directed_edges,
    hull_of,
    incircle,
    opposite_corners,
    orient,
    require,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.testing.exact import Indices, SpaceMesh


def assert_vertices(mesh: Mesh | SpaceMesh, simplices: Indices, noun: str = "triangle") -> None:
    """Assert that the vertices are all distinct points, and only the first of equal points."""
    used = np.zeros(len(mesh.points), dtype=bool)
    used[simplices] = True
    is_first = mesh.first == np.arange(len(mesh.points))

    def repeated(row: int) -> str:
        return f"{mesh.name([row])} repeats row {mesh.first[row]}"

    repeats, lost = np.flatnonzero(used & ~is_first), np.flatnonzero(is_first & ~used)
    assert_none(repeats, repeated, "is used although an earlier row is equal", "row")
    fault = f"is not a vertex of any {noun}"
    assert_none(lost, lambda row: mesh.name([row]), fault, "point")


def assert_counter_clockwise(mesh: Mesh) -> None:
    """Assert that triangles turn left, and each edge has one triangle on its left."""
    a, b, c = mesh.triangles.T
    turned = np.flatnonzero(orient(mesh, a, b, c) <= 0)
    assert_none(turned, mesh.triangle, "is not counter-clockwise", "triangle")
    keys, counts = np.unique(directed_edges(mesh), return_counts=True)
    fault = "is used more than once in the same direction"
    assert_none(keys[counts > 1], mesh.edge, fault, "edge")


def assert_hull_and_area(mesh: Mesh) -> None:
    """Assert that the boundary is that of the convex hull, and count and area agree."""
    n, hull = len(mesh.points), hull_of(mesh)
    found = set(directed_edges(mesh)[opposite_corners(mesh) < 0].tolist())
    wanted = {u * n + v for u, v in zip(hull, hull[1:] + hull[:1], strict=True)}
    for left, fault in (
        (found - wanted, "is on the boundary, but not on the convex hull"),
        (wanted - found, "is on the convex hull, but not on the boundary"),
    ):
        assert_none(sorted(left), mesh.edge, fault, "edge")
    # Count and area follow from the assertions above: they test the checks.
    distinct, m = len(np.unique(mesh.first)), len(mesh.triangles)
    expected = 2 * distinct - len(hull) - 2
    require(
        m == expected,
        f"{m} triangles, but {distinct} distinct points of which {len(hull)} are on the hull "
        f"have {expected}",
    )
    corners = np.array(hull)
    area = orient(mesh, *mesh.triangles.T).sum()
    hull_area = orient(mesh, corners[0], corners[:-1], corners[1:]).sum()
    require(area == hull_area, "the triangles do not have the area of the hull")


def assert_locally_delaunay(
    mesh: Mesh, canonical: bool, fixed: NDArray[np.bool_] | None = None
) -> None:
    """Assert that inner edges are locally Delaunay, unless they are `fixed`, (m, 3)."""
    opposite = opposite_corners(mesh)
    once = opposite > np.arange(len(opposite))  # each inner edge once
    corner = np.flatnonzero(once if fixed is None else once & ~fixed.ravel())
    t, k = np.divmod(corner, 3)
    p, u, v = (mesh.triangles[t, (k + i) % 3] for i in range(3))
    q = mesh.triangles.ravel()[opposite[corner]]
    inside = incircle(mesh, p, u, v, q)

    def edge(i: int) -> str:
        return f"edge {mesh.name(sorted((u[i], v[i])))} between {mesh.name(sorted((p[i], q[i])))}"

    assert_none(np.flatnonzero(inside > 0), edge, "is not locally Delaunay", "edge")
    if not canonical:
        return
    rank = mesh.rank
    apex_smallest = np.minimum(rank[p], rank[q]) < np.minimum(rank[u], rank[v])
    tied = np.flatnonzero((inside == 0) & apex_smallest)
    fault = "is not canonical: the smallest of four cocircular points is not on it"
    assert_none(tied, edge, fault, "edge")


def assert_neighbors(mesh: Mesh, neighbors: ArrayLike) -> None:
    """Assert that neighbors are those across the edges."""
    array = np.asarray(neighbors)
    if array.size == 0:
        array = array.astype(np.int64).reshape(-1, 3)
    require(array.dtype.kind in "iu", f"neighbors must contain integers, got dtype {array.dtype}")
    require(
        array.shape == mesh.triangles.shape,
        f"neighbors must have shape {mesh.triangles.shape}, got {array.shape}",
    )
    if len(array) == 0:
        return
    opposite = opposite_corners(mesh)
    wanted = np.where(opposite < 0, -1, opposite // 3).reshape(-1, 3)

    def both(t: int) -> str:
        return f"triangle {t}: {array[t].tolist()}, not {wanted[t].tolist()}"

    wrong = np.flatnonzero((array != wanted).any(axis=1))
    assert_none(wrong, both, "has wrong neighbors", "triangle")
