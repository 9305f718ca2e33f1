"""The places of SciPy's ``delaunay_plot_2d`` and ``convex_hull_plot_2d`` taken by delone."""

from __future__ import annotations

from typing import Any

import numpy as np

from delone.errors import ShapeError
from delone.extras import require

__all__ = ["convex_hull_plot_2d", "delaunay_plot_2d"]

# Share of the box of the points that stays free on each side.
_MARGIN = 0.1


def delaunay_plot_2d(tri: Any, ax: Any = None) -> Any:
    """Draw a Delaunay triangulation as SciPy does.

    Parameters
    ----------
    tri : Delaunay
        A triangulation; those of SciPy and of `delone.Delaunay` do as well.
    ax : matplotlib Axes, optional
        Where to draw; by default on new axes.

    Returns
    -------
    matplotlib Figure
        The figure of the axes.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    ValueError
        The triangulation is not in the plane.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from delone.compat.scipy import Delaunay, delaunay_plot_2d
    >>> figure = delaunay_plot_2d(Delaunay([(0, 0), (0, 1), (1, 0), (1, 1)]))
    >>> len(figure.axes[0].lines)
    3
    """
    points, ax = _begun(tri, ax, "Delaunay triangulation")
    ax.plot(*points.T, "o")
    ax.triplot(*points.T, np.array(tri.simplices))
    return _ended(points, ax)


def convex_hull_plot_2d(hull: Any, ax: Any = None) -> Any:
    """Draw a convex hull as SciPy does.

    Parameters
    ----------
    hull : ConvexHull
        A hull; those of SciPy and of `delone.ConvexHull` do as well.
    ax : matplotlib Axes, optional
        Where to draw; by default on new axes.

    Returns
    -------
    matplotlib Figure
        The figure of the axes.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    ValueError
        The hull is not in the plane.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from delone.compat.scipy import ConvexHull, convex_hull_plot_2d
    >>> figure = convex_hull_plot_2d(ConvexHull([(0, 0), (0, 1), (1, 0), (1, 1)]))
    >>> len(figure.axes[0].collections[0].get_segments())
    4
    """
    points, ax = _begun(hull, ax, "convex hull")
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    ax.plot(*points.T, "o")
    edges = points[np.asarray(hull.simplices)]
    ax.add_collection(collections.LineCollection(edges, colors="k", linestyle="solid"))
    return _ended(points, ax)


def _begun(thing: Any, ax: Any, what: str) -> tuple[Any, Any]:
    """The points, and axes to draw on."""
    points = np.asarray(thing.points)
    if points.shape[1] != 2:
        raise ShapeError(f"the {what} is not in the plane")
    if ax is None:
        ax = require("matplotlib.pyplot", extra="plot", what="drawing").figure().gca()
    return points, ax


def _ended(points: Any, ax: Any) -> Any:
    """The figure, its limits set as SciPy sets them."""
    margin = _MARGIN * np.ptp(points, axis=0)
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    return ax.figure
