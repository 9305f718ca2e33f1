"""The free memory, and the error for results that would not fit into it."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Self

from delone.errors import DeloneError

__all__ = ["TooLargeError", "free_memory"]

# Limit, use and statistics of the control group of a process, in versions 2 and 1 of Linux control
# groups.
_GROUPS = (
    ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current", "/sys/fs/cgroup/memory.stat"),
    (
        "/sys/fs/cgroup/memory/memory.limit_in_bytes",
        "/sys/fs/cgroup/memory/memory.usage_in_bytes",
        "/sys/fs/cgroup/memory/memory.stat",
    ),
)
# The numbers of MEMORYSTATUSEX, of which only one is needed.
_OF_WINDOWS = ("all", "free", "all_pages", "free_pages", "all_virtual", "free_virtual", "extended")


class TooLargeError(DeloneError, MemoryError):
    """The result would need more than the free memory, or more than `max_bytes`.

    The error is raised before the computation starts. The size is predicted from samples. It is
    also a MemoryError.

    Parameters
    ----------
    message : str
        The error message.
    simplices : int, optional
        The predicted number of simplices.
    nbytes : int, optional
        The predicted memory, in bytes.
    limit : int, optional
        The free memory in bytes, or `max_bytes`.

    Attributes
    ----------
    simplices : int
        The predicted number of simplices.
    nbytes : int
        The predicted memory, in bytes.
    limit : int
        The free memory in bytes, or `max_bytes`.

    Examples
    --------
    >>> import numpy as np
    >>> import delone
    >>> try:
    ...     delone.Delaunay(np.random.default_rng(0).random((3000, 6)), max_bytes=10**8)
    ... except delone.TooLargeError as error:
    ...     print(error.simplices > 10**6, error.nbytes > error.limit)
    True True
    """

    simplices: int
    nbytes: int
    limit: int

    def __new__(cls, *args: object, **kwargs: object) -> Self:
        """Create an error; libraries that copy errors, such as tblib, call only this."""
        # That of MemoryError rejects classes with another base.
        return Exception.__new__(cls, *args)

    def __init__(
        self,
        message: str = "the result would take too much memory",
        *,
        simplices: int = 0,
        nbytes: int = 0,
        limit: int = 0,
    ) -> None:
        super().__init__(message)
        self.simplices = int(simplices)
        self.nbytes = int(nbytes)
        self.limit = int(limit)


def free_memory() -> int | None:
    """Return the bytes that are available without swapping, or None if the system does not say.

    On Linux, limited by what is left in the control group of the process, such as that of a
    container; on Windows, the free physical memory; on other systems, all physical memory.
    """
    free = _available() or _available_on_windows()
    if free is None:
        try:
            free = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        except (AttributeError, OSError, ValueError):
            return None
    left = _left_in_group()
    return free if left is None else min(free, left)


def _available() -> int | None:
    """Return what Linux reports as available."""
    for line in _lines("/proc/meminfo"):
        if line.startswith("MemAvailable:"):
            return 1024 * int(line.split()[1])
    return None


def _left_in_group() -> int | None:
    """Return how much more the control group of this process may use; None without a limit."""
    for limit, used, cache in _GROUPS:
        found, now = _lines(limit), _lines(used)
        # Without a limit, it is "max", or a number larger than any memory.
        if found and now and found[0].isdigit() and now[0].isdigit():
            names = dict(line.split()[:2] for line in _lines(cache) if " " in line)
            # Cached files are dropped when memory is needed.
            dropped = int(names.get("total_inactive_file", names.get("inactive_file", 0)))
            return max(0, int(found[0]) - int(now[0]) + dropped)
    return None


def _lines(path: str) -> list[str]:
    """Return the lines of a system file; none if it does not exist."""
    try:
        return Path(path).read_text(encoding="ascii").splitlines()
    except (OSError, ValueError):
        return []


def _available_on_windows() -> int | None:
    """Return the free physical memory on Windows."""
    if sys.platform != "win32":
        return None
    import ctypes

    class Status(ctypes.Structure):
        _fields_ = (
            ("length", ctypes.c_ulong),
            ("load", ctypes.c_ulong),
            *((name, ctypes.c_ulonglong) for name in _OF_WINDOWS),
        )

    status = Status(length=ctypes.sizeof(Status))
    if not ctypes.windll.kernel32.GlobalMemoryStatusEx(ctypes.byref(status)):
        return None
    return int(status.free)
