"""Heights where points and lines meet: rounding contradicts nothing, everything else is named."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from delone import ConflictingValuesError, InputError
from delone.terrain import TIN

UTM = np.array([500_000.0, 5_400_000.0])
SQUARE = [(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)]


def survey(seed: int, count: int = 40) -> np.ndarray:
    random = np.random.default_rng(seed)
    corners = np.array([(0, 0), (100, 0), (100, 100), (0, 100)])
    xy = np.vstack((np.round(random.random((count, 2)) * 100, 3), corners)) + UTM
    return np.column_stack((xy, np.round(random.random(len(xy)) * 10, 2)))


def pair(seed: int) -> list[np.ndarray]:
    """Two lines between millimeters."""
    random = np.random.default_rng(1000 + seed)
    return [np.round(random.random((2, 2)) * 100, 3) + UTM for _ in range(2)]


@pytest.mark.parametrize("seed", range(12))
def test_lines_without_heights_contradict_nothing(seed):
    points, lines = survey(seed), pair(seed)
    tin = TIN.from_points(points, breaklines=lines)
    ground = TIN.from_points(points)
    used = np.unique(tin.breaklines)
    assert len(used) > 4
    assert tin.z[used] == pytest.approx(ground.heights(tin.points[used]), abs=1e-6)
    # Their order and direction change nothing.
    other = TIN.from_points(points, breaklines=[line[::-1] for line in lines[::-1]])
    rows, others = (np.lexsort(each.points.T) for each in (tin, other))
    assert (tin.points[rows] == other.points[others]).all()
    assert tin.z[rows] == pytest.approx(other.z[others], abs=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_lines_on_one_plane_agree(seed):
    def plane(xy):
        return 0.5 * (xy[:, 0] - UTM[0]) + 0.3 * (xy[:, 1] - UTM[1])

    points, lines = survey(seed), pair(seed)
    points[:, 2] = plane(points)
    tin = TIN.from_points(points, breaklines=[np.column_stack((x, plane(x))) for x in lines])
    assert np.abs(tin.z - plane(tin.points)).max() < 1e-8


@pytest.mark.parametrize("degrees", [10, 37, 60])
@pytest.mark.parametrize("ends", [(0, 10), (55, 65), (5, 115), (0, 120)])
def test_lines_along_the_rows_of_a_turned_grid(degrees, ends):
    x, y = map(np.ravel, np.meshgrid(np.arange(11.0), np.arange(11.0)))
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    xy = np.column_stack((x * c - y * s, x * s + y * c)) + UTM
    points = np.column_stack((xy, 5 * np.sin(x / 3) + 4 * np.cos(y / 4)))
    tin = TIN.from_points(points, breaklines=[points[list(ends), :2]])
    assert tin.heights(xy) == pytest.approx(points[:, 2])
    assert TIN.from_points(points, boundary=[points[[0, 10, 120, 110], :2]]).nsimplex >= 200


def test_a_line_without_heights_takes_those_of_what_it_meets():
    dike, path = [(1, 2, 9), (3, 2, 9)], [(2, 1), (2, 3)]
    for lines in ([dike, path], [path, dike]):
        tin = TIN.from_points(SQUARE, breaklines=[np.array(line, float) for line in lines])
        assert tin.heights([(2, 1), (2, 2), (2, 3)]).tolist() == [2, 9, 6]
    # A point of a line without a height, on another line.
    half = np.array([(2, 1, 2), (2, 2, np.nan), (2, 3, 6)])
    assert TIN.from_points(SQUARE, breaklines=[np.array(dike, float), half]).heights((2, 2)) == 9


def test_real_contradictions_are_errors_however_small():
    for gap in (1, 1e-3, 1e-6):
        lines = [[(1, 1, 3), (3, 3, 3)], [(1, 3, 3 + gap), (3, 1, 3 + gap)]]
        with pytest.raises(ConflictingValuesError, match="lines") as caught:
            TIN.from_points(SQUARE, breaklines=lines)
        low, high = re.search(r"\(2, 2\): (\S+) to (\S+)\.", str(caught.value)).groups()
        assert float(high) - float(low) == pytest.approx(gap)
        assert TIN.from_points(SQUARE, breaklines=lines, tolerance=1.5 * gap).heights((2, 2)) == 3
    steep = [[(1, 1, 0), (3, 3, 200)], [(1, 3, 0), (3, 1, 200 + 1e-9)]]
    with pytest.raises(ConflictingValuesError, match=r"100 to 100\.00000000\d+"):
        TIN.from_points(SQUARE, breaklines=steep)


def test_tolerance_is_for_points_and_for_lines_at_points():
    twice = [*SQUARE, (2, 1, 1), (2, 1, 1.25)]
    with pytest.raises(ConflictingValuesError, match=r"points .*: 1 to 1\.25\. .*tolerance"):
        TIN.from_points(twice, tolerance=0.125)
    assert TIN.from_points(twice, tolerance=0.25).heights((2, 1)) == 1
    line = [[(1, 1, 1.125), (3, 1, 1.125)]]
    assert TIN.from_points(twice[:-1], breaklines=line, tolerance=0.125).heights((2, 1)) == 1
    for wrong in (-1, np.nan, np.inf):
        with pytest.raises(InputError, match="tolerance must be"):
            TIN.from_points(SQUARE, tolerance=wrong)


def test_a_boundary_with_some_heights_does_not_lose_them():
    ring = np.array([(1, 1, 5), (3, 1, 5), (6, 6, np.nan)])
    with pytest.raises(InputError, match=r"outside the points at \(6, 6\): give it heights"):
        TIN.from_points(SQUARE, boundary=[ring])


@pytest.mark.parametrize("duplicates", ["raise", "min", "max", "mean"])
@pytest.mark.parametrize("side", [1, 4, 40, 400])
def test_points_alone_are_as_points_without_a_line(duplicates: str, side: int) -> None:
    """An empty sequence of lines takes the way of surfaces with lines."""
    rng = np.random.default_rng(side)
    # Few places: many points are at one; heights differ there.
    points = rng.integers(0, side, (2_000, 3)) + rng.random((2_000, 3)) * (side == 1)
    points[:, :2] *= 0.1
    found: list[Any] = []
    for lines in ({}, {"breaklines": []}):
        try:
            found.append(TIN.from_points(points, duplicates=duplicates, **lines))
        except ConflictingValuesError as error:
            found.append(error)
    alone, lined = found
    if isinstance(alone, ConflictingValuesError):
        assert str(alone) == str(lined)
        np.testing.assert_array_equal(alone.rows, lined.rows)
        return
    for name in ("points", "z", "simplices", "neighbors", "breaklines", "soft"):
        one, other = getattr(alone, name), getattr(lined, name)
        assert one.dtype == other.dtype
        np.testing.assert_array_equal(one, other)
