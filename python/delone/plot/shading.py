"""Triangulated values as pixels: an image of a surface whose triangles are smaller than pixels.

A pixel shows the mean of the points within it; a pixel without points shows the plane of the
triangle at its center; a pixel without a triangle is empty.
Light and shadow follow B. K. P. Horn, "Hill shading and the reflectance map", 1981. Only NumPy is
needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.plot.protocols import segmented

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats
    from delone.plot.protocols import Triangles

__all__ = ["Raster", "facet_light", "facet_values", "point_density", "rasterize", "relief"]

_BLOCK = 1 << 20
# Below this fraction of pixels with points, triangles are larger than pixels and are drawn as
# planes.
_CROWDED = 0.5
# From the northwest and above: with light from below, hills look like hollows.
_SUN = np.array([-0.5, 0.5, 0.7071067811865476])
# The steepest tenth of a surface is drawn with at least this slope.
_STEEP = 1.2
# Heights beyond this are divided by it; their differences could exceed the largest double.
_HUGE = 2.0**512


class Raster(NamedTuple):
    """Values on square pixels, the first row lowest."""

    values: Floats  # (rows, columns), NaN for no value
    cell: float  # the side of a pixel
    extent: tuple[float, float, float, float]  # left, right, bottom, top


def rasterize(mesh: Triangles, values: Floats, pixels: int) -> Raster:
    """Return the surface of values at points, (n,), as `pixels` along the longer side.

    O(n + pixels²) time, and memory for the pixels and a block of points.
    """
    frame = _frame(mesh, pixels)
    count, total = _gathered(mesh.points, values, frame)
    crowded = (count > 0).mean() >= _CROWDED
    surface = np.full(count.shape, np.nan)
    full = count > 0 if crowded else np.zeros(count.shape, dtype=bool)
    surface[full] = total[full] / count[full]
    empty = np.flatnonzero(~full)
    for start in range(0, len(empty), _BLOCK):
        some = empty[start : start + _BLOCK]
        surface.flat[some] = _interpolated(mesh, values, _centers(some, frame))
    if segmented(mesh) is not None:
        # Points of removed triangles have been counted as well.
        surface[mesh.find_simplex(_all_centers(frame)) < 0] = np.nan
    return Raster(surface, frame.cell, frame.extent)


def point_density(mesh: Triangles, pixels: int) -> Raster:
    """Return how many points lie on the area of each pixel, per unit of area; NaN for none."""
    frame = _frame(mesh, pixels)
    count, _ = _gathered(mesh.points, None, frame)
    with np.errstate(divide="ignore", over="ignore"):
        density = np.where(count > 0, count / frame.cell / frame.cell, np.nan)
    return Raster(density, frame.cell, frame.extent)


def facet_values(mesh: Triangles, values: NDArray[np.integer] | Floats, pixels: int) -> Raster:
    """Return the values of the triangles, (m,), at the centers of pixels; NaN outside them."""
    frame = _frame(mesh, pixels)
    triangle = mesh.find_simplex(_all_centers(frame))
    found = np.full(triangle.shape, np.nan)
    found[triangle >= 0] = values[triangle[triangle >= 0]]
    return Raster(found, frame.cell, frame.extent)


def relief(raster: Raster) -> Floats:
    """Return how bright the sun makes each pixel: from 0 to 1 (toward it), 0.71 for flat ground.

    Heights are exaggerated until the steepest tenth of the ground is as steep as 50 degrees, so
    that plains, towns and heights in meters over degrees all show relief.
    """
    if min(raster.values.shape) < 2:
        return np.full(raster.values.shape, _SUN[2])
    north, east = np.array(np.gradient(_in_range(raster.values), raster.cell))
    # Next to the hull, one side of the difference is missing, so it is drawn flat.
    inside = np.isfinite(raster.values)
    return _light(np.nan_to_num(-east), np.nan_to_num(-north), inside)


def facet_light(points: Floats, z: Floats, simplices: NDArray[np.int32]) -> Floats:
    """Return how bright the sun makes each triangle, (m,), like `relief` for pixels."""
    z = _in_range(z)
    a, b, c = (points[simplices[:, k]] for k in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    uz, vz = z[simplices[:, 1]] - z[simplices[:, 0]], z[simplices[:, 2]] - z[simplices[:, 0]]
    with np.errstate(all="ignore"):
        twice = ux * vy - uy * vx
        east, north = (uz * vy - vz * uy) / twice, (vz * ux - uz * vx) / twice
    inside = np.ones(len(simplices), dtype=bool)
    return _light(np.nan_to_num(-east), np.nan_to_num(-north), inside)


def _in_range(heights: Floats) -> Floats:
    """Return heights whose differences do not overflow; only their ratios matter here."""
    largest = np.abs(heights[np.isfinite(heights)]).max(initial=0.0)
    return heights if largest < _HUGE else heights / _HUGE


def _light(x: Floats, y: Floats, inside: NDArray[np.bool_]) -> Floats:
    """Return the cosine between the sun and the normals (x, y, 1), exaggerated, not below 0."""
    with np.errstate(over="ignore"):
        slope = np.hypot(x, y)
    steep = float(np.quantile(slope[inside], 0.9)) if inside.any() else 0.0
    if steep == 0.0:
        steep = float(slope.max(initial=0.0))
    scale = _STEEP / steep if 0.0 < steep < np.inf else 0.0
    with np.errstate(all="ignore"):
        light = (_SUN[0] * scale * x + _SUN[1] * scale * y + _SUN[2]) / np.hypot(1.0, scale * slope)
    bright: Floats = np.clip(np.nan_to_num(light), 0.0, 1.0)
    return bright


class _Frame(NamedTuple):
    """Square pixels over the box of the points."""

    low: Floats
    cell: float
    rows: int
    columns: int

    @property
    def extent(self) -> tuple[float, float, float, float]:
        x, y = self.low.tolist()
        return x, x + self.columns * self.cell, y, y + self.rows * self.cell


def _frame(mesh: Triangles, pixels: int) -> _Frame:
    low = mesh.min_bound
    width, height = (mesh.max_bound - low).tolist()
    cell = max(width, height) / pixels
    columns, rows = (max(1, min(pixels, int(np.ceil(side / cell)))) for side in (width, height))
    return _Frame(low, cell, rows, columns)


def _gathered(points: Floats, values: Floats | None, frame: _Frame) -> tuple[Floats, Floats]:
    """Return the number of points in each pixel, and the sum of their values."""
    size = frame.rows * frame.columns
    count, total = np.zeros(size), np.zeros(size)
    for start in range(0, len(points), _BLOCK):
        some = points[start : start + _BLOCK]
        place = ((some - frame.low) / frame.cell).astype(np.int64)
        column = np.minimum(place[:, 0], frame.columns - 1)
        flat = np.minimum(place[:, 1], frame.rows - 1) * frame.columns + column
        if values is not None:
            weights = values[start : start + _BLOCK]
            known = np.isfinite(weights)
            flat, weights = flat[known], weights[known]
            total += np.bincount(flat, weights=weights, minlength=size)
        count += np.bincount(flat, minlength=size)
    shape = frame.rows, frame.columns
    return count.reshape(shape), total.reshape(shape)


def _centers(flat: NDArray[np.int64], frame: _Frame) -> Floats:
    row, column = np.divmod(flat, frame.columns)
    return frame.low + frame.cell * (np.column_stack((column, row)) + 0.5)


def _all_centers(frame: _Frame) -> Floats:
    centers = _centers(np.arange(frame.rows * frame.columns), frame)
    return centers.reshape(frame.rows, frame.columns, 2)


def _interpolated(mesh: Triangles, values: Floats, xi: Floats) -> Floats:
    """Return the height of the triangles at points, NaN outside."""
    triangle = mesh.find_simplex(xi)
    inside = triangle >= 0
    corners = mesh.simplices[triangle[inside]]
    a, b, c = (mesh.points[corners[:, k]] for k in range(3))
    (ux, uy), (vx, vy), (px, py) = (b - a).T, (c - a).T, (xi[inside] - a).T
    with np.errstate(all="ignore"):
        twice = ux * vy - uy * vx
        s, t = (px * vy - py * vx) / twice, (ux * py - uy * px) / twice
    # Rounding may be large in a sliver; its values remain between those of its corners.
    s, t = np.clip(np.nan_to_num(s), 0.0, 1.0), np.clip(np.nan_to_num(t), 0.0, 1.0)
    za, zb, zc = (values[corners[:, k]] for k in range(3))
    found = np.full(len(xi), np.nan)
    found[inside] = za + s * (zb - za) + t * (zc - za)
    return found
