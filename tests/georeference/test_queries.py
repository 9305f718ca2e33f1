"""Queries, clips and edits in another reference system than the points they are about."""

from __future__ import annotations

import copy
import pickle
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import CRSWarning, cluster, interpolate
from delone.errors import InputError
from delone.io import GeometrySet, PointSet
from delone.terrain import TIN

pyproj = pytest.importorskip("pyproj")
geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")

DUTCH, DEGREES = "EPSG:28992", "EPSG:4326"
RANDOM = np.random.default_rng(0)
SITES = RANDOM.random((60, 2)) * 1000 + [155_000, 463_000]
VALUES = SITES @ [0.25, 0.5]
INSIDE = np.array([(155_400.0, 463_400.0), (155_500.0, 463_550.0)])


def table(points: Any = SITES, crs: str | None = DUTCH) -> Any:
    return geopandas.GeoDataFrame(geometry=geopandas.points_from_xy(*np.transpose(points)), crs=crs)


def hull(points: Any) -> Any:
    return delone.ConvexHull(points).contains


def tiles(points: Any) -> Any:
    mesh = delone.Delaunay(points)
    return lambda xi: np.stack((mesh.find_simplex(xi), mesh.nearest(xi), mesh.locate(xi).simplex))


def live(points: Any) -> Any:
    mesh = delone.Dynamic(points)

    def ask(xi: Any) -> Any:
        return np.stack(
            (
                mesh.find_simplex(xi),
                mesh.nearest(xi),
                mesh.locate(xi).simplex,
                mesh.corners_at(xi)[0].max(axis=1),
                mesh.interpolate(xi, VALUES),
            )
        )

    return ask


def surface(points: Any) -> Any:
    crs = getattr(points, "crs", None)
    tin = TIN.from_points(np.column_stack((SITES, VALUES)), crs=crs)
    return lambda xi: np.stack((tin.heights(xi), tin.find_simplex(xi), tin.nearest(xi)))


def interpolators(points: Any) -> Any:
    kinds = (
        interpolate.Linear,
        interpolate.CloughTocher,
        interpolate.Nearest,
        interpolate.NaturalNeighbor,
    )
    made = [kind(points, VALUES) for kind in kinds]
    made.append(interpolate.Linear(delone.Delaunay(points), VALUES))
    made.append(interpolate.Linear(points, VALUES, method="lazy"))

    def ask(xi: Any) -> Any:
        values = [each(xi) for each in made] + [made[0].weights_at(xi) @ VALUES]
        return np.stack((*values, made[0].gradient(xi)[:, 0], made[0].distance(xi)))

    return ask


def cells(points: Any) -> Any:
    return delone.Voronoi(points).nearest


ASKED = (tiles, live, hull, surface, interpolators, cells)


@pytest.mark.parametrize("make", ASKED)
def test_queries_in_another_system_are_transformed(make: Any) -> None:
    known, wanted = make(table()), make(SITES)(INSIDE)
    with warnings.catch_warnings():
        warnings.simplefilter("error", CRSWarning)
        assert np.array_equal(known(INSIDE), wanted)
        assert np.array_equal(known(table(INSIDE)), wanted)
        found = known(table(INSIDE).to_crs(DEGREES))
    np.testing.assert_allclose(np.asarray(found, float), np.asarray(wanted, float), rtol=1e-5)


@pytest.mark.parametrize("make", ASKED)
def test_one_unknown_system_is_said(make: Any) -> None:
    wanted = make(SITES)(INSIDE)
    with pytest.warns(CRSWarning, match=r"system of xi|system of xy"):
        assert np.array_equal(make(SITES)(table(INSIDE)), wanted)
    with pytest.warns(CRSWarning, match=r"that of (xi|xy) is unknown"):
        assert np.array_equal(make(table())(table(INSIDE, None)), wanted)


def test_queries_that_are_not_in_their_system_are_refused() -> None:
    with pytest.raises(InputError, match=r"xi: .* has no place in EPSG:28992"):
        delone.Delaunay(table()).find_simplex(table([(5.0, 95.0)], DEGREES))
    lost = PointSet(points=np.array([(np.nan, 1.0), (5.39, 52.16)]), crs=DEGREES)
    assert delone.Delaunay(table()).nearest(lost)[0] == -1


def test_interpolators_and_clusters_keep_it() -> None:
    for kind in (interpolate.Linear, interpolate.Nearest):
        assert kind(table(), VALUES).crs == DUTCH and kind(SITES, VALUES).crs is None
        assert pickle.loads(pickle.dumps(kind(table(), VALUES))).crs == DUTCH
        assert kind(delone.Delaunay(table()), VALUES).crs == DUTCH
    for model in (cluster.HDBSCAN(5), cluster.DBSCAN(50.0)):
        assert model.fit(table()).crs_ == DUTCH and model.fit(SITES).crs_ is None


def test_live_triangulations_keep_it(tmp_path: Path) -> None:
    live = delone.Dynamic(table())
    live.save(tmp_path / "live.npz")
    again = delone.Dynamic.load(tmp_path / "live.npz")
    copies = [live, again, copy.deepcopy(live), pickle.loads(pickle.dumps(live)), live.freeze()]
    assert [each.crs for each in copies] == [DUTCH] * 5
    plain = delone.Dynamic(SITES)
    assert plain.crs is None and plain.freeze().crs is None
    plain.save(tmp_path / "plain.npz")
    assert delone.Dynamic.load(tmp_path / "plain.npz").crs is None
    for snapshot in (live.snapshot(), pickle.loads(pickle.dumps(live.snapshot()))):
        other = delone.Dynamic()
        other.restore(snapshot)
        assert other.crs == DUTCH
    joined = delone.Dynamic(table(), [(0, 1)])
    assert joined.freeze().crs == DUTCH
    assert delone.Dynamic(delone.Delaunay(table())).crs == DUTCH
    assert delone.Dynamic(joined.freeze()).crs == DUTCH
    assert delone.Dynamic(table(SITES[:2])).crs == DUTCH


def test_edits_are_in_the_system_of_the_first_points() -> None:
    live = delone.Dynamic()
    handles = live.insert(table())
    assert live.crs == DUTCH
    more = live.insert(table(INSIDE).to_crs(DEGREES))
    np.testing.assert_allclose(live.points[more], INSIDE, atol=1e-3)
    live.move(more, table(INSIDE + 50).to_crs(DEGREES))
    np.testing.assert_allclose(live.points[more], INSIDE + 50, atol=1e-3)
    many = RANDOM.random((40, 2)) * 1000 + [155_000, 463_000]
    last = live.insert(table(many).to_crs(DEGREES))
    np.testing.assert_allclose(live.points[last], many, atol=1e-3)
    live.remove(np.concatenate((handles, more, last)))
    live.insert(table(INSIDE).to_crs(DEGREES))
    np.testing.assert_allclose(live.points, INSIDE, atol=1e-3)
    assert live.crs == DUTCH
    empty = delone.Dynamic()
    with empty.edits() as draft:
        draft.insert(table())
    assert empty.crs == DUTCH
    with pytest.warns(CRSWarning, match="system of points is EPSG:28992"):
        delone.Dynamic(SITES).insert(table(INSIDE))
    # What fails leaves the system as it was.
    new = delone.Dynamic()
    with pytest.raises(InputError):
        new.insert(geopandas.GeoSeries([None, shapely.Point(1, 2)], crs=DUTCH))
    assert new.crs is None


def test_clips_are_in_the_system_of_the_sites() -> None:
    box = geopandas.GeoSeries([shapely.box(155_100, 463_200, 155_900, 463_700)], crs=DUTCH)
    wanted = delone.Voronoi(SITES, clip=box[0]).cell_areas
    given = [box, box.to_frame("geometry"), GeometrySet(geometries=np.array(box), crs=DUTCH)]
    for clip in given:
        with warnings.catch_warnings():
            warnings.simplefilter("error", CRSWarning)
            diagram = delone.Voronoi(table(), clip=clip)
        assert diagram.crs == DUTCH and np.array_equal(diagram.cell_areas, wanted)
        with pytest.warns(CRSWarning, match="that of the sites is unknown"):
            delone.Voronoi(SITES, clip=clip)
    far = box.to_crs(DEGREES)
    np.testing.assert_allclose(delone.Voronoi(table(), clip=far).cell_areas, wanted, atol=30)
    moved = delone.lloyd(table(), far, max_iter=2)
    assert moved.diagram.crs == DUTCH
    assert delone.lloyd(table(SITES * 1e120), "box", max_iter=1).diagram.crs == DUTCH
    with pytest.warns(CRSWarning, match="that of clip is unknown"):
        delone.Voronoi(table(), clip=geopandas.GeoSeries(list(box)))
