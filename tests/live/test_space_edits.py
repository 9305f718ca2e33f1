"""Every edit in 3-D leaves the tetrahedra that a fresh build has."""

from __future__ import annotations

import copy
import json
import pickle
from itertools import product
from pathlib import Path
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

from delone import (
    DegenerateInputError,
    Delaunay,
    DtypeError,
    Dynamic,
    HandleError,
    NonFiniteError,
    ShapeError,
)
from tiers import examples

CORPUS = Path(__file__).parents[1] / "corpus"


def turned(simplices: np.ndarray) -> np.ndarray:
    """Return the vertices of each tetrahedron in ascending order, as an even permutation."""
    order = np.argsort(simplices, axis=1)
    rows = np.take_along_axis(simplices, order, axis=1)
    pairs = [(i, j) for j in range(4) for i in range(j)]
    odd = sum(order[:, i] > order[:, j] for i, j in pairs) % 2 == 1
    rows[odd, 2:] = rows[odd, 2:][:, ::-1]
    return rows[np.lexsort(rows.T[::-1])]


def assert_fresh(live: Dynamic, points: dict[int, tuple[float, ...]]) -> None:
    """Check a triangulation against a new one of the same points."""
    assert live.handles.tolist() == sorted(points)
    expected = np.array([points[h] for h in sorted(points)], dtype=float).reshape(-1, 3)
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


def integers(*sides: int) -> st.SearchStrategy[tuple[float, ...]]:
    return st.tuples(*[st.integers(0, side).map(float) for side in sides])


SPHERE = st.sampled_from(
    [tuple(map(float, p)) for p in product(range(-3, 4), repeat=3) if sum(x * x for x in p) == 9]
    + [(0.0, 0.0, 0.0)]
)
LAYERS = integers(4, 4, 0) | integers(4, 4, 0) | integers(4, 4, 2)
HULL = st.tuples(st.integers(-3, 3), st.integers(-3, 3)).map(
    lambda p: (float(p[0]), float(p[1]), float(p[0] ** 2 + p[1] ** 2))
) | st.just((0.0, 0.0, 40.0))
MIXED = st.tuples(
    st.floats(-1e300, 1e300, allow_subnormal=True),
    st.sampled_from([0.0, 5e-324, 1e-300, 1.0, 1e9]),
    st.sampled_from([0.0, 1e-160, 2.0]),
)
PLACES = [integers(2, 2, 2), SPHERE, LAYERS, HULL, MIXED]


@st.composite
def sequences(draw: st.DrawFn) -> tuple[list[Any], list[Any]]:
    place = draw(st.sampled_from(PLACES))
    number = st.integers(0, 10**6)
    edit = (
        st.tuples(st.just("insert"), st.lists(place, max_size=4))
        | st.tuples(st.just("remove"), st.lists(number, max_size=4))
        | st.tuples(st.just("move"), st.lists(st.tuples(number, place), max_size=4))
        | st.tuples(st.just("snapshot"), st.none())
        | st.tuples(st.just("restore"), number)
    )
    return draw(st.lists(place, max_size=25)), draw(st.lists(edit, max_size=15))


def table(points: Any) -> np.ndarray:
    return np.array(list(points), dtype=float).reshape(-1, 3)


@given(sequences())
@settings(max_examples=examples(30, deep=300), deadline=None)
def test_every_edit_equals_a_fresh_build(sequence: tuple[list[Any], list[Any]]) -> None:
    start, edits = sequence
    live = Dynamic(table(start))
    points = dict(enumerate(start))
    kept: list[tuple[Any, dict[int, Any]]] = []
    total = len(start)
    for kind, what in edits:
        there = sorted(points)
        if kind == "insert":
            made = live.insert(table(what))
            assert made.tolist() == list(range(total, total + len(what)))
            total += len(what)
            points.update(zip(made.tolist(), what, strict=True))
        elif kind == "remove" and there:
            gone = {there[k % len(there)] for k in what}
            live.remove(list(gone))
            points = {h: p for h, p in points.items() if h not in gone}
        elif kind == "move" and there:
            moved = {there[k % len(there)]: p for k, p in what}
            live.move(list(moved), table(moved.values()))
            points.update(moved)
        elif kind == "snapshot":
            kept.append((live.snapshot(), dict(points)))
        elif kind == "restore" and kept:
            snapshot, old = kept[what % len(kept)]
            live.restore(snapshot)
            points = dict(old)
        assert_fresh(live, points)


def points_of(path: Path) -> list[tuple[float, ...]]:
    """Return the points of a file of the corpus, 2-D ones in a plane of 3-D."""
    case = json.loads(path.read_text(encoding="utf-8"))
    raw = case["points"]
    rows = [[float.fromhex(x) if isinstance(x, str) else float(x) for x in row] for row in raw]
    return [(*row, 0.0) if len(row) == 2 else tuple(row) for row in rows]


FILES = sorted([*CORPUS.glob("space/*.json"), *CORPUS.glob("degenerate/*.json")])


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_corpus_is_built_and_edited(path: Path) -> None:
    start = points_of(path)
    points = dict(enumerate(start))
    live = Dynamic(table(start), ndim=3)
    assert_fresh(live, points)
    half = list(points)[::2]
    live.remove(half)
    assert_fresh(live, {h: p for h, p in points.items() if h % 2})
    for old in half:
        (handle,) = live.insert([start[old]]).tolist()
        points[handle] = points.pop(old)
    assert_fresh(live, points)
    # From a plane and back.
    beside = live.insert([(0.25, 0.5, 1.0), (0.5, 0.25, -3.0)]).tolist()
    assert_fresh(live, points | {beside[0]: (0.25, 0.5, 1.0), beside[1]: (0.5, 0.25, -3.0)})
    live.remove(beside)
    assert_fresh(live, points)
    handles = sorted(points)
    live.move(handles, table(points[h] for h in reversed(handles)))
    points = dict(zip(handles, [points[h] for h in reversed(handles)], strict=True))
    assert_fresh(live, points)


def test_snapshots_bring_back_the_arrays_of_then() -> None:
    rng = np.random.default_rng(5)
    live = Dynamic(rng.integers(0, 9, (150, 3)))
    kept = []
    for step in range(300):
        if step % 25 == 0:
            kept.append((live.snapshot(), live.handles, live.points, live.freeze().simplices))
        handle = rng.choice(live.handles)
        match step % 3:
            case 0:
                live.insert(rng.integers(0, 9, (1, 3)))
            case 1:
                live.remove([handle])
            case 2:
                live.move([handle], rng.integers(0, 9, (1, 3)))
    total = int(live.insert([(0.5, 0.5, 0.5)])[0])
    for k in rng.permutation(len(kept)):
        snapshot, handles, points, simplices = kept[k]
        live.restore(snapshot)
        assert np.array_equal(live.handles, handles)
        assert np.array_equal(live.points, points)
        assert np.array_equal(turned(live.simplices), turned(simplices))
        assert live.validate()
    assert live.insert([(0.5, 0.5, 0.5)])[0] == total + 1  # No handle is given twice.


def test_large_batches_and_few_points_give_the_same() -> None:
    rng = np.random.default_rng(7)
    points = rng.random((3000, 3))
    at_once = turned(Delaunay(points).simplices)
    for first in (10, 100, 1500, 2950):
        live = Dynamic(points[:first])
        live.insert(points[first:])
        assert np.array_equal(turned(live.simplices), at_once)
        live.remove(np.arange(first, 3000))
        assert np.array_equal(turned(live.simplices), turned(Delaunay(points[:first]).simplices))


def test_a_bad_handle_changes_nothing() -> None:
    live = Dynamic(np.vstack([np.eye(3), np.zeros(3), np.ones(3)]))
    live.remove([1])
    before = live.simplices
    for handles in ([0, 1], [0, 5], [-1], [2, 2]):
        with pytest.raises(HandleError):
            live.remove(handles)
        with pytest.raises(HandleError):
            live.move(handles, np.zeros((len(handles), 3)))
    with pytest.raises(NonFiniteError):
        live.insert([(3, 3, 3), (np.nan, 0, 0)])
    with pytest.raises(ShapeError):
        live.insert([(3, 3)])
    assert np.array_equal(live.simplices, before)


def test_dimensions_do_not_mix() -> None:
    plane, space = Dynamic([(0, 0), (1, 0), (0, 1)]), Dynamic(ndim=3)
    assert (plane.ndim, space.ndim, Dynamic().ndim) == (2, 3, 2)
    assert space.simplices.shape == space.neighbors.shape == (0, 4)
    assert space.points.shape == (0, 3)
    for one, other in [(plane, space), (space, plane)]:
        with pytest.raises(DtypeError, match="snapshot"):
            one.restore(other.snapshot())
        with pytest.raises(DtypeError, match="snapshot"):
            one.snapshot().bytes_beyond(other.snapshot())
    with pytest.raises(ShapeError):
        Dynamic([(0, 0)], ndim=3)
    with pytest.raises(ShapeError, match="ndim"):
        Dynamic(ndim=4)
    space.insert(np.vstack([np.eye(3), np.zeros(3)]))
    assert repr(space) == "<Dynamic of 4 points: 1 tetrahedron>"
    assert np.array_equal(Dynamic(space.freeze()).simplices, space.simplices)


def test_pickles_and_copies_are_independent() -> None:
    live = Dynamic(np.random.default_rng(8).integers(0, 4, (40, 3)))
    live.remove([0, 7, 39])
    for other in (pickle.loads(pickle.dumps(live)), copy.copy(live), copy.deepcopy(live)):
        assert np.array_equal(other.handles, live.handles)
        assert np.array_equal(turned(other.simplices), turned(live.simplices))
        assert other.insert([(9, 9, 9)]).tolist() == [40]
        assert 40 not in live


def test_changes_add_up() -> None:
    rng = np.random.default_rng(9)
    live = Dynamic(rng.integers(0, 5, (60, 3)))
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
            live.insert(rng.integers(0, 5, (3, 3)))


def test_queries_need_no_arrays() -> None:
    rng = np.random.default_rng(10)
    live = Dynamic(rng.random((300, 3)))
    live.remove([3, 4])
    live.insert(rng.random((20, 3)))
    queries = rng.random((200, 3)) * 1.2 - 0.1
    handles, weights = live.corners_at(queries)
    inside = live.find_simplex(queries) >= 0
    assert np.array_equal(handles[:, 0] >= 0, inside)
    assert np.isnan(weights[~inside]).all()
    values = live.interpolate(queries, live.points @ [2.0, -3.0, 1.0])
    assert np.allclose(values[inside], queries[inside] @ [2.0, -3.0, 1.0])
    assert np.isnan(values[~inside]).all()
    assert np.array_equal(live.nearest(queries), live.handles[live.freeze().nearest(queries)])
    corner = Dynamic(list(product((0, 1), repeat=3)))
    assert corner.nearest([(0.5, 0.5, 0.5), (0.5, 0.9, 0.9)]).tolist() == [0, 3]
    plane = Dynamic([(0, 0, 0), (1, 1, 0), (2, 0, 0), (0, 2, 0)])
    assert plane.nearest([(0.9, 1, 4), (1, 0, 0)]).tolist() == [1, 0]
