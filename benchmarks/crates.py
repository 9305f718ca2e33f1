"""Delone's core beside the Rust crates spade and delaunator, and beside CGAL: the same points.

Builds benchmarks/peers, hands it each point set as a file, and prints a table of medians. The
crates take turns run by run inside one process; CGAL, where its headers are installed, follows in
one of its own. ``python benchmarks/crates.py --help`` has options.
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

CRATE = Path(__file__).parent / "peers"
LIMIT = 600.0


def options() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", default=",".join(sets.DEFAULT), help="such as uniform:1000000")
    parser.add_argument("--n", type=int, help="take this number of points for every set")
    parser.add_argument("--runs", type=int, default=5, help="runs for each peer (default 5)")
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


def measure(programs: list[Path], name: str, runs: int) -> str:
    """Return the table of one point set."""
    points = sets.make(name)
    with tempfile.TemporaryDirectory() as folder:
        points_file = Path(folder) / "points"
        points.astype("<f8").tofile(points_file)
        output = ""
        for program in programs:
            command = [str(program), str(runs), str(points_file)]
            output += subprocess.run(
                command, capture_output=True, text=True, check=True, timeout=LIMIT
            ).stdout
        times = runs_of(output)
        answers = {
            peer: rows_of(points, np.fromfile(f"{points_file}.{peer}", "<f8").reshape(-1, 2))
            for peer in times
            if times[peer]
        }
    base = report.median(times["delone"])
    expected = len(answers["delone"]) // 3
    rows = []
    for peer, seconds in times.items():
        if not seconds:
            rows.append([peer, "failed", "", ""])
            continue
        middle = report.median(seconds)
        verdict = judge.verdict(points, answers[peer].reshape(-1, 3), expected)
        rows.append([peer, report.seconds(middle), report.ratio(middle / base), verdict])
    return report.table(["peer", "seconds", "times delone", "result"], rows)


def main() -> None:
    """Print a table for each point set."""
    arguments = options()
    programs = [program for program in (build(), build_cgal()) if program]
    print(f"Compiled peers, {arguments.runs} runs; {report.machine()}\n")
    for name in sets.with_number(tuple(arguments.sets.split(",")), arguments.n):
        print(f"{name}\n\n{measure(programs, name, arguments.runs)}\n", flush=True)


if __name__ == "__main__":
    main()
