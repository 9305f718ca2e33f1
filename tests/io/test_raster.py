"""Rasters in files, read back by the libraries of the formats."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from delone.errors import FileFormatError, InputError
from delone.interpolate import Grid, grid
from delone.io import raster_suffixes, read_points, write_raster

POINTS = [(10, 50), (14, 50), (14, 52), (10, 52), (12, 53)]


@pytest.fixture
def raster() -> Grid:
    return grid(POINTS, [0.0, 4.0, 6.0, 2.0, 9.0], resolution=(0.5, 0.25))


def test_geotiff(tmp_path: Path, raster: Grid) -> None:
    rasterio = pytest.importorskip("rasterio")
    write_raster(tmp_path / "a.tif", raster, name="depth", crs="EPSG:4326")
    with rasterio.open(tmp_path / "a.tif") as file:
        assert file.shape == (12, 8) and tuple(file.bounds) == (10, 50, 14, 53)
        assert file.crs.to_epsg() == 4326 and file.descriptions == ("depth",)
        assert np.isnan(file.nodata)
        np.testing.assert_array_equal(file.read(1), raster.values[::-1])
        # The value in the file is that of the place.
        assert file.read(1)[file.index(raster.x[3], raster.y[5])] == raster.values[5, 3]


def test_netcdf(tmp_path: Path, raster: Grid) -> None:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    write_raster(tmp_path / "a.nc", raster, name="depth", crs="EPSG:4326")
    with xarray.open_dataset(tmp_path / "a.nc") as file:
        assert file.depth.dims == ("y", "x")
        np.testing.assert_array_equal(file.depth.values, raster.values)
        np.testing.assert_array_equal(file.x.values, raster.x)


def test_csv_has_the_nodes_with_values(tmp_path: Path, raster: Grid) -> None:
    write_raster(tmp_path / "a.csv", raster, name="depth")
    survey = read_points(tmp_path / "a.csv")
    row, column = np.nonzero(np.isfinite(raster.values))
    assert 0 < len(row) < raster.values.size
    np.testing.assert_array_equal(survey.points, np.column_stack((raster.x[column], raster.y[row])))
    np.testing.assert_array_equal(survey.z, raster.values[row, column])


@pytest.mark.parametrize("suffix", [".png", ".svg"])
def test_pictures(tmp_path: Path, raster: Grid, suffix: str) -> None:
    pytest.importorskip("matplotlib")
    file = tmp_path / f"a{suffix}"
    write_raster(file, raster, crs="EPSG:4326")
    assert file.read_bytes()[:5] in (b"\x89PNG\r", b"<?xml")


def test_what_a_format_cannot_hold_is_refused(tmp_path: Path, raster: Grid) -> None:
    assert {".tif", ".nc", ".csv", ".png"} <= set(raster_suffixes())
    with pytest.raises(FileFormatError, match=r"known are \.tif"):
        write_raster(tmp_path / "a.asc", raster)
    uneven = Grid(raster.values, np.cumsum(raster.x), raster.y)
    row = Grid(raster.values[:1], raster.x, raster.y[:1])
    for bad in (uneven, row):
        pytest.importorskip("rasterio")
        with pytest.raises(FileFormatError, match="GeoTIFF"):
            write_raster(tmp_path / "a.tif", bad)
    values: Any
    for values in (raster.values * 1j, raster.values[..., None] * [1, 2]):
        with pytest.raises(FileFormatError, match="value"):
            write_raster(tmp_path / "a.csv", Grid(values, raster.x, raster.y))
    with pytest.raises(FileFormatError):
        write_raster(tmp_path / "b.csv", Grid(raster.values[1:], raster.x, raster.y))
    assert list(tmp_path.iterdir()) == []


def test_arrays_are_no_rasters(tmp_path: Path, raster: Grid) -> None:
    given: Any
    for given in (raster.values, raster.values.tolist(), None):
        with pytest.raises(InputError, match=r"is not a raster.*Grid\(values, x, y\)"):
            write_raster(tmp_path / "a.csv", given)
    assert list(tmp_path.iterdir()) == []
