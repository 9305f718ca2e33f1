"""Ragged lists, None and other arguments that are no data: errors name the argument."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import io
from delone.errors import DtypeError, InputError, ShapeError
from delone.sphere import Grid
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable

RAGGED: Any = [[0, 1], [1]]
POINTS = np.random.default_rng(0).random((20, 2))
HEIGHTS = np.column_stack((POINTS, POINTS[:, 0]))
TRIANGLE: Any = [[(0, 0), (1, 0), (1, 1)]]

UNEVEN: dict[str, Callable[[], object]] = {
    "lon": lambda: Grid.from_lonlat(RAGGED, [0, 1]),
    "lat": lambda: Grid.from_curvilinear(np.zeros((2, 2)), RAGGED),
    "xyz": lambda: Grid.from_mesh(RAGGED, [0, 2]),
    "lonlat": lambda: Grid.from_mesh(lonlat=RAGGED, starts=[0, 2]),
    "starts": lambda: Grid.from_mesh(np.eye(3), RAGGED),
    "points": lambda: delone.explore(RAGGED),
    "source": lambda: delone.Overlaps([[(0, 0), (1, 0), (1,)]], TRIANGLE),
    "target": lambda: delone.Overlaps(TRIANGLE, [[[(0, 0), (1, 0, 3)], [(1, 1)]]]),
}


@pytest.mark.parametrize("name", UNEVEN)
def test_rows_of_unequal_length_name_the_argument(name: str) -> None:
    with pytest.raises(ShapeError, match=f"^{name} has rows of unequal length"):
        UNEVEN[name]()


@pytest.mark.parametrize("given", [None, 3, "abc", {}, [3]])
def test_polygons_that_are_none(given: Any) -> None:
    with pytest.raises(InputError, match=r"^polygons: (None|3|'abc'|\{\}) is not a geometry"):
        Grid.from_polygons(given)


@pytest.mark.parametrize("n", [0, 8193])
def test_gaussian_grids_have_a_limit(n: int) -> None:
    with pytest.raises(InputError, match=f"^n must be an integer from 1 to 8192, got {n}"):
        Grid.from_gaussian(n)


def test_mappings_are_not_polygons_of_shapely() -> None:
    mapping = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1)]]}
    for given in (mapping, [mapping]):
        with pytest.raises(InputError, match=r"geometry of shapely: convert it with shapely\.geom"):
            Grid.from_polygons(given)


def test_a_missing_polygon_is_an_empty_cell() -> None:
    shapely = pytest.importorskip("shapely")
    grid = Grid.from_polygons([None, shapely.box(0, 0, 1, 1)])
    assert grid.report.empty.tolist() == [0]


@pytest.mark.parametrize("points", [3, "octagonal"])
def test_points_of_gaussian_rows(points: Any) -> None:
    with pytest.raises(InputError, match=r'^points must be "octahedral" or numbers, got'):
        Grid.from_gaussian(4, points)


def test_no_layer_is_not_a_layer_of_one_empty_cell() -> None:
    with pytest.raises(DtypeError, match=r"^source must be polygons"):
        delone.Overlaps(None, TRIANGLE)
    with pytest.raises(DtypeError, match=r"^target must be polygons"):
        delone.Overlaps(TRIANGLE, None)
    assert delone.Overlaps([None], TRIANGLE).report.source_empty.tolist() == [0]


@pytest.mark.parametrize(
    "clip",
    [
        np.full((4, 2), np.nan),
        [np.eye(3)[:, :2], np.full((3, 2), np.nan)],
        [(np.nan, np.nan), (0, 0), (1, 0), (1, 1)],
        [(0, 0), (1, 0), (np.inf, 1)],
    ],
    ids=["all", "second ring", "first", "infinite"],
)
@pytest.mark.filterwarnings("error")
def test_outlines_that_are_not_finite(clip: Any) -> None:
    with pytest.raises(InputError, match=r"^the outline of clip has a coordinate that is NaN"):
        delone.Voronoi(POINTS, clip=clip)


PLACES: dict[str, Callable[[Any], object]] = {
    "read_points": io.read_points,
    "read_mesh": io.read_mesh,
    "read_geometries": io.read_geometries,
    "read_raster": io.read_raster,
    "write_mesh": lambda path: io.write_mesh(path, delone.Delaunay(POINTS)),
    "TIN": TIN.from_file,
    "load": delone.Delaunay.load,
}


@pytest.mark.parametrize("path", [None, [], 3], ids=repr)
@pytest.mark.parametrize("name", PLACES)
def test_paths_that_are_none(name: str, path: Any) -> None:
    with pytest.raises(DtypeError, match=r"^path must be a string or a path-like object, got"):
        PLACES[name](path)
    with pytest.raises(DtypeError, match=r"^folder must be a string"):
        Grid.from_fesom(path)


@pytest.mark.parametrize(
    "mapping",
    [
        {},
        {"type": "Polygon"},
        {"type": "Circle", "coordinates": []},
        {"type": "LineString", "coordinates": [(0,), (1, 2)]},
        {"type": "FeatureCollection"},
        {"type": "Feature", "properties": {}},
        {"type": []},
    ],
    ids=repr,
)
@pytest.mark.parametrize("name", ["breaklines", "boundary", "holes", "level"])
def test_mappings_that_are_not_lines(name: str, mapping: Any) -> None:
    with pytest.raises(InputError, match=rf"^{name}.*: {{.*is not a geometry"):
        TIN.from_points(HEIGHTS, **{name: mapping})


def test_features_without_geometry_have_no_lines() -> None:
    feature = {"type": "Feature", "properties": {}, "geometry": None}
    collection = {"type": "FeatureCollection", "features": [feature]}
    assert TIN.from_points(HEIGHTS, breaklines=collection).npoints == 20
