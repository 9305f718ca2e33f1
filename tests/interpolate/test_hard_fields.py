"""Linear and quadratic functions on sites that nearly coincide, lie on a line, or have hubs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import Delaunay
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor

SLOPE = np.array((1.0, -2.0))


def inside(points: Any) -> Any:
    mesh = Delaunay(points)
    shares = np.random.default_rng(0).dirichlet((1, 1, 1), (mesh.nsimplex, 50))
    queries = np.einsum("tqc,tcd->tqd", shares, mesh.points[mesh.simplices]).reshape(-1, 2)
    return queries[mesh.find_simplex(queries) >= 0]


def error(made: Any, points: Any) -> float:
    queries = inside(points)
    return float(np.abs(made(queries) - queries @ SLOPE).max())


@pytest.mark.parametrize("gradients", ["local", "plane"])
@pytest.mark.parametrize("kind", ["farin", "sibson1"])
@pytest.mark.parametrize("gap", [1e-15, 1e-12, 1e-9, 1e-6])
def test_natural_neighbours_with_gradients_beside_twins(
    gap: float, kind: str, gradients: str
) -> None:
    rng = np.random.default_rng(1)
    points = rng.random((60, 2))
    points = np.vstack((points, points[:20] + gap * rng.normal(size=(20, 2))))
    made = NaturalNeighbor(points, points @ SLOPE, kind=kind, gradients=gradients)
    assert error(made, points) < 1e-11


@pytest.mark.parametrize("gradients", ["local", "plane"])
@pytest.mark.parametrize("gap", [1e-15, 1e-12, 1e-9, 1e-6])
def test_clough_tocher_beside_twins(gap: float, gradients: str) -> None:
    rng = np.random.default_rng(1)
    points = rng.random((60, 2))
    points = np.vstack((points, points[:20] + gap * rng.normal(size=(20, 2))))
    made = CloughTocher(points, points @ SLOPE, gradients=gradients)
    assert error(made, points) < 1e-10


@pytest.mark.parametrize("height", [1e-3, 1e-6, 1e-12, 1e-17, 1e-155, 1e-160, 1e-170, 5e-324])
def test_on_a_line_with_a_step(height: float) -> None:
    points = np.array([(0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (2, height), (2, 1)])
    values = points @ SLOPE
    for gradients in ("local", "plane"):
        assert error(CloughTocher(points, values, gradients=gradients), points) < 1e-12
        for kind in ("farin", "sibson1"):
            made = NaturalNeighbor(points, values, kind=kind, gradients=gradients)
            assert error(made, points) < 1e-12


def test_quadratic_functions_around_a_hub() -> None:
    rng = np.random.default_rng(2)
    turn = np.arange(3000) * (2 * np.pi / 3000)
    ring = np.column_stack((np.cos(turn), np.sin(turn))) * (1 + 1e-9 * rng.random((3000, 1)))
    points = np.vstack((ring, [(0, 0)]))
    made = CloughTocher(points, points[:, 0] * points[:, 1], gradients="local")
    queries = rng.uniform(-0.6, 0.6, (300, 2))
    np.testing.assert_allclose(made(queries), queries[:, 0] * queries[:, 1], atol=1e-10)


def test_gradients_at_a_hub_do_not_depend_on_the_order_of_rows() -> None:
    rng = np.random.default_rng(3)
    turn = np.sort(rng.random(200)) * 2 * np.pi
    points = np.vstack(([(0, 0)], np.column_stack((np.cos(turn), np.sin(turn)))))
    values = np.sin(3 * points[:, 0]) * points[:, 1]
    order = rng.permutation(len(points))
    found = CloughTocher(points, values, gradients="local").site_gradients()
    again = CloughTocher(points[order], values[order], gradients="local").site_gradients()
    np.testing.assert_allclose(again, found[order], rtol=1e-9, atol=1e-9)


def test_on_the_edge_of_a_triangle_as_thin_as_doubles_are() -> None:
    points = [(0, 0), (1, 0), (0.5, 5e-324)]
    values = [0.0, 1.0, 0.5]
    assert Linear(points, values)((0.75, 0)) == 0.75
    found = Delaunay(points).locate((0.75, 0))
    corner = found.barycentric[Delaunay(points).simplices[found.simplex].tolist().index(1)]
    assert corner == 0.75
    for kind in ("sibson", "laplace"):
        assert NaturalNeighbor(points, values, kind=kind)((0.75, 0)) == 0.75
    assert CloughTocher(points, values)((0.75, 0)) == pytest.approx(0.75, abs=1e-6)


def test_in_a_triangle_of_subnormals() -> None:
    tiny = 5e-324
    points = [(0, 0), (3 * tiny, 0), (0, 3 * tiny)]
    assert Linear(points, [0.0, 3.0, 6.0])((tiny, tiny)) == pytest.approx(3, rel=1e-15)


@pytest.mark.parametrize("extrapolate", ["nearest", "linear"])
@pytest.mark.parametrize("method", ["farin", "sibson1", "clough-tocher"])
def test_beyond_the_corners_of_the_largest_square(method: str, extrapolate: str) -> None:
    far = 1.5e308
    points = [(-far, -far), (far, -far), (far, far), (-far, far)]
    values = [1.0, 2.0, 3.0, 4.0]
    made: Any
    if method == "clough-tocher":
        made = CloughTocher(points, values, extrapolate=extrapolate)
    else:
        made = NaturalNeighbor(points, values, kind=method, extrapolate=extrapolate)
    found = made([(1.1 * far, 0), (0, -1.1 * far), (1.1 * far, 1.1 * far)])
    np.testing.assert_allclose(found, [2.5, 1.5, 3.0], atol=0.3)


@pytest.mark.parametrize("kind", ["sibson", "laplace", "sibson1", "farin"])
def test_inside_there_is_a_value_where_magnitudes_are_mixed(kind: Any) -> None:
    """Squares of distances to one site are beyond the range; its tangent plane was NaN."""
    for points, query in (
        ([(1, 1), (0, 0), (1e-300, 0), (0, 1e300)], (0.5, 0.5)),
        ([(1e-300, 1e-300), (0, 1e300), (0, 1e-300), (0, 0)], (5e-301, 1e-300)),
    ):
        field = NaturalNeighbor(points, [2.0] * 4, kind=kind)
        assert field(query) == pytest.approx(2, rel=1e-15)
