"""Weights of regridding: conservation, constants, masks, missing values, categories, map files."""

from __future__ import annotations

import math
import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.areal.weights import METHODS
from delone.sphere import Grid, Overlaps, Weights

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def degrees(step: float) -> Grid:
    return Grid.from_lonlat(np.arange(0, 361, step), np.arange(-90, 91, step))


def harmonic(grid: Grid) -> Floats:
    """Y 2 2, shifted, at the centers of cells."""
    lon, lat = np.radians(grid.centers_lonlat.T)
    found: Floats = 2 + np.cos(lat) ** 2 * np.cos(2 * lon)
    return found


def totals(weights: Weights, field: Floats) -> tuple[float, float]:
    """Integrals on both grids."""
    there = weights.apply(field).ravel()
    return (
        math.fsum(field.ravel() * weights.source_areas),
        math.fsum(there * weights.target_areas),
    )


SOURCE, TARGET = Grid.from_healpix(8), degrees(10)
OVERLAPS = Overlaps(SOURCE, TARGET)


def test_conservative_conserves() -> None:
    for overlaps in (OVERLAPS, Overlaps(TARGET, SOURCE)):
        assert overlaps.source is not None
        before, after = totals(overlaps.to_weights("conservative"), harmonic(overlaps.source))
        assert abs(after / before - 1) < 1e-14


def test_a_constant_remains_one() -> None:
    for method in ("conservative", "normalized", "majority"):
        weights = OVERLAPS.to_weights(method)
        assert abs(weights.apply(np.full(768, 0.1)) / 0.1 - 1).max() < 1e-14
    region = Overlaps(Grid.from_lonlat(np.arange(3, 33), np.arange(41, 61)), TARGET)
    found = region.to_weights("normalized").apply(np.full((19, 29), 0.1))
    assert np.unique(found[~np.isnan(found)]).tolist() == [0.1]
    assert np.array_equal(np.isnan(found).ravel(), region.covered_target == 0)


def test_errors_of_a_field_decrease_with_the_size_of_cells() -> None:
    # The mean of each target cell, from small cells.
    fine = Overlaps(degrees(1), TARGET).to_weights("normalized")
    means = fine.apply(harmonic(degrees(1)).reshape(180, 360)).ravel()
    errors = []
    for source in (Grid.from_healpix(8), Grid.from_healpix(16), Grid.from_healpix(32)):
        weights = Overlaps(source, TARGET).to_weights("normalized")
        errors.append(abs(weights.apply(harmonic(source)).ravel() - means).max())
    assert errors[0] > 3 * errors[2]
    assert errors[2] < 0.02


def analytic(name: str, lonlat: Floats) -> Floats:
    """The fields that articles on regridding compare."""
    lon, lat = np.radians(lonlat.T)
    found: Floats
    if name == "vortex":
        # Nair and Jablonowski (2008), with the pole of the rotation at 0.8 and 0.6 radians.
        up = np.sin(lat) * np.sin(0.6) + np.cos(lat) * np.cos(0.6) * np.cos(lon - 0.8)
        turn = np.arctan2(
            np.cos(lat) * np.sin(lon - 0.8),
            np.cos(lat) * np.sin(0.6) * np.cos(lon - 0.8) - np.cos(0.6) * np.sin(lat),
        )
        r = 3 * np.sqrt(np.maximum(1 - up**2, 1e-30))
        speed = 1.5 * np.sqrt(3) * np.tanh(r) / np.cosh(r) ** 2 / r
        found = 1 - np.tanh(r / 5 * np.sin(turn - 6 * speed))
        return found
    special = pytest.importorskip("scipy.special")
    degree, order = map(int, name.split())
    found = 2 + special.sph_harm_y(degree, order, np.pi / 2 - lat, lon).real
    return found


@pytest.mark.parametrize("name", ["2 2", "32 16", "vortex"])
def test_errors_of_analytic_fields_have_the_first_order(name: str) -> None:
    target = degrees(3)
    fine = Grid.from_lonlat(np.linspace(0, 360, 721), np.linspace(-90, 90, 361))
    inner = analytic(name, fine.centers_lonlat) * fine.areas
    blocks = (60, 6, 120, 6)
    truth = inner.reshape(blocks).sum(axis=(1, 3)) / fine.areas.reshape(blocks).sum(axis=(1, 3))
    errors = []
    for nside in (32, 64):
        source = Grid.from_healpix(nside)
        found = Overlaps(source, target).to_weights().apply(analytic(name, source.centers_lonlat))
        away = (found - truth).ravel()
        errors.append(math.sqrt((away**2 * target.areas).sum()))
    # Means over many cells converge faster than single values.
    assert 1.7 < errors[0] / errors[1] < 6
    assert errors[1] < 0.02


def test_sums_keep_amounts() -> None:
    rng = np.random.default_rng(1)
    people = rng.integers(0, 1000, 768)
    found = OVERLAPS.to_weights("sum").apply(people)
    assert found.shape == TARGET.grid_shape
    assert math.fsum(found.ravel()) == pytest.approx(people.sum(), rel=1e-14)
    nested = Overlaps(degrees(5), TARGET).to_weights("sum")
    assert np.allclose(nested.apply(np.ones((36, 72))), 4, rtol=1e-14)


def test_majority_is_the_largest_part() -> None:
    rng = np.random.default_rng(3)
    kinds = rng.integers(0, 4, 768)
    found = OVERLAPS.to_weights("majority").apply(kinds)
    assert found.dtype == kinds.dtype
    table = OVERLAPS.matrix.toarray()
    parts = np.stack([table[:, kinds == k].sum(axis=1) for k in range(4)])
    assert np.array_equal(parts.max(axis=0), parts[found.ravel(), np.arange(648)])
    # Of equal parts, the smallest value.
    halves = Overlaps(Grid.from_lonlat([0, 1, 2], [-1, 1]), Grid.from_lonlat([0, 2], [-1, 1]))
    assert halves.to_weights("majority").apply([[5, 2]]).tolist() == [[2]]
    outside = Overlaps(Grid.from_lonlat([0, 1], [0, 1]), Grid.from_lonlat([0, 1, 2], [0, 1]))
    with pytest.raises(delone.InputError, match="1 target cell has no value"):
        outside.to_weights("majority").apply([[7]])
    assert outside.to_weights("majority").apply([[7]], fill=-1).tolist() == [[7, -1]]
    found = outside.to_weights("majority").apply([[7.0]])
    assert np.isnan(found[0, 1])


@pytest.mark.parametrize("method", METHODS)
def test_missing_values_are_masked_cells(method: str) -> None:
    rng = np.random.default_rng(7)
    there = rng.random(768) < 0.7
    field = np.floor(4 * rng.random(768))
    masked = OVERLAPS.to_weights(method, source_mask=there)
    one = masked.apply(field)
    two = OVERLAPS.to_weights(method).apply(np.where(there, field, np.nan), skipna=True)
    assert np.allclose(one, two, rtol=1e-13, equal_nan=True)
    half = OVERLAPS.to_weights(method).apply(
        np.where(there, field, np.nan), skipna=True, min_fraction=0.5
    )
    few = masked.fractions.reshape(TARGET.grid_shape) < 0.5
    assert np.array_equal(np.isnan(half), few)
    assert np.allclose(half[~few], one[~few], rtol=1e-13)


def test_missing_values_propagate_unless_they_are_skipped() -> None:
    field = np.ones(768)
    field[100] = np.nan
    touched = OVERLAPS.matrix.toarray()[:, 100] > 0
    for method in ("conservative", "normalized", "sum"):
        found = OVERLAPS.to_weights(method).apply(field)
        assert np.array_equal(np.isnan(found).ravel(), touched)
    found = OVERLAPS.to_weights("normalized").apply(field, skipna=True)
    assert set(np.unique(found)) == {1.0}
    # Only cells of which a part is missing are below 1.
    found = OVERLAPS.to_weights("normalized").apply(field, skipna=True, min_fraction=1)
    assert np.array_equal(np.isnan(found).ravel(), touched)


def test_masks() -> None:
    rng = np.random.default_rng(8)
    land, sea = rng.random(768) < 0.5, rng.random(TARGET.grid_shape) < 0.5
    weights = OVERLAPS.to_weights("conservative", source_mask=land, target_mask=sea)
    assert np.array_equal(np.isnan(weights.apply(np.ones(768))), ~sea | (
        OVERLAPS.to_weights(source_mask=land).fractions.reshape(sea.shape) == 0))  # fmt: skip
    assert not weights.source_fractions[~land].any()
    same = OVERLAPS.to_weights(
        "conservative", source_mask=land.astype(int), target_mask=sea.ravel()
    )
    assert np.array_equal(same.values, weights.values)
    table = weights.matrix.toarray()
    assert not table[:, ~land].any()
    assert not table[~sea.ravel()].any()
    everywhere = OVERLAPS.to_weights(source_mask=np.ones(768, bool))
    assert np.allclose(everywhere.values, OVERLAPS.to_weights().values, rtol=1e-15)


def test_fields_keep_leading_axes_and_float32() -> None:
    weights = Overlaps(TARGET, SOURCE).to_weights("normalized")
    field = np.random.default_rng(2).random((3, 2, 18, 36))
    found = weights.apply(field)
    assert found.shape == (3, 2, 768)
    assert np.array_equal(found[2, 1], weights.apply(field[2, 1]))
    assert np.array_equal(found, weights.apply(field.reshape(3, 2, 648)))
    short = weights.apply(field.astype(np.float32))
    assert short.dtype == np.float32
    assert abs(short - found).max() < 1e-6
    assert weights.apply(np.ones((18, 36), dtype=int)).dtype == np.float64


def test_pickles_are_small() -> None:
    weights = OVERLAPS.to_weights()
    data = pickle.dumps(weights)
    again = pickle.loads(data)
    assert len(data) < 12 * len(weights.values) + 8 * 4 * (768 + 648) + 4000
    assert np.array_equal(again.apply(harmonic(SOURCE)), weights.apply(harmonic(SOURCE)))
    assert repr(again) == repr(weights)
    with pytest.raises(ValueError, match="read-only"):
        again.values[0] = 1


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda w: Weights(), delone.InputError, "Overlaps.to_weights"),
        (lambda w: OVERLAPS.to_weights("bilinear"), delone.InputError, "method"),
        (lambda w: OVERLAPS.to_weights(source_mask=[1, 0]), delone.ShapeError, "source_mask"),
        (lambda w: OVERLAPS.to_weights(source_mask=np.full(768, 2)), delone.InputError, "0 and 1"),
        (lambda w: OVERLAPS.to_weights(source_mask=np.ones(768)), delone.DtypeError, "boolean"),
        (lambda w: w.apply(np.ones(7)), delone.ShapeError, "last axes"),
        (lambda w: w.apply(np.ones(768, complex)), delone.DtypeError, "real"),
        (lambda w: w.apply(np.ones(768), min_fraction=2), delone.InputError, "min_fraction"),
    ],
)
def test_what_is_refused(call: Callable[[Any], Any], error: Any, message: str) -> None:
    with pytest.raises(error, match=message):
        call(OVERLAPS.to_weights())


@pytest.mark.parametrize("layout", ["esmf", "scrip"])
@pytest.mark.parametrize("method", ["conservative", "normalized", "sum"])
def test_map_files(tmp_path: Path, layout: str, method: str) -> None:
    netcdf = pytest.importorskip("netCDF4")
    path = tmp_path / "map.nc"
    land = np.arange(768) % 5 > 0
    weights = OVERLAPS.to_weights(method, source_mask=land)
    weights.to_netcdf(path, layout=layout, source=SOURCE, target=TARGET)
    again = Weights.from_netcdf(path)
    for name in ("indptr", "indices", "values", "fractions", "source_areas", "target_areas"):
        assert np.array_equal(getattr(again, name), getattr(weights, name))
    assert repr(again) == repr(weights)
    with netcdf.Dataset(path) as file:
        row = file.variables["row" if layout == "esmf" else "dst_address"]
        assert row.start_index == 1
        assert row[:].min() >= 1
        if layout == "esmf":
            # What NCO looks for.
            assert "ESMF Offline Regridding Weight Generator" in file.title
            needed = {"area_b", "xc_b", "yc_b", "xv_b", "yv_b", "frac_b", "dst_grid_dims"}
            assert needed <= set(file.variables)
            assert file.variables["dst_grid_dims"][:].tolist() == [36, 18]
            assert file.variables["xv_b"].shape == (648, 4)
            assert file.variables["xc_a"].units == "degrees"
            assert file.normalization in {"destarea", "fracarea", "none"}


def test_maps_of_other_programs(tmp_path: Path) -> None:
    netcdf = pytest.importorskip("netCDF4")
    path = tmp_path / "map.nc"

    def write(
        *, start: int | None = None, first: int = 1, size: int = 3, **attributes: Any
    ) -> None:
        with netcdf.Dataset(path, "w", format="NETCDF3_64BIT_DATA") as file:
            file.setncatts(attributes)
            for name, count in (("n_a", 4), ("n_b", size), ("n_s", 3)):
                file.createDimension(name, count)
            for name, values in (("row", [2, 1, 1]), ("col", [4, 1, 1])):
                variable = file.createVariable(name, "i4", ("n_s",))
                variable[:] = np.array(values) - 1 + first
                if start is not None:
                    variable.start_index = start
            file.createVariable("S", "f8", ("n_s",))[:] = [1, 0.25, 0.75]

    # A map whose last target has no source is not shifted; entries of one pair are added.
    for start, first in ((None, 1), (1, 1), (0, 0)):
        write(start=start, first=first)
        weights = Weights.from_netcdf(path)
        assert weights.method == "other"
        assert weights.indptr.tolist() == [0, 1, 2, 2]
        assert weights.indices.tolist() == [0, 3]
        assert weights.values.tolist() == [1, 1]
        found = weights.apply([1.0, 2, 3, np.nan], skipna=True)
        assert found[0] == 1
        assert np.isnan(found[1:]).all()
    write(normalization="fracarea")
    assert Weights.from_netcdf(path).method == "normalized"
    write(size=1)
    with pytest.raises(delone.FileFormatError, match=r"row\[0\] is 2, outside 1 to 1"):
        Weights.from_netcdf(path)
    write(first=0)
    with pytest.raises(delone.FileFormatError, match=r"row\[1\] is 0, outside 1 to 3"):
        Weights.from_netcdf(path)
    path.write_bytes(b"CDX")
    with pytest.raises(delone.FileFormatError, match="not a NetCDF file"):
        Weights.from_netcdf(path)
    with pytest.raises(FileNotFoundError):
        Weights.from_netcdf(tmp_path / "none.nc")
    with netcdf.Dataset(path, "w") as file:
        file.createDimension("n_a", 1)
    with pytest.raises(delone.FileFormatError, match="not a map file"):
        Weights.from_netcdf(path)


def test_maps_of_scrip_with_areas(tmp_path: Path) -> None:
    netcdf = pytest.importorskip("netCDF4")
    path = tmp_path / "map.nc"
    OVERLAPS.to_weights().to_netcdf(path, layout="scrip", format="NETCDF3_64BIT_DATA")
    with netcdf.Dataset(path, "a") as file:
        file.normalization = "none"
        del file.delone_method
        rows = file.variables["dst_address"][:] - 1
        area = file.variables["dst_grid_area"][:][rows]
        file.variables["remap_matrix"][:] = file.variables["remap_matrix"][:] * area[:, None]
    found = Weights.from_netcdf(path)
    assert found.method == "conservative"
    assert np.allclose(found.values, OVERLAPS.to_weights().values, rtol=1e-15)


def test_what_files_refuse(tmp_path: Path) -> None:
    pytest.importorskip("netCDF4")
    path = tmp_path / "map.nc"
    with pytest.raises(delone.InputError, match="majority"):
        OVERLAPS.to_weights("majority").to_netcdf(path)
    with pytest.raises(delone.InputError, match="layout"):
        OVERLAPS.to_weights().to_netcdf(path, layout="cdo")
    with pytest.raises(delone.InputError, match="source has 12 cells, but the weights are for 768"):
        OVERLAPS.to_weights().to_netcdf(path, source=Grid.from_healpix(1))
    assert not path.exists()
