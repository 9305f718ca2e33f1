"""How much memory is free, and the error that says that a result would not fit."""

from __future__ import annotations

import os
from pathlib import Path

from delone.errors import DeloneError

__all__ = ["TooLargeError", "free_memory"]


class TooLargeError(DeloneError, MemoryError):
    """The result would take more memory than is free, or than `max_bytes`; also a MemoryError.

    It is raised before the work, from numbers of simplices of samples.

    Parameters
    ----------
    message : str
        The message.
    simplices : int, optional
        The predicted number of simplices.
    nbytes : int, optional
        The predicted bytes.
    limit : int, optional
        The bytes that are free, or `max_bytes`.

    Attributes
    ----------
    simplices : int
        The predicted number of simplices.
    nbytes : int
        The predicted bytes.
    limit : int
        The bytes that are free, or `max_bytes`.

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
    """Return the bytes that are available without swapping, or None if the system does not say."""
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
