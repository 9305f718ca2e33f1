"""The furthest-site Delaunay triangulation: the upper side of the lifted points' hull.

Its triangles are those whose circles contain all points. Their corners are the extreme points, so
it is a triangulation of a convex polygon. If vertices are inserted in random order, each insertion
changes a constant expected number of triangles (L. P. Chew, "Building Voronoi diagrams for convex
polygons in linear expected time", 1990; here on the other side of the hull). Ties are broken by the
same infinitesimals as in the rest of the package, so the result is unique.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.predicates import incircle, orient2d

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows

__all__ = ["furthest_site"]


def furthest_site(points: Floats, hull: Rows) -> NDArray[np.int32]:
    """The triangles, (m, 3), whose circles contain all points: ascending, smallest row first.

    `hull` is counter-clockwise, and may include vertices inside sides. Expected time O(h): the
    order of insertion is random, with a fixed seed on which the result does not depend.
    """
    corners = points[hull]
    turns = orient2d(np.roll(corners, 1, axis=0), corners, np.roll(corners, -1, axis=0))
    polygon = hull[turns > 0]
    triangles = _Polygon(points[polygon]).triangles()
    rows = polygon[np.array(triangles)]
    start = rows.argmin(axis=1)[:, None]
    rows = np.take_along_axis(rows, (start + np.arange(3)) % 3, axis=1)
    return rows[np.lexsort(rows.T[::-1])].astype(np.int32)


class _Polygon:
    """A strictly convex polygon, triangulated one vertex at a time."""

    def __init__(self, corners: Floats) -> None:
        self.corners = corners
        # The vertex that completes a triangle to the left of a directed edge.
        self.apex: dict[tuple[int, int], int] = {}

    def triangles(self) -> list[tuple[int, int, int]]:
        n = len(self.corners)
        order = np.random.default_rng(n).permutation(n).tolist()
        between = _neighbors_at_removal(order)
        a, b, c = sorted(order[:3])
        self._add(a, b, c)
        for vertex, (before, after) in zip(order[3:], between, strict=True):
            self._insert(vertex, before, after)
        # Each triangle is found from its three edges; its smallest vertex is the start of one.
        return [(u, v, w) for (u, v), w in self.apex.items() if u < v and u < w]

    def _insert(self, vertex: int, before: int, after: int) -> None:
        """Add a vertex outside the polygon's edge before-after.

        Triangles whose circle does not contain it are removed. They are connected across that edge,
        and their area is visible from the vertex because the polygon is convex.
        """
        edges = [(before, after)]
        while edges:  # Terminates: each round removes a triangle or completes an edge
            u, v = edges.pop()
            w = self.apex.get((u, v))
            if w is not None and self._is_outside((u, v, w), vertex):
                for edge in ((u, v), (v, w), (w, u)):
                    del self.apex[edge]
                edges += [(u, w), (w, v)]
            else:
                self._add(u, vertex, v)

    def _is_outside(self, triangle: tuple[int, int, int], vertex: int) -> bool:
        a, b, c = (self.corners[i] for i in triangle)
        return bool(incircle(a, b, c, self.corners[vertex], ties="canonical") < 0)

    def _add(self, a: int, b: int, c: int) -> None:
        self.apex[a, b] = c
        self.apex[b, c] = a
        self.apex[c, a] = b


def _neighbors_at_removal(order: list[int]) -> list[tuple[int, int]]:
    """For each vertex from the fourth on, its neighbors among the earlier vertices.

    Found by removing the vertices from a ring in reverse order.
    """
    n = len(order)
    before = [(i - 1) % n for i in range(n)]
    after = [(i + 1) % n for i in range(n)]
    found = []
    for vertex in reversed(order[3:]):
        u, v = before[vertex], after[vertex]
        found.append((u, v))
        after[u], before[v] = v, u
    return found[::-1]
