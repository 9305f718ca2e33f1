"""The exact check of 3-D Delaunay triangulations, over arbitrary-precision integers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.testing.checks import assert_vertices
from delone.testing.exact import SpaceMesh, assert_none, require

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone.testing.exact import Indices

# The face opposite each corner, with the corner on its inner side: counter-clockwise as seen from
# outside.
_FACES = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]
# Up to this number of points, every tetrahedron is tested against every point.
_FEW = 64


def orient3d(mesh: SpaceMesh, a: Any, b: Any, c: Any, d: Any) -> Any:
    """Six times the signed volume of tetrahedra, exactly; rows or arrays of rows."""
    at = mesh.at
    return _determinant(at[b] - at[a], at[c] - at[a], at[d] - at[a])


def insphere(mesh: SpaceMesh, corners: Indices, e: Any) -> Any:
    """Positive where e is inside the sphere of the positively oriented corners, (k, 4)."""
    p, q, r, s = (mesh.at[corners[:, k]] - mesh.at[e] for k in range(4))
    return (
        (p * p).sum(axis=-1) * _determinant(q, r, s)
        - (q * q).sum(axis=-1) * _determinant(p, r, s)
        + (r * r).sum(axis=-1) * _determinant(p, q, s)
        - (s * s).sum(axis=-1) * _determinant(p, q, r)
    )


def insphere_of_tie(mesh: SpaceMesh, corners: Indices, e: int) -> int:
    """The sign for five cospherical points, determined by the smallest relevant point."""
    five = [*corners.tolist(), e]
    for k in np.argsort(mesh.rank[five]).tolist():
        if k == 4:
            value = orient3d(mesh, *corners.tolist())
        else:
            p, q, r, s = (e if i == k else five[i] for i in range(4))
            value = -orient3d(mesh, p, q, r, s)
        if value != 0:
            return 1 if value > 0 else -1
    return 0


def assert_delaunay_space(mesh: SpaceMesh, neighbors: ArrayLike | None, *, canonical: bool) -> None:
    """Assert that tetrahedra are the Delaunay triangulation of points."""
    if _spans_no_volume(mesh):
        count = len(mesh.tetrahedra)
        require(count == 0, f"{count} tetrahedra of points that span no volume")
    else:
        assert_vertices(mesh, mesh.tetrahedra, "tetrahedron")
        _assert_positive(mesh)
        beyond = _opposites(mesh)
        _assert_hull(mesh, beyond)
        _assert_count_and_volume(mesh, beyond)
        _assert_empty_spheres(mesh, beyond, canonical)
        if len(mesh.points) <= _FEW:
            _assert_all_spheres_empty(mesh, canonical)
    if neighbors is not None:
        _assert_neighbors(mesh, neighbors)


def _determinant(u: Any, v: Any, w: Any) -> Any:
    return (
        u[..., 0] * (v[..., 1] * w[..., 2] - v[..., 2] * w[..., 1])
        + u[..., 1] * (v[..., 2] * w[..., 0] - v[..., 0] * w[..., 2])
        + u[..., 2] * (v[..., 0] * w[..., 1] - v[..., 1] * w[..., 0])
    )


def _spans_no_volume(mesh: SpaceMesh) -> bool:
    """Return whether all points lie in one plane."""
    rows = np.unique(mesh.first)
    if len(rows) < 4:
        return True
    a, b = rows[0], rows[1]
    u, v = mesh.at[b] - mesh.at[a], mesh.at[rows] - mesh.at[a]
    across = np.stack([u[i] * v[:, j] - u[j] * v[:, i] for i, j in ((1, 2), (2, 0), (0, 1))], 1)
    off = np.flatnonzero((across != 0).any(axis=1))
    return len(off) == 0 or not (orient3d(mesh, a, b, rows[off[0]], rows) != 0).any()


def _assert_positive(mesh: SpaceMesh) -> None:
    flat = np.flatnonzero(orient3d(mesh, *mesh.tetrahedra.T) <= 0)
    assert_none(flat, mesh.tetrahedron, "is not positively oriented", "tetrahedron")


def _opposites(mesh: SpaceMesh) -> Indices:
    """For each corner 4 t + k, the corner beyond the face opposite it, or -1 on the boundary."""
    faces = mesh.tetrahedra[:, _FACES].reshape(-1, 3)
    # With the smallest vertex first, the two sides of a face differ by the order of the others.
    start = faces.argmin(axis=1)[:, None]
    turned = np.take_along_axis(faces, (start + np.arange(3)) % 3, axis=1)
    sides: dict[tuple[int, ...], int] = {}
    doubled = []
    for corner, face in enumerate(map(tuple, turned.tolist())):
        if face in sides:
            doubled.append(face)
        sides[face] = corner
    fault = "is used more than once from the same side"
    assert_none(doubled, lambda face: f"face {mesh.name(face)}", fault, "face")
    found = [sides.get((a, c, b), -1) for a, b, c in turned.tolist()]
    return np.array(found, dtype=np.int64)


def _assert_hull(mesh: SpaceMesh, beyond: Indices) -> None:
    """Assert that the boundary is a closed surface, convex at each edge: the convex hull."""
    t, k = np.divmod(np.flatnonzero(beyond < 0), 4)
    faces = np.take_along_axis(mesh.tetrahedra[t], np.array(_FACES)[k], axis=1)
    edges: dict[tuple[int, int], int] = {}
    for i, (a, b, c) in enumerate(faces.tolist()):
        for edge in ((a, b), (b, c), (c, a)):
            require(edge not in edges, f"boundary edge {mesh.name(edge)} occurs twice")
            edges[edge] = i
    met, open_faces = {0}, [0]
    while open_faces:
        i = open_faces.pop()
        a, b, c = faces[i].tolist()
        for u, v in ((a, b), (b, c), (c, a)):
            require((v, u) in edges, f"the boundary is open at edge {mesh.name((u, v))}")
            j = edges[v, u]
            (far,) = set(faces[j].tolist()) - {u, v}
            require(
                orient3d(mesh, a, b, c, far) <= 0,
                f"the boundary is not convex: {mesh.name([far])} is beyond {mesh.name((a, b, c))}",
            )
            if j not in met:
                met.add(j)
                open_faces.append(j)
    require(len(met) == len(faces), "the boundary is more than one surface")
    vertices = len(np.unique(faces))
    require(
        vertices - len(edges) // 2 + len(faces) == 2, "the boundary is not a topological sphere"
    )


def _assert_count_and_volume(mesh: SpaceMesh, beyond: Indices) -> None:
    """Assert Euler's formula and the volume; both follow from the above and test the checks."""
    t, k = np.divmod(np.flatnonzero(beyond < 0), 4)
    faces = np.take_along_axis(mesh.tetrahedra[t], np.array(_FACES)[k], axis=1)
    pairs = [mesh.tetrahedra[:, [i, j]] for i in range(4) for j in range(i)]
    edges = len(np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0))
    m = len(mesh.tetrahedra)
    vertices, all_faces = len(np.unique(mesh.first)), (4 * m + len(faces)) // 2
    euler = vertices - edges + all_faces - m
    require(euler == 1, f"vertices - edges + faces - tetrahedra is {euler}, not 1")
    volume = orient3d(mesh, *mesh.tetrahedra.T).sum()
    a, b, c = faces.T
    hull = -orient3d(mesh, a, b, c, faces[0, 0]).sum()
    require(volume == hull, "the tetrahedra do not have the volume of the hull")


def _assert_empty_spheres(mesh: SpaceMesh, beyond: Indices, canonical: bool) -> None:
    """Assert that inner faces are locally Delaunay."""
    corner = np.flatnonzero(beyond > np.arange(len(beyond)))
    t, far = corner // 4, mesh.tetrahedra.ravel()[beyond[corner]]
    inside = insphere(mesh, mesh.tetrahedra[t], far)

    def face(i: int) -> str:
        return f"tetrahedron {mesh.name(mesh.tetrahedra[t[i]].tolist())} and {mesh.name([far[i]])}"

    assert_none(np.flatnonzero(inside > 0), face, "is not locally Delaunay", "face")
    if not canonical:
        return
    ties = np.flatnonzero(inside == 0).tolist()
    signs = [insphere_of_tie(mesh, mesh.tetrahedra[t[i]], int(far[i])) for i in ties]
    tied = [i for i, s in zip(ties, signs, strict=True) if s > 0]
    assert_none(tied, face, "is not canonical: five points share a sphere", "face")


def _assert_all_spheres_empty(mesh: SpaceMesh, canonical: bool) -> None:
    """Assert that no tetrahedron has any point inside its sphere."""
    for e in np.unique(mesh.first).tolist():
        inside = insphere(mesh, mesh.tetrahedra, e)
        held = np.flatnonzero(inside > 0)
        fault = f"has point {mesh.name([e])} inside its sphere"
        assert_none(held, mesh.tetrahedron, fault, "tetrahedron")
        for t in np.flatnonzero(inside == 0).tolist() if canonical else []:
            corners = mesh.tetrahedra[t]
            if e not in corners:
                tie = insphere_of_tie(mesh, corners, e)
                require(tie <= 0, f"{mesh.tetrahedron(t)} is not canonical: {mesh.name([e])}")


def _assert_neighbors(mesh: SpaceMesh, neighbors: ArrayLike) -> None:
    array = np.asarray(neighbors)
    require(
        array.dtype.kind in "iu" and array.shape == mesh.tetrahedra.shape,
        f"neighbors must be integers of shape {mesh.tetrahedra.shape}, got {array.shape}",
    )
    if len(array) == 0:
        return
    beyond = _opposites(mesh)
    wanted = np.where(beyond < 0, -1, beyond // 4).reshape(-1, 4)

    def both(t: int) -> str:
        return f"tetrahedron {t}: {array[t].tolist()}, not {wanted[t].tolist()}"

    wrong = np.flatnonzero((array != wanted).any(axis=1))
    assert_none(wrong, both, "has wrong neighbors", "tetrahedron")
