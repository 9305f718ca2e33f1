"""More queries and more sites than one task of any loop takes.

Queries come in any order, which are sorted along a curve first, and in rows, which are not. A
linear field is what every method gives back, and a walk that ended in another triangle does not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, datasets
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor, Nearest, cross_validate
from delone.predicates import orient2d, orient3d

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

COUNT = 60_000


def queries(order: str, ndim: int) -> Floats:
    """Points of the unit square or cube and a little beyond; some are not finite."""
    if order == "any":
        found = np.random.default_rng(3).random((COUNT, ndim)) * 1.1 - 0.05
    else:
        side = round(COUNT ** (1 / ndim))
        axes = np.meshgrid(*[np.linspace(-0.05, 1.05, side)] * ndim, indexing="ij")
        found = np.stack(axes, axis=-1).reshape(-1, ndim)
    found[::1001] = np.nan
    return found


def surrounded(ndim: int, count: int, seed: int) -> Floats:
    """Points whose hull is the unit square or cube."""
    corners = np.stack(np.meshgrid(*[[0.0, 1.0]] * ndim), axis=-1).reshape(-1, ndim)
    return np.concatenate([corners, datasets.uniform(count, seed=seed, ndim=ndim)])


def in_the_box(places: Floats) -> NDArray[np.bool_]:
    found: NDArray[np.bool_] = ((places >= 0) & (places <= 1)).all(axis=1)
    return found


@pytest.mark.parametrize("order", ["any", "rows"])
@pytest.mark.parametrize("ndim", [2, 3])
def test_simplices_hold_their_queries(ndim: int, order: str) -> None:
    points = surrounded(ndim, 3000, ndim)
    asked = queries(order, ndim)
    for workers in (1, 3):
        mesh = Delaunay(points, workers=workers)
        found = mesh.find_simplex(asked)
        inside = found >= 0
        assert np.array_equal(inside, in_the_box(asked))
        corners = [points[mesh.simplices[found[inside], k]] for k in range(ndim + 1)]
        for k in range(ndim + 1):
            moved = [asked[inside] if j == k else corner for j, corner in enumerate(corners)]
            turns = orient2d(*moved) if ndim == 2 else orient3d(*moved)
            assert (turns >= 0).all()


@pytest.mark.parametrize("order", ["any", "rows"])
@pytest.mark.parametrize("ndim", [2, 3])
def test_nearest_vertices(ndim: int, order: str) -> None:
    points = surrounded(ndim, 200, ndim)
    asked = queries(order, ndim)
    finite = np.isfinite(asked).all(axis=1)
    right = np.full(len(asked), -1)
    squares = np.zeros((finite.sum(), len(points)))
    for k in range(ndim):
        squares += (asked[finite, k, None] - points[:, k]) ** 2
    right[finite] = squares.argmin(axis=1)
    for workers in (1, 3):
        assert np.array_equal(Delaunay(points, workers=workers).nearest(asked), right)


def field(places: Floats) -> Floats:
    found: Floats = 2 + places @ np.arange(3, 3 + places.shape[1])
    return found


@pytest.mark.parametrize("order", ["any", "rows"])
@pytest.mark.parametrize(
    ("kind", "options"),
    [
        (Linear, {}),
        (CloughTocher, {"gradients": "local"}),
        (NaturalNeighbor, {}),
        (NaturalNeighbor, {"kind": "laplace"}),
    ],
)
@pytest.mark.sampled(3)
def test_linear_fields_come_back(kind: Any, options: dict[str, str], order: str) -> None:
    points = surrounded(2, 2000, 5)
    asked = queries(order, 2)
    right = np.where(in_the_box(asked), field(asked), np.nan)
    for workers in (1, 3):
        made = kind(points, field(points), workers=workers, **options)
        np.testing.assert_allclose(made(asked), right, rtol=1e-9)
        np.testing.assert_allclose(made.weights_at(asked).apply(field(points)), right, rtol=1e-9)


@pytest.mark.parametrize(
    ("kind", "options"), [(Linear, {}), (Nearest, {}), (NaturalNeighbor, {"kind": "laplace"})]
)
def test_fields_of_space_come_back(kind: Any, options: dict[str, str]) -> None:
    points = surrounded(3, 500, 6)
    asked = queries("any", 3)
    made = kind(points, field(points), workers=3, **options)
    found = made(asked)
    if kind is Nearest:
        there = np.isfinite(asked).all(axis=1)
        right = field(points[Delaunay(points).nearest(asked[there])])
    else:
        there = in_the_box(asked)
        right = field(asked[there])
    np.testing.assert_allclose(found[there], right, rtol=1e-9)


def test_gradients_of_many_sites() -> None:
    """Of a parabola, whose gradients differ from site to site and are found exactly."""
    points = datasets.uniform(10_000, seed=7)
    x, y = points.T
    for workers in (1, 3):
        made = CloughTocher(points, x * x + x * y + 3 * y * y, gradients="local", workers=workers)
        found = made.site_gradients()
        np.testing.assert_allclose(found, np.stack([2 * x + y, x + 6 * y], axis=1), atol=1e-7)


@pytest.mark.parametrize("method", ["linear", "sibson", "laplace"])
def test_many_sites_left_out(method: str) -> None:
    """A linear field comes back at each site but those of the hull."""
    points = surrounded(2, 4000, 8)
    for workers in (1, 3):
        report = cross_validate(points, field(points), method, leave_one_out=True, workers=workers)
        inner = np.setdiff1d(np.arange(len(points)), Delaunay(points).hull)
        np.testing.assert_allclose(report.residuals[inner], 0, atol=1e-9)
