"""Who does the tasks of a stage: this process, or others on this machine.

An executor takes tasks by their keys and hands back summaries as they come. It holds a few tasks
for each worker at a time, however many a stage has.
"""

from __future__ import annotations

import os
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from typing import TYPE_CHECKING, Any, Protocol

from delone.distributed.stages import perform
from delone.errors import DeloneError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from concurrent.futures import Future

__all__ = ["AHEAD", "Executor", "Processes", "Serial"]

# Tasks that are handed out for each worker before one of them has come back.
AHEAD = 3
# How often a worker may die before it is taken for the tasks' fault.
_DEATHS = 3


class Executor(Protocol):
    """What does tasks."""

    @property
    def workers(self) -> int:
        """How many tasks can be done at a time."""

    @property
    def threads(self) -> int:
        """How many threads a task may use."""

    def run(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        """Do all tasks of a stage; hand back their summaries as they come."""


class Serial:
    """Tasks one after another in this process, each with all cores."""

    workers = 1
    threads = os.cpu_count() or 1

    def run(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        """Do all tasks of a stage."""
        for key, arguments in tasks.items():
            yield key, perform(root, stage, key, arguments)


class Processes:
    """Tasks in processes of this machine.

    Parameters
    ----------
    workers : int, optional
        How many; by default one for each core.
    """

    threads = 1

    def __init__(self, workers: int | None = None) -> None:
        self.workers = workers or os.cpu_count() or 1
        self._pool: ProcessPoolExecutor | None = None

    def close(self) -> None:
        """End the processes."""
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)
            self._pool = None

    def run(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        """Do all tasks of a stage; where a process dies, another one does its tasks again."""
        left = dict(tasks)
        for _ in range(_DEATHS):
            try:
                for key, summary in self._once(root, stage, left):
                    del left[key]
                    yield key, summary
                return
            except BrokenProcessPool:
                self.close()
        raise DeloneError(
            f"worker processes died {_DEATHS} times in the stage {stage!r}: is there enough memory "
            "for tiles of this size? What is done is kept; run the same again to go on"
        )

    def _once(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        queue = iter(list(tasks.items()))
        if self._pool is None:
            # Fresh interpreters: a fork of one that has threads may never wake up.
            self._pool = ProcessPoolExecutor(self.workers, mp_context=get_context("spawn"))
        running: dict[Future[dict[str, Any]], int] = {}
        try:
            while True:
                while len(running) < AHEAD * self.workers:
                    task = next(queue, None)
                    if task is None:
                        break
                    running[self._pool.submit(perform, root, stage, *task)] = task[0]
                if not running:
                    return
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    yield running.pop(future), future.result()
        finally:
            for future in running:
                future.cancel()
            wait(running)
