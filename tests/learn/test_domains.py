"""The figures of segments and of refinement: triangles, sentences, segments drawn by the reader."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import live_domains
import numpy as np
import pytest

import delone
from delone.predicates import incircle

if TYPE_CHECKING:
    from browser import Page

SEGMENTS = "window.deloneFigures.constrained"
REFINED = "window.deloneFigures.refined"


def edges_of(triangles: Any) -> set[tuple[int, int]]:
    """Return the edges of triangles, each with its smaller row first."""
    return {
        (min(u, v), max(u, v)) for t in triangles for u, v in zip(t, np.roll(t, 1), strict=True)
    }


def status(page: Page, figure: str) -> str:
    found: str = page.run(f"{figure}.status.textContent")
    return found


def test_sentences_count_replaced_edges_and_hidden_points(page: Page) -> None:
    points = np.array(live_domains.SHORE, dtype=float)
    before = edges_of(delone.Delaunay(points).simplices.tolist())
    said = page.run(f"{SEGMENTS}.states.map((state) => state.say)")
    assert len(said) == len(live_domains.SEGMENTS) + 1
    assert "with 19 triangles" in said[0]
    for count, text in enumerate(said[1:], 1):
        u, v = live_domains.SEGMENTS[count - 1]
        mesh = delone.ConstrainedDelaunay(points, live_domains.SEGMENTS[:count])
        after = edges_of(mesh.simplices.tolist())
        numbers = re.findall(r"\d+", text)
        assert [int(n) for n in numbers[:3]] == [u, v, len(before - after)]
        hidden = sum(
            any(
                incircle(*points[list(t)], points[row]) > 0
                for row in range(len(points))
                if row not in t
            )
            for t in mesh.simplices.tolist()
        )
        assert f"In {hidden} of 19 triangles" in text
        before = after
    assert page.complaints() == []


def enter(page: Page, first: int, second: int) -> str:
    """Choose two points with the keyboard; return what the figure says then."""
    for row in (first, second):
        page.run(f"{SEGMENTS}.element.querySelectorAll('.live-handle')[{row}].focus()")
        page.key("Enter")
        if row == first:
            assert status(page, SEGMENTS).startswith(f"Point {first} is the start")
    return status(page, SEGMENTS)


def test_enter_on_two_points_draws_a_segment_and_removes_it(page: Page) -> None:
    picture = page.run(f"{SEGMENTS}.canvas.toDataURL()")
    if page.run(f"{SEGMENTS}.core.live"):
        assert enter(page, 0, 2).startswith("The segment from 0 to 2 crosses 1 edge")
        assert page.run(f"{SEGMENTS}.states.length") == 7
        enter(page, 2, 0)
        assert "pairs of segments cross, first 2 and 5" in enter(page, 9, 6)
    else:
        assert "without the compiled core" in enter(page, 0, 2)
    assert page.run(f"{SEGMENTS}.states.length") == 6
    page.run(f"{SEGMENTS}.reset(); {SEGMENTS}.show(1)")
    assert page.run(f"{SEGMENTS}.canvas.toDataURL()") == picture
    assert page.complaints() == []


def test_a_drag_draws_a_segment_and_keeps_points(page: Page) -> None:
    if not page.run(f"{SEGMENTS}.core.live"):
        return
    page.run(f"{SEGMENTS}.element.querySelector('select').value = 'draw'")
    page.run(f"{SEGMENTS}.element.querySelector('select').dispatchEvent(new Event('change'))")
    page.run(f"{SEGMENTS}.canvas.scrollIntoView()")
    points = page.run(f"Array.from({SEGMENTS}.points)")
    for count in (7, 6):
        ends = [
            page.run(
                f"(() => {{ const box = {SEGMENTS}.canvas.getBoundingClientRect(); "
                f"const [paint] = {SEGMENTS}.paints; return [box.left + paint.x({x}), "
                f"box.top + paint.y({y})]; }})()"
            )
            for x, y in (live_domains.SHORE[0], live_domains.SHORE[2])
        ]
        page.mouse("Moved", *ends[0])
        page.mouse("Pressed", *ends[0])
        page.mouse("Moved", *ends[1], held=True)
        page.mouse("Released", *ends[1])
        assert page.run(f"{SEGMENTS}.states.length") == count
        if count == 7:
            assert status(page, SEGMENTS).startswith("The segment from 0 to 2 crosses 1 edge")
    assert page.run(f"Array.from({SEGMENTS}.points)") == points
    page.run(f"{SEGMENTS}.reset()")
    assert page.complaints() == []


def test_remove_all_leaves_the_delaunay_triangulation(page: Page) -> None:
    page.run(
        f"[...{SEGMENTS}.element.querySelectorAll('button')]"
        ".find((button) => button.textContent === 'Remove all').click()"
    )
    assert status(page, SEGMENTS).startswith("No segments: the Delaunay triangulation")
    assert page.run(f"{SEGMENTS}.states.length") == 1
    page.run(f"{SEGMENTS}.reset()")


def test_meshes_are_those_of_python_and_keep_their_bounds(page: Page) -> None:
    holes = [(206, 181), (590, 257)]
    found = page.run(
        f"{REFINED}.states.map((state) => ({{ say: state.say, mark: state.mark, "
        "points: Array.from(state.mesh.points), triangles: Array.from(state.mesh.triangles) }))"
    )
    assert [state["mark"] for state in found] == [f"{bound}°" for bound in live_domains.BOUNDS]
    sizes = []
    for bound, state in zip(live_domains.BOUNDS, found, strict=True):
        mesh = delone.mesh((live_domains.PLATE, live_domains.SIDES), holes=holes, min_angle=bound)
        assert np.array_equal(np.reshape(state["points"], (-1, 2)), mesh.points)
        assert delone.testing.same_triangles(
            np.reshape(state["triangles"], (-1, 3)), mesh.simplices
        )
        least = mesh.quality().smallest_angle.min()
        assert least >= bound
        assert f"{len(mesh.points)} vertices and {len(mesh.simplices)} triangles" in state["say"]
        assert f"{mesh.nadded} added point" in state["say"]
        assert float(state["say"].split("smallest angle is ")[1].split("°")[0]) == pytest.approx(
            least, abs=0.051
        )
        sizes.append(len(mesh.points))
    assert sizes == sorted(sizes)
    assert sizes[-1] > 3 * sizes[0]
    assert page.complaints() == []


def test_a_sharp_corner_is_said(page: Page) -> None:
    if not page.run(f"{REFINED}.core.live"):
        return
    assert page.run(f"{REFINED}.move(4, 740, 600)")
    page.run(f"{REFINED}.show({REFINED}.states.length - 1)")
    assert "smallest angle is 12.7°: in 1 triangle (red)" in status(page, REFINED)
    page.run(f"{REFINED}.reset()")
