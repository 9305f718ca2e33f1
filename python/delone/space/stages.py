"""Numbers of tetrahedra in three stages: what cancels is computed again, with more digits.

Coordinates enter only as differences to the last corner of the same tetrahedron, so that nothing is
lost far from the origin, and in a unit of the tetrahedron's own, so that nothing over- or
underflows. What is computed of a sliver cancels in floating point. So everything is computed
plainly where the rounding error is provably small, in pairs of doubles where not (T. J. Dekker, "A
floating-point technique for extending the available precision", 1971), and on `fractions.Fraction`
for the few that remain. Assumed are finite points and tetrahedra that are exactly positively
oriented.

The measure of what is lost is the determinant D of the vectors a, b, c from the last corner, as a
share of |a| |b| |c|. Not only D is known where that is large: so are the vectors of all four faces,
which are at least D over the shortest of the three long, and the lengths of all edges, which are
at least that share of both vectors that they join.
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

__all__ = ["SMALLEST", "Exact", "Measure", "Vectors", "cross", "determinant", "dot", "staged"]

# Differences, in a unit in which the largest is between 1/2 and 1, below which products of four
# and their rounding errors may underflow.
SMALLEST = 2.0**-200
# A determinant above this share of the product of its columns' lengths has lost at most six bits.
_PLAIN = 2.0**-5
# Pairs of doubles err by 2**-98 or so of the product; below this share they keep too little of it.
_PAIRED = 2.0**-51
# Tetrahedra that are measured at once, so that temporary arrays stay in the cache.
_CHUNK = 1 << 13

Exact = list[Fraction]


class Measure(NamedTuple):
    """What is to be computed of each tetrahedron."""

    # Numbers in the vectors' own units, the determinant last; of pairs of doubles as of doubles.
    compute: Callable[[Vectors], list[Any]]
    # The answer of these numbers, (k, m), as (width, m).
    finish: Callable[[Floats, Vectors], Floats]
    # The answer of exact vectors and the last corner.
    exact: Callable[[tuple[Exact, Exact, Exact], Exact], list[Fraction] | list[float]]
    # How many numbers the answer has, and whether the last corner is to be added to it.
    width: int
    origin: bool = False


class Vectors(NamedTuple):
    """Edge vectors a, b, c of tetrahedra from the last corner, (m, 3) each, and their units."""

    a: Any
    b: Any
    c: Any
    exponent: NDArray[np.int32]


def staged(points: Floats, simplices: Indices, measure: Measure) -> Floats:
    """Return what `compute` makes of each tetrahedron, by the first stage that is accurate.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.
    measure : Measure
        What is to be computed.

    Returns
    -------
    ndarray of float64, shape (m, width)
        The answers.
    """
    result = np.empty((len(simplices), measure.width))
    for start in range(0, len(simplices), _CHUNK):
        part = slice(start, start + _CHUNK)
        corners = points[simplices[part]]
        vectors, doubtful = _vectors(corners)
        with np.errstate(all="ignore"):
            columns = _columns(vectors)
            found = np.stack(measure.compute(columns))
            doubtful |= ~_accurate(found[-1], columns, _PLAIN)
            value = measure.finish(found, columns).T
            if measure.origin:
                value = value + corners[:, 3]
                # The sum with the corner may be a double although the offset is none.
                doubtful |= ~np.isfinite(value).all(axis=1)
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


def _paired(corners: Floats, measure: Measure) -> tuple[Floats, NDArray[np.bool_]]:
    """The same in pairs of doubles, and for which tetrahedra that is enough."""
    vectors, doubtful = _vectors(corners)
    a, b, c = (_exact_difference(corners, k, vectors) for k in range(3))
    pairs = _columns(Vectors(a, b, c, vectors.exponent))
    found = np.stack([pair.value() for pair in measure.compute(pairs)])
    columns = _columns(vectors)
    small = np.zeros(len(corners), dtype=bool)
    for vector in vectors[:3]:
        small |= ((vector != 0) & (np.abs(vector) < SMALLEST)).any(axis=1)
    accurate = _accurate(found[-1], columns, _PAIRED) & ~doubtful & ~small
    value = measure.finish(found, columns).T
    if measure.origin:
        value = value + corners[:, 3]
        accurate &= np.isfinite(value).all(axis=1)
    return value, accurate & np.isfinite(found).all(axis=0)


def _accurate(found: Floats, columns: Vectors, share: float) -> NDArray[np.bool_]:
    """Which determinants are larger than a share of what they are made of, which is not tiny."""
    squares = [dot(p, p) for p in columns[:3]]
    size = np.sqrt(squares[0]) * np.sqrt(squares[1]) * np.sqrt(squares[2])
    known: NDArray[np.bool_] = (found > share * size) & (size > SMALLEST)
    return known


def _vectors(corners: Floats) -> tuple[Vectors, NDArray[np.bool_]]:
    """Rounded edge vectors in units in which the largest is about 1; and where there is none."""
    with np.errstate(over="ignore", invalid="ignore"):
        edges = corners[:, :3] - corners[:, 3:]
    largest = np.abs(edges).reshape(len(edges), -1).max(axis=1)
    exponent = np.frexp(largest)[1]
    doubtful = ~np.isfinite(largest)
    exponent[doubtful] = 0
    with np.errstate(all="ignore"):
        edges = np.ldexp(edges, -exponent[:, None, None])
    return Vectors(edges[:, 0], edges[:, 1], edges[:, 2], exponent), doubtful


def _exact_difference(corners: Floats, k: int, vectors: Vectors) -> Pair:
    """An edge vector without rounding."""
    unit = -vectors.exponent[:, None]
    return Pair.difference(np.ldexp(corners[:, k], unit), np.ldexp(corners[:, 3], unit))


def _columns(vectors: Vectors) -> Vectors:
    """Coordinates as arrays of their own, x, y and z of each vector."""
    a, b, c = ([vector[:, k] for k in range(3)] for vector in vectors[:3])
    return Vectors(a, b, c, vectors.exponent)


def dot(p: Any, q: Any) -> Any:
    """Return the inner product of two vectors, of whatever numbers."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Any, q: Any) -> tuple[Any, Any, Any]:
    """Return the cross product of two vectors, of whatever numbers."""
    return (
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    )


def determinant(a: Any, b: Any, c: Any) -> Any:
    """Return six times the volume of a tetrahedron of its vectors from the last corner."""
    # Seen from the last corner of a positive tetrahedron, the others go round clockwise.
    return dot(a, cross(c, b))


def _exact_vectors(corners: Floats) -> tuple[tuple[Exact, Exact, Exact], Exact]:
    a, b, c, d = ([Fraction(x) for x in corner] for corner in corners.tolist())
    u, v, w = ([x - y for x, y in zip(p, d, strict=True)] for p in (a, b, c))
    return (u, v, w), d


def _rounded(number: Fraction | float) -> float:
    try:
        return float(number)
    except OverflowError:
        return float("inf") if number > 0 else float("-inf")
