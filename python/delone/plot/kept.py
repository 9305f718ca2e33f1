"""Plots of 2-D alpha shapes and concave hulls with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_optional_flag
from delone._base.extras import require
from delone.plot.axes import draw_dots, frame, new_axes, require_bounds, thin
from delone.plot.style import EDGES

if TYPE_CHECKING:
    from delone.plot.protocols import Outlined

__all__ = ["plot_kept"]

_FACE, _EDGE, _RIM = "#d3e2ef", "#a9c3d9", "#22384e"


def plot_kept(
    shape: Outlined, ax: Any = None, *, vertices: bool | None = None, title: str | None = None
) -> Any:
    """Draw triangles that are kept, and their boundary; for the options see `delone.plot.plot`."""
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    dots = as_optional_flag(vertices, name="vertices")
    points = shape.points
    low, high = (
        (points.min(axis=0), points.max(axis=0)) if len(points) else (np.zeros(2), np.ones(2))
    )
    if (low == high).all():  # one place
        low, high = low - 0.5, high + 0.5
    require_bounds(low, high)
    ax = new_axes(ax)
    facets = collections.PolyCollection(
        points[shape.simplices],
        facecolors=_FACE,
        edgecolors=_EDGE,
        linewidths=thin(len(shape.simplices), 0.6),
        zorder=1,
    )
    ax.add_collection(facets, autolim=False)
    # An alpha shape also has edges without a triangle.
    rim, loose = shape.boundary, getattr(shape, "loose_edges", None)
    edges = rim if loose is None else np.concatenate((rim, loose))
    lines = collections.LineCollection(
        points[edges], colors=_RIM, linewidths=1.4, capstyle="round", zorder=2, gid=EDGES
    )
    ax.add_collection(lines, autolim=False)
    draw_dots(ax, points, dots)
    frame(ax, low, high, title, margin=0.02 * float(np.max(high - low)))
    return ax
