"""The figures of the course: stored answers, and each figure driven in a headless Chromium."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import live_steps
import pytest

if TYPE_CHECKING:
    from browser import Page

PAGES = sorted((Path(__file__).parents[2] / "docs" / "learn").glob("*.rst"))

FIGURES = sorted(live_steps.FIGURES)


def test_pages_show_all_figures_with_texts() -> None:
    text = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    shown = re.findall(r"^\.\. live:: (\w+)\n   :alt: \S", text, re.MULTILINE)
    assert sorted(shown) == FIGURES
    assert len(re.findall(r"^\.\. live::", text, re.MULTILINE)) == len(shown)


def picture(page: Page, name: str) -> str:
    found: str = page.run(f"window.deloneFigures.{name}.canvas.toDataURL()")
    return found


@pytest.mark.parametrize("name", FIGURES)
def test_stepping_forward_and_back_shows_the_same(page: Page, name: str) -> None:
    figure = f"window.deloneFigures.{name}"
    count = page.run(f"{figure}.states.length")
    assert count > 1
    seen = []
    for step in [*range(count), *reversed(range(count))]:
        page.run(f"{figure}.show({step})")
        seen.append((picture(page, name), page.run(f"{figure}.status.textContent")))
    assert seen == seen[::-1]
    assert len(set(seen)) > 1
    assert page.complaints() == []


@pytest.mark.parametrize("name", FIGURES)
def test_points_move_with_the_core_and_stay_without(page: Page, name: str) -> None:
    figure = f"window.deloneFigures.{name}"
    if page.run(f"{figure}.kind.fixed"):
        assert page.run(f"{figure}.element.querySelector('.live-handle')") is None
        return
    live = page.run(f"{figure}.core.live || Boolean({figure}.kind.free)")
    before = picture(page, name)
    moved = page.run(
        f"(() => {{ const [x, y] = {figure}.points; "
        f"const [x0, y0, x1, y1] = {figure}.kind.panels[0].view; "
        f"return {figure}.move(0, x + (x1 - x0) / 17, y + (y1 - y0) / 23); }})()"
    )
    assert moved is live
    assert (picture(page, name) != before) is live
    page.run(f"{figure}.reset()")
    assert page.complaints() == []


def test_triangles_are_those_of_python(page: Page) -> None:
    from delone import Delaunay

    points = live_steps.SCATTERED
    found = page.run(
        "Array.from(window.deloneFigures.circle.core.delaunay("
        f"Float64Array.from({[x for row in points for x in row]})))"
    )
    triangles = {frozenset(found[k : k + 3]) for k in range(0, len(found), 3)}
    assert triangles == {frozenset(row) for row in Delaunay(points).simplices.tolist()}
