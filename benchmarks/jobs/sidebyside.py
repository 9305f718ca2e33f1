"""Runs one job in several ways, each in fresh processes that take turns, and prints a table.

A way is a function of the command line's arguments and of a folder for its output. It does the
whole job, imports included, and returns a line about its result, by which readers see that all ways
do the same. Inside, `stage` measures its parts.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).parents[1]))

from report import machine, ratio, seconds, table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Way = Callable[[argparse.Namespace, Path], str]

# Settings of the allocator would change what a first call costs.
LEFT_OUT = "MALLOC_"
SAID = "said.json"

_stages: dict[str, float] = {}


@contextmanager
def stage(name: str) -> Iterator[None]:
    """Measure a part of a job."""
    start = time.perf_counter()
    yield
    _stages[name] = _stages.get(name, 0.0) + time.perf_counter() - start


@dataclass
class Runs:
    """The runs of one way."""

    walls: list[float] = field(default_factory=list)
    processors: list[float] = field(default_factory=list)
    megabytes: list[float] = field(default_factory=list)
    stages: list[dict[str, float]] = field(default_factory=list)
    result: str = ""
    ended: str = ""


def compare(
    about: str | None, ways: dict[str, Way], parser: argparse.ArgumentParser | None = None
) -> None:
    """Run all ways or, inside its own process, one."""
    parser = parser or argparse.ArgumentParser()
    parser.description, parser.formatter_class = about, argparse.RawDescriptionHelpFormatter
    parser.add_argument("--runs", type=int, default=3, help="runs of each way")
    parser.add_argument("--ways", default=",".join(ways), help="some of " + ", ".join(ways))
    parser.add_argument("--limit", type=float, default=120.0, help="seconds, then a run is stopped")
    parser.add_argument("--one", help=argparse.SUPPRESS)
    parser.add_argument("--into", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        result = ways[arguments.one](arguments, arguments.into)
        usage = [resource.getrusage(of) for of in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        said = {
            "result": result,
            "stages": _stages,
            "processor": sum(each.ru_utime + each.ru_stime for each in usage),
            "megabytes": max(each.ru_maxrss for each in usage) / 1024,
        }
        (arguments.into / SAID).write_text(json.dumps(said))
        return
    found: dict[str, Runs] = {name: Runs() for name in arguments.ways.split(",")}
    turns = list(found.items())
    for _ in range(arguments.runs):
        for name, runs in turns:
            if not runs.ended:
                _run(name, runs, arguments.limit)
        # Another way begins: the first process of a round pays for pages that the host took back.
        turns.append(turns.pop(0))
    print(machine())
    print(_table(found))


def _run(name: str, runs: Runs, limit: float) -> None:
    environment = {key: text for key, text in os.environ.items() if not key.startswith(LEFT_OUT)}
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, *sys.argv, "--one", name, "--into", folder],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        try:
            _, said = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            runs.ended = f"none in {limit:.0f} s"
            return
        wall = time.perf_counter() - start
        if process.returncode:
            runs.ended = (said.strip().splitlines() or ["ended"])[-1][:60]
            return
        runs.walls.append(wall)
        said = json.loads((Path(folder) / SAID).read_text())
        runs.result = said["result"]
        runs.processors.append(said["processor"])
        runs.megabytes.append(said["megabytes"])
        runs.stages.append(said["stages"] | {"rest": wall - sum(said["stages"].values())})


def _table(found: dict[str, Runs]) -> str:
    first = statistics.median(next(iter(found.values())).walls or [float("nan")])
    rows: list[list[str]] = []
    for name, runs in found.items():
        if runs.ended:
            rows.append([name, runs.ended, "", "", "", "", ""])
            continue
        wall = statistics.median(runs.walls)
        parts = {
            part: statistics.median(each.get(part, 0.0) for each in runs.stages)
            for part in runs.stages[0]
        }
        rows.append(
            [
                name,
                seconds(wall),
                ratio(wall / first),
                seconds(statistics.median(runs.processors)),
                f"{max(runs.megabytes):.0f}",
                ", ".join(f"{part} {seconds(value)}" for part, value in parts.items()),
                runs.result,
            ]
        )
    head = ["way", "seconds", "times the first", "processor s", "MB", "of it", "result"]
    return table(head, rows)
