"""What is measured on tetrahedra: volumes, circumcentres, barycentric transforms.

Coordinates enter only as differences to the last corner of the same tetrahedron, so that nothing is
lost far from the origin, and in a unit of the tetrahedron's own, so that nothing over- or
underflows. The volume of a sliver cancels in floating point; everything is computed in three
stages: plainly where the rounding error is provably small, in pairs of doubles where not (T. J.
Dekker, "A floating-point technique for extending the available precision", 1971), and on
`fractions.Fraction` for the few that remain. Assumed are finite points and tetrahedra that are
exactly positively oriented.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone.space.pairs import Pair

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["circumcenters", "face_areas", "face_normals", "transform", "volumes"]

# A determinant above this share of the product of its columns' lengths has lost at most six bits.
_PLAIN = 2.0**-5
# Pairs of doubles err by 2**-98 or so of the product; below this share they keep too little of it.
_PAIRED = 2.0**-45
# Differences, in a unit in which the largest is between 1/2 and 1, below which products of four
# and their rounding errors may underflow.
_SMALLEST = 2.0**-200
# Tetrahedra that are measured at once, so that temporary arrays stay in the cache.
_CHUNK = 1 << 14

Exact = list[Fraction]


class _Measure(NamedTuple):
    """What is to be computed of each tetrahedron."""

    # Numbers in the vectors' own units, the determinant last; of pairs of doubles as of doubles.
    compute: Callable[[_Vectors], list[Any]]
    # The answer of these numbers.
    finish: Callable[[Floats, _Vectors], Floats]
    # The answer of exact vectors and the last corner.
    exact: Callable[[tuple[Exact, Exact, Exact], Exact], list[Fraction]]
    # How many numbers the answer has, and whether the last corner is to be added to it.
    width: int
    origin: bool = False


class _Vectors(NamedTuple):
    """Edge vectors a, b, c of tetrahedra from the last corner, (m, 3) each, and their units."""

    a: Any
    b: Any
    c: Any
    exponent: NDArray[np.int32]


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

    def compute(v: _Vectors) -> list[Any]:
        return [_determinant(v)]

    def finish(determinant: Floats, v: _Vectors) -> Floats:
        return np.ldexp(determinant[:, 0] / 6, 3 * v.exponent)[:, None]

    def exact(vectors: tuple[Exact, Exact, Exact], last: Exact) -> list[Fraction]:
        return [_exact_determinant(*vectors) / 6]

    return _staged(points, simplices, _Measure(compute, finish, exact, 1))[:, 0]


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

    def compute(v: _Vectors) -> list[Any]:
        rows = (*_cross(v.c, v.b), *_cross(v.a, v.c), *_cross(v.b, v.a))
        return [*rows, _determinant(v)]

    def finish(found: Floats, v: _Vectors) -> Floats:
        return np.ldexp(found[:, :9] / found[:, 9:], -v.exponent[:, None])

    def exact(vectors: tuple[Exact, Exact, Exact], last: Exact) -> list[Fraction]:
        a, b, c = vectors
        determinant = _exact_determinant(a, b, c)
        rows = (*_exact_cross(c, b), *_exact_cross(a, c), *_exact_cross(b, a))
        return [entry / determinant for entry in rows]

    result = np.empty((len(simplices), 4, 3))
    result[:, 3] = points[simplices[:, 3]]
    # Adding 0 makes -0 the 0 that it is.
    result[:, :3] = (
        _staged(points, simplices, _Measure(compute, finish, exact, 9)).reshape(-1, 3, 3) + 0.0
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

    def compute(v: _Vectors) -> list[Any]:
        aa, bb, cc = (_dot(p, p) for p in v[:3])
        cb, ac, ba = _cross(v.c, v.b), _cross(v.a, v.c), _cross(v.b, v.a)
        return [*(aa * cb[k] + bb * ac[k] + cc * ba[k] for k in range(3)), _determinant(v)]

    def finish(found: Floats, v: _Vectors) -> Floats:
        return np.ldexp(found[:, :3] / (2 * found[:, 3:]), v.exponent[:, None])

    def exact(vectors: tuple[Exact, Exact, Exact], last: Exact) -> list[Fraction]:
        a, b, c = vectors
        squares = [sum((x * x for x in p), Fraction(0)) for p in vectors]
        products = [_exact_cross(c, b), _exact_cross(a, c), _exact_cross(b, a)]
        twice = 2 * _exact_determinant(a, b, c)
        sums = (sum((s * p[k] for s, p in zip(squares, products, strict=True))) for k in range(3))
        return [offset / twice + origin for offset, origin in zip(sums, last, strict=True)]

    # What is exact has the corner in it already, and is rounded but once.
    return _staged(points, simplices, _Measure(compute, finish, exact, 3, origin=True))


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
        across = np.column_stack([entry.value() for entry in _cross(*columns)])
        size = np.sqrt((a.high**2).sum(axis=1) * (b.high**2).sum(axis=1))
        small = (scaled != 0) & (np.abs(scaled) < _SMALLEST)
        trusted = (np.abs(across).max(axis=1) > _PAIRED * size) & (size > _SMALLEST)
        trusted &= ~small.any(axis=(1, 2)) & np.isfinite(scaled).all(axis=(1, 2))
    exponent = 2 * unit
    for row in np.flatnonzero(~trusted):
        origin, p, q = ([Fraction(x) for x in corner] for corner in corners[row].tolist())
        vectors = ([x - y for x, y in zip(end, origin, strict=True)] for end in (p, q))
        entries = _exact_cross(*vectors)
        most = max(map(abs, entries))
        exponent[row] = most.numerator.bit_length() - most.denominator.bit_length()
        power = Fraction(2) ** int(exponent[row])
        across[row] = [float(entry / power) for entry in entries]
    more = np.frexp(np.abs(across).max(axis=1))[1]
    return np.ldexp(across, -more[:, None]), exponent + more


def _staged(points: Floats, simplices: Indices, measure: _Measure) -> Floats:
    """What `compute` makes of each tetrahedron, by the first stage that is accurate."""
    result = np.empty((len(simplices), measure.width))
    for start in range(0, len(simplices), _CHUNK):
        part = slice(start, start + _CHUNK)
        corners = points[simplices[part]]
        vectors, doubtful = _vectors(corners)
        with np.errstate(all="ignore"):
            found = np.column_stack(measure.compute(_columns(vectors)))
            size = _size(vectors)
            doubtful |= ~(found[:, -1] > _PLAIN * size)
            value = measure.finish(found, vectors)
            if measure.origin:
                value += corners[:, 3]
            rows = np.flatnonzero(doubtful)
            if rows.size:
                paired, accurate = _paired(corners[rows], measure)
                value[rows] = paired
                rows = rows[~accurate]
        for row in rows:
            value[row] = [
                _rounded(number) for number in measure.exact(*_exact_vectors(corners[row]))
            ]
        result[part] = value
    return result


def _paired(corners: Floats, measure: _Measure) -> tuple[Floats, NDArray[np.bool_]]:
    """The same in pairs of doubles, and for which tetrahedra that is enough."""
    vectors, doubtful = _vectors(corners)
    a, b, c = (_exact_difference(corners, k, vectors) for k in range(3))
    pairs = _columns(_Vectors(a, b, c, vectors.exponent))
    found = np.column_stack([pair.value() for pair in measure.compute(pairs)])
    small = np.zeros(len(corners), dtype=bool)
    for vector in vectors[:3]:
        small |= ((vector != 0) & (np.abs(vector) < _SMALLEST)).any(axis=1)
    accurate = (found[:, -1] > _PAIRED * _size(vectors)) & ~doubtful & ~small
    value = measure.finish(found, vectors)
    if measure.origin:
        value += corners[:, 3]
    return value, accurate & np.isfinite(value).all(axis=1)


def _vectors(corners: Floats) -> tuple[_Vectors, NDArray[np.bool_]]:
    """Rounded edge vectors in units in which the largest is about 1; and where there is none."""
    with np.errstate(over="ignore", invalid="ignore"):
        edges = corners[:, :3] - corners[:, 3:]
    largest = np.abs(edges).reshape(len(edges), -1).max(axis=1)
    exponent = np.frexp(largest)[1]
    doubtful = ~np.isfinite(largest)
    # Beyond this the unit itself, or its third power, is no double.
    doubtful |= np.abs(exponent) > 300
    exponent[doubtful] = 0
    with np.errstate(all="ignore"):
        edges = np.ldexp(edges, -exponent[:, None, None])
    return _Vectors(edges[:, 0], edges[:, 1], edges[:, 2], exponent), doubtful


def _exact_difference(corners: Floats, k: int, vectors: _Vectors) -> Pair:
    """An edge vector without rounding."""
    unit = -vectors.exponent[:, None]
    return Pair.difference(np.ldexp(corners[:, k], unit), np.ldexp(corners[:, 3], unit))


def _columns(vectors: _Vectors) -> _Vectors:
    """Coordinates as arrays of their own, x, y and z of each vector."""
    a, b, c = ([vector[:, k] for k in range(3)] for vector in vectors[:3])
    return _Vectors(a, b, c, vectors.exponent)


def _size(vectors: _Vectors) -> Floats:
    """The product of the lengths of the vectors."""
    lengths = [np.sqrt(np.einsum("ij,ij->i", v, v)) for v in vectors[:3]]
    size: Floats = lengths[0] * lengths[1] * lengths[2]
    return size


def _dot(p: Any, q: Any) -> Any:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def _cross(p: Any, q: Any) -> tuple[Any, Any, Any]:
    return (
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    )


def _determinant(v: _Vectors) -> Any:
    # Seen from the last corner of a positive tetrahedron, the others go round clockwise.
    return _dot(v.a, _cross(v.c, v.b))


def _exact_vectors(corners: Floats) -> tuple[tuple[Exact, Exact, Exact], Exact]:
    a, b, c, d = ([Fraction(x) for x in corner] for corner in corners.tolist())
    u, v, w = ([x - y for x, y in zip(p, d, strict=True)] for p in (a, b, c))
    return (u, v, w), d


def _exact_cross(p: Exact, q: Exact) -> Exact:
    return list(_cross(p, q))


def _exact_determinant(a: Exact, b: Exact, c: Exact) -> Fraction:
    determinant: Fraction = _dot(a, _cross(c, b))
    return determinant


def _rounded(number: Fraction) -> float:
    try:
        return float(number)
    except OverflowError:
        return float("inf") if number > 0 else float("-inf")
