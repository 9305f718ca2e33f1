"""A page with all figures of the course in a headless Chromium, with the core and without."""

from __future__ import annotations

import shutil
import sys
import threading
from functools import partial
from html import escape
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from browser import Browser, chromium
from chapters import EXERCISES, Written

if TYPE_CHECKING:
    from collections.abc import Iterator

    from browser import Page

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
WEB = ROOT / "target" / "web"
sys.path.insert(0, str(DOCS / "extensions"))

import exercise_parts  # noqa: E402
import live_files  # noqa: E402
import live_steps  # noqa: E402

FIGURES = sorted(live_steps.FIGURES)


def exercise_html(written: Written) -> str:
    """The element of an exercise, as the extension writes it."""
    return (
        exercise_parts.opening(written.exercise)
        + f'<p class="exercise-task">{escape(written.task)}</p>'
        + f"{exercise_parts.SOLUTION}<p>{escape(written.answer)}</p>{exercise_parts.CLOSING}"
    )


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
    exercises = map(exercise_html, EXERCISES)
    styles = ("learn.css", "exercises/exercises.css")
    links = "".join(f"<link rel=stylesheet href={live_files.FOLDER}/{name}>" for name in styles)
    page = (
        "<!doctype html><meta charset=utf-8><title>figures</title><link rel=icon href=data:,>"
        f"{links}{''.join(figures)}{''.join(exercises)}"
        f"<script type=module src={live_files.FOLDER}/main.js></script>"
        f"<script type=module src={live_files.FOLDER}/exercises/main.js></script>"
    )
    (folder / "index.html").write_text(page, encoding="utf-8")
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/index.html"
    server.shutdown()
    server.server_close()


@pytest.fixture
def page(site: str, browser: Browser) -> Page:
    return opened(site, browser)


@pytest.fixture(scope="module")
def shared(site: str, browser: Browser) -> Page:
    """One page for tests that leave all but their own exercise as it is."""
    return opened(site, browser)


def opened(site: str, browser: Browser) -> Page:
    found = browser.page(site)
    found.wait("window.deloneFigures && window.deloneReady")
    found.wait(f"Object.keys(window.deloneFigures).length === {len(FIGURES)}")
    return found
