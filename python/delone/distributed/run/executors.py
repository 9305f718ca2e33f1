"""Executors of the tasks of a stage: this process, or worker processes on this machine.

An executor takes tasks by their keys and yields summaries as they are completed. It submits only a
few tasks per worker at a time, however many a stage has.
"""

from __future__ import annotations

from collections import deque
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from typing import TYPE_CHECKING, Any, Protocol

from delone._base.arrays import as_workers
from delone.distributed.run.stages import perform
from delone.distributed.run.worker import Worker, WorkerDiedError
from delone.errors import DeloneError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from concurrent.futures import Future

__all__ = ["Executor", "Processes", "Serial"]

# Number of worker deaths after which the tasks are assumed to be the cause.
_DEATHS = 3


class Executor(Protocol):
    """The interface of an executor."""

    @property
    def workers(self) -> int:
        """Number of concurrent tasks."""

    @property
    def threads(self) -> int:
        """Number of threads per task."""

    def run(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        """Perform all tasks of a stage; yield their summaries as they are completed."""


class Serial:
    """Tasks one after another in this process, each with all cores."""

    workers = 1

    @property
    def threads(self) -> int:
        """All cores that this process may use."""
        return as_workers(None)

    def run(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        """Perform all tasks of a stage."""
        for key, arguments in tasks.items():
            yield key, perform(root, stage, key, arguments)


class Processes:
    """Tasks in processes of this machine, by default one per core that may be used."""

    threads = 1

    def __init__(self, workers: int | None = None) -> None:
        self.workers = as_workers(workers)
        self._idle: list[Worker] = []

    def close(self) -> None:
        """Stop the processes."""
        while self._idle:
            self._idle.pop().close()

    def run(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        """Perform all tasks of a stage; if a process dies, another one repeats its task."""
        queue, deaths = deque(tasks.items()), 0
        running: dict[Future[dict[str, Any]], tuple[int, Sequence[Any]]] = {}
        # Each of these waits for a process.
        with ThreadPoolExecutor(self.workers) as pool:
            try:
                while queue or running:
                    while queue and len(running) < self.workers:
                        task = queue.popleft()
                        running[pool.submit(self._perform, root, stage, *task)] = task
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        task = running.pop(future)
                        try:
                            yield task[0], future.result()
                        except WorkerDiedError:
                            queue.append(task)
                            deaths += 1
                    if deaths >= _DEATHS:
                        break
            finally:
                for future in running:
                    future.cancel()
        if queue:
            raise DeloneError(
                f"worker processes died {deaths} times in the stage {stage!r:.80}: is there enough "
                "memory for tiles of this size? Finished work is kept; run the same again to resume"
            )

    def _perform(self, *task: Any) -> dict[str, Any]:
        try:
            worker = self._idle.pop()
        except IndexError:
            worker = Worker()
        try:
            found: dict[str, Any] = worker.perform(*task)
        except WorkerDiedError:
            worker.close()
            raise
        except Exception:
            self._idle.append(worker)
            raise
        self._idle.append(worker)
        return found
