"""The accessors of xarray: attributes kept, dimensions replaced, Dask chunk by chunk."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import datasets
from delone.errors import InputError
from delone.interpolate import interpolator, raster

xarray = pytest.importorskip("xarray")
import delone.xarray  # noqa: E402, F401  (it registers the accessors)

# Coordinates are called as they are in files; what is said of degrees is tested elsewhere.
pytestmark = pytest.mark.filterwarnings("ignore::delone.GeographicWarning")

POINTS = datasets.uniform(150, seed=2)
TIME = np.arange(6.0)


def stations() -> Any:
    x, y = POINTS.T
    return xarray.Dataset(
        {
            "height": (("time", "station"), TIME[:, None] + 2 * x - y, {"units": "m"}),
            "name": ("time", list("abcdef")),
            "code": ("station", np.arange(150)),
        },
        coords={
            "easting": ("station", x),
            "northing": ("station", y),
            "time": TIME,
            "id": ("station", x),
        },
        attrs={"source": "survey"},
    )


def test_a_dataset_to_a_raster() -> None:
    found = stations().delone.grid(shape=(7, 5))
    assert found.height.dims == ("time", "northing", "easting") and found.height.shape == (6, 5, 7)
    assert found.attrs == {"source": "survey"} and found.height.attrs == {"units": "m"}
    assert found.code.dims == ("northing", "easting") and found.name.dims == ("time",)
    assert "id" not in found.coords and found.time.values.tolist() == TIME.tolist()
    plane = found.time + 2 * found.easting - found.northing
    gap = (found.height - plane).values
    assert np.isfinite(gap).any() and np.nanmax(np.abs(gap)) < 1e-12


@pytest.mark.parametrize("method", ["linear", "sibson", "clough-tocher"])
def test_points_and_dask(method: str) -> None:
    pytest.importorskip("dask")
    track = xarray.DataArray([0.4, 0.5, 0.6], dims="track", coords={"km": ("track", [1, 2, 3])})
    height = stations().height
    options = {"gradients": "local"} if method == "clough-tocher" else {}
    plain = height.delone.interp(track, track * 0 + 0.5, method=method, **options)
    assert plain.dims == ("time", "track") and plain.km.values.tolist() == [1, 2, 3]
    queries = np.column_stack((track.values, np.full(3, 0.5)))
    expected = interpolator(POINTS, height.values.T, method, **options)(queries).T
    np.testing.assert_allclose(plain.values, expected, rtol=1e-12)
    chunked = height.chunk({"time": 2}).delone.interp(
        track, track * 0 + 0.5, method=method, **options
    )
    assert chunked.chunks[0] == (2, 2, 2) and chunked.attrs == {"units": "m"}
    np.testing.assert_array_equal(chunked.compute().values, plain.values)


def test_dask_computes_no_more_than_is_asked_for() -> None:
    array = pytest.importorskip("dask.array")
    touched: list[Any] = []

    def met(block: Any) -> Any:
        touched.append(block.shape)
        return block

    data = array.ones((6, 150), chunks=(2, 50)).map_blocks(met, meta=np.empty((0, 0)))
    height = stations().height.copy(data=data)
    touched.clear()
    dataset = xarray.Dataset({"height": height, "double": 2 * height})
    found = dataset.delone.grid(shape=(8, 6))
    assert not touched and found.height.chunks[1:] == ((6,), (8,))
    first = found.height.isel(time=0).compute()
    assert 0 < len(touched) < 9
    np.testing.assert_allclose(first.values[np.isfinite(first.values)], 1, rtol=1e-12)
    whole = found.compute(scheduler="synchronous")
    np.testing.assert_allclose(whole.double.values, 2 * whole.height.values)


def test_huge_rasters_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(raster, "free_memory", lambda: raster._SPARE + (1 << 21))
    one = stations().height.isel(time=0)
    assert one.delone.grid(shape=(400, 400)).shape == (400, 400)
    with pytest.raises(MemoryError, match="400 x 400 cells needs"):
        stations().delone.grid(shape=(400, 400))


def test_regular_and_curvilinear_coordinates() -> None:
    y, x = np.meshgrid(np.arange(4.0), np.arange(5.0), indexing="ij")
    regular = xarray.DataArray(x + 10 * y, dims=("y", "x"), coords={"y": y[:, 0], "x": x[0]})
    assert regular.delone.interp([0.5, 1.5], [2.5]).values.tolist() == [[25.5, 26.5]]
    bent = xarray.DataArray(
        x + 10 * y, dims=("j", "i"), coords={"a": (("j", "i"), x + y / 8), "b": (("j", "i"), y)}
    )
    found = bent.delone.interp([1.0], [2.0], coords=("a", "b"))
    assert found.dims == ("b", "a") and found.values.tolist() == [[20.75]]


def test_nan_and_complex() -> None:
    array = stations().height.isel(time=0) * 1j
    assert np.iscomplexobj(array.delone.interp([0.5], [0.5]).values)
    gaps = stations().height.where(stations().height > 2)
    assert np.isnan(gaps.delone.interp([0.5], [0.5]).values[0]).all()
    with pytest.raises(InputError, match="triangulation per field"):
        gaps.delone.interp([0.5], [0.5], nan="drop")


def test_what_is_not_understood_is_refused() -> None:
    with pytest.raises(InputError, match="name two with coords"):
        stations().height.drop_vars(["easting", "northing"]).delone.interp([0], [0])
    with pytest.raises(InputError, match="no coordinates u and v"):
        stations().delone.grid(shape=(2, 2), coords=("u", "v"))
    with pytest.raises(InputError, match="one-dimensional"):
        stations().delone.interp([[0]], [0])


def test_a_variable_without_numbers_is_named() -> None:
    stations = xarray.Dataset(
        {"height": ("station", [1.0, 5.0, 9.0]), "label": ("station", ["a", "b", "c"])},
        coords={"x": ("station", [0.0, 4.0, 0.0]), "y": ("station", [0.0, 0.0, 4.0])},
    )
    with pytest.raises(TypeError, match="variable 'label' is not numeric"):
        stations.delone.grid(shape=(2, 2))
    assert stations.drop_vars("label").delone.grid(shape=(2, 2)).height.shape == (2, 2)
