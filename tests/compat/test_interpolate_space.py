"""SciPy's interpolators in space, beside SciPy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import Delaunay
from delone.compat.scipy import (
    CloughTocher2DInterpolator,
    DimensionError,
    LinearNDInterpolator,
    NearestNDInterpolator,
    QhullError,
    griddata,
)

peer = pytest.importorskip("scipy.interpolate")

POINTS = np.random.default_rng(0).random((60, 3)) * [1, 20, 0.3]
VALUES = np.random.default_rng(1).random((60, 2))
QUERIES = np.random.default_rng(2).random((40, 5, 3)) * [1, 20, 0.3]


@pytest.mark.parametrize("rescale", [False, True])
@pytest.mark.parametrize("name", ["LinearNDInterpolator", "NearestNDInterpolator"])
def test_values_are_those_of_scipy(name: str, rescale: bool) -> None:
    own: Any = {"L": LinearNDInterpolator, "N": NearestNDInterpolator}[name[0]]
    ours = own(POINTS, VALUES, rescale=rescale)
    theirs = getattr(peer, name)(POINTS, VALUES, rescale=rescale)
    assert ours(QUERIES) == pytest.approx(theirs(QUERIES), rel=1e-9, nan_ok=True)
    parts = tuple(np.moveaxis(QUERIES, -1, 0))
    assert ours(*parts) == pytest.approx(theirs(*parts), rel=1e-9, nan_ok=True)
    assert ours([0.5, 10, 0.1]).shape == theirs([0.5, 10, 0.1]).shape


@pytest.mark.parametrize("method", ["linear", "nearest"])
def test_griddata(method: str) -> None:
    ours = griddata(tuple(POINTS.T), VALUES[:, 0], QUERIES, method=method, fill_value=-7.0)
    theirs = peer.griddata(tuple(POINTS.T), VALUES[:, 0], QUERIES, method=method, fill_value=-7.0)
    assert ours == pytest.approx(theirs, rel=1e-9)


def test_triangulations_and_refusals() -> None:
    mesh = Delaunay(POINTS)
    made = LinearNDInterpolator(mesh, VALUES)
    assert made.tri is mesh
    assert made(POINTS).tobytes() == VALUES.tobytes()
    with pytest.raises(QhullError):
        LinearNDInterpolator(POINTS * [1, 1, 0], VALUES)
    with pytest.raises(ValueError, match="2-D"):
        CloughTocher2DInterpolator(POINTS, VALUES)
    with pytest.raises(ValueError, match="coordinates"):
        made(QUERIES[..., 0], QUERIES[..., 1])
    flat = NearestNDInterpolator(POINTS * [1, 1, 0], VALUES)
    theirs = peer.NearestNDInterpolator(POINTS * [1, 1, 0], VALUES)
    assert np.array_equal(flat(QUERIES), theirs(QUERIES))


def test_too_many_coordinates_are_named() -> None:
    for d in (3, 5, 9):
        points = np.random.default_rng(0).random((60, d))
        with pytest.raises(
            DimensionError, match=rf"CloughTocher2D\w+ interpolates 2-D .* {d} coord"
        ):
            griddata(points, points[:, 0], points[:1], method="cubic")
    with pytest.raises(DimensionError, match=r"Nearest\w+ interpolates points with up to 8 coord"):
        griddata(points, points[:, 0], points[:1], method="nearest")
    with pytest.raises(DimensionError, match="2-D points"):
        CloughTocher2DInterpolator(Delaunay(points[:, :3]), points[:, 0])


def test_without_a_site_there_is_no_value() -> None:
    for ndim in (2, 3):
        made = NearestNDInterpolator(np.empty((0, ndim)), np.empty(0))
        assert np.isnan(made(np.zeros((4, ndim)))).all()
