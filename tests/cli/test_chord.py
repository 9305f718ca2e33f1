"""Curves of DXF files on the command line: --chord, and notes on what is left out."""

import json

import ezdxf
import numpy as np
import pytest


@pytest.fixture
def drawing(tmp_path):
    made = ezdxf.new()
    made.header["$INSUNITS"] = 6
    space = made.modelspace()
    for x, y in [(-20, -20), (20, -20), (20, 20), (-20, 20)]:
        space.add_point((x, y, 1))
    space.add_circle((0, 0, 2), 10)
    space.add_text("left out")
    made.saveas(tmp_path / "a.dxf")
    return tmp_path / "a.dxf"


def counts(command, *arguments):
    code, out, err = command(*arguments, "--json")
    assert code == 0, err
    assert "left out" in err and "TEXT" in err
    return json.loads(out)["points"]


@pytest.mark.parametrize("call", ["volume", "contours", "dem"])
def test_chords_are_as_near_as_wanted(call, drawing, command, tmp_path):
    options = {
        "volume": [drawing, "0"],
        "contours": [drawing, "--interval", "1"],
        "dem": [drawing, "-r", "4", "-o", tmp_path / "a.tif"],
    }[call]
    rough = counts(command, call, *options, "--chord", "1")
    fine = counts(command, call, *options, "--chord", "0.001")
    assert rough < 20
    assert fine > np.pi / np.arccos(1 - 0.001 / 10)


def test_chords_of_breaklines(drawing, survey, command, tmp_path):
    points = tmp_path / "p.csv"
    points.write_text("x,y,z\n-20,-20,1\n20,-20,1\n20,20,1\n-20,20,1\n")
    call = ("volume", points, "0", "--breaklines", drawing)
    assert counts(command, *call, "--chord", "1") < counts(command, *call, "--chord", "0.01")


def test_chords_of_the_line_of_a_profile(drawing, command, tmp_path):
    points = tmp_path / "p.csv"
    points.write_text("x,y,z\n-20,-20,1\n20,-20,1\n20,20,1\n-20,20,1\n")
    rough, fine = (
        json.loads(command("profile", points, drawing, "--chord", chord, "--json")[1])
        for chord in ("1", "0.01")
    )
    assert rough["length"] < fine["length"] < 20 * np.pi


def test_chord_is_for_drawings(survey, command):
    code, _, err = command("volume", survey, "0", "--chord", "1")
    assert code == 2
    assert "--chord is for DXF files" in err


@pytest.mark.parametrize("call", ["mesh", "triangulate --outline"])
def test_chords_of_closed_lines(call, drawing, command):
    for chord in (1.0, 0.001):
        code, out, err = command(*call.split(), drawing, "--chord", chord, "--json")
        assert code == 0, err
        assert err.startswith("delone: note: ") and "TEXT" in err
        area = json.loads(out)["area"]
        assert np.pi * (10 - chord) ** 2 < area < np.pi * 100


@pytest.mark.parametrize("call", ["mesh", "triangulate"])
def test_quiet_prints_no_notes(call, drawing, command):
    assert command(call, drawing, "--quiet") == (0, "", "")


def test_info_has_notes_and_no_warnings(drawing, command):
    code, _, err = command("info", drawing)
    assert code == 0
    assert err.startswith("delone: note: ") and "Warning" not in err


def test_chords_of_a_region(command, tmp_path):
    points = tmp_path / "p.csv"
    points.write_text("x,y,z\n-20,-20,1\n20,-20,1\n20,20,1\n-20,20,1\n")
    made = ezdxf.new()
    made.modelspace().add_circle((0, 0), 10)
    made.saveas(tmp_path / "r.dxf")
    call = ("volume", points, "0", "--region", tmp_path / "r.dxf", "--json")
    rough, fine = (json.loads(command(*call, "--chord", d)[1])["cut"] for d in ("1", "0.001"))
    assert rough < fine < 100 * np.pi
    assert fine > np.pi * (10 - 0.001) ** 2


def test_lines_and_points_of_a_drawing_are_triangulated(drawing, command):
    code, out, err = command("triangulate", drawing, "--chord", "1", "--json")
    assert code == 0, err
    figures = json.loads(out)
    segments = figures["constraints"]["segments"]
    assert segments == 7
    assert figures["points"] == 4 + segments
    assert figures["constraints"]["features"] == 5
