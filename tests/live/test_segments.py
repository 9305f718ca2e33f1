"""Every edit of points and segments leaves the triangulation that a fresh build has."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import random
import threading
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from delone import (
    ConstrainedDelaunay,
    CrossingSegmentsError,
    DegenerateInputError,
    DtypeError,
    Dynamic,
    HandleError,
    InputError,
)
from delone.dynamic import DynamicReport, validation
from tiers import seeds

CIRCLE = [
    (sx * x, sy * y)
    for x, y in [(5.0, 0.0), (0.0, 5.0), (3.0, 4.0), (4.0, 3.0)]
    for sx in (1, -1)
    for sy in (1, -1)
] + [(0.0, 0.0)]

JUNCTIONS = [(0.1, 0.2), (9.3, 7.7), (0.4, 8.1), (8.8, 0.3), (5.2, 9.9)]


def on_a_road(draw: random.Random) -> tuple[float, float]:
    """Return a junction, or a point of one of few roads between them, rounded."""
    (a, b), (c, d) = draw.sample(JUNCTIONS, 2)
    t = draw.randrange(9) / 8 if draw.random() < 0.5 else draw.random()
    return a + t * (c - a), b + t * (d - b)


PLACES = {
    "roads": on_a_road,
    "lattice of 3": lambda draw: (float(draw.randrange(3)), float(draw.randrange(3))),
    "lattice of 6": lambda draw: (float(draw.randrange(6)), float(draw.randrange(6))),
    "circle": lambda draw: draw.choice(CIRCLE),
    "square": lambda draw: (draw.random(), draw.random()),
    "few doubles": lambda draw: (1e6 + draw.randrange(8) * 2**-30, draw.randrange(8) * 2**-33),
    "exponents": lambda draw: (
        draw.choice([1e-300, 1.0, 1e9, -1e300]) * draw.random(),
        draw.choice([0.0, 5e-324, 1.0, 1e9]) * draw.random(),
    ),
}


class Twin:
    """A live triangulation, its points and segments by handle, and edits drawn at random."""

    def __init__(self, draw: random.Random, place: Any, crossing: str) -> None:
        self.draw, self.place, self.crossing = draw, place, crossing
        # How often points are removed with their segments.
        self.cleared = 0.5
        start = [place(draw) for _ in range(draw.randrange(20))]
        self.live = Dynamic(np.array(start).reshape(-1, 2), crossing=crossing)
        self.points = dict(enumerate(start))
        self.segments: dict[int, tuple[int, int]] = {}
        self.kept: list[Any] = []

    def some(self, items: Any, most: int) -> list[Any]:
        listed = sorted(items)
        return self.draw.sample(listed, min(len(listed), self.draw.randrange(1, most)))

    def insert(self) -> None:
        new = [self.place(self.draw) for _ in range(self.draw.randrange(1, 4))]
        self.points |= zip(self.live.insert(new).tolist(), new, strict=True)

    def remove(self) -> None:
        gone = set(self.some(self.points, 4))
        ends = {end for pair in self.segments.values() for end in pair}
        if gone & ends:
            with pytest.raises(HandleError, match="is an end of segment"):
                self.live.remove(sorted(gone))
            if self.draw.random() < self.cleared:
                own = [s for s, pair in sorted(self.segments.items()) if gone & {*pair}]
                assert self.live.remove(sorted(gone), segments="remove").tolist() == own
                self.segments = {s: p for s, p in self.segments.items() if s not in own}
                self.points = {h: p for h, p in self.points.items() if h not in gone}
                return
            gone -= ends
        self.live.remove(sorted(gone))
        self.points = {h: p for h, p in self.points.items() if h not in gone}

    def move(self) -> None:
        moved = {h: self.place(self.draw) for h in self.some(self.points, 4)}
        self.live.move(list(moved), np.array(list(moved.values())).reshape(-1, 2))
        self.points |= moved

    def link(self) -> None:
        if self.points:
            there = sorted(self.points)
            new = [(self.draw.choice(there), self.draw.choice(there)) for _ in range(2)]
            made = self.live.insert_segments(new).tolist()
            self.segments |= zip(made, new, strict=True)

    def unlink(self) -> None:
        gone = self.some(self.segments, 3)
        self.live.remove_segments(gone)
        self.segments = {s: pair for s, pair in self.segments.items() if s not in gone}

    def keep(self) -> None:
        self.kept.append((self.live.snapshot(), dict(self.points), dict(self.segments)))

    def restore(self) -> None:
        if self.kept:
            state, points, segments = self.draw.choice(self.kept)
            self.live.restore(state)
            self.points, self.segments = dict(points), dict(segments)

    def duplicate(self) -> None:
        before = self.live
        self.live = self.draw.choice([copy.copy, lambda x: pickle.loads(pickle.dumps(x))])(before)
        for name in ("handles", "crossings", "input_segments"):
            assert np.array_equal(getattr(self.live, name), getattr(before, name)), name

    def step(self) -> None:
        edits = [self.insert] * 2 + [self.remove, self.move, self.move] + [self.link] * 3
        edits += [self.unlink, self.keep, self.restore, self.duplicate]
        before = (dict(self.points), dict(self.segments))
        try:
            self.draw.choice(edits)()
        except CrossingSegmentsError as error:
            assert self.crossing == "raise"
            assert len(error.pairs) > 0
            self.points, self.segments = before

    def agree(self) -> None:
        live, handles = self.live, sorted(self.points)
        assert live.segment_handles.tolist() == sorted(self.segments)
        added = set(live.crossings[:, 2].tolist()) - set(handles)
        assert set(live.handles.tolist()) == added | set(handles)
        points = np.array([self.points[h] for h in handles]).reshape(-1, 2)
        ends = [self.segments[s] for s in sorted(self.segments)]
        rows = np.searchsorted(handles, np.array(ends, dtype=int).reshape(-1, 2))
        try:
            fresh = ConstrainedDelaunay(points, rows, crossing=self.crossing)
        except DegenerateInputError:
            assert live.nsimplex == 0
            return
        first: dict[tuple[float, ...], int] = {}
        for row, p in enumerate(map(tuple, fresh.points.tolist())):
            first.setdefault(p, row)
        place = np.array([first[p] for p in map(tuple, live.points.tolist())])
        own, marked = place[live.simplices], live.constrained
        assert triangles(own) == triangles(fresh.simplices)
        assert edges(own, marked) == edges(fresh.simplices, fresh.constrained)
        assert {frozenset(e) for e in place[live.segments].tolist()} == edges(own, marked)
        met = [
            (s, t, first[tuple(live.points[live.handles == v][0])]) for s, t, v in live.crossings
        ]
        numbers = live.segment_handles
        expected = [(numbers[s], numbers[t], v) for s, t, v in fresh.report.crossings]
        assert sorted(met) == sorted(expected)
        assert live.validate(), str(live.validate())

    def nearest(self) -> None:
        for x, y in [self.place(self.draw) for _ in range(2 if len(self.live) else 0)]:
            squares = [
                (Fraction(a) - Fraction(x)) ** 2 + (Fraction(b) - Fraction(y)) ** 2
                for a, b in self.live.points.tolist()
            ]
            assert self.live.nearest((x, y)) == self.live.handles[squares.index(min(squares))]


def triangles(simplices: np.ndarray) -> set[tuple[int, ...]]:
    """Return triangles from their smallest vertex on."""
    turns = [t[k:] + t[:k] for t in simplices.tolist() for k in [t.index(min(t))]]
    return set(map(tuple, turns))


def edges(simplices: np.ndarray, marked: np.ndarray) -> set[frozenset[int]]:
    """Return the marked edges."""
    pairs = [(t, k) for t, k in zip(*np.nonzero(marked), strict=True)]
    return {frozenset((simplices[t, k - 1].item(), simplices[t, k - 2].item())) for t, k in pairs}


@pytest.mark.parametrize("crossing", ["raise", "split"])
@pytest.mark.parametrize("name", PLACES)
@pytest.mark.sampled(3)
def test_every_edit_equals_a_fresh_build(name: str, crossing: str) -> None:
    for seed in range(12):
        twin = Twin(random.Random(f"{name} {seed}"), PLACES[name], crossing)
        for _ in range(15):
            twin.step()
            twin.agree()
            twin.nearest()


def test_long_segments_through_many_points() -> None:
    draw = np.random.default_rng(3)
    points = draw.random((4000, 2))
    live = Dynamic(points, crossing="split")
    live.insert_segments([(0, 1), (2, 3)])
    live.insert_segments(np.arange(4, 44).reshape(-1, 2))
    live.remove_segments(np.arange(0, live.segment_handles[-1], 3))
    moved = np.arange(30, 40)
    live.move(moved, draw.random((10, 2)))
    fresh = ConstrainedDelaunay(
        live.points[:4000], live.input_segments.astype(np.int32), crossing="split"
    )
    assert live.nsimplex == fresh.nsimplex
    assert live.validate()


@pytest.mark.deep
def test_edits_of_crossings_stay_local() -> None:
    draw = np.random.default_rng(5)
    live = Dynamic(draw.random((20_000, 2)), crossing="split")
    centers = 0.1 + 0.8 * draw.random((150, 1, 2))
    crosses = [(-0.01, -0.01), (0.01, 0.012), (-0.01, 0.01), (0.012, -0.01)]
    handles = live.insert((centers + crosses).reshape(-1, 2)).reshape(-1, 2)
    segments = live.insert_segments(handles)
    assert len(live.crossings) >= 150
    kept = set(live.crossings[:, 2].tolist())
    edits = (
        lambda: live.insert_segments([handles[0] + [0, 2], handles[2]]),
        lambda: live.move(handles[5], live.points[handles[5]] + [(0.001, 0), (0, 0.001)]),
        lambda: live.remove_segments(segments[[8, 11]]),
        lambda: live.move(handles[20], live.points[handles[24]] + 1e-4),
        lambda: live.insert_segments([(handles[9, 0], handles[14, 1])]),
    )
    for edit in edits:
        before = live.snapshot()
        edit()
        # All of it is more than 2 MB.
        assert live.snapshot().bytes_beyond(before) < 400_000
        assert live.validate()
        rows = np.flatnonzero(~np.isin(live.handles, live.crossings[:, 2]))
        ends = np.searchsorted(live.handles[rows], live.input_segments)
        fresh = ConstrainedDelaunay(live.points[rows], ends, crossing="split")
        assert fresh.nadded == len(live) - len(rows)
        assert places(live.points, live.simplices) == places(fresh.points, fresh.simplices)
        assert len(kept & set(live.crossings[:, 2].tolist())) >= 130


def places(points: np.ndarray, simplices: np.ndarray) -> set[frozenset[tuple[float, ...]]]:
    """Return the triangles as sets of coordinates."""
    return {frozenset(map(tuple, corners)) for corners in points[simplices].tolist()}


def test_a_dynamic_from_a_constrained_triangulation_has_its_segments() -> None:
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    mesh = ConstrainedDelaunay(square, [(0, 2), (1, 3)], crossing="split")
    live = Dynamic(mesh)
    assert live.input_segments.tolist() == [[0, 2], [1, 3]]
    assert live.crossings.tolist() == [[0, 1, 4]]
    assert live.points[4].tolist() == [2.0, 2.0]
    assert np.array_equal(live.freeze().simplices, mesh.simplices)
    live.remove_segments([1])
    assert live.handles.tolist() == [0, 1, 2, 3]


def test_errors_of_segments_name_them_and_change_nothing() -> None:
    live = Dynamic([(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)], [(0, 2)])
    before = live.simplices
    with pytest.raises(CrossingSegmentsError) as raised:
        live.insert_segments([(4, 1), (1, 3)])
    assert raised.value.pairs.tolist() == [[0, 2]]
    with pytest.raises(HandleError, match="handle 9 is not there"):
        live.insert_segments([(0, 9)])
    with pytest.raises(HandleError, match="segments 5, 7 are not there"):
        live.remove_segments([5, 0, 7])
    with pytest.raises(HandleError, match="segment 0 is named twice"):
        live.remove_segments([0, 0])
    with pytest.raises(HandleError, match="handle 2 is an end of segment 0: remove that one first"):
        live.remove([4, 2])
    with pytest.raises(CrossingSegmentsError):
        Dynamic(live.points, [(0, 2), (1, 3)])
    with pytest.raises(InputError, match="segment 1 is"):
        Dynamic(live.points, [(0, 2), (1, 5)])
    with pytest.raises(InputError, match="2-D"):
        Dynamic(np.eye(3), [(0, 1)])
    with pytest.raises(InputError, match="2-D"):
        Dynamic(ndim=3).insert_segments([(0, 1)])
    assert np.array_equal(live.simplices, before)
    assert live.insert_segments([(4, 1)]).tolist() == [1]


@pytest.mark.parametrize("count", [1, 600, 2900])
def test_an_error_takes_back_all_of_a_batch(count: int) -> None:
    """A segment crosses after points one by one, or so many that all are triangulated again."""
    draw = np.random.default_rng(9)
    square = [(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0), (3.0, 0.0), (3.0, -0.5)]
    live = Dynamic(np.vstack((draw.random((3000, 2)), square)))
    live.insert_segments([(3000, 3002), (3004, 3005)])
    live.remove(np.arange(0, 3000, 50))
    free = np.setdiff1d(np.arange(3000), np.arange(0, 3000, 50))[:count]

    def state() -> list[Any]:
        arrays = live.handles, live.points, live.simplices, live.constrained, live.input_segments
        return [array.tolist() for array in arrays]

    before = state()
    live.changes()
    kept = live.snapshot()
    for edit in range(3):
        with pytest.raises(CrossingSegmentsError):
            live.move(np.append(free, 3004), np.vstack((draw.random((count, 2)), [(-3.0, 0.5)])))
        if edit == 1:
            live.restore(kept)
        assert state() == before
    gone, new = live.changes()
    assert not len(gone)
    assert not len(new)
    live.move(free, draw.random((count, 2)))
    assert live.insert([(0.5, 0.5)]).tolist() == [3006]
    assert live.insert_segments([(3001, 3004)]).tolist() == [2]
    fresh = ConstrainedDelaunay(live.points, np.searchsorted(live.handles, live.input_segments))
    assert triangles(live.simplices) == triangles(fresh.simplices)


def test_points_are_located_in_the_present_triangles() -> None:
    draw = np.random.default_rng(8)
    live = Dynamic(draw.random((300, 2)), crossing="split")
    live.insert_segments([(0, 1), (2, 3), (4, 5), (6, 7)])
    assert len(live.crossings)
    live.remove([50, 60])
    queries = draw.random((400, 2))
    place = live.locate(queries)
    assert np.array_equal(place.simplex, live.find_simplex(queries))
    inside = place.simplex >= 0
    assert 300 < inside.sum() < 400
    handles, _ = live.corners_at(queries)
    found = live.handles[live.simplices[place.simplex[inside]]]
    assert np.array_equal(np.sort(found, axis=1), np.sort(handles[inside], axis=1))
    assert (handles[~inside] == -1).all()
    live.remove_segments(live.segment_handles)
    assert np.array_equal(live.freeze().find_simplex(queries), live.find_simplex(queries))


def test_one_state_is_read_while_others_edit() -> None:
    draw = np.random.default_rng(2)
    live = Dynamic(draw.random((60, 2)), crossing="split")
    found: list[BaseException] = []

    def edit(seed: int) -> None:
        own = np.random.default_rng(seed)
        try:
            for _ in range(40):
                handles = live.insert(own.random((4, 2)))
                segments = live.insert_segments(handles.reshape(2, 2))
                assert len(live.segments) >= 0
                assert live.freeze().validate()
                again = pickle.loads(pickle.dumps(live))
                assert set(again.input_segments.ravel()) <= set(again.handles)
                live.remove_segments(segments)
                live.remove(handles)
        except BaseException as error:
            found.append(error)

    threads = [threading.Thread(target=edit, args=(seed,)) for seed in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not found
    assert (len(live), len(live.segments)) == (60, 0)


def test_a_crossing_cannot_be_edited_itself() -> None:
    live = Dynamic([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2), (1, 3)], crossing="split")
    for edit in (
        lambda: live.remove([4]),
        lambda: live.move([4], [(1, 1)]),
        lambda: live.insert_segments([(0, 4)]),
    ):
        with pytest.raises(HandleError, match="handle 4 is a crossing of segments"):
            edit()
    assert live.crossings.tolist() == [[0, 1, 4]]


def test_changes_follow_segments() -> None:
    live = Dynamic([(0, 0), (4, 0), (4, 3), (0, 3)])
    seen = {tuple(t) for t in live.changes().new.tolist()}
    for edit in (
        lambda: live.insert_segments([(1, 3)]),
        lambda: live.insert([(1, 1)]),
        lambda: live.remove_segments([0]),
    ):
        edit()
        changes = live.changes()
        seen -= {tuple(t) for t in changes.gone.tolist()}
        seen |= {tuple(t) for t in changes.new.tolist()}
        assert seen == triangles(live.handles[live.simplices])


@pytest.mark.parametrize("dtype", [np.uint8, np.uint64, np.int16])
def test_handles_have_any_dtype_of_integers(dtype: Any) -> None:
    live = Dynamic([(0, 0), (4, 0), (4, 4), (0, 4)])
    assert len(live.insert_segments(np.array([(0, 2)], dtype=dtype)))
    with pytest.raises(DtypeError, match="below 2"):
        live.insert_segments(np.array([(0, 2**63)], dtype=np.uint64))


def test_a_segment_is_straight_again_when_the_crossing_that_bent_it_is_gone() -> None:
    """A crossing may be rounded to an end of a segment, where another segment then bends."""
    almost = 0.9999999999999999
    points = [(-1e3, 3e3), (1, -2), (2, -1), (-1, -3), (-1, -2), (-almost, almost)]
    live = Dynamic(points, [(4, 2), (1, 0), (3, 5)], crossing="split")
    bent = len(live.segments)
    live.remove_segments([0])
    fresh = ConstrainedDelaunay(points, [(1, 0), (3, 5)], crossing="split")
    assert bent > len(live.segments) == len(fresh.segments)
    assert places(live.points, live.simplices) == places(fresh.points, fresh.simplices)


@pytest.mark.parametrize("block", seeds(1, deep=25))
def test_side_roads_leave_a_road_as_a_fresh_build_has_it(block: int) -> None:
    bent = 0
    for seed in range(120 * block, 120 * block + 120):
        draw = np.random.default_rng(seed)
        a, b = draw.random((2, 2)) * 1000
        points, segments = [a, b], [(0, 1)]
        for _ in range(3):
            points += [a + (0.05 + 0.9 * draw.random()) * (b - a), draw.random(2) * 1000]
            segments.append((len(points) - 2, len(points) - 1))
        points += list(draw.random((6, 2)) * 1000)
        live = Dynamic(points, segments, crossing="split")
        k = int(draw.integers(1, 4))
        met = live.crossings[:, :2].tolist()
        bent += [0, k] in met and any(k in pair for pair in met if pair[0])
        live.remove_segments([k])
        fresh = ConstrainedDelaunay(points, segments[:k] + segments[k + 1 :], crossing="split")
        assert places(live.points, live.simplices) == places(fresh.points, fresh.simplices)
        assert len(live.segments) == len(fresh.segments)
    assert bent > 5


@pytest.mark.parametrize("edit", ["remove", "move"])
def test_a_crossing_is_named_by_a_handle_that_is_there(edit: str) -> None:
    """The crossing is rounded to an end of a segment, of which there is a duplicate before it."""
    named = 0
    for seed in range(40):
        draw = np.random.default_rng(seed)
        a, b, far = draw.random((3, 2)) * 10
        end = a + draw.random() * (b - a)
        live = Dynamic([a, b, end, end, far], [(0, 1), (3, 4)], crossing="split")
        before = live.crossings
        if len(before) == 0 or len(live) > 5:
            continue
        named += 1
        assert before.tolist() == [[0, 1, 2]]
        if edit == "remove":
            live.remove([2])
        else:
            live.move([2], [(50, 50)])
        assert live.crossings.tolist() == [[0, 1, 3]]
        # Back again, also by a snapshot and a pickle.
        state = live.snapshot()
        live.move([3], [end])
        live.restore(state)
        assert pickle.loads(pickle.dumps(live)).crossings.tolist() == [[0, 1, 3]]
    assert named > 5


def faulty(live: Dynamic, **other: Any) -> DynamicReport:
    """Validate the state of a triangulation with other arrays in place of some."""
    plane: Any = live._live
    made, own = plane.arrays(), plane.segments()
    arrays = {name: getattr(made, name) for name in ("handles", "points", "simplices", "neighbors")}
    arrays |= {"constrained": made.constrained}
    lists = {name: getattr(own, name) for name in ("handles", "ends", "crossings", "added")}
    of_segments = {name[4:]: other.pop(name) for name in list(other) if name.startswith("own_")}
    return validation.validate(
        SimpleNamespace(**arrays | other),
        SimpleNamespace(**lists | of_segments),
        split=True,
        workers=1,
    )


def faults_of(report: DynamicReport) -> dict[str, Any]:
    """Return the fields that are not empty."""
    every = {each.name: getattr(report, each.name).tolist() for each in dataclasses.fields(report)}
    return {name: faults for name, faults in every.items() if faults}


def test_validation_judges_the_present_arrays() -> None:
    square = [(0, 0), (4, 0), (4, 4), (0, 4), (9, 2)]
    live = Dynamic(square, [(0, 2), (1, 3)], crossing="split")
    made, own = live._live.arrays(), live._live.segments()
    assert faults_of(faulty(live)) == {}
    # A segment that is not marked, and edges that are although no segment runs along them.
    found = faults_of(faulty(live, constrained=np.zeros_like(made.constrained)))
    assert found["uncovered"] == [0, 1]
    assert len(found["flags"]) == 4
    found = faults_of(faulty(live, constrained=np.ones_like(made.constrained)))
    assert list(found) == ["flags"]
    # A crossing that stays when a segment is gone, with the detour through it.
    found = faults_of(
        faulty(
            live, own_handles=own.handles[:1], own_ends=own.ends[:1], own_crossings=own.crossings
        )
    )
    assert found["surplus"] == [5]
    assert found["crossings"] == [[0, 1, 5]]
    assert found["uncovered"] == [0]
    # A crossing with the name of another point, and one that is not listed.
    wrong = np.array([[0, 1, 2]])
    assert faults_of(faulty(live, own_crossings=wrong)) == {"crossings": [[0, 1, 2], [0, 1, 5]]}
    assert faults_of(faulty(live, own_crossings=wrong[:0])) == {"crossings": [[0, 1, 5]]}
    # Triangles of points alone, in which the segment is no edge.
    plain = Dynamic([(0, 0), (4, 0), (9, 1), (4, 3), (0, 3)])
    flat, marks = plain._live.arrays(), np.zeros((3, 3), dtype=bool)
    live = Dynamic(plain.points, [(1, 4), (0, 2)], crossing="split")
    assert not faulty(live, simplices=flat.simplices, neighbors=flat.neighbors, constrained=marks)
    live = Dynamic(plain.points, [(0, 2)])
    found = faults_of(
        faulty(live, simplices=flat.simplices, neighbors=flat.neighbors, constrained=marks)
    )
    assert found == {"absent": [[0, 2]], "uncovered": [0]}
    # A triangle that is turned over.
    simplices = live.simplices.copy()
    simplices[0] = simplices[0, ::-1]
    assert 0 in faults_of(faulty(live, simplices=simplices))["orientation"]


def test_validation_finds_a_segment_that_kept_a_detour() -> None:
    """The report is that of the arrays that there are, whatever a new build would have."""
    points = [(0, 0), (8, 0), (4, 1e-300), (4, 6), (1, 5), (7, 5), (4, -7)]
    bent = Dynamic(points, [(0, 2), (2, 1)])
    assert bent.validate()
    found = faults_of(faulty(bent, own_handles=np.array([7]), own_ends=np.array([[0, 1]])))
    assert found["uncovered"] == [7]
    assert found["flags"]
