"""Exact signs for directions: in floating point where an error bound allows it, else in integers.

The core decides while it triangulates. These signs check what it returned, and the arrays in files.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.blocks import blocks

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

    Signs = NDArray[np.int8]
    Vector = tuple[int, int, int]

__all__ = ["circles", "cross", "dot", "turns", "turns_at", "whole"]

# Half the distance from 1.0 to the next double.
_U = 2.0**-53


def whole(vector: Iterable[float]) -> Vector:
    """Return the smallest integers in the same direction, exactly."""
    ratios = [x.as_integer_ratio() for x in vector]
    # Denominators are powers of two.
    scale = max(q for _, q in ratios)
    x, y, z = (p * (scale // q) for p, q in ratios)
    common = math.gcd(x, y, z) or 1
    return x // common, y // common, z // common


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def dot(a: Vector, b: Vector) -> int:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def turns(a: Floats, b: Floats, c: Floats) -> Signs:
    """Return the signs of the determinants of three vectors each, (k, 3): exact, by the core."""
    return _core.orient3d(np.zeros((1, 3)).repeat(len(a), axis=0), a, b, c)


def turns_at(vectors: Floats, units: Floats, edges: Indices, place: Vector) -> Signs:
    """Return the side of each edge, (k, 2), on which a direction of integers lies: 1 is left."""
    size = max(map(abs, place))
    rounded = np.array([x / size for x in place])
    tail, head = units[edges[:, 0]], units[edges[:, 1]]
    value = np.cross(tail, head - tail) @ rounded
    signs: Signs = np.sign(value).astype(np.int8)
    # Unit vectors are off by u / 2 in each coordinate; their coordinates add up to less than 1.74.
    doubtful = np.flatnonzero(np.abs(value) <= 64 * _U)
    for row in doubtful.tolist():
        a, b = (whole(vectors[v].tolist()) for v in edges[row].tolist())
        signs[row] = _sign(dot(cross(a, b), place))
    return signs


def circles(vectors: Floats, units: Floats, rows: Indices) -> tuple[Signs, Signs]:
    """Return 1 if the last of four directions, (k, 4), is inside the circle of the others, 0 on it.

    The first three are counter-clockwise. The second array is the same with ties broken by the
    order of directions.
    """
    plain = np.zeros(len(rows), dtype=np.int8)
    doubtful: list[int] = []
    for block in blocks(len(rows)):
        value, bound = _rounded(units, rows[block])
        plain[block] = np.sign(value)
        doubtful += (np.flatnonzero(~(np.abs(value) > bound)) + block.start).tolist()
    broken = plain.copy()
    for row in doubtful:
        four = [whole(vectors[v].tolist()) for v in rows[row].tolist()]
        plain[row] = _circle(four)
        broken[row] = plain[row] or _tie(four)
    return plain, broken


def _rounded(units: Floats, rows: Indices) -> tuple[Floats, Floats]:
    """Return determinants of the differences from the last of four units, and bounds of errors.

    Coordinates of units are off by u / 2. The bounds in the core are 3 u and 10 u; these allow for
    different orders of summation.
    """
    p, q, r = (units[rows[:, k]] - units[rows[:, 3]] for k in range(3))
    s, t, w = (np.abs(each).sum(axis=1) for each in (p, q, r))
    value = -np.einsum("ij,ij->i", p, np.cross(q, r))
    return value, 8 * _U * (s * t + t * w + w * s) + 16 * _U * s * t * w


def _circle(four: list[Vector]) -> int:
    """Return the sign of |a| [b, c, d] - |b| [a, c, d] + |c| [a, b, d] - |d| [a, b, c]."""
    squares, signs = [], []
    for k, vector in enumerate(four):
        b, c, d = (each for i, each in enumerate(four) if i != k)
        factor = dot(cross(b, c), d)
        squares.append(factor * factor * dot(vector, vector))
        signs.append(-_sign(factor) if k % 2 else _sign(factor))
    return _sign_of_roots(squares, signs)


def _sign_of_roots(squares: list[int], signs: list[int]) -> int:
    """Return the sign of a sum of four square roots of integers with signs.

    Let M be the sum of the roots. The product of all conjugate sums, which have different signs, is
    an integer. There are at most 16 of them, none above M in size, so a nonzero sum is at least 1 /
    M**15.
    """
    size = max(n.bit_length() for n in squares) // 2 + 3
    for bits in (64, 15 * size + 4):
        total = sum(s * math.isqrt(n << 2 * bits) for n, s in zip(squares, signs, strict=True))
        # Each root is too small by less than one.
        if abs(total) >= 4:
            return _sign(total)
    return 0


def _tie(four: list[Vector]) -> int:
    """Return the sign if the smallest of four directions on a circle is pushed outward."""
    k = min(range(4), key=lambda i: _order(four[i]))
    b, c, d = (each for i, each in enumerate(four) if i != k)
    sign = -_sign(dot(cross(b, c), d))
    return -sign if k % 2 else sign


def _order(vector: Vector) -> tuple[int, list[Fraction]]:
    """Return a key that orders directions: the plane that a ray meets, and its position there."""
    k = next(k for k in range(3) if vector[k])
    return (k if vector[k] < 0 else 5 - k), [Fraction(x, abs(vector[k])) for x in vector]


def _sign(x: int) -> int:
    return (x > 0) - (x < 0)
