"""Quantized mesh: terrain tiles for globes, in the levels of the EPSG:4326 tiling.

Coordinates in a tile are integers from 0 to 32767, horizontally and vertically. So points are first
moved onto this grid, and tiles are simplified on it. The error of a level is measured from the
original points, so rounding is part of it. A level is within the error that Cesium expects, which
halves with each level. Heights in all tiles of a level are multiples of one step, and sides of
tiles are simplified separately, so adjacent tiles have the same points on the side between them.

The format is quantized-mesh-1.0 (https://github.com/CesiumGS/quantized-mesh) with layer.json.
"""

from __future__ import annotations

import json
import math
import struct
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_number
from delone._base.atomic import replacing
from delone._base.counting import grouped
from delone._base.extras import require
from delone._base.thinning import thinned
from delone._base.units import METERS
from delone.errors import BudgetExceededError, InputError
from delone.io.tileset import placed

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows

__all__ = ["write_quantized_mesh"]

# Steps across a tile.
_STEPS = 32767
# The error in meters that Cesium expects of level 0: a quarter of the distance between heights, if
# each of two tiles around the equator has 65 of them (CesiumTerrainProvider).
_ERROR = 6378137 * 2 * math.pi * 0.25 / (65 * 2)
# At this level, a step across is 0.04 mm, and no error is promised beyond it.
_DEEPEST = 24
_MOST_TILES = 200_000
# Number of evenly spaced places along each side of a tile.
_SAMPLES = 65
# The corner of the first tile, in degrees.
_CORNER = np.array([-180.0, -90.0])
# The number of the extension with normals.
_NORMALS = 1
# Attempts to stay within the error of a level; each leaves less of it to simplification.
_ATTEMPTS = 6


def write_quantized_mesh(
    folder: str | os.PathLike[str],
    tin: Any,
    *,
    max_error: float,
    outside: float = 0.0,
    normals: bool = False,
) -> tuple[float, ...]:
    """Write a surface as quantized-mesh tiles with layer.json, for Cesium (extra ``globe``).

    Parameters
    ----------
    folder : str or path-like
        The folder of ``layer.json`` and ``z/x/y.terrain``. It is created if it does not exist;
        files with the same names are replaced.
    tin : TIN
        The surface, with a known reference system. Heights are in its `units`, or in meters if
        these are unknown. They are treated as heights above the ellipsoid: no geoid is applied.
    max_error : float
        The largest vertical distance in meters of a point from the finest level. It determines the
        number of levels: as Cesium expects, the error of level z is at most 77067 / 2^z meters.
    outside : float, optional
        The height, in meters, used at corners and sides of tiles beyond the surface.
    normals : bool, optional
        Whether to write a normal for each vertex (extension ``octvertexnormals``), with which
        viewers light the terrain.

    Returns
    -------
    tuple of float
        The error of each level in meters: the largest vertical distance of a point of the surface
        from the triangles as they are written, with all rounding.

    Raises
    ------
    InputError
        The reference system is unknown, or a point has no transformation to WGS 84; the surface
        crosses the 180th meridian; `max_error` is not above 0, or is too small for the finest
        level; or the surface is so steep that rounding of coordinates alone exceeds the error.
    BudgetExceededError
        A level would have more than 200,000 tiles.
    MissingExtraError
        pyproj or quantized-mesh-encoder is not installed.
    OutputError
        A file cannot be written.

    See Also
    --------
    write_tileset : The same surface as 3D Tiles, one file for each level.

    Notes
    -----
    Each tile is a new triangulation of points of the surface. Breaklines and outlines are not kept
    as edges, and gaps inside the hull, such as holes, are filled. Between the outline and the sides
    of a tile, triangles lead to the height `outside`. Adjacent tiles have the same points on the
    side between them, at exactly the same heights.
    A normal is the area-weighted sum of the normals of the triangles around the vertex, in all
    tiles of the level that share it, so no edge is visible between tiles. Each of its two numbers
    has 8 bits. ``layer.json`` is written last.

    Examples
    --------
    >>> import tempfile
    >>> import numpy as np
    >>> from delone.io import write_quantized_mesh
    >>> from delone.terrain import TIN
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.arange(33.0), np.arange(33.0)))
    >>> hill = np.column_stack((x + 155000, y + 463000, 9 - np.hypot(x - 16, y - 16) / 3))
    >>> tin = TIN.from_points(hill, crs="EPSG:28992", units="m")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     errors = write_quantized_mesh(folder, tin, max_error=0.5)
    >>> len(errors), errors[-1] <= 0.5
    (19, True)
    """
    deepest = _levels(max_error)
    height = as_number(outside, name="outside")
    if not np.isfinite(height):
        raise InputError(f"outside must be a height in meters, got {outside!r:.60}")
    require("quantized_mesh_encoder", extra="globe", what="writing quantized-mesh tiles")
    ground = _Ground(tin, height)
    target = Path(folder)
    target.mkdir(exist_ok=True)
    levels = [_Level(ground, zoom) for zoom in range(deepest + 1)]
    _require_few(levels)
    errors, available = [], []
    for level in levels:
        error, tiles = _within_error(level)
        light = _normals(level, tiles) if normals else {}
        for (x, y), tile in tiles.items():
            place = target / str(level.zoom) / str(x)
            place.mkdir(parents=True, exist_ok=True)
            with replacing(place / f"{y}.terrain") as temporary:
                temporary.write_bytes(tile.encoded(level, (x, y), light.get((x, y))))
        errors.append(error)
        available.append(_ranges(tiles))
    with replacing(target / "layer.json") as temporary:
        text = json.dumps(_document(ground, available, normals), indent=1, allow_nan=False) + "\n"
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return tuple(errors)


def _levels(max_error: Any) -> int:
    """Return the first level whose error is small enough."""
    error = as_number(max_error, name="max_error")
    if not 0 < error < math.inf:
        raise InputError(f"max_error must be a distance in meters above 0, got {max_error!r:.60}")
    deepest = max(0, math.ceil(math.log2(_ERROR / error)))
    if deepest > _DEEPEST:
        raise InputError(
            f"max_error={error:g} needs level {deepest}, but the finest is {_DEEPEST}: give at "
            f"least {_ERROR / 2**_DEEPEST:.2g}"
        )
    return deepest


class _Ground:
    """The points of a surface on the globe, and its heights elsewhere."""

    def __init__(self, tin: Any, outside: float) -> None:
        pyproj = require("pyproj", extra="globe", what="placing a surface on the globe")
        used = np.unique(tin.simplices)
        self.tin, self.outside, self.meters = tin, outside, METERS[tin.units or "m"]
        every, _ = placed(tin)
        self.degrees, self.z = every[used], tin.z[used] * self.meters
        self.corners = every[tin.simplices]
        self.low, self.high = self.degrees.min(axis=0), self.degrees.max(axis=0)
        if self.high[0] - self.low[0] > 180:
            raise InputError(
                "the surface crosses the 180th meridian: split it there, and write each part to a "
                "folder of its own"
            )
        self.back = pyproj.Transformer.from_crs("EPSG:4326", tin.crs, always_xy=True)

    def heights(self, degrees: Floats) -> Floats:
        """Return heights at longitudes and latitudes, with `outside` beyond the surface."""
        found = np.full(len(degrees), self.outside)
        near = np.flatnonzero(((degrees >= self.low) & (degrees <= self.high)).all(axis=1))
        if len(near):
            xy = np.column_stack(self.back.transform(*degrees[near].T))
            z = self.tin.heights(xy) * self.meters
            found[near] = np.where(np.isnan(z), self.outside, z)
        return found


class _Tile(NamedTuple):
    """The surface of a tile, a TIN: columns, rows and heights in steps."""

    surface: Any

    def places(self, level: _Level, tile: tuple[int, int]) -> Floats:
        """Return longitudes and latitudes in degrees and heights in meters, (n, 3)."""
        own = self.surface.xyz
        degrees = level.degrees(own[:, :2] + np.multiply(tile, _STEPS))
        return np.column_stack((degrees, own[:, 2] * level.step))

    def encoded(self, level: _Level, tile: tuple[int, int], normals: Floats | None) -> bytes:
        """Return the file; vertices are in the order in which triangles use them."""
        encode = require("quantized_mesh_encoder.encode", extra="globe", what="writing tiles")
        flat = self.surface.simplices.ravel()
        order = flat[np.sort(np.unique(flat, return_index=True)[1])]
        number = np.empty(self.surface.npoints, dtype=np.uint32)
        number[order] = np.arange(len(order), dtype=np.uint32)
        own = self.surface.xyz[order]
        low = own[:, 2].min()
        with np.errstate(divide="ignore", invalid="ignore"):
            header = encode.compute_header(self.places(level, tile)[order], "naive")
        _keep_in_sight(header)
        # All tiles of a level have the same steps of height.
        header["maximumHeight"] = (low + _STEPS) * level.step
        steps = (own - (0, 0, low)).astype(np.int16)
        with BytesIO() as file:
            encode.encode_header(file, header)
            encode.write_vertices(file, steps, len(steps))
            encode.write_indices(file, number[self.surface.simplices], len(steps))
            encode.write_edge_indices(file, steps, len(steps))
            if normals is not None:
                light = _octahedral(normals[order]).tobytes()
                file.write(struct.pack("<BI", _NORMALS, len(light)) + light)
            return file.getvalue()


def _keep_in_sight(header: dict[str, Any]) -> None:
    """Give a tile that is always visible, such as one of level 0, a point far above the horizon.

    Its coordinates are multiples of the radii of the earth.
    """
    names = [f"horizonOcclusionPoint{axis}" for axis in "XYZ"]
    if not np.isfinite([header[name] for name in names]).all():
        center = np.array([header[f"boundingSphereCenter{axis}"] for axis in "XYZ"])
        far = 1000 * center / max(float(np.linalg.norm(center)), 1.0)
        header.update(zip(names, far.tolist(), strict=True))


class _Level:
    """The grid of a level, the points of the surface on it, and its tiles."""

    def __init__(self, ground: _Ground, zoom: int) -> None:
        self.ground, self.zoom, self.error = ground, zoom, _ERROR / 2**zoom
        self.width = 180 / 2**zoom
        self.size = np.array([2 ** (zoom + 1), 2**zoom])
        grid = np.rint((ground.degrees - _CORNER) / self.width * _STEPS)
        self.grid = grid.astype(np.int64)
        self.tiles = self._tiles()
        self.step = 0.0

    def degrees(self, grid: Any) -> Floats:
        """Return longitudes and latitudes of columns and rows."""
        found: Floats = np.asarray(grid) * (self.width / _STEPS) + _CORNER
        return found

    def tile_of(self, degrees: Floats) -> Rows:
        """Return the tiles of longitudes and latitudes, (n, 2)."""
        found: Rows = np.floor((degrees - _CORNER) / self.width).astype(np.int64)
        return np.clip(found, 0, self.size - 1)

    def _tiles(self) -> list[tuple[int, int]]:
        """Return the tiles that the boxes of triangles meet; at level 0, both tiles."""
        corners = self.ground.corners
        low, high = self.tile_of(corners.min(axis=1)), self.tile_of(corners.max(axis=1))
        boxes = np.unique(np.column_stack((low, high)), axis=0)
        count = (boxes[:, 2:] - boxes[:, :2] + 1).prod(axis=1)
        if count.sum() > 10 * _MOST_TILES:
            self._refuse(int(count.sum()))
        box = np.repeat(np.arange(len(boxes)), count)
        place = np.arange(len(box)) - np.repeat(np.cumsum(count) - count, count)
        rows = (boxes[:, 3] - boxes[:, 1] + 1)[box]
        x, y = boxes[box, 0] + place // rows, boxes[box, 1] + place % rows
        # At level 0, both; at other levels, each tile once.
        keys = np.unique(x << 32 | y) if self.zoom else np.array([0, 1 << 32])
        return list(zip((keys >> 32).tolist(), (keys & 0xFFFFFFFF).tolist(), strict=True))

    def _refuse(self, found: int) -> None:
        raise BudgetExceededError(
            f"level {self.zoom} would have {grouped(found)} tiles, more than "
            f"{grouped(_MOST_TILES)}: give a larger max_error, or write parts of the surface",
            limit=_MOST_TILES,
            found=found,
        )


def _require_few(levels: Iterable[_Level]) -> None:
    for level in levels:
        if len(level.tiles) > _MOST_TILES:
            level._refuse(len(level.tiles))


class _Points(NamedTuple):
    """Points on the grid of a level, each place once, with heights in meters."""

    grid: Rows  # (n, 2)
    z: Floats

    @classmethod
    def once(cls, grid: Rows, z: Floats) -> _Points:
        """Return the mean of the heights of each place."""
        places, same = np.unique(grid, axis=0, return_inverse=True)
        same = same.reshape(-1)
        return cls(places, np.bincount(same, z) / np.bincount(same))


def _within_error(level: _Level) -> tuple[float, dict[tuple[int, int], _Tile]]:
    """Return the tiles of a level and their error, which is at most that of the level."""
    points = _Points.once(level.grid, level.ground.z)
    sides = _Sides(level, points)
    level.step = sides.step()
    shift = np.abs(level.ground.heights(level.degrees(level.grid)) - level.ground.z)
    left = level.error - level.step - float(np.median(shift))
    worst = math.inf
    for _ in range(_ATTEMPTS):
        left = max(left, 0.0)
        tiles = {tile: _simplified(sides, tile, left) for tile in level.tiles}
        worst = _measured(level, tiles)
        if worst <= level.error:
            return worst, tiles
        if left == 0:
            break
        left = min(left / 2, left - (worst - level.error))
    raise InputError(
        f"at level {level.zoom}, points are up to {worst:.3g} m from their tile, and "
        f"{level.error:.3g} m is allowed: the surface is so steep that rounding of x and y to "
        f"{level.width / _STEPS * 111_000:.2g} m changes heights by more than that; give a larger "
        "max_error, or make walls less steep"
    )


class _Sides:
    """The points of the tiles of a level, and the sides between tiles."""

    def __init__(self, level: _Level, points: _Points) -> None:
        self.level = level
        tile = np.minimum(points.grid // _STEPS, level.size - 1)
        order = np.lexsort((tile[:, 1], tile[:, 0]))
        keys, start = np.unique(tile[order], axis=0, return_index=True)
        stops = [*start[1:].tolist(), len(order)]
        self.inside: dict[tuple[int, int], _Points] = {}
        for (x, y), a, b in zip(keys.tolist(), start.tolist(), stops, strict=True):
            rows = order[a:b]
            self.inside[x, y] = _Points(points.grid[rows], points.z[rows])
        self.lines: dict[tuple[int, int, int], _Points] = {}
        on = (points.grid % _STEPS == 0).any(axis=1)
        self.on = _Points(points.grid[on], points.z[on])
        for x, y in level.tiles:
            for axis, column, row in ((0, x, y), (0, x + 1, y), (1, x, y), (1, x, y + 1)):
                if (axis, column, row) not in self.lines:
                    self.lines[axis, column, row] = self._line(axis, column, row)

    def _line(self, axis: int, column: int, row: int) -> _Points:
        """Return the points of a side: those of the surface, and evenly spaced places."""
        start = np.array([column, row]) * _STEPS
        way = np.zeros((_SAMPLES, 2), dtype=np.int64)
        way[:, 1 - axis] = np.rint(np.linspace(0, _STEPS, _SAMPLES))
        grid = start + way
        along = self.on.grid[:, 1 - axis] - start[1 - axis]
        own = (self.on.grid[:, axis] == start[axis]) & (along >= 0) & (along <= _STEPS)
        z = self.level.ground.heights(self.level.degrees(grid))
        # Points of the surface come first, and the first point at each place is used.
        both = np.concatenate((self.on.grid[own], grid))
        places, first = np.unique(both, axis=0, return_index=True)
        return _Points(places, np.concatenate((self.on.z[own], z))[first])

    def step(self) -> float:
        """Return the step of heights: a power of two, large enough for the range of each tile."""
        widest = highest = 0.0
        for x, y in self.level.tiles:
            z = np.concatenate([each.z for each in (*self.around(x, y), self.own(x, y))])
            widest = max(widest, float(z.max() - z.min()))
            highest = max(highest, float(np.abs(z).max()))
        # Two steps are left for rounding. Multiples of a step have 24 bits, as in the header.
        return 2.0 ** math.ceil(math.log2(max(widest / (_STEPS - 2), highest / 2**23, 2.0**-40)))

    def own(self, x: int, y: int) -> _Points:
        """Return the points inside a tile, without those on its sides."""
        nothing = _Points(np.empty((0, 2), dtype=np.int64), np.empty(0))
        found = self.inside.get((x, y), nothing)
        within = found.grid - (x * _STEPS, y * _STEPS)
        inner = ((within > 0) & (within < _STEPS)).all(axis=1)
        return _Points(found.grid[inner], found.z[inner])

    def around(self, x: int, y: int) -> list[_Points]:
        """Return the sides of a tile: west, east, south, north."""
        keys = ((0, x, y), (0, x + 1, y), (1, x, y), (1, x, y + 1))
        return [self.lines[key] for key in keys]


def _simplified(sides: _Sides, tile: tuple[int, int], error: float) -> _Tile:
    """Return the triangles of a tile between its sides."""
    level, corner = sides.level, np.array(tile) * _STEPS
    west, east, south, north = (
        _thinned(line, axis, error / 2, level.step)
        for axis, line in zip((0, 0, 1, 1), sides.around(*tile), strict=True)
    )
    ring = np.concatenate((south[:-1], east[:-1], north[:0:-1], west[::-1])) - (*corner, 0)
    own = sides.own(*tile)
    inner = np.column_stack((own.grid - corner, np.rint(own.z / level.step)))
    surface = type(level.ground.tin).from_points(
        np.concatenate((inner, ring[:-1])), breaklines=[ring]
    )
    small = surface.simplify(max_error=error / level.step)
    return _Tile(small)


def _thinned(line: _Points, axis: int, error: float, step: float) -> Floats:
    """Return the points of a side that are kept, with heights in steps."""
    z = np.rint(line.z / step)
    way = line.grid[:, 1 - axis].astype(np.float64)
    kept = thinned(way, z, np.zeros(len(z), dtype=bool), error / step)
    return np.column_stack((line.grid[kept], z[kept]))


def _measured(level: _Level, tiles: dict[tuple[int, int], _Tile]) -> float:
    """Return the largest vertical distance of points from the tiles as written."""
    ground = level.ground
    home = level.tile_of(ground.degrees)
    order = np.lexsort((home[:, 1], home[:, 0]))
    keys, start = np.unique(home[order], axis=0, return_index=True)
    worst = 0.0
    for (x, y), rows in zip(keys.tolist(), np.split(order, start[1:]), strict=True):
        places = (ground.degrees[rows] - _CORNER) / level.width - (x, y)
        z = tiles[x, y].surface.heights(np.clip(places, 0, 1) * _STEPS)
        worst = max(worst, float(np.abs(z * level.step - ground.z[rows]).max()))
    return worst


def _normals(level: _Level, tiles: dict[tuple[int, int], _Tile]) -> dict[tuple[int, int], Floats]:
    """Return unit normals in space of the vertices of tiles, the same where tiles meet."""
    ecef = require("quantized_mesh_encoder.ecef", extra="globe", what="writing tiles")
    around: dict[tuple[int, int], Floats] = {}
    shared: dict[tuple[int, int], Floats] = {}
    sides: dict[tuple[int, int], tuple[Rows, list[tuple[int, int]]]] = {}
    for tile, each in tiles.items():
        simplices, grid = each.surface.simplices, each.surface.xyz[:, :2].astype(np.int64)
        a, b, c = ecef.to_ecef(each.places(level, tile))[simplices.T]
        faces = np.cross(b - a, c - a)
        around[tile] = np.zeros((len(grid), 3))
        for corner in simplices.T:
            np.add.at(around[tile], corner, faces)
        # Vertices on sides are identified by their column and row.
        rows = np.flatnonzero(((grid == 0) | (grid == _STEPS)).any(axis=1))
        keys = [(int(x), int(y)) for x, y in grid[rows] + np.multiply(tile, _STEPS)]
        sides[tile] = rows, keys
        for key, normal in zip(keys, around[tile][rows], strict=True):
            shared[key] = shared.get(key, 0) + normal
    for tile, each in tiles.items():
        found, (rows, keys) = around[tile], sides[tile]
        found[rows] = [shared[key] for key in keys]
        # The points of a row at a pole are one place in space: upward.
        row = each.surface.xyz[:, 1] + tile[1] * _STEPS
        pole = (row == 0) | (row == level.size[1] * _STEPS)
        found[pole] = np.column_stack((0 * row, 0 * row, row - 1))[pole]
        length = np.linalg.norm(found, axis=1)
        found /= length[:, None]
    return around


def _octahedral(normals: Floats) -> NDArray[np.uint8]:
    """Return unit vectors on the octahedron, unfolded to a square, each as two bytes."""
    x, y, z = (normals / np.abs(normals).sum(axis=1, keepdims=True)).T
    below = z < 0
    u = np.where(below, (1 - np.abs(y)) * np.where(x < 0, -1, 1), x)
    v = np.where(below, (1 - np.abs(x)) * np.where(y < 0, -1, 1), y)
    found: NDArray[np.uint8] = np.rint((np.column_stack((u, v)) + 1) * 127.5).astype(np.uint8)
    return found


def _ranges(tiles: Iterable[tuple[int, int]]) -> list[dict[str, int]]:
    """Return the tiles of a level as runs along rows."""
    found: list[dict[str, int]] = []
    for y, x in sorted((y, x) for x, y in tiles):
        if found and found[-1]["startY"] == y and found[-1]["endX"] == x - 1:
            found[-1]["endX"] = x
        else:
            found.append({"startX": x, "startY": y, "endX": x, "endY": y})
    return found


def _document(
    ground: _Ground, available: list[list[dict[str, int]]], normals: bool
) -> dict[str, Any]:
    """Return the contents of layer.json."""
    return {
        "tilejson": "2.1.0",
        "name": "terrain",
        "version": "1.0.0",
        "format": "quantized-mesh-1.0",
        "scheme": "tms",
        "projection": "EPSG:4326",
        "tiles": ["{z}/{x}/{y}.terrain"],
        "minzoom": 0,
        "maxzoom": len(available) - 1,
        "bounds": [*ground.low.tolist(), *ground.high.tolist()],
        "available": available,
    } | ({"extensions": ["octvertexnormals"]} if normals else {})
