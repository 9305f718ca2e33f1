"""Triangulations and hulls of points in a flat: an affine subspace of fewer dimensions.

The *axes* of a flat of dimension k are the first k coordinates that determine the others. The
projection to them is injective, so orientation, containment and hulls are those of the projections.
Distances are not: the core adds the other coordinates to the lifted heights, exactly.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core, predicates
from delone._base.arrays import as_workers
from delone._tiling.higher import exact_flats

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.errors import DegenerateInputError

__all__ = ["Flat", "advised", "axes_of", "circumcenters", "flat_of", "normals", "sizes"]

# Flats of fewer dimensions are points and lines.
_LEAST = 2
# Maximum number of coordinates of points.
_MOST = 8
# Simplices with a height below this share of their longest step are measured by fractions.
_THIN = 2.0**-12
# The same holds for results near the ends of the range of doubles.
_SMALL = 2.0**-960


class Flat:
    """A flat that contains points, (n, d), with the rows of some of them that span it."""

    def __init__(self, points: Floats, spanning: Rows) -> None:
        rows = [[Fraction(x) for x in row] for row in points[spanning].tolist()]
        self.axes = _pivots([[x - y for x, y in zip(row, rows[0], strict=True)] for row in rows])
        others = [k for k in range(points.shape[1]) if k not in self.axes]
        self.projected = np.ascontiguousarray(points[:, self.axes])
        # The other coordinates, as the core expects them.
        self.rest = np.zeros((len(points), _MOST))
        self.rest[:, : len(others)] = points[:, others]

    def triangulated(self) -> _core.Triangulation:
        """Return the Delaunay triangulation in the flat, as the core returns it."""
        return _core.triangulate_in_flat(self.projected, self.rest)

    def hull(self) -> _core.HullN:
        """Return the hull in the flat, as the core returns it."""
        return _core.hull_in_flat(self.projected, self.rest)

    def faults(self, simplices: Indices, neighbors: Indices) -> _core.Faults:
        """Return the faults of a triangulation in the flat."""
        return _core.validate_in_flat(self.projected, self.rest, simplices, neighbors)


def flat_of(points: Floats, error: DegenerateInputError) -> Flat:
    """Return the flat of points; raise the error, and say so, if they are on one line."""
    rows = error.chain.tolist()
    if len(rows) <= _LEAST:
        if len(rows) == _LEAST:
            what = f"all points are on one line, through rows {rows[0]} and {rows[1]}"
        else:
            what = f"all points are equal to row {rows[0]}" if rows else "there are no points"
        error.args = (f"{what}; simplices in a flat need three that are not on one line",)
        raise error
    return Flat(points, error.chain)


def advised(error: DegenerateInputError) -> DegenerateInputError:
    """Return an error that also says how points in a flat can be triangulated."""
    if len(error.chain) > _LEAST:
        error.args = (f'{error}, or pass flat="project" to Delaunay or ConvexHull',)
    return error


def axes_of(points: Floats, simplex: Indices) -> list[int]:
    """Return the axes of the flat that a simplex spans."""
    return Flat(points[simplex], np.arange(len(simplex))).axes


def orientations(points: Floats, simplices: Indices) -> Indices:
    """Return the signs of determinants, exactly; `points` have k coordinates, (n, k)."""
    k = points.shape[1]
    if k > 3:
        return _core.orientations_n(points, np.ascontiguousarray(simplices), as_workers(None))
    corners = [points[simplices[:, j]] for j in range(k + 1)]
    signs: Any = predicates.orient2d(*corners) if k == _LEAST else predicates.orient3d(*corners)
    found: Indices = signs.astype(np.int32)
    return found


def sizes(points: Floats, simplices: Indices) -> Floats:
    """Return the measures of simplices of fewer dimensions, rounded: products of heights."""
    k = simplices.shape[1] - 1
    _, r, unit, doubtful = _orthogonal(points, simplices)
    with np.errstate(all="ignore"):
        found: Floats = np.abs(np.diagonal(r, axis1=1, axis2=2)).prod(axis=1) / math.factorial(k)
        for _ in range(k):
            found = found * (2 * unit)
        doubtful |= ~((found > _SMALL) & (found < 1 / _SMALL))
    for row in np.flatnonzero(doubtful).tolist():
        found[row] = exact_flats.size(points[simplices[row]])
    return found


def circumcenters(points: Floats, simplices: Indices) -> Floats:
    """Return the centers in the flat of the spheres through the corners, rounded, (m, d)."""
    q, r, unit, doubtful = _orthogonal(points, simplices)
    found = np.full((len(simplices), points.shape[1]), np.nan)
    rest = ~doubtful
    with np.errstate(all="ignore"):
        # The squared lengths of the steps, which are the columns of q r.
        squares = (r[rest] ** 2).sum(axis=1)[..., None]
        center = (q[rest] @ np.linalg.solve(r[rest].swapaxes(1, 2), squares))[..., 0]
        found[rest] = points[simplices[rest, 0]] + unit[rest, None] * center
    for row in np.flatnonzero(doubtful | ~np.isfinite(found).all(axis=1)).tolist():
        found[row] = exact_flats.center(points[simplices[row]])
    return found


def normals(points: Floats, facets: Indices, inside: Indices) -> Floats:
    """Return outer unit normals of facets that are directions of the flat, (h, d)."""
    q, r, _, doubtful = _orthogonal(points, np.column_stack((facets, inside)))
    found: Floats = -q[..., -1] * np.sign(r[:, -1, -1])[:, None]
    for row in np.flatnonzero(doubtful).tolist():
        found[row] = exact_flats.normal(points[facets[row]], points[inside[row]])
    return found


def _orthogonal(points: Floats, simplices: Indices) -> tuple[Floats, Floats, Floats, Bools]:
    """Return Q and R of half the steps from the first corners, and the units in which they are.

    Also return for which simplices rounding errors may be large: thin ones, with a small height.
    """
    with np.errstate(all="ignore"):
        # Halved and scaled for each simplex, so that no difference or square overflows.
        steps = points[simplices[:, 1:]] / 2 - points[simplices[:, :1]] / 2
        unit = np.abs(steps).max(axis=(1, 2))
        steps = np.nan_to_num(steps / unit[:, None, None])
        q, r = np.linalg.qr(steps.swapaxes(1, 2))
        heights = np.abs(np.diagonal(r, axis1=1, axis2=2))
        doubtful: Bools = ~((heights.min(axis=1) > _THIN) & (unit > _SMALL))
    return q, r, unit, doubtful


def _pivots(rows: list[list[Fraction]]) -> list[int]:
    """Return the first columns that determine the others, by elimination."""
    left = [list(row) for row in rows]
    found: list[int] = []
    for k in range(len(rows[0])):
        at = len(found)
        pivot = next((i for i in range(at, len(left)) if left[i][k]), None)
        if pivot is None:
            continue
        left[at], left[pivot] = left[pivot], left[at]
        for row in left[at + 1 :]:
            factor = row[k] / left[at][k]
            row[:] = [x - factor * y for x, y in zip(row, left[at], strict=True)]
        found.append(k)
    return found
