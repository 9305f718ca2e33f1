"""Bilinear weights on quadrilaterals between centers: definitions, poles, repeated cells, masks."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
from delone import sphere
from delone.sphere import Grid, Voronoi, Weights
from delone.sphere.quadrilaterals import _in_four

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

TARGET = Grid.from_lonlat(np.arange(-180, 181, 7), np.arange(-90, 91, 6))


SMALL = Grid.from_lonlat([-0.2, 0.2], [-0.1, 0.2])


def units(lonlat: Floats) -> Floats:
    lon, lat = np.radians(np.asarray(lonlat, dtype=float).T)
    return np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))


def lonlat_of(xyz: Floats) -> Floats:
    x, y, z = np.moveaxis(xyz, -1, 0)
    return np.degrees(np.stack((np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))), axis=-1))


def rotated(seed: int) -> Floats:
    found: Floats = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return found * np.sign(np.linalg.det(found))


def sites(count: int) -> Floats:
    return np.random.default_rng(2).normal(size=(count, 3))


def corners(across: int, up: int, *, south: float = -90, north: float = 90) -> Floats:
    lon, lat = np.meshgrid(np.linspace(0, 360, across + 1), np.linspace(south, north, up + 1))
    return np.stack((lon, lat), axis=-1)


def curvilinear(lonlat: Floats, seed: int | None = None) -> Grid:
    if seed is not None:
        lonlat = lonlat_of(units(lonlat.reshape(-1, 2)) @ rotated(seed).T).reshape(lonlat.shape)
    return Grid.from_curvilinear(lonlat[..., 0], lonlat[..., 1])


def dipole() -> Grid:
    """An ocean grid whose northern pole is moved to Greenland, as far as the south of the sea."""
    at = corners(48, 30, south=-78, north=88)
    xyz = units(at.reshape(-1, 2))
    pole = units([(-40, 75)])[0]
    xyz += 0.45 * pole * (1 + xyz[:, 2:]) / 2
    return curvilinear(lonlat_of(xyz).reshape(at.shape))


GRIDS: dict[str, Callable[[], Grid]] = {
    "turned": lambda: curvilinear(corners(36, 18), 1),
    "dipole": dipole,
    "clockwise": lambda: curvilinear(corners(36, 18)[::-1]),
    "healpix": lambda: Grid.from_healpix(8),
    "voronoi": lambda: Grid.from_voronoi(Voronoi(xyz=sites(500))),
}


@pytest.mark.parametrize("name", GRIDS)
def test_weights_are_of_the_patch_that_is_seen_at_the_target(name: str) -> None:
    source = GRIDS[name]()
    weights = Weights.between(source, TARGET, "bilinear")
    assert weights.values.min() > 0
    centers, places = units(source.centers_lonlat), units(TARGET.centers_lonlat)
    counts = np.diff(weights.indptr)
    assert set(counts.tolist()) <= {0, 1, 2, 3, 4, 36, 48}
    kinds = 0
    for row in np.flatnonzero(counts):
        part = slice(weights.indptr[row], weights.indptr[row + 1])
        cells, values = weights.indices[part], weights.values[part]
        assert values.sum() == pytest.approx(1, abs=1e-14)
        if len(cells) > 4:
            continue
        # The combination of the centers points at the target.
        seen = values @ centers[cells]
        assert np.linalg.norm(np.cross(seen, places[row])) < 1e-13
        assert seen @ places[row] > 0
        if len(cells) == 4:
            # Of products (1 - s) (1 - t), s (1 - t), s t, (1 - s) t, opposite ones agree.
            pairs = [values[0] * values[k] for k in (1, 2, 3)]
            rest = [np.prod(values[1:]) / values[k] for k in (1, 2, 3)]
            assert np.isclose(pairs, rest, rtol=1e-9).any()
            kinds += 1
    assert (kinds > 400) == (name != "voronoi")
    # At its own centers a field is itself, bit for bit.
    own = Weights.between(source, source, "bilinear")
    there = own.fractions > 0
    assert (own.values[np.repeat(there, np.diff(own.indptr))] == 1).all()
    assert there.all() or name == "dipole"
    field = np.random.default_rng(0).normal(size=source.ncells)
    assert np.allclose(own.apply(field).ravel()[there], field[there], rtol=0, atol=1e-15 * 8)


def test_triangles_of_a_voronoi_diagram_are_those_of_linear() -> None:
    source = GRIDS["voronoi"]()
    # Many triangles of the centers are those of the sites.
    one = Weights.between(source, TARGET, "bilinear")
    assert (one.fractions == 1).all()
    mesh = sphere.Delaunay(lonlat=source.centers_lonlat)
    found = np.sort(one.indices.reshape(-1, 3), axis=1)
    known = {tuple(row) for row in np.sort(mesh.simplices, axis=1).tolist()}
    common = [tuple(row) in known for row in found.tolist()]
    linear = Weights.between(source, TARGET, "linear").matrix.toarray()
    own = one.matrix.toarray()
    assert sum(common) > 700
    assert np.allclose(own[common], linear[common], rtol=0, atol=1e-12)


def test_the_whole_sphere_with_poles_and_the_seam() -> None:
    source = curvilinear(corners(36, 18))
    target = Grid.from_lonlat(np.arange(0, 361, 3), np.arange(-90, 91, 1))
    weights = Weights.between(source, target, "bilinear")
    assert (weights.fractions == 1).all()
    # As between meridians and parallels, toward a pole to the mean of the last row.
    other = Weights.between(
        Grid.from_lonlat(np.arange(0, 361, 10), np.arange(-90, 91, 10)), target, "bilinear"
    )
    field = units(source.centers_lonlat) @ [0.3, 0.2, 0.5]
    # Great circles are not parallels.
    assert np.abs(weights.apply(field) - other.apply(field)).max() < 0.01
    wave = np.cos(np.radians(source.centers_lonlat[:, 0]))
    assert np.abs(weights.apply(wave)[[0, -1]]).max() < 0.2
    at_pole = Weights.between(source, Grid.from_mesh(lonlat=[[(x, 85) for x in (0, 90, 180, 270)]]),
                              "bilinear")  # fmt: skip
    assert np.array_equal(at_pole.indices, np.arange(612, 648))
    assert np.allclose(at_pole.values, 1 / 36, rtol=1e-12)
    # At the seam, columns 35 and 0.
    seam = Weights.between(source, Grid.from_lonlat([-1, 1], [3, 5]), "bilinear")
    assert set(seam.indices % 36) == {0, 35}
    assert np.allclose(seam.matrix.sum(axis=1), 1)


def test_columns_and_rows_that_ocean_grids_repeat() -> None:
    plain = corners(36, 17, south=-80, north=90)
    once = curvilinear(plain)
    wide = np.concatenate((plain[:, -2:-1], plain, plain[:, 1:2]), axis=1)
    twice = curvilinear(wide)
    assert twice.grid_shape == (17, 38)
    field = np.random.default_rng(3).normal(size=(17, 36))
    repeated = np.concatenate((field[:, -1:], field, field[:, :1]), axis=1)
    one = Weights.between(once, TARGET, "bilinear")
    two = Weights.between(twice, TARGET, "bilinear")
    close = {"rtol": 0, "atol": 1e-12, "equal_nan": True}
    assert np.allclose(one.apply(field), two.apply(repeated), **close)
    # The copies are masked, as in files, or the originals.
    for columns in ((0, 37), (1, 36)):
        mask = np.ones((17, 38), dtype=bool)
        mask[:, columns] = False
        part = Weights.between(twice, TARGET, "bilinear", source_mask=mask)
        assert np.allclose(part.apply(repeated), one.apply(field), **close)


def test_a_fold_joins_the_last_row_to_itself() -> None:
    # The northern edge of a tripolar grid: the middle of it is folded onto its other half.
    x = np.array([0, 1, 2, 3, 4, 3, 2, 1, 0], dtype=float)
    y = np.array([0, 0, 0, 0, 0, 0, 0, 0, 0], dtype=float)
    side = np.array([-2, -2, -2, -2, 0, 2, 2, 2, 2], dtype=float)
    lon, lat = np.stack((x, x)), np.stack((side, y))
    lon[0, 4] = 6
    source = Grid.from_curvilinear(lon, lat)
    target = Grid.from_lonlat([1.4, 1.6], [-0.1, 0.1])
    weights = Weights.between(source, target, "bilinear")
    assert weights.fractions.item() == 1
    # Both halves contribute equally at the edge.
    assert weights.apply(np.where(np.arange(8) < 4, 1.0, 3.0)).item() == pytest.approx(2)
    assert sorted(weights.indices[weights.values > 1e-9]) == [1, 6]


def test_concave_quadrilaterals_are_two_triangles() -> None:
    rng = np.random.default_rng(5)
    base = corners(9, 9, south=-30, north=30) * [0.2, 1]
    source = curvilinear(base + rng.uniform(-2.2, 2.2, size=base.shape))
    target = Grid.from_lonlat(np.arange(5, 66, 0.5), np.arange(-25, 26, 0.5))
    weights = Weights.between(source, target, "bilinear")
    centers = units(source.centers_lonlat)
    seen = np.asarray(weights.matrix @ centers)
    there = weights.fractions > 0
    assert there.mean() > 0.9
    away = np.cross(seen, units(target.centers_lonlat))[there]
    assert np.abs(away).max() < 1e-13
    # An arrow: the third corner of four is inside the triangle of the others.
    for order in ([0, 1, 2, 3], [0, 3, 2, 1], [2, 3, 0, 1], [1, 2, 3, 0]):
        places = units([(0, 0), (10, 0), (2, 2), (0, 10)])
        queries = units([(1, 1), (5, 1), (1, 5), (4, 4), (0, 0), (2, 2)])
        inside, found = _in_four(places, queries, np.tile(order, (6, 1)), None)
        assert inside.tolist() == [True, True, True, False, True, True]
        assert (found[4, order.index(0)], found[5, order.index(2)]) == (1, 1)
        assert (np.count_nonzero(found[:3], axis=1) <= 3).all()
        away = np.cross(found[:3] @ places[order], queries[:3])
        assert np.abs(away).max() < 1e-15


def test_masks_and_regions() -> None:
    region = curvilinear(corners(36, 18)[4:10, 3:12], 4)
    weights = Weights.between(region, TARGET, "bilinear")
    assert 20 < (weights.fractions > 0).sum() < 200
    near = Weights.between(region, TARGET, "bilinear", extrapolate="nearest")
    assert (near.fractions == 1).all()
    mask = np.ones(region.ncells, dtype=bool)
    mask[[9, 20]] = False
    part = Weights.between(region, TARGET, "bilinear", source_mask=mask)
    assert not np.isin(part.indices, [9, 20]).any()
    lost = np.isin(weights.indices, [9, 20])
    rows = np.unique(np.repeat(np.arange(TARGET.ncells), np.diff(weights.indptr))[lost])
    assert len(rows)
    expected = weights.fractions > 0
    expected[rows] = False
    assert np.array_equal(part.fractions > 0, expected)


@pytest.mark.parametrize("size", [1e-2, 1e-5, 1e-7])
def test_small_cells(size: float) -> None:
    # In degrees: from a kilometer to a centimeter.
    rng = np.random.default_rng(6)
    x, y = np.meshgrid(np.arange(7.0), np.arange(7.0))
    lon, lat = x + 0.3 * y, y + 0.1 * rng.uniform(-1, 1, x.shape)
    source = Grid.from_curvilinear(10 + size * lon, 60 + size * lat)
    target = Grid.from_lonlat(10 + size * np.array([3.6, 3.7, 3.9]), 60 + size * np.array([2, 3.1]))
    weights = Weights.between(source, target, "bilinear")
    assert (weights.fractions == 1).all()
    field = source.centers_lonlat[:, 1] - 60
    wanted = target.centers_lonlat[:, 1] - 60
    assert np.allclose(weights.apply(field).ravel(), wanted, rtol=0, atol=1e-3 * size + 1e-14)


def test_what_has_no_quadrilaterals() -> None:
    apart = Grid.from_mesh(lonlat=[[(0, 0), (1, 0), (1, 1)], [(5, 5), (6, 5), (6, 6)]])
    with pytest.raises(delone.InputError, match="no corner of this one has cells on all sides"):
        Weights.between(apart, TARGET, "bilinear")
    with pytest.raises(delone.InputError, match="which those of reduced grids have not"):
        Weights.between(Grid.from_gaussian(4, "octahedral"), TARGET, "bilinear")


def test_the_direction_of_each_cell_and_overlaps() -> None:
    at = corners(36, 18)
    around = np.stack((at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]), axis=2).reshape(
        -1, 4, 2
    )
    some = around.copy()
    some[::3] = some[::3, ::-1]
    weights = Weights.between(Grid.from_mesh(lonlat=some), TARGET, "bilinear")
    field = np.random.default_rng(1).normal(size=648)
    wanted = Weights.between(Grid.from_mesh(lonlat=around), TARGET, "bilinear").apply(field)
    assert np.allclose(weights.apply(field), wanted, rtol=0, atol=1e-12)
    # Two times four cells around one corner: they overlap, so none is between the others.
    cells = []
    for turn in (0, 30):
        x, y = np.cos(np.radians(turn)), np.sin(np.radians(turn))
        for p, q in ((x, y), (-y, x)), ((-y, x), (-x, -y)), ((-x, -y), (y, -x)), ((y, -x), (x, y)):
            cells.append([(0, 0), p, (p[0] + q[0], p[1] + q[1]), q])
    with pytest.raises(delone.InputError, match="no corner of this one"):
        Weights.between(Grid.from_mesh(lonlat=cells), TARGET, "bilinear")
    assert Weights.between(Grid.from_mesh(lonlat=cells[:4]), SMALL, "bilinear").fractions.all()


def test_corners_beyond_360_degrees_are_no_mistake() -> None:
    x, y = np.meshgrid(np.arange(-4.0, 365, 8), [0.0, 5])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made = Grid.from_curvilinear(x, y)
        other = Grid.from_mesh(lonlat=[[(-4, 0), (4, 0), (360, 9)]])
    assert made.areas.sum() == pytest.approx(46 * made.areas[0])
    assert other.ncells == 1


def test_datasets_and_files(tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    from delone.xarray import Regridder

    at = corners(36, 18)
    source = curvilinear(at)
    lon, lat = source.centers_lonlat.T.reshape(2, 18, 36)
    ds = xarray.Dataset(
        {"t": (("j", "i"), units(source.centers_lonlat)[:, 2].reshape(18, 36))},
        coords={
            "lon": (("j", "i"), lon, {"units": "degrees_east"}),
            "lat": (("j", "i"), lat, {"units": "degrees_north"}),
            "lon_b": (("jb", "ib"), at[..., 0]),
            "lat_b": (("jb", "ib"), at[..., 1]),
        },
    )
    made = Regridder(ds, "6x6", method="bilinear")
    found = made(ds)
    wanted = np.sin(np.radians(made.target.centers_lonlat[:, 1])).reshape(30, 60)
    assert np.abs(found.t.values - wanted).max() < 0.01
    made.weights.to_netcdf(tmp_path / "map.nc", source=made.source, target=made.target)
    assert Weights.from_netcdf(tmp_path / "map.nc").method == "bilinear"
