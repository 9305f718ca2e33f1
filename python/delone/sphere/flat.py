"""Polygons on the sphere as polygons on a map of longitudes and latitudes.

Sides are arcs of great circles, which a map shows as chains of short lines. Exact signs decide
whether an arc goes east or west or through a pole, and on which side of the date line it ends. A
ring that surrounds a pole is completed along the edge of the map, and polygons that cross the date
line are cut there, so each result is valid in the plane.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.predicates import orient2d
from delone.sphere.coordinates import lonlat_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats

__all__ = ["flat_polygon"]

_CENTER = (0.0, 0.0)


# In degrees: more than the rounding error of a longitude that was shifted by some turns.
_SEAM = 1e-9


def flat_polygon(rings: Sequence[Floats], step: float) -> Any:
    """Return the area to the left of all rings of unit vectors as shapely polygons in degrees.

    Pieces of arcs are at most `step` degrees long.
    """
    shapely = require("shapely", extra="geo", what="polygons of Voronoi cells")
    world = shapely.box(-180, -90, 180, 90)
    found = world
    for ring in rings:
        path, turns = _unrolled(ring, np.radians(step))
        inside = _wrapped(shapely, _closed(path, turns))
        # If no ring surrounds a pole, the left side is the inside of counter-clockwise paths.
        if turns == 0 and not shapely.is_ccw(shapely.linearrings(path)):
            inside = world.difference(inside)
        found = inside if found is world else found.intersection(inside)
    return found


def _unrolled(ring: Floats, step: float) -> tuple[Floats, int]:
    """Return continuous longitudes and latitudes of a closed ring, and its turns around the axis.

    The last place repeats the first, except for whole turns.
    """
    # A pole has no longitude to start from.
    ring = np.roll(ring, -int(ring[:, :2].any(axis=1).argmax()), axis=0)
    heads = np.roll(ring, -1, axis=0)
    lonlat = lonlat_of(ring)
    signs = orient2d(_CENTER, ring[:, :2], heads[:, :2]).tolist()
    path, at = [], float(lonlat[0, 0])
    # Each side appends its tail and the points along it, then continues from its head.
    for tail, head, sign, (_, lat), (east, _) in zip(
        ring, heads, signs, lonlat.tolist(), np.roll(lonlat, -1, axis=0).tolist(), strict=True
    ):
        path.append((at, lat))
        if sign != 0:
            inner = _between(tail, head, step)
            moved = at + _ahead(at, inner[:, 0], sign)
            path += zip(moved.tolist(), inner[:, 1].tolist(), strict=True)
            at += float(_ahead(at, np.array([east]), sign)[0])
            continue
        pole = _pole(tail, head)
        if pole is None:
            at += (east - at + 180.0) % 360.0 - 180.0
            continue
        # Continue along the edge of the map, inside on the left: westward at the north pole.
        if tail[:2].any():
            path.append((at, pole))
        if head[:2].any():
            at += (east - at) % 360.0 if pole < 0 else -((at - east) % 360.0)
            path.append((at, pole))
    turns = round((at - lonlat[0, 0]) / 360.0)
    path.append((float(lonlat[0, 0]) + 360.0 * turns, float(lonlat[0, 1])))
    return np.array(path), turns


def _ahead(at: float, longitudes: Floats, sign: int) -> Floats:
    """The difference of longitudes, less than half a turn in the direction that the sign says."""
    found = (longitudes - at + 180.0) % 360.0 - 180.0
    # Rounding can have chosen the wrong direction only near half a turn.
    return np.where(sign * found < -90.0, found + sign * 360.0, found)


def _pole(tail: Floats, head: Floats) -> float | None:
    """The latitude of the pole on an arc of a meridian; None if there is none."""
    ends = [end for end in (tail, head) if not end[:2].any()]
    if ends:
        return float(np.copysign(90.0, ends[0][2]))
    if np.dot(tail[:2], head[:2]) > 0:
        return None
    return float(np.copysign(90.0, tail[2] + head[2]))


def _between(tail: Floats, head: Floats, step: float) -> Floats:
    """Longitudes and latitudes of places on an arc, without its ends."""
    angle = 2 * np.arcsin(min(float(np.linalg.norm(tail - head)) / 2, 1.0))
    pieces = max(1, int(np.ceil(angle / step)))
    share = np.arange(1, pieces)[:, None] / pieces
    return lonlat_of(np.sin((1 - share) * angle) * tail + np.sin(share * angle) * head)


def _closed(path: Floats, turns: int) -> Floats:
    """The path, completed along the edge of the map if it surrounds a pole."""
    if turns == 0:
        return path
    pole = 90.0 if turns > 0 else -90.0
    return np.vstack([path, (path[-1, 0], pole), (path[0, 0], pole), path[0]])


def _moved(places: Floats, turn: int, seam: float) -> Floats:
    """Move points west by some turns, and those where a path was opened to exactly the same place.

    Otherwise, rounding would leave a gap that the union of the parts does not close.
    """
    found = places - (360.0 * turn, 0.0)
    near = np.abs(found[:, 0] - seam) < _SEAM
    found[near, 0] = seam
    return found


def _wrapped(shapely: Any, path: Floats) -> Any:
    """The inside of a path as polygons with longitudes from -180 to 180."""
    whole = shapely.make_valid(shapely.Polygon(path))
    low, high = (
        int(np.floor((bound + 180) / 360)) for bound in (path[:, 0].min(), path[:, 0].max())
    )
    parts = []
    for turn in range(low, high + 1):
        west = 360.0 * turn - 180.0
        part = shapely.intersection(whole, shapely.box(west, -90, west + 360, 90))
        parts.append(shapely.transform(part, lambda xy, turn=turn: _moved(xy, turn, path[0, 0])))
    # Keep polygons only: cuts may leave lines and points.
    areas = [each for part in parts for each in shapely.get_parts(part) if each.area > 0]
    return shapely.union_all(areas) if len(areas) != 1 else areas[0]
