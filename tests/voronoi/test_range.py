"""Cells in boxes against exact powers, with coordinates and weights from all of the range."""

from __future__ import annotations

import json
import warnings
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from delone.voronoi import ThinCellWarning, Voronoi
from rational import Vector, area, exact

shapely = pytest.importorskip("shapely")
CASES = [
    path
    for path in sorted((Path(__file__).parents[1] / "corpus").glob("*.json"))
    if '"weights"' in path.read_text(encoding="utf-8")
]
LARGEST = float(np.finfo(np.float64).max)


def holds(ring: list[Vector], q: Vector) -> bool:
    closed = pairwise([*ring, ring[0]])
    return all((bx - ax) * (q[1] - ay) > (by - ay) * (q[0] - ax) for (ax, ay), (bx, by) in closed)


def check(points: Any, weights: Any, box: list[float], seed: int = 0) -> None:
    """Cells tile the box exactly, and have places whose power from their site is least."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", ThinCellWarning)
        diagram = Voronoi(points, weights=weights, clip=box)
        assert np.isfinite(diagram.vertices).all()
        assert np.isfinite(diagram.rays.origin).all()
        assert np.hypot(*diagram.rays.direction.T) == pytest.approx(1)
        assert not np.isnan(diagram.cell_areas).any()
        assert not np.isnan(diagram.neighbors.sizes).any()
    rows = np.setdiff1d(np.unique(diagram.duplicate_of), diagram.hidden).tolist()
    rings = {row: exact(part[0]) for row in rows for part in diagram.cell(row).parts}
    left, bottom, right, top = map(Fraction, box)
    assert sum(map(area, rings.values())) == (right - left) * (top - bottom)
    heavy = np.zeros(len(points)) if weights is None else np.asarray(weights)
    for u, v in np.random.default_rng(seed).random((4, 2)).tolist():
        q = left + Fraction(u) * (right - left), bottom + Fraction(v) * (top - bottom)
        powers = [
            (x - q[0]) ** 2 + (y - q[1]) ** 2 - Fraction(w)
            for (x, y), w in zip(exact(points), heavy.tolist(), strict=True)
        ]
        for row in (row for row, ring in rings.items() if holds(ring, q)):
            # Rounded corners may give a place beside an edge to the neighbour.
            size = max(abs(powers[row]), abs(min(powers)))
            assert powers[row] - min(powers) <= size / 10**6


def sites(rng: np.random.Generator, n: int) -> Any:
    steps = rng.integers(-3, 4, (n, 2))
    corners = [0, 1, -1, 1e300, -1e300, 5e-324, LARGEST, 1e-16]
    return [
        rng.random((n, 2)),
        steps.astype(float),
        rng.random((n, 2)) * 10.0 ** rng.integers(-300, 300, (n, 2)),
        steps * 5e-324,
        steps * 2.0**1021,
        rng.random((n, 2)) * [1, 1e-300],
        np.column_stack((np.arange(n) * 1.0, rng.integers(0, 2, n) * 5e-324)),
        rng.choice(corners, (n, 2)),
    ][rng.integers(8)]


def heaviness(rng: np.random.Generator, n: int) -> Any:
    if rng.random() < 0.5:
        return None
    if rng.random() < 0.4:
        return rng.choice([0, 1, -1, 1e300, -1e300, 1e-300, 0.5, 1.7e308], n)
    return rng.integers(-3, 9, n) * float(rng.choice([1, 1e-3, 5e-324, 1e200]))


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_what_has_failed_before(path: Path) -> None:
    case = json.loads(path.read_text(encoding="utf-8"))
    check(np.array(case["points"]), np.array(case["weights"]), case["box"])


@pytest.mark.parametrize("seed", range(60))
def test_cells_are_those_of_exact_powers(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 12))
    points, weights = sites(rng, n), heaviness(rng, n)
    boxes = [
        [-1.0, -1.0, 1.0, 1.0],
        [0.0, 0.0, 1e-300, 1e300],
        [-1.7e308, -1.7e308, 1.7e308, 1.7e308],
        [-5e-324, -5e-324, 5e-324, 5e-324],
    ]
    check(points, weights, boxes[seed % 4], seed)


@pytest.mark.parametrize("scale", [2.0**-500, 2.0**-350, 2.0**350, 2.0**500])
def test_outlines_of_any_size(scale: float) -> None:
    points = np.random.default_rng(1).random((100, 2))
    outline = shapely.Point(0.5, 0.5).buffer(0.5) - shapely.box(0.4, 0.4, 0.6, 0.7)
    scaled = shapely.transform(outline, lambda places: places * scale)
    plain, found = Voronoi(points, clip=outline), Voronoi(points * scale, clip=scaled)
    assert found.cell_areas == pytest.approx(plain.cell_areas * scale * scale, rel=1e-12)
    assert found.cell_perimeters == pytest.approx(plain.cell_perimeters * scale, rel=1e-12)
    assert found.neighbors.sizes == pytest.approx(plain.neighbors.sizes * scale, rel=1e-12)
    centers = found.cell_centroids / scale
    assert centers == pytest.approx(plain.cell_centroids, rel=1e-12, nan_ok=True)
    back = shapely.transform(found.polygons(), lambda places: places / scale)
    assert shapely.area(shapely.symmetric_difference(back, plain.polygons())).max() < 1e-15


def test_cells_as_small_as_their_rounding_have_valid_polygons() -> None:
    points = np.random.default_rng(0).random((200, 2)) * 1e-9 + 1e6
    squares = [
        shapely.box(i / 10, j / 10, i / 10 + 0.05, j / 10 + 0.05) for i, j in np.ndindex(9, 9)
    ]
    outline = shapely.transform(shapely.MultiPolygon(squares), lambda places: places - 0.5 + 1e6)
    for clip in (outline, outline.bounds):
        diagram = Voronoi(points, clip=clip)
        cells = diagram.polygons()[np.unique(diagram.duplicate_of)]
        assert shapely.is_valid(cells).all()
        size = shapely.area(shapely.box(*clip) if isinstance(clip, tuple) else clip)
        assert shapely.area(cells).sum() == pytest.approx(size, rel=1e-6)


TINY = 1.6578092e-316
CELLS_OF_ULPS = 1e16 + np.array([(0.0, 4), (2, 6), (6, 4), (4, 4), (0, 8)])
SUBNORMAL_BESIDE_ORDINARY = [
    [(-TINY, 2 * TINY), (1.9999999999999991, -TINY), (2 * TINY, -2 * TINY)],
    [(-2 * TINY,) * 2, (0, 2 * TINY), (-2 * TINY, 0.9999999999999996), (2 - 1e-15, 1 + 2**-52)],
]


@pytest.mark.parametrize("points", [CELLS_OF_ULPS, *SUBNORMAL_BESIDE_ORDINARY])
def test_rings_of_cells_fill_the_box_where_polygons_do_not(points: Any) -> None:
    points = np.array(points)
    box = [*points.min(axis=0), *points.max(axis=0)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ThinCellWarning)
        diagram = Voronoi(points, clip=box)
        polygons = diagram.polygons()
    cells = [diagram.cell(row).parts[0][0] for row in range(len(points))]
    width, height = (Fraction(box[i + 2]) - Fraction(box[i]) for i in (0, 1))
    assert sum(area(exact(cell)) for cell in cells) == width * height
    outer = [polygon.exterior.coords[:-1] for polygon in polygons if polygon]
    assert abs(sum(area(exact(ring)) for ring in outer)) != width * height
    # A cell of an area that is no double is not thin.
    assert len(diagram.thin_cells) == (5 if points.min() > 1 else 0)


def test_cells_of_a_rounded_circle_are_valid() -> None:
    angle = np.linspace(0, 2 * np.pi, 101)[:-1]
    points = np.column_stack((np.cos(angle), np.sin(angle))) * 0.5e-5 + 180
    assert shapely.is_valid(Voronoi(points, clip=(179, 179, 181, 181)).polygons()).all()


def test_neighbours_share_their_corners_on_fine_outlines() -> None:
    angle = np.linspace(0, 2 * np.pi, 4000, endpoint=False)
    radius = np.where(np.arange(4000) % 2, 0.3, 0.48)[:, None]
    star = shapely.Polygon(0.5 + radius * np.column_stack((np.cos(angle), np.sin(angle))))
    cells = Voronoi(np.random.default_rng(0).random((3000, 2)), clip=star).polygons()
    assert shapely.coverage_is_valid(cells[~shapely.is_empty(cells)])


@pytest.mark.parametrize(
    ("points", "box"),
    [
        ([(0, 0), (0, 1)], (0.3, -5e307, 1, 2)),
        ([(0, 0), (1, 0)], (0, 0, 1, 8e307)),
        ([(0, 0)], (0, 0, 1, 5e307)),
        ([(0, 0), (1, 0)], (0, 0, 1e-300, 8e307)),
        ([(0, 0), (0, 1)], (0, -LARGEST / 4, 5e-324, LARGEST / 4)),
        ([(0, 0), (0, 1)], (-LARGEST / 4, -1e-200, LARGEST / 4, 1e-200)),
    ],
)
def test_cells_as_long_as_the_range_have_their_measures(points: Any, box: Any) -> None:
    # A scale that was taken back with another power made areas four times too large.
    diagram = Voronoi(points, clip=box)
    for row in range(len(points)):
        cell = diagram.cell(row)
        rings = [exact(part[0]) for part in cell.parts]
        size = sum(map(area, rings), Fraction(0))
        assert diagram.cell_areas[row] == pytest.approx(float(size), rel=1e-15)
        if size:
            (ring,) = rings
            xs, ys = ([corner[k] for corner in ring] for k in range(2))
            # Each is a rectangle along the axes.
            around = 2 * (max(xs) - min(xs) + max(ys) - min(ys))
            assert cell.perimeter == pytest.approx(float(around), rel=1e-15)
            for k, side in enumerate((xs, ys)):
                away = Fraction(diagram.cell_centroids[row, k]) - (min(side) + max(side)) / 2
                assert abs(away) <= (max(side) - min(side)) / 10**15 + Fraction(5e-324)
