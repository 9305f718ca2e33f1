"""Directions in integers: orientation, circles and ties, by roots taken to as many bits as needed.

Independent of the package: a sum of four square roots of integers, with all choices of their signs,
has an integer product; so it is zero or not smaller than a power of two.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cmp_to_key
from itertools import combinations
from math import isqrt
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

Vector = tuple[int, int, int]
Triangle = tuple[int, int, int]


def whole(vector: Iterable[float]) -> Vector:
    """Return a vector of integers without a common factor, with the same direction exactly."""
    x, y, z = (Fraction(float(value)) for value in vector)
    scale = max(x.denominator, y.denominator, z.denominator)
    a, b, c = (int(value * scale) for value in (x, y, z))
    assert a or b or c, "a zero vector has no direction"
    common = a | b | c
    low = (common & -common).bit_length() - 1
    return a >> low, b >> low, c >> low


def dot(a: Vector, b: Vector) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def det(a: Vector, b: Vector, c: Vector) -> int:
    return dot(cross(a, b), c)


def sign(x: int) -> int:
    return (x > 0) - (x < 0)


def sign_of_roots(terms: Sequence[tuple[int, int]]) -> int:
    """Return the sign of the sum of x sqrt n."""
    size = max(abs(x).bit_length() + (n.bit_length() + 1) // 2 + 3 for x, n in terms)
    bits = 40
    while True:
        total = sum(x * isqrt(n << (2 * bits)) for x, n in terms)
        if abs(total) > sum(abs(x) for x, _ in terms) + 1:
            return sign(total)
        if bits > 8 * size + 8:
            return 0
        bits = min(4 * bits, 8 * size + 9)


def orient(a: Vector, b: Vector, c: Vector) -> int:
    return sign(det(a, b, c))


def in_circle(a: Vector, b: Vector, c: Vector, d: Vector) -> int:
    """Return 1 if d is inside the circle of the counter-clockwise a, b, c, without a tie rule."""
    terms = ((det(b, c, d), a), (-det(a, c, d), b), (det(a, b, d), c), (-det(a, b, c), d))
    return sign_of_roots([(x, dot(v, v)) for x, v in terms])


def compare(a: Vector, b: Vector) -> int:
    """Compare directions: by the plane that they meet first, then by their place on it."""
    planes = []
    for v in (a, b):
        k = next(k for k in range(3) if v[k])
        side = k if v[k] < 0 else 5 - k
        planes.append((side, [Fraction(x, abs(v[k])) for x in v]))
    return (planes[0] > planes[1]) - (planes[0] < planes[1])


def is_inside(a: Vector, b: Vector, c: Vector, d: Vector) -> bool:
    """Whether d is in conflict with a triangle; of four on a circle the smallest is the apex."""
    found = in_circle(a, b, c, d)
    if found:
        return found > 0
    smallest = min((a, b, c, d), key=cmp_to_key(compare))
    # The fan from d has no triangle without it; a fan from a corner has all triangles at it.
    if smallest == d:
        return True
    # The triangle is in the fan of its smallest corner if d is not between the other two.
    corners = [a, b, c]
    k = corners.index(smallest)
    p, q, r = (corners[(k + i) % 3] for i in range(3))
    # Around the circle p, q, r: d between q and r splits the triangle.
    return orient(q, d, r) != orient(q, p, r) and _crosses(p, d, q, r)


def _crosses(a: Vector, b: Vector, c: Vector, d: Vector) -> bool:
    """Whether the chords a b and c d of one circle cross."""
    return det(a, b, c) * det(a, b, d) < 0 and det(c, d, a) * det(c, d, b) < 0


def canonical(triangles: Iterable[Iterable[int]]) -> set[Triangle]:
    """Return triangles that begin with their smallest row."""
    out = set()
    for triangle in triangles:
        a, b, c = map(int, triangle)
        out.add(min((a, b, c), (b, c, a), (c, a, b)))
    return out


def firsts(vectors: Sequence[Vector]) -> list[int]:
    """Return for each row the first one with the same direction."""
    return [
        next(k for k in range(i + 1) if compare(vectors[k], v) == 0) for i, v in enumerate(vectors)
    ]


def brute(vectors: Sequence[Vector]) -> set[Triangle]:
    """Return the triangles with a positive determinant whose circles are empty, ties decided."""
    rows = sorted(set(firsts(vectors)))
    found = []
    for i, j, k in combinations(rows, 3):
        side = orient(vectors[i], vectors[j], vectors[k])
        if not side:
            continue
        t = (i, j, k) if side > 0 else (i, k, j)
        corners = [vectors[v] for v in t]
        if not any(is_inside(*corners, vectors[d]) for d in rows if d not in t):
            found.append(t)
    return canonical(found)
