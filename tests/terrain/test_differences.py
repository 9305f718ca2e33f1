"""Differences of rasters: from rasters, surfaces and planes; what is refused, with its cure."""

import re
from fractions import Fraction

import numpy as np
import pytest

from delone import CRSWarning, FileFormatError, InputError, datasets
from delone.interpolate import Grid
from delone.io import write_raster
from delone.terrain import TIN, difference

X, Y = np.arange(6.0) * 2 + 100, np.arange(4.0) * 3 + 50


def grid(seed=0, holes=()):
    values = np.random.default_rng(seed).integers(0, 1000, (4, 6)) / 8
    for hole in holes:
        values[hole] = np.nan
    return Grid(values, X, Y)


def test_differences_are_those_of_fractions():
    a, b = grid(0, [(0, 1), (2, 2)]), grid(1, [(2, 2), (3, 5)])
    found = difference(a, b)
    assert (found.missing, found.missing_other, found.count) == (2, 2, 21)
    exact = [
        Fraction(p) - Fraction(q)
        for p, q in zip(a.values.ravel().tolist(), b.values.ravel().tolist(), strict=True)
        if np.isfinite(p) and np.isfinite(q)
    ]
    values = found.values
    assert [Fraction(v) for v in values[np.isfinite(values)].tolist()] == exact
    assert Fraction(found.cut) == 6 * sum(e for e in exact if e > 0)
    assert Fraction(found.fill) == -6 * sum(e for e in exact if e < 0)
    assert (found.net, found.area) == (found.fill - found.cut, 21 * 6)
    assert (found.min, found.max) == (min(exact), max(exact))
    assert found.mean == pytest.approx(float(sum(exact) / 21), rel=1e-15)
    assert found.rms == pytest.approx(float(sum(e * e for e in exact) / 21) ** 0.5)


def test_planes_and_heights():
    a = grid()
    assert (difference(a, 2.5).values == a.values - 2.5).all()
    plane = 0.5 * X[None, :] - 0.25 * Y[:, None] + 3
    assert (difference(a, (0.5, -0.25, 3)).values == a.values - plane).all()
    with pytest.raises(InputError, match="a height, or a plane"):
        difference(a, (1, 2))


def test_surfaces_are_asked_at_centers():
    a = grid()
    tin = TIN.from_points([(99, 49, 1), (107, 49, 5), (107, 70, 9), (99, 70, 7)], units="ft")
    found = difference(a, tin)
    assert found.missing_other == 8
    assert found.units == "ft"
    outside = X > 107
    assert np.isnan(found.values[:, outside]).all()
    nodes = np.stack(np.meshgrid(X, Y), axis=-1)
    left = (a.values - tin.heights(nodes))[:, ~outside]
    assert (found.values[:, ~outside] == left).all()
    with pytest.raises(InputError, match="multiply"):
        difference(a, tin, units="m")


def test_rasters_with_the_same_cells_in_any_order():
    a, b = grid(0), grid(1)
    plain = difference(a, b)
    turned = Grid(b.values[::-1, ::-1], X[::-1], Y[::-1])
    assert (difference(a, turned).values == plain.values).all()
    backward = difference(turned, a)
    assert (backward.values == -plain.values).all()
    assert (backward.x == X).all()
    assert (backward.y == Y).all()
    near = Grid(b.values, X + 1e-7, Y)
    assert (difference(a, near).values == plain.values).all()


def test_other_cells_are_refused_with_bounds_that_work():
    a = grid()
    other = Grid(np.zeros((3, 4)), np.arange(4.0) * 2 + 104, np.arange(3.0) * 3 + 47)
    with pytest.raises(InputError, match="cells in common") as caught:
        difference(a, other)
    box = re.search(r"bounds=\((.*?)\)", str(caught.value))[1]
    found = difference(a, other, bounds=[float(part) for part in box.split(",")])
    assert found.x.tolist() == [104, 106, 108, 110]
    assert found.y.tolist() == [50, 53]
    assert (found.values == a.values[:2, 2:]).all()
    # Half a cell aside, and finer: no cell is the same.
    for x in (X + 1, np.linspace(100, 110, 11), X + 1e-3):
        odd = Grid(np.zeros((4, len(x))), x, Y)
        with pytest.raises(InputError, match=r"TIN\.from_raster\(other\)"):
            difference(a, odd)
        found = difference(a, TIN.from_raster(odd))
        assert np.nansum(np.abs(found.values - a.values)) == 0


def test_files_with_reference_systems(tmp_path):
    a, b = grid(0, [(1, 1)]), grid(1, [(0, 0)])
    tif, nc, other = (tmp_path / name for name in ("a.tif", "b.nc", "c.tif"))
    write_raster(tif, a, crs="EPSG:28992")
    write_raster(nc, b, crs="EPSG:28992")
    write_raster(other, b, crs="EPSG:31370")
    found = difference(tif, nc)
    plain = difference(a, b)
    assert np.array_equal(found.values, plain.values, equal_nan=True)
    assert (found.missing, found.missing_other) == (1, 1)
    assert found.crs == "EPSG:28992"
    assert found.area_units == "m2"
    with pytest.raises(InputError, match=r"28992.*31370.*gdalwarp"):
        difference(tif, other)
    with pytest.warns(CRSWarning):
        assert difference(tif, b).crs == "EPSG:28992"
    assert difference(tif, b, crs="EPSG:28992").crs == "EPSG:28992"
    assert difference(tif, nc, other_band="z").count == plain.count
    with pytest.raises(FileFormatError, match="no band 2"):
        difference(tif, nc, band=2)
    with pytest.raises(InputError, match="bands are for files"):
        difference(a, b, band=1)


def test_arrays_of_xarray(tmp_path):
    a, b = grid(0), grid(1)
    found = difference(a.to_xarray(crs="EPSG:28992"), b.to_xarray(crs="EPSG:28992").T)
    assert (found.values == a.values - b.values).all()
    assert found.crs == "EPSG:28992"


def test_rotated_rasters_are_refused(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    path = tmp_path / "turned.tif"
    with rasterio.open(
        path, "w", driver="GTiff", count=1, height=4, width=6, dtype="float64",
        transform=rasterio.Affine(2, 1, 100, 1, -2, 60),
    ) as file:  # fmt: skip
        file.write(np.zeros((4, 6)), 1)
    with pytest.raises(FileFormatError, match="rotated"):
        difference(path, 0.0)


def test_a_constant_for_no_height_is_not_a_height():
    values = grid().values.copy()
    values[1, 2] = -9999
    with pytest.raises(InputError, match="nodata"):
        difference(Grid(values, X, Y), 0.0)
    found = difference(Grid(values, X, Y), 0.0, nodata=-9999)
    assert found.missing == 1
    assert found.min >= 0


def test_cells_in_degrees_have_no_area():
    found = difference(grid(), 1.0, crs="EPSG:4326")
    assert found.count == 24
    with pytest.raises(InputError, match="degrees"):
        _ = found.cut


def test_a_real_survey_against_its_own_raster():
    sample = datasets.ahn3()
    ground = sample.attributes["classification"] == 2
    tin = TIN.from_points(np.column_stack((sample.points, sample.z))[ground][::9])
    dem = tin.raster(resolution=1)
    found = difference(dem, tin)
    assert found.missing == found.missing_other > 0
    assert found.min == found.max == 0
    inner = TIN.from_points(tin.xyz, boundary=[np.array(dem.extent)[[[0, 2], [1, 2], [1, 3]]] + 9])
    part = difference(dem, inner)
    assert part.missing == found.missing < part.missing_other
    assert difference(dem, 0.0).net == pytest.approx(tin.volume_to(0.0).net, rel=0.01)


def test_no_cell_in_common():
    empty = Grid(np.full((4, 6), np.nan), X, Y)
    found = difference(empty, 0.0)
    assert (found.count, found.missing, found.cut) == (0, 24, 0)
    assert np.isnan([found.min, found.mean, found.rms]).all()
    with pytest.raises(InputError, match="no cell"):
        found.plot()


def test_colors_are_white_at_zero():
    values = np.array([[-4.0, 0.0, 2.0]])
    ax = difference(Grid(values, X[:3], Y[:1]), 0.0).plot(limit=4, colorbar=False)
    image = np.asarray(ax.images[0].get_array())[0]
    assert image[1, :3].min() > 240
    assert image[0, 2] > image[0, 0]
    assert image[2, 0] > image[2, 2]
    with pytest.raises(InputError, match="limit"):
        difference(grid(), 0.0).plot(limit=-1)


def test_arguments_stay_as_they_are(tmp_path):
    a, b = grid(0), grid(1)
    found = difference(a, b)
    write_raster(tmp_path / "d.tif", found)
    assert a.values.flags.writeable
    assert X.flags.writeable
    assert not found.values.flags.writeable
    assert (difference(tmp_path / "d.tif", found).values == 0).all()
