"""What is measured on triangles: areas, circumcentres, barycentric transforms.

Coordinates enter only as differences to a corner of the same triangle, so that nothing is lost far
from the origin. The area of a sliver cancels in floating point; it is computed in three stages:
plainly where the rounding error is provably small, with the rounding errors themselves carried
along where not (T. J. Dekker, "A floating-point technique for extending the available precision",
1971), and on `fractions.Fraction` for the few that remain. Assumed are finite points and triangles
that are exactly counter-clockwise.
"""

from __future__ import annotations

from fractions import Fraction
from math import fsum, inf
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Exact = tuple[Fraction, Fraction]

__all__ = ["areas", "circumcenters", "edge_normals", "total", "transform"]

# A difference of products that is above this share of their magnitude has lost at most five bits.
_PLAIN = 2.0**-5
# With errors carried along, a relative error of 2**-104 or so grows by the inverse of this.
_COMPENSATED = 2.0**-52
# Magnitudes of products between which no stage but the exact one over- or underflows.
_SMALLEST, _LARGEST = 2.0**-800, 2.0**900
# 2**27 + 1 splits a double into two halves whose products are exact.
_SPLITTER = 134217729.0


def areas(points: Floats, simplices: Indices) -> Floats:
    """Return the areas of triangles.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.

    Returns
    -------
    ndarray of float64, shape (m,)
        With a relative error below 1e-13, unless the area itself is beyond the range of doubles
        (then inf, or rounded among the subnormal ones).

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import areas
    >>> areas(np.array([(0, 0), (4, 0), (0, 3.0)]), np.array([[0, 1, 2]]))
    array([6.])
    """
    corners = points[simplices]
    twice, doubtful = _determinants(corners)
    area = 0.5 * twice

    def exact(a: Exact, b: Exact) -> list[float]:
        return [_rounded(_cross(a, b) / 2)]

    area[doubtful] = _exactly(exact, corners[doubtful]).reshape(-1)
    return area


def transform(points: Floats, simplices: Indices) -> Floats:
    """Return the affine maps from the plane to barycentric coordinates.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.

    Returns
    -------
    ndarray of float64, shape (m, 3, 2)
        For each triangle the inverse of the matrix whose columns lead from the last corner to the
        first two, and below it the last corner. Entries have a relative error below 1e-13, unless
        they are beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import transform
    >>> transform(np.array([(4, 0), (4, 2), (2, 1.0)]), np.array([[0, 1, 2]]))
    array([[[ 0.25, -0.5 ],
            [ 0.25,  0.5 ],
            [ 2.  ,  1.  ]]])
    """
    corners = points[simplices]
    result = np.empty_like(corners)
    result[:, 2] = corners[:, 2]
    determinant, doubtful = _determinants(corners)
    a, b = _edges(corners)
    with np.errstate(all="ignore"):
        result[:, 0, 0] = b[:, 1] / determinant
        result[:, 0, 1] = -b[:, 0] / determinant
        result[:, 1, 0] = -a[:, 1] / determinant
        result[:, 1, 1] = a[:, 0] / determinant

    def exact(a: Exact, b: Exact) -> list[float]:
        determinant = _cross(a, b)
        inverse = (b[1], -b[0], -a[1], a[0])
        return [_rounded(entry / determinant) for entry in inverse]

    result[doubtful, :2] = _exactly(exact, corners[doubtful]).reshape(-1, 2, 2)
    # Where a component is 0, so that it is not -0.
    result[:, :2] += 0.0
    return result


def circumcenters(points: Floats, simplices: Indices) -> Floats:
    """Return the centres of the circles through the corners of triangles.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.

    Returns
    -------
    ndarray of float64, shape (m, 2)
        With an error below 1e-13 of the radius, and the rounding of the result; infinite where a
        coordinate is beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import circumcenters
    >>> circumcenters(np.array([(0, 0), (4, 0), (2, 1.0)]), np.array([[0, 1, 2]]))
    array([[ 2. , -1.5]])
    """
    corners = _apex_last(points[simplices])
    determinant, doubtful = _determinants(corners)
    a, b = _edges(corners)
    with np.errstate(all="ignore"):
        (ax, ay), (bx, by) = a.T, b.T
        squared_a, squared_b = ax * ax + ay * ay, bx * bx + by * by
        # Third powers of lengths: cube the range in which nothing over- or underflows.
        shortest = np.minimum(squared_a, squared_b)
        longest = np.maximum(squared_a, squared_b)
        doubtful |= ~((shortest > _SMALLEST**0.5) & (longest < _LARGEST**0.5))
        x = (by * squared_a - ay * squared_b) / (2 * determinant)
        y = (ax * squared_b - bx * squared_a) / (2 * determinant)
        centers: Floats = corners[:, 2] + np.column_stack((x, y))

    def exact(a: Exact, b: Exact) -> list[Fraction]:
        squared_a, squared_b = a[0] ** 2 + a[1] ** 2, b[0] ** 2 + b[1] ** 2
        twice = 2 * _cross(a, b)
        x = (b[1] * squared_a - a[1] * squared_b) / twice
        y = (a[0] * squared_b - b[0] * squared_a) / twice
        return [x, y]

    for row in np.flatnonzero(doubtful):
        triangle = corners[row]
        offset = exact(*_exact_edges(triangle))
        centers[row] = [
            _rounded(Fraction(origin) + part)
            for origin, part in zip(triangle[2].tolist(), offset, strict=True)
        ]
    return centers


def edge_normals(points: Floats, edges: Indices) -> Floats:
    """Return the unit normals of edges in the plane, to their right.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    edges : ndarray of int32, shape (k, 2)
        Tails and heads, at different places.

    Returns
    -------
    ndarray of float64, shape (k, 2)
        With an error below 1e-15.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import edge_normals
    >>> edge_normals(np.array([(1, 1), (1, 5.0)]), np.array([[0, 1], [1, 0]]))
    array([[ 1.,  0.],
           [-1.,  0.]])
    """
    # Halves where a difference overflows; a power of two, so that small ones keep their bits.
    ends = points[edges]
    with np.errstate(over="ignore"):
        along = ends[:, 1] - ends[:, 0]
        wide = ~np.isfinite(along).all(axis=1)
    along[wide] = ends[wide, 1] / 2 - ends[wide, 0] / 2
    exponent = np.frexp(np.abs(along).max(axis=1))[1]
    along = np.ldexp(along, -exponent[:, None])
    normals = np.column_stack((along[:, 1], -along[:, 0]))
    normals /= np.hypot(normals[:, 0], normals[:, 1])[:, None]
    # Adding 0 makes -0 the 0 that it is.
    return normals + 0.0


def total(sizes: Floats) -> float:
    """Return the sum of sizes, rounded once.

    Parameters
    ----------
    sizes : ndarray of float64, shape (m,)
        Lengths, areas or volumes: none below zero.

    Returns
    -------
    float
        Inf where the sum is beyond the range of doubles.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.geometry import total
    >>> total(np.array([0.1] * 10)), total(np.array([1e308, 1e308]))
    (1.0, inf)
    """
    try:
        return fsum(sizes.tolist())
    except OverflowError:
        return inf


def _apex_last(corners: Floats) -> Floats:
    """Turn triangles until the longest edge is opposite the last corner.

    Then the two edge vectors are no longer than twice what separates their ends, and the
    numerators of the circumcentre do not cancel.
    """
    first, second, third = (corners[:, k] for k in range(3))
    opposite_first, opposite_second = _spread(second, third), _spread(third, first)
    longest = np.maximum(opposite_first, opposite_second)
    elsewhere = ~(_spread(first, second) >= longest)
    turned = corners.copy()
    for order, longest_there in (
        ([1, 2, 0], opposite_first >= opposite_second),
        ([2, 0, 1], opposite_first < opposite_second),
    ):
        rows = np.flatnonzero(elsewhere & longest_there)
        turned[rows] = corners[rows][:, order]
    return turned


def _spread(a: Floats, b: Floats) -> Floats:
    """Distance in the maximum norm."""
    with np.errstate(over="ignore"):
        difference = np.abs(a - b)
    spread: Floats = np.maximum(difference[:, 0], difference[:, 1])
    return spread


def _edges(corners: Floats) -> tuple[Floats, Floats]:
    """Vectors from the last corner to the first two."""
    with np.errstate(over="ignore"):
        return corners[:, 0] - corners[:, 2], corners[:, 1] - corners[:, 2]


def _determinants(corners: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Twice the areas, and for which triangles they are not known well."""
    a, b = _edges(corners)
    with np.errstate(all="ignore"):
        left, right = a[:, 0] * b[:, 1], a[:, 1] * b[:, 0]
        determinant = left - right
        size = np.abs(left) + np.abs(right)
        # Written so that NaN is doubtful.
        plain = (determinant > _PLAIN * size) & (size > _SMALLEST) & (size < _LARGEST)
    doubtful = ~plain
    rows = np.flatnonzero(doubtful)
    if rows.size:
        determinant[rows], doubtful[rows] = _compensated(corners[rows])
    return determinant, doubtful


def _compensated(corners: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Twice the areas in about twice the precision, and where that is not enough."""
    with np.errstate(all="ignore"):
        a, a_error = _difference(corners[:, 0], corners[:, 2])
        b, b_error = _difference(corners[:, 1], corners[:, 2])
        left, left_error = _product(a[:, 0], b[:, 1])
        right, right_error = _product(a[:, 1], b[:, 0])
        high, low = _difference(left, right)
        low += left_error - right_error
        low += a[:, 0] * b_error[:, 1] + a_error[:, 0] * b[:, 1]
        low -= a[:, 1] * b_error[:, 0] + a_error[:, 1] * b[:, 0]
        determinant = high + low
        factors = np.abs(np.concatenate((a, b), axis=1))
        size = np.abs(left) + np.abs(right)
        trusted = (determinant > _COMPENSATED * size) & (size > _SMALLEST)
        trusted &= (factors < _LARGEST**0.5).all(axis=1)
        # The error of a product with a tiny factor would underflow.
        trusted &= ((factors == 0) | (factors > _SMALLEST**0.5)).all(axis=1)
    return determinant, ~trusted


def _difference(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """The rounded difference and, exactly, what rounding took away (D. E. Knuth's TwoSum)."""
    rounded = a - b
    virtual = a - rounded
    return rounded, (a - (rounded + virtual)) + (virtual - b)


def _product(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """The rounded product and, exactly, what rounding took away (Dekker, 1971)."""
    rounded = a * b
    (a_high, a_low), (b_high, b_low) = _split(a), _split(b)
    error = a_low * b_low - (((rounded - a_high * b_high) - a_low * b_high) - a_high * b_low)
    return rounded, error


def _split(a: Floats) -> tuple[Floats, Floats]:
    large = _SPLITTER * a
    high = large - (large - a)
    return high, a - high


def _exactly(compute: Callable[[Exact, Exact], list[float]], corners: Floats) -> Floats:
    """What `compute` makes of each triangle's exact edge vectors."""
    return np.array([compute(*_exact_edges(triangle)) for triangle in corners], dtype=np.float64)


def _exact_edges(triangle: Floats) -> tuple[Exact, Exact]:
    (ax, ay), (bx, by), (ox, oy) = ([Fraction(x) for x in corner] for corner in triangle.tolist())
    return (ax - ox, ay - oy), (bx - ox, by - oy)


def _cross(a: Exact, b: Exact) -> Fraction:
    return a[0] * b[1] - a[1] * b[0]


def _rounded(number: Fraction) -> float:
    try:
        return float(number)
    except OverflowError:
        return float("inf") if number > 0 else float("-inf")
