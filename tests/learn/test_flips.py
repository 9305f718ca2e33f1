"""The figures of flips: steps are those of Python, angles grow, a tie leaves both diagonals."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import live_flips
import numpy as np
import pytest

import delone
from delone.testing import same_triangles

if TYPE_CHECKING:
    from browser import Page

LAWSON = "window.deloneFigures.lawson"
QUAD = "window.deloneFigures.quad"


def test_flips_and_angles_are_those_of_python(page: Page) -> None:
    points = live_flips.FLIPPED
    result = delone.lawson(points, live_flips.scan(points), record=True)
    states = page.run(
        f"{LAWSON}.states.map((s) => [Array.from(s.triangles), s.angles, s.say, s.mark])"
    )
    assert result.sequence is not None
    assert len(states) == result.flips + 1
    assert np.allclose([s[1] for s in states], np.degrees(result.angles))
    for flip, (_, _, said, mark) in zip(result.sequence.tolist(), states[1:], strict=True):
        assert "{}-{} became {}-{}".format(*flip) in said
        assert mark.endswith(f" / {result.flips}")
    last = np.reshape(states[-1][0], (-1, 3))
    assert same_triangles(last, delone.Delaunay(points).simplices)
    assert "is Delaunay" in states[-1][2]
    assert not same_triangles(np.reshape(states[0][0], (-1, 3)), last)
    assert page.complaints() == []


def test_sorted_angles_grow_also_after_a_drag(page: Page) -> None:
    moves = [(0, 0, 0)]
    if page.run(f"{LAWSON}.core.live"):
        moves += [(4, 300, 300), (9, 130, 60), (0, 40, 580)]
    for row, x, y in moves:
        if (x, y) != (0, 0):
            assert page.run(f"{LAWSON}.move({row}, {x}, {y})")
        angles = np.array(page.run(f"{LAWSON}.states.map((s) => s.angles)"))
        assert len(angles) > 3
        for before, after in pairwise(angles):
            first = np.flatnonzero(np.abs(after - before) > 1e-9)[0]
            assert after[first] > before[first]
        points = np.reshape(page.run(f"Array.from({LAWSON}.points)"), (-1, 2))
        last = np.reshape(page.run(f"Array.from({LAWSON}.states.at(-1).triangles)"), (-1, 3))
        assert same_triangles(last, delone.Delaunay(points).simplices)
    page.run(f"{LAWSON}.reset()")
    assert page.complaints() == []


def test_the_orange_bar_is_the_first_that_changes(page: Page) -> None:
    drawn = page.run(
        f"{LAWSON}.states.map((s) => [s.angles, s.layers[1].filter((l) => l.color === 'accent')"
        ".map((l) => Array.from(l.corners))])"
    )
    assert drawn[0][1] == []
    for (before, _), (angles, ((left, *_),)) in pairwise(drawn):
        first = np.flatnonzero(np.abs(np.subtract(angles, before)) > 1e-9)[0]
        assert int((left - 55) / (530 / len(angles))) == first


def test_a_scan_tiles_the_hull() -> None:
    points = np.array(live_flips.FLIPPED)
    corners = points[np.array(live_flips.scan(live_flips.FLIPPED))]
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    areas = ax * by - ay * bx
    assert (areas > 0).all()
    assert areas.sum() / 2 == pytest.approx(delone.Delaunay(points).areas.sum())


def test_one_diagonal_is_legal_and_both_on_a_circle(page: Page) -> None:
    def legal() -> list[bool]:
        found: list[bool] = page.run(f"{QUAD}.states.map((state) => state.legal)")
        return found

    assert legal() == [False, True]
    least = page.run(f"{QUAD}.states.map((state) => Math.min(...state.angles))")
    assert least[1] > least[0] + 10
    for row, (x, y) in enumerate([(100, 100), (500, 100), (500, 500), (100, 500)]):
        assert page.run(f"{QUAD}.move({row}, {x}, {y})")
    assert legal() == [True, True]
    assert " on the circle " in page.run(f"{QUAD}.status.textContent")
    assert page.run(f"{QUAD}.move(3, 101, 499)")
    assert legal() == [False, True]
    assert page.run(f"{QUAD}.move(3, 98, 501)")
    assert legal() == [True, False]
    # A dent leaves one diagonal; a point on the wrong side is refused.
    assert page.run(f"{QUAD}.move(3, 450, 200)")
    assert legal() == [True]
    assert "nothing to flip" in page.run(f"{QUAD}.status.textContent")
    assert not page.run(f"{QUAD}.move(3, 700, 60)")
    assert "counter-clockwise" in page.run(f"{QUAD}.status.textContent")
    page.run(f"{QUAD}.reset()")
    assert legal() == [False, True]
    assert page.complaints() == []
