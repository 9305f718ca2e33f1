"""Results of point location, in any dimension.

Decisions are exact: the simplex that contains a point, and the boundary facet that is nearest to a
point outside. Weights and points of the boundary are rounded.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, fields
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.arrays import as_vectors, as_workers, require_finite
from delone._base.blocks import blocks
from delone._base.numbers import as_nonnegative
from delone._base.renames import renamed
from delone._base.values import require_shape
from delone._tiling.dimension import FLAT_OR_SOLID
from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone._tiling.dimension import Dimension, Locator

__all__ = ["Location"]

# The fraction of a facet's extent by which a rounded distance to it may be off, with a margin.
_DOUBT = 2.0**-30


@renamed(nearest="closest")
@dataclass(frozen=True, eq=False)
class Location:
    """The location of points: simplices and weights.

    Parameters
    ----------
    simplex : ndarray of int32, shape (...)
        The simplex that contains the point, inside it or on its boundary; the first one if there
        are several; -1 outside.
    barycentric : ndarray of float64, shape (..., d + 1)
        Weights of the corners of that simplex: nonnegative, with the sum 1 up to rounding, and
        exactly 1 at a corner. NaN outside.
    closest : ndarray of float64, shape (..., d)
        The point itself inside; outside, the nearest point of the boundary, rounded. NaN where the
        query is not finite, and outside in more than three dimensions.
    beside : ndarray of int32, shape (...)
        Outside, the simplex at that point of the boundary; otherwise -1.
    facet : ndarray of int32, shape (..., d)
        Outside, the corners of the facet of the boundary with that point, the nearest one by exact
        distances: an edge with the triangle to its left, or a face, counter-clockwise seen from
        outside; else -1.
    weights : ndarray of float64, shape (..., d)
        Outside, the weights of these corners at that point: nonnegative, with the sum 1 up to
        rounding; otherwise NaN.

    Examples
    --------
    >>> from delone import Delaunay
    >>> place = Delaunay([(0, 0), (4, 0), (0, 4)]).locate([(1, 2), (3, 3)])
    >>> place.simplex.tolist(), sorted(place.barycentric[0].tolist())
    ([0, -1], [0.25, 0.25, 0.5])
    >>> place.facet[1].tolist(), place.weights[1].tolist(), place.closest[1].tolist()
    ([1, 2], [0.5, 0.5], [2.0, 2.0])
    >>> place = Delaunay([(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]).locate((1, 1, -3))
    >>> int(place.simplex), place.closest.tolist(), sorted(place.facet.tolist())
    (-1, [1.0, 1.0, 0.0], [0, 1, 2])
    """

    simplex: Indices
    barycentric: Floats
    closest: Floats
    beside: Indices
    facet: Indices
    weights: Floats

    def at(self, rows: NDArray[np.integer]) -> Self:
        """Return the locations of some rows.

        Parameters
        ----------
        rows : ndarray of int
            Rows along the first axis.

        Returns
        -------
        Location
            The locations of these rows.
        """
        return type(self)(*(getattr(self, each.name)[rows] for each in fields(self)))


def find(dimension: Dimension, index: Locator, xi: ArrayLike, workers: int | None) -> Indices:
    """Return the first simplex that contains each point of `xi`, (..., d); -1 if there is none."""
    queries = as_vectors(xi, dimension.ndim, name="xi")
    flat = queries.reshape(-1, dimension.ndim)
    return index.find(flat, as_workers(workers)).reshape(queries.shape[:-1])


def nearest(
    dimension: Dimension,
    sites: tuple[Locator | None, Indices | None],
    xi: ArrayLike,
    workers: int | None,
) -> Indices:
    """Return the sites nearest to points, (..., d), as rows; -1 for points that are not finite.

    `sites` are the index over a Delaunay triangulation, or None if it has no simplex, and the row
    of each of its points, or None if these are all points in order.
    """
    queries = as_vectors(xi, dimension.ndim, name="xi")
    index, rows = sites
    if index is None:
        return np.full(queries.shape[:-1], -1, dtype=np.int32)
    found = index.nearest(queries.reshape(-1, dimension.ndim), as_workers(workers))
    if rows is not None:
        found = np.where(found >= 0, rows[found], np.int32(-1))
    return found.reshape(queries.shape[:-1])


def locate(
    dimension: Dimension, index: Any, points: Floats, xi: ArrayLike, workers: int | None
) -> Location:
    """Locate points, (..., d), in the simplices of an index; `points` are the vertices, (n, d)."""
    d = dimension.ndim
    queries = as_vectors(xi, d, name="xi")
    flat, leading = queries.reshape(-1, d), queries.shape[:-1]
    simplex, barycentric, beside, facet, weights = dimension.located(
        index, flat, as_workers(workers)
    )
    # In a flat, simplices have fewer corners.
    corners = barycentric.shape[1]
    close = np.empty_like(flat)
    for block in blocks(len(flat)):
        close[block] = np.where((simplex[block] >= 0)[:, None], flat[block], np.nan)
    rows = np.flatnonzero(beside >= 0)
    close[rows] = dimension.on_facets(points, facet[rows], weights[rows])
    return Location(
        simplex.reshape(leading),
        barycentric.reshape((*leading, corners)),
        close.reshape((*leading, d)),
        beside.reshape(leading),
        facet.reshape((*leading, d)),
        weights.reshape((*leading, d)),
    )


def locate_near(
    dimension: Dimension,
    index: Any,
    points: Floats,
    simplices: Indices,
    xi: ArrayLike,
    *,
    tolerance: float,
    workers: int | None,
) -> Location:
    """Locate points; those at most `tolerance` outside, at the nearest point of the boundary."""
    limit = as_nonnegative(tolerance, name="tolerance")
    if limit and dimension.ndim not in FLAT_OR_SOLID:
        raise InputError(
            "tolerance is only available in 2-D and 3-D: in more dimensions distances from the "
            "boundary are not computed"
        )
    place = locate(dimension, index, points, xi, workers)
    if not limit:
        return place
    flat = as_vectors(xi, dimension.ndim, name="xi").reshape(-1, dimension.ndim)
    d, leading = dimension.ndim, place.simplex.shape
    beside, facet = place.beside.reshape(-1), place.facet.reshape(-1, d)
    outside = np.flatnonzero(beside >= 0)
    rows = outside[
        _are_near(
            points, facet[outside], place.closest.reshape(-1, d)[outside], flat[outside], limit
        )
    ]
    simplex, barycentric = place.simplex.reshape(-1), place.barycentric.reshape(-1, d + 1)
    shares = place.weights.reshape(-1, d)
    simplex[rows] = beside[rows]
    # The weights of the corners of the facet; that of the opposite corner is zero.
    corners = simplices[simplex[rows]]
    barycentric[rows] = 0.0
    for k in range(d):
        at = corners == facet[rows, k, None]
        barycentric[rows] += np.where(at, shares[rows, k, None], 0.0)
    beside[rows], facet[rows], shares[rows] = -1, -1, np.nan
    return Location(
        simplex.reshape(leading),
        barycentric.reshape((*leading, d + 1)),
        place.closest,
        beside.reshape(leading),
        facet.reshape((*leading, d)),
        shares.reshape((*leading, d)),
    )


def _are_near(
    points: Floats, facet: Indices, nearest: Floats, queries: Floats, limit: float
) -> Bools:
    """Return which queries are at most `limit` away from facets of the boundary, exactly.

    `nearest` are points of the facets, rounded.
    """
    if math.isinf(limit):
        return np.ones(len(queries), dtype=bool)
    corners = points[facet]
    with np.errstate(over="ignore", invalid="ignore"):
        distance = functools.reduce(np.hypot, (queries - nearest).T)
        largest = np.maximum(np.abs(corners).max(axis=(1, 2), initial=0.0), np.abs(queries).max(1))
        extent = np.ptp(corners, axis=1).max(axis=1, initial=0.0)
        # Weights are accurate to 1e-12 and coordinates to a few rounding errors: both with a wide
        # margin.
        error = _DOUBT * extent + 64 * np.spacing(largest)
        found: Bools = distance + error <= limit
        doubtful = ~found & ~(distance - error > limit)
    for row in np.flatnonzero(doubtful).tolist():
        exact = [_exact(each) for each in corners[row]]
        found[row] = _squared_distance(_exact(queries[row]), exact) <= Fraction(limit) ** 2
    return found


def _exact(point: Floats) -> list[Fraction]:
    return [Fraction(x) for x in point.tolist()]


def _dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def _squared_distance(query: list[Fraction], corners: list[list[Fraction]]) -> Fraction:
    """The squared distance from a point to an edge or a triangle."""
    base, *others = corners
    to, *sides = ([x - y for x, y in zip(each, base, strict=True)] for each in (query, *others))
    if len(sides) == 1:
        side, length = sides[0], _dot(sides[0], sides[0])
        share = min(max(_dot(to, side) / length, Fraction(0)), Fraction(1)) if length else 0
        gap = [x - share * y for x, y in zip(to, side, strict=True)]
        return _dot(gap, gap)
    u, v = sides
    uu, uv, vv, up, vp = _dot(u, u), _dot(u, v), _dot(v, v), _dot(u, to), _dot(v, to)
    # Not zero: faces of tetrahedra have an area.
    area = uu * vv - uv * uv
    s, t = (vv * up - uv * vp) / area, (uu * vp - uv * up) / area
    if s >= 0 and t >= 0 and s + t <= 1:
        gap = [x - s * y - t * z for x, y, z in zip(to, u, v, strict=True)]
        return _dot(gap, gap)
    # The nearest point is on a side.
    return min(_squared_distance(query, [corners[k - 1], corners[k]]) for k in range(3))


def segment_ends(a: ArrayLike, b: ArrayLike) -> tuple[Floats, Floats]:
    """Return the ends of a segment as finite points, (2,)."""
    return _end(a, "a"), _end(b, "b")


def _end(point: ArrayLike, name: str) -> Floats:
    end = as_vectors(point, 2, name=name)
    require_shape(end, (2,), name)
    require_finite(end[None], name=name)
    return end
