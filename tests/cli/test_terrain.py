"""The commands ``contours``, ``profile``, ``volume`` and ``dem``, in folders with spaces."""

from __future__ import annotations

import json

import numpy as np
import pytest

from delone import distributed
from delone.distributed.read import contours
from delone.interpolate import grid
from delone.terrain import TIN

geopandas = pytest.importorskip("geopandas")
rasterio = pytest.importorskip("rasterio")
shapely = pytest.importorskip("shapely")

SLOPE = [(0, 0, 0), (40, 0, 0), (40, 40, 20), (0, 40, 20)]


@pytest.fixture
def folder(tmp_path):
    """A folder with spaces and an accent, with points, lines and polygons."""
    path = tmp_path / "survey of the höhe" / "day 1"
    path.mkdir(parents=True)
    np.savetxt(path / "the points.csv", SLOPE, delimiter=",", header="x,y,z", comments="")
    np.savetxt(
        path / "after it.csv",
        [(x, y, z + 1) for x, y, z in SLOPE],
        delimiter=",",
        header="x,y,z",
        comments="",
    )
    for name, geometry in {
        "the line": shapely.LineString([(10, 0), (10, 40)]),
        "the dike": shapely.LineString([(0, 15, 14), (40, 15, 14)]),
        "the pit": shapely.box(0, 0, 20, 40),
    }.items():
        geopandas.GeoSeries([geometry]).to_file(path / f"{name}.gpkg")
    return path


def read(path):
    with rasterio.open(path) as file:
        return file.read(1), file.transform, file.crs


def test_contours(folder, figures):
    out = folder / "some contours.gpkg"
    found = figures(
        "contours", folder / "the points.csv", "--interval", 5, "-o", out, "--crs", "EPSG:28992"
    )
    assert found["lines"] == 4 and found["levels"] == 4 and found["crs"] == "EPSG:28992"
    assert found["output_bytes"] == out.stat().st_size and found["coordinates"] == 11
    table = geopandas.read_file(out)
    assert table.level.tolist() == [5, 10, 15, 20] and table.crs.to_epsg() == 28992
    few = figures("contours", folder / "the points.csv", "--interval", 5, "--min-length", 41)
    lengths = table.geometry.length
    assert few["short_lines_left_out"] == np.count_nonzero(lengths < 41)
    assert few["lines"] + few["short_lines_left_out"] == 4
    bump = folder / "a bump.csv"
    lines = (folder / "the points.csv").read_text() + "20,20,30\n"
    bump.write_text(lines)
    call = ("contours", bump, "--levels", "5,29.5", "--min-area", 5)
    found = figures(*call)
    assert (found["lines"], found["small_lines_left_out"]) == (1, 1)
    found = figures(*call, "--bands")
    assert (found["polygons"], found["small_polygons_left_out"]) == (2, 1)
    bands = folder / "some bands.geojson"
    figures("contours", folder / "the points.csv", "--levels", "10", "--bands", "-o", bands)
    assert geopandas.read_file(bands).area.tolist() == [800, 800]


@pytest.mark.parametrize(
    ("option", "sharp"), [("--breaklines", True), ("--soft-breaklines", False)]
)
def test_hard_and_soft_breaklines(folder, figures, option, sharp):
    dike = folder / "a ridge.gpkg"
    ridge = shapely.LineString([(20, 0, 20), (20, 40, 40)])
    geopandas.GeoSeries([ridge]).to_file(dike)
    out = folder / "smooth ones.gpkg"
    found = figures(
        *("contours", folder / "the points.csv", option, dike, "--levels", 15, "--smooth", 1),
        *("--duplicates", "max", "-o", out),
    )
    line = geopandas.read_file(out).geometry[0]
    assert found["points"] == 6
    # The level 15 crosses the ridge nowhere, that of 30 does.
    figures(
        *("contours", folder / "the points.csv", option, dike, "--levels", 30, "--smooth", 1),
        *("--duplicates", "max", "-o", out),
    )
    line = geopandas.read_file(out).geometry[0]
    corner = shapely.Point(20, 20)
    assert (shapely.distance(line, corner) == 0) == sharp


def test_profile(folder, figures):
    out = folder / "a profile.csv"
    found = figures(
        *("profile", folder / "the points.csv", folder / "the line.gpkg", "-o", out),
        *("--breaklines", folder / "the dike.gpkg"),
    )
    table = np.loadtxt(out, delimiter=",", skiprows=1)
    assert found["length"] == 40 and found["highest"] == 20
    assert [0.0, 0.0] in table[:, :2].tolist() and [15.0, 14.0] in table[:, :2].tolist()
    picture = folder / "a profile.svg"
    figures("profile", folder / "the points.csv", folder / "the line.gpkg", "-o", picture)
    assert picture.read_text().startswith("<?xml")


def test_volume(folder, figures):
    found = figures("volume", folder / "the points.csv", folder / "after it.csv")
    assert (found["cut"], found["fill"]) == pytest.approx((0, 1600))
    found = figures("volume", folder / "the points.csv", 10, "--region", folder / "the pit.gpkg")
    assert (found["cut"], found["fill"]) == pytest.approx((2000, 2000)) and found["area"] == 800
    found = figures("volume", folder / "the points.csv", 0)
    assert (found["cut"], found["fill"]) == pytest.approx((16000, 0))


def test_regions_and_lines_in_degrees_are_transformed(tmp_path, figures, command):
    low = np.array([155_000.0, 463_000.0])
    points = [(*(low + at), 1) for at in ((0, 0), (100, 0), (100, 100), (0, 100))]
    source, pit, road = (tmp_path / name for name in ("site.csv", "pit.geojson", "road.geojson"))
    np.savetxt(source, points, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    for path, geometry in {
        pit: shapely.box(*(low + 10), *(low + 20)),
        road: shapely.LineString([low + 10, low + 40]),
    }.items():
        geopandas.GeoSeries([geometry], crs=28992).to_crs(4326).to_file(path)
    there = ("--crs", "EPSG:28992")
    found = figures("volume", source, 0, "--region", pit, *there)
    assert found["cut"] == pytest.approx(100, rel=1e-4)
    assert figures("profile", source, road, *there)["length"] == pytest.approx(42.43, abs=0.01)
    code, _, notes = command("volume", source, 0, "--region", pit)
    assert code == 0 and "that of the surface is unknown, and assumed to be the same" in notes
    assert "no area in common" in notes


def test_heights_that_differ_are_within_a_tolerance(folder, figures, command):
    path = folder / "the points.csv"
    path.write_text(path.read_text() + "40,0,0.002\n")
    code, _, message = command("volume", path, 0)
    assert code == 4 and "0 to 0.002" in message and "tolerance" in message
    assert figures("volume", path, 0, "--tolerance", 0.005)["points"] == 4


@pytest.mark.parametrize("what", ["height", "slope", "aspect", "hillshade"])
def test_dem_of_a_file_of_points(folder, figures, what):
    out = folder / f"the {what}.tif"
    options = [] if what == "height" else [f"--{what}"]
    found = figures(
        *("dem", folder / "the points.csv", "-r", 5, *options, "-o", out, "--crs", "EPSG:28992")
    )
    values, transform, crs = read(out)
    expected = TIN.from_points(SLOPE).raster(what, resolution=5)
    assert np.allclose(values[::-1], expected.values)
    assert (transform.a, transform.e, transform.c, transform.f) == (5, -5, 0, 40)
    assert crs.to_epsg() == 28992 and found["values"] == what
    assert found["output_bytes"] == out.stat().st_size
    if what == "slope":
        assert np.allclose(values, np.degrees(np.arctan(0.5)))
    if what == "aspect":
        assert np.allclose(values, 180)


def test_dem_names_the_units_of_its_values(folder, figures):
    import rasterio

    out = folder / "out.tif"
    for options, unit in (
        ([], None),
        (["--crs", "EPSG:7415"], "m"),
        (["--crs", "EPSG:7415", "--slope"], "degrees"),
    ):
        figures("dem", folder / "the points.csv", "-r", 5, "-o", out, *options)
        with rasterio.open(out) as file:
            assert file.units == (unit,)


def test_dem_with_light_bounds_and_lines(folder, figures):
    out = folder / "shade.tif"
    figures(
        *("dem", folder / "the points.csv", "-r", "5,10", "--hillshade", "--azimuth", 180),
        *("--altitude", 30, "--z-factor", 2, "--bounds", "0,0,20,40", "-o", out),
    )
    values = read(out)[0]
    # The light is at a right angle to the slope of 45 degrees, but for 15 degrees.
    assert values.shape == (4, 4) and np.allclose(values, np.cos(np.radians(15)))
    figures(
        *("dem", folder / "the points.csv", "-r", 10, "-o", out),
        *("--soft-breaklines", folder / "the dike.gpkg", "--boundary", folder / "the pit.gpkg"),
        *("--crossing", "max"),
    )
    values = read(out)[0][::-1]
    assert np.isnan(values[:, 2:]).all() and values[1, 0] == pytest.approx(14)


def test_dem_of_tiles_in_a_folder_with_spaces(folder, figures, command):
    points = np.random.default_rng(2).random((3000, 3)) * 100
    np.savetxt(folder / "many.csv", points, delimiter=",", header="x,y,z", comments="")
    tiles, out = folder / "my tiles", folder / "tiles.tif"
    command("tile", folder / "many.csv", "-o", tiles, "--tile-points", 500)
    figures("dem", tiles, "-r", 5, "-o", out)
    values, transform, _ = read(out)
    x = transform.c + transform.a * (np.arange(values.shape[1]) + 0.5)
    y = transform.f + transform.e * (np.arange(values.shape[0]) + 0.5)
    expected = grid(points[:, :2], points[:, 2], x=x, y=y[::-1])
    assert np.allclose(values, expected.values[::-1], equal_nan=True)
    figures("dem", tiles, "-r", 5, "-o", out, "--hillshade", "--altitude", 30)
    shades = read(out)[0]
    figures("dem", folder / "many.csv", "-r", 5, "-o", out, "--hillshade", "--altitude", 30)
    assert (np.isclose(shades, read(out)[0], rtol=1e-5, equal_nan=True)).mean() > 0.99
    code, _, err = command("dem", tiles, "-r", 5, "-o", out, "--max-edge", 3, "--crossing", "min")
    assert code == 2 and "--max-edge, --crossing: for files of points" in err


def test_tiles_in_place_of_a_file(folder, figures, command):
    points = np.random.default_rng(5).random((2000, 3)) * [100, 100, 9]
    np.savetxt(folder / "many.csv", points, delimiter=",", header="x,y,z", comments="")
    line = folder / "the line.gpkg"
    file, tiles = folder / "many.csv", folder / "tiles"
    command("tile", file, "-o", tiles, "--tile-points", 300)
    for what, name, number in (
        (["contours", "--interval", 0.5], "lines.gpkg", "coordinates"),
        (["contours", "--interval", 1, "--smooth", 1, "--min-length", 2], "few.gpkg", "lines"),
        (["profile", line], "heights.csv", "profile_points"),
        (["volume", 4], None, "area"),
    ):
        output = [] if name is None else ["-o", folder / name]
        command_, *more = what
        where = [more.pop(0)] if command_ in ("profile", "volume") else []
        found = figures(command_, tiles, *where, *more, *output)
        ours = None if name is None else (folder / name).read_bytes()
        right = figures(command_, file, *where, *more, *output)
        assert found[number] == pytest.approx(right[number]) and found["tiles"] > 4
        if name == "heights.csv":
            assert ours == (folder / name).read_bytes()
    figures("volume", tiles, tiles)
    for wrong, message in (
        (["contours", tiles, "--interval", 1, "--snap", 1, "--max-edge", 2], "--max-edge, --snap"),
        (["contours", tiles, "--interval", 1, "--bands"], "--bands is for files"),
        (
            ["contours", tiles, "--interval", 1, "--crs", "EPSG:28992"],
            "--crs: the tiles already have",
        ),
        (["profile", tiles, line, "--other", file], "--other and --interval"),
        (["volume", file, tiles], "swap the two"),
    ):
        code, _, err = command(*wrong)
        assert code == 2
        assert message in err


@pytest.mark.parametrize("suffix", [".gpkg", ".shp", ".sqlite", ".geojson"])
def test_contours_of_tiles_are_written_in_parts(figures, monkeypatch, tmp_path, suffix):
    monkeypatch.setattr(contours, "CROSSINGS", 1)
    random = np.random.default_rng(1)
    points = np.column_stack((random.random((900, 2)) * 90, random.random(900) * 9))
    tiles = distributed.triangulate(points, tmp_path / "a.tin", tile_points=200)
    right = TIN.from_points(points).contours(interval=1, min_length=9)
    out = tmp_path / f"a{suffix}"
    found = figures("contours", tiles.path, "--interval", 1, "--min-length", 9, "-o", out)
    table = geopandas.read_file(out)
    assert table.level.tolist() == right.level.tolist() and len(set(right.level)) > 5
    assert shapely.get_coordinates(table.geometry).tolist() == right.points.tolist()
    assert table["index"].astype(bool).tolist() == right.index.tolist()
    assert found["short_lines_left_out"] == right.short > 0
    assert (found["lines"], found["coordinates"]) == (len(right), len(right.points))
    # No line at all.
    assert figures("contours", tiles.path, "--levels", 99, "-o", out)["lines"] == 0
    assert len(geopandas.read_file(out)) == 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--hillshade", "--slope"], "--hillshade and --slope are separate rasters"),
        (["--azimuth", "90"], "--azimuth: only for --hillshade"),
        (["--value", "intensity"], "--value is for tiles"),
        (["--bounds", "1,2,3"], "--bounds takes four numbers"),
        (["--crs", "EPSG:0"], "not a reference system"),
        (["--hillshade", "--altitude", "100"], "altitude (degrees) must be from 0 to 90"),
    ],
)
def test_wrong_options_of_dem(folder, command, options, message):
    out = folder / "x.tif"
    code, _, err = command("dem", folder / "the points.csv", "-r", 5, "-o", out, *options)
    assert code == 2 and message in err and not out.exists()


def test_too_many_contours_are_refused_with_the_number(folder, command, figures):
    out = folder / "many.gpkg"
    few = ("contours", folder / "the points.csv", "--interval", 0.1)
    code, _, err = command(*few, "--max-points", 100, "-o", out)
    assert code == 4 and not out.exists()
    # Level 0 is only at the lower edge.
    assert "contours of 600 points, more than 100" in err and "raise --max-points" in err
    code, _, err = command(*few, "--max-points", 600, "--smooth", 2)
    assert code == 4 and "at most 2,400 points, more than 600" in err
    assert 590 < figures(*few, "--max-points", 600)["coordinates"] <= 600
    assert command(*few, "--max-points", 2400, "--smooth", 2)[0] == 0
    code, _, err = command(*few, "--bands", "--max-points", 100)
    assert code == 4 and "600 points" in err


def test_reports_name_the_size_of_files(folder, command):
    out = folder / "c.geojson"
    code, text, err = command("contours", folder / "the points.csv", "--interval", 5, "-o", out)
    assert (code, err) == (0, "")
    assert f"output bytes  {out.stat().st_size:,}" in " ".join(text.split("\n")).replace(
        "   ", "  "
    )
    _, text, _ = command("contours", folder / "the points.csv", "--interval", 5)
    assert "output bytes" not in text


@pytest.mark.parametrize("name", ["contours", "profile", "volume", "dem", "info", "crossval"])
def test_all_commands_that_read_points_take_a_reference_system(folder, command, name):
    more = {
        "contours": ["--interval", "5"],
        "profile": [folder / "the line.gpkg"],
        "volume": ["3"],
        "dem": ["-r", "5", "-o", folder / "o.tif"],
        "crossval": ["--method", "nearest"],
    }.get(name, [])
    code, out, err = command(name, folder / "the points.csv", *more)
    assert code == 0 and out.startswith(str(folder / "the points.csv")), err
    code, out, _ = command(name, folder / "the points.csv", *more, "--crs", "EPSG:28992", "--json")
    assert code == 0 and json.loads(out)
    code, _, err = command(name, folder / "the points.csv", *more, "--crs", "EPSG:nowhere")
    assert code == 2 and "not a reference system known to pyproj" in err


def test_info_reports_the_given_reference_system(folder, figures):
    found = figures("info", folder / "the points.csv", "--crs", "EPSG:28992")
    assert found["crs"] == "EPSG:28992"


def test_voids_inside_are_open(command, figures, tmp_path):
    x, y = (each.ravel() for each in np.meshgrid(np.arange(9.0), np.arange(8.0)))
    lake = (np.abs(x - 4) < 2) & (np.abs(y - 3.5) < 1)
    points = np.column_stack((x, y, np.ones(len(x))))[~lake]
    np.savetxt(tmp_path / "p.csv", points, delimiter=",", header="x,y,z", comments="")
    call = ("volume", tmp_path / "p.csv", "0", "--max-edge", "1.5")
    assert figures(*call)["cut"] == 56
    assert figures(*call, "--voids")["cut"] == 56 - 12 + 4 * 0.5
    code, _, err = command("volume", tmp_path / "p.csv", "0", "--voids")
    assert code == 2 and "--voids needs --max-edge" in err


def test_lakes_are_level_and_near_points_are_merged(command, figures, tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(31.0), np.arange(31.0)))
    points = np.vstack((np.column_stack((x, y, x)), [(2.001, 2, 2), (25.0, 25.002, 25)]))
    survey, lakes = tmp_path / "survey.csv", tmp_path / "lakes.gpkg"
    np.savetxt(survey, points, delimiter=",", header="x,y,z", comments="")
    geopandas.GeoDataFrame(geometry=[shapely.box(10, 10, 20, 20)]).to_file(lakes)
    found = figures("volume", survey, 0, "--level", lakes, "--snap", 0.01)
    assert found["points_moved"] == 2
    assert found["largest_move"] == pytest.approx(0.002)
    assert (found["level_polygons"], found["points_left_out_in_level_polygons"]) == (1, 121)
    # The plane z = x but for the lake, which is at 10 instead of 15 in the mean, and its shore.
    assert found["cut"] == pytest.approx(900 * 15 - 100 * 5 - 10 * 10 / 2 * 1, rel=0.01)
    dem = tmp_path / "dem.tif"
    assert figures("dem", survey, "-r", 1, "--level", lakes, "--snap", 0.01, "-o", dem)["points"]
    code, _, err = command("volume", survey, 0, "--snap", -1)
    assert code == 2
    assert "snap" in err
    code, _, err = command("volume", survey, 0, "--level", tmp_path / "none.gpkg")
    assert code == 3


def test_contours_with_fewer_points(survey, figures, command, tmp_path):
    out = tmp_path / "lines.gpkg"
    full = figures("contours", survey, "--interval", 100, "-o", out)
    few = figures("contours", survey, "--interval", 100, "--simplify", 2, "-o", out)
    assert few["lines"] == full["lines"] == len(geopandas.read_file(out))
    assert few["coordinates"] + few["points_of_lines_left_out"] == full["coordinates"]
    assert few["points_of_lines_left_out"] > 1000
    areas = figures("contours", survey, "--interval", 100, "--simplify", 2, "--bands", "-o", out)
    assert areas["points_of_lines_left_out"] == few["points_of_lines_left_out"]
    assert areas["polygons"] == len(geopandas.read_file(out)) > areas["flat_polygons_left_out"]


def test_an_error_of_labels_leaves_no_lines(folder, command, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    points, lines, labels = folder / "the points.csv", folder / "a.gpkg", folder / "b.gpkg"
    monkeypatch.setattr("delone.cli.terrain.write_table", full)
    options = ("--interval", 5, "-o", lines, "--labels", labels)
    code, _, err = command("contours", points, *options)
    assert (code, f"{labels}: No space" in err) == (5, True), err
    assert not lines.exists() and not labels.exists()
