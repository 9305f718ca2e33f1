"""Cells so thin that rounded corners do not determine their measures.

A corner is rounded by up to 4 units in the last place of each coordinate. That changes the area of
a cell by up to that times its extent along the other axis, on either side. If the area is not
larger than that, none of its digits is known, and it may be 0.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.georeference import caller_level

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = ["ThinCellWarning", "among", "warn"]

# Four units in the last place, on either side, of numbers up to 1.
_ROUNDING = 2.0**-49
# The smallest normal number.
_SMALLEST = float(np.finfo(np.float64).tiny)
_MOST_ROWS = 8


class ThinCellWarning(UserWarning):
    """Cells are so thin that rounded corners do not determine their areas or volumes.

    ``rows`` contains the sites, like `Voronoi.thin_cells`.

    Parameters
    ----------
    message : str
        The message.
    rows : ndarray of int32
        The rows of the sites.
    """

    def __init__(self, message: str, rows: NDArray[np.int32]) -> None:
        super().__init__(message)
        self.rows = rows


def among(
    areas: Floats, perimeters: Floats, starts: NDArray[np.int32], corners: Floats
) -> NDArray[np.bool_]:
    """Return which 2-D cells are thin: they have a perimeter, but rounding may hide their area.

    `starts` and `corners` are those of the cells before they are cut to an outline.
    """
    found = np.zeros(len(areas), dtype=bool)
    rows = np.flatnonzero((np.diff(starts) > 0) & (perimeters > 0) & np.isfinite(perimeters))
    # No bound below is larger than this one.
    largest = float(np.abs(corners).max(initial=0.0))
    with np.errstate(over="ignore"):
        rows = rows[~(areas[rows] > _ROUNDING * largest * perimeters[rows])]
    if not len(rows):
        return found
    # Cells without corners have no entry in `corners`, so the others are adjacent.
    filled = np.flatnonzero(np.diff(starts) > 0)
    low = np.minimum.reduceat(corners, starts[:-1][filled], axis=0)[np.searchsorted(filled, rows)]
    high = np.maximum.reduceat(corners, starts[:-1][filled], axis=0)[np.searchsorted(filled, rows)]
    error = _ROUNDING * np.maximum(np.abs(low), np.abs(high))
    with np.errstate(all="ignore"):
        # The extent of a cell across the axis along which its corners are moved.
        reach = np.minimum(high - low, perimeters[rows, None] / 2)
        bound = (error * reach[:, ::-1]).sum(axis=1)
        # Areas below the range of doubles are 0 without being thin.
        found[rows] = (areas[rows] <= bound) & (bound > _SMALLEST) & np.isfinite(bound)
    return found


def warn(rows: NDArray[np.int32], measures: str) -> None:
    """Warn about thin cells, if there are any, at the line that called the package."""
    if not len(rows):
        return
    some: list[Any] = rows[:_MOST_ROWS].tolist()
    listed = ", ".join(map(str, some)) + (", ..." if len(rows) > len(some) else "")
    count = "1 cell is" if len(rows) == 1 else f"{len(rows)} cells are"
    row = "row" if len(rows) == 1 else "rows"
    warnings.warn(
        ThinCellWarning(
            f"{count} only a few units in the last place of the coordinates wide "
            f"({row} {listed}): rounded corners do not determine such {measures}, which may be 0. "
            "thin_cells lists the rows. Subtract an offset that all points share before they are "
            "rounded, or merge such sites",
            rows,
        ),
        stacklevel=caller_level(),
    )
