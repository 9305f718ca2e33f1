"""The cells of the comparison about packages that are installed here: SciPy and shapely.

The others (Triangle, CGAL, TetGen, startinpy, MATLAB) are not, so their cells are from their
documentation.
"""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

PAGE = Path(__file__).parents[2] / "docs" / "compared.rst"
scipy = pytest.importorskip("scipy")
shapely = pytest.importorskip("shapely")

from scipy import interpolate, spatial  # noqa: E402

GRID = np.array([(x, y) for x in range(4) for y in range(4)], dtype=float)


def table() -> dict[str, dict[str, str]]:
    """The cells by feature and package."""
    text = PAGE.read_text(encoding="utf-8").partition(".. list-table::")[2]
    text = text.partition("\nChoose another")[0]
    rows = [
        [cell.strip() for cell in re.findall(r"^(?:   \* -|     -) ?(.*)$", row, re.MULTILINE)]
        for row in re.split(r"^(?=   \* -)", text, flags=re.MULTILINE)[1:]
    ]
    head, *rest = rows
    return {row[0]: dict(zip(head[1:], row[1:], strict=True)) for row in rest}


def points(dimension: int, count: int = 30) -> np.ndarray:
    return np.random.default_rng(dimension).random((count, dimension))


def simplices_of_scipy(dimension: int) -> int:
    return len(spatial.Delaunay(points(dimension)).simplices)


def halfspaces_of_scipy(dimension: int) -> spatial.HalfspaceIntersection:
    """The half-spaces around a cube."""
    sides = np.vstack((np.eye(dimension), -np.eye(dimension)))
    rows = np.column_stack((sides, -np.ones(2 * dimension)))
    return spatial.HalfspaceIntersection(rows, np.zeros(dimension))


def triangles(order: np.ndarray) -> set[frozenset[tuple[float, ...]]]:
    mesh = spatial.Delaunay(GRID[order])
    return {frozenset(map(tuple, GRID[order][corners])) for corners in mesh.simplices}


def ties_of_scipy() -> bool:
    random = np.random.default_rng(0)
    return len({frozenset(triangles(random.permutation(16))) for _ in range(20)}) == 1


def ties_of_shapely() -> bool:
    def made(order: np.ndarray) -> frozenset[bytes]:
        found = shapely.delaunay_triangles(shapely.MultiPoint(GRID[order]))
        return frozenset(shapely.to_wkb(shapely.normalize(each)) for each in found.geoms)

    random = np.random.default_rng(0)
    return len({made(random.permutation(16)) for _ in range(20)}) == 1


def removed_points_of_scipy() -> bool:
    return any("remove" in name for name in dir(spatial.Delaunay))


def added_points_of_scipy() -> bool:
    mesh = spatial.Delaunay(points(2), incremental=True)
    mesh.add_points(points(2) + 2)
    return len(mesh.points) == 60


def interpolated(maker: Callable[..., object], dimension: int) -> bool:
    sites = points(dimension, 200)
    found = maker(sites, sites.sum(axis=1))(np.full((1, dimension), 0.5))
    return bool(np.isclose(found[0], dimension / 2, atol=0.05))


def clipped_by_shapely() -> bool:
    box = shapely.box(0.2, 0.2, 0.8, 0.8)
    cells = shapely.voronoi_polygons(shapely.MultiPoint(points(2)))
    parts = [cell.intersection(box) for cell in cells.geoms]
    return bool(np.isclose(sum(part.area for part in parts), box.area))


def polygon_kept() -> bool:
    bay = shapely.Polygon([(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)])
    found = shapely.constrained_delaunay_triangles(bay)
    return bool(np.isclose(sum(each.area for each in found.geoms), bay.area))


def has(module: object, *words: str) -> bool:
    return any(word in name.lower() for name in dir(module) for word in words)


# Feature and package; whether it is so; what the cell says then, and else.
CLAIMS: list[tuple[str, str, Callable[[], object], str]] = [
    ("Delaunay, 2-D", "SciPy", lambda: simplices_of_scipy(2), "yes"),
    ("Delaunay, 3-D", "SciPy", lambda: simplices_of_scipy(3), "yes"),
    ("four and more dimensions", "SciPy", lambda: simplices_of_scipy(5), "yes"),
    ("ties independent of the order of points", "SciPy", ties_of_scipy, "yes"),
    ("Voronoi diagram, 2-D", "SciPy", lambda: len(spatial.Voronoi(points(2)).vertices), "yes"),
    ("Voronoi diagram, 3-D", "SciPy", lambda: len(spatial.Voronoi(points(3)).vertices), "yes"),
    ("the sphere", "SciPy", lambda: has(spatial, "sphericalvoronoi"), "cells"),
    (
        "convex hulls",
        "SciPy",
        lambda: len(spatial.ConvexHull(points(4)).simplices),
        "all dimensions",
    ),
    (
        "intersections of half-spaces",
        "SciPy",
        lambda: len(halfspaces_of_scipy(5).intersections) == 32,
        "all dimensions",
    ),
    ("alpha shapes, concave hulls", "SciPy", lambda: has(spatial, "alpha", "concave"), "yes"),
    (
        "linear interpolation",
        "SciPy",
        lambda: interpolated(interpolate.LinearNDInterpolator, 4),
        "all dimensions",
    ),
    (
        "natural neighbor interpolation",
        "SciPy",
        lambda: has(interpolate, "natural", "sibson", "laplace"),
        "yes",
    ),
    (
        "smooth (Clough-Tocher)",
        "SciPy",
        lambda: interpolated(interpolate.CloughTocher2DInterpolator, 2),
        "2-D",
    ),
    (
        "radial basis functions",
        "SciPy",
        lambda: interpolated(interpolate.RBFInterpolator, 3),
        "yes",
    ),
    ("points added and removed", "SciPy", added_points_of_scipy, "added"),
    ("points added and removed", "SciPy", lambda: not removed_points_of_scipy(), "added"),
    (
        "segments as edges (2-D)",
        "SciPy",
        lambda: "segments" in inspect.signature(spatial.Delaunay).parameters,
        "yes",
    ),
    (
        "threads",
        "SciPy",
        lambda: "workers" in inspect.signature(spatial.Delaunay).parameters,
        "yes",
    ),
    (
        "Delaunay, 2-D",
        "shapely",
        lambda: len(shapely.delaunay_triangles(shapely.MultiPoint(GRID)).geoms) == 18,
        "yes",
    ),
    ("ties independent of the order of points", "shapely", ties_of_shapely, "yes"),
    ("segments as edges (2-D)", "shapely", polygon_kept, "polygons"),
    (
        "Voronoi diagram, 2-D",
        "shapely",
        lambda: len(shapely.voronoi_polygons(shapely.MultiPoint(points(2))).geoms) == 30,
        "yes",
    ),
    (
        "cells clipped to any polygon, with areas",
        "shapely",
        clipped_by_shapely,
        "by intersecting them",
    ),
    ("convex hulls", "shapely", lambda: shapely.MultiPoint(GRID).convex_hull.area == 9, "2-D"),
    (
        "alpha shapes, concave hulls",
        "shapely",
        lambda: shapely.concave_hull(shapely.MultiPoint(points(2))).area > 0,
        "concave hull",
    ),
    ("linear interpolation", "shapely", lambda: has(shapely, "linearnd", "griddata"), "yes"),
]


@pytest.mark.parametrize(
    ("feature", "package", "holds", "cell"),
    CLAIMS,
    ids=[f"{package}: {feature}" for feature, package, _, _ in CLAIMS],
)
def test_cells_are_as_the_package_does(
    feature: str, package: str, holds: Callable[[], object], cell: str
) -> None:
    assert table()[feature][package] == (cell if holds() else "–")


def test_each_row_has_a_cell_for_each_package() -> None:
    cells = table()
    assert len(cells) > 30
    assert all(row["delone"] and all(row.values()) for row in cells.values())


@pytest.mark.parametrize(("name", "module"), [("SciPy", scipy), ("shapely", shapely)])
def test_the_versions_are_those_that_are_tested(name: str, module: object) -> None:
    said = re.search(rf"{name} (\d+\.\d+)", PAGE.read_text(encoding="utf-8"))
    assert said is not None
    assert said[1] == ".".join(module.__version__.split(".")[:2])  # type: ignore[attr-defined]
