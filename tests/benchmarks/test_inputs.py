"""The inputs of the benchmarks are what they are said to be; their judges see what is wrong."""

from __future__ import annotations

import gzip
import importlib
import json
import sys
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import ModuleType

ROOT = Path(__file__).parents[2]


@pytest.fixture
def modules() -> Iterator[dict[str, ModuleType]]:
    """The programs in `benchmarks` import one another by bare names; none may stay behind."""
    before = set(sys.modules)
    sys.path.insert(0, str(ROOT / "benchmarks"))
    names = ("lines", "evenodd", "line_judge")
    yield {name: importlib.import_module(name) for name in names}
    sys.path.remove(str(ROOT / "benchmarks"))
    for name in set(sys.modules) - before:
        if "benchmarks" in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


@pytest.fixture
def lines(modules: dict[str, Any]) -> Any:
    return modules["lines"]


@pytest.fixture
def evenodd(modules: dict[str, Any]) -> Any:
    return modules["evenodd"]


@pytest.mark.parametrize("seed", [1, 2026])
def test_the_ring_is_simple_and_lies_in_the_unit_square(lines: Any, seed: int) -> None:
    shapely = pytest.importorskip("shapely")
    ring = lines.fractal_ring(seed=seed)
    assert ring.shape == (28_672, 2)
    assert ((ring > 0) & (ring < 1)).all()
    assert shapely.LinearRing(ring).is_simple
    assert shapely.LinearRing(ring).is_ccw
    assert (ring == lines.fractal_ring(seed=seed)).all()


def test_the_ring_closes_behind_the_points(lines: Any) -> None:
    points, segments = lines.points_and_ring(50, levels=3)
    assert points.shape == (50 + 56, 2)
    assert segments[0].tolist() == [50, 51]
    assert segments[-1].tolist() == [105, 50]
    assert sorted(segments.ravel()) == sorted([*range(50, 106)] * 2)


def test_half_of_all_pairs_of_long_segments_cross(lines: Any) -> None:
    points, segments = lines.long_segments(1000)
    heights = points[segments][:, :, 1]
    assert (points[segments][:, :, 0] == [0, 1]).all()
    left, right = (heights[:, None, k] - heights[None, :, k] for k in (0, 1))
    crossing = np.count_nonzero(left * right < 0) // 2
    assert 230_000 < crossing < 270_000


def test_a_star_turns_left_around_the_origin(lines: Any) -> None:
    points = lines.star_ring(100).points
    after = np.roll(points, -1, axis=0)
    assert (points[:, 0] * after[:, 1] > points[:, 1] * after[:, 0]).all()


@pytest.mark.parametrize("packed", [False, True])
def test_a_coastline_keeps_rings_and_closing_points(
    lines: Any, tmp_path: Path, packed: bool
) -> None:
    square = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
    hole = [[1, 1], [1, 2], [2, 1], [1, 1]]
    geometries = [
        {"type": "Polygon", "coordinates": [square, hole]},
        {"type": "MultiPolygon", "coordinates": [[square], [hole]]},
    ]
    features = [{"type": "Feature", "geometry": geometry} for geometry in geometries]
    text = json.dumps({"type": "FeatureCollection", "features": features}).encode()
    file = tmp_path / "land"
    file.write_bytes(gzip.compress(text) if packed else text)
    points, segments = lines.coastline(file)
    assert points.tolist() == 2 * (square + hole)
    rows = [*range(4), *range(5, 8), *range(9, 13), *range(14, 17)]
    assert segments.tolist() == [[row, row + 1] for row in rows]


def test_lines_are_read_as_they_were_written(lines: Any, tmp_path: Path) -> None:
    given = lines.points_and_ring(10, levels=1)
    lines.save(given, tmp_path / "lines.npz")
    found = lines.load(tmp_path / "lines.npz")
    assert (found.points == given.points).all()
    assert (found.segments == given.segments).all()


def test_the_polygon_of_the_corpus_has_its_rings(lines: Any) -> None:
    rings = lines.corpus_polygon(ROOT / "tests" / "corpus" / "earcut-water-huge.json")
    assert rings.starts[0] == 0
    assert rings.starts[-1] == len(rings.points) == 5667
    assert [len(ring) for ring in rings.split()] == np.diff(rings.starts).tolist()


SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
TILTED = [(2, -1), (5, 2), (2, 5), (-1, 2)]
AREAS = {
    "square": ([SQUARE], Fraction(16)),
    "clockwise": ([SQUARE[::-1]], Fraction(16)),
    "hole": ([SQUARE, [(1, 1), (3, 1), (3, 3), (1, 3)]], Fraction(12)),
    "twice": ([SQUARE, SQUARE], Fraction(0)),
    "bow tie": ([[(0, 0), (2, 2), (2, 0), (0, 2)]], Fraction(2)),
    "crossing at a third": ([[(0, 0), (3, 1), (3, 0), (0, 2)]], Fraction(5, 2)),
    # They share 14: a square less four corners.
    "two squares": ([SQUARE, TILTED], Fraction(16 + 18 - 2 * 14)),
    "point and line": ([[(1, 1)], [(0, 0), (3, 1)]], Fraction(0)),
}


@pytest.mark.parametrize("name", AREAS)
def test_areas_by_the_even_odd_rule(evenodd: Any, name: str) -> None:
    rings, expected = AREAS[name]
    assert evenodd.area([np.array(ring, dtype=float) for ring in rings]) == expected


def test_areas_of_many_crossings_agree_with_overlays(evenodd: Any) -> None:
    shapely = pytest.importorskip("shapely")
    rng = np.random.default_rng(5)
    triangles = rng.integers(0, 20, (12, 3, 2)).astype(float)
    overlay = shapely.Polygon()
    for triangle in triangles:
        overlay = overlay.symmetric_difference(shapely.Polygon(triangle))
    assert float(evenodd.area(triangles)) == pytest.approx(overlay.area, rel=1e-9)


def test_the_judge_of_segments_sees_what_is_wrong(modules: dict[str, Any]) -> None:
    judge, lines = modules["line_judge"], modules["lines"]
    points = np.array([(0, 0), (4, 1), (8, 0), (4, -3), (4, 9.0)])
    flat = np.array([(0, 3, 2), (0, 2, 1), (0, 1, 4), (1, 2, 4)])
    asked = lines.Lines(points, np.array([(0, 2)], dtype=np.int32))
    assert judge.verdict(asked, points[flat], 4) == "exact"
    free = np.array([(0, 3, 1), (1, 3, 2), (0, 1, 4), (1, 2, 4)])
    assert judge.verdict(asked, points[free], 4) == "loses 1 segments"
    unasked = lines.Lines(points, np.empty((0, 2), dtype=np.int32))
    assert judge.verdict(unasked, points[free], 4) == "exact"
    assert judge.verdict(unasked, points[flat], 4) == "1 edges wrong"
    assert judge.verdict(unasked, points[free], 5) == "-1 triangles"
    chain = lines.Lines(points, np.array([(3, 4)], dtype=np.int32))
    assert judge.verdict(chain, points[free], 4) == "exact"
    assert judge.verdict(chain, points[flat], 4) == "loses 1 segments, 1 edges wrong"


def test_the_judge_of_tilings_sees_what_is_wrong(modules: dict[str, Any]) -> None:
    points = np.array([(0, 0), (4, 0), (4, 4), (0, 4.0)])
    tiling = modules["line_judge"].tiling
    assert tiling(points[[(0, 1, 2), (0, 2, 3)]]) == "valid, 4 vertices"
    assert "turned" in tiling(points[[(0, 1, 2), (0, 3, 2)]])
    assert "twice" in tiling(points[[(0, 1, 2), (0, 1, 2)]])
