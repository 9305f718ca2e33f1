"""Which polygon contains each region.

Crossing an odd number of a polygon's rings switches between its inside and its outside. So one
traversal of the regions between segments, from the outside in, finds the polygons that contain each
region, without using coordinates: crossings and overlaps of rings are subsegments by then, and
rings that rounding has bent are still closed.
"""

from __future__ import annotations

from collections import defaultdict, deque
from typing import TYPE_CHECKING

import numpy as np

from delone.plane.topology import edge_keys

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._core import ConstrainedTriangulation

    Bools = NDArray[np.bool_]
    Indices = NDArray[np.int32]
    Rows = NDArray[np.int64]

__all__ = ["closed_rings", "containing", "first_polygon", "odd_pairs"]


def closed_rings(ends: Indices, geometries: Indices, rings: Bools) -> Bools:
    """Return which rows of segments, of those created as sides of `rings`, form closed rings.

    False for all sides of a geometry if an odd number of them meet at some vertex: then a side is
    missing, and the geometry has no inside. In `ends`, (s, 2), equal points have the same vertex.
    """
    if not rings.any():
        return rings
    count = int(ends.max()) + 1
    keys = geometries[rings, None].astype(np.int64) * count + ends[rings]
    vertices, sides = np.unique(keys, return_counts=True)
    is_open = np.zeros(int(geometries.max()) + 1, dtype=bool)
    is_open[vertices[sides % 2 == 1] // count] = True
    closed: Bools = rings & ~is_open[geometries]
    return closed


def first_polygon(
    made: ConstrainedTriangulation,
    npoints: int,
    geometries: Indices,
    component: Indices,
    sides: Bools,
) -> Indices:
    """Return the first geometry whose rings contain each component (even-odd rule), or -1.

    `geometries` has the geometry of each row of segments, `sides` those of closed rings. Takes O(m
    log m), plus for each component time in proportion to the polygons that overlap in it.
    """
    polygons = np.where(sides, geometries, -1)
    found = containing(made, npoints, polygons, component)
    return np.array([min(each, default=-1) for each in found], dtype=np.int32)


def containing(
    made: ConstrainedTriangulation, npoints: int, polygons: Indices, component: Indices
) -> list[frozenset[int]]:
    """Return the polygons that contain each component."""
    count = int(component.max(initial=-1)) + 1
    walls = _walls(made, npoints, component, count)
    crossed = _polygons_of_subsegments(made, polygons)
    beyond: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for one, other, subsegment in walls.tolist():
        beyond[one].append((other, subsegment))
        beyond[other].append((one, subsegment))
    nothing: frozenset[int] = frozenset()
    found = {count: nothing}
    queue = deque(found)
    # Each component enters the queue once.
    while queue:
        here = queue.popleft()
        for there, subsegment in beyond[here]:
            if there not in found:
                found[there] = found[here] ^ crossed.get(subsegment, nothing)
                queue.append(there)
    return [found[c] for c in range(count)]


def odd_pairs(start: Rows, source: Indices, polygons: Indices) -> Rows:
    """Return pairs of a subsegment and a polygon of which an odd number of sides cover it, (k, 2).

    The sources are compressed rows, as `segment_source` has them.
    """
    of = polygons[source].astype(np.int64)
    subsegment = np.repeat(np.arange(len(start) - 1), np.diff(start))
    pairs = np.column_stack((subsegment, of))[of >= 0]
    distinct, number = np.unique(pairs, axis=0, return_counts=True)
    found: Rows = distinct[number % 2 == 1]
    return found


def _polygons_of_subsegments(
    made: ConstrainedTriangulation, polygons: Indices
) -> dict[int, frozenset[int]]:
    """Return the polygons that cover subsegments with an odd number of sides."""
    crossed: dict[int, frozenset[int]] = {}
    for subsegment, polygon in odd_pairs(made.source_start, made.source, polygons).tolist():
        crossed[subsegment] = crossed.get(subsegment, frozenset()) | {polygon}
    return crossed


def _walls(made: ConstrainedTriangulation, npoints: int, component: Indices, outside: int) -> Rows:
    """Return each pair of adjacent components once, with a subsegment between them."""
    simplices, neighbors, constrained = made.simplices, made.neighbors, made.constrained
    triangle, corner = np.nonzero(constrained)
    # An edge of the hull separates from the outside, whether it is a subsegment or not.
    rim = component[np.nonzero((neighbors < 0) & ~constrained)[0]]
    other = neighbors[triangle, corner]
    tail, head = (simplices[triangle, (corner + i) % 3] for i in (1, 2))
    keys = edge_keys(made.segments[:, 0], made.segments[:, 1], npoints)
    order = np.argsort(keys)
    subsegment = order[np.searchsorted(keys[order], edge_keys(tail, head, npoints))]
    there = np.where(other < 0, outside, component[other])
    here = component[triangle]
    low = np.concatenate((np.minimum(here, there), rim))
    high = np.concatenate((np.maximum(here, there), np.full(len(rim), outside)))
    subsegment = np.concatenate((subsegment, np.full(len(rim), -1)))
    _, first = np.unique(low.astype(np.int64) * (outside + 1) + high, return_index=True)
    walls = np.column_stack((low, high, subsegment))[first]
    between: Rows = walls[walls[:, 0] != walls[:, 1]]
    return between
