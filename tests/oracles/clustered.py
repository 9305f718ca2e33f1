"""Point sets for tests of clusters: ties, duplicates, far exponents, and few points."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["LARGE", "SMALL", "partition"]

RANDOM = np.random.default_rng(8)


def grid(*sizes: int) -> Floats:
    return np.array(list(product(*map(range, sizes))), dtype=float)


def circle(n: int) -> Floats:
    """Points of one circle with integer coordinates, and its center."""
    found = [(x, y) for x in range(-n, n + 1) for y in range(-n, n + 1) if x * x + y * y == n * n]
    return np.array([*found, (0, 0)], dtype=float)


def blobs(d: int, count: int) -> Floats:
    """Three groups of points, the first of them dense."""
    return np.concatenate([RANDOM.normal(4 * i, 0.2 + 0.3 * i, (count, d)) for i in range(3)])


# For oracles that test all pairs.
SMALL: dict[str, Floats] = {
    "two": np.array([[3.0, 4.0], [0.0, 0.0]]),
    "coincident": np.ones((7, 2)),
    "two places": np.repeat([[3.0, 4.0], [0.0, 0.0]], 5, axis=0),
    "line": np.array([(3 * x, 2 * x) for x in (5, 0, 1, 9, 2, 3, 3, 10, 20, 21, 22)], dtype=float),
    "grid": grid(5, 5),
    "grids": np.concatenate((grid(3, 4), np.add(grid(4, 3), (9, 1)), grid(2, 2) * 2 + [3, 30])),
    "circle": circle(25),
    "circles": np.concatenate((circle(5), np.add(circle(5), (30, 1)), circle(5) / 4 + [1, 40])),
    "blobs": blobs(2, 11),
    "rounded": blobs(2, 11).round(),
    "small integers": RANDOM.integers(0, 6, (34, 2)).astype(float),
    "mixed exponents": np.ldexp(RANDOM.random((24, 2)) - 0.5, RANDOM.integers(-60, 60, (24, 2))),
    "wild exponents": np.ldexp(RANDOM.random((14, 2)) - 0.5, RANDOM.integers(-500, 500, (14, 2))),
    "subnormal": RANDOM.integers(0, 9, (16, 2)) * 2.0**-1040,
    "huge": RANDOM.integers(-4, 5, (16, 2)) * 2.0**1015,
    "almost a grid": grid(4, 5) + RANDOM.integers(-1, 2, (20, 2)) * 2.0**-50,
    "cubes": np.concatenate((grid(2, 3, 2), np.add(grid(3, 2, 2), (8, 0, 1)))),
    "blobs in 3-D": blobs(3, 10),
    "rounded in 3-D": blobs(3, 10).round(),
    "plane in 3-D": np.array([(x, y, 2 * x - y) for x, y in grid(4, 5)], dtype=float),
}
LARGE: dict[str, Floats] = {
    "uniform": RANDOM.random((20_000, 2)),
    "rounded": RANDOM.random((5000, 2)).round(2),
    "lattice": grid(50, 60),
    "blobs": blobs(2, 2000),
    "blobs in 3-D": blobs(3, 1500),
    "cells": grid(12, 11, 13),
}


def partition(labels: NDArray[np.int32]) -> set[frozenset[int]]:
    """The clusters as sets of rows; numbers must follow first rows."""
    assert labels.dtype == np.int32
    first = [int(np.flatnonzero(labels == label)[0]) for label in range(labels.max(initial=-1) + 1)]
    assert first == sorted(first)
    return {frozenset(np.flatnonzero(labels == k).tolist()) for k in range(len(first))}
