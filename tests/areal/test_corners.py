"""Rings that cross themselves at a corner, in the plane and on the sphere, against signed areas."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import delone
from delone import CrossingSegmentsError, sphere
from delone.areal.corners import crossing_at_corners
from delone.errors import DirectionError

shapely = pytest.importorskip("shapely")

Ring = list[tuple[float, float]]

CROSSING: dict[str, Ring] = {
    "bow": [(0, 0), (5, 5), (10, 10), (10, 0), (5, 5), (0, 10)],
    "bow of unequal parts": [(-5, -5), (0, 0), (2, 2), (2, -2), (0, 0), (-5, 5)],
    "straight sides": [(-4, 0), (0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (0, -4), (-4, -4)],
    "loop inside": [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0), (5, 1), (5, 5), (1, 5)],
    "three times": [(0, 0), (4, -1), (4, 1), (0, 0), (-2, 4), (-4, 3), (0, 0), (5, 3), (-3, -4)],
}
TOUCHING: dict[str, Ring] = {
    "two squares": [(0, 0), (5, 5), (10, 0), (10, 10), (5, 5), (0, 10)],
    "a hole with a bridge": [(0, 0), (9, 0), (9, 9), (0, 9), (0, 0), (3, 3), (3, 6), (6, 6),
                             (6, 3), (3, 3)],
    "a spike": [(0, 0), (4, 0), (9, 0), (4, 0), (4, 4), (2, 5)],
    "flat": [(0, 0), (4, 0), (9, 0), (4, 0), (2, 0)],
    "a hole that touches": [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0), (1, 5), (5, 5), (5, 1)],
    "star": [(0, 0), (2, 1), (4, 0), (3, 2), (4, 4), (2, 3), (0, 4), (1, 2)],
}  # fmt: skip


def variants(ring: Ring) -> list[np.ndarray]:
    """The ring from each start, both ways, and with each corner twice."""
    points = np.array(ring, dtype=float)
    starts = [np.roll(points, k, axis=0) for k in range(len(points))]
    return [*starts, *(each[::-1] for each in starts), np.repeat(points, 2, axis=0)]


@pytest.mark.parametrize("name", CROSSING)
def test_rings_that_cross_at_corners_are_refused(name: str) -> None:
    other = [shapely.box(-20, -20, 20, 20)]
    for ring in variants(CROSSING[name]):
        cells = [shapely.box(11, 11, 12, 12), shapely.Polygon(ring)]
        with pytest.raises(CrossingSegmentsError, match="first: 1"):
            delone.Overlaps(cells, other)
        with pytest.raises(DirectionError, match="sides that cross") as caught:
            sphere.Grid.from_polygons(cells)
        assert caught.value.rows == [1]
    hole = np.array(CROSSING[name], dtype=float)
    outer = shapely.box(-15, -15, 15, 15).exterior.coords
    with pytest.raises(CrossingSegmentsError):
        delone.Overlaps([shapely.Polygon(outer, [hole])], other)


@pytest.mark.parametrize("name", TOUCHING)
def test_rings_that_touch_at_corners_are_cells(name: str) -> None:
    expected = abs(signed(TOUCHING[name]))
    for ring in variants(TOUCHING[name]):
        cells = [shapely.Polygon(ring)]
        found = delone.Overlaps(cells, [shapely.box(-20, -20, 20, 20)])
        assert found.source_areas[0] == pytest.approx(float(expected))
        area = sphere.Grid.from_polygons(cells).areas[0]
        assert np.degrees(np.degrees(area)) == pytest.approx(float(expected), rel=0.02, abs=1e-9)


def signed(ring: Ring) -> Fraction:
    """The sum of the areas that a ring goes around, clockwise ones negative."""
    points = [tuple(map(Fraction, p)) for p in ring]
    sides = zip(points, points[1:] + points[:1], strict=True)
    return sum((a[0] * b[1] - a[1] * b[0] for a, b in sides), Fraction(0)) / 2


def test_random_lattice_rings_against_winding_numbers() -> None:
    """Where two parts of a ring cross, three winding numbers meet."""
    rng = np.random.default_rng(2)
    seen = [0, 0]
    for _ in range(4000):
        ring = rng.integers(0, 3, (int(rng.integers(5, 9)), 2)).astype(float)
        ring = ring[(ring != np.roll(ring, 1, axis=0)).any(axis=1)]
        if len(ring) < 5 or len(np.unique(ring, axis=0)) == len(ring) or not clean(ring):
            continue
        numbers = windings(ring, rng)
        crosses = not (numbers <= {0, 1} or numbers <= {0, -1})
        arrays = ring, np.array([0, len(ring)]), np.array([0, 1]), np.array([False])
        assert len(crossing_at_corners(arrays)) == crosses, ring.tolist()
        seen[crosses] += 1
    assert min(seen) > 20


def windings(ring: np.ndarray, rng: np.random.Generator) -> set[int]:
    """The winding numbers of a ring around random places."""
    x, y = 2 * rng.random((2, 1000))
    a, b = ring[:, None], np.roll(ring, -1, axis=0)[:, None]
    left = (b[..., 0] - a[..., 0]) * (y - a[..., 1]) - (x - a[..., 0]) * (b[..., 1] - a[..., 1]) > 0
    up = (a[..., 1] <= y) & (y < b[..., 1]) & left
    down = (b[..., 1] <= y) & (y < a[..., 1]) & ~left
    return set((up.astype(int) - down.astype(int)).sum(axis=0).tolist())


def clean(ring: np.ndarray) -> bool:
    """Whether sides meet at common corners only, and no two are the same."""
    ends = np.roll(ring, -1, axis=0)
    sides = [shapely.LineString(side) for side in zip(ring, ends, strict=True)]
    for i, one in enumerate(sides):
        for two in sides[:i]:
            common = one.intersection(two)
            known = {*one.coords} & {*two.coords}
            if not common.is_empty and (
                common.geom_type != "Point" or common.coords[0] not in known
            ):
                return False
    return True


@pytest.mark.parametrize("at", [1, 1023, 1024, 1499])
def test_each_ring_is_tested(at: int) -> None:
    """Also after rings that only touch themselves, and beyond the first thousand."""
    rings = np.tile(np.array(TOUCHING["two squares"], dtype=float), (1500, 1, 1))
    rings[at] = CROSSING["bow"]
    rings += 20 * np.stack(np.divmod(np.arange(1500), 40), axis=1)[:, None]
    cells = list(shapely.polygons(rings))
    with pytest.raises(CrossingSegmentsError, match=f"1 polygon has .* first: {at}:"):
        delone.Overlaps(cells, [shapely.box(0, 0, 1, 1)])
    with pytest.raises(DirectionError) as caught:
        sphere.Grid.from_mesh(lonlat=rings / 20)
    assert caught.value.rows == [at]


@pytest.mark.parametrize("at", [0, 1023, 1024, 2500])
def test_each_cell_is_checked(at: int) -> None:
    """The core checks cells in lots of 1,024: a crossing in a later one is found, too."""
    rings = np.tile(np.array([(0, 0), (10, 0), (10, 10), (0, 10)], dtype=float), (2501, 1, 1))
    rings[at] = rings[at, [0, 2, 1, 3]]
    rings += 20 * np.stack(np.divmod(np.arange(2501), 50), axis=1)[:, None]
    with pytest.raises(CrossingSegmentsError, match=f"1 polygon has .* first: {at}:"):
        delone.Overlaps(list(shapely.polygons(rings)), [shapely.box(0, 0, 1, 1)])
    with pytest.raises(DirectionError, match="sides that cross") as caught:
        sphere.Grid.from_mesh(lonlat=rings / 20).validate()
    assert caught.value.rows == [at]
