"""Algorithms step by step: both directions agree, and the last state is the triangulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay
from delone.predicates import orient2d

if TYPE_CHECKING:
    from collections.abc import Callable

    Run = Callable[[list[dict[str, Any]]], list[dict[str, Any]]]

ALL = ["bowyerWatsonSteps", "incrementalSteps", "lawsonSteps", "divideSteps", "sweepSteps"]
GRID = [[float(x), float(y)] for x in range(5) for y in range(4)]


def inputs() -> dict[str, list[list[float]]]:
    rng = np.random.default_rng(5)
    circle = [[5, 0], [4, 3], [3, 4], [0, 5], [-3, 4], [-4, 3], [-5, 0], [0, -5], [4, -3]]
    return {
        "scattered": rng.random((30, 2)).tolist(),
        "grid, a point twice": [*rng.permutation(GRID).tolist(), GRID[7]],
        "circle": [[float(x), float(y)] for x, y in circle],
        "line and apex": [*([float(x), 0.0] for x in range(6)), [2.5, 1.0]],
        "far apart": (rng.random((12, 2)) * 1e200).tolist(),
        "three": [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
    }


INPUTS = inputs()


def triangles_of(flat: list[int]) -> Any:
    return np.array(flat, dtype=np.int64).reshape(-1, 3)


def rows_of(flat: list[int]) -> set[tuple[int, ...]]:
    return set(map(tuple, triangles_of(flat).tolist()))


def canonical(triangles: Any) -> list[int]:
    """Triangles as three rows from the smallest on, sorted, flat."""
    rows = [tuple(np.roll(t, -int(np.argmin(t))).tolist()) for t in np.reshape(triangles, (-1, 3))]
    return [v for row in sorted(rows) for v in row]


@pytest.fixture(scope="module")
def walks(run: Run) -> dict[tuple[str, str], dict[str, Any]]:
    names = [(method, name) for method in ALL for name in INPUTS]
    cases = [
        {"call": method, "args": [[x for row in INPUTS[name] for x in row]]}
        for method, name in names
    ]
    answers = run(cases)
    assert all("value" in answer for answer in answers), [a for a in answers if "error" in a]
    return {each: answer["value"] for each, answer in zip(names, answers, strict=True)}


@pytest.mark.parametrize("name", INPUTS)
@pytest.mark.parametrize("method", ALL)
def test_states(walks: dict[tuple[str, str], dict[str, Any]], method: str, name: str) -> None:
    walk = walks[method, name]
    states = walk["forwards"]
    assert walk["backwards"] == states[::-1]
    last = len(states) - 1
    assert walk["jumps"] == [states[last], states[0], states[last >> 1], states[last]]
    assert states[-1] == canonical(Delaunay(INPUTS[name]).simplices)
    points = np.array(INPUTS[name])
    for state in states:
        corners = points[triangles_of(state)]
        if len(corners):
            assert (orient2d(corners[:, 0], corners[:, 1], corners[:, 2]) > 0).all()
    if method != "lawsonSteps":
        assert states[0] == []


@pytest.mark.parametrize("name", INPUTS)
def test_a_step_removes_what_was_there(
    walks: dict[tuple[str, str], dict[str, Any]], name: str
) -> None:
    for method in ALL:
        walk = walks[method, name]
        rows = [rows_of(state) for state in walk["forwards"]]
        for before, after, step in zip(rows[:-1], rows[1:], walk["steps"], strict=True):
            removed, added = rows_of(step["removed"]), rows_of(step["added"])
            assert removed <= before
            assert not added & before
            assert after == (before - removed) | added
            if step["kind"] == "flip":
                assert len(removed) == len(added) == 2
                assert all(set(step["before"]) <= set(t) for t in removed)
                assert all(set(step["after"]) <= set(t) for t in added)
            if step["kind"] == "insert":
                assert all(step["point"] in triangle for triangle in added)
                cavity = np.reshape(np.array(step["cavity"], dtype=np.int64), (-1, 2)).tolist()
                star = [
                    tuple(np.roll(t, -t.index(min(t))))
                    for u, v in cavity
                    for t in [(u, v, step["point"])]
                ]
                assert set(star) == added


@pytest.mark.parametrize("name", INPUTS)
def test_the_sweep_meets_circles_from_left_to_right(
    walks: dict[tuple[str, str], dict[str, Any]], name: str
) -> None:
    steps = walks["sweepSteps", name]["steps"]
    ends = [step["circle"][0] + step["circle"][2] for step in steps]
    assert ends == sorted(ends)
    assert all(step["circle"][2] > 0 for step in steps)


def test_merges_join_halves(walks: dict[tuple[str, str], dict[str, Any]]) -> None:
    points = np.array(INPUTS["scattered"])
    steps = walks["divideSteps", "scattered"]["steps"]
    merges = [step for step in steps if step["kind"] == "merge"]
    for step in merges:
        assert points[step["left"], 0].max() <= points[step["right"], 0].min()
    assert sorted(merges[-1]["left"] + merges[-1]["right"]) == list(range(30))


def test_the_order_of_insertion_is_the_one_given(node: Run) -> None:
    points, order = [0, 0, 4, 0, 4, 3, 0, 3, 2, 1], [4, 3, 2, 1, 0]
    (answer,) = node([{"call": "bowyerWatsonSteps", "args": [points, {"order": order}]}])
    steps = answer["value"]["steps"]
    assert sorted(steps[0]["added"]) == [2, 3, 4]
    assert [step["point"] for step in steps[1:]] == [1, 0]
