"""Polygons that have broken others: those of the corpus, and those beside the repository."""

from __future__ import annotations

import json
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, CrossingSegmentsError
from delone.reference import orient
from delone.testing import assert_constrained_delaunay, assert_regions

CORPUS = Path(__file__).parents[1] / "corpus"


def cases() -> dict[str, dict[str, Any]]:
    found = {path.stem: json.loads(path.read_text("utf-8")) for path in CORPUS.glob("*.json")}
    return {name: case for name, case in sorted(found.items()) if "rings" in case}


CASES = cases()


@pytest.fixture(params=CASES)
def polygon(request: pytest.FixtureRequest) -> tuple[np.ndarray, np.ndarray]:
    """Points, and the segments of all rings, each of which closes itself."""
    case = CASES[request.param]
    points = np.array(case["points"], dtype=float)
    segments = [
        (row, row + 1 if row + 1 < end else start)
        for start, end in pairwise([*case["rings"], len(points)])
        for row in range(start, end)
    ]
    return points, np.array(segments)


def winding(points: np.ndarray, segments: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Whether places are inside by the even-odd rule: edges met by a ray to the right, exactly."""
    inside = np.zeros(len(places), dtype=bool)
    x, y = ([Fraction(c) for c in column] for column in points.T.tolist())
    px, py = ([Fraction(c) for c in column] for column in places.T.tolist())
    for u, v in segments.tolist():
        (lx, ly), (hx, hy) = sorted(((x[u], y[u]), (x[v], y[v])), key=lambda p: p[1])
        for row in range(len(places)):
            if ly <= py[row] < hy:
                inside[row] ^= (hx - lx) * (py[row] - ly) > (px[row] - lx) * (hy - ly)
    return inside


def test_split_polygons_exactly(polygon: tuple[np.ndarray, np.ndarray]) -> None:
    points, segments = polygon
    mesh = ConstrainedDelaunay(points, segments, crossing="split")
    assert np.array_equal(mesh.points[: len(points)], points)
    assert_constrained_delaunay(mesh, segments, split=True)
    assert_regions(mesh, mesh.region)
    report = mesh.validate()
    assert report, str(report)


def test_outlines_exactly(polygon: tuple[np.ndarray, np.ndarray]) -> None:
    points, segments = polygon
    mesh = ConstrainedDelaunay(points, segments, crossing="split", boundary="outline")
    assert_constrained_delaunay(mesh, segments, split=True, complete=False)
    assert_regions(mesh, mesh.region)
    whole = ConstrainedDelaunay(points, segments, crossing="split")
    kept = {tuple(t) for t in mesh.simplices.tolist()}
    assert kept <= {tuple(t) for t in whole.simplices.tolist()}


@pytest.mark.deep("earcut-water-huge")
def test_crossings_are_those_of_a_direct_search(polygon: tuple[np.ndarray, np.ndarray]) -> None:
    points, segments = polygon
    wanted = crossing_pairs(points, segments)
    if not wanted:
        mesh = ConstrainedDelaunay(points, segments)
        assert mesh.nadded == 0
        assert_constrained_delaunay(mesh, segments)
        return
    with pytest.raises(CrossingSegmentsError) as caught:
        ConstrainedDelaunay(points, segments)
    assert caught.value.pairs.tolist() == wanted
    split = ConstrainedDelaunay(points, segments, crossing="split")
    assert np.unique(split.report.crossings[:, :2], axis=0).tolist() == wanted


def crossing_pairs(points: np.ndarray, segments: np.ndarray) -> list[list[int]]:
    """Pairs of rows that cross where no point is; candidates by their boxes."""
    low, high = points[segments].min(axis=1), points[segments].max(axis=1)
    places = points.tolist()
    found = []
    for i, (a, b) in enumerate(segments.tolist()):
        near = ((low[i + 1 :] <= high[i]) & (high[i + 1 :] >= low[i])).all(axis=1)
        for j in (np.flatnonzero(near) + i + 1).tolist():
            c, d = segments[j].tolist()
            if crosses(*(places[v] for v in (a, b, c, d))) and not any(
                orient(places[a], places[b], p) == orient(places[c], places[d], p) == 0
                for p in points[inside_box(points, low[[i, j]], high[[i, j]])].tolist()
            ):
                found.append([i, j])
    return found


def inside_box(points: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    inside: np.ndarray = ((points >= low.max(axis=0)) & (points <= high.min(axis=0))).all(axis=1)
    return inside


def crosses(a: Any, b: Any, c: Any, d: Any) -> bool:
    return orient(a, b, c) * orient(a, b, d) < 0 and orient(c, d, a) * orient(c, d, b) < 0


@pytest.mark.deep("earcut-water-huge")
def test_regions_do_not_mix_inside_and_outside(polygon: tuple[np.ndarray, np.ndarray]) -> None:
    points, segments = polygon
    mesh = ConstrainedDelaunay(points, segments, crossing="split")
    # A place well within each triangle: rounding does not take it out of one that is fat enough.
    places = mesh.points[mesh.simplices].mean(axis=1)
    fat = np.flatnonzero(mesh.areas > 1e-9 * mesh.areas.max())[:400]
    inside = winding(points, segments, places[fat])
    for region in np.unique(mesh.region[fat]):
        assert len(set(inside[mesh.region[fat] == region].tolist())) == 1
    outside = ConstrainedDelaunay(points, segments, crossing="split", boundary="outline")
    gone = {tuple(t) for t in mesh.simplices[fat].tolist()}
    gone -= {tuple(t) for t in outside.simplices.tolist()}
    for t in fat[inside].tolist():
        assert tuple(mesh.simplices[t].tolist()) not in gone


def test_each_row_joined_to_the_one_before(corpus_case: Any) -> None:
    """Crossings by the hundred, some of them far from every lattice."""
    points = corpus_case.points[:120]
    rows = np.arange(1, len(points))
    segments = np.column_stack((rows, rows - 1))
    mesh = ConstrainedDelaunay(points, segments, crossing="split", max_points=100_000)
    assert_constrained_delaunay(mesh, segments, split=True)
