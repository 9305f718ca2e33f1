"""Triangulations and diagrams of directions as a globe: the front half in orthographic projection.

Arcs of great circles are drawn as chains of short chords. A chain ends where it passes behind the
globe; near the limb the steps are seen at a flat angle, so that no exact end is needed. Polygons
are colored pixel by pixel, because outlines that pass behind the globe have no simple projection.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.values import require_shape
from delone.errors import InputError
from delone.plot.axes import draw_dots, new_axes, thin

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["plot_globe"]

# Degrees between two corners of an arc.
_STEP = 2.0
# Pixels across the globe, where polygons are colored.
_PIXELS = 800
_EDGE, _COAST, _SEA = "#5f6f7e", "#a08a64", "#f4f8fb"


def plot_globe(
    ax: Any,
    *,
    points: Floats,
    arcs: tuple[Floats, Floats, Floats],
    values: ArrayLike | None,
    count: int,
    found: Callable[[Floats], Indices],
    view: tuple[float, float] | None,
    cmap: Any,
    colorbar: bool,
    coast: Any,
    sites: bool | None,
    linewidth: float | None,
    title: str | None,
) -> Any:
    """Draw arcs, and the polygons between them in colors, on a globe.

    Parameters
    ----------
    ax : matplotlib Axes or None
        Where to draw.
    points : ndarray of float64, shape (n, 3)
        Unit vectors, drawn as dots.
    arcs : tuple of ndarray
        For each arc, the unit vectors of its start and of its direction there, (r, 3) each, and its
        length in radians, (r,).
    values : array_like, shape (count,), or None
        A number for each polygon.
    count : int
        The number of polygons.
    found : callable
        For directions, (k, 3), the polygon that contains each, or -1.
    view, cmap, colorbar, coast, sites, linewidth, title
        Options of the plot.

    Returns
    -------
    matplotlib Axes
        Where it is drawn.
    """
    axes = new_axes(ax)
    frame = _frame(_center(points) if view is None else view)
    from matplotlib.collections import LineCollection
    from matplotlib.patches import Circle

    limb = axes.add_patch(Circle((0, 0), 1, facecolor=_SEA, edgecolor=_EDGE, linewidth=0.8))
    limb.set_zorder(0)
    if values is not None:
        shown = axes.imshow(
            _raster(_as_values(values, count), found, frame),
            extent=(-1, 1, -1, 1),
            origin="lower",
            cmap=cmap,
            interpolation="nearest",
            zorder=1,
        )
        shown.set_clip_path(limb)
        if colorbar:
            axes.figure.colorbar(shown, ax=axes, shrink=0.8)
    if coast is not None:
        chords: Any = _front(_coast(coast), frame)
        # Below edges without colors, above them where colors would hide it.
        color, halo, order = (_COAST, 0.0, 2.0) if values is None else ("black", 2.4, 3.5)
        axes.add_collection(LineCollection(chords, colors="white", linewidths=halo, zorder=order))
        axes.add_collection(LineCollection(chords, colors=color, linewidths=1.1, zorder=order))
    width = thin(len(arcs[2])) if linewidth is None else linewidth
    edges: Any = _chords(arcs, frame)
    axes.add_collection(LineCollection(edges, colors=_EDGE, linewidths=width, zorder=3))
    draw_dots(axes, points[points @ frame[2] > 0] @ frame[:2].T, sites)
    axes.set(xlim=(-1.02, 1.02), ylim=(-1.02, 1.02), aspect="equal")
    axes.axis("off")
    if title:
        axes.set_title(title, fontsize="medium")
    return axes


def _as_values(values: ArrayLike, count: int) -> Floats:
    colors = np.asarray(values, dtype=float)
    require_shape(colors, (count,), "values")
    return colors


def _center(points: Floats) -> tuple[float, float]:
    """The longitude and latitude of the mean direction; 0 and 20 degrees if there is none."""
    x, y, z = points.mean(axis=0)
    if np.hypot(np.hypot(x, y), z) < 0.1:
        return 0.0, 20.0
    return float(np.degrees(np.arctan2(y, x))), float(np.degrees(np.arctan2(z, np.hypot(x, y))))


def _frame(view: tuple[float, float]) -> Floats:
    """The unit vectors to the right, up and toward the viewer, above a position in degrees."""
    try:
        lon, lat = np.radians(np.array(view, dtype=float))
    except (TypeError, ValueError):
        raise InputError(f"view must be a longitude and a latitude, got {view!r:.60}") from None
    if not np.isfinite((lon, lat)).all():
        raise InputError(f"view must be finite, got {view!r:.60}")
    east = np.array((-np.sin(lon), np.cos(lon), 0.0))
    out = np.array((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))
    return np.stack((east, np.cross(out, east), out))


def _samples(arcs: tuple[Floats, Floats, Floats], steps: int) -> Floats:
    """Positions along arcs, (r, steps + 1, 3)."""
    start, ahead, length = arcs
    turn = np.linspace(0, 1, steps + 1)[None, :, None] * length[:, None, None]
    found: Floats = np.cos(turn) * start[:, None] + np.sin(turn) * ahead[:, None]
    return found


def _steps(length: Floats) -> NDArray[np.intp]:
    """The number of chords of each arc, a power of two."""
    needed = np.maximum(np.degrees(length) / _STEP, 1.0)
    found: NDArray[np.intp] = (2 ** np.ceil(np.log2(needed))).astype(np.intp)
    return found


def _front(chains: Floats, frame: Floats) -> Floats:
    """The projected chords of chains that are in front, (s, 2, 2)."""
    seen = chains @ frame.T
    ahead = seen[..., 2] > -1e-3
    both = ahead[:, 1:] & ahead[:, :-1]
    found: Floats = np.stack((seen[:, :-1, :2][both], seen[:, 1:, :2][both]), axis=1)
    return found


def _chords(arcs: tuple[Floats, Floats, Floats], frame: Floats) -> Floats:
    """The visible chords of arcs."""
    steps = _steps(arcs[2])
    found = [np.empty((0, 2, 2))]
    for count in np.unique(steps).tolist():
        rows = steps == count
        start, ahead, length = (each[rows] for each in arcs)
        found.append(_front(_samples((start, ahead, length), count), frame))
    return np.concatenate(found)


def _raster(values: Floats, found: Callable[[Floats], Indices], frame: Floats) -> Floats:
    """The value at each pixel of the square around the globe, NaN outside."""
    steps = (np.arange(_PIXELS) + 0.5) * (2 / _PIXELS) - 1
    x, y = np.meshgrid(steps, steps)
    depth = 1 - x**2 - y**2
    front = depth > 0
    places = np.column_stack((x[front], y[front], np.sqrt(depth[front])))
    rows = found(places @ frame)
    image = np.full(x.shape, np.nan)
    image[front] = np.where(rows >= 0, values[rows], np.nan)
    return image


def _coast(land: Any) -> Floats:
    """The segments of the coast, as chains of two, without the edges where maps are cut."""
    parts = []
    for polygon in land["coordinates"]:
        for ring in polygon:
            corners = np.array(ring)
            pairs = np.stack((corners[:-1], corners[1:]), axis=1)
            cut = (np.abs(pairs[..., 0]) == 180).all(axis=1) | (pairs[..., 1] < -89).any(axis=1)
            parts.append(pairs[~cut])
    lon, lat = np.moveaxis(np.radians(np.concatenate(parts)), -1, 0)
    found: Floats = np.stack(
        (np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)), axis=-1
    )
    return found
