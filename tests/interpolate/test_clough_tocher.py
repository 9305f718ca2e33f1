"""Clough-Tocher against its definition in fractions, its smoothness, and its gradients."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import Delaunay, datasets
from delone.compat.scipy import CloughTocher2DInterpolator
from delone.errors import DtypeError
from delone.interpolate import CloughTocher, GradientWarning, interpolator
from delone.reference import clough_tocher


def bumps(points: Any) -> Any:
    return np.sin(5 * points[..., 0]) + np.cos(4 * points[..., 1]) * points[..., 0]


def bowl(points: Any) -> Any:
    x, y = points[..., 0], points[..., 1]
    return x * x - x * y / 2 + 0.3 * y * y - y + 2


@pytest.mark.parametrize("gradients", ["global", "local"])
def test_values_are_those_of_the_definition(gradients: str) -> None:
    mesh = Delaunay(datasets.uniform(25, seed=3))
    made = CloughTocher(mesh, bumps(mesh.points), gradients=gradients)
    slopes = made.site_gradients()
    queries = np.random.default_rng(4).random((60, 2))
    found = made(queries)
    for query, value in zip(queries, found, strict=True):
        t = int(mesh.find_simplex(query))
        if t < 0:
            assert np.isnan(value)
            continue
        corners = mesh.simplices[t]
        beyond = [
            None if n < 0 else mesh.points[(set(mesh.simplices[n]) - set(corners)).pop()]
            for n in mesh.neighbors[t]
        ]
        exact = clough_tocher(
            mesh.points[corners], bumps(mesh.points[corners]), slopes[corners], beyond, query
        )
        assert value == pytest.approx(float(exact), rel=1e-12, abs=1e-12)


def test_global_gradients_bend_edges_least() -> None:
    mesh = Delaunay(datasets.uniform(60, seed=5))
    values = bumps(mesh.points)
    made = CloughTocher(mesh, values, tol=1e-13, max_iter=2000)

    def energy(slopes: Any) -> float:
        u, v = mesh.edges.T
        edge = mesh.points[v] - mesh.points[u]
        start, end = (slopes[u] * edge).sum(axis=1), (slopes[v] * edge).sum(axis=1)
        rise = values[v] - values[u]
        bent = start**2 + start * end + end**2 - 3 * rise * (start + end) + 3 * rise**2
        return float((bent / np.hypot(*edge.T) ** 3).sum())

    best = made.site_gradients()
    rng = np.random.default_rng(6)
    for size in (1e-3, 1e-1):
        for _ in range(20):
            assert energy(best + size * rng.normal(size=best.shape)) > energy(best)


def test_local_gradients_are_exact_for_quadratic_functions() -> None:
    points = datasets.uniform(200, seed=7)
    made = CloughTocher(points, bowl(points), gradients="local", extrapolate="raise")
    queries = 0.2 + 0.6 * np.random.default_rng(8).random((200, 2))
    x, y = queries.T
    np.testing.assert_allclose(made(queries), bowl(queries), rtol=1e-11)
    slopes = np.column_stack((2 * x - y / 2, -x / 2 + 0.6 * y - 1))
    np.testing.assert_allclose(made.gradient(queries), slopes, atol=1e-9)
    hessian = np.tile([[2.0, -0.5], [-0.5, 0.6]], (200, 1, 1))
    np.testing.assert_allclose(made.hessian(queries), hessian, atol=1e-6)


def test_derivatives_go_over_edges_without_a_jump() -> None:
    lattice = np.stack(np.meshgrid(np.arange(9), np.arange(9)), axis=-1).reshape(-1, 2) / 8
    jitter = np.random.default_rng(9).random((81, 2)) / 30
    mesh = Delaunay(lattice + jitter)
    made = CloughTocher(mesh, bumps(mesh.points))
    # Across a sliver the slope may change as fast as it likes.
    fat = np.append(mesh.areas > 1e-3, False)
    inner = np.argwhere((fat[:-1, None] & fat[mesh.neighbors]) & (mesh.neighbors >= 0))
    t, k = inner.T
    u, v = mesh.simplices[t, (k + 1) % 3], mesh.simplices[t, (k + 2) % 3]
    middle = 0.3 * mesh.points[u] + 0.7 * mesh.points[v]
    turned = (mesh.points[v] - mesh.points[u]) @ np.array([[0, 1], [-1, 0]])
    left, right = (made.gradient(middle + sign * 1e-9 * turned) for sign in (1, -1))
    np.testing.assert_allclose(left, right, atol=1e-4)


def test_gradient_and_hessian_are_derivatives() -> None:
    points = datasets.uniform(80, seed=9)
    made = CloughTocher(points, bumps(points))
    queries = 0.2 + 0.6 * np.random.default_rng(1).random((200, 2))
    step = 1e-6
    for axis, d in enumerate(step * np.eye(2)):
        slope = (made(queries + d) - made(queries - d)) / (2 * step)
        np.testing.assert_allclose(made.gradient(queries)[:, axis], slope, atol=1e-6)
        bend = (made.gradient(queries + d) - made.gradient(queries - d)) / (2 * step)
        np.testing.assert_allclose(made.hessian(queries)[:, axis], bend, rtol=1e-4, atol=1e-2)


def test_order_of_accuracy() -> None:
    errors = []
    for n in (400, 1600, 6400):
        points = datasets.uniform(n, seed=10)
        made = CloughTocher(points, bumps(points), gradients="local")
        queries = 0.1 + 0.8 * np.random.default_rng(11).random((2000, 2))
        errors.append(np.sqrt(np.mean((made(queries) - bumps(queries)) ** 2)))
    # Spacing halves: the third power of it, or better, against the second of linear interpolation.
    assert errors[0] / errors[1] > 6 and errors[1] / errors[2] > 6


def test_too_few_sweeps_are_told() -> None:
    points = datasets.uniform(200)
    with pytest.warns(GradientWarning, match="1 iterations"):
        CloughTocher(points, bumps(points), tol=1e-14, max_iter=1)((0.5, 0.5))


@pytest.mark.deep
def test_agrees_with_scipy() -> None:
    interpolate = pytest.importorskip("scipy.interpolate")
    points = datasets.uniform(500, seed=12)
    queries = np.random.default_rng(13).random((1000, 2))
    theirs = interpolate.CloughTocher2DInterpolator(points, bumps(points))(queries)
    np.testing.assert_allclose(CloughTocher(points, bumps(points))(queries), theirs, atol=1e-9)


@pytest.mark.parametrize("kind", ["clough-tocher", "farin", "sibson1"])
def test_local_gradients_do_not_swing_between_tracks(kind: str) -> None:
    # Along almost straight tracks nothing tells how a quadric bends across them.
    rng = np.random.default_rng(14)
    tracks = [
        np.column_stack((rng.random(100), row + 1e-6 * rng.normal(size=100))) for row in range(2)
    ]
    points = np.concatenate(tracks)
    values = np.sin(4 * points[:, 0]) + 0.01 * rng.random(200)
    found = interpolator(points, values, kind, gradients="local")(0.1 + 0.8 * rng.random((500, 2)))
    assert np.abs(found).max() < 2


@pytest.mark.parametrize("tol", ["a", "1", True, None])
def test_a_tolerance_that_is_no_number(tol: Any) -> None:
    with pytest.raises(DtypeError, match="tol must be a real number"):
        CloughTocher([(0, 0), (1, 0), (0, 1)], tol=tol)


@pytest.mark.parametrize("k", [-600, -100, -20, 20, 100, 600])
@pytest.mark.parametrize("kind", ["clough-tocher", "sibson1", "farin"])
def test_units_change_nothing_in_global_gradients(kind: str, k: int) -> None:
    # An absolute tolerance ended the sweeps after the first one where slopes were small.
    mesh = datasets.uniform(200, seed=15)
    queries = np.random.default_rng(16).random((100, 2))
    plain = interpolator(mesh, bumps(mesh), kind, gradients="global")
    value, slopes = plain(queries), plain.site_gradients()
    longer = interpolator(mesh * 2.0**k, bumps(mesh), kind, gradients="global")
    higher = interpolator(mesh, bumps(mesh) * 2.0**k, kind, gradients="global")
    assert np.array_equal(longer.site_gradients(), slopes / 2.0**k)
    assert np.array_equal(higher.site_gradients(), slopes * 2.0**k)
    np.testing.assert_allclose(longer(queries * 2.0**k), value, rtol=1e-12)
    np.testing.assert_allclose(higher(queries) / 2.0**k, value, rtol=1e-12)


@pytest.mark.parametrize("unit", [1.0, 1e4, 1e7])
def test_the_tolerance_holds_in_any_unit(unit: float) -> None:
    points = np.random.default_rng(0).random((300, 2))
    queries = 0.1 + 0.8 * np.random.default_rng(1).random((300, 2))
    exact = CloughTocher(points, bumps(points), tol=1e-14)(queries)
    assert np.abs(CloughTocher(points * unit, bumps(points))(queries * unit) - exact).max() < 1e-6


def test_values_without_a_slope_need_one_sweep() -> None:
    points = datasets.uniform(50, seed=17)
    made = CloughTocher(points, np.full((50, 2), [3.0, 0.0]), max_iter=1)
    assert not made.site_gradients().any()


def test_the_interface_of_scipy_keeps_its_tolerance() -> None:
    interpolate = pytest.importorskip("scipy.interpolate")
    points = datasets.uniform(300, seed=12)
    queries = 1e6 * (0.1 + 0.8 * np.random.default_rng(13).random((300, 2)))
    sites, values = points * 1e6, bumps(points)
    theirs = interpolate.CloughTocher2DInterpolator(sites, values)(queries)
    ours = CloughTocher2DInterpolator(sites, values)(queries)
    np.testing.assert_allclose(ours, theirs, atol=1e-9)
    assert np.abs(ours - CloughTocher(sites, values)(queries)).max() > 1e-5
