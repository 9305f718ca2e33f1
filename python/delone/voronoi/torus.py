"""Diagrams of periodic sites: the arrays of `dual` from a periodic triangulation.

A vertex of the periodic diagram has translates; those around a site are listed at their positions.
Seen from a corner of a triangle that is moved by some periods, the circumcenter is moved back by as
many. If triangles share their circumcenter, which is decided exactly, the shift of each relative to
the first of them is known.

With one period the hull is a strip: its two borders are parallel to the period, and the ridges that
cross them are rays perpendicular to it. The cells of sites on one line along the period are strips.

A `PeriodicDual` contains the arrays of any diagram, and those that the periods require.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.immutable import sealed
from delone._core import Diagram2
from delone.errors import LimitError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices, Rows
    from delone.periodic import PeriodicDelaunay

__all__ = ["PeriodicDual", "of_line", "of_periodic", "require_room", "unrolled"]

_AFTER, _BEFORE = [1, 2, 0], [2, 0, 1]
# For an entry that is an end at infinity.
_GAP = -1


class PeriodicDual(NamedTuple):
    """The diagram of periodic sites."""

    cells: Diagram2
    # (r, 2): the number of periods by which the second site of each ridge is moved, as seen from
    # the first. The ends of a ridge are at their positions as seen from its first site.
    moved: Indices
    # (e,): for each entry of a cell the site across the ridge from there to the next.
    beside: Indices
    # (e, 2): the number of periods by which that site is moved, as seen from the cell.
    beside_moved: Indices

    def sealed(self, cells: Diagram2) -> PeriodicDual:
        """Return the same with read-only arrays, and the sealed `cells`."""
        return PeriodicDual(cells, *map(sealed, self[1:]))


def of_periodic(mesh: PeriodicDelaunay, workers: int) -> PeriodicDual:
    """Return the diagram of sites with a period in x, in y, or both."""
    lengths = np.array([length or 0.0 for length in mesh.periods])
    bounded, partners, triangle, corner, tau = _across(mesh)
    apexes = np.dstack((mesh.simplices[triangle, corner], mesh.offsets[triangle, corner] + tau))
    centers, shared = _centers(mesh, lengths, apexes, workers)
    shared &= bounded
    first, shift = _shared_centers(triangle, tau, shared)
    ridge, edges = _ridges(partners, shared)
    site, starts, codes, gaps = _cells(mesh.simplices, np.where(bounded, partners, -1), shared)
    t, k = np.divmod(codes, 3)
    entries = np.column_stack((first[t], shift[t] - mesh.offsets[t, k]))
    # An end at infinity is followed by the edge at which the path around its site begins.
    along = np.where(gaps, (k + 2) % 3, (k + 1) % 3)
    left, e = np.divmod(edges, 3)
    right, seen_from = triangle[left, e], mesh.offsets[left, (e + 1) % 3]
    ends = np.stack(
        (
            np.column_stack((first[right], shift[right] + tau[left, e] - seen_from)),
            np.column_stack((first[left], shift[left] - seen_from)),
        ),
        axis=1,
    )
    everywhere = np.column_stack((first, shift))
    vertices, (of_cells, of_ends, of_triangles) = _numbered(
        entries, ends.reshape(-1, 3), everywhere
    )
    ends = of_ends.reshape(-1, 2)
    open_ridges = np.flatnonzero(~bounded[left, e])
    ends[open_ridges, 0] = ~np.arange(len(open_ridges))
    a, b = mesh.simplices[left, (e + 1) % 3], mesh.simplices[left, (e + 2) % 3]
    moved = mesh.offsets[left, (e + 2) % 3] - seen_from
    region = np.full(mesh.npoints, -1, dtype=np.int32)
    region[site] = np.arange(len(site))
    leads = ridge[t, along]
    of_first = gaps | (partners.reshape(-1)[3 * t + along] == edges[leads])
    of_first &= gaps | (edges[leads] != 3 * t + along)
    with np.errstate(over="ignore"):
        places = centers[vertices[:, 0]] + vertices[:, 1:] * lengths
    if not np.isfinite(places).all():
        raise LimitError("a vertex lies beyond the range of doubles")
    diagram = Diagram2(
        vertices=places,
        simplex_vertex=of_triangles,
        sites=np.column_stack((a, b)),
        ends=ends,
        rays=_outward(mesh, a[open_ridges]),
        beyond=np.full((len(open_ridges), 2), np.nan),
        region=region[mesh.duplicate_of],
        site=site,
        region_starts=starts,
        region_vertices=np.where(gaps, _GAP, of_cells).astype(np.int32),
        region_ridges=leads,
    )
    return PeriodicDual(
        diagram,
        moved,
        beside=np.where(of_first, b[leads], a[leads]),
        beside_moved=np.where(of_first[:, None], moved[leads], -moved[leads]),
    )


def _across(mesh: PeriodicDelaunay) -> tuple[NDArray[Any], ...]:
    """Return what lies across each edge; an edge without a neighbor is its own partner.

    The arrays are: whether there is a neighbor, the edge as seen from there, that triangle, its
    corner, and the number of periods by which it is moved from its own position.
    """
    bounded = mesh.partners >= 0
    partners = np.where(bounded, mesh.partners, np.arange(mesh.partners.size).reshape(-1, 3))
    triangle, corner = np.divmod(partners.astype(np.int64), 3)
    tau = mesh.offsets[:, _BEFORE] - mesh.offsets[triangle, (corner + 1) % 3]
    tau[~bounded] = 0
    return bounded, partners, triangle, corner, tau


def _numbered(*parts: NDArray[Any]) -> tuple[NDArray[Any], list[Indices]]:
    """Return the distinct rows of some tables, and for each table the numbers of its rows."""
    rows, number = np.unique(np.concatenate(parts), axis=0, return_inverse=True)
    cuts = np.cumsum([len(part) for part in parts[:-1]])
    numbers = np.split(number.reshape(-1).astype(np.int32), cuts)
    return rows, [each.copy() for each in numbers]


def require_room(points: Floats, periods: tuple[float | None, float | None]) -> None:
    """Reject sites in a strip whose next copies are beyond the range of doubles.

    Rays and cells could not be computed.
    """
    if None not in periods:
        return
    lengths = np.array([length or 0.0 for length in periods])
    with np.errstate(over="ignore"):
        furthest = np.abs(points).max(axis=0, initial=0.0) + lengths
    if np.isinf(furthest[lengths > 0]).any():
        raise LimitError("the next copy of a site lies beyond the range of doubles")


def _centers(
    mesh: PeriodicDelaunay, lengths: Floats, apexes: NDArray[Any], workers: int
) -> tuple[Floats, NDArray[np.bool_]]:
    corners = np.dstack((mesh.simplices, mesh.offsets))
    try:
        return _core.periodic_centers2(
            mesh.points,
            mesh.weights,
            (float(lengths[0]), float(lengths[1])),
            np.ascontiguousarray(corners.reshape(-1, 3), dtype=np.int32),
            np.ascontiguousarray(apexes.reshape(-1, 3), dtype=np.int32),
            workers,
        )
    except ShapeError as error:
        raise LimitError(str(error)) from error


def _outward(mesh: PeriodicDelaunay, sites: Indices) -> Floats:
    """Return the directions in which ridges cross the border that contains the sites."""
    axis = 1 if mesh.periods[1] is None else 0
    heights = mesh.points[sites, axis]
    found = np.zeros((len(sites), 2))
    found[:, axis] = np.where(heights == heights.max(initial=-np.inf), 1.0, -1.0)
    return found


def of_line(
    points: Floats, chain: Indices, periods: tuple[float | None, float | None]
) -> PeriodicDual:
    """Return the diagram of sites on one line along their only period: strips.

    `chain` contains the rows of the sites in their order along the line; it is not empty.
    """
    k = len(chain)
    axis = 0 if periods[1] is None else 1
    ridges = np.arange(k, dtype=np.int32)
    moved = np.zeros((k, 2), dtype=np.int32)
    moved[-1, axis] = 1
    # The first site of a ridge is to the left of its direction.
    along = np.array([0.0, 1.0] if axis == 0 else [-1.0, 0.0])
    region = np.full(len(points), -1, dtype=np.int32)
    region[chain] = ridges
    # Each cell has the ridge to the site after it, then that to the site before it.
    before = np.roll(ridges, 1)
    after_site, before_site = np.roll(chain, -1), np.roll(chain, 1)
    diagram = Diagram2(
        vertices=np.empty((0, 2)),
        simplex_vertex=np.empty(0, dtype=np.int32),
        sites=np.column_stack((chain, after_site)).astype(np.int32),
        ends=~np.column_stack((2 * ridges, 2 * ridges + 1)),
        rays=np.tile([-along, along], (k, 1)) + 0.0,
        beyond=np.full((2 * k, 2), np.nan),
        region=region,
        site=chain.astype(np.int32),
        region_starts=np.arange(0, 2 * k + 1, 2, dtype=np.int32),
        region_vertices=np.full(2 * k, _GAP, dtype=np.int32),
        region_ridges=np.column_stack((ridges, before)).reshape(-1).astype(np.int32),
    )
    return PeriodicDual(
        diagram,
        moved,
        beside=np.column_stack((after_site, before_site)).reshape(-1).astype(np.int32),
        beside_moved=np.stack((moved, -np.roll(moved, 1, axis=0)), axis=1).reshape(-1, 2),
    )


def unrolled(
    points: Floats,
    weights: Floats | None,
    dual: PeriodicDual,
    periods: tuple[float | None, float | None],
) -> tuple[Floats, Floats | None, Diagram2]:
    """Return the cells of one period, each with its own ridges, as a diagram without periods.

    After the sites come, for each entry of a cell, the site across its ridge, at its position as
    seen from the cell. The ridges are the entries.
    """
    lengths = np.array([length or 0.0 for length in periods])
    cells = dual.cells
    starts, entries = cells.region_starts, cells.region_vertices
    count, sizes = len(entries), np.diff(starts)
    owner = np.repeat(cells.site, sizes)
    following = np.arange(1, count + 1)
    following[starts[1:] - 1] = starts[:-1]
    at = points[dual.beside] + dual.beside_moved * lengths
    ends = np.column_stack((entries, entries[following]))
    opens = np.flatnonzero(ends < 0)
    # A ray points out of the border on which its site lies; a line first down, then up.
    axis = 1 if periods[1] is None else 0
    rays = np.zeros((len(opens), 2))
    turned = cells.region_ridges[opens // 2]
    of_first = (cells.sites[turned, 0] == owner[opens // 2]) & (
        dual.moved[turned] == dual.beside_moved[opens // 2]
    ).all(axis=1)
    which = np.where(of_first, opens % 2, 1 - opens % 2)
    codes = cells.ends[turned, which]
    rays[:, axis] = cells.rays[~codes, axis]
    ends.reshape(-1)[opens] = ~np.arange(len(opens))
    unfolded = Diagram2(
        vertices=cells.vertices,
        simplex_vertex=np.empty(0, dtype=np.int32),
        sites=np.column_stack((owner, len(points) + np.arange(count))).astype(np.int32),
        ends=ends.astype(np.int32),
        rays=rays,
        beyond=np.full((len(opens), 2), np.nan),
        region=np.empty(0, dtype=np.int32),
        site=cells.site,
        region_starts=starts,
        region_vertices=entries,
        region_ridges=np.arange(count, dtype=np.int32),
    )
    at_weights = None if weights is None else np.concatenate((weights, weights[dual.beside]))
    return np.concatenate((points, at)), at_weights, unfolded


def _shared_centers(
    neighbor: Rows, tau: NDArray[Any], shared: NDArray[np.bool_]
) -> tuple[Rows, Rows]:
    """Return the first triangle with the same circumcenter, and the shift from there."""
    first = np.arange(len(neighbor))
    shift = np.zeros((len(neighbor), 2), dtype=np.int64)
    seen = np.zeros(len(neighbor), dtype=bool)
    for start in np.flatnonzero(shared.any(axis=1)).tolist():
        if seen[start]:
            continue
        seen[start] = True
        stack = [start]
        # Each triangle is pushed once, when it is first seen.
        while stack:
            t = stack.pop()
            for k in np.flatnonzero(shared[t]).tolist():
                other = int(neighbor[t, k])
                if not seen[other]:
                    seen[other] = True
                    first[other] = start
                    shift[other] = shift[t] - tau[t, k]
                    stack.append(other)
    return first, shift


def _ridges(
    partners: NDArray[Any], shared: NDArray[np.bool_]
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Return the ridge of each edge of each triangle, and for each ridge its first edge.

    An edge of the border is its own partner.
    """
    codes = np.arange(shared.size, dtype=np.int64).reshape(-1, 3)
    owner = np.minimum(codes, partners)
    edges = np.flatnonzero(((owner == codes) & ~shared).reshape(-1))
    number = np.full(shared.size, -1, dtype=np.int32)
    number[edges] = np.arange(len(edges))
    return number[owner], edges


def _cells(
    simplices: Indices, partners: NDArray[Any], shared: NDArray[np.bool_]
) -> tuple[Indices, Indices, Rows, NDArray[np.bool_]]:
    """Return sites, where the entries of each begin, and the corner (3 t + k) of each entry.

    All sites are circled in parallel, one triangle per step, so the number of steps is the largest
    number of triangles around one site. On a border, the path begins there, with an entry for the
    end at infinity; the last result marks these.
    """
    across = partners[:, _AFTER].astype(np.int64)
    after = np.where(across < 0, -1, across // 3 * 3 + (across % 3 + 1) % 3).reshape(-1)
    emits = ~shared[:, _AFTER].reshape(-1)
    site, start = np.unique(simplices.reshape(-1), return_index=True)
    begins = np.flatnonzero(partners[:, _BEFORE].reshape(-1) < 0)
    place_of = np.searchsorted(site, simplices.reshape(-1)[begins])
    start = start.astype(np.int64)
    start[place_of] = begins
    owners, places, codes = [place_of], [np.full(len(begins), -1)], [begins]
    going, now, step = np.arange(len(site)), start, 0
    while len(going):
        owners.append(going)
        places.append(np.full(len(going), step))
        codes.append(now)
        now = after[now]
        further = (now != start[going]) & (now >= 0)
        going, now, step = going[further], now[further], step + 1
    owner, place, code = map(np.concatenate, (owners, places, codes))
    order = np.lexsort((place, owner))
    owner, code, gap = owner[order], code[order], place[order] < 0
    kept = emits[code] | gap
    owner, code, gap = owner[kept], code[kept], gap[kept]
    starts = np.zeros(len(site) + 1, dtype=np.int32)
    np.cumsum(np.bincount(owner, minlength=len(site)), out=starts[1:])
    return site.astype(np.int32), starts, code, gap
