"""3-D point sets for examples, tests and benchmarks: seeded generators.

Like those in 2-D, every generator is a function of the number of points and a seed, returns float64
points of shape (n, 3), and is included because it breaks something. `GENERATORS` lists them by
name; `delone.datasets` exports it as `GENERATORS3`.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from delone._base.arrays import as_count

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    Points = NDArray[np.float64]

__all__ = ["GENERATORS"]


def uniform(n: int, *, seed: int = 0) -> Points:
    """Return uniformly distributed points in the unit cube."""
    return np.random.default_rng(seed).random((as_count(n), 3))


def grid(n: int, *, seed: int | None = 0) -> Points:
    """Return the first n points of the smallest cubic integer grid with at least n points.

    The eight corners of each small cube are on one sphere. With the seed None the rows are in
    order.
    """
    n = as_count(n)
    # Cube roots differ between processors in their last bit; comparing integers does not.
    side = max(1, round(n ** (1 / 3)))
    side += side**3 < n
    rows = np.arange(n)
    columns = (rows // side**2, rows // side % side, rows % side)
    points = np.column_stack(columns).astype(np.float64)
    return points if seed is None else np.random.default_rng(seed).permutation(points)


def integer_lattice(n: int, *, seed: int = 0, side: int = 4) -> Points:
    """Return random points of a cubic lattice of `side` points per axis, most of them repeated."""
    rng = np.random.default_rng(seed)
    return rng.integers(0, side, (as_count(n), 3)).astype(np.float64)


def sphere(n: int, *, seed: int = 0) -> Points:
    """Return points on the unit sphere, up to rounding: all are on the hull."""
    points = np.random.default_rng(seed).standard_normal((as_count(n), 3))
    points /= np.sqrt((points * points).sum(axis=1))[:, None]
    return points


def integer_sphere(n: int, *, seed: int = 0) -> Points:
    """Return integer points exactly on a sphere of radius 45; if n is above 294, some repeat."""
    n = as_count(n)
    radius = 45
    axis = np.arange(-radius, radius + 1)
    x, y = (a.ravel() for a in np.meshgrid(axis, axis, indexing="ij"))
    rest = radius**2 - x * x - y * y
    z = np.sqrt(np.maximum(rest, 0)).round().astype(np.int64)
    on = (rest >= 0) & (z * z == rest)
    half = np.column_stack((x[on], y[on], z[on]))
    below = half[half[:, 2] > 0] * (1, 1, -1)
    points = np.concatenate((half, below)).astype(np.float64)
    order = np.random.default_rng(seed).permutation(len(points))
    return points[np.resize(order, n)]


def clusters(n: int, *, seed: int = 0) -> Points:
    """Return normal clusters in the unit cube, with widths over ten orders of magnitude."""
    n, rng = as_count(n), np.random.default_rng(seed)
    centers, widths = rng.random((11, 3)), np.logspace(-11, -1, 11)
    which = rng.integers(0, 11, n)
    return centers[which] + widths[which, None] * rng.standard_normal((n, 3))


def planes(n: int, *, seed: int = 0, count: int = 3) -> Points:
    """Return lattice points of `count` parallel tilted planes: most are coplanar and cocircular."""
    n, rng = as_count(n), np.random.default_rng(seed)
    side = max(2, int(np.sqrt(n)))
    x, y = rng.integers(0, side, (2, n))
    return np.column_stack((x, y, x + 2 * y + 7 * rng.integers(0, count, n))).astype(np.float64)


def near_coplanar(n: int, *, seed: int = 0) -> Points:
    """Return points within two times the smallest positive double of a plane."""
    n, rng = as_count(n), np.random.default_rng(seed)
    points = rng.random((n, 3))
    points[:, 2] = np.ldexp(rng.integers(0, 3, n).astype(np.float64), -1074)
    return points


def prism(n: int, *, seed: int = 0) -> Points:
    """Return points of a prism over a rounded regular polygon: two large cocircular facets."""
    n = as_count(n)
    angle = 2 * np.pi * (np.arange(n) // 2) / max(1, (n + 1) // 2)
    points = np.column_stack((np.cos(angle), np.sin(angle), (np.arange(n) % 2).astype(np.float64)))
    return np.random.default_rng(seed).permutation(points)


def mixed_exponents(n: int, *, seed: int = 0) -> Points:
    """Return coordinates of all magnitudes of doubles, including subnormal ones."""
    n, rng = as_count(n), np.random.default_rng(seed)
    return np.ldexp(rng.uniform(-1, 1, (n, 3)), rng.integers(-1073, 1024, (n, 3)))


GENERATORS: Mapping[str, Callable[..., Points]] = MappingProxyType(
    {
        generator.__name__: generator
        for generator in (
            clusters,
            grid,
            integer_lattice,
            integer_sphere,
            mixed_exponents,
            near_coplanar,
            planes,
            prism,
            sphere,
            uniform,
        )
    }
)
"""The generators of 3-D points by name; each is called with n and the keyword seed."""
