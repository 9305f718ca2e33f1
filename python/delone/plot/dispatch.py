"""One function that plots anything: 2-D with matplotlib, 3-D with PyVista."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

from delone.errors import InputError
from delone.plot import tetrahedra, triangles
from delone.plot.cells import plot_cells2, plot_cells3
from delone.plot.graph import plot_graph2, plot_graph3
from delone.plot.hull import plot_hull
from delone.plot.kept import plot_kept
from delone.plot.periodic import plot_periodic
from delone.plot.protocols import hint, kind_of
from delone.plot.style import EDGES, require_style, restyle

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone.plot.protocols import (
        Cells2,
        Cells3,
        Hull2,
        Linked,
        Outlined,
        Periodic,
        Simplices,
        Triangles,
    )

__all__ = ["plot"]

_SPACE = 3
_DRAWERS: dict[str, Callable[..., Any]] = {
    "triangles": triangles.plot,
    "tetrahedra": tetrahedra.plot,
    "hull": plot_hull,
    "kept": plot_kept,
    "periodic": plot_periodic,
    "cells2": plot_cells2,
    "cells3": plot_cells3,
    "graph2": plot_graph2,
    "graph3": plot_graph3,
}


def plot(
    mesh: Simplices | Triangles | Hull2 | Periodic | Cells2 | Cells3 | Linked | Outlined,
    ax: Any = None,
    **options: Any,
) -> Any:
    """Draw a triangulation, mesh, convex hull, Voronoi diagram or graph, in 2-D or 3-D.

    Parameters
    ----------
    mesh : object
        What to draw: a `Delaunay`, `RegularTriangulation`, `ConstrainedDelaunay`, `Mesh`,
        `TetMesh`, `PeriodicDelaunay`, `ConvexHull`, `AlphaShape`, `ConcaveHull`, `Voronoi` or
        `graphs.Graph`, or an object with the same attributes.
    ax : matplotlib Axes or pyvista Plotter, optional
        Where to draw; by default on a new one.
    **options
        What is drawn, and how; see Notes.

    Returns
    -------
    matplotlib Axes or pyvista Plotter
        Where it is drawn: matplotlib (extra ``plot``) in 2-D, PyVista (extra ``pyvista``) in 3-D,
        where ``show()`` opens the window.

    Raises
    ------
    MissingExtraError
        The library is not installed.
    InputError
        `mesh` cannot be drawn, an option does not exist for it, or the value of an option is wrong.

    See Also
    --------
    save_picture : Draw a 2-D triangulation to a file.
    draw, image : Draw in 3-D to a file or an array.

    Notes
    -----
    2-D triangulations and meshes:

    - ``z``, array_like of shape (n,): color triangles by the heights of their points
    - ``cmap``, ``colorbar``, ``shade``: the colors of z, the color bar, light and shadow. Light and
      shadow change the colors, so they are for terrain; by default they are added only with
      ``colorbar=False`` and at least 2000 triangles
    - ``edges``: the edges of triangles; by default if these are large enough to see
    - ``hull``: the convex hull, or the boundary of a constrained triangulation
    - ``segments``: the segments of a constrained triangulation, bold
    - ``circumcircles``: the circle through the corners of each triangle, up to 3000
    - ``vertices``: the points; by default up to 2000
    - ``title``

    If triangles are smaller than 14 pixels on average, an image is drawn: the surface of z, or
    without z the density of points. The color scale spans the values from the 1st to the 99th
    percentile; values beyond have the colors of its ends. In constrained triangulations without z,
    regions are colored so that those on both sides of a segment differ; triangles without a label
    are gray, and holes are white.

    3-D triangulations, meshes and convex hulls:

    - ``values``, array_like of shape (n,) or (m,): color by a number for each point or simplex
    - ``cmap``, ``colorbar``: the colors of values, the color bar
    - ``cut``, ``"x"``, ``"y"`` or ``"z"``: omit the half with the larger coordinates on this axis
    - ``shrink``, up to 1: the fraction of its size at which each simplex is drawn
    - ``below``: draw only the tetrahedra whose smallest dihedral angle is below this many degrees,
      within the translucent surface
    - ``points``: the points
    - ``off_screen``: whether a new plotter draws without a window

    2-D convex and concave hulls, alpha shapes and periodic triangulations: ``vertices``, ``title``;
    the latter also have ``box``, the outline of a period.

    2-D Voronoi diagrams: ``values``, array_like of shape (n,), ``cmap``, ``colorbar``; ``points``,
    the sites, by default up to 2000; ``linewidth``. Without a clip, they are drawn in the bounding
    box of the sites, enlarged by 10 %. 3-D Voronoi diagrams: ``off_screen``, and the options of
    ``pyvista.Plotter.add_mesh``; bounded cells are drawn, or the sites if there are none.

    Graphs: ``values``, array_like of shape (m,): color edges by numbers such as ``graph.lengths``;
    ``cmap``, ``colorbar``; ``vertices``; in 2-D ``title``, in 3-D ``color`` and ``linewidth`` of
    edges and ``off_screen``.

    In 2-D, properties of matplotlib's lines, such as ``color``, ``linewidth``, ``linestyle``,
    ``alpha`` and ``zorder``, are those of edges and of the outlines of cells; ``facecolor`` is the
    color of cells and periodic triangles.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from delone import Delaunay, Voronoi
    >>> from delone.plot import plot
    >>> points = [(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)]
    >>> ax = plot(Delaunay(points), circumcircles=True)
    >>> ax = plot(Voronoi(points), ax)
    >>> ax.get_aspect()
    1.0
    """
    drawer = _DRAWERS.get(kind_of(mesh))
    if drawer is None:
        ndim = getattr(mesh, "ndim", 0)
        if isinstance(ndim, int) and ndim > _SPACE and hasattr(mesh, "simplices"):
            raise InputError(
                f"simplices in {ndim}-D cannot be drawn: draw two or three of the columns of "
                "the points"
            )
        name = f"{type(mesh).__module__}.{type(mesh).__name__}"
        raise InputError(f"an object of type {name} cannot be drawn: {hint(mesh)}")
    known = _known(drawer)
    if known is None:
        return drawer(mesh, ax, **options)
    style = {name: value for name, value in options.items() if name not in known}
    if not style:
        return drawer(mesh, ax, **options)
    what = f"this {type(mesh).__name__}"
    if "off_screen" in known:
        raise InputError(
            f"{next(iter(style))} is not an option of plotting {what}; its options are "
            f"{', '.join(known)}"
        )
    require_style(style, what, known)
    own = {name: value for name, value in options.items() if name in known}
    if "edges" in known:
        own.setdefault("edges", True)
    before = set(ax.get_children()) if hasattr(ax, "get_children") else set()
    drawn = drawer(mesh, ax, **own)
    new = [each for each in drawn.get_children() if each not in before]
    restyle([each for each in new if each.get_gid() == EDGES], style)
    return drawn


def _known(drawer: Callable[..., Any]) -> dict[str, None] | None:
    """Return the options of a drawer, in their order; None if it passes others on to a library."""
    parameters = inspect.signature(drawer).parameters.values()
    if any(each.kind is each.VAR_KEYWORD for each in parameters):
        return None
    return {each.name: None for each in parameters if each.kind is each.KEYWORD_ONLY}
