"""Volumes and profiles of a tiled triangulation."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._tiling.plane.geometry import shares, summed
from delone.distributed.read.folder import TileFolder
from delone.distributed.read.parts import gathered, sheet_of, surface_of
from delone.distributed.read.tasks import mapped
from delone.predicates import orient2d
from delone.terrain.lines import line_of
from delone.terrain.profiles import Profile
from delone.terrain.volumes import (
    Volume,
    goal_of,
    refuse_overflow,
    require_same_crs,
    wanted_region,
    warn_of_nothing,
)

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats
    from delone.distributed.read.tile import Tile

__all__ = ["profile", "volume"]


class _Side:
    """What `goal_of` needs from a surface: its reference system and units."""

    def __init__(self, crs: str | None) -> None:
        self.crs, self.units = crs, None


def volume(tin: TileFolder, other: Any, region: Any, value: str, executor: Any) -> Volume:
    """Return the volume between all tiles and a height, a plane, a surface, or other tiles."""
    tin._require(value)
    goal: Any
    if isinstance(other, TileFolder):
        other._require("z")
        require_same_crs(tin.crs, other.crs)
        goal = str(other.path)
    else:
        goal = goal_of(_Side(tin.crs), other)  # type: ignore[arg-type]
    within = wanted_region(region, tin.crs)
    tasks = [(str(tin.path), value, number, goal, within) for number in range(tin.ntiles)]
    parts: list[list[float]] = [[] for _ in range(5)]
    of_tiles = np.zeros((tin.ntiles, 5))
    # Sums are rounded once, at the end, whatever the tiles are.
    for number, found in enumerate(mapped(executor, _volume, tasks)):
        for k, some in enumerate(found):
            parts[k] += some
            of_tiles[number, k] = summed(some)
    if not of_tiles[:, 4].any():
        warn_of_nothing(region)
    cut, fill, cut_area, fill_area, area = map(summed, parts)
    refuse_overflow(np.array(cut), np.array(fill))
    return Volume(
        cut=cut,
        fill=fill,
        cut_area=cut_area,
        fill_area=fill_area,
        area=area,
        of_triangles=of_tiles,
        units=None,
        crs=tin.crs,
    )


def _volume(path: str, value: str, number: int, goal: Any, region: Any) -> list[list[float]]:
    """Return numbers whose sums are the volumes and areas of a tile."""
    tin = TileFolder._at(path)
    sheet = sheet_of(tin.tile(number), value)
    found: list[list[float]] = [[] for _ in range(5)]
    if not len(sheet.simplices):
        return found
    goals = [goal]
    if isinstance(goal, str):
        others = TileFolder._at(goal)
        near = _near(others, tin.manifest["tiles"][number]["extent"])
        goals = [(sheet_of(others.tile(k), "z"), [0.0, 0.0, 0.0]) for k in near]
    for surface, plane in goals:
        columns = _core.volumes2(sheet, surface, plane, region, as_workers(None))
        for k, column in enumerate(columns):
            found[k] += shares(column[column != 0])
    return found


def _near(tin: TileFolder, extent: list[float]) -> list[int]:
    """The tiles whose triangles may meet a box."""
    low, high = np.array(extent[:2]), np.array(extent[2:])
    boxes = ((k, tile["extent"]) for k, tile in enumerate(tin.manifest["tiles"]))
    return [
        k
        for k, box in boxes
        if box is not None and (box[:2] <= high).all() and (low <= box[2:]).all()
    ]


def profile(tin: TileFolder, line: Any, value: str) -> Profile:
    """Return the heights along a line, which needs only the triangles along it."""
    tin._require(value)
    points = line_of(line, name="line", crs=tin.crs)
    low, high = points.min(axis=0).tolist(), points.max(axis=0).tolist()

    def choose(tile: Tile) -> Bools:
        corners = tile.points[tile.simplices]
        found = np.zeros(len(corners), dtype=bool)
        if not len(corners):
            return found
        least, most = corners.min(axis=1), corners.max(axis=1)
        for a, b in pairwise(points):
            beside = (most >= np.minimum(a, b)) & (least <= np.maximum(a, b))
            some = np.flatnonzero(beside.all(axis=1) & ~found)
            found[some] = _met(corners[some], a, b)
        return found

    patch = gathered(tin, value, _near(tin, [*low, *high]), choose)
    if not len(patch.simplices):
        return Profile(distances=np.empty(0), z=np.empty(0), points=np.empty((0, 2)))
    return surface_of(patch, tin.crs).profile(points)


def _met(corners: Floats, a: Floats, b: Floats) -> Bools:
    """Which triangles have corners on both sides of the line through a and b, or on it."""
    flat = corners.reshape(-1, 2)
    start, end = (np.broadcast_to(each, flat.shape).copy() for each in (a, b))
    side = np.asarray(orient2d(start, end, np.ascontiguousarray(flat))).reshape(-1, 3)
    return np.asarray(~((side > 0).all(axis=1) | (side < 0).all(axis=1)))
