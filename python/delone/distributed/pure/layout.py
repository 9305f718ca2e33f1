"""Data shared by all tasks of a run: the cells, the strips, the hull and the dtype of rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from delone.distributed.pure.rows import Rows
    from delone.distributed.pure.tiles import Tiles

__all__ = ["Layout"]


@dataclass(frozen=True, eq=False)
class Layout:
    """The partition of the plane: cells, the boxes that tiles know initially, corners of the hull.

    `strips` is (tiles, 4); the hull is in the order of the source.
    """

    tiles: Tiles
    strips: NDArray[np.float64]
    hull: Rows

    @property
    def type(self) -> np.dtype[np.void]:
        """The dtype of rows."""
        return self.hull.dtype
