"""What files of models and grids hold: bounds, units, several pairs of coordinates, masks."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from delone import sphere
from delone.errors import InputError, NonFiniteError

xarray = pytest.importorskip("xarray")
import delone.xarray  # noqa: E402  (it registers the accessors)

EAST = {"units": "degrees_east", "standard_name": "longitude", "long_name": "longitude"}
NORTH = {"units": "degrees_north", "standard_name": "latitude"}


def cmip() -> Any:
    """A dataset as CMIP has them: a regular grid with bounds of cells."""
    lon, lat = np.arange(15.0, 360, 30), np.arange(-75.0, 90, 30)
    tas = np.sin(np.radians(lat))[:, None] + np.cos(np.radians(lon))
    return xarray.Dataset(
        {
            "tas": (("lat", "lon"), tas.astype("f4"), {"units": "K"}),
            "lat_bnds": (("lat", "bnds"), np.stack([lat - 15, lat + 15], -1)),
            "lon_bnds": (("lon", "bnds"), np.stack([lon - 15, lon + 15], -1)),
            "edges": (("lat", "bnds"), np.stack([lat - 15, lat + 15], -1)),
        },
        coords={
            "lat": ("lat", lat, NORTH | {"bounds": "edges"}),
            "lon": ("lon", lon, EAST | {"bounds": "lon_bnds"}),
        },
    )


def icon(lonlat: Any, values: Any) -> Any:
    """An unstructured grid in radians."""
    lon, lat = np.radians(np.transpose(lonlat))
    attrs = [{"units": "radian", "standard_name": name} for name in ("longitude", "latitude")]
    coords = {"clon": ("cell", lon, attrs[0]), "clat": ("cell", lat, attrs[1])}
    return xarray.DataArray(values, dims="cell", coords=coords)


def directions(count: int) -> Any:
    vectors = np.random.default_rng(count).normal(size=(count, 3))
    return sphere.Delaunay(xyz=vectors).lonlat


def test_bounds_of_cells_go_with_the_coordinates() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = cmip().delone.interp(np.arange(0.5, 360), np.arange(-89.5, 90))
    assert list(found.data_vars) == ["tas"] and found.tas.shape == (180, 360)
    assert found.tas.dtype == np.float32 and found.tas.attrs == {"units": "K"}
    assert found.lon.attrs == EAST and found.lat.attrs == NORTH


def test_variables_with_some_of_the_dimensions_are_named() -> None:
    data = cmip().assign(zonal=("lat", np.zeros(6)), level=("z", [1.0]))
    with pytest.warns(delone.xarray.VariableWarning, match=r"zonal \(lat\): not in the") as caught:
        found = data.delone.interp([0.0], [0.0])
    assert [each.filename for each in caught] == [__file__]
    assert sorted(found.data_vars) == ["level", "tas"]
    stations = xarray.Dataset(
        {"t": ("s", np.zeros(3)), "climate": ("lat", np.zeros(9))},
        coords={"lon": ("s", [0.0, 9, 0]), "lat_": ("s", [0.0, 0, 9])},
    )
    with pytest.raises(InputError, match="'climate' and the targets have the dimension 'lat'"):
        stations.rename(lat_="latitude").delone.interp(
            xarray.DataArray([1.0], dims="lat"),
            xarray.DataArray([1.0], dims="lat"),
            coords=("lon", "latitude"),
        )


def test_units_of_targets_are_converted() -> None:
    lonlat = directions(2000)
    data = icon(lonlat, lonlat[:, 1])
    x = xarray.DataArray([1.0, 2.0, 3.0], dims="p", attrs={"units": "degrees_east"})
    y = xarray.DataArray([0.5, 1.0, 1.5], dims="p", attrs={"units": "degrees_north"})
    found = data.delone.interp(x, y)
    np.testing.assert_allclose(found.values, y.values, atol=0.02)
    assert found.clat.values.tolist() == y.values.tolist() and found.clat.attrs == y.attrs
    # A limit without a unit is asked for, too.
    with pytest.raises(InputError, match="numbers of max_distance have no units"):
        data.delone.interp(x, y, max_distance=20)
    assert np.isfinite(data.delone.interp(x, y, max_distance=20, degrees=True).values).all()
    near = data.delone.interp(x, y, max_distance=1e-3, degrees=True)
    assert np.isnan(near.values).all()
    other = xarray.DataArray([0.5, 1.0, 1.5], dims="p", attrs={"units": "km"})
    with pytest.raises(InputError, match="targets have units 'km'"):
        data.delone.interp(other, other)


def test_planar_units_are_converted_or_refused() -> None:
    coords = {
        "x": ("s", [0.0, 4000.0, 0.0], {"units": "m"}),
        "y": ("s", [0.0, 0.0, 4000.0], {"units": "m"}),
    }
    data = xarray.DataArray([1.0, 5.0, 9.0], dims="s", coords=coords)
    one = xarray.DataArray([1.0], dims="p", attrs={"units": "km"})
    assert data.delone.interp(one, one).values.tolist() == [4.0]
    for unit in ("degrees_north", "pixel"):
        with pytest.raises(InputError, match="has units 'm': convert one of them"):
            data.delone.interp(one, one.assign_attrs(units=unit))
    with pytest.raises(InputError, match="degrees is for longitudes and latitudes, and x and y"):
        data.delone.interp([1.0], [1.0], degrees=True)


def polar() -> Any:
    """A stereographic grid with longitudes and latitudes of its nodes; the field is latitude."""
    side = np.linspace(-2e6, 2e6, 21)
    xx, yy = np.meshgrid(side, side)
    lat = 90 - np.degrees(2 * np.arctan(np.hypot(xx, yy) / 2 / 6371e3))
    lon = np.degrees(np.arctan2(xx, -yy))
    coords = {
        "x": side,
        "y": side,
        "lon": (("y", "x"), lon, EAST),
        "lat": (("y", "x"), lat, NORTH),
    }
    return xarray.DataArray(lat, dims=("y", "x"), coords=coords)


def test_targets_decide_between_two_pairs_of_coordinates() -> None:
    lon = xarray.DataArray([0.0, 90.0], dims="lon", name="lon", attrs=EAST)
    lat = xarray.DataArray([75.0, 80.0, 85.0], dims="lat", name="lat", attrs=NORTH)
    found = polar().delone.interp(lon, lat)
    # Rows before columns, as for plain nodes.
    assert found.dims == ("lat", "lon") and found.lat.attrs == NORTH
    np.testing.assert_allclose(found.values, np.tile(lat.values[:, None], 2), atol=0.1)
    x = xarray.DataArray([0.0], dims="p", name="x")
    y = xarray.DataArray([1e6], dims="p", name="y")
    assert abs(polar().delone.interp(x, y).item() - 81) < 0.1
    with pytest.raises(InputError, match=r"x and y, and lon and lat: name two, such as coords="):
        polar().delone.interp([0.0], [75.0])
    with pytest.raises(InputError, match="name two"):
        polar().delone.grid(shape=(2, 2))
    assert polar().delone.interp([0.0], [80.0], coords=("lon", "lat")).shape == (1, 1)


def test_variables_of_a_dataset_may_be_coordinates() -> None:
    data = xarray.Dataset(
        {
            "depth": (("j", "i"), np.arange(4.0).reshape(2, 2)),
            "nav_lon": (("j", "i"), [[0.0, 9.0], [0.0, 9.0]], EAST),
            "nav_lat": (("j", "i"), [[0.0, 0.0], [9.0, 9.0]], NORTH),
        }
    )
    found = data.delone.interp([9.0], [9.0])
    assert list(found.data_vars) == ["depth"] and found.depth.item() == 3
    assert found.nav_lon.attrs == EAST
    two = data.assign(u_lon=data.nav_lon, u_lat=data.nav_lat)
    with pytest.raises(InputError, match="several longitudes or latitudes: nav_lon, u_lon"):
        two.delone.interp([9.0], [9.0])
    assert two.delone.interp([9.0], [9.0], coords=("u_lon", "u_lat")).depth.item() == 3


def test_places_without_coordinates_are_left_out_on_request() -> None:
    data = polar().drop_vars(["x", "y"]).rename(x="i", y="j")
    data["lon"] = data.lon.where(data.lat > 76)
    with pytest.raises(NonFiniteError, match=r"places have NaN .* missing='drop'") as caught:
        data.delone.interp([0.0], [80.0])
    assert caught.value.count == int((data.lat <= 76).sum())
    found = data.delone.interp([0.0, 90.0], [80.0, 85.0], missing="drop")
    np.testing.assert_allclose(found.values, [[80.0, 80.0], [85.0, 85.0]], atol=0.1)
    pytest.importorskip("dask")
    lazy = data.chunk({"j": 7}).delone.interp([0.0, 90.0], [80.0, 85.0], missing="drop")
    np.testing.assert_array_equal(lazy.compute().values, found.values)
    with pytest.raises(InputError, match="missing must be"):
        data.delone.interp([0.0], [80.0], missing="ignore")


@pytest.mark.parametrize("radians", [False, True])
def test_rasters_of_the_globe_are_aligned(radians: bool) -> None:
    lonlat = directions(60)
    data = icon(lonlat, lonlat[:, 1])
    if not radians:
        data = data.assign_coords(
            clon=("cell", lonlat[:, 0], EAST), clat=("cell", lonlat[:, 1], NORTH)
        )
    if radians:
        with pytest.raises(InputError, match="numbers of the raster have no units"):
            data.delone.grid(resolution=1)
    found = data.delone.grid(resolution=1, degrees=True)
    assert found.clon.values.tolist() == [k - 179.5 for k in range(360)]
    assert found.clat.values.tolist() == [k - 89.5 for k in range(180)]
    assert np.isfinite(found.values).all() and found.clat.attrs["units"] == "degrees_north"
    tenths = data.delone.grid(resolution=(30, 0.1), degrees=True)
    assert tenths.clat.values[-3:].tolist() == [89.75, 89.85, 89.95]
    assert data.delone.grid(shape=(4, 2)).clon.values.tolist() == [-135.0, -45.0, 45.0, 135.0]
    odd = data.delone.grid(resolution=7, degrees=True)
    assert (abs(odd.clat.values) <= 90).all() and odd.clon.values[-1] < 180


def test_rasters_cross_the_date_line_and_cover_a_pole() -> None:
    lon, lat = np.meshgrid(np.linspace(165.25, 194.75, 31), np.arange(11.0))
    coords = {"lon": (("j", "i"), (lon + 180) % 360 - 180), "lat": (("j", "i"), lat)}
    pacific = xarray.DataArray(lat, dims=("j", "i"), coords=coords)
    found = pacific.delone.grid(resolution=1)
    assert found.lon.values.tolist() == [k + 165.5 for k in range(30)]
    assert found.lat.values.tolist() == [k + 0.5 for k in range(10)]
    assert np.isfinite(found.values).all()
    part = pacific.delone.grid(resolution=5, bounds=(170, 0, -170, 10))
    assert part.lon.values.tolist() == [172.5, 177.5, 182.5, 187.5]
    cap = polar().drop_vars(["x", "y"]).delone.grid(resolution=2)
    assert cap.sizes["lon"] == 180 and cap.lat.values[-1] == 89.0
    assert np.isfinite(cap.sel(lat=89.0).values).all()
