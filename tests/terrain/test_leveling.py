"""Level polygons: lakes are level, their shores are edges, and what is inside is counted."""

import numpy as np
import pytest
import shapely

from delone import ConflictingValuesError, CrossingSegmentsError, InputError
from delone.interpolate import Grid
from delone.terrain import TIN

SQUARE = [(10, 10), (20, 10), (20, 20), (10, 20)]


def slope(seed=0, count=400):
    """Points of the plane z = x, among them the corners of a square of 30."""
    xy = np.random.default_rng(seed).random((count, 2)) * 30
    xy = np.vstack((xy, [(0, 0), (30, 0), (30, 30), (0, 30)]))
    return np.column_stack((xy, xy[:, 0]))


def test_a_lake_has_the_lowest_height_of_its_shore():
    points = slope()
    tin = TIN.from_points(points, level=[SQUARE])
    x, y, _ = points.T
    inside = (x >= 10) & (x <= 20) & (y >= 10) & (y <= 20)
    assert tin.adjustments.points_leveled == inside.sum() > 20
    assert tin.npoints == len(points) - inside.sum() + 4
    assert tin.adjustments.levels.tolist() == pytest.approx([10], abs=1e-12)
    level = tin.adjustments.levels[0]
    places = 10 + 10 * np.random.default_rng(1).random((1000, 2))
    assert (tin.heights(places) == level).all()
    outside = slope(2)[:, :2]
    far = (np.abs(outside - 15) > 8).any(axis=1)
    assert tin.heights(outside[far]) == pytest.approx(outside[far, 0], abs=1e-9)
    assert tin.validate()
    shore = {frozenset(map(tuple, tin.points[row].tolist())) for row in tin.breaklines}
    assert frozenset({(10.0, 10.0), (20.0, 10.0)}) in shore


def test_noise_on_the_water_changes_nothing():
    points = slope()
    x, y, _ = points.T
    inside = (x > 10) & (x < 20) & (y > 10) & (y < 20)
    noisy = points.copy()
    noisy[inside, 2] -= 5 * np.random.default_rng(3).random(inside.sum())
    a, b = (TIN.from_points(each, level=[SQUARE]) for each in (points, noisy))
    assert a.adjustments.levels == b.adjustments.levels
    assert np.array_equal(a.z, b.z)


def test_heights_of_polygons_count_and_each_feature_has_its_own():
    lakes = [
        shapely.Polygon([(x, y, 3) for x, y in SQUARE]),
        shapely.MultiPolygon([shapely.box(1, 1, 4, 4), shapely.box(6, 1, 8, 4)]),
        None,
    ]
    tin = TIN.from_points(slope(), level=lakes)
    levels = tin.adjustments.levels
    assert levels[0] == 3
    assert levels[1] == pytest.approx(1, abs=1e-12)
    assert np.isnan(levels[2])
    assert tin.heights([(15, 15), (2, 2), (7, 3)]).tolist() == [3, levels[1], levels[1]]
    for last, text in (
        (4.0, r"feature 0: a level polygon has one height.*3 to 4"),
        (np.nan, "without"),
    ):
        mixed = np.column_stack((SQUARE, [3, 3, 3, last]))
        with pytest.raises(InputError, match=text):
            TIN.from_points(slope(), level=[mixed])


def test_islands_stay():
    hole = [(13, 13), (17, 13), (17, 17), (13, 17)]
    points = slope()
    tin = TIN.from_points(points, level=[shapely.Polygon(SQUARE, [hole])])
    x, y, z = points[:, 0], points[:, 1], points[:, 2]
    island = (x > 13) & (x < 17) & (y > 13) & (y < 17)
    assert island.sum() > 3
    assert np.array_equal(tin.heights(points[island, :2]), z[island])
    assert tin.heights((11, 15)) == tin.adjustments.levels[0]


def test_points_on_the_shore_are_left_out_exactly():
    # On sides and corners, and one double beside.
    at = np.array([(10.0, 15), (15, 10), (20, 20), (10, 10), (15, 20)])
    beside = np.array([(np.nextafter(10, 0), 15.0), (15, np.nextafter(20, 99))])
    extra = np.column_stack((np.vstack((at, beside)), np.full(7, 99.0)))
    points = np.vstack((slope(count=0), extra))
    tin = TIN.from_points(points, level=[[(*p, 5) for p in SQUARE]])
    assert tin.adjustments.points_leveled == 5
    assert tin.npoints == 4 + 2 + 4
    assert (tin.heights(beside) == 99).all()


def test_points_on_reflex_shores_are_left_out():
    # A comb, whose sides have other triangles of the hull on both sides; with an island.
    comb = [(4, 4), (26, 4), (26, 26), (20, 26), (20, 12), (10, 12), (10, 26), (4, 26)]
    island = [(22, 14), (24, 14), (24, 18), (22, 18)]
    lake = shapely.Polygon([(*p, 5) for p in comb], [[(*p, 5) for p in island]])
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0.0, 31), np.arange(0.0, 31)))
    points = np.column_stack((x, y, np.full(len(x), 9.0)))
    inside = shapely.intersects_xy(lake, x, y)
    tin = TIN.from_points(points, level=lake)
    assert tin.adjustments.points_leveled == inside.sum()
    assert tin.heights(points[inside, :2]) == pytest.approx(5, abs=1e-12)
    assert tin.heights(points[~inside, :2]) == pytest.approx(9, abs=1e-12)


def test_points_at_corners_of_many_ponds_are_left_out():
    random = np.random.default_rng(4)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(2.0, 30, 4), np.arange(2.0, 30, 4)))
    ponds = np.stack((x, y), axis=-1)[:, None] + random.random((len(x), 3, 2)) * 2
    corners = ponds.reshape(-1, 2)
    points = np.vstack((slope(count=0), np.column_stack((corners, np.full(len(corners), 99.0)))))
    levels = [np.column_stack((pond, np.full(3, 5.0))) for pond in ponds]
    assert TIN.from_points(points, level=levels).adjustments.points_leveled == len(corners)


def test_lines_without_heights_are_level_on_the_water():
    line = np.array([(2.0, 15), (28, 15)])
    tin = TIN.from_points(slope(), level=[SQUARE], breaklines=[line])
    places = np.column_stack((np.linspace(10, 20, 101), np.full(101, 15.0)))
    assert (tin.heights(places) == tin.adjustments.levels[0]).all()
    assert tin.heights((3, 15)) == pytest.approx(3)


def test_other_heights_in_a_lake_are_refused_with_their_place():
    lake = [[(*p, 5) for p in SQUARE]]
    inside = [[(12, 15, 6), (18, 15, 6)]]
    with pytest.raises(InputError, match=r"at \((12|18), 15\): 6"):
        TIN.from_points(slope(), level=lake, breaklines=inside)
    same = [[(12, 15, 5), (18, 15, 5)]]
    assert TIN.from_points(slope(), level=lake, breaklines=same).heights((15, 15)) == 5
    across = [[(5, 15, 5), (15, 15, 7)]]
    with pytest.raises(ConflictingValuesError, match=r"\(10, 15\): 5 to 6"):
        TIN.from_points(slope(), level=lake, breaklines=across)
    with pytest.raises(InputError, match="inside a level polygon"):
        TIN.from_points(slope(), level=lake, breaklines=across, crossing="mean")
    overlap = [*lake, [(15, 15, 4), (25, 15, 4), (25, 25, 4), (15, 25, 4)]]
    with pytest.raises(ConflictingValuesError, match="4 to 5"):
        TIN.from_points(slope(), level=overlap)
    nested = [*lake, [(12, 12, 4), (18, 12, 4), (18, 18, 4)]]
    with pytest.raises(InputError, match="inside a level polygon"):
        TIN.from_points(slope(), level=nested)


def test_bad_polygons():
    with pytest.raises(CrossingSegmentsError, match=r"\(15, 15\)"):
        TIN.from_points(slope(), level=[[(10, 10), (20, 20), (20, 10), (10, 20)]])
    with pytest.raises(InputError, match="no part of its shore"):
        TIN.from_points(slope(), level=[[(100, 100), (110, 100), (110, 110)]])
    with pytest.raises(InputError, match="LineString"):
        TIN.from_points(slope(), level=shapely.LineString(SQUARE))
    with pytest.raises(InputError, match="no polygon"):
        TIN.from_points(slope(), level=[])


def test_errors_name_the_rows_of_the_caller():
    points = np.vstack(([(15.0, 15, 0)] * 3, slope(), [(25, 25, 1), (25, 25, 2)]))
    with pytest.raises(ConflictingValuesError) as caught:
        TIN.from_points(points, level=[[(*p, 5) for p in SQUARE]])
    assert caught.value.rows.tolist() == [[len(points) - 1, len(points) - 2]]


def test_lakes_without_returns_stay_with_voids():
    x, y = np.meshgrid(np.arange(31.0), np.arange(31.0))
    points = np.column_stack((x.ravel(), y.ravel(), x.ravel()))
    water = (np.abs(points[:, :2] - 15) < 6).all(axis=1)
    bare = points[~water]
    ring = [(9.5, 9.5), (20.5, 9.5), (20.5, 20.5), (9.5, 20.5)]
    holed = TIN.from_points(bare, max_edge=2, voids=True)
    assert np.isnan(holed.heights((15, 15)))
    tin = TIN.from_points(bare, max_edge=2, voids=True, level=[ring])
    assert tin.heights((15, 15)) == tin.adjustments.levels[0] == pytest.approx(9.5)
    assert tin.areas.sum() == pytest.approx(900)
    assert len(tin.breaklines) == 44


def test_rasters_and_boundaries():
    x = y = np.arange(0.5, 30)
    values = np.tile(x, (30, 1))
    values[12:18, 12:18] = np.nan
    dem = Grid(values, x, y)
    tin = TIN.from_raster(dem, level=[SQUARE])
    assert tin.heights((15, 15)) == tin.adjustments.levels[0] == pytest.approx(10)
    assert tin.adjustments.points_leveled == 64
    part = TIN.from_raster(dem, level=[SQUARE], boundary=[(0.5, 0.5), (15, 0.5), (15, 29), (1, 29)])
    assert np.isnan(part.heights((18, 15)))
    assert part.heights((12, 15)) == pytest.approx(10)
    small = TIN.from_raster(dem, level=[SQUARE], max_error=0.1)
    assert (small.heights([(15, 15), (11, 19)]) == tin.adjustments.levels[0]).all()


def test_archives_keep_the_numbers(tmp_path):
    tin = TIN.from_points(slope(), level=[SQUARE, None])
    tin.save(tmp_path / "tin.npz")
    again = TIN.load(tmp_path / "tin.npz")
    assert vars(again.adjustments).keys() == vars(tin.adjustments).keys()
    assert np.array_equal(again.adjustments.levels, tin.adjustments.levels, equal_nan=True)
    assert again.adjustments.points_leveled == tin.adjustments.points_leveled
    assert TIN.from_points(slope()).adjustments is None
    assert repr(tin.adjustments).startswith("<Adjustments: ")


def test_points_that_snap_to_a_shore_are_left_out():
    """A shore has one height, so the heights of points merged with it cannot count."""
    beside = [(9.98, 15), (9.99, 10.01), (15, 20.02), (9, 5.01), (20.1, 15)]
    points = np.vstack((slope(), [(x, y, x) for x, y in beside]))
    x, y, _ = points.T
    inside = (x >= 10) & (x <= 20) & (y >= 10) & (y <= 20)
    line = [(5, 5, 5), (25, 5, 25)]
    tin = TIN.from_points(points, level=[SQUARE], breaklines=[line], snap=0.05, duplicates="mean")
    near = (x > 9.95) & (x < 20.05) & (y > 9.95) & (y < 20.05) & ~inside
    assert near.sum() >= 3
    assert tin.adjustments.points_leveled == inside.sum() + near.sum()
    places = 10 + 10 * np.random.default_rng(1).random((1000, 2))
    assert (tin.heights(places) == tin.adjustments.levels[0]).all()
    # A point beside the line became part of it, and one farther from the shore stayed.
    on_line = (np.abs(y - 5) < 0.05) & (x > 5) & (x < 25)
    assert tin.adjustments.points_moved == on_line.sum() > 1
    assert tin.adjustments.largest_move == pytest.approx(np.abs(y[on_line] - 5).max())
    assert tin.heights((20.1, 15)) == 20.1
