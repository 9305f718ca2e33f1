"""Polygons in which a surface is level: lakes, ponds, basins.

The shore is a line of one height. Points inside it or on it are left out, so that nothing else
is there, and triangles between points of the shore are level.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.errors import BudgetExceededError, InputError
from delone.predicates import orient2d
from delone.terrain.extent import inside_of_rings, refuse_crossing_rings
from delone.terrain.lines import Ring, rings_by_feature
from delone.terrain.profiles import profile

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any

    from delone._base.types import Bools, Floats
    from delone.constrained.delaunay import ConstrainedDelaunay
    from delone.terrain.surface import Surface

__all__ = ["Level", "leveled", "require_level"]


# The maximum number of sides of a shore after division.
_MOST = 10_000_000


class Level(NamedTuple):
    """Level polygons: shores with heights, the height of each feature, and points outside."""

    shores: list[Ring]
    heights: Floats
    outside: Bools


def leveled(
    given: Any,
    points: Floats,
    crs: str | None,
    longest: float,
    surface_of: Callable[[Floats], Surface],
) -> Level:
    """Return the shores of level polygons with their heights, and which points are outside.

    A polygon without heights has the lowest height of its shore, on the surface of the points that
    are outside all polygons. Sides longer than `longest` are divided.
    """
    features = _numbered(rings_by_feature(given, name="level", crs=crs))
    features = [[_divided(ring, longest) for ring in rings] for rings in features]
    shores = [ring for rings in features for ring in rings]
    if not shores:
        raise InputError("level has no polygon or ring")
    refuse_crossing_rings("polygons of level", shores)
    mesh, within = inside_of_rings(shores)
    outside = ~_covered(mesh, within, np.ascontiguousarray(points[:, :2]))
    ground: Surface | None = None
    heights = np.full(len(features), np.nan)
    found: list[Ring] = []
    for row, rings in enumerate(features):
        if not rings:
            continue
        own = _own_height(rings, row)
        if own is None:
            if ground is None:
                ground = surface_of(points[outside])
            own = _shore_height(rings, row, ground)
        heights[row] = own
        for ring in rings:
            table = ring.points.copy()
            table[:, 2] = own
            found.append(ring._replace(points=table))
    return Level(found, heights, outside)


def _numbered(features: list[list[Ring]]) -> list[list[Ring]]:
    """Return the rings, numbered so that no two features share a polygon number."""
    count, found = 0, []
    for rings in features:
        own = {polygon: count + k for k, polygon in enumerate({ring.polygon for ring in rings})}
        count += len(own)
        found.append([ring._replace(polygon=own[ring.polygon]) for ring in rings])
    return found


def _divided(ring: Ring, longest: float) -> Ring:
    """Return a ring without sides that are longer than a length."""
    if longest == np.inf:
        return ring
    way = np.diff(ring.points, axis=0)
    count = np.maximum(1, np.ceil(np.hypot(way[:, 0], way[:, 1]) / longest)).astype(np.int64)
    if count.sum() > _MOST:
        raise BudgetExceededError(
            f"the shores of level polygons are {count.sum():.3g} times as long as half of max_edge",
            limit=_MOST,
            found=int(count.sum()),
        )
    side = np.repeat(np.arange(len(way)), count)
    share = (np.arange(len(side)) - np.repeat(np.cumsum(count) - count, count)) / count[side]
    found = ring.points[side] + share[:, None] * way[side]
    # The points of a side of constant height have that height.
    found[:, 2] = np.where(way[side, 2] == 0, ring.points[side, 2], found[:, 2])
    return ring._replace(points=np.vstack((found, ring.points[-1:])))


def _covered(mesh: ConstrainedDelaunay, within: Bools, places: Floats) -> Bools:
    """Return which places are inside polygons or on their sides, exactly."""
    triangle = mesh.find_simplex(places)
    found = (triangle >= 0) & within[triangle]
    # For a place on a side or corner, the triangle found may be the one outside.
    rest = np.flatnonzero((triangle >= 0) & ~found)
    corners, beside = mesh.simplices[triangle[rest]], mesh.neighbors[triangle[rest]]
    shore = np.zeros(mesh.npoints, dtype=bool)
    shore[mesh.simplices[within]] = True
    for k in range(3):
        at = mesh.points[corners[:, k]]
        found[rest] |= shore[corners[:, k]] & (at == places[rest]).all(axis=1)
        a, b = (mesh.points[corners[:, (k + each) % 3]] for each in (1, 2))
        side = (beside[:, k] >= 0) & within[beside[:, k]]
        found[rest] |= side & (orient2d(a, b, places[rest]) == 0)
    return found


def _own_height(rings: list[Ring], row: int) -> float | None:
    """Return the common height of the points of a polygon; None if they have none."""
    z = np.concatenate([ring.points[:, 2] for ring in rings])
    if np.isnan(z).all():
        return None
    if np.isnan(z).any() or z.min() != z.max():
        low, high = np.nanmin(z), np.nanmax(z)
        rest = ", and points without a height" if np.isnan(z).any() else ""
        raise InputError(
            f"level, feature {row}: a level polygon has one height, and this one has heights from "
            f"{low:.10g} to {high:.10g}{rest}: give all of its points one height, or none"
        )
    return float(z[0])


def _shore_height(rings: list[Ring], row: int, ground: Surface) -> float:
    """Return the lowest height of the ground along the sides of a polygon."""
    lowest = [
        np.nanmin(z, initial=np.inf)
        for z in (profile(ground, np.ascontiguousarray(ring.points[:, :2])).z for ring in rings)
    ]
    found = float(min(lowest))
    if not np.isfinite(found):
        x, y = rings[0].points[0, :2].tolist()
        raise InputError(
            f"level, feature {row}: no part of its shore is on the surface of the points, first "
            f"({x:.10g}, {y:.10g}): give its points the height"
        )
    return found


def require_level(
    mesh: ConstrainedDelaunay, z: Floats, lakes: Bools, kept: Bools, heights: Floats
) -> None:
    """Reject lines with other heights inside level polygons."""
    corners = mesh.simplices[lakes & kept]
    bad = np.flatnonzero((z[corners] != z[corners[:, :1]]).any(axis=1))
    if not len(bad):
        return
    rows = np.unique(corners[bad])
    # If a point has the height of no level polygon, name it.
    other = rows[~np.isin(z[rows], heights)]
    row = int(other[0] if len(other) else rows[0])
    x, y = mesh.points[row].tolist()
    raise InputError(
        f"a line inside a level polygon has a different height at ({x:.10g}, {y:.10g}): "
        f"{z[row]:.10g}; leave it out there, or leave out its heights"
    )
