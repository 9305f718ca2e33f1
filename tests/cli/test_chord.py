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
