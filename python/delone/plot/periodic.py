"""Periodic 2-D triangulations: the triangles of one period, and its box."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_flag, as_optional_flag
from delone._base.extras import require
from delone.plot.axes import draw_dots, frame, new_axes, require_bounds, thin
from delone.plot.style import EDGES

if TYPE_CHECKING:
    from delone._base.types import Floats
    from delone.plot.protocols import Periodic

__all__ = ["plot_periodic"]

_FACE, _INK, _BOX = "#eaf1f6", "#35506b", "#b3372f"


def plot_periodic(
    mesh: Periodic,
    ax: Any = None,
    *,
    box: bool = True,
    vertices: bool | None = None,
    title: str | None = None,
) -> Any:
    """Draw one triangle of each class of translates; for the options see `delone.plot.plot`."""
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    outlined = as_flag(box, name="box")
    dots = as_optional_flag(vertices, name="vertices")
    corners = mesh.corners
    start, end = _period(mesh)
    # In a direction without a period, the limits are those of the triangles.
    low = np.fmin(corners.min(axis=(0, 1)), start)
    high = np.fmax(corners.max(axis=(0, 1)), end)
    require_bounds(low, high)
    ax = new_axes(ax)
    facets = collections.PolyCollection(
        corners,
        facecolors=_FACE,
        edgecolors=_INK,
        linewidths=thin(len(corners)),
        zorder=1,
        gid=EDGES,
    )
    ax.add_collection(facets, autolim=False)
    if outlined:
        _draw_box(ax, np.array([start, end]), np.array([low, high]))
    draw_dots(ax, mesh.points, dots)
    frame(ax, low, high, title, margin=0.02 * float(np.max(high - low)))
    return ax


def _period(mesh: Periodic) -> tuple[Floats, Floats]:
    """Return the ends of one period with the points in its middle; NaN without a period."""
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    lengths = np.array([np.nan if each is None else each for each in mesh.periods])
    start = low - (lengths - (high - low)) / 2
    return start, start + lengths


def _draw_box(ax: Any, ends: Floats, shown: Floats) -> None:
    """Draw the sides of a period, except those along a direction without a period."""
    for axis in (0, 1):
        along = ends[:, 1 - axis] if np.isfinite(ends[0, 1 - axis]) else shown[:, 1 - axis]
        for at in ends[np.isfinite(ends[:, axis]), axis].tolist():
            side = [along, [at, at]] if axis else [[at, at], along]
            ax.plot(*side, "--", color=_BOX, linewidth=1.4, zorder=3, gid="period")
