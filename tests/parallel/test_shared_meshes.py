"""Eight threads share one mesh: each gets what one thread alone gets.

Under the free-threaded build they run at the same time in Python, too; `sys._is_gil_enabled` is
asked so that a module that turns the lock on again is noticed. With the lock, calls of the core
still run side by side, because the core releases it.
"""

from __future__ import annotations

import sys
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import (
    ConstrainedDelaunay,
    Delaunay,
    PeriodicDelaunay,
    RegularTriangulation,
    Voronoi,
)
from delone.interpolate import Linear, NaturalNeighbor

if TYPE_CHECKING:
    from collections.abc import Callable

THREADS = 8
FREE_THREADED = bool(sysconfig.get_config_var("Py_GIL_DISABLED"))

PLANE = np.random.default_rng(0).random((3_000, 2))
SPACE = np.random.default_rng(1).random((800, 3))
SEGMENTS = np.array([(0, 1), (2, 3), (4, 5)])
QUERIES = np.random.default_rng(2).uniform(-0.1, 1.1, (500, 2))
BODIES = np.random.default_rng(3).uniform(-0.1, 1.1, (300, 3))


def of_a_triangulation(mesh: Any) -> list[Any]:
    """What is computed at the first use and kept: topology, measures and the index of queries."""
    neighbors = mesh.vertex_neighbor_vertices
    found = [mesh.edges, mesh.hull, mesh.vertex_to_simplex, *neighbors, mesh.circumcenters]
    queries = QUERIES if mesh.ndim == 2 else BODIES
    return [*found, mesh.find_simplex(queries), mesh.nearest(queries)]


def of_cells(found: Any) -> list[Any]:
    return [found.vertices, found.ridge_points, found.cell_areas, found.point_region]


def of_a_torus(mesh: Any) -> list[Any]:
    return [mesh.edges, mesh.neighbors, mesh.offsets]


# What is shared, and what each thread asks of it.
SHARED: dict[str, tuple[Callable[[], Any], Callable[[Any], list[Any]]]] = {
    "2-D": (lambda: Delaunay(PLANE), of_a_triangulation),
    "3-D": (lambda: Delaunay(SPACE), of_a_triangulation),
    "constrained": (
        lambda: ConstrainedDelaunay(PLANE, SEGMENTS, crossing="split"),
        of_a_triangulation,
    ),
    "regular": (
        lambda: RegularTriangulation(PLANE, np.zeros(len(PLANE))),
        lambda mesh: [mesh.edges, mesh.hull, mesh.find_simplex(QUERIES)],
    ),
    "periodic": (lambda: PeriodicDelaunay(PLANE, (1.0, 1.0)), of_a_torus),
    "Voronoi": (lambda: Voronoi(PLANE), of_cells),
    "linear": (lambda: Linear(PLANE, PLANE[:, 0]), lambda field: [field(QUERIES)]),
    "natural": (
        lambda: NaturalNeighbor(PLANE, PLANE[:, 0] ** 2),
        lambda field: [field(QUERIES), field.gradient(QUERIES)],
    ),
}


def in_threads(work: Callable[[], list[Any]]) -> list[list[Any]]:
    """The results of `work` in eight threads that begin together."""
    together = Barrier(THREADS)

    def one() -> list[Any]:
        together.wait(timeout=60)
        return work()

    with ThreadPoolExecutor(THREADS) as pool:
        return [done.result() for done in [pool.submit(one) for _ in range(THREADS)]]


@pytest.mark.parametrize("name", SHARED)
def test_each_thread_gets_what_one_alone_gets(name: str) -> None:
    make, ask = SHARED[name]
    expected = [np.array(part) for part in ask(make())]
    for _ in range(3):
        # A new object each time: what it keeps is not there yet.
        shared = make()
        for found in in_threads(lambda shared=shared: ask(shared)):
            for part, right in zip(found, expected, strict=True):
                np.testing.assert_array_equal(np.asarray(part), right)


def test_threads_triangulate_the_same_array() -> None:
    right = Delaunay(PLANE)
    for found in in_threads(lambda: [Delaunay(PLANE, workers=2).simplices]):
        assert np.array_equal(found[0], right.simplices)


def test_the_global_lock_is_off_where_python_is_built_without_it() -> None:
    # Python turns it on again for a module that does not say that it needs none.
    enabled = getattr(sys, "_is_gil_enabled", lambda: True)()
    assert enabled != FREE_THREADED
