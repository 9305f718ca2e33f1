"""One and two threads, class by class: how many times faster two are.

Jobs run with one thread and with two in turn, after a first call of each that is not counted. The
arrays are compared: they must be the same. Queries, contours, bands, volumes and overlaps start
from finished triangulations and grids, all other jobs from arrays.
``python benchmarks/workers.py --help`` has options.
"""

import argparse
import itertools
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from report import machine, median, ratio, table

import delone
from delone import graphs, sphere
from delone.cluster import HDBSCAN
from delone.interpolate import Linear, NaturalNeighbor
from delone.terrain import TIN

HEAD = ("job", "input", "one thread", "two threads", "times")


class Job(NamedTuple):
    """A call with some number of workers, which returns arrays."""

    name: str
    rows: int
    run: Callable[[int], Any]


def plane(n: int) -> Iterator[Job]:
    """Points in 2-D and what is made of them."""
    rng = np.random.default_rng(1)
    points, queries = rng.random((n, 2)), rng.random((n, 2))
    values = np.sin(9 * points[:, 0]) * np.cos(7 * points[:, 1])
    weights = rng.random(n) / n
    ring = np.arange(n // 10)
    turn = 2 * np.pi * ring / len(ring)
    star = np.column_stack((np.cos(turn), np.sin(turn))) * (1 + 0.1 * np.sin(40 * turn))[:, None]
    segments = np.column_stack((ring, np.roll(ring, -1)))
    yield Job("Delaunay", n, lambda w: delone.Delaunay(points, workers=w).simplices)
    yield Job(
        "ConstrainedDelaunay",
        n,
        lambda w: (
            delone.ConstrainedDelaunay(
                np.concatenate((star, 4 * points - 2)), segments, workers=w
            ).simplices
        ),
    )
    yield Job(
        "RegularTriangulation",
        n,
        lambda w: delone.RegularTriangulation(points, weights, workers=w).simplices,
    )
    yield Job(
        "PeriodicDelaunay",
        n // 4,
        lambda w: delone.PeriodicDelaunay(points[: n // 4], (1.0, 1.0), workers=w).simplices,
    )
    yield Job("Voronoi, areas", n, lambda w: delone.Voronoi(points, workers=w).cell_areas)
    yield Job("AlphaComplex", n, lambda w: delone.AlphaComplex(points, workers=w).spectrum)
    yield Job("gabriel", n, lambda w: graphs.gabriel(points, workers=w).edges)
    yield Job(
        "minimum_spanning_tree", n, lambda w: graphs.minimum_spanning_tree(points, workers=w).edges
    )
    yield Job("HDBSCAN", n // 4, lambda w: HDBSCAN(workers=w).fit(points[: n // 4]).labels_)
    mesh = delone.Delaunay(points)
    first, second = (Linear(mesh, values, workers=w) for w in (1, 2))
    yield Job("Linear", n, lambda w: (first, second)[w - 1](queries))
    natural = [NaturalNeighbor(mesh, values, workers=w) for w in (1, 2)]
    yield Job("NaturalNeighbor", n // 4, lambda w: natural[w - 1](queries[: n // 4]))
    surfaces = [TIN.from_points(np.column_stack((points, values)), workers=w) for w in (1, 2)]
    levels = np.linspace(-0.95, 0.95, 39)
    yield Job("contours", n, lambda w: surfaces[w - 1].contours(levels).points)
    yield Job("bands", n, lambda w: surfaces[w - 1].bands(levels).points)
    yield Job("volume_to", n, lambda w: np.array(surfaces[w - 1].volume_to(0.0).cut))


def space(n: int) -> Iterator[Job]:
    """Points in 3-D and what is made of them."""
    rng = np.random.default_rng(2)
    points, queries = rng.random((n, 3)), rng.random((n, 3))
    ball = rng.standard_normal((n, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    values = points @ (1.0, 2.0, 3.0)
    yield Job("Delaunay, 3-D", n, lambda w: delone.Delaunay(points, workers=w).simplices)
    yield Job("ConvexHull of a sphere", n, lambda w: delone.ConvexHull(ball, workers=w).simplices)
    yield Job("Voronoi, 3-D, volumes", n // 4, lambda w: _volumes(points[: n // 4], w))
    yield Job(
        "AlphaComplex, 3-D",
        n // 4,
        lambda w: delone.AlphaComplex(points[: n // 4], workers=w).spectrum,
    )
    few = n // 4
    mesh = delone.Delaunay(points[:few])
    linear = [Linear(mesh, values[:few], workers=w) for w in (1, 2)]
    yield Job("Linear, 3-D", n, lambda w: linear[w - 1](queries))
    natural = [NaturalNeighbor(mesh, values[:few], kind="laplace", workers=w) for w in (1, 2)]
    yield Job("NaturalNeighbor, 3-D", n // 20, lambda w: natural[w - 1](queries[: n // 20]))


def globe(n: int) -> Iterator[Job]:
    """Directions and what is made of them."""
    rng = np.random.default_rng(3)
    xyz, queries = rng.standard_normal((n, 3)), rng.standard_normal((n, 3))
    yield Job("sphere.Delaunay", n, lambda w: sphere.Delaunay(xyz=xyz, workers=w).simplices)
    yield Job("sphere.Voronoi, areas", n, lambda w: sphere.Voronoi(xyz=xyz, workers=w).cell_areas)
    meshes = [sphere.Delaunay(xyz=xyz, workers=w) for w in (1, 2)]
    yield Job("sphere, find_simplex", n, lambda w: meshes[w - 1].find_simplex(queries))
    few = n // 20
    one, other = sphere.Voronoi(xyz=xyz[:few]), sphere.Voronoi(xyz=queries[:few])
    cells = [sphere.Grid.from_voronoi(each) for each in (one, other)]
    yield Job("sphere.Overlaps", few, lambda w: sphere.Overlaps(*cells, workers=w).areas)


def _volumes(points: Any, workers: int) -> Any:
    return delone.Voronoi(
        points, clip=np.array([[0.0] * 3, [1.0] * 3]), workers=workers
    ).cell_volumes


def row(job: Job, runs: int) -> list[str]:
    """Measure one job."""
    found = [job.run(workers) for workers in (1, 2)]
    if not np.array_equal(*found, equal_nan=True):
        raise SystemExit(f"{job.name}: two threads give other arrays")
    seconds: list[list[float]] = [[], []]
    for _, workers in itertools.product(range(runs), (1, 2)):
        start = time.perf_counter()
        job.run(workers)
        seconds[workers - 1].append(time.perf_counter() - start)
    one, two = map(median, seconds)
    return [job.name, f"{job.rows:,}", f"{one:.3g} s", f"{two:.3g} s", ratio(one / two)]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, default=1_000_000, help="points of the largest jobs")
    parser.add_argument("--runs", type=int, default=3, help="rounds (default 3)")
    parser.add_argument("--only", default="", help="jobs whose names contain this text")
    given = parser.parse_args()
    print(f"\nOne and two threads. {machine()}.\n")
    jobs = itertools.chain(plane(given.n), space(given.n // 5), globe(given.n))
    rows = []
    for job in jobs:
        if given.only in job.name:
            rows.append(row(job, given.runs))
            print(*rows[-1], sep="\t", flush=True)
    print(table(HEAD, rows))


if __name__ == "__main__":
    main()
