"""Three dimensions side by side, delone, CGAL and SciPy: ``python benchmarks/space.py``.

Each peer works in a process of its own, and they take turns run by run. Timed is the way from an
array of points to `simplices` and `neighbors`; CGAL, built where Debian's libcgal-dev is installed,
is timed to its own data structure. SciPy takes part where a run lasts some seconds.
Every answer of delone is checked exactly, once.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import adapters
import crates
import numpy as np
import report
from numpy.typing import NDArray
from worker import Peer

if TYPE_CHECKING:
    from delone import _core

SEED = 2026
SETS = (
    "uniform:100000",
    "uniform:1000000",
    "grid:1000000",
    "sphere:1000000",
    "clusters:1000000",
    "kuzmin:1000000",
    "utm:1000000",
)
# SciPy takes half a minute for more points, and for ten thousand on a sphere.
FEW = 200_000
LIMIT = 300.0
Points = NDArray[np.float64]


def make(name: str) -> Points:
    """Return the set that `name` names, such as ``"sphere:100000"``."""
    kind, _, number = name.partition(":")
    n, rng = int(number), np.random.default_rng(SEED)
    if kind == "grid":
        side = np.arange(round(n ** (1 / 3)), dtype=float)
        return rng.permutation(np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3))
    if kind == "sphere":
        points = rng.standard_normal((n, 3))
        return points / np.linalg.norm(points, axis=1)[:, None]
    if kind == "clusters":
        return rng.random((20, 3))[rng.integers(0, 20, n)] + 0.01 * rng.standard_normal((n, 3))
    if kind == "kuzmin":
        # Dense at the centre, thin for ever outside.
        points = rng.standard_normal((n, 3))
        points /= np.linalg.norm(points, axis=1)[:, None]
        return points * np.sqrt(1 / (1 - rng.random(n)) ** 2 - 1)[:, None]
    if kind == "utm":
        # A cubic kilometre in millimetres, where UTM has it.
        corner = np.array([500_000.0, 4_500_000.0, 300.0])
        return corner + np.round(1000 * rng.random((n, 3)), 3)
    return rng.random((n, 3))


def delone(workers: int) -> adapters.Adapter:
    """Delone's core: arrays in, arrays out."""
    import delone as library
    from delone import _core

    return adapters.Adapter(
        lambda points: _core.triangulate3(points, workers),
        _verdict,
        library.__version__,
    )


def _verdict(points: NDArray[np.float64], answer: _core.Triangulation) -> NDArray[np.int32]:
    """The number of tetrahedra, and how many things are wrong with them."""
    from delone import _core

    found = _core.validate3(points, answer.simplices, answer.neighbors)
    single = (found.orientation, found.neighbors, found.missing, found.repeats)
    wrong = (*single, found.facets, found.hull, found.delaunay, found.ties)
    return np.array([len(answer.simplices), sum(map(len, wrong))], np.int32)


def scipy() -> adapters.Adapter:
    """SciPy's Qhull."""
    peer = adapters.scipy()
    return adapters.Adapter(
        peer.call, lambda _, answer: np.array([len(answer.simplices), -1]), peer.version
    )


PEERS = {
    "delone 1 thread": lambda: delone(1),
    "delone 2 threads": lambda: delone(2),
    "SciPy": scipy,
}


class Program:
    """CGAL at work on one file of points: a process a run."""

    def __init__(self, program: Path, points_file: Path) -> None:
        self.command = [str(program), "1", str(points_file)]
        self.seconds: list[float] = []
        self.count = 0

    def run(self) -> None:
        """Do one run."""
        output = subprocess.run(
            self.command, capture_output=True, text=True, check=True, timeout=LIMIT
        ).stdout
        _, seconds, _, count = output.split()
        self.seconds.append(float(seconds))
        self.count = int(count)


def rows(name: str, runs: int, cgal: Path | None) -> list[list[str]]:
    """Return the lines of one point set."""
    points = make(name)
    with tempfile.TemporaryDirectory() as folder:
        points_file = Path(folder) / "points.npy"
        np.save(points_file, points)
        raw = Path(folder) / "points"
        points.tofile(raw)
        bearable = name.startswith("uniform") and len(points) <= FEW
        names = [peer for peer in PEERS if peer != "SciPy" or bearable]
        peers = [Peer(p, points_file, points_file.with_name(f"{p}.npy"), "space") for p in names]
        program = Program(cgal, raw) if cgal else None
        for turn in range(runs):
            for peer in peers:
                if peer.name != "SciPy" or turn == 0:
                    peer.run(LIMIT)
            if program:
                program.run()
        for peer in peers:
            peer.stop()
        table = []
        base = report.median(run.seconds for run in peers[0].runs)
        for peer in peers:
            if not peer.runs:
                table.append([name, peer.name, peer.ended, "", "", "", ""])
                continue
            middle = report.median(run.seconds for run in peer.runs)
            count, wrong = np.load(peer.answer_file)
            verdict = "" if wrong < 0 else "exact" if wrong == 0 else f"{wrong} faults"
            memory = f"{1e6 * peer.runs[0].megabytes / len(points):.0f}"
            table.append(
                _row(name, f"{peer.name} {peer.version}", middle, base, (int(count), verdict))
            )
            table[-1].append(memory)
        if program:
            middle = report.median(program.seconds)
            table.append([*_row(name, "CGAL 1 thread", middle, base, (program.count, "")), ""])
    return table


def _row(name: str, peer: str, middle: float, base: float, found: tuple[int, str]) -> list[str]:
    number = int(name.partition(":")[2])
    each = f"{1e9 * middle / number:.0f}"
    count, verdict = found
    return [
        name,
        peer,
        report.seconds(middle),
        each,
        report.ratio(middle / base),
        str(count),
        verdict,
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", default=",".join(SETS), help="such as uniform:1000000")
    parser.add_argument("--n", type=int, help="take this number of points for every set")
    parser.add_argument("--runs", type=int, default=5, help="runs for each peer (default 5)")
    # `make bench` gives all programs the same options.
    arguments = parser.parse_known_args()[0]
    names = [n for n in arguments.sets.split(",") if n.partition(":")[0] in _kinds()] or list(SETS)
    if arguments.n:
        names = list(dict.fromkeys(f"{n.partition(':')[0]}:{arguments.n}" for n in names))
    print(f"Three dimensions; {report.machine()}\n")
    cgal = crates.build_cgal("cgal_space")
    head = [
        "set",
        "peer",
        "seconds",
        "ns a point",
        "times delone",
        "tetrahedra",
        "result",
        "B a point",
    ]
    print(report.table(head, [row for n in names for row in rows(n, arguments.runs, cgal)]))


def _kinds() -> set[str]:
    return {name.partition(":")[0] for name in SETS}


if __name__ == "__main__":
    main()
