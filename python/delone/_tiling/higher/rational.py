"""Linear algebra with fractions, for decisions that need exact arithmetic."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["kernel"]


def kernel(rows: Sequence[Sequence[Fraction]]) -> list[Fraction]:
    """Return a nonzero vector that is orthogonal to all rows, by Gauss-Jordan elimination.

    Such a vector must exist. Its last free component is 1, and the other free ones are 0.
    """
    left, width = [list(row) for row in rows], len(rows[0])
    pivots: list[int] = []
    for k in range(width):
        found = next((i for i in range(len(pivots), len(left)) if left[i][k]), None)
        if found is None:
            continue
        at = len(pivots)
        left[at], left[found] = left[found], left[at]
        left[at] = [x / left[at][k] for x in left[at]]
        for i, row in enumerate(left):
            if i != at and row[k]:
                left[i] = [x - row[k] * y for x, y in zip(row, left[at], strict=True)]
        pivots.append(k)
    free = max(k for k in range(width) if k not in pivots)
    vector = [Fraction(0)] * width
    vector[free] = Fraction(1)
    for i, k in enumerate(pivots):
        vector[k] = -left[i][free]
    return vector
