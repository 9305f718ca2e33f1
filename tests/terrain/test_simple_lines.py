"""Contours and bands with fewer points: nothing crosses or changes sides, the distance holds."""

from collections import Counter
from fractions import Fraction
from itertools import combinations, pairwise

import numpy as np
import pytest
import shapely

from delone import InputError
from delone.terrain import TIN
from delone.terrain.generalizing import simplified


def hills(seed, count=2500):
    random = np.random.default_rng(seed)
    xy = random.random((count, 2)) * 100
    x, y = xy.T
    z = 8 * np.sin(x / 9) * np.cos(y / 7) + random.random(count) * 2
    return TIN.from_points(np.column_stack((xy, z)))


def pieces(lines):
    return [line[k : k + 2] for line in lines for k in range(len(line) - 1)]


def side(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = (map(Fraction, p) for p in (a, b, c))
    found = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (found > 0) - (found < 0)


def cross(p, q):
    """Whether two pieces have a point in common that is not an end of both."""
    (a, b), (c, d) = p.tolist(), q.tolist()
    if max(a[0], b[0]) < min(c[0], d[0]) or max(c[0], d[0]) < min(a[0], b[0]):
        return False
    if max(a[1], b[1]) < min(c[1], d[1]) or max(c[1], d[1]) < min(a[1], b[1]):
        return False
    if a in (c, d) or b in (c, d):
        # Ends in common: they may only go on over each other.
        common, other = (a, b) if a in (c, d) else (b, a)
        away = d if c == common else c
        if side(common, other, away) != 0 or other == away:
            return other == away
        way = [p - q for p, q in zip(other, common, strict=True)]
        return sum(w * (p - q) for w, p, q in zip(way, away, common, strict=True)) > 0
    return side(a, b, c) * side(a, b, d) <= 0 and side(c, d, a) * side(c, d, b) <= 0


def require_no_crossing(lines):
    segments = pieces(lines)
    tree = shapely.STRtree([shapely.LineString(each) for each in segments])
    for k, j in tree.query(tree.geometries).T:
        if k < j:
            assert not cross(segments[k], segments[j]), (segments[k], segments[j])


def around(lines, closed):
    """Return pairs of a closed line and another line inside it."""
    polygons = [
        shapely.Polygon(line) if ring else None for line, ring in zip(lines, closed, strict=True)
    ]
    found = set()
    for k, polygon in enumerate(polygons):
        if polygon is None:
            continue
        shapely.prepare(polygon)
        found |= {
            (k, j) for j, line in enumerate(lines)
            if j != k and shapely.contains_xy(polygon, *line[len(line) // 2])
        }  # fmt: skip
    return found


def lines_of(found):
    return [found.coordinates(k) for k in range(len(found))]


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("tolerance", [0.2, 2.0, 50.0])
def test_lines_do_not_cross_and_stay_where_they_are(seed, tolerance):
    tin = hills(seed)
    full, few = tin.contours(interval=0.7), tin.contours(interval=0.7, simplify=tolerance)
    before, after = lines_of(full), lines_of(few)
    assert few.straightened == len(full.points) - len(few.points) > len(full.points) / 3
    assert np.array_equal(full.level, few.level)
    require_no_crossing(after)
    closed = full.closed.tolist()
    assert closed == few.closed.tolist()
    nested = around(before, closed)
    assert len(nested) > 20
    assert nested == around(after, closed)
    for old, new, ring in zip(before, after, closed, strict=True):
        assert np.array_equal(old[[0, -1]], new[[0, -1]])
        assert set(map(tuple, new.tolist())) <= set(map(tuple, old.tolist()))
        far = shapely.distance(shapely.points(old), shapely.LineString(new)).max()
        assert far <= tolerance * (1 + 1e-12)
        if ring:
            assert len(new) >= 4
            signs = (shapely.LinearRing(each).is_ccw for each in (old, new))
            assert len(set(signs)) == 1


def test_a_line_does_not_jump_over_a_peak():
    bend = np.array([(0.0, 0), (5, 3), (10, 0)])
    peak = np.array([(4.0, 1), (6, 1), (5, 2), (4, 1)])
    for lines in ([bend, peak], [peak, bend]):
        starts = np.cumsum([0, *map(len, lines)])
        points, found = simplified(np.concatenate(lines), starts, 10.0)
        assert np.array_equal(found, starts)
        assert len(points) == 7
    alone, _ = simplified(bend, np.array([0, 3]), 10.0)
    assert alone.tolist() == [[0, 0], [10, 0]]
    # A point exactly on the new piece is in the way, too; just beside it is not.
    for y, count in ((0.0, 3), (-1e-300, 2)):
        lines = [bend, np.array([(5, y), (5, -9.0)])]
        points, found = simplified(np.concatenate(lines), np.array([0, 3, 5]), 10.0)
        assert found[1] == count


def test_the_distance_is_that_of_all_points_left_out():
    turn = np.linspace(0, np.pi, 1001)
    arc = np.column_stack((np.cos(turn), np.sin(turn))) * 100
    for tolerance in (0.01, 1, 20):
        points, starts = simplified(arc, np.array([0, 1001]), tolerance)
        far = shapely.distance(shapely.points(arc), shapely.LineString(points))
        assert tolerance / 20 < far.max() <= tolerance
        assert starts[-1] == len(points)
    # Not far from the ideal: chords of an arc with that height.
    assert len(simplified(arc, np.array([0, 1001]), 1.0)[0]) < 2.2 * np.pi / (2 * np.arccos(0.99))


@pytest.mark.parametrize("tolerance", [0.5, 3.0])
def test_every_point_that_is_left_has_a_reason(tolerance):
    full = hills(5, 700).contours(interval=0.7)
    few, starts = simplified(full.points, full.starts, tolerance)
    tree = shapely.STRtree(shapely.points(few))
    for k, old in enumerate(lines_of(full)):
        new = few[starts[k] : starts[k + 1]]
        at = [np.flatnonzero((old == each).all(axis=1))[0] for each in new]
        if (old[0] == old[-1]).all():
            at[-1] = len(old) - 1
            if len(new) == 4:
                continue
        for i in range(1, len(new) - 1):
            piece = shapely.LineString(new[[i - 1, i + 1]])
            between = shapely.points(old[at[i - 1] + 1 : at[i + 1]])
            if shapely.distance(between, piece).max() > tolerance * (1 - 1e-12):
                continue
            corners = new[i - 1 : i + 2].tolist()
            box = shapely.box(*np.min(corners, axis=0), *np.max(corners, axis=0))
            near = [few[j].tolist() for j in tree.query(box, predicate="intersects")]
            a, b, c = corners
            signs = [
                {side(a, b, p), side(b, c, p), side(c, a, p)} for p in near if p not in corners
            ]
            assert any(not {-1, 1} <= each for each in signs)


def test_straight_lines_keep_their_ends_only():
    line = np.column_stack((np.arange(9.0), np.arange(9.0)))
    points, _ = simplified(line, np.array([0, 9]), 1e-300)
    assert points.tolist() == [[0, 0], [8, 8]]
    tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
    assert len(tin.contours([3.0], simplify=1e-9).points) == 2


def test_closed_lines_keep_three_points():
    turn = np.linspace(0, 2 * np.pi, 13)
    ring = np.column_stack((np.cos(turn), np.sin(turn)))
    ring[-1] = ring[0]
    for size in (13, 7, 6, 5, 4):
        part = np.vstack((ring[: size - 1], ring[:1]))
        points, _ = simplified(part, np.array([0, size]), 100.0)
        assert len(points) == 4
        assert abs(shapely.Polygon(points).area) > 0.05


def test_lines_that_touch_still_touch():
    a = np.array([(0.0, 0), (4, 0.5), (5, 1), (6, 0.5), (10, 0)])
    b = np.array([(0.0, 9), (4, 2), (5, 1), (6, 2), (10, 9)])
    points, starts = simplified(np.concatenate((a, b)), np.array([0, 5, 10]), 3.0)
    for k in range(2):
        assert [5, 1] in points[starts[k] : starts[k + 1]].tolist()


@pytest.mark.parametrize("count", [900, 6000])
def test_the_direction_of_lines_changes_nothing(count):
    full = hills(3, count).contours(interval=0.5)
    lines = lines_of(full)
    order = np.random.default_rng(0).permutation(len(lines))
    one, first = simplified(full.points, full.starts, 0.5)
    turned = [lines[k][::-1] for k in order]
    two, second = simplified(
        np.concatenate(turned), np.cumsum([0, *(len(each) for each in turned)]), 0.5
    )
    for at, k in enumerate(order.tolist()):
        assert np.array_equal(one[first[k] : first[k + 1]], two[second[at] : second[at + 1]][::-1])


def lattice(seed):
    """Heights at levels: plateaus, lines through vertices, and lines that touch the outline."""
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(30.0), np.arange(30.0))
    z = random.integers(0, 5, x.shape)
    return TIN.from_points(np.column_stack((x.ravel(), y.ravel(), z.ravel())))


def bay(seed):
    """An outline that is not convex, with a hole."""
    random = np.random.default_rng(seed)
    xy = random.random((1200, 2)) * 100
    z = 8 * np.sin(xy[:, 0] / 9) * np.cos(xy[:, 1] / 7) + random.random(1200) * 2
    outline = np.array([(0.0, 0), (100, 0), (100, 100), (50, 20), (0, 100)])
    hole = np.array([(30.0, 10), (60, 12), (50, 18), (45, 14)])
    return TIN.from_points(np.column_stack((xy, z)), boundary=[outline], holes=[hole])


def cliff(seed):
    """A wall between neighboring doubles: of the three levels in it, two have the same line."""
    random = np.random.default_rng(seed)
    y = np.arange(41.0)
    foot = 64.0 + random.integers(0, 4, len(y))
    wall = [(foot, 0.5), (np.nextafter(foot, np.inf), 3.5)]
    xy = random.random((400, 2)) * [128, 40]
    xy = xy[np.abs(xy[:, 0] - 66) > 6]
    z = np.where(xy[:, 0] < 66, 0.5, 3.5) + 1.5 * np.sin(xy[:, 0] / 5) * np.cos(xy[:, 1] / 4)
    edges = [np.column_stack((x, y, np.full(len(y), height))) for x, height in wall]
    return TIN.from_points(np.column_stack((xy, z)), breaklines=edges)


def sides_of(lines):
    """Return how often there is each side of lines, whatever its direction."""
    return Counter(frozenset(map(tuple, side.tolist())) for side in pieces(lines))


def rings_of(found):
    return [found.points[a:b] for a, b in pairwise(found.ring_starts.tolist())]


def area(ring):
    """Twice the area, exactly."""
    points = [(Fraction(x), Fraction(y)) for x, y in ring.tolist()]
    return sum(a * d - b * c for (a, b), (c, d) in pairwise(points))


SURFACES = {"hills": lambda seed: hills(seed, 1200), "lattice": lattice, "bay": bay, "cliff": cliff}


@pytest.mark.parametrize("kind", SURFACES)
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("tolerance", [0.3, 3.0, 1e3])
def test_bands_have_the_borders_of_contours(kind, seed, tolerance):
    tin = SURFACES[kind](seed)
    every, few = tin.bands(interval=1), tin.bands(interval=1, simplify=tolerance)
    lines = tin.contours(interval=1, simplify=tolerance)
    assert few.straightened == lines.straightened > 0
    sides, before = sides_of(rings_of(few)), sides_of(rings_of(every))
    borders = sides_of(lines_of(lines))
    # Each side of a contour is a border of two polygons, or along the outline, which stays.
    outline = {side for side, count in before.items() if count == 1}
    assert max(sides.values()) == 2
    assert all(sides[side] == 2 or side in outline for side in borders)
    assert {side for side, count in sides.items() if count == 1} == outline
    assert {side for side, count in sides.items() if count == 2} <= borders.keys()
    # Nothing crosses, so polygons are what their rings enclose.
    require_no_crossing([np.array(list(side)) for side in sides])
    first = set(few.polygon_starts[:-1].tolist())
    for k, ring in enumerate(rings_of(few)):
        assert (area(ring) > 0) == (k in first)
    assert sum(map(area, rings_of(few))) == sum(map(area, rings_of(every)))
    assert len(few) + few.flattened == len(every)
    assert shapely.is_valid(few.to_shapely()).all()


def heights_beside(found):
    """Return the lowest heights of the polygons on both sides of each border."""
    polygon = np.repeat(np.arange(len(found)), np.diff(found.polygon_starts))
    beside = {}
    for ring, low in zip(rings_of(found), found.low[polygon].tolist(), strict=True):
        for border in sides_of([ring]):
            beside.setdefault(border, []).append(low)
    return {border: lows for border, lows in beside.items() if len(lows) == 2}


@pytest.mark.parametrize("seed", [0, 1])
def test_borders_of_bands_two_levels_apart_stay(seed):
    tin = cliff(seed)
    levels = [0.0, 1.0, 2.0, 3.0, 4.0]
    every, few = tin.bands(levels), tin.bands(levels, simplify=1e3)
    steep = {side for side, lows in heights_beside(every).items() if abs(lows[0] - lows[1]) == 2}
    assert len(steep) > 40
    # Contours of both levels pass there, and keep the points in which they touch.
    lines = sides_of(lines_of(tin.contours(levels, simplify=1e3)))
    assert all(lines[side] == 2 for side in steep)
    after = heights_beside(few)
    assert steep <= after.keys()
    assert steep == {side for side, lows in after.items() if abs(lows[0] - lows[1]) == 2}
    assert few.straightened > 0


def test_a_polygon_that_becomes_flat_is_counted():
    # The contour goes around the middle of a straight outline, from one vertex to another.
    low = [(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0), (4, 2, 0)]
    tin = TIN.from_points([*low, (3, 0, 4), (5, 0, 4), (4, 0, 6), (4, 1, 4)])
    every, few = tin.bands([4.0]), tin.bands([4.0], simplify=9.0)
    assert (len(every), len(few), few.flattened) == (2, 2, 0)
    # Without the vertex between, nothing is left of the polygon but a side of the outline.
    tin = TIN.from_points([*low, (3, 0, 4), (5, 0, 4), (4, 1, 4)])
    every, few = tin.bands([4.0]), tin.bands([4.0], simplify=9.0)
    assert (len(every), len(few), few.flattened, few.straightened) == (2, 1, 1, 1)
    assert few.to_shapely()[0].area == 81
    assert tin.contours([4.0], simplify=9.0).points.tolist() == [[5, 0], [3, 0]]
    assert sum(lattice(seed).bands(interval=1, simplify=9).flattened for seed in range(3)) > 0


def test_none_and_bad_values():
    tin = hills(0, 200)
    assert tin.contours([1000.0], simplify=1.0).straightened == 0
    assert tin.contours(interval=1).straightened == 0
    for bad in (-1, np.nan, np.inf):
        with pytest.raises(InputError, match="simplify must be"):
            tin.contours(interval=1, simplify=bad)
        with pytest.raises(InputError, match="simplify must be"):
            tin.bands(interval=1, simplify=bad)
    assert (tin.bands(interval=1).straightened, tin.bands([1e3], simplify=1).straightened) == (0, 0)


def test_the_judge_sees_crossings():
    crossing = [np.array([(0.0, 0), (2, 2)]), np.array([(0.0, 2), (2, 0)])]
    with pytest.raises(AssertionError):
        require_no_crossing(crossing)
    assert not any(cross(p, q) for p, q in combinations(pieces([np.eye(2), np.eye(2) + 3]), 2))
