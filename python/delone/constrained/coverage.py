"""Which polygon contains each region.

Crossing an odd number of a polygon's rings switches between its inside and its outside: the core
traverses the regions between segments, without using coordinates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from delone._base.types import Indices, Rows
    from delone._core import ConstrainedTriangulation

__all__ = ["beside", "containing", "odd_pairs"]


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
