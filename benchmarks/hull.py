"""Convex hulls, and location in space, side by side with SciPy.

One thread for SciPy, which has no more; delone's hull works on one, its location on one and on all.
Medians of some runs. ``python benchmarks/hull.py --help`` has options.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.spatial

from delone import ConvexHull, Delaunay, datasets

# A call that takes longer is not repeated, and short ones until they have taken so long together.
SLOW = 5.0
ENOUGH = 0.1


def median(call: Callable[[], Any], runs: int) -> float:
    """Seconds of a call, the median of some runs; of one where it is slow."""
    times: list[float] = []
    while len(times) < runs or sum(times) < ENOUGH:
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
        if times[-1] > SLOW:
            break
    return statistics.median(times)


def line(name: str, ours: float, theirs: float) -> None:
    """Print one row of a table."""
    print(f"{name:38} {ours:10.5f} {theirs:10.5f} {theirs / ours:12.2f}")


def hulls(n: int, runs: int) -> None:
    """Points inside, all on the hull, in the plane and in space; few and many."""
    space = datasets.GENERATORS3
    flat = {"uniform square": datasets.uniform(n), "circle": datasets.circle(n // 10)}
    sets = {f"hull, {name}, {len(points):,}": points for name, points in flat.items()}
    sizes = sorted({size for size in (2_000, 20_000, n // 10, n) if size <= n})
    for name, some in {"cube": space["uniform"], "ball": ball, "sphere": space["sphere"]}.items():
        sets |= {f"hull, {name}, {size:,}": some(size) for size in sizes}
    sets[f"hull, grid, {n:,}"] = space["grid"](n)
    for name, points in sets.items():
        ours = median(lambda points=points: ConvexHull(points), runs)
        theirs = median(lambda points=points: scipy.spatial.ConvexHull(points), runs)
        line(name, ours, theirs)


def ball(n: int) -> Any:
    """Uniform points in a ball: the more of them, the more are on the hull."""
    rng = np.random.default_rng(0)
    ways = rng.normal(size=(n, 3))
    return ways * (rng.random(n) ** (1 / 3) / np.linalg.norm(ways, axis=1))[:, None]


def location(n: int, runs: int) -> None:
    """Queries in random order; SciPy is asked for a tenth of them, on its own triangulation.

    The nearest vertex is asked of SciPy's k-d tree, of as many queries.
    """
    points, queries = datasets.uniform(n // 10, ndim=3), datasets.uniform(n, ndim=3, seed=1)
    few = queries[: n // 10]
    peer, sites = scipy.spatial.Delaunay(points), scipy.spatial.KDTree(points)
    theirs = 10 * median(lambda: peer.find_simplex(few), runs)
    for name, workers in (("one thread", 1), ("all cores", None)):
        mesh = Delaunay(points, workers=workers)
        mesh.find_simplex(few[:1])  # makes the index
        ours = median(lambda mesh=mesh: mesh.find_simplex(queries), runs)
        line(f"find_simplex, {name}, {n:,} queries", ours, theirs)
        mesh.nearest(few[:1])
        ours = median(lambda mesh=mesh: mesh.nearest(queries), runs)
        threads = -1 if workers is None else workers
        tree = median(lambda threads=threads: sites.query(queries, workers=threads), runs)
        line(f"nearest, {name}, {n:,} queries", ours, tree)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--n", type=int, default=1_000_000, help="points")
    parser.add_argument("--runs", type=int, default=3, help="of each call")
    options = parser.parse_args()
    print(f"{'':38} {'delone s':>10} {'SciPy s':>10} {'times delone':>12}")
    hulls(options.n, options.runs)
    location(options.n, options.runs)


if __name__ == "__main__":
    main()
