"""Profiles, draped lines and lines of sight where they meet holes, corners and needles."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from delone import InputError
from delone.terrain import TIN
from tiers import seeds


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
    with pytest.raises(InputError, match="is outside the surface"):
        tin.drape(shapely.LineString(line))


@pytest.mark.parametrize("end", [3.0000000000000004, 3.000000000000001])
@pytest.mark.parametrize("backward", [False, True])
def test_a_gap_shorter_than_roundings_is_a_gap(end, backward):
    # The line passes above the lower corner of the hole, by less than the distance of doubles.
    points = [(-1, -1, 0), (4, -1, 1), (4, 4, 2), (-1, 4, 3), (1, 1, 1.5), (0.5, 3, 1), (1.5, 3, 2)]
    tin = TIN.from_points(points, holes=[[(1, 1), (0.5, 3), (1.5, 3)]])
    found = tin.profile([(0, 0), (3, end)][:: -1 if backward else 1])
    (gap,) = np.flatnonzero(np.isnan(found.z))
    assert 0 < gap < len(found) - 1
    # Both ends of it are nearly the corner; without the rule they would be one row.
    assert found.points[gap - 1 : gap + 2] == pytest.approx(np.ones((3, 2)), abs=1e-15)
    assert found.z[[gap - 1, gap + 1]] == pytest.approx([1.5, 1.5])
    shapely = pytest.importorskip("shapely")
    with pytest.raises(InputError, match="is outside the surface"):
        tin.drape(shapely.LineString([(0, 0), (3, end)]))


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


def exact_parts(tin: TIN, a, b) -> list[tuple[Fraction, Fraction]]:
    """The parts of a segment in closed triangles, as shares of it: by clipping in fractions."""
    (ax, ay), (bx, by) = ([Fraction(x) for x in end] for end in (a, b))
    found = []
    for triangle in tin.simplices.tolist():
        corners = [[Fraction(x) for x in tin.points[k].tolist()] for k in triangle]
        low, high = Fraction(0), Fraction(1)
        for (px, py), (qx, qy) in zip(corners, corners[1:] + corners[:1], strict=True):
            # The side of the start, and how it changes along the segment.
            at = (qx - px) * (ay - py) - (qy - py) * (ax - px)
            change = (qx - px) * (by - ay) - (qy - py) * (bx - ax)
            if change > 0:
                low = max(low, -at / change)
            elif change < 0:
                high = min(high, -at / change)
            elif at < 0:
                high = Fraction(-1)
        if low <= high:
            found.append((low, high))
    merged: list[tuple[Fraction, Fraction]] = []
    for low, high in sorted(found):
        if merged and low <= merged[-1][1]:
            merged[-1] = merged[-1][0], max(high, merged[-1][1])
        else:
            merged.append((low, high))
    return merged


@pytest.mark.parametrize("seed", seeds(3, deep=20))
def test_parts_are_those_of_closed_triangles(seed):
    # Small integers: most lines pass corners, and many touch the surface in a corner alone.
    random = np.random.default_rng(seed)
    x, y = map(np.ravel, np.meshgrid(np.arange(5.0), np.arange(5.0)))
    points = np.column_stack((x, y, random.integers(0, 9, 25)))
    hole = [(1, 1), (2, 0), (3, 1), (2, 2)], [(2, 2), (3, 3), (2, 4), (1, 3)]
    tins = (
        TIN.from_points(points),
        TIN.from_points(points, holes=[np.array(ring, dtype=float) for ring in hole]),
        TIN.from_points(
            points, boundary=[[(0, 0), (4, 0), (4, 4), (3, 1), (2, 4), (1, 1), (0, 4)]]
        ),
    )
    single = 0
    for _ in range(120):
        tin = tins[random.integers(3)]
        a, b = random.integers(-1, 6, (2, 2)).astype(float)
        if (a == b).all():
            continue
        found = tin.profile([a, b])
        parts = np.split(np.arange(len(found)), np.flatnonzero(np.isnan(found.z)))
        parts = [rows[~np.isnan(found.z[rows])] for rows in parts if len(rows)]
        want = exact_parts(tin, a, b)
        ends = [found.distances[rows[[0, -1]]] / np.hypot(*(b - a)) for rows in parts]
        assert len(parts) == len(want)
        assert np.reshape(ends, -1) == pytest.approx([float(x) for part in want for x in part])
        single += sum(low == high for low, high in want)
    assert single > 5


COMB = [(0, 0), (4, 0), (4, 2), (3, 1), (2, 2), (1, 1), (0, 2)]


def comb(height: float) -> TIN:
    """A surface with three peaks on a line that touches nothing else of it."""
    xyz = [(x, y, height if (x, y) == (2, 2) else 0.0) for x, y in COMB]
    return TIN.from_points(xyz, boundary=[COMB])


def test_a_line_that_touches_peaks_has_their_heights():
    found = comb(100).profile([(0, 2), (4, 2)])
    np.testing.assert_array_equal(found.z, [0, np.nan, 100, np.nan, 0])
    assert found.points[[0, 2, 4]].tolist() == [[0, 2], [2, 2], [4, 2]]
    back = comb(100).profile([(4, 2), (0, 2)])
    np.testing.assert_array_equal(back.distances[::2], 4 - found.distances[::-2])
    # From outside the hull, and along the way through a corner of it.
    square = TIN.from_points([(0, 0, 5), (4, 0, 1), (4, 4, 2), (0, 4, 3)])
    for line, heights in (
        ([(-1, 1), (1, -1)], [5]),
        ([(-1, -1), (0, 0), (-1, 1)], [5]),
        ([(0, 1), (-1, 1)], [4.5]),
        ([(-1, 1), (0, 1)], [4.5]),
        ([(-2, 1), (-1, 1)], []),
    ):
        assert square.profile(line).z.tolist() == heights


def test_peaks_that_are_touched_hide_what_is_behind():
    found = comb(100).line_of_sight((0, 2), (4, 2), height=1, target=1)
    assert not found and found.obstruction.tolist() == [2, 2, 100]
    assert comb(1).line_of_sight((0, 2), (4, 2), height=1, target=1)


def test_draped_lines_lose_no_part_that_is_outside():
    shapely = pytest.importorskip("shapely")
    tin = comb(7)
    for line in (
        [(0, 2), (4, 2)],
        [(1, 0.5), (0, 2), (4, 2)],
        [(0, 2), (4, 2), (3, 0.5)],
        [(0, 2), (2, 2)],
    ):
        with pytest.raises(InputError, match=r"between \(.*\) and \(.*\) is outside the surf"):
            tin.drape(shapely.LineString(line))
    whole = tin.drape(shapely.LineString([(0, 2), (1, 1), (2, 2)]))
    assert shapely.get_coordinates(whole, include_z=True).tolist() == [
        [0, 2, 0],
        [1, 1, 0],
        [2, 2, 7],
    ]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("power", [-1000, -700, 700, 1010])
@pytest.mark.parametrize("line", [[(0.5, 0.25), (3.25, 3.75)], [(0, 1), (3, 1)], [(0, 0), (3, 3)]])
def test_profiles_do_not_depend_on_the_unit_of_coordinates(power, line):
    """Areas of triangles are beyond the doubles then."""
    random = np.random.default_rng(7)
    lattice = [(x, y) for x in range(5) for y in range(5)]
    points = np.vstack((lattice, 4 * random.random((60, 2))))
    z = random.random(len(points))
    plain = TIN.from_points(np.column_stack((points, z))).profile(line)
    scaled = TIN.from_points(np.column_stack((np.ldexp(points, power), z)))
    found = scaled.profile(np.ldexp(np.array(line, dtype=float), power))
    assert len(plain) > 4
    assert np.array_equal(found.z, plain.z)
    assert np.array_equal(np.ldexp(found.distances, -power), plain.distances)
