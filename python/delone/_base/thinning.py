"""A profile through fewer points: those farthest from the line are kept (Douglas and Peucker)."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats

__all__ = ["thinned"]

# The sum of three heights up to this one, or of their differences, does not overflow.
_TALL = 1e307


def thinned(way: Floats, z: Floats, fixed: Bools, limit: float) -> Bools:
    """Return which points of a profile to keep, so that others are within a vertical distance."""
    if np.abs(z).max(initial=0.0) > _TALL:
        z, limit = z / 8, limit / 8
    kept = fixed.copy()
    kept[:1] = kept[-1:] = True
    spans = list(pairwise(np.flatnonzero(kept).tolist()))
    while spans:  # Each round with a split keeps one more point.
        a, b = spans.pop()
        if b - a < 2:
            continue
        share = (way[a + 1 : b] - way[a]) / (way[b] - way[a])
        away = np.abs(z[a + 1 : b] - (z[a] + share * (z[b] - z[a])))
        k = a + 1 + int(away.argmax())
        if not away[k - a - 1] <= limit:
            kept[k] = True
            spans += [(a, k), (k, b)]
    return kept
