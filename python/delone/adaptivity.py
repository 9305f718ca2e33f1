"""Meshes that become finer or coarser where a caller says so.

Finer is what the core does, with a cap for the triangles that are marked. Coarser is the removal of
points that were added inside: those of marked triangles go, no two of them neighbours, and what
would leave an angle below the bound comes back.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import domains, geometry, topology
from delone._arrays import as_count
from delone.domains import Counts
from delone.errors import DtypeError, InputError, InternalError, ShapeError
from delone.refine import Limits, as_min_angle, rounds
from delone.sizing import Sizing
from delone.smoothing import rebuilt, worse

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.meshed import Mesh

    Bools = NDArray[np.bool_]
    Indices = NDArray[np.int32]

__all__ = ["coarsened", "finer"]

_MOST_ADDED = 5_000_000


def finer(
    mesh: Mesh,
    marked: ArrayLike | None,
    *,
    ratio: float,
    min_angle: float | None,
    max_area: Any,
    size: Any,
    max_points: int | None,
    progress: Any,
) -> Mesh:
    """Return a finer mesh; see ``Mesh.refine``."""
    if not 0 < ratio <= 1:
        raise InputError(f"ratio must be above 0 and at most 1, got {ratio!r}")
    bound = float(mesh._bound[0]) if min_angle is None else as_min_angle(min_angle)
    most = _MOST_ADDED if max_points is None else as_count(max_points, name="max_points")
    limits = Limits(bound, most, False, progress, mesh._workers)
    domain, counts = mesh._domain(), Counts(*mesh._counts[:3].tolist())
    if marked is not None:
        chosen = _chosen(marked, mesh.nsimplex)
        caps = np.full(len(domain.simplices), math.inf)
        at = _same_triangles(mesh, chosen, domain.simplices)
        caps[at] = ratio * geometry.areas(mesh.points, mesh.simplices[chosen])
        domain, more = domains.refined(
            domain, caps, bound, limits.max_points, progress=limits.progress
        )
        counts = counts.plus(more)
        limits = limits._replace(max_points=most - more.total)
    if (marked is None or max_area is not None or size is not None) and not counts.exhausted:
        domain, more = rounds(domain, Sizing(max_area, size, domain.regions), limits)
        counts = counts.plus(more)
    return type(mesh)._of(domain, counts, bound, mesh.stages, mesh._workers)


def _chosen(marked: ArrayLike, count: int) -> NDArray[np.intp]:
    """Return triangles from a mask or from their numbers."""
    array = np.asarray(marked)
    if array.dtype.kind == "b":
        if array.shape != (count,):
            raise ShapeError(f"marked must have shape ({count},), got {array.shape}")
        return np.flatnonzero(array)
    if array.size == 0:
        return np.empty(0, dtype=np.intp)
    if array.ndim != 1:
        raise ShapeError(f"marked must have one axis, got shape {array.shape}")
    if array.dtype.kind not in "iu":
        raise DtypeError(f"marked must be booleans or triangles, got dtype {array.dtype}")
    if int(array.min()) < 0 or int(array.max()) >= count:
        raise InputError(f"marked leaves the range 0 to {count - 1} of triangles")
    return np.unique(array).astype(np.intp)


def _same_triangles(
    mesh: Mesh, chosen: NDArray[np.intp], simplices: Indices
) -> NDArray[np.intp]:
    """Find triangles of a mesh among those of its points triangulated anew."""
    ours, all_of_them = (np.sort(s, axis=1).T for s in (mesh.simplices[chosen], simplices))
    order = np.lexsort(all_of_them[::-1])
    n = np.int64(mesh.npoints)
    # The pair of the two smaller corners is a key of 64 bits; it is shared by few triangles.
    pair = all_of_them[0] * n + all_of_them[1]
    third = all_of_them[2]
    start = np.searchsorted(pair[order], ours[0] * n + ours[1])
    found = np.full(len(chosen), -1, dtype=np.intp)
    for step in range(2):
        at = np.minimum(start + step, len(order) - 1)
        row = order[at]
        same = (pair[row] == ours[0] * n + ours[1]) & (third[row] == ours[2])
        found[same] = row[same]
    if (found < 0).any():
        raise InternalError("a mesh is not the triangulation of its points and segments")
    return found


def coarsened(mesh: Mesh, marked: ArrayLike | None) -> Mesh:
    """Return a coarser mesh; see ``Mesh.coarsen``."""
    chosen = slice(None) if marked is None else _chosen(marked, mesh.nsimplex)
    free = np.zeros(mesh.npoints, dtype=bool)
    free[mesh.simplices[chosen]] = True
    free &= (mesh.point_source < 0) & (mesh._on < 0)
    free[mesh.simplices[mesh._below]] = False
    gone = _independent(mesh, free)
    while gone.any():
        kept = np.flatnonzero(~gone)
        row = np.full(mesh.npoints, -1, dtype=np.int32)
        row[kept] = np.arange(len(kept), dtype=np.int32)
        domain, lost = rebuilt(mesh, mesh.points[kept], row)
        if domain is None:
            raise InternalError("points of a mesh have met each other")
        lost = worse(mesh, domain, kept)
        if not len(lost):
            counts = Counts(*mesh._counts[:3].tolist(), exhausted=bool(mesh._counts[3]))
            return type(mesh)._of(
                domain, counts, float(mesh._bound[0]), mesh.stages, mesh._workers
            )
        # What was beside a triangle that is too thin now comes back.
        near = np.zeros(mesh.npoints, dtype=bool)
        near[kept[lost]] = True
        ends = mesh.edges
        back = np.zeros(mesh.npoints, dtype=bool)
        back[ends[near[ends].any(axis=1)]] = True
        if not (back & gone).any():
            back[:] = True
        gone &= ~back
    return mesh


def _independent(mesh: Mesh, free: Bools) -> Bools:
    """Choose free points, no two of them neighbours, as many as fit: the lower row goes first."""
    indptr, indices = topology.vertex_neighbor_vertices(mesh.edges, mesh.npoints)
    chosen, barred = np.zeros_like(free), ~free
    # A fixed scattering of the rows, so that few rounds do.
    rank = (np.arange(mesh.npoints, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(11)
    owner = np.repeat(np.arange(mesh.npoints), np.diff(indptr))
    while not barred.all():
        open_rank = np.where(barred, np.uint64(2**63), rank)
        least = np.full(mesh.npoints, 2**63, dtype=np.uint64)
        np.minimum.at(least, owner, open_rank[indices])
        take = ~barred & (rank < least)
        chosen |= take
        barred |= take
        barred[indices[take[owner]]] = True
    return chosen
