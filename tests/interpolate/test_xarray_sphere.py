"""Geographic coordinates of xarray: on the sphere, lazily for Dask arrays, in both conventions."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from delone import GeographicWarning, sphere
from delone.errors import InputError
from delone.sphere import LongitudeWarning

xarray = pytest.importorskip("xarray")
import delone.xarray  # noqa: E402, F401  (it registers the accessors)

CLASSES: dict[str, tuple[Any, dict[str, Any]]] = {
    "linear": (sphere.Linear, {}),
    "nearest": (sphere.Nearest, {}),
    "sibson": (sphere.NaturalNeighbor, {"kind": "sibson"}),
    "laplace": (sphere.NaturalNeighbor, {"kind": "laplace"}),
}
LON, LAT = np.arange(-180.0, 181, 20), np.arange(-90.0, 91, 15)


def stations(names: tuple[str, str] = ("lon", "lat"), **options: Any) -> Any:
    random = np.random.default_rng(0)
    places = sphere.Delaunay(xyz=random.normal(size=(200, 3))).lonlat
    turn = np.where(places[:, 0] < 0, 360.0, 0.0) if options.get("east") else 0.0
    degrees, units = (np.degrees(1.0), "radians") if options.get("radians") else (1.0, None)
    attrs = {} if units is None else {"units": units}
    coords = {
        names[0]: ("station", (places[:, 0] + turn) / degrees, attrs),
        names[1]: ("station", places[:, 1] / degrees, attrs),
    }
    values = random.normal(size=(6, 200))
    return xarray.DataArray(values, dims=("time", "station"), coords=coords)


def expected(array: Any, method: str, lon: Any, lat: Any, **options: Any) -> Any:
    kind, fixed = CLASSES[method]
    sites = np.column_stack([array[name].values for name in ("lon", "lat")])
    queries = np.stack(np.meshgrid(lon, lat), axis=-1)
    return np.moveaxis(kind(sites, array.values.T, **fixed, **options)(queries), -1, 0)


@pytest.mark.parametrize("method", CLASSES)
def test_the_values_are_those_of_the_sphere(method: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = stations().delone.interp(LON, LAT, method=method)
    assert found.dims == ("time", "lat", "lon") and np.isfinite(found.values).all()
    np.testing.assert_allclose(found.values, expected(stations(), method, LON, LAT), rtol=1e-12)
    # A pole and the two names of the date line are one place each.
    assert (found.sel(lat=[-90.0, 90.0]).values == found.values[:, [0, -1], :1]).all()
    assert (found.sel(lon=-180.0).values == found.sel(lon=180.0).values).all()


@pytest.mark.parametrize("method", CLASSES)
def test_dask_arrays_stay_lazy(method: str) -> None:
    array = pytest.importorskip("dask.array")
    touched: list[Any] = []

    def met(block: Any) -> Any:
        touched.append(block.shape)
        return block

    plain = stations()
    lazy = array.from_array(plain.values, chunks=(2, 50)).map_blocks(met, meta=np.empty((0, 0)))
    touched.clear()
    found = plain.copy(data=lazy).delone.interp(LON, LAT, method=method)
    assert not touched and found.chunks is not None
    assert found.chunks[1:] == ((len(LAT),), (len(LON),))
    first = found.isel(time=0).compute(scheduler="synchronous")
    # The chunks of other times are left alone: one time in four chunks of stations.
    assert len(touched) == 4
    whole = plain.delone.interp(LON, LAT, method=method)
    np.testing.assert_array_equal(first.values, whole.values[0])
    np.testing.assert_array_equal(found.compute().values, whole.values)


def test_targets_may_be_dask_arrays() -> None:
    array = pytest.importorskip("dask.array")
    random = np.random.default_rng(3)
    lon, lat = random.uniform(-180, 180, 400), random.uniform(-90, 90, 400)
    plain = [xarray.DataArray(part, dims="ship") for part in (lon, lat)]
    lazy = [part.copy(data=array.from_array(part.values, chunks=100)) for part in plain]
    data = stations()
    want = data.delone.interp(*plain)
    np.testing.assert_array_equal(data.delone.interp(*lazy).values, want.values)
    chunked = data.chunk({"time": 3}).delone.interp(*lazy)
    assert chunked.chunks == ((3, 3), (400,))
    np.testing.assert_array_equal(chunked.compute().values, want.values)


def test_conventions_of_longitudes() -> None:
    east, plain = stations(east=True), stations()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = east.delone.interp(LON, LAT)
    np.testing.assert_allclose(found.values, plain.delone.interp(LON, LAT).values, atol=1e-9)
    assert found.lon.values.tolist() == LON.tolist()
    # Only longitudes of one set that span more than a turn are mixed.
    mixed = xarray.concat([east, plain], "station")
    with pytest.warns(LongitudeWarning, match="modulo 360") as caught:
        mixed.delone.interp(LON, LAT, duplicates="first", method="nearest")
    assert [each.filename for each in caught] == [__file__]


def test_what_names_angles_and_their_unit() -> None:
    want = stations().delone.interp(LON, LAT).values
    radians = stations(radians=True)
    found = radians.delone.interp(np.radians(LON), np.radians(LAT), degrees=False)
    np.testing.assert_allclose(found.values, want, atol=1e-9)
    assert found.lat.attrs == {"units": "radians"}
    found = radians.delone.interp(LON, LAT, degrees=True)
    np.testing.assert_allclose(found.values, want, atol=1e-9)
    assert found.lat.attrs == {"units": "degrees_north"}
    with pytest.raises(InputError, match="are in radians: give degrees=True or degrees=False"):
        radians.delone.interp(LON, LAT)
    named = stations(("a", "b"))
    for name, standard in (("a", "longitude"), ("b", "latitude")):
        named[name].attrs["standard_name"] = standard
    assert (named.delone.interp(LON, LAT).values == want).all()
    # Without a word about degrees, the plane.
    flat = stations(("x", "y")).delone.interp(LON, LAT)
    assert np.isnan(flat.values).any()


def test_policies() -> None:
    data = stations()
    near = data.delone.interp(LON, LAT, max_distance=5.0).values
    kind = sphere.Linear(np.column_stack((data.lon, data.lat)))
    far = kind.distance(np.stack(np.meshgrid(LON, LAT), axis=-1)) > 5
    assert far.any() and not far.all()
    assert (np.isnan(near) == far).all()
    gap = data.copy(data=np.where(np.arange(200) == 5, np.nan, data.values))
    some = gap.delone.interp(LON, LAT).values
    assert 0 < np.isnan(some[0]).sum() < some[0].size
    with pytest.raises(InputError, match="triangulation per field"):
        gap.delone.interp(LON, LAT, nan="drop")
    with pytest.raises(InputError, match="respect_constraints is not an option"):
        data.delone.interp(LON, LAT, respect_constraints=True)
    cap = data.isel(station=np.flatnonzero(data.lat.values > 30))
    assert np.isnan(cap.delone.interp([0.0], [-80.0]).values).all()
    assert np.isfinite(cap.delone.interp([0.0], [-80.0], extrapolate="nearest").values).all()


def test_planar_methods_name_the_sphere() -> None:
    with pytest.warns(GeographicWarning, match=r"delone\.sphere"):
        stations().delone.interp([0.0], [0.0], method="clough-tocher", gradients="local")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        flat = stations().delone.interp(LON, LAT, planar=True)
    assert np.isnan(flat.values).any()
