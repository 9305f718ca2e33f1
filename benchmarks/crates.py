"""Delone's core compared with the Rust crates spade and delaunator, and CGAL, on the same points.

Builds benchmarks/peers, hands it each point set as a file, and prints a table of medians. Each
crate runs in processes of its own, and so does CGAL, where its headers are installed: the first run
of a process is cold, the others are warm, and the peers take turns, round by round.
``python benchmarks/crates.py --help`` has options.
"""

import argparse
import shutil
import subprocess
import tempfile
from pathlib import Path

import judge
import numpy as np
import report
import sets
from adapters import rows_of
from rounds import HEAD, Program, compete

CRATE = Path(__file__).parent / "peers"
LIMIT = 600.0
PEERS = (
    "delone",
    "delone, 2 workers",
    "spade bulk_load",
    "spade bulk_load_stable",
    "delaunator",
)


def options() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", default=",".join(sets.DEFAULT), help="such as uniform:1000000")
    parser.add_argument("--n", type=int, help="take this number of points for every set")
    parser.add_argument("--rounds", type=int, default=5, help="processes of each peer (default 5)")
    parser.add_argument("--warm", type=int, default=1, help="warm runs in each (default 1)")
    # `make bench` gives both programs the same options, of which wheels.py knows more.
    return parser.parse_known_args()[0]


def build() -> Path:
    """Build the Rust side and return the program."""
    subprocess.run(["cargo", "build", "--release", "--quiet"], cwd=CRATE, check=True)
    return CRATE / "target" / "release" / "delone-peers"


def build_cgal(name: str = "cgal") -> Path | None:
    """Build a driver of CGAL and return the program; nothing where CGAL is not installed."""
    program = CRATE / "target" / name
    if shutil.which("g++") is None or not Path("/usr/include/CGAL").exists():
        return None
    program.parent.mkdir(exist_ok=True)
    command = ["g++", "-O3", "-DNDEBUG", "-std=c++17", f"{name}.cpp"]
    command += ["-o", str(program), "-lgmp"]
    subprocess.run(command, cwd=CRATE, check=True)
    return program


def runs_of(output: str) -> dict[str, list[float]]:
    """Return the seconds of each peer's runs; none where it failed."""
    times: dict[str, list[float]] = {}
    for line in output.splitlines():
        peer, time, _ = line.split("\t", 2)
        times.setdefault(peer, []).extend([float(time)] if time != "failed" else [])
    return times


def measure(crates: Path, cgal: Path | None, name: str, given: argparse.Namespace) -> str:
    """Return the table of one point set."""
    points = sets.make(name)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "points"
        points.astype("<f8").tofile(file)
        peers = [Program(crates, file, peer, peer, limit=LIMIT) for peer in PEERS]
        peers += [Program(cgal, file, "CGAL", limit=LIMIT)] if cgal else []
        compete(peers, given.rounds, given.warm)
        done = [peer.times for peer in peers if peer.times.warm]
        answers = {
            times.name: rows_of(
                points, np.fromfile(f"{file}.{times.name}", "<f8").reshape(-1, 2)
            ).reshape(-1, 3)
            for times in done
        }
    expected = len(answers["delone"])
    rows = []
    for times in (peer.times for peer in peers):
        answer = answers.get(times.name)
        verdict = "" if answer is None else judge.verdict(points, answer, expected)
        rows.append([times.name, *times.cells(done[0])[:-1], verdict])
    return report.table(["peer", *HEAD[:-1], "result"], rows)


def main() -> None:
    """Print a table for each point set."""
    arguments = options()
    crates, cgal = build(), build_cgal()
    print(f"Compiled peers; {report.machine()}\n")
    for name in sets.with_number(tuple(arguments.sets.split(",")), arguments.n):
        print(f"{name}\n\n{measure(crates, cgal, name, arguments)}\n", flush=True)


if __name__ == "__main__":
    main()
