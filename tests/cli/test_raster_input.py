"""Rasters as input of the commands of terrain."""

import json

import geopandas
import numpy as np
import pytest
import rasterio
import shapely


@pytest.fixture
def ramp(tmp_path):
    """Ten rows and columns of a plane of slope 1, one cell of which is empty."""
    path = tmp_path / "ramp.tif"
    values = np.tile(np.arange(10.0), (10, 1))
    values[0, 0] = -1
    with rasterio.open(
        path, "w", driver="GTiff", count=1, height=10, width=10, dtype="float64", nodata=-1,
        crs="EPSG:28992", transform=rasterio.Affine(2, 0, 1000, 0, -2, 2000),
    ) as file:  # fmt: skip
        file.write(values, 1)
    return path


def test_commands_of_terrain_read_rasters(ramp, command, tmp_path):
    line = tmp_path / "line.gpkg"
    way = shapely.LineString([(1001, 1985), (1019, 1985)])
    geopandas.GeoDataFrame(geometry=[way], crs="EPSG:28992").to_file(line)
    for call in (
        ("contours", ramp, "--interval", "2", "-o", tmp_path / "lines.gpkg"),
        ("volume", ramp, "0"),
        ("profile", ramp, line),
        ("dem", ramp, "-r", "1", "--hillshade", "-o", tmp_path / "shade.tif"),
    ):
        code, out, err = command(*call)
        assert code == 0, err
        assert "1 cell without a height left out" in err
        assert "99" in out


def test_volume_of_a_ramp(ramp, command):
    code, out, _ = command("volume", ramp, "0", "--json", "--quiet")
    assert code == 0
    # 18 x 18 meters of mean height 4.5, without half a cell at the corner: heights 0, 0 and 1.
    assert json.loads(out)["cut"] == pytest.approx(18 * 18 * 4.5 - 2 * 1 / 3)
    code, out, _ = command("volume", ramp, "0", "--step", "3", "--json", "--quiet")
    assert json.loads(out)["points"] == 15


def test_step_is_for_rasters(survey, command):
    code, _, err = command("volume", survey, "0", "--step", "2")
    assert code == 2
    assert "--step is for rasters" in err


def test_windows_and_values_of_empty_cells(ramp, command):
    with rasterio.open(ramp, "r+") as file:
        file.nodata = None
        values = file.read(1)
        values[0, 0] = -9999
        file.write(values, 1)
    code, _, err = command("volume", ramp, "0")
    assert code == 3
    assert "--nodata" in err
    code, out, err = command("volume", ramp, "0", "--nodata", "-9999", "--json")
    assert code == 0
    assert json.loads(out)["points"] == 99
    assert "1 cell without a height left out" in err
    window = "1006,1984,1012,1990"
    code, out, _ = command("volume", ramp, ramp, "--window", window, "--json", "--nodata", "nan")
    assert json.loads(out)["points"] == 9
    assert command("volume", ramp, "0", "--window", "1,2")[0] == 2


def test_windows_are_for_rasters(survey, command):
    for option, value in (("--window", "0,0,1,1"), ("--nodata", "-1")):
        code, _, err = command("volume", survey, "0", option, value)
        assert code == 2
        assert f"{option} is for rasters" in err


def test_netcdf(ramp, command, tmp_path):
    from delone.interpolate import Grid
    from delone.io import write_raster

    path = tmp_path / "ramp.nc"
    nodes = np.arange(10.0)
    write_raster(path, Grid(np.tile(nodes, (10, 1)), nodes, nodes), crs="EPSG:28992", name="h")
    for more in ((), ("--layer", "h"), ("--window", "0,0,9,9")):
        code, out, err = command("volume", path, "0", "--json", *more)
        assert code == 0, err
        assert json.loads(out)["cut"] == pytest.approx(81 * 4.5)
    code, out, _ = command("volume", path, path, "--json", "--step", "3")
    assert (code, json.loads(out)["points"]) == (0, 16)


@pytest.mark.parametrize(
    ("call", "out"),
    [
        (("contours", "--interval", "1.5"), "a.gpkg"),
        (("contours", "--interval", "1.5", "--bands"), "a.gpkg"),
        (("volume", "3"), None),
        (("profile",), "a.csv"),
        (("dem", "-r", "1"), "a.tif"),
        (("dem", "-r", "1", "--hillshade"), "a.tif"),
        (("dem", "-r", "1", "--slope"), "a.tif"),
        (("dem", "-r", "1", "--aspect"), "a.tif"),
        (("simplify", "--max-error", "0.5"), "a.ply"),
    ],
)
def test_netcdf_is_like_geotiff(command, tmp_path, call, out):
    from delone.interpolate import Grid
    from delone.io import read_points, write_raster

    x, y = np.meshgrid(np.arange(12.0), np.arange(9.0))
    heights = 4 + 3 * np.sin(x / 3) * np.cos(y / 2) + x / 5
    heights[2, 3] = np.nan
    line = tmp_path / "line.gpkg"
    way = shapely.LineString([(0.5, 0.5), (10.5, 7.5)])
    geopandas.GeoDataFrame(geometry=[way], crs="EPSG:28992").to_file(line)
    figures, files = [], []
    for suffix in (".tif", ".nc"):
        path = tmp_path / f"dem{suffix}"
        write_raster(path, Grid(heights, x[0], y[:, 0]), crs="EPSG:28992")
        name, *more = call
        given = [line] if name == "profile" else []
        place = None if out is None else tmp_path / f"{suffix[1:]}-{out}"
        given += [] if place is None else ["-o", place]
        options = [each for each in more if each != "3"]
        against = [each for each in more if each == "3"]
        code, text, err = command(name, path, *against, *given, *options, "--json")
        assert code == 0, err
        assert "1 cell without a height left out" in err
        found = json.loads(text)
        assert found["crs"] == "EPSG:28992"
        names = ("input", "source", "outputs", "output_bytes", "stages", "peak_memory_bytes")
        figures.append({key: value for key, value in found.items() if key not in names})
        files.append(place)
    assert figures[0] == figures[1]
    assert call[0] == "simplify" or figures[0]["points"] == 107
    if out == "a.gpkg":
        one, two = map(geopandas.read_file, files)
        assert len(one) > 3
        assert one.equals(two)
    elif out == "a.tif":
        one, two = (rasterio.open(file).read(1) for file in files)
        assert np.isfinite(one).sum() > 50
        assert np.array_equal(one, two, equal_nan=True)
    elif out == "a.ply":
        # Rows of the two files are in another order.
        one, two = (np.column_stack((each.points, each.z)) for each in map(read_points, files))
        assert sorted(one.tolist()) == sorted(two.tolist())
    elif out is not None:
        one, two = (file.read_bytes() for file in files)
        assert one == two


def test_windows_of_lidar(command, tmp_path):
    laspy = pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    points = np.random.default_rng(3).integers(0, 1000, (500, 3)) / 10
    file = laspy.LasData(laspy.LasHeader(version="1.4", point_format=6))
    file.header.scales = np.full(3, 0.1)
    file.x, file.y, file.z = points.T
    file.write(tmp_path / "survey.laz")
    call = "volume", tmp_path / "survey.laz", "0", "--duplicates", "min", "--json"
    code, out, _ = command(*call, "--window", "20,30,70,80", "--planar")
    x, y, _ = points.T
    inside = (x >= 20) & (x <= 70) & (y >= 30) & (y <= 80)
    assert code == 0
    assert json.loads(out)["points"] == len(np.unique(points[inside, :2], axis=0))
