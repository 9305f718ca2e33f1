"""Plots of rasters: colors, hillshade and contours."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_flag, as_number, as_optional_flag
from delone._base.extras import require
from delone.errors import InputError
from delone.plot.axes import axis_names, figure_size, new_axes, require_values
from delone.plot.colors import add_bar, as_cmap, scale, shaded, show
from delone.plot.shading import Raster, relief

if TYPE_CHECKING:
    from pathlib import Path

    from delone._base.types import Floats

__all__ = ["draw_difference", "draw_raster", "plot_difference", "plot_raster"]


def plot_raster(
    values: Floats,
    x: Floats,
    y: Floats,
    ax: Any = None,
    *,
    contours: Any = None,
    shade: bool | None = None,
    cmap: Any = None,
    colorbar: bool = True,
    label: str = "z",
    title: str | None = None,
) -> Any:
    """Draw a raster in the colors of its values, optionally as a relief map.

    Parameters
    ----------
    values : ndarray of float64, shape (rows, columns)
        Values, the first row lowest; NaN for no value.
    x, y : ndarray of float64, shape (columns,) and (rows,)
        Nodes, evenly spaced.
    ax : matplotlib Axes, optional
        Where to draw; by default on the axes of a new pyplot figure.
    contours : int or sequence of float, optional
        Draw lines of equal value: about this many, or at these values.
    shade : bool, optional
        Add light and shadow, for terrain. The colors then differ from those of the color bar, so
        by default this is done only with ``colorbar=False``.
    cmap : str or matplotlib Colormap, optional
        Colors; by default those of land, or of water if no value is above zero.
    colorbar : bool, optional
        Add the color scale.
    label : str, optional
        Name of the values.
    title : str, optional
        Title of the axes.

    Returns
    -------
    matplotlib Axes
        Where it is drawn.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    InputError
        No value is finite, or the magnitude of one is above 1e305.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from delone.interpolate import grid
    >>> from delone.plot import plot_raster
    >>> ramp = grid([(0, 0), (4, 0), (4, 4), (0, 4)], [0.0, 4.0, 4.0, 0.0], shape=(40, 40))
    >>> plot_raster(ramp.values, ramp.x, ramp.y, contours=4).get_aspect()
    1.0
    """
    bar, lit = as_flag(colorbar, name="colorbar"), as_optional_flag(shade, name="shade")
    colors = as_cmap(cmap)
    if not np.isfinite(values).any():
        raise InputError("the raster has no finite value to draw")
    require_values(values[np.isfinite(values)])
    ax = new_axes(ax)
    mapped = scale(values, colors)
    rgba = mapped.to_rgba(values)
    extent = _extent(x, y)
    if lit or (lit is None and not bar):
        light = relief(Raster(values, (extent[1] - extent[0]) / len(x), extent))
        rgba[..., :3] = shaded(rgba[..., :3], light)
    rgba[..., 3] = np.isfinite(values)
    show(ax, rgba, extent)
    if contours is not None:
        ax.contour(
            x,
            y,
            np.ma.masked_invalid(values),
            levels=contours,
            colors="black",
            linewidths=0.4,
            linestyles="solid",
            alpha=0.45,
        )
    if bar:
        add_bar(ax, mapped, values, label)
    if title:
        ax.set_title(title, fontsize="medium")
    return ax


def plot_difference(
    values: Floats,
    x: Floats,
    y: Floats,
    ax: Any = None,
    *,
    limit: float | None = None,
    cmap: Any = None,
    colorbar: bool = True,
    label: str = "difference",
    title: str | None = None,
) -> Any:
    """Draw differences in colors that are white at 0, with equal intensity at both ends."""
    bar, colors = as_flag(colorbar, name="colorbar"), as_cmap(cmap or "RdBu_r")
    normalize = require("matplotlib.colors", extra="plot", what="drawing").Normalize
    mappable = require("matplotlib.cm", extra="plot", what="drawing").ScalarMappable
    known = np.abs(values[np.isfinite(values)])
    if not len(known):
        raise InputError("no cell has a difference to draw")
    require_values(known)
    if limit is None:
        end = float(np.quantile(known, 0.99)) or float(known.max()) or 1.0
    else:
        end = as_number(limit, name="limit")
    if not 0 < end < np.inf:
        raise InputError(f"limit must be a difference above 0, got {limit!r:.60}")
    ax = new_axes(ax)
    mapped = mappable(norm=normalize(-end, end), cmap=colors)
    rgba = mapped.to_rgba(values)
    rgba[..., 3] = np.isfinite(values)
    show(ax, rgba, _extent(x, y))
    if bar:
        add_bar(ax, mapped, values, label)
    if title:
        ax.set_title(title, fontsize="medium")
    return ax


def draw_raster(
    path: Path,
    values: Floats,
    x: Floats,
    y: Floats,
    *,
    label: str = "z",
    shade: bool | None = None,
    crs: str | None = None,
    size: float = 10.0,
    dpi: int = 160,
) -> None:
    """Draw a raster like `plot_raster`, to a PNG or SVG file with `size` inches on its longer side.

    The reference system names the axes if pyproj is installed.
    """
    figure_module = require("matplotlib.figure", extra="plot", what="drawing")
    left, right, bottom, top = _extent(x, y)
    figsize = figure_size(right - left, top - bottom, size, with_bar=True)
    figure = figure_module.Figure(figsize=figsize, dpi=dpi, layout="constrained")
    ax = plot_raster(values, x, y, figure.add_subplot(), label=label, shade=shade)
    xlabel, ylabel = axis_names(crs)
    ax.set(xlabel=xlabel, ylabel=ylabel)
    figure.savefig(path, dpi=dpi, facecolor="white")


def draw_difference(
    path: Path,
    values: Floats,
    x: Floats,
    y: Floats,
    *,
    units: str | None = None,
    crs: str | None = None,
    size: float = 10.0,
    dpi: int = 160,
) -> None:
    """Draw differences like `plot_difference`, to a PNG or SVG file."""
    figure_module = require("matplotlib.figure", extra="plot", what="drawing")
    left, right, bottom, top = _extent(x, y)
    figsize = figure_size(right - left, top - bottom, size, with_bar=True)
    figure = figure_module.Figure(figsize=figsize, dpi=dpi, layout="constrained")
    label = "difference" + ("" if units is None else f" ({units})")
    ax = plot_difference(values, x, y, figure.add_subplot(), label=label)
    xlabel, ylabel = axis_names(crs)
    ax.set(xlabel=xlabel, ylabel=ylabel)
    figure.savefig(path, dpi=dpi, facecolor="white")


def _extent(x: Floats, y: Floats) -> tuple[float, float, float, float]:
    half_x, half_y = (
        (nodes[-1] - nodes[0]) / max(len(nodes) - 1, 1) / 2 or 0.5 for nodes in (x, y)
    )
    return (
        float(x[0] - half_x),
        float(x[-1] + half_x),
        float(y[0] - half_y),
        float(y[-1] + half_y),
    )
