"""2-D convex hulls: a polygon over the points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_optional_flag
from delone._base.extras import require
from delone.plot.axes import draw_dots, frame, new_axes, require_bounds
from delone.plot.style import EDGES

if TYPE_CHECKING:
    from delone.plot.protocols import Hull2

__all__ = ["plot_hull"]

_FACE, _RIM = "#c9dcea", "#b3372f"


def plot_hull(
    hull: Hull2, ax: Any = None, *, vertices: bool | None = None, title: str | None = None
) -> Any:
    """Draw a 2-D convex hull and the points; for the options see `delone.plot.plot`."""
    patches = require("matplotlib.patches", extra="plot", what="drawing")
    dots = as_optional_flag(vertices, name="vertices")
    corners = hull.points[hull.vertices]
    low, high = corners.min(axis=0), corners.max(axis=0)
    require_bounds(low, high)
    ax = new_axes(ax)
    outline = patches.Polygon(
        corners, facecolor=_FACE, edgecolor=_RIM, linewidth=1.4, zorder=1, gid=EDGES
    )
    ax.add_patch(outline)
    draw_dots(ax, hull.points, dots)
    frame(ax, low, high, title, margin=0.02 * float(np.max(high - low)))
    return ax
