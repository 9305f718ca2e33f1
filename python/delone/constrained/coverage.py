"""Which polygon contains each region.

Crossing an odd number of a polygon's rings switches between its inside and its outside: the core
traverses the regions between segments, without using coordinates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from delone._base.types import Bools, Indices, Rows
    from delone._core import ConstrainedTriangulation

__all__ = ["beside", "closed_rings", "containing", "first_polygons", "odd_pairs"]


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


def first_polygons(
    made: ConstrainedTriangulation, geometries: Indices, sides: Bools
) -> tuple[Indices, Indices]:
    """Return the component of each triangle, and the first geometry that contains each component.

    The geometry is -1 if there is none. Rings contain what they wind around an odd number of times.
    `geometries` has the geometry of each row of segments; `sides` marks the rows of closed rings.
    """
    covers = made.source_start, made.source, np.where(sides, geometries, np.int32(-1))
    component, pairs = _core.components_in_polygons2(
        made.simplices, made.neighbors, made.constrained, made.segments, covers
    )
    inside, polygon = pairs.T
    found = np.full(int(component.max(initial=-1)) + 1, -1, dtype=np.int32)
    # If an index is repeated, the last value assigned remains.
    found[inside[::-1]] = polygon[::-1]
    return component, found


def containing(
    made: ConstrainedTriangulation,
    polygons: Indices,
    component: Indices,
    *,
    from_outside: bool = True,
) -> Indices:
    """Return pairs of a component and a polygon that contains it, (k, 2), ascending.

    The area that no triangle covers is an additional component, the last, and in no polygon;
    otherwise, it is the first component. This takes linear time, plus time proportional to the
    number of polygons that overlap in each component.
    """
    first = int(component.max(initial=-1)) + 1 if from_outside else 0
    parts = made.simplices, made.neighbors, made.constrained, component, made.segments
    covers = made.source_start, made.source, np.ascontiguousarray(polygons, np.int32)
    return _core.components_inside2(parts, covers, first)


def beside(made: ConstrainedTriangulation, component: Indices) -> Indices:
    """Return the components to the left and right of each subsegment, (q, 2)."""
    parts = made.simplices, made.neighbors, made.constrained, component, made.segments
    return _core.components_beside2(parts)


def odd_pairs(start: Rows, source: Indices, polygons: Indices) -> Indices:
    """Return pairs of a subsegment and a polygon with an odd number of sides that cover it, (k, 2).

    The sources are compressed rows, as in `segment_source`.
    """
    return _core.odd_pairs2((start, source, np.ascontiguousarray(polygons, np.int32)))
