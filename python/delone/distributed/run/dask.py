"""Tasks on a Dask cluster (extra ``dask``): local processes, or machines that share a file system.

Dask starts the workers, distributes the tasks and reassigns those of a worker that died. Tasks
exchange data in the files of the run, so that any worker can repeat a task, and the scheduler
stores only names and small summaries.
"""

from __future__ import annotations

import contextlib
import time
from typing import TYPE_CHECKING, Any

from delone._base.extras import require
from delone.distributed.run.stages import perform
from delone.errors import DeloneError, InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

__all__ = ["DaskExecutor"]

# Tasks submitted per worker before one of them returns.
_AHEAD = 3
# Seconds that a client may be without a scheduler, and between two checks.
_PATIENCE, _GLANCE = 5.0, 0.005
# Seconds to wait for running tasks after one has failed; those of large tiles take long.
_LONGEST = 120.0


class DaskExecutor:
    """Tasks on the workers of a Dask client that is connected to a scheduler.

    The workers must have access to the output folder, and to source files, under the same names.
    """

    threads = 1

    def __init__(self, client: Any) -> None:
        self._distributed = require("distributed", extra="dask", what="a Dask executor")
        if not isinstance(client, self._distributed.Client) or client.asynchronous:
            raise InputError(
                "executor must be 'serial', 'processes' or a dask.distributed.Client that is not "
                f"asynchronous, got {client!r:.80}"
            )
        self.client = client

    @property
    def workers(self) -> int:
        """Number of concurrent tasks."""
        try:
            return max(1, sum(map(int, self.client.nthreads().values())))
        except AttributeError as error:
            # The error of a client that lost its scheduler.
            raise ConnectionError("no answer") from error

    def run(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        """Perform all tasks of a stage; those of workers that die are repeated by others."""
        try:
            yield from self._run(root, stage, tasks)
        except self._distributed.KilledWorker as error:
            raise DeloneError(
                f"a task of the stage {stage!r:.80} killed worker after worker: is there enough "
                "memory for tiles of this size? Finished work is kept; run the same again to resume"
            ) from error
        except self._lost() as error:
            raise DeloneError(
                f"the Dask scheduler is gone ({type(error).__name__}); finished work is kept: run "
                "the same again, with another client or executor, to resume"
            ) from error

    def _run(
        self, root: str, stage: str, tasks: Mapping[int, Sequence[Any]]
    ) -> Iterator[tuple[int, dict[str, Any]]]:
        queue = iter(list(tasks.items()))
        room = _AHEAD * self.workers
        waiting = self._distributed.as_completed()
        keys: dict[str, tuple[int, Any]] = {}
        try:
            while True:
                while len(keys) < room:
                    task = next(queue, None)
                    if task is None:
                        break
                    future = self._submit(root, stage, *task)
                    keys[future.key] = task[0], future
                    waiting.add(future)
                if not keys:
                    return
                self._wait(waiting)
                future = next(waiting)
                if future.status == "cancelled":
                    raise self._distributed.CancelledError(future.key)
                key, _ = keys.pop(future.key)
                yield key, future.result()
        except DeloneError:
            # Wait for the other tasks, so that nothing is written after the run.
            with contextlib.suppress(*self._lost()):
                others = [future for _, future in keys.values()]
                self._distributed.wait(others, timeout=_LONGEST)
            raise
        finally:
            waiting.clear()

    def _wait(self, waiting: Any) -> None:
        """Wait until a task returns, as long as there is a scheduler."""
        left = time.monotonic()
        while not waiting.has_ready():
            if self.client.status == "running":
                left = time.monotonic()
            elif time.monotonic() - left > _PATIENCE:
                self._require_scheduler()
            time.sleep(_GLANCE)

    def _require_scheduler(self) -> None:
        if self.client.status != "running":
            raise ConnectionError(f"the client is {self.client.status}")

    def _submit(self, root: str, stage: str, key: int, arguments: Sequence[Any]) -> Any:
        """Submit a task to the scheduler."""
        self._require_scheduler()
        return self.client.submit(perform, root, stage, key, arguments, pure=False)

    def _lost(self) -> tuple[type[BaseException], ...]:
        core = require("distributed.comm", extra="dask", what="a Dask executor")
        return (
            self._distributed.CancelledError,
            core.CommClosedError,
            ConnectionError,
            TimeoutError,
        )
