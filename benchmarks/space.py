"""Three dimensions side by side, delone, CGAL and SciPy: ``python benchmarks/space.py``.

Each peer works in processes of its own, whose first call is cold and the others warm, and they take
turns, round by round. Timed is the way from an array of points to `simplices` and `neighbors`;
CGAL, built where Debian's libcgal-dev is installed, is timed to its own data structure. SciPy takes
part where a run lasts some seconds. Every answer of delone is checked exactly, once.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

import adapters
import crates
import numpy as np
import report
from numpy.typing import NDArray
from rounds import HEAD, Module, Program, compete

if TYPE_CHECKING:
    from delone import Delaunay

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
    """Delone: `simplices` and `neighbors` are there when the constructor returns."""
    import delone as library

    return adapters.Adapter(
        lambda points: library.Delaunay(points, workers=workers), _verdict, library.__version__
    )


def _verdict(points: NDArray[np.float64], answer: Delaunay) -> NDArray[np.int32]:
    """The number of tetrahedra, and how many faults they have."""
    del points
    report = answer.validate()
    faults = sum(getattr(report, each.name).size for each in fields(report))
    return np.array([answer.nsimplex, faults], np.int32)


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


def rows(name: str, given: argparse.Namespace, cgal: Path | None) -> list[list[str]]:
    """Return the lines of one point set."""
    points = make(name)
    with tempfile.TemporaryDirectory() as folder:
        file, raw = Path(folder) / "points.npy", Path(folder) / "points"
        np.save(file, points)
        points.tofile(raw)
        bearable = name.startswith("uniform") and len(points) <= FEW
        names = [peer for peer in PEERS if peer != "SciPy" or bearable]
        modules = [Module(peer, file, module="space", limit=LIMIT) for peer in names]
        programs = [Program(cgal, raw, "CGAL 1 thread", limit=LIMIT)] if cgal else []
        compete([*modules, *programs], given.rounds, given.warm)
        base = modules[0].times
        table = [
            [name, peer.times.name, *peer.times.cells(base), *_found(peer)] for peer in modules
        ]
        return table + [[name, peer.times.name, *peer.times.cells(base), ""] for peer in programs]


def _found(peer: Module) -> list[str]:
    """Return what is wrong with a peer's answer."""
    if not peer.answer.exists():
        return [""]
    _, wrong = np.load(peer.answer)
    return ["" if wrong < 0 else "exact" if wrong == 0 else f"{wrong} faults"]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", default=",".join(SETS), help="such as uniform:1000000")
    parser.add_argument("--n", type=int, help="take this number of points for every set")
    parser.add_argument("--rounds", type=int, default=3, help="processes of each peer (default 3)")
    parser.add_argument("--warm", type=int, default=1, help="warm runs in each (default 1)")
    # `make bench` gives all programs the same options.
    arguments = parser.parse_known_args()[0]
    names = [n for n in arguments.sets.split(",") if n.partition(":")[0] in _kinds()] or list(SETS)
    if arguments.n:
        names = list(dict.fromkeys(f"{n.partition(':')[0]}:{arguments.n}" for n in names))
    print(f"Three dimensions; {report.machine()}\n")
    cgal = crates.build_cgal("cgal_space")
    found = [row for name in names for row in rows(name, arguments, cgal)]
    print(report.table(["set", "peer", *HEAD, "result"], found))


def _kinds() -> set[str]:
    return {name.partition(":")[0] for name in SETS}


if __name__ == "__main__":
    main()
