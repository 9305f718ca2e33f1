"""Clusters side by side with fast_hdbscan, hdbscan, scikit-learn and SciPy, if they are installed.

Points are uniform in a square, or in groups with some noise. Packages take turns, run by run, so
that other load on the machine affects all of them; the first run of each, in which fast_hdbscan
compiles itself, is a column of its own. ``python benchmarks/cluster.py --help`` has options.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from report import machine, ratio, seconds, table

from delone.cluster import DBSCAN, HDBSCAN, single_linkage

HEAD = ("", "peer", "first", "median", "times delone", "clusters")


def sets(n: int) -> dict[str, Any]:
    """Uniform points, and fifty groups with a tenth of noise."""
    random = np.random.default_rng(0)
    centers = random.random((50, 2))
    groups = [random.normal(center, 0.01, (n * 9 // 500, 2)) for center in centers]
    noise = random.random((n - sum(map(len, groups)), 2))
    return {"uniform": random.random((n, 2)), "groups": np.concatenate((*groups, noise))}


def hdbscans(size: int, samples: int) -> dict[str, Callable[[Any], Any]]:
    """HDBSCAN of every package; two of them do not count the point itself."""
    found: dict[str, Callable[[Any], Any]] = {}
    for workers in (1, 2):
        model = HDBSCAN(size, min_samples=samples, workers=workers)
        found[f"delone, {workers} workers"] = model.fit_predict
    try:
        import fast_hdbscan

        fast = fast_hdbscan.HDBSCAN(min_cluster_size=size, min_samples=samples - 1)
        found["fast_hdbscan"] = fast.fit_predict
    except ImportError:
        print("fast_hdbscan is not installed")
    try:
        import hdbscan

        slow = hdbscan.HDBSCAN(min_cluster_size=size, min_samples=samples - 1)
        found["hdbscan"] = slow.fit_predict
    except ImportError:
        print("hdbscan is not installed")
    return found


def dbscans(eps: float, samples: int) -> dict[str, Callable[[Any], Any]]:
    """DBSCAN of delone and scikit-learn."""
    import sklearn.cluster

    found: dict[str, Callable[[Any], Any]] = {}
    for workers in (1, 2):
        model = DBSCAN(eps, min_samples=samples, workers=workers)
        found[f"delone, {workers} workers"] = model.fit_predict
    found["scikit-learn"] = sklearn.cluster.DBSCAN(eps=eps, min_samples=samples).fit_predict
    return found


def compare(what: str, calls: dict[str, Callable[[Any], Any]], points: Any, runs: int) -> None:
    """Print the times of all packages."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    clusters = {}
    for _ in range(runs + 1):
        for name, call in calls.items():
            start = time.perf_counter()
            labels = call(points)
            times[name].append(time.perf_counter() - start)
            clusters[name] = int(labels.max()) + 1
    medians = {name: statistics.median(found[1:]) for name, found in times.items()}
    ours = next(iter(medians.values()))
    rows = [
        (
            what,
            name,
            seconds(times[name][0]),
            seconds(median),
            ratio(median / ours),
            f"{clusters[name]:,}",
        )
        for name, median in medians.items()
    ]
    print(table(HEAD, rows), end="\n\n", flush=True)


def linkages(n: int) -> None:
    """Print the time of single linkage of uniform points."""
    points = np.random.default_rng(1).random((n, 2))
    for workers in (1, 2):
        start = time.perf_counter()
        found = single_linkage(points, workers=workers)
        merges = len(found.linkage)
        taken = time.perf_counter() - start
        print(
            f"single linkage of {n:,} points, {workers} workers: {taken:.2f} s, {merges:,} merges"
        )


def main() -> None:
    """Measure what the arguments say."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--n", type=int, default=100_000, help="number of points")
    parser.add_argument("--runs", type=int, default=5, help="runs after the first one")
    parser.add_argument("--linkage", type=int, default=1_000_000, help="points of single linkage")
    options = parser.parse_args()
    print(machine(), end="\n\n")
    for name, points in sets(options.n).items():
        for size in (5, 50):
            what = f"HDBSCAN({size}, min_samples=5), {name}"
            compare(what, hdbscans(size, 5), points, options.runs)
        compare(f"DBSCAN(0.005), {name}", dbscans(0.005, 5), points, options.runs)
    linkages(options.linkage)


if __name__ == "__main__":
    main()
