"""Rasters: constants for no height that a file does not declare, and windows."""

import numpy as np
import pytest
import rasterio

from delone.errors import FileFormatError, InputError
from delone.interpolate import Grid
from delone.io import LeftOutWarning, read_raster
from delone.terrain import TIN


def tif(path, values, **profile):
    values = np.asarray(values)
    given = {
        "driver": "GTiff", "count": 1, "height": values.shape[0], "width": values.shape[1],
        "dtype": values.dtype, "crs": "EPSG:28992",
        "transform": rasterio.Affine(2, 0, 1000, 0, -2, 2000),
    }  # fmt: skip
    with rasterio.open(path, "w", **given | profile) as file:
        file.write(values, 1)
    return path


def ramp(dtype="float32"):
    return np.add.outer(np.arange(6), np.arange(8)).astype(dtype)


@pytest.mark.parametrize(
    ("constant", "dtype"),
    [
        (-9999, "float32"), (9999, "float64"), (-32768, "int16"), (-32767, "int32"),
        (3.4028234663852886e38, "float32"), (-3.4e38, "float32"), (-1.797e308, "float64"),
    ],
)  # fmt: skip
def test_undeclared_constants_are_refused(constant, dtype, tmp_path):
    values = ramp(dtype)
    values[2, 3] = values[0, 0] = constant
    path = tif(tmp_path / "a.tif", values)
    with pytest.raises(
        FileFormatError, match=r"2 cells of .*others are from 1 to 12: give nodata=-?\d[\d.e+]+ "
    ):
        read_raster(path)
    with pytest.raises(FileFormatError, match="nodata"):
        TIN.from_raster(path)
    with pytest.warns(LeftOutWarning, match="2 cells"):
        found = read_raster(path, nodata=constant)
    assert len(found) == 46
    assert found.z.max() == 12
    # All values are heights, if that is said.
    assert len(read_raster(path, nodata=float("nan"))) == 48


def test_constants_among_the_heights_are_heights(tmp_path):
    values = ramp() * 1000 - 9500
    values[0, 0] = -9999
    assert len(read_raster(tif(tmp_path / "a.tif", values))) == 48
    assert len(read_raster(tif(tmp_path / "b.tif", ramp() * 1000))) == 48


def test_flat_ground_and_nothing_else(tmp_path):
    flat = np.zeros((3, 3), np.float32)
    flat[1, 1] = -9999
    with pytest.raises(FileFormatError, match="1 cell of -9999"):
        read_raster(tif(tmp_path / "a.tif", flat))
    flat[:] = -9999
    with pytest.raises(FileFormatError, match="no other value"):
        read_raster(tif(tmp_path / "b.tif", flat))
    assert len(read_raster(tif(tmp_path / "c.tif", flat * 0))) == 9


def test_scaled_bands_are_compared_as_they_are_stored(tmp_path):
    values = ramp("int16")
    values[0, 0] = -32768
    path = tif(tmp_path / "a.tif", values)
    with rasterio.open(path, "r+") as file:
        file.scales, file.offsets = (0.01,), (5,)
    with pytest.raises(FileFormatError, match="-32768"):
        read_raster(path)
    with pytest.warns(LeftOutWarning):
        assert read_raster(path, nodata=-32768).z.min() == pytest.approx(5.01)


def test_arrays_are_checked_as_well():
    values = ramp("float64")
    values[0, 0] = -9999
    grid = Grid(values, np.arange(8.0), np.arange(6.0))
    with pytest.raises(InputError, match="1 cell of -9999"):
        TIN.from_raster(grid)
    assert TIN.from_raster(grid, nodata=-9999).npoints == 47
    assert TIN.from_raster(grid, nodata=np.nan).npoints == 48


@pytest.mark.parametrize("step", [1, 2, 3])
@pytest.mark.parametrize(
    "bounds",
    [
        (1003, 1991, 1009, 1997),
        (1002.5, 1990, 1012, 1996.5),
        (-1e9, -1e9, 1e9, 1e9),
        (1009, 1989, 1015, 1993),
    ],
)
def test_windows_are_the_cells_of_the_whole(bounds, step, tmp_path):
    path = tif(tmp_path / "a.tif", ramp() / 7)
    whole, part = read_raster(path, step=step), read_raster(path, step=step, bounds=bounds)
    x, y = whole.points.T
    left, bottom, right, top = bounds
    inside = (x >= left) & (x <= right) & (y >= bottom) & (y <= top)
    assert inside.any()
    assert np.array_equal(part.points, whole.points[inside])
    assert np.array_equal(part.z, whole.z[inside])


def test_windows_of_rotated_rasters(tmp_path):
    path = tif(tmp_path / "a.tif", ramp(), transform=rasterio.Affine(3, 4, 100, 4, -3, 200))
    whole, part = read_raster(path), read_raster(path, bounds=(105, 195, 115, 205))
    inside = ((whole.points >= (105, 195)) & (whole.points <= (115, 205))).all(axis=1)
    assert 0 < len(part) < 48
    assert np.array_equal(part.points, whole.points[inside])


def test_windows_that_fit_are_read_of_rasters_that_do_not(tmp_path):
    path = tif(tmp_path / "a.tif", ramp())
    with pytest.raises(FileFormatError, match=r"step=3 .*bounds"):
        read_raster(path, max_points=8)
    assert len(read_raster(path, max_points=8, bounds=(1002, 1996, 1006, 2000))) == 4
    assert TIN.from_raster(path, bounds=(1002, 1996, 1006, 2000)).npoints == 4
    grid = Grid(ramp(), np.arange(8.0), np.arange(6.0))
    assert TIN.from_raster(grid, bounds=(0, 0, 1, 1)).npoints == 4


@pytest.mark.parametrize(
    ("bounds", "message"),
    [
        ((0, 0, 1, 1), "no center"), ((1, 2, 3), "four numbers"), ((3, 0, 1, 1), "this order"),
        ((0, 0, np.inf, 1), "finite"), (5, "four numbers"), ("abcd", "bounds"),
    ],
)  # fmt: skip
def test_bounds_that_are_none(bounds, message, tmp_path):
    path = tif(tmp_path / "a.tif", ramp())
    with pytest.raises((InputError, TypeError), match=message):
        read_raster(path, bounds=bounds)
