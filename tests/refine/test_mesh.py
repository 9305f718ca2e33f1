"""Meshes, judged exactly: segments, Delaunay, areas, angles."""

from __future__ import annotations

import copy
import os
import pickle
import signal
import threading
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import (
    BudgetExceededError,
    ConstrainedDelaunay,
    CrossingSegmentsError,
    DtypeError,
    InputError,
)
from delone.refine.rounds import MOST_ADDED
from delone.testing import assert_mesh

SQUARE = np.array([(0.0, 0), (1, 0), (1, 1), (0, 1)])
RING = np.array([(0, 1), (1, 2), (2, 3), (3, 0)])
THIRTY = Fraction(3, 4)


def loops(*rings: Any) -> tuple[np.ndarray, np.ndarray]:
    """Rings of points that each close themselves."""
    points = np.concatenate([np.asarray(ring, dtype=float) for ring in rings])
    ends = np.cumsum([0] + [len(ring) for ring in rings])
    segments = [
        (i, i + 1 if i + 1 < end else start)
        for start, end in pairwise(ends.tolist())
        for i in range(start, end)
    ]
    return points, np.array(segments)


def wavy(count: int, waves: int, radius: float = 1.0) -> np.ndarray:
    angle = np.arange(count) * 2 * np.pi / count
    length = radius * (1 + 0.3 * np.sin(waves * angle))
    return np.column_stack((length * np.cos(angle), length * np.sin(angle)))


def checked(domain: tuple[np.ndarray, np.ndarray], **options: Any) -> delone.Mesh:
    """A mesh whose promises have been checked at 30 degrees."""
    mesh = delone.mesh(domain, **options)
    spoilt = mesh.report.below
    assert set(mesh.report.cause.tolist()) <= {"corner"}
    assert_mesh(mesh, *domain, squared_cosine=THIRTY, spoilt=spoilt)
    return mesh


def test_a_square_stays_two_triangles() -> None:
    mesh = checked((SQUARE, RING))
    assert (mesh.npoints, mesh.nsimplex, mesh.nadded) == (4, 2, 0)
    assert mesh.report.ok
    assert mesh.report.smallest_angle == pytest.approx(45)


@pytest.mark.parametrize("area", [0.1, 0.01, 1e-3])
def test_a_cap_of_area_is_kept(area: float) -> None:
    mesh = checked((SQUARE, RING), max_area=area)
    assert mesh.report.ok
    assert mesh.areas.max() <= area
    assert sum(Fraction(a) for a in mesh.areas.tolist()) == pytest.approx(1)


def test_rings_and_a_hole() -> None:
    domain = loops(wavy(60, 5), wavy(20, 3, 0.3))
    mesh = checked(domain, holes=[(0, 0)], max_area=0.02)
    assert mesh.report.ok
    assert mesh.find_simplex((0, 0)) == -1
    assert mesh.report.added == mesh.nadded == mesh.npoints - 80


def test_points_and_segments_know_where_they_come_from() -> None:
    points = np.concatenate((SQUARE, [(9, 9)], [(0.5, 0.5)]))
    mesh = delone.mesh((points, RING), max_area=0.05)
    old = mesh.point_source >= 0
    # What lies outside is no point of the mesh.
    assert sorted(mesh.point_source[old]) == [0, 1, 2, 3, 5]
    assert np.array_equal(mesh.points[old], points[mesh.point_source[old]])
    start, source = mesh.segment_source
    assert np.array_equal(np.diff(start), np.ones(len(mesh.segments)))
    for row, ends in enumerate(RING.tolist()):
        chain = mesh.segments[source == row]
        assert mesh.point_source[chain[0, 0]] == ends[0]
        assert mesh.point_source[chain[-1, 1]] == ends[1]
        assert np.array_equal(chain[1:, 0], chain[:-1, 1])


def test_sources_of_segments_that_overlap() -> None:
    segments = np.concatenate((RING, [(1, 0)]))
    mesh = delone.mesh((SQUARE, segments), max_area=0.05)
    start, source = mesh.segment_source
    for i in range(len(mesh.segments)):
        rows = source[start[i] : start[i + 1]].tolist()
        bottom = bool((mesh.points[mesh.segments[i], 1] == 0).all())
        assert rows == [0, 4] if bottom else len(rows) == 1


def test_markers_are_inherited() -> None:
    mesh = delone.mesh(
        (SQUARE, RING), max_area=0.02, segment_markers=[5, 6, 7, 0], point_markers=[0, 0, 0, 9]
    )
    marks = {mark: mesh.segments[mesh.segment_markers == mark] for mark in (5, 6, 7, 0)}
    assert (mesh.points[marks[5], 1] == 0).all()
    assert (mesh.points[marks[6], 0] == 1).all()
    assert (mesh.points[marks[7], 1] == 1).all()
    assert (mesh.points[marks[0], 0] == 0).all()
    assert mesh.point_markers[:4].tolist() == [5, 5, 6, 9]
    added = mesh.point_source < 0
    bottom = added & (mesh.points[:, 1] == 0)
    assert set(mesh.point_markers[bottom].tolist()) == {5}
    inner = added & ((mesh.points > 0) & (mesh.points < 1)).all(axis=1)
    assert inner.any()
    assert set(mesh.point_markers[inner].tolist()) == {0}


def test_regions_have_their_caps() -> None:
    points = np.array([(0.0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)])
    segments = np.array([(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)])
    mesh = checked(
        (points, segments), regions=[(0.5, 0.5, 7), (1.5, 0.5, 3)], max_area={7: 0.001, 3: 0.1}
    )
    for label, cap in ((7, 0.001), (3, 0.1)):
        areas = mesh.areas[mesh.region == label]
        assert areas.sum() == pytest.approx(1)
        assert areas.max() <= cap
    assert np.count_nonzero(mesh.region == 7) > 5 * np.count_nonzero(mesh.region == 3)
    with pytest.raises(InputError, match="no region 4"):
        delone.mesh((points, segments), regions=[(0.5, 0.5, 7)], max_area={4: 1})


def test_geometries_are_meshed_inside() -> None:
    ring = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)]
    hole = [(1, 1), (2, 1), (2, 2), (1, 2), (1, 1)]
    beside = [(4, 0), (6, 0), (6, 4), (4, 4), (4, 0)]
    shapes = [
        {"type": "Polygon", "coordinates": [ring, hole]},
        {"type": "Polygon", "coordinates": [beside]},
    ]
    mesh = delone.mesh(shapes, size={0: 1.0, 1: 0.3})
    assert mesh.areas[mesh.region == 0].sum() == pytest.approx(15)
    assert mesh.areas[mesh.region == 1].sum() == pytest.approx(8)
    assert mesh.report.ok


RINGED = {
    "type": "Polygon",
    "coordinates": [
        [(0, 0), (6, 0), (6, 6), (0, 6)],
        [(1, 1), (2, 1), (2, 2), (1, 2)],
        [(3, 3), (5, 3), (5, 5), (3, 5)],
    ],
}
BESIDE = {"type": "Polygon", "coordinates": [[(6, 0), (9, 0), (9, 6), (6, 6)]]}
POINT_AND_LINE = [
    {"type": "Point", "coordinates": (7, 1)},
    {"type": "LineString", "coordinates": [(7, 2), (8, 4)]},
]


def test_each_ring_and_line_has_its_own_marker() -> None:
    mesh = delone.mesh([RINGED, *POINT_AND_LINE, BESIDE], size=0.7)
    middle = mesh.points[mesh.segments].mean(axis=1)
    x, y = middle.T
    small = (np.abs(middle - 1.5) <= 0.5).all(axis=1)
    large = (np.abs(middle - 4) <= 1).all(axis=1)
    line = (x > 6) & (x < 9) & (y > 0) & (y < 6)
    outer = ~(small | large | line) & (x <= 6)
    assert set(mesh.segment_markers[outer].tolist()) == {1}
    assert set(mesh.segment_markers[small].tolist()) == {2}
    assert set(mesh.segment_markers[large].tolist()) == {3}
    assert set(mesh.segment_markers[line].tolist()) == {4}
    assert set(mesh.segment_markers[x > 6].tolist()) == {4, 5}
    assert set(mesh.geometry_of_segment[x <= 6].tolist()) == {0}
    assert set(mesh.geometry_of_segment[line].tolist()) == {2}
    assert set(mesh.geometry_of_segment[~line & (x > 6)].tolist()) == {3}
    # Points of the input and points that were added have a marker of their segment.
    assert mesh.point_markers[mesh.segments[small]].min() == 2
    assert mesh.point_markers[mesh.segments[small]].max() == 2


def test_lines_outside_of_the_domain_shift_no_numbers() -> None:
    outside = {"type": "LineString", "coordinates": [(-5, 0), (-5, 2), (-4, 3)]}
    mesh = delone.mesh([outside, RINGED], size=2)
    assert set(mesh.segment_markers.tolist()) == {2, 3, 4}
    assert set(mesh.geometry_of_segment.tolist()) == {1}


def test_rings_stay_apart_where_a_constrained_triangulation_is_meshed() -> None:
    base = delone.from_geometry(RINGED, boundary="polygons")
    assert base.part_of_segment.tolist() == [0] * 4 + [1] * 4 + [2] * 4
    mesh = delone.mesh(base, size=1)
    assert set(mesh.segment_markers.tolist()) == {1, 2, 3}
    assert set(mesh.geometry_of_segment.tolist()) == {0}
    # Segments that an edit adds, and those from arrays, came from no geometry.
    with base.edit() as edit:
        edit.remove_segments([4, 5, 6, 7])
        edit.insert_segments([(0, 8)])
    assert edit.result.part_of_segment.tolist() == [0] * 4 + [2] * 4 + [-1]
    edited = delone.mesh(edit.result)
    assert set(edited.segment_markers.tolist()) == {0, 1, 3}
    assert (edited.geometry_of_segment == np.where(edited.segment_markers, 0, -1)).all()


def test_markers_that_are_given_count_and_arrays_have_none() -> None:
    given = delone.mesh(RINGED, segment_markers=np.arange(12) + 50)
    assert set(given.segment_markers.tolist()) == set(range(50, 62))
    assert set(given.geometry_of_segment.tolist()) == {0}
    plain = delone.mesh((SQUARE, RING), max_area=0.1)
    assert not plain.segment_markers.any()
    assert not plain.point_markers.any()
    assert set(plain.geometry_of_segment.tolist()) == {-1}


@pytest.mark.parametrize("change", ["refine", "coarsen", "smooth", "load", "pickle"])
def test_geometries_of_segments_are_inherited(change: str, tmp_path: Path) -> None:
    mesh = delone.mesh([RINGED, BESIDE], size=0.8)
    if change == "load":
        mesh.save(tmp_path / "mesh.npz")
        made = delone.Mesh.load(tmp_path / "mesh.npz")
    elif change == "pickle":
        made = pickle.loads(pickle.dumps(mesh))
    else:
        made = getattr(mesh, change)()
    for mine in (mesh, made):
        east = (mine.points[mine.segments][..., 0] >= 6).all(axis=1)
        east &= (mine.points[mine.segments][..., 0] > 6).any(axis=1)
        assert (mine.geometry_of_segment == east).all()
    assert set(made.segment_markers.tolist()) == {1, 2, 3, 4}


def test_the_whole_hull_of_a_constrained_triangulation() -> None:
    rng = np.random.default_rng(5)
    points = rng.random((40, 2))
    base = ConstrainedDelaunay(points, [(0, 1)])
    mesh = delone.mesh(base)
    assert_mesh(mesh, points, [(0, 1)], squared_cosine=THIRTY, spoilt=mesh.report.below)
    assert mesh.areas.sum() == pytest.approx(base.areas.sum())
    start, source = mesh.segment_source
    assert set(source.tolist()) == {0}
    assert (np.diff(start) == 0).any()


@pytest.mark.parametrize("degrees", [0, 10, 20, 26, 33])
def test_bounds_of_angles(degrees: float) -> None:
    mesh = delone.mesh(loops(wavy(80, 7)), min_angle=degrees)
    assert mesh.report.ok
    bound = Fraction(np.cos(np.radians(degrees)) ** 2 * (1 + 1e-15))
    assert_mesh(mesh, *loops(wavy(80, 7)), squared_cosine=bound)
    assert mesh.report.smallest_angle >= degrees - 1e-12


def test_delaunay_across_segments() -> None:
    points = np.array([(0.0, 0), (10, 0), (10, 4), (0, 4), (5, 0.6)])
    mesh = delone.mesh((points, RING), delaunay=True, min_angle=20)
    plain = delone.mesh((points, RING), min_angle=20)
    assert mesh.npoints > plain.npoints
    free = delone.Delaunay(mesh.points)
    ours, theirs = (
        {tuple(sorted(t)) for t in simplices.tolist()}
        for simplices in (mesh.simplices, free.simplices)
    )
    assert ours <= theirs


def test_frozen_segments_are_not_split() -> None:
    points, segments = loops(wavy(60, 5), wavy(30, 3, 0.4))
    mesh = delone.mesh((points, segments), fixed="boundary", max_area=0.002)
    boundary = mesh.point_source[mesh.boundary]
    assert len(boundary) == 60
    assert (boundary >= 0).all()
    assert len(mesh.segments) > 90
    whole = delone.mesh((points, segments), fixed=True)
    assert len(whole.segments) == 90
    assert whole.report.on_segments == 0
    some = np.zeros(90, dtype=bool)
    some[::2] = True
    part = delone.mesh((points, segments), fixed=some, max_area=0.001)
    _start, source = part.segment_source
    counts = np.bincount(source, minlength=90)
    assert (counts[some] == 1).all()
    assert (counts[~some] > 1).any()


def test_sizes_are_kept_between_frozen_segments() -> None:
    mesh = delone.mesh((SQUARE, RING), fixed=True, max_area=0.001)
    assert_mesh(mesh, SQUARE, RING)
    assert len(mesh.segments) == 4
    assert mesh.areas.max() <= 0.001
    assert not mesh.report.exhausted
    assert set(mesh.report.cause.tolist()) <= {"fixed"}


def test_small_angles_at_fixed_segments_have_that_cause() -> None:
    thin = [(0, 0), (6, 0), (6, 6), (0, 6), (1, 0.01), (5, 0.01)]
    mesh = delone.mesh((thin, [*RING, (4, 5)]), fixed=True)
    assert set(mesh.report.cause.tolist()) == {"fixed"}
    assert "at fixed segments" in str(mesh.report)


def test_what_is_no_function_is_refused_before_the_work() -> None:
    for call in (
        lambda: delone.mesh("no domain", progress=3),
        lambda: delone.mesh((SQUARE, RING)).refine(progress="often"),
        lambda: delone.lloyd(SQUARE, clip="box", progress=3),
        lambda: delone.improve(delone.Delaunay(np.eye(4)[:, :3]), progress=3),
        lambda: delone.interpolate.grid(SQUARE, [0.0] * 4, shape=(2, 2), progress=3),
        lambda: delone.interpolate.cross_validate(SQUARE, [0.0] * 4, progress=3),
    ):
        with pytest.raises(InputError, match="progress must be a function or None"):
            call()


def test_a_budget_ends_the_work_and_is_reported() -> None:
    mesh = delone.mesh(loops(wavy(60, 5)), max_points=10)
    assert mesh.report.exhausted
    assert not mesh.report
    assert mesh.nadded == 10
    assert set(mesh.report.cause.tolist()) == {"budget"}
    assert "limit on points" in str(mesh.report)


def test_too_small_sizes_are_refused_before_the_work() -> None:
    for options in (
        {"max_area": 1e-12},
        {"size": 1e-6},
        {"size": lambda xy: np.full(len(xy), 1e-6)},
    ):
        with pytest.raises(BudgetExceededError, match="triangles") as caught:
            delone.mesh((SQUARE, RING), **options)
        assert caught.value.limit == 5_000_000
        assert caught.value.found > 5_000_000


@pytest.mark.parametrize("angle", [-1, 60, 90, float("nan"), float("inf")])
def test_angles_out_of_range(angle: float) -> None:
    with pytest.raises(ValueError, match="min_angle"):
        delone.mesh((SQUARE, RING), min_angle=angle)


def test_a_warning_above_33_degrees() -> None:
    with pytest.warns(UserWarning, match="33"):
        delone.mesh((SQUARE, RING), min_angle=34)


def test_what_encloses_nothing() -> None:
    with pytest.raises(InputError, match=r"open.*points 0, 3"):
        delone.mesh((SQUARE, RING[:3]))
    with pytest.raises(CrossingSegmentsError):
        delone.mesh((SQUARE, [(0, 2), (1, 3), (0, 1), (2, 3)]))
    bow = delone.mesh((SQUARE, [(0, 2), (1, 3), (0, 1), (2, 3)]), crossing="split")
    assert bow.areas.sum() == pytest.approx(0.5)
    with pytest.raises(InputError, match="conforming"):
        delone.mesh((SQUARE, RING), conforming=False)


def test_same_mesh_every_time() -> None:
    domain = loops(wavy(200, 9), wavy(50, 4, 0.3))
    meshes = [delone.mesh(domain, max_area=0.003, workers=w) for w in (1, 2, None)]
    for other in meshes[1:]:
        for name in ("points", "simplices", "neighbors", "segments", "point_source"):
            assert np.array_equal(getattr(meshes[0], name), getattr(other, name))


def test_meshes_are_immutable_and_travel() -> None:
    mesh = delone.mesh((SQUARE, RING), max_area=0.05, segment_markers=[1, 2, 3, 4])
    with pytest.raises(AttributeError):
        mesh.points = 3  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        mesh.points[0] = 1
    other = pickle.loads(pickle.dumps(mesh))
    assert copy.deepcopy(mesh) is mesh
    for name in ("points", "simplices", "segments", "segment_markers", "region", "point_markers"):
        assert np.array_equal(getattr(mesh, name), getattr(other, name))
    assert str(other.report) == str(mesh.report)
    assert len(mesh.boundary) >= 4


def test_progress_is_told() -> None:
    told: list[tuple[int, float]] = []
    delone.mesh((SQUARE, RING), max_area=2e-6, progress=lambda *now: told.append(now))
    assert told
    assert all(angle <= 60 and added > 0 for added, angle in told)

    def stop(added: int, angle: float) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        delone.mesh((SQUARE, RING), max_area=2e-6, progress=stop)


def test_interruption_returns_control_and_loses_nothing() -> None:
    # A shell may ignore the signal for what it starts in the background.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    mesh = delone.mesh((SQUARE, RING), max_area=0.001)
    before = mesh.points.copy()
    for work in (
        lambda: delone.mesh((SQUARE, RING), max_area=2e-7),
        lambda: mesh.refine(max_area=2e-7),
    ):
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            work()
        timer.join()
    assert np.array_equal(mesh.points, before)
    assert mesh.refine(max_area=0.0005).report


def test_the_default_limit_on_points_keeps_memory_bounded() -> None:
    """A bound that has no end is not tried for ever; here the limit is lower, to be quick."""
    assert MOST_ADDED == 5_000_000
    with pytest.warns(UserWarning, match="59"):
        mesh = delone.mesh(loops(wavy(60, 5)), min_angle=59, max_points=5000)
    assert mesh.report.exhausted
    assert mesh.nadded == 5000


@pytest.mark.parametrize("given", [(), (SQUARE,), (SQUARE, RING)])
def test_the_class_is_not_called(given: tuple[Any, ...]) -> None:
    with pytest.raises(DtypeError, match=r"with delone\.mesh"):
        delone.Mesh(*given)


@pytest.mark.parametrize("kind", [list, tuple, np.array])
def test_points_alone_are_a_ring_or_no_domain(kind: Any) -> None:
    points = kind([(0, 0), (4, 0), (4, 4), (0, 4)])
    assert delone.mesh(points).areas.sum() == 16
    # Scattered points cross as a ring.
    with pytest.raises(CrossingSegmentsError):
        delone.mesh(kind([(0, 0), (4, 4), (4, 0), (0, 4)]))
    with pytest.raises(InputError, match=r"without segments.*\(points, segments\).*a ring"):
        delone.mesh(kind([(0, 0, 1), (4, 0, 1), (4, 4, 1), (0, 4, 1)]))
    assert delone.mesh(delone.ConstrainedDelaunay(points, [])).nsimplex >= 2


def _line(points: list[tuple[float, float]]) -> dict[str, object]:
    return {"type": "LineString", "coordinates": points}


def test_lines_without_polygons_enclose_the_domain() -> None:
    outer = [(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0), (0.0, 0.0)]
    inner = [(2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0), (2.0, 2.0)]
    # As an iterator, which can be read once.
    mesh = delone.mesh(map(_line, (outer, inner)), max_area=1)
    assert mesh.areas.sum() == 36
    middle = mesh.region[mesh.find_simplex((3, 3))]
    assert mesh.areas[mesh.region == middle].sum() == 4
    assert set(mesh.geometry_of_segment.tolist()) == {0, 1}
    # A polygon among them decides: a line around it encloses nothing.
    square = {"type": "Polygon", "coordinates": [inner]}
    assert delone.mesh([_line(outer), square]).areas.sum() == 4


def test_open_lines_enclose_nothing() -> None:
    with pytest.raises(delone.InputError, match="the domain is empty: the outline is open"):
        delone.mesh(_line([(0.0, 0.0), (6.0, 0.0), (6.0, 6.0)]))
