"""Map files of other programs, and files that other programs read."""

from __future__ import annotations

import importlib.util
import pickle
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.sphere import Grid, Overlaps, Weights

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

netcdf = pytest.importorskip("netCDF4")

ROWS = Grid.from_lonlat(np.arange(0, 361, 20), np.arange(-90, 91, 15))
MESH = Grid.from_healpix(4)
SQUARE = Grid.from_lonlat(np.arange(0, 361, 30), np.arange(-90, 91, 15))
# A region, so that its last target has no source.
REGION = Grid.from_lonlat(np.arange(-20, 41, 10), np.arange(-30, 31, 10))


def field_on(grid: Grid) -> Floats:
    lon, lat = np.radians(grid.centers_lonlat.T)
    found: Floats = 2 + np.cos(lat) ** 2 * np.cos(2 * lon) + np.sin(lat)
    return found


def tempest(
    path: Path,
    source: Grid,
    target: Grid,
    *,
    slowest_first: bool = False,
    without: tuple[str, ...] = (),
    weights: Weights | None = None,
) -> Weights:
    """A map as TempestRemap writes it: no normalization, names of dimensions, first_index."""
    made = Overlaps(source, target).to_weights() if weights is None else weights
    with netcdf.Dataset(path, "w", format="NETCDF3_64BIT_DATA") as file:
        file.Title = "TempestRemap Offline Regridding Weight Generator"
        file.createDimension("n_s", len(made.values))
        for a, side, grid in (("a", "src", source), ("b", "dst", target)):
            shape = grid.grid_shape
            file.createDimension(f"n_{a}", grid.ncells)
            file.createDimension(f"{side}_grid_rank", len(shape))
            dims = file.createVariable(f"{side}_grid_dims", "i4", (f"{side}_grid_rank",))
            names = ("lat", "lon") if len(shape) == 2 else ("num_elem",)
            order = slice(None) if slowest_first else slice(None, None, -1)
            dims[:] = shape[order]
            for k, name in enumerate(names[order]):
                dims.setncattr(f"name{k}", name)
            known = {
                "xc": grid.centers_lonlat[:, 0],
                "yc": grid.centers_lonlat[:, 1],
                "area": grid.areas,
                "frac": made.fractions if a == "b" else made.source_fractions,
                "mask": np.ones(grid.ncells),
            }
            for name, values in known.items():
                if f"{name}_{a}" not in without:
                    file.createVariable(f"{name}_{a}", "f8", (f"n_{a}",))[:] = values
        row = np.repeat(np.arange(target.ncells), np.diff(made.indptr))
        # In no order.
        order = np.random.default_rng(0).permutation(len(row))
        for name, numbers in (("row", row), ("col", made.indices)):
            variable = file.createVariable(name, "i4", ("n_s",))
            variable.first_index = np.int32(1)
            variable[:] = numbers[order] + 1
        file.createVariable("S", "f8", ("n_s",))[:] = made.values[order]
    return made


@pytest.mark.parametrize("slowest_first", [False, True])
@pytest.mark.parametrize(
    ("source", "target"),
    [(ROWS, MESH), (MESH, ROWS), (ROWS, SQUARE), (SQUARE, SQUARE), (MESH, REGION)],
)
def test_rows_and_meshes_on_both_sides(
    tmp_path: Path, source: Grid, target: Grid, slowest_first: bool
) -> None:
    made = tempest(tmp_path / "map.nc", source, target, slowest_first=slowest_first)
    read = Weights.from_netcdf(tmp_path / "map.nc")
    assert read.method == "other"
    assert read.source_shape == source.grid_shape
    assert read.target_shape == target.grid_shape
    assert np.array_equal(read.matrix.toarray(), made.matrix.toarray())
    field = field_on(source).reshape(source.grid_shape)
    assert np.allclose(read.apply(field), made.apply(field), rtol=1e-14, atol=0, equal_nan=True)
    # A matrix of as many rows as columns is not transposed.
    for grid, areas in ((source, read.source_areas), (target, read.target_areas)):
        assert np.array_equal(areas, grid.areas)


@pytest.mark.parametrize("without", [("frac_b",), ("frac_a", "frac_b"), ("xc_b", "yc_b", "area_a")])
def test_what_files_lack(tmp_path: Path, without: tuple[str, ...]) -> None:
    # Half of the target has no source.
    made = tempest(tmp_path / "map.nc", REGION, ROWS, without=without)
    with netcdf.Dataset(tmp_path / "map.nc", "a") as file:
        file.normalization = "destarea"
    read = Weights.from_netcdf(tmp_path / "map.nc")
    assert read.method == "conservative"
    field = field_on(REGION)
    assert np.allclose(
        read.apply(field).ravel(), made.apply(field).ravel(), rtol=1e-13, equal_nan=True
    )
    assert np.allclose(read.fractions, made.fractions, rtol=0, atol=1e-14)
    assert np.isnan(read.source_areas).all() == ("area_a" in without)


def test_results_are_sums_of_weights_whatever_a_file_says(tmp_path: Path) -> None:
    made = tempest(tmp_path / "map.nc", REGION, MESH)
    expected = made.matrix @ field_on(REGION)
    assert ((made.fractions > 0) & (made.fractions < 0.9)).any()
    for said in ("destarea", "fracarea"):
        with netcdf.Dataset(tmp_path / "map.nc", "a") as file:
            file.normalization = said
            file.variables["frac_b"][:] = 1.0
        read = Weights.from_netcdf(tmp_path / "map.nc")
        there = made.fractions > 0
        assert np.allclose(read.apply(field_on(REGION)).ravel()[there], expected[there], rtol=1e-13)
    assert read.method == "other"


def sloped(path: Path) -> Weights:
    weights = Overlaps(MESH, ROWS).to_weights(order=2)
    weights.to_netcdf(path, source=MESH, target=ROWS)
    return weights


@pytest.mark.parametrize("own", [True, False])
def test_weights_of_second_order_are_not_areas(tmp_path: Path, own: bool) -> None:
    path = tmp_path / "map.nc"
    weights = sloped(path)
    if not own:
        # As ESMF writes them.
        with netcdf.Dataset(path, "a") as file:
            del file.delone_order, file.delone_method
            assert file.ESMF_regrid_method == "Second-order Conservative"
    read = Weights.from_netcdf(path)
    assert read.order == 2
    assert "order 2" in repr(read)
    field = field_on(MESH)
    assert np.allclose(read.apply(field), weights.apply(field), rtol=1e-13)
    # Complete fields have nothing to leave out.
    assert np.allclose(read.apply(field, skipna=True), weights.apply(field), rtol=1e-13)
    field[5] = np.nan
    for again in (read, pickle.loads(pickle.dumps(read))):
        with pytest.raises(delone.InputError, match="do not tell areas from slopes"):
            again.apply(field, skipna=True)
    assert np.isnan(read.apply(field)).sum() >= np.isnan(weights.apply(field)).sum() > 0
    # Written once more, it remains what it is.
    read.to_netcdf(tmp_path / "again.nc")
    assert Weights.from_netcdf(tmp_path / "again.nc").order == 2


def test_negative_weights_are_not_areas(tmp_path: Path) -> None:
    made = Overlaps(MESH, ROWS).to_weights(order=2)
    tempest(tmp_path / "map.nc", MESH, ROWS, weights=made)
    read = Weights.from_netcdf(tmp_path / "map.nc")
    assert (read.order, read.method) == (2, "other")
    tempest(tmp_path / "map.nc", MESH, ROWS)
    assert Weights.from_netcdf(tmp_path / "map.nc").order == 1


def test_files_without_sizes_need_the_grids(tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    from delone.xarray import Regridder

    path = tmp_path / "yac.nc"
    made = Overlaps(MESH, REGION).to_weights("normalized")
    with netcdf.Dataset(path, "w") as file:
        file.version = "yac weight file 1.0"
        file.createDimension("num_links", len(made.values))
        file.createDimension("num_wgts", 1)
        rows = np.repeat(np.arange(REGION.ncells), np.diff(made.indptr))
        file.createVariable("dst_address", "i4", ("num_links",))[:] = rows + 1
        file.createVariable("src_address", "i4", ("num_links",))[:] = made.indices + 1
        file.createVariable("remap_matrix", "f8", ("num_links", "num_wgts"))[:] = made.values[
            :, None
        ]
    with pytest.raises(delone.FileFormatError, match="src_grid_size: give the grid, source="):
        Weights.from_netcdf(path)
    read = Weights.from_netcdf(path, source=MESH, target=REGION)
    assert np.array_equal(read.matrix.toarray(), made.matrix.toarray())
    assert read.target_shape == (6, 6)
    assert np.array_equal(read.target_areas, REGION.areas)
    field = xarray.DataArray(field_on(MESH), dims="cell", name="t")
    found = Regridder(MESH, REGION, weights=path, dims=("cell",))(field)
    assert np.allclose(found.values, made.apply(field_on(MESH)), rtol=1e-14)
    with netcdf.Dataset(path, "a") as file:
        file.contains_fixed_dst = "TRUE"
    with pytest.raises(delone.FileFormatError, match="fixed values"):
        Weights.from_netcdf(path, source=MESH, target=REGION)
    tempest(tmp_path / "map.nc", MESH, ROWS)
    with pytest.raises(delone.InputError, match=r"source has 36 cells, and .*map\.nc 192"):
        Weights.from_netcdf(tmp_path / "map.nc", source=REGION)


def test_sides_of_cells_must_be_those_of_the_file(tmp_path: Path) -> None:
    weights = Overlaps(MESH, ROWS).to_weights()
    weights.to_netcdf(tmp_path / "map.nc", source=MESH, target=ROWS)
    read = Weights.from_netcdf(tmp_path / "map.nc", source=MESH, target=ROWS)
    assert np.array_equal(read.values, weights.values)
    lon, lat = np.meshgrid(np.arange(0.0, 361, 20), np.arange(-90.0, 91, 15))
    arcs = Grid.from_curvilinear(lon, lat)
    with pytest.raises(delone.InputError, match=r"target have arcs of great circles as sides, and"):
        Weights.from_netcdf(tmp_path / "map.nc", target=arcs)
    # Without the grids a file does not say.
    weights.to_netcdf(tmp_path / "bare.nc")
    assert Weights.from_netcdf(tmp_path / "bare.nc", target=arcs).target_shape == (12, 18)


@pytest.mark.parametrize("target", [ROWS, REGION, MESH])
def test_uxarray_applies_maps(tmp_path: Path, target: Grid) -> None:
    pytest.importorskip("uxarray")
    from uxarray.remap.weights import RemapWeights

    for method in ("conservative", "normalized"):
        weights = Overlaps(MESH, target).to_weights(method)
        weights.to_netcdf(tmp_path / "map.nc", source=MESH, target=target)
        theirs = RemapWeights.from_file(tmp_path / "map.nc")
        assert theirs.matrix.shape == (target.ncells, MESH.ncells)
        assert np.allclose(
            theirs._apply(field_on(MESH)), weights.matrix @ field_on(MESH), rtol=1e-14
        )


def test_uxarray_regrids_fields_on_its_grids(tmp_path: Path) -> None:
    uxarray = pytest.importorskip("uxarray")
    xarray = pytest.importorskip("xarray")
    grids = []
    for grid in (MESH, Grid.from_healpix(3)):
        places = grid.rings[0].reshape(-1, 4, 3)
        lon = np.degrees(np.arctan2(places[..., 1], places[..., 0]))
        lat = np.degrees(np.arcsin(np.clip(places[..., 2], -1, 1)))
        grids.append(uxarray.Grid.from_face_vertices(np.stack((lon, lat), axis=2), latlon=True))
    ours = [Grid.from_dataset(grid) for grid in grids]
    assert np.allclose(ours[0].areas, MESH.areas, rtol=1e-12)
    weights = Overlaps(*ours).to_weights("normalized")
    weights.to_netcdf(tmp_path / "map.nc", source=ours[0], target=ours[1])
    array = xarray.DataArray(np.stack([field_on(MESH)] * 2), dims=("time", "n_face"))
    field = uxarray.UxDataArray(array, uxgrid=grids[0])
    found = field.remap.apply_weights(grids[1], tmp_path / "map.nc")
    assert np.allclose(found.values, weights.apply(array.values), rtol=1e-13)


@pytest.mark.parametrize("form", ["NETCDF4", "NETCDF3_64BIT_DATA"])
@pytest.mark.parametrize(
    ("source", "target", "dims"),
    [(MESH, ROWS, ("lat", "lon")), (MESH, REGION, ("lat", "lon")), (ROWS, MESH, ("ncol",))],
    ids=["rows", "region", "mesh"],
)
def test_nco_applies_maps(
    tmp_path: Path, source: Grid, target: Grid, dims: tuple[str, ...], form: str
) -> None:
    ncks = shutil.which("ncks")
    if ncks is None:
        pytest.skip("could not find the program ncks")
    weights = Overlaps(source, target).to_weights("conservative")
    weights.to_netcdf(tmp_path / "map.nc", source=source, target=target, format=form)
    with netcdf.Dataset(tmp_path / "in.nc", "w") as file:
        names = ("lat", "lon") if len(source.grid_shape) == 2 else ("ncol",)
        for name, size in zip(names, source.grid_shape, strict=True):
            file.createDimension(name, size)
        file.createVariable("t", "f8", names)[:] = field_on(source).reshape(source.grid_shape)
    files = f"--map={tmp_path / 'map.nc'}", str(tmp_path / "in.nc"), str(tmp_path / "out.nc")
    subprocess.run([ncks, "-O", *files], check=True, capture_output=True)
    with netcdf.Dataset(tmp_path / "out.nc") as file:
        assert file["t"].dimensions == dims
        found = np.asarray(file["t"][:])
        assert np.allclose(found, weights.apply(field_on(source)), rtol=1e-14)
        lat = np.asarray(file["lat"][:])
        lon = np.asarray(file["lon"][:])
    if dims == ("lat", "lon"):
        lon, lat = (part.ravel() for part in np.meshgrid(lon, lat))
    off = np.abs(np.column_stack((lon, lat)) - target.centers_lonlat)
    assert np.minimum(off[:, 0], 360 - off[:, 0]).max() < 1e-9
    assert off[:, 1].max() < 1e-9


def run_cdo(cdo: str, *words: str) -> None:
    subprocess.run([cdo, "-O", *words], check=True, capture_output=True)


@pytest.mark.parametrize("method", ["conservative", "normalized"])
def test_cdo_applies_maps_and_its_maps_are_read(tmp_path: Path, method: str) -> None:
    cdo = shutil.which("cdo")
    if cdo is None:
        pytest.skip("could not find the program cdo")
    xarray = pytest.importorskip("xarray")
    given, out, table = (str(tmp_path / name) for name in ("in.nc", "out.nc", "map.nc"))
    source = Grid.from_lonlat(np.arange(0, 361, 10), np.arange(-90, 91, 10))
    target = Grid.from_lonlat(np.arange(0, 361, 5), np.arange(-90, 91, 6))
    field = field_on(source).reshape(source.grid_shape)
    lon, lat = np.arange(5.0, 360, 10), np.arange(-85.0, 90, 10)
    coords = {
        "lon": ("lon", lon, {"units": "degrees_east", "standard_name": "longitude"}),
        "lat": ("lat", lat, {"units": "degrees_north", "standard_name": "latitude"}),
    }
    xarray.Dataset({"t": (("lat", "lon"), field)}, coords=coords).to_netcdf(given)
    weights = Overlaps(source, target).to_weights(method)
    weights.to_netcdf(table, source=source, target=target, layout="scrip")
    run_cdo(cdo, f"remap,r72x30,{table}", given, out)
    with netcdf.Dataset(out) as file:
        assert np.allclose(file["t"][:], weights.apply(field), rtol=1e-14, atol=1e-14)
    run_cdo(cdo, "gencon,r72x36", given, table)
    run_cdo(cdo, f"remap,r72x36,{table}", given, out)
    again = Weights.from_netcdf(table)
    with netcdf.Dataset(out) as file:
        assert np.allclose(file["t"][:], again.apply(field), rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("target", [ROWS, REGION, MESH])
def test_xesmf_applies_maps(tmp_path: Path, target: Grid) -> None:
    # Its module of matrices alone, because the package needs ESMF.
    spec = importlib.util.find_spec("xesmf")
    if spec is None or spec.submodule_search_locations is None:
        pytest.skip("could not import 'xesmf': no such package")
    path = f"{spec.submodule_search_locations[0]}/smm.py"
    own = importlib.util.spec_from_file_location("xesmf_smm", path)
    assert own is not None
    assert own.loader is not None
    smm: Any = importlib.util.module_from_spec(own)
    own.loader.exec_module(smm)
    weights = Overlaps(MESH, target).to_weights("conservative")
    weights.to_netcdf(tmp_path / "map.nc", source=MESH, target=target)
    read = smm.read_weights(str(tmp_path / "map.nc"), MESH.ncells, target.ncells)
    shape = target.grid_shape if len(target.grid_shape) == 2 else (1, target.ncells)
    field = field_on(MESH).reshape(1, -1)
    # As its Regridder does.
    found = smm.apply_weights(read.data.reshape(shape + field.shape), field, field.shape, shape)
    expected = weights.matrix @ field.ravel()
    assert np.allclose(np.asarray(found).ravel(), expected, rtol=1e-13, atol=1e-15)
    assert "xesmf" not in sys.modules


class YacGrid:
    """What YAC needs of a grid between meridians and parallels."""

    def __init__(self, yac: Any, name: str, grid: Grid, lon: Floats, lat: Floats) -> None:
        cyclic = [bool(np.isclose(lon[-1] - lon[0], 360.0)), False]
        east = lon[:-1] if cyclic[0] else lon
        made = yac.BasicGrid.reg_2d_new(name, np.radians(east), np.radians(lat), cyclic=cyclic)
        place, nowhere = yac.yac_location.YAC_LOC_CELL, np.zeros(grid.ncells)
        self.field = yac.InterpField(made.add_coordinates(place, nowhere, nowhere))
        made.set_global_index(place, np.arange(grid.ncells))
        self.kept = made


def yac_grids(yac: Any) -> list[YacGrid]:
    around, rows = np.arange(0.0, 361, 20), np.arange(-90.0, 91, 15)
    part = np.arange(-20.0, 41, 10), np.arange(-30.0, 31, 10)
    return [YacGrid(yac, "globe", ROWS, around, rows), YacGrid(yac, "region", REGION, *part)]


def yac_core() -> Any:
    # Without an MPI library the import fails, with an error that has no name of a module.
    return pytest.importorskip(
        "yac.core", reason="could not import 'yac.core'", exc_type=ImportError
    )


@pytest.mark.parametrize("method", ["conservative", "normalized", "sum", "nearest"])
@pytest.mark.parametrize("form", ["NETCDF4", "NETCDF3_64BIT_DATA"])
def test_yac_applies_maps(tmp_path: Path, method: str, form: str) -> None:
    yac, path = yac_core(), tmp_path / "map.nc"
    if method == "nearest":
        made = Weights.between(ROWS, REGION, method)
    else:
        made = Overlaps(ROWS, REGION).to_weights(method)
    names = ("globe", "region")
    made.to_netcdf(path, layout="yac", grid_names=names, format=form, source=ROWS, target=REGION)
    stack = yac.InterpolationStack()
    stack.add_user_file(str(path))
    source, target = yac_grids(yac)
    applied = yac.compute_weights(stack, source.field, target.field)
    field = field_on(ROWS)
    found = applied.get_interpolation(collection_size=1)(field.reshape(1, -1)).ravel()
    assert np.allclose(found, made.apply(field).ravel(), rtol=1e-14, atol=0)


def test_maps_of_yac(tmp_path: Path) -> None:
    yac, path = yac_core(), tmp_path / "map.nc"
    stack = yac.InterpolationStack()
    kinds = yac.yac_interp_method_conserv_normalisation
    stack.add_conservative(
        order=1,
        enforced_conserv=False,
        partial_coverage=False,
        normalisation=kinds.YAC_INTERP_CONSERV_DESTAREA,
    )
    source, target = yac_grids(yac)
    made = yac.compute_weights(stack, source.field, target.field)
    made.write_to_file(str(path), "globe", "region", ROWS.ncells, REGION.ncells)
    field = field_on(ROWS)
    found = Weights.from_netcdf(path, source=ROWS, target=REGION).apply(field)
    applied = made.get_interpolation(collection_size=1)(field.reshape(1, -1))
    assert np.allclose(found.ravel(), applied.ravel(), rtol=1e-14, atol=0)
    assert np.allclose(found, Overlaps(ROWS, REGION).to_weights().apply(field), rtol=1e-10)


@pytest.mark.parametrize("form", ["NETCDF4", "NETCDF3_64BIT_DATA"])
def test_the_layout_of_yac(tmp_path: Path, form: str) -> None:
    path = tmp_path / "map.nc"
    made = Overlaps(MESH, REGION).to_weights("normalized")
    made.to_netcdf(path, layout="yac", grid_names=("ocean", "coast"), format=form)
    with netcdf.Dataset(path) as file:
        file.set_auto_mask(False)
        assert file.version == "yac weight file 1.0"
        assert (file.src_grid_name, file.dst_grid_name) == ("ocean", "coast")
        assert (file.contains_links, file.contains_fixed_dst) == ("TRUE", "FALSE")
        assert file.variables["num_links_per_src_field"][:].tolist() == [len(made.values)]
        for name, shape in (("src_locations", (1, 10)), ("dst_location", (10,))):
            place = file.variables[name][:]
            assert place.shape == shape and place.tobytes().rstrip(b"\0") == b"CELL"
        assert file.variables["src_address"][:].min() >= 1
    read = Weights.from_netcdf(path)
    assert read.method == "normalized" and np.array_equal(read.values, made.values)
    assert np.array_equal(read.matrix.toarray(), made.matrix.toarray())
