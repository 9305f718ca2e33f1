"""Location and interpolation side by side with SciPy: ``python benchmarks/interpolate.py``.

One thread for everybody unless a line says more. Sites are uniform in a square, queries as well: in
random order, and in rows as a raster has them. Times are medians; SciPy's slow ones are run once.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.interpolate
import scipy.spatial

from delone import Delaunay
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor

SLOW = 4.0
# SciPy's walk from the last hit takes 0.2 ms a query in random order: fewer will do.
FEW = 20_000


def median(call: Callable[[], Any], runs: int) -> float:
    """Seconds of a call, the median of some runs; of one where it is slow."""
    times: list[float] = []
    for _ in range(runs):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
        if times[-1] > SLOW:
            break
    return statistics.median(times)


def line(what: str, ours: float, theirs: float | None, count: int) -> None:
    """Print a row: seconds, nanoseconds a query, and how many times SciPy's."""
    each = f"{ours / count * 1e9:9.0f} ns"
    other = "" if theirs is None else f"{theirs:9.3f} s {theirs / ours:8.1f} x"
    print(f"{what:52}{ours:9.4f} s {each} {other}", flush=True)


def orders(count: int) -> dict[str, Any]:
    """Queries in random order, and row by row."""
    rng = np.random.default_rng(2)
    side = int(np.sqrt(count))
    nodes = (np.arange(side) + 0.5) / side
    rows = np.stack(np.meshgrid(nodes, nodes), axis=-1).reshape(-1, 2)
    return {"random": rng.random((count, 2)), "rows": rows}


def location(sites: int, count: int, runs: int) -> None:
    """find_simplex, many at once, one at a time, and with two threads."""
    points = np.random.default_rng(1).random((sites, 2))
    mesh, twin = Delaunay(points, workers=1), Delaunay(points, workers=2)
    theirs = scipy.spatial.Delaunay(points)
    for order, queries in orders(count).items():
        few = queries[:FEW] if order == "random" else queries
        scale = len(queries) / len(few)
        ours = median(lambda q=queries: mesh.find_simplex(q), runs)
        other = scale * median(lambda q=few: theirs.find_simplex(q), runs)
        line(f"find_simplex, {sites:,} sites, {order}", ours, other, len(queries))
        two = median(lambda q=queries: twin.find_simplex(q), runs)
        line(f"  two threads ({ours / two:.2f} times one)", two, None, len(queries))
    singles = np.random.default_rng(3).random((2000, 2))
    line(
        "find_simplex, one at a time",
        median(lambda: [mesh.find_simplex(q) for q in singles], runs),
        median(lambda: [theirs.find_simplex(q) for q in singles], runs),
        len(singles),
    )


def fields(sites: int, count: int, runs: int) -> None:
    """From points to values, and the second field."""
    points = np.random.default_rng(1).random((sites, 2))
    values = np.sin(9 * points[:, 0]) * points[:, 1]
    one: dict[str, Any] = {"workers": 1}
    pairs: dict[str, tuple[Any, Any]] = {
        "Linear": (Linear, scipy.interpolate.LinearNDInterpolator),
        "CloughTocher": (CloughTocher, scipy.interpolate.CloughTocher2DInterpolator),
    }
    for order, queries in orders(count).items():
        for name, (ours, theirs) in pairs.items():
            line(
                f"{name}, points to values, {order}",
                median(lambda q=queries, f=ours: f(points, values, **one)(q), runs),
                median(lambda q=queries, f=theirs: f(points, values)(q), runs),
                len(queries),
            )
        made = Linear(points, values, **one)
        table = made.weights(queries)
        again = median(lambda t=table: t @ values, runs)
        line(f"Linear, another field by weights, {order}", again, None, len(queries))
        for kind in ("sibson", "laplace", "farin", "sibson1"):
            natural = NaturalNeighbor(points, values, kind=kind, **one)
            natural(queries[:1])
            seconds = median(lambda q=queries, n=natural: n(q), runs)
            line(f"NaturalNeighbor {kind}, {order}", seconds, None, len(queries))


def main() -> None:
    """Print all lines."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sites", type=int, default=100_000)
    parser.add_argument("--queries", type=int, default=1_000_000)
    parser.add_argument("--runs", type=int, default=5)
    given = parser.parse_args()
    print(f"{'':52}{'delone':>11} {'a query':>12} {'SciPy':>11} {'times':>10}")
    location(10 * given.sites, given.queries, given.runs)
    fields(given.sites, given.queries, given.runs)


if __name__ == "__main__":
    main()
