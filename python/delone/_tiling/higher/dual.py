"""The Voronoi diagram in four to eight dimensions: the dual of a Delaunay triangulation.

Simplices with the same circumsphere share a Voronoi vertex. Two sites p and q have a ridge if they
are the ends of an edge of a Delaunay *cell*: the hull of the points on one empty sphere. These
cells are the facets of the lower hull of the lifted points, and the facets of the convex hull
correspond to vertices at infinity. The smallest face that contains p and q is the intersection of
all facets that contain both. So p and q have a ridge if no other point belongs to all cells and all
facets of the convex hull that contain p and q. An edge of a cell or facet that is a simplex always
has a ridge, and is not checked.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._tiling.higher.spheres import components, cospherical
from delone._tiling.higher.topology import boundary_facets, distinct, neighbors

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices, Rows

__all__ = ["DiagramN", "dual"]


@dataclass(frozen=True, eq=False)
class DiagramN:
    """A Voronoi diagram in four to eight dimensions; the fields are those of `Diagram3`."""

    vertices: Floats
    # The Voronoi vertex of each simplex; -1 if it is beyond the range of doubles.
    simplex_vertex: Indices
    # The two sites of each ridge.
    sites: Indices
    # The vertices of each ridge, ascending; -1 comes first if the ridge is unbounded.
    ridge_starts: Indices
    ridge_entries: Indices
    region: Indices
    site: Indices
    # The vertices of each cell, in the same format.
    region_starts: Indices
    region_vertices: Indices

    def arrays(self) -> tuple[Any, ...]:
        """Return the arrays in the order of the fields."""
        return tuple(getattr(self, each.name) for each in fields(self))


def dual(
    points: Floats, simplices: Indices, neighbor: Indices, centers: Floats, workers: int
) -> DiagramN:
    """Return the dual of a Delaunay triangulation; `centers` are the core's circumcenters."""
    cell = cospherical(points, simplices, neighbor, centers)
    first = np.unique(cell)
    there = np.isfinite(centers[first]).all(axis=1)
    number = np.full(len(simplices), -1)
    number[first[there]] = np.arange(int(there.sum()))
    facets = boundary_facets(simplices, neighbor)
    plane = _planes(points, facets, workers)
    sites, ridges = _ridges(simplices, cell, facets, plane, len(points))
    used = np.unique(simplices)
    region = np.full(len(points), -1, np.int32)
    region[used] = np.arange(len(used))
    of_cell = region[simplices].astype(np.int64)
    vertex = np.repeat(number[cell], simplices.shape[1])
    at_infinity = region[np.unique(facets)].astype(np.int64)
    owner = np.concatenate((of_cell.reshape(-1), at_infinity))
    regions = _rows(owner, np.append(vertex, np.full(len(at_infinity), -1)), len(used))
    owner, entry = ridges
    vertex = np.where(entry < 0, -1, number[np.maximum(entry, 0)])
    return DiagramN(
        centers[first[there]],
        number[cell].astype(np.int32),
        sites,
        *_rows(owner, vertex, len(sites)),
        region,
        used.astype(np.int32),
        *regions,
    )


def _planes(points: Floats, facets: Indices, workers: int) -> Rows:
    """Return for each boundary facet the first facet that lies in the same plane."""
    beside = neighbors(facets)
    t, k = np.nonzero(beside > np.arange(len(facets))[:, None])
    u = beside[t, k]
    # The corner of the second facet that the first does not share.
    others = facets[u]
    apart = (others[:, :, None] != facets[t][:, None, :]).all(axis=2)
    apex = others[np.arange(len(others)), apart.argmax(axis=1)]
    corners = np.column_stack((apex, facets[t])).astype(np.int32)
    flat = np.flatnonzero(_core.orientations_n(points, corners, workers) == 0)
    return components(len(facets), t[flat], u[flat].astype(np.int64))


def _ridges(
    simplices: Indices, cell: Rows, facets: Indices, plane: Rows, count: int
) -> tuple[Indices, tuple[Rows, Rows]]:
    """Return the sites of ridges, (r, 2), and pairs of ridges and their cells, -1 at infinity."""
    inner, of_inner = _pairs(simplices, count)
    outer, of_outer = _pairs(facets, count)
    keys, owner = np.unique(np.concatenate((inner, outer)), return_inverse=True)
    owner = owner.reshape(-1)
    # Number cells and planes consecutively.
    group = np.concatenate((cell[of_inner], len(cell) + plane[of_outer]))
    corners = np.concatenate((np.bincount(cell, minlength=len(cell)), np.bincount(plane)))
    simple = np.zeros(len(keys), dtype=bool)
    simple[owner[corners[group] == 1]] = True
    kept = simple.copy()
    doubtful = np.flatnonzero(~simple)
    if len(doubtful):
        kept[doubtful] = _are_edges(
            np.column_stack(np.divmod(keys[doubtful], count)),
            *_rows(*_among(owner, group, doubtful), len(doubtful)),
            _members(simplices, cell) | _members(facets, len(cell) + plane),
        )
    number = np.cumsum(kept) - 1
    own = kept[owner]
    entry = np.where(group < len(cell), group, -1)
    sites = np.column_stack(np.divmod(keys[kept], count)).astype(np.int32)
    return sites, (number[owner[own]], entry[own])


def _pairs(simplices: Indices, count: int) -> tuple[Rows, Rows]:
    """Return the edges of simplices as numbers, and the simplex of each."""
    low, high = np.array([*combinations(range(simplices.shape[1]), 2)]).T
    ascending = np.sort(simplices, axis=1).astype(np.int64)
    keys = ascending[:, low] * count + ascending[:, high]
    return keys.reshape(-1), np.repeat(np.arange(len(simplices)), len(low))


def _among(owner: Rows, group: Rows, chosen: Rows) -> tuple[Rows, Rows]:
    """Return pairs of owners and groups, for chosen owners, numbered by position in `chosen`."""
    number = np.full(int(owner.max()) + 1, -1)
    number[chosen] = np.arange(len(chosen))
    own = number[owner] >= 0
    return number[owner[own]], group[own]


def _members(simplices: Indices, label: Rows) -> dict[int, frozenset[int]]:
    """Return the corners of all simplices with each label that several simplices share."""
    order = np.argsort(label, kind="stable")
    starts = np.flatnonzero(np.append(True, np.diff(label[order]) > 0))
    ends = np.append(starts[1:], len(order))
    return {
        int(label[order[start]]): frozenset(simplices[order[start:end]].reshape(-1).tolist())
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True)
        if end - start > 1
    }


def _are_edges(
    pairs: Rows, starts: Indices, groups: Indices, members: dict[int, frozenset[int]]
) -> list[bool]:
    """Return for which pairs of points their cells and planes have no other common point."""
    found = []
    for pair, (start, end) in zip(pairs.tolist(), pairwise(starts.tolist()), strict=True):
        sets = sorted((members[k] for k in groups[start:end].tolist()), key=len)
        left = set(sets[0]).difference(pair)
        for each in sets[1:]:
            if not left:
                break
            left &= each
        found.append(not left)
    return found


def _rows(owner: Rows, entry: Rows, count: int) -> tuple[Indices, Indices]:
    """Return distinct pairs as compressed rows, with entries from -1 in ascending order."""
    width = int(entry.max(initial=0)) + 2
    keys = distinct(owner * width + entry + 1)
    owners, entries = np.divmod(keys, width)
    starts = np.searchsorted(owners, np.arange(count + 1))
    return starts.astype(np.int32), (entries - 1).astype(np.int32)
