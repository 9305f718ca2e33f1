"""Bounds of the cells of Gaussian grids."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_index, as_least
from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats

__all__ = ["gaussian_bounds"]

# More would be cells of a kilometer; the time of the roots grows with the cube.
_MOST = 8192


def gaussian_bounds(n: int, points: str | Sequence[int] | None) -> tuple[Floats, list[Floats]]:
    """Return the bounds of rows from north to south and of the columns of each, in degrees."""
    half = as_index(n, 1, _MOST, name="n")
    counts = _counts(half, points)
    weights = np.polynomial.legendre.leggauss(2 * half)[1]
    # Sines of bounds from the north pole to the equator, and their mirror images.
    north = 1 - np.cumsum(weights[:half])
    sines = np.concatenate(([1.0], north[:-1], [0.0], -north[:-1][::-1], [-1.0]))
    rows: Floats = np.degrees(np.arcsin(sines))
    made: dict[int, Floats] = {}
    for count in counts:
        if count not in made:
            edges = (np.arange(count + 1, dtype=np.float64) - 0.5) * (360.0 / count)
            # Exactly one turn.
            edges[-1] = edges[0] + 360.0
            made[count] = edges
    return rows, [made[count] for count in counts]


def _counts(half: int, points: Any) -> list[int]:
    """Return the cells in each row."""
    if points is None:
        return [4 * half] * (2 * half)
    octahedral = isinstance(points, str) and points == "octahedral"
    if not octahedral and (isinstance(points, str) or not hasattr(points, "__iter__")):
        raise InputError(f'points must be "octahedral" or numbers, got {points!r:.60}')
    if octahedral:
        north = [20 + 4 * k for k in range(half)]
        return north + north[::-1]
    counts = [as_least(count, 1, name="points") for count in points]
    if len(counts) != 2 * half:
        raise InputError(
            f"points must have {2 * half} numbers, one for each row, got {len(counts)}"
        )
    return counts
