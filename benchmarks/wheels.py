"""Delone compared with the other Python packages: the same array in, arrays out.

Each peer works in processes of its own, whose first call is cold and the others warm; the peers
take turns, round by round. The medians stand in one table per point set, with the peak memory of
cold runs and what exact predicates say of the answer.
``python benchmarks/wheels.py --help`` has options.
"""

import os

os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import signal
import sys
import tempfile
from pathlib import Path

import adapters
import judge
import numpy as np
import report
import sets
from rounds import HEAD, Module, compete


def options() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", default=",".join(sets.DEFAULT), help="such as uniform:1000000")
    parser.add_argument("--n", type=int, help="take this number of points for every set")
    parser.add_argument("--rounds", type=int, default=5, help="processes of each peer (default 5)")
    parser.add_argument("--warm", type=int, default=1, help="warm runs in each (default 1)")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a run may take")
    parser.add_argument("--peers", default=",".join(adapters.PEERS), help="which peers take part")
    return parser.parse_known_args()[0]


def row(peer: Module, base: Module, points: adapters.Points, expected: int) -> list[str]:
    """Return a peer's line of the table."""
    verdict = judge.verdict(points, np.load(peer.answer), expected) if peer.times.warm else ""
    return [peer.times.name, *peer.times.cells(base.times), verdict]


def measure(name: str, arguments: argparse.Namespace) -> str:
    """Return the table of one point set."""
    points = sets.make(name)
    with tempfile.TemporaryDirectory() as folder:
        points_file = Path(folder) / "points.npy"
        np.save(points_file, points)
        peers = [
            Module(name, points_file, limit=arguments.limit) for name in arguments.peers.split(",")
        ]
        compete(peers, arguments.rounds, arguments.warm)
        done = [peer for peer in peers if peer.times.warm]
        if not done:
            return "\n".join(f"{peer.times.name}: {peer.times.ended}" for peer in peers)
        expected = len(np.load(done[0].answer))
        rows = [row(peer, done[0], points, expected) for peer in peers]
    return report.table(["peer", *HEAD, "result"], rows)


def main() -> None:
    """Print a table for each point set."""
    # Ended from outside, the program still ends its workers: see multiprocessing's daemons.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    arguments = options()
    print(f"Python packages; {report.machine()}\n")
    for name in sets.with_number(tuple(arguments.sets.split(",")), arguments.n):
        print(f"{name}\n\n{measure(name, arguments)}\n", flush=True)


if __name__ == "__main__":
    main()
