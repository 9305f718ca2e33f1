"""Longitudes and latitudes: what is warned of, and what is not."""

from __future__ import annotations

import copy
import pickle
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import Delaunay, GeographicWarning, PeriodicDelaunay, datasets
from delone._base.georeference import (
    degrees_in,
    is_geographic,
    may_be_degrees,
    names_degrees,
    same_crs,
)
from delone.compat import scipy as like_scipy
from delone.compat import triangle as like_triangle
from delone.errors import DtypeError
from delone.interpolate import (
    CloughTocher,
    Linear,
    NaturalNeighbor,
    Nearest,
    cross_validate,
    grid,
    interpolator,
)
from delone.io import GeometrySet, PointSet, read_points
from delone.terrain import TIN

POINTS = np.random.default_rng(0).random((30, 2)) * [300, 150] - [150, 75]
VALUES = np.arange(30.0)
SEGMENTS = np.empty((0, 2), dtype=int)
MAKERS: dict[str, Any] = {
    "Delaunay": Delaunay,
    "ConstrainedDelaunay": lambda data, **told: delone.ConstrainedDelaunay(data, SEGMENTS, **told),
    "RegularTriangulation": lambda data, **told: delone.RegularTriangulation(data, VALUES, **told),
    "Voronoi": delone.Voronoi,
    "mesh": lambda data, **told: delone.mesh((data, [(0, 1), (1, 2), (2, 0)]), size=200, **told),
    "Linear": lambda data, **told: Linear(data, VALUES, **told),
    "Nearest": lambda data, **told: Nearest(data, VALUES, **told),
    "NaturalNeighbor": lambda data, **told: NaturalNeighbor(data, VALUES, **told),
    "CloughTocher": lambda data, **told: CloughTocher(data, VALUES, gradients="local", **told),
    "interpolator": lambda data, **told: interpolator(data, VALUES, "sibson", **told),
    "grid": lambda data, **told: grid(data, VALUES, shape=(3, 3), **told),
    "cross_validate": lambda data, **told: cross_validate(data, VALUES, **told),
    "AlphaComplex": delone.AlphaComplex,
    "concave_hull": lambda data, **told: delone.concave_hull(data, ratio=0.5, **told),
    "gabriel": delone.graphs.gabriel,
    "nearest_neighbors": lambda data, **told: delone.graphs.nearest_neighbors(data, 3, **told),
    "single_linkage": delone.cluster.single_linkage,
    "DBSCAN": lambda data, **told: delone.cluster.DBSCAN(eps=9.0, **told).fit(data),
    "Dynamic": delone.Dynamic,
    "insert": lambda data, **told: delone.Dynamic(**told).insert(data),
    "TIN": lambda data, **told: TIN.from_points(with_heights(data), **told),
}


def with_heights(data: Any) -> Any:
    """The same with heights."""
    if isinstance(data, PointSet):
        return replace(data, z=VALUES)
    return np.column_stack((data, VALUES))


def survey(**facts: Any) -> PointSet:
    return PointSet(points=POINTS, **facts)


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize("facts", [{"crs": "EPSG:4326"}, {"columns": ("Lon", "LATITUDE")}])
def test_what_is_plainly_degrees_is_warned_of(name: str, facts: dict[str, Any]) -> None:
    make = MAKERS[name]
    with pytest.warns(GeographicWarning, match=r"delone\.sphere, or give planar=True") as caught:
        make(survey(**facts))
    # Once, and it is the caller's line that is named.
    assert [Path(each.filename).name for each in caught] == ["test_degrees.py"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        make(survey(**facts), planar=True)
        make(survey(**facts).points)
        make(POINTS.tolist())
        make(survey())
        make(survey(crs="EPSG:28992"))
        # A system counts more than names.
        make(survey(crs="EPSG:28992", columns=("lon", "lat")))
    with pytest.raises(DtypeError, match="planar must be True"):
        make(survey(), planar="yes")


def test_tiles(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    from delone import distributed

    with pytest.warns(GeographicWarning, match=r"delone\.sphere, or give planar=True") as caught:
        distributed.triangulate(POINTS, tmp_path / "a", crs="EPSG:4326")
    assert [Path(each.filename).name for each in caught] == ["test_degrees.py"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        distributed.triangulate(POINTS, tmp_path / "b", crs="EPSG:4326", planar=True)
        distributed.triangulate(POINTS, tmp_path / "c", crs="EPSG:28992")
        distributed.triangulate(POINTS, tmp_path / "d")


def test_copies_stay_declared() -> None:
    live = delone.Dynamic(survey(crs="EPSG:4326"), planar=True)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for each in (live, copy.copy(live), pickle.loads(pickle.dumps(live))):
            each.insert(survey(crs="EPSG:4326"))


def test_tables_by_the_names_of_their_columns() -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(POINTS, columns=["longitude", "latitude"])
    with pytest.warns(GeographicWarning, match="columns longitude, latitude"):
        Delaunay(table)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Delaunay(table.set_axis(["east", "north"], axis=1))
        Delaunay(table, planar=True)


def test_a_period_says_that_degrees_are_meant() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mesh = PeriodicDelaunay(survey(crs="EPSG:4326"), periods=(360, None))
        Linear(mesh, VALUES)
        delone.Voronoi(survey(crs="EPSG:4326"), periods=(360, None))


def test_the_drop_ins_say_nothing() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for data in (survey(crs="EPSG:4326"), survey(columns=("lon", "lat"))):
            like_scipy.Delaunay(data)
            like_scipy.Voronoi(data)
            like_scipy.ConvexHull(data)
            like_scipy.LinearNDInterpolator(data, VALUES)
            like_scipy.CloughTocher2DInterpolator(data, VALUES)
            like_scipy.NearestNDInterpolator(data, VALUES)
            like_triangle.triangulate({"vertices": data})


def test_geometries() -> None:
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    box = shapely.box(4, 50, 6, 52)
    series = geopandas.GeoSeries([box], crs="EPSG:4326")
    held = GeometrySet(geometries=np.array([box]), crs="EPSG:4326")
    for given in (series, series.to_frame("geometry"), held, [series]):
        for make in (delone.from_geometry, delone.mesh):
            with pytest.warns(GeographicWarning, match=r"geometries.*EPSG:4326.*delone\.sphere"):
                make(given)
    with pytest.warns(GeographicWarning):
        delone.from_geometry([box], crs=4326)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for make in (delone.from_geometry, delone.mesh):
            make(series, planar=True)
            make(series.to_crs(28992))
            make(box)
        # Meters in a file that says nothing are read as degrees.
        far = GeometrySet(geometries=np.array([shapely.box(0, 0, 900, 900)]), crs="EPSG:4326")
        delone.from_geometry(far)


def test_xarray() -> None:
    xarray = pytest.importorskip("xarray")
    import delone.xarray  # noqa: F401

    def stations(names: tuple[str, str], **attrs: Any) -> Any:
        x, y = names
        coords = {x: ("station", POINTS[:, 0]), y: ("station", POINTS[:, 1])}
        array = xarray.DataArray(VALUES, dims="station", coords=coords)
        for name, unit in attrs.items():
            array.coords[name].attrs["units"] = unit
        return array

    degrees = {"x": "degrees_east", "y": "degrees_north"}
    for array in (stations(("lon", "lat")), stations(("x", "y"), **degrees)):
        with pytest.warns(GeographicWarning, match=r"delone\.sphere"):
            array.delone.interp([0.0], [0.0], method="clough-tocher")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            array.delone.grid(shape=(2, 2), planar=True)
            stations(("x", "y")).delone.interp([0.0], [0.0])


def test_estimators_by_the_names_of_features() -> None:
    pytest.importorskip("sklearn")
    pandas = pytest.importorskip("pandas")
    from delone.interpolate import DelaunayRegressor

    table = pandas.DataFrame(POINTS, columns=["lon", "lat"])
    with pytest.warns(GeographicWarning, match="features lon, lat"):
        DelaunayRegressor().fit(table, VALUES)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        DelaunayRegressor(planar=True).fit(table, VALUES)
        DelaunayRegressor().fit(POINTS, VALUES)


def test_files_keep_the_names_of_columns(tmp_path: Path) -> None:
    text, records, archive = (tmp_path / f"a{suffix}" for suffix in (".csv", ".npy", ".npz"))
    text.write_text("id,lat,lon,depth\n1,52.0,4.25,-3\n2,52.5,4.5,-7\n")
    table = np.array([(52.0, 4.25)], dtype=[("lat", float), ("lon", float)])
    np.save(records, table)
    np.savez(archive, lon=[4.25], lat=[52.0])
    assert read_points(text).columns == ("lon", "lat", "depth")
    assert read_points(records).columns == ("lon", "lat")
    assert read_points(archive).columns == ("lon", "lat")
    (tmp_path / "b.csv").write_text("4.25 52\n4.5 52.5\n")
    assert read_points(tmp_path / "b.csv").columns == ()
    assert degrees_in(read_points(text)) == "columns lon, lat, depth"


def test_tables_keep_the_names_of_columns(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    pandas = pytest.importorskip("pandas")
    pandas.DataFrame({"lat": [52.0], "lon": [4.25]}).to_parquet(tmp_path / "a.parquet")
    assert read_points(tmp_path / "a.parquet").columns == ("lon", "lat")


def test_samples_know_what_they_are() -> None:
    with pytest.warns(GeographicWarning, match="EPSG:4326"):
        Delaunay(datasets.baja())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Delaunay(datasets.baja(), planar=True)
        Delaunay(datasets.ahn3())


def test_point_sets_are_arrays() -> None:
    data = survey()
    assert np.asarray(data) is data.points
    assert np.asarray(data, dtype=np.float32).dtype == np.float32
    copied = np.array(data)
    copied[0] = 0
    assert (Delaunay(data).points == data.points).all() and data.points[0].any()


def test_what_is_recognized_without_pyproj(monkeypatch: pytest.MonkeyPatch) -> None:
    for missing in (False, True):
        if missing:
            monkeypatch.setattr("delone._base.georeference._has_pyproj", lambda: False)
        else:
            pytest.importorskip("pyproj")
        assert is_geographic("EPSG:4326") and is_geographic("OGC:CRS84")
        assert not is_geographic("EPSG:28992") and not is_geographic("EPSG:43261")
        assert same_crs("EPSG:28992", "EPSG:28992")
        assert not same_crs("EPSG:28992", "EPSG:28991")


def test_names_and_ranges() -> None:
    for names in (
        ["lon", "lat"],
        ["Longitude [deg]", "Latitude (deg)"],
        ["id", "LNG", "lat_wgs84"],
    ):
        assert names_degrees(names)
    for names in ([], ["x", "y"], ["lon"], ["length", "latch"], ["plat", "plon"], [3, None]):
        assert not names_degrees(names)
    assert may_be_degrees(np.array([(np.nan, 1e9), (180.0, 90.0)]))
    assert not may_be_degrees(np.array([(0.0, 90.5)]))
    assert not may_be_degrees(np.array([(721.0, 0.0)]))
