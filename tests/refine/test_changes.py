"""Meshes made of meshes: finer, coarser, smoother."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import DtypeError, InputError
from delone.refine.domains import sides_in
from delone.refine.smoothing import rebuilt
from delone.testing import assert_mesh
from tiers import seeds

THIRTY = Fraction(3, 4)
POINTS = np.array([(0.0, 0), (4, 0), (4, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2)])
SEGMENTS = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)])
CORNER = np.array([(0.0, 0), (10, 0), (10, 10), (0, 10), (1, 1), (9, 1.2), (9, 1.0)])
RAYS = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (4, 6)])


@pytest.fixture(scope="module")
def mesh() -> delone.Mesh:
    return delone.mesh((POINTS, SEGMENTS), max_area=0.02, segment_markers=np.arange(8) + 1)


def check(mesh: delone.Mesh) -> None:
    assert_mesh(mesh, POINTS, SEGMENTS, squared_cosine=THIRTY)
    assert mesh.areas.sum() == pytest.approx(12)
    assert mesh.areas[mesh.region == mesh.region[mesh.find_simplex((1.5, 1.5))]].sum() == (
        pytest.approx(1)
    )
    _start, source = mesh.segment_source
    assert np.array_equal(mesh.segment_markers, source + 1)


def test_the_triangulation_of_a_mesh_is_the_mesh(mesh: delone.Mesh) -> None:
    simplices, _, labels = mesh._whole
    found = {tuple(sorted(t)) for t in simplices[labels >= 0].tolist()}
    assert found == {tuple(sorted(t)) for t in mesh.simplices.tolist()}


def test_marked_triangles_become_smaller(mesh: delone.Mesh) -> None:
    marked = np.flatnonzero(np.hypot(*(mesh.points[mesh.simplices].mean(axis=1) - 3).T) < 0.5)
    finer = mesh.refine(marked, ratio=0.25)
    check(finer)
    assert np.array_equal(finer.points[: mesh.npoints], mesh.points)
    where = finer.points[finer.simplices].mean(axis=1)
    home = mesh.find_simplex(where)
    inside = np.isin(home, marked)
    assert (finer.areas[inside] <= 0.25 * mesh.areas[home[inside]] * 1.0001).mean() > 0.8
    assert finer.areas[inside].max() <= 0.25 * mesh.areas[marked].max()
    assert finer.report.added == finer.nadded
    mask = np.zeros(mesh.nsimplex, dtype=bool)
    mask[marked] = True
    assert np.array_equal(mesh.refine(mask, ratio=0.25).points, finer.points)


def test_nothing_to_refine_changes_nothing(mesh: delone.Mesh) -> None:
    same = mesh.refine()
    assert same.nsimplex == mesh.nsimplex
    assert mesh.refine([]).nsimplex == mesh.nsimplex
    with pytest.raises(DtypeError, match="ratio"):
        mesh.refine([0], ratio="half")  # type: ignore[arg-type]
    for wrong in ([-1], [mesh.nsimplex], np.zeros(3, dtype=bool), [[0]]):
        with pytest.raises(InputError):
            mesh.refine(wrong)


def test_sharp_corners_are_remembered() -> None:
    """Refining again leaves what the input spoils, and does not start to work at it."""
    mesh = delone.mesh((CORNER, RAYS))
    again = mesh.refine()
    assert again.npoints == mesh.npoints
    near = np.flatnonzero(np.hypot(*(mesh.points[mesh.simplices].mean(axis=1) - 1).T) < 2)
    finer = mesh.refine(near).refine()
    assert finer.npoints < 4 * mesh.npoints
    assert_mesh(finer, CORNER, RAYS, squared_cosine=THIRTY, spoilt=finer.report.below)
    assert set(finer.report.cause.tolist()) == {"corner"}


def test_coarsening_keeps_what_is_promised(mesh: delone.Mesh) -> None:
    coarser = mesh.coarsen()
    check(coarser)
    assert coarser.npoints < 0.95 * mesh.npoints
    twice = coarser.coarsen()
    check(twice)
    assert twice.npoints < coarser.npoints
    marked = mesh.find_simplex([(3, 2)])
    check(mesh.coarsen(marked))
    assert mesh.coarsen([]) is mesh


def star(spikes: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A star with inner corners at random distances from its center."""
    n = 2 * spikes
    angle = np.arange(n) * (2 * np.pi / n)
    inner = 0.35 + 0.5 * np.random.default_rng(seed).random(n)
    radius = np.where(np.arange(n) % 2 == 0, 1.0, inner)
    points = np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))
    return points, np.column_stack((np.arange(n), (np.arange(n) + 1) % n))


@pytest.mark.parametrize(("spikes", "seed"), [(9, 51), (5, 56), (7, 57), (5, 58), (7, 58), (7, 59)])
def test_coarsening_keeps_the_bound_at_corners_above_it(spikes: int, seed: int) -> None:
    """Such corners are sharp enough for the core to leave a smaller angle at them."""
    fine = delone.mesh(star(spikes, seed), min_angle=28, max_area=0.01)
    assert fine.report
    coarse = fine.coarsen()
    assert coarse.npoints < fine.npoints
    assert coarse.report


@pytest.mark.parametrize("method", ["lloyd", "odt", "laplace"])
def test_smoothing_keeps_what_is_promised(mesh: delone.Mesh, method: str) -> None:
    better = mesh.smooth(4, method)
    check(better)
    fixed = (mesh.point_source >= 0) | (mesh._on >= 0)
    assert np.array_equal(better.points[fixed], mesh.points[fixed])
    assert not np.array_equal(better.points, mesh.points)
    before, after = mesh.quality(), better.quality()
    assert after.radius_ratio.mean() > before.radius_ratio.mean()
    assert after.smallest_angle.min() >= 30 - 1e-9


def winding(seed: int) -> Any:
    """A wavy ring with a hole, and lines that cross it."""
    rng = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    circle = np.column_stack((np.cos(angle), np.sin(angle)))
    outer = circle * (2 + 0.4 * np.sin(7 * angle))[:, None]
    rings = [[*ring.tolist(), ring[0].tolist()] for ring in (outer, circle[::-4] * 0.3)]
    lines = [rng.uniform(-1, 1, (2, 2)).tolist() for _ in range(4)]
    shapes = [{"type": "LineString", "coordinates": line} for line in lines]
    return [{"type": "Polygon", "coordinates": rings}, *shapes]


@pytest.mark.parametrize("min_angle", [25, 0])
@pytest.mark.parametrize("method", ["lloyd", "odt", "laplace"])
@pytest.mark.parametrize("seed", seeds(3, deep=40))
def test_smoothed_meshes_are_canonical(seed: int, method: str, min_angle: float) -> None:
    def size(xy: Any) -> Any:
        return 0.02 + 0.3 * np.hypot(*xy.T)

    mesh = delone.mesh(winding(seed), size=size, min_angle=min_angle)
    better = mesh.smooth(3, method)
    assert better.validate()
    assert len(better.report.below) <= len(mesh.report.below)
    moved = (better.points != mesh.points).any(axis=1)
    assert moved.mean() > 0.3 and not moved[~mesh._inner].any()
    # The triangles, lines and regions are those of a fresh triangulation of the moved points.
    again, lost = rebuilt(mesh, better.points, np.arange(mesh.npoints, dtype=np.int32))
    assert again is not None and not len(lost)

    def table(simplices: Any, sides: Any, labels: Any) -> set[tuple[Any, ...]]:
        first = simplices.argmin(axis=1)
        order = (first[:, None] + np.arange(3)) % 3
        corners = np.take_along_axis(simplices, order, axis=1)
        lines = np.take_along_axis(sides, order, axis=1)
        return set(map(tuple, np.column_stack((corners, lines, labels)).tolist()))

    inside = again.labels >= 0
    expected = again.simplices[inside], sides_in(again)[inside], again.regions[again.labels[inside]]
    assert table(better.simplices, better._sides, better.region) == table(*expected)
    beyond = better.neighbors
    for k in range(3):
        t = np.flatnonzero(beyond[:, k] >= 0)
        back = beyond[beyond[t, k]] == t[:, None]
        assert (back.sum(axis=1) == 1).all()
    one = delone.mesh(winding(seed), size=size, min_angle=min_angle, workers=1)
    assert np.array_equal(one.smooth(3, method).points, better.points)


@pytest.mark.parametrize("seed", range(4))
def test_no_triangle_is_turned_over(seed: int) -> None:
    """Needles between near lines: the mean of the neighbors is often beyond a triangle."""
    rng = np.random.default_rng(seed)
    x = np.sort(rng.random(12))
    saw = np.column_stack((np.repeat(x, 2), np.tile([0.02, 0.98], 12)))
    lines = [{"type": "LineString", "coordinates": pair} for pair in saw.reshape(-1, 2, 2).tolist()]
    square = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]]}
    mesh = delone.mesh([square, *lines], max_area=0.002, min_angle=0)
    for method in ("lloyd", "odt", "laplace"):
        better = mesh.smooth(6, method)
        assert better.validate() and better.areas.sum() == pytest.approx(1)


def test_a_point_that_would_turn_a_triangle_over_goes_part_of_the_way() -> None:
    """The mean of the neighbors of a point in a narrow bay lies beyond the opposite side."""
    bay = [(0, 0), (10, 0), (10, 10), (9, 10), (9, 1), (1, 1), (1, 10), (0, 10)]
    mesh = delone.mesh({"type": "Polygon", "coordinates": [[*bay, bay[0]]]}, max_area=2)
    for rounds in range(1, 12):
        better = mesh.smooth(rounds, "laplace")
        assert better.validate() and better.areas.sum() == pytest.approx(28)


def test_smoothing_beside_sharp_corners() -> None:
    mesh = delone.mesh((CORNER, RAYS), max_area=0.3)
    better = mesh.smooth(5, "odt")
    assert_mesh(better, CORNER, RAYS, squared_cosine=THIRTY, spoilt=better.report.below)
    assert len(better.report.below) <= len(mesh.report.below)


def test_crossings_of_segments_stay() -> None:
    """They were added, but hold segments together."""
    shapes = [
        {"type": "Polygon", "coordinates": [[(0, 0), (6, 0), (6, 5), (0, 5), (0, 0)]]},
        {"type": "LineString", "coordinates": [(1, 1), (5, 4)]},
        {"type": "LineString", "coordinates": [(1, 4), (5, 1.5)]},
        {"type": "LineString", "coordinates": [(3, -1), (3.5, 6)]},
    ]
    mesh = delone.mesh(shapes, max_area=0.02)
    ends = np.flatnonzero((mesh.point_source < 0) & np.isin(np.arange(mesh.npoints), mesh._ends))
    assert len(ends) == 5
    places = {tuple(p) for p in mesh.points[ends].tolist()}
    for other in (mesh.coarsen(), mesh.smooth(3, "laplace"), mesh.coarsen().coarsen().smooth(2)):
        assert places <= {tuple(p) for p in other.points.tolist()}
        assert other.areas.sum() == pytest.approx(30)
        assert len(other.report.below) <= len(mesh.report.below)


CORPUS = Path(__file__).parents[1] / "corpus"


@pytest.mark.parametrize("name", ["earcut-bad-hole", "earcut-water", "earcut-touching-holes"])
def test_real_outlines_that_cross(name: str) -> None:
    case = json.loads((CORPUS / f"{name}.json").read_text("utf-8"))
    points = np.array(case["points"], dtype=float)
    rings = np.split(points, case["rings"][1:])
    shape = {"type": "Polygon", "coordinates": [[*r.tolist(), r[0].tolist()] for r in rings]}
    mesh = delone.mesh(shape, max_area=np.ptp(points, axis=0).prod() / 2000)
    other = mesh.refine(np.arange(0, mesh.nsimplex, 7)).coarsen().smooth(2, "odt")
    assert other.areas.sum() == pytest.approx(mesh.areas.sum())
    assert len(other.report.below) <= 1.1 * len(mesh.report.below) + 2


def test_smoothing_while_meshing() -> None:
    plain = delone.mesh((POINTS, SEGMENTS), max_area=0.02)
    smooth = delone.mesh((POINTS, SEGMENTS), max_area=0.02, smooth=3)
    assert np.array_equal(smooth.points, plain.smooth(3).points)
    with pytest.raises(InputError, match="method"):
        plain.smooth(1, "other")


def test_measures() -> None:
    mesh = delone.mesh((POINTS, SEGMENTS), max_area=0.1)
    q = mesh.quality()
    a, b, c = (mesh.points[mesh.simplices[:, k]] for k in range(3))
    sides = np.array([np.hypot(*(c - b).T), np.hypot(*(a - c).T), np.hypot(*(b - a).T)])
    s = sides.sum(axis=0) / 2
    inner = mesh.areas / s
    outer = sides.prod(axis=0) / (4 * mesh.areas)
    assert q.radius_ratio == pytest.approx(2 * inner / outer)
    assert q.edge_ratio == pytest.approx(sides.max(axis=0) / sides.min(axis=0))
    cosines = np.array(
        [(sides[k - 1] ** 2 + sides[k - 2] ** 2 - sides[k] ** 2) / (2 * sides[k - 1] * sides[k - 2])
         for k in range(3)]
    )  # fmt: skip
    angles = np.degrees(np.arccos(cosines))
    assert q.smallest_angle == pytest.approx(angles.min(axis=0))
    assert q.largest_angle == pytest.approx(angles.max(axis=0))
    assert q.area == pytest.approx(mesh.areas)
    assert q.summary()["smallest_angle"]["min"] == q.smallest_angle.min()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("k", [-1000, -920, -600, -300, 300, 600, 900, 1000])
def test_changes_at_any_magnitude(k: int) -> None:
    """Powers of two change nothing: areas and squares of lengths are not asked of doubles."""
    points = np.array([(0.0, 0), (10, 0), (10, 10), (0, 10), (5, 0.5)])
    segments = [(0, 1), (1, 2), (2, 3), (3, 0)]
    plain, scaled = (delone.mesh((points * unit, segments)) for unit in (1, 2.0**k))
    assert np.array_equal(scaled.points, plain.points * 2.0**k)
    changes = [
        lambda mesh: mesh.refine(range(mesh.nsimplex), ratio=0.1),
        lambda mesh: mesh.refine(range(9)).coarsen(),
        lambda mesh: mesh.smooth(2, "lloyd"),
        lambda mesh: mesh.smooth(2, "odt"),
        lambda mesh: mesh.smooth(2, "laplace"),
    ]
    for change in changes:
        expected, found = change(plain), change(scaled)
        assert not np.array_equal(expected.points, plain.points)
        assert np.array_equal(found.points, expected.points * 2.0**k)
        assert np.array_equal(found.simplices, expected.simplices)
        assert str(found.report) == str(expected.report)
