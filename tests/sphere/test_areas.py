"""Areas of spherical triangles beside integers with 500 bits after the point."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from delone import sphere

BITS = 500


def solid_angle(corners: Any) -> float:
    """By Van Oosterom and Strackee, with roots of 500 bits after the point."""
    vectors = [[Fraction(x) for x in row] for row in corners.tolist()]
    unit = math.lcm(*(x.denominator for row in vectors for x in row))
    a, b, c = ([int(x * unit) for x in row] for row in vectors)

    def dot(p: list[int], q: list[int]) -> int:
        return sum(x * y for x, y in zip(p, q, strict=True))

    k, n, m = (math.isqrt(dot(p, p) << 2 * BITS) for p in (a, b, c))
    total = (k * n * m >> 2 * BITS) + dot(a, b) * m + dot(b, c) * k + dot(c, a) * n
    cross = [b[i - 2] * c[i - 1] - b[i - 1] * c[i - 2] for i in range(3)]
    det = dot(a, cross) << BITS
    most = max(abs(det), abs(total))
    return 2 * math.atan2(float(Fraction(det, most)), float(Fraction(total, most)))


def clusters(km: float, seed: int) -> Any:
    """Stations in Spain, and at their antipodes in New Zealand."""
    rng = np.random.default_rng(seed)
    size = km / 111.2
    spain = np.array([-4, 40]) + rng.uniform(-size / 2, size / 2, (6, 2))
    zealand = np.array([176, -40]) + rng.uniform(-size / 2, size / 2, (6, 2))
    return sphere.Delaunay(lonlat=np.vstack([spain, zealand]))


@pytest.mark.parametrize("km", [1000, 10, 1, 0.1, 0.001])
@pytest.mark.parametrize("seed", range(3))
def test_areas_of_nearly_opposite_clusters(km: float, seed: int) -> None:
    mesh = clusters(km, seed)
    expected = [solid_angle(corners) for corners in mesh.vectors[mesh.simplices]]
    assert mesh.areas == pytest.approx(expected, rel=1e-13, abs=0)
    if mesh.covers_sphere:
        assert mesh.areas.sum() == pytest.approx(4 * math.pi, rel=1e-14)


@pytest.mark.parametrize("seed", range(20))
def test_areas_beside_directions_that_are_opposite_up_to_rounding(seed: int) -> None:
    """Multiples of one vector, rounded: two directions differ by down to 1e-32."""
    rng = np.random.default_rng(seed)
    v = rng.standard_normal(3)
    multiples = np.array([v * k for k in (1, -1 / 3, 2 / 3, -5 / 7, 1e200, -3e-200)])
    others = rng.standard_normal((seed % 4 + 2, 3))
    mesh = sphere.Delaunay(xyz=np.concatenate((multiples, others)))
    expected = [solid_angle(corners) for corners in mesh.vectors[mesh.simplices]]
    assert mesh.areas == pytest.approx(expected, rel=1e-12, abs=0)
    if mesh.covers_sphere:
        assert mesh.areas.sum() == pytest.approx(4 * math.pi, rel=1e-14)


def test_areas_of_scattered_directions() -> None:
    mesh = sphere.Delaunay(xyz=np.random.default_rng(1).standard_normal((60, 3)))
    expected = [solid_angle(corners) for corners in mesh.vectors[mesh.simplices]]
    assert mesh.areas == pytest.approx(expected, rel=1e-14, abs=0)


@pytest.mark.parametrize("width", [1e-7, 1e-10, 1e-12, 1e-14])
def test_cells_around_close_sites_are_those_of_their_outline(width: float) -> None:
    # Seen from far away the sites are one, and the cell of a corner of their outline is a lune
    # between the normals of its sides: its area is twice the angle there.
    rng = np.random.default_rng(5)
    middle = np.array([0.6, 0.3, math.sqrt(1 - 0.45)])
    east = np.cross((0, 0, 1), middle)
    east /= np.linalg.norm(east)
    north = np.cross(middle, east)
    away = rng.uniform(-width, width, (60, 2))
    vectors = middle + away @ np.stack((east, north))
    # As rounded: differences of vectors that are so close are exact.
    places = (vectors - vectors[0]) @ np.stack((east, north)).T / width
    corners = delone.ConvexHull(places).vertices
    sides = np.roll(places[corners], -1, axis=0) - places[corners]
    before = np.roll(sides, 1, axis=0)
    cross = before[:, 0] * sides[:, 1] - before[:, 1] * sides[:, 0]
    angles = np.arctan2(cross, (before * sides).sum(axis=1))
    found = sphere.Voronoi(xyz=vectors).cell_areas
    assert found[corners] == pytest.approx(2 * angles, rel=1e-11 + 10 * width)
    assert found.sum() == pytest.approx(4 * np.pi, rel=1e-14)
