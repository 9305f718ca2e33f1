"""What is measured on tetrahedra: volumes, circumcentres, barycentric transforms.

The volume of a sliver cancels in floating point; `stages` computes it again, with more digits.
Triangles alone go to pairs of doubles at once. Assumed are finite points and tetrahedra that are
exactly positively oriented.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.space.pairs import Pair
from delone.space.stages import SMALLEST, Exact, Measure, Vectors, cross, determinant, dot, staged

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["circumcenters", "face_areas", "face_normals", "transform", "volumes"]

# Pairs of doubles err by 2**-98 or so of the product of two edges; below this share of it they keep
# too little of the triangle's vector.
_THIN = 2.0**-45


def volumes(points: Floats, simplices: Indices) -> Floats:
    """Return the volumes of tetrahedra.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.

    Returns
    -------
    ndarray of float64, shape (m,)
        With a relative error below 1e-13, unless the volume itself is beyond the range of doubles
        (then inf, or rounded among the subnormal ones).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import volumes
    >>> corners = np.array([(0, 0, 0), (3, 0, 0), (0, 2, 0), (0, 0, 4.0)])
    >>> volumes(corners, np.array([[0, 1, 2, 3]]))
    array([4.])
    """

    def compute(v: Vectors) -> list[Any]:
        return [determinant(v.a, v.b, v.c)]

    def finish(found: Floats, v: Vectors) -> Floats:
        return np.ldexp(found / 6, 3 * v.exponent)

    def exact(vectors: tuple[Exact, Exact, Exact], last: Exact) -> list[Fraction]:
        return [determinant(*vectors) / 6]

    return staged(points, simplices, Measure(compute, finish, exact, 1))[:, 0]


def transform(points: Floats, simplices: Indices) -> Floats:
    """Return the affine maps from space to barycentric coordinates.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.

    Returns
    -------
    ndarray of float64, shape (m, 4, 3)
        For each tetrahedron the inverse of the matrix whose columns lead from the last corner to
        the first three, and below it the last corner. Each row has an error below 1e-13 of its
        length, unless it is beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import transform
    >>> corners = np.array([(4, 0, 0), (0, 2, 0), (0, 0, 8), (0, 0, 0.0)])
    >>> transform(corners, np.array([[0, 2, 1, 3]]))
    array([[[0.25 , 0.   , 0.   ],
            [0.   , 0.   , 0.125],
            [0.   , 0.5  , 0.   ],
            [0.   , 0.   , 0.   ]]])
    """

    def compute(v: Vectors) -> list[Any]:
        rows = (*cross(v.c, v.b), *cross(v.a, v.c), *cross(v.b, v.a))
        return [*rows, determinant(v.a, v.b, v.c)]

    def finish(found: Floats, v: Vectors) -> Floats:
        rows: Floats = np.ldexp(found[:9] / found[9], -v.exponent)
        return rows

    def exact(vectors: tuple[Exact, Exact, Exact], last: Exact) -> list[Fraction]:
        a, b, c = vectors
        size = determinant(a, b, c)
        rows = (*cross(c, b), *cross(a, c), *cross(b, a))
        return [entry / size for entry in rows]

    result = np.empty((len(simplices), 4, 3))
    result[:, 3] = points[simplices[:, 3]]
    # Adding 0 makes -0 the 0 that it is.
    result[:, :3] = (
        staged(points, simplices, Measure(compute, finish, exact, 9)).reshape(-1, 3, 3) + 0.0
    )
    return result


def circumcenters(points: Floats, simplices: Indices) -> Floats:
    """Return the centres of the spheres through the corners of tetrahedra.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.

    Returns
    -------
    ndarray of float64, shape (m, 3)
        With an error below 1e-13 of the radius, and the rounding of the result; infinite where a
        coordinate is beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import circumcenters
    >>> corners = np.array([(0, 0, 0), (4, 0, 0), (0, 2, 0), (0, 0, 6.0)])
    >>> circumcenters(corners, np.array([[0, 1, 2, 3]]))
    array([[2., 1., 3.]])
    """

    def compute(v: Vectors) -> list[Any]:
        aa, bb, cc = (dot(p, p) for p in v[:3])
        cb, ac, ba = cross(v.c, v.b), cross(v.a, v.c), cross(v.b, v.a)
        return [
            *(aa * cb[k] + bb * ac[k] + cc * ba[k] for k in range(3)),
            determinant(v.a, v.b, v.c),
        ]

    def finish(found: Floats, v: Vectors) -> Floats:
        offsets: Floats = np.ldexp(found[:3] / (2 * found[3]), v.exponent)
        return offsets

    def exact(vectors: tuple[Exact, Exact, Exact], last: Exact) -> list[Fraction]:
        a, b, c = vectors
        squares = [sum((x * x for x in p), Fraction(0)) for p in vectors]
        products = [cross(c, b), cross(a, c), cross(b, a)]
        twice = 2 * determinant(a, b, c)
        sums = (sum((s * p[k] for s, p in zip(squares, products, strict=True))) for k in range(3))
        return [offset / twice + origin for offset, origin in zip(sums, last, strict=True)]

    # What is exact has the corner in it already, and is rounded but once.
    return staged(points, simplices, Measure(compute, finish, exact, 3, origin=True))


def face_normals(points: Floats, faces: Indices) -> Floats:
    """Return the unit normals of triangles in space.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    faces : ndarray of int32, shape (m, 3)
        Triangles, none of which is flat.

    Returns
    -------
    ndarray of float64, shape (m, 3)
        From where the triangle is counter-clockwise, with an error below 1e-14.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import face_normals
    >>> face_normals(np.array([(0, 0, 5), (2, 0, 5), (0, 3, 5.0)]), np.array([[0, 1, 2]]))
    array([[0., 0., 1.]])
    """
    across, _ = _across(points, faces)
    normals: Floats = across / np.sqrt((across * across).sum(axis=1))[:, None]
    # Adding 0 makes -0 the 0 that it is.
    return normals + 0.0


def face_areas(points: Floats, faces: Indices) -> Floats:
    """Return the areas of triangles in space.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    faces : ndarray of int32, shape (m, 3)
        Triangles, none of which is flat.

    Returns
    -------
    ndarray of float64, shape (m,)
        With a relative error below 1e-14, unless the area is beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.space.geometry import face_areas
    >>> face_areas(np.array([(0, 0, 5), (2, 0, 5), (0, 3, 5.0)]), np.array([[0, 1, 2]]))
    array([3.])
    """
    across, exponent = _across(points, faces)
    with np.errstate(over="ignore", under="ignore"):
        areas: Floats = np.ldexp(np.sqrt((across * across).sum(axis=1)) / 2, exponent)
    return areas


def _across(points: Floats, faces: Indices) -> tuple[Floats, NDArray[np.int32]]:
    """Cross products of edges, the largest entry between 1/2 and 1, and exponents of their units.

    Pairs of doubles tell all but the thinnest triangles; those go to fractions.
    """
    corners = points[faces]
    with np.errstate(all="ignore"):
        largest = np.abs(corners[:, 1:] - corners[:, :1]).reshape(-1, 6).max(axis=1)
        unit = np.frexp(largest)[1]
        scaled = np.ldexp(corners, -unit[:, None, None])
        a, b = (Pair.difference(scaled[:, k], scaled[:, 0]) for k in (1, 2))
        columns = [[v[:, k] for k in range(3)] for v in (a, b)]
        across = np.column_stack([entry.value() for entry in cross(*columns)])
        size = np.sqrt((a.high**2).sum(axis=1) * (b.high**2).sum(axis=1))
        small = (scaled != 0) & (np.abs(scaled) < SMALLEST)
        trusted = (np.abs(across).max(axis=1) > _THIN * size) & (size > SMALLEST)
        trusted &= ~small.any(axis=(1, 2)) & np.isfinite(scaled).all(axis=(1, 2))
    exponent = 2 * unit
    for row in np.flatnonzero(~trusted):
        origin, p, q = ([Fraction(x) for x in corner] for corner in corners[row].tolist())
        vectors = ([x - y for x, y in zip(end, origin, strict=True)] for end in (p, q))
        entries = cross(*vectors)
        most = max(map(abs, entries))
        exponent[row] = most.numerator.bit_length() - most.denominator.bit_length()
        power = Fraction(2) ** int(exponent[row])
        across[row] = [float(entry / power) for entry in entries]
    more = np.frexp(np.abs(across).max(axis=1))[1]
    return np.ldexp(across, -more[:, None]), exponent + more
