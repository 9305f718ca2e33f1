"""Sizes that grow with distance: against NumPy, in meshes of both dimensions, and bad input."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import delone
import solids
from delone import SizeByDistance

RANDOM = np.random.default_rng(8)


def from_segments(queries: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return distances from segments, (m, 2, d), by the formula."""
    a, way = ends[:, 0], ends[:, 1] - ends[:, 0]
    away = queries[:, None] - a
    square = np.maximum((way**2).sum(axis=1), np.finfo(float).tiny)
    part = np.clip((away * way).sum(axis=2) / square, 0, 1)
    return np.linalg.norm(away - part[:, :, None] * way, axis=2).min(axis=1)


def from_triangles(queries: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return distances from triangles, (m, 3, 3): of feet inside them, and of their edges."""
    best = from_segments(queries, corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2, 3))
    for a, b, c in corners:
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)
        height = (queries - a) @ normal
        foot = queries - height[:, None] * normal
        turns = [np.cross(q - p, foot - p) @ normal >= 0 for p, q in ((a, b), (b, c), (c, a))]
        inside = np.all(turns, axis=0)
        best[inside] = np.minimum(best[inside], np.abs(height[inside]))
    return best


@pytest.mark.parametrize("ndim", [2, 3])
def test_distances(ndim: int) -> None:
    points = RANDOM.uniform(size=(60, ndim))
    queries = RANDOM.uniform(-1, 2, size=(5000, ndim))
    segments = RANDOM.permutation(60).reshape(-1, 2)
    to_points = np.linalg.norm(queries[:, None] - points, axis=2).min(axis=1)
    one = SizeByDistance(points, near=1)
    assert one.distance(queries) == pytest.approx(to_points, rel=1e-13, abs=1e-300)
    assert one.ndim == ndim
    two = SizeByDistance(points, segments, near=1)
    wanted = from_segments(queries, points[segments])
    assert two.distance(queries) == pytest.approx(wanted, rel=1e-9, abs=1e-14)


def test_distances_from_triangles() -> None:
    points = RANDOM.uniform(size=(90, 3))
    cells = np.arange(90).reshape(-1, 3)
    queries = RANDOM.uniform(-1, 2, size=(9000, 3))
    size = SizeByDistance(points, cells, near=1, workers=1)
    found = size.distance(queries)
    assert found == pytest.approx(from_triangles(queries, points[cells]), rel=1e-9, abs=1e-14)
    again = SizeByDistance(points, cells, near=1, workers=3)
    assert again.distance(queries).tolist() == found.tolist()
    assert size.distance(points).max() < 1e-15
    # Powers of two scale distances exactly.
    scaled = SizeByDistance(points * 2.0**40, cells, near=1)
    assert (scaled.distance(queries * 2.0**40) == found * 2.0**40).all()


def test_sizes_are_linear_up_to_a_limit() -> None:
    size = SizeByDistance([(0, 0)], near=0.5, growth=0.25, far=2)
    assert size([(0, 0), (3, 4), (30, 40)]).tolist() == [0.5, 1.75, 2]
    assert size(np.empty((0, 2))).tolist() == []
    assert repr(size) == "<SizeByDistance near=0.5, growth=0.25, far=2>"
    copy = pickle.loads(pickle.dumps(size))
    assert copy([(3, 4)]).tolist() == [1.75]
    assert repr(SizeByDistance([(0, 0)], near=1)) == "<SizeByDistance near=1, growth=0.3>"


def test_geometries() -> None:
    shapely = pytest.importorskip("shapely")
    rings = shapely.Polygon([(0, 0), (8, 0), (8, 8), (0, 8)], [[(3, 3), (5, 3), (5, 5), (3, 5)]])
    shapes = [shapely.Point(20, 0), rings, shapely.LineString([(0, 12), (8, 12), (8, 20)])]
    queries = [(4, 4), (2, 4), (20, 3), (10, 16), (10, 4)]
    for given in (shapes, shapely.GeometryCollection(shapes), np.array(shapes)[:, None].ravel()):
        found = SizeByDistance(given, near=1).distance(queries)
        assert found.tolist() == [1, 1, 3, 2, 2]
    lines = {"type": "LineString", "coordinates": [(0, 0), (4, 0)]}
    assert SizeByDistance(lines, near=1).distance([(2, 1), (5, 0)]).tolist() == [1, 1]


def test_missing_geometries_have_no_places() -> None:
    shapely = pytest.importorskip("shapely")
    for given in ([None, shapely.Point(3, 4)], [shapely.Point(3, 4), None, shapely.LineString()]):
        assert SizeByDistance(given, near=1).distance([(0, 0)]).tolist() == [5]


def test_later_changes_of_arrays_do_not_matter() -> None:
    points, cells = np.eye(3), np.array([[0, 1, 2]], dtype=np.int32)
    size = SizeByDistance(points, cells, near=1)
    points[:], cells[:] = 7, 0
    assert size.distance(np.eye(3)).max() < 1e-15


def test_tables() -> None:
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    line = shapely.LineString([(0, 0), (4, 0)])
    for given in (geopandas.GeoSeries([line]), geopandas.GeoDataFrame(geometry=[line])):
        assert SizeByDistance(given, near=1).distance([(2, 1)]).tolist() == [1]


def test_triangles_in_the_plane() -> None:
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    size = SizeByDistance(square, [(0, 1)], near=0.1, growth=0.3)
    mesh = delone.mesh(square, size=size)
    assert bool(mesh.report) and bool(mesh.validate())
    corners = mesh.points[mesh.simplices]
    # No triangle is larger than the regular one at its center, and they do grow.
    areas = np.sqrt(3) / 4 * size(corners.mean(axis=1)) ** 2
    assert (mesh.areas <= areas * (1 + 1e-9)).all()
    low = corners[:, :, 1].max(axis=1) < 0.3
    assert mesh.areas[low].mean() < mesh.areas[corners[:, :, 1].min(axis=1) > 2].mean() / 20


def test_tetrahedra_near_marked_faces() -> None:
    points, faces = solids.box((0, 0, 0), (2, 2, 2))
    marked = faces[(points[faces][:, :, 2] == 0).all(axis=1)]
    assert len(marked) == 2
    size = SizeByDistance(points, marked, near=0.15, growth=0.5, far=0.6)
    mesh = delone.tetrahedralize(points, faces, boundary="surface", size=size)
    assert bool(mesh.report.ok) and bool(mesh.validate())
    corners = mesh.points[mesh.simplices]
    edges = np.cbrt(6 * np.sqrt(2) * mesh.volumes)
    assert (edges <= size(corners.mean(axis=1)) * (1 + 1e-9)).all()
    low, high = corners[:, :, 2].max(axis=1) < 0.3, corners[:, :, 2].min(axis=1) > 1
    assert mesh.volumes[low].mean() < mesh.volumes[high].mean() / 10
    finer = mesh.refine(size=SizeByDistance([(2, 2, 2)], near=0.1), boundary="surface")
    assert finer.nsimplex > mesh.nsimplex


def test_far_away() -> None:
    size = SizeByDistance([(-1e308, 0.0), (1.5e308, 0.0)], near=1, growth=1e-300)
    assert size.distance([(1e308, 0.0), (0.0, 0.0)]).tolist() == [5e307, 1e308]
    assert np.isinf(SizeByDistance([(-1.7e308, 0)], near=1).distance([(1.7e308, 0)])).all()
    with np.errstate(over="raise"):
        assert SizeByDistance([(0, 0)], near=1, growth=9, far=5)([(1e308, 0)]).tolist() == [5]


@pytest.mark.filterwarnings("error")
def test_sizes_beyond_the_doubles() -> None:
    steep = SizeByDistance([(0, 0)], near=1, growth=1e300)
    assert steep([(1e10, 0), (0, 0)]).tolist() == [np.inf, 1]
    assert SizeByDistance([(0, 0)], near=1, growth=1e300, far=7)([(1e10, 0)]).tolist() == [7]


def test_arrays_may_change_later() -> None:
    for points in (np.zeros((3, 2)), np.zeros((3, 3))):
        cells = np.array([(0, 1, 2)], dtype=np.int32)
        for size in (SizeByDistance(points, near=1), SizeByDistance(points, cells, near=1)):
            before = np.array(points), np.array(cells)
            points[:], cells[:] = 5, 7
            assert size.distance(before[0]).tolist() == [0, 0, 0]
            points[:], cells[:] = before


def test_geometries_that_are_missing() -> None:
    shapely = pytest.importorskip("shapely")
    point = shapely.Point(3, 4)
    for given in ([None, point], [point, None], np.array([None, point]), (shapely.Point(), point)):
        assert SizeByDistance(given, near=1).distance([(0, 0)]).tolist() == [5]
    alone = np.array(point, dtype=object)
    with pytest.raises(delone.DtypeError, match="places contains geometries"):
        SizeByDistance(alone, near=1)


@pytest.mark.parametrize(
    ("places", "cells", "options", "error", "words"),
    [
        ([(0, 0)], None, {"near": 0}, delone.InputError, "near"),
        ([(0, 0)], None, {"near": -1}, delone.InputError, "near"),
        ([(0, 0)], None, {"near": np.nan}, delone.InputError, "near"),
        ([(0, 0)], None, {"near": np.inf}, delone.InputError, "near"),
        ([(0, 0)], None, {"near": 1, "growth": 0}, delone.InputError, "growth"),
        ([(0, 0)], None, {"near": 1, "far": 0.5}, delone.InputError, "far is 0.5, below near"),
        ([(0, 0)], None, {"near": 1, "workers": 0}, delone.InputError, "workers"),
        (np.empty((0, 2)), None, {"near": 1}, delone.InputError, "nothing to measure"),
        ([(0, 0)], np.empty((0, 2), int), {"near": 1}, delone.InputError, "nothing to measure"),
        ([(0, np.nan)], None, {"near": 1}, delone.NonFiniteError, "places"),
        ([(0, 0, 0, 0)], None, {"near": 1}, delone.ShapeError, "places"),
        ([(0, 0), (1, 1)], [(0, 2)], {"near": 1}, delone.InputError, "cells"),
        ([(0, 0), (1, 1)], [0, 1], {"near": 1}, delone.ShapeError, r"cells .* \(m, 2\) or"),
        ([(0, 0), (1, 1)], [(0, 1, 1, 0)], {"near": 1}, delone.ShapeError, r"\(m, 2\) or \(m, 3\)"),
        ([(0, 0), (1, 1)], [], {"near": 1}, delone.InputError, "nothing to measure"),
        ([(0, 0), (1,)], None, {"near": 1}, delone.ShapeError, "places has rows of unequal"),
        ([None, None], None, {"near": 1}, delone.DeloneError, "places"),
        (None, None, {"near": 1}, delone.DeloneError, "places"),
        (
            {"type": "Point", "coordinates": (0, 0)},
            [(0, 1)],
            {"near": 1},
            delone.InputError,
            "cells",
        ),
        ({}, None, {"near": 1}, delone.DeloneError, "places"),
    ],
)
def test_bad_input(places: object, cells: object, options: dict, error: type, words: str) -> None:
    with pytest.raises(error, match=words):
        SizeByDistance(places, cells, **options)


def test_bad_positions() -> None:
    size = SizeByDistance([(0, 0)], near=1)
    with pytest.raises(delone.ShapeError, match="xi"):
        size([(0, 0, 0)])
    with pytest.raises(delone.NonFiniteError, match="xi"):
        size([(0, np.nan)])
    points, faces = solids.box((0, 0, 0), (1, 1, 1))
    with pytest.raises(delone.ShapeError, match=r"xi has 3 coordinates, the places of .* have 2"):
        delone.tetrahedralize(points, faces, size=size)
