"""Profiles, draped lines and lines of sight where they meet holes, corners and needles."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from delone import InputError
from delone.terrain import TIN


def exact_crossings(tin: TIN, line) -> list[tuple[float, float]]:
    """Shares of a line and heights where it crosses an edge in its inside, ascending."""
    (ax, ay), (bx, by) = ([Fraction(x) for x in end] for end in np.asarray(line).tolist())
    found = set()
    for u, v in tin.edges.tolist():
        (px, py, pz), (qx, qy, qz) = (map(Fraction, tin.xyz[k].tolist()) for k in (u, v))
        one = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
        two = (bx - ax) * (qy - ay) - (by - ay) * (qx - ax)
        if one * two < 0:
            along = one / (one - two)
            x, y = px + along * (qx - px), py + along * (qy - py)
            share = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / (
                (bx - ax) ** 2 + (by - ay) ** 2
            )
            if 0 < share < 1:
                found.add((float(share), float(pz + along * (qz - pz))))
    return sorted(found)


def test_a_profile_has_a_gap_at_a_hole_between_triangles_that_share_a_corner():
    points = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (5, 5, 9)]
    tin = TIN.from_points(points, holes=[[(4, 4), (6, 4), (5, 5)]])
    line = [(4, 4.8), (6.5, 4.3)]
    found = tin.profile(line)
    assert np.isnan(found.z).sum() == 1
    gap = int(np.flatnonzero(np.isnan(found.z))[0])
    left, right = found.points[gap - 1], found.points[gap + 1]
    assert np.isnan(tin.heights((left + right) / 2))
    # Where the line meets the sides (4, 4)-(5, 5) and (5, 5)-(6, 4).
    assert left == pytest.approx([14 / 3, 14 / 3]) and right == pytest.approx([5.5, 4.5])
    shapely = pytest.importorskip("shapely")
    with pytest.raises(InputError, match="is outside of the surface"):
        tin.drape(shapely.LineString(line))


@pytest.mark.parametrize("seed", range(4))
def test_profiles_across_buildings_have_gaps_where_there_is_no_surface(seed):
    random = np.random.default_rng(seed)
    xy = random.random((200, 2)) * 100
    turn = random.random() * 1.5
    c, s = np.cos(turn), np.sin(turn)
    box = np.array([(0, 0), (9, 0), (9, 6), (0, 6)]) @ np.array([(c, s), (-s, c)])
    holes = [box + np.array([15 + 24 * i, 15 + 24 * j]) for i in range(3) for j in range(3)]
    tin = TIN.from_points(np.column_stack((xy, 10 * np.sin(xy[:, 0] / 10))), holes=holes)
    gaps = 0
    for _ in range(25):
        found = tin.profile(random.random((2, 2)) * 70 + 15)
        gone = np.isnan(found.z)
        gaps += int(gone.sum())
        long = np.hypot(*np.diff(found.points, axis=0).T) > 1e-6
        on = np.flatnonzero(long & ~gone[1:] & ~gone[:-1])
        middle = (found.points[on] + found.points[on + 1]) / 2
        assert tin.heights(middle) == pytest.approx((found.z[on] + found.z[on + 1]) / 2, abs=1e-6)
        off = np.flatnonzero(long & gone[1:])
        assert np.isnan(tin.heights((found.points[off] + found.points[off + 1]) / 2)).all()
    assert gaps > 10


@pytest.mark.parametrize("degrees", [12, 33, 58])
def test_profiles_of_needles_start_and_end_on_the_surface(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    x, y = map(np.ravel, np.meshgrid(np.arange(9.0), np.arange(9.0)))
    xy = np.column_stack((x * c - y * s + 5e5, x * s + y * c + 5.4e6))
    # Lines along the rows of the grid run within a rounding of its points.
    z = 3 * np.sin(x) + 2 * np.cos(y)
    points = np.column_stack((xy, z))
    tin = TIN.from_points(points, boundary=[xy[[0, 8, 80, 72]]])
    random = np.random.default_rng(degrees)
    ends = [xy[[9 * k, 9 * k + 8]] for k in range(1, 8)] + [xy[[k, 72 + k]] for k in range(1, 8)]
    ends += [xy[random.integers(1, 8, (2, 2)) @ (9, 1)] for _ in range(20)]
    for line in ends:
        if (line[0] == line[1]).all() or np.isnan(tin.heights(line)).any():
            continue
        found = tin.profile(line)
        assert not np.isnan(found.z).any()
        assert (found.points[[0, -1]] == line).all()
        assert (np.diff(found.distances) >= 0).all()
        assert found.z.min() >= z.min() and found.z.max() <= z.max()
        assert found.z[[0, -1]] == pytest.approx(tin.heights(line))


def test_heights_where_a_line_crosses_needles():
    tin = TIN.from_points([(0, 0, 0), (1e6, 1e-9, 10), (2e6, 0, 0), (1e6, 9, 5), (1e6, -9, 5)])
    line = np.array([(-1.0, 3e-10), (2e6, -7e-10)])
    want = exact_crossings(tin, line)
    found = tin.profile(line)
    # It enters, crosses two needles and leaves.
    assert len(want) == 4
    assert (found.distances / np.hypot(*(line[1] - line[0]))).tolist() == pytest.approx(
        [share for share, _ in want], rel=1e-12
    )
    assert found.z.tolist() == pytest.approx([z for _, z in want], rel=1e-9)


def test_a_line_through_a_corner_and_along_edges():
    square = [(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8), (2, 2, 9)]
    tin = TIN.from_points(square, holes=[[(0, 0), (4, 0), (2, 2)]])
    along = tin.profile([(0, 0), (4, 4)])
    assert along.points.tolist() == [[0, 0], [2, 2], [4, 4]] and along.z.tolist() == [0, 9, 8]
    back = tin.profile([(5, 5), (-1, -1)])
    assert back.points.tolist() == [[4, 4], [2, 2], [0, 0]] and back.z.tolist() == [8, 9, 0]
    touch = tin.profile([(1, 2), (3, 2)])
    assert touch.z.tolist() == pytest.approx([6.5, 9, 6.5])


def test_lines_of_sight_beside_the_surface():
    points = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (8, 0, 0), (8, 4, 0)]
    tin = TIN.from_points(points, boundary=[[(0, 0), (8, 0), (8, 4), (4, 1), (0, 4)]])
    found = tin.line_of_sight((0, 4), (8, 4))
    assert found and found.obstruction is None
    with pytest.raises(InputError, match=r"\(4, 3\) is outside"):
        tin.line_of_sight((0, 4), (4, 3))
