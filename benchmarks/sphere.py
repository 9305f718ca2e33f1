"""Triangulations of directions compared with stripy, SciPy and delone's own in the plane; in turns.

The directions are uniform on the sphere, and points as many are uniform in a square. Beside stripy
both take longitudes and latitudes in radians; otherwise delone takes vectors. stripy and SciPy are
left out where they are not installed. stripy is asked for a part of the queries, and its seconds
are for all of them at that rate. Memory is what one call needs beyond what the process held, each
in a process of its own. ``python benchmarks/sphere.py --help`` has options.
"""

import argparse
import importlib.util
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import memory
import numpy as np

import delone
from delone import sphere

# By name, the calls that take turns.
Calls = dict[str, Callable[[], Any]]

# Queries that stripy is asked for.
FEW = 20_000


def directions(count: int, seed: int = 1) -> Any:
    """Unit vectors, uniform on the sphere."""
    vectors = np.random.default_rng(seed).normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def angles(vectors: Any) -> Any:
    """Longitudes and latitudes in radians."""
    x, y, z = vectors.T
    return np.column_stack((np.arctan2(y, x), np.arcsin(z)))


def turns(calls: Calls, runs: int) -> dict[str, list[float]]:
    """Seconds of all calls, run after run."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(runs):
        for name, call in calls.items():
            start = time.perf_counter()
            call()
            times[name].append(time.perf_counter() - start)
    return times


def table(title: str, calls: Calls, runs: int, shares: dict[str, float] | None = None) -> None:
    """Print the median and the least seconds of calls, and ratios to the first; of equal work."""
    for call in calls.values():
        call()
    times = turns(calls, runs)
    print(f"\n{title}\n")
    print("| | median s | least s | times the first, median | least |")
    print("|---|---|---|---|---|")
    work = {name: (shares or {}).get(name, 1.0) for name in calls}
    middle = {name: statistics.median(found) / work[name] for name, found in times.items()}
    least = {name: min(found) / work[name] for name, found in times.items()}
    first = next(iter(calls))
    for name in calls:
        ratios = f"{middle[name] / middle[first]:.3g} | {least[name] / least[first]:.3g}"
        print(f"| {name} | {middle[name]:.3g} | {least[name]:.3g} | {ratios} |", flush=True)


def beside_stripy(n: int, runs: int) -> None:
    """Build, and linear interpolation at random directions."""
    lonlat, targets = angles(directions(n)), angles(directions(n, seed=2))
    values = np.sin(3 * lonlat[:, 1]) * np.cos(lonlat[:, 0])
    mesh = sphere.Delaunay(lonlat=lonlat, degrees=False, workers=1)
    linear = sphere.Linear(mesh, values)
    built: Calls = {
        "delone": lambda: sphere.Delaunay(lonlat=lonlat, degrees=False, workers=1),
        "delone, two workers": lambda: sphere.Delaunay(lonlat=lonlat, degrees=False, workers=2),
    }
    asked: Calls = {"delone": lambda: linear(targets)}
    if importlib.util.find_spec("stripy"):
        import stripy

        lon, lat = np.ascontiguousarray(lonlat.T)
        theirs = stripy.sTriangulation(lon, lat)
        few = np.ascontiguousarray(targets[:FEW].T)
        difference = np.abs(theirs.interpolate_linear(*few, values)[0] - linear(targets[:FEW]))
        built["stripy"] = lambda: stripy.sTriangulation(lon, lat)
        asked["stripy"] = lambda: theirs.interpolate_linear(*few, values)
        print(f"\nlinear interpolation differs from stripy's by {difference.max():.1g} at most")
    table(f"build, {n:,} directions", built, runs)
    table(f"linear, {n:,} queries", asked, runs, {"stripy": min(FEW, n) / n})


def everything(made: Any) -> Any:
    """The vertices, the regions as sorted lists, and the areas of a `SphericalVoronoi`."""
    made.sort_vertices_of_regions()
    return made.vertices, made.regions, made.calculate_areas()


def beside_scipy(n: int, runs: int) -> None:
    """Voronoi diagrams: all that `SphericalVoronoi` has, and what is computed first."""
    from delone.compat import scipy as ours

    vectors = directions(n)
    whole: Calls = {"delone": lambda: everything(ours.SphericalVoronoi(vectors))}
    first: Calls = {"delone": lambda: ours.SphericalVoronoi(vectors).vertices}
    if importlib.util.find_spec("scipy"):
        from scipy.spatial import SphericalVoronoi

        theirs = everything(SphericalVoronoi(vectors))[2]
        difference = np.abs(theirs - everything(ours.SphericalVoronoi(vectors))[2])
        whole["SciPy"] = lambda: everything(SphericalVoronoi(vectors))
        first["SciPy"] = lambda: SphericalVoronoi(vectors).vertices
        print(f"\nareas differ from SciPy's by {difference.max():.1g} at most")
    table(f"SphericalVoronoi, sorted, with areas, {n:,} directions", whole, runs)
    table(f"SphericalVoronoi without them, {n:,} directions", first, runs)


def beside_the_plane(n: int, runs: int) -> None:
    """The same number of directions and of points, with one worker and with two."""
    vectors, points = directions(n), np.random.default_rng(1).random((n, 2))
    calls: Calls = {
        "plane": lambda: delone.Delaunay(points, workers=1),
        "sphere": lambda: sphere.Delaunay(xyz=vectors, workers=1),
        "plane, two workers": lambda: delone.Delaunay(points, workers=2),
        "sphere, two workers": lambda: sphere.Delaunay(xyz=vectors, workers=2),
    }
    table(f"build, {n:,}", calls, runs)


def held(n: int) -> None:
    """Print the bytes that one triangulation needs at its peak."""
    vectors = directions(n)
    start = memory.start()
    mesh = sphere.Delaunay(xyz=vectors, workers=1)
    print(memory.peak() - start, mesh.nsimplex)


def peaks(n: int) -> None:
    """Print the memory for numbers of directions, each in a process of its own."""
    print("\n| directions | peak MB | bytes each |\n|---|---|---|")
    for count in (n // 8, n // 4, n // 2, n):
        command = [sys.executable, str(Path(__file__)), "--held", str(count)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        size = int(done.stdout.split()[0])
        print(f"| {count:,} | {size / 1e6:.0f} | {size / count:.0f} |", flush=True)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, default=100_000, help="directions beside stripy")
    parser.add_argument("--many", type=int, default=1_000_000, help="beside the plane")
    parser.add_argument("--runs", type=int, default=9, help="of each call")
    parser.add_argument("--held", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.held:
        held(options.held)
        return
    beside_stripy(options.n, options.runs)
    beside_scipy(options.n, options.runs)
    beside_the_plane(options.many, options.runs)
    peaks(options.many)


if __name__ == "__main__":
    main()
