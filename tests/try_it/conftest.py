"""A site with the figures of the course and the page for readers' points, for a browser."""

from __future__ import annotations

import shutil
import sys
import threading
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from browser import Browser, chromium

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
WEB = ROOT / "target" / "web"
sys.path.insert(0, str(DOCS / "extensions"))

import live_files  # noqa: E402


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *what: object) -> None:
        pass


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve a folder; gives the address."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        server.server_close()


@pytest.fixture(scope="session")
def serve() -> Callable[[Path], AbstractContextManager[str]]:
    """Serve a folder in a block, with its address."""
    return served


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    if chromium() is None:
        pytest.skip("no Chromium is installed")
    with Browser() as found:
        yield found


@pytest.fixture(scope="session")
def core() -> Path:
    """The folder of the compiled core."""
    if not (WEB / "delone.js").exists():
        pytest.skip("the module for pages is not built")
    return WEB


@pytest.fixture(scope="session")
def write_page() -> Callable[[Path, str], None]:
    """Write index.html with these elements, between the files that the extensions write."""

    def write(folder: Path, elements: str) -> None:
        static = folder / live_files.FOLDER
        if not static.exists():
            shutil.copytree(DOCS / live_files.FOLDER, static)
            live_files.write_answers(static)
            live_files.copy_view(static)
            if (WEB / "delone.js").exists():
                shutil.copytree(WEB, static / "core")
        styles, scripts = ["learn.css"], []
        if "data-live" in elements:
            scripts.append("main.js")
        if "data-try" in elements:
            styles.append("try/try.css")
            scripts.append("try/main.js")
        head = "".join(f"<link rel=stylesheet href={live_files.FOLDER}/{name}>" for name in styles)
        tail = "".join(
            f"<script type=module src={live_files.FOLDER}/{name}></script>" for name in scripts
        )
        text = (
            "<!doctype html><meta charset=utf-8><title>page</title><link rel=icon href=data:,>"
            '<meta name=viewport content="width=device-width">'
            f"{head}<body>{elements}{tail}"
        )
        (folder / "index.html").write_text(text, encoding="utf-8")

    return write
