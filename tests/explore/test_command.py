"""The command in a process of its own: what it reads, prints and serves, and how it ends."""

from __future__ import annotations

import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone.cli import run

if TYPE_CHECKING:
    from collections.abc import Iterator

ADDRESS = re.compile(r"http://127\.0\.0\.1:(\d+)/([\w-]{43})/")


@pytest.fixture
def survey(tmp_path: Path) -> Path:
    """Two hundred points with heights."""
    file = tmp_path / "survey.csv"
    points = np.random.default_rng(2).random((200, 3))
    np.savetxt(file, points, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    return file


@contextmanager
def started(*arguments: Any) -> Iterator[tuple[subprocess.Popen[str], int, str]]:
    """Start the command; give the process, the port and the token."""
    command = [sys.executable, "-m", "delone", "explore", "--no-browser", *map(str, arguments)]
    with tempfile.TemporaryFile("w+") as errors:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True)
        try:
            assert process.stdout is not None
            found = ADDRESS.fullmatch(process.stdout.readline().strip())
            assert found, process.wait()
            assert process.stdout.readline() == "Ctrl-C ends the command\n"
            yield process, int(found[1]), found[2]
        finally:
            process.kill()
            process.communicate()


def get(port: int, path: str) -> tuple[int, bytes]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("GET", path)
    found = connection.getresponse()
    answer = found.status, found.read()
    connection.close()
    return answer


def header(scene: bytes) -> dict[str, Any]:
    length = int.from_bytes(scene[:4], "little")
    found: dict[str, Any] = json.loads(scene[4 : 4 + length])
    return found


def test_a_file_is_served_until_ctrl_c(survey: Path) -> None:
    with started(survey) as (process, port, token):
        assert get(port, f"/{token}/name") == (200, b"survey.csv")
        told = header(get(port, f"/{token}/scene")[1])
        assert told["label"].startswith("Delaunay of 200 points")
        assert told["arrays"]["values"]["length"] == 200
        assert get(port, "/")[0] == 404
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        assert process.returncode == 130
        assert out.strip() == ""


def test_sigterm_ends_it(survey: Path) -> None:
    with started(survey) as (process, _, _):
        process.terminate()
        process.communicate(timeout=60)
        assert process.returncode == (143 if os.name == "posix" else 1)


def test_slow_clients_do_not_delay_ctrl_c(survey: Path) -> None:
    with started(survey) as (process, port, token):
        slow = [socket.create_connection(("127.0.0.1", port), timeout=60) for _ in range(3)]
        slow[1].sendall(b"GET /")
        head = (
            f"POST /{token}/move HTTP/1.0\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 99\r\n\r\n{{"
        )
        slow[2].sendall(head.encode())
        assert get(port, f"/{token}/")[0] == 200
        process.send_signal(signal.SIGINT)
        # The server would wait 20 s for these clients.
        process.communicate(timeout=15)
        assert process.returncode == 130
        for connection in slow:
            connection.close()


def test_a_port_can_be_chosen(survey: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert run(["explore", str(survey), "--no-browser", "--port", str(port)]) == 5
        assert f"--port {port}" in capfd.readouterr().err
    with started(survey, "--port", port) as (_, found, _):
        assert found == port


def test_lines_and_polygons_are_read(tmp_path: Path) -> None:
    pytest.importorskip("shapely")
    square = [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [2, 1], [2, 2], [1, 1]]]
    file = tmp_path / "lake.geojson"
    file.write_text(json.dumps({"type": "Polygon", "coordinates": square}))
    with started(file, "--outline", "--quality", "area") as (_, port, token):
        told = header(get(port, f"/{token}/scene")[1])
    assert told["label"].startswith("ConstrainedDelaunay of 7 points")
    assert told["arrays"]["constrained"]["length"] == 14
    assert told["qualityName"] == "area"


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        ("absent.csv", 3, "no such file"),
        ("line.csv", 4, "line"),
        ("corner.csv --outline", 2, "--outline"),
        ("corner.csv --port 65536", 2, "--port"),
        ("corner.csv --quality beauty", 2, "quality"),
    ],
)
def test_errors_have_their_codes(
    options: str, code: int, said: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "line.csv").write_text("x,y\n0,0\n1,1\n2,2\n")
    (tmp_path / "corner.csv").write_text("x,y\n0,0\n1,0\n0,1\n")
    file, *rest = options.split()
    assert run(["explore", str(tmp_path / file), "--no-browser", *rest]) == code
    assert said in capfd.readouterr().err


def test_the_browser_gets_the_address(survey: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []

    def stop(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    from delone.explorer.server import ExploreServer

    monkeypatch.setattr("webbrowser.open", opened.append)
    monkeypatch.setattr("threading.Thread", Now)
    monkeypatch.setattr(ExploreServer, "serve_forever", stop)
    assert run(["explore", str(survey)]) == 130
    assert len(opened) == 1
    assert ADDRESS.fullmatch(opened[0])
    assert run(["explore", str(survey), "--no-browser"]) == 130
    assert len(opened) == 1


class Now:
    """A thread whose work is done when it starts."""

    def __init__(self, *, target: Any, args: Any = (), daemon: bool = False) -> None:
        self._work = lambda: target(*args)

    def start(self) -> None:
        self._work()
