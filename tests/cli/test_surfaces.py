"""The commands for terrain with surfaces of LandXML and DXF."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("lxml")
FILES = Path(__file__).parents[1] / "terrain" / "files"
CIVIL, OTHER = FILES / "civil3d.xml", FILES / "12d.xml"


@pytest.fixture
def site(tmp_path):
    """A LandXML file in a folder whose name has a space."""
    folder = tmp_path / "site one"
    folder.mkdir()
    (folder / "ground level.xml").write_bytes(CIVIL.read_bytes())
    return folder / "ground level.xml"


def test_contours(site, figures):
    pyogrio = pytest.importorskip("pyogrio")
    output = site.with_name("contours 1.gpkg")
    found = figures("contours", site, "--interval", "1", "-o", output)
    assert (found["units"], found["crs"], found["triangles"]) == ("us-ft", "EPSG:2263", 4)
    assert pyogrio.read_info(output)["features"] == found["lines"] == 8


def test_volumes(site, figures, command):
    # The prism under a plane that rises from 10 to 18 over 8 by 8.
    assert figures("volume", site, "10")["cut"] == pytest.approx(256)
    layers = "--layer", "tin survey", "--other-layer", "tin design"
    found = figures("volume", OTHER, OTHER, *layers)
    assert found["area"] == pytest.approx(96) and found["units"] == "m"
    code, _, err = command("volume", site, "3", "--layer", "tin survey", "--other-layer", "EG")
    assert code == 2 and "--other-layer is for a file, not for a height" in err
    code, _, err = command("volume", OTHER, site, "--layer", "tin survey", "--other-layer", "EG")
    assert code == 2 and "heights are in m and in us-ft" in err


def test_faces_and_the_order_of_coordinates(site, figures, command):
    code, _, err = command("contours", site, "--interval", "1", "--max-edge", "3")
    assert code == 2 and "--retriangulate" in err
    options = "contours", site, "--interval", "1", "--retriangulate"
    assert figures(*options)["points"] > 5
    code, _, err = command("contours", site, "--interval", "1", "--easting-first")
    assert code == 3 and "swapped" in err
    code, _, err = command("contours", OTHER, "--interval", "1")
    assert code == 3 and "choose one (--layer): 'tin survey', 'tin design'" in err
    code, _, err = command("contours", site, "--interval", "1", "--classes", "2")
    assert code == 2 and "neither columns nor classes" in err


def test_units_that_contradict_each_other_are_noted(site, command):
    pytest.importorskip("pyproj")
    code, _, err = command("contours", site, "--interval", "1", "--crs", "EPSG:28992")
    assert code == 0 and "x and y are in us-ft, but those of EPSG:28992 in m" in err
    quiet = command("contours", site, "--interval", "1", "--crs", "EPSG:28992", "--quiet")
    assert quiet == (0, "", "")


def test_drawings_are_surfaces_and_breaklines(tmp_path, figures):
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new()
    space = drawing.modelspace()
    for corner in [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)]:
        space.add_point(corner, dxfattribs={"layer": "spots"})
    space.add_line((1, 2, 6), (3, 2, 6), dxfattribs={"layer": "kerbs"})
    drawing.saveas(tmp_path / "a b.dxf")
    found = figures("volume", tmp_path / "a b.dxf", "0", "--layer", "spots,kerbs")
    assert found["points"] == 6 and found["cut"] > 0
    survey = tmp_path / "a.csv"
    survey.write_text("x,y,z\n0,0,0\n4,0,0\n4,4,0\n0,4,0\n")
    pytest.importorskip("shapely")
    with_lines = figures("volume", survey, "0", "--breaklines", tmp_path / "a b.dxf")["cut"]
    assert with_lines == found["cut"]


def test_json_and_quiet_show_no_progress() -> None:
    from delone.cli.surfaces import SurfaceOptions

    assert SurfaceOptions(as_json=True).silent and SurfaceOptions(quiet=True).silent
    assert not SurfaceOptions().silent
