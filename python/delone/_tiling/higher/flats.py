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

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices, Rows
    from delone.errors import DegenerateInputError

__all__ = ["Flat", "advised", "axes_of", "circumcenters", "flat_of", "normals", "sizes"]

# Flats of fewer dimensions are points and lines.
_LEAST = 2
# Maximum number of coordinates of points.
_MOST = 8


class Flat:
    """A flat that contains points, (n, d), with the rows of some of them that span it."""

    def __init__(self, points: Floats, spanning: Rows) -> None:
        rows = [[Fraction(x) for x in row] for row in points[spanning].tolist()]
        self.axes = _pivots([[x - y for x, y in zip(row, rows[0], strict=True)] for row in rows])
        others = [k for k in range(points.shape[1]) if k not in self.axes]
        self.projected = np.ascontiguousarray(points[:, self.axes])
        # The other coordinates, as the core takes them.
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
    """Return the flat of points; raise the error if they are on one line."""
    if len(error.chain) <= _LEAST:
        raise error
    return Flat(points, error.chain)


def advised(error: DegenerateInputError) -> DegenerateInputError:
    """Return an error that also says how points in a flat can be triangulated."""
    if len(error.chain) > _LEAST:
        error.args = (f'{error}, or pass flat="project" to stay in the flat',)
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
    with np.errstate(all="ignore"):
        steps = points[simplices[:, 1:]] - points[simplices[:, :1]]
        heights = np.linalg.qr(steps.swapaxes(1, 2), mode="r")
        found: Floats = np.abs(np.diagonal(heights, axis1=1, axis2=2)).prod(axis=1)
        found /= math.factorial(k)
    return found


def circumcenters(points: Floats, simplices: Indices) -> Floats:
    """Return the centers in the flat of the spheres through the corners, rounded, (m, d)."""
    first = points[simplices[:, 0]]
    with np.errstate(all="ignore"):
        # Halved and scaled for each simplex, so that no difference or square overflows.
        steps = points[simplices[:, 1:]] / 2 - first[:, None] / 2
        unit = np.abs(steps).max(axis=(1, 2))[:, None]
        steps = steps / unit[:, None]
        q, r = np.linalg.qr(steps.swapaxes(1, 2))
        squares = (steps * steps).sum(axis=2)[..., None]
        center = (q @ np.linalg.solve(r.swapaxes(1, 2), squares))[..., 0]
        found: Floats = first + unit * center
    return found


def normals(points: Floats, facets: Indices, inside: Indices) -> Floats:
    """Return outer unit normals of facets that are directions of the flat, (h, d)."""
    first = points[facets[:, :1]]
    with np.errstate(all="ignore"):
        steps = np.concatenate((points[facets[:, 1:]] - first, points[inside][:, None] - first), 1)
        q, r = np.linalg.qr(steps.swapaxes(1, 2))
        found: Floats = -q[..., -1] * np.sign(r[:, -1, -1])[:, None]
    return found


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
