"""Triangulation of 3-D polygons, with their corners as the only vertices.

A polygon is triangulated in the plane of the two coordinates in which it is largest. Its corners
need not be exactly in one plane; triangles use them unchanged.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import DeloneError, FileFormatError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats

__all__ = ["facet_triangles", "normal_axis"]


def facet_triangles(
    points: Floats, polygons: Sequence[Sequence[int]], holes: Floats, source: str
) -> list[list[int]]:
    """Return the triangles of a facet, oriented as its first polygon.

    A facet consists of polygons, of which those with one or two corners are points and segments
    inside, and of seeds of holes, (k, 3).
    """
    first = polygons[0]
    if len(polygons) == 1 and len(first) == 3:
        return [list(first)]
    rows = np.array(list(dict.fromkeys(row for polygon in polygons for row in polygon)))
    number = {row: i for i, row in enumerate(rows.tolist())}
    segments = [
        (number[polygon[k - 1]], number[polygon[k]])
        for polygon in polygons
        if len(polygon) > 1
        for k in range(len(polygon) if len(polygon) > 2 else 1)
    ]
    axis, turned = normal_axis(points[list(first)])
    others = [k for k in range(3) if k != axis]
    flat = np.ascontiguousarray(points[rows][:, others])
    try:
        made = ConstrainedDelaunay(
            flat, segments, holes=np.ascontiguousarray(holes[:, others]), boundary="outline"
        )
    except DeloneError as error:
        raise FileFormatError(f"{source}: a facet cannot be triangulated: {error}") from error
    triangles = made.simplices[:, ::-1] if turned else made.simplices
    found: list[list[int]] = rows[triangles].tolist()
    return found


def normal_axis(corners: Floats) -> tuple[int, bool]:
    """Return the axis nearest to the normal of a polygon.

    Also return whether the polygon is clockwise in the other two coordinates, in their order.
    """
    with np.errstate(all="ignore"):
        offset = corners - corners[0]
        normal = np.cross(offset, np.roll(offset, -1, axis=0)).sum(axis=0)
    axis = int(np.argmax(np.abs(np.nan_to_num(normal))))
    # Without y, x and z are a left-handed pair.
    return axis, bool((normal[axis] < 0) ^ (axis == 1))
