"""Cross-validation against triangulations of what is left."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import datasets
from delone.errors import DtypeError, InputError, NonFiniteError, ShapeError
from delone.interpolate import cross_validate, grid, interpolator
from delone.interpolate.methods import METHODS


def field(points: Any) -> Any:
    return np.sin(4 * points[:, 0]) + points[:, 1] ** 2


def one_by_one(points: Any, values: Any, method: str, **options: Any) -> Any:
    rows = np.arange(len(points))
    return np.array(
        [
            interpolator(points[rows != i], values[rows != i], method, **options)(points[i])
            for i in rows
        ]
    )


@pytest.mark.parametrize("name", ["uniform", "grid", "integer_lattice"])
@pytest.mark.parametrize("method", ["linear", "nearest", "sibson", "laplace"])
def test_leave_one_out_from_stars(method: str, name: str) -> None:
    options = {"side": 12} if name == "integer_lattice" else {}
    points = np.unique(datasets.GENERATORS[name](81, seed=2, **options), axis=0)
    points = np.random.default_rng(3).permutation(points)
    values = field(points)
    found = cross_validate(points, values, method)
    expected = one_by_one(points, values, method)
    np.testing.assert_allclose(found.predicted, expected, rtol=1e-10, atol=1e-12)
    known = np.isfinite(expected)
    assert found.count == known.sum()
    np.testing.assert_allclose(found.residuals[known], (values - expected)[known], atol=1e-11)
    assert found.rmse == pytest.approx(np.sqrt(np.mean((values - expected)[known] ** 2)))
    assert found.mae == pytest.approx(np.mean(np.abs(values - expected)[known]))


@pytest.mark.parametrize("count", [20, 60])
def test_around_the_centre_of_a_circle(count: int) -> None:
    # Its hole is a polygon of points on one circle: which triangle has it is a tie.
    circle = datasets.pythagorean_circle(count)
    size = np.abs(circle).max()
    beyond = 2.0 * size * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    points = np.concatenate((circle, [(0.0, 0.0), (0.25 * size, 0.125 * size)], beyond))
    for centre in (count, count + 1):
        some = np.delete(points, 2 * count + 1 - centre, axis=0)
        values = np.random.default_rng(4).normal(size=len(some))
        for method in ("linear", "nearest", "sibson", "laplace"):
            found = cross_validate(some, values, method).predicted
            np.testing.assert_allclose(found, one_by_one(some, values, method), atol=1e-11)


@pytest.mark.parametrize("method", ["clough-tocher", "sibson1", "farin"])
def test_leave_one_out_in_batches(method: str) -> None:
    points = datasets.uniform(250, seed=3)
    values = field(points)
    found = cross_validate(points, values, method, gradients="local")
    expected = one_by_one(points, values, method, gradients="local")
    np.testing.assert_allclose(found.predicted, expected, rtol=1e-9, atol=1e-11)


def test_global_gradients_in_batches() -> None:
    points = datasets.uniform(700, seed=4)
    found = cross_validate(points, field(points), "clough-tocher", tol=1e-10)
    some = np.arange(0, 700, 23)
    rows = np.arange(700)
    for i in some:
        rest = rows != i
        made = interpolator(points[rest], field(points)[rest], "clough-tocher", tol=1e-10)
        np.testing.assert_allclose(found.predicted[i], made(points[i]), atol=1e-6)


@pytest.mark.parametrize("method", sorted(METHODS))
def test_folds(method: str) -> None:
    points = datasets.uniform(60, seed=5)
    values = np.column_stack((field(points), points[:, 0]))
    found = cross_validate(points, values, method, folds=4, seed=6)
    dealt = np.random.default_rng(6).permutation(60)
    for start in range(4):
        out = np.sort(dealt[start::4])
        rest = np.setdiff1d(np.arange(60), out)
        made = interpolator(points[rest], values[rest], method)
        np.testing.assert_allclose(found.predicted[out], made(points[out]), rtol=1e-12, atol=1e-12)
    assert found.rmse.shape == found.mae.shape == (2,)
    again = cross_validate(points, values, method, folds=4, seed=6)
    np.testing.assert_array_equal(again.predicted, found.predicted)


def test_other_predictors_and_options() -> None:
    points = datasets.uniform(30, seed=7)
    values = field(points)

    def mean(_: Any, known: Any) -> Any:
        return lambda queries: np.full(len(queries), known.mean())

    found = cross_validate(points, values, mean)
    expected = (values.sum() - values) / 29
    np.testing.assert_allclose(found.predicted, expected)
    assert "mean" in repr(found)
    near = cross_validate(points, values, "linear", extrapolate="nearest")
    assert near.count == 30
    np.testing.assert_allclose(
        near.predicted, one_by_one(points, values, "linear", extrapolate="nearest")
    )


def test_duplicates_are_left_out_together() -> None:
    points = datasets.uniform(50, seed=8)
    twice = np.concatenate((points, points[:5]))
    values = np.concatenate((field(points), field(points)[:5] + 1))
    with pytest.raises(InputError, match="a different value"):
        cross_validate(twice, values)
    found = cross_validate(twice, values, duplicates="mean")
    np.testing.assert_array_equal(found.predicted[50:], found.predicted[:5])
    known = np.isfinite(found.predicted[:5])
    np.testing.assert_allclose((found.residuals[50:] - found.residuals[:5])[known], 1.0)


def test_nan_among_values() -> None:
    points = datasets.uniform(50, seed=9)
    values = field(points)
    values[7] = np.nan
    with pytest.raises(NonFiniteError, match="first: 7"):
        cross_validate(points, values)
    found = cross_validate(points, values, nan="drop")
    assert np.isnan(found.predicted[7])
    rest = np.delete(np.arange(50), 7)
    np.testing.assert_array_equal(
        found.predicted[rest], cross_validate(points[rest], values[rest]).predicted
    )


@pytest.mark.parametrize(
    "options",
    [
        {"folds": 1},
        {"folds": 31},
        {"folds": 2, "leave_one_out": True},
        {"leave_one_out": False},
        {"nan": "propagate"},
        {"interpolator": "kriging"},
    ],
)
def test_bad_arguments(options: dict[str, Any]) -> None:
    points = datasets.uniform(30)
    with pytest.raises(InputError):
        cross_validate(points, field(points), **options)


def test_progress_is_told() -> None:
    points = datasets.uniform(100)
    told: list[float] = []
    cross_validate(points, field(points), "farin", progress=told.append)
    assert told == sorted(told) and told[-1] == 1.0


@pytest.mark.parametrize("method", sorted(METHODS))
def test_a_site_without_which_there_is_no_area(method: str) -> None:
    points = np.array([(0, 0), (1, 0), (2, 0), (3, 0), (1, 1)])
    found = cross_validate(points, np.arange(5.0), method)
    if method != "nearest":
        np.testing.assert_allclose(found.predicted, [np.nan, 1, 2, np.nan, np.nan], atol=1e-5)
    # Those who are left out together are so only to save time.
    found = cross_validate(
        np.append(points, [(2, 1.5)], axis=0), np.arange(6.0), method, nan="drop"
    )
    assert found.predicted.shape == (6,)
    assert np.isnan(cross_validate(points, np.arange(5.0), method, folds=2).predicted).any()


@pytest.mark.parametrize("method", ["linear", "nearest", "sibson1", "clough-tocher"])
@pytest.mark.parametrize("name", ["foo", "kind"])
def test_options_that_a_method_does_not_have(method: str, name: str) -> None:
    points = datasets.uniform(20)
    calls: tuple[Any, ...] = (
        lambda **options: cross_validate(points, points[:, 0], method, **options),
        lambda **options: grid(points, points[:, 0], shape=(2, 2), method=method, **options),
        lambda **options: interpolator(points, points[:, 0], method, **options),
    )
    wanted = rf"{name} is not an option of '{method}'; its options are .*extrapolate"
    for call in calls:
        with pytest.raises(InputError, match=wanted):
            call(**{name: "laplace"})


@pytest.mark.parametrize(("seed", "kind"), [("a", DtypeError), (-1, InputError), (1.5, DtypeError)])
def test_a_seed_that_is_none(seed: Any, kind: type[Exception]) -> None:
    points = datasets.uniform(20)
    with pytest.raises(kind, match="seed must be"):
        cross_validate(points, points[:, 0], folds=2, seed=seed)


def test_a_predictor_that_returns_too_few() -> None:
    points = datasets.uniform(20)
    with pytest.raises(ShapeError, match="the result of the interpolator must have shape"):
        cross_validate(points, points[:, 0], lambda *_: lambda xi: xi[:0, 0], folds=2)
