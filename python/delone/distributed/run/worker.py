"""A worker process: takes tasks from its standard input until that ends, and hands back summaries.

It is a fresh interpreter, as a fork of one that has threads may never wake up, and knows nothing of
the program that started it: that need not guard its main module. When that program ends, however it
does, so does the input.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import sys
from subprocess import PIPE, Popen
from typing import Any

from delone.distributed.run.stages import perform

__all__ = ["Worker", "WorkerDiedError", "serve"]

_BEGIN = (
    "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); "
    "from delone.distributed.run.worker import serve; serve()"
)


class WorkerDiedError(Exception):
    """The process has ended in a task."""


class Worker:
    """A process that waits for tasks."""

    def __init__(self) -> None:
        # Not from the working folder (-P): a file there may have the name of a module.
        self._process = Popen([sys.executable, "-P", "-c", _BEGIN], stdin=PIPE, stdout=PIPE)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._tasks, self._answers = self._process.stdin, self._process.stdout
        pickle.dump(sys.path, self._tasks)

    def perform(self, *task: Any) -> Any:
        """Let it do a task; raise what the task raises."""
        try:
            pickle.dump(task, self._tasks)
            self._tasks.flush()
            done, found = pickle.load(self._answers)
        except (EOFError, OSError, pickle.UnpicklingError) as error:
            raise WorkerDiedError from error
        if done:
            return found
        raise found

    def close(self) -> None:
        """Let it end after its task, and wait for that."""
        # Who has ended has left the rest of a task unread.
        with contextlib.suppress(OSError):
            self._tasks.close()
        self._process.wait()
        self._answers.close()


def serve() -> None:
    """Do what comes."""
    tasks, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    # Whatever a library prints is no answer.
    os.dup2(2, 1)
    try:
        while True:
            try:
                task = pickle.load(tasks)
            except EOFError:
                return
            answers.write(_answer(task))
            answers.flush()
    except (KeyboardInterrupt, BrokenPipeError):
        # Whoever started this is told as well, or gone.
        os._exit(1)


def _answer(task: Any) -> bytes:
    try:
        return pickle.dumps((True, perform(*task)))
    except Exception as error:
        try:
            return pickle.dumps((False, error))
        except Exception:
            return pickle.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
