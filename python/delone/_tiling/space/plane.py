"""Delaunay triangulation of coplanar 3-D points.

In a tilted plane there are no exact 2-D coordinates for in-circle tests. So a point off the plane,
the apex, is added, and all points are triangulated in 3-D: spheres intersect the plane in circles,
so the tetrahedra are cones over the Delaunay triangles, and ties are broken by the same rule. This
is also true with weights: in the plane, lifted heights differ from those in 2-D coordinates by a
linear function, and the apex, a corner of the hull, is never hidden.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from delone import _core, predicates
from delone._base.immutable import ReadOnly, sealed
from delone._tiling.plane import topology
from delone._tiling.space.topology import FACES

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["PlaneTriangulation", "plane_of"]

# Axes of the projections to coordinate planes: first along z, then along y, then along x.
_PROJECTIONS = ((2, (0, 1)), (1, (2, 0)), (0, (1, 2)))


@dataclass(frozen=True, eq=False)
class PlaneTriangulation(ReadOnly):
    """The Delaunay triangulation of coplanar 3-D points, or with weights the regular triangulation.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        The coordinates.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `points`: counter-clockwise as seen from the positive z direction;
        in vertical planes from the positive y direction, and in planes of constant x from the
        positive x direction.
    neighbors : ndarray of int32, shape (m, 3)
        The triangle opposite each vertex, -1 outside.
    duplicates : ndarray of int32, shape (k, 2)
        Rows that repeat earlier rows, and the earlier rows.
    weights : ndarray of float64, shape (n,), optional
        The weights of the points.

    Examples
    --------
    >>> from delone import DegenerateInputError, Delaunay
    >>> try:
    ...     Delaunay([(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 1)])
    ... except DegenerateInputError as error:
    ...     reason, plane = error.reason, error.plane
    >>> reason, plane.simplices.shape, len(plane.convex_hull)
    ('coplanar', (2, 3), 4)
    """

    points: Floats
    simplices: Indices
    neighbors: Indices
    duplicates: Indices
    weights: Floats | None = None

    @cached_property
    def convex_hull(self) -> Indices:
        """The edges of the convex hull, (h, 2), each with the triangulation to its left."""
        return sealed(topology.boundary_edges(self.simplices, self.neighbors))

    @cached_property
    def hidden(self) -> Indices:
        """The rows that are neither vertices nor duplicates of vertices, ascending."""
        seen = np.zeros(len(self.points), dtype=bool)
        seen[self.simplices] = True
        seen[self.duplicates[:, 0]] = seen[self.duplicates[:, 1]]
        return sealed(np.flatnonzero(~seen).astype(np.int32))

    @cached_property
    def circumcenters(self) -> Floats:
        """Circumcenters of the triangles, (m, 3): the vertices of the planar Voronoi diagram.

        With weights, the points where the three vertices have equal power. In the plane up to
        rounding; those of thin triangles are far away, and infinite beyond the range of doubles.
        """
        a, b, c = (self.points[self.simplices[:, k]] for k in range(3))
        with np.errstate(all="ignore"):
            # Halved and scaled for each triangle, so that no difference or square overflows.
            u, v = b / 2 - a / 2, c / 2 - a / 2
            unit = np.abs(np.stack((u, v))).max(axis=(0, 2), initial=0.0)[:, None]
            u, v = u / unit, v / unit
            normal = np.cross(u, v)
            uu, vv = (u * u).sum(axis=1), (v * v).sum(axis=1)
            if self.weights is not None:
                weights = self.weights[self.simplices] / 2
                lift = (weights[:, :1] - weights[:, 1:]) / unit / unit / 2
                uu, vv = uu + lift[:, 0], vv + lift[:, 1]
            across = np.cross(uu[:, None] * v - vv[:, None] * u, normal)
            offset = across / (2 * (normal * normal).sum(axis=1))[:, None]
            return sealed(a + 2 * unit * offset)


def plane_of(
    points: Floats, workers: int = 1, weights: Floats | None = None
) -> PlaneTriangulation | None:
    """Triangulate finite coplanar points, (n, 3); None if they are collinear."""
    corners = _corners(points)
    if corners is None:
        return None
    axis, pair, first = corners
    extended = np.concatenate((points, _apex(points, first[0], axis)))
    if weights is None:
        made = _core.triangulate3(extended, workers)
        simplices, neighbors, duplicates = made.simplices, made.neighbors, made.duplicates
    else:
        # The weight of the apex has no effect; one like the others avoids a large range of
        # exponents.
        own = np.append(weights, weights[first[0]])
        regular = _core.regular(extended, own, workers)
        simplices, neighbors = regular.simplices, regular.neighbors
        duplicates = repeated_rows(regular.stands_for, own)
    # Keep three columns of each row: those of the base, opposite the apex.
    rows, corner = np.nonzero(simplices == len(points))
    order = np.array(FACES)[corner]
    triangles = np.take_along_axis(simplices[rows], order, axis=1)
    beyond = np.take_along_axis(neighbors[rows], order, axis=1)
    if predicates.orient2d(*points[triangles[0]][:, pair]) < 0:
        triangles, beyond = triangles[:, [0, 2, 1]], beyond[:, [0, 2, 1]]
    return PlaneTriangulation(
        points.view(),
        np.ascontiguousarray(triangles),
        np.ascontiguousarray(beyond),
        duplicates,
        None if weights is None else weights.view(),
    )


def repeated_rows(stands_for: Indices, weights: Floats) -> Indices:
    """Return rows that repeat others, including weights, and those that they repeat, (k, 2).

    `stands_for` is for each row the first row with the same coordinates that has the largest
    weight.
    """
    other = stands_for != np.arange(len(weights))
    rows = np.flatnonzero(other & (weights == weights[stands_for]))
    return np.column_stack((rows, stands_for[rows])).astype(np.int32)


def _corners(points: Floats) -> tuple[int, list[int], tuple[int, int, int]] | None:
    """Return an axis not parallel to the plane, the other two, and three non-collinear points."""
    if len(points) < 3:
        return None
    other = np.flatnonzero((points != points[0]).any(axis=1))
    if not len(other):
        return None
    a, b = 0, int(other[0])
    for axis, pair in _PROJECTIONS:
        flat = np.ascontiguousarray(points[:, pair])
        turned = np.flatnonzero(predicates.orient2d(flat[a], flat[b], flat))
        if len(turned):
            return axis, list(pair), (a, b, int(turned[0]))
    return None


def _apex(points: Floats, row: int, axis: int) -> Floats:
    """Return a point off the plane, at a distance similar to the distances between the points."""
    apex = points[[row]]
    with np.errstate(over="ignore"):
        size = float((points.max(axis=0) - points.min(axis=0)).max())
        at = float(apex[0, axis])
        places = [at + size, at - size, 2 * at, 0.0, 1.0]
    apex[0, axis] = next(place for place in places if np.isfinite(place) and place != at)
    return apex
