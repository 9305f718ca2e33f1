"""Heights in NetCDF files and in xarray's arrays: axes, fill values, scales, reference systems."""

import numpy as np
import pyproj
import pytest
import xarray

from delone.errors import FileFormatError, InputError
from delone.interpolate import Grid
from delone.io import LeftOutWarning, read_points, read_raster, write_raster
from delone.terrain import TIN

X, Y = np.arange(4) * 2.0 + 100, np.arange(3) * 3.0 + 50
Z = np.arange(12.0).reshape(3, 4)


def array(**options):
    given = {"dims": ("y", "x"), "coords": {"y": Y, "x": X}, "name": "z"}
    return xarray.DataArray(Z.copy(), **given | options)


def written(path, data, **encoding):
    data = data if isinstance(data, xarray.Dataset) else data.to_dataset()
    data.to_netcdf(path, encoding=encoding)
    return path


def table(survey):
    return sorted(map(tuple, np.column_stack((survey.points, survey.z)).tolist()))


def expected():
    return sorted(map(tuple, np.column_stack((np.tile(X, 3), np.repeat(Y, 4), Z.ravel())).tolist()))


def test_what_is_written_is_read(tmp_path):
    path = tmp_path / "a.nc"
    write_raster(path, Grid(Z, X, Y), crs="EPSG:28992")
    survey = read_raster(path)
    assert table(survey) == expected()
    assert survey.crs == "EPSG:28992"
    assert table(read_points(path)) == expected()
    assert TIN.from_raster(path).crs == "EPSG:28992"
    with pytest.raises(FileFormatError, match="no variable 'height'"):
        read_raster(path, band="height")


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("falling", [False, True])
def test_order_of_axes_changes_nothing(turned, falling, tmp_path):
    data = array()
    data = data.isel(y=slice(None, None, -1)) if falling else data
    data = data.transpose("x", "y") if turned else data
    assert table(read_raster(written(tmp_path / "a.nc", data))) == expected()
    tin = TIN.from_raster(data)
    assert sorted(map(tuple, tin.xyz.tolist())) == expected()


def test_square_arrays_are_not_transposed():
    square = xarray.DataArray(np.arange(9.0).reshape(3, 3), {"x": [0, 1, 2], "y": [0, 1, 2]})
    assert TIN.from_raster(square).heights((2, 0)) == 6


def test_axes_have_names_or_attributes(tmp_path):
    for across, up in (("lon", "lat"), ("easting", "northing")):
        data = array().rename(x=across, y=up)
        assert table(read_raster(written(tmp_path / f"{across}.nc", data))) == expected()
    data = array().rename(x="a", y="b")
    with pytest.raises(FileFormatError, match="which of b and a is x"):
        read_raster(written(tmp_path / "a.nc", data))
    with pytest.raises(InputError, match="which of b and a is x"):
        TIN.from_raster(data)
    data.a.attrs["axis"], data.b.attrs["standard_name"] = "X", "projection_y_coordinate"
    assert TIN.from_raster(data).npoints == 12


def test_fill_values_and_scales(tmp_path):
    data = array()
    data[0, 0] = np.nan
    packed = {"dtype": "int16", "scale_factor": 0.5, "add_offset": 3.0, "_FillValue": -32768}
    path = written(tmp_path / "a.nc", data, z=packed)
    with pytest.warns(LeftOutWarning, match="1 cell"):
        survey = read_raster(path)
    assert table(survey) == expected()[1:]
    # As stored, without decoding.
    raw = xarray.open_dataset(path, mask_and_scale=False)["z"]
    assert sorted(map(tuple, TIN.from_raster(raw).xyz.tolist())) == expected()[1:]
    raw.attrs.pop("_FillValue")
    with pytest.raises(InputError, match="-32768"):
        TIN.from_raster(raw)
    assert TIN.from_raster(raw, nodata=-32768).npoints == 11


def test_windows_and_steps(tmp_path):
    path = written(tmp_path / "a.nc", array())
    inside = [each for each in expected() if 101 <= each[0] <= 104 and 50 <= each[1] <= 53]
    assert table(read_raster(path, bounds=(101, 50, 104, 53), max_points=4)) == inside
    assert TIN.from_raster(array(), bounds=(101, 50, 104, 53)).npoints == 4
    assert read_raster(path, step=2).z.tolist() == [0, 2, 8, 10]
    with pytest.raises(FileFormatError, match="at most 4"):
        read_raster(path, max_points=4)
    with pytest.raises(InputError, match="no node"):
        read_raster(path, bounds=(0, 0, 1, 1))


def test_files_with_several_variables_and_times(tmp_path):
    both = xarray.Dataset({"z": array(), "depth": -array(), "time": ("t", [1.0])})
    path = written(tmp_path / "a.nc", both)
    with pytest.raises(FileFormatError, match=r"choose a variable .* are z, depth"):
        read_raster(path)
    assert read_raster(path, band="depth").z.min() == -11
    assert read_points(path, layer="depth").z.min() == -11
    assert TIN.from_raster(path, band="z").npoints == 12
    many = xarray.concat([array(), array() + 1], "time").assign_coords(time=[0, 1])
    with pytest.raises(FileFormatError, match=r"2 of time: choose .*isel\(time=0\)"):
        read_raster(written(tmp_path / "b.nc", many))
    with pytest.raises(InputError, match="isel"):
        TIN.from_raster(many)
    assert TIN.from_raster(many.isel(time=[1])).z.min() == 1


def test_files_that_are_none(tmp_path):
    path = tmp_path / "a.nc"
    with pytest.raises(FileNotFoundError):
        read_raster(path)
    path.write_bytes(b"CDF\x01 and nothing else")
    with pytest.raises(FileFormatError, match="not a NetCDF file"):
        read_raster(path)
    curved = xarray.Dataset({"z": (("j", "i"), Z)}, coords={"lon": (("j", "i"), Z)})
    with pytest.raises(FileFormatError, match="on grids are none"):
        read_raster(written(tmp_path / "b.nc", curved))
    with pytest.raises(InputError, match="band must be the name"):
        read_raster(path, band=1)


def test_reference_systems(tmp_path):
    data = array()
    data.x.attrs["units"] = "degrees_east"
    assert read_raster(written(tmp_path / "a.nc", data)).crs == "EPSG:4326"
    crs = xarray.DataArray(0, attrs={"crs_wkt": pyproj.CRS(32633).to_wkt()})
    mapped = array().assign_coords(spatial_ref=crs)
    assert TIN.from_raster(mapped).crs == "EPSG:32633"
    with pytest.raises(InputError, match="transform them"):
        TIN.from_raster(mapped, crs="EPSG:28992")
