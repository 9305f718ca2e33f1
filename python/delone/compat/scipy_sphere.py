"""Drop-in replacement for ``scipy.spatial.SphericalVoronoi``.

>>> from delone.compat.scipy import SphericalVoronoi
>>> points = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, 1, 0), (0, -1, 0), (-1, 0, 0)]
>>> sv = SphericalVoronoi(points)
>>> sv.vertices.shape, sv.calculate_areas().round(4)[0]
((8, 3), np.float64(2.0944))

`delone.compat.scipy` exports it. Differences from SciPy:

* Facets are those of the exact convex hull of the directions from the center, in delone's order, so
  vertices have a different order; regions are sorted from the start.
* Areas of tiny cells are accurate.
* Points in two dimensions or more than three are rejected.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_workers, require_finite
from delone.compat.qhull import DimensionError
from delone.voronoi.rows import as_lists

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

__all__ = ["SphericalVoronoi"]

# Between generators that are closer, rounded vertices are too coarse for areas: they have relative
# errors of about 1e-16 divided by this distance.
_CLOSE = 1e-3
_DUPLICATES = "Duplicate generators present."


class SphericalVoronoi:
    """Voronoi diagram on a sphere with the interface of ``scipy.spatial.SphericalVoronoi``.

    Parameters
    ----------
    points : array_like, shape (npoints, 3)
        The generators, on the sphere.
    radius : float, optional
        Radius of the sphere.
    center : array_like, shape (3,), optional
        Its center; by default the origin.
    threshold : float, optional
        Relative to the radius: generators that are closer than this are duplicates, and generators
        may be off the sphere by less than this.

    Attributes
    ----------
    points : ndarray of float64, shape (npoints, 3)
        The generators.
    radius : float
        Radius of the sphere.
    center : ndarray of float64, shape (3,)
        Its center.
    vertices : ndarray of float64, shape (2 npoints - 4, 3)
        The vertices, one for each facet of the hull: several may coincide.
    regions : list of list of int
        For each generator the vertices of its region, counter-clockwise seen from outside.

    Raises
    ------
    ValueError
        There are fewer than four generators, or they are on one circle, or some are duplicates or
        not on the sphere; or `radius` is None.
    DimensionError
        The generators do not have three coordinates.
    NonFiniteError
        A coordinate is NaN or infinite.

    See Also
    --------
    delone.sphere.Voronoi : The diagram with distinct vertices, for any input.

    Notes
    -----
    The documentation of the module lists the differences from SciPy.

    Examples
    --------
    >>> from delone.compat.scipy import SphericalVoronoi
    >>> sv = SphericalVoronoi([(2, 0, 0), (-2, 0, 0), (0, 2, 0), (0, 0, 2)], radius=2)
    >>> sv.sort_vertices_of_regions()
    >>> len(sv.vertices), [len(region) for region in sv.regions]
    (4, [3, 3, 3, 3])
    """

    def __init__(
        self,
        points: ArrayLike,
        radius: float = 1,
        center: ArrayLike | None = None,
        threshold: float = 1e-06,
    ) -> None:
        if radius is None:
            raise ValueError(
                "`radius` is `None`. Please provide a floating point number (i.e. `radius=1`)."
            )
        self.radius = float(radius)
        self.points: Floats = np.array(points).astype(np.float64)
        self._dim = self.points.shape[1]
        if self._dim != 3:
            raise DimensionError(
                f"only points with three coordinates are supported, got {self._dim}"
            )
        self.center: Floats
        self.center = np.zeros(3) if center is None else np.array(center, dtype=float)
        # For anything else, computing the rank is a LAPACK error.
        require_finite(self.points)
        require_finite(np.atleast_2d(self.center), name="center")
        tolerance = threshold * self.radius
        self._rank = np.linalg.matrix_rank(self.points - self.points[0], tol=tolerance)
        if self._rank < self._dim:
            raise ValueError(f"Rank of input points must be at least {self._dim}")
        self._vectors = self.points - self.center
        self._refuse_lengths(tolerance)
        workers = as_workers(None)
        mesh = _core.sphere_delaunay(self._vectors, workers)
        if len(mesh.duplicates):
            raise ValueError(_DUPLICATES)
        self._dual = _core.sphere_dual(
            self._vectors, mesh.simplices, mesh.neighbors, False, workers
        )
        self._refuse_duplicates(tolerance)

    def _refuse_lengths(self, tolerance: float) -> None:
        squares = np.einsum("ij,ij->i", self._vectors, self._vectors)
        away = np.sqrt([squares.min(), squares.max()])
        # The triangulation rejects NaN.
        if np.abs(away - self.radius).max() >= tolerance:
            raise ValueError("Radius inconsistent with generators.")

    def _refuse_duplicates(self, tolerance: float) -> None:
        """Compare the ends of edges, which include the closest pair."""
        tails, heads = (_columns(self.points, self._dual.around[:, k]) for k in (0, 1))
        steps = tails - heads
        # Between the two generators of each ridge.
        self._squares: Floats = (steps * steps).sum(axis=0)
        if self._squares.min() <= tolerance**2:
            raise ValueError(_DUPLICATES)

    @property
    def _simplices(self) -> NDArray[np.int32]:
        """The facets of the hull."""
        return self._dual.simplices

    @cached_property
    def _units(self) -> Floats:
        """The unit vectors of the vertices."""
        workers = as_workers(None)
        return _core.sphere_circumcenters(self._vectors, self._dual.simplices, workers)

    @cached_property
    def vertices(self) -> Floats:
        """The vertices, one for each facet of the hull."""
        found: Floats = self.radius * self._units + self.center
        return found

    @cached_property
    def regions(self) -> list[list[int]]:
        """The vertices of each region, counter-clockwise seen from outside."""
        return as_lists(self._dual.starts, self._dual.vertices)

    def sort_vertices_of_regions(self) -> None:
        """Sort the vertices of regions around their generators; they are sorted from the start.

        Examples
        --------
        See the class.
        """

    def calculate_areas(self) -> Floats:
        """Return the areas of the regions, which sum to 4 pi times the square of the radius.

        Returns
        -------
        ndarray of float64, shape (npoints,)
            The areas.

        Examples
        --------
        >>> from delone.compat.scipy import SphericalVoronoi
        >>> points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
        >>> SphericalVoronoi(points).calculate_areas().sum().round(9)
        np.float64(12.566370614)
        """
        workers = as_workers(None)
        dual, units = self._dual, _core.sphere_units(self._vectors, workers)
        corners = (
            _columns(units, dual.around[:, 0]),
            *(_columns(self._units, dual.ends[:, k]) for k in (1, 0)),
        )
        shares = _triangles(*corners)
        close = np.flatnonzero(self._squares < (_CLOSE * self.radius) ** 2)
        spans = _core.sphere_spans(self._vectors, dual.around[close], workers)
        shares[close] = spans[:, 1]
        sites: Any = dual.around[:, :2].ravel()
        found: Any = np.bincount(sites, np.repeat(shares, 2), minlength=len(self.points))
        areas: Floats = found * self.radius**2
        return areas


def _columns(rows: Floats, chosen: NDArray[np.int32]) -> Floats:
    """Return the coordinates of some rows, (3, k)."""
    return np.ascontiguousarray(rows.T).take(chosen, axis=1)


def _triangles(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return the areas of triangles of unit vectors (Van Oosterom and Strackee, 1983)."""
    p, q = b - a, c - a
    volume = a[0] * (p[1] * q[2] - p[2] * q[1])
    volume += a[1] * (p[2] * q[0] - p[0] * q[2])
    volume += a[2] * (p[0] * q[1] - p[1] * q[0])
    found: Floats = 2 * np.arctan2(volume, 1 + (a * b).sum(0) + (a * c).sum(0) + (b * c).sum(0))
    return found
