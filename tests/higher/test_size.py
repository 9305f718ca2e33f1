"""Predictions of size, and refusals before memory is spent."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

import delone
from delone import ConvexHull, Delaunay
from delone._tiling.higher import size

GIVEN = {2: 2.0, 3: 6.77, 4: 31.8, 5: 187, 6: 1296, 8: 90_425}


@pytest.mark.parametrize("d", GIVEN)
def test_simplices_of_uniform_points(d: int) -> None:
    assert size._per_point(d) == pytest.approx(GIVEN[d], rel=2e-3)


@pytest.mark.parametrize("d", [4, 5, 6])
def test_no_points_have_more_facets_than_cyclic_ones(d: int) -> None:
    curve = np.linspace(-1, 1, 15)
    points = curve[:, None] ** np.arange(1, d + 1)
    hull = ConvexHull(points)
    assert hull.nsimplex == size._cyclic(15, d)
    lower, _ = np.unique(Delaunay(points[:, :4]).simplices, axis=0, return_counts=True)
    assert len(lower) <= size._cyclic(15, 5)


@pytest.mark.parametrize("d", [4, 5, 6, 7, 8])
def test_few_points_are_too_few_and_not_too_large(d: int) -> None:
    for made in (Delaunay, ConvexHull):
        for n in (0, 1, d):
            with pytest.raises(delone.DegenerateInputError, match="too few"):
                made(np.eye(d)[:n])


@pytest.mark.parametrize(("d", "n"), [(4, 1500), (5, 400), (6, 150), (8, 110)])
@pytest.mark.parametrize("kind", ["uniform", "sphere"])
@pytest.mark.deep("uniform-8-110", "sphere-8-110")
def test_predictions(d: int, n: int, kind: str) -> None:
    points = np.random.default_rng(d).normal(size=(n, d))
    if kind == "sphere":
        points /= np.linalg.norm(points, axis=1)[:, None]
    hull = kind == "sphere" and d < 8
    found = size._extrapolated(points, hull=hull)
    whole = ConvexHull(points).nsimplex if hull else Delaunay(points).nsimplex
    assert found is not None
    # Samples of a hundred points say less.
    factor = 1.5 if d < 8 else 2
    assert whole / factor < found < whole * factor


@pytest.mark.slow("the samples have as many simplices as it takes to predict 8-D")
def test_too_large_is_said_soon() -> None:
    points = np.random.default_rng(0).random((100_000, 8))
    start = time.perf_counter()
    with pytest.raises(delone.TooLargeError, match=r"100,000 points in 8-D .* GB is free") as error:
        Delaunay(points)
    assert isinstance(error.value, MemoryError)
    assert error.value.nbytes > error.value.limit > 0
    assert error.value.simplices > 10**8
    points /= np.linalg.norm(points - 0.5, axis=1)[:, None]
    with pytest.raises(delone.TooLargeError, match=r"the hull of 100,000 points in 8-D .* facets"):
        ConvexHull(points - 0.5)
    # A budget of the test, far from what the work would take.
    assert time.perf_counter() - start < 60


def test_max_bytes() -> None:
    points = np.random.default_rng(0).random((250, 6))
    cost = delone.estimate(points)
    with pytest.raises(delone.TooLargeError, match="max_bytes is"):
        Delaunay(points, max_bytes=cost.peak // 4)
    mesh = Delaunay(points, max_bytes=cost.peak * 4)
    assert (mesh.simplices == Delaunay(points).simplices).all()
    # A hull of points inside is small, whatever points on a sphere would have.
    assert ConvexHull(np.vstack((points * 0.01, np.eye(6), -np.eye(6))), max_bytes=10**6).nsimplex
    with pytest.raises(delone.TooLargeError):
        ConvexHull(points, max_bytes=10**4)
    for bad in (0, -5, math.nan):
        with pytest.raises(delone.InputError, match="max_bytes must be above 0"):
            Delaunay(points, max_bytes=bad)
    with pytest.raises(delone.DtypeError):
        Delaunay(points, max_bytes="1 GB")
    for kind in (Delaunay, ConvexHull):
        with pytest.raises(delone.InputError, match="from 4-D on"):
            kind(points[:, :3], max_bytes=10**9)


def test_points_that_span_nothing_are_told_as_such(monkeypatch: pytest.MonkeyPatch) -> None:
    points = np.random.default_rng(0).random((4000, 5))
    points[:, 4] = 1
    monkeypatch.setattr(size, "free_memory", lambda: 10**6)
    with pytest.raises(delone.DegenerateInputError):
        Delaunay(points)
    monkeypatch.setattr(size, "free_memory", lambda: None)
    assert Delaunay(points[:60, :4]).nsimplex
