"""Cells as polygons of a map: cut at the date line, completed at the poles, valid, and whole."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import datasets, sphere
from delone.errors import InputError

shapely = pytest.importorskip("shapely")
pytest.importorskip("geopandas")

# Areas of maps are what is tested.
pytestmark = pytest.mark.filterwarnings("ignore:Geometry is in a geographic CRS")

OCTAHEDRON = [(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)]


def test_cells_tile_the_map() -> None:
    sites = np.random.default_rng(5).normal(size=(60, 3))
    # Sites at the poles and on the date line are places like any other.
    sites = np.vstack([sites, (0, 0, 1), (-1, 0, 0), (0, 0, 1)])
    cells = sphere.Voronoi(xyz=sites)
    table = cells.to_geopandas({"row": range(63)}, step=2.0)
    assert table.crs == "EPSG:4326" and table.row.tolist() == list(range(63))
    assert table.is_valid.all() and table.geometry[60].equals(table.geometry[62])
    assert (table.bounds.to_numpy() <= [180, 90, 180, 90]).all()
    assert (table.bounds.to_numpy() >= [-180, -90, -180, -90]).all()
    once = table.geometry[:-1]
    assert abs(once.area.sum() - 360 * 180) < 1e-6
    assert abs(shapely.union_all(once.to_numpy()).area - 360 * 180) < 1e-6
    # Each cell contains its site, and no other.
    places = shapely.points(cells.lonlat[:-3])
    inside = [shapely.contains(shape, places) for shape in once.to_numpy()[:60]]
    np.testing.assert_array_equal(inside, np.eye(60, dtype=bool))


@pytest.mark.parametrize(
    ("sites", "areas"),
    [
        # Lunes: from pole to pole, and from one place on the equator to the opposite one.
        ([(0, 0), (120, 0), (240, 0)], [120 * 180] * 3),
        ([(0, 0), (90, 0), (180, 0), (270, 0)], [90 * 180] * 4),
        # All cells contain a pole or have one as a corner.
        ([(0, 80), (90, 80), (180, 80), (270, 80), (0, -90)], None),
        (OCTAHEDRON, None),
    ],
)
def test_poles_are_edges_of_the_map(sites: Any, areas: list[float] | None) -> None:
    shapes = sphere.Voronoi(lonlat=sites).to_geopandas(step=0.5).geometry
    assert shapes.is_valid.all() and abs(shapes.area.sum() - 360 * 180) < 1e-6
    if areas is not None:
        np.testing.assert_allclose(shapes.area, areas, atol=1e-6)
    for shape, place in zip(shapes, sites, strict=True):
        lon, lat = (place[0] + 180) % 360 - 180, place[1]
        assert shape.intersects(shapely.Point(lon, lat))


def test_a_cell_that_passes_through_a_pole() -> None:
    # The ridge between two sites is the meridian of 0 and 180, over the north pole.
    shapes = sphere.Voronoi(lonlat=[(-90, 60), (90, 60), (0, -60), (180, -60)]).to_geopandas()
    west, east = shapes.geometry[:2]
    assert west.bounds[2] == pytest.approx(0, abs=1e-9) and east.bounds[0] == pytest.approx(0)
    assert west.bounds[3] == east.bounds[3] == 90
    assert abs(west.area - east.area) < 1e-6


def test_clipped_cells_are_cut_at_the_date_line() -> None:
    ring = [(170, -10), (-170, -10), (-170, 10), (170, 10)]
    hole = [(178, -2), (178, 2), (-178, 2), (-178, -2)]
    region = {"type": "Polygon", "coordinates": [ring, hole]}
    sites = [(175, 0), (-175, 0), (180, 8), (0, 0)]
    cells = sphere.Voronoi(lonlat=sites, clip=region)
    shapes = cells.to_geopandas(step=0.1).geometry
    assert shapes.is_valid.all() and shapes[3].is_empty
    assert shapes[2].geom_type == "MultiPolygon"
    whole = shapely.union_all(shapes.to_numpy())
    assert len(shapely.get_parts(whole)) == 2 and not whole.contains(shapely.Point(179.9, 0))
    # Arcs between corners on a parallel bulge towards the pole.
    assert 20 * 20 - 4 * 4 < whole.area < 20 * 20.3 - 4 * 4


def test_a_band_around_the_globe() -> None:
    ring = [(lon, lat) for lat in (60,) for lon in range(-180, 180, 5)]
    inner = [(lon, 80) for lon in range(175, -185, -5)]
    band = {"type": "Polygon", "coordinates": [ring, inner]}
    sites = [(0, 90), (0, 0), (120, 0), (240, 0)]
    shapes = sphere.Voronoi(lonlat=sites, clip=band).to_geopandas().geometry
    assert shapes.is_valid.all() and abs(shapes.area.sum() - 360 * 20) < 15
    assert shapes[0].bounds[1] > 59 and not shapes[0].contains(shapely.Point(0, 85))


def test_what_is_not_understood_is_refused() -> None:
    cells = sphere.Voronoi(lonlat=OCTAHEDRON)
    with pytest.raises(InputError, match="step must be above 0"):
        cells.to_geopandas(step=0)
    with pytest.raises(InputError, match="data has 2 rows for 6 points"):
        cells.to_geopandas({"a": [1, 2]})


def test_a_cell_around_a_pole_is_one_polygon() -> None:
    # A turn away, the longitude of the first corner of Antarctica is rounded.
    ring = datasets.land()["coordinates"][1][0]
    shape = sphere.Grid.from_polygons([shapely.Polygon(ring)]).to_geopandas().geometry[0]
    assert len(shapely.get_parts(shape)) == 1
    assert shape.is_valid
    places = shapely.get_coordinates(shape)
    # Nothing runs to the pole but the edges of the map.
    up = np.flatnonzero((np.abs(places[1:, 1]) == 90) != (np.abs(places[:-1, 1]) == 90))
    assert set(np.abs(places[up, 0])) == {180.0}
