"""What errors advise can be followed: extras exist, arguments are those of the caller."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import delone
import solids
from delone import cluster, graphs, interpolate, sphere, terrain
from delone.cluster import DBSCAN, HDBSCAN
from delone.errors import DtypeError

# Wheels are tested with NumPy alone.
shapely = pytest.importorskip("shapely")

ROOT = Path(__file__).parents[2]
SOURCES = sorted((ROOT / "python" / "delone").glob("**/*.py"))
POINTS = np.random.default_rng(0).random((500, 2))
BOX = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
FACES = delone.ConvexHull(BOX).simplices


def test_every_extra_that_an_error_names_exists():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pages = [*SOURCES, ROOT / "README.md", *(ROOT / "docs").glob("**/*.rst")]
    named = set()
    for path in pages:
        text = path.read_text(encoding="utf-8")
        named |= set(re.findall(r'extra="(\w+)"', text))
        for group in re.findall(r"delone\[([\w, ]+)\]", text):
            named |= {name.strip() for name in group.split(",")}
    assert "gudhi" in named and "las" in named
    assert named <= set(project["optional-dependencies"])


def _unlimited(tree: ast.AST) -> list[int]:
    """The lines of errors that print the repr of a value of any length."""
    found = []
    for node in ast.walk(tree):
        of_error = isinstance(node, ast.Raise) or (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Name)
            and node.func.id.endswith(("Error", "Failure"))
        )
        for part in ast.walk(node) if of_error else ():
            if isinstance(part, ast.FormattedValue) and part.conversion == ord("r"):
                form = "" if part.format_spec is None else ast.unparse(part.format_spec)
                limit = re.search(r"\.(\d+)", form)
                if limit is None or int(limit[1]) > 200:
                    found.append(part.lineno)
    return sorted(set(found))


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_no_error_prints_a_value_of_any_length(path):
    assert _unlimited(ast.parse(path.read_text(encoding="utf-8"))) == []


def test_what_looks_for_long_values_finds_them():
    assert _unlimited(ast.parse('raise ValueError(f"{a!r:.60} and {b!r}")')) == [1]
    assert _unlimited(ast.parse('x = InputError(f"{b!r:.900}")')) == [1]


LONG = "x" * 5000
CALLS = {
    "method": lambda value: delone.Delaunay(POINTS, method=value),
    "crossing": lambda value: delone.ConstrainedDelaunay(POINTS, [(0, 1)], crossing=value),
    "boundary": lambda value: delone.tetrahedralize(BOX, FACES, boundary=value),
    "interpolator": lambda value: interpolate.interpolator(POINTS, POINTS[:, 0], value),
    "nan": lambda value: interpolate.Linear(POINTS, POINTS[:, 0], nan=value),
    "k": lambda value: graphs.nearest_neighbors(POINTS, value),
    "metric": lambda value: HDBSCAN(metric=value).fit(POINTS),
    "min_angle": lambda value: delone.mesh(shapely.box(0, 0, 1, 1), min_angle=value),
    "clip": lambda value: delone.Voronoi(POINTS, clip=value),
    "sphere": lambda value: sphere.Delaunay(lonlat=POINTS, degrees=value),
    "single_linkage": lambda value: cluster.single_linkage(POINTS, planar=value),
}


@pytest.mark.parametrize("value", [LONG, [LONG], np.zeros((300, 2)), 10**4000], ids=type)
@pytest.mark.parametrize("name", CALLS)
def test_values_are_cut(name, value):
    with pytest.raises(Exception) as caught:
        CALLS[name](value)
    assert len(str(caught.value)) < 600
    assert not re.search(r"x{201}|0{201}", str(caught.value))


def test_least_values_are_those_of_the_argument():
    for call in (
        lambda: graphs.nearest_neighbors(POINTS, 0),
        lambda: DBSCAN(0.1, min_samples=-1).fit(POINTS),
        lambda: delone.AlphaComplex(POINTS).optimal(components=-1),
    ):
        with pytest.raises(delone.InputError, match="must be an integer of at least 1"):
            call()
    with pytest.raises(
        delone.InputError, match="min_cluster_size must be an integer of at least 2"
    ):
        HDBSCAN(min_cluster_size=-1).fit(POINTS)


def test_libraries_that_are_missing(monkeypatch):
    for library in ("gudhi", "scipy.sparse", "scipy.spatial", "scipy.interpolate"):
        monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(delone.MissingExtraError, match=r"delone\[gudhi\]"):
        delone.AlphaComplex(POINTS).to_gudhi()
    with pytest.raises(delone.MissingExtraError) as caught:
        interpolate.Linear(POINTS, POINTS[:, 0]).weights_at(POINTS).csr()
    assert caught.value.extra == "graph"


def test_arguments_in_another_order():
    for order in ((POINTS[:, 0], "linear", POINTS), ("linear", POINTS, POINTS[:, 0])):
        with pytest.raises(delone.DtypeError, match=r"interpolator\(points, values, 'linear'\)"):
            interpolate.interpolator(*order)


def test_objects_in_place_of_points_have_points():
    mesh = delone.Delaunay([(0, 0), (1, 0), (0, 1)])
    for takes in (delone.Delaunay, delone.Voronoi, cluster.HDBSCAN().fit, mesh.find_simplex):
        with pytest.raises(DtypeError, match=r"is an object of type Delaunay, .*: pass its points"):
            takes(mesh)
    tin = terrain.TIN.from_points([(0, 0, 1), (1, 0, 1), (0, 1, 1)])
    with pytest.raises(DtypeError, match=r"xyz is an object of type TIN, .*: pass its xyz"):
        terrain.TIN.from_points(tin)
    globe = sphere.Delaunay(lonlat=[(0, 0), (1, 0), (0, 1)])
    with pytest.raises(DtypeError, match=r"lonlat is an object of type Delaunay, .* its lonlat"):
        sphere.Delaunay(lonlat=globe)
    with pytest.raises(DtypeError, match=r"Voronoi is not a sphere\.Delaunay; pass its points"):
        sphere.Linear(sphere.Voronoi.from_delaunay(globe), [1, 2, 3])


def test_numbers_in_place_of_geometries_are_a_box():
    for takes in (delone.from_geometry, sphere.from_geometry):
        with pytest.raises(delone.InputError, match=r"-10 is not .*: a box is shapely\.box\("):
            takes((-10, 35, 30, 60))
    sites = [(0, 40), (20, 50), (-20, 50), (5, 70)]
    with pytest.raises(delone.InputError, match=r"clip: -10 is not .*: a box is shapely\.box\("):
        sphere.Voronoi(lonlat=sites, clip=(-10, 35, 30, 60))
    assert sphere.Voronoi(lonlat=sites, clip=shapely.box(-10, 35, 20, 60)).cell_areas.sum() > 0


def test_incremental_is_dynamic():
    with pytest.raises(delone.DtypeError, match=r"delone\.Dynamic"):
        delone.Delaunay(POINTS, incremental=True)


def test_extra_points_are_no_seeds():
    with pytest.raises(delone.InputError, match="extra_points: 1 point outside"):
        delone.tetrahedralize(BOX, FACES, extra_points=[(5, 5, 5)])
    with pytest.raises(delone.InputError, match="holes: 1 seed outside"):
        delone.tetrahedralize(BOX, FACES, holes=[(5, 5, 5)])


def test_faces_without_room_advise_the_surface():
    from delone.solids.tetrahedra.filling import _Stages

    assert 'boundary="surface"' in _Stages(None, None, "faces", "winding", None, None)._advice()
    assert not _Stages(None, None, "surface", "winding", None, None)._advice()
    with pytest.raises(delone.BudgetExceededError, match='boundary="surface"'):
        delone.tetrahedralize(*solids.schoenhardt(), max_points=0)


SITES = [(0, 0), (10, 0), (0, 10), (5, 5)]


def test_coordinates_of_a_clip_region_are_named():
    wrong = [shapely.box(0, 0, 1, 1), shapely.Polygon([(0, 0), (155000, 463000), (5, 12)])]
    with pytest.raises(delone.DirectionError) as caught:
        sphere.Voronoi(lonlat=SITES, clip=wrong)
    text = str(caught.value)
    assert text.startswith("clip: geometry 1 has a latitude beyond a pole at (155000, 463000)")
    assert "lonlat" not in text and caught.value.rows.tolist() == [1]
    with pytest.raises(delone.DirectionError, match="geometries: geometry 1 has a longitude of"):
        sphere.from_geometry([wrong[0], shapely.Point(1e9, 3)])


def test_opposite_ends_are_named_by_their_places():
    wrong = [shapely.box(0, 0, 1, 1), shapely.Polygon([(0, 0), (180, 0), (90, 50)])]
    for call in (
        lambda: sphere.Voronoi(lonlat=SITES, clip=wrong),
        lambda: sphere.from_geometry(wrong),
    ):
        with pytest.raises(delone.DirectionError) as caught:
            call()
        assert "a side of geometry 1 joins the opposite directions (0, 0) and (180, 0)" in str(
            caught.value
        )
        assert caught.value.rows.tolist() == [1]
    with pytest.raises(delone.DirectionError, match="segment 1 joins"):
        sphere.ConstrainedDelaunay(
            lonlat=[(0, 0), (10, 0), (0, 10), (180, 0)], segments=[(0, 1), (0, 3)]
        )
