"""Reference systems on the command line, and what is said of degrees."""

import numpy as np
import pytest

from delone.io import GeometrySet
from delone.io.writing import output_suffixes

pytest.importorskip("pyproj")
geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")


@pytest.fixture
def plain(tmp_path):
    """Points without a reference system, in meters."""
    file = tmp_path / "plain.csv"
    points = np.random.default_rng(1).random((60, 3)) * [1000, 1000, 10] + [85000, 446000, 0]
    np.savetxt(file, points, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    return file


@pytest.fixture
def degrees(tmp_path):
    """Points on both sides of the antimeridian."""
    file = tmp_path / "degrees.csv"
    points = np.random.default_rng(2).random((60, 3)) * [4, 4, 10] + [178, -2, 0]
    points[:, 0] = (points[:, 0] + 180) % 360 - 180
    np.savetxt(file, points, delimiter=",", header="lon,lat,z", comments="", fmt="%.17g")
    return file


@pytest.fixture
def ring(tmp_path):
    file = tmp_path / "ring.gpkg"
    geopandas.GeoDataFrame(geometry=[shapely.box(0, 0, 4, 3)]).to_file(file, driver="GPKG")
    return file


def test_triangulate(tmp_path, plain, figures):
    target = tmp_path / "a.gpkg"
    assert figures("triangulate", plain, "-o", target)["crs"] is None
    assert geopandas.read_file(target).crs is None
    found = figures("triangulate", plain, "--crs", "EPSG:28992", "-o", target)
    assert found["crs"] == "EPSG:28992"
    assert geopandas.read_file(target).crs == "EPSG:28992"


def test_mesh_and_voronoi(tmp_path, plain, ring, figures):
    for command, source, target in (
        ("mesh", ring, tmp_path / "mesh.gpkg"),
        ("voronoi", plain, tmp_path / "cells.gpkg"),
    ):
        found = figures(command, source, "--crs", "EPSG:28992", "-o", target)
        assert found["crs"] == "EPSG:28992"
        assert geopandas.read_file(target).crs == "EPSG:28992"


def test_interpolate(tmp_path, plain, figures):
    rasterio = pytest.importorskip("rasterio")
    target = tmp_path / "a.tif"
    options = ("--grid", "10x10", "--units", "m", "-o", target)
    figures("interpolate", plain, "--crs", "EPSG:28992", *options)
    with rasterio.open(target) as file:
        assert file.crs.to_epsg() == 28992 and file.units == ("m",)


def test_tile_and_dem(tmp_path, plain, figures):
    rasterio = pytest.importorskip("rasterio")
    pytest.importorskip("pyarrow")
    folder = tmp_path / "tin"
    assert figures("tile", plain, "-o", folder, "--crs", "EPSG:28992")["crs"] == "EPSG:28992"
    figures("dem", folder, "-r", "100", "-o", tmp_path / "a.tif")
    figures("dem", folder, "-r", "100", "-o", tmp_path / "b.tif", "--crs", "EPSG:28991")
    for name, code in (("a.tif", 28992), ("b.tif", 28991)):
        with rasterio.open(tmp_path / name) as file:
            assert file.crs.to_epsg() == code


def test_a_system_that_nobody_knows(plain, command):
    for name in ("triangulate", "mesh", "voronoi", "interpolate"):
        more = ("--grid", "3x3") if name == "interpolate" else ()
        code, _, err = command(name, plain, "--crs", "EPSG:1", *more)
        assert (code, err.count("\n")) == (2, 1) and "--crs EPSG:1" in err


def test_what_the_file_says_otherwise_is_said(tmp_path, command):
    file = tmp_path / "a.gpkg"
    points = geopandas.points_from_xy([0, 900, 0], [0, 0, 900], crs="EPSG:28992")
    geopandas.GeoDataFrame(geometry=points).to_file(file, driver="GPKG")
    code, _, err = command("triangulate", file, "--crs", "EPSG:32631")
    assert (code, err.count("\n")) == (0, 1)
    assert "says EPSG:28992, but --crs EPSG:32631 is used" in err
    assert command("triangulate", file, "--crs", "EPSG:28992")[::2] == (0, "")


def test_files_without_a_place_for_a_system_are_named(tmp_path, plain, command):
    pytest.importorskip("meshio")
    options = ("--crs", "EPSG:28992", "-o", tmp_path / "a.vtu")
    code, _, err = command("triangulate", plain, *options)
    assert (code, err.count("\n")) == (0, 1)
    assert ".vtu files cannot store a reference system; EPSG:28992 is not in the file" in err
    assert command("triangulate", plain, "--quiet", *options)[::2] == (0, "")
    assert ".vtu" in output_suffixes()


@pytest.mark.parametrize(
    "words", [["triangulate"], ["voronoi"], ["crossval"], ["interpolate", "--grid", "4x4"]]
)
def test_degrees_are_said_unless_they_are_meant(words, degrees, plain, command):
    name, *options = words
    code, _, err = command(name, degrees, *options)
    assert (code, err.count("\n")) == (0, 1)
    assert err.startswith(f"delone: note: {degrees}: coordinates are longitudes and latitudes")
    assert "columns lon, lat" in err and "give --planar" in err
    assert command(name, degrees, *options, "--planar")[::2] == (0, "")
    assert command(name, plain, *options)[::2] == (0, "")


def test_geographic_systems_are_degrees(tmp_path, ring, plain, command):
    code, _, err = command("mesh", ring, "--crs", "EPSG:4326")
    assert code == 0 and "longitudes and latitudes (EPSG:4326)" in err
    assert command("mesh", ring, "--crs", "EPSG:4326", "--planar")[::2] == (0, "")
    assert command("mesh", ring, "--crs", "EPSG:28992")[::2] == (0, "")
    # GeoJSON without a system is taken for degrees, which these cannot be.
    far = GeometrySet(geometries=np.array([shapely.box(85000, 446000, 85100, 446100)]))
    file = tmp_path / "far.geojson"
    file.write_text(shapely.to_geojson(far.geometries[0]))
    assert command("mesh", file)[::2] == (0, "")


def test_tiles_of_degrees(tmp_path, degrees, command):
    pytest.importorskip("pyarrow")
    code, _, err = command("tile", degrees, "-o", tmp_path / "tin", "--crs", "EPSG:4326")
    assert code == 0 and "longitudes and latitudes (EPSG:4326)" in err
    again = command("tile", degrees, "-o", tmp_path / "b", "--crs", "EPSG:4326", "--planar")
    assert again[::2] == (0, "")


def test_degrees_beyond_a_pole_are_refused(tmp_path, command):
    file = tmp_path / "a.csv"
    file.write_text("x,y,z\n10,89,0\n11,90,1\n10,90.5,2\n12,-91,0\n")
    for more in ((), ("--planar",)):
        options = ("--interval", 1, "--crs", "EPSG:4326", *more)
        code, _, err = command("contours", file, *options)
        assert code == 4 and f"--crs EPSG:4326 is for degrees, longitudes first, and {file}" in err
        assert "(10, 90.5)" in err and err.count("\n") == 1
    assert command("contours", file, "--interval", 1, "--crs", "EPSG:28992")[0] == 0
