"""Across a fault nothing is mixed; holes are outside."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import delone
from delone import ConstrainedDelaunay, Delaunay, datasets
from delone.errors import InputError
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor, interpolator
from delone.interpolate.methods import METHODS
from delone.interpolate.smooth import cut

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
FAULT = np.column_stack((np.full(6, 0.5), np.linspace(0, 1, 6)))


def faulted(length: int = 5) -> tuple[ConstrainedDelaunay, Any]:
    """Points of a square, with a fault up its middle, or part of it; which are to its right."""
    points = np.concatenate((datasets.uniform(300, seed=3), SQUARE, FAULT))
    first = len(points) - 6
    segments = [(first + i, first + i + 1) for i in range(length)]
    return ConstrainedDelaunay(points, segments), points[:, 0] > 0.5


@pytest.mark.parametrize(
    "method", ["linear", "clough-tocher", "sibson", "laplace", "sibson1", "farin"]
)
def test_one_side_does_not_show_on_the_other(method: str) -> None:
    mesh, right = faulted()
    values = mesh.points[:, 1] + 10.0 * right
    made = interpolator(mesh, values, method, respect_constraints=True)
    queries = np.random.default_rng(4).random((2000, 2)) * (0.499, 1)
    np.testing.assert_allclose(made(queries), queries[:, 1], atol=1e-5)
    values[right] *= -1e3
    np.testing.assert_array_equal(made(queries, values=values), made(queries))
    np.testing.assert_allclose(made.weights_at(queries) @ values, made(queries), rtol=1e-12)
    assert not right[made.weights_at(queries).indices].any()


def test_matrices_share_duplicates_on_both_sides() -> None:
    points = np.concatenate((datasets.uniform(300, seed=3), SQUARE, FAULT, FAULT[2:4], FAULT[2:3]))
    segments = [(304 + i, 305 + i) for i in range(5)]
    values = np.random.default_rng(4).normal(size=len(points))
    mesh = ConstrainedDelaunay(points, segments)
    made = NaturalNeighbor(mesh, values, duplicates="mean", respect_constraints=True)
    queries = np.concatenate((np.random.default_rng(5).random((300, 2)), FAULT))
    np.testing.assert_allclose(made.weights_at(queries).csr() @ values, made(queries), rtol=1e-10)


def test_without_respect_it_shows() -> None:
    mesh, right = faulted()
    values = mesh.points[:, 1] + 10.0 * right
    queries = np.random.default_rng(4).random((2000, 2)) * (0.499, 1)
    found = CloughTocher(mesh, values)(queries)
    assert np.abs(found - queries[:, 1]).max() > 1


def test_the_nearest_site_that_is_seen() -> None:
    mesh, right = faulted()
    queries = np.random.default_rng(5).random((300, 2))
    made = interpolator(mesh, right.astype(float), "nearest", respect_constraints=True)
    assert (made(queries[queries[:, 0] < 0.5]) == 0).all()
    rows = np.arange(mesh.npoints, dtype=float)
    seen = made(queries, values=rows).astype(int)
    on_fault = mesh.points[:, 0] == 0.5
    for query, row in zip(queries, seen, strict=True):
        side = (mesh.points[:, 0] > 0.5) == (query[0] > 0.5)
        distance = np.where(side | on_fault, np.hypot(*(mesh.points - query).T), np.inf)
        assert row == distance.argmin()
    far = interpolator(mesh, rows, "nearest", respect_constraints=True)([(9, 9), (np.nan, 0)])
    assert far[0] == 302 and np.isnan(far[1])


def test_a_fault_that_ends_parts_no_vertex_at_its_end() -> None:
    mesh, _ = faulted(3)
    made = CloughTocher(mesh, mesh.points[:, 0], respect_constraints=True)
    # The fault begins on the hull: its first vertices have two sides, its last one has one.
    assert len(made.site_gradients()) == mesh.npoints + 3
    queries = np.random.default_rng(6).random((500, 2))
    np.testing.assert_allclose(made(queries), queries[:, 0], atol=1e-5)


def test_holes_are_outside() -> None:
    turn = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = 0.5 + 0.2 * np.column_stack((np.cos(turn), np.sin(turn)))
    points = np.concatenate((datasets.uniform(300, seed=7), SQUARE, ring))
    segments = [(304 + i, 304 + (i + 1) % 40) for i in range(40)]
    mesh = ConstrainedDelaunay(points, segments, holes=[(0.5, 0.5)])
    assert mesh.locate((0.5, 0.5)).simplex == -1
    queries = np.random.default_rng(8).random((1000, 2))
    within = np.hypot(*(queries - 0.5).T) < 0.19
    for method in ("linear", "sibson", "clough-tocher"):
        made = interpolator(mesh, points[:, 0], method, respect_constraints=True)
        assert np.isnan(made(queries[within])).all()
        np.testing.assert_allclose(made(queries[~within][:50]), queries[~within][:50, 0], atol=1e-5)
    near = Linear(mesh, points[:, 0], extrapolate="nearest")
    assert near((0.5, 0.69)) == pytest.approx(0.5, abs=0.03)


def test_what_has_no_meaning_is_refused() -> None:
    mesh, _ = faulted()
    with pytest.raises(InputError, match="respect_constraints=True"):
        NaturalNeighbor(mesh)
    gaps = np.where(np.arange(mesh.npoints) == mesh.npoints - 2, np.nan, 1.0)
    with pytest.raises(InputError, match=r"from a constrained .*need rows 308"):
        Linear(mesh, gaps, nan="drop")
    ring = [(0, 1), (1, 2), (2, 3), (3, 0)]
    fine = delone.mesh((SQUARE, ring), max_area=0.1)
    with pytest.raises(InputError, match="from a constrained"):
        Linear(fine, np.full(fine.npoints, np.nan), nan="drop")


@pytest.mark.parametrize("method", sorted(METHODS))
def test_sites_without_a_value_are_left_out(method: str) -> None:
    mesh, right = faulted()
    values = mesh.points[:, 1] + 10.0 * right
    gaps = values.copy()
    gaps[:40:3] = np.nan
    kept = np.flatnonzero(np.isfinite(gaps))
    segments = [(int(kept.searchsorted(a)), int(kept.searchsorted(b))) for a, b in mesh.segments]
    rest = ConstrainedDelaunay(mesh.points[kept], segments)
    expected = interpolator(rest, values[kept], method, respect_constraints=True)
    queries = np.random.default_rng(4).random((500, 2))
    made = interpolator(mesh, gaps, method, nan="drop", respect_constraints=True)
    np.testing.assert_array_equal(made(queries), expected(queries))
    table = made.weights_at(queries)
    assert np.isin(table.indices, kept).all()
    np.testing.assert_allclose(table @ gaps, expected(queries), rtol=1e-12)
    whole = interpolator(mesh, values, method, respect_constraints=True)
    np.testing.assert_array_equal(made(queries, values=values), whole(queries))
    assert NaturalNeighbor(mesh, respect_constraints=True).kind == "sibson"


def test_cut_by_every_edge_and_by_none() -> None:
    mesh = Delaunay(datasets.uniform(50))
    every = np.ones(mesh.simplices.shape, dtype=bool)
    simplices, source = cut(mesh.simplices, mesh.neighbors, every, 50)
    assert len(np.unique(simplices)) == 3 * mesh.nsimplex
    assert np.array_equal(source[simplices], mesh.simplices)
    simplices, source = cut(mesh.simplices, mesh.neighbors, ~every, 50)
    assert np.array_equal(simplices, mesh.simplices) and len(source) == 50


@pytest.mark.parametrize("method", sorted(METHODS))
def test_on_meshes_with_holes(method: str) -> None:
    ring = [(0, 1), (1, 2), (2, 3), (3, 0)]
    hole = [(4 + a, 4 + b) for a, b in ring]
    fault = [(8, 9)]
    corners = [*SQUARE, (0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6), (0.2, 0.2), (0.2, 0.8)]
    mesh = delone.mesh((corners, ring + hole + fault), holes=[(0.5, 0.5)], max_area=0.004)
    values = 1 + 2 * mesh.points[:, 0] - 3 * mesh.points[:, 1]
    made = interpolator(mesh, values, method, respect_constraints=True)
    assert made(mesh.points).tobytes() == values.tobytes()
    queries = np.random.default_rng(9).random((500, 2))
    found = made(queries)
    within = (np.abs(queries - 0.5) < 0.1).all(axis=1)
    if method == "nearest":
        np.testing.assert_allclose(found, 1 + 2 * queries[:, 0] - 3 * queries[:, 1], atol=0.5)
        return
    assert np.array_equal(np.isnan(found), within)
    expected = (1 + 2 * queries[:, 0] - 3 * queries[:, 1])[~within]
    np.testing.assert_allclose(found[~within], expected, atol=1e-4)
    np.testing.assert_allclose(made.weights_at(queries) @ values, found, rtol=1e-12)
    slopes = made.gradient(queries[~within])
    np.testing.assert_allclose(slopes, np.tile((2.0, -3.0), (len(slopes), 1)), atol=1e-2)
