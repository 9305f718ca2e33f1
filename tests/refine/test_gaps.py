"""Needles between lines that nearly touch: left where they are too dear, and nothing else is."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
from delone.testing import assert_mesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

CORPUS = Path(__file__).parents[1] / "corpus"
SHARED = Path(__file__).parents[3] / "shared" / "data"
COUNTRIES = SHARED / "ne_110m_admin_0_countries.geojson"
THIN = [(0, 0), (1, 0), (0.3, 1e-9)], [(0, 1), (1, 2), (2, 0)]


def thin(height: float) -> tuple[list[tuple[float, float]], list[tuple[int, int]]]:
    return [*THIN[0][:2], (0.3, height)], THIN[1]


def square_of_needles(
    count: int, kind: str, gap: float
) -> tuple[NDArray[np.float64], list[tuple[int, int]]]:
    """A square with pairs of lines, triangles or corners of almost no width in a grid."""
    rng = np.random.default_rng(1)
    points = [np.array(p, dtype=float) for p in ((0, 0), (1, 0), (1, 1), (0, 1))]
    segments = [(0, 1), (1, 2), (2, 3), (3, 0)]
    side = int(np.ceil(np.sqrt(count)))
    for i in range(count):
        centre = (np.array(divmod(i, side)) + 0.5) / side
        angle = rng.uniform(0, np.pi)
        u = 0.35 / side * np.array([np.cos(angle), np.sin(angle)])
        v = gap * np.array([-np.sin(angle), np.cos(angle)])
        b = len(points)
        if kind == "triangles":
            points += [centre - u, centre + u, centre - 0.4 * u + v]
            segments += [(b, b + 1), (b + 1, b + 2), (b + 2, b)]
        elif kind == "pairs":
            points += [centre - u, centre + u, centre - 0.8 * u + v, centre + 1.1 * u + v]
            segments += [(b, b + 1), (b + 2, b + 3)]
        else:
            points += [centre - u, centre + u, centre + 0.6 * u + v]
            segments += [(b, b + 1), (b, b + 2)]
    return np.array(points), segments


def assert_spoilt_by_needles_alone(mesh: delone.Mesh, width: float) -> None:
    """What is below the bound is at a corner, or as narrow as a needle."""
    report = mesh.report
    assert not report.exhausted
    assert set(report.cause.tolist()) <= {"corner", "needle"}
    corners = mesh.points[mesh.simplices[report.below[report.cause == "needle"]]]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    u, v = (corners[:, k] - corners[:, 0] for k in (1, 2))
    heights = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / edges.max(axis=1)
    assert heights.max() <= width


def test_a_needle_that_would_take_the_whole_budget_is_left_and_reported() -> None:
    mesh = delone.mesh(THIN, min_angle=20)
    report = mesh.report
    assert mesh.npoints == 3
    assert not report and not report.exhausted
    assert report.cause.tolist() == ["needle"]
    assert report.corner.tolist() == [-1]
    assert mesh.find_simplex(report.needles).tolist() == [0]
    assert "1 needle left unrefined (too many points needed): (0.433333, 3.33333e-10)" in str(
        report
    )


def test_a_larger_budget_refines_what_a_smaller_one_leaves() -> None:
    small = delone.mesh(thin(1e-4), min_angle=25, max_points=100_000)
    assert small.nadded == 0
    assert len(small.report.needles) == 1
    large = delone.mesh(thin(1e-4), min_angle=25)
    assert large.nadded > 1000
    assert len(large.report.needles) == 0
    assert set(large.report.cause.tolist()) <= {"corner"}


@pytest.mark.parametrize("angle", [20, 30])
@pytest.mark.parametrize("gap", [1e-9, 1e-12])
@pytest.mark.parametrize("kind", ["triangles", "pairs", "corners"])
@pytest.mark.sampled(5)
def test_a_square_with_a_thousand_needles_is_refined_elsewhere(
    kind: str, gap: float, angle: float
) -> None:
    mesh = delone.mesh(square_of_needles(1000, kind, gap), min_angle=angle)
    assert mesh.npoints < 40_000
    assert len(mesh.report.needles) == 1000
    assert_spoilt_by_needles_alone(mesh, 2 * gap)


def test_sizes_are_kept_around_needles_and_in_them() -> None:
    domain = square_of_needles(9, "pairs", 1e-9)
    mesh = delone.mesh(domain, max_area=1e-4)
    assert mesh.areas.max() <= 1e-4
    assert len(mesh.report.needles) == 9
    assert_mesh(mesh, *domain, spoilt=mesh.report.below)
    alone = delone.mesh(THIN, min_angle=20, max_area=1e-12)
    assert alone.areas.max() <= 1e-12
    assert alone.nadded < 10_000


def test_needles_stay_the_same_when_their_mesh_is_refined_again() -> None:
    mesh = delone.mesh(square_of_needles(25, "pairs", 1e-9))
    again = mesh.refine()
    assert again.npoints == mesh.npoints
    assert set(map(frozenset, again.simplices.tolist())) == set(
        map(frozenset, mesh.simplices.tolist())
    )
    finer = mesh.refine(size=lambda xy: 0.01 + 0.1 * xy[:, 0])
    assert len(finer.report.needles) == 25
    assert finer.npoints < 20_000
    assert_spoilt_by_needles_alone(finer, 2e-9)


def test_needles_are_the_same_in_any_order_of_the_input() -> None:
    points, segments = square_of_needles(25, "pairs", 1e-9)
    given = delone.mesh((points, segments)).report.needles
    rng = np.random.default_rng(4)
    row = rng.permutation(len(points))
    shuffled = np.empty_like(points)
    shuffled[row] = points
    turned = rng.permutation(row[np.array(segments)])[:, ::-1]
    found = delone.mesh((shuffled, turned)).report.needles
    assert len(found) == len(given) == 25
    # Each is a place in the same needle: pieces of its sides may be cut otherwise.
    assert np.linalg.norm(given[:, None] - found, axis=2).min(axis=1).max() < 0.1


def test_a_report_knows_the_needles_after_a_mesh_has_travelled(tmp_path: Path) -> None:
    mesh = delone.mesh(square_of_needles(4, "triangles", 1e-9))
    mesh.save(tmp_path / "needles.npz")
    assert str(delone.Mesh.load(tmp_path / "needles.npz").report) == str(mesh.report)
    assert len(mesh.smooth().report.needles) == 4


@pytest.mark.parametrize("path", sorted(CORPUS.glob("needle-*.json")), ids=lambda path: path.stem)
def test_needles_of_the_corpus(path: Path) -> None:
    case = json.loads(path.read_text(encoding="utf-8"))
    rings = np.split(np.array(case["points"]), case["rings"][1:])
    polygons = [
        {"type": "Polygon", "coordinates": [[*r, r[0]]]} for r in map(np.ndarray.tolist, rings)
    ]
    features = [{"type": "Feature", "properties": {}, "geometry": p} for p in polygons]
    mesh = delone.mesh({"type": "FeatureCollection", "features": features}, min_angle=20)
    assert mesh.npoints < 2000
    assert set(mesh.report.cause.tolist()) <= {"corner", "needle"}
    assert not mesh.report.exhausted


def test_a_line_is_led_through_a_rounded_crossing_next_to_it() -> None:
    """The side from the first point to the second one passes the crossing by a part of an ulp."""
    case = json.loads((CORPUS / "needle-beside-a-rounded-crossing.json").read_text("utf-8"))
    points = np.array(case["points"])
    segments = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)]
    base = delone.ConstrainedDelaunay(points, segments, crossing="split", boundary="outline")
    indptr, rows = base.segment_source
    common = [set(rows[i:j].tolist()) for i, j in pairwise(indptr)]
    assert {0, 3} in common
    smallest = delone.mesh(base, min_angle=20).report
    assert smallest.smallest_angle > 1e-3
    assert not len(smallest.needles)


@pytest.mark.skipif(not COUNTRIES.exists(), reason="needs the countries of Natural Earth")
@pytest.mark.parametrize("angle", [20, 30])
def test_countries(angle: float) -> None:
    mesh = delone.mesh(json.loads(COUNTRIES.read_text(encoding="utf-8")), min_angle=angle)
    assert mesh.npoints < 100_000
    assert 1 <= len(mesh.report.needles) < 20
    assert_spoilt_by_needles_alone(mesh, 1e-5)
