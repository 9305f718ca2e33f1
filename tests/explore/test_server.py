"""The server answers those who have its address, and nobody else; it reads no path."""

from __future__ import annotations

import http.client
import json
import re
import socket
import threading
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay
from delone.explorer.server import ExploreServer
from delone.explorer.state import Exploration

if TYPE_CHECKING:
    from collections.abc import Mapping

NAMES = (
    *("", "page.css", "page.js", "scene.js", "view.js", "mesh.js", "colors.js", "paint.js"),
    *("scene", "name"),
)


class Answer:
    """Status, headers and body of an answer."""

    def __init__(self, found: http.client.HTTPResponse) -> None:
        self.status, self.headers, self.body = found.status, found.headers, found.read()


def ask(
    server: ExploreServer,
    path: str,
    *,
    method: str = "GET",
    body: bytes | None = None,
    headers: Mapping[str, str] | None = None,
) -> Answer:
    """Send a request as it is, without the help of a library that would tidy the path."""
    given = {"Host": f"127.0.0.1:{server.server_port}", **(headers or {})}
    if body is not None:
        given.setdefault("Content-Length", str(len(body)))
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=60)
    connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
    for name, value in given.items():
        if value:
            connection.putheader(name, value)
    connection.endheaders(body)
    answer = Answer(connection.getresponse())
    connection.close()
    return answer


def move(server: ExploreServer, body: Any, **headers: str) -> Answer:
    text = body if isinstance(body, bytes) else json.dumps(body).encode()
    path = f"/{server.token}/move"
    return ask(server, path, method="POST", body=text, headers=headers)


@pytest.mark.parametrize("name", NAMES)
def test_what_the_page_needs_is_there(server: ExploreServer, name: str) -> None:
    answer = ask(server, f"/{server.token}/{name}")
    assert answer.status == 200
    assert answer.body
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    policy = answer.headers["Content-Security-Policy"]
    assert policy.startswith("default-src 'none'; script-src 'self'; style-src 'self';")
    assert "unsafe" not in policy
    assert answer.headers["Referrer-Policy"] == "no-referrer"
    assert answer.headers["Cache-Control"] == "no-store"
    assert "Access-Control-Allow-Origin" not in answer.headers
    if name == "scene":
        assert answer.body == server.state.packed()


def test_tokens_are_long_and_differ(mesh: Delaunay) -> None:
    tokens = set()
    for _ in range(3):
        with ExploreServer(Exploration(mesh), name="a") as server:
            tokens.add(server.token)
            assert server.server_address[0] == "127.0.0.1"
    assert len(tokens) == 3
    # 32 random bytes in base 64.
    assert all(re.fullmatch(r"[\w-]{43}", token) for token in tokens)


def wrong_tokens(token: str) -> list[str]:
    last = "A" if token[-1] != "A" else "B"
    return [
        *("", "x", token[:-1], token[:-1] + last, token + "A", token + "=", token.swapcase()),
        *(token[0], "%" + token, "\xff" * len(token), token.replace(token[0], "%2e", 1)),
    ]


@pytest.mark.parametrize("name", [*NAMES, "move"])
def test_without_the_token_there_is_nothing(server: ExploreServer, name: str) -> None:
    points = server.state.mesh.points
    body = json.dumps({"vertex": 0, "x": 5, "y": 5}).encode()
    for token in wrong_tokens(server.token):
        path = f"/{token}/{name}"
        found = [raw(server, f"GET {path} HTTP/1.0")]
        if token.isascii():  # the client sends nothing else
            found += [ask(server, path), ask(server, path, method="POST", body=body)]
        assert {answer.status for answer in found} <= {404, 400}
        assert not any(b"canvas" in answer.body for answer in found)
    assert np.array_equal(server.state.mesh.points, points)


def raw(server: ExploreServer, line: str) -> Any:
    """Send one line and a header as bytes."""
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=60) as connection:
        text = f"{line}\r\nHost: 127.0.0.1:{server.server_port}\r\n\r\n"
        connection.sendall(text.encode("latin-1"))
        found = http.client.HTTPResponse(connection)
        found.begin()
        return Answer(found)


@pytest.mark.parametrize(
    "host",
    [
        *("evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "localhost"),
        *("127.0.0.1:{port}.evil.example", "127.0.0.2:{port}", "[::1]:{port}", "0.0.0.0:{port}"),
        *("LOCALHOST.evil:{port}", "127.0.0.1:{port}@evil.example", ""),
    ],
)
def test_other_hosts_are_refused(server: ExploreServer, host: str) -> None:
    named = {"Host": host.format(port=server.server_port)}
    for name in ("", "scene"):
        assert ask(server, f"/{server.token}/{name}", headers=named).status == 403
    body = b'{"vertex": 0, "x": 5, "y": 5}'
    path = f"/{server.token}/move"
    assert ask(server, path, method="POST", body=body, headers=named).status == 403
    assert 5 not in server.state.mesh.points


def test_two_hosts_are_refused(server: ExploreServer) -> None:
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=60) as connection:
        host = f"Host: 127.0.0.1:{server.server_port}\r\n"
        connection.sendall(f"GET /{server.token}/ HTTP/1.1\r\n{host}Host: a\r\n\r\n".encode())
        assert b" 403 " in connection.recv(64)


def test_localhost_is_a_name_of_this_machine(server: ExploreServer) -> None:
    named = {"Host": f"localhost:{server.server_port}"}
    assert ask(server, f"/{server.token}/", headers=named).status == 200


@pytest.mark.parametrize(
    "path",
    [
        *("../server.py", "../{token}/", "..", ".", "./", "//", "server.py", "widget.js"),
        *("page.html", "%2e%2e/server.py", "..%2fserver.py", "..\\server.py", "/etc/passwd"),
        *("__init__.py", "view.js/", "view.js?x=1", "view.js%00", "scene/..", "PAGE.JS"),
    ],
)
def test_paths_lead_nowhere(server: ExploreServer, path: str) -> None:
    answer = ask(server, f"/{server.token}/{path.format(token=server.token)}")
    assert answer.status == 404
    assert answer.body == b"404 Not Found\n"


@pytest.mark.parametrize("path", ["/", "*", "/{token}", "x/{token}/", "http://127.0.0.1/{token}/"])
def test_nothing_is_listed(server: ExploreServer, path: str) -> None:
    answer = raw(server, f"GET {path.format(token=server.token)} HTTP/1.0")
    assert answer.status in (400, 404)
    assert server.token.encode() not in answer.body


@pytest.mark.parametrize(
    "method", ["HEAD", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "CONNECT"]
)
def test_other_methods_are_refused(server: ExploreServer, method: str) -> None:
    for name in ("", "scene", "move"):
        answer = ask(server, f"/{server.token}/{name}", method=method)
        assert answer.status == 501
        assert "Allow" not in answer.headers
        assert "Access-Control-Allow-Methods" not in answer.headers


@pytest.mark.parametrize("name", ["", "scene", "view.js", "name", "x"])
def test_only_moves_are_posted(server: ExploreServer, name: str) -> None:
    assert ask(server, f"/{server.token}/{name}", method="POST", body=b"{}").status == 404
    assert ask(server, f"/{server.token}/move").status == 404


def test_a_moved_point_is_answered_with_the_scene(server: ExploreServer) -> None:
    moved = np.array(server.state.mesh.points)
    moved[8] = 0.5, 0.25
    origin = f"http://127.0.0.1:{server.server_port}"
    answer = move(server, {"vertex": 8, "x": 0.5, "y": 0.25}, Origin=origin)
    assert answer.status == 200
    assert answer.body == server.state.packed()
    assert np.array_equal(server.state.mesh.simplices, Delaunay(moved).simplices)


@pytest.mark.parametrize("origin", ["null", "http://evil.example", "https://127.0.0.1:{port}"])
def test_other_pages_move_nothing(server: ExploreServer, origin: str) -> None:
    given = origin.format(port=server.server_port)
    assert move(server, {"vertex": 8, "x": 5, "y": 5}, Origin=given).status == 403
    assert 5 not in server.state.mesh.points


def test_a_point_that_cannot_be_there_is_an_answer(server: ExploreServer) -> None:
    answer = move(server, {"vertex": 60, "x": 5, "y": 5})
    assert (answer.status, answer.headers["Content-Type"]) == (422, "text/plain; charset=utf-8")
    assert answer.body == b"point 60 does not exist or cannot be moved"


@pytest.mark.parametrize(
    "body",
    [b"", b"{", b"[]", b"3", b"{}", b'{"vertex": 1, "x": 2}', b"\xff\xfe", b"[" * 1000, b"null"],
)
def test_odd_bodies_are_refused(server: ExploreServer, body: bytes) -> None:
    assert move(server, body).status == 400


@pytest.mark.parametrize("text", ["NaN", "Infinity", "1e999"])
def test_numbers_out_of_range_are_refused(server: ExploreServer, text: str) -> None:
    answer = move(server, f'{{"vertex": 1, "x": {text}, "y": 0}}'.encode())
    assert answer.status == 422
    assert b"NaN or infinite" in answer.body


@pytest.mark.parametrize(
    ("length", "status"),
    [
        *(("1025", 413), ("99999999999999999999", 413), ("00000000000000000005", 413)),
        *(("-1", 411), ("", 411), ("1e3", 411), ("\xb2", 411), ("+5", 411)),
    ],
)
def test_bodies_are_bounded(server: ExploreServer, length: str, status: int) -> None:
    # The body is never sent: an answer shows that it is not waited for.
    path = f"/{server.token}/move"
    headers = {"Content-Length": length}
    assert ask(server, path, method="POST", headers=headers).status == status


def test_long_lines_are_refused(server: ExploreServer) -> None:
    assert raw(server, f"GET /{'a' * 70000} HTTP/1.0").status == 414


def test_slow_clients_delay_nobody(server: ExploreServer) -> None:
    slow = []
    for start in (b"", b"GE", f"POST /{server.token}/move HTTP/1.0\r\nHost: 127.0.0.1".encode()):
        connection = socket.create_connection(("127.0.0.1", server.server_port), timeout=60)
        connection.sendall(start)
        slow.append(connection)
    head = f"Host: 127.0.0.1:{server.server_port}\r\nContent-Length: 9\r\n\r\n"
    slow[1].sendall(f"T /{server.token}/scene HTTP/1.0\r\n{head}"[:20].encode())
    assert ask(server, f"/{server.token}/").status == 200
    server.shutdown()
    server.server_close()
    for connection in slow:
        connection.close()


def test_moves_at_the_same_time_follow_each_other(server: ExploreServer) -> None:
    def drag(row: int) -> None:
        for step in range(1, 6):
            assert move(server, {"vertex": row, "x": 0.1 * row, "y": step / 8}).status == 200

    threads = [threading.Thread(target=drag, args=[row]) for row in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    moved = np.array(server.state.mesh.points)
    assert moved[:4].tolist() == [[0.1 * row, 5 / 8] for row in range(4)]
    assert np.array_equal(server.state.mesh.simplices, Delaunay(moved).simplices)
