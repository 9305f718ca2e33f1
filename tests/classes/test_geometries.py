"""GeoDataFrames and GeoSeries of points are points, and their reference system is carried on."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import cluster, datasets, graphs, interpolate, sphere
from delone.errors import DtypeError, InputError, NonFiniteError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

geopandas = pytest.importorskip("geopandas")
pandas = pytest.importorskip("pandas")
shapely = pytest.importorskip("shapely")

PLACES = 100 * datasets.uniform(40, seed=5)
ONES = np.ones(len(PLACES))
SURVEY = geopandas.GeoDataFrame(
    {"name": range(40)}, geometry=geopandas.points_from_xy(*PLACES.T), crs="EPSG:28992"
)
OBJECTS: dict[str, Callable[[Any], Any]] = {
    "Delaunay": delone.Delaunay,
    "Regular": lambda points: delone.RegularTriangulation(points, ONES),
    "Periodic": lambda points: delone.PeriodicDelaunay(points, (200, 200)),
    "Constrained": lambda points: delone.ConstrainedDelaunay(points, [(0, 1)]),
    "Mesh": lambda points: delone.mesh(delone.ConstrainedDelaunay(points, [(0, 1)])),
    "Smoothed": lambda points: delone.mesh(delone.ConstrainedDelaunay(points, [])).smooth(1),
    "ConvexHull": delone.ConvexHull,
    "Voronoi": lambda points: delone.Voronoi(points, clip="box"),
    "AlphaComplex": delone.AlphaComplex,
    "AlphaShape": lambda points: delone.AlphaComplex(points).shape(200),
    "ConcaveHull": lambda points: delone.concave_hull(points, ratio=0.3),
    "ConcaveHull, flat": lambda points: delone.concave_hull(points[:2], ratio=0.3),
    "of a mesh": lambda points: delone.AlphaComplex(delone.Delaunay(points)),
    "Graph": lambda points: graphs.Graph(points, [(0, 1)]),
    "subgraph": lambda points: graphs.Graph(points, [(0, 1)]).subgraph([0, 1, 2]),
    "pruned": lambda points: graphs.delaunay_graph(points).prune(max_length=9),
    "Delaunay graph": graphs.delaunay_graph,
    "Gabriel": graphs.gabriel,
    "tree": graphs.minimum_spanning_tree,
    "nearest": lambda points: graphs.nearest_neighbors(points, 2),
    "influence": graphs.sphere_of_influence,
}
OTHERS: dict[str, Callable[[Any], Any]] = {
    "HDBSCAN": lambda points: cluster.HDBSCAN().fit(points).labels_,
    "DBSCAN": lambda points: cluster.DBSCAN(9).fit(points).labels_,
    "Linear": lambda points: interpolate.Linear(points, PLACES[:, 0])([(50, 50)]),
    "queries": interpolate.Linear(PLACES, PLACES[:, 0]),
    "find_simplex": lambda points: delone.Delaunay(PLACES).find_simplex(points),
    "Dynamic": lambda points: delone.Dynamic(points).points,
    "lloyd": lambda points: delone.lloyd(points, (0, 0, 100, 100), max_iter=1).points,
    "grid": lambda points: interpolate.grid(points, PLACES[:, 0], shape=(3, 3)).values,
}


@pytest.mark.parametrize("name", OBJECTS)
def test_the_reference_system_is_carried_on(name: str, tmp_path: Path) -> None:
    for points in (SURVEY, SURVEY.geometry):
        made = OBJECTS[name](points)
        assert made.crs == "EPSG:28992"
        plain = OBJECTS[name](PLACES)
        assert plain.crs is None
        assert np.array_equal(made.points, plain.points)
        if hasattr(made, "to_geopandas") and "flat" not in name:
            assert made.to_geopandas().crs.to_epsg() == 28992
            assert made.to_geopandas(crs="EPSG:3857").crs.to_epsg() == 3857
            assert plain.to_geopandas().crs is None
        if hasattr(made, "save"):
            file = tmp_path / "a.npz"
            for each in (made, plain):
                each.save(file)
                assert type(each).load(file).crs == each.crs
                assert pickle.loads(pickle.dumps(each)).crs == each.crs


@pytest.mark.filterwarnings("ignore::delone.CRSWarning")
@pytest.mark.parametrize("name", OTHERS)
def test_points_are_those_of_arrays(name: str) -> None:
    expected = OTHERS[name](PLACES)
    for points in (SURVEY, SURVEY.geometry, SURVEY.geometry.to_numpy(), list(SURVEY.geometry)):
        assert np.array_equal(OTHERS[name](points), expected, equal_nan=True)


def test_degrees_cause_a_warning_or_are_directions() -> None:
    globe = geopandas.GeoSeries.from_xy(*PLACES.T / 2, crs="EPSG:4326")
    with pytest.warns(delone.GeographicWarning):
        graphs.gabriel(globe)
    mesh = sphere.Delaunay(lonlat=globe)
    assert np.allclose(mesh.lonlat, PLACES / 2)
    # Queries, and sites of interpolators, of any kind of geometries.
    pairs = np.random.default_rng(0).normal(size=(40, 2))
    plain = sphere.Linear(PLACES / 2, pairs)
    for points in (globe, globe.to_frame("geometry"), globe.to_numpy(), list(globe)):
        assert (mesh.find_simplex(points) == mesh.find_simplex(PLACES / 2)).all()
        assert (mesh.nearest(points) == np.arange(40)).all()
        made = sphere.Linear(points, pairs)
        assert (made(points) == pairs).all() and (made.vectors_at(points) == pairs).all()
        assert (made.distance(points) == plain.distance(PLACES / 2)).all()
    pole = geopandas.GeoSeries.from_xy([40.0, 0, 90, 200], [90.0, 0, 0, 0], crs="EPSG:4326")
    wind = np.array([(1.0, 2), (3, 4), (5, 6), (7, 8)])
    assert (sphere.Linear(pole, wind).vectors_at(pole) == wind).all()


def test_projected_coordinates_are_no_directions() -> None:
    mesh = sphere.Delaunay(lonlat=PLACES / 2)
    for takes in (
        lambda points: sphere.Delaunay(lonlat=points),
        lambda points: sphere.Voronoi(lonlat=points),
        lambda points: sphere.Linear(points, ONES),
        sphere.Linear(mesh, ONES),
        mesh.find_simplex,
        mesh.nearest,
    ):
        for points in (SURVEY, SURVEY.geometry):
            with pytest.raises(InputError, match="of EPSG:28992, not longitudes and latitudes"):
                takes(points)


def test_geometries_that_are_not_points() -> None:
    lines = geopandas.GeoSeries([shapely.Point(0, 0), shapely.LineString([(0, 0), (1, 1)])])
    with pytest.raises(DtypeError, match=r"row 1, a LineString: shapely\.get_coordinates"):
        delone.Delaunay(lines)
    gaps = geopandas.GeoSeries([shapely.Point(0, 0), None, shapely.Point(), shapely.Point(1, 1)])
    with pytest.raises(NonFiniteError, match="2 of 4 rows are missing or an empty point; first: 1"):
        delone.Delaunay(gaps)
    for odd in ((1.0, 2.0), np.nan, "POINT (1 1)"):
        with pytest.raises(DtypeError, match=r"contains geometries, and a \w+ in row 1"):
            delone.Delaunay([shapely.Point(0, 0), odd, shapely.Point(1, 1)])
    tops = geopandas.GeoSeries.from_xy(*PLACES.T, PLACES[:, 0])
    with pytest.raises(InputError, match=r"points with heights: pass shapely\.force_2d"):
        delone.Delaunay(tops)
    assert delone.Delaunay(shapely.force_2d(tops.to_numpy())).npoints == 40
    solid = delone.Delaunay(datasets.uniform(20, ndim=3))
    inside = solid.points[solid.simplices].mean(axis=1)[:3]
    found = solid.find_simplex(shapely.points(inside))
    assert np.array_equal(found, solid.find_simplex(inside))


@pytest.mark.parametrize(
    "names",
    [
        ("decimalLongitude", "decimalLatitude"),
        ("location-long", "location-lat"),
        ("gps_lon", "gps_lat"),
        ("Longitude [deg]", "Latitude [deg]"),
        ("gps:longitude", "gps:latitude"),
    ],
)
def test_names_of_columns_of_trackers_and_registers(names: tuple[str, str]) -> None:
    table = pandas.DataFrame(dict(zip(names, PLACES.T / 2, strict=True)))
    with pytest.warns(delone.GeographicWarning, match="longitudes and latitudes"):
        delone.Delaunay(table)
    # Columns in another order, or among others, are not taken for coordinates.
    for wrong in (table[list(names[::-1])], table.assign(speed=1.0, id=2)):
        with pytest.raises(InputError, match=r"pass points\[\["):
            delone.Delaunay(wrong)
    with pytest.raises(InputError, match="pass lonlat"):
        sphere.Delaunay(lonlat=table[list(names[::-1])])


def test_a_third_coordinate_is_one() -> None:
    table = pandas.DataFrame(datasets.uniform(20, ndim=3), columns=["x", "y", "z"])
    assert delone.Delaunay(table).ndim == 3
