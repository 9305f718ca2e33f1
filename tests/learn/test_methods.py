"""The figure of the five methods: stored steps are those of the core, and all ends are the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import live_answers
import live_methods
import numpy as np
import pytest

from delone import Delaunay
from delone.reference import incircle_canonical
from delone.testing import same_triangles

if TYPE_CHECKING:
    from browser import Page

FIGURE = "window.deloneFigures.methods"
METHODS = sorted(live_methods.METHODS)


def choose(page: Page, method: str) -> None:
    page.run(f"{FIGURE}.change((figure) => {{ figure.options = {{ method: '{method}' }}; }})")


def triples(rows: list[int]) -> set[frozenset[int]]:
    return {frozenset(rows[k : k + 3]) for k in range(0, len(rows), 3)}


@pytest.mark.parametrize("method", METHODS)
def test_steps_of_python_are_those_of_the_core(page: Page, method: str) -> None:
    everything = [live_methods.PLACED]
    if page.run(f"{FIGURE}.core.live"):
        everything.append(np.random.default_rng(3).integers(0, 10_000, (40, 2)).tolist())
    for points in everything:
        compare(page, method, points)


def compare(page: Page, method: str, points: list[list[float]]) -> None:
    found: list[dict[str, Any]] = page.run(
        f"{FIGURE}.core.method('{method}', Float64Array.from({live_answers.flat(points)}))"
        ".map((step) => Object.fromEntries(Object.entries(step).map(([name, value]) => "
        "[name, ArrayBuffer.isView(value) ? Array.from(value) : value])))"
    )
    steps = live_methods.METHODS[method](points)
    assert len(found) == len(steps) > 5
    for one, other in zip(found, steps, strict=True):
        assert one["kind"] == other["kind"]
        assert triples(one["removed"]) == triples(other["removed"])
        assert triples(one["added"]) == triples(other["added"])
        for name in other.keys() & {"point", "before", "after", "circle"}:
            assert one[name] == pytest.approx(other[name])
        for name in other.keys() & {"left", "right"}:
            assert set(one[name]) == set(other[name])


@pytest.mark.parametrize("method", METHODS)
def test_all_end_in_the_same_triangles(page: Page, method: str) -> None:
    choose(page, method)
    moves = [None]
    if page.run(f"{FIGURE}.core.live"):
        # The third point makes a row of three on the hull, the fourth a rectangle, the last a pair.
        moves += [(3, 620, 330), (9, 120, 540), (4, 120, 370), (1, 470, 110), (11, 880, 500)]
    for move in moves:
        if move:
            assert page.run(f"{FIGURE}.move{move}")
        points = np.reshape(page.run(f"Array.from({FIGURE}.points)"), (-1, 2))
        last = page.run(f"Array.from({FIGURE}.states.at(-1).triangles)")
        assert same_triangles(np.reshape(last, (-1, 3)), Delaunay(points).simplices)
        assert page.run(f"{FIGURE}.states[0].triangles.length") == 0
    page.run(f"{FIGURE}.reset()")
    assert page.complaints() == []


@pytest.mark.parametrize("method", METHODS)
def test_each_method_steps_forward_and_back(page: Page, method: str) -> None:
    choose(page, method)
    count = page.run(f"{FIGURE}.states.length")
    seen = [
        page.run(f"{FIGURE}.show({step}), {FIGURE}.canvas.toDataURL()")
        for step in [*range(count), *reversed(range(count))]
    ]
    assert seen == seen[::-1]
    assert len(set(seen)) == count
    says = page.run(f"{FIGURE}.states.map((state) => state.say)")
    assert len(set(says[1:])) > count / 2
    assert says[-1].endswith("These are all 15 triangles.")
    assert page.complaints() == []


def test_insertion_is_delaunay_after_each_step() -> None:
    points = live_methods.PLACED
    now: set[frozenset[int]] = set()
    rows = {0, 1, 2}
    for step in live_methods.cavities(points):
        now = now - triples(step["removed"]) | triples(step["added"])
        rows |= {step.get("point", 0)}
        order = sorted(rows)
        simplices = np.array(order)[Delaunay([points[row] for row in order]).simplices]
        assert now == {frozenset(t) for t in simplices.tolist()}


def test_insertion_with_flips_passes_the_states_of_bowyer_watson() -> None:
    cavities, splits = (
        [step.get("point", -1) for step in record(live_methods.PLACED)]
        for record in (live_methods.cavities, live_methods.splits)
    )
    assert list(dict.fromkeys(splits)) == cavities
    assert len(splits) > len(cavities) + 3


def test_final_triangles_of_sweep_and_wrap_have_empty_circles() -> None:
    points = live_methods.PLACED
    for record in (live_methods.events, live_methods.wraps):
        steps = record(points)
        assert all(not step["removed"] for step in steps)
        for step in steps:
            corners = step["added"]
            assert all(
                incircle_canonical(*(points[k] for k in corners), points[row]) < 0
                for row in range(len(points))
                if row not in corners
            )
    ends = [step["circle"][0] + step["circle"][2] for step in live_methods.events(points)]
    assert ends == sorted(ends)
