"""Linear algebra in fractions, for what rounding does not decide."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["kernel"]


def kernel(rows: Sequence[Sequence[Fraction]]) -> list[Fraction]:
    """Return a vector that is orthogonal to others, one for which it exists, by Gauss and Jordan.

    The last of its components that are free is 1.
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
