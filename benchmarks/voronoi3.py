"""3-D diagrams and 3-D interpolation, compared with SciPy.

    python benchmarks/voronoi3.py [--n 100000] [--queries 100000] [--runs 3]

Whole diagrams: points in, arrays out; with the lists that SciPy gives; volumes of all cells, which
users of SciPy take from a convex hull of each cell (of these a sample is timed and scaled); cells
cut to the box, which SciPy does not do. Regular triangulations have no peer here. Interpolation:
construction and queries together, uniform. Figures are medians, in seconds; the peers take turns.
"""

from __future__ import annotations

import argparse
import statistics
import time
from typing import TYPE_CHECKING, Any

import numpy as np

import delone
from delone import interpolate

if TYPE_CHECKING:
    from collections.abc import Callable

# Cells whose hulls are timed of SciPy's way to volumes.
SAMPLE = 2000


def arrays(points: Any, workers: int) -> None:
    diagram = delone.Voronoi(points, workers=workers)
    _ = diagram.vertices, diagram.ridge_points, diagram.region_rows, diagram.point_region


def lists(points: Any, workers: int) -> None:
    diagram = delone.Voronoi(points, workers=workers)
    _ = diagram.regions, diagram.ridge_vertices


def volumes(points: Any, workers: int, clip: str | None = None) -> None:
    _ = delone.Voronoi(points, workers=workers, clip=clip).cell_volumes


def scipy_lists(points: Any) -> None:
    import scipy.spatial

    diagram = scipy.spatial.Voronoi(points)
    _ = diagram.regions, diagram.ridge_vertices


def scipy_volumes(points: Any) -> float:
    """Seconds for the hulls of all bounded cells, from a sample, and for the diagram."""
    import scipy.spatial

    start = time.perf_counter()
    diagram = scipy.spatial.Voronoi(points)
    whole = time.perf_counter() - start
    bounded = [r for r in diagram.regions if r and -1 not in r]
    start = time.perf_counter()
    for region in bounded[:SAMPLE]:
        _ = scipy.spatial.ConvexHull(diagram.vertices[region]).volume
    return whole + (time.perf_counter() - start) * len(bounded) / min(SAMPLE, len(bounded))


def table(title: str, peers: dict[str, Callable[[], float | None]], runs: int) -> None:
    times: dict[str, list[float]] = {name: [] for name in peers}
    for _ in range(runs):
        for name, work in peers.items():
            start = time.perf_counter()
            own = work()
            times[name].append(time.perf_counter() - start if own is None else own)
    print(f"\n{title}\n")
    print("| | seconds |\n|---|---|")
    for name, taken in times.items():
        print(f"| {name} | {statistics.median(taken):.3f} |")


def interpolated(points: Any, values: Any, queries: Any) -> dict[str, Any]:
    import scipy.interpolate

    own = {
        f"delone {method}, {workers} worker{'s' * (workers > 1)}": (
            lambda m=method, w=workers: (
                interpolate.interpolator(points, values, m, workers=w)(queries),
                None,
            )[1]
        )
        for method in ("linear", "nearest", "laplace")
        for workers in (1, 2)
    }
    peers = {
        "scipy LinearNDInterpolator": lambda: (
            scipy.interpolate.LinearNDInterpolator(points, values)(queries),
            None,
        )[1],
        "scipy NearestNDInterpolator": lambda: (
            scipy.interpolate.NearestNDInterpolator(points, values)(queries),
            None,
        )[1],
    }
    return own | peers


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--n", type=int, default=100_000)
    options.add_argument("--queries", type=int, default=100_000)
    options.add_argument("--runs", type=int, default=3)
    given = options.parse_known_args()[0]
    rng = np.random.default_rng(0)
    points = rng.random((given.n, 3))
    weights = rng.random(given.n) * given.n ** (-2 / 3) / 4
    whole = {
        "delone, arrays": lambda: arrays(points, 1),
        "delone, arrays, 2 workers": lambda: arrays(points, 2),
        "delone, lists": lambda: lists(points, 1),
        "scipy, lists": lambda: scipy_lists(points),
        "delone, volumes": lambda: volumes(points, 1),
        "delone, volumes, 2 workers": lambda: volumes(points, 2),
        "delone, volumes in the box": lambda: volumes(points, 1, "box"),
        "delone, volumes in the box, 2 workers": lambda: volumes(points, 2, "box"),
        "scipy, volumes by hulls (scaled)": lambda: scipy_volumes(points),
        "delone, regular triangulation": lambda: (
            delone.RegularTriangulation(points, weights),
            None,
        )[1],
    }
    table(f"{given.n:,} uniform sites in 3-D", whole, given.runs)
    values, queries = rng.random(given.n), rng.random((given.queries, 3))
    title = f"{given.queries:,} queries among {given.n:,} sites in 3-D"
    table(title, interpolated(points, values, queries), given.runs)


if __name__ == "__main__":
    main()
