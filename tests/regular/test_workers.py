"""Regular triangulations of large sets, in blocks: the same arrays for each number of workers."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from typing import Any

import numpy as np
import pytest

from delone import Delaunay, Voronoi
from delone.regular import RegularTriangulation

# More points than one block has, and few enough to be proven.
PLANE, SPACE = 40_000, 66_000


def scattered(n: int, dimension: int) -> Any:
    return np.random.default_rng(dimension).random((n, dimension))


def weighted(n: int, heaviest: float) -> Any:
    return heaviest * np.random.default_rng(9).random(n)


@pytest.mark.parametrize(
    ("points", "heaviest"),
    [
        (scattered(PLANE, 2), 0.0),
        (scattered(PLANE, 2), 1e-5),
        (scattered(PLANE, 2), 3e-4),
        (scattered(PLANE, 2), 1.0),
        (np.stack(np.meshgrid(np.arange(200.0), np.arange(200.0)), -1).reshape(-1, 2), 0.0),
        (scattered(PLANE, 2) * (1, 1e-9), 1e-22),
        (scattered(PLANE, 2) * 2.0**500, 0.0),
        (np.round(scattered(PLANE, 2), 2), 1e-5),
        (scattered(SPACE, 3), 1e-4),
    ],
    ids=[
        *("equal", "light", "heavy", "hidden", "grid", "thin", "far", "duplicates", "space"),
    ],
)
@pytest.mark.sampled(3)
def test_the_arrays_do_not_depend_on_workers(points: Any, heaviest: float) -> None:
    weights = weighted(len(points), heaviest)
    one = RegularTriangulation(points, weights, workers=1)
    for workers in (2, 3, 16):
        mesh = RegularTriangulation(points, weights, workers=workers)
        for name in ("simplices", "neighbors", "duplicate_of", "hidden"):
            assert np.array_equal(getattr(mesh, name), getattr(one, name))
    report = one.validate()
    assert report, str(report)


@pytest.mark.parametrize("n", [PLANE, 100_000])
def test_equal_weights_are_the_delaunay_triangulation(n: int) -> None:
    points = scattered(n, 2)
    mesh = RegularTriangulation(points, np.full(n, 7.25))
    assert rows(mesh.simplices) == rows(Delaunay(points).simplices)


def test_permuted_points_have_the_same_triangles() -> None:
    points, weights = scattered(PLANE, 2), weighted(PLANE, 2e-4)
    order = np.random.default_rng(1).permutation(PLANE)
    mesh = RegularTriangulation(points, weights)
    other = RegularTriangulation(points[order], weights[order])
    assert rows(order[other.simplices]) == rows(mesh.simplices)


def test_power_diagrams_do_not_depend_on_workers() -> None:
    points, weights = scattered(PLANE, 2), weighted(PLANE, 2e-4)
    one, three = (Voronoi(points, weights=weights, workers=k) for k in (1, 3))
    for name in ("vertices", "ridge_points", "point_region"):
        assert np.array_equal(getattr(one, name), getattr(three, name))


def rows(simplices: Any) -> list[list[int]]:
    found = np.sort(simplices, axis=1)
    return found[np.lexsort(found.T)].tolist()


@pytest.mark.skipif(sys.platform != "linux", reason="RLIMIT_AS is kept on Linux alone")
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.sampled(1)
def test_refused_memory_is_an_error(dimension: int) -> None:
    code = f"""
        import resource
        import numpy as np
        from delone import RegularTriangulation
        points = np.random.default_rng(0).random(({400_000 // dimension**2}, {dimension}))
        weights = np.random.default_rng(1).random(len(points)) * 1e-7
        page = resource.getpagesize()
        refused = 0
        for megabytes in range(1, 1000, 3 if {dimension} == 2 else 9):
            size = int(open("/proc/self/statm").read().split()[0]) * page
            hard = resource.getrlimit(resource.RLIMIT_AS)[1]
            resource.setrlimit(resource.RLIMIT_AS, (size + megabytes * 2**20, hard))
            try:
                made = RegularTriangulation(points, weights, workers=2)
                break
            except MemoryError:
                refused += 1
            finally:
                resource.setrlimit(resource.RLIMIT_AS, (hard, hard))
        # Built last: memory that it frees could serve the builds that must be refused.
        expected = RegularTriangulation(points, weights, workers=2)
        print(refused > 0, np.array_equal(made.simplices, expected.simplices))
    """
    ran = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr[-2000:]
    assert ran.stdout.split() == ["True", "True"]
