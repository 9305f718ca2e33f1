"""What tells whether a file has opened anything else: a watched canary and a local listener."""

from __future__ import annotations

import ctypes
import os
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

# Of inotify: a file is opened; a read does not wait.
_OPENED, _NONBLOCK = 0x20, 0o4000


class Canary:
    """A folder of files that nobody but their writer may open; C libraries are seen, too."""

    def __init__(self, folder: Path) -> None:
        if not sys.platform.startswith("linux"):
            pytest.skip("inotify is part of Linux")
        self.folder = folder
        folder.mkdir()
        self.csv = folder / "secret.csv"
        self.csv.write_text("x,y,z\n1111,2222,1\n3333,4444,2\n5555,7777,3\n")
        self._libc = ctypes.CDLL(None, use_errno=True)
        self._descriptor = -1

    def watch(self) -> None:
        """Begin to record; what the test itself writes there must be written before."""
        self._descriptor = self._libc.inotify_init1(_NONBLOCK)
        assert self._descriptor >= 0
        assert self._libc.inotify_add_watch(self._descriptor, bytes(self.folder), _OPENED) >= 0

    @property
    def was_opened(self) -> bool:
        """Whether a file of the folder has been opened since `watch`, or since the last look."""
        assert self._descriptor >= 0, "watch() comes first"
        try:
            return len(os.read(self._descriptor, 1 << 16)) > 0
        except BlockingIOError:
            return False

    def close(self) -> None:
        if self._descriptor >= 0:
            os.close(self._descriptor)


class Listener:
    """An HTTP server of this machine that notes every request."""

    def __init__(self) -> None:
        requests: list[str] = []

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                requests.append(f"{self.command} {self.path}")
                self.send_response(404)
                self.end_headers()

            do_HEAD = do_POST = do_GET  # noqa: N815

            def log_message(self, *_: Any) -> None:
                pass

        self.requests = requests
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self._server.server_port}"
        # `close` waits until the server looks whether to stop: by default every half second.
        threading.Thread(target=self._server.serve_forever, args=(0.01,), daemon=True).start()

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()


@pytest.fixture
def canary(tmp_path):
    made = Canary(tmp_path / "elsewhere")
    yield made
    made.close()


@pytest.fixture
def listener():
    made = Listener()
    yield made
    made.close()
