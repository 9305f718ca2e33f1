"""The command ``difference``: figures, files, and what it refuses."""

import numpy as np
import pytest
import rasterio

from delone.interpolate import Grid
from delone.io import write_raster

X, Y = np.arange(10.0) + 1000.5, np.arange(8.0) + 2000.5


@pytest.fixture
def dems(tmp_path):
    """A ramp of slope 1, one cell of which is empty, and a level raster one column longer."""
    ramp, level = tmp_path / "ramp.tif", tmp_path / "level.tif"
    values = np.tile(np.arange(10.0), (8, 1))
    values[2, 3] = np.nan
    write_raster(ramp, Grid(values, X, Y), crs="EPSG:28992", units="m")
    longer = Grid(np.full((8, 11), 4.0), np.append(X, 1010.5), Y)
    write_raster(level, longer, crs="EPSG:28992")
    return ramp, level


def test_difference_of_two_rasters(dems, figures, command, tmp_path):
    ramp, level = dems
    code, _, err = command("difference", ramp, level)
    assert code == 2
    window = err.partition("--window ")[2].strip()
    tif, png = tmp_path / "d.tif", tmp_path / "d.png"
    found = figures("difference", ramp, level, "--window", window, "-o", tif, "-o", png)
    assert (found["cells_compared"], found["cells_without_height"]) == (79, 1)
    assert (found["least"], found["greatest"]) == (-4, 5)
    assert (found["cut"], found["fill"]) == (8 * 15, 8 * 10 - 1)
    assert (found["volume_units"], found["area_units"]) == (None, "m2")
    with rasterio.open(tif) as file:
        assert file.crs.to_epsg() == 28992
        assert np.nanmax(file.read(1)) == 5
    assert png.stat().st_size > 1000


def test_heights_surfaces_and_rasters_as_surfaces(dems, figures, command, tmp_path):
    ramp, level = dems
    found = figures("difference", ramp, "4", "--units", "m")
    assert (found["cut"], found["fill"], found["volume_units"]) == (120, 79, "m3")
    found = figures("difference", ramp, level, "--surface")
    assert (found["cut"], found["fill"]) == (120, 79)
    points = tmp_path / "points.csv"
    points.write_text("x,y,z\n1000,2000,0\n1005,2000,5\n1005,2008,5\n1000,2008,0\n")
    found = figures("difference", ramp, points, "--crs", "EPSG:28992")
    assert found["cells_without_height_of_other"] == 5 * 8
    assert found["least"] == pytest.approx(-0.5)
    assert found["greatest"] == pytest.approx(-0.5)
    code, out, _ = command("difference", ramp, "4", "--units", "m")
    assert code == 0
    assert "120 m3" in out


@pytest.mark.parametrize(
    ("change", "code", "text"),
    [
        (["nothing.tif"], 3, "neither a file nor a height"),
        (["4", "-o", "out.xyz"], 5, "cannot write rasters"),
        (["4", "--window", "1,2"], 2, "--window takes"),
        (["4", "--layer", "z"], 2, "number of a band"),
    ],
)
def test_what_is_refused(dems, command, change, code, text):
    found, _, err = command("difference", dems[0], *change)
    assert (found, text in err) == (code, True), err


def test_the_first_is_a_raster_and_inputs_stay(survey, dems, command):
    code, _, err = command("difference", survey, "4")
    assert (code, "not a raster of heights" in err) == (2, True)
    code, _, err = command("difference", *dems, "-o", dems[1])
    assert code == 2
    assert "input" in err
    with rasterio.open(dems[1]) as file:
        assert file.width == 11


def test_systems_differ(dems, command, tmp_path):
    other = tmp_path / "other.tif"
    write_raster(other, Grid(np.zeros((8, 10)), X, Y), crs="EPSG:31370")
    code, _, err = command("difference", dems[0], other)
    assert code == 2
    assert "gdalwarp" in err


def test_cells_that_no_window_makes_the_same(dems, command, tmp_path):
    other = tmp_path / "other.tif"
    write_raster(other, Grid(np.zeros((8, 10)), X + 0.5, Y), crs="EPSG:28992")
    code, _, err = command("difference", dems[0], other)
    assert code == 2
    assert "as a --surface" in err


def test_an_error_of_one_file_leaves_none(dems, command, tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("delone.cli.difference.raster_writer", lambda _: full)
    png, tif = tmp_path / "d.png", tmp_path / "d.tif"
    code, _, err = command("difference", dems[0], "4", "-o", png, "-o", tif)
    assert (code, f"{tif}: No space" in err) == (5, True), err
    assert not png.exists() and not tif.exists()
