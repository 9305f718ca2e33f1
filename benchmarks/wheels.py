"""Delone beside the other Python packages: the same array in, arrays out.

Each peer works in a process of its own; the peers take turns run by run; the medians stand in one
table per point set, with the peak memory of the first run and what exact predicates say of its
answer. Run ``python benchmarks/wheels.py --help`` for the options.
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
from worker import Peer

SLOW, VERY_SLOW = 4.0, 12.0


def options() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", default=",".join(sets.DEFAULT), help="such as uniform:1000000")
    parser.add_argument("--n", type=int, help="take this number of points for every set")
    parser.add_argument("--runs", type=int, default=5, help="runs for each peer (default 5)")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a run may take")
    parser.add_argument("--peers", default=",".join(adapters.PEERS), help="which peers take part")
    return parser.parse_args()


def wanted(peer: Peer, runs: int) -> int:
    """Return how many runs a peer gets: the slow fewer, so that the whole ends."""
    first = peer.runs[0].seconds if peer.runs else 0.0
    return 1 if first > VERY_SLOW else min(runs, 3) if first > SLOW else runs


def compete(points_file: Path, names: list[str], runs: int, limit: float) -> list[Peer]:
    """Let the peers take turns."""
    peers = [Peer(name, points_file, points_file.with_name(f"{name}.npy")) for name in names]
    for turn in range(runs):
        for peer in peers:
            if turn < wanted(peer, runs):
                peer.run(limit)
    for peer in peers:
        peer.stop()
    return peers


def row(peer: Peer, points: adapters.Points, base: float, expected: int) -> list[str]:
    """Return a peer's line of the table."""
    name = f"{peer.name} {peer.version}"
    if not peer.runs:
        return [name, peer.ended, "", "", "", ""]
    middle = report.median(run.seconds for run in peer.runs)
    return [
        name,
        report.seconds(middle),
        report.ratio(middle / base),
        str(len(peer.runs)),
        f"{peer.runs[0].megabytes:.0f}",
        judge.verdict(points, np.load(peer.answer_file), expected),
    ]


def measure(name: str, arguments: argparse.Namespace) -> str:
    """Return the table of one point set."""
    points = sets.make(name)
    with tempfile.TemporaryDirectory() as folder:
        points_file = Path(folder) / "points.npy"
        np.save(points_file, points)
        names = arguments.peers.split(",")
        peers = compete(points_file, names, arguments.runs, arguments.limit)
        done = [peer for peer in peers if peer.runs]
        if not done:
            return "\n".join(f"{peer.name}: {peer.ended}" for peer in peers)
        base = report.median(run.seconds for run in done[0].runs)
        expected = len(np.load(done[0].answer_file))
        rows = [row(peer, points, base, expected) for peer in peers]
    head = ["peer", "seconds", "times " + done[0].name, "runs", "peak MB", "result"]
    return report.table(head, rows)


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
