"""Proximity graphs by their definitions: every pair against every point, in integers.

The input is a list of distinct points; edges are sets of pairs of their numbers, the smaller first.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Point = tuple[Fraction, ...]
Edges = set[tuple[int, int]]


def exact(points: Sequence[Sequence[float]]) -> list[Point]:
    """The points as integers (as fractions), all times one power of two."""
    rows = [tuple(Fraction(float(x)) for x in p) for p in points]
    unit = max((x.denominator for p in rows for x in p), default=1)
    return [tuple(x * unit for x in p) for p in rows]


def squared(a: Point, b: Point) -> Fraction:
    return sum(((x - y) ** 2 for x, y in zip(a, b, strict=True)), Fraction(0))


def dot(a: Point, b: Point, origin: Point) -> Fraction:
    return sum(
        ((x - o) * (y - o) for x, y, o in zip(a, b, origin, strict=True)),
        Fraction(0),
    )


def empty(points: Sequence[Point], holds: Callable[[Point, Point, Point], bool]) -> Edges:
    """Pairs for which no third point is in a region."""
    return {
        (i, j)
        for i, j in combinations(range(len(points)), 2)
        if not any(holds(points[i], points[j], p) for k, p in enumerate(points) if k not in (i, j))
    }


def gabriel(points: Sequence[Point], *, closed: bool) -> Edges:
    def holds(a: Point, b: Point, p: Point) -> bool:
        angle = dot(a, b, p)
        return angle < 0 or (closed and angle == 0)

    return empty(points, holds)


def relative_neighborhood(points: Sequence[Point]) -> Edges:
    return empty(points, lambda a, b, p: max(squared(a, p), squared(b, p)) < squared(a, b))


def lunes(points: Sequence[Point], beta: float, *, closed: bool) -> Edges:
    """Balls around the centers (1 - beta / 2) a + (beta / 2) b and the reverse."""
    half = Fraction(beta) / 2

    def in_ball(a: Point, b: Point, p: Point) -> bool:
        center = tuple((1 - half) * x + half * y for x, y in zip(a, b, strict=True))
        inside = squared(center, p) - half**2 * squared(a, b)
        return inside < 0 or (closed and inside == 0)

    return empty(points, lambda a, b, p: in_ball(a, b, p) and in_ball(b, a, p))


def circles(points: Sequence[Point], beta: float, *, closed: bool) -> Edges:
    """Disks of radius beta |ab| / 2 through a and b, by the power of a point: 2-D.

    The centers are m + t n, where m is the middle, n the normal of the edge with its length, and t
    squared is (beta^2 - 1) / 4. Power of p: |p - m|^2 - |ab|^2 / 4 - 2 t (p - m) . n.
    """
    square = (Fraction(beta) ** 2 - 1) / 4

    def holds(a: Point, b: Point, p: Point) -> bool:
        middle = tuple((x + y) / 2 for x, y in zip(a, b, strict=True))
        plain = squared(p, middle) - squared(a, b) / 4
        along = (p[0] - middle[0]) * (a[1] - b[1]) + (p[1] - middle[1]) * (b[0] - a[0])
        # The nearer center is on the side of p: plain - 2 t |along|.
        if plain < 0:
            return True
        side = plain**2 - 4 * square * along**2
        return side < 0 or (closed and side == 0)

    return empty(points, holds)


def nearest(points: Sequence[Point], k: int) -> list[list[int]]:
    """The k nearest of each, ties by coordinates."""
    return [
        sorted(
            (j for j in range(len(points)) if j != i),
            key=lambda j: (squared(points[i], points[j]), points[j]),
        )[:k]
        for i in range(len(points))
    ]


def influence(points: Sequence[Point], *, closed: bool) -> Edges:
    """sqrt(d) <= sqrt(r) + sqrt(s), squared twice."""
    radii = [min((squared(p, q) for q in points if q != p), default=Fraction(0)) for p in points]
    found = set()
    for i, j in combinations(range(len(points)), 2):
        rest = squared(points[i], points[j]) - radii[i] - radii[j]
        sign = 1 if rest < 0 else 4 * radii[i] * radii[j] - rest**2
        if sign > 0 or (closed and sign == 0):
            found.add((i, j))
    return found


def spanning_tree(points: Sequence[Point]) -> Edges:
    """Kruskal's algorithm on all pairs: by length, then by the smaller and the larger end."""

    def key(pair: tuple[int, int]) -> tuple[Fraction, list[Point]]:
        ends = [points[i] for i in pair]
        return squared(*ends), sorted(ends)

    parts = list(range(len(points)))
    found = set()
    for i, j in sorted(combinations(range(len(points)), 2), key=key):
        if parts[i] != parts[j]:
            found.add((i, j))
            old = parts[j]
            parts = [parts[i] if part == old else part for part in parts]
    return found


def urquhart(points: Sequence[Point], triangles: Sequence[Sequence[int]]) -> Edges:
    """Edges of triangles without those that are strictly longest in one."""
    edges, longest = set(), set()
    for triangle in triangles:
        sides = [tuple(sorted(pair)) for pair in combinations(triangle, 2)]
        edges.update(sides)
        lengths = [squared(points[i], points[j]) for i, j in sides]
        if lengths.count(max(lengths)) == 1:
            longest.add(sides[lengths.index(max(lengths))])
    return {(int(i), int(j)) for i, j in edges - longest}
