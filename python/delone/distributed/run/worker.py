"""A worker process: reads tasks from its standard input until it ends, and returns summaries.

It is a fresh interpreter, because a fork of a process with threads may deadlock. It imports nothing
from the program that started it, so that program need not guard its main module. The input ends
when that program ends, for whatever reason.
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
    """The process died during a task."""


class Worker:
    """A process that performs tasks."""

    def __init__(self) -> None:
        # Not from the working folder (-P): a file there may have the name of a module.
        self._process = Popen([sys.executable, "-P", "-c", _BEGIN], stdin=PIPE, stdout=PIPE)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._tasks, self._answers = self._process.stdin, self._process.stdout
        pickle.dump(sys.path, self._tasks)

    def perform(self, *task: Any) -> Any:
        """Perform a task in the process; raise its exception."""
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
        """Stop the process after its task, and wait for it."""
        # A process that died left the rest of a task unread.
        with contextlib.suppress(OSError):
            self._tasks.close()
        self._process.wait()
        self._answers.close()


def serve() -> None:
    """Perform tasks until the input ends."""
    tasks, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    # Output that a library prints must not mix with the answers.
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
        # The parent process is interrupted as well, or gone.
        os._exit(1)


def _answer(task: Any) -> bytes:
    try:
        return pickle.dumps((True, perform(*task)))
    except Exception as error:
        try:
            return pickle.dumps((False, error))
        except Exception:
            return pickle.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
