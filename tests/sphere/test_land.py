"""Polygons on the sphere: which triangles are land, at poles, the date line, in holes."""

from __future__ import annotations

import json
import random
from pathlib import Path

import numpy as np
import pytest

import delone
from delone import sphere

COUNTRIES = Path(__file__).parents[3] / "shared" / "data" / "ne_110m_admin_0_countries.geojson"
FAR = [(7, -75), (127, -75), (-113, -75), (31, 5), (61, 75), (-163, 21), (151, 11)]
POINTS = {"type": "MultiPoint", "coordinates": FAR}


def polygon(*rings):
    return {"type": "Polygon", "coordinates": list(rings)}


def parallel(latitude, count=36, start=-180.0):
    return [(start + 360 / count * i, latitude) for i in range(count)]


def box(west, south, east, north):
    return [(west, south), (east, south), (east, north), (west, north)]


def area(mesh, number):
    return float(mesh.areas[mesh.polygon_of_simplex == number].sum())


def at(mesh, *lonlat):
    found = mesh.find_simplex(lonlat)
    assert (found >= 0).all()
    return mesh.polygon_of_simplex[found].tolist()


def cap(latitude, count):
    """The area of a cap that a polygon of `count` arcs bounds: a fan of triangles at the pole."""
    ring = np.array(parallel(latitude, count))
    lon, lat = np.radians(ring[:2]).T
    a, b = np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))
    tangent = a[0] * b[1] - a[1] * b[0]
    return count * 2 * np.arctan2(tangent, 1 + a @ b + a[2] + b[2])


@pytest.mark.parametrize("winding", ["ccw", "cw", "smaller"])
def test_a_ring_around_a_pole(winding):
    ring = parallel(60)
    given = polygon(ring[::-1] if winding == "cw" else ring)
    mesh = sphere.from_geometry([given, POINTS], winding=winding)
    assert at(mesh, (0, 90), (12, 61), (180, 61), (180, 59), (0, -90)) == [0, 0, 0, -1, -1]
    assert area(mesh, 0) == pytest.approx(cap(60, 36))
    # The other way around, it is everything else, unless the smaller side counts.
    turned = sphere.from_geometry([polygon(given["coordinates"][0][::-1]), POINTS], winding=winding)
    want = cap(60, 36) if winding == "smaller" else 4 * np.pi - cap(60, 36)
    assert area(turned, 0) == pytest.approx(want)


@pytest.mark.parametrize("turn", [0, 90, 180, -90])
def test_a_ring_across_the_date_line_is_like_any_other(turn):
    ring = [(lon + turn, lat) for lon, lat in box(-10, -20, 10, 20)]
    wrapped = [((lon + 180) % 360 - 180, lat) for lon, lat in ring]
    mesh = sphere.from_geometry([polygon(wrapped), POINTS])
    assert at(mesh, (turn, 0), (turn + 9, 0), (turn - 9, 0), (turn + 11, 0)) == [0, 0, 0, -1]
    same = sphere.from_geometry([polygon(box(-10, -20, 10, 20)), POINTS])
    assert area(mesh, 0) == pytest.approx(area(same, 0), rel=1e-12)


def test_a_sphere_cut_along_meridians():
    count = 9
    points = np.linspace(-80, 80, 5)
    lunes = []
    for i in range(count):
        west, east = (-180 + 360 / count * (i + k) for k in (0, 1))
        up = [(east, lat) for lat in points]
        down = [(west, lat) for lat in points[::-1]]
        lunes.append(polygon([(0, -90), *up, (0, 90), *down]))
    for order in (range(count), random.Random(1).sample(range(count), count)):
        mesh = sphere.from_geometry([lunes[i] for i in order])
        assert mesh.covers_sphere
        assert mesh.npoints - len(mesh.duplicates) == 5 * count + 2
        assert int(mesh.region.max()) + 1 == count
        for i in range(count):
            assert area(mesh, i) == pytest.approx(4 * np.pi / count)
        middles = [(-180 + 360 / count * (i + 0.5), 30) for i in order]
        assert at(mesh, *middles) == list(range(count))
        # Each side is that of two lunes, in both directions.
        start, _ = mesh.segment_source
        assert set(np.diff(start).tolist()) == {2}


def test_holes_and_islands_in_them():
    outer, lake, isle = box(-40, -40, 40, 40), box(-20, -20, 20, 20), box(-10, -10, 10, 10)
    for hole in (lake, lake[::-1]):
        # The direction of holes does not matter.
        given = [{"type": "MultiPolygon", "coordinates": [[outer, hole], [isle]]}, POINTS]
        for winding in ("ccw", "smaller"):
            mesh = sphere.from_geometry(given, winding=winding)
            assert at(mesh, (30, 0), (15, 0), (5, 0), (60, 0)) == [0, -1, 0, -1]
    nested = sphere.from_geometry([polygon(isle), polygon(outer, lake), polygon(lake), POINTS])
    assert at(nested, (30, 0), (15, 0), (5, 0), (60, 0)) == [1, 2, 0, -1]


def test_a_cut_from_the_coast_to_the_pole_separates_nothing():
    # Flat maps close Antarctica along the date line and the bottom of the map.
    coast = [(lon, -70.0) for lon in range(180, -181, -10)]
    ring = [*coast, (-180.0, -90.0), (180.0, -90.0)]
    mesh = sphere.from_geometry([polygon(ring), POINTS])
    assert area(mesh, 0) == pytest.approx(cap(70, 36))
    assert at(mesh, (0, -90), (180, -80), (179, -75), (-179, -75), (180, -69)) == [0] * 4 + [-1]
    assert mesh.report.zero.size == 1


def test_rings_that_run_in_different_directions_are_refused():
    two = {"type": "MultiPolygon", "coordinates": [[box(0, 0, 9, 9)], [box(20, 0, 29, 9)[::-1]]]}
    mesh = sphere.from_geometry([POINTS, two], winding="ccw")
    with pytest.raises(
        delone.InputError, match=r"outer rings of 1 geometry run in both .* first 1"
    ):
        _ = mesh.polygon_of_simplex
    mesh = sphere.from_geometry([POINTS, two], winding="smaller")
    assert at(mesh, (4, 4), (25, 4), (15, 4)) == [1, 1, -1]


def test_the_hull_of_land_in_one_hemisphere():
    for winding in ("ccw", "smaller"):
        mesh = sphere.from_geometry(
            [polygon(box(-40, -40, 40, 40), box(0, 0, 9, 9))], winding=winding
        )
        assert not mesh.covers_sphere
        assert at(mesh, (-5, 0), (5, 5)) == [0, -1]
    mesh = sphere.from_geometry([polygon(box(-9, -9, 0, 9)), POINTS])
    assert at(mesh, (-5, 0), (5, 5)) == [0, -1]


def test_lines_separate_regions_and_are_no_land():
    line = {"type": "LineString", "coordinates": [*parallel(0), (-180, 0)]}
    mesh = sphere.from_geometry([line, POINTS, polygon(box(40, 20, 60, 40))])
    assert int(mesh.region.max()) + 1 == 3
    assert at(mesh, (50, 30), (50, -30)) == [2, -1]
    assert mesh.geometry_of_segment.tolist() == [0] * 36 + [2] * 4


def test_geometries_that_are_none():
    with pytest.raises(delone.NonFiniteError, match="1 geometry has NaN or infinity; first: 1"):
        sphere.from_geometry([polygon(parallel(9)), polygon([(0, 0), (1, float("nan")), (2, 3)])])
    with pytest.raises(delone.InputError, match="winding"):
        sphere.from_geometry([polygon(parallel(9))], winding="left")
    with pytest.raises(delone.DirectionError, match="latitude beyond a pole"):
        sphere.from_geometry([polygon([(0, 0), (1, 100), (2, 3)])])


@pytest.mark.skipif(not COUNTRIES.exists(), reason="needs the countries of Natural Earth")
def test_the_countries_of_the_world():
    world = json.loads(COUNTRIES.read_text(encoding="utf-8"))
    mesh = sphere.from_geometry(world, winding="cw", crossing="split")
    names = [feature["properties"]["NAME"] for feature in world["features"]]
    places = {
        "Antarctica": (0, -90),
        "Russia": (-178, 67),
        "Fiji": (178, -18),
        "Canada": (-100, 55),
        "South Africa": (25, -31),
        "Lesotho": (28.2, -29.6),
    }
    assert [names[i] for i in at(mesh, *places.values())] == list(places)
    assert at(mesh, (0, 90), (180, 0), (-30, 40)) == [-1] * 3
    # Square kilometers, at this scale.
    earth = 6371.0088**2
    assert area(mesh, names.index("Antarctica")) * earth == pytest.approx(12.3e6, rel=0.03)
    assert area(mesh, names.index("Russia")) * earth == pytest.approx(16.9e6, rel=0.03)
    assert 1 - area(mesh, -1) / (4 * np.pi) == pytest.approx(0.29, abs=0.01)
    smaller = sphere.from_geometry(world, winding="smaller", crossing="split")
    assert smaller.polygon_of_simplex.tolist() == mesh.polygon_of_simplex.tolist()
