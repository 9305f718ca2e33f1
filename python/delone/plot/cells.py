"""Voronoi cells: polygons in 2-D, polyhedra in 3-D."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_flag, as_optional_flag
from delone.errors import InputError
from delone.extras import require
from delone.plot.axes import draw_dots, new_axes, thin
from delone.plot.plotter import new_plotter

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.plot.protocols import Cells2, Cells3

    Floats = NDArray[np.float64]

__all__ = ["plot_cells2", "plot_cells3"]

_EDGE = "#35506b"
# Unbounded cells are drawn as far as this share of the longer side of the box of the sites.
_MARGIN = 0.1


def plot_cells2(
    diagram: Cells2,
    ax: Any = None,
    *,
    values: ArrayLike | None = None,
    cmap: Any = None,
    points: bool | None = None,
    colorbar: bool = True,
    linewidth: float | None = None,
) -> Any:
    """Draw a 2-D Voronoi diagram; for the options see `delone.plot.plot`."""
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    bar = as_flag(colorbar, name="colorbar")
    dots = as_optional_flag(points, name="points")
    numbers = None if values is None else np.asarray(values, dtype=np.float64)
    if numbers is not None and numbers.shape != (diagram.npoints,):
        raise InputError(f"values has shape {numbers.shape} for {diagram.npoints} points")
    shown = _bounded(diagram)
    sites = np.setdiff1d(shown.duplicate_of, shown.hidden)
    rings = [[ring for part in shown.cell(site).parts for ring in part] for site in sites.tolist()]
    look: dict[str, Any] = {"facecolors": "none"} if numbers is None else {"cmap": cmap}
    look["linewidths"] = thin(len(sites)) if linewidth is None else linewidth
    outlines = [_path(each) for each in rings]
    cells = collections.PathCollection(outlines, edgecolors=_EDGE, **look)
    ax = new_axes(ax)
    ax.add_collection(cells, autolim=False)
    if numbers is not None:
        cells.set_array(numbers[sites])
        if bar:
            ax.figure.colorbar(cells, ax=ax, shrink=0.75, pad=0.02)
    draw_dots(ax, diagram.points, dots)
    low, high = _window(shown, rings)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    return ax


def _bounded(diagram: Cells2) -> Cells2:
    """Return a diagram of the same sites whose cells are all bounded."""
    periods = diagram.periods
    if diagram.clip is not None or (periods is not None and None not in periods):
        return diagram
    low, high = _box(diagram)
    if periods is not None:
        # The period bounds the cells in its direction.
        axis = 0 if periods[1] is None else 1
        low[axis], high[axis] = -np.inf, np.inf
    make: Any = type(diagram)
    options = {} if periods is None else {"periods": periods}
    found: Cells2 = make(
        diagram.points, clip=(*low.tolist(), *high.tolist()), weights=diagram.weights, **options
    )
    return found


def _box(diagram: Cells2) -> tuple[Floats, Floats]:
    """Return the box of the sites, with a margin."""
    low, high = diagram.points.min(axis=0), diagram.points.max(axis=0)
    extent = float((high - low).max())
    if diagram.periods is None:
        margin = _MARGIN * extent or 1.0
    else:
        margin = _MARGIN * max(extent, *(each or 0.0 for each in diagram.periods))
    return low - margin, high + margin


def _window(shown: Cells2, rings: list[list[Floats]]) -> tuple[Floats, Floats]:
    """Return the limits: those of the clip, or with periods those of the cells."""
    if shown.periods is None:
        bounds = np.array(getattr(shown.clip, "bounds", shown.clip))
        return bounds[:2], bounds[2:]
    corners = np.concatenate([ring for each in rings for ring in each])
    return corners.min(axis=0), corners.max(axis=0)


def _path(rings: list[Floats]) -> Any:
    """Return rings as one path of matplotlib."""
    make = require("matplotlib.path", extra="plot", what="drawing").Path
    if not rings:
        return make(np.empty((0, 2)))
    closed = [np.concatenate((ring, ring[:1])) for ring in rings]
    codes = [
        np.concatenate(([make.MOVETO], np.full(len(ring) - 1, make.LINETO), [make.CLOSEPOLY]))
        for ring in rings
    ]
    return make(np.concatenate(closed), np.concatenate(codes))


def plot_cells3(
    diagram: Cells3, ax: Any = None, *, off_screen: bool | None = None, **options: Any
) -> Any:
    """Draw the bounded cells of a 3-D Voronoi diagram, slightly shrunk, on a plotter of PyVista."""
    plotter = new_plotter(ax, off_screen=off_screen)
    grid = diagram.to_pyvista()
    look: dict[str, Any] = {"scalars": "site", "show_edges": True, "ambient": 0.4}
    plotter.add_mesh(grid.shrink(0.85), **(look | options))
    return plotter
