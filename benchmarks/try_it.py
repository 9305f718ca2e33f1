"""Measures the page on which readers triangulate their own points, in a headless Chromium.

    python benchmarks/try_it.py

It needs Chromium and the module of `make web`. Times are in milliseconds, the drawing on a canvas
of about 970 by 600 pixels without a graphics card, including the time until pixels can be read.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
import threading
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from statistics import quantiles
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "tests" / "oracles"), str(ROOT / "docs" / "extensions")]

from live_files import points_html  # noqa: E402

from browser import Browser  # noqa: E402

SAMPLES = {"random": 500, "many": 10_000, "most": 100_000}
MOVES = 200
# A point goes around an ellipse, inside the points.
CODE = """(async () => {
  const page = await window.deloneTry;
  const { picture, hand } = page;
  const { triangulating } = await page.client.ask("sample", { name: NAME });
  await page.readSample(NAME);
  const flush = () => [picture.back, picture.front].forEach(
    (canvas) => canvas.getContext("2d").getImageData(0, 0, 1, 1));
  const timed = async (work) => {
    const start = performance.now();
    await work();
    flush();
    return performance.now() - start;
  };
  const soon = () => new Promise((done) => setTimeout(done, 0));
  const idle = async () => { while (picture.job) await soon(); };
  const found = { triangulation: [triangulating], all: [], update: [], drawing: [], move: [] };
  await idle();
  for (let k = 0; k < 10; k += 1) {
    found.all.push(await timed(async () => { picture.draw(); await idle(); }));
  }
  hand.grab(7);
  await page.client.ask("hold");
  for (let k = 0; k < MOVES; k += 1) {
    const turn = 2 * Math.PI * k / MOVES;
    const [x, y] = [500 + 300 * Math.cos(turn), 300 + 200 * Math.sin(turn)];
    found.move.push(await timed(() => hand.drag(7, x, y)));
    found.update.push(hand.times.update);
    found.drawing.push(found.move.at(-1) - hand.times.update);
    await new Promise(requestAnimationFrame);
  }
  await hand.drop();
  return JSON.stringify(found);
})()"""
COLUMNS = {
    "triangulation": "triangulation",
    "all": "drawing all",
    "update": "update",
    "drawing": "drawing a change",
    "move": "a move in all",
}


class Quiet(SimpleHTTPRequestHandler):
    """Serves files and says nothing."""

    def log_message(self, *what: object) -> None:
        """Say nothing."""


@contextmanager
def page() -> Iterator[str]:
    """Serve the page; gives its address."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(ROOT / "docs" / "_static" / "learn", folder / "learn")
        shutil.copytree(ROOT / "target" / "web", folder / "learn" / "core")
        (folder / "index.html").write_text(
            "<!doctype html><meta charset=utf-8><title>Try it</title><link rel=icon href=data:,>"
            "<link rel=stylesheet href=learn/learn.css><link rel=stylesheet href=learn/try/try.css>"
            f"{points_html(live=True)}<script type=module src=learn/try/main.js></script>",
            encoding="utf-8",
        )
        server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=folder))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/index.html"
        server.shutdown()
        server.server_close()


def cell(times: list[float]) -> str:
    """Median and, of many, the 95th percentile."""
    if len(times) < 2:
        return f"{times[0]:.1f}"
    cuts = quantiles(times, n=20, method="inclusive")
    return f"{cuts[9]:.1f} ({cuts[18]:.1f})"


def main() -> None:
    """Print a table."""
    print("Median, and in parentheses the 95th percentile, in milliseconds.\n")
    print("| points | " + " | ".join(COLUMNS.values()) + " |")
    print("|---|" + "---|" * len(COLUMNS))
    with page() as address, Browser() as browser:
        opened = browser.page(address, size=(1000, 1000))
        opened.run("window.deloneTry.then(() => 1)")
        for name, count in SAMPLES.items():
            code = CODE.replace("NAME", json.dumps(name)).replace("MOVES", str(MOVES))
            found = json.loads(opened.run(code))
            print(f"| {count:,} | " + " | ".join(cell(found[key]) for key in COLUMNS) + " |")


if __name__ == "__main__":
    main()
