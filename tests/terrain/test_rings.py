"""Boundaries, holes, regions and pads: rings have one meaning, and decide without rounding."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from delone import CrossingSegmentsError, InputError, from_geometry
from delone.io import GeometrySet, read_surface
from delone.terrain import TIN, snapping

BOX = [(-1, -1, 1), (11, -1, 1), (11, 11, 1), (-1, 11, 1)]


def square(low: float, high: float) -> list[tuple[float, float]]:
    return [(low, low), (high, low), (high, high), (low, high)]


def turned(n: int, degrees: float) -> np.ndarray:
    x, y = map(np.ravel, np.meshgrid(np.arange(n) * 1.0, np.arange(n) * 1.0))
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.column_stack((x * c - y * s + 5e5, x * s + y * c + 5.4e6, x * y % 7))


def border(n: int) -> np.ndarray:
    k = np.arange(n)
    return np.concatenate((k, k[1:] * n + n - 1, (n - 1) * n + k[-2::-1], k[-2:0:-1] * n))


@pytest.mark.parametrize(("n", "degrees"), [(7, 10), (31, 10), (16, 37), (16, 72)])
def test_a_boundary_along_the_border_of_a_turned_grid(n, degrees):
    points = turned(n, degrees)
    ring = points[border(n), :2]
    tin = TIN.from_points(points, boundary=[ring])
    assert tin.nsimplex == 2 * (n - 1) ** 2
    assert tin.validate()
    # As a hole it leaves what is between it and the hull, which may be nothing.
    try:
        outside = TIN.from_points(points, holes=[ring])
    except InputError as error:
        assert "no triangle is left" in str(error)
    else:
        # Exact areas: together they are the hull.
        assert area(tin) + area(outside) == area(TIN.from_points(points))


def area(tin: TIN) -> Fraction:
    a, b, c = (
        [tuple(map(Fraction, point)) for point in tin.points[tin.simplices[:, k]].tolist()]
        for k in range(3)
    )
    return sum(
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        for p, q, r in zip(a, b, c, strict=True)
    )


def test_polygons_are_a_union_each_with_its_own_holes():
    shapely = pytest.importorskip("shapely")
    box = shapely.box
    court = box(0, 0, 8, 8) - box(2, 2, 4, 4)
    apart, over, aslant = box(6, 0, 9, 3), box(3, 0, 10, 6), box(3, 3, 8, 8)
    first = box(0, 0, 6, 6)
    tin = TIN.from_points(BOX)
    for polygons, want in [
        ([first, over], 60),
        ([first, aslant], 36 + 25 - 9),
        ([first, first], 36),
        ([first, apart], 45),
        (court, 60),
        ([court, box(3, 3, 6, 6)], 60 + 1),
        (shapely.MultiPolygon([first, apart]), 45),
    ]:
        assert TIN.from_points(BOX, boundary=polygons).areas.sum() == want
        assert TIN.from_points(BOX, holes=polygons).areas.sum() == 144 - want
        assert tin.volume_to(0.0, region=polygons).area == pytest.approx(want, rel=1e-15)
        assert tin.volume_to(tin.flatten(polygons, 0.0), region=polygons).cut == pytest.approx(want)
    # A hole across the boundary.
    assert TIN.from_points(BOX, boundary=first, holes=[aslant]).areas.sum() == 36 - 9
    bowtie = shapely.Polygon([(1, 1), (7, 7), (7, 1), (1, 7)])
    with pytest.raises(CrossingSegmentsError, match=r"first \(4, 4\)"):
        TIN.from_points(BOX, boundary=[first, bowtie])


def test_arrays_of_rings_are_odd_even():
    rings = [square(0, 10), square(2, 8), square(4, 6)]
    tin = TIN.from_points(BOX)
    assert TIN.from_points(BOX, boundary=rings).areas.sum() == 100 - 36 + 4
    assert TIN.from_points(BOX, holes=rings).areas.sum() == 144 - 68
    assert tin.volume_to(0.0, region=rings).area == 68
    assert tin.volume_to(tin.flatten(rings, 0.0), region=rings).cut == pytest.approx(68)
    kept = TIN.from_points(BOX, boundary=rings[0], holes=rings[1], islands=rings[2])
    assert kept.areas.sum() == 68 and kept.heights((5, 5)) == 1


def test_islands_of_landxml(tmp_path):
    pytest.importorskip("lxml")

    def ring(low, high):
        return " ".join(f"{y} {x}" for x, y in [*square(low, high), (low, low)])

    kinds = {"outer": (0, 10), "void": (2, 8), "island": (4, 6)}
    rings = "".join(
        f'<Boundary bndType="{kind}"><PntList2D>{ring(*ends)}</PntList2D></Boundary>'
        for kind, ends in kinds.items()
    )
    points = "".join(f'<P id="{k}">{y} {x} {z}</P>' for k, (x, y, z) in enumerate(BOX))
    path = tmp_path / "islands.xml"
    path.write_text(
        '<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2"><Surfaces><Surface name="EG">'
        f"<SourceData><Boundaries>{rings}</Boundaries></SourceData>"
        f'<Definition surfType="TIN"><Pnts>{points}</Pnts></Definition>'
        "</Surface></Surfaces></LandXML>"
    )
    assert len(read_surface(path).islands) == 1
    tin = TIN.from_file(path)
    assert tin.areas.sum() == 68 and tin.heights((5, 5)) == 1


@pytest.mark.parametrize("degrees", [0, 10, 37, 81])
def test_a_boundary_that_leaves_the_points(degrees):
    points = turned(11, degrees)
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    for place, want in [
        (square(-5, 15), 100),
        (square(4.5, 20), 5.5**2),
        ([(-3, 2.25), (20, 2.25), (20, 7.5), (-3, 7.5)], 52.5),
    ]:
        x, y = np.array(place, float).T
        ring = np.column_stack((x * c - y * s + 5e5, x * s + y * c + 5.4e6))
        tin = TIN.from_points(points, boundary=[ring])
        assert tin.areas.sum() == pytest.approx(want, rel=1e-7)
        assert np.isfinite(tin.z).all() and tin.validate()
        hole = 100 - want
        if hole > 1:
            rest = TIN.from_points(points, holes=[ring])
            assert rest.areas.sum() == pytest.approx(hole, rel=1e-7)
            assert np.isfinite(rest.z).all()


def test_a_boundary_between_lines_that_leave_the_points_needs_heights():
    line = [(11, 5, 1), (20, 5, 1)]
    with pytest.raises(InputError, match=r"outside the points at \(13, 4\.5\)"):
        TIN.from_points(BOX, breaklines=[line], boundary=[[(0, 4), (13, 4.5), (13, 5.25), (0, 6)]])


def test_holes_take_one_pass():
    """1,600 holes: each was tested against the triangles of all others."""
    corners = np.stack(np.meshgrid(np.arange(40) * 2.0, np.arange(40) * 2.0), axis=-1)
    holes = list(corners.reshape(-1, 1, 2) + np.array(square(0.5, 1.5)))
    points = [(-1, -1, 0), (81, -1, 0), (81, 81, 0), (-1, 81, 0)]
    assert TIN.from_points(points, holes=holes).areas.sum() == 82**2 - 1600


@pytest.mark.parametrize("kind", ["frame", "series", "array", "set", "mapping"])
def test_tables_of_geometries(kind):
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")

    def table(geometry):
        frame = geopandas.GeoDataFrame({"name": [1]}, geometry=[geometry])
        if kind == "set":
            return GeometrySet(geometries=frame.geometry.to_numpy())
        found = {"frame": frame, "series": frame.geometry, "array": frame.geometry.values}
        return found.get(kind, frame.__geo_interface__)

    area_, line = table(shapely.box(2, 2, 4, 4)), table(shapely.LineString([(1, 2), (8, 2)]))
    tin = TIN.from_points(BOX)
    assert len(TIN.from_points(BOX, breaklines=line).breaklines) >= 1
    assert TIN.from_points(BOX, boundary=area_).areas.sum() == 4
    assert TIN.from_points(BOX, holes=area_).areas.sum() == 140
    assert tin.flatten(area_, 5).heights((3, 3)) == 5
    assert tin.embank(area_, 2, slope=1).heights((3, 3)) == 2
    assert tin.volume_to(0.0, region=area_).area == 4
    assert tin.profile(line).distances[-1] == 7


@pytest.mark.parametrize("degrees", [10, 37, 72])
def test_pads_along_the_rows_of_a_turned_grid(degrees):
    n = 13
    points = turned(n, degrees)
    points[:, 2] = 0
    inner = (np.add.outer(np.arange(5) * n, np.arange(5)) + 4 * n + 4).ravel()
    pad = points[inner[border(5)], :2]
    ground = TIN.from_points(points)
    flat = ground.flatten(pad, 1.0)
    assert flat.validate()
    assert ground.volume_to(flat, region=[pad]).fill == pytest.approx(16, rel=1e-6)
    # One row of cells around the pad is inclined.
    assert ground.volume_to(flat).fill == pytest.approx(16 + 16 / 2 + 4 / 3, rel=0.1)
    hill = ground.embank(pad, 1.0, slope=1, corners="miter")
    assert hill.validate()
    assert ground.volume_to(hill).fill == pytest.approx(16 + 8 + 4 / 3, rel=1e-6)


def test_a_pad_of_many_edges_is_compared_with_what_is_near(monkeypatch):
    compared = []
    close = snapping._close
    monkeypatch.setattr(
        snapping, "_close", lambda *given: (compared.append(len(given[2])), close(*given))[1]
    )
    xy = np.random.default_rng(3).random((3000, 2)) * 1000
    ground = TIN.from_points(np.column_stack((xy, np.zeros(len(xy)))))
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    pad = 500 + 50 * np.column_stack((np.cos(angle), np.sin(angle)))
    flat = ground.flatten(pad, 2.0)
    assert ground.volume_to(flat, region=[pad]).fill == pytest.approx(
        200 * 1250 * np.sin(angle[1]) * 4
    )
    # Each with each would be 400 edges with all vertices, and all edges with 400 corners.
    assert sum(compared) < 400 * 3000 / 20


@pytest.mark.parametrize("form", ["shape", "list", "frame", "mapping", "collection"])
@pytest.mark.parametrize("call", ["volume_to", "volumes_to"])
def test_open_lines_are_no_regions(form, call):
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    tin = TIN.from_points(BOX)

    def measure(regions):
        if call == "volumes_to":
            return tin.volumes_to(0.0, regions)
        return tin.volume_to(0.0, region=regions)

    for geometry, right in (
        (shapely.LineString([(1, 1), (5, 1), (5, 5)]), False),
        (shapely.Point(1, 1), False),
        (shapely.LineString([(1, 1), (5, 1), (5, 5), (1, 1)]), True),
    ):
        frame = geopandas.GeoDataFrame(geometry=[geometry])
        given = {
            "shape": geometry, "list": [geometry], "frame": frame,
            "mapping": shapely.geometry.mapping(geometry), "collection": frame.__geo_interface__,
        }[form]  # fmt: skip
        if right:
            found = measure(given)
            assert float(np.sum(found.area)) == 8
        else:
            with pytest.raises(InputError, match=r"contains a|is not a line"):
                measure(given)


def test_open_lines_in_lists_of_tables_are_no_region():
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    line = geopandas.GeoDataFrame(geometry=[shapely.LineString([(1, 1), (5, 1), (5, 5)])])
    with pytest.raises(InputError, match="LineString"):
        TIN.from_points(BOX).volume_to(0.0, region=[line])


@pytest.mark.parametrize(
    "mapping",
    [
        {"type": "GeometryCollection"},
        {"type": "GeometryCollection", "geometries": 5},
        {"type": "GeometryCollection", "geometries": [None]},
        {"type": "FeatureCollection", "features": None},
        {"type": "FeatureCollection", "features": {}},
        {"type": "FeatureCollection", "features": [{"type": "Feature"}]},
        {"type": "Feature", "geometry": {}},
        {"type": "LineString", "coordinates": None},
        {"type": "LineString", "coordinates": "12"},
    ],
)
@pytest.mark.parametrize("name", ["breaklines", "boundary", "holes"])
def test_malformed_mappings_are_no_lines(mapping, name):
    pytest.importorskip("shapely")
    with pytest.raises(InputError, match=f"{name}: .* is not a geometry"):
        TIN.from_points(BOX, **{name: mapping})


def test_an_empty_boundary_is_an_error():
    pytest.importorskip("shapely")
    for empty in ([], {"type": "Feature", "geometry": None}, np.empty((0, 2)), [None]):
        with pytest.raises(InputError, match="boundary is empty"):
            TIN.from_points(BOX, boundary=empty)
    # Empty layers of holes and breaklines are what a job in steps has.
    assert len(TIN.from_points(BOX, holes=[], breaklines=[]).simplices) == 2


def test_features_hold_geometries_of_any_form():
    shapely = pytest.importorskip("shapely")

    class Placed:
        def __init__(self, mapping):
            self.__geo_interface__ = mapping

    polygon = shapely.box(2, 0.5, 3, 1.5)
    plain = shapely.geometry.mapping(polygon)
    tin = TIN.from_points(BOX)
    for feature in (
        polygon, plain, Placed(plain),
        {"type": "Feature", "geometry": polygon}, {"type": "Feature", "geometry": plain},
        {"type": "Feature", "geometry": Placed(plain)},
        Placed({"type": "Feature", "geometry": plain}),
    ):  # fmt: skip
        for features in ([feature], (feature, None)):
            given = {"type": "FeatureCollection", "features": features}
            assert tin.volume_to(0.0, region=given).area == 1
            assert len(TIN.from_points(BOX, holes=given).simplices) > 2
            assert len(from_geometry(given).simplices) == 2
        with pytest.raises(InputError, match="is not a geometry"):
            tin.volume_to(0.0, region={"type": "Feature", "geometry": {"type": "Feature"}})
    rows = {"type": "FeatureCollection", "features": iter([plain, polygon])}
    assert tin.volumes_to(0.0, rows).area.tolist() == [1, 1]
