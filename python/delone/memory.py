"""The free memory, and the error for results that would not fit into it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Self

from delone.errors import DeloneError

__all__ = ["TooLargeError", "free_memory"]


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
        """Create an error; libraries that copy errors, such as tblib, call this alone."""
        # The one of MemoryError refuses classes with another base.
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

    On systems without /proc/meminfo, this is the total physical memory.
    """
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return 1024 * int(line.split()[1])
    except (OSError, ValueError):
        pass
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return None
