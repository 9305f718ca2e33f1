"""Conservative weights of second order: moments, orders of errors, totals, the limiter."""

from __future__ import annotations

import math
import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.sphere import Grid, Overlaps, Voronoi, Weights
from delone.sphere.moments import moments_of_cells, moments_of_parts

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def rows(across: int, up: int) -> Grid:
    return Grid.from_lonlat(np.linspace(0, 360, across + 1), np.linspace(-90, 90, up + 1))


def sites(count: int, seed: int) -> Floats:
    return np.random.default_rng(seed).normal(size=(count, 3))


STAR = [
    (10 + size * math.cos(k * math.pi / 5), 55 + size * math.sin(k * math.pi / 5))
    for k, size in enumerate([14, 2] * 5)
]


def cells_with_holes() -> Grid:
    shapely = pytest.importorskip("shapely")
    ring = shapely.Polygon([(-80, -30), (-20, -35), (-30, 20), (-75, 25)]).difference(
        shapely.box(-60, -10, -40, 5)
    )
    return Grid.from_polygons([shapely.Polygon(STAR), ring])


GRIDS: dict[str, Callable[[], Grid]] = {
    "healpix": lambda: Grid.from_healpix(4),
    "rows": lambda: rows(20, 11),
    "reduced": lambda: Grid.from_gaussian(8, "octahedral"),
    "voronoi": lambda: Grid.from_voronoi(Voronoi(xyz=sites(200, 5))),
    "wide": lambda: Grid.from_lonlat([0, 120, 240, 360], [-90, 0, 90]),
    "holes": cells_with_holes,
}


def units(grid: Grid) -> Floats:
    lon, lat = np.radians(grid.centers_lonlat.T)
    return np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))


@pytest.mark.parametrize("target", GRIDS)
@pytest.mark.parametrize("source", GRIDS)
def test_moments_of_parts_add_to_those_of_cells(source: str, target: str) -> None:
    one, two = GRIDS[source](), GRIDS[target]()
    overlaps = Overlaps(one, two)
    row = np.repeat(np.arange(two.ncells), np.diff(overlaps.indptr))
    cell = overlaps.indices.astype(np.int64)
    centers = units(one)
    parts = moments_of_parts(one, two, cell, row, centers[cell])
    sums = np.stack([np.bincount(cell, parts[:, k], one.ncells) for k in range(3)], axis=1)
    away = np.abs(sums - moments_of_cells(one, centers)).max(axis=1) / one.areas**1.5
    whole = np.abs(overlaps.covered_source - 1) < 1e-9
    assert away[whole].max(initial=0) < 1e-12
    # From both sides, the same parts.
    back = moments_of_parts(two, one, row, cell, centers[cell])
    assert np.abs(back - parts).max() < 1e-14


def test_moments_by_their_integrals() -> None:
    # Of a cell between meridians and parallels, by hand.
    grid = Grid.from_lonlat([20, 50], [10, 40])
    w, e, s, n = np.radians([20, 50, 10, 40])
    high = (n - s) / 2 + (math.sin(2 * n) - math.sin(2 * s)) / 4
    wanted = np.array(
        [
            high * (math.sin(e) - math.sin(w)),
            high * (math.cos(w) - math.cos(e)),
            (e - w) * (math.sin(n) ** 2 - math.sin(s) ** 2) / 2,
        ]
    )
    center = units(grid)
    wanted -= (wanted @ center[0]) * center[0]
    assert np.allclose(moments_of_cells(grid, center)[0], wanted, rtol=0, atol=1e-16)
    # Of polygons, by many small cells.
    polygons = cells_with_holes()
    fine = rows(1440, 720)
    overlaps = Overlaps(fine, polygons)
    places = units(fine)[overlaps.indices] * overlaps.areas[:, None]
    row = np.repeat([0, 1], np.diff(overlaps.indptr))
    centers = units(polygons)
    for k in range(2):
        total = places[row == k].sum(axis=0)
        total -= (total @ centers[k]) * centers[k]
        found = moments_of_cells(polygons, centers)[k]
        assert np.allclose(found, total, rtol=0, atol=2e-6)


def test_a_side_that_reaches_a_parallel_twice() -> None:
    # The side between the corners at 40 degrees goes as far as 44 degrees.
    one = Grid.from_mesh(lonlat=[[(0, 40), (30, 20), (60, 40)]])
    two = Grid.from_lonlat([0, 60], [41, 50])
    fine = Grid.from_lonlat(np.linspace(0, 60, 301), np.linspace(41, 45, 81))
    overlaps = Overlaps(one, fine)
    row = np.repeat(np.arange(fine.ncells), np.diff(overlaps.indptr))
    wanted = (units(fine)[row] * overlaps.areas[:, None]).sum(axis=0)
    center, zero = units(two), np.zeros(1, dtype=np.int64)
    wanted -= (wanted @ center[0]) * center[0]
    found = moments_of_parts(one, two, zero, zero, center)[0]
    assert np.abs(found).max() > 1e-5
    assert np.allclose(found, wanted, rtol=0, atol=1e-6)


@pytest.mark.parametrize("size", [1e-2, 1e-4, 1e-6])
def test_moments_of_small_cells(size: float) -> None:
    lon, lat = np.meshgrid(np.arange(5) * size, 40 + np.arange(4) * size)
    one = Grid.from_curvilinear(lon + lat * 0.3, lat, merge=0)
    steps = np.meshgrid(12 + np.arange(-2, 9) * size * 0.9, 40 + np.arange(-3, 9) * size * 0.7)
    two = Grid.from_curvilinear(*steps, merge=0)
    overlaps = Overlaps(one, two)
    assert np.abs(overlaps.covered_source - 1).max() < 1e-12
    row = np.repeat(np.arange(two.ncells), np.diff(overlaps.indptr))
    cell = overlaps.indices.astype(np.int64)
    centers = units(one)
    parts = moments_of_parts(one, two, cell, row, centers[cell])
    sums = np.stack([np.bincount(cell, parts[:, k], one.ncells) for k in range(3)], axis=1)
    away = np.abs(sums - moments_of_cells(one, centers)).max() / one.areas.max() ** 1.5
    # Coordinates of corners are rounded to 1e-16.
    assert away < 1e-14 + 1e-15 / math.radians(size)


def means(grid: Grid) -> Floats:
    """The means of 2 + cos(lat)^2 cos(2 lon) over cells between meridians and parallels."""
    assert grid.bounds is not None
    lon, lat = (np.radians(edges) for edges in grid.bounds)
    east = np.diff(np.sin(2 * lon)) / (2 * np.diff(lon))
    sine = np.sin(lat)
    north = np.diff(sine - sine**3 / 3) / np.diff(sine)
    return 2 + north[:, None] * east


@pytest.mark.parametrize(("order", "least", "most"), [(1, 1.7, 2.5), (2, 3.4, 6.0)])
def test_errors_have_their_order(order: int, least: float, most: float) -> None:
    errors = []
    for n in (1, 2, 4):
        source, target = rows(36 * n, 18 * n), rows(50 * n, 23 * n)
        weights = Overlaps(source, target).to_weights("conservative", order=order)
        away = (weights.apply(means(source)) - means(target)).ravel()
        errors.append(math.sqrt((away**2 * target.areas).sum()))
    assert least < errors[0] / errors[1] < most
    assert least < errors[1] / errors[2] < most


@pytest.mark.parametrize("limiter", [False, True])
@pytest.mark.parametrize("target", ["rows", "voronoi", "reduced"])
def test_totals_and_constants(target: str, limiter: bool) -> None:
    source = Grid.from_healpix(8)
    wanted = GRIDS[target]()
    field = np.random.default_rng(4).normal(size=(2, source.ncells))
    weights = Overlaps(source, wanted).to_weights(order=2, limiter=limiter)
    for one, two in zip(field, weights.apply(field), strict=True):
        before = math.fsum(one * source.areas)
        after = math.fsum(two.ravel() * wanted.areas)
        assert abs(after - before) < 1e-14 * math.fsum(abs(one) * source.areas)
    normal = Overlaps(source, wanted).to_weights("normalized", order=2, limiter=limiter)
    assert np.unique(normal.apply(np.full(source.ncells, 0.1))).tolist() == [0.1]


@pytest.mark.parametrize("method", ["conservative", "normalized"])
def test_the_matrix_is_that_of_fields(method: str) -> None:
    source, target = (
        Grid.from_healpix(4),
        Grid.from_lonlat(np.arange(0, 91, 7), np.arange(0, 61, 7)),
    )
    weights = Overlaps(source, target).to_weights(method, order=2)
    field = np.random.default_rng(2).normal(size=source.ncells)
    found = weights.matrix @ field
    assert np.allclose(found, weights.apply(field).ravel(), rtol=0, atol=1e-13)
    assert weights.order == 2
    assert not weights.limited


def test_a_limiter_makes_no_extremes() -> None:
    source, target = Grid.from_healpix(8), rows(100, 49)
    jump = (source.centers_lonlat[:, 0] > 20).astype(float)
    overlaps = Overlaps(source, target)
    free = overlaps.to_weights(order=2).apply(jump)
    assert free.max() > 1.01
    assert free.min() < -0.01
    limited = overlaps.to_weights(order=2, limiter=True)
    found = limited.apply(jump)
    assert found.max() < 1 + 1e-12
    assert found.min() > -1e-12
    # Slopes that need no limit remain, so errors are far below those of first order.
    means = Overlaps(rows(360, 180), source).to_weights("normalized")
    smooth = 2 + np.cos(np.radians(rows(360, 180).centers_lonlat[:, 1]))
    wanted = Overlaps(rows(360, 180), target).to_weights("normalized").apply(smooth)
    field = means.apply(smooth)
    one = np.abs(overlaps.to_weights().apply(field) - wanted).mean()
    assert np.abs(limited.apply(field) - wanted).mean() < 0.3 * one


def test_missing_values_and_masks() -> None:
    source, target = Grid.from_healpix(8), rows(36, 18)
    overlaps = Overlaps(source, target)
    rng = np.random.default_rng(1)
    field = 2 + rng.random(source.ncells)
    there = rng.random(source.ncells) < 0.8
    holes = np.where(there, field, np.nan)
    # What is there is conserved.
    weights = overlaps.to_weights(order=2)
    total = math.fsum((field * source.areas)[there])
    masked = overlaps.to_weights(order=2, source_mask=there)
    for found in (weights.apply(holes, skipna=True), masked.apply(field)):
        sums = math.fsum(np.nan_to_num(found.ravel()) * target.areas)
        assert sums == pytest.approx(total, rel=1e-14)
    # A constant remains one, and NaN reaches no further than in first order.
    normal = overlaps.to_weights("normalized", order=2, limiter=True)
    found = normal.apply(np.where(there, 3.0, np.nan), skipna=True)
    assert set(found[~np.isnan(found)]) == {3.0}
    first = overlaps.to_weights().apply(holes)
    assert np.array_equal(np.isnan(weights.apply(holes)), np.isnan(first))
    assert np.array_equal(
        np.isnan(weights.apply(holes, skipna=True, min_fraction=0.9)),
        np.isnan(overlaps.to_weights().apply(holes, skipna=True, min_fraction=0.9)),
    )


def test_files_and_pickles(tmp_path: Path) -> None:
    overlaps = Overlaps(Grid.from_healpix(4), rows(20, 11))
    field = np.random.default_rng(8).normal(size=192)
    for limiter in (False, True):
        weights = overlaps.to_weights(order=2, limiter=limiter)
        again = pickle.loads(pickle.dumps(weights))
        assert repr(again) == repr(weights)
        assert np.array_equal(again.apply(field), weights.apply(field))
    weights = overlaps.to_weights(order=2)
    weights.to_netcdf(tmp_path / "map.nc")
    read = Weights.from_netcdf(tmp_path / "map.nc")
    assert np.allclose(read.apply(field), weights.apply(field), rtol=0, atol=1e-14)
    with pytest.raises(delone.InputError, match="limited slopes"):
        overlaps.to_weights(order=2, limiter=True).to_netcdf(tmp_path / "no.nc")
    overlaps.save(tmp_path / "shared.npz")
    with pytest.raises(delone.InputError, match="needs the grids"):
        Overlaps.load(tmp_path / "shared.npz").to_weights(order=2)


def test_regridders() -> None:
    xarray = pytest.importorskip("xarray")
    from delone.xarray import Regridder

    source = rows(36, 18)
    field = xarray.DataArray(means(source)[None], dims=("time", "lat", "lon"), name="t")
    errors = {}
    for order in (1, 2):
        made = Regridder(source, "7.5x7.5", order=order, dims=("lat", "lon"))
        errors[order] = np.abs(made(field).values - means(made.target)).mean()
    assert errors[2] < 0.2 * errors[1]
    lazy = made(field.chunk({"time": 1}))
    assert np.allclose(lazy.values, made(field).values, rtol=1e-14)
    assert "second order" in repr(made.weights)


def test_a_row_of_cells_has_slopes_along_it() -> None:
    source = Grid.from_lonlat([0, 1, 2, 3, 4], [-1, 1])
    target = Grid.from_lonlat([1, 1.5, 2.5, 3], [-1, 1])
    found = Overlaps(source, target).to_weights(order=2).apply([[0.0, 2.0, 4.0, 6.0]])
    assert np.allclose(found, [[1.5, 3.0, 4.5]], rtol=0, atol=1e-3)


ONE = Grid.from_lonlat([0, 1], [-1, 1])
LINE = Grid.from_lonlat([0, 1, 2, 3], [-1, 1])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Overlaps(LINE, LINE).to_weights("sum", order=2), "order=2 is for conservative"),
        (lambda: Overlaps(LINE, LINE).to_weights(order=3), "order must be"),
        (lambda: Overlaps(LINE, LINE).to_weights(limiter=True), "limiter is for order=2"),
        (lambda: Overlaps(ONE, LINE).to_weights(order=2), "needs source cells with neighbors"),
    ],
)
def test_what_is_refused(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(delone.InputError, match=message):
        call()


def test_pairs_beyond_the_first_lot(monkeypatch: pytest.MonkeyPatch) -> None:
    source, target = Grid.from_healpix(4), Grid.from_lonlat(range(0, 361, 30), range(-90, 91, 30))
    field = np.random.default_rng(5).random(source.ncells)
    wanted = Overlaps(source, target).to_weights("conservative", order=2).apply(field)
    monkeypatch.setattr("delone.sphere.moments._LOT", 7)
    found = Overlaps(source, target).to_weights("conservative", order=2).apply(field)
    # Equal up to rounding.
    assert np.allclose(found, wanted, rtol=1e-12, atol=0)
