"""Surfaces that end at long edges, outside and inside."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.interpolate import Grid
from delone.terrain import TIN

if TYPE_CHECKING:
    from numpy.typing import NDArray


def survey(seed: int, turn: float = 0.0, shift: float = 0.0) -> NDArray[np.float64]:
    """Points on a grid of 20 by 20 with a lake, which is nowhere at the border."""
    rng = np.random.default_rng(seed)
    x, y = (each.ravel() for each in np.meshgrid(np.arange(20.0), np.arange(20.0)))
    lake = np.hypot(x - rng.uniform(7, 12), y - rng.uniform(7, 12)) < 3.5
    x, y = x[~lake], y[~lake]
    cos, sin = np.cos(turn), np.sin(turn)
    return np.column_stack((cos * x - sin * y + shift, sin * x + cos * y + shift, x + y))


def squared(points: NDArray[np.float64], edges: NDArray[Any]) -> list[Fraction]:
    """Squared lengths of edges."""
    return [
        sum((Fraction(p) - Fraction(q)) ** 2 for p, q in zip(*points[pair].tolist(), strict=True))
        for pair in edges
    ]


@pytest.mark.parametrize("turn", [0.0, 0.3, np.pi / 4])
@pytest.mark.parametrize("shift", [0.0, 5e5])
def test_no_long_edge_is_left(turn: float, shift: float) -> None:
    points = survey(3, turn, shift)
    plain = TIN.from_points(points, max_edge=1.6)
    open_ = TIN.from_points(points, max_edge=1.6, voids=True)
    # From outside nothing is removed, but the lake is.
    assert plain.areas.sum() == pytest.approx(361, rel=1e-6)
    assert 361 - np.pi * 4.5**2 < open_.areas.sum() < 361 - np.pi * 2.5**2
    mesh = delone.Delaunay(points[:, :2])
    sides = mesh.simplices[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
    long = np.array([each > Fraction(1.6) ** 2 for each in squared(points[:, :2], sides)])
    expected = mesh.simplices[~long.reshape(-1, 3).any(axis=1)]
    found = open_.points[open_.simplices]
    places = {tuple(sorted(map(tuple, each))) for each in found.tolist()}
    assert places == {tuple(sorted(map(tuple, each))) for each in mesh.points[expected].tolist()}


def test_edges_as_long_as_the_limit_remain() -> None:
    # Diagonals of 3 and 4 are 5 long; those of the turned survey are not, by a rounding.
    x, y = (each.ravel() for each in np.meshgrid(np.arange(4) * 3.0, np.arange(4) * 4.0))
    points = np.column_stack((x, y, x * 0))
    assert TIN.from_points(points, max_edge=5, voids=True).nsimplex == 18
    with pytest.raises(delone.InputError, match="no triangle is left"):
        TIN.from_points(points, max_edge=np.nextafter(5, 0), voids=True)
    tenths = points * 0.1
    limit = np.hypot(0.3, 0.4)
    mesh = delone.Delaunay(tenths[:, :2])
    sides = mesh.simplices[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
    long = np.array([each > Fraction(limit) ** 2 for each in squared(tenths[:, :2], sides)])
    kept = int((~long.reshape(-1, 3).any(axis=1)).sum())
    assert 0 < kept < 18
    assert TIN.from_points(tenths, max_edge=float(limit), voids=True).nsimplex == kept


def test_lines_may_be_long() -> None:
    corners = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]
    frame = [np.array([*corners, corners[0]], dtype=float)]
    tin = TIN.from_points(corners, breaklines=[*frame, np.array(corners)[[0, 2]].astype(float)],
                          max_edge=1, voids=True)  # fmt: skip
    assert tin.nsimplex == 2


def test_voids_need_a_length() -> None:
    with pytest.raises(delone.InputError, match="voids=True needs max_edge"):
        TIN.from_points(survey(0), voids=True)
    with pytest.raises(delone.DtypeError, match="voids"):
        TIN.from_points(survey(0), max_edge=2, voids="inside")


def test_lakes_of_a_raster_are_open() -> None:
    x, y = np.arange(9.0), np.arange(8.0)
    values = np.add.outer(y, x)
    values[3:5, 3:6] = np.nan
    tin = TIN.from_raster(Grid(values, x, y), max_edge=1.5, voids=True)
    # Triangles in the corners of the lake have a diagonal as their longest edge.
    assert tin.areas.sum() == 56 - 3 * 4 + 4 * 0.5
    assert np.isnan(tin.heights((4, 3.5)))
