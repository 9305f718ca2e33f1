"""The Delaunay triangulation of points that all lie in one plane of space.

In-circle tests in a tilted plane have no exact coordinates of the plane to work with. So the points
are joined with one more off the plane and triangulated in space: spheres cut the plane in circles,
hence the tetrahedra are cones over the Delaunay triangles, and ties go by the same rule. Weights
change nothing in that: in the plane, lifted heights differ from those of coordinates of its own by
a linear function, and the apex, a corner of the hull, is never hidden.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from delone import _core, predicates
from delone.immutable import ReadOnly
from delone.plane import topology
from delone.space.topology import FACES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["PlaneTriangulation", "plane_of"]

# Axes of the projections to coordinate planes: that along z first, then along y, then along x.
_PROJECTIONS = ((2, (0, 1)), (1, (2, 0)), (0, (1, 2)))


@dataclass(frozen=True, eq=False)
class PlaneTriangulation(ReadOnly):
    """The Delaunay triangulation of points of one plane in space; the regular one, with weights.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        The coordinates.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `points`: counter-clockwise seen from where z grows; in a vertical
        plane from where y grows, and in one of constant x from where x grows.
    neighbors : ndarray of int32, shape (m, 3)
        The triangle opposite each vertex, -1 outside.
    duplicates : ndarray of int32, shape (k, 2)
        Rows that repeat earlier ones, and these.
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
        return topology.boundary_edges(self.simplices, self.neighbors)

    @cached_property
    def hidden(self) -> Indices:
        """The rows that are neither vertices nor duplicates of vertices, ascending."""
        seen = np.zeros(len(self.points), dtype=bool)
        seen[self.simplices] = True
        seen[self.duplicates[:, 0]] = seen[self.duplicates[:, 1]]
        return np.flatnonzero(~seen).astype(np.int32)

    @cached_property
    def circumcenters(self) -> Floats:
        """Centres of the circles of triangles, (m, 3): the vertices of the plane's Voronoi diagram.

        With weights, where the three vertices have equal power. In the plane up to rounding; those
        of thin triangles are far away, and infinite beyond the range of doubles.
        """
        a, b, c = (self.points[self.simplices[:, k]] for k in range(3))
        with np.errstate(all="ignore"):
            # Halves in a unit of each triangle, so that no difference or square overflows.
            u, v = b / 2 - a / 2, c / 2 - a / 2
            unit = np.abs(np.stack((u, v))).max(axis=(0, 2), initial=0.0)[:, None]
            u, v = u / unit, v / unit
            normal = np.cross(u, v)
            uu, vv = (u * u).sum(axis=1), (v * v).sum(axis=1)
            if self.weights is not None:
                heavy = self.weights[self.simplices] / 2
                lift = (heavy[:, :1] - heavy[:, 1:]) / unit / unit / 2
                uu, vv = uu + lift[:, 0], vv + lift[:, 1]
            across = np.cross(uu[:, None] * v - vv[:, None] * u, normal)
            way = across / (2 * (normal * normal).sum(axis=1))[:, None]
            found: Floats = a + 2 * unit * way
        return found


def plane_of(
    points: Floats, workers: int = 1, weights: Floats | None = None
) -> PlaneTriangulation | None:
    """Triangulate points of one plane.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Finite points, all in one plane.
    workers : int, optional
        How many threads may work; with weights there is one.
    weights : ndarray of float64, shape (n,), optional
        Finite weights of the points.

    Returns
    -------
    PlaneTriangulation or None
        None where all points lie on one line.
    """
    corners = _corners(points)
    if corners is None:
        return None
    axis, pair, first = corners
    extended = np.concatenate((points, _apex(points, first[0], axis)))
    if weights is None:
        made = _core.triangulate3(extended, workers)
        simplices, neighbors, duplicates = made.simplices, made.neighbors, made.duplicates
    else:
        # The weight of the apex is of no account; one of the others' keeps exponents together.
        own = np.append(weights, weights[first[0]])
        heavy = _core.regular3(extended, own)
        simplices, neighbors = heavy.simplices, heavy.neighbors
        duplicates = twins(heavy.stands_for, own)
    # Three columns of each row: those of the base, which is opposite the apex.
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


def twins(stands_for: Indices, weights: Floats) -> Indices:
    """List rows that repeat others, weights included.

    Parameters
    ----------
    stands_for : ndarray of int32, shape (n,)
        For each row the first of the heaviest ones with its coordinates.
    weights : ndarray of float64, shape (n,)
        The weights.

    Returns
    -------
    ndarray of int32, shape (k, 2)
        The rows, and those that they repeat.
    """
    other = stands_for != np.arange(len(weights))
    rows = np.flatnonzero(other & (weights == weights[stands_for]))
    return np.column_stack((rows, stands_for[rows])).astype(np.int32)


def _corners(points: Floats) -> tuple[int, list[int], tuple[int, int, int]] | None:
    """An axis that is not parallel to the plane, the other two, and three points off a line."""
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
    """A point off the plane, as far from one of its points as the points are from each other."""
    apex = points[[row]]
    with np.errstate(over="ignore"):
        size = float((points.max(axis=0) - points.min(axis=0)).max())
        at = float(apex[0, axis])
        places = [at + size, at - size, 2 * at, 0.0, 1.0]
    apex[0, axis] = next(place for place in places if np.isfinite(place) and place != at)
    return apex
