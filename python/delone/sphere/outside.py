"""The nearest boundary points of a hull on the sphere, for directions outside it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from delone._base.types import Floats, Indices

__all__ = ["arc_weights", "chords"]

# Number of entries in each temporary array.
_BLOCK = 1 << 20


def arc_weights(points: Floats, arcs: Indices, queries: Floats) -> tuple[Indices, Floats]:
    """Return the nearest arc of each query, (k, 2), and the weights of its ends.

    Points and queries are unit vectors. All arcs are compared, in blocks of queries.
    """
    chosen = np.empty(len(queries), dtype=np.int64)
    for part, squares in chords(points, arcs, queries):
        chosen[part] = squares.argmin(axis=1)
    ends = arcs[chosen]
    a, b = points[ends[:, 0]], points[ends[:, 1]]
    normal = _normals(a, b)
    shares = np.stack((_dots(np.cross(b, normal), queries), _dots(np.cross(normal, a), queries)), 1)
    shares = np.maximum(shares, 0.0)
    # Beyond both ends, the nearest point is the nearer of them.
    lost = ~(shares.sum(axis=1) > 0)
    shares[lost, 0] = _dots(a, queries)[lost] >= _dots(b, queries)[lost]
    shares[lost, 1] = 1.0 - shares[lost, 0]
    return ends, shares / shares.sum(axis=1, keepdims=True)


def chords(points: Floats, arcs: Indices, queries: Floats) -> Iterator[tuple[slice, Floats]]:
    """Yield blocks of queries, and the squared chords from these to all arcs, (k, h)."""
    step = max(1, _BLOCK // max(1, len(arcs)))
    for start in range(0, len(queries), step):
        part = slice(start, min(start + step, len(queries)))
        yield part, _squares(points, arcs, queries[part])


def _squares(points: Floats, arcs: Indices, queries: Floats) -> Floats:
    """The squared chords from queries to arcs, (k, h)."""
    a, b = points[arcs[:, 0]], points[arcs[:, 1]]
    normal = _normals(a, b)
    within = (queries @ np.cross(normal, a).T > 0) & (queries @ np.cross(b, normal).T > 0)
    # From the sine of the angle to the plane, which is accurate for small angles.
    square = np.minimum((queries @ normal.T) ** 2, 1.0)
    interior = 2 * square / (1 + np.sqrt(1 - square))
    ends = 2 - 2 * np.maximum(queries @ a.T, queries @ b.T)
    found: Floats = np.where(within, interior, np.maximum(ends, 0.0))
    return found


def _normals(a: Floats, b: Floats) -> Floats:
    """The unit normals of the planes of arcs, from differences, accurate for short arcs."""
    normal = np.cross(a, b - a)
    length = np.sqrt(_dots(normal, normal))[:, None]
    found: Floats = normal / np.where(length > 0, length, 1.0)
    return found


def _dots(a: Floats, b: Floats) -> Floats:
    found: Floats = np.einsum("kj,kj->k", a, b)
    return found
