"""Four and more dimensions: time and memory compared with SciPy, in fresh processes.

Each call runs in its own process; the peers take turns in each round. The columns are the number
of simplices, the least processor seconds, the peak memory during the call, and the memory that
the process keeps with the result. Both are in addition to what the process held before the call.
``python benchmarks/higher.py --help`` has options.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import memory
import numpy as np
import report

# By name: coordinates, the number of points at size 1, and the distribution.
SETS: dict[str, tuple[int, int, str]] = {
    "4-D uniform": (4, 20_000, "uniform"),
    "4-D clusters": (4, 20_000, "clusters"),
    "4-D sphere": (4, 5_000, "sphere"),
    "5-D uniform": (5, 5_000, "uniform"),
    "5-D clusters": (5, 5_000, "clusters"),
    "6-D uniform": (6, 1_000, "uniform"),
    "6-D clusters": (6, 1_000, "clusters"),
    "6-D compositions": (6, 400, "compositions"),
    "8-D uniform": (8, 150, "uniform"),
    "8-D clusters": (8, 150, "clusters"),
}
PEERS = "delone", "SciPy"
UNIT = 1e6
# Parts of a whole of which a composition consists.
PARTS = 12


def points_of(name: str, size: float) -> Any:
    """Return the points of a set."""
    d, count, kind = SETS[name]
    n = max(d + 2, int(count * size))
    random = np.random.default_rng(d)
    if kind == "uniform":
        return random.random((n, d))
    if kind == "clusters":
        # Twenty normal clouds of different widths.
        centers, widths = random.random((20, d)), 2.0 ** -random.integers(2, 8, 20)
        own = random.integers(0, 20, n)
        return centers[own] + widths[own, None] * random.normal(size=(n, d))
    if kind == "sphere":
        points = random.normal(size=(n, d))
        return points / np.linalg.norm(points, axis=1)[:, None]
    # Fractions of d + 1 parts, without the last one: rounded, and most of them cospherical.
    rows = np.unique(random.multinomial(PARTS, np.ones(d + 1) / (d + 1), 4 * n), axis=0)
    return random.permutation(rows)[:n, :d] / PARTS


def call(peer: str, name: str, size: float) -> dict[str, float]:
    """Triangulate once; return seconds, bytes and the number of simplices."""
    points = points_of(name, size)
    if peer == "delone":
        from delone import Delaunay as Triangulation
    else:
        from scipy.spatial import Delaunay as Triangulation
    # What the first call of all loads is not counted.
    Triangulation(np.vstack((np.zeros(points.shape[1]), np.eye(points.shape[1]))))
    before = memory.start()
    start = time.process_time()
    mesh = Triangulation(points)
    seconds = time.process_time() - start
    held = memory.peak() - before
    memory.start()
    kept = memory.peak() - before
    return {"seconds": seconds, "peak": held, "kept": kept, "simplices": len(mesh.simplices)}


def called(peer: str, name: str, size: float, limit: float) -> dict[str, float] | None:
    """Return the same from a fresh process; None if it takes too long."""
    given = ["--one", peer, "--sets", name, "--size", str(size)]
    try:
        done = subprocess.run(
            [sys.executable, str(Path(__file__)), *given],
            capture_output=True,
            text=True,
            check=True,
            timeout=limit,
            env=os.environ | {"OMP_NUM_THREADS": "1"},
        )
    except subprocess.TimeoutExpired:
        return None
    found: dict[str, float] = json.loads(done.stdout)
    return found


def row(name: str, size: float, rounds: int, limit: float) -> list[str]:
    """Return the cells of a set."""
    runs: dict[str, list[dict[str, float]]] = {peer: [] for peer in PEERS}
    for _ in range(rounds):
        for peer in PEERS:
            if (found := called(peer, name, size, limit)) is not None:
                runs[peer].append(found)
    cells = [name, str(len(points_of(name, size)))]
    for peer in PEERS:
        if not runs[peer]:
            cells += ["", f"> {limit:.0f} s", "", ""]
            continue
        least = min(run["seconds"] for run in runs[peer])
        peak, kept = (max(run[key] for run in runs[peer]) / UNIT for key in ("peak", "kept"))
        simplices = int(runs[peer][0]["simplices"])
        cells += [f"{simplices:,}", report.seconds(least), f"{peak:.0f}", f"{kept:.0f}"]
    if all(runs.values()):
        for key, pick in (("seconds", min), ("peak", max)):
            own, other = (pick(run[key] for run in runs[peer]) for peer in PEERS)
            faster = key == "seconds"
            share = other / max(own, 1e-9) if faster else own / max(other, 1)
            cells.append(report.ratio(share))
    return cells


def main() -> None:
    """Print the table, or the result of one call."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sets", default=",".join(SETS), help="names, separated by commas")
    parser.add_argument("--size", type=float, default=1.0, help="times the number of points")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--limit", type=float, default=200.0, help="seconds of a call")
    parser.add_argument("--one", choices=PEERS, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.one:
        print(json.dumps(call(given.one, given.sets, given.size)))
        return
    columns = "simplices", "s", "peak MB", "kept MB"
    head = ["set", "points", *columns, *columns, "times faster", "share of peak"]
    rows = [row(name, given.size, given.rounds, given.limit) for name in given.sets.split(",")]
    print(report.machine())
    print(report.table(head, rows))


if __name__ == "__main__":
    main()
