"""Alpha complexes side by side with GUDHI, and concave hulls with shapely; in turns.

GUDHI and shapely have one thread; delone works on one and on all. Columns are seconds of the first
run and the least of all runs. ``python benchmarks/alpha.py --help`` has options.
"""

import argparse
import importlib.util
import time
from collections.abc import Callable
from typing import Any

import shapely

from delone import AlphaComplex, concave_hull, datasets

# By name, the calls that take turns.
Calls = dict[str, Callable[[], Any]]


def turns(calls: Calls, runs: int) -> dict[str, list[float]]:
    """Seconds of all calls, run after run."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(runs):
        for name, call in calls.items():
            start = time.perf_counter()
            call()
            times[name].append(time.perf_counter() - start)
    return times


def table(title: str, calls: Calls, runs: int) -> None:
    """Print the first and the least seconds of each call, and its share of the last one."""
    times = turns(calls, runs)
    print(title)
    least = min(list(times.values())[-1])
    for name, found in times.items():
        print(f"  {name:24} {found[0]:9.3f} {min(found):9.3f} {min(found) / least:8.3f}")


def complexes(n: int, runs: int) -> None:
    """All simplices with their values, in 2-D and 3-D; with GUDHI if it is installed."""
    for ndim in (2, 3):
        points = datasets.uniform(n, ndim=ndim)
        calls: Calls = {
            "delone, all cores": lambda points=points: AlphaComplex(points),
            "delone, one thread": lambda points=points: AlphaComplex(points, workers=1),
        }
        if importlib.util.find_spec("gudhi"):
            import gudhi

            calls["GUDHI, safe"] = lambda points=points: gudhi.AlphaComplex(
                points=points, precision="safe"
            ).create_simplex_tree()
        table(f"alpha complex, {ndim}-D, {n:,} points", calls, runs)


def hulls(n: int, runs: int) -> None:
    """One polygon around points."""
    points = datasets.uniform(n)
    given = shapely.multipoints(points)
    calls: Calls = {
        "delone": lambda: concave_hull(points, ratio=0.05).polygon(),
        "shapely": lambda: shapely.concave_hull(given, ratio=0.05),
    }
    table(f"concave hull, {n:,} points, ratio 0.05", calls, runs)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--n", type=int, default=100_000, help="points")
    parser.add_argument("--runs", type=int, default=5, help="of each call")
    options = parser.parse_args()
    print(f"{'':26} {'first s':>9} {'least s':>9} {'share':>8}")
    complexes(options.n, options.runs)
    hulls(options.n, options.runs)


if __name__ == "__main__":
    main()
