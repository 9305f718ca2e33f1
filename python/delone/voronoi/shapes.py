"""Diagrams as tables of geopandas and pictures of matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_flag, as_optional_flag
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.voronoi.diagram import Voronoi

    Floats = NDArray[np.float64]

__all__ = ["chosen", "draw", "shapely_or_say", "table"]

_EDGE, _DOT = "#35506b", "#17324d"
# Beyond the box of the sites, by this share of its longer side, whole diagrams are not drawn.
_MARGIN = 0.1
_MOST_DOTS = 2000


def shapely_or_say() -> Any:
    """Import shapely, or say how to install it."""
    from delone.extras import require

    return require("shapely", extra="geo", what="polygons of Voronoi cells")


def chosen(polygons: NDArray[Any], regions: NDArray[np.int32]) -> NDArray[Any]:
    """Return the geometry of each region number, an empty polygon for -1.

    Parameters
    ----------
    polygons : ndarray of object, shape (c,)
        Geometries.
    regions : ndarray of int32, shape (n,)
        Their numbers, or -1.

    Returns
    -------
    ndarray of object, shape (n,)
        Geometries.
    """
    shapely = shapely_or_say()

    found: NDArray[Any] = np.append(polygons, shapely.Polygon())[regions]
    return found


def table(polygons: NDArray[Any], data: Any, crs: Any) -> Any:
    """Return cells beside the columns of their sites.

    Parameters
    ----------
    polygons : ndarray of object, shape (n,)
        Geometries.
    data : DataFrame, mapping or None
        Columns to carry.
    crs : any
        Reference system; by default that of `data`.

    Returns
    -------
    GeoDataFrame
        A row for each polygon.

    Raises
    ------
    InputError
        `data` has another number of rows.
    """
    from delone.extras import require

    geopandas = require("geopandas", extra="geo", what="a table of cells")
    if data is None:
        return geopandas.GeoDataFrame(geometry=polygons, crs=crs)
    if hasattr(data, "geometry") and hasattr(data, "crs"):
        crs = data.crs if crs is None else crs
        data = data.drop(columns=data.geometry.name)
    frame = (
        data
        if hasattr(data, "index")
        else require("pandas", extra="geo", what="a table of cells").DataFrame(data)
    )
    if len(frame) != len(polygons):
        raise InputError(f"data has {len(frame)} rows for {len(polygons)} points")
    geometry = geopandas.GeoSeries(polygons, index=frame.index, crs=crs)
    return geopandas.GeoDataFrame(frame.copy(), geometry=geometry)


def draw(
    diagram: Voronoi,
    ax: Any = None,
    *,
    values: ArrayLike | None = None,
    cmap: Any = None,
    points: bool | None = None,
    colorbar: bool = True,
    linewidth: float | None = None,
) -> Any:
    """Draw a diagram.

    Parameters
    ----------
    diagram : Voronoi
        What to draw. Without a clip it is drawn as far as the box of the sites and a tenth more.
    ax : matplotlib Axes, optional
        Where to draw; by default on the axes of a new pyplot figure.
    values : array_like of float, shape (n,), optional
        Cells are coloured by them.
    cmap : str or matplotlib Colormap, optional
        Colours of the values.
    points : bool, optional
        Draw the sites. By default where there are few enough to be told apart.
    colorbar : bool, optional
        Add the scale of the colours.
    linewidth : float, optional
        Width of the edges of cells; by default thinner the more cells there are.

    Returns
    -------
    matplotlib Axes
        What was drawn on.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    InputError
        `values` has another length.

    Examples
    --------
    >>> from delone import Voronoi
    >>> diagram = Voronoi([(0, 0), (2, 0), (1, 2)])
    >>> ax = diagram.plot(values=[1, 2, 3], colorbar=False)
    >>> len(ax.collections)
    1
    """
    from delone.extras import require

    bar = as_flag(colorbar, name="colorbar")
    dots = as_optional_flag(points, name="points")
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    paths = require("matplotlib.path", extra="plot", what="drawing")
    if ax is None:
        _, ax = require("matplotlib.pyplot", extra="plot", what="drawing").subplots()
    colours = None if values is None else np.asarray(values, dtype=np.float64)
    if colours is not None and colours.shape != (diagram.npoints,):
        raise InputError(f"values has shape {colours.shape} for {diagram.npoints} points")
    shown, low, high = _drawable(diagram)
    sites = np.setdiff1d(shown.duplicate_of, shown.hidden)
    outlines = [_path(paths.Path, shown, int(site)) for site in sites]
    thin = float(np.clip(30 / np.sqrt(len(sites)), 0.15, 1.0)) if linewidth is None else linewidth
    cells = collections.PathCollection(
        outlines,
        facecolors="none",
        edgecolors=_EDGE,
        linewidths=thin,
    )
    if colours is not None:
        cells = collections.PathCollection(outlines, edgecolors=_EDGE, linewidths=thin, cmap=cmap)
        cells.set_array(colours[sites])
    ax.add_collection(cells, autolim=False)
    if colours is not None and bar:
        ax.figure.colorbar(cells, ax=ax, shrink=0.75, pad=0.02)
    if dots or (dots is None and diagram.npoints <= _MOST_DOTS):
        size = float(np.clip(60 / np.sqrt(diagram.npoints), 0.8, 5.0))
        ax.plot(*diagram.points.T, "o", color=_DOT, markersize=size, markeredgewidth=0, zorder=4)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    return ax


def _drawable(diagram: Voronoi) -> tuple[Voronoi, Floats, Floats]:
    """A diagram of bounded cells, and the window in which it is seen."""
    from delone.voronoi.diagram import Voronoi

    if diagram.periods is not None:
        return _drawable_periodic(diagram, diagram.periods)
    if diagram._clip is not None:
        bounds = np.array(diagram._clip.bounds)
        return diagram, bounds[:2], bounds[2:]
    low, high = diagram.points.min(axis=0), diagram.points.max(axis=0)
    margin = _MARGIN * float((high - low).max()) or 1.0
    low, high = low - margin, high + margin
    return Voronoi(diagram.points, clip=(*low, *high), weights=diagram.weights), low, high


def _drawable_periodic(
    diagram: Voronoi, periods: tuple[float | None, float | None]
) -> tuple[Voronoi, Floats, Floats]:
    """The same with periods: all of the cells, strips to a little beyond the sites."""
    from delone.voronoi.diagram import Voronoi

    if None in periods and diagram._clip is None:
        axis = 0 if periods[1] is None else 1
        low, high = diagram.points.min(axis=0), diagram.points.max(axis=0)
        margin = _MARGIN * max(float((high - low).max()), periods[axis] or 0.0)
        box = np.concatenate((low - margin, high + margin))
        box[[axis, axis + 2]] = -np.inf, np.inf
        diagram = Voronoi(
            diagram.points, clip=box.tolist(), weights=diagram.weights, periodic=periods
        )
    corners = diagram._clipped.corners
    return diagram, corners.min(axis=0), corners.max(axis=0)


def _path(make: Any, diagram: Voronoi, site: int) -> Any:
    """The rings of what is left of a cell, as one path."""
    rings = [
        ring for part in diagram._clipped.parts(int(diagram.point_region[site])) for ring in part
    ]
    if not rings:
        return make(np.empty((0, 2)))
    closed = [np.concatenate((ring, ring[:1])) for ring in rings]
    codes = [
        np.concatenate(([make.MOVETO], np.full(len(ring) - 1, make.LINETO), [make.CLOSEPOLY]))
        for ring in rings
    ]
    return make(np.concatenate(closed), np.concatenate(codes))
