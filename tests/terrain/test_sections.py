"""Profiles of several surfaces at common distances, and cross sections along an alignment."""

from __future__ import annotations

import math

import numpy as np
import pytest

import delone
from delone import BudgetExceededError, DtypeError, InputError
from delone.terrain import TIN

shapely = pytest.importorskip("shapely")
pytest.importorskip("pandas")

FLAT = [(0, 0, 5), (100, 0, 5), (100, 100, 5), (0, 100, 5)]


def surface(seed: int, count: int = 300, **options) -> TIN:
    rng = np.random.default_rng(seed)
    xyz = np.column_stack((rng.uniform(0, 100, (count, 2)), rng.uniform(0, 9, count)))
    return TIN.from_points(xyz, **options)


def lines(seed: int):
    return np.random.default_rng(seed).uniform(-10, 110, (5, 2))


@pytest.mark.parametrize("seed", range(6))
def test_each_surface_is_linear_between_rows(seed):
    holes = {"max_edge": 12, "voids": True}
    surfaces = [surface(seed), surface(seed + 20, 200, **holes), surface(seed + 40, 90, **holes)]
    line = lines(seed)
    found = surfaces[0].profiles(line, surfaces[1:])
    assert found.names == ("surface", "other 1", "other 2")
    assert (np.diff(found.distances) >= 0).all()
    along = shapely.line_interpolate_point(shapely.LineString(line), found.distances)
    assert np.abs(shapely.get_coordinates(along) - found.points).max() < 1e-9
    halves = (found.distances[1:] + found.distances[:-1]) / 2
    middle = shapely.get_coordinates(
        shapely.line_interpolate_point(shapely.LineString(line), halves)
    )
    # Nothing is to be seen between rows at one distance.
    apart = np.diff(found.distances) > 1e-9
    # Rows on both sides of a corner of the line have one at it between them.
    assert set(map(tuple, line.tolist())) & set(map(tuple, found.points.tolist()))
    for k, tin in enumerate(surfaces):
        one = tin.profile(line)
        heights, z = tin.heights(middle), found.z[:, k]
        between = (z[1:] + z[:-1]) / 2
        assert (np.isnan(heights) == np.isnan(between))[apart].all()
        assert np.nanmax(np.abs(heights - between)[apart]) < 1e-9
        known = ~np.isnan(one.z)
        rows = set(zip(found.distances.round(9), z.round(9), strict=True))
        assert set(zip(one.distances[known].round(9), one.z[known].round(9), strict=True)) <= rows
        # As many gaps as the profile of the surface alone.
        gaps = np.diff(np.isnan(np.append(z[~np.isnan(z).cumprod().astype(bool)], 0)).astype(int))
        assert np.count_nonzero(gaps == 1) == np.count_nonzero(~known) + np.isnan(z[-1])


def test_a_gap_without_a_row_in_it_has_a_row_of_its_own():
    gap = shapely.box(4, -1, 6, 11)
    corners = [(0, 0, 1), (10, 0, 1), (10, 10, 1), (0, 10, 1)]
    pierced = TIN.from_points(corners, holes=[gap.intersection(shapely.box(0, 0, 10, 10))])
    whole = TIN.from_points([(x, y, 2) for x, y, _ in corners])
    line = [(0, 2), (10, 2)]
    # The hole is empty of edges of the other surface at y = 2: its diagonal is at x = 2 or 8.
    found = pierced.profiles(line, whole)
    z = found.z[:, 0]
    ends = found.distances[np.flatnonzero(np.isnan(z)) + 1]
    assert np.isnan(z).sum() == 1 and ends.tolist() == [6] and not np.isnan(found.z[:, 1]).any()
    assert found.distances.tolist().count(6.0) == 2


def test_parts_that_meet_at_one_distance_keep_both_ends():
    from delone.terrain.sections import _END, _GAP, _PLAIN, _heights, _rows

    common = np.array([0.0, 5.0, 9.0])
    parts = [(np.array([0.0, 5.0]), np.array([1.0, 2.0])), (common[1:], np.array([7.0, 8.0]))]
    # The other surface has a part that starts at the same distance.
    rows, own = _rows(common, [(0, 5.0, 5.0), (1, 0.0, 5.0)], 2)
    assert rows[:, 1].tolist() == [_PLAIN, _END, _GAP, _PLAIN, _PLAIN]
    z = _heights(own[:, 0], common[rows[:, 0]], parts)
    assert z[[0, 1, 3, 4]].tolist() == [1, 2, 7, 8] and np.isnan(z[2])
    other = [(common[:1], np.array([4.0])), (common[1:], np.array([5.0, 6.0]))]
    z = _heights(own[:, 1], common[rows[:, 0]], other)
    assert z[[0, 3, 4]].tolist() == [4, 5, 6] and np.isnan(z[1:3]).all()


def test_surfaces_with_the_same_hole_have_the_same_gap():
    hole = [(30, 20), (60, 20), (60, 80), (30, 80)]
    one, other = (TIN.from_points([(x, y, z) for x, y, _ in FLAT], holes=[hole]) for z in (1, 2))
    found = one.profiles([(0, 50), (100, 50)], [other, TIN.from_points(FLAT)])
    # Each of both ends before the gap and starts after it.
    for z, level in zip(found.z.T[:2], (1, 2), strict=True):
        gap = np.flatnonzero(np.isnan(z))
        assert len(gap) and (np.diff(gap) == 1).all() and set(z[~np.isnan(z)]) == {level}
        assert found.distances[[gap[0] - 1, gap[-1] + 1]].tolist() == [30, 60]
    # Without the third surface nothing is between the ends.
    found = one.profiles([(0, 50), (100, 50)], other)
    assert np.isnan(found.z).all(axis=1).sum() == np.isnan(found.z).any(axis=1).sum() == 1


def test_rows_of_common_edges_are_one():
    ridge = [(0, 30.1, 9), (100, 70.3, 9)]
    one = TIN.from_points(FLAT, breaklines=[ridge], duplicates="max")
    # The other surface has the same line, with its points in another order of rows.
    other = TIN.from_points([(50, 90, 1), *FLAT[::-1]], breaklines=[ridge[::-1]])
    found = one.profiles([(33.3, 0), (35.7, 100)], other)
    # Rows are apart by more than roundings.
    assert np.diff(found.distances).min() > 1e-6


def test_surfaces_that_cannot_be_compared_are_refused():
    tin = TIN.from_points(FLAT, crs="EPSG:28992", units="m")
    line = [(0, 0), (9, 9)]
    with pytest.raises(InputError, match="in EPSG:28992 and in EPSG:31370"):
        tin.profiles(line, TIN.from_points(FLAT, crs="EPSG:31370"))
    with pytest.raises(InputError, match="multiply those in ft"):
        tin.profiles(line, [TIN.from_points(FLAT, units="ft")])
    with pytest.raises(InputError, match="names of surfaces must differ"):
        tin.profiles(line, {"surface": tin})
    with pytest.raises(InputError, match="not be one of distance"):
        tin.profiles(line, {"x": tin})
    with pytest.raises(DtypeError, match="surface 'b' must be a TIN, got int"):
        tin.profiles(line, {"b": 3})


def test_a_line_outside_has_no_rows():
    tin = TIN.from_points(FLAT)
    found = tin.profiles([(200, 200), (300, 300)], tin)
    assert len(found) == 0 and found.z.shape == (0, 2) and len(found.to_pandas()) == 0
    assert repr(found) == "<Profiles of 2 surfaces: 0 points over 0>"
    found.plot()


def test_sections_are_perpendicular_and_halve_corners():
    slope = TIN.from_points([(0, 0, 0), (100, 0, 10), (100, 100, 10), (0, 100, 0)])
    road = [(20, 20), (60, 20), (60, 60)]
    found = slope.cross_sections(road, interval=20, left=5, right=3, start=100)
    assert found.stations.tolist() == [100, 120, 140, 160, 180]
    assert found.centers.tolist() == [[20, 20], [40, 20], [60, 20], [60, 40], [60, 60]]
    # To the left of a road to the east is north.
    assert found.ends[1].tolist() == [[40, 25], [40, 17]]
    assert found.ends[3].tolist() == [[55, 40], [63, 40]]
    half = math.sqrt(0.5)
    assert found.ends[2] == pytest.approx(
        np.array([[60 - 5 * half, 20 + 5 * half], [60 + 3 * half, 20 - 3 * half]])
    )
    assert found.offsets_of(3)[[0, -1]].tolist() == [-5, 3]
    assert found.sections[3].z[[0, -1], 0] == pytest.approx([5.5, 6.3])
    table = found.to_pandas()
    assert list(table.columns) == ["station", "offset", "surface", "x", "y"]
    assert table.surface.to_numpy() == pytest.approx(table.x.to_numpy() / 10)
    names = {"name": list("abcde")}
    assert found.to_pandas(names).groupby("station")["name"].first().tolist() == names["name"]
    assert found.to_geopandas(names)["name"].tolist() == names["name"]
    with pytest.raises(InputError, match="data has 2 rows for 5 sections"):
        found.to_pandas({"name": ["a", "b"]})
    assert found.to_geopandas().geometry.length.round(9).tolist() == [8] * 5


def test_a_station_within_a_rounding_of_a_corner_is_at_it():
    tin = TIN.from_points(FLAT)
    # Tenths: the third point is at 0.1 + 0.2, not at 0.3.
    road = [(10, 10), (10.1, 10), (10.1, 10.2), (11, 10.2)]
    found = tin.cross_sections(road, stations=[0.1 + 0.2], left=1)
    again = tin.cross_sections(road, stations=[np.nextafter(0.3, 0)], left=1)
    assert found.centers.tolist() == again.centers.tolist() == [[10.1, 10.2]]
    assert np.abs(found.ends - again.ends).max() < 1e-12


def test_the_last_station_is_the_end_once():
    tin = TIN.from_points(FLAT)
    road = [(10, 10), (70, 10)]
    assert tin.cross_sections(road, interval=25, left=1).stations.tolist() == [0, 25, 50, 60]
    assert tin.cross_sections(road, interval=20, left=1).stations.tolist() == [0, 20, 40, 60]
    tenths = tin.cross_sections([(10, 10), (10.3, 10)], interval=0.1, left=1).stations
    assert tenths == pytest.approx([0, 0.1, 0.2, 0.3]) and len(tenths) == 4


def test_a_road_that_turns_back_and_one_with_equal_points():
    tin = TIN.from_points(FLAT)
    found = tin.cross_sections([(10, 10), (10, 10), (30, 10), (10, 10)], interval=20, left=2)
    assert found.ends[1].tolist() == [[30, 12], [30, 8]]
    with pytest.raises(InputError, match="line has no length"):
        tin.cross_sections([(10, 10), (10, 10)], interval=20, left=2)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"left": 1}, "either an interval or stations"),
        ({"left": 1, "interval": 1, "stations": [1]}, "either an interval or stations"),
        ({"left": 1, "interval": 0}, "interval must be above 0"),
        ({"left": -1, "interval": 1}, "left must be finite and at least 0"),
        ({"left": 1, "right": math.inf, "interval": 1}, "right must be finite and at least 0"),
        ({"left": 0, "interval": 1}, "both 0: cross sections have no length"),
        ({"left": 1, "stations": [5, 61, 99]}, "2 stations outside .* first row 1: 61"),
        ({"left": 1, "stations": []}, "stations is empty"),
        ({"left": 1, "stations": [math.nan]}, "1 station outside"),
        ({"left": 1, "interval": 10, "start": math.inf}, "start must be finite"),
    ],
)
def test_options_out_of_range(options, words):
    with pytest.raises(InputError, match=words):
        TIN.from_points(FLAT).cross_sections([(10, 10), (70, 10)], **options)


def test_too_many_stations():
    with pytest.raises(BudgetExceededError, match="gives 6e\\+07 stations on 60"):
        TIN.from_points(FLAT).cross_sections([(10, 10), (70, 10)], left=1, interval=1e-6)


def test_pictures():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    tin, other = surface(1), surface(2, max_edge=20)
    found = tin.cross_sections([(10, 10), (60, 80)], interval=12, left=8, others=other)
    figure = found.figure(columns=4)
    assert [ax.get_title() for ax in figure.axes] == [f"{each:.6g}" for each in found.stations]
    assert all(len(ax.lines) == 3 for ax in figure.axes)
    assert len(found.plot().texts) == len(found)
    assert [text.get_text() for text in found.sections[0].plot().get_legend().texts] == [
        "surface",
        "other",
    ]
    with pytest.raises(InputError, match="do not fit into one figure"):
        tin.cross_sections([(10, 10), (60, 80)], interval=0.1, left=8).figure()
    pyplot.close("all")


def test_the_alignment_is_transformed():
    geopandas = pytest.importorskip("geopandas")
    low = np.array([155_000.0, 463_000.0])
    tin = TIN.from_points([(*(low + np.array((x, y))), z) for x, y, z in FLAT], crs="EPSG:28992")
    road = geopandas.GeoSeries(
        [shapely.LineString([low + 10, low + np.array((70, 10))])], crs=28992
    )
    found = tin.cross_sections(road.to_crs(4326), interval=20, left=5)
    assert found.stations[-1] == pytest.approx(60, abs=0.01)
    assert isinstance(tin.profiles(road.to_crs(4326)), delone.terrain.Profiles)


def test_a_line_without_length_is_refused():
    tin = TIN.from_points([(0, 0, 0), (4, 0, 4), (4, 4, 4), (0, 4, 0)])
    still = [(1, 1), (1, 1), (1, 1)]
    for call in (
        lambda: tin.profile(still),
        lambda: tin.profiles(still, {}),
        lambda: tin.cross_sections(still, interval=1, left=1),
    ):
        with pytest.raises(InputError, match="line has no length: it needs two points that differ"):
            call()
    with pytest.raises(InputError, match="one line of at least two points, got one of one point"):
        tin.profile([(1, 1)])
    # Points may repeat.
    assert tin.profile([(1, 1), (1, 1), (3, 1)]).distances[-1] == 2
