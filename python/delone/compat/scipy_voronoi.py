"""Drop-in replacements for ``scipy.spatial.Voronoi`` and ``voronoi_plot_2d``.

`delone.compat.scipy` exports both. Differences from SciPy:

* Sites on one circle or sphere share one vertex whatever their coordinates, so every ridge has a
  positive length or area, and vertices, ridges and regions are in delone's order.
* From 3-D on every ridge is listed; Qhull omits unbounded ones with fewer than d - 1 vertices.
* Furthest-site diagrams are only available in 2-D.
* Every distinct point has a region; duplicates share that of their first row, as in SciPy.
* Points with more than eight coordinates are rejected.
* `add_points` recomputes the diagram.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.duplicates import first_rows
from delone._base.extras import require
from delone._tiling.higher.dimension import MOST
from delone._tiling.higher.dual import DiagramN
from delone.compat.qhull import Incremental, triangulate
from delone.compat.qhull_options import VORONOI
from delone.compat.scipy_plot import framed, points_and_axes
from delone.voronoi.higher import of_mesh
from delone.voronoi.rows import as_lists, from_the_gap, one_gap

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Voronoi", "voronoi_plot_2d"]

_SPACE = 3


class Voronoi(Incremental):
    """Voronoi diagram with the interface of ``scipy.spatial.Voronoi``.

    Parameters
    ----------
    points : array_like, shape (npoints, ndim)
        The sites, with two to eight coordinates.
    furthest_site : bool, optional
        Whether to compute the furthest-site diagram, in which each cell is nearer to all other
        sites. Only available in 2-D.
    incremental : bool, optional
        Whether `add_points` may be called.
    qhull_options : str, optional
        As in SciPy, and as for `delone.compat.scipy.Delaunay`. With ``Qz``, which is in the default
        ``"Qbb Qc Qz"`` (but not in incremental mode), the first region is the empty one of a point
        at infinity. Without ``Qc`` a duplicate has the region -1.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, ndim)
        The sites; the given array itself if it has this dtype and layout, as in SciPy.
    vertices : ndarray of float64, shape (nvertices, ndim)
        Vertices, accurate to a few units in the last place.
    ridge_points : ndarray of int32, shape (nridges, 2)
        The two sites of each ridge.
    ridge_vertices : list of list of int
        The vertices of each ridge, two in 2-D, in 3-D all in order around it, in more dimensions
        ascending; -1, which is first, if it is unbounded.
    ridge_dict : dict
        The vertices of each ridge keyed by the pair of its sites.
    regions : list of list of int
        The vertices of each region, in 2-D in order around it; -1 if it is unbounded.
    point_region : ndarray of int64, shape (npoints,)
        The region of each site.
    furthest_site : bool
        As given.
    ndim, npoints : int
        Sizes.
    min_bound, max_bound : ndarray of float64, shape (ndim,)
        The minimum and maximum coordinates.

    Raises
    ------
    QhullError
        The points span no area, in 3-D no volume, or lie in a flat; a coordinate is infinite; an
        option is unknown. (`delone.Voronoi` supports any number of sites in 2-D.)
    ValueError
        A coordinate is NaN, the array has a wrong shape or dtype, or an option requires a different
        diagram.
    DimensionError
        The points have more than eight coordinates, or more than two if `furthest_site` is set.

    Notes
    -----
    The documentation of the module lists the differences from SciPy.

    Examples
    --------
    >>> from delone.compat.scipy import Voronoi
    >>> points = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)]
    >>> vor = Voronoi(points)
    >>> sorted(vor.vertices.tolist())
    [[0.5, 0.5], [0.5, 1.5], [1.5, 0.5], [1.5, 1.5]]
    >>> len(vor.ridge_points), vor.regions[0], len(vor.regions[vor.point_region[4]])
    (12, [], 4)
    """

    _what = VORONOI
    _most = MOST

    def __init__(
        self,
        points: ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
    ) -> None:
        self.furthest_site = bool(furthest_site)
        if qhull_options is None:
            qhull_options = "Qc" if incremental else "Qbb Qc Qz"
        self._begin(points, qhull_options, incremental)

    def _set(self, points: Floats) -> None:
        mesh = triangulate(points, self.furthest_site, self._what)
        given = mesh.points, None, mesh.simplices, mesh.neighbors, as_workers(None)
        self._dual: _core.Diagram2 | _core.Diagram3 | DiagramN
        if mesh.ndim > _SPACE:
            self._dual = of_mesh(mesh)
        else:
            self._dual = _core.voronoi2(*given) if mesh.ndim == 2 else _core.voronoi3(*given)
        self._points, self._mesh = points, mesh
        self._forget()
        self.ndim, self.npoints = mesh.ndim, mesh.npoints

    @cached_property
    def vertices(self) -> Floats:
        """Vertices."""
        return self._dual.vertices.copy()

    @cached_property
    def ridge_points(self) -> Indices:
        """The two sites of each ridge."""
        return self._dual.sites.copy()

    @cached_property
    def ridge_vertices(self) -> list[list[int]]:
        """The vertices of each ridge; -1, which comes first, where it is unbounded."""
        if isinstance(self._dual, _core.Diagram3):
            return as_lists(*from_the_gap(self._dual.ridge_starts, self._dual.ridge_entries))
        if isinstance(self._dual, DiagramN):
            return as_lists(self._dual.ridge_starts, self._dual.ridge_entries)
        found: list[list[int]] = np.maximum(self._dual.ends, -1).tolist()
        return found

    @cached_property
    def ridge_dict(self) -> dict[tuple[int, ...], list[int]]:
        """The vertices of each ridge keyed by the pair of its sites."""
        pairs = map(tuple, self.ridge_points.tolist())
        return dict(zip(pairs, self.ridge_vertices, strict=True))

    @cached_property
    def _regions(self) -> tuple[list[list[int]], NDArray[np.int64]]:
        cells = as_lists(*one_gap(self._dual.region_starts, self._dual.region_vertices))
        of_point = self._dual.region.astype(np.int64)
        infinite = self._options.infinite_point and not self.furthest_site
        lists: list[list[int]] = [[]] if infinite else []
        of_point[of_point >= 0] += len(lists)
        lists += cells
        # Sites without a cell (inner ones of a furthest-site diagram) have an empty one each.
        rows = np.flatnonzero((of_point < 0) & (self._first_rows == np.arange(self.npoints)))
        of_point[rows] = len(lists) + np.arange(len(rows))
        lists += [[] for _ in rows]
        if self._options.coplanar:
            return lists, of_point[self._first_rows]
        return lists, of_point

    @cached_property
    def _first_rows(self) -> NDArray[np.int64]:
        return first_rows(self._mesh.points)

    @property
    def regions(self) -> list[list[int]]:
        """The vertices of each region; -1 if it is unbounded."""
        return self._regions[0]

    @property
    def point_region(self) -> NDArray[np.int64]:
        """The region of each site."""
        return self._regions[1]

    @cached_property
    def min_bound(self) -> Floats:
        """The smallest coordinates."""
        return self._mesh.min_bound.copy()

    @cached_property
    def max_bound(self) -> Floats:
        """The largest coordinates."""
        return self._mesh.max_bound.copy()


def voronoi_plot_2d(vor: Any, ax: Any = None, **kw: Any) -> Any:
    """Plot a Voronoi diagram as SciPy does.

    Parameters
    ----------
    vor : Voronoi
        A diagram; those of SciPy and `delone.Voronoi` are accepted as well.
    ax : matplotlib Axes, optional
        Axes to draw on; by default new ones.
    **kw
        ``show_points``, ``show_vertices`` (bool), ``line_colors``, ``line_width``, ``line_alpha``,
        ``point_size``: as in SciPy.

    Returns
    -------
    matplotlib Figure
        The figure of the axes.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    ValueError
        The diagram is not 2-D.

    Notes
    -----
    Unbounded ridges are dashed and as long as in SciPy: the longer side of the bounding box of the
    sites times its aspect ratio, away from the mean of all sites.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from delone.compat.scipy import Voronoi, voronoi_plot_2d
    >>> figure = voronoi_plot_2d(Voronoi([(0, 0), (0, 1), (1, 0), (1, 1)]))
    >>> len(figure.axes[0].collections)
    2
    """
    lines = require("matplotlib.collections", extra="plot", what="drawing")
    points, ax = points_and_axes(vor, ax, "Voronoi diagram")
    if kw.get("show_points", True):
        ax.plot(*points.T, ".", markersize=kw.get("point_size"))
    if kw.get("show_vertices", True):
        ax.plot(*vor.vertices.T, "o")
    look = {
        "colors": kw.get("line_colors", "k"),
        "lw": kw.get("line_width", 1.0),
        "alpha": kw.get("line_alpha", 1.0),
    }
    pairs = np.asarray(vor.ridge_vertices).reshape(-1, 2)
    finite = (pairs >= 0).all(axis=1)
    inner = [*vor.vertices[pairs[finite]]]
    ax.add_collection(lines.LineCollection(inner, linestyle="solid", **look))
    outer = [*_far_segments(vor, pairs)]
    ax.add_collection(lines.LineCollection(outer, linestyle="dashed", **look))
    return framed(points, ax)


def _far_segments(vor: Any, pairs: Indices) -> Floats:
    """The unbounded ridges with a vertex, up to their drawn ends."""
    rows = np.flatnonzero((pairs < 0).any(axis=1) & (pairs >= 0).any(axis=1))
    start = vor.vertices[pairs[rows].max(axis=1)]
    first, second = vor.points[np.asarray(vor.ridge_points)[rows]].swapaxes(0, 1)
    along = second - first
    along = along / np.hypot(*along.T)[:, None]
    normal = np.column_stack((-along[:, 1], along[:, 0]))
    outward = ((first + second) / 2 - vor.points.mean(axis=0)) * normal
    sign = np.sign(outward.sum(axis=1))
    if vor.furthest_site:
        sign = -sign
    extent = np.ptp(vor.points, axis=0)
    with np.errstate(divide="ignore"):
        reach = extent.max() * abs(extent.max() / extent.min())
    end = start + sign[:, None] * normal * reach
    segments: Floats = np.stack((start, end), axis=1)
    return segments
