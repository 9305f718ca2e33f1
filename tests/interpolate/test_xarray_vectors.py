"""Components of vectors in xarray objects: which pairs are vectors, and their values."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from delone import sphere
from delone.errors import InputError, NonFiniteError

xarray = pytest.importorskip("xarray")
from delone.xarray import VectorWarning  # noqa: E402  (it registers the accessors)

LON, LAT = np.arange(-180.0, 181, 30), np.array([-90.0, -89, 0, 60, 90])
STANDARD = ("eastward_wind", "northward_wind")
CLASSES: dict[str, Any] = {
    "linear": sphere.Linear,
    "nearest": sphere.Nearest,
    "sibson": sphere.NaturalNeighbor,
    "laplace": lambda *args: sphere.NaturalNeighbor(*args, kind="laplace"),
}


def winds(count: int = 400, standard: Any = STANDARD, **attrs: Any) -> Any:
    """A dataset with two components, a number, and a variable that has no points."""
    random = np.random.default_rng(0)
    places = sphere.Delaunay(xyz=random.normal(size=(count, 3))).lonlat
    values = random.normal(size=(2, 3, count))
    wind = {
        name: (("time", "station"), part, {"units": "m s-1", **attrs})
        for name, part in zip("uv", values, strict=True)
    }
    found = xarray.Dataset(
        {**wind, "t": ("station", random.normal(size=count)), "year": ("time", [1, 2, 3])},
        coords={"lon": ("station", places[:, 0]), "lat": ("station", places[:, 1])},
    )
    for name, text in zip("uv", standard or (), strict=bool(standard)):
        found[name].attrs["standard_name"] = text
    return found


def expected(data: Any, method: str = "linear", pair: tuple[str, str] = ("u", "v")) -> Any:
    """Components at the nodes, (2, time, lat, lon)."""
    sites = np.column_stack((data.lon, data.lat))
    values = np.stack([data[name].values.T for name in pair], axis=1)
    nodes = np.stack(np.meshgrid(LON, LAT), axis=-1)
    return CLASSES[method](sites, values).vectors_at(nodes).transpose(2, 3, 0, 1)


@pytest.mark.parametrize("method", CLASSES)
def test_standard_names_make_pairs(method: str) -> None:
    data = winds()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = data.delone.interp(LON, LAT, method=method)
    np.testing.assert_allclose(
        np.stack((found.u, found.v)), expected(data, method), rtol=0, atol=1e-14
    )
    # Each node of a pole has the components of its meridian: one vector, of one length.
    poles = found.sel(lat=[90.0, -90.0])
    assert np.ptp(poles.u.values, axis=-1).min() > 0.1
    np.testing.assert_allclose(np.ptp(np.hypot(poles.u, poles.v).values, axis=-1), 0, atol=1e-14)
    # All else is as it was: the order of the variables, attributes, what has no points, numbers.
    assert set(found) == {"u", "v", "t", "year"}
    assert found.u.attrs == data.u.attrs and found.v.attrs == data.v.attrs
    assert found.u.dims == found.v.dims == ("time", "lat", "lon")
    np.testing.assert_array_equal(
        found.t.values, data.t.delone.interp(LON, LAT, method=method).values
    )
    # Off, they are two numbers.
    plain = data.delone.interp(LON, LAT, method=method, vectors=[])
    with pytest.warns(VectorWarning):
        alone = data.u.delone.interp(LON, LAT, method=method)
    np.testing.assert_array_equal(plain.u.values, alone.values)
    assert np.abs(plain.u - found.u).max() > 0.5


def test_pairs_that_the_caller_names() -> None:
    plain = winds(standard=None)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert (plain.delone.interp(LON, LAT).u.values != expected(plain)[0]).any()
        found = plain.delone.interp(LON, LAT, vectors=[("u", "v")])
    np.testing.assert_allclose(np.stack((found.u, found.v)), expected(plain), rtol=0, atol=1e-14)
    # Exactly these pairs.
    more = winds().assign(a=plain.u + 1, b=plain.v + 1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = more.delone.interp(LON, LAT, vectors=[["a", "b"]])
    want = expected(more, pair=("a", "b"))
    np.testing.assert_allclose(np.stack((found.a, found.b)), want, rtol=0, atol=1e-14)
    assert (found.u.values == more.delone.interp(LON, LAT, vectors=[]).u.values).all()


@pytest.mark.parametrize(
    ("standard", "attrs"),
    [
        (("eastward_wind", "northward_wind"), {"cell_methods": "time: mean (interval: 1 hr)"}),
        (("surface_downward_eastward_stress", "surface_downward_northward_stress"), {}),
        (("tendency_of_eastward_wind", "tendency_of_northward_wind"), {}),
        (("Eastward_Sea_Water_Velocity", "northward_sea_water_velocity"), {}),
    ],
)
def test_names_of_vectors(standard: Any, attrs: Any) -> None:
    found = winds(standard=standard, **attrs).delone.interp(LON, LAT)
    np.testing.assert_allclose(found.v, expected(winds())[1], rtol=0, atol=1e-14)


@pytest.mark.parametrize(
    ("standard", "attrs"),
    [
        (("x_wind", "y_wind"), {}),
        (("grid_eastward_wind", "grid_northward_wind"), {}),
        (("eastward_wind standard_error", "northward_wind standard_error"), {}),
        (("square_of_eastward_wind", "square_of_northward_wind"), {}),
        (("eastward_wind", "northward_wind"), {"cell_methods": "time: variance"}),
        (("eastward_wind", "northward_wind"), {"cell_methods": "area: mean time: maximum"}),
        (("product_of_eastward_wind_and_northward_wind", "air_temperature"), {}),
        (("wind_speed", "wind_from_direction"), {}),
    ],
)
def test_names_of_numbers(standard: Any, attrs: Any) -> None:
    data = winds(standard=standard, **attrs)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = data.delone.interp(LON, LAT)
        assert (data.u.delone.interp(LON, LAT).values == found.u.values).all()
    assert (found.u.values == data.delone.interp(LON, LAT, vectors=[]).u.values).all()


def test_components_alone_are_warned_of() -> None:
    data = winds()
    with pytest.warns(VectorWarning, match="u: components .* a Dataset of both") as caught:
        data.u.delone.interp(LON, LAT)
    assert [each.filename for each in caught] == [__file__]
    with pytest.warns(
        VectorWarning, match=r"v: components .*vectors=\[\(east, north\)\]"
    ) as caught:
        data.drop_vars("u").delone.grid(shape=(3, 4))
    assert [each.filename for each in caught] == [__file__]
    other = winds(standard=("eastward_wind", "northward_sea_water_velocity"))
    with pytest.warns(VectorWarning, match="u, v: components"):
        other.delone.interp(LON, LAT)
    # With other dimensions or cells they are not one vector.
    last = data.assign(v=data.v.isel(time=0))
    with pytest.warns(VectorWarning, match="u, v: components"):
        last.delone.interp(LON, LAT)
    # In the plane they are numbers.
    flat = data.rename(lon="x", lat="y")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        data.drop_vars("u").delone.interp(LON, LAT, vectors=[])
        flat.delone.interp(LON, LAT)
        flat.u.delone.interp(LON, LAT, planar=True)


def test_several_vectors_of_one_name() -> None:
    low, high = winds(), winds()
    pairs = {"u10": low.u, "v10": low.v, "u100": high.u + 1, "v100": high.v - 2}
    data = xarray.Dataset(dict(reversed(pairs.items())))
    for name in pairs:
        data[name].attrs = (low.u if name[0] == "u" else low.v).attrs
    found = data.delone.interp(LON, LAT)
    for pair in (("u10", "v10"), ("u100", "v100")):
        np.testing.assert_allclose(
            np.stack([found[name] for name in pair]), expected(data, pair=pair), rtol=0, atol=1e-14
        )
    again = {"u10": "wind_east_10", "v10": "wind_north_10", "u100": "EASTB", "v100": "NORTHB"}
    named = data.rename(again).delone.interp(LON, LAT)
    assert (named.wind_north_10.values == found.v10.values).all()
    assert (named.EASTB.values == found.u100.values).all()
    unclear = data.rename(v10="a", v100="b")
    with pytest.raises(InputError, match=r"several variables .*vectors=\[\('u.*', '.'\), ...\]"):
        unclear.delone.interp(LON, LAT)
    found = unclear.delone.interp(LON, LAT, vectors=[("u10", "a"), ("u100", "b")])
    np.testing.assert_allclose(found.a, expected(unclear, pair=("u10", "a"))[1], atol=1e-14)
    with pytest.raises(InputError, match="several variables"):
        data.drop_vars("v10").delone.interp(LON, LAT)


def test_dask_stays_lazy_and_gives_the_same() -> None:
    pytest.importorskip("dask.array")
    data = winds()
    data["v"] = data.v.transpose("station", "time")
    want = data.delone.interp(LON, LAT)
    assert want.v.dims == ("time", "lat", "lon") and want.u.dims == ("time", "lat", "lon")
    lazy = data.chunk({"time": 2, "station": 100}).delone.interp(LON, LAT)
    assert lazy.u.chunks == lazy.v.chunks
    assert len(lazy.u.chunks[0]) > 1 and lazy.u.chunks[1:] == ((len(LAT),), (len(LON),))
    for name in "uv":
        np.testing.assert_array_equal(lazy[name].compute(scheduler="processes"), want[name])


def test_kinds_missing_values_and_limits() -> None:
    data = winds()
    mixed = data.assign(u=data.u.astype(np.float32), v=data.v.round().astype(np.int32))
    found = mixed.delone.interp(LON, LAT)
    assert found.u.dtype == np.float32 and found.v.dtype == np.float64
    waves = data.assign(u=data.u + 2j * data.v)
    found = waves.delone.interp(LON, LAT, vectors=[("u", "v")])
    assert found.u.dtype == found.v.dtype == np.complex128
    np.testing.assert_allclose(found.u.real, expected(data)[0], rtol=0, atol=1e-14)
    gap = data.copy(deep=True)
    gap.u[0, 5] = np.nan
    found = gap.delone.interp(LON, LAT, max_distance=10)
    far = data.delone.interp(LON, LAT, max_distance=10).u.isnull()
    assert far.any() and not far.all()
    assert (found.u.isnull() == found.v.isnull()).all()
    lost = gap.delone.interp(data.lon[[5]], data.lat[[5]])
    assert lost.u.isnull().values.ravel().tolist() == [True, False, False]
    assert lost.v.isnull().values.ravel().tolist() == [True, False, False]
    with pytest.raises(NonFiniteError, match="1 of 400 rows"):
        gap.delone.interp(LON, LAT, nan="raise")
    places = data.copy(deep=True)
    places.lon[7] = np.nan
    dropped = places.delone.interp(LON, LAT, missing="drop")
    rest = data.isel(station=np.delete(np.arange(400), 7)).delone.interp(LON, LAT)
    np.testing.assert_allclose(dropped.u, rest.u, rtol=0, atol=1e-14)


def test_curvilinear_grids_rasters_and_radians() -> None:
    lon, lat = np.meshgrid(np.arange(-180, 180, 12.0), np.arange(-84, 85, 12.0))
    axis = np.array([6.0, 3.0, 2.0]) / 7

    def rotation(lon: Any, lat: Any) -> Any:
        """Components of a solid rotation."""
        lon, lat = np.radians(lon), np.radians(lat)
        up = axis[0] * np.cos(lon) + axis[1] * np.sin(lon)
        return (
            axis[2] * np.cos(lat) - np.sin(lat) * up,
            axis[0] * np.sin(lon) - axis[1] * np.cos(lon),
        )

    u, v = rotation(lon, lat)
    data = xarray.Dataset(
        {"u": (("j", "i"), u), "v": (("j", "i"), v)},
        coords={
            name: (("j", "i"), np.radians(part), {"units": "radian", "standard_name": word})
            for name, part, word in (("lon", lon, "longitude"), ("lat", lat, "latitude"))
        },
    )
    found = data.delone.grid(resolution=5.0, degrees=True, vectors=[("u", "v")])
    assert found.u.dims == ("lat", "lon") and found.sizes["lon"] == 72
    want = rotation(*np.meshgrid(found.lon, found.lat))
    for name, part in zip("uv", want, strict=True):
        assert np.abs(found[name] - part).max() < 0.03
    at = data.delone.interp([0.3, 2.0], [np.pi / 2], degrees=False, vectors=[("u", "v")])
    np.testing.assert_allclose(at.u.values[0], rotation(np.degrees([0.3, 2.0]), 90.0)[0], atol=0.03)


@pytest.mark.parametrize(
    ("vectors", "message"),
    [
        (["uv"], "must be pairs of names"),
        ([("u",)], "must be pairs of names"),
        ([("u", "w")], "'w' is not one of the interpolated variables"),
        ([("u", "year")], "'year' is not one of the interpolated variables"),
        ([("u", "u")], "'u' is in more than one place"),
        ([("u", "v"), ("v", "t")], "'v' is in more than one place"),
        ([("u", "t")], "different dimensions"),
        ([("v", "u")], "'v' is northward_wind: pairs are"),
    ],
)
def test_mistakes_in_pairs(vectors: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        winds().delone.interp(LON, LAT, vectors=vectors)


def test_other_mistakes() -> None:
    with pytest.raises(InputError, match="x_wind, along an axis of a grid"):
        winds(standard=("x_wind", "y_wind")).delone.interp(LON, LAT, vectors=[("u", "v")])
    data = winds()
    data.v.attrs["units"] = "km h-1"
    for vectors in (None, [("u", "v")]):
        with pytest.raises(InputError, match="units 'm s-1' and 'km h-1': convert"):
            data.delone.interp(LON, LAT, vectors=vectors)
    flat = winds().rename(lon="x", lat="y")
    with pytest.raises(InputError, match="vectors= is for the sphere"):
        flat.delone.interp(LON, LAT, vectors=[("u", "v")])
