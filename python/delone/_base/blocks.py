"""Processing of long arrays in blocks.

Python can handle Ctrl-C between blocks, and temporary arrays are as small as a block.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

__all__ = ["ROWS", "blocks", "copied"]

Scalar = TypeVar("Scalar", bound=np.generic)

# Rows of a block. Results for this many rows fit into the caches and take milliseconds.
ROWS = 1 << 16


def blocks(count: int) -> Iterator[slice]:
    """Split a number of rows into slices of `ROWS` consecutive rows."""
    return (slice(start, start + ROWS) for start in range(0, count, ROWS))


def copied(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a C-contiguous copy of an array of at least one dimension."""
    if len(array) <= ROWS:
        return array.copy()
    copy = np.empty(array.shape, dtype=array.dtype)
    for block in blocks(len(array)):
        copy[block] = array[block]
    return copy
