"""What each class says of itself, value by value."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest

import delone
from delone.compat.scipy import Delaunay as DropIn
from delone.exchange.parts import parts_of

FLAT = np.random.default_rng(1).random((30, 2))
SOLID = np.random.default_rng(2).random((30, 3))
CORNERS = [(0.0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (0.5, 1)]
SEGMENTS = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)]


@pytest.mark.parametrize(
    "mesh",
    [
        delone.Delaunay(FLAT),
        delone.Delaunay(SOLID),
        delone.RegularTriangulation(FLAT, np.arange(30) / 1e4),
        delone.RegularTriangulation(SOLID, np.arange(30) / 1e4),
        DropIn(FLAT),
    ],
)
def test_triangulations_have_no_values(mesh: delone.Delaunay) -> None:
    parts = parts_of(mesh)
    assert np.array_equal(parts.points, mesh.points)
    assert np.array_equal(parts.simplices, mesh.simplices)
    assert (parts.of_points, parts.of_simplices, parts.of_segments) == ({}, {}, {})
    assert parts.segments is None
    assert parts.crs is None


def test_constrained() -> None:
    parts = delone.ConstrainedDelaunay(CORNERS, SEGMENTS)._parts()
    mesh = delone.ConstrainedDelaunay(CORNERS, SEGMENTS)
    assert list(parts.of_simplices) == ["region"]
    assert np.array_equal(parts.of_simplices["region"], mesh.region)
    assert np.array_equal(parts.segments, mesh.segments)
    assert parts.of_segments == {}


def test_polygons() -> None:
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    areas = geopandas.GeoSeries([shapely.box(0, 0, 1, 1), shapely.box(1, 0, 3, 1)], crs=28992)
    mesh = delone.from_geometry(areas)
    parts = mesh._parts()
    assert list(parts.of_simplices) == ["region", "polygon"]
    east = parts.points[parts.simplices].mean(axis=1)[:, 0] > 1
    assert np.array_equal(parts.of_simplices["polygon"], east)
    assert parts.crs == mesh.crs == "EPSG:28992"


def test_mesh() -> None:
    mesh = delone.mesh(
        (CORNERS, SEGMENTS),
        max_area=0.05,
        segment_markers=[7, 3, 11, 2, 13, 5, 17],
        regions=[(0.25, 0.5, 4), (0.75, 0.5, 9)],
    )
    parts = mesh._parts()
    at = parts.points[parts.simplices].mean(axis=1)
    assert np.array_equal(parts.of_simplices["region"], np.where(at[:, 0] < 0.5, 4, 9))
    assert np.array_equal(parts.of_points["marker"], mesh.point_markers)
    x, y = parts.points[parts.segments].mean(axis=1).T
    left = x < 0.5
    wanted = np.select(
        [x == 0, x == 1, x == 0.5, (y == 0) & left, y == 0, left], [5, 11, 17, 7, 3, 13], default=2
    )
    assert np.array_equal(parts.of_segments["marker"], wanted)


def test_tetrahedra() -> None:
    mesh = delone.improve(delone.Delaunay(SOLID))
    parts = mesh._parts()
    assert list(parts.of_simplices) == ["region", "smallest_dihedral"]
    assert np.array_equal(parts.of_simplices["region"], mesh.region)
    angles = mesh.quality().smallest_dihedral
    assert np.array_equal(parts.of_simplices["smallest_dihedral"], angles)


@pytest.mark.parametrize("points", [FLAT, SOLID])
def test_hull(points: np.ndarray) -> None:
    hull = delone.ConvexHull(points)
    parts = hull._parts()
    assert np.array_equal(parts.points, points)
    assert np.array_equal(parts.simplices, hull.simplices)
    assert np.array_equal(parts.of_simplices["facet_of"], hull.facet_of)


@pytest.mark.parametrize("periods", [(1.0, 2.0), (None, 2.0)])
def test_periodic(periods: tuple[float | None, float]) -> None:
    mesh = delone.PeriodicDelaunay(FLAT, periods)
    parts = mesh._parts()
    count = mesh.nsimplex
    assert np.array_equal(parts.simplices, np.arange(3 * count).reshape(-1, 3))
    row = parts.of_points["row"]
    assert np.array_equal(row.reshape(-1, 3), mesh.simplices)
    moved = parts.points - mesh.points[row]
    lengths = np.array([periods[0] or 0, periods[1]])
    assert np.allclose(moved, mesh.offsets.reshape(-1, 2) * lengths, atol=1e-12)
    corners = parts.points[parts.simplices]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    assert (areas > 0).all()
    if periods[0]:
        assert areas.sum() == pytest.approx(2.0)


def test_no_class_is_known_to_the_room() -> None:
    """Also not for types: what is imported of delone is named here."""
    room = Path(delone.__file__).parent / "exchange"
    allowed = {
        "delone._base.arrays",
        "delone._base.types",
        "delone._base.blocks",
        "delone.errors",
        "delone._base.extras",
        "delone.exchange",
    }
    for path in room.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("delone"):
                name = node.module or ""
                inside = name.startswith("delone.exchange.")
                assert inside or name in allowed, (path, name)
