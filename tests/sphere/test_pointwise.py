"""Weights between centers: their definitions, masks, poles, files and xarray."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import sphere
from delone.sphere import Grid, Overlaps, Weights
from delone.sphere.pointwise import POINTWISE

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

SOURCE = Grid.from_lonlat(np.arange(0, 361, 10), np.arange(-90, 91, 10))
TARGET = Grid.from_healpix(8, "nested")


def vectors(grid: Grid) -> Floats:
    lon, lat = np.radians(grid.centers_lonlat.T)
    return np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))


def smooth(grid: Grid) -> Floats:
    x, y, z = vectors(grid).T
    found: Floats = 1 + 0.3 * x + 0.2 * y * z
    return found


@pytest.mark.parametrize("method", POINTWISE)
def test_constants_and_smooth_fields(method: str) -> None:
    weights = Weights.between(SOURCE, TARGET, method)
    assert weights.method == method
    sums = np.asarray(weights.matrix.sum(axis=1)).ravel()
    there = weights.fractions > 0
    assert np.allclose(sums[there], 1, rtol=1e-12)
    assert (weights.values > 0).all()
    assert there.all() or method == "binned"
    found = weights.apply(np.full(648, 0.1))
    assert np.unique(found[there]).tolist() == [0.1]
    errors = abs(weights.apply(smooth(SOURCE)) - smooth(TARGET))[there]
    limit = {"nearest": 0.05, "binned": 0.06, "inverse_distance": 0.04}.get(method, 0.006)
    assert errors.max() < limit
    # At its own centers a field is itself.
    own = Weights.between(SOURCE, SOURCE, method).apply(smooth(SOURCE).reshape(18, 36))
    assert np.allclose(own.ravel(), smooth(SOURCE), rtol=1e-12)


def test_nearest_and_binned_are_those_of_all_pairs() -> None:
    cosines = vectors(TARGET) @ vectors(SOURCE).T
    best = cosines.max(axis=1)
    near = Weights.between(SOURCE, TARGET, "nearest")
    assert np.allclose(cosines[np.arange(768), near.indices], best, rtol=1e-14)
    binned = Weights.between(SOURCE, TARGET, "binned").matrix.toarray()
    assert (np.count_nonzero(binned, axis=0) == 1).all()
    owner = binned.argmax(axis=0)
    assert np.allclose(cosines[owner, np.arange(648)], cosines.max(axis=0), rtol=1e-14)
    rows, counts = np.unique(owner, return_counts=True)
    assert np.allclose(binned.max(axis=1)[rows], 1 / counts)
    # One center, and two, are enough.
    few = Grid.from_lonlat([0, 10, 20], [0, 10])
    assert set(Weights.between(few, TARGET, "nearest").apply([[1.0, 2.0]])) == {1.0, 2.0}
    one = Grid.from_lonlat([0, 10], [0, 10])
    assert Weights.between(SOURCE, one, "binned").apply(np.full(648, 3.0)).tolist() == [[3.0]]


def test_inverse_distances_by_their_definition() -> None:
    mesh = sphere.Delaunay(lonlat=SOURCE.centers_lonlat)
    angles = np.arccos(np.clip(vectors(TARGET) @ vectors(SOURCE).T, -1, 1))
    neighbors = {k: {k} for k in range(648)}
    for a, b in mesh.edges.tolist():
        neighbors[a].add(b)
        neighbors[b].add(a)
    table = Weights.between(SOURCE, TARGET, "inverse_distance", power=3).matrix.toarray()
    near = mesh.nearest(TARGET.centers_lonlat)
    for row in range(0, 768, 37):
        own = sorted(neighbors[int(near[row])])
        expected = angles[row, own] ** -3.0
        assert np.allclose(table[row, own], expected / expected.sum(), rtol=1e-6)
        assert np.count_nonzero(table[row]) == len(own)
    for power in (0, -1, np.inf):
        with pytest.raises(delone.InputError, match="power must be above 0"):
            Weights.between(SOURCE, TARGET, "inverse_distance", power=power)


@pytest.mark.parametrize("most", [1, 2, 4, 30])
@pytest.mark.parametrize("regional", [False, True])
def test_the_nearest_centers_by_all_distances(most: int, regional: bool) -> None:
    xyz = np.random.default_rng(9).normal(size=(400, 3))
    source = Grid.from_voronoi(sphere.Voronoi(xyz=xyz))
    there = vectors(source)[:, 2] > 0.2 if regional else np.ones(400, bool)
    angles = np.arccos(np.clip(vectors(TARGET) @ vectors(source).T, -1, 1))
    angles[:, ~there] = 9
    table = Weights.between(
        source, TARGET, "inverse_distance", neighbors=most, power=1, source_mask=there
    ).matrix.toarray()
    # Targets within a right angle of the centers.
    for row in np.flatnonzero(vectors(TARGET)[:, 2] > -0.1)[::7]:
        near = np.argsort(angles[row])[:most]
        assert np.array_equal(np.flatnonzero(table[row]), np.sort(near))
        expected = 1 / angles[row, near]
        assert np.allclose(table[row, near], expected / expected.sum(), rtol=1e-9)


def test_equal_distances_all_count() -> None:
    # The middle of four centers, which are equally far.
    source, target = Grid.from_lonlat([-2, 0, 2], [-2, 0, 2]), Grid.from_lonlat([-1, 1], [-1, 1])
    for most in (1, 3, 4):
        made = Weights.between(source, target, "inverse_distance", neighbors=most)
        assert np.allclose(made.matrix.toarray(), 0.25, rtol=1e-12)


@pytest.mark.parametrize(("across", "up"), [(1, 1), (-1, 1), (1, -1), (-1, -1)])
def test_bilinear_is_exact_in_degrees_and_at_poles(across: int, up: int) -> None:
    lon, lat = np.arange(0, 361, 10)[::across], np.arange(-90, 91, 10)[::up]
    source = Grid.from_lonlat(lon, lat)
    target = Grid.from_lonlat(np.arange(-180, 181, 3), np.arange(-90, 91, 3))
    weights = Weights.between(source, target, "bilinear")
    assert (weights.fractions == 1).all()
    y = source.centers_lonlat[:, 1]
    found = weights.apply(y).reshape(60, 120)
    expected = target.centers_lonlat[:, 1].reshape(60, 120)
    middle = abs(expected) <= 85
    assert np.allclose(found[middle], expected[middle], rtol=0, atol=1e-12)
    # Beyond the last rows values are those of the mean of the row.
    assert np.allclose(abs(found[~middle]), 85)
    east = weights.apply(np.sin(np.radians(source.centers_lonlat[:, 0]))).reshape(60, 120)
    gap = east - np.sin(np.radians(target.centers_lonlat[:, 0])).reshape(60, 120)
    assert abs(gap[middle]).max() < 0.005
    wave = np.cos(np.radians(source.centers_lonlat[:, 0]))
    poles = abs(weights.apply(wave).reshape(60, 120)[[0, -1]])
    # 3.5 of 5 degrees from the row to the pole, where waves have the mean 0.
    assert poles.max() < 0.31


def test_bilinear_of_regions_and_masks() -> None:
    region = Grid.from_lonlat(np.arange(350, 391, 10), np.arange(0, 41, 10))
    target = Grid.from_lonlat(np.arange(-30, 61, 2), np.arange(-20, 61, 2))
    weights = Weights.between(region, target, "bilinear")
    x, y = target.centers_lonlat.T
    inside = (x >= -5) & (x <= 25) & (y >= 5) & (y <= 35)
    assert np.array_equal(weights.fractions > 0, inside)
    found = weights.apply(region.centers_lonlat[:, 0]).ravel()
    assert np.allclose(found[inside], x[inside], rtol=0, atol=1e-12)
    near = Weights.between(region, target, "bilinear", extrapolate="nearest")
    assert (near.fractions == 1).all()
    assert np.allclose(near.apply(region.centers_lonlat[:, 0]).ravel()[inside], x[inside])
    mask = np.ones(16, bool)
    mask[5] = False
    part = Weights.between(region, target, "bilinear", source_mask=mask)
    assert not (part.indices == 5).any()
    assert set(part.indptr) != set(weights.indptr)
    assert np.allclose(part.matrix.sum(axis=1)[part.fractions > 0], 1)


@pytest.mark.parametrize("method", POINTWISE)
def test_masks_missing_values_and_hulls(method: str) -> None:
    there = np.random.default_rng(1).random(648) < 0.8
    aim = np.arange(768) % 4 > 0
    weights = Weights.between(SOURCE, TARGET, method, source_mask=there, target_mask=aim)
    assert not (~there)[weights.indices].any()
    assert not weights.fractions[~aim].any()
    field = np.where(there, smooth(SOURCE), np.nan)
    assert not np.isnan(weights.apply(field)[weights.fractions > 0]).any()
    # A constant remains one where some values are missing.
    found = Weights.between(SOURCE, TARGET, method).apply(field * 0 + 0.3, skipna=True)
    assert set(found[~np.isnan(found)].tolist()) == {0.3}
    region = Grid.from_lonlat(np.arange(0, 61, 10), np.arange(0, 61, 10))
    inside = Weights.between(region, TARGET, method).fractions > 0
    if method in {"nearest", "inverse_distance"}:
        assert inside.all()
    else:
        assert 10 < inside.sum() < 120
        near = Weights.between(region, TARGET, method, extrapolate="nearest")
        assert (near.fractions > 0).all() or method == "binned"


def test_files_and_pickles(tmp_path: Path) -> None:
    netcdf = pytest.importorskip("netCDF4")
    for method in POINTWISE:
        weights = Weights.between(SOURCE, TARGET, method)
        weights.to_netcdf(tmp_path / "map.nc", source=SOURCE, target=TARGET)
        again = Weights.from_netcdf(tmp_path / "map.nc")
        assert again.method == method
        assert np.array_equal(again.values, weights.values)
        assert np.array_equal(again.apply(smooth(SOURCE)), weights.apply(smooth(SOURCE)),
                              equal_nan=True)  # fmt: skip
        assert repr(pickle.loads(pickle.dumps(weights))) == repr(weights)
        with netcdf.Dataset(tmp_path / "map.nc") as file:
            assert "onservative" not in file.map_method + file.ESMF_regrid_method
    Overlaps(SOURCE, TARGET).to_weights().to_netcdf(tmp_path / "map.nc")
    with netcdf.Dataset(tmp_path / "map.nc") as file:
        assert file.map_method == "Conservative remapping"


def test_xarray() -> None:
    xarray = pytest.importorskip("xarray")
    import delone.xarray

    field = xarray.DataArray(
        smooth(SOURCE).reshape(18, 36),
        coords=[
            ("lat", np.arange(-85.0, 90, 10), {"units": "degrees_north"}),
            ("lon", np.arange(5.0, 360, 10), {"units": "degrees_east"}),
        ],
    )
    for method in ("linear", "bilinear", "nearest"):
        found = field.delone.regrid(TARGET, method=method, infer_bounds=True)
        expected: Any = Weights.between(SOURCE, TARGET, method).apply(smooth(SOURCE))
        assert np.array_equal(found.values, expected)
    assert isinstance(delone.xarray.Regridder, type)


def test_what_is_refused() -> None:
    for options, error, message in (
        ({"method": "cubic"}, delone.InputError, "method"),
        ({"extrapolate": "linear"}, delone.InputError, "extrapolate"),
        ({"method": "inverse_distance", "neighbors": 0}, delone.InputError, "at least 1"),
        (
            {"method": "linear", "neighbors": 4},
            delone.InputError,
            "only for method .inverse_distance",
        ),
        ({"source_mask": [1]}, delone.ShapeError, "source_mask"),
        ({"workers": 0}, delone.InputError, "workers"),
    ):
        with pytest.raises(error, match=message):
            Weights.between(SOURCE, TARGET, **options)
    nothing = Weights.between(SOURCE, TARGET, source_mask=np.zeros(648, bool))
    assert np.isnan(nothing.apply(smooth(SOURCE))).all()
