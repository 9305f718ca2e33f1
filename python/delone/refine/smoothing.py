"""Smoothing: free points of a mesh move by Lloyd's method, by its Delaunay dual, or to the mean.

The core moves them and flips edges, so the mesh stays constrained Delaunay; see `refine/smooth`
there. `rebuilt` and `worse` serve changes that remove or add points: the remaining ones are
retriangulated, and the triangles that became worse are found.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_limit, as_workers
from delone._tiling.plane import quality
from delone.refine import domains
from delone.refine.state import MeshState

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.refine.domains import Domain

__all__ = ["METHODS", "rebuilt", "smoothed", "worse"]

M = TypeVar("M", bound=MeshState)

METHODS = ("lloyd", "odt", "laplace")


def smoothed(mesh: M, max_iter: int, method: str) -> M:
    """Return a mesh whose free points have moved; see ``Mesh.smooth``."""
    as_choice(method, METHODS, name="method")
    rounds = as_limit(max_iter, name="max_iter")
    # In this unit, areas and squared lengths are in the range of doubles. If the conversion would
    # round new positions to subnormal doubles, the mesh is smoothed in its own unit.
    unit = domains.unit_of(mesh.points)
    made = _smoothed(mesh, mesh.points / unit, rounds, method)
    points = made.points * unit
    if not np.array_equal(points / unit, made.points):
        made = _smoothed(mesh, mesh.points, rounds, method)
        points = made.points
    changed: dict[str, NDArray[Any]] = {
        "points": points,
        "simplices": made.simplices,
        "neighbors": made.neighbors,
        "sides": made.sides,
    }
    made_of = mesh._arrays() | changed
    return mesh._from_arrays(made_of, mesh.stages, mesh._workers)._refer(mesh)


def _smoothed(mesh: MeshState, points: Floats, rounds: int, method: str) -> _core.SmoothedMesh:
    return _core.smooth2(
        np.ascontiguousarray(points),
        mesh.simplices,
        mesh.neighbors,
        mesh._sides,
        mesh._inner,
        quality.squared_cosine(float(mesh._bound[0])),
        method,
        rounds,
        as_workers(mesh._workers),
    )


def rebuilt(
    mesh: MeshState, points: Floats, row: Indices
) -> tuple[Domain | None, NDArray[np.intp]]:
    """Triangulate new positions of the points of a mesh, with its subsegments and regions.

    `row` contains the row of each old point in `points`, -1 if removed; ends of subsegments remain.
    If points coincide, lie on a subsegment or leave their region, None and their rows are returned.
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
        lines=lines,
        walls=domains.Pieces(segments, mesh._segment_line),
    ), lost


def _astray(
    mesh: MeshState, simplices: Indices, labels: Indices, row: Indices, kept: NDArray[np.intp]
) -> NDArray[np.intp]:
    """Return the free points that are vertices of a triangle outside their region."""
    own = np.full(len(kept), -2, dtype=np.int32)
    inner = mesh._inner
    first = mesh.vertex_to_simplex
    region = np.searchsorted(mesh._regions, mesh.region[first]).astype(np.int32)
    own[row[kept]] = np.where(inner[kept], region[kept], -2)
    wrong = (own[simplices] != -2) & (own[simplices] != labels[:, None])
    return np.unique(simplices[wrong]).astype(np.intp)


def worse(mesh: MeshState, domain: Domain, number: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the vertices, in a domain, of triangles below the bound that the mesh did not have.

    `number` contains the point of the mesh for each point of the domain, -1 for new points.
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
