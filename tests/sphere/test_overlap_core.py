"""Areas that cells share, against 50 digits: hostile pairs of rings, and cells of parallels.

Corners lie on lattices, at poles and at the date line; cells are equal, share sides, have corners
in sides, or have sides that are equal but for roundings; rings are concave, and from a radian to
1e-8 wide.
"""

from __future__ import annotations

import math
import random
from typing import TYPE_CHECKING

import numpy as np
import pytest

from delone import _core
from delone.sphere.coordinates import directions_of
from overlaps import polygon_area, shared_by_box, shared_by_polygons
from tiers import seeds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

INF = float("inf")


def place(lon: float, lat: float) -> Floats:
    if abs(lat) == 90:
        return np.array([0.0, 0.0, math.copysign(1, lat)])
    found: Floats = directions_of([(lon, lat)], None, degrees=True, workers=1)[0]
    return found


def polygons(rings: Sequence[Floats]) -> _core.CellGrid:
    """A grid of cells of one ring each."""
    starts = np.cumsum([0, *(len(ring) for ring in rings)]).astype(np.int64)
    cells = np.arange(len(rings) + 1, dtype=np.int64)
    vectors = np.ascontiguousarray(np.concatenate(rings), dtype=np.float64)
    return _core.CellGrid.polygons(vectors, starts, cells, np.zeros(len(rings), dtype=bool))


def lattice(lon: Floats, lat: Floats) -> tuple[_core.CellGrid, Floats, Floats]:
    """Cells between meridians and parallels in degrees, row by row."""
    meridians = directions_of(
        np.column_stack((lon, np.zeros(len(lon)))), None, degrees=True, workers=1
    )[:, :2].copy()
    sloped = directions_of(
        np.column_stack((np.zeros(len(lat)), np.where(abs(lat) == 90, 0, lat))),
        None,
        degrees=True,
        workers=1,
    )
    tangents = np.where(abs(lat) == 90, np.copysign(INF, lat), sloped[:, 2] / sloped[:, 0])
    rows, columns = len(lat) - 1, len(lon) - 1
    numbers = np.full((rows, columns + 1), -1, dtype=np.int32)
    numbers[:, :-1] = np.arange(rows * columns).reshape(rows, columns)
    grid = _core.CellGrid.rows(
        np.column_stack((tangents[:-1], tangents[1:])),
        np.arange(rows + 1, dtype=np.int64) * (columns + 1),
        np.tile(meridians, (rows, 1)),
        numbers.ravel(),
        rows * columns,
    )
    return grid, meridians, tangents


def corner(rng: random.Random) -> Floats:  # noqa: PLR0911
    kind = rng.randrange(7)
    if kind == 0:
        return place(
            rng.choice([0, 30, 60, 90, 180, -180, 150, 179, -179]),
            rng.choice([-60, -30, 0, 30, 60, 80]),
        )
    if kind == 1:
        return np.array([0, 0, rng.choice([1.0, -1.0])])
    if kind == 2:
        return np.array([float(rng.randint(-3, 3)) for _ in range(3)])
    if kind == 3:
        return place(rng.uniform(-180, 180), rng.uniform(-90, 90))
    if kind == 4:
        lon = rng.choice([0, 30, 180]) + rng.choice([0, 1e-9, -1e-13, 1e-15])
        return place(lon, rng.choice([0, 45]) + rng.choice([0, 1e-9, -1e-12]))
    if kind == 5:
        return np.array([rng.uniform(-1, 1), rng.uniform(-1, 1), 1.0])
    small = [0, 1e-8, -1e-8, 1e-15, 1e-17]
    return np.array([1.0, rng.choice(small), rng.choice(small)])


def ring(rng: random.Random) -> Floats:
    while True:
        if rng.random() < 0.3:
            # Around a center, convex or concave.
            c = corner(rng)
            if not c.any():
                continue
            c = c / np.linalg.norm(c)
            a = np.cross(c, [0.3, 0.5, 0.7])
            a /= np.linalg.norm(a)
            b = np.cross(c, a)
            radius, m = rng.choice([0.5, 0.1, 1e-3, 1e-6, 1e-8]), rng.choice([5, 7, 9, 13])
            angles = 2 * np.pi * np.arange(m) / m
            shares = [1.0] if rng.random() < 0.3 else [1, 0.3, 0.5, 1]
            lengths = radius * np.array([rng.choice(shares) for _ in range(m)])
            spokes = np.cos(angles)[:, None] * a + np.sin(angles)[:, None] * b
            found: Floats = c + lengths[:, None] * spokes
            return found
        p = np.array([corner(rng) for _ in range(3)])
        if not p.any(axis=1).all():
            continue
        u = p / np.linalg.norm(p, axis=1, keepdims=True)
        if min(u[0] @ u[1], u[1] @ u[2], u[2] @ u[0]) < 0.3 or np.linalg.det(u) == 0:
            continue
        return p if np.linalg.det(u) > 0 else p[::-1].copy()


def relative(rng: random.Random, r: Floats) -> Floats:
    """The same cell, one that shares a side, or a part of it."""
    kind = rng.randrange(4)
    if kind == 0:
        return r.copy()
    if kind == 1:
        return np.array([r[1], r[0], r[0] + r[1] - (r[2] if len(r) == 3 else r[-1])])
    if kind == 2:
        return np.array([r[0], r[1], r[1] + r[2]])
    return np.array([r[0], r[0] + r[1], r[0] + r[1] + r[2]])


def cell(r: Floats) -> tuple[_core.CellGrid, float, Floats] | None:
    """A grid of one cell, its area, and its ring counter-clockwise; None if it is not a cell."""
    grid = polygons([r])
    known = grid.check(True, 1)
    if known.faults[0] or known.areas[0] < 1e-24:
        return None
    return grid, known.areas[0], r[::-1] if known.turned[0] else r


@pytest.mark.parametrize("seed", seeds(6, deep=200))
def test_two_polygons(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(40):
        p = ring(rng)
        q = relative(rng, p) if rng.random() < 0.6 else ring(rng)
        first, second = cell(p), cell(q)
        if first is None or second is None:
            continue
        exact = float(shared_by_polygons(first[2], second[2]))
        small = min(first[1], second[1])
        for found in (first[0].overlaps(second[0], 1), second[0].overlaps(first[0], 1)):
            area = found.areas.sum()
            assert area >= 0
            assert abs(area - exact) <= max(4e-15 * small, 1e-29), (p.tolist(), q.tolist())
            assert found.first.sum() == found.second.sum() == area


@pytest.mark.parametrize("seed", seeds(2, deep=30))
def test_which_cells_are_convex(seed: int) -> None:
    # Integers in the plane of one side of a cube, seen from its center: arcs are segments there.
    rng = random.Random(seed)
    seen = set()
    for _ in range(600):
        side, count, axis = rng.randint(1, 3), rng.randint(3, 7), rng.randrange(3)
        flat = [(rng.randint(-side, side), rng.randint(-side, side)) for _ in range(count)]
        known = polygons([np.roll([(x, y, 3.0) for x, y in flat], axis, axis=1)]).check(True, 1)
        if known.faults[0]:
            continue
        if known.turned[0]:
            flat.reverse()
        ends = list(zip(flat, flat[1:] + flat[:1], strict=True))
        beside = (
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0
            for a, b in ends
            for c in flat
        )
        concave = any(beside)
        assert known.concave[0] == concave, flat
        seen.add((concave, count))
    assert len(seen) > 6


@pytest.mark.parametrize("seed", seeds(6, deep=200))
def test_a_polygon_and_a_cell_of_parallels(seed: int) -> None:
    rng = random.Random(1000 + seed)
    for _ in range(40):
        r = ring(rng)
        if rng.random() < 0.4:
            a, b = rng.choice([-180, -30, 0, 150, 170]), rng.choice([-90, -60, -30, 0, 30, 60])
            w, h = rng.choice([10, 30, 60]), rng.choice([10, 30])
            r = np.array([place(a, b), place(a + w, b), place(a + w, b + h), place(a, b + h)])
        made = cell(r)
        if made is None:
            continue
        grid, area, r = made
        u = r / np.linalg.norm(r, axis=1, keepdims=True)
        lon = np.degrees(np.arctan2(u[:, 1], u[:, 0]))
        lat = np.degrees(np.arcsin(np.clip(u[:, 2], -1, 1)))
        west = rng.choice(
            [0.0, 30.0, -180.0, 150.0, 90.0, rng.choice(lon), lon.mean() - rng.uniform(0, 40)]
        )
        width = rng.choice([1, 10, 30, 90, 1e-3])
        south = (
            rng.choice([-90.0, -60.0, -30.0, 0.0, 30.0, 60.0])
            if rng.random() < 0.5
            else rng.choice(lat)
        )
        north = min(90.0, south + rng.choice([1, 10, 30, 60, 1e-3]))
        if south < 0 < north and rng.random() < 0.5:
            north = 0.0
        if north <= south:
            continue
        box, meridians, tangents = lattice(np.array([west, west + width]), np.array([south, north]))
        if not tangents[0] < tangents[1]:
            continue
        exact = float(shared_by_box(r, meridians, tangents))
        small = min(area, box.check(False, 1).areas[0])
        found = grid.overlaps(box, 1)
        case = (r.tolist(), west, width, south, north)
        assert abs(found.areas.sum() - exact) <= max(8e-15 * small, 1e-29), case
        other = box.overlaps(grid, 1)
        assert np.array_equal(other.areas, found.areas)


@pytest.mark.parametrize("size", [1.0, 1e-3, 1e-6, 1e-9])
def test_the_oracle_of_areas(size: float) -> None:
    rng = np.random.default_rng(3)
    rings = [np.array([1.0, 0.3, 0.2]) + size * rng.random((3, 3)) for _ in range(10)]
    found = polygons(rings).check(False, 1)
    for r, area in zip(rings, found.areas, strict=True):
        exact = abs(float(polygon_area(r)))
        assert abs(area - exact) <= max(4e-16 * exact, 1e-30)
