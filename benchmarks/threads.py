"""Two threads compared with two processes: how much of a second core reaches delone.

Cores share caches, memory and often one physical core, whose clock may rise while the other half
rests. So a speed-up of two is not to be had everywhere. The ceiling is what two processes of one
thread each, with nothing in common, do at once; they take turns with one thread and with two, run
by run. ``python benchmarks/threads.py --help`` has options.
"""

import argparse
import multiprocessing
import time
from multiprocessing.connection import Connection
from typing import Any

import numpy as np
from report import machine, median, ratio, table

from delone import Delaunay

# Points and dimensions, and how many times the asked number of rounds.
TASKS = ((1_000_000, 2, 3), (10_000_000, 2, 1), (1_000_000, 3, 1))
HEAD = ("points", "one thread", "two threads", "times", "two processes at once", "ceiling")


def serve(pipe: Connection, n: int, dimensions: int) -> None:
    """Triangulate with as many threads as asked for, and tell the seconds, until told to end."""
    points = np.random.default_rng(1).random((n, dimensions))
    Delaunay(points, workers=1)
    while workers := pipe.recv():
        start = time.perf_counter()
        Delaunay(points, workers=workers)
        pipe.send(time.perf_counter() - start)


def ask(pipes: list[Any], workers: int) -> float:
    """Seconds of the slowest of some processes that work at once."""
    for pipe in pipes:
        pipe.send(workers)
    return max(pipe.recv() for pipe in pipes)


def row(n: int, dimensions: int, runs: int) -> list[str]:
    """Measure one size."""
    context = multiprocessing.get_context("spawn")
    pairs = [context.Pipe() for _ in range(2)]
    processes = [context.Process(target=serve, args=(far, n, dimensions)) for _, far in pairs]
    for process in processes:
        process.start()
    pipes = [near for near, _ in pairs]
    # Both have made their points when they answer.
    ask(pipes, 1)
    rounds = [(ask(pipes[:1], 1), ask(pipes[:1], 2), ask(pipes, 1)) for _ in range(runs)]
    for pipe in pipes:
        pipe.send(0)
    for process in processes:
        process.join()
    one, two, both = (median(column) for column in zip(*rounds, strict=True))
    cells = [
        f"{one:.3g} s",
        f"{two:.3g} s",
        ratio(one / two),
        f"{both:.3g} s",
        ratio(2 * one / both),
    ]
    return [f"{n:,} in {dimensions}-D", *cells]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, default=1_000_000, help="points of the smallest task")
    parser.add_argument("--runs", type=int, default=5, help="rounds (default 5)")
    given = parser.parse_known_args()[0]
    print(f"\nThreads. {machine()}.\n")
    tasks = [(given.n * n // 1_000_000, d, times * given.runs) for n, d, times in TASKS]
    print(table(HEAD, [row(*task) for task in tasks]))


if __name__ == "__main__":
    main()
