"""Plots of the areas between contours with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_flag
from delone._base.extras import require
from delone.plot.axes import frame, new_axes, require_bounds
from delone.plot.colors import as_cmap
from delone.plot.style import require_style, restyle

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats

__all__ = ["plot_bands"]


def plot_bands(
    polygons: Sequence[Sequence[Floats]],
    low: Floats,
    high: Floats,
    ax: Any = None,
    *,
    cmap: Any = None,
    colorbar: bool = True,
    title: str | None = None,
    **style: Any,
) -> Any:
    """Draw polygons, lists of rings, (k, 2) each, in the colors of their ranges of heights."""
    require_style(style, "bands", ("cmap", "colorbar", "title"))
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    colors = require("matplotlib.colors", extra="plot", what="drawing")
    path = require("matplotlib.path", extra="plot", what="drawing").Path
    bar, chosen = as_flag(colorbar, name="colorbar"), as_cmap(cmap)
    every = [ring for rings in polygons for ring in rings]
    corners = np.concatenate(every) if every else np.array([[0.0, 0], [1, 1]])
    box = corners.min(axis=0), corners.max(axis=0)
    require_bounds(*box)
    ax = new_axes(ax)
    # Each ring ends with its first point, which closes its part of the path.
    outlines = []
    for rings in polygons:
        codes = [[path.MOVETO, *[path.LINETO] * (len(ring) - 2), path.CLOSEPOLY] for ring in rings]
        outlines.append(path(np.concatenate(rings), np.concatenate(codes)))
    bounds = np.unique(np.concatenate((low, high)))
    if len(bounds) < 2:
        bounds = np.array([0.0, 1.0]) + (bounds[0] if len(bounds) else 0.0)
    drawn = collections.PathCollection(
        outlines,
        array=low,
        cmap=chosen or "viridis",
        norm=colors.BoundaryNorm(bounds, 256),
        edgecolors="white",
        linewidths=0.3,
        zorder=1,
    )
    restyle([drawn], style)
    ax.add_collection(drawn, autolim=False)
    if bar and len(polygons):
        ax.figure.colorbar(
            drawn, ax=ax, label="height", shrink=0.75, pad=0.02, spacing="proportional"
        )
    frame(ax, *box, title, margin=0.02 * float(np.max(box[1] - box[0])))
    return ax
