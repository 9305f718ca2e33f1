"""Survey points and alignments of LandXML: arcs by centers, clothoids by Fresnel integrals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from delone import InputError
from delone.errors import FileFormatError
from delone.io import LeftOutWarning, read_geometries, read_points, read_surface
from delone.terrain import TIN

pytest.importorskip("lxml")
shapely = pytest.importorskip("shapely")
special = pytest.importorskip("scipy.special")

POINTS = """
<CgPoints>
  <CgPoint name="1" code="EP" desc="edge">463000.5 155000.25 3.5</CgPoint>
  <CgPoint name="2" code="GR">463090.0 155010.0 4.5</CgPoint>
  <CgPoint name="3">463010.0 155090.0 5.5</CgPoint>
  <CgPoint name="bm 4">463020.0 155030.0</CgPoint>
  <CgPoint name="3">463010.0 155090.0 5.5</CgPoint>
  <CgPoints name="group"><CgPoint pntRef="1"/></CgPoints>
</CgPoints>"""
SURFACE = """
<Surfaces><Surface name="EG"><Definition surfType="TIN">
<Pnts><P id="1">0 0 1</P><P id="2">9 0 1</P><P id="3">0 9 1</P></Pnts><Faces><F>1 2 3</F></Faces>
</Definition></Surface></Surfaces>"""


def write(path, *parts, units="meter"):
    path.write_text(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2">\n'
        f'<Units><Metric linearUnit="{units}"/></Units><CoordinateSystem epsgCode="28992"/>\n'
        + "\n".join(parts)
        + "\n</LandXML>\n"
    )
    return path


def alignment(*elements, name="axis", start="0"):
    return (
        f'<Alignments><Alignment name="{name}" staStart="{start}" length="1"><CoordGeom>'
        + "\n".join(elements)
        + "</CoordGeom></Alignment></Alignments>"
    )


def ends(tag, start, end, *more, **given):
    """An element between two places (x, y); the file has northings first."""
    words = "".join(f' {name}="{value}"' for name, value in given.items())
    places = [("Start", start), *more, ("End", end)]
    inner = "".join(f"<{name}>{float(y)!r} {float(x)!r}</{name}>" for name, (x, y) in places)
    return f"<{tag}{words}>{inner}</{tag}>"


def test_survey_points_have_names_codes_and_heights(tmp_path):
    path = write(tmp_path / "a.xml", POINTS, SURFACE)
    with pytest.warns(LeftOutWarning, match="1 repeated CgPoint, 1 CgPoint that refers to another"):
        found = read_points(path, layer="CgPoints", attributes="all")
    assert found.points.tolist() == [
        [155000.25, 463000.5],
        [155010.0, 463090.0],
        [155090.0, 463010.0],
        [155030.0, 463020.0],
    ]
    assert found.z[:3].tolist() == [3.5, 4.5, 5.5] and np.isnan(found.z[3])
    assert {name: values.tolist() for name, values in found.attributes.items()} == {
        "name": ["1", "2", "3", "bm 4"],
        "code": ["EP", "GR", "", ""],
        "desc": ["edge", "", "", ""],
    }
    assert found.crs == "EPSG:28992"
    # Without a choice, a file with a surface has that.
    assert read_surface(path).name == "EG" and len(read_points(path).points) == 3
    with pytest.raises(FileFormatError, match="no column 'code': CgPoints have name"):
        read_points(path, attributes=["code"])


def test_a_file_of_points_alone_is_a_survey(tmp_path):
    path = write(tmp_path / "a.xml", POINTS)
    with pytest.warns(LeftOutWarning, match="1 CgPoint without a height"):
        tin = TIN.from_file(path)
    assert tin.npoints == 3 and tin.units == "m" and tin.z.tolist() == [3.5, 4.5, 5.5]
    with pytest.warns(LeftOutWarning):
        assert read_points(path, attributes=["code"]).attributes["code"].tolist()[0] == "EP"
    empty = write(tmp_path / "b.xml")
    with pytest.raises(FileFormatError, match="no surface, and no survey points"):
        read_surface(empty)
    swapped = write(tmp_path / "c.xml", "<CgPoints><CgPoint>155000 463000 1</CgPoint></CgPoints>")
    with pytest.raises(FileFormatError, match="easting and northing are swapped"):
        read_points(swapped)


def test_arcs_become_chords_as_close_as_wanted(tmp_path):
    center, radius = np.array([155_100.0, 463_050.0]), 50.0
    up = np.array([0, radius])
    start, end = center - up, center + up
    arc = {"rot": "ccw", "crvType": "arc", "radius": radius}
    path = write(
        tmp_path / "a.xml",
        alignment(
            ends("Line", (155_000.0, 463_000.0), start),
            ends("Curve", start, end, ("Center", center), **arc),
            ends("Line", end, (155_000.0, 463_100.0)),
            start="1200.5",
        ),
    )
    for chord in (0.5, 0.01, None):
        found = read_geometries(path, chord=chord, attributes="all")
        line = shapely.get_coordinates(found.geometries[0])
        turned = line[(line[:, 0] > center[0] + 1e-6)]
        assert np.hypot(*(turned - center).T) == pytest.approx(np.full(len(turned), radius))
        # Counterclockwise from below to above: through the east.
        assert turned[:, 0].max() > center[0] + 49 and (np.diff(turned[:, 1]) > 0).all()
        on = np.vstack((start, turned, end))
        middles = (on[1:] + on[:-1]) / 2
        sagitta = radius - np.hypot(*(middles - center).T)
        assert 0.2 < sagitta.max() / (chord or 0.05) <= 1 + 1e-9
        assert found.attributes["start"].tolist() == [1200.5]
    clockwise = alignment(ends("Curve", start, end, ("Center", center), **(arc | {"rot": "cw"})))
    (line,) = read_geometries(write(tmp_path / "b.xml", clockwise)).geometries
    assert shapely.get_coordinates(line)[:, 0].min() < center[0] - 49


@pytest.mark.parametrize("rot", ["cw", "ccw"])
def test_clothoids_are_those_of_fresnel(tmp_path, rot):
    radius, length, chord = 80.0, 60.0, 1e-3
    scale = math.sqrt(math.pi * radius * length)
    s = np.linspace(0, length, 400)
    y, x = special.fresnel(s / scale)
    side = 1 if rot == "ccw" else -1
    true = np.column_stack((x, side * y)) * scale + (155_000, 463_000)
    spiral = {
        "length": length,
        "radiusStart": "INF",
        "radiusEnd": radius,
        "rot": rot,
        "spiType": "clothoid",
    }
    corner = ("PI", true[0] + (20, 0))
    inward = ends("Spiral", true[0].tolist(), true[-1].tolist(), corner, **spiral)
    path = write(tmp_path / "a.xml", alignment(inward))
    (found,) = read_geometries(path, chord=chord).geometries
    away = shapely.distance(found, shapely.points(true))
    assert 0.3 * chord < away.max() < 1.05 * chord
    # Out of the curve again: the same line backward turns to the other side.
    angle = length / (2 * radius)
    corner = ("PI", true[-1] - 10 * np.array([math.cos(angle), side * math.sin(angle)]))
    other = {"radiusStart": radius, "radiusEnd": "INF", "rot": "cw" if rot == "ccw" else "ccw"}
    outward = ends("Spiral", true[-1].tolist(), true[0].tolist(), corner, **(spiral | other))
    (back,) = read_geometries(write(tmp_path / "b.xml", alignment(outward)), chord=chord).geometries
    assert shapely.distance(back, shapely.points(true)).max() < 1.05 * chord


def test_alignments_are_chosen_by_name_and_measured(tmp_path):
    one = alignment(ends("Line", (0.0, 0.0), (5.0, 5.0)), name="a", start="100")
    other = alignment(
        "<IrregularLine><Start>0 0</Start><End>3 4</End><PntList2D>0 0 3 1 3 4</PntList2D>"
        "</IrregularLine>",
        name="b",
    )
    profile = "<Alignments><Alignment name='c' staStart='0'><Profile/></Alignment></Alignments>"
    path = write(tmp_path / "a.xml", SURFACE, one, other, profile)
    found = read_geometries(path, layer="b")
    assert shapely.get_coordinates(found.geometries).tolist() == [[0, 0], [1, 3], [4, 3]]
    with pytest.warns(LeftOutWarning, match="1 Profile of an alignment, 1 alignment without a"):
        found = read_geometries(path, layer="Alignments", attributes="all")
    assert found.attributes["name"].tolist() == ["a", "b"]
    with pytest.raises(FileFormatError, match=r"no surface or alignment 'd'; its .* 'a', 'b', 'c'"):
        read_geometries(path, layer="d")
    tin = TIN.from_points([(0, 0, 1), (9, 0, 1), (9, 9, 3), (0, 9, 3)])
    sections = tin.cross_sections(read_geometries(path, layer="a"), interval=2, left=1)
    assert len(sections) == 5


def test_ends_refer_to_survey_points_that_may_follow(tmp_path):
    line = '<Line><Start pntRef="1"/><End pntRef="2"/></Line>'
    path = write(tmp_path / "a.xml", alignment(line), POINTS)
    with pytest.warns(LeftOutWarning):
        (found,) = read_geometries(path).geometries
    assert shapely.get_coordinates(found).tolist() == [[155000.25, 463000.5], [155010.0, 463090.0]]


CURVE = {"rot": "cw", "radius": 1}
SPIRAL = {"length": 9, "radiusStart": "INF", "radiusEnd": 20, "rot": "cw"}


@pytest.mark.parametrize(
    ("elements", "words"),
    [
        ([ends("Line", (0, 0), (1, 1)), ends("Line", (1, 2), (3, 3))], "gap of 1 before this Line"),
        ([ends("Curve", (0, 0), (2, 0), ("Center", (1.5, 0)), **CURVE)], "not equally far"),
        ([ends("Curve", (0, 0), (2, 0), ("Center", (1, 0)))], "rot must be cw or ccw"),
        ([ends("Curve", (0, 0), (2, 0), **CURVE)], "this Curve has no Center"),
        ([ends("Curve", (0, 0), (0, 0), ("Center", (0, 0)), **CURVE)], "not equally far"),
        (
            [ends("Curve", (0, 0), (2, 0), ("Center", (1, 0)), rot="cw", crvType="chord")],
            "other than arcs",
        ),
        (
            [ends("Spiral", (0, 0), (9, 0), ("PI", (4, 0)), **(SPIRAL | {"spiType": "bloss"}))],
            "spirals of the type 'bloss'",
        ),
        ([ends("Spiral", (0, 0), (9, 9), ("PI", (4, 0)), **SPIRAL)], "does not reach its end"),
        ([ends("Spiral", (0, 0), (9, 0), ("PI", (0, 0)), **SPIRAL)], "has no direction"),
        (
            [ends("Spiral", (0, 0), (9, 0), ("PI", (4, 0)), **(SPIRAL | {"radiusEnd": "5e-324"}))],
            "has no direction, or no radius",
        ),
        (
            [ends("Spiral", (0, 0), (9, 0), ("PI", (4, 0)), **(SPIRAL | {"length": "-1"}))],
            "length of this Spiral is '-1'",
        ),
        (["<Line><Start>0 0</Start><End>1 nan</End></Line>"], "'nan' is not a finite number"),
        (["<Line><Start>0 0</Start><End>1</End></Line>"], "2 numbers for each point"),
        (["<Line><Start>0 0</Start></Line>"], "this Line has no End"),
        (['<Line><Start>0 0</Start><End pntRef="x"/></Line>'], "there is no CgPoint 'x'"),
        (["<Chain>1 2 3</Chain>"], "a Chain without a list of points"),
        ([ends("Curve", (-1e308, 0), (1e308, 0), ("Center", (0, 9e307)), **CURVE)], "line "),
    ],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path, elements, words):
    path = write(tmp_path / "a.xml", alignment(*elements))
    with pytest.raises(FileFormatError, match=words) as caught:
        read_geometries(path)
    assert ", line " in str(caught.value)


def test_curves_do_not_exhaust_memory(tmp_path):
    arc = ends("Curve", (0, 0), (2e9, 0), ("Center", (1e9, 0)), **CURVE)
    path = write(tmp_path / "a.xml", alignment(arc))
    for chord in (1e-9, 1e-320):
        with pytest.raises(FileFormatError, match="more than 4,194,304 chords: choose a larger"):
            read_geometries(path, chord=chord)
    assert len(read_geometries(path)) == 1
    with pytest.raises(InputError, match="chord must be"):
        read_geometries(path, chord=-1)
    with pytest.raises(FileFormatError, match="DOCTYPE"):
        path.write_text("<!DOCTYPE LandXML [<!ENTITY a 'b'>]>" + "<LandXML/>")
        read_geometries(path)


def test_points_of_one_name_at_two_places_are_refused(tmp_path):
    points = (
        '<CgPoints><CgPoint name="7">0 0 1</CgPoint><CgPoint name="7">0 1 1</CgPoint></CgPoints>'
    )
    path = write(tmp_path / "a.xml", points)
    with pytest.raises(FileFormatError, match="line 4: a second CgPoint has the name '7'"):
        read_points(path)
    path = write(tmp_path / "b.xml", '<Alignments><Alignment staStart="x"/></Alignments>')
    with pytest.raises(FileFormatError, match="staStart 'x' is not a finite number"):
        read_geometries(path)
