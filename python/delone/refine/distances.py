"""Sizes that grow with the distance from chosen points, segments or faces."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import (
    as_plain_array,
    as_points,
    as_segments,
    as_simplices,
    as_workers,
    require_finite,
    wrong_shape,
)
from delone._base.numbers import as_positive
from delone.constrained import geodata
from delone.errors import InputError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["SizeByDistance"]

_SEGMENT, _TRIANGLE = 2, 3


class _Places(NamedTuple):
    """Where sizes are smallest: points (n, 2) or (n, 3), and triangles of them."""

    points: Floats
    # (m, 3): with a vertex twice for segments, and three times for points.
    cells: Indices


class SizeByDistance:
    """A size that grows with the distance from chosen points, segments or faces.

    A function of positions, for ``size=`` of `mesh`, `Mesh.refine`, `tetrahedralize` and
    `TetMesh.refine`: the size is ``near`` on the chosen parts and ``near + growth * distance``
    elsewhere, up to ``far``.

    Parameters
    ----------
    places : array_like of float, shape (n, 2) or (n, 3), or geometries
        Points. Or, in 2-D, shapely geometries, a GeoDataFrame or GeoSeries, or mappings with
        coordinates: distances are from their points, lines and the boundaries of their polygons,
        and heights are ignored, as are missing and empty geometries.
    cells : array_like of int, shape (m, 2) or (m, 3), optional
        Segments or triangles, rows of points, from which distances are measured. By default
        they are measured from the points.
    near : float
        The size at distance 0.
    growth : float, optional
        By how much the size grows with the distance. The edges of neighbors differ by about
        this share, so values above 1 are of little use.
    far : float, optional
        The largest size; by default infinite.
    workers : int, optional
        Number of threads; by default one per core. The result does not depend on it.

    Attributes
    ----------
    ndim : int
        The number of coordinates, 2 or 3.
    near, growth, far : float
        As given.

    Raises
    ------
    InputError
        There are no points or cells; a number is not positive; or `far` is below `near`.
    ShapeError, DtypeError, NonFiniteError
        The arrays are not such coordinates and rows.
    MissingExtraError
        Geometries are given, and shapely is not installed.

    Notes
    -----
    Distances are in the unit of the coordinates, rounded to doubles. A tree of boxes finds the
    nearest part, in about O(log m) for each position. A size that is this smooth cannot
    be missed between the positions at which a refinement asks for it.

    For several sizes, use the smallest: ``lambda xy: np.minimum(one(xy), other(xy))``.

    Examples
    --------
    Small triangles at one corner of a square, and in 3-D at one face of a cube:

    >>> import delone
    >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    >>> size = delone.SizeByDistance([(0, 0)], near=0.02, growth=0.3)
    >>> size([(0, 0), (0.3, 0.4)]).round(9).tolist()
    [0.02, 0.17]
    >>> bool(delone.mesh(square, size=size).report)
    True

    >>> points = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> cube = delone.ConvexHull(points)
    >>> bottom = cube.simplices[(cube.points[cube.simplices, 2] == 0).all(axis=1)]
    >>> size = delone.SizeByDistance(cube.points, bottom, near=0.1, growth=0.4)
    >>> mesh = delone.tetrahedralize(cube.points, cube.simplices, boundary="surface", size=size)
    >>> bool(mesh.report)
    True
    """

    def __init__(
        self,
        places: Any,
        cells: ArrayLike | None = None,
        *,
        near: float,
        growth: float = 0.3,
        far: float = math.inf,
        workers: int | None = None,
    ) -> None:
        self.near = as_positive(near, name="near", finite=True)
        self.growth = as_positive(growth, name="growth", finite=True)
        self.far = as_positive(far, name="far")
        if self.far < self.near:
            raise InputError(f"far is {self.far}, below near, which is {self.near}")
        as_workers(workers)
        self._workers = workers
        self._places = _given(places, cells)
        self.ndim = self._places.points.shape[1]
        self._tree: _core.Distances3 | None = None

    def __call__(self, xi: ArrayLike) -> NDArray[np.float64]:
        """Return the size at each position, (k, ndim)."""
        with np.errstate(over="ignore"):  # such sizes are infinite
            sizes = self.near + self.growth * self.distance(xi)
        return np.minimum(sizes, self.far)

    def distance(self, xi: ArrayLike) -> NDArray[np.float64]:
        """Return the distance of positions from the nearest chosen part.

        Parameters
        ----------
        xi : array_like of float, shape (k, ndim)
            Positions.

        Returns
        -------
        ndarray of float64, shape (k,)
            The distances, rounded; infinite beyond the doubles.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError
            The positions are not such an array.

        Examples
        --------
        >>> import delone
        >>> size = delone.SizeByDistance([(0, 0), (4, 0)], [(0, 1)], near=0.1)
        >>> size.distance([(2, 1), (7, 4)]).round(9).tolist()
        [1.0, 5.0]
        """
        other = _SEGMENT + _TRIANGLE - self.ndim
        if isinstance(xi, np.ndarray) and xi.ndim == _SEGMENT and xi.shape[1] == other:
            raise ShapeError(
                f"xi has {other} coordinates, the places of the SizeByDistance have {self.ndim}"
            )
        given = as_points(xi, ndim=self.ndim, name="xi")
        require_finite(given, name="xi")
        if self._tree is None:
            self._tree = _core.Distances3(_spatial(self._places.points), self._places.cells)
        return self._tree.of(_spatial(given), as_workers(self._workers))

    def __repr__(self) -> str:
        far = "" if math.isinf(self.far) else f", far={self.far:g}"
        return f"<SizeByDistance near={self.near:g}, growth={self.growth:g}{far}>"

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_tree": None}


def _given(places: Any, cells: ArrayLike | None) -> _Places:
    found = _of_geometries(places, cells) or _of_arrays(places, cells)
    require_finite(found.points, name="places")
    if not len(found.cells):
        raise InputError("places has nothing to measure distances from")
    # The arrays are read later, when the caller may have changed theirs.
    return _Places(found.points.copy(), found.cells.copy())


def _of_arrays(places: Any, cells: ArrayLike | None) -> _Places:
    points = as_points(places, name="places")
    count = len(points)
    if cells is None:
        return _Places(points, _repeated(np.arange(count, dtype=np.int32)[:, None]))
    given = as_plain_array(cells, "cells")
    if given.shape == (0,) or (given.ndim == _SEGMENT and given.shape[1] == _SEGMENT):
        return _Places(points, _repeated(as_segments(given, count, name="cells")))
    if given.ndim != _SEGMENT or given.shape[1] != _TRIANGLE:
        raise wrong_shape("cells", "(m, 2) or (m, 3)", given)
    return _Places(points, as_simplices(given, count, _TRIANGLE - 1, name="cells"))


def _of_geometries(places: Any, cells: ArrayLike | None) -> _Places | None:
    """Return points, lines and boundaries of geometries; None if they are coordinates."""
    first = places
    if isinstance(places, list | tuple) or (isinstance(places, np.ndarray) and places.ndim):
        first = next((place for place in places if place is not None), None)
    if not (geodata.is_geometry(first) or hasattr(places, "geometries")):
        return None
    if cells is not None:
        raise InputError("cells are rows of points: with geometries, leave them out")
    parts = geodata.parts_of(places, name="places")
    segments, _ = geodata.steps_of(parts)
    alone = np.repeat(parts.kinds == geodata.POINTS, np.diff(parts.starts))
    rows = np.concatenate((_repeated(segments), _repeated(np.flatnonzero(alone)[:, None])))
    return _Places(np.ascontiguousarray(parts.coordinates), rows)


def _repeated(cells: NDArray[Any]) -> Indices:
    """Return triangles that repeat the last vertex of points and segments."""
    columns = [*cells.T, *[cells[:, -1]] * (_TRIANGLE - cells.shape[1])]
    return np.ascontiguousarray(np.column_stack(columns), dtype=np.int32)


def _spatial(points: Floats) -> Floats:
    """Return positions in space; those in the plane have z = 0."""
    if points.shape[1] == _TRIANGLE:
        return np.ascontiguousarray(points)
    return np.column_stack((points, np.zeros(len(points))))
