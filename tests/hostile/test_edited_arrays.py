"""Saved files in which one array is edited: rejected, or every method of what is loaded works."""

from __future__ import annotations

import pickle
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

import delone
from delone import FileFormatError, datasets, sphere
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

FLAT, SOLID = datasets.duplicates(30), datasets.uniform(20, ndim=3)
SQUARE = np.array([(0.0, 0), (4, 0), (4, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2)])
SIDES = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)])
RELIEF = TIN.from_points(SOLID, crs="EPSG:28992", units="m")

MAKE: dict[str, Callable[[], Any]] = {
    "Delaunay 2-D": lambda: delone.Delaunay(FLAT),
    "Delaunay 3-D": lambda: delone.Delaunay(SOLID),
    "ConstrainedDelaunay": lambda: delone.ConstrainedDelaunay(
        FLAT, [(0, 1), (2, 3), (4, 5)], crossing="split", regions=[(0.5, 0.5, 3)]
    ),
    "ConstrainedDelaunay, conforming": lambda: delone.ConstrainedDelaunay(
        SQUARE, SIDES, conforming=True, holes=[(1.5, 1.5)]
    ),
    "from_geometry": lambda: delone.from_geometry(shapely.Polygon(SQUARE[:4], [SQUARE[4:]])),
    "Mesh": lambda: delone.mesh((SQUARE, SIDES), max_area=0.1, segment_markers=np.arange(8)),
    "TIN": lambda: TIN.from_points(
        np.column_stack((SQUARE, SQUARE[:, 0])),
        breaklines=[[(0.5, 0.5, 1), (3, 0.5, 2)]],
        holes=[SQUARE[4:]],
        crs="EPSG:28992",
    ),
    "TetMesh": lambda: delone.improve(delone.Delaunay(SOLID), min_angle=60),
    "RegularTriangulation": lambda: delone.RegularTriangulation(SQUARE, SQUARE[:, 0] / 9),
    "PeriodicDelaunay": lambda: delone.PeriodicDelaunay(SQUARE, (9, None)),
    "Voronoi 2-D": lambda: delone.Voronoi(SQUARE, clip="box"),
    "Voronoi 3-D": lambda: delone.Voronoi(SOLID, clip="box"),
    "ConvexHull": lambda: delone.ConvexHull(SOLID),
    "AlphaShape 2-D": lambda: delone.AlphaComplex(FLAT, np.arange(len(FLAT)) / 999).shape(0.02),
    "AlphaShape, periodic": lambda: delone.AlphaComplex(SQUARE, periodic=(9, None)).shape(4),
    "AlphaShape 3-D": lambda: delone.AlphaComplex(SOLID).shape(0.04),
    "ConcaveHull 2-D": lambda: delone.concave_hull(FLAT, ratio=0.3),
    "ConcaveHull 3-D": lambda: delone.concave_hull(SOLID, ratio=0.3),
    "Contours": lambda: RELIEF.contours(interval=0.25, min_length=0.1),
    "Bands": lambda: RELIEF.bands(interval=0.25, min_area=0.01),
    "sphere.Delaunay": lambda: sphere.Delaunay(xyz=[*SOLID - 0.5, 2 * SOLID[0] - 1]),
    "sphere.Delaunay, a hull": lambda: sphere.Delaunay(lonlat=[*SQUARE, SQUARE[3]]),
    "sphere.ConstrainedDelaunay": lambda: sphere.ConstrainedDelaunay(
        lonlat=9 * SQUARE, segments=[*SIDES, (0, 2), (1, 6), (3, 3)], crossing="split"
    ),
    "sphere.from_geometry": lambda: sphere.from_geometry(shapely.Polygon(SQUARE[:4], [SQUARE[4:]])),
    "sphere.Voronoi": lambda: sphere.Voronoi(lonlat=SQUARE, radius=6371.0),
    "sphere.Voronoi, clipped": lambda: sphere.Voronoi(
        lonlat=SQUARE, clip=shapely.Polygon(SQUARE[:4], [SQUARE[4:]])
    ),
    "sphere.Grid": lambda: sphere.Grid.from_polygons(
        [shapely.Polygon(SQUARE[:4], [SQUARE[4:]]), shapely.box(5, 5, 6, 6)]
    ),
    "sphere.Grid of parallels": lambda: sphere.Grid.from_lonlat(
        [0, 90, 180, 270, 360], [-90, 0, 9]
    ),
    "sphere.Grid, reduced": lambda: sphere.Grid.from_gaussian(2, [3, 4, 4, 3]),
    "sphere.Voronoi, a circle": lambda: sphere.Voronoi(lonlat=[(x, 0) for x in range(5)]),
}
EDITS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "zeroed": np.zeros_like,
    "reversed": lambda a: a[::-1].copy(),
    "shortened": lambda a: a[:-1].copy(),
    "emptied": lambda a: a[:0].copy(),
    "shifted": lambda a: np.roll(a, 1, axis=0),
    "negative": lambda a: -a - 1 if a.dtype.kind in "if" else ~a,
    "not a number": lambda a: a * np.nan if a.dtype.kind == "f" else a,
}
# Attributes of shapes that raise an InputError, also for the periodic one.
OTHER_DIMENSION = {2: ("perimeter", "volume"), 3: ("loose_edges", "perimeter", "sides")}


def edited(path: Path, name: str, edit: Callable[[np.ndarray], np.ndarray]) -> bool:
    """Edit an array of a file; false if it is as before."""
    with np.load(path) as archive:
        arrays = dict(archive)
    changed = edit(arrays[name])
    if np.array_equal(changed, arrays[name], equal_nan=changed.dtype.kind == "f"):
        return False
    np.savez(path, **arrays | {name: changed})
    return True


def attributes(made: Any) -> dict[str, Any]:
    """All public attributes that are not methods."""
    names = [name for name in dir(type(made)) if not name.startswith("_")]
    if isinstance(made, delone.AlphaShape | delone.ConcaveHull):
        names = [name for name in names if name not in OTHER_DIMENSION[made.ndim]]
    values = {name: getattr(made, name) for name in names if hasattr(made, name)}
    return {name: value for name, value in values.items() if not callable(value)}


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], tuple[Any, bytes, list]]:
    found: dict[str, Any] = {}

    def of(name: str) -> Any:
        if name not in found:
            made = MAKE[name]()
            path = tmp_path_factory.mktemp("saved") / "a.npz"
            made.save(path)
            with np.load(path) as archive:
                rows = [each for each in archive.files if archive[each].ndim]
            found[name] = made, path.read_bytes(), rows
        return found[name]

    return of


@pytest.mark.parametrize("edit", EDITS)
@pytest.mark.parametrize("name", MAKE)
@pytest.mark.sampled(21)
def test_each_array_edited(saved, tmp_path: Path, name: str, edit: str) -> None:
    made, whole, arrays = saved(name)
    path = tmp_path / "a.npz"
    for array in arrays:
        path.write_bytes(whole)
        if not edited(path, array, EDITS[edit]):
            continue
        try:
            found = type(made).load(path)
        except FileFormatError:
            continue
        if hasattr(found, "validate") and not found.validate():
            continue
        if isinstance(found, delone.Mesh):
            found.coarsen()
            found.refine(max_area=0.08)
        # Other points, weights and labels may be right as well.
        values = attributes(found)
        assert values.keys() == attributes(made).keys()
        assert str(values.get("report", found))
        again = pickle.loads(pickle.dumps(found))
        assert repr(again) == repr(found)


# Edits that leave a triangulation correct and contradict the other arrays, and what is said.
CONTRADICTIONS: list[tuple[str, str, Callable[[np.ndarray], np.ndarray], str]] = [
    ("ConstrainedDelaunay", "labels", lambda a: a * 0 - 7, "labels"),
    ("ConstrainedDelaunay", "geometries", lambda a: a * 0 - 2, "geometries"),
    ("ConstrainedDelaunay", "crossings", lambda a: a[:0], "crossings"),
    ("ConstrainedDelaunay", "crossings", np.zeros_like, "crossings"),
    ("ConstrainedDelaunay", "crossings", lambda a: a[:, [1, 0, 2]], "crossings"),
    ("ConstrainedDelaunay, conforming", "added", lambda a: a[:0], "added"),
    ("ConstrainedDelaunay, conforming", "through", lambda a: np.array([[0, 5]], "<i4"), "through"),
    ("Mesh", "counts", lambda a: a[::-1], "counts"),
    ("Mesh", "counts", np.zeros_like, "counts"),
    ("Mesh", "on", lambda a: a * 0 - 1, "on"),
    ("Mesh", "on", lambda a: np.where(a < 0, 0, a), "on"),
    ("sphere.Delaunay", "options", lambda a: a + 2, "options"),
    ("sphere.Delaunay", "duplicates", lambda a: a - 1, "duplicates"),
    ("sphere.Delaunay", "vectors", lambda a: a * 0, "vector"),
    ("sphere.Delaunay", "vectors", lambda a: a * (1, 1, -1), "turned"),
    ("sphere.Delaunay", "vectors", lambda a: np.vstack((a[:-1], -a[-1:])), "direction"),
    ("sphere.Delaunay", "vectors", lambda a: np.vstack((a[:-1], a[-1:] + 0.1)), "direction"),
    ("sphere.ConstrainedDelaunay", "options", lambda a: np.add(a, (0, 3, 0)), "options"),
    ("sphere.ConstrainedDelaunay", "options", lambda a: np.subtract(a, (0, 0, 1)), "input"),
    ("sphere.ConstrainedDelaunay", "crossings", lambda a: a[:0], "crossings"),
    ("sphere.ConstrainedDelaunay", "geometries", lambda a: a[:-1], "geometries"),
    ("sphere.ConstrainedDelaunay", "outer", lambda a: ~a, "outer"),
    ("sphere.Voronoi", "radius", lambda a: -a, "radius"),
    ("sphere.Voronoi", "degrees", lambda a: a[:0], "degrees"),
    ("sphere.Voronoi, clipped", "winding", lambda a: a + 3, "winding"),
    ("sphere.Voronoi, clipped", "sides", lambda a: a + 1, "sides"),
    ("sphere.Voronoi, clipped", "sides", lambda a: a[:0], "sides"),
    ("sphere.Voronoi, clipped", "outer", lambda a: a[1:], "outer"),
    ("sphere.Voronoi, clipped", "corners", lambda a: a * 0, "vector"),
    ("TetMesh", "angles", lambda a: a * np.nan, "angles"),
    ("TetMesh", "angles", lambda a: a[::-1], "angles"),
    ("TetMesh", "counts", lambda a: a * 0 - 5, "counts"),
    ("TetMesh", "counts", lambda a: a * 0 + 2, "counts"),
    ("TetMesh", "weights", lambda a: a * np.nan, "weights"),
    ("TetMesh", "bounds", lambda a: a[::-1], "bounds"),
    ("TetMesh", "before", lambda a: a - 10**6, "before"),
    ("TetMesh", "after", lambda a: a + 1, "after"),
    ("TetMesh", "below", lambda a: a[::-1], "below"),
    ("TetMesh", "wall_edges", lambda a: a[1:], "wall_edges"),
    ("TetMesh", "wall_edges", lambda a: a + 1, "wall_edges"),
    ("TetMesh", "wall_edges", lambda a: a[:, ::-1] - 10**6, "wall_edges"),
    ("AlphaShape 2-D", "alpha", lambda a: a * np.nan, "alpha"),
    ("AlphaShape 3-D", "alpha", lambda a: np.append(a, a), "alpha"),
    ("ConcaveHull 2-D", "kept", lambda a: a[1:], "kept"),
    ("ConcaveHull 3-D", "simplices", lambda a: a[:, [1, 0, 2, 3]].copy(), "tetrahedron"),
    ("ConcaveHull 2-D", "neighbors", lambda a: a * 0 - 1, "mutual"),
    ("Contours", "starts", lambda a: a + 1, "starts"),
    ("Contours", "starts", lambda a: np.insert(a, 1, 1), "starts"),
    ("Contours", "level", lambda a: a + 0.01, "level"),
    ("Contours", "levels", lambda a: a[::-1], "levels"),
    ("Contours", "index", lambda a: a[1:], "index"),
    ("Contours", "counts", lambda a: -a - 1, "counts"),
    ("Bands", "ring_starts", lambda a: np.insert(a, 1, 3), "ring_starts"),
    ("Bands", "polygon_starts", lambda a: a[:-1], "polygon_starts"),
    ("Bands", "points", lambda a: a[::-1] + np.arange(len(a))[:, None], "closed"),
    ("Bands", "high", lambda a: a - 10, "range"),
    ("Bands", "low", lambda a: a[1:], "polygon_starts"),
    ("Bands", "counts", lambda a: a[1:], "counts"),
]


@pytest.mark.parametrize(
    ("name", "case"),
    [pytest.param(name, case, id=f"{name}-{case[0]}") for name, *case in CONTRADICTIONS],
)
def test_arrays_that_contradict_each_other(saved, tmp_path: Path, name: str, case: Any) -> None:
    array, edit, message = case
    made, whole, _ = saved(name)
    path = tmp_path / "a.npz"
    path.write_bytes(whole)
    type(made).load(path)
    assert edited(path, array, edit)
    with pytest.raises(FileFormatError, match=rf"truncated: .*\b{message}\b"):
        type(made).load(path)
