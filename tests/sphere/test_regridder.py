"""Datasets and arrays of xarray on other grids: dimensions, attributes, Dask, missing values."""

from __future__ import annotations

import pickle
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import sphere
from delone.sphere import Grid, Overlaps
from delone.sphere.named import named_grid

xarray = pytest.importorskip("xarray")
from delone.xarray import Regridder, VariableWarning  # noqa: E402

GRIDS = Path(__file__).parents[3] / "shared" / "data" / "climate"
LON, LAT = np.arange(0, 361, 10.0), np.arange(-90, 91, 10.0)
SOURCE, TARGET = Grid.from_lonlat(LON, LAT), Grid.from_healpix(4)
FIELD = np.random.default_rng(5).random((3, 18, 36))


def bounded(name: str, edges: Any, units: str) -> dict[str, Any]:
    attrs = {"units": units, "bounds": f"{name}_bnds", "axis": "X"}
    return {
        name: (name, (edges[1:] + edges[:-1]) / 2, attrs),
        f"{name}_bnds": ((name, "nv"), np.column_stack((edges[:-1], edges[1:]))),
    }


def model(field: Any = FIELD, *, lon: Any = LON, lat: Any = LAT) -> Any:
    parts = bounded("lon", lon, "degrees_east") | bounded("lat", lat, "degrees_north")
    return xarray.Dataset(
        {
            "rain": (
                ("time", "lat", "lon"),
                field,
                {"units": "kg m-2", "cell_measures": "area: a"},
            ),
            "height": (("lat", "lon"), np.arange(648.0).reshape(18, 36).astype(np.float32)),
            "title": ("time", list("abc")),
            "lon_bnds": parts.pop("lon_bnds"),
            "lat_bnds": parts.pop("lat_bnds"),
        },
        coords={**parts, "time": [0, 1, 2], "land": (("lat", "lon"), np.zeros((18, 36)))},
        attrs={"model": "one"},
    )


def mesh(grid: Grid = TARGET) -> Any:
    """The dataset of UGRID of a grid of quadrilaterals, with a field on its faces."""
    vectors, _, _ = grid.rings
    places, numbers = np.unique(vectors, axis=0, return_inverse=True)
    lon = np.degrees(np.arctan2(places[:, 1], places[:, 0]))
    lat = np.degrees(np.arcsin(np.clip(places[:, 2], -1, 1)))
    return xarray.Dataset(
        {
            "topology": ((), 0, {"cf_role": "mesh_topology", "topology_dimension": 2,
                                 "node_coordinates": "nx ny", "face_node_connectivity": "fn"}),
            "nx": ("node", lon, {"units": "degrees_east"}),
            "ny": ("node", lat, {"units": "degrees_north"}),
            "fn": (("face", "four"), numbers.reshape(-1, 4)),
            "psi": (("face", "level"), np.random.default_rng(2).random((grid.ncells, 2)),
                    {"mesh": "topology", "location": "face", "units": "K"}),
        }
    )  # fmt: skip


def test_a_dataset_of_rows_and_columns() -> None:
    ds = model()
    found = ds.delone.regrid(TARGET)
    expected = Overlaps(SOURCE, TARGET).to_weights().apply(FIELD)
    assert found.rain.dims == ("time", "cell")
    assert np.array_equal(found.rain.values, expected)
    assert found.rain.attrs == {"units": "kg m-2"}
    assert found.attrs == {"model": "one"}
    assert found.height.dtype == np.float32
    assert found.title.values.tolist() == list("abc")
    assert found.time.values.tolist() == [0, 1, 2]
    assert set(found.variables) == {"rain", "height", "title", "time", "lon", "lat"}
    assert np.array_equal(found.lon.values, TARGET.centers_lonlat[:, 0])
    assert found.lat.attrs["units"] == "degrees_north"
    assert found.lon.dims == ("cell",)
    # The dataset itself is as it was.
    assert ds.identical(model())


def test_the_target_is_a_dataset() -> None:
    lon, lat = np.arange(0, 361, 20.0), np.arange(90, -91, -30.0)
    parts = bounded("x", lon, "degrees_east") | bounded("y", lat, "degrees_north")
    other = xarray.Dataset(parts).set_coords(("x", "y"))
    found = model().delone.regrid(other, method="normalized")
    assert found.rain.dims == ("time", "y", "x")
    assert found.rain.shape == (3, 6, 18)
    assert found.x.attrs == {"units": "degrees_east", "bounds": "x_bnds", "axis": "X"}
    assert found.x_bnds.equals(other.x_bnds)
    assert "lon" not in found.variables
    assert "lon_bnds" not in found.variables
    # The same names on both sides are those of the target.
    fine = model().delone.regrid("5x5")
    assert fine.rain.shape == (3, 36, 72)
    assert fine.lon.values[:2].tolist() == [2.5, 7.5]
    assert fine.lon_bnds.values[0].tolist() == [0, 5]
    again = fine.delone.regrid(SOURCE)
    assert np.allclose(again.rain, FIELD, rtol=1e-14)


def test_meshes_of_ugrid() -> None:
    ds = mesh()
    found = ds.delone.regrid("10x10")
    assert found.psi.dims == ("lat", "lon", "level")
    assert found.psi.attrs == {"units": "K"}
    assert set(found.variables) == {"psi", "lon", "lat", "lon_bnds", "lat_bnds"}
    source = Grid.from_dataset(ds)
    values = Overlaps(source, SOURCE).to_weights().apply(ds.psi.values.T)
    assert np.array_equal(found.psi.transpose("level", "lat", "lon").values, values)
    # On a mesh, its description goes along.
    back = found.delone.regrid(ds.drop_vars("psi"))
    assert back.psi.dims == ("face", "level")
    assert back.psi.attrs == {"units": "K", "mesh": "topology", "location": "face"}
    assert Grid.from_dataset(back).ncells == TARGET.ncells


def test_other_dimensions_in_front_and_behind() -> None:
    regridder = Regridder(model(), "30x30")
    expected = regridder(model()).rain
    for dims in (("lat", "lon", "time"), ("lon", "time", "lat"), ("lat", "time", "lon")):
        found = regridder(model().rain.transpose(*dims))
        kept = [dim if dim == "time" else "cell" for dim in dims if dim != "lon"]
        assert (
            found.dims
            == {
                ("lat", "lon", "time"): ("lat", "lon", "time"),
                ("lon", "time", "lat"): ("lat", "lon", "time"),
                ("lat", "time", "lon"): ("lat", "lon", "time"),
            }[dims]
        ), kept
        assert np.array_equal(found.transpose(*expected.dims).values, expected.values)
    assert expected.name == "rain"


def test_dask_is_lazy_and_has_one_matrix() -> None:
    dask = pytest.importorskip("dask")
    ds = model().chunk({"time": 1, "lat": 5, "lon": 7})
    regridder = Regridder(ds, TARGET)
    found = regridder(ds)
    assert found.rain.chunks == ((1, 1, 1), (192,))
    assert found.rain.dtype == np.float64
    assert found.height.dtype == np.float32
    graph = dict(found.rain.__dask_graph__())
    held = [key for key, value in graph.items() if len(pickle.dumps(value)) > 20000]
    assert len(held) == 1
    plain = regridder(model())
    assert found.compute().identical(plain)
    assert isinstance(dask.compute(found.rain)[0].values, np.ndarray)
    masked = ds.assign(rain=ds.rain.where(ds.rain > 0.2))
    one = regridder(masked, skipna=True, min_fraction=0.3).compute()
    two = regridder(masked.compute(), skipna=True, min_fraction=0.3)
    assert one.identical(two)
    assert np.isnan(two.rain).any()


def test_majority_keeps_integers() -> None:
    kinds = (model().rain * 4).astype(np.int16)
    ds = model().assign(rain=kinds)
    found = ds.drop_vars("height").delone.regrid("30x30", method="majority")
    assert found.rain.dtype == np.int16
    lazy = ds.drop_vars("height").chunk({"time": 1}).delone.regrid("30x30", method="majority")
    assert lazy.rain.dtype == np.int16
    assert lazy.compute().rain.equals(found.rain)
    sub = model(FIELD).assign(rain=kinds).isel(lat=slice(4))
    with pytest.raises(delone.InputError, match="give fill="):
        sub.delone.regrid("30x30", method="majority")
    filled = sub.delone.regrid("30x30", method="majority", fill=-1)
    assert (filled.rain == -1).any()


def test_masks_of_datasets() -> None:
    places = np.stack(np.meshgrid(LON, LAT), axis=-1)
    quads = np.stack((places[:-1, :-1], places[:-1, 1:], places[1:, 1:], places[1:, :-1]), axis=2)
    units = {"units": "degrees"}
    scrip = xarray.Dataset(
        {
            "grid_dims": ("r", [36, 18]),
            "grid_corner_lon": (("n", "c"), quads[..., 0].reshape(-1, 4), units),
            "grid_corner_lat": (("n", "c"), quads[..., 1].reshape(-1, 4), units),
            "grid_imask": ("n", (np.arange(648) % 3 > 0).astype(int)),
        }
    )
    regridder = Regridder(scrip, TARGET, method="normalized", dims=("lat", "lon"))
    assert repr(regridder).endswith("216 source cells masked>")
    weights = Overlaps(regridder.source, TARGET).to_weights(
        "normalized", source_mask=regridder.source.mask
    )
    assert np.array_equal(regridder(model().rain).values, weights.apply(FIELD))
    whole = Regridder(scrip, TARGET, source_mask=np.ones(648, bool), dims=("lat", "lon"))
    assert np.allclose(whole.weights.fractions, 1, rtol=1e-14)
    # Without names of dimensions, the last ones of the shape.
    short = Regridder(scrip, TARGET, method="normalized")
    assert short(model().rain).identical(regridder(model().rain))
    assert short(model()).rain.equals(regridder(model().rain))
    with pytest.raises(delone.ShapeError, match="name them with dims="):
        short(model().rain.transpose("lon", "lat", "time"))


def test_weights_of_a_file(tmp_path: Path) -> None:
    pytest.importorskip("netCDF4")
    made = Regridder(model(), TARGET)
    path = tmp_path / "map.nc"
    made.weights.to_netcdf(path, source=made.source, target=made.target)
    read = Regridder(model(), TARGET, weights=sphere.Weights.from_netcdf(path))
    assert read(model()).identical(made(model()))
    with pytest.raises(delone.InputError, match="target has 48 cells, but the weights are for 192"):
        Regridder(model(), "healpix:2", weights=made.weights)
    again = pickle.loads(pickle.dumps(made))
    assert again(model()).identical(made(model()))
    assert repr(again) == repr(made) == "<Regridder, conservative, 18 x 36 to 192>"


def test_partial_variables_are_named() -> None:
    ds = model().assign(zonal=("lat", np.zeros(18)))
    with pytest.warns(VariableWarning, match=r"zonal \(lat\): not in the result") as caught:
        found = ds.delone.regrid(TARGET)
    assert caught[0].filename == __file__
    assert "zonal" not in found.variables
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model().delone.regrid(TARGET)
        # Bounds of coordinates that are not the grid's are gone with them.
        ds = model().assign_coords(band=("lat", np.zeros(18), {"bounds": "band_bnds"}))
        found = ds.assign(band_bnds=(("lat", "nv"), np.zeros((18, 2)))).delone.regrid(TARGET)
        assert "band_bnds" not in found.variables


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: model().delone.regrid("1.7x1"), delone.InputError, "1.7 degrees do not divide"),
        (lambda: model().delone.regrid("n"), delone.InputError, "no grid is called 'n'; names are"),
        (lambda: model().delone.regrid(3), delone.DtypeError, "target must be a sphere.Grid"),
        (lambda: model().rain.delone.regrid(TARGET), delone.InputError, "of an array give the"),
        (lambda: model().delone.regrid(TARGET, method="x"), delone.InputError, "method"),
        (
            lambda: model().delone.regrid(TARGET, dims=["lat"]),
            delone.ShapeError,
            r"dims must be those of \(18, 36\)",
        ),
        (
            lambda: Regridder(model(), TARGET)(model().rain.isel(lon=slice(3))),
            delone.ShapeError,
            "rain must have the dimensions",
        ),
        (lambda: Regridder(model(), TARGET)(FIELD), delone.DtypeError, "xarray objects"),
        (
            lambda: (
                model().assign(t=(("lat", "lon"), np.full((18, 36), "a"))).delone.regrid(TARGET)
            ),
            delone.DtypeError,
            "variable t is not numeric",
        ),
        (
            lambda: model().rename(time="cell").delone.regrid(TARGET),
            delone.InputError,
            "rain and the target have the dimension 'cell'",
        ),
    ],
)
def test_what_is_refused(call: Any, error: Any, message: str) -> None:
    with pytest.raises(error, match=message):
        call()


def test_arrays_with_inferred_bounds() -> None:
    found = model().rain.delone.regrid(TARGET, infer_bounds=True)
    assert np.array_equal(found.values, model().delone.regrid(TARGET).rain.values)
    assert found.dims == ("time", "cell")
    assert "land" not in found.coords


def test_names_of_grids() -> None:
    for name, cells in (
        ("1x1", 64800), ("2.5x2", 144 * 90), ("healpix:8", 768), ("healpix:8:nested", 768),
        ("n8", 16 * 32), ("O8", Grid.from_gaussian(8, "octahedral").ncells), ("0.5x.5", 720 * 360),
    ):  # fmt: skip
        assert named_grid(name).ncells == cells
    assert np.array_equal(
        named_grid("healpix:8:nested").rings[0], Grid.from_healpix(8, "nested").rings[0]
    )


def test_fields_of_models() -> None:
    pytest.importorskip("netCDF4")
    if not GRIDS.is_dir():
        pytest.skip("needs the grids of models")
    with (
        xarray.open_dataset(GRIDS / "ugrid_outCSne30_outCSne30.ug") as grid,
        xarray.open_dataset(GRIDS / "ugrid_outCSne30_outCSne30_vortex.nc") as fields,
        xarray.open_dataset(GRIDS / "ugrid_outRLL1deg_outRLL1deg_vortex.nc") as truth,
    ):
        found = Regridder(grid, "1x1", dims=["ncol"])(fields)
        assert found.psi.shape == (180, 360)
        assert abs(found.psi.values - truth.psi.values).mean() < 0.01


def test_classes_that_have_a_grid_become_plain_ones() -> None:
    class Own(xarray.Dataset):
        __slots__ = ()

    given = model()
    parts = (
        {name: given.variables[name] for name in names} for names in (given.data_vars, given.coords)
    )
    own = Own(*parts, attrs=given.attrs)
    found = Regridder(given, TARGET)(own)
    assert type(found) is xarray.Dataset
    assert found.identical(given.delone.regrid(TARGET))
