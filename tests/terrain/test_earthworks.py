"""Pads and their side slopes: against formulas, cones sampled by brute force, and the ground."""

from __future__ import annotations

import math

import numpy as np
import pytest

from delone import (
    CrossingSegmentsError,
    DegenerateInputError,
    DeloneError,
    InputError,
    NonFiniteError,
    OutsideError,
)
from delone.terrain import TIN

SQUARE = [(30, 30), (60, 30), (60, 60), (30, 60)]
# Sums of the tangents of half the angles between neighboring facets at four right angles.
CORNERS = {"miter": 4.0, "round": 24 * math.tan(math.radians(7.5))}


def level(z: float = 0.0, size: float = 90.0, **options) -> TIN:
    return TIN.from_points([(0, 0, z), (size, 0, z), (size, size, z), (0, size, z)], **options)


def rough(seed: int, shift: float = 0.0, lattice: float = 0.0, **options) -> TIN:
    """A surface whose triangles are not steeper than 0.4."""
    rng = np.random.default_rng(seed)
    if lattice:
        side = np.arange(0, 100 + lattice, lattice)
        xy = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    else:
        xy = np.concatenate((rng.random((400, 2)) * 100, [(0, 0), (100, 0), (100, 100), (0, 100)]))
    u = xy / rng.uniform(8, 20)
    z = 5 * np.sin(u[:, 0]) + 4 * np.cos(u[:, 1] + u[:, 0] / 3)
    steepest = np.hypot(*TIN.from_points(np.column_stack((xy, z))).gradients.T).max()
    return TIN.from_points(
        np.column_stack((xy + shift, z * 0.4 / max(0.4, steepest))), planar=True, **options
    )


def star(seed: int, radius: float = 25.0, step: float = 0.0) -> np.ndarray:
    """A polygon with reflex corners around (50, 50), on a lattice if there is a step."""
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(7)) * 2 * np.pi
    angle = (np.arange(7) + 0.6 * rng.random(7)) * 2 * np.pi / 7
    reach = radius * (0.3 + 0.7 * rng.random(7))
    points = 50 + np.column_stack((np.cos(angle), np.sin(angle))) * reach[:, None]
    return np.round(points / step) * step if step else points


def distances(points: np.ndarray, ring: np.ndarray) -> np.ndarray:
    """Distances to a polygon, 0 inside."""
    found = np.full(len(points), np.inf)
    odd = np.zeros(len(points), dtype=bool)
    for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        share = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        found = np.minimum(found, np.linalg.norm(points - a - share[:, None] * (b - a), axis=1))
        with np.errstate(divide="ignore", invalid="ignore"):
            at = a[0] + (points[:, 1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        odd ^= ((a[1] > points[:, 1]) != (b[1] > points[:, 1])) & (points[:, 0] < at)
    return np.where(odd, 0.0, found)


def triangles(tin: TIN) -> set[tuple]:
    return {tuple(sorted(map(tuple, corners))) for corners in tin.xyz[tin.simplices].tolist()}


@pytest.mark.parametrize("corners", ["miter", "round"])
@pytest.mark.parametrize(("z", "slope"), [(3.0, 0.5), (-3.0, 0.5), (2.0, 0.25), (-5.0, 1.0)])
def test_a_square_pad_on_level_ground_is_a_frustum(z, slope, corners):
    design = level().embank(SQUARE, z, slope=slope, corners=corners)
    run = 1 / slope
    volume = 900 * abs(z) + 120 * run * z**2 / 2 + CORNERS[corners] * run**2 * abs(z) ** 3 / 3
    area = 900 + 120 * run * abs(z) + CORNERS[corners] * run**2 * z**2
    found = level().volume_to(design)
    assert (found.fill if z > 0 else found.cut) == pytest.approx(volume, rel=1e-12)
    assert (found.cut if z > 0 else found.fill) == pytest.approx(0, abs=1e-9)
    back = design.volume_to(level())
    changed = np.abs(back.mean_height) > 1e-9
    assert back.of_triangles[changed, 4].sum() == pytest.approx(area, rel=1e-12)
    assert design.validate()
    steep = np.hypot(*design.gradients.T)
    assert np.abs(steep[steep > 1e-9] - slope).max() < 1e-9


@pytest.mark.parametrize("z", [3.0, -3.0])
def test_slopes_meet_in_a_line_at_reflex_corners(z):
    ring = [(20, 20), (70, 20), (70, 40), (40, 40), (40, 70), (20, 70)]
    design = level().embank(ring, z, slope=0.5, corners="miter")
    sign = np.sign(z)
    for x, y in [(41, 43), (43, 41), (45, 45), (44, 60), (60, 44)]:
        assert design.heights((x, y)) == pytest.approx(sign * (3 - 0.5 * min(x - 40, y - 40)))
    # An edge has the area 9 in section; six corners: five pyramids more, and one less.
    found = level().volume_to(design)
    volume = 1600 * 3 + 200 * 9 + (5 - 1) * 36
    assert (found.fill if z > 0 else found.cut) == pytest.approx(volume, rel=1e-12)
    assert set(design.z.tolist()) == {0.0, z}


def test_slopes_of_three_edges_meet_in_a_slot():
    slot = [(20, 20), (70, 20), (70, 70), (50, 70), (50, 40), (40, 40), (40, 70), (20, 70)]
    for z in (3.0, -3.0):
        design = level().embank(slot, z, slope=0.25)
        for x, y in [
            (45, 41),
            (45, 44),
            (45, 45),
            (45, 60),
            (41, 60),
            (48, 60),
            (44, 42),
            (49, 42),
        ]:
            away = min(x - 40, 50 - x, y - 40)
            assert design.heights((x, y)) == pytest.approx(np.sign(z) * (3 - 0.25 * away))


def test_slopes_run_down_in_fill_and_up_in_cut():
    fill = level().embank(SQUARE, 3.0, cut=2.0, fill=0.5)
    assert fill.heights([(45, 29), (45, 25), (45, 23)]) == pytest.approx([2.5, 0.5, 0])
    cut = level().embank(SQUARE, -3.0, cut=2.0, fill=0.5)
    assert cut.heights([(45, 29), (45, 28.75), (45, 28)]) == pytest.approx([-1, -0.5, 0])


def test_a_pad_partly_in_cut_and_partly_in_fill():
    ground = TIN.from_points([(0, 0, -9), (90, 0, 9), (90, 90, 9), (0, 90, -9)])
    design = ground.embank(SQUARE, 0.0, slope=0.5, corners="miter")
    found = ground.volume_to(design)
    assert found.cut == pytest.approx(found.fill, rel=1e-12)
    assert found.cut_area == pytest.approx(found.fill_area, rel=1e-12)
    # West of the pad the slope and the ground, 0.2 (x - 45), meet at x = 20.
    places = [(x, 45) for x in (15, 20, 25, 45, 65, 70, 75)]
    assert design.heights(places) == pytest.approx([-6, -5, -2.5, 0, 2.5, 5, 6])
    # The pad, the prism to the west, two pyramids beside the pad, and two corners.
    assert found.fill == pytest.approx(675 + 450 + 2 * 45 + 2 * (50 + 30), rel=1e-12)


@pytest.mark.parametrize("shift", [0.0, 500_000.0])
@pytest.mark.parametrize("lattice", [0.0, 5.0])
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.sampled(6)
def test_designs_are_between_cones(seed, lattice, shift):
    ground = rough(seed, shift, lattice)
    ring = star(seed, step=lattice) + shift
    z, cut, fill = float(np.random.default_rng(seed).normal()), 1.0, 0.5
    design = ground.embank(ring, z, cut=cut, fill=fill)
    places = np.random.default_rng(1).random((5000, 2)) * 100 + shift
    away, below = distances(places, ring), ground.heights(places)
    # Facets touch cones of the same slope: they are a little further out.
    wide = math.cos(math.radians(7.5))
    low = np.maximum(z - fill * away, np.minimum(below, z + cut * wide * away))
    high = np.minimum(z + cut * away, np.maximum(below, z - fill * wide * away))
    found = design.heights(places)
    slack = 1e-11 * (shift + 100)
    assert (found >= low - slack).all() and (found <= high + slack).all()
    assert np.abs(found[away == 0] - z).max() <= slack
    assert design.validate()
    assert design.areas.sum() == pytest.approx(ground.areas.sum(), rel=1e-9)
    far = ground.points[(distances(ground.points, ring) > 40)]
    assert np.array_equal(design.heights(far), ground.heights(far))
    again = design.embank(ring, z, cut=cut, fill=fill)
    twice = design.volume_to(again)
    assert twice.cut + twice.fill < 1e4 * slack


def test_mitred_slopes_of_a_convex_pad_are_the_planes_of_its_edges():
    ring = np.array([(30.0, 35), (65, 30), (72, 65), (35, 70)])
    ground = rough(3)
    design = ground.embank(ring, 4.0, slope=1.5, corners="miter")
    places = np.random.default_rng(1).random((5000, 2)) * 100
    along = np.roll(ring, -1, axis=0) - ring
    normal = np.column_stack((along[:, 1], -along[:, 0])) / np.linalg.norm(along, axis=1)[:, None]
    away = np.maximum(((places[:, None] - ring) * normal).sum(axis=2).max(axis=1), 0)
    below = ground.heights(places)
    expected = np.maximum(4 - 1.5 * away, np.minimum(4 + 1.5 * away, below))
    assert np.abs(design.heights(places) - expected).max() < 1e-11


def test_a_tilted_pad_has_slopes_of_the_same_steepness():
    ground = rough(4)
    plane = (0.1, -0.05, -2.0)
    design = ground.embank(star(4), plane, cut=1.0, fill=0.75)
    places = np.random.default_rng(1).random((3000, 2)) * 100
    away, below = distances(places, star(4)), ground.heights(places)
    ring = star(4)
    share = np.linspace(0, 1, 400)[:, None]
    rim = np.concatenate(
        [a + share * (b - a) for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True)]
    )
    height = lambda p: plane[2] + p @ plane[:2]  # noqa: E731
    reach = np.linalg.norm(places[:, None] - rim, axis=2)
    fill = (height(rim) - 0.75 * reach).max(axis=1)
    cut = (height(rim) + 1.0 * reach).min(axis=1)
    expected = np.where(away == 0, height(places), np.maximum(fill, np.minimum(cut, below)))
    assert np.abs(design.heights(places) - expected).max() < 0.1
    assert design.heights(ring) == pytest.approx(height(ring))
    with pytest.raises(InputError, match=r"the pad itself falls by 0\.5 along an edge"):
        level().embank(SQUARE, (0.5, 0, 0), slope=0.5)


@pytest.mark.deep
def test_the_sharp_corner_of_a_tilted_pad_has_a_whole_cone():
    ring, plane = np.array([(40.0, 48), (80, 50), (40, 52)]), (0.4, 0.0, -26.0)
    places = np.random.default_rng(1).uniform(20, 80, (4000, 2))
    for slope in (0.5, 1.0):
        design = level(size=100).embank(ring, plane, slope=slope)
        share = np.linspace(0, 1, 2000)[:, None]
        rim = np.concatenate([ring[k] + share * (ring[k - 2] - ring[k]) for k in range(3)])
        reach = np.linalg.norm(places[:, None] - rim, axis=2)
        above = plane[2] + 0.4 * rim[:, 0]
        low, high = (above - slope * reach).max(axis=1), (above + slope * reach).min(axis=1)
        within = distances(places, ring) == 0
        expected = np.where(within, plane[2] + 0.4 * places[:, 0], np.clip(0, low, high))
        assert np.abs(design.heights(places) - expected).max() < 0.1


def test_what_the_design_does_not_touch_is_the_same():
    lines = [[(5, 5, 0), (95, 12, 1)], [(10, 50, 2), (95, 55, 3)]]
    ground = rough(5, breaklines=lines[:1], soft_breaklines=lines[1:], duplicates="mean")
    for design in (ground.embank(star(5), 1.0, slope=0.8), ground.flatten(star(5), 1.0)):
        old, new = triangles(ground), triangles(design)
        corners = ground.points[ground.simplices].reshape(-1, 2)
        away = distances(corners, star(5)).reshape(-1, 3).min(axis=1)
        far = {
            tuple(sorted(map(tuple, ground.xyz[row].tolist())))
            for row in ground.simplices[away > 20]
        }
        assert far and far <= new and len(old & new) >= len(far)
        places = np.array([(x, 5 + (x - 5) * 7 / 90) for x in np.linspace(6, 94, 50)])
        assert design.heights(places) == pytest.approx(ground.heights(places))
    hard = ground.embank(star(5), 1.0, slope=0.8).soft
    assert hard.any() and not hard.all()


def test_breaklines_end_at_the_design():
    line = [(5, 45, 1.0), (85, 45, 1.0)]
    ground = level(breaklines=[line])
    design = ground.flatten(SQUARE, 3.0)
    assert design.heights([(10, 45), (45, 45), (80, 45)]).tolist()[1] == 3.0
    ends = design.points[design.breaklines[(~design.soft)]]
    inside = ((ends.mean(axis=1) > 31) & (ends.mean(axis=1) < 59)).all(axis=1)
    assert not inside.any()
    slope = ground.embank(SQUARE, 3.0, slope=0.5)
    assert slope.heights([(10, 45), (5, 45), (27, 45)]) == pytest.approx([1, 1, 1.5])


def test_flattening_keeps_vertices_outside():
    ground = rough(6)
    ring = star(6)
    design = ground.flatten(ring, 1.5)
    away = distances(ground.points, ring)
    assert np.array_equal(design.heights(ground.points[away > 0]), ground.z[away > 0])
    assert np.abs(design.heights(ground.points[away == 0]) - 1.5).max() < 1e-12
    assert design.npoints == np.count_nonzero(away > 0) + len(ring)
    assert np.count_nonzero(~design.soft) == len(ring)
    assert design.validate()
    tilted = level().flatten(SQUARE, (0.5, 0, 1))
    assert tilted.heights([(30, 30), (45, 40), (60, 60)]) == pytest.approx([16, 23.5, 31])


def test_pads_on_lattice_lines_and_vertices():
    ground = rough(7, lattice=5.0)
    design = ground.flatten(SQUARE, 2.0)
    assert (design.heights(SQUARE) == 2).all() and design.heights((45, 30)) == 2
    outside = distances(ground.points, np.array(SQUARE, dtype=float)) > 0
    assert np.array_equal(design.heights(ground.points[outside]), ground.z[outside])
    flush = level().embank(SQUARE, 0.0, slope=1)
    assert level().volume_to(flush).cut_area == level().volume_to(flush).fill_area == 0


def test_pads_that_touch_lattice_lines_from_one_side():
    ground = rough(7, lattice=5.0)
    ring = np.array([(44.0, 66), (47, 37), (55, 27)])
    design = ground.flatten(ring, 2.0)
    new = triangles(design)
    for rows in ground.simplices:
        x, y = ground.points[rows].T
        if x.min() >= 60 or x.max() <= 40 or y.min() >= 70 or y.max() <= 25:
            assert tuple(sorted(map(tuple, ground.xyz[rows].tolist()))) in new
    places = np.array([(58, 26), (59, 28), (56, 29.5), (58.3, 26.7)])
    right = ground.heights(places)
    # The triangle on the other side of the line that a corner touches has that corner, no more.
    assert design.heights(places[[0, 3]]) == pytest.approx(right[[0, 3]])
    assert design.validate()


def test_corners_that_are_vertices_up_to_rounding_are_these_vertices():
    ground = rough(7, lattice=5.0)
    exact = ground.flatten(SQUARE, 2.0)
    for shift in (1e-14, -2e-14):
        near = ground.flatten(np.array(SQUARE) * (1 + shift), 2.0)
        assert near.npoints == exact.npoints
        assert set(map(tuple, near.xyz.tolist())) == set(map(tuple, exact.xyz.tolist()))


def test_hollows_that_are_not_connected_remain():
    x = np.arange(0.0, 91, 5)
    xy = np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2)
    z = np.where((np.abs(xy[:, 0] - 75) < 4) & (np.abs(xy[:, 1] - 45) < 4), -20.0, 0.0)
    ground = TIN.from_points(np.column_stack((xy, z)))
    design = ground.embank(SQUARE, 1.0, slope=0.125)
    assert design.heights((75, 45)) == -20
    assert design.heights((62, 45)) == pytest.approx(0.75)
    deeper = ground.embank(SQUARE, 3.0, slope=0.125)
    assert deeper.heights((75, 45)) == pytest.approx(3 - 15 / 8)


def test_holes_of_pads():
    inner = [(40, 40), (50, 40), (50, 50), (40, 50)]
    ground = level()
    design = ground.embank([SQUARE, inner], 2.0, slope=1, corners="miter")
    assert design.heights([(45, 45), (41, 45), (35, 45), (29, 45)]) == pytest.approx([0, 1, 2, 1])
    deep = ground.embank([SQUARE, inner], 2.0, slope=0.25)
    assert deep.heights((45, 45)) == pytest.approx(0.75)
    shapely = pytest.importorskip("shapely")
    again = ground.embank(shapely.Polygon(SQUARE, [inner]), 2.0, slope=0.25)
    assert again.volume_to(deep).cut == again.volume_to(deep).fill == 0


def test_parts_that_touch_at_a_corner():
    other = [(60, 60), (75, 60), (75, 75), (60, 75)]
    design = level().embank([SQUARE, other], 2.0, slope=0.5, corners="miter")
    places = [(61, 59), (59, 61), (62, 59), (68, 68)]
    assert design.heights(places) == pytest.approx([1.5, 1.5, 1.5, 2])


def test_pads_at_the_outline():
    ground = level()
    side = ground.embank([(0, 30), (30, 30), (30, 60), (0, 60)], 3.0, slope=0.5, corners="miter")
    assert side.heights([(0, 45), (0, 28), (15, 28), (0, 20)]) == pytest.approx([3, 2, 2, 0])
    found = ground.volume_to(side)
    assert found.fill == pytest.approx(900 * 3 + 90 * 9 + 2 * 4 * 27 / 3, rel=1e-12)
    everything = ground.embank([(0, 0), (90, 0), (90, 90), (0, 90)], 3.0, slope=0.5)
    assert ground.volume_to(everything).fill == 3 * 8100
    assert ground.flatten([(0, 0), (90, 0), (90, 90), (0, 90)], 3.0).z.tolist() == [3] * 4
    with pytest.raises(OutsideError, match=r"fill leaves the surface at \(.*steeper") as caught:
        ground.embank([(3, 30), (30, 30), (30, 60), (3, 60)], 3.0, slope=0.5)
    assert caught.value.place[0] == 0 and 28 <= caught.value.place[1] <= 62
    with pytest.raises(OutsideError, match="cut leaves the surface"):
        ground.embank([(3, 30), (30, 30), (30, 60), (3, 60)], -3.0, slope=0.5)
    assert ground.embank([(3, 30), (30, 30), (30, 60), (3, 60)], 3.0, slope=2).heights((1, 45)) == 0


@pytest.mark.parametrize("degrees", [10, 30, 77])
@pytest.mark.parametrize("shift", [0.0, 1e5])
def test_pads_at_outlines_that_are_straight_up_to_rounding(degrees, shift):
    turn = math.radians(degrees)
    matrix = np.array([(math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))])
    rng = np.random.default_rng(degrees)
    side = rng.random(20) * 90
    rim = np.array([(0, 0), (90, 0), (90, 90), (0, 90)])
    xy = np.concatenate((rim, np.column_stack((np.zeros(20), side)), rng.random((200, 2)) * 90))
    turned = xy @ matrix + shift
    ground = TIN.from_points(np.column_stack((turned, np.zeros(len(xy)))), planar=True)
    pad = np.array([(0, 30), (30, 30), (30, 60), (0, 60)]) @ matrix + shift
    design = ground.embank(pad, 3.0, slope=0.5, corners="miter")
    volume = ground.volume_to(design).fill
    assert volume == pytest.approx(900 * 3 + 90 * 9 + 2 * 4 * 27 / 3, rel=1e-9)
    assert ground.volume_to(ground.flatten(pad, 3.0)).fill > 2700
    assert design.areas.sum() == pytest.approx(8100, rel=1e-9)


def test_outlines_and_holes_remain():
    rim = [(10, 10), (80, 5), (85, 80), (45, 88), (5, 75)]
    hole = [(70, 20), (75, 20), (75, 25)]
    ground = rough(8, boundary=[rim], holes=[hole])
    places = np.random.default_rng(1).random((4000, 2)) * 100
    for design in (
        ground.embank(star(8, 15), 0.5, slope=1),
        ground.flatten([(10, 10), (40, 40), (20, 60)], 1.0),
        ground.flatten([(10, 10), (80, 5), (40, 60)], 1.0),
    ):
        same = np.isnan(design.heights(places)) == np.isnan(ground.heights(places))
        assert same.all()
        assert design.areas.sum() == pytest.approx(ground.areas.sum(), rel=1e-12)
        assert design.crs == ground.crs
    peeled = rough(9, max_edge=9.0)
    design = peeled.embank(star(9, 15), 0.5, slope=1)
    assert (np.isnan(design.heights(places)) == np.isnan(peeled.heights(places))).all()


def test_pads_that_leave_the_surface_are_refused():
    ground = level()
    for method in (ground.flatten, lambda *given: ground.embank(*given, slope=1)):
        with pytest.raises(OutsideError, match=r"leaves the surface at \(100, 60\)") as caught:
            method([(30, 30), (100, 60), (30, 60)], 0.0)
        assert caught.value.place == (100, 60)
        with pytest.raises(OutsideError):
            method([(200, 200), (210, 200), (200, 210)], 0.0)
    holed = level(holes=[[(40, 40), (50, 40), (50, 50), (40, 50)]])
    with pytest.raises(OutsideError):
        holed.flatten(SQUARE, 0.0)


def test_bad_polygons_are_refused():
    ground = level()
    with pytest.raises(
        CrossingSegmentsError, match=r"polygon: edges cross at 1 place, .*\(45, 45\)"
    ):
        ground.flatten([(30, 30), (60, 60), (60, 30), (30, 60)], 0.0)
    with pytest.raises(NonFiniteError, match="polygon"):
        ground.flatten([(30, 30), (np.nan, 60), (60, 30)], 0.0)
    with pytest.raises(DegenerateInputError):
        ground.flatten([(30, 30), (40, 40), (50, 50)], 0.0)
    with pytest.raises(InputError, match="at least three points"):
        ground.flatten([(30, 30), (40, 40)], 0.0)
    with pytest.raises(InputError, match="polygon has no area"):
        ground.flatten([SQUARE, SQUARE], 0.0)
    for factor in (1e298, 1e-298):
        with pytest.raises(InputError, match="designs need coordinates"):
            TIN.from_points(ground.xyz * factor).flatten(np.array(SQUARE) * factor, 0.0)
    with pytest.raises(InputError, match="designs need coordinates"):
        ground.embank(SQUARE, 1e300, slope=1)
    for empty in ([], np.empty((0, 2)), "abc", 5, None):
        with pytest.raises(DeloneError):
            ground.flatten(empty, 0.0)


@pytest.mark.parametrize("z", [np.nan, np.inf, (1, 2), "high", None, (1, 2, np.nan)])
def test_bad_heights_are_refused(z):
    with pytest.raises(DeloneError):
        level().flatten(SQUARE, z)
    with pytest.raises(DeloneError):
        level().embank(SQUARE, z, slope=1)


def test_bad_slopes_are_refused():
    ground = level()
    with pytest.raises(InputError, match="give slope, or cut and fill: cut has none"):
        ground.embank(SQUARE, 1.0)
    with pytest.raises(InputError, match="fill has none"):
        ground.embank(SQUARE, 1.0, cut=1)
    for bad in (0, -1, np.nan, np.inf, 1e300, 1e-300):
        with pytest.raises(InputError, match="must be from 1e-6 to 1e6"):
            ground.embank(SQUARE, 1.0, slope=bad)
    with pytest.raises(InputError, match="corners must be one of"):
        ground.embank(SQUARE, 1.0, slope=1, corners="sharp")


def test_scaling_by_a_power_of_two_changes_nothing_else():
    ground = rough(10)
    design = ground.embank(star(10), 1.0, slope=0.8)
    small = TIN.from_points(ground.xyz * 0.125).embank(star(10) * 0.125, 0.125, slope=0.8)
    assert np.array_equal(small.xyz, design.xyz * 0.125)
    assert np.array_equal(small.simplices, design.simplices)


def test_the_number_of_threads_and_the_start_of_a_ring_change_nothing():
    ground, ring = rough(11), star(11)
    design = ground.embank(ring, 1.0, slope=0.8)
    for other in (np.roll(ring, 3, axis=0), ring[::-1]):
        found = ground.embank(other, 1.0, slope=0.8)
        twice = found.volume_to(design)
        assert twice.cut + twice.fill < 1e-9
    alone = rough(11, workers=1).embank(ring, 1.0, slope=0.8)
    assert np.array_equal(alone.xyz, design.xyz)
    assert np.array_equal(alone.simplices, design.simplices)
