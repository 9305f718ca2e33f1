"""Slope, aspect and brightness of triangles, and rasters of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_callback, as_choice, as_queries
from delone._base.numbers import as_between, as_finite, as_nonnegative
from delone._tiling import measures
from delone.errors import InputError
from delone.interpolate.raster import Grid, as_nodes, raster_nodes, require_memory
from delone.terrain.surface import on_surface

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices
    from delone.terrain.surface import Surface

__all__ = [
    "aspect",
    "cells_of",
    "extremes",
    "gradient",
    "heights",
    "hillshade",
    "measure",
    "normals",
    "raster",
    "require_room",
    "slope",
]

_WHAT = ("height", "slope", "aspect", "hillshade")
_LIGHT = ("azimuth", "altitude", "z_factor")
# Number of nodes that are located at a time.
_BLOCK = 1 << 18


def gradient(points: Floats, z: Floats, simplices: Indices) -> Floats:
    """Return the gradients of the planes of triangles, (m, 2).

    Areas are those of the given corners, even in triangles that are thinner than rounding errors.
    """
    # In units of the largest coordinate, without rounding: no product overflows or underflows.
    exponent = int(np.frexp(np.abs(points).max(initial=0.0))[1])
    points = np.ldexp(points, -exponent)
    # Differences of heights overflow only near the end of the range.
    tall = max(0, int(np.frexp(np.abs(z).max(initial=0.0))[1]) - 1000)
    z = np.ldexp(z, -tall)
    a, b, c = (points[corner] for corner in simplices.T)
    low, mid, high = (z[corner] for corner in simplices.T)
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    du, dv = mid - low, high - low
    twice = 2 * measures.sizes(points, simplices)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found: Floats = np.column_stack((du * vy - dv * uy, dv * ux - du * vx)) / twice[:, None]
        found = np.ldexp(found, tall - exponent)
    # Level triangles stay level, however thin.
    found[(du == 0) & (dv == 0)] = 0.0
    return found


def normals(slopes: Floats) -> Floats:
    """Return the upward unit normals of planes with these gradients."""
    found = np.column_stack((-slopes, np.ones(len(slopes))))
    # An infinite slope is vertical; squares of others must not overflow.
    upright = np.isinf(found).any(axis=1)
    found[upright] = np.where(np.isinf(found[upright]), np.sign(found[upright]), 0.0)
    largest = np.abs(found).max(axis=1, initial=0.0, keepdims=True)
    found = np.ldexp(found, -np.frexp(largest)[1])
    shares: Floats = found / np.linalg.norm(found, axis=1, keepdims=True)
    return shares


def slope(slopes: Floats) -> Floats:
    """Return slopes in degrees."""
    with np.errstate(over="ignore"):  # beyond the range, it is vertical
        found: Floats = np.degrees(np.arctan(np.hypot(*slopes.T)))
    return found


def aspect(slopes: Floats) -> Floats:
    """Return the downhill directions in degrees clockwise from north; NaN if level."""
    x, y = -slopes.T
    found = np.degrees(np.arctan2(x, y)) % 360.0
    return np.where((x == 0) & (y == 0), np.nan, found)


def hillshade(slopes: Floats, azimuth: float, altitude: float, z_factor: float) -> Floats:
    """Return the cosines between normals and light, 0 where they face away."""
    numbers = {
        name: as_finite(value, name=name)
        for name, value in zip(_LIGHT, (azimuth, altitude, z_factor), strict=True)
    }
    as_between(altitude, 0, 90, name="altitude (degrees)")
    around, above = np.radians(numbers["azimuth"]), np.radians(numbers["altitude"])
    light = np.array(
        (np.cos(above) * np.sin(around), np.cos(above) * np.cos(around), np.sin(above))
    )
    factor = numbers["z_factor"]
    with np.errstate(over="ignore"):
        steeper = slopes * factor if factor else np.zeros_like(slopes)
    found: Floats = np.clip(normals(steeper) @ light, 0.0, 1.0)
    return found


def heights(tin: Surface, xy: ArrayLike, tolerance: float) -> Floats:
    """Return heights at positions, NaN outside."""
    queries = as_queries(xy, 2, tin.crs, name="xy", to="the surface")
    place = tin.locate(queries, tolerance=tolerance)
    inside = place.simplex >= 0
    corners = tin.z[tin.simplices[np.where(inside, place.simplex, 0)]]
    found = (place.barycentric * corners).sum(axis=-1)
    # Level triangles stay level, because weights sum to 1 only up to rounding.
    level = (corners == corners[..., :1]).all(axis=-1)
    return np.asarray(np.where(inside, np.where(level, corners[..., 0], found), np.nan))


def extremes(tin: Surface) -> tuple[float, float]:
    """Return the smallest and the largest height of a surface."""
    z = tin.z[on_surface(tin)]
    return float(z.min()), float(z.max())


def raster(tin: Surface, what: str, options: dict[str, Any]) -> Grid:
    """Sample heights, or a measure of triangles, at the centers of cells."""
    as_choice(what, _WHAT, name="what")
    light = {"azimuth": 315.0, "altitude": 45.0, "z_factor": 1.0}
    for name in _LIGHT:
        if name in options and what == "hillshade":
            light[name] = options.pop(name)
    tell = as_callback(options.pop("progress", None), name="progress")
    tolerance = as_nonnegative(options.pop("tolerance", 0.0), name="tolerance")
    x, y = _nodes(tin, options)
    values = np.empty((len(y), len(x)))
    rows = max(1, _BLOCK // len(x))
    for start in range(0, len(y), rows):
        nodes = np.stack(np.meshgrid(x, y[start : start + rows]), axis=-1)
        if what == "height":
            found = tin.heights(nodes, tolerance=tolerance)
        else:
            simplex = tin.find_simplex(nodes, tolerance=tolerance)
            # Only triangles with a node: a surface may have many more triangles than nodes.
            own, back = np.unique(simplex, return_inverse=True)
            corners = tin.simplices[own].ravel()
            triples = np.arange(len(corners), dtype=np.int32).reshape(-1, 3)
            slopes = gradient(tin.points[corners], tin.z[corners], triples)
            found = np.where(own < 0, np.nan, measure(slopes, what, light))[back]
        values[start : start + rows] = found.reshape(-1, len(x))
        if tell is not None:
            tell(min(1.0, (start + rows) / len(y)))
    return Grid(values, x, y)


def measure(slopes: Floats, what: str, light: dict[str, float]) -> Floats:
    """Return the slope, the aspect or, with `light`, the brightness of planes."""
    if what == "hillshade":
        return hillshade(slopes, **light)
    return slope(slopes) if what == "slope" else aspect(slopes)


def _nodes(tin: Surface, options: dict[str, Any]) -> tuple[Floats, Floats]:
    if "x" in options and "y" in options and len(options) == 2:
        x, y = as_nodes(options["x"], "x"), as_nodes(options["y"], "y")
        require_memory(len(x), len(y), 1)
        return x, y
    unknown = set(options) - {"resolution", "shape", "bounds"}
    if unknown & set(_LIGHT):
        raise InputError(f'{", ".join(sorted(unknown))}: these options are for what="hillshade"')
    if unknown:
        raise InputError(
            f"{', '.join(sorted(unknown))}: give resolution, shape and bounds, or x and y"
        )
    return raster_nodes(_box(tin), **options)


def require_room(tin: Surface, resolution: float, count: int) -> None:
    """Raise what `raster` would raise about cells of this size, for several rasters at a time."""
    raster_nodes(
        _box(tin),
        resolution=resolution,
        room=lambda columns, rows: require_memory(columns, rows, count),
    )


def _box(tin: Surface) -> tuple[list[float], list[float]]:
    """Return the smallest and the largest coordinates of a surface."""
    corners = tin.points[on_surface(tin)]
    return corners.min(axis=0).tolist(), corners.max(axis=0).tolist()


def cells_of(dem: Any) -> tuple[Floats, Floats, Floats]:
    """Return values, x and y of a raster."""
    if all(hasattr(dem, name) for name in ("values", "x", "y")):
        values, x, y = (np.asarray(each, dtype=np.float64) for each in (dem.values, dem.x, dem.y))
        if values.ndim == 2 and values.shape == (len(y), len(x)):
            return values, x, y
    raise InputError(
        "a raster must have one height in each cell, and the attributes values, x and y: a "
        f"delone.interpolate.Grid or an xarray.DataArray with these coordinates, got {dem!r:.60}"
    )
