"""Delone's constrained triangulations and polygons compared with other libraries.

Tables: the land polygons of Natural Earth (where ``--coastline`` or the environment variable
DELONE_COASTLINE names ``ne_10m_land.geojson``, gzipped or not), a million points and a fractal
ring, a thousand long segments that cross, and polygons to fill. Each Python package and each
compiled peer works in processes of its own, cold and warm, and all take turns.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import signal
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import crates
import line_adapters
import line_judge
import lines
import numpy as np
import polygons
import report
from rounds import HEAD, Module, Program, Times, compete

from delone import Delaunay

Corners = np.ndarray
Judge = Callable[[Corners], str]
UNCONSTRAINED = ("delone-no-segments", "delone, no segments")
# What each compiled program can run, without crossings and with.
COMPILED = {
    False: (
        "delone",
        "delone, 2 workers",
        "delone, no segments",
        "spade bulk_load_cdt",
        "spade bulk_load",
    ),
    True: ("delone", "spade add_constraint_and_split"),
}
CGAL = {False: ("CGAL", "CGAL, Delaunay first"), True: ("CGAL",)}


def options() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--coastline", default=os.environ.get("DELONE_COASTLINE"), help="GeoJSON")
    parser.add_argument("--n", type=int, default=1_000_000, help="points around the ring")
    parser.add_argument("--segments", type=int, default=1000, help="long segments that cross")
    parser.add_argument("--rounds", type=int, default=5, help="processes of each peer (default 5)")
    parser.add_argument("--warm", type=int, default=1, help="warm runs in each (default 1)")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a run may take")
    parser.add_argument("--tables", default="coastline,ring,crossings,polygons", help="which")
    parser.add_argument("--write", type=Path, help="only write the inputs to this folder")
    return parser.parse_known_args()[0]


def build() -> dict[Path, dict[bool, tuple[str, ...]]]:
    """Build the compiled peers; return their programs with what each can run."""
    crates.build()
    programs = {crates.CRATE / "target" / "release" / "constrained": COMPILED}
    cgal = crates.build_cgal("cgal_constrained")
    return programs | ({cgal: CGAL} if cgal else {})


def write(given: lines.Lines, file: Path) -> None:
    """Write points and segments as the compiled peers read them."""
    given.points.astype("<f8").tofile(file)
    given.segments.astype("<u4").tofile(f"{file}.segments")


def measure(
    given: lines.Lines, split: bool, judge: Judge, arguments: argparse.Namespace
) -> tuple[str, str]:
    """Return the tables of the Python packages and of the compiled peers; all take turns."""

    def corners(peer: Program) -> Corners:
        return np.fromfile(f"{raw}.{peer.times.name}", "<f8").reshape(-1, 3, 2)

    with tempfile.TemporaryDirectory() as folder:
        arrays, raw = Path(folder) / "lines.npz", Path(folder) / "lines"
        lines.save(given, arrays)
        write(given, raw)
        modules = [
            Module(name, arrays, module="line_adapters", limit=arguments.limit)
            for name in (line_adapters.SPLITTING if split else line_adapters.CONSTRAINED)
        ]
        more = ["split"] if split else []
        programs = [
            Program(program, raw, name, name, *more, limit=crates.LIMIT)
            for program, names in arguments.programs.items()
            for name in names[split]
        ]
        compete([*modules, *programs], arguments.rounds, arguments.warm)
        return (
            table("Python", modules, lambda peer: judge(np.load(peer.answer))),
            table("compiled", programs, lambda peer: judge(corners(peer))),
        )


def table(kind: str, peers: list[Any], judged: Callable[[Any], str]) -> str:
    """Return a table; the first peer that works is the base of the ratios."""
    base = next((peer.times for peer in peers if peer.times.warm), Times(""))
    rows = []
    for peer in peers:
        # The triangulation without segments is there to be compared with, not to be right.
        right = not peer.times.warm or peer.times.name.startswith(UNCONSTRAINED)
        rows.append([peer.times.name, *peer.times.cells(base), "" if right else judged(peer)])
    return report.table([f"{kind} peer", *HEAD, "result"], rows)


def compare(title: str, given: lines.Lines, split: bool, arguments: argparse.Namespace) -> None:
    """Print both tables of one input."""
    expected = 0 if split else len(Delaunay(given.points).simplices)

    def judge(corners: Corners) -> str:
        if split:
            return line_judge.tiling(corners)
        return line_judge.verdict(given, corners, expected)

    print(f"{title}: {len(given.points):,} points, {len(given.segments):,} segments\n")
    for text in measure(given, split, judge, arguments):
        print(text + "\n", flush=True)


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
    print(f"Constrained triangulations; {report.machine()}\n")
    arguments.programs = build() if given else {}
    for title, arrays, split in given.values():
        compare(title, arrays, split, arguments)
    if "polygons" in arguments.tables.split(","):
        print(polygons.tables(arguments.rounds))


if __name__ == "__main__":
    main()
