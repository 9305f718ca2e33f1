"""The command ``profile``: several surfaces, cross sections, tables, drawings and pictures."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

from delone.terrain import TIN

geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")
ezdxf = pytest.importorskip("ezdxf")

SLOPE = [(0, 0, 0), (40, 0, 0), (40, 40, 20), (0, 40, 20)]
AXIS = [(10, 5), (10, 35)]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    path = tmp_path / "day 1 of the höhe"
    path.mkdir()
    monkeypatch.chdir(path)
    for name, add in (("the ground", 0), ("a design", 3)):
        table = [(x, y, z + add * (x > 20)) for x, y, z in SLOPE]
        np.savetxt(f"{name}.csv", table, delimiter=",", header="x,y,z", comments="")
    geopandas.GeoSeries([shapely.LineString(AXIS)]).to_file("axis.gpkg")
    return path


def rows(path):
    with path.open(encoding="utf-8") as file:
        return list(csv.reader(file))


def test_several_surfaces_in_one_table(folder, figures):
    others = ("--other", "a design.csv", "--other", "the ground.csv")
    found = figures("profile", "the ground.csv", "axis.gpkg", *others, "-o", "a.csv", "-o", "a.dxf")
    table = rows(folder / "a.csv")
    assert table[0] == ["distance", "the ground", "a design", "the ground 2", "x", "y"]
    numbers = np.array(table[1:], dtype=float)
    ground = TIN.from_points(SLOPE)
    assert numbers[:, 1].tolist() == numbers[:, 3].tolist()
    assert numbers[:, 1] == pytest.approx(ground.heights(numbers[:, 4:]))
    assert found["profile_points"] == len(numbers) and found["length"] == 30
    layers = {layer.dxf.name for layer in ezdxf.readfile("a.dxf").layers}
    assert {"PROFILE_the ground", "PROFILE_a design", "PROFILE_the ground 2"} <= layers


def test_cross_sections(folder, figures):
    call = ("profile", "the ground.csv", "axis.gpkg", "--interval", 12, "--left", 4, "--right", 6)
    outputs = ("-o", "a.csv", "-o", "a.dxf", "-o", "a.png", "-o", "a.svg")
    found = figures(*call, "--start", 100, "--other", "a design.csv", *outputs)
    assert found["stations"] == 4 and found["length"] == 30 and found["output_bytes"] > 0
    table = rows(folder / "a.csv")
    assert table[0] == ["station", "offset", "the ground", "a design", "x", "y"]
    numbers = np.array(table[1:], dtype=float)
    assert sorted(set(numbers[:, 0])) == [100, 112, 124, 130]
    assert numbers[:, 1].min() == -4 and numbers[:, 1].max() == 6
    # To the right of an axis to the north is east.
    assert numbers[:, 4] == pytest.approx(10 + numbers[:, 1])
    assert numbers[:, 2] == pytest.approx(TIN.from_points(SLOPE).heights(numbers[:, 4:]))
    texts = [each.dxf.text for each in ezdxf.readfile("a.dxf").modelspace().query("TEXT")]
    assert {"100", "112", "124", "130"} <= set(texts)
    assert (folder / "a.png").stat().st_size > 5000
    low = figures(*call, "--quiet")["lowest"]
    assert low == pytest.approx(2.5)


def test_stations_outside_of_the_surface_are_counted(folder, figures):
    geopandas.GeoSeries([shapely.LineString([(10, 30), (10, 80)])]).to_file("long.gpkg")
    found = figures("profile", "the ground.csv", "long.gpkg", "--interval", 25, "--left", 4)
    assert (found["stations"], found["stations_without_heights"]) == (3, 2)


def test_text_and_exaggeration_of_drawings(folder, figures):
    call = ("profile", "the ground.csv", "axis.gpkg", "-o", "a.dxf", "--text-height", 0.5)
    figures(*call, "--exaggeration", 10)
    space = ezdxf.readfile("a.dxf").modelspace()
    assert {each.dxf.height for each in space.query("TEXT")} == {0.5}
    (line,) = space.query('LWPOLYLINE[layer=="PROFILE_surface"]')
    up = [point[1] for point in line.get_points()]
    assert max(up) - min(up) == pytest.approx(150)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--left", 4), "need --interval"),
        (("--start", 4), "need --interval"),
        (("--interval", 4), "--interval needs --left"),
        (("--other-layer", "a"), "once for each --other"),
        (("--exaggeration", 4), "for DXF drawings"),
        (("-o", "x.txt"), "can be written to .csv .dxf .png"),
        (("-o", "axis.gpkg"), "can be written to"),
        (("-o", "a design.csv", "--other", "a design.csv"), "would replace the input"),
        (("--interval", 0, "--left", 2), "interval must be above 0"),
        (("--other", "nothing.csv"), "nothing.csv"),
    ],
)
def test_what_does_not_go_together_is_refused(folder, command, options, words):
    code, _, message = command("profile", "the ground.csv", "axis.gpkg", *options)
    assert code != 0 and words in message


def test_chords_of_alignments(survey, command, tmp_path):
    path = tmp_path / "road.xml"
    path.write_text(
        '<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2">'
        '<Units><Metric linearUnit="meter"/></Units>'
        '<Alignments><Alignment name="axis" staStart="0" length="1"><CoordGeom>'
        '<Curve rot="ccw"><Start>500 600</Start><Center>500 500</Center><End>600 500</End></Curve>'
        "</CoordGeom></Alignment></Alignments></LandXML>"
    )
    counts = []
    for chord in ("20", "0.001"):
        code, out, err = command("profile", survey, path, "--chord", chord, "--json")
        assert code == 0, err
        counts.append(json.loads(out)["length"])
    assert counts[0] < counts[1]
    assert command("contours", survey, "--interval", "9", "--chord", "1")[0] == 2


def test_lines_outside_are_named(tmp_path, command):
    survey = tmp_path / "a.csv"
    survey.write_text("x,y,z\n0,0,1\n1,0,1\n0,1,1\n1,1,3\n")
    for name, coordinates in (("far", [[5, 5], [6, 6]]), ("near", [[-1, 0.5], [2, 0.5]])):
        line = {"type": "LineString", "coordinates": coordinates}
        (tmp_path / f"{name}.geojson").write_text(json.dumps(line))
    words = "the line is outside the surface: the profile has no points"
    for name, said in (("far", True), ("near", False)):
        line = tmp_path / f"{name}.geojson"
        assert (words in command("profile", survey, line)[2]) is said
        options = ("--profile", line, "-o", tmp_path / f"site-{name}")
        assert (words in command("terrain", survey, *options)[2]) is said


@pytest.mark.parametrize(("options", "gaps"), [((), None), (("--max-edge", "2"), 1)])
def test_gaps_are_counted(tmp_path, command, options, gaps):
    survey, line = tmp_path / "a.csv", tmp_path / "line.geojson"
    rows = [f"{x},{y},1" for x in (0, 1, 5, 6) for y in (0, 1)]
    survey.write_text("\n".join(("x,y,z", *rows)))
    line.write_text(json.dumps({"type": "LineString", "coordinates": [[0, 0.5], [6, 0.5]]}))
    code, out, _ = command("profile", survey, line, *options, "--json")
    assert code == 0 and json.loads(out)["gaps"] == gaps


def test_a_polygon_and_an_empty_layer_instead_of_a_line(folder, figures, command):
    ring = [(10, 5), (30, 5), (30, 35), (10, 35)]
    geopandas.GeoSeries([shapely.Polygon(ring)]).to_file("pit.gpkg")
    found = figures("profile", "the ground.csv", "pit.gpkg", "-o", "a.csv")
    assert found["length"] == 100
    assert "a polygon is the line around it" in " ".join(command("profile", "--help")[1].split())
    with open("empty.geojson", "w", encoding="utf-8") as file:
        json.dump({"type": "FeatureCollection", "features": []}, file)
    contours = ("contours", "the ground.csv", "--interval", 5, "-o", "a.gpkg")
    for call in (
        ("profile", "the ground.csv", "empty.geojson"),
        (*contours, "--boundary", "empty.geojson"),
        ("terrain", "the ground.csv", "-o", "site", "--profile", "empty.geojson"),
    ):
        code, _, err = command(*call)
        assert (code, err) == (3, "delone: empty.geojson contains no geometries\n")
    for index, marked in ((0, 0), (1, 4)):
        assert command(*contours, "--index", index)[0] == 0
        assert geopandas.read_file("a.gpkg")["index"].sum() == marked
