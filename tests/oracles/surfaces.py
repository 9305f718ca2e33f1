"""Pairs of triangles in 3-D by brute force, in fractions, and closed surfaces to test with.

What two triangles have in common is computed by clipping one with the other: the polygon, segment
or point is exact, and how it is placed in both tells the kind of the pair.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from rational import Vector, cross, dot, exact, minus

if TYPE_CHECKING:
    from collections.abc import Iterable
    from fractions import Fraction

    from numpy.typing import NDArray

    Triangle = list[Vector]


def normal(t: Triangle) -> Vector:
    return cross(minus(t[1], t[0]), minus(t[2], t[0]))


def common(s: Triangle, t: Triangle) -> set[Vector]:
    """Return the corners of what two triangles with an area have in common, and perhaps more."""
    ring = [*s]
    up = normal(t)
    walls = [(t[k], cross(up, minus(t[(k + 1) % 3], t[k]))) for k in range(3)]
    for origin, inward in [(t[0], up), (t[0], tuple(-x for x in up)), *walls]:
        ring = _clipped(ring, origin, inward)
    return set(ring)


def _clipped(ring: list[Vector], origin: Vector, inward: Vector) -> list[Vector]:
    """Return the part of a convex ring on one side of a plane."""
    heights = [dot(inward, minus(p, origin)) for p in ring]
    out = []
    for i, p in enumerate(ring):
        q, g, h = ring[i - 1], heights[i - 1], heights[i]
        if (g < 0 < h) or (h < 0 < g):
            out.append(tuple(x + (y - x) * g / (g - h) for x, y in zip(q, p, strict=True)))
        if h >= 0:
            out.append(p)
    return out


def extremes(found: Iterable[Vector]) -> list[Vector]:
    """Return the ends of collinear points."""
    points = sorted(found)
    return [points[0], points[-1]] if len(points) > 1 else points


def spans_area(found: set[Vector]) -> bool:
    points = list(found)
    return any(any(cross(minus(q, p), minus(r, p))) for p, q, r in combinations(points, 3))


def on_edges(p: Vector, t: Triangle) -> bool:
    """Whether a point of a triangle is on one of its edges."""
    edges = [(t[k], t[(k + 1) % 3]) for k in range(3)]
    return any(not any(cross(minus(q, r), minus(p, r))) for q, r in edges)


def kind(s: Triangle, t: Triangle) -> tuple[str, bool] | None:
    """Return the kind of a pair and whether it crosses; None for common vertices and edges."""
    found = common(s, t)
    shared = set(s) & set(t)
    flat = spans_area(found)
    corners = found if flat else set(extremes(found))
    if not corners - shared:
        return None
    vertices = set(s) | set(t)
    new = corners - vertices
    if flat:
        hull = {p for p in corners if not _is_between(p, corners)}
        return ("folded" if len(shared) == 2 else "coplanar overlap"), bool(hull - vertices)
    if any(not (on_edges(p, s) and on_edges(p, t)) for p in new):
        return "crossing", True
    if len(corners) == 2:
        p, q = corners
        middle = tuple((x + y) / 2 for x, y in zip(p, q, strict=True))
        if not on_edges(middle, s) and not on_edges(middle, t):
            return "crossing", True
    if new:
        return "edge on edge", True
    inner = [p for p in corners - shared if not (on_edges(p, s) and on_edges(p, t))]
    return ("vertex in face" if inner else "vertex on edge"), False


def _is_between(p: Vector, points: set[Vector]) -> bool:
    others = points - {p}
    return any(
        not any(cross(minus(q, p), minus(r, p))) and dot(minus(q, p), minus(r, p)) < 0
        for q, r in combinations(others, 2)
    )


def brute_pairs(points: Any, faces: Any) -> dict[tuple[int, int], tuple[str, bool]]:
    """Return all pairs of distinct faces with an area, with kind and whether they cross."""
    rows = exact(points)
    triangles, seen = {}, set()
    for row, face in enumerate(np.asarray(faces).tolist()):
        corners = [rows[v] for v in face]
        if any(normal(corners)) and frozenset(corners) not in seen:
            seen.add(frozenset(corners))
            triangles[row] = corners
    found = {(i, j): kind(triangles[i], triangles[j]) for i, j in combinations(triangles, 2)}
    return {pair: what for pair, what in found.items() if what is not None}


def volume(points: Any, faces: Any) -> Fraction:
    rows = exact(points)
    six = sum(dot(rows[a], cross(rows[b], rows[c])) for a, b, c in np.asarray(faces).tolist())
    return six / 6


BOX_FACES = [
    (0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
    (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5),
]  # fmt: skip


def box(low: Any, high: Any) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return a closed box, its triangles oriented outward."""
    ends = np.array([low, high], dtype=float)
    corners = [(ends[i & 1, 0], ends[i >> 1 & 1, 1], ends[i >> 2, 2]) for i in range(8)]
    return np.array(corners), np.array(BOX_FACES)


def joined(*parts: tuple[Any, Any]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return several surfaces as one; points are not merged."""
    points, faces, count = [], [], 0
    for own, rows in parts:
        points.append(np.asarray(own, dtype=float))
        faces.append(np.asarray(rows) + count)
        count += len(own)
    return np.concatenate(points), np.concatenate(faces)


def sphere(levels: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return an octahedron, each face subdivided into four `levels` times, on the unit sphere."""
    points = [(1.0, 0, 0), (-1.0, 0, 0), (0, 1.0, 0), (0, -1.0, 0), (0, 0, 1.0), (0, 0, -1.0)]
    faces = np.array(
        [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    )
    found = np.array(points)
    for _ in range(levels):
        sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, which = np.unique(sides, axis=0, return_inverse=True)
        middles = found[edges].sum(axis=1)
        middles /= np.linalg.norm(middles, axis=1)[:, None]
        (a, b, c), (p, q, r) = faces.T, (which.reshape(-1, 3) + len(found)).T
        found = np.concatenate((found, middles))
        corners = [(a, p, r), (p, b, q), (r, q, c), (p, q, r)]
        faces = np.concatenate([np.stack(four, axis=1) for four in corners])
    return found, faces
