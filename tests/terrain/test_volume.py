"""Volumes against exact sums of prisms, and against each other."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest

from delone import InputError, LimitError
from delone.terrain import TIN


def surface(seed: int, count: int = 40, scale: float = 1.0, shift=(0.0, 0.0)) -> TIN:
    rng = np.random.default_rng(seed)
    corners = [(0, 0), (8, 0), (8, 8), (0, 8)]
    xy = np.concatenate((corners, rng.integers(0, 9, (count, 2)))) * scale + shift
    xyz = np.column_stack((xy, rng.integers(-4, 5, len(xy))))
    return TIN.from_points(xyz, duplicates="max", planar=True)


def clip(polygon, a, b):
    """The part of a polygon of fractions to the left of a line."""

    def side(p):
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    found = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        s, t = side(p), side(q)
        if s >= 0:
            found.append(p)
        if s * t < 0:
            found.append(tuple(p[k] + s / (s - t) * (q[k] - p[k]) for k in range(2)))
    return found


def plane(corners, values):
    (ax, ay), (bx, by), (cx, cy) = corners
    s, t = values[1] - values[0], values[2] - values[0]
    twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    u = (s * (cy - ay) - t * (by - ay)) / twice
    v = (t * (bx - ax) - s * (cx - ax)) / twice
    return lambda p: values[0] + u * (p[0] - ax) + v * (p[1] - ay)


def positive_part(polygon, height):
    """The integral of the positive part of a linear function over a polygon, and the area."""
    values = [height(p) for p in polygon]
    above = []
    count = len(polygon)
    for k in range(count):
        p, q, s, t = polygon[k], polygon[k - count + 1], values[k], values[k - count + 1]
        if s >= 0:
            above.append(p)
        if s * t < 0:
            above.append(tuple(p[k] + s / (s - t) * (q[k] - p[k]) for k in range(2)))
    volume = area = Fraction(0)
    for p, q in pairwise(above[1:]):
        o = above[0]
        part = ((p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0])) / 2
        area += part
        volume += part * (height(o) + height(p) + height(q)) / 3
    return volume, area


def triangles(tin):
    for rows in tin.simplices:
        corners = [tuple(map(Fraction, p)) for p in tin.points[rows].tolist()]
        yield corners, [Fraction(z) for z in tin.z[rows].tolist()]


def exact(one, other):
    """Cut, fill, both areas, and the area of two surfaces or of a surface and a plane."""
    sums = [Fraction(0)] * 5
    for corners, values in triangles(one):
        below = plane(corners, values)
        pieces = [(corners, other)] if callable(other) else []
        if not callable(other):
            for others, heights in triangles(other):
                piece = corners
                for k in range(3):
                    piece = piece and clip(piece, others[k], others[(k + 1) % 3])
                if len(piece) > 2:
                    pieces.append((piece, plane(others, heights)))
        for piece, above in pieces:
            cut = positive_part(piece, lambda p, above=above, below=below: below(p) - above(p))
            fill = positive_part(piece, lambda p, above=above, below=below: above(p) - below(p))
            whole = positive_part(piece, lambda _: Fraction(1))
            for k, value in enumerate((cut[0], fill[0], cut[1], fill[1], whole[1])):
                sums[k] += value
    return [float(each) for each in sums]


def numbers(found):
    return [found.cut, found.fill, found.cut_area, found.fill_area, found.area]


@pytest.mark.parametrize("seed", range(4))
def test_volumes_between_surfaces_are_sums_of_prisms(seed):
    one, other = surface(seed, 12), surface(seed + 100, 12)
    expected = exact(one, other)
    # Where surfaces coincide, rounding decides whether they are above or below each other.
    assert numbers(one.volume_to(other))[:2] == pytest.approx(expected[:2], rel=1e-12)
    assert one.volume_to(other).area == pytest.approx(64, rel=1e-14)


@pytest.mark.parametrize("seed", range(4))
def test_volumes_to_a_plane_are_sums_of_prisms(seed):
    tin = surface(seed)
    a, b, c = 0.3125, -0.1875, 0.71875
    height = lambda p: Fraction(c) + Fraction(a) * p[0] + Fraction(b) * p[1]  # noqa: E731
    assert numbers(tin.volume_to((a, b, c))) == pytest.approx(exact(tin, height), rel=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_there_and_back_is_the_same(seed):
    one, other = surface(seed, 400), surface(seed + 50, 300)
    there, back = one.volume_to(other), other.volume_to(one)
    assert there.cut == pytest.approx(back.fill, rel=1e-12)
    assert there.fill == pytest.approx(back.cut, rel=1e-12)
    assert there.net == pytest.approx(-back.net, rel=1e-11)


@pytest.mark.parametrize("shift", [0.0, 0.375])
def test_volumes_across_holes_are_sums_of_prisms(shift):
    # One triangle spans the hole and the notch of the other surface, and parts behind them.
    one = TIN.from_points([(-9, -9, 0), (30, -9, 2), (-9, 30, -1)])
    xyz = [(x + shift, y, (x * y) % 5 - 1) for x in range(8) for y in range(8)]
    holes = [[(x + shift, y) for x, y in ((1, 1), (6, 1), (6, 6), (1, 6))]]
    island = TIN.from_points(
        [(x / 2 + 2 + shift, y / 2 + 2, 3) for x in range(4) for y in range(4)]
    )
    other = TIN.from_points(xyz, holes=holes)
    for pair in ((one, other), (other, one), (island, other), (other, island)):
        if island in pair:
            with pytest.warns(UserWarning, match="no area in common"):
                found = pair[0].volume_to(pair[1])
        else:
            found = pair[0].volume_to(pair[1])
        assert numbers(found) == pytest.approx(exact(*pair), rel=1e-12)


def test_large_coordinates_lose_nothing():
    shift = (500_000.0, 5_400_000.0)
    near = surface(1).volume_to(surface(2))
    far = surface(1, shift=shift).volume_to(surface(2, shift=shift))
    assert numbers(far)[:2] == pytest.approx(numbers(near)[:2], rel=1e-12)


def test_the_number_of_threads_changes_no_bit():
    rng = np.random.default_rng(5)
    sheets = []
    for workers in (1, 2, 5):
        rng = np.random.default_rng(5)
        pair = [
            TIN.from_points(rng.random((20_000, 3)), workers=workers),
            TIN.from_points(rng.random((20_000, 3)), workers=workers),
        ]
        sheets.append(pair[0].volume_to(pair[1]).of_triangles)
    assert np.array_equal(sheets[0], sheets[1])
    assert np.array_equal(sheets[0], sheets[2])


def test_many_groups_and_tasks_cover_everything():
    rng = np.random.default_rng(6)
    ground = np.column_stack((rng.random((30_000, 2)), np.zeros(30_000)))
    square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    one = TIN.from_points(np.concatenate((ground, square)))
    other = TIN.from_points([(x, y, x + 2 * y + 3) for x, y, _ in square])
    found = one.volume_to(other)
    assert found.fill == pytest.approx(0.5 + 1 + 3, rel=1e-12)
    assert found.of_triangles[:, 4] == pytest.approx(one.areas, rel=1e-9, abs=1e-15)
    assert found.mean_height.min() > 3


def test_regions_and_holes():
    tin = surface(3)
    flat = TIN.from_points([(0, 0, 9), (8, 0, 9), (8, 8, 9), (0, 8, 9)])
    whole = tin.volume_to(flat)
    left = tin.volume_to(flat, region=[[(0, 0), (3, 0), (3, 8), (0, 8)]])
    right = tin.volume_to(9.0, region=[[(3, 0), (8, 0), (8, 8), (3, 8)]])
    assert left.fill + right.fill == pytest.approx(whole.fill, rel=1e-12)
    assert left.area == pytest.approx(24) and right.area == pytest.approx(40)
    holed = TIN.from_points(tin.xyz, holes=[[(2, 2), (4, 2), (4, 5), (2, 5)]])
    assert holed.volume_to(flat).area == pytest.approx(64 - 6)
    apart = TIN.from_points([(20, 0, 0), (21, 0, 0), (20, 1, 0)])
    with pytest.warns(UserWarning, match="no area in common"):
        assert numbers(tin.volume_to(apart)) == [0.0] * 5


def test_regions_of_shapely():
    shapely = pytest.importorskip("shapely")
    tin = surface(3)
    ring = shapely.box(1, 1, 7, 7) - shapely.box(2, 2, 4, 4)
    assert tin.volume_to(0.0, region=ring).area == pytest.approx(32)
    assert tin.volume_to(0.0, region=[ring, shapely.box(2, 2, 4, 4)]).area == pytest.approx(36)


def test_other_systems_and_values_are_refused():
    meters = TIN.from_points([(0, 0, 0), (1, 0, 0), (0, 1, 0)], crs="EPSG:28992")
    feet = TIN.from_points([(0, 0, 0), (1, 0, 0), (0, 1, 0)], crs="EPSG:2269")
    with pytest.raises(InputError, match="EPSG:28992 and in EPSG:2269"):
        meters.volume_to(feet)
    for wrong in (np.nan, (1, 2), (1, 2, np.inf)):
        with pytest.raises(InputError, match="other must be"):
            meters.volume_to(wrong)


@pytest.mark.parametrize("size", [1e150, 1e200, 1e300])
def test_volumes_beyond_doubles_are_refused(size: float) -> None:
    """Otherwise cut and fill would be infinite, and their difference NaN."""
    points = np.random.default_rng(5).random((30, 3)) * size
    tin = TIN.from_points(points)
    shift = np.random.default_rng(6).uniform(-size, size, 30) / 2
    others = TIN.from_points(points + np.column_stack((0 * shift, 0 * shift, shift)))
    for other in (size / 2, (0.1, 0.0, size / 2), others):
        with pytest.raises(LimitError, match="exceed the largest double: give coordinates"):
            tin.volume_to(other)
    with pytest.raises(LimitError, match="larger unit"):
        tin.volumes_to(size / 2, [[(0, 0), (size, 0), (size, size), (0, size)]])


def test_areas_of_the_other_surface_are_checked() -> None:
    corners = np.array([(-1.0, -1, 0), (1, -1, 0), (1, 1, 1), (-1, 1, 1)])
    small, large = TIN.from_points(corners), TIN.from_points(corners * 1e200)
    with pytest.raises(LimitError, match="areas of the surface to reach exceed"):
        small.volume_to(large)


def test_one_infinite_volume_has_a_net() -> None:
    found = TIN.from_points([(0, 0, 0), (9, 0, 0), (0, 9, 3)]).volume_to(1e308)
    assert (found.cut, found.fill, found.net) == (0, np.inf, np.inf)


def test_large_volumes_are_finite() -> None:
    points = np.random.default_rng(5).random((30, 3)) * 1e102
    found = TIN.from_points(points).volume_to(5e101)
    assert np.isfinite([found.cut, found.fill, found.net]).all() and found.cut > 1e304
