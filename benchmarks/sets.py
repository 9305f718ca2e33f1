"""The point sets of the benchmarks: generators of `delone.datasets` at one seed.

A set is named by its generator, with the number of points behind a colon: ``uniform:1000000``.
"""

import numpy as np
from numpy.typing import NDArray

from delone.datasets import GENERATORS

Points = NDArray[np.float64]

SEED = 2026

DEFAULT = (
    "uniform:10000",
    "uniform:100000",
    "uniform:1000000",
    "utm_millimeters:1000000",
    "grid:1000000",
    "circle:100000",
    "kuzmin:1000000",
    "gaussian_clusters:1000000",
    "lines:1000000",
    "sorted:1000000",
    "reversed:1000000",
    "duplicates:1000000",
)


def _lines(n: int, *, seed: int) -> Points:
    """Return points along a hundred horizontal lines."""
    rng = np.random.default_rng(seed)
    return np.column_stack((rng.random(n), rng.integers(0, 100, n) / 100))


def _sorted(n: int, *, seed: int) -> Points:
    """Return uniform points by x, then y."""
    points = GENERATORS["uniform"](n, seed=seed)
    return points[np.lexsort((points[:, 1], points[:, 0]))]


def _reversed(n: int, *, seed: int) -> Points:
    """Return the same from the last to the first."""
    return _sorted(n, seed=seed)[::-1]


ORDERS = {"lines": _lines, "sorted": _sorted, "reversed": _reversed}


def make(name: str) -> Points:
    """Return the set that `name` names, such as ``"kuzmin:1000000"``."""
    generator, _, number = name.partition(":")
    generators = GENERATORS | ORDERS
    if generator not in generators or not number.isdigit():
        known = ", ".join(generators)
        raise SystemExit(f"no point set {name!r}: one of {known}, then a colon and a number")
    return np.ascontiguousarray(generators[generator](int(number), seed=SEED))


def with_number(names: tuple[str, ...], number: int | None) -> tuple[str, ...]:
    """Replace the number of points of each set by `number`; each set is then named once."""
    if number is None:
        return names
    return tuple(dict.fromkeys(f"{name.partition(':')[0]}:{number}" for name in names))
