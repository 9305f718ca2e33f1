"""Whatever the core finds broken comes out as an exception that `except Exception` catches.

A locator checks its arrays once, and nobody may change them later. Who does so makes the core panic
wherever it looks: in calls with few queries, which keep the interpreter lock, and with many.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, Delaunay, _core, datasets
from delone.errors import InternalError
from delone.interpolate import Linear, NaturalNeighbor, Nearest, interpolator
from delone.interpolate.methods import METHODS

if TYPE_CHECKING:
    from collections.abc import Callable

FEW, MANY = 1, 50


def broken(ndim: int) -> tuple[Any, Any]:
    """A locator of simplices whose vertices are no points any more, and its points."""
    mesh = Delaunay(datasets.uniform(40, ndim=ndim))
    simplices = mesh.simplices.copy()
    kind = {2: _core.Locator2, 3: _core.Locator3}[ndim]
    index = kind(mesh.points, simplices, mesh.neighbors)
    simplices[:] = 1 << 20
    return index, mesh.points


def doors(index: Any, points: Any, queries: Any) -> list[Callable[[], Any]]:
    """Calls of every method of a locator."""
    values, slopes = points[:, :1].copy(), np.zeros((len(points), 1, points.shape[1]))
    calls: list[Callable[[], Any]] = [
        lambda: index.find(queries, 1),
        lambda: index.locate(queries, 1),
        lambda: index.nearest(queries, 1),
    ]
    if points.shape[1] == 3:
        return [*calls, lambda: index.laplace(queries, 1)]
    calls += [
        lambda: index.along(queries[0], queries[-1]),
        lambda: index.clough_tocher_weights(queries, None, 1),
        *(lambda o=o: index.linear(values, queries, o, 1) for o in (0, 1)),
        *(lambda o=o: index.clough_tocher(values, slopes, queries, None, o, 1) for o in range(3)),
    ]
    for kind in ("sibson", "laplace", "sibson1", "farin"):
        calls += [
            lambda k=kind: index.natural(k, queries, None, 1),
            lambda k=kind: index.natural_values(k, values, slopes, queries, None, 0, 1),
        ]
    return calls + [lambda k=k: index.leave_one_out(k, 1) for k in ("linear", "sibson")]


@pytest.mark.parametrize("count", [FEW, MANY])
@pytest.mark.parametrize("ndim", [2, 3])
def test_no_door_lets_a_panic_through(ndim: int, count: int) -> None:
    index, points = broken(ndim)
    queries = np.random.default_rng(count).random((count, ndim))
    for call in doors(index, points, queries):
        with pytest.raises(InternalError):
            call()


def nothing_left() -> ConstrainedDelaunay:
    """A square with a hole in each half."""
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    return ConstrainedDelaunay(square, [(0, 2)], holes=[(3, 1), (1, 3)])


@pytest.mark.parametrize("count", [FEW, MANY])
@pytest.mark.parametrize("method", sorted(METHODS))
def test_without_a_triangle_everything_is_outside(method: str, count: int) -> None:
    mesh = nothing_left()
    assert mesh.nsimplex == 0
    queries = np.ones((count, 2))
    values = np.arange(4.0)
    made = interpolator(mesh, values, method, respect_constraints=True)
    assert np.isnan(made(queries)).all()
    assert np.isnan(made.gradient(queries)).all()
    table = made.weights_at(queries)
    assert np.isnan(table @ values).all()


def test_outside_of_nothing_is_refused_where_that_is_asked() -> None:
    mesh = nothing_left()
    for kind in (Linear, NaturalNeighbor, Nearest):
        with pytest.raises(ValueError, match="1 of 1 query is outside"):
            made = kind(mesh, np.zeros(4), extrapolate="raise", respect_constraints=True)
            made([(1, 1)])


@pytest.mark.parametrize("count", [FEW, MANY])
@pytest.mark.parametrize("method", sorted(METHODS))
def test_infinity_is_outside_and_nan_is_nowhere(method: str, count: int) -> None:
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    made = interpolator(square, np.zeros(4), method, extrapolate="raise")
    queries = np.ones((count, 2))
    assert (made(queries) == 0).all()
    for far in (np.inf, -np.inf):
        queries[0] = (1, far)
        for call in (made, made.gradient, made.weights_at):
            with pytest.raises(ValueError, match=f"1 of {count} (query|queries) is outside"):
                call(queries)
    queries[0] = (np.nan, np.inf)
    assert np.isnan(made(queries)[0])
    assert np.isnan(made.gradient(queries)[0]).all()
