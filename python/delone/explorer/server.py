"""The server of the command ``delone explore``: one page on 127.0.0.1, at a secret address.

The address contains a random token, which all requests need. Requests must name 127.0.0.1 or
localhost as their host, so that a page of another site cannot reach this server under its own name
(DNS rebinding), and the origin of a request that changes something must be the page itself.
Everything that can be requested is in a table: no path in a request reaches the file system.
"""

from __future__ import annotations

import json
import secrets
import sys
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

from delone.errors import DeloneError
from delone.explorer import script

if TYPE_CHECKING:
    from delone.explorer.state import Exploration

__all__ = ["ExploreServer"]

_JS = "text/javascript; charset=utf-8"
_TEXT = "text/plain; charset=utf-8"
_FILES = {
    "": ("page.html", "text/html; charset=utf-8"),
    "page.css": ("page.css", "text/css; charset=utf-8"),
    **{name: (name, _JS) for name in ("page.js", "scene.js", "view.js")},
    **{name: (name, _JS) for name in ("mesh.js", "colors.js", "paint.js")},
}
_HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    # The address contains the token.
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
# A row number and two numbers as JSON; more is not read.
_MOST_BYTES = 1024
# A client that is silent for longer is disconnected.
_PATIENCE = 20.0  # seconds


class ExploreServer(ThreadingHTTPServer):
    """A server for one exploration; `serve_forever` serves, `server_close` frees the port."""

    # Threads of slow clients do not delay the end of the process.
    daemon_threads = True
    block_on_close = False
    # On Windows, reuse would let another process listen at the same port.
    allow_reuse_address = sys.platform != "win32"

    def __init__(self, state: Exploration, *, name: str, port: int = 0) -> None:
        self.state = state
        self.name = name
        self.token = secrets.token_urlsafe(32)
        super().__init__(("127.0.0.1", port), _Handler)

    @property
    def address(self) -> str:
        """The address of the page, with the token."""
        return f"http://127.0.0.1:{self.server_port}/{self.token}/"

    def hosts(self) -> set[str]:
        """The values of the header Host that are accepted."""
        return {f"{name}:{self.server_port}" for name in ("127.0.0.1", "localhost")}

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing about connections that clients have closed or left idle."""
        if not isinstance(sys.exception(), ConnectionError | TimeoutError):
            super().handle_error(request, client_address)


class _Handler(BaseHTTPRequestHandler):
    """Answers one request."""

    server: ExploreServer
    timeout = _PATIENCE
    server_version, sys_version = "delone", ""

    def do_GET(self) -> None:
        """Answer with a file, the scene, or the name of the input."""
        name = self._allowed()
        if name is None:
            return
        if name in _FILES:
            file, kind = _FILES[name]
            self._answer(HTTPStatus.OK, script(file).encode(), kind)
        elif name == "scene":
            self._answer(HTTPStatus.OK, self.server.state.packed(), "application/octet-stream")
        elif name == "name":
            self._answer(HTTPStatus.OK, self.server.name.encode(errors="replace"))
        else:
            self.send_error(HTTPStatus.NOT_FOUND)

    def do_POST(self) -> None:
        """Move a point."""
        name = self._allowed()
        if name is None:
            return
        origin = self.headers.get("Origin")
        if origin is not None and origin.removeprefix("http://") not in self.server.hosts():
            self.send_error(HTTPStatus.FORBIDDEN)
        elif name != "move":
            self.send_error(HTTPStatus.NOT_FOUND)
        else:
            self._move()

    def _move(self) -> None:
        length = self.headers.get("Content-Length", "")
        if not (length.isascii() and length.isdigit()):
            self.send_error(HTTPStatus.LENGTH_REQUIRED)
            return
        if len(length) > 9 or int(length) > _MOST_BYTES:
            self.send_error(HTTPStatus.REQUEST_ENTITY_TOO_LARGE)
            return
        try:
            asked = json.loads(self.rfile.read(int(length)))
            target = asked["vertex"], asked["x"], asked["y"]
        except (ValueError, TypeError, KeyError, RecursionError):
            self.send_error(HTTPStatus.BAD_REQUEST)
            return
        try:
            scene = self.server.state.move(*target)
        except DeloneError as error:
            # The text is shown, as text, on the page.
            self._answer(HTTPStatus.UNPROCESSABLE_ENTITY, str(error).encode(errors="replace"))
        except MemoryError:
            self._answer(HTTPStatus.INSUFFICIENT_STORAGE, b"there is not enough memory")
        else:
            self._answer(HTTPStatus.OK, scene, "application/octet-stream")

    def _allowed(self) -> str | None:
        """Return the part of a request after its token; None if it was rejected."""
        if self.headers.get_all("Host", []) not in [[host] for host in self.server.hosts()]:
            self.send_error(HTTPStatus.FORBIDDEN)
            return None
        parts = self.path.split("/")
        given = parts[1] if len(parts) == 3 and not parts[0] else ""
        # In time that does not depend on how much of the token is correct.
        if not secrets.compare_digest(
            given.encode("latin-1", "replace"), self.server.token.encode()
        ):
            self.send_error(HTTPStatus.NOT_FOUND)
            return None
        return parts[2]

    def _answer(self, status: HTTPStatus, body: bytes, kind: str = _TEXT) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        for header, value in _HEADERS.items():
            self.send_header(header, value)
        self.end_headers()
        self.wfile.write(body)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        """Answer with only the number and the name of an error, and nothing from the request."""
        status = HTTPStatus(code)
        self.close_connection = True
        self._answer(status, f"{status.value} {status.phrase}\n".encode())

    def log_message(self, format: str, *args: Any) -> None:
        """Print nothing: a logged address would reveal the token."""
