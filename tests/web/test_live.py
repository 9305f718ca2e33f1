"""A live triangulation in a page: after any edits it is what Python makes of the points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, Dynamic, HandleError, NonFiniteError

if TYPE_CHECKING:
    from collections.abc import Callable

    Run = Callable[[list[dict[str, Any]]], list[dict[str, Any]]]

Edit = list[Any]


def flat(rows: Any) -> list[float]:
    return np.asarray(rows, dtype=float).ravel().tolist()


def named(triangles: Any) -> set[tuple[int, ...]]:
    """Triangles from their smallest row on."""
    rows = np.reshape(np.asarray(triangles, dtype=np.int64), (-1, 3)).tolist()
    found = {tuple(t[(k := t.index(min(t))) :] + t[:k]) for t in rows}
    assert len(found) == len(rows)
    return found


def edits_of(points: Any, seed: int) -> list[Edit]:
    """Moves near and far, onto other points and back, insertions, removals."""
    rng = np.random.default_rng(seed)
    count, there, edits = len(points), list(range(len(points))), []
    for k in range(30):
        row = there[int(rng.integers(len(there)))]
        if k % 10 == 3:
            edits.append(["insert", flat(rng.random((2, 2)) * 6 - 1)])
            there += [count, count + 1]
            count += 2
        elif k % 10 == 6:
            edits.append(["remove", [row]])
            there.remove(row)
        else:
            place = points[int(rng.integers(len(points)))] if k % 3 == 0 else rng.random(2) * 6 - 1
            edits.append(["move", row, *flat(place)])
    return edits


SETS = {
    "scattered": np.random.default_rng(3).random((40, 2)) * 4,
    "grid, two points twice": np.array(
        [*((x, y) for x in range(5) for y in range(5)), (2, 2), (0, 0)], dtype=float
    ),
    "beyond a chunk": np.random.default_rng(4).random((3000, 2)) * 4,
}


@pytest.mark.parametrize("name", SETS)
def test_edits_end_in_the_triangles_of_the_points(run: Run, name: str) -> None:
    points = SETS[name]
    edits = edits_of(points, len(name))
    (answer,) = run([{"call": "edited", "args": [flat(points), edits]}])
    before = named(Delaunay(points).simplices)
    # Each row that is there, and its point, by these edits.
    kept = dict(enumerate(points.tolist()))
    for edit, found in zip(edits, answer["value"], strict=True):
        if edit[0] == "move":
            kept[edit[1]] = edit[2:]
        elif edit[0] == "remove":
            del kept[edit[1][0]]
        else:
            first = found["state"]["rows"][-2]
            kept |= {first: edit[1][:2], first + 1: edit[1][2:]}
        state, right = found["state"], Delaunay(list(kept.values()))
        assert state["rows"] == list(kept)
        assert state["points"] == flat(list(kept.values()))
        assert named(state["triangles"]) == named(right.simplices)
        repeats = np.flatnonzero(right.duplicate_of != np.arange(right.npoints))
        assert state["duplicates"] == flat([(row, right.duplicate_of[row]) for row in repeats])
        gone, added = (named(found["value"][part]) for part in ("gone", "added"))
        assert gone <= before
        assert not added & before
        before = (before - gone) | added
        rows = np.array(state["rows"])
        assert before == named(rows[np.reshape(state["triangles"], (-1, 3))])


def test_edits_that_fail_change_nothing(run: Run) -> None:
    points = SETS["scattered"]
    edits: list[Edit] = [["move", 3, "NaN", 0], ["remove", [40]], ["insert", [1.0, "Infinity"]]]
    edits.append(["move", 3, *flat(points[3])])
    (answer,) = run([{"call": "edited", "args": [flat(points), edits]}])
    *failed, last = answer["value"]
    assert [each["error"] for each in failed] == ["NonFiniteError", "HandleError", "NonFiniteError"]
    live = Dynamic(points)
    with pytest.raises(NonFiniteError) as raised:
        live.move([3], [(np.nan, 0)])
    assert failed[0]["message"] == str(raised.value)
    with pytest.raises(HandleError) as missing:
        live.remove([40])
    assert failed[1]["message"] == str(missing.value)
    assert all(each["state"] == last["state"] for each in failed)
    assert last["value"] == {"gone": [], "added": []}


def test_points_on_one_line_have_no_triangles(run: Run) -> None:
    points = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]
    edits: list[Edit] = [["move", 1, 1.0, 1.0], ["move", 1, 4.0, 0.0]]
    (answer,) = run([{"call": "edited", "args": [flat(points), edits]}])
    up, down = answer["value"]
    assert up["value"] == {"gone": [], "added": [0, 2, 1]}
    assert down["value"] == {"gone": [0, 2, 1], "added": []}
    assert down["state"]["triangles"] == []
