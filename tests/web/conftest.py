"""The module for pages, run in Node and in Chromium, and the tests' calls of it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from browser import Browser, chromium

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

HERE = Path(__file__).parent
ROOT = HERE.parents[1]

Case = dict[str, Any]


@pytest.fixture(scope="session")
def built() -> Path:
    """The folder of the module; `make web` builds it."""
    folder = Path(os.environ.get("DELONE_WEB_OUT", ROOT / "target" / "web"))
    if not (folder / "delone_web_bg.wasm").exists():
        pytest.skip("the module for pages is not built")
    return folder


@pytest.fixture(scope="session")
def node(built: Path) -> Callable[[list[Case]], list[dict[str, Any]]]:
    """Runs calls in Node."""
    command = shutil.which("node")
    if command is None:
        pytest.skip("no Node is installed")

    def run(cases: list[Case]) -> list[dict[str, Any]]:
        done = subprocess.run(
            [command, str(HERE / "node.mjs"), str(built)],
            input=json.dumps(cases), capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        found: list[dict[str, Any]] = json.loads(done.stdout)
        return found

    return run


class _Handler(SimpleHTTPRequestHandler):
    """Serves the page, the module, and the calls of a test."""

    def __init__(self, *args: Any, built: Path, cases: list[Case], **options: Any) -> None:
        self.built, self.cases = built, cases
        super().__init__(*args, directory=str(HERE), **options)

    def do_GET(self) -> None:
        """Answer with the calls, or with a file."""
        if self.path != "/cases.json":
            super().do_GET()
            return
        body = json.dumps(self.cases).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def translate_path(self, path: str) -> str:
        """Return a file of the module for what is below /module/."""
        if path.startswith("/module/"):
            return str(self.built / path.removeprefix("/module/"))
        return super().translate_path(path)

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing."""


@pytest.fixture(scope="session")
def page(built: Path) -> Iterator[Callable[[list[Case]], list[dict[str, Any]]]]:
    """Runs calls in Chromium."""
    if chromium() is None:
        pytest.skip("no Chromium is installed")
    with Browser() as browser:

        def run(cases: list[Case]) -> list[dict[str, Any]]:
            handler = partial(_Handler, built=built, cases=cases)
            with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
                thread = threading.Thread(target=server.serve_forever)
                thread.start()
                try:
                    address = f"http://127.0.0.1:{server.server_port}/page.html"
                    opened = browser.page(address)
                    opened.wait("window.answers")
                    text: str = opened.run("window.answers()")
                finally:
                    server.shutdown()
                    thread.join()
            found: list[dict[str, Any]] = json.loads(text)
            return found

        yield run


@pytest.fixture(scope="session", params=["node", "page"])
def run(request: pytest.FixtureRequest) -> Callable[[list[Case]], list[dict[str, Any]]]:
    """Runs calls in Node, then in Chromium."""
    found: Callable[[list[Case]], list[dict[str, Any]]] = request.getfixturevalue(request.param)
    return found
