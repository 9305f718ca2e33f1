"""Rings that touch themselves, in the plane and on the sphere: at corners, in sides and along them.

Those that cross there are refused; the others have the areas of rational numbers.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from delone import CrossingSegmentsError, _core, sphere
from delone.errors import DirectionError

shapely = pytest.importorskip("shapely")

Ring = list[tuple[float, float]]

CROSSING: dict[str, Ring] = {
    "bow": [(0, 0), (5, 5), (10, 10), (10, 0), (5, 5), (0, 10)],
    "bow of unequal parts": [(-5, -5), (0, 0), (2, 2), (2, -2), (0, 0), (-5, 5)],
    "straight sides": [(-4, 0), (0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (0, -4), (-4, -4)],
    "loop inside": [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0), (5, 1), (5, 5), (1, 5)],
    "three times": [(0, 0), (4, -1), (4, 1), (0, 0), (-2, 4), (-4, 3), (0, 0), (5, 3), (-3, -4)],
    "a corner in a side": [(3, 6), (2, 5), (3, 4), (4, 4), (3, 3)],
    "two corners in sides": [(0, 0), (12, 0), (12, 6), (9, 0), (9, -3), (3, -3), (3, 0), (0, 6)],
    "along a common part": [
        (0, 0),
        (10, 0),
        (10, 10),
        (7, 10),
        (3, 0),
        (0, 0),
        (0, -5),
        (5, -5),
        (8, 0),
        (2, 0),
        (2, -9),
        (-1, -9),
    ],
    "along a common side": [
        (0, 0),
        (4, 0),
        (4, 4),
        (4, 0),
        (0, 0),
        (0, -4),
        (8, -4),
        (8, 4),
        (4, 4),
        (0, 4),
        (0, 0),
        (4, 0),
        (6, 1),
        (4, 0),
    ],
    "a bridge to a loop that runs the same way": [
        (0, 0),
        (9, 0),
        (9, 9),
        (0, 9),
        (0, 0),
        (3, 3),
        (6, 3),
        (6, 6),
        (3, 6),
        (3, 3),
    ],
    "a bridge from a side": [
        (0, 0),
        (9, 0),
        (9, 9),
        (4, 9),
        (4, 6),
        (3, 3),
        (6, 6),
        (4, 6),
        (4, 9),
        (0, 9),
    ],
    "a spike along a side": [(0, 0), (8, 0), (8, 8), (3, 8), (3, 0), (6, 0), (3, 0), (0, 8)],
    "a common side of loops that cancel": [
        (0, 4),
        (0, 0),
        (4, 0),
        (4, 4),
        (0, 4),
        (0, 0),
        (-4, 0),
        (-4, 4),
    ],
}
TOUCHING: dict[str, Ring] = {
    "two squares": [(0, 0), (5, 5), (10, 0), (10, 10), (5, 5), (0, 10)],
    "a hole with a bridge": [(0, 0), (9, 0), (9, 9), (0, 9), (0, 0), (3, 3), (3, 6), (6, 6),
                             (6, 3), (3, 3)],
    "a hole with a bridge from a side": [(0, 0), (9, 0), (9, 9), (4, 9), (4, 6), (6, 6), (5, 3),
                                         (4, 6), (4, 9), (0, 9)],
    "a spike": [(0, 0), (4, 0), (9, 0), (4, 0), (4, 4), (2, 5)],
    "a bridge that begins in a side": [(0, 0), (8, 0), (8, 8), (4, 8), (4, 2), (3, 3), (4, 4),
                                       (4, 8), (0, 8)],
    "a spike to a side": [(0, 0), (8, 0), (8, 8), (4, 8), (4, 0), (4, 8), (0, 8)],
    "flat": [(0, 0), (4, 0), (9, 0), (4, 0), (2, 0)],
    "flat, back and forth": [(0, 0), (6, 0), (3, 0), (9, 0), (1, 0)],
    "a hole that touches": [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0), (1, 5), (5, 5), (5, 1)],
    "star": [(0, 0), (2, 1), (4, 0), (3, 2), (4, 4), (2, 3), (0, 4), (1, 2)],
    "a corner in a side": [(0, 0), (10, 0), (10, 10), (5, 0), (0, 10)],
    "corners in both sides": [(0, 0), (10, 0), (10, 10), (6, 4), (6, 0), (4, 4), (4, 0), (0, 10)],
}  # fmt: skip


def variants(ring: Ring) -> list[np.ndarray]:
    """The ring from each start, both ways, and with each corner twice."""
    points = np.array(ring, dtype=float)
    starts = [np.roll(points, k, axis=0) for k in range(len(points))]
    return [*starts, *(each[::-1] for each in starts), np.repeat(points, 2, axis=0)]


def seen(ring: Any, lengths: Any = 1.0) -> np.ndarray:
    """The ring in a plane that touches the sphere, where sides are those of the arcs to it."""
    return np.column_stack((ring, np.full(len(ring), 1000.0))) * lengths


@pytest.mark.parametrize("name", CROSSING)
def test_rings_that_cross_where_they_touch_are_refused(name: str) -> None:
    other = [shapely.box(-20, -20, 20, 20)]
    for ring in variants(CROSSING[name]):
        cells = [shapely.box(11, 11, 12, 12), shapely.Polygon(ring)]
        with pytest.raises(CrossingSegmentsError, match="first: 1"):
            delone.Overlaps(cells, other)
        lengths = np.arange(1, len(ring) + 1)[:, None]
        vectors = [seen([(11, 11), (12, 11), (12, 12)]), seen(ring, lengths)]
        starts = [0, 3, 3 + len(ring)]
        for winding in (None, "smaller", "ccw", "cw"):
            with pytest.raises(DirectionError, match="sides that cross") as caught:
                sphere.Grid.from_mesh(np.concatenate(vectors), starts, winding=winding)
            assert caught.value.rows == [1]
    hole = np.array(CROSSING[name], dtype=float)
    outer = shapely.box(-15, -15, 15, 15).exterior.coords
    with pytest.raises(CrossingSegmentsError):
        delone.Overlaps([shapely.Polygon(outer, [hole])], other)


@pytest.mark.parametrize("name", TOUCHING)
def test_rings_that_touch_are_cells(name: str) -> None:
    expected = abs(signed(TOUCHING[name]))
    for ring in variants(TOUCHING[name]):
        cells = [shapely.Polygon(ring)]
        left, right = shapely.box(-20, -20, 4, 20), shapely.box(4, -20, 20, 20)
        found = delone.Overlaps(cells, [left, right])
        assert found.source_areas[0] == pytest.approx(float(expected))
        assert found.areas.sum() == pytest.approx(float(expected))
        area = sphere.Grid.from_mesh(seen(ring), [0, len(ring)]).areas[0]
        assert area * 1e6 == pytest.approx(float(expected), rel=1e-3, abs=1e-9)


def test_a_polygon_with_a_corner_in_its_side_from_shapely() -> None:
    """On the equator, the side contains the corner."""
    ring = [(0, 0), (5, 0), (5, 5), (0, 5), (0, 0), (-5, 0), (-5, -5), (3, -5), (3, 0), (-5, 0)]
    with pytest.raises(DirectionError, match="sides that cross"):
        sphere.Grid.from_polygons([shapely.Polygon(ring)])
    touching = [(0, 0), (10, 0), (10, 10), (5, 0), (0, 10)]
    assert sphere.Grid.from_polygons([shapely.Polygon(touching)]).report.concave.tolist() == [0]


def signed(ring: Ring) -> Fraction:
    """The sum of the areas that a ring goes around, clockwise ones negative."""
    points = [tuple(map(Fraction, p)) for p in ring]
    sides = zip(points, points[1:] + points[:1], strict=True)
    return sum((a[0] * b[1] - a[1] * b[0] for a, b in sides), Fraction(0)) / 2


@pytest.mark.parametrize(("side", "most"), [(2, 7), (3, 10), (6, 8), (2, 14)])
def test_random_lattice_rings_against_winding_numbers(side: int, most: int) -> None:
    """Where two parts of a ring cross, it has three winding numbers, which are counted exactly."""
    rng = np.random.default_rng(side + most)
    rings = [rng.integers(0, side + 1, (int(rng.integers(3, most)), 2)) for _ in range(2500)]
    starts = np.concatenate(([0], np.cumsum([len(ring) for ring in rings])))
    cells = np.arange(len(starts)), np.zeros(len(rings), dtype=bool)
    points = np.concatenate(rings).astype(float)
    known = _core.PlaneCells(points, starts, *cells).check(True, 1)
    vectors = seen(points, rng.integers(1, 6, (len(points), 1)))
    found = _core.CellGrid.polygons(vectors, starts, *cells).check(True, 1)
    assert known.faults.tolist() == found.faults.tolist()
    counts = {(good, fault): 0 for good in (False, True) for fault in (0, 1, 4)}
    for ring, fault, area in zip(rings, known.faults.tolist(), known.areas.tolist(), strict=True):
        numbers = windings(ring, side)
        good = numbers <= {0, 1} or numbers <= {0, -1}
        assert good or fault == 4, ring.tolist()
        # Of the others, the sides of some cross all the same, or run along a common part.
        assert not good or (fault == 4) == sides_cross(ring, fault), ring.tolist()
        if fault == 0:
            assert Fraction(area) == abs(signed(ring.tolist()))
        counts[good, fault] += 1
    assert all(counts[key] > 10 for key in [(False, 4), (True, 0), (True, 1), (True, 4)])


def windings(ring: np.ndarray, side: int) -> set[int]:
    """The winding numbers of a ring around places that are on no side of a ring, in integers."""
    # Crossings of sides are multiples of fractions with small denominators.
    unit, steps = 1 << 20, np.arange(-1, 8 * side)
    x, y = (each.ravel() for each in np.meshgrid(steps, steps))
    x, y = x * unit // 8 + 137, y * unit // 8 + 9973
    a, b = (each[:, None] * unit for each in (ring, np.roll(ring, -1, axis=0)))
    turn = (b[..., 0] - a[..., 0]) * (y - a[..., 1]) - (x - a[..., 0]) * (b[..., 1] - a[..., 1])
    up = (a[..., 1] <= y) & (y < b[..., 1])
    down = (b[..., 1] <= y) & (y < a[..., 1])
    assert turn[up | down].all()
    return set(((up & (turn > 0)).astype(int) - (down & (turn < 0))).sum(axis=0).tolist())


def sides_cross(ring: np.ndarray, fault: int) -> bool:
    """Whether two sides cross, or run the same way along a common part of them."""
    ring = ring[(ring != np.roll(ring, 1, axis=0)).any(axis=1)]
    ends = np.roll(ring, -1, axis=0)
    for i, (a, b) in enumerate(zip(ring, ends, strict=True)):
        for c, d in zip(ring[:i], ends[:i], strict=True):
            s, t, u, v = turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)
            if s * t < 0 and u * v < 0:
                return True
            axis = int(a[0] == b[0])
            low = max(min(a[axis], b[axis]), min(c[axis], d[axis]))
            high = min(max(a[axis], b[axis]), max(c[axis], d[axis]))
            same = (b[axis] > a[axis]) == (d[axis] > c[axis])
            if s == t == 0 and same and low < high and fault != 1:
                return True
    return False


def turn(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> int:
    return int((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


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
