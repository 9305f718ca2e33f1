"""Triangulations that change: delone, CGAL, spade, and startinpy if installed.

Each peer works in a process of its own, on one thread, and they take turns run by run. The table
has microseconds of processor time for each point, of the clock for spade; for snapshots,
milliseconds and megabytes. CGAL is built where Debian's libcgal-dev is installed, and spade where
Cargo is. startinpy is given a tenth of the points, along a curve. Run it:
``python benchmarks/live.py [--n 1000000] [--m 100000] [--ndim 2] [--runs 5]``.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import crates
import numpy as np
import report

PEERS = ("delone", "startinpy")


def timed(name: str, count: int, work: Callable[[], Any]) -> Any:
    """Run some work, and print its name, processor seconds, and how many points it edits."""
    start = time.process_time()
    made = work()
    print(f"{name}\t{time.process_time() - start:.9f}\t{count}", flush=True)
    return made


def steps(count: int, ndim: int, by: float) -> np.ndarray:
    """Small moves in all directions."""
    i = np.arange(count)
    turn = [np.cos(i), np.sin(i)] if ndim == 2 else [np.cos(i), 0.6 * np.sin(i), 0.8 * np.sin(i)]
    return by * np.column_stack(turn)


def run_delone(points: np.ndarray, n: int, m: int) -> None:
    """Time edits of delone on one thread."""
    import delone

    ndim = points.shape[1]
    first, more = points[:n].copy(), points[n : n + m].copy()
    spacing = n ** (-1 / ndim)
    timed("bulk build", n, lambda: delone.Delaunay(first, workers=1))
    live = timed("build", n, lambda: delone.Dynamic(first, workers=1))
    timed("insert a batch", m, lambda: live.insert(more))
    picked = np.arange(m) * (n // m)
    timed("remove a batch", m, lambda: live.remove(picked + 1))
    where = first[picked + 2] + steps(m, ndim, 0.1 * spacing)
    timed("move a batch by a tenth", m, lambda: live.move(picked + 2, where))
    one = m // 10
    there = list((more[:one] + steps(one, ndim, 0.3 * spacing))[:, None, :])
    timed("insert one by one, anywhere", one, lambda: [live.insert(p) for p in there])
    near = list((0.5 + steps(one, ndim, 0.1) * np.linspace(0.1, 1, one)[:, None])[:, None, :])
    near.sort(key=lambda p: np.floor(200 * p[0, 0]) + p[0, 1])
    timed("insert one by one, near the last", one, lambda: [live.insert(p) for p in near])
    gone = list((picked + 0)[:one, None])
    timed("remove one by one, anywhere", one, lambda: [live.remove(h) for h in gone])
    states(live, ndim)


def states(live: Any, ndim: int) -> None:
    """Time snapshots, and print their memory."""
    draw = np.random.default_rng(7)
    last = timed("first snapshot", 1, live.snapshot)
    for name, width in (("in one place", 0.02), ("scattered", 1.0)):
        live.insert(0.4 + width * (draw.random((1000, ndim)) - 0.4))
        state = timed(f"snapshot after 1000 {name}", 1, live.snapshot)
        print(f"its memory, {name}\t{state.bytes_beyond(last) / 1e6:.9f}\t0", flush=True)
        last = state
    live.changes()
    live.insert(0.4 + 0.02 * draw.random((1000, ndim)))
    timed("changes after 1000", 1, live.changes)
    timed("restore 1000", 1, lambda: live.restore(last))


def run_startinpy(points: np.ndarray, n: int, m: int) -> None:
    """Time edits of startinpy."""
    import startinpy

    n, m = n // 10, m // 10
    flat = np.column_stack((points[: n + m], np.zeros(n + m)))

    def along(rows: np.ndarray) -> np.ndarray:
        strip = np.floor(rows[:, 0] * np.sqrt(len(rows)) / 2).astype(int)
        return rows[np.lexsort((np.where(strip % 2, -rows[:, 1], rows[:, 1]), strip))]

    first, more = along(flat[:n]), along(flat[n:])
    mesh = startinpy.DT()
    mesh.snap_tolerance = 1e-12
    timed("build", n, lambda: mesh.insert(first))
    timed("insert a batch", m, lambda: mesh.insert(more))
    # Vertices count from 1, in the order of insertion.
    gone = (1 + np.arange(m) * (n // m)).tolist()
    timed("remove a batch", m, lambda: [mesh.remove(v) for v in gone])
    one = max(m // 10, 1)
    there = (flat[n : n + one] + 0.3 * n**-0.5).tolist()
    timed("insert one by one, anywhere", one, lambda: [mesh.insert_one_pt(p) for p in there])


def lines_of(command: list[str]) -> list[tuple[str, float, int]]:
    """Return what a peer prints."""
    made = subprocess.run(command, check=True, capture_output=True, text=True)
    rows = [line.split("\t") for line in made.stdout.splitlines()]
    return [(name, float(value), int(count)) for name, value, count in rows]


def compare(n: int, m: int, ndim: int, runs: int) -> str:
    """Return a table of the medians of all peers."""
    peers: dict[str, list[str]] = {}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "points.raw"
        np.random.default_rng(0).random((n + m, ndim)).tofile(file)
        size = [str(n), str(m)]
        for name in PEERS if ndim == 2 else PEERS[:1]:
            if name != "startinpy" or _has("startinpy"):
                peers[name] = [
                    sys.executable,
                    __file__,
                    "--peer",
                    name,
                    str(file),
                    str(ndim),
                    *size,
                ]
        if ndim == 2 and shutil.which("cargo"):
            peers["spade"] = [str(crates.build().with_name("live")), str(file), *size]
        if program := crates.build_cgal("cgal_live"):
            kind = "PLANE" if ndim == 2 else "SPACE"
            peers["CGAL"] = [str(program), kind, str(file), *size]
        found: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
        for _ in range(runs):
            for peer, command in peers.items():
                for name, value, count in lines_of(command):
                    unit = 1e6 / count if count > 1 else 1e3 if count else 1.0
                    found[name][peer].append(value * unit)
    rows = [
        [name, *(report.seconds(report.median(of[p])) if p in of else "" for p in peers)]
        for name, of in found.items()
    ]
    return report.table(["edit", *peers], rows)


def _has(module: str) -> bool:
    import importlib.util

    return importlib.util.find_spec(module) is not None


def main() -> None:
    """Print a table, or do the work of one peer."""
    if sys.argv[1:2] == ["--peer"]:
        _, _, peer, file, ndim, n, m = sys.argv
        points = np.fromfile(file).reshape(-1, int(ndim))
        work = {"delone": run_delone, "startinpy": run_startinpy}[peer]
        return work(points, int(n), int(m))
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--n", type=int, default=1_000_000)
    parser.add_argument("--m", type=int, default=100_000)
    parser.add_argument("--ndim", type=int, default=2, choices=(2, 3))
    parser.add_argument("--runs", type=int, default=5)
    given = parser.parse_args()
    print(f"Edits, {given.runs} runs; {report.machine()}\n")
    print(compare(given.n, given.m, given.ndim, given.runs))


if __name__ == "__main__":
    main()
