"""Interpolation in space: sites, linear functions, Laplace weights, the hull, what is refused."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from delone import Delaunay, RegularTriangulation, Voronoi
from delone.errors import InputError, ShapeError
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor, Nearest, interpolator

GRID = np.array(list(itertools.product(range(4), repeat=3)), dtype=float)


def uniform(n: int, seed: int) -> Any:
    return np.random.default_rng(seed).random((n, 3))


def plane(points: Any) -> Any:
    return points @ np.array([1.0, -2.0, 3.0]) + 0.5


def sphere(n: int) -> Any:
    points = np.random.default_rng(4).normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


SETS = {
    "uniform": uniform(300, 1),
    "grid": GRID,
    "sphere": sphere(120),
    "flat": uniform(200, 2) * [1, 1, 1e-8],
    "far": uniform(200, 3) + 1e5,
    "cube": np.array(list(itertools.product((0.0, 1.0), repeat=3))),
}
LINEAR = ("linear", "laplace")


@pytest.mark.parametrize("method", ["linear", "laplace", "nearest"])
@pytest.mark.parametrize("name", SETS)
def test_sites_get_their_values_bit_for_bit(method: str, name: str) -> None:
    points = SETS[name]
    values = np.random.default_rng(0).normal(size=(len(points), 2)) * 1e7
    values[0] = -0.0
    found = interpolator(points, values, method)(points)
    assert found.tobytes() == values.tobytes()


def inside(points: Any, seed: int, count: int) -> Any:
    """Queries in the hull: in tetrahedra, on faces, on edges, on the hull."""
    rng = np.random.default_rng(seed)
    mesh = Delaunay(points)
    picked = mesh.simplices[rng.integers(0, mesh.nsimplex, count)]
    shares = rng.dirichlet(np.ones(4), count)
    shares[: count // 4, 0] = 0
    shares[: count // 8, 1] = 0
    shares /= shares.sum(axis=1)[:, None]
    queries = np.einsum("ki,kij->kj", shares, points[picked])
    return queries[mesh.find_simplex(queries) >= 0]


@pytest.mark.parametrize("method", LINEAR)
@pytest.mark.parametrize("name", SETS)
def test_linear_functions_are_reproduced(method: str, name: str) -> None:
    points = SETS[name]
    queries = inside(points, 5, 2000)
    assert len(queries) > 500
    values = plane(points)
    found = interpolator(points, values, method)(queries)
    assert np.abs(found - plane(queries)).max() < 2e-14 * max(1.0, np.abs(values).max())


@pytest.mark.parametrize("name", SETS)
def test_laplace_weights_are_those_of_a_convex_mean(name: str) -> None:
    points = SETS[name]
    queries = inside(points, 6, 1000)
    table = NaturalNeighbor(points, kind="laplace").weights_at(queries)
    assert table.weights.min() > 0
    owner = np.repeat(np.arange(len(queries)), np.diff(table.indptr))
    sums = np.bincount(owner, table.weights)
    assert np.abs(sums - 1).max() < 1e-14
    scale = np.ptp(points, axis=0)
    for k in range(3):
        mean = np.bincount(owner, table.weights * (points[table.indices, k] - points[0, k]))
        assert np.abs(mean - (queries[:, k] - points[0, k])).max() < 1e-13 * max(1, scale[k])


def test_laplace_weights_are_areas_over_distances_of_the_cell_of_the_query() -> None:
    points = uniform(200, 7)
    queries = 0.3 + 0.4 * uniform(20, 8)
    table = NaturalNeighbor(points, kind="laplace").weights_at(queries)
    for i, query in enumerate(queries):
        cell = Voronoi(np.vstack((points, query))).cell(len(points))
        distance = np.linalg.norm(points[cell.neighbors] - query, axis=1)
        expected = cell.sizes / distance
        row = slice(table.indptr[i], table.indptr[i + 1])
        order = np.argsort(table.indices[row])
        assert table.indices[row][order].tolist() == cell.neighbors.tolist()
        assert table.weights[row][order] == pytest.approx(expected / expected.sum(), rel=1e-9)


def test_laplace_weights_on_a_grid_by_hand() -> None:
    table = NaturalNeighbor(GRID, kind="laplace").weights_at(
        [(1.5, 1.5, 1.5), (1.5, 1.5, 0), (1.5, 0, 0), (1.25, 1.25, 0), (1, 2, 1.5)]
    )
    rows = [table.weights[a:b] for a, b in itertools.pairwise(table.indptr)]
    assert [len(row) for row in rows[:3]] == [8, 4, 2]
    assert rows[0] == pytest.approx(np.full(8, 1 / 8))
    assert rows[1] == pytest.approx(np.full(4, 1 / 4))
    assert rows[2] == pytest.approx(np.full(2, 1 / 2))
    assert sorted(rows[3]) == pytest.approx([1 / 16, 3 / 16, 3 / 16, 9 / 16])


@pytest.mark.parametrize("distance", [1e-3, 1e-8, 1e-15, 1e-300])
def test_laplace_is_continuous_at_the_hull(distance: float) -> None:
    values = np.random.default_rng(9).normal(size=len(GRID))
    height = NaturalNeighbor(GRID, values, kind="laplace")
    on = np.column_stack((3 * uniform(200, 10)[:, :2], np.zeros(200)))
    near = on + np.array([0, 0, distance])
    sibson = NaturalNeighbor(GRID[::4, :2], values[::4], kind="sibson")
    assert np.abs(height(on) - sibson(on[:, :2])).max() < 1e-12
    assert np.abs(height(near) - height(on)).max() < 60 * distance + 1e-12


def test_nearest_is_the_nearest() -> None:
    points, queries = uniform(300, 11), 1.4 * uniform(800, 12) - 0.2
    found = Nearest(points, np.arange(300))(queries)
    distance = ((queries[:, None] - points) ** 2).sum(axis=2)
    assert np.array_equal(found, distance.argmin(axis=1))
    grid = Nearest(GRID, np.arange(len(GRID)))((0.5, 0.5, 0.5))
    assert grid == 0


def test_what_lies_beyond_the_hull() -> None:
    points = uniform(200, 13)
    values = plane(points)
    queries = 3 * uniform(500, 14) - 1
    outside = Delaunay(points).find_simplex(queries) < 0
    for method in LINEAR:
        assert np.array_equal(np.isnan(interpolator(points, values, method)(queries)), outside)
        on = interpolator(points, values, method, extrapolate="linear")
        assert on(queries) == pytest.approx(plane(queries), abs=1e-11)
        assert on.weights_at(queries).apply(values) == pytest.approx(plane(queries), abs=1e-11)
        near = interpolator(points, values, method, extrapolate="nearest")(queries)
        assert not np.isnan(near).any()
        assert near.min() >= values.min() - 1e-12
        assert near.max() <= values.max() + 1e-12
        with pytest.raises(InputError, match="outside the hull"):
            interpolator(points, values, method, extrapolate="raise")(queries)
    assert np.isnan(Linear(points, values, extrapolate="nearest")((np.nan, 0, 0)))


def test_the_nearest_point_of_the_hull_is_that_of_rational_arithmetic() -> None:
    cube = SETS["cube"]
    values = cube @ np.array([1.0, 2.0, 4.0])
    queries = np.array([(0.25, 0.5, 3), (-1, -1, 0.5), (2, 2, 2), (0.5, -3, 0.25)])
    found = Linear(cube, values, extrapolate="nearest")(queries)
    clamped = [
        [min(max(Fraction(x), Fraction(0)), Fraction(1)) for x in q] for q in queries.tolist()
    ]
    assert found == pytest.approx([float(x + 2 * y + 4 * z) for x, y, z in clamped], abs=1e-14)


def test_slopes_of_linear() -> None:
    points = np.concatenate((SETS["uniform"], SETS["flat"]))
    height = Linear(points, np.column_stack((plane(points), -plane(points))))
    queries = inside(points, 15, 300)
    found = height.gradient(queries)
    assert found.shape == (len(queries), 2, 3)
    # Values are rounded, which over the height of the thinnest tetrahedra is this much.
    assert np.abs(found[:, 0] - [1, -2, 3]).max() < 1e-4
    beyond = Linear(points, plane(points), extrapolate="linear")
    assert beyond.gradient((5, 5, 5)) == pytest.approx([1, -2, 3], abs=1e-9)
    assert np.isnan(height.gradient((5, 5, 5))).all()


def hollow() -> Any:
    """A ball with a hole in its middle, with slivers removed: neither convex nor Delaunay."""
    mesh = Delaunay(uniform(400, 20))
    away = np.linalg.norm(mesh.points[mesh.simplices].mean(axis=1) - 0.5, axis=1)
    kept = mesh.simplices[(away > 0.2) & (away < 0.45)]
    return delone.improve((mesh.points, kept))


TILINGS = {
    "hollow": hollow,
    "improved": lambda: delone.improve(Delaunay(uniform(200, 21)), min_angle=30),
    "regular": lambda: RegularTriangulation(uniform(200, 22), uniform(200, 23)[:, 0] / 20),
}


@pytest.mark.parametrize("name", TILINGS)
def test_other_tilings_are_used_as_they_are(name: str) -> None:
    mesh = TILINGS[name]()
    vertices = np.unique(mesh.simplices)
    values = np.random.default_rng(24).normal(size=(mesh.npoints, 2)) * 1e7
    height = Linear(mesh, values)
    assert height.triangulation is mesh
    assert height(mesh.points[vertices]).tobytes() == values[vertices].tobytes()
    queries = 1.2 * uniform(3000, 25) - 0.1
    place = mesh.locate(queries)
    outside = place.simplex < 0
    assert 300 < outside.sum() < 2900
    found = height(queries)
    assert np.array_equal(np.isnan(found).all(axis=1), outside)
    corners = values[mesh.simplices[place.simplex]]
    wanted = np.einsum("ki,kij->kj", place.barycentric, corners)
    assert np.abs(found - wanted)[~outside].max() < 1e-8
    assert np.abs(height.weights_at(queries).apply(values) - found)[~outside].max() < 1e-8


@pytest.mark.parametrize("name", TILINGS)
def test_linear_functions_are_reproduced_on_other_tilings(name: str) -> None:
    mesh = TILINGS[name]()
    queries = 1.2 * uniform(3000, 26) - 0.1
    outside = mesh.find_simplex(queries) < 0
    height = Linear(mesh, plane(mesh.points), extrapolate="linear")
    assert np.abs(height(queries) - plane(queries)).max() < 1e-10
    slopes = height.gradient(queries[~outside])
    assert np.abs(slopes - [1, -2, 3]).max() < 1e-6
    near = Linear(mesh, plane(mesh.points), extrapolate="nearest")(queries[outside])
    assert near == pytest.approx(plane(mesh.locate(queries[outside]).closest), abs=1e-12)
    with pytest.raises(InputError, match="outside the hull"):
        Linear(mesh, plane(mesh.points), extrapolate="raise")(queries)


@pytest.mark.parametrize("name", TILINGS)
def test_nearest_vertices_of_other_tilings(name: str) -> None:
    mesh = TILINGS[name]()
    vertices = np.unique(mesh.simplices)
    assert len(vertices) < mesh.npoints or name == "improved"
    queries = 1.2 * uniform(500, 27) - 0.1
    distance = ((queries[:, None] - mesh.points[vertices]) ** 2).sum(axis=2)
    wanted = vertices[distance.argmin(axis=1)]
    rows = np.arange(mesh.npoints)
    assert np.array_equal(Nearest(mesh, rows)(queries), wanted)
    inside = mesh.find_simplex(queries) >= 0
    found = Nearest(mesh, rows, extrapolate="nan")(queries)
    assert np.array_equal(found[inside], wanted[inside])
    assert np.isnan(found[~inside]).all()


@pytest.mark.parametrize("name", TILINGS)
def test_what_other_tilings_do_not_allow_is_refused(name: str) -> None:
    mesh = TILINGS[name]()
    kind = type(mesh).__name__
    with pytest.raises(InputError, match=f"not a {kind}; `Linear` takes it"):
        NaturalNeighbor(mesh, kind="laplace")
    values = plane(mesh.points)
    values[mesh.simplices[0, 0]] = np.nan
    with pytest.raises(InputError, match=f"nan='drop' would remove points from a {kind}"):
        Linear(mesh, values, nan="drop")
    with pytest.raises(InputError, match=f"nan='drop' would remove points from a {kind}"):
        Linear(mesh, nan="drop")(mesh.points[:1], values=values)
    found = Linear(mesh, values, nan="propagate")(mesh.points[mesh.simplices].mean(axis=1))
    touched = (mesh.simplices == mesh.simplices[0, 0]).any(axis=1)
    assert np.array_equal(np.isnan(found), touched)


def test_weighted_triangulations_do_not_turn_into_plain_ones_in_2d() -> None:
    points = uniform(50, 28)
    mesh = RegularTriangulation(points[:, :2], points[:, 2])
    values = np.where(np.arange(50) == 3, np.nan, 1.0)
    with pytest.raises(InputError, match="would remove points from a RegularTriangulation"):
        Linear(mesh, values, nan="drop")


def test_shapes_policies_and_fields() -> None:
    points = np.vstack((uniform(50, 16), uniform(50, 16)[:3]))
    values = np.arange(53.0)
    with pytest.raises(InputError, match="different value"):
        Linear(points, values)
    for method in ("linear", "laplace", "nearest"):
        last = interpolator(points, values, method, duplicates="last")
        assert last(points[:3]).tolist() == [50, 51, 52]
        assert last(points[:4].reshape(2, 2, 3)).shape == (2, 2)
        table = last.weights_at(points[:3])
        assert table.apply(values).tolist() == [50, 51, 52]
        odd = np.where(values == 7, np.nan, values)
        dropped = interpolator(points, odd, method, duplicates="last", nan="drop")
        assert dropped.triangulation.npoints == 52
        whole = interpolator(Delaunay(points), 1j * values, method, duplicates="first")
        assert whole(points[5]) == 5j
        with pytest.raises(ShapeError):
            last([(0, 0)])


def test_workers_change_nothing() -> None:
    points, queries = uniform(2000, 17), uniform(5000, 18)
    for method in ("linear", "laplace", "nearest"):
        one, two = (interpolator(points, plane(points), method, workers=k)(queries) for k in (1, 2))
        assert one.tobytes() == two.tobytes()


def test_what_there_is_in_the_plane_alone_is_refused_by_name() -> None:
    points = uniform(20, 19)
    with pytest.raises(InputError, match="CloughTocher is only available in 2-D"):
        CloughTocher(points, plane(points))
    for kind in ("sibson", "sibson1", "farin"):
        with pytest.raises(InputError, match=f"kind='{kind}' is only available in 2-D"):
            NaturalNeighbor(points, plane(points), kind=kind)
    height = NaturalNeighbor(points, plane(points), kind="laplace")
    with pytest.raises(InputError, match="gradient"):
        height.gradient(points[:1])
    with pytest.raises(InputError, match="hessian"):
        height.hessian(points[:1])
    with pytest.raises(InputError, match="site_gradients"):
        height.site_gradients()
