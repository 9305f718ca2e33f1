"""Cold and warm runs of peers, in fresh processes that take turns.

In each round every peer starts a process of its own, where the first call is a cold one and the
others are warm: so all peers have the same number of both. The allocator stays as the system has
it: settings of the environment are left out.
"""

from __future__ import annotations

import os
import random
import subprocess
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import report
from worker import Peer, Run

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from pathlib import Path

HEAD = ("cold", "times", "warm", "times", "runs", "peak MB")
# Settings of the allocator would change what a first call costs.
for setting in [key for key in os.environ if key.startswith("MALLOC_")]:
    del os.environ[setting]


@dataclass
class Times:
    """The runs of a peer, and why there are no more if so."""

    name: str
    cold: list[Run] = field(default_factory=list)
    warm: list[Run] = field(default_factory=list)
    ended: str = ""

    def add(self, runs: Sequence[Run]) -> None:
        """Add the runs of one process."""
        self.cold += runs[:1]
        self.warm += runs[1:]

    def cells(self, base: Times) -> list[str]:
        """Return the cells below `HEAD`, with ratios to another peer."""
        if not self.warm:
            return [self.ended, "", "", "", "", ""]
        cold, warm = median(self.cold), median(self.warm)
        megabytes = max(run.megabytes for run in self.cold)
        return [
            report.seconds(cold),
            report.ratio(cold / median(base.cold)),
            report.seconds(warm),
            report.ratio(warm / median(base.warm)),
            f"{len(self.cold)} + {len(self.warm)}",
            f"{megabytes:.0f}" if megabytes else "",
        ]


class Contender(Protocol):
    """Something that starts a process and runs in it."""

    times: Times

    def round(self, warm: int) -> None:
        """Start a process, run once cold and then `warm` times, and end it."""


class Module:
    """A Python peer: an adapter in a module of this folder."""

    def __init__(
        self, name: str, points: Path, *, module: str = "adapters", limit: float = 60.0
    ) -> None:
        self.name, self.module, self.limit, self.points = name, module, limit, points
        self.answer = points.with_name(f"{name}.npy")
        self.times = Times(name)

    def round(self, warm: int) -> None:
        """Start a process, run once cold and then `warm` times, and end it."""
        peer = Peer(self.name, self.points, self.answer, self.module)
        self.times.name = f"{self.name} {peer.version}".strip()
        for _ in range(1 + warm):
            peer.run(self.limit)
        peer.stop()
        self.times.add(peer.runs)
        self.times.ended = peer.ended


class Program:
    """A compiled peer: a program that takes the number of runs, a file and perhaps more."""

    def __init__(
        self, program: Path, points: Path, name: str, *more: str, limit: float = 600.0
    ) -> None:
        self.start = [str(program)], [str(points), *more]
        self.limit = limit
        self.times = Times(name)

    def round(self, warm: int) -> None:
        """Start a process, run once cold and then `warm` times, and end it."""
        before, after = self.start
        try:
            done = subprocess.run(
                [*before, str(1 + warm), *after],
                capture_output=True,
                text=True,
                check=True,
                timeout=self.limit,
            )
        except subprocess.SubprocessError as error:
            self.times.ended = type(error).__name__
            return
        lines = [line.split("\t") for line in done.stdout.splitlines()]
        if any(second == "failed" for _, second, *_ in lines):
            self.times.ended = "failed"
            return
        self.times.add([Run(float(second), 0.0) for _, second, *_ in lines])


def compete(peers: Iterable[Contender], rounds: int, warm: int) -> None:
    """Let the peers take turns, round by round, as long as they do not fail.

    Each round has an order of its own, the same in every run of the program: what a process leaves
    behind in the memory of a virtual machine decides what the first call of the next one costs.
    """
    peers = list(peers)
    for seed in range(rounds):
        for peer in random.Random(seed).sample(peers, len(peers)):
            if not peer.times.ended:
                peer.round(warm)


def alternate(calls: Mapping[str, Callable[[], object]], runs: int) -> dict[str, float]:
    """Return the median seconds of calls in this process, which take turns, all equally often.

    A first call of each is not counted: these are warm.
    """
    seconds: dict[str, list[float]] = {name: [] for name in calls}
    for run in range(1 + runs):
        for name, call in calls.items():
            start = time.perf_counter()
            call()
            if run:
                seconds[name].append(time.perf_counter() - start)
    return {name: report.median(each) for name, each in seconds.items()}


def median(runs: Sequence[Run]) -> float:
    """Return the median of the seconds of some runs."""
    return report.median(run.seconds for run in runs)
