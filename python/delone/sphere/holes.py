"""Holes in the coverage of grids: parts of the sphere outside all cells.

Cells that have a side in common, with the same ends, are joined there. The remaining sides have a
cell on one side only, and form closed rings around the holes. At a corner, a ring passes all cells
that are joined around it, so it continues with a side of the last one. A corner in a side of
another cell divides that side first. Corners that are closer to a side, or to another corner, than
rounding errors count as on it: `near_sides` has the limits. Exact signs decide the rest, and
nothing is counted where sides cross.

Joined cells form surfaces without handles, since they lie on the sphere. A surface with r rings
separates the rest into r parts, so by Alexander duality the rest of the sphere has one part more
than there are rings minus surfaces.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.duplicates import groups_of
from delone.errors import CrossingSegmentsError
from delone.sphere.constrained import ConstrainedDelaunay
from delone.sphere.coordinates import units_of
from delone.sphere.crossings import in_order
from delone.sphere.exact import turns
from delone.sphere.near_sides import NARROW, ROUNDING, beside, merged

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone._base.types import Bools, Floats, Rows

__all__ = ["Holes", "holes_between_arcs", "holes_between_rows"]


class Holes(NamedTuple):
    """The number of holes, the cells along each of their rings, and rings of rounding errors."""

    # None if cells overlap, or sides cross.
    number: int | None
    rims: tuple[Rows, ...]
    slivers: int


class _Sides(NamedTuple):
    """The sides of pieces of cells, ring by ring, with the piece on their left."""

    # The vertex where each side starts.
    start: Rows
    # The number of its ring, ascending.
    ring: Rows

    def following(self) -> Rows:
        """Return the next side in the ring of each."""
        number = np.arange(len(self.ring))
        last = np.append(self.ring[1:] != self.ring[:-1], True)[: len(number)]
        first = np.flatnonzero(np.append(True, last[:-1]))[: len(number)]
        found = number + 1
        found[last] = first
        return found

    def distinct(self) -> _Sides:
        """Return the sides without those that have no length, and without rings of two sides."""
        kept = self.lasting()
        return _Sides(self.start[kept], self.ring[kept])

    def lasting(self) -> Rows:
        """Return the rows of sides that have a length and are not in rings of two sides."""
        if not len(self.ring):
            return np.empty(0, dtype=np.int64)
        kept = np.flatnonzero(self.start != self.start[self.following()])
        ring = self.ring[kept]
        return kept[np.bincount(ring, minlength=1)[ring] > 2]

    def twins(self) -> Rows:
        """Return for each side the opposite one of another cell, or -1."""
        start, end = self.start, self.start[self.following()]
        low, high = np.minimum(start, end), np.maximum(start, end)
        order = np.lexsort((start, high, low))
        a, b = low[order], high[order]
        same = (a[1:] == a[:-1]) & (b[1:] == b[:-1])
        # Exactly two, one in each direction; others repeat a side, where cells overlap.
        first = np.flatnonzero(same & (start[order][1:] != start[order][:-1]))
        more = np.append(same[1:], False) | np.append(False, same[:-1])
        first = first[~more[first]]
        found = np.full(len(start), -1)
        found[order[first]], found[order[first + 1]] = order[first + 1], order[first]
        return found

    def repeated(self) -> bool:
        """Whether several sides without an opposite have the same ends."""
        lone = self.twins() < 0
        ends = np.sort(np.column_stack((self.start, self.start[self.following()]))[lone], axis=1)
        return len(np.unique(ends, axis=0)) < len(ends)

    def divided(self, at: Rows, vertices: Rows) -> _Sides:
        """Return sides with vertices in them; several for one side are in their order along it."""
        start = np.insert(self.start, at + 1, vertices)
        return _Sides(start, np.insert(self.ring, at + 1, self.ring[at]))


def holes_between_arcs(
    arrays: tuple[Any, ...], owner: Rows, areas: Floats, workers: int | None
) -> Holes:
    """Return the holes between polygons; `owner` is the cell of each polygon."""
    vectors, rings, cells, holes = arrays
    count = len(rings) - 1
    single = np.arange(count + 1, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    each = _core.CellGrid.polygons(vectors, rings, *single).check(False, as_workers(workers))
    lengths = np.where(each.faults == 1, 0, np.diff(rings))
    ring = np.repeat(np.arange(count), lengths)
    within = np.arange(len(ring)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    # Every ring has its cell on the left.
    turned = (np.asarray(each.turned) != holes)[ring]
    rows = rings[:-1][ring] + np.where(turned, lengths[ring] - 1 - within, within)
    units = units_of(vectors, workers)
    corners = units[rows]
    first, start = groups_of(corners)
    places = corners[first]
    sides = _Sides(start, ring).distinct()
    owner = owner[np.repeat(np.arange(len(cells) - 1), np.diff(cells))]
    # An outer ring and its holes are one piece; a cell of several outer rings has as many.
    piece = np.maximum.accumulate(np.where(holes, 0, np.arange(count)))
    sides, slivers = _joined(sides, places, np.minimum(areas[owner], each.areas))
    lone = np.flatnonzero(sides.twins() < 0)
    if len(lone):
        ends = np.column_stack((sides.start, sides.start[sides.following()]))[lone]
        exact = _on_arcs(places, ends)
        if exact is None:
            return Holes(None, (), 0)
        same, row, vertex = exact
        sides = sides.divided(lone[row], vertex)
        sides = sides._replace(start=same[sides.start]).distinct()
    if sides.repeated():
        return Holes(None, (), 0)

    def size(row: Rows) -> float:
        corners = places[sides.start[row]]
        area = _left_of_arcs(corners)
        around = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).sum()
        return area if abs(area) > NARROW / 2 * around else 0.0

    found = _holes(sides, piece, owner, areas, size)
    return found._replace(slivers=found.slivers + slivers)


def _joined(sides: _Sides, places: Floats, areas: Floats) -> tuple[_Sides, int]:
    """Return sides with the corners in them that rounding errors put beside them, and how many.

    Corners that are the same but for rounding errors are merged first. Each chain of sides that
    meet only so, between corners that they share exactly, counts once. `areas` are those of rings.
    """
    lone = sides.twins() < 0
    if not lone.any():
        return sides, 0
    ends = np.column_stack((sides.start, sides.start[sides.following()]))
    same = merged(places, ends[lone], areas[sides.ring[lone]])
    moved = lone & (same[ends] != ends).any(axis=1)
    sides = sides._replace(start=same[sides.start])
    kept = sides.lasting()
    sides, lone, moved = _Sides(sides.start[kept], sides.ring[kept]), lone[kept], moved[kept]
    alone = np.flatnonzero(sides.twins() < 0)
    at, vertex = np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64)
    if len(alone):
        ends = np.column_stack((sides.start, sides.start[sides.following()]))[alone]
        row, vertex = beside(places, ends, areas[sides.ring[alone]])
        vertex = _ordered(places, ends, row, vertex)
        at = alone[row]
        off = turns(places[ends[row, 0]], places[ends[row, 1]], places[vertex]) != 0
        moved[at[off]] = True
    divided = sides.divided(at, vertex)
    # The side of each part, and chains of sides whose parts are opposite.
    of = np.insert(np.arange(len(sides.ring)), at + 1, at)
    twin = divided.twins()
    part = np.flatnonzero(twin >= 0)
    part = part[lone[of[part]]]
    pairs = np.column_stack((of[part], of[twin[part]])).astype(np.int32)
    chain = np.asarray(_core.graph_components(pairs, len(sides.ring)))
    return divided, len(np.unique(chain[pairs[moved[pairs].any(axis=1), 0]]))


def _ordered(places: Floats, ends: Rows, row: Rows, vertex: Rows) -> Rows:
    """Return the vertices of each arc in their order along it; `row` ascends."""
    vertex = vertex.copy()
    first, counts = np.unique(row, return_index=True, return_counts=True)[1:]
    for k, n in zip(first[counts > 1].tolist(), counts[counts > 1].tolist(), strict=True):
        vertex[k : k + n] = in_order(places, ends[row[k]].tolist(), vertex[k : k + n].tolist())
    return vertex


def _on_arcs(places: Floats, ends: Rows) -> tuple[Rows, Rows, Rows] | None:
    """Return equal places, and arcs with the places that lie exactly on them, in their order.

    None if arcs cross.
    """
    used, local = np.unique(ends, return_inverse=True)
    local = local.reshape(-1, 2).astype(np.int32)
    try:
        # The axes let all places be within a hemisphere.
        mesh = ConstrainedDelaunay(
            xyz=np.concatenate((places[used], np.eye(3), -np.eye(3))), segments=local
        )
    except CrossingSegmentsError:
        return None
    same = np.arange(len(places))
    same[used] = used[mesh.duplicate_of[: len(used)]]
    through = mesh._made.through[mesh._made.through[:, 1] < len(used)]
    row, vertex = through[:, 0].astype(np.int64), used[through[:, 1]]
    order = np.argsort(row, kind="stable")
    row, vertex = row[order], vertex[order]
    return same, row, _ordered(places, ends, row, vertex)


def _left_of_arcs(corners: Floats) -> float:
    """Return the area on the left of a ring of arcs, up to whole spheres.

    The area is the sum of triangles that have a common corner, the pivot. The arc from the pivot to
    its opposite is not determined, so ways to corners around that lead through a second pivot.
    """
    pivot = corners[0]
    far = corners @ pivot < -0.5
    if not far.any():
        return _within_a_sphere(_triangles(pivot, corners[1:-1], corners[2:]))
    second = _second_pivot(corners, far)
    p, q = corners, np.roll(corners, -1, axis=0)
    first, last = far, np.roll(far, -1)
    total = _triangles(pivot, p[~first & ~last], q[~first & ~last])
    total += _triangles(second, p[first | last], q[first | last])
    # Where the ring comes near the opposite of the pivot, or leaves it, both pivots have a part.
    enter, leave = p[~first & last], q[first & ~last]
    total += _triangles(pivot, enter, np.broadcast_to(second, enter.shape))
    total += _triangles(pivot, np.broadcast_to(second, leave.shape), leave)
    return _within_a_sphere(total)


def _within_a_sphere(area: float) -> float:
    """Return an area without whole spheres, at most a half sphere in size."""
    return area - 4 * np.pi * round(area / (4 * np.pi))


def _second_pivot(corners: Floats, far: Bools) -> Floats:
    """Return a direction at 90 degrees from the first corner, opposite to none where `far` changes.

    Of 16 directions, it is the one farthest from the opposites of these corners.
    """
    pivot = corners[0]
    across = np.cross(pivot, np.eye(3)[np.argmin(np.abs(pivot))])
    across /= np.linalg.norm(across)
    turn = np.arange(16)[:, None] * np.pi / 8
    around = np.cos(turn) * across + np.sin(turn) * np.cross(pivot, across)
    ends = corners[~far & (np.roll(far, 1) | np.roll(far, -1))]
    best: Floats = around[np.argmax((around @ ends.T).min(axis=1, initial=1.0))]
    return best


def _triangles(pivot: Floats, p: Floats, q: Floats) -> float:
    """Return the sum of the areas, positive if on the left, of triangles with a common corner."""
    # Differences keep the digits of small triangles.
    across = np.cross(p - pivot, q - pivot) @ pivot
    along = 1 + p @ pivot + q @ pivot + (p * q).sum(axis=1)
    return float(2 * np.arctan2(across, along).sum())


def holes_between_rows(arrays: tuple[Any, ...], areas: Floats) -> Holes:
    """Return the holes between cells of meridians and parallels."""
    tangents, starts, meridians, numbers, _ = arrays
    inner = np.ones(len(numbers), dtype=bool)
    inner[starts[1:] - 1] = False
    # Pieces of cells, as the core has them: at most 90 degrees wide.
    west = np.flatnonzero(inner & (numbers >= 0))
    row = np.searchsorted(starts, west, side="right") - 1
    # The equator divides sides from pole to pole, whose ends do not determine them.
    level = np.unique(np.append(tangents, 0.0))
    south, north = np.searchsorted(level, tangents[row]).T
    equator = np.searchsorted(level, 0.0)
    both = np.isinf(tangents[row]).all(axis=1)
    up, down = np.where(both, equator, south), np.where(both, equator, north)
    ranks, angle = _ranks(meridians)
    left, right = ranks[west], ranks[west + 1]
    levels = np.column_stack((south, south, up, north, north, down)).ravel()
    turns = np.column_stack((left, right, right, right, left, left)).ravel()
    turns[np.isinf(level[levels])] = 0
    corners = levels * len(angle) + turns
    sides = _Sides(corners, np.repeat(np.arange(len(west)), 6)).distinct()
    lone = np.flatnonzero(sides.twins() < 0)
    if len(lone):
        sides = sides.divided(*_on_lines(sides, lone, level, angle)).distinct()

    def size(row: Rows) -> float:
        at = sides.start[row]
        return _left_of_rows(level[at // len(angle)], angle[at % len(angle)])

    return _holes(sides, np.arange(len(west)), numbers[west].astype(np.int64), areas, size)


def _ranks(meridians: Floats) -> tuple[Rows, Floats]:
    """Return the number of each meridian in order from west to east, and the angle of each number.

    Coordinates are rounded correctly, so they order the meridians within 45 degrees of an axis.
    """
    first, of = groups_of(meridians)
    c, s = meridians[first].T
    flat = np.abs(s) <= np.abs(c)
    # East from -180 to 180 degrees, as `arctan2` has them.
    west = np.where(s < 0, 0, 4)
    part = np.where(flat, np.where(c > 0, 2, west), np.where(s > 0, 3, 1))
    # The coordinate that changes faster, with the sign by which it ascends to the east.
    faster = np.where(flat, s, c) * np.where((part == 1) | (part == 2), 1.0, -1.0)
    order = np.lexsort((np.where(flat, c, s), faster, part))
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return rank[of], np.arctan2(s, c)[order]


def _on_lines(sides: _Sides, lone: Rows, level: Floats, angle: Floats) -> tuple[Rows, Rows]:
    """Return sides along meridians and parallels, and the vertices on them, in their order."""
    around = len(angle)
    ends = np.column_stack((sides.start, sides.start[sides.following()]))[lone]
    vertices = np.unique(ends)
    flat = ends[:, 0] // around == ends[:, 1] // around
    # On a parallel, the first vertex follows the last. Sides are at most 90 degrees wide.
    a, b = (ends[flat] % around).T
    east = (a < b) != (np.abs(angle[a] - angle[b]) > np.pi)
    low, high = np.where(east[:, None], ends[flat], ends[flat][:, ::-1]).T
    base = np.searchsorted(vertices, low // around * around)
    size = np.searchsorted(vertices, (low // around + 1) * around) - base
    begin = np.searchsorted(vertices, low, side="right") - base
    count = (np.searchsorted(vertices, high) - base - begin) % size
    found = [_listed(lone[flat], (base, begin, count, size), east, vertices)]
    # On a meridian, vertices are in order from south to north. Poles are on all of them.
    pole = np.isinf(level[vertices // around])
    keys = vertices[~pole] % around * len(level) + vertices[~pole] // around
    order = np.argsort(keys)
    keys, vertices = keys[order], vertices[~pole][order]
    first, second = (ends[~flat] // around).T
    rank = np.where(np.isinf(level[first])[:, None], ends[~flat][:, ::-1], ends[~flat])[:, 0]
    line = rank % around * len(level)
    begin = np.searchsorted(keys, line + np.minimum(first, second), side="right")
    count = np.searchsorted(keys, line + np.maximum(first, second)) - begin
    none, all_of = np.zeros(len(line), dtype=np.int64), np.full(len(line), max(len(keys), 1))
    found.append(_listed(lone[~flat], (none, begin, count, all_of), first < second, vertices))
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


def _listed(
    side: Rows, where: tuple[Rows, Rows, Rows, Rows], forward: Bools, vertices: Rows
) -> tuple[Rows, Rows]:
    """Return each side as often as there are vertices on it, and these in the order of the side.

    `where` is the first vertex of its line, the number in it of the first one on the side, how many
    are on the side, and how many in the line.
    """
    base, begin, count, size = where
    of = np.repeat(np.arange(len(side)), count)
    step = np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)
    step = np.where(forward[of], step, count[of] - 1 - step)
    return side[of], vertices[base[of] + (begin[of] + step) % size[of]]


def _left_of_rows(tangents: Floats, angles: Floats) -> float:
    """Return the area on the left of a ring of meridians and parallels, up to whole spheres."""
    pole = np.isinf(tangents)
    finite = np.where(pole, 0.0, tangents)
    sines = np.where(pole, np.sign(tangents), finite / np.hypot(1, finite))
    # At a pole, a ring turns from the meridian on which it comes to the one on which it goes.
    angles = np.where(pole, np.roll(angles, 1), angles)
    steps = np.roll(angles, -1) - angles
    steps = np.where(np.abs(steps) > np.pi, steps - np.copysign(2 * np.pi, steps), steps)
    turns = float(np.rint(steps.sum() / (2 * np.pi)))
    # Latitudes relative to one of them keep the digits of narrow rings.
    origin = turns if turns else sines[~pole][0]
    return float(((origin - sines) * steps).sum())


def _holes(
    sides: _Sides, piece: Rows, owner: Rows, areas: Floats, size: Callable[[Rows], float]
) -> Holes:
    """Return the holes between pieces; `piece` is that of a ring, and `owner` the cell of a piece.

    `size` returns the area on the left of sides.
    """
    if not len(sides.start):
        return Holes(1, (), 0)
    twin, following, of = sides.twins(), sides.following(), piece[sides.ring]
    joined = np.flatnonzero(twin >= 0)
    used, local = np.unique(of, return_inverse=True)
    pairs = np.column_stack((local[joined], local[twin[joined]])).astype(np.int32)
    surfaces = int(_core.graph_components(pairs, len(used)).max()) + 1
    lone = np.flatnonzero(twin < 0)
    after = following[lone]
    # Each step goes to the next cell around a corner. It ends: another side of that corner is lone,
    # because steps in the opposite direction lead back to the side before it.
    while len(inner := np.flatnonzero(twin[after] >= 0)):
        after[inner] = following[twin[after[inner]]]
    place = np.full(len(twin), -1)
    place[lone] = np.arange(len(lone))
    cell = owner[of]
    rims, slivers = [], 0
    for ring in _cycles(place[after].tolist()):
        # Sides of holes have the hole on their right.
        row = lone[ring]
        beside = np.unique(cell[row])
        if abs(size(row[::-1])) <= ROUNDING * areas[beside].min():
            slivers += 1
        else:
            rims.append(beside)
    rims.sort(key=lambda beside: beside.tolist())
    return Holes(len(rims) - surfaces + 1, tuple(rims), slivers)


def _cycles(follow: list[int]) -> list[list[int]]:
    """Return the cycles of a permutation."""
    seen, found = bytearray(len(follow)), []
    for first in range(len(follow)):
        ring, at = [], first
        while not seen[at]:
            seen[at] = True
            ring.append(at)
            at = follow[at]
        if ring:
            found.append(ring)
    return found
