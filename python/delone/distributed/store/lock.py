"""One run at a time in an output: a lock that the system takes from a process when it ends.

The file says who has it. As the system holds the lock, none is left by a killed process, whatever
stands in the file, and two runs that find such a file cannot both take it.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import sys
import warnings
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING

from delone.errors import BusyError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["LOCK", "locked"]

# The name of the file in the folder of the output.
LOCK = "delone.lock"


@contextmanager
def locked(root: Path) -> Iterator[None]:
    """Have a folder, which is made if need be, for oneself.

    Raises
    ------
    BusyError
        Another run is at work there.
    """
    made = not root.exists()
    path = root / LOCK
    file = _taken(path)
    try:
        file.truncate(0)
        json.dump({"pid": os.getpid(), "host": platform.node()}, file)
        file.flush()
        yield
    finally:
        # Removed while it is held: who waits for this file sees that it is not there any more.
        path.unlink(missing_ok=True)
        file.close()
        if made:
            # Nothing has come of it, if it is empty still.
            with contextlib.suppress(OSError):
                root.rmdir()


def _taken(path: Path) -> IO[str]:
    """Make the folder, open the file and lock it."""
    while True:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            file = path.open("a+", encoding="utf-8")
        except FileNotFoundError:
            # Whoever made the folder has just removed it.
            continue
        try:
            _lock(file)
            # Between opening and locking, the run that had it may have ended and removed it.
            if os.path.samestat(os.fstat(file.fileno()), path.stat()):
                return file
        except BlockingIOError:
            raise _busy(path, file) from None
        except FileNotFoundError:
            pass
        file.close()


def _lock(file: IO[str]) -> None:
    """Lock a file, or raise BlockingIOError."""
    if sys.platform == "win32":
        import msvcrt

        file.seek(1 << 20)
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        except OSError as error:
            raise BlockingIOError from error
    else:
        import fcntl

        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise
        except OSError:
            warnings.warn(
                f"{file.name}: the file system has no locks; see to it that no other run is at "
                "work in this output",
                RuntimeWarning,
                stacklevel=2,
            )


def _busy(path: Path, file: IO[str]) -> BusyError:
    """Say who has a lock."""
    file.seek(0)
    try:
        owner = json.load(file)
        pid, host = int(owner["pid"]), str(owner["host"])
    except (ValueError, KeyError, TypeError):
        # It has only just been taken.
        pid, host = 0, ""
    file.close()
    who = f"process {pid} on {host}" if host else "another process"
    return BusyError(
        f"{path.parent} is being written by {who}: wait for it, or end it and run the same again",
        pid=pid,
        host=host,
    )
