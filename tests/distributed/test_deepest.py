"""The points deepest in circles against all points, in fractions."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import pytest

from delone import _core, datasets
from delone.predicates import orient2d
from delone.reference import incircle_canonical

if TYPE_CHECKING:
    from numpy.typing import NDArray

POINTS = {
    "uniform": datasets.uniform(100, seed=2),
    "lattice": datasets.integer_lattice(100, seed=2, side=12),
    "circle": datasets.pythagorean_circle(40),
    "clusters": datasets.gaussian_clusters(100, seed=2),
}


def triangles(points: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """Counter-clockwise triangles whose corners are in the box of the points."""
    corners = points[np.random.default_rng(4).integers(0, len(points), (count, 3))]
    turns = orient2d(corners[:, 0], corners[:, 1], corners[:, 2])
    corners[turns < 0] = corners[turns < 0][:, ::-1]
    return np.ascontiguousarray(corners[turns != 0])


def depth(corners: NDArray[np.float64], point: NDArray[np.float64]) -> Fraction:
    """The squared distance of a point from the centre of a circle."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in corner] for corner in corners.tolist())
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    bb, cc, d = bx * bx + by * by, cx * cx + cy * cy, 2 * (bx * cy - by * cx)
    x, y = ax + (cy * bb - by * cc) / d, ay + (bx * cc - cx * bb) / d
    px, py = (Fraction(v) for v in point.tolist())
    return (px - x) ** 2 + (py - y) ** 2


@pytest.mark.parametrize("name", POINTS)
def test_the_flag_tells_exactly_whether_there_are_more(name: str) -> None:
    """Asked for as many as there are, one less and one more."""
    points = POINTS[name]
    for corners in triangles(points, 20):
        among = (points[:, None] == corners).all(axis=2).any(axis=1)
        right = [
            row
            for row in np.flatnonzero(~among).tolist()
            if incircle_canonical(*corners, points[row]) > 0
        ]
        distances = sorted(depth(corners, points[row]) for row in right)
        for most in {0, 1, len(right) // 2, max(0, len(right) - 1), len(right), len(right) + 1}:
            deepest = _core.deepest2(points, corners.reshape(1, 6), most, 1)
            starts, rows, is_all = deepest.starts, deepest.rows, deepest.complete
            found = rows.tolist()
            assert starts.tolist() == [0, len(found)]
            assert len(set(found)) == len(found) == min(most, len(right))
            assert set(found) <= set(right)
            assert is_all.tolist() == [len(right) <= most]
            for row, wanted in zip(found, distances, strict=False):
                assert float(depth(corners, points[row])) == pytest.approx(float(wanted), rel=1e-6)


def test_queries_of_several_tasks() -> None:
    """One call says what a call for each query says."""
    points = datasets.uniform(2000, seed=3)
    corners = triangles(points, 900).reshape(-1, 6)
    for workers in (1, 3):
        deepest = _core.deepest2(points, corners, 4, workers)
        starts, rows, is_all = deepest.starts, deepest.rows, deepest.complete
        assert len(starts) == len(corners) + 1
        for i in [*range(0, len(corners), 97), 255, 256, 257, 511, 512, len(corners) - 1]:
            alone = _core.deepest2(points, corners[i : i + 1], 4, 1)
            assert rows[starts[i] : starts[i + 1]].tolist() == alone.rows.tolist()
            assert is_all[i] == alone.complete[0]


def test_many_triangles_within_a_box() -> None:
    """More than two tasks; disks are those of single triangles."""
    points = datasets.uniform(1000, seed=5)
    corners = np.random.default_rng(6).integers(0, 1000, (150_000, 3)).astype(np.int32)
    box = (-0.25, -0.25, 1.25, 1.25)
    disks = _core.disks2(points, corners)
    low, high = disks[:, :2] - disks[:, 2:], disks[:, :2] + disks[:, 2:]
    right = (
        (corners < 900).all(axis=1) & (low >= box[:2]).all(axis=1) & (high <= box[2:]).all(axis=1)
    )
    for tail in (right, right[1 << 16 :], right[1 << 17 :]):
        assert tail.any() and not tail.all()
    for workers in (1, 3):
        assert np.array_equal(_core.within2(points, corners, 900, box, workers), right)
