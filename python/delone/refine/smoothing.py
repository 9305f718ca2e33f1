"""Smoothing: free points of a mesh move by Lloyd's method, its Delaunay dual, or to the mean.

After each round the moved points are triangulated again with the same subsegments, so the mesh
stays Delaunay. The points of triangles that became worse move back, first by half of the step,
finally all the way, until there are no new angles below the bound, each point is in its region, and
no point coincides with another point or lies on a segment. This terminates, because in the end all
points would be back.

S. P. Lloyd (1982), "Least squares quantization in PCM"; L. Chen and M. Holst (2011), "Efficient
mesh optimization schemes based on optimal Delaunay triangulations".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np

from delone._arrays import as_choice, as_limit
from delone.plane import geometry, quality
from delone.refine import domains
from delone.refine.domains import Counts
from delone.refine.state import MeshState

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.refine.domains import Domain

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["METHODS", "rebuilt", "smoothed", "worse"]

M = TypeVar("M", bound=MeshState)

METHODS = ("lloyd", "odt", "laplace")
# How often a step is halved before the point does not move at all.
_HALVINGS = 3


def smoothed(mesh: M, max_iter: int, method: str) -> M:
    """Return a mesh whose free points have moved; see ``Mesh.smooth``."""
    as_choice(method, METHODS, name="method")
    for _ in range(as_limit(max_iter, name="max_iter")):
        free = _free(mesh)
        if not free.any():
            break
        changed = _moved(mesh, free, method)
        if changed is None:
            break
        mesh = changed
    return mesh


def _free(mesh: MeshState) -> Bools:
    """Return the added points that lie on no segment and belong to no triangle below the bound."""
    free = mesh._inner.copy()
    free[mesh.simplices[mesh._below]] = False
    return free


def _targets(mesh: MeshState, points: Floats, method: str) -> Floats:
    """Return the target position of each point, for the current triangles."""
    simplices, n = mesh.simplices, mesh.npoints
    if method == "laplace":
        pairs = mesh.edges
        ends = np.concatenate((pairs, pairs[:, ::-1]))
        return _means(ends[:, 0], points[ends[:, 1]], np.ones(len(ends)), n)
    corners = points[simplices]
    weight = geometry.areas(points, simplices)
    if method == "odt":
        at = geometry.circumcenters(points, simplices)
        return _means(simplices.ravel(), np.repeat(at, 3, axis=0), np.repeat(weight, 3), n)
    # The part of a triangle in the Voronoi cell of a corner is a signed quadrilateral: the corner,
    # two edge midpoints and the circumcenter. It is the sum of two triangles with signed areas and
    # centroids.
    center = geometry.circumcenters(points, simplices)
    owners, places, weights = [], [], []
    for k in range(3):
        a = corners[:, k]
        for other, sign in ((corners[:, k - 2], 1.0), (corners[:, k - 1], -1.0)):
            middle = (a + other) / 2
            u, v = middle - a, center - a
            # The circumcenter of a needle may overflow; then its corners stay.
            with np.errstate(all="ignore"):
                weights.append(sign * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]))
            places.append((a + middle + center) / 3)
            owners.append(simplices[:, k])
    return _means(np.concatenate(owners), np.concatenate(places), np.concatenate(weights), n)


def _means(owner: Indices, places: Floats, weight: Floats, count: int) -> Floats:
    total = np.bincount(owner, weights=weight, minlength=count)
    with np.errstate(all="ignore"):
        sums = [np.bincount(owner, weights=weight * p, minlength=count) for p in places.T]
        mean: Floats = np.column_stack(sums) / total[:, None]
    return mean


def _moved(mesh: M, free: Bools, method: str) -> M | None:
    """Move free points as far as no triangle becomes worse; None if no point moves."""
    # In this unit, areas and squared lengths are doubles.
    unit = domains.unit_of(mesh.points)
    points = mesh.points / unit
    target = _targets(mesh, points, method)
    target = np.where(free[:, None] & np.isfinite(target), target, points)
    step = np.ones(mesh.npoints)
    while True:
        places = (points + step[:, None] * (target - points)) * unit
        moves = (places != mesh.points).any(axis=1)
        if not moves.any():
            return None
        domain, lost = rebuilt(mesh, places, np.arange(mesh.npoints, dtype=np.int32))
        if domain is not None:
            lost = worse(mesh, domain, np.arange(mesh.npoints))
        if not len(lost):
            assert domain is not None
            segment, angle, size, exhausted = mesh._counts.tolist()
            counts = Counts(segment, angle, size, exhausted=bool(exhausted))
            return type(mesh)._of(domain, counts, float(mesh._bound[0]), mesh.stages, mesh._workers)
        back = np.zeros(mesh.npoints, dtype=bool)
        back[lost] = True
        if not (back & moves).any():
            # No vertex of a worse triangle moved, but some of their neighbors did.
            ends = mesh.edges
            back[ends[back[ends].any(axis=1)]] = True
        if not (back & moves).any():
            return None
        halved = step / 2
        step[back] = np.where(halved < 0.5**_HALVINGS, 0.0, halved)[back]


def rebuilt(
    mesh: MeshState, points: Floats, row: Indices
) -> tuple[Domain | None, NDArray[np.intp]]:
    """Triangulate new positions of the points of a mesh, with its subsegments and regions.

    `row` has the row of each old point in `points`, -1 if removed; ends of subsegments stay. If
    points coincide, lie on a subsegment or left their region, None and their rows are returned.
    """
    edges, label = mesh._directed
    segments = row[mesh.segments]
    made, labels = domains.triangulated(points, segments, row[edges], label, mesh._workers)
    if len(made.duplicates) or len(made.through):
        pairs = made.duplicates.ravel(), made.through[:, 1]
        return None, np.unique(np.concatenate(pairs)).astype(np.intp)
    kept = np.flatnonzero(row >= 0)
    lost = _astray(mesh, made.simplices, labels, row, kept)
    if len(lost):
        return None, lost
    sides = domains.sides_at(made.simplices, made.constrained, (segments, mesh._segment_line))
    lines = mesh._lines._replace(ends=row[mesh._ends])
    return domains.Domain(
        points=points,
        point_source=mesh.point_source[kept],
        point_markers=mesh.point_markers[kept],
        on=mesh._on[kept],
        simplices=made.simplices,
        neighbors=made.neighbors,
        labels=labels,
        regions=mesh._regions,
        sides=sides,
        lines=lines,
    ), lost


def _astray(
    mesh: MeshState, simplices: Indices, labels: Indices, row: Indices, kept: NDArray[np.intp]
) -> NDArray[np.intp]:
    """Return the free points that are vertices of a triangle outside of their region."""
    own = np.full(len(kept), -2, dtype=np.int32)
    inner = mesh._inner
    first = mesh.vertex_to_simplex
    region = np.searchsorted(mesh._regions, mesh.region[first]).astype(np.int32)
    own[row[kept]] = np.where(inner[kept], region[kept], -2)
    wrong = (own[simplices] != -2) & (own[simplices] != labels[:, None])
    return np.unique(simplices[wrong]).astype(np.intp)


def worse(mesh: MeshState, domain: Domain, number: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the vertices, in a domain, of triangles below the bound that the mesh did not have.

    `number` has the point of the mesh for each point of the domain, -1 for new points.
    """
    inside = domain.simplices[domain.labels >= 0]
    rows = quality.below(domain.points, inside, float(mesh._bound[0]))
    new = np.sort(number[inside[rows]], axis=1)
    old = np.sort(mesh.simplices[mesh._below], axis=1).astype(np.int64)
    n = mesh.npoints
    # A triangle with a new point (-1, so first in the sorted row) is not an old one.
    same = (new[:, 0] >= 0) & np.isin((new[:, 0] * n + new[:, 1]) * n + new[:, 2],
                   (old[:, 0] * n + old[:, 1]) * n + old[:, 2])  # fmt: skip
    return np.unique(inside[rows[~same]]).astype(np.intp)
