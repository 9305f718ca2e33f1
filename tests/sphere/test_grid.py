"""Grids of cells: constructors, what they report, and what they refuse."""

from __future__ import annotations

import pickle
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import sphere
from delone.sphere import Grid
from overlaps import polygon_area

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

LON, LAT = np.arange(0, 361, 30.0), np.arange(-90, 91, 30.0)
SPHERE = 4 * np.pi


def of_the_sphere() -> dict[str, Callable[[], Grid]]:
    sites = np.random.default_rng(4).normal(size=(60, 3))
    return {
        "lonlat": lambda: Grid.from_lonlat(LON, LAT),
        "one column": lambda: Grid.from_lonlat([0, 360], LAT),
        "healpix ring": lambda: Grid.from_healpix(3),
        "healpix nested": lambda: Grid.from_healpix(4, "nested"),
        "gaussian": lambda: Grid.from_gaussian(8),
        "octahedral": lambda: Grid.from_gaussian(8, "octahedral"),
        "reduced": lambda: Grid.from_gaussian(2, [3, 7, 7, 3]),
        "voronoi": lambda: Grid.from_voronoi(sphere.Voronoi(xyz=sites)),
        "curvilinear": lambda: Grid.from_curvilinear(*np.meshgrid(LON, LAT)),
    }


@pytest.mark.parametrize("name", of_the_sphere())
def test_cells_tile_the_sphere(name: str) -> None:
    grid = of_the_sphere()[name]()
    assert abs(grid.areas.sum() / SPHERE - 1) < 4e-15
    faults = grid.validate()
    assert faults
    assert abs(faults.covered - 1) < 4e-15
    assert not len(grid.report.reversed)
    assert grid.ncells == np.prod(grid.grid_shape) == len(grid) == len(grid.areas)
    again = pickle.loads(pickle.dumps(grid))
    assert np.array_equal(again.areas, grid.areas)
    assert (again.grid_shape, again.edges, repr(again)) == (grid.grid_shape, grid.edges, repr(grid))


def test_areas_are_those_of_the_definition() -> None:
    grid = Grid.from_lonlat(LON, LAT)
    sines = np.sin(np.radians(LAT))
    expected = np.diff(sines)[:, None] * np.radians(30.0) * np.ones(12)
    assert np.allclose(grid.areas.reshape(grid.grid_shape), expected, rtol=1e-14, atol=0)
    ring = [(1.0, 0, 0), (1, 1, 0.5), (0, 1, 2)]
    assert Grid.from_mesh([ring]).areas[0] == pytest.approx(float(polygon_area(ring)), rel=1e-15)


def test_the_order_of_bounds_is_that_of_cells() -> None:
    grid = Grid.from_lonlat(LON, LAT)
    for a, b, lon, lat in (
        (1, -1, LON, LAT[::-1]),
        (-1, 1, LON[::-1], LAT),
        (-1, -1, LON[::-1], LAT[::-1]),
    ):
        other = Grid.from_lonlat(lon, lat)
        expected = grid.areas.reshape(grid.grid_shape)[::b, ::a]
        assert np.array_equal(other.areas.reshape(grid.grid_shape), expected)
        centers = grid.centers_lonlat.reshape(6, 12, 2)[::b, ::a]
        assert np.allclose(other.centers_lonlat.reshape(6, 12, 2), centers, atol=1e-12)
    pairs = np.column_stack((LON[:-1], LON[1:])), np.column_stack((LAT[1:], LAT[:-1]))[::-1]
    assert np.array_equal(Grid.from_lonlat(*pairs).areas, Grid.from_lonlat(LON, LAT[::-1]).areas)
    radians = Grid.from_lonlat(np.radians(LON), np.radians(LAT), degrees=False)
    assert np.allclose(radians.areas, grid.areas, rtol=1e-14)


def test_centers_are_halfway_between_bounds() -> None:
    grid = Grid.from_lonlat([100, 200, 300], [0, 60, 90])
    assert grid.centers_lonlat.tolist() == [[150, 30], [-110, 30], [150, 75], [-110, 75]]
    assert grid.bounds is not None
    assert [edges.tolist() for edges in grid.bounds] == [[100, 200, 300], [0, 60, 90]]
    assert Grid.from_healpix(1).bounds is None


def test_corners_beyond_a_pole_by_rounding_are_the_pole() -> None:
    far = np.nextafter(np.float32(90), np.float32(91))
    for kind, degrees in ((np.float64, True), (np.float32, True), (np.float64, False)):
        corners = np.array([[(0, 80), (120, 80), (0, far)], [(0, -80), (0, -far), (120, -80)]])
        wanted = Grid.from_mesh(lonlat=np.clip(corners, -90, 120))
        given = corners.astype(kind) if degrees else np.radians(corners)
        found = Grid.from_mesh(lonlat=given, degrees=degrees)
        assert np.allclose(found.areas, wanted.areas, rtol=1e-12)
        assert (np.abs(found.rings[0][[2, 4]]) == [0, 0, 1]).all()
    lon, lat = np.meshgrid(np.arange(0, 361, 90), [80, far])
    band = Grid.from_curvilinear(lon, lat)
    assert (band.rings[0][:, 2] == 1).sum() == 8
    with pytest.raises(
        delone.DirectionError, match="2 rows have a latitude beyond a pole"
    ) as caught:
        Grid.from_mesh(lonlat=[[(0, 80), (120, 90.0001), (0, 91)]])
    assert caught.value.rows.tolist() == [1, 2]


def test_holes_must_be_inside_their_outer_ring_and_not_in_each_other() -> None:
    shapely = pytest.importorskip("shapely")
    square, lake = [(0, 0), (10, 0), (10, 10), (0, 10)], [(2, 2), (8, 2), (8, 8)]
    good = shapely.Polygon(square, [lake])
    # Holes may touch the outer ring and each other; islands may lie in them.
    touching = shapely.Polygon(square, [[(0, 0), (5, 1), (5, 2)], [(5, 2), (6, 3), (5, 4)]])
    island = shapely.MultiPolygon([good, shapely.Polygon([(6, 3), (7, 3), (7, 4)])])
    assert (Grid.from_polygons([good, touching, island]).areas > 0).all()
    for holes in (
        [[(20, 20), (30, 20), (30, 30)]],
        # It touches the outer ring from the other side.
        [[(10, 0), (20, -5), (20, 5)]],
        [lake, [(3, 2.5), (7, 2.5), (7, 5)]],
        [[(3, 2.5), (7, 2.5), (7, 5)], lake],
    ):
        bad = shapely.Polygon(square, holes)
        # Another cell has area there, which does not matter.
        for given in ([good, bad, shapely.box(10, 0, 30, 30)], [good, shapely.reverse(bad)]):
            with pytest.raises(delone.DirectionError, match="1 cell has a hole that") as caught:
                Grid.from_polygons(given)
            assert caught.value.rows.tolist() == [1]


def test_a_latitude_beyond_a_pole_by_rounding_is_the_pole() -> None:
    lat = np.radians(LAT.astype(np.float32)).astype(np.float64)
    grid = Grid.from_lonlat(LON, np.degrees(lat))
    assert abs(grid.areas.sum() / SPHERE - 1) < 1e-14


def test_healpix_orders_have_the_same_pixels() -> None:
    ring, nested = Grid.from_healpix(8), Grid.from_healpix(8, "nested")
    found = [np.round(grid.centers_lonlat, 9) for grid in (ring, nested)]
    order = [np.lexsort(c.T) for c in found]
    assert np.array_equal(found[0][order[0]], found[1][order[1]])
    # Rings of 4, 8, ... pixels go south from the pole, and east from longitude 0.
    lon, lat = found[0].T
    first = np.cumsum([0, *(4 * k for k in range(1, 9))])
    for a, b in pairwise(first):
        assert (np.diff(lon[a:b] % 360) > 0).all()
        assert lat[a:b].min() > lat[b : b + 4].max()
    corners = ring.rings[0].reshape(-1, 4, 3)
    # 12 nside^2 pixels have 2 corners more, shared bit for bit.
    assert len(np.unique(corners.reshape(-1, 3), axis=0)) == 12 * 64 + 2


def test_the_report_names_cells() -> None:
    cells = [
        [(0, 0), (10, 0), (10, 10), (0, 10)],
        [(0, 0), (0, 10), (10, 10), (10, 0)],
        [(0, 0), (10, 0), (10, 0), (10, 10)],
        [(0, 0), (10, 0), (0, 0), (10, 0)],
        [(0, 0), (10, 0), (4, 4), (0, 10)],
    ]
    report = Grid.from_mesh(lonlat=cells).report
    assert report.reversed.tolist() == [1]
    assert report.empty.tolist() == [3]
    assert report.concave.tolist() == [4]
    assert report.repeated == 1
    assert report.merged == 0
    near = np.array(cells, dtype=float)
    near[1] += 1e-13
    grid = Grid.from_mesh(lonlat=near)
    assert grid.report.merged == 4
    assert np.array_equal(grid.areas, Grid.from_mesh(lonlat=cells).areas)
    assert Grid.from_mesh(lonlat=near, merge=0).report.merged == 0


def test_merging_follows_chains() -> None:
    steps = np.arange(5) * 5e-13
    corners = np.column_stack((np.cos(steps), np.sin(steps), np.zeros(5)))
    other = np.tile([(0.0, 1, 0), (0, 0, 1)], (5, 1)).reshape(5, 2, 3)
    cells = np.concatenate((corners[:, None], other), axis=1)
    grid = Grid.from_mesh(cells)
    assert grid.report.merged == 4
    assert len(np.unique(grid.rings[0], axis=0)) == 3


def test_merging_many_copies_and_their_neighbors() -> None:
    # Copies of a corner beside each other on the line, and others that are near one of them.
    corners = np.zeros((3, 4, 3))
    corners[:, 1], corners[:, 2] = (0, 1, 0), (0, 0, 1)
    corners[:, 0], corners[:, 3] = (1, 0, 0), (1, 0, 0)
    for at, shift in (((0, 3), 6e-13), ((1, 0), 0.0), ((2, 0), -6e-13), ((2, 3), 1.2e-12)):
        corners[at] = (1, shift, 0)
    rng = np.random.default_rng(0)
    for _ in range(6):
        grid = Grid.from_mesh(corners[rng.permutation(3)])
        assert len(np.unique(grid.rings[0], axis=0)) == 3
    # A is near B and C, which are not near each other; along the line B is between them.
    u, v = np.array([[0.612, 0.707], [-0.707, 0.612]]) / np.hypot(0.612, 0.707)
    for k, (along, aside) in enumerate([(0, 0), (0.1, 0.95), (0.9, -0.3)]):
        corners[k] = [(1, *(1e-12 * (along * u + aside * v))), (0, 1, 0), (0, 0, 1), (0, 0, 1)]
    assert len(np.unique(Grid.from_mesh(corners).rings[0], axis=0)) == 3
    # All corners of a row at a pole are one.
    lon, lat = np.meshgrid(np.linspace(0, 360, 1441), [80, 85, 90.0])
    grid = Grid.from_curvilinear(lon, lat)
    assert len(np.unique(grid.rings[0], axis=0)) == 2 * 1440 + 1
    assert np.isclose(grid.areas.sum(), 2 * np.pi * (1 - np.sin(np.radians(80))), rtol=1e-5)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (Grid, delone.InputError, "make a Grid with a class method"),
        (lambda: Grid.from_lonlat([0, 1, 1], LAT), delone.InputError, "ascend or descend"),
        (lambda: Grid.from_lonlat([0, 361], LAT), delone.InputError, "more than one turn"),
        (lambda: Grid.from_lonlat([(0, 1), (2, 3)], LAT), delone.InputError, "entries 0 and 1"),
        (lambda: Grid.from_lonlat(LON, [0, 91]), delone.InputError, "beyond a pole"),
        (lambda: Grid.from_lonlat(LON, [0, np.nan]), delone.NonFiniteError, "NaN"),
        (lambda: Grid.from_lonlat([0], LAT), delone.ShapeError, "at least 2"),
        (lambda: Grid.from_lonlat(np.ones((2, 3)), LAT), delone.ShapeError, "shape"),
        (lambda: Grid.from_healpix(3, "nested"), delone.InputError, "power of two"),
        (lambda: Grid.from_healpix(0), delone.InputError, "nside"),
        (lambda: Grid.from_gaussian(2, [4, 4]), delone.InputError, "4 numbers"),
        (lambda: Grid.from_gaussian(2, "reduced"), delone.InputError, "octahedral"),
        (lambda: Grid.from_mesh([(1, 0, 0)]), delone.ShapeError, "starts"),
        (lambda: Grid.from_mesh([(1, 0, 0)], [0, 2]), delone.ShapeError, "number of corners, 1"),
        (lambda: Grid.from_mesh(np.eye(3), [0, 3], merge=1), delone.InputError, "merge"),
        (lambda: Grid.from_curvilinear([[0, 1]], [[0, 1]]), delone.ShapeError, "two rows"),
        (lambda: Grid.from_curvilinear(LON, LAT), delone.ShapeError, "shape"),
        (
            lambda: Grid.from_mesh([[(1, 0, 0), (-1, 0, 0), (0, 1, 1)]]),
            delone.DirectionError,
            "1 cell has a side that joins opposite directions, first cell 0",
        ),
        # One row from pole to pole: lunes whose sides are not determined.
        (
            lambda: Grid.from_curvilinear(*np.meshgrid([0, 10, 20], [-90, 90])),
            delone.DirectionError,
            "2 cells have a side that joins opposite directions, first cell 0: add a corner",
        ),
        (
            lambda: Grid.from_mesh(lonlat=[[(0, 0), (120, 0), (240, 0)]]),
            delone.DirectionError,
            "no hemisphere contains",
        ),
        (
            lambda: Grid.from_mesh(lonlat=[[(0, 0), (9, 9), (9, 0), (0, 9)]]),
            delone.DirectionError,
            "sides that cross",
        ),
        (lambda: Grid.from_mesh(np.zeros((1, 3, 3))), delone.DirectionError, "zero"),
    ],
)
def test_what_is_refused(call: Callable[[], Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        call()


def test_polygons_of_shapely() -> None:
    shapely = pytest.importorskip("shapely")
    geopandas = pytest.importorskip("geopandas")
    hole = shapely.Polygon([(0, 0), (10, 0), (10, 10), (0, 10)], [[(2, 2), (4, 2), (4, 4), (2, 4)]])
    parts = shapely.MultiPolygon([shapely.box(170, 0, 180, 5), shapely.box(-180, 0, -170, 5)])
    table = geopandas.GeoDataFrame(geometry=[hole, parts, None, hole.reverse()], crs=4326)
    grid = Grid.from_polygons(table)
    assert grid.report.empty.tolist() == [2]
    assert grid.areas[0] == grid.areas[3]
    outer, inner = (Grid.from_polygons(shapely.Polygon(ring)).areas[0] for ring in
                    (hole.exterior, hole.interiors[0]))  # fmt: skip
    assert grid.areas[0] == pytest.approx(outer - inner, rel=1e-14)
    again = Grid.from_polygons(grid.to_geopandas())
    assert np.allclose(again.areas, grid.areas, rtol=1e-12)
    with pytest.raises(delone.InputError, match="projected"):
        Grid.from_polygons(table.to_crs(3857))
    with pytest.raises(delone.InputError, match="geometry 1 is or contains a POINT"):
        Grid.from_polygons([hole, shapely.Point(0, 0)])
    with pytest.raises(delone.InputError, match="is not a geometry"):
        Grid.from_polygons(dict)


def test_polygons_of_collections_and_rings() -> None:
    shapely = pytest.importorskip("shapely")
    one, two = shapely.box(0, 0, 10, 10), shapely.box(20, 0, 30, 10)
    deep = shapely.GeometryCollection(
        [shapely.GeometryCollection([one]), shapely.MultiPolygon([two])]
    )
    grid = Grid.from_polygons([deep, None, one, shapely.GeometryCollection()])
    assert grid.report.empty.tolist() == [1, 3]
    assert grid.areas[0] == pytest.approx(2 * grid.areas[2], rel=1e-14)
    rings = [np.array(one.exterior.coords)[:-1], list(two.exterior.coords)]
    assert np.array_equal(Grid.from_polygons(rings).areas, Grid.from_polygons([one, two]).areas)
    line = shapely.GeometryCollection([one, shapely.LineString([(0, 0), (1, 1)])])
    with pytest.raises(delone.InputError, match="geometry 1 is or contains a LINESTRING"):
        Grid.from_polygons([one, line])
    with pytest.raises(delone.ShapeError, match=r"ring 1 must have shape .* got \(2, 2\)"):
        Grid.from_polygons([rings[0], [(0, 0), (1, 0)]])
    with pytest.raises(delone.ShapeError, match=r"ring 0 must have shape .* got \(3, 3\)"):
        Grid.from_polygons([[(0, 0, 1), (1, 0, 1), (1, 1, 1)]])
    with pytest.raises(delone.ShapeError, match="ring 0"):
        Grid.from_polygons([(0, 0), (1, 0), (1, 1)])


def test_tables_of_cells() -> None:
    pytest.importorskip("geopandas")
    table = Grid.from_lonlat(LON, LAT).to_geopandas({"number": np.arange(72)})
    assert table.area.sum() == pytest.approx(360 * 180)
    assert table.number.tolist() == list(range(72))
    table = Grid.from_healpix(2).to_geopandas()
    assert table.is_valid.all()
    assert table.area.sum() == pytest.approx(360 * 180, rel=1e-6)
    with pytest.raises(delone.InputError, match="step"):
        Grid.from_healpix(1).to_geopandas(step=0)


@pytest.mark.parametrize("name", of_the_sphere())
def test_files_of_grids(name: str, tmp_path: Path) -> None:
    grid = of_the_sphere()[name]()
    grid.save(tmp_path / "grid.npz")
    again = Grid.load(tmp_path / "grid.npz")
    assert np.array_equal(again.areas, grid.areas)
    assert np.array_equal(again.centers_lonlat, grid.centers_lonlat)
    assert (again.grid_shape, again.edges, repr(again)) == (grid.grid_shape, grid.edges, repr(grid))
    assert (again.bounds is None) == (grid.bounds is None)
    assert repr(again.report) == repr(grid.report)


def test_files_keep_masks_and_counts_and_refuse_others(tmp_path: Path) -> None:
    path = tmp_path / "grid.npz"
    near = np.array([[(0, 0), (10, 0), (10, 10)], [(0, 0), (10, 10), (0, 10.0)]])
    near[1] += 1e-13
    grid = Grid.from_mesh(lonlat=near)
    grid.save(path)
    assert Grid.load(path).report.merged == 2
    with np.load(path) as file:
        arrays = dict(file)
    for edits, message in (
        ({"rings": arrays["rings"][::-1]}, "rings is not a partition"),
        ({"cells": arrays["cells"] + 1}, "cells is not a partition"),
        ({"shape": np.array([3])}, "shape and cells do not match"),
        ({"mask": np.ones(3, bool)}, "mask and shape do not match"),
        ({"merged": np.array([-1])}, "merged"),
        ({"rows": np.array([0.0, 1, 2])}, "rows and columns do not fit"),
        ({"places": arrays["places"] * 0}, "zero"),
        # What a constructor refuses.
        ({"places": np.array([(1.0, 0, 0), (-1, 0, 0), (0, 1, 1)] * 2)}, "opposite directions"),
    ):
        np.savez(path, **arrays | edits)
        with pytest.raises(delone.FileFormatError, match=message):
            Grid.load(path)
    with pytest.raises(delone.FileFormatError):
        sphere.Overlaps.load(path)


def test_plots() -> None:
    pytest.importorskip("matplotlib")
    import matplotlib as mpl

    mpl.use("Agg")
    grid = Grid.from_healpix(4, "nested")
    values = np.arange(192.0)
    ax = grid.plot(values=values, resolution=1, title="pixels")
    image = ax.images[0].get_array()
    assert image.shape == (180, 360)
    # Each pixel has the mean over its area: sums are those of the cells.
    weight = np.diff(np.sin(np.radians(np.arange(-90, 91))))[:, None] * np.radians(1)
    assert (image * weight).sum() == pytest.approx((values * grid.areas).sum(), rel=1e-13)
    assert ax.get_title() == "pixels"
    assert len(ax.collections) > 0
    assert not grid.plot(values=values, sides=False).collections
    # Sides across the date line are seen on both ends of the map.
    box = Grid.from_lonlat([170, 190], [0, 10])
    ax = box.plot(bounds=(-180, -20, 180, 20))
    ends = [line.vertices[:, 0] for part in ax.collections for line in part.get_paths()]
    assert min(x.min() for x in ends) == pytest.approx(-190)
    assert max(x.max() for x in ends) == pytest.approx(190)
    ax = box.plot(bounds=(160, -20, -160, 20), values=[3])
    assert ax.get_xlim() == (160, 200)
    assert np.nanmax(ax.images[0].get_array()) == pytest.approx(3)
    assert Grid.from_lonlat([0, 10], [40, 50]).plot().get_xlim() == pytest.approx((-0.3, 10.3))
    ring = Grid.from_lonlat([0, 360], [0, 10]).plot()
    widths = [np.ptp(path.vertices[:, 0]) for path in ring.collections[0].get_paths()]
    assert widths == pytest.approx([360])
    pole = Grid.from_lonlat([0, 120, 240, 360], [60, 90]).plot()
    assert sum(len(part.get_paths()) for part in pole.collections) >= 3
    for options, error, message in (
        ({"values": [1, 2]}, delone.ShapeError, r"shape \(192,\)"),
        ({"values": ["a"] * 192}, delone.DtypeError, "real numbers"),
        ({"values": values, "resolution": 0}, delone.InputError, "resolution"),
        ({"bounds": (0, 1)}, delone.ShapeError, "left, bottom"),
        ({"bounds": (0, 9, 5, 3)}, delone.InputError, "left, bottom"),
    ):
        with pytest.raises(error, match=message):
            grid.plot(**options)
    mpl.pyplot.close("all")


def test_the_number_of_workers_changes_nothing() -> None:
    x, y = np.meshgrid(np.linspace(0, 360, 181), np.linspace(-90, 90, 91))
    sites = np.random.default_rng(8).normal(size=(3000, 3))
    made = [
        [
            Grid.from_curvilinear(x, y, workers=workers),
            Grid.from_lonlat(x[0], y[:, 0], workers=workers),
            Grid.from_healpix(32, workers=workers),
            Grid.from_voronoi(sphere.Voronoi(xyz=sites), workers=workers),
        ]
        for workers in (1, 3)
    ]
    for one, three in zip(*made, strict=True):
        assert np.array_equal(one.areas, three.areas)
        assert np.array_equal(one.rings[0], three.rings[0])
        assert repr(one.report) == repr(three.report)
        assert (one.workers, three.workers) == (1, 3)


def test_nan_in_polygons_names_the_polygons() -> None:
    shapely = pytest.importorskip("shapely")
    square, bad = [(0, 0), (4, 0), (4, 4)], [(10, 0), (14, np.nan), (14, 4)]
    with np.errstate(invalid="ignore"):
        hollow = shapely.Polygon(square, [[(1, 1), (2, 1), (2, np.inf)]])
        nested = shapely.GeometryCollection([shapely.Polygon(square), shapely.Polygon(bad)])
    for given, rows in (
        ([square, bad], [1]),
        ([square, None, square, nested, hollow], [3, 4]),
        ([shapely.Polygon(), hollow], [1]),
    ):
        with pytest.raises(delone.NonFiniteError) as caught:
            Grid.from_polygons(given)
        assert (caught.value.rows.tolist(), caught.value.count) == (rows, len(rows))
