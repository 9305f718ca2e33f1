"""The overlay of a surface with a pad and its side slopes: in each piece, one plane applies.

The edges of the surface near the pad, the edges of the pad and the rims of the facets are segments
of a first triangulation. In a region between them the surface is one plane, and so is each facet:
which triangle, pad and facets contain a region follows from the segments around it (`coverage`);
where two of these planes cross in a triangle, the crossing is a segment of a second triangulation.
In each of its regions, one plane applies: that of the highest facet above the ground, or of the
lowest facet below it. Regions that are not connected to the pad remain ground.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.constrained.coverage import odd_pairs
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.membership import containing
from delone.delaunay import Delaunay
from delone.errors import OutsideError
from delone.terrain.pads import inside, plane_at
from delone.terrain.snapping import closeness, threaded

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.terrain.pads import Facets, Pad
    from delone.terrain.surface import Surface

__all__ = ["GROUND", "PAD", "Overlay", "overlaid"]

# Labels of triangles; those of facets are their numbers.
PAD, GROUND = -1, -2
# Height differences of at most this many rounding errors count as zero, on surfaces no steeper than
# this.
_ROUNDINGS, _STEEPEST = 64, 16.0
# A slope whose direction differs from that of the outline by less than this runs along it.
_ALONG = 1e-6
# Number of points on each edge of a pad to which distances are measured.
_SPREAD = 4
_EPS = float(np.finfo(np.float64).eps)
# The polygons of segments: the pad, the whole surface, facets by their numbers from `_FACETS` on,
# then the triangles of the surface that are near.
_PAD, _SURFACE, _FACETS = 0, 1, 2


class Overlay(NamedTuple):
    """Pieces of the surface, of the pad and of facets."""

    mesh: ConstrainedDelaunay
    label: Rows  # of each triangle: `PAD`, `GROUND` or the number of a facet
    simplex: Rows  # of each triangle: that of the surface; -1 if there is none, or it is not near
    outside: Bools  # of each triangle: not on the surface
    vertex: Rows  # of each row of `mesh`: the vertex of the surface there, or -1
    corner: Bools  # of each row of `mesh`: a point of the pad
    ground: Floats  # of each row of `mesh`: the height of the surface; NaN if it is not near
    near: Bools  # of each triangle of the surface: whether it is part of the overlay


class _Sides(NamedTuple):
    """Segments to triangulate, and the polygon of each, -1 for none; one row for each side."""

    points: Floats
    segments: Indices
    polygons: Indices

    def mesh(self, workers: int | None) -> ConstrainedDelaunay:
        """Triangulate them."""
        return ConstrainedDelaunay(
            self.points, self.segments, crossing="split", workers=workers, planar=True
        )


class _Cells(NamedTuple):
    """The regions between segments of a triangulation."""

    largest: Rows  # the largest triangle of each
    center: Floats  # a point in it
    simplex: Rows  # as in `Overlay`
    outside: Bools
    pad: Bools
    beyond: Bools  # inside the polygon, but not on the surface
    facets: Rows  # (k, 2), regions and facets that contain them


class _Pairs(NamedTuple):
    """Triangles, and facets on them that are above the ground (fill) or below it (cut)."""

    triangle: Rows
    facet: Rows
    excess: Floats  # (p, 3), by how much, at the corners


class _Lines(NamedTuple):
    """Segments between points on edges of a triangulation."""

    points: Floats  # (k, 2), new points
    segments: Rows  # (s, 2), rows of the triangulation, then of new points
    ends: Indices  # (k, 2), the edge of each new point
    share: Floats  # (k,), where on it


def overlaid(tin: Surface, pad: Pad, facets: Facets) -> Overlay:
    """Overlay a surface with a pad and its side slopes."""
    near, reach = _near(tin, pad, facets)
    if not near.any():
        raise _leaves(*pad.points[0].tolist())
    first, used = _first(tin, pad, facets, near, reach)
    mesh = first.mesh(tin.workers)
    cells = _cells(mesh, first.polygons, near, len(reach))
    _refuse_outside(tin, pad, mesh, cells)
    ground = _ground(tin, mesh, cells, used)
    if len(facets.height):
        slack = _slack(tin, pad, facets, near)
        pairs = _raised(mesh, cells, facets, ground, slack)
        second = _split(mesh, first.polygons, pairs, facets, slack)
        mesh = second.mesh(tin.workers)
        cells = _cells(mesh, second.polygons, near, len(reach))
        ground = _ground(tin, mesh, cells, used)
        pairs = _raised(mesh, cells, facets, ground, slack)
        label = _connected(mesh, _labels(mesh, cells, pairs, facets))
        _refuse_leaving(mesh, cells, facets, label)
    else:
        label = np.where(cells.pad[mesh.region], PAD, GROUND)
    vertex = np.full(mesh.npoints, -1)
    vertex[: len(used)] = used
    corner = np.zeros(mesh.npoints, dtype=bool)
    corner[mesh.duplicate_of[len(used) : len(used) + len(pad.points)]] = True
    simplex, outside = cells.simplex[mesh.region], cells.outside[mesh.region]
    return Overlay(mesh, label, simplex, outside, vertex, corner, ground, near)


def _near(tin: Surface, pad: Pad, facets: Facets) -> tuple[Bools, Floats]:
    """Return which triangles the pad and its slopes can meet, and how far each facet can reach."""
    away, excess = _distances(tin.points, pad)
    corners = tin.points[tin.simplices]
    size = np.hypot(*np.moveaxis(corners - corners[:, [1, 2, 0]], -1, 0)).max(axis=1)
    closest = np.maximum(away[tin.simplices].min(axis=1) - size - excess, 0)
    near = closest == 0
    z, ends = tin.z[tin.simplices], plane_at(pad.plane, pad.points)
    reach = np.zeros(len(facets.height))
    for rise, best, lowest in ((-1, ends.max(), z.min(axis=1)), (1, -ends.min(), -z.max(axis=1))):
        mine = facets.rise == rise
        if not (mine.any() and near.any()):
            continue
        met = best - facets.mildest[mine][0] * closest >= lowest
        # Facets are cut off beyond the last triangle that they can meet.
        reach[mine] = 1.0625 * float(away[tin.simplices[met | near]].max())
        near |= met
    return near, reach


def _distances(points: Floats, pad: Pad) -> tuple[Floats, float]:
    """Return distances of points to a pad, 0 inside, and by how much they may be too large.

    They are distances to the nearest of points that are spread over the edges of the pad.
    """
    ends = pad.points[pad.edges]
    lengths = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    step = float(lengths.sum()) / (_SPREAD * len(lengths))
    parts = np.ceil(lengths / step).astype(np.int64)
    edge = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(len(edge)) - (np.cumsum(parts) - parts)[edge]) / parts[edge]
    spread = ends[edge, 0] + share[:, None] * (ends[edge, 1] - ends[edge, 0])
    mesh = Delaunay(spread, planar=True)
    found = np.hypot(*(points - spread[mesh.nearest(points)]).T)
    found[inside(points, pad)] = 0.0
    return found, step


def _first(
    tin: Surface, pad: Pad, facets: Facets, near: Bools, reach: Floats
) -> tuple[_Sides, Rows]:
    """Return what is triangulated first, and the vertices of the surface that come first in it."""
    sides, of_triangle = _sides_of_surface(tin, near, _FACETS + len(reach))
    used, rows = np.unique(sides, return_inverse=True)
    far = reach[:, None]
    rims: tuple[Floats, ...] = (
        facets.start,
        facets.start + far * facets.first,
        facets.end + far * facets.last,
        facets.end,
    )
    rim = np.arange(4 * len(far)).reshape(4, -1).T + len(used) + len(pad.points)
    points = np.concatenate((tin.points[used], pad.points, *rims))
    ours, corners = np.arange(len(used)), len(used) + np.arange(len(pad.points))
    edges, edge = np.unique(np.sort(rows.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    pieces, whole = threaded(points, edges, corners)
    # Each piece of an edge is a side of the triangles on both sides of the edge.
    order = np.argsort(whole, kind="stable")
    begin = np.searchsorted(whole[order], np.arange(len(edges) + 1))
    side, piece = _expanded(begin, edge.reshape(-1))
    # For a facet, also the edge of the pad, which closes its rims.
    around = [rim[:, [k, k + 1]] for k in range(3)] + [rim[:, [0, 3]]]
    others, row = threaded(points, np.concatenate([pad.edges + len(used), *around]), ours)
    number = np.concatenate(
        (np.full(len(pad.edges), _PAD), np.tile(_FACETS + np.arange(len(far)), 4))
    )
    return _Sides(
        points,
        np.concatenate((pieces[order[piece]], others)).astype(np.int32),
        np.concatenate((of_triangle[side], number[row])).astype(np.int32),
    ), used.astype(np.int64)


def _sides_of_surface(tin: Surface, near: Bools, first: int) -> tuple[Indices, Rows]:
    """Return the sides of near triangles and of the whole surface, and the polygon of each."""
    around = tin.simplices[:, [[1, 2], [2, 0], [0, 1]]]
    triangles = np.flatnonzero(near)
    outline = around[tin.neighbors < 0]
    return np.concatenate((around[triangles].reshape(-1, 2), outline)), np.concatenate(
        (
            np.repeat(first + np.arange(len(triangles)), 3),
            np.full(len(outline), _SURFACE),
        )
    )


def _expanded(begin: Rows, rows: Rows) -> tuple[Rows, Rows]:
    """Return the places in `rows`, and the items from `begin[row]` to `begin[row + 1]` of each."""
    count = begin[rows + 1] - begin[rows]
    place = np.repeat(np.arange(len(rows)), count)
    first = np.repeat(begin[rows] - np.cumsum(count) + count, count)
    return place, first + np.arange(len(place))


def _cells(mesh: ConstrainedDelaunay, polygons: Indices, near: Bools, nfacets: int) -> _Cells:
    """Find what contains each region: the segments around it decide."""
    order = np.lexsort((mesh.areas, mesh.region))
    largest = order[np.flatnonzero(np.diff(mesh.region[order], append=-1))]
    region, polygon = containing(mesh, polygons).T
    pad, surface = np.zeros(len(largest), dtype=bool), np.zeros(len(largest), dtype=bool)
    pad[region[polygon == _PAD]] = True
    surface[region[polygon == _SURFACE]] = True
    simplex = np.full(len(largest), -1)
    of_triangle = polygon >= _FACETS + nfacets
    simplex[region[of_triangle]] = np.flatnonzero(near)[polygon[of_triangle] - _FACETS - nfacets]
    # Regions as narrow as a rounding error may be beyond an edge of their triangle and of the
    # surface.
    simplex[~surface] = -1
    of_facet = (polygon >= _FACETS) & ~of_triangle
    return _Cells(
        largest,
        mesh.points[mesh.simplices[largest]].mean(axis=1),
        simplex,
        ~surface,
        pad & surface,
        pad & ~surface,
        np.column_stack((region, polygon - _FACETS))[of_facet],
    )


def _ground(tin: Surface, mesh: ConstrainedDelaunay, cells: _Cells, used: Rows) -> Floats:
    """Return the height of the surface at each vertex, each on one of its triangles."""
    found = np.full(mesh.npoints, np.nan)
    simplex = cells.simplex[mesh.region]
    at = np.flatnonzero(simplex >= 0)
    rows = mesh.simplices[at].ravel()
    corner = tin.simplices[np.repeat(simplex[at], 3)]
    a, b, c = (tin.points[corner[:, k]] for k in range(3))
    low, mid, high = (tin.z[corner[:, k]] for k in range(3))
    p = mesh.points[rows] - a
    twice = _cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        v, w = _cross(p, c - a) / twice, _cross(b - a, p) / twice
        height = low + v * (mid - low) + w * (high - low)
    # If several triangles of the surface meet, the largest has the smallest rounding errors.
    order = np.argsort(twice, kind="stable")
    found[rows[order]] = height[order]
    found[: len(used)] = tin.z[used]
    return found


def _slack(tin: Surface, pad: Pad, facets: Facets, near: Bools) -> float:
    """Return the difference of heights that rounding may cause."""
    steepness = np.hypot(*tin.gradients[near].T).max()
    steepness = min(float(steepness), _STEEPEST) + float(np.hypot(*facets.gradient.T).max())
    span = max(float(np.abs(tin.min_bound).max()), float(np.abs(tin.max_bound).max()))
    rise = max(float(np.abs(tin.z).max()), float(np.abs(plane_at(pad.plane, pad.points)).max()))
    return _ROUNDINGS * _EPS * (span * steepness + rise)


def _raised(
    mesh: ConstrainedDelaunay,
    cells: _Cells,
    facets: Facets,
    ground: Floats,
    slack: float,
) -> _Pairs:
    """Return the facets on each triangle that are above its ground (fill) or below it (cut)."""
    order = np.argsort(mesh.region, kind="stable")
    begin = np.searchsorted(mesh.region[order], np.arange(len(cells.center) + 1))
    region, facet = cells.facets[((cells.simplex >= 0) & ~cells.pad)[cells.facets[:, 0]]].T
    place, at = _expanded(begin, region)
    triangle, facet = order[at], facet[place]
    corners = mesh.simplices[triangle]
    heights = facets.at(np.repeat(facet, 3), mesh.points[corners.ravel()]).reshape(-1, 3)
    excess = -facets.rise[facet, None] * (heights - ground[corners])
    excess[np.abs(excess) <= slack] = 0.0
    some = np.flatnonzero((excess > 0).any(axis=1))
    some = some[np.lexsort((facet[some], triangle[some]))]
    return _Pairs(triangle[some], facet[some], excess[some])


def _split(
    mesh: ConstrainedDelaunay, polygons: Indices, pairs: _Pairs, facets: Facets, slack: float
) -> _Sides:
    """Return the segments again, with the lines where planes cross."""
    triangles, values = [pairs.triangle], [pairs.excess]
    for first, second in _couples(pairs, facets):
        # Not from the excesses, which are rounded to zero.
        corners = mesh.simplices[pairs.triangle[first]]
        one = facets.at(np.repeat(pairs.facet[first], 3), mesh.points[corners.ravel()])
        two = facets.at(np.repeat(pairs.facet[second], 3), mesh.points[corners.ravel()])
        difference = (one - two).reshape(-1, 3)
        difference[np.abs(difference) <= slack] = 0.0
        triangles.append(pairs.triangle[first])
        values.append(difference)
    found = _zero_lines(mesh, np.concatenate(triangles), np.concatenate(values))
    pieces, whole = _through(mesh, found)
    # Each piece is a side of the polygons of its subsegment.
    subsegment, polygon = odd_pairs(*mesh.segment_source, polygons).T
    begin = np.searchsorted(subsegment, np.arange(len(mesh.segments) + 1))
    piece, at = _expanded(begin, whole)
    bare = np.flatnonzero(begin[whole + 1] == begin[whole])
    lines = np.concatenate((pieces[bare], found.segments))
    return _Sides(
        np.concatenate((mesh.points, found.points)),
        np.concatenate((pieces[piece], lines)).astype(np.int32),
        np.concatenate((polygon[at], np.full(len(lines), -1))).astype(np.int32),
    )


def _couples(pairs: _Pairs, facets: Facets) -> list[tuple[Rows, Rows]]:
    """Return rows of `pairs` of one triangle whose facets are both fill, or both cut."""
    found: list[tuple[Rows, Rows]] = []
    step = 1
    while True:
        first = np.flatnonzero(pairs.triangle[step:] == pairs.triangle[:-step])
        if not len(first):
            return found
        second = first + step
        same = facets.rise[pairs.facet[first]] == facets.rise[pairs.facet[second]]
        found.append((first[same], second[same]))
        step += 1


def _zero_lines(mesh: ConstrainedDelaunay, triangle: Rows, values: Floats) -> _Lines:
    """Return where linear functions on triangles are zero."""
    some = (values != 0).any(axis=1)
    triangle, values = triangle[some], values[some]
    sign = np.sign(values)
    changes = sign[:, [1, 2, 0]] * sign[:, [2, 0, 1]] < 0  # on the edge opposite each corner
    row, side = np.nonzero(changes)
    two = (side[:, None] + (1, 2)) % 3
    ends, at = mesh.simplices[triangle[row][:, None], two], values[row[:, None], two]
    # From the smaller row, so that both triangles at an edge compute the same point.
    turned = ends[:, 0] > ends[:, 1]
    ends[turned], at[turned] = ends[turned, ::-1], at[turned, ::-1]
    p, q = (mesh.points[ends[:, k]] for k in range(2))
    share = at[:, 0] / (at[:, 0] - at[:, 1])
    # Ends are corners that are zero and edges with a change of sign: a segment has two.
    zero, corner = np.nonzero(sign == 0)
    of = np.concatenate((row, zero))
    end = np.concatenate(
        (mesh.npoints + np.arange(len(row)), mesh.simplices[triangle[zero], corner])
    )
    order = np.argsort(of, kind="stable")
    of, end = of[order], end[order]
    first = np.flatnonzero(of[1:] == of[:-1])
    segments = np.column_stack((end[first], end[first + 1]))
    return _Lines(p + share[:, None] * (q - p), segments, ends, share)


def _through(mesh: ConstrainedDelaunay, lines: _Lines) -> tuple[Rows, Rows]:
    """Return the segments of a mesh, through the new points that are on them, and their rows.

    Points are rounded: otherwise, regions on both sides of a segment would be connected next to its
    new points.
    """
    scale = np.array([mesh.npoints, 1])
    keys = np.sort(mesh.segments, axis=1).astype(np.int64) @ scale
    edge = lines.ends.astype(np.int64) @ scale
    on = np.flatnonzero(np.isin(edge, keys))
    on = on[np.lexsort((lines.share[on], edge[on]))]
    edge, point = edge[on], mesh.npoints + on
    last = np.diff(edge, append=-1) != 0
    first = np.roll(last, 1)
    by_key = np.argsort(keys)
    whole, row = np.flatnonzero(~np.isin(keys, edge)), by_key[np.searchsorted(keys[by_key], edge)]
    return np.concatenate(
        (
            mesh.segments[whole],
            np.column_stack((lines.ends[on[first], 0], point[first])),
            np.column_stack((point[:-1], point[1:]))[~last[:-1]],
            np.column_stack((point[last], lines.ends[on[last], 1])),
        )
    ), np.concatenate((whole, row[first], row[:-1][~last[:-1]], row[last]))


def _labels(mesh: ConstrainedDelaunay, cells: _Cells, pairs: _Pairs, facets: Facets) -> Rows:
    """Return which plane applies to each triangle: the largest triangle of a region decides."""
    region = mesh.region[pairs.triangle]
    here = (cells.largest[region] == pairs.triangle) & (pairs.excess.sum(axis=1) > 0)
    region, facet = region[here], pairs.facet[here]
    # For fill the highest, for cut the lowest; among equal ones, the first.
    height = -facets.rise[facet] * facets.at(facet, cells.center[region])
    order = np.lexsort((-facet, height, region))
    found = np.where(cells.pad, PAD, GROUND)
    found[region[order]] = facet[order]
    label: Rows = found[mesh.region]
    return label


def _connected(mesh: ConstrainedDelaunay, label: Rows) -> Rows:
    """Change facets that are not connected to the pad back to ground."""
    around = np.where(mesh.neighbors < 0, GROUND, label[mesh.neighbors])
    slope = label >= 0
    reached = slope & (around == PAD).any(axis=1)
    front = np.flatnonzero(reached)
    while len(front):
        beside = mesh.neighbors[front].ravel()
        beside = np.unique(beside[beside >= 0])
        front = beside[slope[beside] & ~reached[beside]]
        reached[front] = True
    found: Rows = np.where(slope & ~reached, GROUND, label)
    return found


def _refuse_outside(tin: Surface, pad: Pad, mesh: ConstrainedDelaunay, cells: _Cells) -> None:
    """Reject a pad that leaves the surface."""
    off = cells.beyond[mesh.region]
    if not off.any():
        return
    edges = pad.points[pad.edges]
    length = np.hypot(*(edges[:, 1] - edges[:, 0]).T).sum()
    # The polygon may be on the outline up to rounding.
    if mesh.areas[off].sum() <= closeness(tin.points, pad.points) * length:
        return
    away = pad.points[tin.find_simplex(pad.points) < 0]
    places = away if len(away) else cells.center[cells.beyond]
    raise _leaves(*places[0].tolist())


def _leaves(x: float, y: float) -> OutsideError:
    return OutsideError(f"the polygon leaves the surface at ({x:.10g}, {y:.10g})", place=(x, y))


def _refuse_leaving(mesh: ConstrainedDelaunay, cells: _Cells, facets: Facets, label: Rows) -> None:
    """Reject slopes that run across the outline of the surface before they meet the ground."""
    outside = np.append(cells.outside[mesh.region], True)[mesh.neighbors]
    triangle, side = np.nonzero(outside & (label >= 0)[:, None])
    a, b = (mesh.points[mesh.simplices[triangle, (side + turn) % 3]] for turn in (1, 2))
    normal = np.column_stack(((b - a)[:, 1], -(b - a)[:, 0]))
    facet = label[triangle]
    across = (normal * facets.outward[facet]).sum(axis=1) / np.hypot(*normal.T)
    away = (((a + b) / 2 - facets.start[facet]) * facets.outward[facet]).sum(axis=1)
    limit = closeness(mesh.points)
    left = np.flatnonzero((across > _ALONG) & (away > limit) & (np.hypot(*normal.T) > limit))
    if not len(left):
        return
    x, y = (a[left[0]] + b[left[0]]) / 2
    fill = facets.rise[facet[left[0]]] < 0
    raise OutsideError(
        f"the side slope of {'fill' if fill else 'cut'} leaves the surface at ({x:.10g}, {y:.10g}) "
        "without meeting the ground: choose a steeper slope or another height, or survey more",
        place=(x, y),
    )


def _cross(u: Floats, v: Floats) -> Floats:
    found: Floats = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return found
