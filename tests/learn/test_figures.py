"""The figures of the course: stored answers, and each figure driven in a headless Chromium."""

from __future__ import annotations

import re
import shutil
import sys
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from browser import Browser, chromium

if TYPE_CHECKING:
    from collections.abc import Iterator

    from browser import Page

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
WEB = ROOT / "target" / "web"
PAGES = sorted((DOCS / "learn").glob("*.rst"))
sys.path.insert(0, str(DOCS / "extensions"))

import live_files  # noqa: E402
import live_steps  # noqa: E402

FIGURES = sorted(live_steps.FIGURES)


def test_pages_show_all_figures_with_texts() -> None:
    text = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    shown = re.findall(r"^\.\. live:: (\w+)\n   :alt: \S", text, re.MULTILINE)
    assert sorted(shown) == FIGURES
    assert len(re.findall(r"^\.\. live::", text, re.MULTILINE)) == len(shown)


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *what: object) -> None:
        pass


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    if chromium() is None:
        pytest.skip("no Chromium is installed")
    with Browser() as found:
        yield found


@pytest.fixture(scope="module", params=["stored", "core"])
def site(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a page with all figures, as the extension writes them."""
    with_core = request.param == "core"
    if with_core and not (WEB / "delone.js").exists():
        pytest.skip("the module for pages is not built")
    folder = tmp_path_factory.mktemp("site")
    static = folder / live_files.FOLDER
    shutil.copytree(DOCS / live_files.FOLDER, static)
    live_files.write_answers(static)
    live_files.copy_view(static)
    if with_core:
        shutil.copytree(WEB, static / "core")
    figures = [
        live_files.figure_html(name, name, folder=live_files.FOLDER, live=with_core)
        for name in FIGURES
    ]
    page = (
        "<!doctype html><meta charset=utf-8><title>figures</title><link rel=icon href=data:,>"
        f"<link rel=stylesheet href={live_files.FOLDER}/learn.css>{''.join(figures)}"
        f"<script type=module src={live_files.FOLDER}/main.js></script>"
    )
    (folder / "index.html").write_text(page, encoding="utf-8")
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/index.html"
    server.shutdown()
    server.server_close()


@pytest.fixture
def page(site: str, browser: Browser) -> Page:
    found = browser.page(site)
    found.wait("window.deloneFigures && window.deloneReady")
    found.wait(f"Object.keys(window.deloneFigures).length === {len(FIGURES)}")
    return found


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
    live = page.run(f"{figure}.core.live")
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
