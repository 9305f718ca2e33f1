"""Graphs: lines between points, in 2-D and 3-D."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_flag, as_optional_flag
from delone._base.extras import require
from delone._base.values import as_values
from delone.errors import InputError
from delone.plot.axes import draw_dots, frame, new_axes, require_bounds, thin
from delone.plot.plotter import add_points, as_pyvista_cmap, new_plotter
from delone.plot.style import EDGES

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone.plot.protocols import Linked

__all__ = ["plot_graph2", "plot_graph3"]

_LINE = "#2b6ca3"


def plot_graph2(
    graph: Linked,
    ax: Any = None,
    *,
    values: ArrayLike | None = None,
    cmap: Any = "viridis",
    colorbar: bool = True,
    vertices: bool | None = None,
    title: str | None = None,
) -> Any:
    """Draw the edges of a 2-D graph; for the options see `delone.plot.plot`."""
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    dots, bar = as_optional_flag(vertices, name="vertices"), as_flag(colorbar, name="colorbar")
    chosen = as_values(values, len(graph.edges), name="values")
    _require_points(graph)
    low, high = graph.points.min(axis=0), graph.points.max(axis=0)
    extent = float(np.max(high / 2 - low / 2)) * 2
    if extent == 0:  # one place
        extent = 1.0
        low, high = low - 0.5, high + 0.5
    require_bounds(low, high)
    ax = new_axes(ax)
    width = 2 * thin(len(graph.edges))
    lines = collections.LineCollection(
        graph.points[graph.edges], linewidths=width, capstyle="round", zorder=2, gid=EDGES
    )
    if chosen is None:
        lines.set_color(_LINE)
    else:
        lines.set(array=chosen, cmap=cmap)
    ax.add_collection(lines)
    draw_dots(ax, graph.points, dots)
    if chosen is not None and bar:
        ax.figure.colorbar(lines, ax=ax)
    frame(ax, low, high, title, margin=0.02 * extent)
    return ax


def plot_graph3(
    graph: Linked,
    ax: Any = None,
    *,
    values: ArrayLike | None = None,
    cmap: Any = "viridis",
    colorbar: bool = True,
    color: Any = _LINE,
    linewidth: float = 2.0,
    vertices: bool | None = None,
    off_screen: bool | None = None,
) -> Any:
    """Draw the edges of a 3-D graph; for the options see `delone.plot.plot`."""
    pyvista = require("pyvista", extra="pyvista", what="drawing in 3-D")
    dots, bar = as_optional_flag(vertices, name="vertices"), as_flag(colorbar, name="colorbar")
    chosen, colors = as_values(values, len(graph.edges), name="values"), as_pyvista_cmap(cmap)
    _require_points(graph)
    plotter = new_plotter(ax, off_screen=off_screen)
    if len(graph.edges):
        cells = np.column_stack((np.full(len(graph.edges), 2), graph.edges)).ravel()
        mesh = pyvista.PolyData(np.array(graph.points), lines=cells)
        look: dict[str, Any] = {"color": color}
        if chosen is not None:
            mesh.cell_data["values"] = chosen
            look = {"scalars": "values", "cmap": colors, "show_scalar_bar": bar}
        plotter.add_mesh(mesh, line_width=linewidth, **look)
    if dots or dots is None:
        add_points(plotter, graph.points)
    return plotter


def _require_points(graph: Linked) -> None:
    if not len(graph.points):
        raise InputError("there is nothing to draw: the graph has no points")
