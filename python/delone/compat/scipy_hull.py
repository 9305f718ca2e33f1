"""Drop-in replacement for ``scipy.spatial.ConvexHull``.

>>> from delone.compat.scipy import ConvexHull
>>> hull = ConvexHull([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
>>> hull.vertices.tolist(), hull.volume, hull.area
([0, 1, 2, 3], 12.0, 14.0)

Signatures, attributes, dtypes, errors and the mutability of arrays are those of SciPy. Differences:

* Simplices are in delone's order, and each facet is triangulated by delone's rule.
* Normals are those of whole facets, so coplanar triangles have the same equation.
* `coplanar`, with option ``Qc``, lists the rows that repeat a vertex.
* ``QGn`` is exact: a facet is visible from point n if the point is strictly beyond its plane.
* In 3-D, triangles are counterclockwise as seen from outside.
* Points in more than eight dimensions are rejected.
* `add_points` recomputes the hull.
"""

from __future__ import annotations

import re
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from delone import _core, hull, predicates
from delone._base.arrays import as_workers
from delone._tiling.higher.dimension import MOST
from delone.compat.qhull import Incremental, QhullError, told_as_qhull_does
from delone.compat.qhull_options import HULL
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["ConvexHull"]


class ConvexHull(Incremental):
    """Convex hull with the interface of ``scipy.spatial.ConvexHull``.

    Parameters
    ----------
    points : array_like, shape (npoints, ndim)
        Two to eight coordinates of each point.
    incremental : bool, optional
        Whether `add_points` may be called.
    qhull_options : str, optional
        As in SciPy. Options about rounding have no effect, because nothing is rounded. These
        include ``QbB`` (after which SciPy measures the scaled points), ``C-0`` and ``A-1``. With
        ``Qc``, rows that repeat a vertex are listed in `coplanar`. With ``QGn`` or ``QG-n``, point
        n is left out, and `good` says which facets are, or are not, visible from it. The default is
        ``"Qt"``.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, ndim)
        Coordinates; the given array itself if it has this dtype and layout, as in SciPy.
    vertices : ndarray of int32, shape (nvertices,)
        The extreme points: counter-clockwise in 2-D, otherwise ascending.
    simplices : ndarray of int32, shape (nfacet, ndim)
        The facets: edges, triangles or simplices of more dimensions.
    neighbors : ndarray of int32, shape (nfacet, ndim)
        The facet that shares all vertices but one.
    equations : ndarray of float64, shape (nfacet, ndim + 1)
        Outer normals and offsets.
    coplanar : ndarray of int32, shape (ncoplanar, 3)
        Rows that repeat a vertex, a facet of it, and the vertex.
    good : ndarray of bool, shape (nfacet,), or None
        Which facets are visible, with option ``QGn``.
    area, volume : float
        Surface area and volume; in 2-D perimeter and area.
    ndim, npoints, nsimplex : int
        Sizes.
    min_bound, max_bound : ndarray of float64, shape (ndim,)
        The minimum and maximum coordinates.

    Raises
    ------
    QhullError
        The points span no area, or no volume; a coordinate is infinite; an option is unknown.
    ValueError
        A coordinate is NaN, the array has a wrong shape or dtype, or an option requires a different
        hull.
    DimensionError
        The points have more than eight coordinates. (A NotImplementedError and a ValueError.)

    Notes
    -----
    The documentation of the module lists the differences from SciPy.

    Examples
    --------
    >>> from delone.compat.scipy import ConvexHull
    >>> cube = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> hull = ConvexHull(cube)
    >>> hull.simplices.shape, hull.volume, hull.area
    ((12, 3), 1.0, 6.0)
    """

    _what = HULL
    _most = MOST

    def __init__(
        self,
        points: ArrayLike,
        incremental: bool = False,
        qhull_options: str | None = None,
    ) -> None:
        options, self._viewer = _viewer("Qt" if qhull_options is None else qhull_options)
        self._begin(points, options, incremental)

    def _set(self, points: Floats) -> None:
        rows = np.arange(len(points), dtype=np.int32)
        with told_as_qhull_does(points, self._what):
            if self._viewer is not None:
                if self._viewer[0] >= len(points):
                    raise QhullError(
                        f"option QG names point {self._viewer[0]}, which does not exist"
                    )
                rows = np.delete(rows, self._viewer[0])
            found = hull.ConvexHull(points[rows] if self._viewer else points)
        self._points, self._hull, self._rows = points, found, rows
        self._forget()
        self.ndim, self.npoints, self.nsimplex = found.ndim, len(points), found.nsimplex

    @cached_property
    def vertices(self) -> Indices:
        """The extreme points."""
        return self._rows[self._hull.vertices]

    @cached_property
    def simplices(self) -> Indices:
        """The facets: edges, triangles or simplices of more dimensions."""
        return self._rows[self._hull.simplices]

    @cached_property
    def neighbors(self) -> Indices:
        """The facet that shares all vertices but one."""
        return self._hull.neighbors.copy()

    @cached_property
    def equations(self) -> Floats:
        """Outer normals and offsets."""
        return self._hull.equations.copy()

    @cached_property
    def coplanar(self) -> Indices:
        """Rows that repeat a vertex, a facet of it, and the vertex."""
        if not self._options.coplanar:
            return np.empty((0, 3), dtype=np.int32)
        row, simplex, vertex = self._hull.coplanar.T
        return np.column_stack((self._rows[row], simplex, self._rows[vertex]))

    @cached_property
    def good(self) -> NDArray[np.bool_] | None:
        """Which facets are (or are not) visible from the point of option ``QGn``."""
        if self._viewer is None:
            return None
        row, visible = self._viewer
        a, b = (self._points[self.simplices[:, k]] for k in (0, 1))
        if self.ndim > 3:
            apex = np.full((self.nsimplex, 1), row, dtype=np.int32)
            cones = np.hstack((apex, self.simplices))
            beyond = _core.orientations_n(self._points, cones, as_workers(None)) < 0
        elif self.ndim == 2:
            beyond = predicates.orient2d(a, b, self._points[row]) < 0
        else:
            c = self._points[self.simplices[:, 2]]
            beyond = predicates.orient3d(a, b, c, self._points[row]) > 0
        found: NDArray[np.bool_] = np.equal(beyond, visible)
        return found

    @cached_property
    def volume(self) -> float:
        """The volume; in 2-D the area."""
        return self._hull.volume

    @cached_property
    def area(self) -> float:
        """The surface area; in 2-D the perimeter."""
        return self._hull.area

    @cached_property
    def min_bound(self) -> Floats:
        """The smallest coordinates."""
        bound: Floats = self._points.min(axis=0)
        return bound

    @cached_property
    def max_bound(self) -> Floats:
        """The largest coordinates."""
        bound: Floats = self._points.max(axis=0)
        return bound


def _viewer(options: str) -> tuple[str, tuple[int, bool] | None]:
    """Options without ``QGn``, the point n, and whether visible facets are good."""
    if not isinstance(options, str):
        return options, None
    others, found = [], None
    for option in options.split():
        match = re.fullmatch(r"QG(-?)(\d+)", option)
        if match is None:
            others.append(option)
        elif found is not None:
            raise InputError("option QG is allowed only once")
        else:
            found = (int(match[2]), match[1] == "")
    return " ".join(others), found
