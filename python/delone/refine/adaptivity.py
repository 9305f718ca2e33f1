"""Adaptive refinement and coarsening of meshes.

To refine, the core gets a maximum area for each marked triangle. To coarsen, points that were added
inside are removed: points of marked triangles, no two of them neighbors. Points whose removal would
leave an angle below the bound are reinserted.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from delone._base.arrays import as_callback, as_limit
from delone._base.numbers import as_share
from delone._tiling import measures
from delone._tiling.plane import topology
from delone._tiling.sizes import chosen
from delone.errors import InternalError
from delone.refine import domains
from delone.refine.domains import Counts
from delone.refine.rounds import MOST_ADDED, Limits, as_min_angle, rounds
from delone.refine.sizing import EQUILATERAL
from delone.refine.smoothing import rebuilt, worse
from delone.refine.state import MeshState

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats

__all__ = ["coarsened", "finer"]

M = TypeVar("M", bound=MeshState)


def finer(
    mesh: M,
    marked: ArrayLike | None,
    *,
    ratio: float,
    min_angle: float | None,
    max_area: Any,
    size: Any,
    max_points: int | None,
    progress: Any,
) -> M:
    """Return a finer mesh; see ``Mesh.refine``."""
    ratio = as_share(ratio, name="ratio")
    bound = float(mesh._bound[0]) if min_angle is None else as_min_angle(min_angle)
    budget = MOST_ADDED if max_points is None else as_limit(max_points, name="max_points")
    limits = Limits(bound, budget, False, as_callback(progress, name="progress"), mesh._workers)
    domain, counts = mesh._domain(), Counts(*mesh._counts[:3].tolist())
    if marked is not None:
        size_at = _size_function(mesh, chosen(marked, mesh.nsimplex, "triangles"), ratio)
        domain, more = rounds(domain, (None, size_at), limits)
        counts = counts.plus(more)
        limits = limits._replace(max_points=budget - more.total)
    if (marked is None or max_area is not None or size is not None) and not counts.exhausted:
        domain, more = rounds(domain, (max_area, size), limits)
        counts = counts.plus(more)
    return type(mesh)._of(domain, counts, bound, mesh.stages, mesh._workers)


def _size_function(
    mesh: MeshState, rows: NDArray[np.intp], ratio: float
) -> Callable[[Floats], Floats]:
    """Return a size function that makes chosen triangles smaller."""
    sizes = np.full(mesh.nsimplex, math.inf)
    unit = domains.unit_of(mesh.points)
    areas = measures.sizes(mesh.points / unit, mesh.simplices[rows])
    sizes[rows] = np.sqrt(ratio * areas / EQUILATERAL) * unit

    def size(positions: Floats) -> Floats:
        found = mesh.locate(positions)
        triangle = np.where(found.simplex >= 0, found.simplex, found.beside)
        return np.asarray(sizes[triangle])

    return size


def coarsened(mesh: M, marked: ArrayLike | None) -> M:
    """Return a coarser mesh; see ``Mesh.coarsen``."""
    rows = slice(None) if marked is None else chosen(marked, mesh.nsimplex, "triangles")
    free = np.zeros(mesh.npoints, dtype=bool)
    free[mesh.simplices[rows]] = True
    free &= mesh._inner
    free[mesh.simplices[mesh._below]] = False
    removed = _independent(mesh, free)
    while removed.any():
        domain, kept = _without(mesh, removed)
        bound = float(mesh._bound[0])
        counts = Counts._make(mesh._counts.tolist())
        caps = np.full(len(domain.simplices), math.inf)
        # Where an angle has become too small, the core adds points, fewer or at other positions.
        limit = int(np.count_nonzero(removed))
        refined, more = domains.refined(domain, caps, bound, limit)
        # At corners sharper than 60 degrees the core may leave new angles below the bound.
        bad = worse(mesh, refined, np.append(kept, np.full(more.total, -1)))
        if not more.exhausted and more.total < limit and not len(bad):
            return type(mesh)._of(refined, counts, bound, mesh.stages, mesh._workers)
        bad = worse(mesh, domain, kept)
        if not len(bad):
            return type(mesh)._of(domain, counts, bound, mesh.stages, mesh._workers)
        removed &= ~_neighborhood(mesh, kept[bad], removed)
    return mesh


def _without(mesh: MeshState, removed: Bools) -> tuple[domains.Domain, NDArray[np.intp]]:
    """Triangulate without some points; return the domain and the rows of its points."""
    kept = np.flatnonzero(~removed)
    row = np.full(mesh.npoints, -1, dtype=np.int32)
    row[kept] = np.arange(len(kept), dtype=np.int32)
    domain, _ = rebuilt(mesh, mesh.points[kept], row)
    if domain is None:
        raise InternalError("points of a mesh coincide")
    return domain, kept


def _neighborhood(mesh: MeshState, points: NDArray[np.intp], removed: Bools) -> Bools:
    """Return points and their neighbors; all points if no removed point is among these."""
    near = np.zeros(mesh.npoints, dtype=bool)
    near[points] = True
    back = np.zeros(mesh.npoints, dtype=bool)
    back[mesh.edges[near[mesh.edges].any(axis=1)]] = True
    return back if (back & removed).any() else np.ones(mesh.npoints, dtype=bool)


def _independent(mesh: MeshState, free: Bools) -> Bools:
    """Choose a maximal set of free points, no two of which are neighbors."""
    indptr, indices = topology.vertex_neighbor_vertices(mesh.edges, mesh.npoints)
    chosen, excluded = np.zeros_like(free), ~free
    # A fixed pseudorandom order of the rows, so that few rounds are enough.
    rank = (np.arange(mesh.npoints, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(
        11
    )
    owner = np.repeat(np.arange(mesh.npoints), np.diff(indptr))
    while not excluded.all():
        open_rank = np.where(excluded, np.uint64(2**63), rank)
        least = np.full(mesh.npoints, 2**63, dtype=np.uint64)
        np.minimum.at(least, owner, open_rank[indices])
        take = ~excluded & (rank < least)
        chosen |= take
        excluded |= take
        excluded[indices[take[owner]]] = True
    return chosen
