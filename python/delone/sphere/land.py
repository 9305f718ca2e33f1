"""Which polygon contains each region of the sphere.

Crossing an odd number of a polygon's rings switches between its inside and its outside, as in the
plane. But a sphere has no region that is outside everything: the direction of the outer rings,
or the smaller area, determines which of the two sides is inside.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone._base.counting import agreed, counted
from delone._base.georeference import caller_level
from delone._tiling.plane import topology
from delone.constrained.coverage import beside, containing
from delone.errors import InputError
from delone.sphere.sides import Origin, PolygonWarning

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Indices, Rows
    from delone._core import ConstrainedTriangulation

__all__ = ["Origin", "Rings", "first_polygon"]


# Sums of rounded areas, in steradians, count as half of the sphere within this.
_HALF = 1e-9


class Rings(NamedTuple):
    """The rings of polygons."""

    origin: Origin
    # (s, 2): the vertices of the rows of segments.
    ends: Indices
    # The inside is left ("ccw") or right ("cw") of outer rings, or the "smaller" side.
    winding: str


def first_polygon(
    made: ConstrainedTriangulation,
    areas: Floats,
    component: Indices,
    rings: Rings,
    *,
    warn: bool = True,
) -> Indices:
    """Return the first geometry whose rings contain each component (even-odd rule), or -1.

    Takes linear time, plus time proportional to the number of overlapping polygons in each
    component.
    """
    origin, ends, winding = rings
    count = int(component.max(initial=-1)) + 1
    polygons = np.where(origin.rings, origin.geometries, np.int32(-1))
    polygons = _core.closed_polygons(ends, polygons)
    closed = polygons >= 0
    if not closed.any():
        return np.full(count, -1, dtype=np.int32)
    sides = beside(made, component)
    # The last component is the part that no triangle covers.
    inside = containing(made, polygons, component, from_outside=False)
    size: Floats = np.bincount(component, weights=areas, minlength=count + 1).astype(np.float64)
    size[count] = max(4 * math.pi - float(areas.sum()), 0.0)
    outer = _outer(made, origin, closed)
    if winding == "smaller":
        area = _areas(inside, size, int(origin.geometries.max()) + 1)
        half = np.abs(area - 2 * math.pi) < _HALF
        large = (area > 2 * math.pi) & ~half
        turned = np.union1d(
            np.flatnonzero(large),
            _turned(inside, sides, outer[half[outer[:, 1]]], "ccw"),
        )
        inside = _toggled(inside, turned, count)
    else:
        inside = _toggled(inside, _turned(inside, sides, outer, winding), count)
        if warn:
            _warn_of_large(_areas(inside, size))
    # If an index is repeated, the last value assigned remains.
    first = np.full(count + 1, -1, dtype=np.int32)
    order = np.argsort(-inside[:, 1], kind="stable")
    first[inside[order, 0]] = inside[order, 1]
    return first[:count]


def _toggled(inside: Indices, turned: Rows, count: int) -> Indices:
    """Return the pairs after swapping the inside and the outside of some geometries.

    For each geometry, components ascend.
    """
    if not len(turned):
        return inside
    stays = ~np.isin(inside[:, 1], turned)
    component, geometry = inside[~stays].T
    outside = np.ones((len(turned), count + 1), dtype=bool)
    outside[np.searchsorted(turned, geometry), component] = False
    row, component = np.nonzero(outside)
    entered = np.column_stack((component, turned[row])).astype(np.int32)
    return np.concatenate((inside[stays], entered))


def _outer(made: ConstrainedTriangulation, origin: Origin, closed: Bools) -> Rows:
    """Return subsegments that an outer ring covers once, with its geometry and direction."""
    count = np.diff(made.source_start)
    row = np.repeat(np.arange(len(count)), count)
    wanted = np.flatnonzero(closed[made.source] & origin.outer[made.source])
    geometry = origin.geometries[made.source[wanted]].astype(np.int64)
    # A side that occurs twice, such as a cut along the date line, does not count.
    keys = row[wanted] * (int(geometry.max(initial=0)) + 1) + geometry
    _, first, times = np.unique(keys, return_index=True, return_counts=True)
    at = wanted[first[times == 1]]
    return np.column_stack((row[at], origin.geometries[made.source[at]], made.forward[at]))


def _turned(inside: Indices, sides: Indices, outer: Rows, winding: str) -> Rows:
    """Return the geometries, ascending, whose outside is marked as their inside in `inside`.

    The majority of the sides decides, because a border that crosses itself has loops in the other
    direction.
    """
    row, geometry, forward = outer.T
    within = np.where((forward != 0) == (winding == "ccw"), sides[row, 0], sides[row, 1])
    count = int(geometry.max(initial=-1)) + 1
    here = topology.among(within * np.int64(count) + geometry, _keys(inside, count))
    votes = np.bincount(geometry, minlength=count) - 2 * np.bincount(
        geometry[here], minlength=count
    )
    is_known = np.bincount(geometry, minlength=count) > 0
    torn = np.flatnonzero(is_known & (votes == 0)).tolist()
    if torn:
        first = ", ".join(map(str, torn[:10]))
        raise InputError(
            f"outer rings of {len(torn)} {agreed(len(torn), 'geometry', 'geometries')} run in both "
            f'directions, first {first}: turn rings, or pass winding="smaller"'
        )
    return np.flatnonzero(votes > 0).astype(np.int64)


def _keys(inside: Indices, count: int) -> Rows:
    """Return a unique number for each pair of a component and a geometry below `count`."""
    component, geometry = inside[inside[:, 1] < count].T.astype(np.int64)
    keys: Rows = component * count + geometry
    return keys


def _areas(inside: Indices, size: Floats, count: int = 0) -> Floats:
    """Return the rounded area of each geometry, for at least `count` of them."""
    component, geometry = inside.T
    return np.bincount(geometry, weights=size[component], minlength=count).astype(np.float64)


def _warn_of_large(area: Floats) -> None:
    """Warn about geometries that are larger than half of the sphere because of their winding."""
    large = np.flatnonzero(area > 2 * math.pi + _HALF).tolist()
    if large:
        share = area[large[0]] / (4 * math.pi)
        warnings.warn(
            f"{counted(len(large), 'geometry')} "
            f"{agreed(len(large), 'covers', 'cover')} more than half of the sphere, first "
            f"{large[0]} with {share:.1%}: do its outer rings run the other way? "
            'winding="smaller" takes the smaller side',
            PolygonWarning,
            stacklevel=caller_level(),
        )
