"""Drop-in replacements for SciPy's ``delaunay_plot_2d`` and ``convex_hull_plot_2d``."""

from __future__ import annotations

from typing import Any

import numpy as np

from delone._base.extras import require
from delone.errors import ShapeError

__all__ = ["convex_hull_plot_2d", "delaunay_plot_2d", "framed", "points_and_axes"]

# Margin on each side, as a fraction of the bounding box of the points.
_MARGIN = 0.1


def delaunay_plot_2d(tri: Any, ax: Any = None) -> Any:
    """Plot a Delaunay triangulation as SciPy does.

    Parameters
    ----------
    tri : Delaunay
        A triangulation; those of SciPy and `delone.Delaunay` are accepted as well.
    ax : matplotlib Axes, optional
        Axes to draw on; by default new ones.

    Returns
    -------
    matplotlib Figure
        The figure of the axes.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    ValueError
        The triangulation is not 2-D.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from delone.compat.scipy import Delaunay, delaunay_plot_2d
    >>> figure = delaunay_plot_2d(Delaunay([(0, 0), (0, 1), (1, 0), (1, 1)]))
    >>> len(figure.axes[0].lines)
    3
    """
    points, ax = points_and_axes(tri, ax, "Delaunay triangulation")
    ax.plot(*points.T, "o")
    ax.triplot(*points.T, np.array(tri.simplices))
    return framed(points, ax)


def convex_hull_plot_2d(hull: Any, ax: Any = None) -> Any:
    """Plot a convex hull as SciPy does.

    Parameters
    ----------
    hull : ConvexHull
        A hull; those of SciPy and `delone.ConvexHull` are accepted as well.
    ax : matplotlib Axes, optional
        Axes to draw on; by default new ones.

    Returns
    -------
    matplotlib Figure
        The figure of the axes.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    ValueError
        The hull is not 2-D.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from delone.compat.scipy import ConvexHull, convex_hull_plot_2d
    >>> figure = convex_hull_plot_2d(ConvexHull([(0, 0), (0, 1), (1, 0), (1, 1)]))
    >>> len(figure.axes[0].collections[0].get_segments())
    4
    """
    points, ax = points_and_axes(hull, ax, "convex hull")
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    ax.plot(*points.T, "o")
    edges = points[np.asarray(hull.simplices)]
    ax.add_collection(collections.LineCollection(edges, colors="k", linestyle="solid"))
    return framed(points, ax)


def points_and_axes(thing: Any, ax: Any, what: str) -> tuple[Any, Any]:
    """The points, and axes to draw on."""
    points = np.asarray(thing.points)
    if points.shape[1] != 2:
        raise ShapeError(f"the {what} is not 2-D")
    if ax is None:
        ax = require("matplotlib.pyplot", extra="plot", what="drawing").figure().gca()
    return points, ax


def framed(points: Any, ax: Any) -> Any:
    """The figure, with SciPy's limits."""
    margin = _MARGIN * np.ptp(points, axis=0)
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    return ax.figure
