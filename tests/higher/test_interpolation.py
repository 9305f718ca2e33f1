"""Linear and nearest interpolation from four dimensions on, and on rectilinear grids."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import delone
from delone import Delaunay
from delone.interpolate import Linear, Nearest
from delone.interpolate.rectilinear import rectilinear


def grid(axes: list[np.ndarray], seed: int) -> np.ndarray:
    """All nodes in a random order."""
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, len(axes))
    return points[np.random.default_rng(seed).permutation(len(points))]


@pytest.mark.parametrize("d", [4, 5, 6])
def test_linear_functions_are_reproduced(d: int) -> None:
    random = np.random.default_rng(d)
    points, slope = random.random((30, d)), np.arange(1.0, d + 1)
    field = Linear(points, points @ slope + 2)
    queries = random.dirichlet(np.ones(30), 40) @ points
    assert np.abs(field(queries) - queries @ slope - 2).max() < 1e-12
    assert np.abs(field.gradient(queries) - slope).max() < 1e-9
    assert (field(points) == points @ slope + 2).all()
    outside = points[:4] + 5
    assert np.isnan(field(outside)).all()
    assert np.abs(field.weights_at(queries) @ (points @ slope) + 2 - field(queries)).max() < 1e-12
    with pytest.raises(delone.InputError, match="4 of 4 queries are outside the hull"):
        Linear(points, points @ slope, extrapolate="raise")(outside)
    for option in ({"extrapolate": "linear"}, {"tolerance": 1.0}):
        with pytest.raises(delone.InputError, match="only available in 2-D and 3-D"):
            Linear(points, points @ slope, **option)


def test_values_are_those_of_the_simplices() -> None:
    random = np.random.default_rng(1)
    points, values = random.random((40, 4)), random.random((40, 2))
    mesh, queries = Delaunay(points), random.random((60, 4)) * 0.5 + 0.25
    found = Linear(mesh, values)(queries)
    place = mesh.locate(queries)
    inside = place.simplex >= 0
    expected = np.einsum(
        "kc,kcv->kv", place.barycentric[inside], values[mesh.simplices[place.simplex[inside]]]
    )
    assert inside.sum() > 20
    assert np.abs(found[inside] - expected).max() < 1e-14
    assert np.isnan(found[~inside]).all()


def test_missing_values_and_duplicates() -> None:
    random = np.random.default_rng(2)
    points = random.random((30, 4))
    values = points.sum(axis=1)
    values[7] = np.nan
    queries = random.dirichlet(np.ones(30), 20) @ points
    with pytest.raises(delone.NonFiniteError):
        Linear(points, values)
    rest = np.delete(np.arange(30), 7)
    expected = Linear(points[rest], values[rest])(queries)
    assert np.array_equal(Linear(points, values, nan="drop")(queries), expected, equal_nan=True)
    twice = np.vstack((points[rest], points[rest][:1])), np.append(values[rest], 99.0)
    with pytest.raises(delone.InputError):
        Linear(*twice)
    kept = Linear(*twice, duplicates="first")(queries)
    assert np.array_equal(kept, expected, equal_nan=True)


def test_nearest_sites_are_exact() -> None:
    random = np.random.default_rng(3)
    points = random.integers(0, 4, (50, 5)).astype(float)
    points[:6] = np.vstack((np.zeros(5), np.eye(5)))
    queries = random.integers(-2, 10, (80, 5)) / 2
    distance = ((queries[:, None] - points) ** 2).sum(axis=2)
    expected = distance.argmin(axis=1)
    assert Delaunay(points).nearest(queries).tolist() == expected.tolist()
    rows = np.arange(50.0)
    assert Nearest(points, rows, duplicates="first")(queries).tolist() == expected.tolist()


@pytest.mark.parametrize("d", [2, 3, 4, 5])
def test_a_grid_has_the_values_of_its_triangulation(d: int) -> None:
    random = np.random.default_rng(d)
    count = 4 if d < 5 else 2
    axes = [np.sort(random.choice(64, count, replace=False)) + 100.0 * k for k in range(d)]
    points = grid(axes, d)
    values = random.random((len(points), 3))
    low, high = points.min(axis=0), points.max(axis=0)
    queries = low + random.random((500, d)) * (high - low) * 1.05
    # On faces of cells and simplices, at nodes, outside by a rounding.
    queries[:100, 0] = random.choice(axes[0], 100)
    queries[100:150] = points[:50] if len(points) >= 50 else points[:1]
    queries[150:160] = np.nextafter(high, np.inf)
    by_grid = Linear(points, values, method="grid")
    by_mesh = Linear(points, values, method="mesh")
    found, expected = by_grid(queries), by_mesh(queries)
    assert np.array_equal(np.isnan(found), np.isnan(expected))
    assert np.isnan(found).any()
    assert np.nanmax(np.abs(found - expected)) < 1e-13
    assert (by_grid(points) == values).all()
    inner = low + random.random((200, d)) * (high - low)
    slopes = by_mesh.gradient(inner)
    assert np.abs(by_grid.gradient(inner) - slopes).max() < 1e-12 * np.abs(slopes).max()
    table = by_grid.weights_at(inner)
    assert np.abs(table @ values - by_grid(inner)).max() < 1e-14
    assert by_grid._held is None
    assert by_grid.triangulation.npoints == len(points)


def test_grids_are_taken_without_triangulation_from_four_dimensions_on() -> None:
    axes = [np.arange(3.0)] * 4
    points = grid(axes, 0)
    field = Linear(points, points.sum(axis=1))
    assert repr(field) == "<Linear on a grid of 3 x 3 x 3 x 3 points>"
    assert field((0.5, 1.25, 2, 0)) == 3.75
    with pytest.raises(delone.InputError, match="1 of 2 queries is outside the hull: row 1"):
        Linear(points, points.sum(axis=1), extrapolate="raise")([(1, 1, 1, 1), (1, 1, 1, 3)])
    # Without a node, or with one more, points are not a grid.
    twice = np.vstack((points[1:], points[1:2]))
    for other in (points[1:], np.vstack((points, points[:1] + 0.5)), twice):
        assert repr(Linear(other, other.sum(axis=1))).startswith("<Linear on <Delaunay")
    values = points.sum(axis=1)
    values[3] = np.nan
    dropped = Linear(points, values, nan="drop")
    assert repr(dropped).startswith("<Linear on <Delaunay")
    assert np.isfinite(dropped(np.full((1, 4), 1.25))).all()
    spread = Linear(points, values, nan="propagate")
    at = points[3]
    assert np.isnan(spread(at))
    assert np.isfinite(spread(points[np.arange(81) != 3])).all()


def test_grids_of_many_coordinates() -> None:
    axes = [np.array([0.0, 1.0 + k]) for k in range(12)]
    points = grid(axes, 1)
    field = Linear(points, points @ np.arange(12.0))
    query = np.linspace(0.1, 0.9, 12)
    assert field(query) == pytest.approx(query @ np.arange(12.0), rel=1e-14)
    assert field.gradient(query) == pytest.approx(np.arange(12.0), abs=1e-12)
    rest = Linear(points[1:], points[1:] @ np.arange(12.0))
    assert repr(rest) == f"<Linear on {len(points) - 1} points in 12-D>"
    with pytest.raises(delone.ShapeError):
        _ = field.triangulation


def test_method_grid_refuses_what_is_no_grid() -> None:
    points = grid([np.arange(3.0)] * 2, 0)
    values = np.zeros(9)
    with pytest.raises(delone.InputError, match="needs the points of a rectilinear grid"):
        Linear(points[1:], values[1:], method="grid")
    with pytest.raises(delone.InputError, match="needs the points of a rectilinear grid"):
        Linear(Delaunay(points), values, method="grid")
    with pytest.raises(delone.InputError, match="method must be one of"):
        Linear(points, values, method="lattice")
    assert rectilinear(np.array([[0.0, 0.0], [0.0, 1.0], [0.0, 2.0], [0.0, 3.0]])) is None
    assert rectilinear(np.vstack((points, points[:0]))) is not None


def test_steps_at_the_ends_of_doubles() -> None:
    for scale in (5e-324, 1e-300, 1.7e308):
        axis = np.array([-scale, scale])
        points = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
        field = Linear(points, np.array([0.0, 4.0, 8.0, 12.0]), method="grid")
        assert field((0.0, 0.0)) == 6
        assert field([(scale, scale), (-scale, scale)]).tolist() == [12, 8]


def test_paths_are_monotone() -> None:
    found = rectilinear(grid([np.arange(4.0)] * 3, 4))
    assert found is not None
    queries = np.random.default_rng(0).random((50, 3)) * 3
    cells = found.find(queries)
    nodes = grid([np.arange(4.0)] * 3, 4)[cells.corners]
    for before, after in pairwise(range(4)):
        step = nodes[:, after] - nodes[:, before]
        assert (np.sort(step, axis=1) == [0, 0, 1]).all()
    assert np.abs(np.einsum("kc,kcd->kd", cells.weights, nodes) - queries).max() < 1e-14


@pytest.mark.parametrize("workers", [1, 2])
def test_many_queries_are_answered_as_few_are(workers: int) -> None:
    random = np.random.default_rng(6)
    points, queries = random.random((60, 4)), random.random((3000, 4))
    mesh = Delaunay(points, workers=workers)
    whole = mesh.locate(queries)
    for start in range(0, len(queries), 100):
        part = mesh.locate(queries[start : start + 100])
        rows = slice(start, start + 100)
        assert np.array_equal(whole.simplex[rows], part.simplex)
        assert np.array_equal(whole.barycentric[rows], part.barycentric, equal_nan=True)
    assert (whole.simplex >= 0).sum() > 500
