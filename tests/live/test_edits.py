"""Every edit leaves the triangulation that a fresh build has."""

from __future__ import annotations

import copy
import json
import pickle
import sys
import threading
from pathlib import Path
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

from delone import (
    DegenerateInputError,
    Delaunay,
    Dynamic,
    HandleError,
    NonFiniteError,
    ShapeError,
)
from tiers import examples

CORPUS = Path(__file__).parents[1] / "corpus"


def turned(simplices: np.ndarray) -> np.ndarray:
    """Return simplices from their smallest vertex on, in ascending order."""
    first = simplices.argmin(axis=1) if len(simplices) else np.empty(0, dtype=int)
    columns = (first[:, None] + np.arange(3)) % 3
    rows = np.take_along_axis(simplices, columns, axis=1)
    return rows[np.lexsort(rows.T[::-1])]


def assert_fresh(live: Dynamic, points: dict[int, tuple[float, float]]) -> None:
    """Check a triangulation against a new one of the same points."""
    assert live.handles.tolist() == sorted(points)
    expected = np.array([points[h] for h in sorted(points)], dtype=float).reshape(-1, 2)
    assert np.array_equal(live.points, expected)
    assert len(live) == live.npoints == len(points)
    try:
        fresh = Delaunay(expected)
    except DegenerateInputError:
        assert live.nsimplex == 0 == len(live.simplices)
        return
    frozen = live.freeze()
    assert np.array_equal(turned(frozen.simplices), turned(fresh.simplices))
    assert np.array_equal(frozen.duplicate_of, fresh.duplicate_of)
    assert live.nsimplex == fresh.nsimplex
    assert frozen.validate()


LATTICES = [st.tuples(*[st.integers(0, k).map(float)] * 2) for k in (2, 3, 4, 5)]
CIRCLE = st.sampled_from(
    [(sx * x, sy * y) for x, y in [(5.0, 0.0), (0.0, 5.0), (3.0, 4.0), (4.0, 3.0)]
     for sx in (1, -1) for sy in (1, -1)] + [(0.0, 0.0)]
)  # fmt: skip
HULL = st.integers(-4, 4).map(lambda k: (float(k), float(k * k))) | st.just((0.0, 40.0))
MIXED = st.tuples(
    st.floats(-1e300, 1e300, allow_subnormal=True), st.sampled_from([0.0, 5e-324, 1e-300, 1.0, 1e9])
)


@st.composite
def sequences(draw: st.DrawFn) -> tuple[list[Any], list[Any]]:
    place = draw(st.sampled_from([*LATTICES, CIRCLE, HULL, MIXED]))
    number = st.integers(0, 10**6)
    edit = (
        st.tuples(st.just("insert"), st.lists(place, max_size=4))
        | st.tuples(st.just("remove"), st.lists(number, max_size=4))
        | st.tuples(st.just("move"), st.lists(st.tuples(number, place), max_size=4))
        | st.tuples(st.just("snapshot"), st.none())
        | st.tuples(st.just("restore"), number)
    )
    return draw(st.lists(place, max_size=25)), draw(st.lists(edit, max_size=15))


@given(sequences())
@settings(max_examples=examples(30, deep=300), deadline=None)
def test_every_edit_equals_a_fresh_build(sequence: tuple[list[Any], list[Any]]) -> None:
    start, edits = sequence
    live = Dynamic(np.array(start, dtype=float).reshape(-1, 2))
    points = dict(enumerate(start))
    kept: list[tuple[Any, dict[int, Any]]] = []
    total = len(start)
    for kind, what in edits:
        there = sorted(points)
        if kind == "insert":
            made = live.insert(np.array(what, dtype=float).reshape(-1, 2))
            assert made.tolist() == list(range(total, total + len(what)))
            total += len(what)
            points.update(zip(made.tolist(), what, strict=True))
        elif kind == "remove" and there:
            gone = {there[k % len(there)] for k in what}
            live.remove(list(gone))
            points = {h: p for h, p in points.items() if h not in gone}
        elif kind == "move" and there:
            moved = {there[k % len(there)]: p for k, p in what}
            live.move(list(moved), np.array(list(moved.values()), dtype=float).reshape(-1, 2))
            points.update(moved)
        elif kind == "snapshot":
            kept.append((live.snapshot(), dict(points)))
        elif kind == "restore" and kept:
            snapshot, old = kept[what % len(kept)]
            live.restore(snapshot)
            points = dict(old)
        assert_fresh(live, points)


def corpus() -> list[Path]:
    return sorted(CORPUS.glob("*.json"))


@pytest.mark.parametrize("path", corpus(), ids=lambda path: path.stem)
def test_the_corpus_is_built_and_edited(path: Path) -> None:
    case = json.loads(path.read_text(encoding="utf-8"))
    raw = case.get("points") if isinstance(case, dict) else None
    if not raw or not isinstance(raw[0], list) or len(raw[0]) != 2:
        pytest.skip("no list of 2-D points")
    given = [
        tuple(float.fromhex(x) if isinstance(x, str) else float(x) for x in row) for row in raw
    ]
    points = dict(enumerate(given))
    live = Dynamic(given)
    assert_fresh(live, points)
    half = list(points)[::2]
    live.remove(half)
    assert_fresh(live, {h: p for h, p in points.items() if h % 2})
    for handle, old in zip(live.insert([given[h] for h in half]).tolist(), half, strict=True):
        points[handle] = points.pop(old)
    assert_fresh(live, points)
    handles = sorted(points)
    live.move(handles, [points[h] for h in reversed(handles)])
    points = dict(zip(handles, [points[h] for h in reversed(handles)], strict=True))
    assert_fresh(live, points)


def test_snapshots_bring_back_the_arrays_of_then() -> None:
    rng = np.random.default_rng(5)
    live = Dynamic(rng.integers(0, 30, (200, 2)))
    kept = []
    for step in range(1000):
        if step % 25 == 0:
            kept.append((live.snapshot(), live.handles, live.points, live.freeze().simplices))
        handle = rng.choice(live.handles)
        match step % 3:
            case 0:
                live.insert(rng.integers(0, 30, (1, 2)))
            case 1:
                live.remove([handle])
            case 2:
                live.move([handle], rng.integers(0, 30, (1, 2)))
    total = int(live.insert([(0.5, 0.5)])[0])
    for k in rng.permutation(len(kept)):
        snapshot, handles, points, simplices = kept[k]
        live.restore(snapshot)
        assert np.array_equal(live.handles, handles)
        assert np.array_equal(live.points, points)
        assert np.array_equal(turned(live.simplices), turned(simplices))
        assert live.validate()
    assert live.insert([(0.5, 0.5)])[0] == total + 1  # No handle is given twice.


def test_a_snapshot_is_read_while_another_thread_edits() -> None:
    rng = np.random.default_rng(6)
    live = Dynamic(rng.random((3000, 2)))
    snapshot = live.snapshot()
    expected = turned(live.simplices).copy()
    wrong: list[int] = []

    def read(k: int) -> None:
        own = Dynamic()
        for _ in range(5):
            own.restore(snapshot)
            own.insert([(2.0 + k, 3.0)])
            own.restore(snapshot)
            if not np.array_equal(turned(own.simplices), expected):
                wrong.append(k)

    readers = [threading.Thread(target=read, args=(k,)) for k in range(8)]
    for reader in readers:
        reader.start()
    for _ in range(50):
        live.remove(rng.choice(live.handles, 30, replace=False))
        live.insert(rng.random((30, 2)))
    for reader in readers:
        reader.join()
    assert not wrong
    assert live.validate()


def test_interpolation_is_of_one_state() -> None:
    """The two states differ in which rows are at the first two corners of a square."""
    live = Dynamic([(0, 0), (1, 0), (0, 1), (1, 1)])
    first = live.snapshot()
    live.remove([0])
    live.insert([(0, 0)])
    second = live.snapshot()
    found, is_over = set(), threading.Event()

    def read() -> None:
        for _ in range(4000):
            found.add(tuple(live.interpolate([(0, 0), (1, 0)], [10, 20, 30, 40]).tolist()))
        is_over.set()

    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        reader = threading.Thread(target=read)
        reader.start()
        while not is_over.is_set():
            live.restore(first)
            live.restore(second)
        reader.join()
    finally:
        sys.setswitchinterval(before)
    assert found <= {(10.0, 20.0), (40.0, 10.0)}


def test_large_batches_and_few_points_give_the_same() -> None:
    rng = np.random.default_rng(7)
    points = rng.random((9000, 2))
    at_once = turned(Delaunay(points).simplices)
    for first in (10, 100, 4000, 8950):
        live = Dynamic(points[:first])
        live.insert(points[first:])
        assert np.array_equal(turned(live.simplices), at_once)
        live.remove(np.arange(first, 9000))
        assert np.array_equal(turned(live.simplices), turned(Delaunay(points[:first]).simplices))


def test_a_bad_handle_changes_nothing() -> None:
    live = Dynamic([(0, 0), (1, 0), (0, 1), (1, 1)])
    live.remove([1])
    before = live.simplices
    for handles in ([0, 1], [0, 4], [-1], [2**40], [2, 2]):
        with pytest.raises(HandleError) as caught:
            live.remove(handles)
        assert set(caught.value.handles) <= set(handles)
        with pytest.raises(KeyError):
            live.move(handles, np.zeros((len(handles), 2)))
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.handles.tolist() == [2] and str(again) == "handle 2 is named twice"
    with pytest.raises(ShapeError, match="handles must be an array, got one number: 0"):
        live.remove(0)
    with pytest.raises(NonFiniteError):
        live.insert([(3, 3), (np.nan, 0)])
    with pytest.raises(NonFiniteError):
        live.move([0], [(np.inf, 0)])
    assert np.array_equal(live.simplices, before)
    assert 0 in live and 1 not in live and -1 not in live and "0" not in live


def test_pickles_and_copies_are_independent() -> None:
    live = Dynamic(np.random.default_rng(8).integers(0, 6, (40, 2)))
    live.remove([0, 7, 39])
    for other in (pickle.loads(pickle.dumps(live)), copy.copy(live), copy.deepcopy(live)):
        assert np.array_equal(other.handles, live.handles)
        assert np.array_equal(turned(other.simplices), turned(live.simplices))
        assert other.insert([(9, 9)]).tolist() == [40]
        assert 40 not in live


def test_changes_add_up() -> None:
    rng = np.random.default_rng(9)
    live = Dynamic(rng.integers(0, 9, (60, 2)))
    seen: set[tuple[int, ...]] = set()
    for step in range(60):
        gone, new = live.changes()
        old = {tuple(t) for t in gone.tolist()}
        assert old <= seen
        seen = seen - old
        assert not seen & {tuple(t) for t in new.tolist()}
        seen |= {tuple(t) for t in new.tolist()}
        assert seen == {tuple(t) for t in turned(live.handles[live.simplices]).tolist()}
        if step % 2:
            live.remove(rng.choice(live.handles, 3, replace=False))
        else:
            live.insert(rng.integers(0, 9, (3, 2)))


def test_queries_need_no_arrays() -> None:
    rng = np.random.default_rng(10)
    live = Dynamic(rng.random((300, 2)))
    live.remove([3, 4])
    live.insert(rng.random((20, 2)))
    queries = rng.random((200, 2)) * 1.4 - 0.2
    handles, weights = live.corners_at(queries)
    inside = live.find_simplex(queries) >= 0
    assert np.array_equal(handles[:, 0] >= 0, inside)
    assert np.isnan(weights[~inside]).all()
    values = live.interpolate(queries, live.points @ [2.0, -3.0])
    assert np.allclose(values[inside], queries[inside] @ [2.0, -3.0])
    assert np.isnan(values[~inside]).all()
    both = live.interpolate(queries[inside], live.points)
    assert np.allclose(both, queries[inside])
    frozen = live.freeze()
    assert np.array_equal(live.nearest(queries), live.handles[frozen.nearest(queries)])
    empty = Dynamic()
    assert empty.nearest([(0, 0)]).tolist() == [-1] == empty.find_simplex([(0, 0)]).tolist()
    line = Dynamic([(0, 0), (1, 1), (2, 2)])
    assert line.nearest([(0.9, 1), (0.5, 0.5)]).tolist() == [1, 0]


def test_it_starts_from_other_triangulations() -> None:
    from delone import ConstrainedDelaunay

    square = ConstrainedDelaunay([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 2)])
    assert np.array_equal(Dynamic(square).points, square.points)
    assert repr(Dynamic(Delaunay([(0, 0), (1, 0), (0, 1), (0, 0)]))) == (
        "<Dynamic of 4 points (1 duplicate): 1 triangle>"
    )
