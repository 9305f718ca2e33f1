"""The pure parts: cells, hulls, disks, answers."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from delone import Delaunay, _core, datasets
from delone.distributed.pure.hull import extreme_rows
from delone.distributed.pure.rows import make_rows
from delone.distributed.pure.tiles import plant, strips
from delone.predicates import incircle, orient2d


def test_each_point_has_one_cell() -> None:
    points = datasets.integer_lattice(3000)
    tiles = plant(points, 13)
    assert len(tiles) == 13
    owner = tiles.locate(points)
    low, high = tiles.cells[:, :2], tiles.cells[:, 2:]
    inside = ((points[:, None] >= low) & (points[:, None] < high)).all(axis=2)
    assert (inside.sum(axis=1) == 1).all()
    assert np.array_equal(inside.argmax(axis=1), owner)
    assert np.bincount(owner).min() > 100


def test_boxes_meet_cells() -> None:
    points = datasets.uniform(1000)
    tiles = plant(points, 11)
    low = points[:60]
    high = low + 0.2
    box, tile = tiles.overlaps(low, high)
    found = set(zip(box.tolist(), tile.tolist(), strict=True))
    cells = tiles.cells
    right = {
        (b, t)
        for b in range(60)
        for t in range(11)
        if (cells[t, :2] <= high[b]).all() and (cells[t, 2:] > low[b]).all()
    }
    assert right == found


def test_equal_points_leave_fewer_tiles() -> None:
    points = np.repeat(datasets.uniform(3), 50, axis=0)
    assert len(plant(points, 20)) == 3
    assert len(plant(np.ones((9, 2)), 4)) == 1
    assert len(plant(np.empty((0, 2)), 4)) == 1


def test_strips_hold_about_what_they_should() -> None:
    points = datasets.uniform(40_000)
    tiles = plant(points, 4)
    boxes = strips(tiles, points, len(points))
    owner = tiles.locate(points)
    for tile, box in enumerate(boxes):
        within = ((points >= box[:2]) & (points <= box[2:])).all(axis=1)
        foreign = np.count_nonzero(within & (owner != tile))
        # Half the sides of a corner tile are at the margin.
        assert 0.3 * 5.5 * math.sqrt(10_000) < foreign < 2 * 11 * math.sqrt(10_000)


@pytest.mark.parametrize("generator", ["uniform", "grid", "circle", "kuzmin", "duplicates"])
def test_extreme_rows(generator: str) -> None:
    points = getattr(datasets, generator)(2000)
    rows = make_rows(0, points, None, {})
    found = extreme_rows(rows)["id"].astype(int)
    assert np.array_equal(found, np.sort(found))
    hull = points[found]
    center = hull.mean(axis=0)
    order = np.argsort(np.arctan2(*(hull - center).T[::-1]))
    around = hull[order]
    ahead = np.roll(around, -1, axis=0)
    assert (orient2d(around, ahead, np.roll(around, -2, axis=0)) > 0).all()
    for a, b in zip(around[:50], ahead[:50], strict=True):
        assert (orient2d(a, b, points) >= 0).all()
    # Of equal points the first.
    first = np.unique(points, axis=0, return_index=True)[1]
    assert set(found) <= set(first)


def test_disks_hold_their_circles() -> None:
    dice = np.random.default_rng(2)
    for scale in (1.0, 1e-3, 1e6, 1e-90, 1e90):
        flat = 10.0 ** -dice.integers(0, 14, (200, 1))
        points = dice.random((200, 3, 2)) * np.stack([np.ones_like(flat), flat], axis=2)
        points = (points + dice.integers(-3, 4, (200, 1, 2))) * scale
        simplices = np.arange(600, dtype=np.int32).reshape(-1, 3)
        disks = _core.disks2(points.reshape(-1, 2), simplices)
        assert np.isfinite(disks[:, 2]).sum() > 100
        for corners, disk in zip(points.tolist(), disks.tolist(), strict=True):
            if math.isfinite(disk[2]):
                assert holds(corners, disk)


def holds(corners: list[list[float]], disk: list[float]) -> bool:
    """Whether the closed circumdisk lies in a disk, in fractions."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(v) for v in p] for p in corners)
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    d = 2 * (bx * cy - by * cx)
    bb, cc = bx * bx + by * by, cx * cx + cy * cy
    x, y = (cy * bb - by * cc) / d, (bx * cc - cx * bb) / d
    dx, dy = ax + x - Fraction(disk[0]), ay + y - Fraction(disk[1])
    # sqrt(q) + sqrt(p) <= r, squared until no root is left.
    p, q, r = x * x + y * y, dx * dx + dy * dy, Fraction(disk[2])
    left = r * r - p - q
    return left >= 0 and 4 * p * q <= left * left


def test_triangles_are_certain_where_their_disks_are_known() -> None:
    points = datasets.integer_lattice(400, side=30)
    simplices = np.array(Delaunay(points).simplices)
    disks = _core.disks2(points, simplices)
    low, high = disks[:, :2] - disks[:, 2:], disks[:, :2] + disks[:, 2:]
    box = (3.0, 4.0, 25.0, 27.0)
    inside = (low >= box[:2]).all(axis=1) & (high <= box[2:]).all(axis=1)
    for own in (0, 200, 400):
        right = inside & (simplices < own).all(axis=1)
        for workers in (1, 2):
            assert np.array_equal(_core.within2(points, simplices, own, box, workers), right)
    assert right.any() and not right.all()
    with pytest.raises(ValueError, match="outside"):
        _core.within2(points[:9], simplices, 9, box, 1)


def test_answers_are_exact() -> None:
    points = datasets.integer_lattice(500, side=16)
    asked = datasets.integer_lattice(300, seed=1, side=16).reshape(-1, 3, 2)
    turns = orient2d(asked[:, 0], asked[:, 1], asked[:, 2])
    asked = asked[turns != 0]
    asked[turns[turns != 0] < 0] = asked[turns[turns != 0] < 0][:, ::-1]
    corners = np.ascontiguousarray(asked.reshape(-1, 6))
    deepest = _core.deepest2(points, corners, 4, 2)
    starts, rows, is_all = deepest.starts, deepest.rows, deepest.complete
    for i, (a, b, c) in enumerate(asked):
        signs = incircle(a, b, c, points, ties="canonical")
        mine = rows[starts[i] : starts[i + 1]]
        among = (points[:, None] == asked[i]).all(axis=2).any(axis=1)
        conflicts = np.flatnonzero((signs > 0) & ~among)
        assert set(mine) <= set(conflicts)
        assert len(mine) == min(4, len(conflicts))
        assert is_all[i] == (len(conflicts) <= 4)
