"""What a live triangulation tells, saves and undoes without `freeze`."""

from __future__ import annotations

import copy
import pickle
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import Dynamic
from delone.dynamic import saving
from delone.dynamic.saving import State, require_few_handles

if TYPE_CHECKING:
    from numpy.typing import NDArray


def used(ndim: int, seed: int = 0, *, segments: bool = False) -> Dynamic:
    """A triangulation with gaps in its handles, duplicates, and perhaps segments that cross."""
    draw = np.random.default_rng(seed)
    points = draw.integers(0, 60, (120, ndim)).astype(float)
    live = Dynamic(points, crossing="split" if segments else None)
    if segments:
        ends = draw.permutation(120)[:24].reshape(-1, 2)
        live.insert_segments(ends)
        free = np.setdiff1d(live.handles, np.concatenate((ends.ravel(), live.crossings[:, 2])))
    else:
        free = live.handles
    live.remove(free[::3])
    live.move(free[1::3], points[free[1::3]] + draw.integers(0, 3, (len(free[1::3]), ndim)))
    live.insert(draw.integers(0, 60, (15, ndim)))
    if segments:
        live.remove_segments(live.segment_handles[::4])
    return live


def state(live: Dynamic) -> tuple[Any, ...]:
    """All that an edit can change, but the numbers that are given next."""
    simplices = np.sort(live.handles[live.simplices], axis=1)
    plain = (live.handles.tolist(), live.points.tolist(), sorted(simplices.tolist()))
    if live.ndim == 3:
        return plain
    return (
        *plain,
        live.segment_handles.tolist(),
        live.input_segments.tolist(),
        live.crossings.tolist(),
        live.segments.tolist(),
    )


NAMES = ("edges", "boundary", "convex_hull", "circumcenters")


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("seed", range(3))
def test_measures_are_those_of_the_frozen_mesh(ndim: int, seed: int) -> None:
    live = used(ndim, seed)
    for edit in (lambda: None, lambda: live.remove(live.handles[5:9])):
        edit()
        mesh = live.freeze()
        for name in (*NAMES, "hull", "areas" if ndim == 2 else "volumes"):
            found = getattr(live, name)
            assert np.array_equal(found, getattr(mesh, name)), name
            assert not found.flags.writeable
        one, two = live.quality(), mesh.quality()
        assert type(one) is type(two)
        assert np.array_equal(one.radius_ratio, two.radius_ratio)
    with pytest.raises(AttributeError, match="volumes" if ndim == 2 else "areas"):
        getattr(live, "areas" if ndim == 3 else "volumes")


def test_measures_with_segments_are_those_of_the_present_triangles() -> None:
    live = used(2, 4, segments=True)
    corners = live.points[live.simplices]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    assert np.allclose(live.areas, (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2)
    pairs = np.sort(live.simplices[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    assert np.array_equal(live.edges, np.unique(pairs, axis=0))
    assert set(map(tuple, live.segments.tolist())) <= set(map(tuple, live.edges.tolist()))


@pytest.mark.parametrize("points", [np.empty((0, 2)), [(0, 0), (1, 1), (2, 2)], np.eye(3)])
def test_without_simplices_measures_are_empty(points: Any) -> None:
    live = Dynamic(points)
    assert live.nsimplex == 0
    for name in (*NAMES, "hull", "areas" if live.ndim == 2 else "volumes"):
        assert len(getattr(live, name)) == 0, name
    assert live.hull.dtype == np.int64
    summary = live.quality().summary()
    assert np.isnan([list(each.values()) for each in summary.values()]).all()
    noun = "triangles" if live.ndim == 2 else "tetrahedra"
    assert str(live.quality()).startswith(f"0 {noun}")


def test_pictures_show_the_present_state() -> None:
    live = used(2, 1)
    assert len(live.plot().collections) == len(live.freeze().plot().collections)
    crossed = used(2, 1, segments=True)
    assert len(crossed.plot().collections) == len(crossed.freeze().plot().collections)


# Several edits as one.


@pytest.mark.parametrize("kind", [(2, False), (2, True), (3, False)])
def test_edits_become_one(kind: tuple[int, bool]) -> None:
    ndim, segments = kind
    live, alone = used(ndim, 2, segments=segments), used(ndim, 2, segments=segments)
    free = live.handles if not segments else np.setdiff1d(live.handles, live.input_segments)
    free = free if not segments else np.setdiff1d(free, live.crossings[:, 2])
    before = state(live)
    live.changes(), alone.changes()
    with live.edits() as draft:
        new = draft.insert([(70.0,) * ndim, (80.0,) * ndim])
        draft.remove(free[:2])
        draft.move(new[:1], [(71.0,) * ndim])
        if segments:
            draft.insert_segments([new])
        # Readers see the old state until the end.
        assert state(live) == before
    alone.insert([(70.0,) * ndim, (80.0,) * ndim])
    alone.remove(free[:2])
    alone.move(new[:1], [(71.0,) * ndim])
    if segments:
        alone.insert_segments([new])
    assert state(live) == state(alone)
    one, two = live.changes(), alone.changes()
    assert np.array_equal(one.gone, two.gone)
    assert np.array_equal(one.new, two.new)
    assert live.validate()
    # The numbers that follow are the same, and the draft is on its own.
    draft.insert([(0.5,) * ndim])
    assert state(live) == state(alone)
    assert live.insert([(0.5,) * ndim]) == alone.insert([(0.5,) * ndim])


@pytest.mark.parametrize("kind", [KeyError, KeyboardInterrupt])
def test_an_exception_in_a_block_changes_nothing(kind: type[BaseException]) -> None:
    live = used(2, 3, segments=True)
    before, handle = state(live), live._live.counts()[3]
    with pytest.raises(kind), live.edits() as draft:
        draft.insert([(1, 1)])
        draft.remove_segments(draft.segment_handles[:2])
        raise kind
    assert state(live) == before
    assert live.insert([(1, 1)]) == handle


def test_edits_beside_a_draft_stay_and_it_is_dropped() -> None:
    live = used(2, 5)
    with pytest.raises(delone.EditConflictError), live.edits() as draft:
        draft.insert([(100, 100)])
        live.insert([(200, 200)])
        expected = state(live)
    assert state(live) == expected
    # Without edits of its own there is no conflict.
    with live.edits() as draft:
        live.insert([(300, 300)])
    assert live.points[-1].tolist() == [300, 300]


def test_threads_that_draft_take_turns() -> None:
    live = Dynamic(np.random.default_rng(0).random((50, 2)))
    lost = []

    def work(number: int) -> None:
        for k in range(25):
            while True:
                try:
                    with live.edits() as draft:
                        new = draft.insert([(number, k + 2), (number + 0.5, k + 2)])
                        draft.remove(new[:1])
                    break
                except delone.EditConflictError:
                    lost.append(number)

    threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(live) == 50 + 4 * 25
    places = {(number + 0.5, k + 2.0) for number in range(4) for k in range(25)}
    assert set(map(tuple, live.points[50:].tolist())) == places
    assert live.validate()


class Edited:
    """A core that another thread edits as soon as its state has been taken."""

    def __init__(self, core: Any) -> None:
        self.core, self.pending = core, [(7.0, 7.0), (8.0, 8.0)]

    def __getattr__(self, name: str) -> Any:
        return getattr(self.core, name)

    def state(self) -> Any:
        made = self.core.state()
        if self.pending:
            self.core.insert(np.array([self.pending.pop()]), 1)
        return made


def test_a_draft_is_of_the_state_that_it_is_compared_with() -> None:
    live = Dynamic([(0, 0), (1, 0), (0, 1)])
    core = live._live
    live._live = Edited(core)  # type: ignore[assignment]
    known, draft = live._draft()
    assert known == core.edits
    assert len(draft) == 5


# Points that go with their segments.


def test_points_go_with_their_segments() -> None:
    corners = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)]
    live = Dynamic(corners, [(0, 2), (1, 3), (0, 1)], crossing="split")
    assert len(live.crossings) == 1
    before = state(live)
    with pytest.raises(delone.HandleError, match=r'handle 0 is an end of .* segments="remove"'):
        live.remove([0])
    with pytest.raises(delone.HandleError, match="is a crossing"):
        live.remove([0, int(live.crossings[0, 2])], segments="remove")
    with pytest.raises(delone.HandleError, match="handle 77 is not there"):
        live.remove([0, 77], segments="remove")
    with pytest.raises(delone.HandleError, match="named twice"):
        live.remove([0, 0], segments="remove")
    assert state(live) == before
    assert live.remove([0, 4], segments="remove").tolist() == [0, 2]
    assert live.segment_handles.tolist() == [1]
    assert live.handles.tolist() == [1, 2, 3]
    assert not len(live.crossings)
    assert live.validate()
    assert live.remove([1], segments="remove").tolist() == [1]
    # Where no segment ends, and where there is none at all.
    assert live.remove([2], segments="remove").dtype == np.int64
    assert live.handles.tolist() == [3]
    with pytest.raises(delone.InputError, match="segments must be"):
        live.remove([3], segments="keep")


def test_points_of_solids_have_no_segments() -> None:
    live = used(3, 9)
    first = live.handles[:2]
    assert live.remove(first[:1], segments="remove").tolist() == []
    assert live.remove(first[1:]) is None
    assert not np.isin(first, live.handles).any()
    with pytest.raises(delone.HandleError, match="are not there"):
        live.remove(first, segments="remove")


@pytest.mark.parametrize("seed", range(4))
def test_what_is_left_is_that_of_the_remaining_input(seed: int) -> None:
    live = used(2, seed, segments=True)
    alone = used(2, seed, segments=True)
    ends = np.unique(live.input_segments)
    gone = ends[:: 2 + seed]
    live.changes(), alone.changes()
    lost = alone.segment_handles[np.isin(alone.input_segments, gone).any(axis=1)]
    assert np.array_equal(live.remove(gone, segments="remove"), lost)
    alone.remove_segments(lost)
    alone.remove(gone)
    assert state(live) == state(alone)
    one, two = live.changes(), alone.changes()
    assert np.array_equal(one.gone, two.gone)
    assert np.array_equal(one.new, two.new)
    assert live.validate()


# Files and pickles.


@pytest.mark.parametrize("kind", [(2, False), (2, True), (3, False)])
@pytest.mark.parametrize("way", ["save", "pickle", "snapshot"])
def test_states_are_kept(kind: tuple[int, bool], way: str, tmp_path: Path) -> None:
    ndim, segments = kind
    live = used(ndim, 6, segments=segments)
    if way == "save":
        live.save(tmp_path / "a.npz")
        again = Dynamic.load(tmp_path / "a.npz")
    elif way == "pickle":
        again = pickle.loads(pickle.dumps(live))
    else:
        again = Dynamic(ndim=ndim)
        again.restore(pickle.loads(pickle.dumps(live.snapshot())))
    assert state(again) == state(live)
    assert again.validate()
    assert again.insert([(1.5,) * ndim]) == live.insert([(1.5,) * ndim])
    if segments:
        ends = np.setdiff1d(again.handles, again.crossings[:, 2])[:2]
        assert again.insert_segments([ends]) == live.insert_segments([ends])
        assert state(again) == state(live)


def test_a_snapshot_of_elsewhere_never_gives_handles_again() -> None:
    live = Dynamic([(0, 0), (1, 0), (0, 1)])
    kept = pickle.loads(pickle.dumps(live.snapshot()))
    live.insert([(5, 5), (6, 7)])
    live.restore(kept)
    assert live.handles.tolist() == [0, 1, 2]
    assert live.insert([(9, 9)]).tolist() == [5]
    with pytest.raises(delone.DtypeError, match="2-D snapshot"):
        Dynamic(ndim=3).restore(kept)


def parts(live: Dynamic) -> dict[str, Any]:
    """What a pickle consists of."""
    names = ("points", "handles", "total", "split", "segments", "ends", "segments_total", "added")
    return dict(zip(names, live.__reduce__()[1][0], strict=True))


class Parts:
    """An object that is pickled as other parts of a class."""

    def __init__(self, build: Any, *parts: Any) -> None:
        self.reduced = build, parts

    def __reduce__(self) -> Any:
        return self.reduced


CROSSED = Dynamic([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2), (1, 3), (0, 1)], crossing="split")


@pytest.mark.parametrize(
    "change",
    [
        {"handles": np.array([0, 1, 2, 3, 9])},
        {"handles": np.array([0, 1, 3, 2, 4])},
        {"handles": np.arange(4)},
        {"handles": np.arange(5, dtype=np.int32)},
        {"handles": np.arange(-1, 4)},
        {"handles": [0, 1, 2, 3, 4]},
        {"total": 2**40},
        {"total": -1},
        {"total": 4},
        {"total": "5"},
        {"total": None},
        {"segments_total": 2**40},
        {"segments_total": 2},
        {"segments_total": 3.0},
        {"split": 1},
        {"split": False},
        {"segments": np.array([0, 0, 2])},
        {"segments": np.array([0, 2])},
        {"ends": np.array([[0, 2], [1, 3], [0, 9]])},
        {"ends": np.array([[0, 2], [1, 3], [0, -1]])},
        {"ends": np.array([[0, 2], [1, 4], [0, 1]])},
        {"ends": np.array([[0, 1], [1, 2], [2, 3]])},
        {"ends": np.array([0, 2, 1])},
        {"added": np.array([3])},
        {"added": np.array([7])},
        {"added": np.array([4, 4])},
        {"added": np.array(["4"])},
        {"points": np.full((5, 2), np.nan)},
        {"points": np.zeros((5, 4))},
        {"points": np.zeros(5)},
        {"points": np.zeros((5, 2), dtype=np.float32)},
        {"points": np.zeros((5, 3))},
        {"points": None},
    ],
    ids=str,
)
def test_pickles_that_contradict_themselves_are_refused(change: dict[str, Any]) -> None:
    wrong = tuple((parts(CROSSED) | change).values())
    live = Parts(Dynamic._again, wrong, (None, False))
    snapshot = Parts(type(CROSSED.snapshot())._again, wrong)
    for each in (live, snapshot):
        data = pickle.dumps(each)
        with pytest.raises(delone.InputError):
            pickle.loads(data)


def test_pickles_without_a_part_are_refused_and_others_read() -> None:
    saved = tuple(parts(CROSSED).values())
    for wrong in (saved[:-1], (*saved, 1), list(saved), None):
        with pytest.raises(delone.InputError, match="a part is missing"):
            Dynamic._again(wrong, (None, False))
    # Orders in memory are no faults.
    change = parts(CROSSED)
    change["points"] = np.asfortranarray(change["points"])
    change["handles"] = np.repeat(change["handles"], 2)[::2]
    assert state(Dynamic._again(tuple(change.values()), (1, False))) == state(CROSSED)


def damaged(path: Path, **changes: NDArray[Any]) -> Path:
    """Write a file again, with some arrays replaced."""
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files} | changes
    bad = path.with_name("bad.npz")
    with bad.open("wb") as out:
        np.savez(out, **arrays)
    return bad


def integers(*values: int) -> NDArray[np.int64]:
    return np.array(values, dtype=np.int64)


def test_files_that_contradict_themselves_are_refused(tmp_path: Path) -> None:
    live = Dynamic([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2), (1, 3), (0, 1)], crossing="split")
    path = tmp_path / "a.npz"
    live.save(path)
    changes: list[dict[str, NDArray[Any]]] = [
        {"handles": integers(0, 1, 2, 3, 9)},
        {"handles": integers(0, 1, 3, 2, 4)},
        {"handles": integers(0, 1, 2, 3)},
        {"handles": integers(-1, 1, 2, 3, 4)},
        {"numbers": integers(5, 1)},
        {"numbers": integers(5, 2, 3)},
        {"numbers": integers(2**40, 1, 3)},
        {"numbers": integers(5, 1, 2**40)},
        {"numbers": integers(5, 1, 2)},
        {"segments": integers(0, 0, 2)},
        {"segments": integers(0, 2)},
        {"ends": integers(0, 2, 1, 3, 0, 9).reshape(-1, 2)},
        {"ends": integers(0, 2, 1, 4, 0, 1).reshape(-1, 2)},
        {"added": integers(3)},
        {"added": integers(7)},
        {"points": np.full((5, 2), np.nan)},
        # Crossings that may not be split, and one where no segments cross.
        {"numbers": integers(5, 0, 3)},
        {"ends": integers(0, 1, 1, 2, 2, 3).reshape(-1, 2)},
    ]
    for number, change in enumerate(changes):
        bad = damaged(path, **change)
        with pytest.raises(delone.FileFormatError):
            pytest.fail(f"{number} is read: {Dynamic.load(bad)}")
    with pytest.raises(delone.FileFormatError):
        delone.Delaunay.load(path)
    with pytest.raises(TypeError, match="path must be"):
        Dynamic.load(3)  # type: ignore[arg-type]


def test_few_points_cannot_claim_the_memory_of_many(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    Dynamic([(0, 0), (4, 0), (4, 4)]).save(path)
    for numbers in (integers(2**31, 0, 0), integers(3, 0, 2**31)):
        bad = damaged(path, numbers=numbers)
        with pytest.raises(delone.FileFormatError, match="max_handles=2147483648"):
            Dynamic.load(bad)
    many = damaged(path, numbers=integers(10_000_001, 0, 0))
    with pytest.raises(delone.FileFormatError, match="at most 10,000,000"):
        Dynamic.load(many)
    assert Dynamic.load(many, max_handles=10_000_001).insert([(1, 1)]).tolist() == [10_000_001]
    with pytest.raises(delone.FileFormatError, match="at most 2 "):
        Dynamic.load(path, max_handles=2)


def test_many_points_may_have_had_64_handles_each() -> None:
    saved = State.of(Dynamic()._live)._replace(points=np.zeros((200_000, 2)))
    require_few_handles("a.npz", saved._replace(total=12_800_000), None)
    with pytest.raises(delone.FileFormatError, match="max_handles=12800001 accepts them"):
        require_few_handles("a.npz", saved._replace(total=12_800_001), None)
    # The limit is for handles of segments as well.
    with pytest.raises(delone.FileFormatError, match="max_handles=12800001 accepts them"):
        require_few_handles("a.npz", saved._replace(segments_total=12_800_001), None)


def test_pickles_cannot_claim_the_memory_of_many(monkeypatch: pytest.MonkeyPatch) -> None:
    live = Dynamic([(0, 0), (4, 0), (4, 4)])
    again, (saved, options) = live.__reduce__()
    for name in ("total", "segments_total"):
        bad = State(*saved)._replace(**{name: 2**31})
        with pytest.raises(
            delone.InputError, match=r"accepts at most 10,000,000.*max_handles=2147"
        ):
            again(tuple(bad), options)
        with pytest.raises(
            delone.InputError, match="2,147,483,648 handles have been assigned, for 3"
        ):
            type(live.snapshot())._again(tuple(bad))
    # One that could not be read is not written: the error comes where it can still be saved.
    monkeypatch.setattr(saving, "_ALWAYS", 3)
    assert pickle.loads(pickle.dumps(live)).handles.tolist() == [0, 1, 2]
    for _ in range(200):
        live.remove(live.insert([(1, 1)]))
    for each in (live, live.snapshot()):
        with pytest.raises(delone.InputError, match=r"203 handles .* max_handles=203"):
            pickle.dumps(each)
    assert copy.deepcopy(live).handles.tolist() == [0, 1, 2]


# Values.


def test_values_are_those_of_handles() -> None:
    live = used(2, 7)
    values = np.arange(1000.0) ** 2
    found = live.arrays(values)
    assert np.array_equal(found.values, values[live.handles])
    assert found.handles is live.handles
    assert found.simplices is live.simplices
    assert live.arrays().values is None
    top = int(live.handles[-1])
    assert live.arrays(np.ones((top + 1, 3))).values.shape == (len(live), 3)
    with pytest.raises(delone.ShapeError, match=f"{top + 1} rows or more"):
        live.arrays(np.ones(top))
    rows = live.rows_of(live.handles[[5, 0, 5]])
    assert rows.tolist() == [5, 0, 5]
    gone = np.setdiff1d(np.arange(top), live.handles)
    with pytest.raises(delone.HandleError, match=f"handle {gone[0]} is not there"):
        live.rows_of([live.handles[0], gone[0]])
    with pytest.raises(delone.HandleError, match="are not there"):
        live.rows_of([top + 1, top + 2])


class Busy(Dynamic):
    """A triangulation that another thread edits as soon as its arrays have been made."""

    def _arrays(self) -> Any:
        made = super()._arrays()
        self.insert([(0.5, 0.25)])
        return made


def test_arrays_are_those_of_one_look() -> None:
    live = Busy([(0, 0), (1, 0), (0, 1)])
    found = live.arrays(np.arange(99.0))
    assert found.handles.tolist() == [0, 1, 2]
    assert found.values.tolist() == [0, 1, 2]
    assert len(found.points) == len(found.handles)
    assert len(found.simplices) == len(found.neighbors)
    assert live.rows_of([3]).tolist() == [3]


def test_values_of_handles_in_any_order_are_interpolated() -> None:
    live = used(2, 8)
    draw = np.random.default_rng(0)
    values = draw.random(len(live))
    xi = draw.random((40, 2)) * 60
    expected = live.interpolate(xi, values)
    order = draw.permutation(len(live))
    found = live.interpolate(xi, values[order], handles=live.handles[order])
    assert np.array_equal(found, expected, equal_nan=True)
    more = np.append(live.handles[order], 10**9)
    found = live.interpolate(xi, np.append(values[order], np.nan), handles=more)
    assert np.array_equal(found, expected, equal_nan=True)
    with pytest.raises(delone.HandleError, match="a point without a value"):
        live.interpolate(xi, values[1:], handles=live.handles[1:])
    with pytest.raises(delone.HandleError, match="named twice"):
        live.interpolate(xi, np.append(values, 1), handles=np.append(live.handles, live.handles[0]))
    with pytest.raises(delone.ShapeError, match="one per handle"):
        live.interpolate(xi, values[1:], handles=live.handles)


WRONG_VALUES: dict[str, tuple[Any, type[Exception], str]] = {
    "text": (["a", "b", "c"], delone.DtypeError, "numbers, got dtype <U1"),
    "dates": (np.zeros(3, dtype="M8[D]"), delone.DtypeError, "numbers, got dtype datetime64"),
    "none": (None, delone.DtypeError, "numbers, got dtype object"),
    "masked": (np.ma.masked_array([1, 2, 3], [0, 0, 1]), delone.DtypeError, "filled"),
    "large": ([1, 2**53 + 1, 2], delone.DtypeError, "row 1 has a number"),
    "small": ([[1, 1], [1, 1], [-(2**53) - 1, 2]], delone.DtypeError, "row 2 has a number"),
    "uneven": ([[1], [1, 2], [3]], delone.ShapeError, "rows of unequal length"),
}


@pytest.mark.parametrize("name", WRONG_VALUES)
def test_values_that_are_no_numbers_are_refused(name: str) -> None:
    live = Dynamic([(0, 0), (4, 0), (0, 4)])
    values, kind, message = WRONG_VALUES[name]
    with pytest.raises(kind, match=message):
        live.interpolate((1, 1), values)
    if name in ("masked", "uneven"):
        with pytest.raises(kind, match=message):
            live.arrays(values)


def test_values_of_other_kinds_are_taken() -> None:
    live = Dynamic([(0, 0), (4, 0), (0, 4)])
    assert live.interpolate((2, 0), [1j, 1, 3]) == 0.5 + 0.5j
    assert live.interpolate((2, 2), np.array([1, 2, 3], dtype=np.uint8)) == 2.5
    assert live.interpolate((2, 0), [2**53, -(2**53), 1]) == 0
    assert live.interpolate((2, 2), np.ma.masked_array([1.0, 2, 3], mask=False)) == 2.5
    assert live.interpolate((0, 2), np.float32([1, np.nan, 3])) != 2
    assert live.arrays(["a", "b", "c"]).values.tolist() == ["a", "b", "c"]


def test_arrays_are_of_one_state_while_others_edit() -> None:
    live = Dynamic(np.random.default_rng(0).random((300, 2)))
    values = np.arange(40_000.0)
    stop = threading.Event()

    def edit() -> None:
        draw = np.random.default_rng(1)
        # As many edits as there are values for their handles.
        for _ in range(7000):
            if stop.is_set():
                break
            new = live.insert(draw.random((5, 2)))
            live.remove(new[:4])
            if len(live) > 800:
                live.remove(live.handles[300:])

    worker = threading.Thread(target=edit)
    worker.start()
    try:
        for _ in range(100):
            found = live.arrays(values)
            assert len(found.handles) == len(found.points) == len(found.values)
            assert found.simplices.max() < len(found.points)
            assert np.array_equal(found.values, found.handles)
    finally:
        stop.set()
        worker.join()
