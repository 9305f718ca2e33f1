"""Point location against its definition, on and off the boundary."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, datasets
from delone.compat import scipy
from delone.errors import DtypeError, ShapeError
from delone.predicates import orient2d

if TYPE_CHECKING:
    from numpy.typing import NDArray


def check(mesh: Delaunay, queries: NDArray[np.float64]) -> NDArray[np.int32]:
    """Each triangle found has its point; where none is found, the point is outside the hull."""
    found = mesh.find_simplex(queries)
    assert found.dtype == np.int32
    inside = found >= 0
    corners = mesh.points[mesh.simplices[found[inside]]]
    for k in range(3):
        start, end = corners[:, k], corners[:, (k + 1) % 3]
        assert (orient2d(start, end, queries[inside]) >= 0).all()
    hull = mesh.points[mesh.hull]
    after = np.roll(hull, -1, axis=0)
    within = np.array([(orient2d(hull, after, query) >= 0).all() for query in queries])
    assert np.array_equal(inside, within)
    return found


@pytest.mark.parametrize("name", sorted(datasets.GENERATORS))
def test_queries_everywhere(name: str) -> None:
    mesh = Delaunay(datasets.GENERATORS[name](150, seed=2))
    rng = np.random.default_rng(3)
    with np.errstate(over="ignore"):
        low, high = mesh.min_bound, mesh.max_bound
        spread = low + rng.random((100, 2)) * (high - low) * 1.2
    spread = spread[np.isfinite(spread).all(axis=1)]
    u, v = mesh.edges.T
    halves = mesh.points[u] / 2 + mesh.points[v] / 2
    centroids = (mesh.points[mesh.simplices] / 3).sum(axis=1)
    nudged = np.nextafter(mesh.points, np.inf)
    check(mesh, np.concatenate((spread, halves, centroids, mesh.points, nudged)))


def test_every_vertex_is_in_a_triangle_of_its_own() -> None:
    mesh = Delaunay(datasets.duplicates(300))
    found = mesh.find_simplex(mesh.points)
    assert (mesh.simplices[found] == mesh.duplicate_of[:, None]).any(axis=1).all()


def test_the_hull_is_inside_and_the_next_double_is_not() -> None:
    mesh = Delaunay([(0, 0), (1, 0), (0, 1)])
    assert mesh.find_simplex([(0.5, 0), (0.5, 0.5), (0, 0.5)]).tolist() == [0, 0, 0]
    assert mesh.find_simplex([(0.5, -5e-324), (0.5, np.nextafter(0.5, 1))]).tolist() == [-1, -1]


def test_what_is_no_number_is_outside() -> None:
    mesh = Delaunay(datasets.uniform(100))
    bad = [(np.nan, 0.5), (0.5, np.nan), (np.inf, 0.5), (0.5, -np.inf), (np.nan, np.inf)]
    assert mesh.find_simplex(bad).tolist() == [-1] * 5
    mixed = mesh.find_simplex([(0.5, 0.5), (np.nan, 0.5), (0.5, 0.5)])
    assert mixed[0] == mixed[2] >= 0 > mixed[1]


def test_queries_far_off_are_outside() -> None:
    mesh = Delaunay(datasets.uniform(100))
    huge = np.finfo(float).max
    assert mesh.find_simplex([(huge, huge), (-huge, 0), (1e-300, -1e300)]).tolist() == [-1] * 3


@pytest.mark.parametrize("shape", [(2,), (0, 2), (7, 2), (3, 4, 2), (2, 0, 2), (1, 1, 1, 2)])
def test_any_leading_shape(shape: tuple[int, ...]) -> None:
    mesh = Delaunay(datasets.uniform(100))
    queries = np.random.default_rng(0).random(shape)
    found = mesh.find_simplex(queries)
    assert found.shape == shape[:-1]
    one_by_one = [mesh.find_simplex(q) for q in queries.reshape(-1, 2)]
    assert found.reshape(-1).tolist() == [int(f) for f in one_by_one]


def test_arguments_of_scipy_are_those_of_the_drop_in() -> None:
    points, queries = datasets.uniform(100), np.random.default_rng(0).random((50, 2))
    mesh = Delaunay(points)
    with pytest.raises(TypeError, match="bruteforce"):
        mesh.find_simplex(queries, bruteforce=True)  # type: ignore[call-arg]
    found = scipy.Delaunay(points).find_simplex(queries, True, 0.0)
    inside = mesh.find_simplex(queries) >= 0
    assert np.array_equal(found >= 0, inside)


@pytest.mark.parametrize("bad", [1.0, (1, 2, 3), [[1], [2]], np.zeros((2, 3))])
def test_wrong_shapes_are_refused(bad: Any) -> None:
    mesh = Delaunay(datasets.uniform(10))
    with pytest.raises(ShapeError, match="xi"):
        mesh.find_simplex(bad)


def test_wrong_dtypes_are_refused() -> None:
    mesh = Delaunay(datasets.uniform(10))
    for bad in (
        [(1j, 0)],
        [("a", "b")],
        [(True, False)],
        np.ma.masked_array([(0.0, 0.0)], mask=True),
    ):
        with pytest.raises(DtypeError, match="xi"):
            mesh.find_simplex(bad)  # type: ignore[arg-type]


@pytest.mark.parametrize("workers", [2, 3, 7])
def test_neither_workers_nor_company_show(workers: int) -> None:
    points = datasets.grid(2500)
    one, many = Delaunay(points, workers=1), Delaunay(points, workers=workers)
    rng = np.random.default_rng(1)
    low, high = one.min_bound, one.max_bound
    # Points of the lattice and between: many lie on edges and corners of several triangles.
    queries = low + rng.integers(0, 2 * 49, (20_000, 2)) / 98 * (high - low)
    queries = np.concatenate((queries, points))
    expected = one.find_simplex(queries)
    assert np.array_equal(many.find_simplex(queries), expected)
    order = rng.permutation(len(queries))
    assert np.array_equal(many.find_simplex(queries[order]), expected[order])
    assert np.array_equal(one.find_simplex(queries[:50]), expected[:50])
