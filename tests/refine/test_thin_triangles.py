"""Measures of triangles beside rational ones: of those that are nearly flat above all."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import pytest

from delone import Delaunay
from delone._tiling.plane.quality import measured

if TYPE_CHECKING:
    from numpy.typing import NDArray

SINGLE = {
    "decimals in line": [(0, 0), (0.1, 0.1), (0.3, 0.30000000000000004)],
    "needle": [(0, 0), (1, 0), (0, 1e-200)],
    "subnormal": [(0, 0), (5e-324, 0), (0, 1e-323)],
    "largest": [(-1.5e308, 0), (1.5e308, 1), (0, 1.5e308)],
    "twins far away": [(1e9, 1e9), (1e9, 1e9 + 1e-6), (0, 1)],
}


def angles(corners: NDArray[np.float64]) -> list[float]:
    p = [[Fraction(x) for x in row] for row in corners.tolist()]
    found = []
    for k in range(3):
        (ax, ay), (bx, by) = ((q[0] - p[k][0], q[1] - p[k][1]) for q in (p[k - 2], p[k - 1]))
        sine, cosine = ax * by - ay * bx, ax * bx + ay * by
        if sine < abs(cosine):
            found.append(math.atan2(float(sine / abs(cosine)), 1 if cosine > 0 else -1))
        else:
            found.append(math.atan2(1, float(cosine / sine)))
    return [math.degrees(angle) for angle in found]


def assert_right(points: NDArray[np.float64]) -> None:
    mesh = Delaunay(points)
    quality = measured(mesh.points, mesh.simplices)
    for row, simplex in enumerate(mesh.simplices):
        right = angles(points[simplex])
        assert quality.smallest_angle[row] == pytest.approx(min(right), rel=1e-13, abs=0)
        assert quality.largest_angle[row] == pytest.approx(max(right), rel=1e-13)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", SINGLE)
def test_single_triangles(name: str) -> None:
    assert_right(np.array(SINGLE[name], dtype=np.float64))


def test_sizes_in_one_mesh_do_not_touch_each_other() -> None:
    points = np.array([(0, 0), (5e-324, 0), (0, 5e-324), (-1.5e308, 0), (1.5e308, 1), (0, 1.5e308)])
    quality = measured(points, np.array([(0, 1, 2), (3, 4, 5)], dtype=np.int32))
    assert quality.smallest_angle == pytest.approx([45, 45])
    assert quality.radius_ratio == pytest.approx(2 * [2 * math.sqrt(2) - 2])


@pytest.mark.parametrize("exponent", range(6, 17, 2))
def test_turned_lattices_that_are_shaken(exponent: int) -> None:
    """Their sides are nearly straight, and the triangles at them nearly flat."""
    rng = np.random.default_rng(exponent)
    lattice = np.stack(np.meshgrid(np.arange(8.0), np.arange(8.0)), axis=-1).reshape(-1, 2)
    turned = lattice @ np.array([(0.6, 0.8), (-0.8, 0.6)])
    assert_right(turned + 10.0**-exponent * rng.uniform(-1, 1, turned.shape))
