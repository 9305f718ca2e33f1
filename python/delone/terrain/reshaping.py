"""A new surface from an old one, with a pad and its side slopes instead of the ground there.

Between pieces of the overlay that differ, edges become segments of one triangulation; vertices of
the ground remain where there is ground. Triangles that the design cuts keep the rest of their
ground: their edges are soft breaklines. All others stay the same, because Delaunay triangles do not
depend on what is behind segments.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_number
from delone._tiling.plane.topology import among, edge_keys, triangles_among
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import InputError
from delone.terrain.building import Built
from delone.terrain.heights import claims_of_lines
from delone.terrain.overlay import GROUND, PAD, Overlay, overlaid
from delone.terrain.pads import CORNERS, Facets, facets_of, pad_of, plane_at
from delone.terrain.snapping import closeness, settled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.terrain.pads import Pad
    from delone.terrain.surface import Surface

__all__ = ["embanked", "flattened"]

# Slopes from this to its inverse are possible, and coordinates up to `_LARGEST`.
_MILDEST, _LARGEST = 1e-6, 1e100
# What is next to edges, apart from triangles of the design: triangles of the surface have
# `GROUND - 1` minus their number.
_OUTSIDE = GROUND


class _Change(NamedTuple):
    """What a design changes."""

    ground: Bools  # of each row of the overlay: whether its height is that of the ground
    remains: Bools  # of each vertex of the surface: whether it remains
    cut: Bools  # of each triangle: whether the design takes a part of it


class _Edges(NamedTuple):
    """Edges of the new surface."""

    ends: Indices  # (q, 2), rows of the overlay
    beside: Rows  # (q, 2), what is on both sides, ascending
    hard: Bools


def flattened(tin: Surface, polygon: Any, z: Any) -> Built:
    """Return a surface with the plane of a pad inside its polygon."""
    pad = _pad(tin, polygon, z)
    facets = Facets.none()
    overlay = overlaid(tin, pad, facets)
    return _rebuilt(tin, overlay, _change(tin, overlay), pad, facets, exact=False)


def embanked(  # noqa: PLR0917
    tin: Surface, polygon: Any, z: Any, slope: Any, cut: Any, fill: Any, corners: str
) -> Built:
    """Return a surface with a pad and its side slopes."""
    as_choice(corners, tuple(CORNERS), name="corners")
    cut, fill = _slopes(slope, cut, fill)
    pad = _pad(tin, polygon, z)
    facets = Facets.joined([facets_of(pad, cut, 1, corners), facets_of(pad, fill, -1, corners)])
    overlay = overlaid(tin, pad, facets)
    return _rebuilt(tin, overlay, _change(tin, overlay), pad, facets, exact=True)


def _slopes(slope: Any, cut: Any, fill: Any) -> tuple[float, float]:
    """Return the slopes of cut and of fill."""
    found = []
    for name, value in (("cut", cut), ("fill", fill)):
        given = slope if value is None else value
        if given is None:
            raise InputError(f"give slope, or cut and fill: {name} has none")
        number = as_number(given, name="slope" if value is None else name)
        if not _MILDEST <= number <= 1 / _MILDEST:
            raise InputError(
                f"{'slope' if value is None else name} must be from 1e-6 to 1e6: the rise per "
                f"unit of distance, such as 0.5 for 1 : 2; got {given!r:.80}. A vertical wall "
                f"cannot be "
                "part of a TIN"
            )
        found.append(number)
    return found[0], found[1]


def _pad(tin: Surface, polygon: Any, z: Any) -> Pad:
    """Return the pad, with coordinates whose products do not overflow."""
    pad = pad_of(polygon, z, tin.crs)
    extents = [*np.ptp(tin.points, axis=0), *np.ptp(pad.points, axis=0)]
    given = (tin.points, tin.z, pad.points, pad.plane)
    largest = max(float(np.abs(each).max()) for each in given)
    if not (largest <= _LARGEST and min(extents) >= 1 / _LARGEST):
        raise InputError(
            f"designs need coordinates and heights up to {_LARGEST:g} and extents of at least "
            f"{1 / _LARGEST:g}: change their unit"
        )
    return settled(pad, tin)


def _incident(overlay: Overlay, triangles: Bools) -> Bools:
    """Which vertices belong to some of these triangles."""
    found = np.zeros(overlay.mesh.npoints, dtype=bool)
    found[overlay.mesh.simplices[triangles]] = True
    return found


def _change(tin: Surface, overlay: Overlay) -> _Change:
    """Return what the design changes."""
    mesh, design = overlay.mesh, overlay.label != GROUND
    ends = mesh.points[mesh.simplices]
    longest = np.hypot(*np.moveaxis(ends - ends[:, [1, 2, 0]], -1, 0)).max(axis=1)
    # Ground as narrow as a rounding error, at an outline that is not exactly straight, does not
    # count.
    narrow = mesh.areas <= closeness(mesh.points) * longest
    ground = _incident(overlay, ~(design | overlay.outside | narrow))
    ground |= ~_incident(overlay, design)
    ground &= ~_incident(overlay, overlay.label == PAD)
    remains = np.ones(tin.npoints, dtype=bool)
    remains[overlay.vertex[overlay.vertex >= 0]] = ground[overlay.vertex >= 0]
    # Triangles as narrow as a rounding error may have no piece in the overlay.
    cut = np.array(~remains[tin.simplices].all(axis=1))
    # New points on an edge concern the triangles on both sides.
    new = _incident(overlay, design) & ~(ground & (overlay.vertex >= 0))
    there = design | new[mesh.simplices].any(axis=1)
    cut[overlay.simplex[there & (overlay.simplex >= 0)]] = True
    return _Change(ground, remains, cut)


def _edges(tin: Surface, overlay: Overlay, change: _Change, *, exact: bool) -> _Edges:
    """Return the edges of the overlay that the new surface needs.

    If `exact`, the rest of the triangles that the design cuts keeps its heights.
    """
    mesh, label = overlay.mesh, overlay.label
    beyond = np.where(overlay.simplex < 0, _OUTSIDE, GROUND - 1 - overlay.simplex)
    what = np.append(np.where(label == GROUND, beyond, label), _OUTSIDE)
    design = np.append(label != GROUND, False)
    cut = np.append(np.append(change.cut, False)[overlay.simplex], False)
    triangle = np.repeat(np.arange(mesh.nsimplex), 3)
    other = mesh.neighbors.ravel()
    once = (triangle < other) | (other < 0)
    side = np.tile(np.arange(3), mesh.nsimplex)[once]
    triangle, other = triangle[once], other[once]
    different = what[triangle] != what[other]
    of_design = design[triangle] | design[other]
    line = _lines_between(tin, overlay, triangle, other)
    rest = (cut[triangle] | cut[other]) if exact else (cut[triangle] != cut[other])
    wanted = different & (of_design | rest | ((line >= 0) & (cut[triangle] | cut[other])))
    triangle, other, side = triangle[wanted], other[wanted], side[wanted]
    ends = np.column_stack([mesh.simplices[triangle, (side + turn) % 3] for turn in (1, 2)])
    if not exact:
        what = np.where(what < GROUND, GROUND - 1, what)
    beside = np.sort(np.column_stack((what[triangle], what[other])), axis=1)
    hard = of_design[wanted] | (line[wanted] == 1)
    return _straightened(overlay, change, _Edges(ends, beside, hard))


def _lines_between(tin: Surface, overlay: Overlay, triangle: Any, other: Any) -> NDArray[np.int8]:
    """Tell hard (1) and soft (0) breaklines of the surface from other edges (-1)."""
    simplex = np.append(overlay.simplex, -1)
    one, two = simplex[triangle], simplex[other]
    found = np.full(len(one), -1, dtype=np.int8)
    status = _status(tin)
    # The overlay has no triangle of the surface where the surface has none, or where none is near.
    beside = np.where(np.append(overlay.near, False)[tin.neighbors], tin.neighbors, -1)
    for first, second in ((one, two), (two, one)):
        at = np.flatnonzero((first >= 0) & (first != second))
        side = beside[first[at]] == second[at, None]
        hits = np.where(side, status[first[at]], -1).max(axis=1)
        found[at] = np.maximum(found[at], hits)
    return found


def _status(tin: Surface) -> NDArray[np.int8]:
    """The status of the edges of triangles: 1 on hard breaklines, 0 on soft ones, -1 elsewhere."""
    ends = np.sort(tin.simplices[:, [[1, 2], [2, 0], [0, 1]]], axis=2).astype(np.int64)
    keys = ends @ np.array([tin.npoints, 1])
    lines = np.sort(tin.breaklines, axis=1).astype(np.int64) @ np.array([tin.npoints, 1])
    found = np.full(keys.shape, -1, dtype=np.int8)
    if len(lines):
        order = np.argsort(lines)
        place = np.minimum(np.searchsorted(lines[order], keys), len(lines) - 1)
        hit = lines[order][place] == keys
        found[hit] = (~tin.soft)[order][place][hit]
    return found


def _straightened(overlay: Overlay, change: _Change, edges: _Edges) -> _Edges:
    """Join edges at vertices that the new surface does not need: crossings with other edges."""
    count = np.bincount(edges.ends.ravel(), minlength=overlay.mesh.npoints)
    outline = np.zeros(len(count), dtype=bool)
    outline[edges.ends[(edges.beside == _OUTSIDE).any(axis=1)]] = True
    passed = (count == 2) & ~overlay.corner
    passed &= ~((overlay.vertex >= 0) & (change.ground | outline))
    order = np.argsort(edges.ends.ravel(), kind="stable")
    begin = np.cumsum(count) - count
    pair = order[begin[passed][:, None] + (0, 1)] // 2
    alike = (edges.beside[pair[:, 0]] == edges.beside[pair[:, 1]]).all(axis=1)
    return _joined(edges, np.flatnonzero(passed)[alike].tolist(), pair[alike].tolist())


def _joined(edges: _Edges, vertices: list[int], pairs: list[list[int]]) -> _Edges:
    """Join two edges at each of these vertices."""
    ends = edges.ends.tolist()
    # Follow edges that were joined to others, up to the one that is left.
    into = list(range(len(ends)))
    for vertex, pair in zip(vertices, pairs, strict=True):
        one, two = (_root(into, edge) for edge in pair)
        if one == two:
            continue
        a, b = ends[one], ends[two]
        ends[one] = [
            a[0] if a[1] == vertex else a[1],
            b[0] if b[1] == vertex else b[1],
        ]
        into[two] = one
    left = np.flatnonzero(np.array(into) == np.arange(len(into)))
    return _Edges(
        np.array(ends, dtype=np.int32).reshape(-1, 2)[left], edges.beside[left], edges.hard[left]
    )


def _root(into: list[int], edge: int) -> int:
    while into[edge] != edge:
        into[edge] = into[into[edge]]
        edge = into[edge]
    return edge


def _rebuilt(
    tin: Surface, overlay: Overlay, change: _Change, pad: Pad, facets: Facets, *, exact: bool
) -> Built:
    """Triangulate the vertices of the ground that remain, with the edges."""
    edges = _edges(tin, overlay, change, exact=exact)
    remains = change.remains
    row = np.full(tin.npoints, -1)
    row[remains] = np.arange(np.count_nonzero(remains))
    # Rows of the overlay that are new, or no longer vertices of the ground.
    used = np.unique(edges.ends)
    own = used[(overlay.vertex[used] < 0) | ~remains[overlay.vertex[used]]]
    to = np.full(overlay.mesh.npoints, -1)
    at_vertex = np.flatnonzero(overlay.vertex >= 0)
    to[at_vertex] = row[overlay.vertex[at_vertex]]
    to[own] = np.count_nonzero(remains) + np.arange(len(own))
    row[overlay.vertex[at_vertex]] = to[at_vertex]
    old, soft = _lines_left(tin, change)
    mesh = ConstrainedDelaunay(
        np.concatenate((tin.points[remains], overlay.mesh.points[own])),
        np.concatenate((row[old], to[edges.ends])).astype(np.int32),
        crossing="split",
        workers=tin.workers,
        planar=True,
    )
    z = np.concatenate((tin.z[remains], _heights(overlay, change, pad, facets)[own]))
    hard = np.concatenate((~soft, edges.hard))
    ends = np.concatenate((np.zeros(len(old), dtype=bool), (edges.beside == _OUTSIDE).any(axis=1)))
    kept = _kept(tin, mesh, row, ends)
    return _built(tin, mesh, _complete(mesh, z), hard, kept)


def _lines_left(tin: Surface, change: _Change) -> tuple[Indices, Bools]:
    """Return the breaklines of the surface on triangles that the design does not cut."""
    ends = np.sort(tin.simplices[change.cut][:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)
    scale = np.array([tin.npoints, 1])
    gone = ends.astype(np.int64) @ scale
    left = ~np.isin(np.sort(tin.breaklines, axis=1).astype(np.int64) @ scale, gone)
    return tin.breaklines[left], tin.soft[left]


def _heights(overlay: Overlay, change: _Change, pad: Pad, facets: Facets) -> Floats:
    """Return the height of each row of the overlay: of the ground, of a facet, or of the pad."""
    z = overlay.ground.copy()
    mesh = overlay.mesh
    at_ground = change.ground & ~np.isnan(z)
    slope = np.flatnonzero(overlay.label >= 0)
    for corner in mesh.simplices[slope].T:
        height = facets.at(overlay.label[slope], mesh.points[corner])
        # On the daylight line, heights are those of the ground, which therefore stays the same.
        z[corner] = np.where(at_ground[corner], z[corner], height)
    of_pad = np.unique(mesh.simplices[overlay.label == PAD])
    z[of_pad] = plane_at(pad.plane, mesh.points[of_pad])
    return z


def _complete(mesh: ConstrainedDelaunay, z: Floats) -> Floats:
    """Return heights of all rows: where rounded edges cross, the mean of both."""
    found = np.full(mesh.npoints, np.nan)
    found[: len(z)] = z
    if len(z) < mesh.npoints:
        claims, _ = claims_of_lines(mesh, z)
        new = claims.vertex >= len(z)
        number = np.bincount(claims.vertex[new], minlength=mesh.npoints)
        total = np.bincount(claims.vertex[new], claims.z[new], minlength=mesh.npoints)
        at = number > 0
        found[at] = total[at] / number[at]
    return found


def _kept(tin: Surface, mesh: ConstrainedDelaunay, row: Rows, ends: Bools) -> Bools:
    """Return which triangles are part of the surface; those that were left out still are.

    `ends` says which segments are where the surface ends. Between these and the old outline
    triangles are all inside or all outside, and some of them are old.
    """
    gone = row[tin._left_out()]
    if not len(gone):
        return np.ones(mesh.nsimplex, dtype=bool)
    outline = _outline(tin, mesh, row, ends)
    component = _core.components2(mesh.neighbors, outline)
    state = np.full(int(component.max()) + 1, -1)
    # A triangle of the hull is outside if it ends there without being on the outline.
    state[component[((mesh.neighbors < 0) & ~outline).any(axis=1)]] = 0
    state[component[triangles_among(mesh.simplices, gone)]] = 0
    state[component[triangles_among(mesh.simplices, row[tin.simplices])]] = 1
    triangle, side = np.nonzero(outline)
    here, there = component[triangle], component[mesh.neighbors[triangle, side]]
    here, there = (each[mesh.neighbors[triangle, side] >= 0] for each in (here, there))
    # Others are found from their neighbors across edges; each round settles some.
    while True:
        found = (state[there] < 0) & (state[here] >= 0)
        if not found.any():
            break
        state[there[found]] = 1 - state[here[found]]
    kept: Bools = state[component] == 1
    return kept


def _outline(tin: Surface, mesh: ConstrainedDelaunay, row: Rows, ends: Bools) -> Bools:
    """Which sides of triangles are on the outline of the surface, old or new."""
    start, source = mesh.segment_source
    new = np.add.reduceat(ends[source].astype(np.int64), start[:-1]) > 0
    old = row[tin.simplices[:, [[1, 2], [2, 0], [0, 1]]][tin.neighbors < 0]]
    known: Rows = np.concatenate((mesh.segments[new].astype(np.int64), old[(old >= 0).all(axis=1)]))
    sides = mesh.simplices[:, [[1, 2], [2, 0], [0, 1]]]
    return among(
        edge_keys(sides[..., 0], sides[..., 1], mesh.npoints),
        edge_keys(known[:, 0], known[:, 1], mesh.npoints),
    )


def _built(tin: Surface, mesh: ConstrainedDelaunay, z: Floats, hard: Bools, kept: Bools) -> Built:
    """Return the arrays of the new surface."""
    start, source = mesh.segment_source
    some = np.append(hard[source], False)
    soft = np.add.reduceat(some, start[:-1]) == 0 if len(start) > 1 else some[:0]
    return Built(
        mesh.points,
        z,
        mesh.simplices.copy(),
        mesh.neighbors.copy(),
        kept,
        mesh.segments.copy(),
        soft,
        tin.crs,
        tin.units,
    )
