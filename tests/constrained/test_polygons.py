from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import geopandas
import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

import delone
from delone import (
    ConstrainedDelaunay,
    PolygonTriangles,
    _core,
    errors,
    from_geometry,
    triangulate_polygon,
)
from delone.constrained.geodata import parts_of

RING = [(0, 0), (6, 0), (6, 6), (0, 6)]
HOLE = [(2, 2), (4, 2), (4, 4), (2, 4)]
FRAME = shapely.Polygon(RING, [HOLE])
MAPPING = {"type": "Polygon", "coordinates": [[*RING, RING[0]], [*HOLE, HOLE[0]]]}


class Speaker:
    """Has nothing but the interface."""

    def __init__(self, mapping: dict[str, Any]) -> None:
        self.__geo_interface__ = mapping


def area(triangles: PolygonTriangles) -> Fraction:
    """The exact area, where every triangle is counter-clockwise."""
    total = Fraction(0)
    for a, b, c in triangles.points[triangles.simplices].tolist():
        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, p) for p in (a, b, c))
        twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        assert twice > 0
        total += twice / 2
    return total


def same_parts(one: Any, other: Any) -> None:
    for mine, theirs in zip(parts_of(one), parts_of(other), strict=True):
        np.testing.assert_array_equal(mine, theirs)


class TestParts:
    """What shapely reads in bulk and what is read by hand are the same."""

    GEOMETRIES = (
        shapely.Point(1, 2),
        shapely.MultiPoint([(1, 2), (3, 4)]),
        shapely.LineString([(0, 0), (1, 1), (0, 0)]),
        shapely.MultiLineString([[(0, 0), (1, 1)], [(5, 5), (6, 6), (7, 5)]]),
        FRAME,
        shapely.MultiPolygon([FRAME, shapely.box(10, 10, 11, 11)]),
        shapely.GeometryCollection([shapely.Point(0, 0), FRAME, shapely.MultiPoint([(9, 9)])]),
        shapely.GeometryCollection([shapely.GeometryCollection([shapely.Point(7, 7)])]),
        shapely.Polygon(),
        shapely.LineString(),
        shapely.GeometryCollection(),
        shapely.Point(),
    )

    @pytest.mark.parametrize("geometry", GEOMETRIES, ids=lambda g: g.wkt[:24])
    def test_each_type(self, geometry: Any) -> None:
        same_parts(geometry, shapely.geometry.mapping(geometry))
        same_parts(geometry, Speaker(shapely.geometry.mapping(geometry)))

    def test_all_at_once_in_any_container(self) -> None:
        many = list(self.GEOMETRIES)
        series = geopandas.GeoSeries(many)
        same_parts(many, [shapely.geometry.mapping(g) for g in many])
        for other in (tuple(many), series, series.to_frame("geometry"), series.values, iter(many)):
            same_parts(many, other)
        same_parts(many, np.array(many, dtype=object))

    def test_geometries_are_numbered_through(self) -> None:
        series = geopandas.GeoSeries([shapely.Point(0, 0), None, shapely.Point(1, 1)])
        collection = {
            "type": "FeatureCollection",
            "features": [
                {"type": "Feature", "geometry": MAPPING, "properties": {}},
                {"type": "Feature", "geometry": None, "properties": {}},
                {"type": "Feature", "geometry": {"type": "Point", "coordinates": (1, 1)}},
            ],
        }
        parts = parts_of([series, collection, None, FRAME, [shapely.Point(3, 3)]])
        assert parts.geometries.tolist() == [0, 2, 3, 3, 5, 7, 7, 8]

    def test_rings_are_closed_without_repetition(self) -> None:
        open_ring = {"type": "Polygon", "coordinates": [RING, HOLE]}
        same_parts(open_ring, FRAME)

    def test_third_coordinates_are_left_out(self) -> None:
        same_parts(shapely.LineString([(0, 0, 5), (1, 1, 6)]), shapely.LineString([(0, 0), (1, 1)]))
        same_parts(
            {"type": "LineString", "coordinates": [(0, 0, 5), (1, 1, 6)]},
            shapely.LineString([(0, 0), (1, 1)]),
        )

    @pytest.mark.parametrize(
        "wrong", [3, "POINT (1 1)", [1, 2], [(0, 0), (1, 1)], {"type": "Topology"}, {}, object()]
    )
    def test_what_is_no_geometry_is_refused(self, wrong: Any) -> None:
        with pytest.raises(errors.InputError, match=r"not a geometry|unknown geometry type"):
            from_geometry(wrong)

    def test_unknown_types_and_torn_coordinates_are_refused(self) -> None:
        with pytest.raises(errors.InputError, match="'Curve'"):
            from_geometry({"type": "Curve", "coordinates": []})
        for coordinates in ([(0, 0), (1,)], [0, 1], [("a", "b")]):
            with pytest.raises(errors.ShapeError, match="LineString"):
                from_geometry({"type": "LineString", "coordinates": coordinates})


class TestFromGeometry:
    def test_all_kinds_at_once(self) -> None:
        line = shapely.LineString([(-1, 3), (7, 3), (8, 5)])
        mesh = from_geometry([FRAME, line, shapely.MultiPoint([(1, 1), (9, 9)])])
        assert isinstance(mesh, ConstrainedDelaunay)
        assert mesh.validate()
        assert mesh.points[:8].tolist() == [list(map(float, p)) for p in RING + HOLE]
        assert mesh.input_segments[:8].tolist() == [
            *([0, 1], [1, 2], [2, 3], [3, 0]),
            *([4, 5], [5, 6], [6, 7], [7, 4]),
        ]
        assert mesh.geometry_of_segment.tolist() == [0] * 8 + [1, 1]
        assert mesh.nadded == len(mesh.report.crossings) == 4

    def test_neighbours_share_vertices(self) -> None:
        grid = [shapely.box(x, y, x + 1, y + 1) for x in range(3) for y in range(3)]
        mesh = from_geometry(geopandas.GeoSeries(grid))
        assert mesh.npoints == 16
        assert len(mesh.segments) == 24
        assert len(mesh.input_segments) == 36
        assert len(np.unique(mesh.region)) == 9
        assert len(mesh.report.repeated) == 12

    def test_crossings_may_be_refused(self) -> None:
        lines = shapely.MultiLineString([[(0, 0), (1, 1)], [(0, 1), (1, 0)]])
        with pytest.raises(errors.CrossingSegmentsError):
            from_geometry(lines, crossing="raise")

    def test_options_are_those_of_the_class(self) -> None:
        mesh = from_geometry(FRAME, holes=[(3, 3)], regions=[(1, 1, 5)], boundary="outline")
        assert mesh.areas.sum() == 32
        assert set(mesh.region.tolist()) == {5}
        with pytest.raises(errors.InputError, match="boundary"):
            from_geometry(FRAME, boundary="no such")

    def test_minus_zero_is_zero(self) -> None:
        line = shapely.LineString([(0.0, 0), (1, 1), (1, 0)])
        assert from_geometry([line, shapely.Point(-0.0, -0.0)]).npoints == 3

    def test_nan_names_geometries(self) -> None:
        bad = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (np.nan, 1)]]}
        with pytest.raises(errors.NonFiniteError, match="1 geometry has") as caught:
            from_geometry([FRAME, bad])
        assert caught.value.rows.tolist() == [1]

    @pytest.mark.parametrize("nothing", [None, [], shapely.Point(), [None, shapely.Polygon()]])
    def test_nothing_has_no_triangles(self, nothing: Any) -> None:
        with pytest.raises(errors.DegenerateInputError):
            from_geometry(nothing)

    def test_a_mapping_needs_no_library(self, monkeypatch: pytest.MonkeyPatch) -> None:
        for name in ("shapely", "geopandas"):
            monkeypatch.setitem(sys.modules, name, None)
        assert from_geometry(MAPPING).areas.sum() == 36
        assert area(triangulate_polygon(MAPPING)) == 32

    def test_edits_keep_the_geometry_of_segments(self) -> None:
        mesh = from_geometry([FRAME, shapely.LineString([(0, 0), (2, 2)])])
        with mesh.edit() as edit:
            edit.remove_segments([0, 8])
            edit.insert_segment(0, 2)
        assert edit.result.geometry_of_segment.tolist() == [0] * 7 + [-1]


class TestInside:
    def test_polygons_alone_are_kept(self) -> None:
        line = shapely.LineString([(-3, 3), (9, 3)])
        mesh = from_geometry([line, FRAME, shapely.Point(20, 20)], boundary="polygons")
        assert mesh.areas.sum() == 32
        assert set(mesh.polygon_of_simplex.tolist()) == {1}
        assert mesh.validate()

    def test_the_first_of_overlapping_polygons_counts(self) -> None:
        mesh = from_geometry([shapely.box(0, 0, 4, 4), shapely.box(2, 2, 6, 6), FRAME])
        areas = [mesh.areas[mesh.polygon_of_simplex == number].sum() for number in (-1, 0, 1, 2)]
        assert areas == [0, 16, 12, 8]

    def test_islands_in_holes_are_inside(self) -> None:
        many = shapely.MultiPolygon([FRAME, shapely.box(2.5, 2.5, 3.5, 3.5)])
        assert from_geometry(many, boundary="polygons").areas.sum() == 33

    def test_polygons_that_cover_a_side_twice_cancel_it(self) -> None:
        halves = shapely.MultiPolygon([shapely.box(0, 0, 3, 6), shapely.box(3, 0, 6, 6)])
        assert from_geometry(halves, boundary="polygons").areas.sum() == 36

    def test_arrays_have_no_polygons(self) -> None:
        assert set(ConstrainedDelaunay(RING, [(0, 2)]).polygon_of_simplex.tolist()) == {-1}
        with pytest.raises(errors.InputError, match="boundary"):
            ConstrainedDelaunay(RING, [(0, 2)], boundary="polygons")

    def test_a_torn_ring_has_no_inside(self) -> None:
        mesh = from_geometry([FRAME, shapely.box(10, 0, 11, 1)], boundary="polygons")
        with mesh.edit() as edit:
            edit.remove_segment(5)
        assert set(edit.result.polygon_of_simplex.tolist()) == {1}
        assert edit.result.areas.sum() == 1

    def test_a_file_keeps_polygons(self, tmp_path: Path) -> None:
        mesh = from_geometry([FRAME, shapely.box(10, 0, 11, 1)], boundary="polygons")
        mesh.save(tmp_path / "mesh.npz")
        loaded = ConstrainedDelaunay.load(tmp_path / "mesh.npz")
        assert np.array_equal(loaded.polygon_of_simplex, mesh.polygon_of_simplex)
        assert np.array_equal(loaded.simplices, mesh.simplices)

    @given(
        st.lists(
            st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=3, max_size=7),
            min_size=1,
            max_size=4,
        )
    )
    def test_labels_agree_with_the_even_odd_rule(self, rings: Any) -> None:
        geometries = [{"type": "Polygon", "coordinates": [ring]} for ring in rings]
        mesh = from_geometry([shapely.box(-1, -1, 6, 6).boundary, *geometries])
        for number in range(1, len(rings) + 1):
            only = from_geometry(
                [*[None] * number, geometries[number - 1], shapely.box(-1, -1, 6, 6)]
            )
            found = only.areas[only.polygon_of_simplex == number].sum()
            assert found == pytest.approx(winding_area([rings[number - 1]], "even-odd"), abs=1e-9)
        inside = mesh.polygon_of_simplex >= 1
        centre = mesh.points[mesh.simplices].mean(axis=1)
        for (x, y), label in zip(centre.tolist(), inside.tolist(), strict=True):
            assert label == any(is_inside(ring, x, y) for ring in rings)


def is_inside(ring: Any, x: float, y: float) -> bool:
    odd = False
    for (ax, ay), (bx, by) in zip(ring, [*ring[1:], ring[0]], strict=True):
        if (ay <= y) != (by <= y):
            odd ^= ((bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0) == (ay <= y)
    return odd


class TestTriangulatePolygon:
    def test_a_ring_in_any_form(self) -> None:
        forms = [
            RING,
            [*RING, RING[0]],
            np.array(RING),
            np.array(RING, dtype=float),
            np.array(RING, dtype=float, order="F"),
            np.array(RING, dtype=">f8"),
            [RING],
            np.array([RING]),
            shapely.Polygon(RING),
            shapely.Polygon(RING).__geo_interface__,
            geopandas.GeoSeries([shapely.Polygon(RING)]),
        ]
        for form in forms:
            found = triangulate_polygon(form)
            assert area(found) == 36
            assert found.simplices.dtype == np.int32
            assert len(found.simplices) == 2

    @pytest.mark.parametrize("rule", ["even-odd", "nonzero"])
    def test_holes_of_geometries_are_outside_by_both_rules(self, rule: str) -> None:
        turned = shapely.Polygon(RING[::-1], [HOLE])
        for polygon in (
            FRAME,
            turned,
            MAPPING,
            Speaker(MAPPING),
            shapely.Polygon(RING, [HOLE[::-1]]),
        ):
            assert area(triangulate_polygon(polygon, rule=rule)) == 32

    def test_arrays_are_taken_as_they_run(self) -> None:
        assert area(triangulate_polygon([RING, HOLE])) == 32
        assert area(triangulate_polygon([RING, HOLE], rule="nonzero")) == 36
        assert area(triangulate_polygon([RING, HOLE[::-1]], rule="nonzero")) == 32

    def test_a_multipolygon_is_all_its_polygons(self) -> None:
        two = shapely.MultiPolygon([FRAME, shapely.box(10, 0, 11, 1)])
        assert area(triangulate_polygon(two)) == 33

    def test_a_bow_tie_gets_its_crossing(self) -> None:
        found = triangulate_polygon([(0, 0), (4, 4), (4, 0), (0, 4)])
        assert found.points.tolist()[4:] == [[2, 2]]
        assert area(found) == 8

    def test_rules_differ_where_rings_wind_twice(self) -> None:
        overlapping = [[(0, 0), (4, 0), (4, 4), (0, 4)], [(2, 2), (6, 2), (6, 6), (2, 6)]]
        assert area(triangulate_polygon(overlapping)) == 24
        assert area(triangulate_polygon(overlapping, rule="nonzero")) == 28

    @pytest.mark.parametrize("rule", ["even-odd", "nonzero"])
    @pytest.mark.parametrize(
        "nothing",
        [
            [],
            np.empty((0, 2)),
            [(1, 1)],
            [(1, 1), (2, 2)],
            [(0, 0), (1, 1), (2, 2), (1, 1)],
            [(3, 3)] * 5,
            [[]],
            [[], [(0, 0), (1, 0)]],
            shapely.Polygon(),
            shapely.MultiPolygon(),
            shapely.Polygon([(0, 0), (1, 1), (2, 2)]),
            {"type": "Polygon", "coordinates": []},
        ],
        ids=str,
    )
    def test_what_has_no_inside_has_no_triangles(self, nothing: Any, rule: str) -> None:
        found = triangulate_polygon(nothing, rule=rule)
        assert found.simplices.shape == (0, 3)
        assert found.points.shape[1] == 2

    @given(
        st.lists(st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), max_size=8), max_size=3),
        st.sampled_from(["even-odd", "nonzero"]),
    )
    def test_any_rings_give_valid_triangles(self, rings: Any, rule: str) -> None:
        found = triangulate_polygon([ring for ring in rings if ring], rule=rule)
        assert area(found) <= 25
        inside = winding_area(rings, rule)
        assert float(area(found)) == pytest.approx(inside, abs=1e-9)

    def test_the_input_stays_the_callers(self) -> None:
        ring = np.array(RING, dtype=float)
        found = triangulate_polygon(ring)
        ring[:] = 0
        assert area(found) == 36
        assert not found.points.flags.writeable
        assert not found.simplices.flags.writeable
        geometry = shapely.Polygon(RING[::-1])
        triangulate_polygon(geometry, rule="nonzero")
        assert geometry.equals_exact(shapely.Polygon(RING[::-1]))

    def test_huge_and_tiny_rings_turn_the_right_way(self) -> None:
        for scale in (1e300, 1e-300):
            outer, inner = np.array(RING) * scale, np.array(HOLE) * scale
            polygon = shapely.Polygon(outer, [inner])
            assert len(triangulate_polygon(polygon, rule="nonzero").simplices) == 8

    def test_bad_input_is_refused(self) -> None:
        with pytest.raises(errors.InputError, match="rule must be one of"):
            triangulate_polygon(RING, rule="odd")
        with pytest.raises(errors.InputError, match="no inside"):
            triangulate_polygon(shapely.LineString([(0, 0), (1, 1)]))
        with pytest.raises(errors.InputError):
            triangulate_polygon("POLYGON")
        with pytest.raises(errors.ShapeError):
            triangulate_polygon([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
        with pytest.raises(errors.NonFiniteError):
            triangulate_polygon(np.array([(0, 0), (1, np.nan), (1, 1)]))
        with pytest.raises(errors.NonFiniteError):
            triangulate_polygon(shapely.Polygon([(0, 0), (1, np.inf), (1, 1)]))


def winding_area(rings: Any, rule: str) -> float:
    """The area inside by shapely's own arithmetic: faces of the noded sides, their winding."""
    sides = [
        (ring[i - 1], ring[i]) for ring in rings for i in range(len(ring)) if ring[i - 1] != ring[i]
    ]
    if not sides:
        return 0.0
    faces = shapely.polygonize([shapely.union_all([shapely.LineString(side) for side in sides])])
    total = 0.0
    for face in faces.geoms:
        x, y = face.representative_point().coords[0]
        winds = 0
        for (ax, ay), (bx, by) in sides:
            if (ay <= y) != (by <= y):
                left = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
                winds += (1 if left > 0 else 0) if ay <= y else (-1 if left < 0 else 0)
        if winds % 2 if rule == "even-odd" else winds:
            total += face.area
    return total


class TestTables:
    def test_triangles_become_rows_with_regions(self) -> None:
        mesh = from_geometry(FRAME)
        frame = mesh.to_geopandas(crs="EPSG:28992")
        assert list(frame.columns) == ["v0", "v1", "v2", "region", "polygon", "geometry"]
        assert len(frame) == mesh.nsimplex
        assert frame.dissolve("region").area.tolist() == [32, 4]
        assert frame.crs.to_epsg() == 28992
        assert np.array_equal(frame[["v0", "v1", "v2"]], mesh.simplices)

    def test_triangles_of_polygons_become_rows(self) -> None:
        frame = triangulate_polygon(FRAME).to_geopandas()
        assert list(frame.columns) == ["v0", "v1", "v2", "geometry"]
        assert frame.union_all().equals(FRAME)

    def test_no_triangles_are_a_table_without_rows(self) -> None:
        assert len(triangulate_polygon([]).to_geopandas()) == 0

    @pytest.mark.parametrize("library", ["shapely", "geopandas"])
    def test_a_missing_library_is_named(
        self, monkeypatch: pytest.MonkeyPatch, library: str
    ) -> None:
        monkeypatch.setitem(sys.modules, library, None)
        with pytest.raises(errors.MissingExtraError, match=library) as caught:
            delone.triangulate_polygon(RING).to_geopandas()
        assert caught.value.extra == "geo"


class TestWhatIsNoGeometry:
    @staticmethod
    def nested(item: Any, depth: int = 5000) -> Any:
        for _ in range(depth):
            item = {"type": "GeometryCollection", "geometries": [item]}
        return item

    @pytest.mark.parametrize("take", [from_geometry, triangulate_polygon])
    def test_collections_too_deep_to_follow(self, take: Any) -> None:
        deep = self.nested({"type": "Point", "coordinates": (0, 0)})
        for given_ in (deep, {"type": "FeatureCollection", "features": [deep]}):
            with pytest.raises(errors.InputError, match="too deep"):
                take(given_)

    def test_lists_too_deep_to_follow(self) -> None:
        deep: list[Any] = []
        for _ in range(5000):
            deep = [deep]
        with pytest.raises(errors.InputError, match="too deep"):
            from_geometry(deep)
        with pytest.raises(errors.InputError):
            triangulate_polygon(deep)

    @pytest.mark.deep
    def test_collections_of_shapely_are_followed_all_the_way(self) -> None:
        geometry = shapely.Polygon(RING)
        for _ in range(5000):
            geometry = shapely.GeometryCollection([geometry])
        assert area(triangulate_polygon(geometry)) == 36

    @pytest.mark.parametrize("take", [from_geometry, triangulate_polygon])
    def test_numbers_that_no_double_holds(self, take: Any) -> None:
        line = {"type": "Polygon", "coordinates": [[(0, 0), (10**400, 1), (0, 1)]]}
        with pytest.raises(errors.InputError, match="beyond the range of doubles"):
            take(line)

    @pytest.mark.parametrize("take", [from_geometry, triangulate_polygon])
    def test_curves(self, take: Any, monkeypatch: pytest.MonkeyPatch) -> None:
        def refused(*_: Any, **__: Any) -> None:
            raise NotImplementedError("Nonlinear geometry types are not currently supported")

        # Not every shapely can hold a curve; those that can say this.
        monkeypatch.setattr(shapely, "get_coordinates", refused)
        with pytest.raises(errors.InputError, match="curves are not supported"):
            take(shapely.Polygon(RING))


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("shift", [0.0, 5e5])
def test_holes_as_narrow_as_a_rounding_are_oriented_exactly(turned: bool, shift: float) -> None:
    rng = np.random.default_rng(1)
    ring = [(shift, shift), (1 + shift, shift), (1 + shift, 1 + shift), (shift, 1 + shift)]
    for _ in range(40):
        # There and almost back: the signed area is all rounding.
        a, b = rng.uniform(0.1, 0.9, (2, 2)) + shift
        middle = a + rng.uniform(0.2, 0.8) * (b - a)
        hole = [tuple(each) for each in np.array([a, middle, b]).tolist()]
        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, p) for p in hole)
        twice = abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
        for corners in (hole, hole[::-1]):
            given = corners if not turned else corners[1:] + corners[:1]
            shape = {"type": "Polygon", "coordinates": [ring, given]}
            assert area(triangulate_polygon(shape, rule="nonzero")) == 1 - twice / 2


@pytest.mark.parametrize(
    "mapping",
    [
        {"type": "FeatureCollection"},
        {"type": "FeatureCollection", "features": None},
        {"type": "FeatureCollection", "features": {"a": 1}},
        {"type": "FeatureCollection", "features": [5]},
        {"type": "Feature"},
        {"type": "Feature", "geometry": 5},
        {"type": "GeometryCollection"},
        {"type": "GeometryCollection", "geometries": 5},
        {"type": "GeometryCollection", "geometries": [5]},
        {"type": "MultiPoint", "coordinates": 5},
        {"type": "LineString", "coordinates": 5},
        {"type": "MultiLineString", "coordinates": 5},
        {"type": "Polygon", "coordinates": 5},
        {"type": "Polygon", "coordinates": [5]},
        {"type": "MultiPolygon", "coordinates": 5},
        {"type": "MultiPolygon", "coordinates": [5]},
        dict,
    ],
)
def test_mappings_that_are_no_geometries(mapping):
    calls = (
        delone.from_geometry,
        delone.mesh,
        lambda given: delone.Overlaps(given, [[(0, 0), (1, 0), (0, 1)]]),
        lambda given: delone.SizeByDistance(given, near=1),
    )
    for call in calls:
        with pytest.raises(delone.DeloneError):
            call(mapping)


def test_a_feature_without_a_geometry():
    triangle = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (0, 1)]]}
    features = [{"type": "Feature", "geometry": each} for each in (None, triangle)]
    collection = {"type": "FeatureCollection", "features": features}
    assert delone.Overlaps(collection, [triangle]).areas.tolist() == [0.5]
    assert delone.Overlaps({"a": 1, **triangle}, [triangle]).areas.tolist() == [0.5]


def test_closed_lines_are_no_polygons() -> None:
    """A closed line around a polygon, and one inside of it, contain nothing."""

    def ring(low: int, high: int) -> list[tuple[int, int]]:
        return [(low, low), (high, low), (high, high), (low, high), (low, low)]

    lines = [{"type": "LineString", "coordinates": ring(*ends)} for ends in ((0, 9), (4, 5))]
    square = {"type": "Polygon", "coordinates": [ring(3, 6)]}
    mesh = delone.from_geometry([lines[0], square, lines[1]], boundary="polygons")
    assert float(mesh.areas.sum()) == 9 and set(mesh.polygon_of_simplex.tolist()) == {1}
    hull = delone.from_geometry([lines[0], square, lines[1]])
    inside = hull.polygon_of_simplex == 1
    assert float(hull.areas[inside].sum()) == 9 and set(hull.polygon_of_simplex.tolist()) == {-1, 1}


def test_rings_may_meet_at_equal_points() -> None:
    """The last side ends at a point that repeats the first one; without it, the ring is open."""
    points = np.array([(0, 0), (1, 0), (1, 1), (0, 0)], dtype=float)
    sides = np.array([(0, 1), (1, 2), (2, 3)], dtype=np.int32)
    of = np.full(3, 4, dtype=np.int32)

    def polygons(count: int, of: Any) -> list[int]:
        options = False, False, 0, "auto", 1
        made, _, areas = _core.constrained2(points, sides[:count], *options, of)
        assert areas is not None
        again = _core.areas2(made, sides[:count], of)
        assert all(map(np.array_equal, areas, again))
        return list(areas[1].tolist())

    assert polygons(3, of) == [4] and polygons(2, of[:2]) == [-1]
    with pytest.raises(errors.ShapeError, match="differ in length"):
        polygons(3, of[:2])
