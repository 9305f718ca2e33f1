"""Work on long arrays block by block.

Between two blocks Python hears Ctrl-C, and temporary arrays are as small as a block.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

__all__ = ["ROWS", "blocks", "copied"]

Scalar = TypeVar("Scalar", bound=np.generic)

# Rows of a block. What is computed from so many fits the caches, and takes milliseconds.
ROWS = 1 << 16


def blocks(count: int) -> Iterator[slice]:
    """Return the blocks of so many rows.

    Parameters
    ----------
    count : int
        How many rows there are.

    Yields
    ------
    slice
        Rows that follow each other.

    Examples
    --------
    >>> from delone.blocks import ROWS, blocks
    >>> [block.start for block in blocks(ROWS + 1)] == [0, ROWS]
    True
    """
    return (slice(start, start + ROWS) for start in range(0, count, ROWS))


def copied(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a copy of an array in rows.

    Parameters
    ----------
    array : ndarray
        Of one dimension or more.

    Returns
    -------
    ndarray
        C-contiguous.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.blocks import copied
    >>> copied(np.array([1, 2]))
    array([1, 2])
    """
    copy = np.empty(array.shape, dtype=array.dtype)
    for block in blocks(len(array)):
        copy[block] = array[block]
    return copy
