"""2-D point sets for examples, tests and benchmarks: seeded generators.

Every generator is a function of the number of points and a seed, and returns float64 points of
shape (n, 2); n must be an integer of at least 0, or InputError is raised. Each one is included
because it breaks something: a float predicate, a sort, a tolerance, a super-triangle. `GENERATORS`
lists them by name.
"""

from __future__ import annotations

from math import isqrt, pi
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from delone._base.arrays import as_count
from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    Points = NDArray[np.float64]

__all__ = [
    "GENERATORS",
    "circle",
    "collinear_lines",
    "duplicates",
    "gaussian_clusters",
    "grid",
    "integer_lattice",
    "kuzmin",
    "mixed_exponents",
    "near_collinear",
    "pythagorean_circle",
    "spiral",
    "tilted_grid",
    "uniform",
    "utm_millimeters",
]


def uniform(n: int, *, seed: int = 0, ndim: int = 2) -> Points:
    """Return uniformly distributed points in the unit square or cube.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int, optional
        The same seed gives the same points.
    ndim : {2, 3}, optional
        Number of coordinates.

    Returns
    -------
    ndarray of float64, shape (n, ndim)
        Coordinates from 0 to 1.

    Examples
    --------
    >>> from delone.datasets import uniform
    >>> uniform(1000).shape
    (1000, 2)
    """
    n = as_count(n)
    return np.random.default_rng(seed).random((n, ndim))


def gaussian_clusters(n: int, *, seed: int = 0, clusters: int = 11) -> Points:
    """Return normal clusters in the unit square, with widths over ten orders of magnitude.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int, optional
        The same seed gives the same points.
    clusters : int, optional
        Number of clusters; their standard deviations range from 1 to 1e-10.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        The points, with clusters mixed.

    Notes
    -----
    The cells are crowded: uniform grids put most of the points into a few cells.

    Examples
    --------
    >>> from delone.datasets import gaussian_clusters
    >>> gaussian_clusters(1000).shape
    (1000, 2)
    """
    n = as_count(n)
    rng = np.random.default_rng(seed)
    centers, widths = rng.random((clusters, 2)), np.logspace(0, -10, clusters)
    of = rng.integers(clusters, size=n)
    points: Points = centers[of] + widths[of, None] * rng.standard_normal((n, 2))
    return points


def kuzmin(n: int, *, seed: int = 0) -> Points:
    """Return points of a Kuzmin disk, a flat galaxy: dense at the center, with a long tail.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int, optional
        The same seed gives the same points.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        The expected fraction within radius r is 1 - 1 / sqrt(1 + r²).

    Notes
    -----
    The density is that of Kuzmin, G. G. (1956), Astronomicheskii Zhurnal 33, 27-45. The farthest of
    n points is about n times as far from the center as the median.

    Examples
    --------
    >>> from delone.datasets import kuzmin
    >>> kuzmin(1000).shape
    (1000, 2)
    """
    n = as_count(n)
    rng = np.random.default_rng(seed)
    outside = 1.0 - rng.random(n)  # in (0, 1], so that the radius is finite
    radius = np.sqrt((1.0 - outside) * (1.0 + outside)) / outside
    return _polar(radius, rng.uniform(0, 2 * pi, n))


def grid(n: int, *, seed: int | None = 0) -> Points:
    """Return the first n points of the smallest square integer grid with at least n points.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int or None, optional
        Shuffles the rows; None leaves them in order, starting with the lowest line.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Integers from 0.

    Notes
    -----
    Every square of four is cocircular; every line and the sides of the hull are collinear.

    Examples
    --------
    >>> from delone.datasets import grid
    >>> grid(4, seed=None).tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
    """
    n = as_count(n)
    width = isqrt(n - 1) + 1 if n else 1
    y, x = np.divmod(np.arange(n), width)
    return _shuffled(np.column_stack((x, y)).astype(np.float64), seed)


def tilted_grid(n: int, *, seed: int | None = 0, angle: float = 0.3) -> Points:
    """Return a grid rotated about the origin, with rounded coordinates.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int or None, optional
        Shuffles the rows; None leaves them in order.
    angle : float, optional
        Angle of rotation in radians, counter-clockwise.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Points that are nearly cocircular and nearly collinear, in either direction.

    Notes
    -----
    The classic trap for tolerances: nothing is degenerate, but everything looks degenerate.

    Examples
    --------
    >>> from delone.datasets import tilted_grid
    >>> tilted_grid(900).shape
    (900, 2)
    """
    x, y = grid(n, seed=seed).T
    cos, sin = np.cos(angle), np.sin(angle)
    return np.column_stack((cos * x - sin * y, sin * x + cos * y))


def circle(n: int, *, seed: int | None = 0, radius: float = 1.0) -> Points:
    """Return points evenly spaced on a circle, up to rounding.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int or None, optional
        Shuffles the rows; None leaves them counter-clockwise.
    radius : float, optional
        Radius of the circle about the origin.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Points within rounding of the circle; `pythagorean_circle` gives exact ones.

    Examples
    --------
    >>> from delone.datasets import circle
    >>> circle(1000).shape
    (1000, 2)
    """
    n = as_count(n)
    angle = 2 * pi * np.arange(n) / max(n, 1)
    return _shuffled(_polar(np.full(n, radius), angle), seed)


def spiral(n: int, *, seed: int | None = 0, turns: float = 10.0) -> Points:
    """Return points along an Archimedean spiral.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int or None, optional
        Shuffles the rows; None leaves them in order from the center.
    turns : float, optional
        Number of turns around the origin.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Points at distances 1/n to 1 from the origin.

    Notes
    -----
    There are long thin triangles between the arms; insertions in order walk along the hull.

    Examples
    --------
    >>> from delone.datasets import spiral
    >>> spiral(1000).shape
    (1000, 2)
    """
    n = as_count(n)
    share = np.arange(1, n + 1) / max(n, 1)
    return _shuffled(_polar(share, 2 * pi * turns * share), seed)


def near_collinear(n: int, *, seed: int = 0, ulps: int = 2) -> Points:
    """Return points within a few units in the last place of a line.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int, optional
        The same seed gives the same points.
    ulps : int, optional
        Maximum error of the second coordinate, in steps to the next double.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Points about y = x / 3 + 1 with 0 <= x < 1; with more than a few, not all are on one line.

    Examples
    --------
    >>> from delone.datasets import near_collinear
    >>> near_collinear(1000).shape
    (1000, 2)
    """
    n = as_count(n)
    rng = np.random.default_rng(seed)
    x = rng.random(n)
    y = x / 3 + 1
    return np.column_stack((x, y + rng.integers(-ulps, ulps + 1, size=n) * np.spacing(y)))


def duplicates(n: int, *, seed: int = 0, distinct: int | None = None) -> Points:
    """Return uniform points, most of which are repeated.

    Parameters
    ----------
    n : int
        Number of rows.
    seed : int, optional
        The same seed gives the same points.
    distinct : int, optional
        Number of distinct points to draw from; by default one per four rows, at least three.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Points in the unit square.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.datasets import duplicates
    >>> len(np.unique(duplicates(1000, distinct=50), axis=0))
    50
    """
    n = as_count(n)
    places = uniform(max(3, n // 4) if distinct is None else distinct, seed=seed)
    return places[np.random.default_rng([seed, 1]).integers(len(places), size=n)]


def collinear_lines(n: int, *, seed: int = 0, lines: int = 5) -> Points:
    """Return points exactly on a few lines, each in its own direction.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int, optional
        The same seed gives the same points.
    lines : int, optional
        Number of lines.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Integers; points of one line may coincide.

    Examples
    --------
    >>> from delone.datasets import collinear_lines
    >>> collinear_lines(1000).shape
    (1000, 2)
    """
    n = as_count(n)
    rng = np.random.default_rng(seed)
    starts = rng.integers(-(2**20), 2**20, size=(lines, 2))
    steps = rng.integers(-20, 21, size=(lines, 2)) * 2 + 1  # odd, so that no step is zero
    of = np.arange(n) % lines
    along = rng.integers(-n, n + 1, size=n)
    points: Points = (starts[of] + along[:, None] * steps[of]).astype(np.float64)
    return points


def utm_millimeters(n: int, *, seed: int = 0) -> Points:
    """Return a square kilometer of survey points in UTM coordinates, rounded to millimeters.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int, optional
        The same seed gives the same points.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Easting from 500,000 m and northing from 5,400,000 m.

    Notes
    -----
    The offset uses half of the bits, and rounding leaves points in rows: a circle test in plain
    double precision is noise here.

    Examples
    --------
    >>> from delone.datasets import utm_millimeters
    >>> utm_millimeters(1000).min(axis=0).round(-3).tolist()
    [500000.0, 5400000.0]
    """
    corner = np.array([500_000.0, 5_400_000.0])
    points: Points = np.round(corner + 1000 * uniform(n, seed=seed), 3)
    return points


def pythagorean_circle(n: int, *, seed: int = 0) -> Points:
    """Return distinct integer points exactly on one circle about the origin.

    Parameters
    ----------
    n : int
        Number of points, up to 236,196.
    seed : int, optional
        Chooses the points if the circle has more than n, and their order.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Integers with the same x² + y²; the radius is below 2**53.

    Raises
    ------
    InputError
        n is larger than the number of points on such a circle.

    Notes
    -----
    A prime p = a² + b² splits into the Gaussian integers a ± bi. If the radius is a product of k
    such primes, there are 4 · 3^k integer points: for each prime the square of one factor, of the
    other, or p itself, times a unit.

    Examples
    --------
    >>> from delone.datasets import pythagorean_circle
    >>> x, y = pythagorean_circle(12).T
    >>> set((x * x + y * y).tolist())
    {25.0}
    """
    n = as_count(n)
    x, y = np.array([1, 0, -1, 0]), np.array([0, 1, 0, -1])
    for a, b in _GAUSSIAN_PRIMES:
        if len(x) >= n:
            break
        # No product exceeds the radius, so int64 is exact.
        factors = ((a * a - b * b, 2 * a * b), (a * a - b * b, -2 * a * b), (a * a + b * b, 0))
        x, y = (
            np.concatenate([x * c - y * d for c, d in factors]),
            np.concatenate([x * d + y * c for c, d in factors]),
        )
    if len(x) < n:
        raise InputError(f"an exact circle has at most {len(x)} points, not {n}")
    chosen = np.random.default_rng(seed).permutation(len(x))[:n]
    return np.column_stack((x, y))[chosen].astype(np.float64)


# p = 5, 13, 17, 29, 37, 41, 53, 61, 73, 89: their product 1.02e15 is below 2**53, but not with 97.
_GAUSSIAN_PRIMES = (
    (2, 1), (3, 2), (4, 1), (5, 2), (6, 1), (5, 4), (7, 2), (6, 5), (8, 3), (8, 5),
)  # fmt: skip


def mixed_exponents(n: int, *, seed: int = 0) -> Points:
    """Return coordinates of all magnitudes of doubles, including subnormal ones.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int, optional
        The same seed gives the same points.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Coordinates of either sign: magnitudes 1e-300 to 1e300, one in ten subnormal, one in
        twenty zero.

    Notes
    -----
    Squares overflow and underflow in most of the tests.

    Examples
    --------
    >>> from delone.datasets import mixed_exponents
    >>> mixed_exponents(1000).shape
    (1000, 2)
    """
    n = as_count(n)
    rng = np.random.default_rng(seed)
    values = 10.0 ** rng.uniform(-300, 300, (n, 2))
    kind = rng.random((n, 2))
    values[kind < 0.15] = rng.integers(1, 2**52, (n, 2))[kind < 0.15] * 5e-324
    values[kind < 0.05] = 0.0
    points: Points = np.copysign(values, rng.random((n, 2)) - 0.5)
    return points


def integer_lattice(n: int, *, seed: int = 0, side: int = 32) -> Points:
    """Return random points of a square lattice.

    Parameters
    ----------
    n : int
        Number of points.
    seed : int, optional
        The same seed gives the same points.
    side : int, optional
        Coordinates are the integers from 0 to side - 1.

    Returns
    -------
    ndarray of float64, shape (n, 2)
        Integers, with random duplicates.

    Examples
    --------
    >>> from delone.datasets import integer_lattice
    >>> integer_lattice(1000, side=4).max()
    np.float64(3.0)
    """
    n = as_count(n)
    return np.random.default_rng(seed).integers(side, size=(n, 2)).astype(np.float64)


def _polar(radius: NDArray[np.float64], angle: NDArray[np.float64]) -> Points:
    return np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))


def _shuffled(points: Points, seed: int | None) -> Points:
    return points if seed is None else np.random.default_rng(seed).permutation(points)


GENERATORS: Mapping[str, Callable[..., Points]] = MappingProxyType(
    {
        generator.__name__: generator
        for generator in (
            uniform,
            gaussian_clusters,
            kuzmin,
            grid,
            tilted_grid,
            circle,
            spiral,
            near_collinear,
            duplicates,
            collinear_lines,
            utm_millimeters,
            pythagorean_circle,
            mixed_exponents,
            integer_lattice,
        )
    }
)
"""The generators of 2-D points by name; each is called with n and the keyword seed."""
