"""A process of its own for each peer, so that one that hangs or dies takes nothing with it.

The parent asks for one run at a time and waits no longer than its limit: peers take turns, so that
whatever else the machine does meets them alike.
"""

import gc
import importlib
import multiprocessing
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

import memory
import numpy as np

START_LIMIT = 60.0


@dataclass(frozen=True)
class Run:
    """One run: its seconds, and its peak memory in MB beyond what was held before."""

    seconds: float
    megabytes: float


def serve(
    connection: Connection, module: str, peer: str, points_file: str, answer_file: str
) -> None:
    """Send the version, then a `Run` for each request; the first answer is kept for the judge."""
    try:
        adapter = importlib.import_module(module).PEERS[peer]()
        points = adapter.load(points_file)
        connection.send(adapter.version)
        while connection.recv():
            gc.collect()
            before = memory.start()
            start = time.perf_counter()
            answer = adapter.call(points)
            run = Run(time.perf_counter() - start, (memory.peak() - before) / 1e6)
            if not Path(answer_file).exists():
                np.save(answer_file, adapter.simplices(points, answer))
            del answer
            connection.send(run)
    except (EOFError, KeyboardInterrupt):
        return
    except Exception as error:
        connection.send(error_line(error))


def error_line(error: Exception) -> str:
    """Return what a table cell can hold of an exception."""
    return f"{type(error).__name__}: {error}".splitlines()[0][:60]


class Peer:
    """A peer at work on one point set: its runs so far, and why there are no more if so."""

    def __init__(
        self, name: str, points_file: Path, answer_file: Path, module: str = "adapters"
    ) -> None:
        self.name = name
        self.answer_file = answer_file
        self.runs: list[Run] = []
        self.ended = ""
        self.connection, theirs = multiprocessing.Pipe()
        self.process = multiprocessing.get_context("spawn").Process(
            target=serve,
            args=(theirs, module, name, str(points_file), str(answer_file)),
            daemon=True,
        )
        self.process.start()
        theirs.close()
        self.version = str(self._receive(START_LIMIT) or "")

    def _receive(self, limit: float) -> object:
        """Wait for the worker's next word; where none comes, end it and note why."""
        try:
            if self.connection.poll(limit):
                return self.connection.recv()
            self._end(f"none in {limit:.0f} s")
        except (EOFError, ConnectionError):
            self.process.join(1.0)
            self._end(f"process ended with code {self.process.exitcode}")
        return None

    def _end(self, why: str) -> None:
        self.ended = why
        self.stop()

    def run(self, limit: float) -> None:
        """Do one run, where the peer is still there."""
        if self.ended:
            return
        self.connection.send(True)
        word = self._receive(limit)
        if isinstance(word, Run):
            self.runs.append(word)
        elif word is not None:
            self._end(str(word))

    def stop(self) -> None:
        """End the worker."""
        self.process.kill()
        self.process.join()
        self.connection.close()
