"""Queries outside the hull by a rounding: the distance that counts as inside, exactly."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, Delaunay, Dynamic, datasets
from delone.errors import InputError
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor, Nearest, grid

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

METHODS: list[tuple[Any, dict[str, str]]] = [
    (Linear, {}),
    (CloughTocher, {"gradients": "local"}),
    (NaturalNeighbor, {"kind": "sibson"}),
    (NaturalNeighbor, {"kind": "farin"}),
]


def plane(at: Floats) -> Floats:
    found: Floats = at @ np.arange(2.0, 2.0 + at.shape[-1]) + 1.0
    return found


def on_the_hull(mesh: Delaunay, count: int = 1) -> Floats:
    shares = np.random.default_rng(0).dirichlet(np.ones(mesh.ndim), (count, len(mesh.convex_hull)))
    found: Floats = np.einsum("ckj,kjd->ckd", shares, mesh.points[mesh.convex_hull])
    return found.reshape(-1, mesh.ndim)


@pytest.mark.parametrize("extrapolate", ["nan", "raise", "nearest", "linear"])
@pytest.mark.parametrize(("method", "options"), METHODS)
def test_places_on_sides_have_values(
    method: Any, options: dict[str, str], extrapolate: str
) -> None:
    mesh = Delaunay(datasets.uniform(60, seed=3))
    places = on_the_hull(mesh, 5)
    assert np.isnan(method(mesh, plane(mesh.points), **options)(places)).mean() > 0.2
    made = method(mesh, plane(mesh.points), extrapolate=extrapolate, tolerance=1e-14, **options)
    np.testing.assert_allclose(made(places), plane(places), atol=1e-12)
    table = made.weights_at(places)
    np.testing.assert_allclose(table.apply(plane(mesh.points)), plane(places), atol=1e-12)
    np.testing.assert_allclose(made.gradient(places), np.tile((2.0, 3.0), (len(places), 1)), 1e-6)


def test_faces_in_space_have_values() -> None:
    mesh = Delaunay(datasets.uniform(60, ndim=3, seed=3))
    places = on_the_hull(mesh)
    made = Linear(mesh, plane(mesh.points), tolerance=1e-14)
    assert np.isnan(Linear(mesh, plane(mesh.points))(places)).any()
    np.testing.assert_allclose(made(places), plane(places), atol=1e-12)
    np.testing.assert_allclose(made.gradient(places), np.tile((2.0, 3, 4), (len(places), 1)))
    laplace = NaturalNeighbor(mesh, plane(mesh.points), kind="laplace", tolerance=1e-14)
    np.testing.assert_allclose(laplace(places), plane(places), atol=1e-12)


@pytest.mark.parametrize(("method", "options"), [*METHODS, (Nearest, {"extrapolate": "nan"})])
def test_the_distance_is_compared_exactly(method: Any, options: dict[str, str]) -> None:
    triangle = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)]
    # 3 beyond a side, 5 beyond a corner: the nearest points are (1, 0) and (0, 0).
    for query, distance, nearest in (((1.0, -3.0), 3.0, (1.0, 0.0)), ((-3.0, -4.0), 5.0, (0, 0))):
        values = plane(np.array(triangle))
        made = method(triangle, values, tolerance=distance, **options)
        wanted = plane(np.array(nearest)) if method is not Nearest else 1.0
        assert made(query) == pytest.approx(wanted, rel=1e-14)
        less = method(triangle, values, tolerance=np.nextafter(distance, 0), **options)
        assert np.isnan(less(query)) and np.isnan(less.gradient(query)).all()
        refuses = options | {"extrapolate": "raise"}
        assert method(triangle, values, tolerance=distance, **refuses)(query) == made(query)
        with pytest.raises(InputError, match="1 of 1 query is outside the hull: row 0"):
            method(triangle, values, tolerance=np.nextafter(distance, 0), **refuses)(query)


def test_rasters_reach_their_last_row() -> None:
    corners = np.array([(0.0, 0.0), (3.0, 1.0), (2.0, 4.0), (-1.0, 3.0)])
    # Nodes on the two sides that go up to the right.
    x, y = np.linspace(0.0, 3.0, 31), np.linspace(0.0, 1.0, 31)
    exact = grid(corners, plane(corners), x=x, y=y)
    near = grid(corners, plane(corners), x=x, y=y, tolerance=1e-15)
    on_the_side = np.diagonal(near.values)
    assert np.isnan(np.diagonal(exact.values)).any()
    np.testing.assert_allclose(on_the_side, plane(np.column_stack((x, y))), rtol=1e-14)
    with pytest.raises(InputError, match="tolerance must be at least 0, got -1"):
        grid(corners, plane(corners), x=x, y=y, tolerance=-1)


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("kind", [Delaunay, Dynamic])
def test_places_are_those_of_the_nearest_points(kind: Any, ndim: int) -> None:
    points = datasets.uniform(60, ndim=ndim, seed=3)
    mesh = kind(points)
    queries = np.random.default_rng(1).uniform(-1, 2, (300, ndim))
    exact = mesh.locate(queries)
    away = np.linalg.norm(queries - exact.closest, axis=1)
    found = mesh.locate(queries, tolerance=0.25)
    assert np.array_equal(found.simplex >= 0, away <= 0.25)
    moved = (exact.simplex < 0) & (away <= 0.25)
    assert 10 < moved.sum() < 290
    assert np.array_equal(found.simplex[moved], exact.beside[moved])
    corners = mesh.points[mesh.simplices[found.simplex[moved]]]
    places = np.einsum("kj,kjd->kd", found.barycentric[moved], corners)
    np.testing.assert_allclose(places, exact.closest[moved], atol=1e-14)
    assert np.array_equal(found.closest, exact.closest)
    assert (found.beside[moved] == -1).all() and (found.facet[moved] == -1).all()
    assert np.isnan(found.weights[moved]).all()
    rest = ~moved
    for name in ("simplex", "barycentric", "beside", "facet", "weights"):
        assert np.array_equal(
            getattr(found, name)[rest], getattr(exact, name)[rest], equal_nan=True
        )
    assert np.array_equal(mesh.find_simplex(queries, tolerance=0.25), found.simplex)


def test_holes_have_sides_as_well() -> None:
    points = [(0, 0), (6, 0), (0, 6), (1, 1), (2, 1), (1, 2)]
    mesh = ConstrainedDelaunay(points, [(3, 4), (4, 5), (5, 3)], holes=[(1.2, 1.2)])
    values = plane(mesh.points)
    for method in (Linear, CloughTocher):
        made = method(mesh, values, tolerance=0.125)
        assert made((1.5, 1.125)) == pytest.approx(plane(np.array((1.5, 1.0))))
        assert np.isnan(made((1.25, 1.25)))
    nearest = Nearest(mesh, values, extrapolate="nan", respect_constraints=True, tolerance=0.125)
    assert nearest((1.25, 1.125)) == values[3] and np.isnan(nearest((1.25, 1.25)))
