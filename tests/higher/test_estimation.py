"""Estimates of triangulations from samples."""

from __future__ import annotations

import numpy as np
import pytest

import delone
from delone import Delaunay, estimate


@pytest.mark.parametrize(("d", "n"), [(2, 20_000), (3, 5_000), (4, 3_000), (5, 900)])
def test_numbers_of_simplices_are_predicted(d: int, n: int) -> None:
    random = np.random.default_rng(d)
    for points in (random.random((n, d)), random.normal(size=(n, d))):
        cost, mesh = estimate(points), Delaunay(points)
        assert cost.simplices == pytest.approx(mesh.nsimplex, rel=0.2)
        held = mesh.points.nbytes + mesh.simplices.nbytes + mesh.neighbors.nbytes
        assert cost.nbytes == pytest.approx(held, rel=0.2)
        assert cost.peak > cost.nbytes
        assert cost.seconds > 0
        assert (cost.npoints, cost.ndim) == (n, d)


def test_few_points_are_counted() -> None:
    points = np.random.default_rng(0).random((30, 4))
    assert estimate(points).simplices == Delaunay(points).nsimplex
    assert estimate(np.vstack((np.zeros(4), np.eye(4)))).simplices == 1


def test_samples_that_span_nothing_grow() -> None:
    points = np.zeros((2000, 4))
    points[:, 0] = np.arange(2000)
    points[-30:] = np.random.default_rng(0).random((30, 4)) * 2000
    cost = estimate(points)
    assert 0.2 < cost.simplices / Delaunay(points).nsimplex < 5
    points[:, 1] = 1.0
    with pytest.raises(delone.DegenerateInputError):
        estimate(points)


def test_it_reads_as_a_sentence() -> None:
    cost = delone.Estimate(
        npoints=20_000, ndim=4, simplices=600_000, nbytes=48_640_000, peak=2 * 10**9, seconds=1.25
    )
    assert str(cost) == "20,000 points in 4-D: about 600,000 simplices, 48 MB (2 GB at most), 1.2 s"
    assert np.isfinite(estimate(np.random.default_rng(0).random((100, 3))).seconds)


def test_bad_points() -> None:
    with pytest.raises(delone.ShapeError):
        estimate(np.ones((20, 9)))
    with pytest.raises(delone.NonFiniteError):
        estimate(np.full((20, 4), np.nan))
