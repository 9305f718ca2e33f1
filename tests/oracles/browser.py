"""A headless Chromium for tests of pages: the DevTools protocol over two pipes.

`Browser` starts it with a profile of its own. `Browser.page` opens an address; a page evaluates
JavaScript, sends real key and mouse events, takes screenshots, and collects what the console, the
log and uncaught exceptions say, so that a test can ask for silence.
"""

from __future__ import annotations

import base64
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["Browser", "Page", "chromium"]

PATIENCE = 60.0  # seconds until a browser that does not answer is an error
# The child of the fork: descriptors 3 and 4 are where Chromium reads and writes.
_START = (
    # Both are first copied out of the way: a copy of 3 onto 3 would keep its close-on-exec flag.
    "import fcntl, os, sys; "
    "r, w = (fcntl.fcntl(int(n), fcntl.F_DUPFD, 10) for n in sys.argv[1:3]); "
    "os.dup2(r, 3); os.dup2(w, 4); os.execvp(sys.argv[3], sys.argv[3:])"
)


def chromium() -> str | None:
    """Return the command of an installed Chromium or Chrome, None without one."""
    names = ("chromium", "chromium-browser", "google-chrome", "chrome")
    return next((found for name in names if (found := shutil.which(name))), None)


class Browser:
    """A running browser; leave its block to end it."""

    def __init__(self, *options: str) -> None:
        command = chromium()
        assert command, "no Chromium is installed"
        self.profile = tempfile.mkdtemp()
        theirs, self._to = os.pipe()
        self._from, answers = os.pipe()
        self._process = subprocess.Popen(
            [
                *(sys.executable, "-c", _START, str(theirs), str(answers), command),
                *("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"),
                *("--remote-debugging-pipe", "--no-first-run", "--disable-extensions"),
                *("--disable-background-networking", f"--user-data-dir={self.profile}"),
                *("--hide-scrollbars", *options, "about:blank"),
            ],
            pass_fds=(theirs, answers),
            stderr=subprocess.DEVNULL,
        )
        os.close(theirs)
        os.close(answers)
        self._rest = b""
        self._number = 0
        self.events: list[dict[str, Any]] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *what: object) -> None:
        os.close(self._to)
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._from)
        shutil.rmtree(self.profile, ignore_errors=True)

    def call(self, method: str, session: str | None = None, **parameters: Any) -> dict[str, Any]:
        """Send a command and return its result; events that come before it are kept."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        message |= {"sessionId": session} if session else {}
        os.write(self._to, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + PATIENCE
        while True:
            found = self._next(end - time.monotonic())
            assert found is not None, f"{method} is not answered"
            if found.get("id") == self._number:
                assert "error" not in found, f"{method}: {found['error']}"
                result: dict[str, Any] = found["result"]
                return result

    def _next(self, seconds: float) -> dict[str, Any] | None:
        """Return the next message, None if there is none in this time."""
        while b"\0" not in self._rest:
            if not select.select([self._from], [], [], max(0.0, seconds))[0]:
                return None
            block = os.read(self._from, 1 << 20)
            assert block, "the browser has ended"
            self._rest += block
        line, _, self._rest = self._rest.partition(b"\0")
        message: dict[str, Any] = json.loads(line)
        if "method" in message:
            self.events.append(message)
        return message

    def page(self, address: str, *, size: tuple[int, int] = (900, 700), dark: bool = False) -> Page:
        """Open an address in a new tab, and wait until it is loaded."""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        return Page(self, session, address, size, dark)


class Page:
    """A tab of a browser."""

    def __init__(
        self, browser: Browser, session: str, address: str, size: tuple[int, int], dark: bool
    ) -> None:
        self._browser, self._session = browser, session
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.resize(*size)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])
        self.call("Page.navigate", url=address)
        self.wait("document.readyState === 'complete' && location.href !== 'about:blank'")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command of the DevTools protocol to this tab."""
        return self._browser.call(method, self._session, **parameters)

    def resize(self, width: int, height: int, ratio: float = 1.0) -> None:
        """Set the size of the window in CSS pixels, and the device pixels in each."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=height, deviceScaleFactor=ratio, mobile=False,
        )  # fmt: skip

    def run(self, code: str) -> Any:
        """Evaluate JavaScript, wait for a promise, and return the value."""
        found = self.call(
            "Runtime.evaluate", expression=code, awaitPromise=True, returnByValue=True
        )
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def wait(self, condition: str) -> None:
        """Wait until an expression is true."""
        end = time.monotonic() + PATIENCE
        while not self.run(f"Boolean({condition})"):
            assert time.monotonic() < end, f"never: {condition}; {self.complaints()}"
            time.sleep(0.02)

    def mouse(self, kind: str, x: float, y: float, **more: Any) -> None:
        """Send a mouse event: "Moved", "Pressed", "Released" or "Wheel"."""
        button = {} if kind in ("Moved", "Wheel") else {"button": "left", "clickCount": 1}
        pressed = {"button": "left", "buttons": 1} if more.pop("held", False) else {}
        self.call(
            "Input.dispatchMouseEvent", type=f"mouse{kind}", x=x, y=y, **(button | pressed | more)
        )

    def click(self, x: float, y: float) -> None:
        """Press and release the mouse."""
        self.mouse("Pressed", x, y)
        self.mouse("Released", x, y)

    def key(self, key: str) -> None:
        """Press and release a key by its name in the DOM."""
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def screenshot(self, path: Path) -> None:
        """Write a PNG of the window."""
        data = self.call("Page.captureScreenshot", format="png")["data"]
        path.write_bytes(base64.b64decode(data))

    def complaints(self) -> list[str]:
        """Return what the console, the log and uncaught exceptions have said so far."""
        self.run("new Promise((done) => setTimeout(done, 50))")
        said = []
        for event in self._browser.events:
            if event.get("sessionId") != self._session:
                continue
            about = event["params"]
            if event["method"] == "Runtime.consoleAPICalled":
                if about["type"] in ("error", "warning", "assert"):
                    said.append(" ".join(str(each.get("value", each)) for each in about["args"]))
            elif event["method"] == "Log.entryAdded":
                said.append(f"{about['entry']['text']} {about['entry'].get('url', '')}".strip())
            elif event["method"] == "Runtime.exceptionThrown":
                said.append(json.dumps(about["exceptionDetails"]))
        return said

    def addresses(self) -> list[str]:
        """Return the addresses that the page has asked for."""
        return [
            event["params"]["request"]["url"]
            for event in self._browser.events
            if event.get("sessionId") == self._session
            and event["method"] == "Network.requestWillBeSent"
        ]
