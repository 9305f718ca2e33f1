"""Delone's constrained triangulations and polygons beside those of other libraries.

Tables: the land polygons of Natural Earth (where ``--coastline`` or the environment variable
DELONE_COASTLINE names ``ne_10m_land.geojson``, gzipped or not), a million points and a fractal
ring, a thousand long segments that cross, and polygons to fill. Each Python package works in a
process of its own, in turns; compiled peers follow, one program after the other.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import crates
import line_adapters
import line_judge
import lines
import numpy as np
import polygons
import report
from wheels import wanted
from worker import Peer

from delone import Delaunay

Corners = np.ndarray
Judge = Callable[[Corners], str]
UNCONSTRAINED = ("delone-no-segments", "delone, no segments")
HEAD = ["peer", "seconds", "times delone", "runs", "result"]


def options() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--coastline", default=os.environ.get("DELONE_COASTLINE"), help="GeoJSON")
    parser.add_argument("--n", type=int, default=1_000_000, help="points around the ring")
    parser.add_argument("--segments", type=int, default=1000, help="long segments that cross")
    parser.add_argument("--runs", type=int, default=5, help="runs for each peer (default 5)")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a run may take")
    parser.add_argument("--tables", default="coastline,ring,crossings,polygons", help="which")
    parser.add_argument("--write", type=Path, help="only write the inputs to this folder")
    return parser.parse_known_args()[0]


def build() -> list[Path]:
    """Build the compiled peers and return their programs."""
    crates.build()
    programs = [crates.CRATE / "target" / "release" / "constrained"]
    cgal = crates.build_cgal("cgal_constrained")
    return programs + ([cgal] if cgal else [])


def write(given: lines.Lines, file: Path) -> None:
    """Write points and segments as the compiled peers read them."""
    given.points.astype("<f8").tofile(file)
    given.segments.astype("<u4").tofile(f"{file}.segments")


def python_rows(given: lines.Lines, split: bool, judge: Judge, runs: int, limit: float) -> list:
    """Return the table of the Python packages."""
    names = line_adapters.SPLITTING if split else line_adapters.CONSTRAINED
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "lines.npz"
        lines.save(given, file)
        peers = [Peer(n, file, Path(folder) / f"{n}.npy", "line_adapters") for n in names]
        for turn in range(runs):
            for peer in peers:
                if turn < wanted(peer, runs):
                    peer.run(limit)
        for peer in peers:
            peer.stop()
        times = {f"{p.name} {p.version}": [run.seconds for run in p.runs] or p.ended for p in peers}
        answers = {f"{p.name} {p.version}": p.answer_file for p in peers}
        return rows(times, lambda name: judge(np.load(answers[name])))


def compiled_rows(
    given: lines.Lines, split: bool, judge: Judge, runs: int, programs: list[Path]
) -> list:
    """Return the table of the compiled peers."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "lines"
        write(given, file)
        times: dict[str, list[float] | str] = {}
        for program in programs:
            command = [str(program), str(runs), str(file), *(["split"] if split else [])]
            done = subprocess.run(
                command, capture_output=True, text=True, check=False, timeout=crates.LIMIT
            )
            found = crates.runs_of(done.stdout)
            times |= {peer: seconds or "failed" for peer, seconds in found.items()}
            if done.returncode:
                times[f"{program.name}, the program"] = f"ended with code {done.returncode}"
        return rows(
            times, lambda name: judge(np.fromfile(f"{file}.{name}", "<f8").reshape(-1, 3, 2))
        )


def rows(times: dict[str, list[float] | str], judged: Callable[[str], str]) -> list[list[str]]:
    """Return the lines of a table; the first peer that works is the base of the ratios."""
    base = next((report.median(t) for t in times.values() if not isinstance(t, str)), 1.0)
    table = []
    for name, seconds in times.items():
        if isinstance(seconds, str):
            table.append([name, seconds, "", "", ""])
            continue
        middle = report.median(seconds)
        ratio = report.ratio(middle / base)
        # The triangulation without segments is there to be compared with, not to be right.
        verdict = "" if name.startswith(UNCONSTRAINED) else judged(name)
        table.append([name, report.seconds(middle), ratio, str(len(seconds)), verdict])
    return table


def compare(
    title: str, given: lines.Lines, split: bool, arguments: argparse.Namespace, programs: list[Path]
) -> None:
    """Print both tables of one input."""
    expected = 0 if split else len(Delaunay(given.points).simplices)

    def judge(corners: Corners) -> str:
        if split:
            return line_judge.tiling(corners)
        return line_judge.verdict(given, corners, expected)

    runs = arguments.runs
    print(f"{title}: {len(given.points):,} points, {len(given.segments):,} segments\n")
    table = python_rows(given, split, judge, runs, arguments.limit)
    print(report.table(["Python " + HEAD[0], *HEAD[1:]], table) + "\n", flush=True)
    table = compiled_rows(given, split, judge, runs, programs)
    print(report.table(["compiled " + HEAD[0], *HEAD[1:]], table) + "\n", flush=True)


def inputs(arguments: argparse.Namespace) -> dict[str, tuple[str, lines.Lines, bool]]:
    """Return the inputs that are asked for: title, points and segments, whether these may cross."""
    wanted = arguments.tables.split(",")
    found: dict[str, tuple[str, lines.Lines, bool]] = {}
    if "coastline" in wanted:
        if arguments.coastline:
            given = lines.coastline(Path(arguments.coastline))
            found["coastline"] = (Path(arguments.coastline).name, given, False)
        else:
            print("No coastline: neither --coastline nor DELONE_COASTLINE names a file.\n")
    if "ring" in wanted:
        found["ring"] = ("uniform points and a ring", lines.points_and_ring(arguments.n), False)
    if "crossings" in wanted:
        given = lines.long_segments(arguments.segments)
        found["crossings"] = ("long segments", given, True)
    return found


def main() -> None:
    """Print a table for each input."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    arguments = options()
    given = inputs(arguments)
    if arguments.write:
        arguments.write.mkdir(parents=True, exist_ok=True)
        for name, (_, arrays, _) in given.items():
            write(arrays, arguments.write / name)
        return
    print(f"Constrained triangulations, {arguments.runs} runs; {report.machine()}\n")
    programs = build() if given else []
    for title, arrays, split in given.values():
        compare(title, arrays, split, arguments, programs)
    if "polygons" in arguments.tables.split(","):
        print(polygons.tables(arguments.runs))


if __name__ == "__main__":
    main()
