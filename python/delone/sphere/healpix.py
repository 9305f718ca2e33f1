"""Corners of HEALPix pixels, from integers, so that pixels share them exactly.

K. M. Górski et al., "HEALPix: a framework for high-resolution discretization and fast analysis of
data distributed on the sphere", The Astrophysical Journal 622 (2005).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_index
from delone._base.blocks import blocks
from delone.errors import InputError

if TYPE_CHECKING:
    from delone._base.types import Floats, Rows

__all__ = ["healpix_corners"]

# The ring and the longitude, in eighths of a turn, of the southern corner of each base pixel.
_RING = np.array([2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4])
_EIGHTH = np.array([1, 3, 5, 7, 0, 2, 4, 6, 1, 3, 5, 7])
_LARGEST = 1 << 13


def healpix_corners(nside: int, *, nested: bool, workers: int) -> Floats:
    """Return the four corners of each pixel, counter-clockwise from the south, (n, 4, 3)."""
    n = as_index(nside, 1, _LARGEST, name="nside")
    if nested and n & (n - 1):
        raise InputError(f"nside must be a power of two for nested pixels, got {n}")
    face, x, y = _nested(n) if nested else _ringed(n)
    # In a base pixel, x increases to the northeast and y to the northwest.
    steps = ((0, 0), (1, 0), (1, 1), (0, 1))
    found = np.empty((len(face), 4, 3))
    for block in blocks(len(face)):
        for k, (i, j) in enumerate(steps):
            found[block, k] = _place(n, face[block], x[block] + i, y[block] + j, workers)
    return found


def _place(n: int, face: Rows, x: Rows, y: Rows, workers: int) -> Floats:
    """Return vectors of corners by their ring, from the north pole, and their place in it."""
    ring = _RING[face] * n - x - y
    # A quarter of a ring has as many corners as rings lie between it and its pole, at most nside.
    wide = np.minimum(np.minimum(ring, 4 * n - ring), n)
    at = (_EIGHTH[face] * wide + x - y) % np.maximum(8 * wide, 1)
    cap = wide < n
    square = (wide * wide) / (3.0 * n * n)
    z = np.where(cap, np.where(ring < n, 1 - square, square - 1), (2 * n - ring) * 2 / (3.0 * n))
    flat = np.sqrt(np.where(cap, square * (2 - square), (1 - z) * (1 + z)))
    angles = np.zeros((len(ring), 2))
    angles[:, 0] = 45.0 * at / np.maximum(wide, 1)
    circle = _core.sphere_directions(angles, True, workers)
    return np.column_stack((flat * circle[:, 0], flat * circle[:, 1], z))


def _nested(n: int) -> tuple[Rows, Rows, Rows]:
    """Return the base pixel and the place in it of nested pixels: bits of x and y alternate."""
    pixel = np.arange(12 * n * n, dtype=np.int64)
    face, within = pixel // (n * n), pixel % (n * n)
    return face, _even_bits(within), _even_bits(within >> 1)


def _even_bits(value: Rows) -> Rows:
    """Return the numbers that every second bit forms."""
    found = np.zeros_like(value)
    for bit in range(14):
        found |= ((value >> (2 * bit)) & 1) << bit
    return found


def _ringed(n: int) -> tuple[Rows, Rows, Rows]:
    """Return the base pixel and the place in it of pixels along rings from north to south."""
    face = np.repeat(np.arange(12, dtype=np.int64), n * n)
    x = np.tile(np.repeat(np.arange(n, dtype=np.int64), n), 12)
    y = np.tile(np.arange(n, dtype=np.int64), 12 * n)
    # The middle of a pixel is between two corners: twice its ring, and its place from longitude 0.
    ring = _RING[face] * n - x - y - 1
    wide = np.minimum(np.minimum(ring, 4 * n - ring), n)
    at = (_EIGHTH[face] * wide + x - y) % (8 * wide)
    order = np.lexsort((at, ring))
    return face[order], x[order], y[order]
