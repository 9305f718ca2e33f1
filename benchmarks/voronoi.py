"""Voronoi diagrams side by side: arrays of whole diagrams, and cells cut to an outline.

    python benchmarks/voronoi.py [--n 1000000] [--cells 100000] [--outline FILE] [--runs 5]

Whole diagrams: points in, arrays out, for delone, SciPy (vertices, ridges, regions as SciPy gives
them) and, where its headers are installed, CGAL, in a process of its own, with its Voronoi adaptor
and straight from its triangulation;
shapely's ``voronoi_polygons`` gives geometries. Cut to an outline: delone's polygons
in the order of the sites, against the usual way, ``voronoi_polygons`` and then ``intersection`` of
each cell; of the latter a sample is timed and scaled, where the whole would take minutes. The
outline is the largest polygon of a file of polygons, such as the land of Natural Earth (of which
that is Afro-Eurasia), by default a star of 60,000 corners.
Figures are medians, in seconds; the peers take turns, run by run.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import crates
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

    # GDAL reads compressed files by another name.
    frame = geopandas.read_file(f"/vsigzip/{path}" if path.endswith(".gz") else path)
    parts = shapely.get_parts(np.asarray(frame.geometry.values))
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
    _ = diagram.vertices, diagram.ridge_points, diagram.ridge_rows
    _ = diagram.region_rows, diagram.point_region


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


def cgal(points: Any, runs: int) -> dict[str, list[float]]:
    """Seconds of each run of CGAL's two ways; none where CGAL is not installed."""
    program = crates.build_cgal("cgal_voronoi")
    if program is None:
        return {}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "points"
        points.astype("<f8").tofile(file)
        command = [str(program), str(runs), str(file)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    return crates.runs_of(done.stdout)


def table(
    title: str, peers: dict[str, Callable[[], object]], runs: int, apart: dict[str, list[float]]
) -> None:
    taken: dict[str, list[float]] = {name: [] for name in peers}
    for run in range(runs):
        for name, call in peers.items():
            if run == 0 or taken[name][0] < SLOW:
                taken[name].append(seconds(call))
    taken |= apart
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
    given = options.parse_known_args()[0]
    points = np.random.default_rng(0).random((given.n, 2))
    whole = {
        "delone": lambda: delone_arrays(points, 1),
        "delone, 2 workers": lambda: delone_arrays(points, 2),
        "scipy": lambda: scipy_lists(points),
        "shapely voronoi_polygons": lambda: shapely_polygons(points),
    }
    apart = cgal(points, given.runs)
    table(f"{given.n:,} uniform sites, whole diagram", whole, given.runs, apart)
    outline = largest(given.outline) if given.outline else star()
    sites = within(outline, given.cells)
    corners = shapely.get_num_coordinates(outline)
    cut = {
        "delone": lambda: delone_clipped(sites, outline),
        "voronoi_polygons, then intersection (scaled)": lambda: usual_way(sites, outline),
    }
    table(f"{given.cells:,} sites in an outline of {corners:,} corners", cut, given.runs, {})


if __name__ == "__main__":
    main()
