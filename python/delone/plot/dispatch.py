"""One function that plots anything: 2-D with matplotlib, 3-D with PyVista."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

from delone.errors import InputError
from delone.plot import tetrahedra, triangles
from delone.plot.cells import plot_cells2, plot_cells3
from delone.plot.graph import plot_graph2, plot_graph3
from delone.plot.hull import plot_hull
from delone.plot.periodic import plot_periodic
from delone.plot.protocols import hint, kind_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone.plot.protocols import Cells2, Cells3, Hull2, Linked, Periodic, Simplices, Triangles

__all__ = ["plot"]

_DRAWERS: dict[str, Callable[..., Any]] = {
    "triangles": triangles.plot,
    "tetrahedra": tetrahedra.plot,
    "hull": plot_hull,
    "periodic": plot_periodic,
    "cells2": plot_cells2,
    "cells3": plot_cells3,
    "graph2": plot_graph2,
    "graph3": plot_graph3,
}


def plot(
    mesh: Simplices | Triangles | Hull2 | Periodic | Cells2 | Cells3 | Linked,
    ax: Any = None,
    **options: Any,
) -> Any:
    """Draw a triangulation, mesh, convex hull, Voronoi diagram or graph, in 2-D or 3-D.

    Parameters
    ----------
    mesh : object
        What to draw: a `Delaunay`, `RegularTriangulation`, `ConstrainedDelaunay`, `Mesh`,
        `TetMesh`, `PeriodicDelaunay`, `ConvexHull`, `Voronoi` or `graphs.Graph`, or an object with
        the same attributes.
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
    save_picture : Draw a 2-D triangulation into a file.
    draw, image : Draw in 3-D into a file or an array.

    Notes
    -----
    2-D triangulations and meshes:

    - ``z``, array_like of shape (n,): color triangles by the heights of their points
    - ``cmap``, ``colorbar``, ``shade``: the colors of z, the color bar, light and shadow. Light and
      shadow change the colors, so they are for terrain; by default they are added only with
      ``colorbar=False`` and at least 2000 triangles
    - ``hull``: the convex hull, or the boundary of a constrained triangulation
    - ``segments``: the segments of a constrained triangulation, bold
    - ``circumcircles``: the circle through the corners of each triangle, up to 3000
    - ``vertices``: the points; by default up to 2000
    - ``title``

    If triangles are smaller than 14 pixels on average, an image is drawn: the surface of z, or
    without z the density of points. The color scale spans the values without the lowest and the
    highest hundredth, which have the colors of its ends. Constrained triangulations without z have
    their regions in colors, such that regions on both sides of a segment differ; triangles without
    a label are gray, holes stay white.

    3-D triangulations, meshes and convex hulls:

    - ``values``, array_like of shape (n,) or (m,): color by a number for each point or simplex
    - ``cmap``, ``colorbar``: the colors of values, the color bar
    - ``cut``, ``"x"``, ``"y"`` or ``"z"``: leave out the farther half along this axis
    - ``shrink``, up to 1: share of the size at which each simplex is drawn
    - ``below``: draw only the tetrahedra whose smallest dihedral angle is below this many degrees,
      within the translucent surface
    - ``points``: the points
    - ``off_screen``: whether a new plotter draws without a window

    2-D convex hulls and periodic triangulations: ``vertices``, ``title``; the latter also have
    ``box``, the outline of a period.

    2-D Voronoi diagrams: ``values``, array_like of shape (n,), ``cmap``, ``colorbar``; ``points``,
    the sites, by default up to 2000; ``linewidth``. Without a clip they are drawn in the bounding
    box of the sites, enlarged by a tenth. 3-D Voronoi diagrams: ``off_screen``, and the options of
    ``pyvista.Plotter.add_mesh``; bounded cells are drawn, or the sites if there are none.

    Graphs: ``values``, array_like of shape (m,): color edges by numbers such as ``graph.lengths``;
    ``cmap``, ``colorbar``; ``color`` and ``linewidth`` of edges; ``vertices``; in 2-D ``title``, in
    3-D ``off_screen``.

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
        name = f"{type(mesh).__module__}.{type(mesh).__name__}"
        raise InputError(f"an object of type {name} cannot be drawn: {hint(mesh)}")
    _require_options(drawer, mesh, options)
    return drawer(mesh, ax, **options)


def _require_options(drawer: Callable[..., Any], mesh: Any, options: dict[str, Any]) -> None:
    """Refuse options that do not exist for this object, and list those that do.

    A drawer that passes options on to a library checks them itself.
    """
    parameters = inspect.signature(drawer).parameters.values()
    if any(each.kind is each.VAR_KEYWORD for each in parameters):
        return
    known = [each.name for each in parameters if each.kind is each.KEYWORD_ONLY]
    for name in options:
        if name not in known:
            raise InputError(
                f"{name} is not an option of plotting this {type(mesh).__name__}; its options are "
                f"{', '.join(known)}"
            )
