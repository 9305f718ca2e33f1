"""Voronoi cells: polygons in 2-D, polyhedra in 3-D."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_flag, as_number, as_optional_flag
from delone._base.extras import require
from delone._base.values import as_values
from delone.errors import InputError
from delone.plot.axes import draw_dots, new_axes, require_bounds, thin
from delone.plot.colors import as_cmap
from delone.plot.plotter import add_points, as_pyvista_cmap, new_plotter
from delone.plot.style import EDGES

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats
    from delone.plot.protocols import Cells2, Cells3

__all__ = ["plot_cells2", "plot_cells3"]

_EDGE = "#35506b"
# Parameters of PyVista's `add_mesh` that are not options here, and options that it does not name.
_TAKEN = frozenset({"self", "mesh", "kwargs"})
_UNNAMED = frozenset({"feature_angle", "vertex_color", "vertex_opacity", "vertex_style"})
# Unbounded cells are drawn up to this fraction of the longer side of the box of the sites.
_MARGIN = 0.1
# And at least up to this number of spacings of their coordinates.
_SPACINGS = 8


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
    numbers, colors = as_values(values, diagram.npoints, name="values"), as_cmap(cmap)
    width = None if linewidth is None else as_number(linewidth, name="linewidth")
    shown = _bounded(diagram)
    sites = np.setdiff1d(shown.duplicate_of, shown.hidden)
    rings = [[ring for part in shown.cell(site).parts for ring in part] for site in sites.tolist()]
    low, high = _window(shown, rings)
    require_bounds(low, high)
    look: dict[str, Any] = {"facecolors": "none"} if numbers is None else {"cmap": colors}
    look["linewidths"] = thin(len(sites)) if width is None else width
    outlines = [_path(each) for each in rings]
    cells = collections.PathCollection(outlines, edgecolors=_EDGE, gid=EDGES, **look)
    ax = new_axes(ax)
    ax.add_collection(cells, autolim=False)
    if numbers is not None:
        cells.set_array(numbers[sites])
        if bar:
            ax.figure.colorbar(cells, ax=ax, shrink=0.75, pad=0.02)
    draw_dots(ax, diagram.points, dots)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    return ax


def _bounded(diagram: Cells2) -> Cells2:
    """Return a diagram of the same sites whose cells are all bounded."""
    periods = diagram.periods
    if diagram.clip is not None or (periods is not None and None not in periods):
        return diagram
    low, high = _box(diagram)
    require_bounds(low, high)
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
    with np.errstate(over="ignore"):
        extent = max(float((high - low).max()), *(each or 0.0 for each in diagram.periods or (0,)))
        # Even the box of sites on a line far from the origin has a width.
        least = _SPACINGS * float(np.spacing(np.abs((low, high)).max()))
        margin = max(_MARGIN * extent or 1.0, least)
        return low - margin, high + margin


def _window(shown: Cells2, rings: list[list[Floats]]) -> tuple[Floats, Floats]:
    """Return the limits: those of the clip or, with periods, those of the cells."""
    if shown.periods is None:
        bounds = np.array(getattr(shown.clip, "bounds", shown.clip))
        return bounds[:2], bounds[2:]
    corners = np.concatenate([ring for each in rings for ring in each])
    return corners.min(axis=0), corners.max(axis=0)


def _path(rings: list[Floats]) -> Any:
    """Return rings as one matplotlib path."""
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
    """Draw the bounded cells of a 3-D Voronoi diagram, slightly shrunk, on a PyVista plotter.

    If no cell is bounded, the sites are drawn.
    """
    wanted = _known(options)
    plotter = new_plotter(ax, off_screen=off_screen)
    grid = diagram.to_pyvista()
    if not grid.n_cells:
        add_points(plotter, diagram.points)
        return plotter
    look: dict[str, Any] = {"scalars": "site", "show_edges": True, "ambient": 0.4}
    plotter.add_mesh(grid.shrink(0.85), **(look | wanted))
    return plotter


def _known(options: dict[str, Any]) -> dict[str, Any]:
    """Return options that PyVista's `add_mesh` takes; reject others, and unknown colormaps."""
    pyvista = require("pyvista", extra="pyvista", what="drawing in 3-D")
    known = (_UNNAMED | set(inspect.signature(pyvista.Plotter.add_mesh).parameters)) - _TAKEN
    for name in options:
        if name not in known:
            raise InputError(
                f"{name} is not an option of plotting this Voronoi diagram; its options are "
                "off_screen, and those of pyvista.Plotter.add_mesh, such as scalars, color, cmap "
                "and opacity"
            )
    return options | {"cmap": as_pyvista_cmap(options.get("cmap"))}
