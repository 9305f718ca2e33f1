"""A lock for one run at a time in an output; the system releases it when a process ends.

The file says who holds it. Because the system manages the lock, a killed process does not leave one
behind, whatever the file contains, and two runs that find such a file cannot both acquire it.
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

from delone.errors import BusyError, InputError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["LOCK", "locked"]

# The name of the file in the folder of the output.
LOCK = "delone.lock"


@contextmanager
def locked(root: Path) -> Iterator[None]:
    """Lock a folder, which is created if necessary; BusyError if another run is using it."""
    made = not root.exists()
    if made and root.is_symlink():
        raise InputError(
            f"{root} is a link to {os.readlink(root)!r:.100}, which does not exist: create that "
            "folder, or choose another output"
        )
    path = root / LOCK
    file = _taken(path)
    try:
        file.truncate(0)
        json.dump({"pid": os.getpid(), "host": platform.node()}, file)
        file.flush()
        yield
    finally:
        # Removed while the lock is held, so that waiting processes see that it is gone.
        path.unlink(missing_ok=True)
        file.close()
        if made:
            # Remove the folder if it is still empty.
            with contextlib.suppress(OSError):
                root.rmdir()


def _taken(path: Path) -> IO[str]:
    """Create the folder, open the file and lock it."""
    while True:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            file = path.open("a+", encoding="utf-8")
        except FileNotFoundError:
            # The process that created the folder just removed it.
            continue
        try:
            _lock(file)
            # Between opening and locking, the run that held the lock may have removed the file.
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
                f"{file.name}: the file system has no locks; make sure that no other run is "
                "using this output",
                RuntimeWarning,
                stacklevel=2,
            )


def _busy(path: Path, file: IO[str]) -> BusyError:
    """Return the error that says who holds a lock."""
    file.seek(0)
    try:
        owner = json.load(file)
        pid, host = int(owner["pid"]), str(owner["host"])
    except (ValueError, KeyError, TypeError):
        # It was acquired just now.
        pid, host = 0, ""
    file.close()
    who = f"process {pid} on {host}" if host else "another process"
    return BusyError(
        f"{path.parent} is being written by {who}: wait for it, or stop it and run the same again",
        pid=pid,
        host=host,
    )
