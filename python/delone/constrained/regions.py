"""Regions between segments: which are outside, which are holes, and their numbers and labels.

A region is a connected component of triangles that share edges other than segments; the core finds
these components. Everything here is arithmetic on their numbers. `Tiling` contains all triangles of
the convex hull. Exact predicates decide whether a seed lies on a segment.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices

__all__ = [
    "Tiling",
    "corners",
    "crossed",
    "labels",
    "located",
    "on_edges",
    "outside",
]


class Tiling(NamedTuple):
    """All triangles of the convex hull, including removed ones."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    constrained: Bools


def outside(tiling: Tiling, component: Indices) -> Bools:
    """Return which components can be reached from outside the hull without crossing segments."""
    found = np.zeros(int(component.max(initial=-1)) + 1, dtype=bool)
    open_to = ((tiling.neighbors < 0) & ~tiling.constrained).any(axis=1)
    found[component[open_to]] = True
    return found


def located(
    tiling: Tiling, seeds: Floats, segments: Indices, workers: int
) -> tuple[Indices, Bools]:
    """Return the triangle that contains each seed, -1 outside, and whether it lies on a segment.

    Segments include their ends.
    """
    points, simplices, neighbors, constrained = tiling
    if not len(seeds):
        # This avoids a check of all triangles.
        return np.empty(0, dtype=np.int32), np.empty(0, dtype=bool)
    triangle = _core.find_simplex2(points, simplices, neighbors, seeds, workers)
    on_edge = on_edges(tiling, triangle, seeds)
    on_segment: Bools = np.any(on_edge & constrained[triangle], axis=1)
    rows, corner = corners(on_edge)
    has_segment = np.zeros(len(points), dtype=bool)
    has_segment[segments] = True
    on_segment[rows] = has_segment[simplices[triangle[rows], corner]]
    on_segment[triangle < 0] = False
    return triangle, on_segment


def on_edges(tiling: Tiling, triangle: Indices, queries: Floats) -> Bools:
    """Return on which edges of their triangles points lie, (k, 3); arbitrary for triangle -1."""
    points, simplices = tiling.points, tiling.simplices
    found = np.empty((len(queries), 3), dtype=bool)
    for k in range(3):
        tail, head = simplices[triangle, k - 2], simplices[triangle, k - 1]
        found[:, k] = _core.orient2d(points[tail], points[head], queries) == 0
    return found


def corners(on_edge: Bools) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows that lie on two edges, and the common corner of these."""
    rows = np.flatnonzero(on_edge.sum(axis=1) == 2)
    return rows, np.argmin(on_edge[rows], axis=1)


def labels(component: Indices, of_seed: Indices, given: Indices) -> tuple[Indices, Indices]:
    """Label triangles with the label of the first seed in their component, -1 without one.

    `of_seed` is -1 for seeds outside. The second result, (r, 2), contains the seeds whose component
    already has a label, and the seed that this label is from.
    """
    seeds = np.flatnonzero(of_seed >= 0).astype(np.int32)
    first = np.full(int(component.max(initial=-1)) + 1, -1, dtype=np.int32)
    # If an index is repeated, the last value assigned remains.
    first[of_seed[seeds[::-1]]] = seeds[::-1]
    label = np.full(len(first), -1, dtype=np.int32)
    label[first >= 0] = given[first[first >= 0]]
    later = seeds[first[of_seed[seeds]] != seeds]
    return label[component], np.column_stack((later, first[of_seed[later]]))


def crossed(tiling: Tiling, along: Indices, a: Floats, b: Floats) -> Indices:
    """Return the subsegments that a straight line crosses, (c, 2), in order.

    `along` are the triangles that the line meets, in order.
    """
    corner = np.tile(np.arange(3), len(along))
    triangle = np.repeat(along, 3)
    tail, head = (tiling.simplices[triangle, (corner + i) % 3] for i in (1, 2))
    u, v = tiling.points[tail], tiling.points[head]
    start, end = np.broadcast_to(a, u.shape).copy(), np.broadcast_to(b, u.shape).copy()
    of_a, of_b = _core.orient2d(u, v, start), _core.orient2d(u, v, end)
    sides = _core.orient2d(start, end, u) * _core.orient2d(start, end, v)
    proper = (sides < 0) & (of_a * of_b < 0) & tiling.constrained[triangle, corner]
    # The line leaves a triangle through an edge beyond which it ends. It enters through edges by
    # which it left the previous triangle, except where it enters the hull.
    leaves = proper & (of_b < 0)
    enters = proper & (of_a < 0) & (tiling.neighbors[triangle, corner] < 0)
    rows = np.concatenate((np.flatnonzero(enters), np.flatnonzero(leaves)))
    return np.column_stack((tail[rows], head[rows]))
