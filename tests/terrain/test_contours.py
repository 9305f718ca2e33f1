"""Contours and bands: closed, simple, never crossing, and a tiling; decided by fractions."""

from __future__ import annotations

from collections import Counter
from decimal import Decimal
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest

from delone import BudgetExceededError, InputError, _core
from delone.interpolate import Grid
from delone.terrain import TIN
from delone.terrain.smoothing import _changed_order as changed_order
from delone.terrain.smoothing import smoothed

shapely = pytest.importorskip("shapely")


def lattice(side: int, seed: int, high: int = 4) -> TIN:
    """A raster of small integers: plateaus, saddles and vertices at every level."""
    x = np.arange(float(side))
    z = np.random.default_rng(seed).integers(0, high, (side, side)).astype(float)
    return TIN.from_raster(Grid(z, x, x))


def scattered(seed: int, needles: float | None = None) -> TIN:
    """Random points; `needles` adds points on a strip of that height."""
    rng = np.random.default_rng(seed)
    xy = rng.random((60, 2)) * [3, 2]
    if needles is not None:
        strip = rng.random((30, 2)) * [1, needles] + 1
        xy = np.concatenate((xy, strip, [(0, 0), (3, 0), (3, 2), (0, 2)]))
    z = rng.integers(0, 6, len(xy)) * 1.0 if seed % 2 else rng.random(len(xy)) * 5
    return TIN.from_points(np.column_stack((xy, z)), duplicates="max")


def orientation(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in p] for p in (a, b, c))
    turn = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (turn > 0) - (turn < 0)


def cross(s, t):
    """Whether two segments have a point in common other than a common end."""
    (a, b), (c, d) = s, t
    for k in range(2):
        if max(a[k], b[k]) < min(c[k], d[k]) or max(c[k], d[k]) < min(a[k], b[k]):
            return False
    common = {a, b} & {c, d}
    sides = orientation(a, b, c), orientation(a, b, d), orientation(c, d, a), orientation(c, d, b)
    if common:
        (p,) = common
        (q,), (r,) = {a, b} - common, {c, d} - common
        return sides[0] == sides[1] == 0 and (q > p) == (r > p)
    return sides[0] * sides[1] <= 0 and sides[2] * sides[3] <= 0


def segments_of(points, starts):
    rows = [[tuple(p) for p in points[i:j].tolist()] for i, j in pairwise(starts)]
    return [segment for row in rows for segment in pairwise(row)]


def assert_nothing_crosses(segments):
    order = sorted(segments, key=lambda s: min(s[0][0], s[1][0]))
    for i, s in enumerate(order):
        right = max(s[0][0], s[1][0])
        for t in order[i + 1 :]:
            if min(t[0][0], t[1][0]) > right:
                break
            assert not cross(s, t), (s, t)


SURFACES = [
    *(pytest.param(lattice(side, seed), id=f"{side}x{side}-{seed}")
      for side in (2, 3, 4, 5, 7) for seed in range(12)),
    *(pytest.param(scattered(seed), id=f"scattered-{seed}") for seed in range(6)),
    *(pytest.param(scattered(seed, needles), id=f"needles-{needles}-{seed}")
      for needles in (3e-16, 1e-15, 1e-12) for seed in range(6)),
]  # fmt: skip
LEVELS = [0.5, 1, 2, 2.75, 3, 4]


@pytest.mark.parametrize("tin", SURFACES)
@pytest.mark.sampled(13)
def test_contours_are_simple_and_never_cross(tin):
    found = tin.contours(LEVELS)
    lines = [found.coordinates(k) for k in range(len(found))]
    for line in lines:
        rows = [tuple(p) for p in line.tolist()]
        closed = rows[0] == rows[-1]
        assert len(set(rows)) == len(rows) - closed
        assert len(rows) >= (4 if closed else 2)
    segments = segments_of(found.points, found.starts)
    assert len(set(segments)) == len(segments)
    assert_nothing_crosses(segments)


@pytest.mark.parametrize("tin", SURFACES)
def test_open_contours_end_at_the_outline(tin):
    found = tin.contours(LEVELS)
    outline = shapely.multilinestrings(tin.points[tin.boundary])
    for k in np.flatnonzero(~found.closed):
        ends = found.coordinates(k)[[0, -1]]
        assert (shapely.distance(shapely.points(ends), outline) < 1e-12).all()


@pytest.mark.parametrize("tin", SURFACES)
def test_bands_tile_the_surface_by_their_shared_vertices(tin):
    found = tin.bands(LEVELS)
    assert shapely.is_valid(found.to_shapely()).all()
    sides = Counter(segments_of(found.points, found.ring_starts))
    assert set(sides.values()) == {1}
    # A side without a reverse is on the outline. What the rings enclose is what these enclose.
    rim = [s for s in sides if s[::-1] not in sides]

    def twice_area(edges):
        return sum(
            Fraction(a[0]) * Fraction(b[1]) - Fraction(a[1]) * Fraction(b[0]) for a, b in edges
        )

    assert twice_area(sides) == twice_area(rim)
    vertices = {tuple(p) for p in tin.points[tin.boundary].reshape(-1, 2).tolist()}
    assert vertices <= {p for side in rim for p in side}
    # Sides within are contours.
    contours = tin.contours(LEVELS)
    lines = {frozenset(s) for s in segments_of(contours.points, contours.starts)}
    assert {frozenset(s) for s in sides if s[::-1] in sides} <= lines


@pytest.mark.parametrize("tin", SURFACES[::3])
def test_heights_in_bands_are_between_their_levels(tin):
    found = tin.bands(LEVELS)
    inner = shapely.point_on_surface(found.to_shapely())
    z = tin.heights(shapely.get_coordinates(inner))
    wide = shapely.area(found.to_shapely()) > 1e-9
    assert ((z >= found.low - 1e-9) & (z <= found.high + 1e-9))[wide].all()


@pytest.mark.parametrize("seed", range(5))
def test_contours_do_not_depend_on_the_order_of_points(seed):
    rng = np.random.default_rng(seed)
    xyz = np.column_stack((rng.random((200, 2)), rng.integers(0, 5, 200)))
    one = TIN.from_points(xyz).contours(LEVELS)
    other = TIN.from_points(xyz[rng.permutation(200)]).contours(LEVELS)
    assert np.array_equal(one.points, other.points)
    assert np.array_equal(one.starts, other.starts)
    scaled = TIN.from_points(xyz * 2.0**40).contours(np.array(LEVELS) * 2.0**40)
    assert np.array_equal(one.points * 2.0**40, scaled.points)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.sampled(3)
def test_levels_a_few_roundings_apart(seed):
    # Contours are less than a unit in the last place of the coordinates apart: most would cross.
    rng = np.random.default_rng(seed)
    xyz = np.column_stack((rng.random((6, 2)) + 2.0**20, rng.random(6)))
    tin = TIN.from_points(xyz)
    levels = np.median(xyz[:, 2]) + np.arange(30) * 2.0**-33 * rng.choice([0.5, 1, 2, 4])
    found = tin.contours(levels)
    # Merged lines of different levels may coincide.
    segments = {frozenset(s) for s in segments_of(found.points, found.starts)}
    assert len(segments) > 30
    assert_nothing_crosses([tuple(sorted(s)) for s in segments])
    assert shapely.is_valid(tin.bands(levels).to_shapely()).all()


def test_higher_ground_is_to_the_left():
    hill = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)]
    up, down = (TIN.from_points([(x, y, sign * z) for x, y, z in hill]) for sign in (1, -1))
    assert shapely.is_ccw(shapely.linearrings(up.contours([1.0]).points))
    assert not shapely.is_ccw(shapely.linearrings(down.contours([-1.0]).points))


@pytest.mark.parametrize(
    ("heights", "count"),
    [
        # A peak exactly at the level collapses; so does a ridge, and a plateau does not.
        ({12: 1.0}, 0),
        ({11: 1.0, 12: 1.0}, 0),
        ({6: 1.0, 7: 1.0, 11: 1.0, 12: 1.0}, 1),
        # Two plateaus that touch at a vertex are two rings, also around the other diagonal.
        (dict.fromkeys((7, 8, 11, 12, 13, 16, 17), 1.0), 2),
        (dict.fromkeys((6, 7, 11, 12, 13, 17, 18), 1.0), 1),
    ],
)
def test_vertices_at_the_level(heights, count):
    x = np.arange(5.0)
    z = np.zeros(25)
    z[list(heights)] = list(heights.values())
    found = TIN.from_raster(Grid(z.reshape(5, 5), x, x)).contours([1.0])
    assert len(found) == count
    assert found.closed.all()


def test_levels_of_an_interval():
    tin = TIN.from_points([(0, 0, -1.2), (1, 0, 2.6), (0, 1, 1)])
    found = tin.contours(interval=0.5, base=0.1, index=2)
    assert found.levels == pytest.approx([-0.9, -0.4, 0.1, 0.6, 1.1, 1.6, 2.1, 2.6])
    assert set(found.level[found.index]) == {-0.9, 0.1, 1.1, 2.1}


def test_too_many_levels_are_refused_before_the_work():
    tin = TIN.from_points([(0, 0, 0), (1, 0, 1e9), (0, 1, 1)])
    with pytest.raises(BudgetExceededError, match=r"1e\+09 levels"):
        tin.contours(interval=1)
    with pytest.raises(BudgetExceededError) as caught:
        tin.contours(interval=1e4, max_points=1000)
    # Two edges, of 100,001 levels each.
    assert caught.value.found == 200_000
    with pytest.raises(InputError, match="either levels= or interval="):
        tin.contours()
    with pytest.raises(InputError, match="NaN or infinity"):
        tin.contours([0.0, np.nan])


def rotated(side: int, degrees: float, kind: str, shift=(0.0, 0.0)) -> TIN:
    """A raster whose straight sides are no longer parallel to an axis, with a plane or hills."""
    x, y = np.arange(float(side)), np.arange(float(side))
    if kind == "dense":
        x = np.unique(np.concatenate((x, x[:-1] + 0.125)))
    x, y = (each.ravel() for each in np.meshgrid(x, y))
    z = x + 2 * y + (np.sin(3 * x) + np.cos(2 * y) if kind == "hills" else 0)
    if kind == "sheared":
        x = x + 0.3 * y
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return TIN.from_points(np.column_stack((x * c - y * s + shift[0], x * s + y * c + shift[1], z)))


@pytest.mark.parametrize("kind", ["plane", "hills", "dense", "sheared"])
@pytest.mark.parametrize("degrees", [5, 25, 45, 60, 85])
@pytest.mark.sampled(8)
def test_rotated_rasters_have_contours(kind, degrees):
    tin = rotated(25, degrees, kind, (500_000.0, 5_400_000.0))
    levels = np.linspace(tin.z.min(), tin.z.max(), 23)
    found = tin.contours(levels)
    assert_nothing_crosses(segments_of(found.points, found.starts))
    assert np.count_nonzero(found.level == levels[11]) >= 1
    # Each point lies where the surface has this height, within the rounding of coordinates. At the
    # sides a hill is as steep as a cliff, in triangles that are a few roundings high.
    every = np.repeat(found.level, np.diff(found.starts))
    outline = shapely.multilinestrings(tin.points[tin.boundary])
    inside = shapely.distance(shapely.points(found.points), outline) > 1e-6
    assert inside.mean() > 0.8
    assert np.abs(tin.heights(found.points) - every)[inside].max() < 1e-6
    if kind != "hills":
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        x, y = ((found.points - (500_000.0, 5_400_000.0)) @ [[c, -s], [s, c]]).T
        x = x - 0.3 * y if kind == "sheared" else x
        assert np.abs(x + 2 * y - every).max() < 1e-6
    bands = tin.bands(levels)
    assert shapely.is_valid(bands.to_shapely()).all()
    sides = Counter(segments_of(bands.points, bands.ring_starts))
    assert set(sides.values()) == {1}
    assert shapely.area(bands.to_shapely()).sum() == pytest.approx(tin.areas.sum(), rel=1e-9)
    assert 0 <= bands.left_out <= 4 * 49


def test_six_points_along_a_line_have_contours():
    a, b = np.array([0.9715348278780412, -0.23689676701041085]), np.array([2.2, 0.75])
    xy = [0 * a, a, 2 * a, 3 * a, b, 1.42 * b]
    tin = TIN.from_points(np.column_stack((xy, [3.0, 4.0, 4.0, 3.0, 2.0, 0.0])))
    for level in np.linspace(0.1, 3.95, 40):
        found = tin.contours([level])
        assert_nothing_crosses(segments_of(found.points, found.starts))
        assert len(found)


@pytest.mark.parametrize("kind", ["plane", "hills"])
def test_contours_do_not_cross_where_triangles_are_collapsed(kind):
    """The last resort, in some triangles and in all."""
    tin = rotated(12, 25, kind)
    sheet, levels = tin._sheet(), np.linspace(tin.z.min(), tin.z.max(), 9)
    for share in (0.1, 0.5, 1.0):
        collapsed = np.random.default_rng(3).random(len(tin.simplices)) < share
        made = _core.contour_lines2(sheet, levels, 10**6, collapsed, True, 1)
        while len(made.tangled):
            assert not collapsed[made.tangled].any()
            collapsed[made.tangled] = True
            made = _core.contour_lines2(sheet, levels, 10**6, collapsed, True, 1)
        # Lines of several levels may pass along the same edge.
        assert_nothing_crosses({tuple(sorted(s)) for s in segments_of(made.points, made.starts)})
        assert len(made.starts) > 1


@pytest.mark.parametrize("seed", range(6))
def test_thin_triangles_inside_have_contours(seed):
    """Along a breakline that is straight up to rounding, with cliffs between its points."""
    rng = np.random.default_rng(seed)
    along = np.sort(rng.random(14))[:, None] * [0.9, 0.31] + [0.01, 0.3]
    line = np.column_stack((along, rng.integers(0, 9, 14)))
    frame = [(0, 0, 1), (1, 0, 7), (1, 1, 2), (0, 1, 5)]
    tin = TIN.from_points(
        np.concatenate((frame, line)), breaklines=[line[[0, -1]]], crossing="mean"
    )
    found = tin.contours(interval=0.37)
    assert_nothing_crosses({tuple(sorted(s)) for s in segments_of(found.points, found.starts)})
    assert shapely.is_valid(tin.bands(found.levels).to_shapely()).all()


@pytest.mark.parametrize("step", [1.0, 0.01])
def test_any_number_of_workers_draws_the_same(step):
    """With triangles for several threads, and levels with many and with few points."""
    rng = np.random.default_rng(4)
    xy = rng.random((30_000, 2))
    z = np.round(9 * np.sin(7 * xy[:, 0]) * np.cos(5 * xy[:, 1]) + rng.random(len(xy)), 2)
    made = []
    for workers in (1, 2, 3, 16):
        tin = TIN.from_points(np.column_stack((xy, z)), workers=workers)
        levels = np.arange(-12, 12, step)
        lines, areas = tin.contours(levels), tin.bands(levels[::10])
        made.append([lines.points, lines.starts, lines.level, areas.points, areas.ring_starts])
        made[-1] += [areas.polygon_starts, areas.low]
    assert len(made[0][1]) > 30
    for other in made[1:]:
        for one, another in zip(made[0], other, strict=True):
            assert np.array_equal(one, another)


def test_contours_of_many_points_do_not_depend_on_the_order_of_rows():
    """Levels are heights of vertices in all parts of the arrays."""
    rng = np.random.default_rng(6)
    xyz = np.column_stack((rng.random((40_000, 2)), rng.integers(0, 6, 40_000)))
    one, other = (TIN.from_points(rows).contours(range(6)) for rows in (xyz, xyz[::-1]))
    assert np.array_equal(one.points, other.points)
    assert np.array_equal(one.starts, other.starts)


@pytest.mark.parametrize("rounds", [1, 2, 3, 5])
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.sampled(6)
def test_smoothed_contours_do_not_cross(seed, rounds):
    tin = lattice(5, seed)
    plain, smooth = tin.contours(interval=0.5), tin.contours(interval=0.5, smooth=rounds)
    assert len(smooth) == len(plain)
    assert len(smooth.points) > len(plain.points)
    assert np.array_equal(smooth.closed, plain.closed)
    assert shapely.is_simple(smooth.to_shapely()).all()
    assert_nothing_crosses(segments_of(smooth.points, smooth.starts))


def meetings(found) -> tuple[set, set]:
    """The pairs of lines that have a point in common, and those that share inner points only."""
    lines = found.to_shapely()
    tree = shapely.STRtree(lines)
    pairs = {(i, j) for i, j in tree.query(lines, predicate="intersects").T.tolist() if i < j}
    return pairs, {(i, j) for i, j in pairs if shapely.crosses(lines[i], lines[j])}


@pytest.mark.parametrize("rounds", [1, 2, 3])
def test_smoothed_contours_of_nearly_equal_levels_do_not_meet(rounds):
    """Four levels, one unit in the last place apart: most nodes are at the same place."""
    levels = [2.3]
    for _ in range(3):
        levels.append(float(np.nextafter(levels[-1], 9)))
    met = grown = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        points = np.column_stack((rng.integers(0, 9, (60, 2)), rng.integers(0, 6, 60)))
        tin = TIN.from_points(points.astype(float), duplicates="max")
        plain, smooth = tin.contours(levels), tin.contours(levels, smooth=rounds)
        grown += len(smooth.points) - len(plain.points)
        for before, after in zip(meetings(plain), meetings(smooth), strict=True):
            assert after <= before
            met += len(before)
        simple = shapely.is_simple(plain.to_shapely())
        assert shapely.is_simple(smooth.to_shapely())[simple].all()
    assert met > 100 and grown > 100


def test_smoothing_ends_with_lines_that_cross() -> None:
    """Lines that cross before they are smoothed are returned as they are."""
    points = np.array([(0, 0), (1, 1), (2, 0), (0, 0.5), (1, 0.4), (2, 0.5)])
    starts = np.array([0, 3, 6])
    found, begin = smoothed(points, starts, None, 2)
    assert (found == points).all() and (begin == starts).all()


@pytest.mark.parametrize(
    ("other", "crosses"),
    [
        ([(0, 2), (1, 1), (2, 2)], False),
        ([(2, 2), (1, 1), (0, 2)], False),
        ([(0.5, 0), (1, 1), (1.5, 0)], False),
        ([(0, 2), (1, 1), (1, 0)], True),
        ([(1, 0), (1, 1), (0, 2)], True),
        ([(0, 2), (1, 1), (2, np.nextafter(0, -1))], True),
        ([(0, 2), (1, 1), (2, 0)], True),
    ],
)
def test_lines_that_cross_where_they_meet_are_found(other, crosses):
    points = np.array([(0, 0), (1, 1), (2, 0), (5, 5), (6, 6), *other], dtype=np.float64)
    found = changed_order(points, np.array([0, 3, 5, 8]), np.array([1, 6]))
    assert found.tolist() == ([0, 2, 5, 7] if crosses else [])


def test_smoothing_keeps_corners_at_hard_breaklines():
    z = [(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)]
    dike = [(0, 2, 6), (4, 2, 5)]
    hard = TIN.from_points(z, breaklines=[dike]).contours([5.5], smooth=2)
    soft = TIN.from_points(z, soft_breaklines=[dike]).contours([5.5], smooth=2)
    assert [2.0, 2.0] in hard.points.tolist()
    assert [2.0, 2.0] not in soft.points.tolist()


def test_contours_skip_holes_and_bays():
    x = np.arange(9.0)
    grid = np.array([(i, j, i) for i in x for j in x])
    tin = TIN.from_points(grid, holes=[[(2.5, 2.5), (5.5, 2.5), (5.5, 5.5), (2.5, 5.5)]])
    found = tin.contours([4.25])
    assert len(found) == 2
    assert tin.contours([1.5]).points[:, 0] == pytest.approx(1.5)
    bands = tin.bands([4.25])
    assert shapely.area(bands.to_shapely()).sum() == pytest.approx(64 - 9)


@pytest.mark.parametrize(("interval", "base"), [(0.1, 0.0), (0.3, 0.05), (0.01, -1.07), (2.5, 1e6)])
def test_levels_are_the_doubles_nearest_to_decimal_multiples(interval, base):
    tin = TIN.from_points([(0, 0, base), (1, 0, base + 20), (0, 1, base)])
    found = tin.contours(interval=interval, base=base, index=5)
    step, start = Decimal(repr(interval)), Decimal(repr(base))
    want = [float(start + k * step) for k in range(int(Decimal(20) / step) + 1)]
    assert found.levels.tolist() == want
    assert tin.bands(interval=interval, base=base).low.tolist() == want[: len(tin.bands(want[1:]))]


def test_a_terrace_at_a_level_is_not_below_it():
    terrace = [
        (x, y, 0.3 if 2 <= x <= 6 and 2 <= y <= 6 else 0.0) for x in range(9) for y in range(9)
    ]
    tin = TIN.from_points(terrace)
    assert 0.3 in tin.contours(interval=0.1).level
    assert tin.contours(interval=0.1).level.tolist() == tin.contours([0.1, 0.2, 0.3]).level.tolist()
    # A number of 17 digits is no decimal: the multiples are those of the double.
    third = TIN.from_points([(0, 0, 0), (1, 0, 1), (0, 1, 0)]).contours(interval=1 / 3)
    assert third.levels.tolist() == [0, 1 / 3, 2 / 3, 1]


@pytest.mark.parametrize("smooth", [0, 2])
def test_short_lines_are_left_out_and_counted(smooth):
    rng = np.random.default_rng(2)
    xy = rng.random((2000, 2)) * 100
    tin = TIN.from_points(np.column_stack((xy, xy[:, 0] / 10 + rng.normal(0, 0.2, 2000))))
    every = tin.contours(interval=0.5, smooth=smooth)
    lengths = shapely.length(every.to_shapely())
    found = tin.contours(interval=0.5, smooth=smooth, min_length=5)
    kept = lengths >= 5
    assert found.short == np.count_nonzero(~kept) > 40 and every.short == 0
    assert np.array_equal(found.level, every.level[kept])
    assert np.array_equal(found.index, every.index[kept])
    assert (found.to_shapely() == every.to_shapely()[kept]).all()
    assert np.array_equal(found.levels, every.levels)
    none = tin.contours(interval=0.5, min_length=1e9)
    assert len(none) == 0 and none.short == len(tin.contours(interval=0.5))
    assert none.to_shapely().shape == (0,)
    assert tin.contours([1e9], min_length=1).short == 0
    for bad in (-1, float("nan"), float("inf")):
        with pytest.raises(InputError, match="min_length must be at least 0 and finite"):
            tin.contours(interval=1, min_length=bad)
