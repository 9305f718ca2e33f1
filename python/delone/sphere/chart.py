"""Plots of grids on maps of longitudes and latitudes.

Each pixel shows a mean weighted by the areas that it shares with cells, so no cell is missed and
none is drawn too large.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_number, as_plain_array, as_workers, wrong_shape
from delone._base.extras import require
from delone._base.numbers import as_positive
from delone._base.values import require_real
from delone.areal.paired import row_sums
from delone.errors import InputError, ShapeError
from delone.plot.axes import new_axes, thin
from delone.sphere.coordinates import lonlat_of
from delone.sphere.large import overlaps_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from delone._base.types import Floats

__all__ = ["plot_grid"]

# The width of a map in pixels, and the distance between points of a curved side, in degrees.
_PIXELS = 600
_STEP = 2.0
_MOST_SIDES = 5000
_SIDE, _COAST = "#5f6f7e", "#a08a64"


def plot_grid(
    grid: Any,
    ax: Any,
    values: ArrayLike | None,
    *,
    bounds: Sequence[float] | None,
    resolution: float | None,
    sides: bool | None,
    coast: Any,
    cmap: Any,
    colorbar: bool,
    title: str | None,
) -> Any:
    """Draw cells; see `Grid.plot`."""
    ax = new_axes(ax)
    field = None if values is None else _field(grid, values)
    left, bottom, right, top = _box(grid, bounds)
    if field is not None:
        given = (right - left) / _PIXELS if resolution is None else resolution
        step = as_positive(given, name="resolution", finite=True)
        x = np.linspace(left, right, max(1, round((right - left) / step)) + 1)
        y = np.linspace(bottom, top, max(1, round((top - bottom) / step)) + 1)
        image = _means(grid, field, type(grid).from_lonlat(x, y))
        shown = ax.imshow(
            image, extent=(left, right, bottom, top), origin="lower", cmap=cmap, aspect="auto",
            interpolation="nearest",
        )  # fmt: skip
        if colorbar:
            ax.figure.colorbar(shown, ax=ax)
    if sides is None:
        sides = field is None or grid.ncells <= _MOST_SIDES
    if sides:
        chains = _parallels(grid) if grid.edges == "parallel" else _arcs(grid)
        _draw(ax, chains, left, right, color=_SIDE, linewidth=thin(grid.ncells))
    if coast is not None:
        _draw(ax, [_coast(coast)], left, right, color=_COAST, linewidth=0.9)
    ax.set(xlim=(left, right), ylim=(bottom, top), xlabel="longitude", ylabel="latitude")
    ax.set_aspect("equal")
    if title is not None:
        ax.set_title(title)
    return ax


def _means(grid: Any, field: Floats, pixels: Any) -> Floats:
    """Return the mean of each pixel over the part where cells have values."""
    found = overlaps_of(pixels._made, grid._made, as_workers(grid.workers))
    values = field[found.indices]
    there = np.isfinite(values)
    parts = np.where(there, found.areas, 0.0)
    sums = row_sums(found.indptr, parts * np.where(there, values, 0.0))
    covered = row_sums(found.indptr, parts)
    image = np.full(pixels.ncells, np.nan)
    np.divide(sums, covered, out=image, where=covered > 0)
    shaped: Floats = image.reshape(pixels.grid_shape)
    return shaped


def _field(grid: Any, values: ArrayLike) -> Floats:
    """Return one value for each cell."""
    array = as_plain_array(values, "values")
    require_real(array, "values", kinds="iufb")
    if array.shape not in {grid.grid_shape, (grid.ncells,)}:
        raise wrong_shape("values", f"{grid.grid_shape} or ({grid.ncells},)", array)
    return array.ravel().astype(np.float64)


def _box(grid: Any, bounds: Sequence[float] | None) -> tuple[float, float, float, float]:
    """Return the left, bottom, right and top of the map."""
    if bounds is not None:
        listed = bounds if hasattr(bounds, "__iter__") else ()
        given = [as_number(bound, name="bounds") for bound in listed]
        left, bottom, right, top = given if len(given) == 4 else (np.nan,) * 4
        right += 360.0 if right < left else 0.0
        if not (left < right <= left + 360 and -90 <= bottom < top <= 90):
            kind = InputError if len(given) == 4 else ShapeError
            raise kind(f"bounds must be left, bottom, right and top, got {bounds!r:.60}")
        return left, bottom, right, top
    vectors = grid.rings[0]
    places = lonlat_of(vectors) if len(vectors) else np.zeros((0, 2))
    low, high = places.min(axis=0, initial=180.0), places.max(axis=0, initial=-180.0)
    wide, tall = (high - low).tolist()
    # Cells at a pole or at the date line need a map of the whole globe.
    if not 0 < wide <= 180 or not 0 < tall <= 90:
        return -180.0, -90.0, 180.0, 90.0
    margin = 0.03 * max(wide, tall)
    left, right = float(low[0]) - margin, float(high[0]) + margin
    return left, max(-90.0, float(low[1]) - margin), right, min(90.0, float(high[1]) + margin)


def _parallels(grid: Any) -> list[Floats]:
    """Return the four corners of each cell between meridians and parallels, and the first again."""
    places = lonlat_of(grid.rings[0]).reshape(-1, 4, 2)
    lon, lat = places[..., 0], places[..., 1]
    # At a pole, use the longitudes of the other end of the cell.
    pole = np.abs(lat) == 90
    lon = np.where(pole, lon[:, [3, 2, 1, 0]], lon)
    # A cell that goes all the way around ends where it starts.
    width = (lon[:, 1] - lon[:, 0]) % 360
    width = np.where(width > 0, width, 360.0)
    west = lon[:, :1]
    lon = np.concatenate((west, west + width[:, None], west + width[:, None], west, west), axis=1)
    return [np.stack((lon, lat[:, [0, 1, 2, 3, 0]]), axis=2)]


def _arcs(grid: Any) -> list[Floats]:
    """Return sides as chains of places, in groups of equal length.

    Those between two triangles of one cell are left out.
    """
    vectors, rings, cells = grid.rings
    following = np.arange(1, len(vectors) + 1)
    following[rings[1:][np.diff(rings) > 0] - 1] = rings[:-1][np.diff(rings) > 0]
    start, end = vectors, vectors[following]
    outer = np.ones(len(vectors), dtype=bool)
    for cell in grid.report.large.tolist():
        own = slice(rings[cells[cell]], rings[cells[cell + 1]])
        outer[own] = _once(start[own], end[own])
    start, end = start[outer], end[outer]
    angle = 2 * np.arcsin(np.clip(np.linalg.norm(end - start, axis=1) / 2, 0, 1))
    parts = np.ceil(np.degrees(angle) / _STEP).astype(int)
    found = []
    for count in np.unique(parts[parts > 0]).tolist():
        own = parts == count
        share = np.linspace(0, 1, count + 1)[None, :, None]
        between = (1 - share) * start[own][:, None] + share * end[own][:, None]
        places = lonlat_of(between.reshape(-1, 3)).reshape(-1, count + 1, 2)
        places[..., 0] = np.unwrap(places[..., 0], period=360, axis=1)
        found.append(places)
    return found


def _once(start: Floats, end: Floats) -> Any:
    """Return which sides of a cell do not also occur in the opposite direction."""
    at = np.unique(np.concatenate((start, end)), axis=0, return_inverse=True)[1].ravel()
    one, other = at[: len(start)], at[len(start) :]
    count = len(start) + len(end)
    return ~np.isin(one * count + other, other * count + one)


def _draw(ax: Any, chains: list[Floats], left: float, right: float, **style: Any) -> None:
    """Draw chains at each multiple of 360 degrees where they are visible."""
    lines = require("matplotlib.collections", extra="plot", what="drawing")
    for chain in chains:
        for turn in (-360.0, 0.0, 360.0):
            lon = chain[..., 0] + turn
            seen = (lon.max(axis=1) >= left) & (lon.min(axis=1) <= right)
            moved = np.stack((lon[seen], chain[seen][..., 1]), axis=2)
            if len(moved):
                ax.add_collection(lines.LineCollection(list(moved), **style))


def _coast(land: Any) -> Floats:
    """Return the segments of the coast, (n, 2, 2), without those along the edges of the map."""
    if not isinstance(land, dict) or land.get("type") != "MultiPolygon":
        raise InputError(f"coast must be a GeoJSON MultiPolygon, got {land!r:.60}")
    parts = [np.zeros((0, 2, 2))]
    for polygon in land["coordinates"]:
        for ring in polygon:
            corners = np.array(ring, dtype=np.float64)[:, :2]
            pairs = np.stack((corners[:-1], corners[1:]), axis=1)
            cut = (np.abs(pairs[..., 0]) == 180).all(axis=1) | (pairs[..., 1] < -89).any(axis=1)
            parts.append(pairs[~cut])
    return np.concatenate(parts)
