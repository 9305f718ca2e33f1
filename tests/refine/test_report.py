"""The report of a mesh, beside the measures of all its triangles."""

from __future__ import annotations

import numpy as np
import pytest

import delone
from delone._tiling.plane import quality
from delone.refine.report import judged

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]


def triangles(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Separate triangles, counter-clockwise, some of them thin."""
    points = rng.random((count, 3, 2)) * 10.0 ** rng.integers(-3, 4, (count, 1, 1))
    points[:, 2, 1] *= 10.0 ** -rng.integers(0, 9, count)
    u, v = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    turned = u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]
    points[turned] = points[turned][:, ::-1]
    return points.reshape(-1, 2), np.arange(3 * count, dtype=np.int32).reshape(-1, 3)


@pytest.mark.parametrize("bound", [0, 10, 20.7, 30, 45])
@pytest.mark.parametrize("power", [0, -900, 900])
def test_the_same_as_by_measures_and_fractions(bound: float, power: int) -> None:
    points, simplices = triangles(np.random.default_rng(int(bound)), 300)
    points = np.ldexp(points, power)
    rows, (smallest, largest) = judged(points, simplices, bound)
    assert rows.dtype == np.int64
    assert rows.tolist() == quality.below(points, simplices, bound).tolist()
    found = quality.measured(points, simplices)
    assert smallest == pytest.approx(found.smallest_angle.min(), rel=1e-12)
    assert largest == pytest.approx(found.largest_angle.max(), rel=1e-12)


def test_triangles_of_all_magnitudes_at_once() -> None:
    points, simplices = triangles(np.random.default_rng(1), 90)
    scale = np.repeat(np.ldexp(1.0, np.tile([-800, 0, 480], 30)), 3)[:, None]
    rows, (smallest, largest) = judged(points * scale, simplices, 20)
    assert rows.tolist() == quality.below(points, simplices, 20).tolist()
    found = quality.measured(points, simplices)
    assert smallest == pytest.approx(found.smallest_angle.min(), rel=1e-12)
    assert largest == pytest.approx(found.largest_angle.max(), rel=1e-12)


def test_angles_that_are_exactly_the_bound_are_not_below() -> None:
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0))
    grid = delone.Delaunay(np.column_stack((x.ravel(), y.ravel())))
    rows, angles = judged(grid.points, grid.simplices, 45)
    assert (rows.tolist(), angles) == ([], (45.0, 90.0))
    rows, _ = judged(grid.points, grid.simplices, 45.000001)
    assert len(rows) == grid.nsimplex


def test_the_summary_has_what_the_measures_have() -> None:
    mesh = delone.mesh(SQUARE, max_area=1e-3, min_angle=0)
    found = mesh.quality()
    assert mesh.report.smallest_angle == found.smallest_angle.min()
    assert mesh.report.largest_angle == found.largest_angle.max()
    shown = f"{found.smallest_angle.min():.4g} to {found.largest_angle.max():.4g} degrees"
    assert shown in str(mesh.report)


def test_no_triangles() -> None:
    rows, angles = judged(np.empty((0, 2)), np.empty((0, 3), dtype=np.int32), 20)
    assert (rows.tolist(), angles) == ([], (180.0, 0.0))
