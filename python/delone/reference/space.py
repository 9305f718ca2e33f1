"""Bowyer-Watson in 3-D, and the predicates that it needs: exact, slow and readable.

As in 2-D, the outside of the hull is covered by ghosts: one for each hull face, with a fourth
vertex at infinity. The "sphere" of a ghost is the open half-space beyond its face, together with
the open disk of the face's own circle in the plane between.

Devillers, O. and Teillaud, M. (2011), "Perturbations for Delaunay and weighted Delaunay 3D
triangulations", Computational Geometry 44 (3), 160-168, for points on one sphere.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any, TypeAlias

from delone.errors import DegenerateInputError
from delone.reference.exact import exact_number, exact_rows, first_rows, sign

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from delone.reference.exact import ExactNumber

Tetrahedron: TypeAlias = tuple[int, int, int, int]
Vector: TypeAlias = "tuple[ExactNumber, ExactNumber, ExactNumber]"

INFINITE = -1


def orient3d(a: Sequence[Any], b: Sequence[Any], c: Sequence[Any], d: Sequence[Any]) -> int:
    """Return on which side of the plane through a, b and c the point d lies.

    Parameters
    ----------
    a, b, c, d : sequence of three numbers
        Points.

    Returns
    -------
    1 if the vectors from a to b, c and d form a right-handed frame, -1 if they form a left-handed
    one, 0 if all four points lie in one plane.

    Examples
    --------
    >>> from delone.reference import orient3d
    >>> orient3d((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 5e-324))
    1
    """
    o, u, v, w = map(_exact_vector, (a, b, c, d))
    return sign(_determinant(_minus(u, o), _minus(v, o), _minus(w, o)))


def insphere(
    a: Sequence[Any], b: Sequence[Any], c: Sequence[Any], d: Sequence[Any], e: Sequence[Any]
) -> int:
    """Return whether e lies inside the sphere through a, b, c and d.

    Parameters
    ----------
    a, b, c, d : sequence of three numbers
        Points on the sphere, positively oriented; otherwise the sign is reversed.
    e : sequence of three numbers
        The point to test.

    Returns
    -------
    int
        1 inside, 0 on the sphere, -1 outside.

    Examples
    --------
    >>> from delone.reference import insphere
    >>> corners = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)
    >>> insphere(*corners, (0.5, 0.5, 0.5)), insphere(*corners, (1, 1, 1))
    (1, 0)
    """
    e = _exact_vector(e)
    p, q, r, s = (_minus(_exact_vector(x), e) for x in (a, b, c, d))
    # The determinant of the lifted points, expanded along the column of heights.
    return sign(
        _square(p) * _determinant(q, r, s)
        - _square(q) * _determinant(p, r, s)
        + _square(r) * _determinant(p, q, s)
        - _square(s) * _determinant(p, q, r)
    )


def insphere_canonical(
    a: Sequence[Any], b: Sequence[Any], c: Sequence[Any], d: Sequence[Any], e: Sequence[Any]
) -> int:
    """Return whether e lies inside the sphere through a, b, c and d, with every tie broken.

    Parameters
    ----------
    a, b, c, d : sequence of three numbers
        Points on the sphere, positively oriented; otherwise the sign is reversed.
    e : sequence of three numbers
        The point to test.

    Returns
    -------
    int
        1 inside, -1 outside; 0 only if all five are in one plane, or two of them coincide.

    Notes
    -----
    The lifted point of each vertex is lowered by an infinitesimal amount, which is infinitely
    larger for the lexicographically smaller of any two points. Lowering e moves it inside. Lowering
    a corner moves the sphere by the barycentric coordinate of that corner at e, which is 0 if the
    other three and e are in one plane: then the next point in order decides.

    Examples
    --------
    Five corners of a cube:

    >>> from delone.reference import insphere_canonical
    >>> insphere_canonical((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1))
    1
    """
    found = insphere(a, b, c, d, e)
    if found != 0:
        return found
    corners = [a, b, c, d]
    for point in sorted(map(_exact_vector, (a, b, c, d, e))):
        if point == _exact_vector(e):
            side = orient3d(a, b, c, d)
        else:
            k = [_exact_vector(corner) for corner in corners].index(point)
            p, q, r, s = (e if i == k else corners[i] for i in range(4))
            side = -orient3d(p, q, r, s)
        if side != 0:
            return side
    return 0


def tetrahedra(points: Sequence[Sequence[Any]]) -> list[Tetrahedron]:
    """Triangulate 3-D points by the algorithm of Bowyer and Watson.

    See `bowyer_watson`, which calls this for 3-D points.
    """
    exact = exact_rows(points, 3)
    rows = first_rows(exact)
    first = _first_tetrahedron(exact, rows)
    a, b, c, d = first
    ghosts = {(b, c, d, INFINITE), (c, a, d, INFINITE), (a, b, d, INFINITE), (b, a, c, INFINITE)}
    found = {first} | ghosts
    for row in rows:
        if row in first:
            continue
        cavity = {t for t in found if _in_conflict(exact, t, row, first)}
        found -= cavity
        found |= {(*face, row) for face in _boundary(cavity)}
    return sorted(_ascending(t) for t in found if INFINITE not in t)


def _in_conflict(points: Sequence[Vector], t: Tetrahedron, row: int, first: Tetrahedron) -> bool:
    """Whether a point lies inside the sphere of a tetrahedron, which may be a ghost."""
    if INFINITE not in t:
        a, b, c, d = (points[vertex] for vertex in t)
        return insphere_canonical(a, b, c, d, points[row]) > 0
    u, v, w = (points[vertex] for vertex in _face_opposite(t, t.index(INFINITE)))
    # Infinity is on the positive side of the face.
    side = orient3d(u, v, w, points[row])
    if side != 0:
        return side > 0
    # In the plane of the face, any sphere through its circle decides if the point is inside.
    apex = next(points[e] for e in first if orient3d(u, v, w, points[e]) != 0)
    return orient3d(u, v, w, apex) * insphere_canonical(u, v, w, apex, points[row]) > 0


def _face_opposite(t: Tetrahedron, k: int) -> tuple[int, int, int]:
    """The face opposite a corner, oriented so that the corner is on its positive side."""
    a, b, c, d = t
    return [(d, c, b), (a, c, d), (d, b, a), (a, b, c)][k]


def _boundary(cavity: Iterable[Tetrahedron]) -> list[tuple[int, int, int]]:
    """The faces that bound a set of tetrahedra, with the set on their positive side."""
    faces: dict[frozenset[int], tuple[int, int, int]] = {}
    for t in cavity:
        for k in range(4):
            face = _face_opposite(t, k)
            key = frozenset(face)
            if key in faces:
                del faces[key]
            else:
                faces[key] = face
    return list(faces.values())


def _ascending(t: Tetrahedron) -> Tetrahedron:
    """The same tetrahedron with the same orientation, ascending except for the last two."""
    odd = sum(t[i] > t[j] for i, j in combinations(range(4), 2)) % 2
    a, b, c, d = sorted(t)
    return (a, b, d, c) if odd else (a, b, c, d)


def _first_tetrahedron(points: Sequence[Vector], rows: Sequence[int]) -> Tetrahedron:
    """The first two distinct points, the first not on their line, the first not in their plane."""
    chain = sorted(rows, key=lambda row: points[row])
    if len(rows) < 4:
        message = f"a 3-D triangulation needs four distinct points, got {len(rows)}"
        raise DegenerateInputError(message, reason="too few points", chain=chain)
    a, b, *others = rows
    along = _minus(points[b], points[a])
    off = [c for c in others if any(cross(along, _minus(points[c], points[a])))]
    if not off:
        message = f"all {len(rows)} distinct points lie on one line"
        raise DegenerateInputError(message, reason="collinear", chain=chain)
    c = off[0]
    for d in off:
        side = orient3d(points[a], points[b], points[c], points[d])
        if side != 0:
            return (a, b, c, d) if side > 0 else (b, a, c, d)
    message = f"all {len(rows)} distinct points lie in one plane"
    raise DegenerateInputError(message, reason="coplanar")


def cross(p: Vector, q: Vector) -> Vector:
    """The cross product."""
    return (
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    )


def _exact_vector(point: Sequence[Any]) -> Vector:
    x, y, z = point
    return exact_number(x), exact_number(y), exact_number(z)


def _minus(p: Vector, q: Vector) -> Vector:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def _square(p: Vector) -> ExactNumber:
    return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]


def _determinant(p: Vector, q: Vector, r: Vector) -> ExactNumber:
    return (
        p[0] * (q[1] * r[2] - q[2] * r[1])
        + p[1] * (q[2] * r[0] - q[0] * r[2])
        + p[2] * (q[0] * r[1] - q[1] * r[0])
    )
