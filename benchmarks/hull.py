"""Convex hulls, intersections of half-spaces, and 3-D point location, side by side with SciPy.

SciPy uses one thread, as do delone's hulls; delone's point location uses one thread, and then all.
Medians of warm calls, which take turns. ``python benchmarks/hull.py --help`` has options.
"""

import argparse
from typing import Any

import numpy as np
import scipy.spatial
from rounds import alternate

from delone import ConvexHull, Delaunay, datasets
from delone.compat.scipy import HalfspaceIntersection


def line(name: str, ours: float, theirs: float) -> None:
    """Print one row of a table."""
    print(f"{name:38} {ours:10.5f} {theirs:10.5f} {theirs / ours:12.2f}")


def hulls(n: int, runs: int) -> None:
    """Points inside, all on the hull, in 2-D and in 3-D; few and many."""
    space = datasets.GENERATORS3
    flat = {"uniform square": datasets.uniform(n), "circle": datasets.circle(n // 10)}
    sets = {f"hull, {name}, {len(points):,}": points for name, points in flat.items()}
    sizes = sorted({size for size in (2_000, 20_000, n // 10, n) if size <= n})
    for name, some in {"cube": space["uniform"], "ball": ball, "sphere": space["sphere"]}.items():
        sets |= {f"hull, {name}, {size:,}": some(size) for size in sizes}
    sets[f"hull, grid, {n:,}"] = space["grid"](n)
    for name, points in sets.items():
        calls = {
            "delone": lambda points=points: ConvexHull(points),
            "SciPy": lambda points=points: scipy.spatial.ConvexHull(points),
        }
        line(name, *alternate(calls, runs).values())


def ball(n: int) -> Any:
    """Uniform points in a ball: the more of them, the more are on the hull."""
    rng = np.random.default_rng(0)
    ways = rng.normal(size=(n, 3))
    return ways * (rng.random(n) ** (1 / 3) / np.linalg.norm(ways, axis=1))[:, None]


def halfspaces(runs: int) -> None:
    """Half-spaces around a ball: all touch it, or most are redundant; corners and dual facets."""
    sizes = [(d, n) for d in (2, 3) for n in (100, 1_000, 10_000)] + [(4, 500), (5, 200), (6, 100)]
    for name, far in (("tangent", 1.0), ("redundant", 2.0)):
        for d, n in sizes:
            rng = np.random.default_rng(n + d)
            normals = rng.normal(size=(n, d))
            normals /= np.linalg.norm(normals, axis=1)[:, None]
            rows = np.column_stack((normals, -rng.uniform(1.0, far, n)))
            point = rng.uniform(-0.2, 0.2, d)
            kinds = {"delone": HalfspaceIntersection, "SciPy": scipy.spatial.HalfspaceIntersection}
            # The lists of facets are part of the work.
            calls = {
                label: lambda kind=kind, rows=rows, point=point: kind(rows, point).dual_facets
                for label, kind in kinds.items()
            }
            line(f"half-spaces, {name}, {d}-D, {n:,}", *alternate(calls, runs).values())


def location(n: int, runs: int) -> None:
    """Queries in random order; SciPy is asked for a tenth of them, on its own triangulation.

    The nearest vertex is asked of SciPy's k-d tree, of as many queries.
    """
    points, queries = datasets.uniform(n // 10, ndim=3), datasets.uniform(n, ndim=3, seed=1)
    few = queries[: n // 10]
    peer, sites = scipy.spatial.Delaunay(points), scipy.spatial.KDTree(points)
    for name, workers in (("one thread", 1), ("all cores", None)):
        mesh = Delaunay(points, workers=workers)
        simplices = {
            "delone": lambda mesh=mesh: mesh.find_simplex(queries),
            "SciPy": lambda: peer.find_simplex(few),
        }
        ours, theirs = alternate(simplices, runs).values()
        line(f"find_simplex, {name}, {n:,} queries", ours, 10 * theirs)
        threads = -1 if workers is None else workers
        nearest = {
            "delone": lambda mesh=mesh: mesh.nearest(queries),
            "SciPy": lambda threads=threads: sites.query(queries, workers=threads),
        }
        line(f"nearest, {name}, {n:,} queries", *alternate(nearest, runs).values())


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--n", type=int, default=1_000_000, help="points")
    parser.add_argument("--runs", type=int, default=3, help="warm calls of each")
    options = parser.parse_known_args()[0]
    print(f"{'':38} {'delone s':>10} {'SciPy s':>10} {'times delone':>12}")
    halfspaces(options.runs)
    hulls(options.n, options.runs)
    location(options.n, options.runs)


if __name__ == "__main__":
    main()
