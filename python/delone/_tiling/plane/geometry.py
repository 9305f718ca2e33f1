"""Normals of edges in the plane, and sums of many sizes."""

from __future__ import annotations

from math import frexp, fsum, inf, ldexp
from typing import TYPE_CHECKING

import numpy as np

from delone._base.blocks import ROWS, blocks

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices


# So few sizes that splitting them would cost more.
_FEW = 1000
# The exponent of the largest power of two that is a double.
_LARGEST = 1023

__all__ = ["edge_normals", "shares", "summed", "total"]


def edge_normals(points: Floats, edges: Indices) -> Floats:
    """Return unit normals to the right of edges between distinct points; errors are below 1e-15."""
    # Halve the coordinates if their difference overflows, and scale by a power of two, so that
    # small differences keep their bits.
    ends = points[edges]
    with np.errstate(over="ignore"):
        along = ends[:, 1] - ends[:, 0]
        wide = ~np.isfinite(along).all(axis=1)
    along[wide] = ends[wide, 1] / 2 - ends[wide, 0] / 2
    exponent = np.frexp(np.abs(along).max(axis=1))[1]
    along = np.ldexp(along, -exponent[:, None])
    normals = np.column_stack((along[:, 1], -along[:, 0]))
    normals /= np.hypot(normals[:, 0], normals[:, 1])[:, None]
    # Adding 0 turns -0 into 0.
    return normals + 0.0


def total(sizes: Floats) -> float:
    """Return the sum of sizes that are not negative, rounded once; inf beyond doubles."""
    return summed([part for block in blocks(len(sizes)) for part in shares(sizes[block])])


def summed(parts: list[float]) -> float:
    """Return the sum of numbers, rounded once; inf beyond doubles."""
    try:
        return fsum(parts)
    except OverflowError:
        return inf


def shares(sizes: Floats) -> list[float]:
    """Return numbers with exactly the same sum, few of them if sizes are similar.

    S. M. Rump, T. Ogita, S. Oishi, "Accurate floating-point summation part I", SIAM Journal on
    Scientific Computing 31 (2008). Terminates: the largest number left falls by a factor of 2^34.
    """
    found: list[float] = []
    while len(sizes) > _FEW:
        top = float(np.abs(sizes).max())
        # Above the sum of all: high parts are multiples of 2^-53 of it, so their sum is exact.
        exponent = frexp(top)[1] + ROWS.bit_length() + 1
        if not top < inf or exponent > _LARGEST:
            break
        high = (sizes + ldexp(1.0, exponent)) - ldexp(1.0, exponent)
        found.append(float(high.sum()))
        sizes = sizes - high
        sizes = sizes[sizes != 0]
    found += sizes.tolist()
    return found
