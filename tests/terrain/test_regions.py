"""Volumes in each polygon of a layer: those of the polygon alone, and how much of it is covered."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import delone
from delone import InputError
from delone.terrain import TIN

geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")

NAMES = ("cut", "fill", "cut_area", "fill_area", "area")


def surface(seed: int, count: int = 900, **options) -> TIN:
    rng = np.random.default_rng(seed)
    xyz = np.column_stack((rng.uniform(0, 100, (count, 2)), rng.uniform(0, 9, count)))
    return TIN.from_points(xyz, **options)


def plots(seed: int, count: int = 30):
    """Stars, some with a hole, some of two parts, and some that leave the surface."""
    rng = np.random.default_rng(seed)
    found = []
    for row in range(count):
        angle = np.linspace(0, 2 * np.pi, 12)[:-1]
        radius = rng.uniform(2, 25, 11)
        ring = np.column_stack((np.cos(angle), np.sin(angle))) * radius[:, None]
        center = rng.uniform(-10, 110, 2)
        holes = [ring[::-1] * 0.3 + center] if row % 3 == 0 else []
        star = shapely.Polygon(ring + center, holes)
        found.append(
            shapely.MultiPolygon([star, shapely.box(1, 1, 9, 4)]) if row % 5 == 0 else star
        )
    return found


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["surface", "plane", "voids"])
@pytest.mark.filterwarnings("ignore:.*no area in common")
def test_each_row_is_the_volume_of_its_polygon_alone(seed, kind):
    options = {"max_edge": 5, "voids": True} if kind == "voids" else {}
    one = surface(seed, **options)
    other = (0.01, -0.02, 4.5) if kind == "plane" else surface(seed + 50, 700, **options)
    polygons = plots(seed)
    found = one.volumes_to(other, polygons)
    for row, polygon in enumerate(polygons):
        alone = one.volume_to(other, region=polygon)
        # A walk through a part of the surface may visit its triangles in another order.
        rounded = 0 if kind == "plane" else 1e-13
        assert [getattr(found, name)[row] for name in NAMES] == pytest.approx(
            [getattr(alone, name) for name in NAMES], rel=rounded, abs=0
        )
        assert found.region_area[row] == pytest.approx(
            shapely.union_all(polygon).area if row % 5 == 0 else polygon.area, rel=1e-12
        )
    assert found.area.min() < found.area.max() and found.partial.any()
    assert found.partial.all() == (kind == "voids")


def test_coverage_is_the_share_of_the_polygon_that_both_surfaces_cover():
    low = TIN.from_points([(0, 0, 1), (8, 0, 1), (8, 8, 1), (0, 8, 1)])
    high = TIN.from_points([(4, 0, 3), (12, 0, 3), (12, 8, 3), (4, 8, 3)])
    boxes = [
        shapely.box(*each) for each in ((5, 1, 7, 3), (2, 2, 6, 4), (0, 0, 3, 3), (6, 6, 10, 9))
    ]
    with pytest.warns(UserWarning, match="1 region has no area in common .* row 2"):
        found = low.volumes_to(high, boxes)
    inside = [Fraction(1), Fraction(1, 2), Fraction(0), Fraction(4, 12)]
    assert found.coverage.tolist() == [float(each) for each in inside]
    assert found.fill.tolist() == [8, 8, 0, 8] and found.net.tolist() == found.fill.tolist()
    assert found.partial.tolist() == [False, True, True, True]


def test_features_without_geometry_are_rows_without_area():
    ground = surface(1)
    table = geopandas.GeoDataFrame(
        {"name": ["a", "b", "c", "d"], "area_of": [1, 2, 3, 4]},
        geometry=[
            shapely.box(10, 10, 20, 20),
            None,
            shapely.Polygon(),
            shapely.Polygon([(0, 0), (5, 5), (9, 9)]),
        ],
        index=[7, 5, 3, 1],
    )
    with pytest.warns(UserWarning, match="3 regions have .* rows 1, 2, 3"):
        found = ground.volumes_to(0.0, table)
    assert found.region_area.tolist() == [100, 0, 0, 0]
    assert np.isnan(found.coverage).tolist() == [False, True, True, True]
    rows = found.to_geopandas(table)
    assert rows.index.tolist() == [7, 5, 3, 1] and rows["name"].tolist() == list("abcd")
    assert rows.geometry.iloc[0].equals(table.geometry.iloc[0]) and rows.geometry.iloc[1] is None
    assert rows.cut.iloc[0] == ground.volume_to(0.0, region=table.geometry.iloc[0]).cut
    assert list(found.to_pandas(table).columns) == [
        *("cut", "fill", "net", "area", "coverage", "cut_area", "fill_area", "region_area"),
        *("name", "area_of"),
    ]


def test_rings_are_regions_of_their_own_and_nested_ones_are_one():
    ground = TIN.from_points([(0, 0, 2), (9, 0, 2), (9, 9, 2), (0, 9, 2)])
    outer, inner = [(0, 0), (6, 0), (6, 6), (0, 6)], [(1, 1), (3, 1), (3, 3), (1, 3)]
    assert ground.volumes_to(0, [np.array(outer), np.array(inner)]).cut.tolist() == [72, 8]
    assert ground.volumes_to(0, np.array(outer)).cut.tolist() == [72]
    both = ground.volumes_to(0, [[np.array(outer), np.array(inner)]])
    assert both.cut.tolist() == [64] and both.to_geopandas().area.tolist() == [32]
    ring = {"type": "Polygon", "coordinates": [[*outer, outer[0]]]}
    feature = {"type": "Feature", "geometry": ring, "properties": {}}
    layer = {"type": "FeatureCollection", "features": [feature, feature]}
    assert ground.volumes_to(0, layer).cut.tolist() == [72, 72]


def test_regions_in_another_system_are_transformed():
    low = np.array([155_000.0, 463_000.0])
    corners = [(*(low + at), 1) for at in ((0, 0), (100, 0), (100, 100), (0, 100))]
    ground = TIN.from_points(corners, crs="EPSG:28992", units="m")
    boxes = geopandas.GeoSeries([shapely.box(*(low + k), *(low + 10 + k)) for k in (5, 50)])
    degrees = boxes.set_crs(28992).to_crs(4326)
    found = ground.volumes_to(0.0, degrees)
    assert found.cut == pytest.approx([100, 100], rel=1e-4) and found.crs == "EPSG:28992"
    table = found.to_geopandas()
    assert table.crs.to_epsg() == 28992
    assert shapely.hausdorff_distance(table.geometry.values, boxes.values).max() < 0.01
    with pytest.warns(delone.CRSWarning, match="that of regions is unknown"):
        ground.volumes_to(0.0, boxes.to_frame("geometry").set_geometry("geometry"))


@pytest.mark.parametrize(
    ("geometry", "words"),
    [
        (shapely.Point(1, 1), "feature 1 is not a polygon but contains a Point"),
        (shapely.LineString([(0, 0), (1, 1), (2, 0)]), "feature 1 .* LineString: select the poly"),
    ],
)
def test_other_geometries_are_refused_with_their_row(geometry, words):
    with pytest.raises(InputError, match=words):
        surface(1).volumes_to(0, [shapely.box(0, 0, 1, 1), geometry])


def test_closed_lines_are_polygons():
    line = shapely.LineString([(10, 10), (20, 10), (20, 20), (10, 10)])
    assert surface(1).volumes_to(0, [line]).region_area.tolist() == [50]


def test_columns_of_the_layer_must_not_hide_those_of_the_table():
    ground = surface(1)
    found = ground.volumes_to(0, [shapely.box(10, 10, 20, 20)])
    with pytest.raises(InputError, match="column 'area'"):
        found.to_pandas({"area": [1]})


def test_no_regions():
    found = surface(1).volumes_to(0, [])
    assert len(found) == 0 and found.coverage.shape == (0,) and len(found.to_pandas()) == 0
