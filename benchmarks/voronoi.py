"""Voronoi diagrams side by side: arrays of whole diagrams, and cells cut to an outline.

    python benchmarks/voronoi.py [--n 1000000] [--cells 100000] [--outline FILE] [--runs 5]

Whole diagrams: points in, arrays out, for delone and SciPy (vertices, ridges, regions as SciPy
gives them); shapely's ``voronoi_polygons`` gives geometries. Cut to an outline: delone's polygons
in the order of the sites, against the usual way, ``voronoi_polygons`` and then ``intersection`` of
each cell; of the latter a sample is timed and scaled, where the whole would take minutes. The
outline is the largest polygon of a file that geopandas reads, by default a star of 60,000 corners.
Figures are medians, in seconds; the peers take turns, run by run.
"""

from __future__ import annotations

import argparse
import statistics
import time
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

import delone

if TYPE_CHECKING:
    from collections.abc import Callable

# Intersections that are timed of the usual way.
SAMPLE = 500
# Peers slower than this, in seconds, run once.
SLOW = 10.0


def star(corners: int = 60_000) -> shapely.Polygon:
    """A ragged outline of many corners, always the same."""
    rng = np.random.default_rng(1)
    angle = np.sort(rng.random(corners)) * 2 * np.pi
    waves = sum(
        rng.random() / k * np.sin(k * angle + 7 * rng.random()) for k in (1, 2, 3, 5, 8, 40)
    )
    radius = 1 + 0.2 * waves + 0.002 * rng.random(corners)
    return shapely.Polygon(np.column_stack((radius * np.cos(angle), radius * np.sin(angle))))


def largest(path: str) -> shapely.Polygon:
    import geopandas

    parts = shapely.get_parts(np.asarray(geopandas.read_file(path).geometry.values))
    return parts[np.argmax(shapely.area(parts))]


def within(outline: shapely.Polygon, n: int) -> Any:
    """Uniform sites inside an outline."""
    rng = np.random.default_rng(2)
    left, bottom, right, top = outline.bounds
    shapely.prepare(outline)
    sites = np.empty((0, 2))
    while len(sites) < n:
        more = rng.random((n, 2)) * [right - left, top - bottom] + [left, bottom]
        sites = np.concatenate((sites, more[shapely.contains_xy(outline, more)]))
    return sites[:n]


def delone_arrays(points: Any, workers: int) -> None:
    diagram = delone.Voronoi(points, workers=workers)
    _ = diagram.vertices, diagram.ridge_points, diagram.ridge_vertices
    _ = diagram.region_vertices, diagram.point_region


def scipy_lists(points: Any) -> None:
    import scipy.spatial

    diagram = scipy.spatial.Voronoi(points)
    _ = diagram.regions, diagram.ridge_vertices


def shapely_polygons(points: Any) -> None:
    shapely.get_parts(shapely.voronoi_polygons(shapely.multipoints(points)))


def delone_clipped(points: Any, outline: shapely.Polygon) -> None:
    delone.Voronoi(points, clip=outline).polygons()


def usual_way(points: Any, outline: shapely.Polygon) -> float:
    """Seconds of ``voronoi_polygons`` and ``intersection``, the latter scaled from a sample."""
    start = time.perf_counter()
    collected = shapely.voronoi_polygons(shapely.multipoints(points), extend_to=outline.envelope)
    cells = shapely.get_parts(collected)
    between = time.perf_counter()
    chosen = np.random.default_rng(3).choice(len(cells), min(SAMPLE, len(cells)), replace=False)
    shapely.intersection(cells[chosen], outline)
    return between - start + (time.perf_counter() - between) * len(cells) / len(chosen)


def seconds(call: Callable[[], object]) -> float:
    start = time.perf_counter()
    found = call()
    return found if isinstance(found, float) else time.perf_counter() - start


def table(title: str, peers: dict[str, Callable[[], object]], runs: int) -> None:
    taken: dict[str, list[float]] = {name: [] for name in peers}
    for run in range(runs):
        for name, call in peers.items():
            if run == 0 or taken[name][0] < SLOW:
                taken[name].append(seconds(call))
    medians = {name: statistics.median(times) for name, times in taken.items()}
    ours = next(iter(medians.values()))
    print(f"\n{title}\n\n| peer | seconds | times delone | runs |\n|---|---|---|---|")
    for name, median in medians.items():
        print(f"| {name} | {median:.3g} | {median / ours:.3g} | {len(taken[name])} |")


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--n", type=int, default=1_000_000)
    options.add_argument("--cells", type=int, default=100_000)
    options.add_argument("--outline")
    options.add_argument("--runs", type=int, default=5)
    given = options.parse_args()
    points = np.random.default_rng(0).random((given.n, 2))
    whole = {
        "delone": lambda: delone_arrays(points, 1),
        "delone, 2 workers": lambda: delone_arrays(points, 2),
        "scipy": lambda: scipy_lists(points),
        "shapely voronoi_polygons": lambda: shapely_polygons(points),
    }
    table(f"{given.n:,} uniform sites, whole diagram", whole, given.runs)
    outline = largest(given.outline) if given.outline else star()
    sites = within(outline, given.cells)
    corners = shapely.get_num_coordinates(outline)
    cut = {
        "delone": lambda: delone_clipped(sites, outline),
        "voronoi_polygons, then intersection (scaled)": lambda: usual_way(sites, outline),
    }
    table(f"{given.cells:,} sites in an outline of {corners:,} corners", cut, given.runs)


if __name__ == "__main__":
    main()
