"""Bilinear weights between the centers of cells that meet at corners: curvilinear grids and meshes.

Where four cells meet, their centers are a quadrilateral, whose sides are arcs of great circles. A
direction in it is that of one point of the bilinear patch of its corners, seen from the middle of
the sphere, so that two quadrilaterals agree on their common side. Exact signs decide which one
contains a direction, and whether that is on a side or at a corner.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.duplicates import groups_of
from delone.errors import InputError
from delone.sphere.coordinates import directions_of, units_of
from delone.sphere.exact import turns

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows
    from delone.sphere.grid import Grid

__all__ = ["between_corners"]

# Maximum number of steps of Newton's method; with quadratic convergence, it takes about five.
_STEPS = 30
# Smaller steps end it: a few units in the last place of 1.
_SMALL = 2.0**-48
# A solution farther outside the quadrilateral that contains the query is on a wrong branch.
_OUTSIDE = 1e-6
# Half the size of the triangles, in radians, by which pieces are looked up: their areas are large
# enough for the core not to treat them as empty.
_NEEDLE = 1e-8


class _Pieces(NamedTuple):
    """Quadrilaterals and triangles between centers, counterclockwise."""

    # Vectors of the centers of all cells, then those of corners where more than four cells meet.
    places: Floats
    # Rows of `places`, (p, 4); the last is -1 for triangles.
    corners: Rows
    # Cells around each of the corners at the end of `places`, as compressed rows.
    starts: Rows
    members: Rows


class _Found(NamedTuple):
    """Rows of queries, of places, and weights."""

    rows: Rows
    places: Rows
    weights: Floats


def between_corners(
    source: Grid, used: Bools | None, queries: Floats, workers: int | None
) -> tuple[Rows, Rows, Floats]:
    """Return rows of queries, cells of the source, and weights.

    Queries are longitudes and latitudes in degrees. Those outside all pieces have no entries.
    """
    pieces = _pieces(source, used, workers)
    vectors = directions_of(queries, None, degrees=True, workers=workers, any_turns=True)
    rows, at = _candidates(pieces, vectors, workers)
    found = _weighted(pieces, vectors, rows, at, workers)
    # The value at a corner where many cells meet is the mean of theirs.
    count = source.ncells
    cells = found.places < count
    many = found.places[~cells] - count
    sizes = np.diff(pieces.starts)[many]
    within = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    return (
        np.concatenate((found.rows[cells], np.repeat(found.rows[~cells], sizes))),
        np.concatenate(
            (found.places[cells], pieces.members[np.repeat(pieces.starts[many], sizes) + within])
        ),
        np.concatenate((found.weights[cells], np.repeat(found.weights[~cells] / sizes, sizes))),
    )


def _pieces(source: Grid, used: Bools | None, workers: int | None) -> _Pieces:
    """Return the pieces between the centers of cells around each corner."""
    nodes, starts, members = _around(source, used)
    sizes = np.diff(starts)
    centers = np.zeros((source.ncells, 3))
    there = np.isfinite(source.centers_lonlat).all(axis=1)
    lonlat = source.centers_lonlat[there]
    centers[there] = directions_of(lonlat, None, degrees=True, workers=workers, any_turns=True)
    parts = []
    for size in (3, 4):
        chosen = starts[:-1][sizes == size]
        corners = members[chosen[:, None] + np.arange(size)]
        parts.append(np.pad(corners, ((0, 0), (0, 4 - size)), constant_values=-1))
    # Around a corner with more cells, such as a pole, use triangles with the corner itself.
    many = np.flatnonzero(sizes > 4)
    count = sizes[many]
    within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    first = np.repeat(starts[many], count)
    after = np.where(within + 1 < np.repeat(count, count), within + 1, 0)
    own = source.ncells + np.repeat(np.arange(len(many)), count)
    none = np.full(len(own), -1)
    parts.append(np.column_stack((own, members[first + within], members[first + after], none)))
    corners = np.concatenate(parts).astype(np.int64)
    if not len(corners):
        raise InputError(
            "bilinear needs a source in rows and columns, or cells that have corners in common, "
            "and no corner of this one has cells on all sides: linear is for all grids"
        )
    return _Pieces(
        np.concatenate((centers, nodes[many])),
        corners,
        np.concatenate(([0], np.cumsum(count))).astype(np.int64),
        members[first + within],
    )


def _around(source: Grid, used: Bools | None) -> tuple[Floats, Rows, Rows]:
    """Return the corners with cells on all sides, and these cells, counterclockwise.

    If cells have the same corners, as in the rows and columns that ocean grids repeat, only the
    first used one counts.
    """
    cell, node, before, after, vectors = _corners(source, used)
    count = len(vectors)
    # A cell at a corner is followed by the one that shares the side toward the corner before.
    outgoing, incoming = node * count + after, node * count + before
    order = np.argsort(outgoing, kind="stable")
    lined = outgoing[order]
    twice = np.flatnonzero(lined[1:] == lined[:-1])
    wrong = np.zeros(count, dtype=bool)
    # Two cells on the same side of an edge overlap.
    wrong[lined[twice] // count] = True
    wrong[lined[twice] % count] = True
    sought = np.argsort(incoming, kind="stable")
    place = np.minimum(np.searchsorted(lined, incoming[sought]), max(len(lined) - 1, 0))
    following = np.full(len(lined), -1)
    following[sought] = np.where(lined[place] == incoming[sought], order[place], -1)
    wrong[node[following < 0]] = True
    by_node = np.argsort(node, kind="stable")
    sizes = np.bincount(node, minlength=count)
    firsts = np.concatenate(([0], np.cumsum(sizes)))[:-1]
    good = np.flatnonzero(~wrong & (sizes >= 3))
    sizes = sizes[good]
    starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
    members = np.empty(starts[-1], dtype=np.int64)
    first = at = by_node[firsts[good]] if len(good) else np.zeros(0, dtype=np.int64)
    closed = np.ones(len(good), dtype=bool)
    for step in range(int(sizes.max(initial=0))):
        live = sizes > step
        # One turn visits all cells of a corner; if it ends early, other cells only touch the
        # corner.
        closed &= ~live | (step == 0) | (at != first)
        members[starts[:-1][live] + step] = cell[at[live]]
        at = np.where(live, following[at], at)
    kept = np.repeat(closed, sizes)
    sizes = sizes[closed]
    starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
    return vectors[good[closed]], starts, members[kept]


def _corners(source: Grid, used: Bools | None) -> tuple[Rows, Rows, Rows, Rows, Floats]:
    """Return all corners of cells of one ring: cells, corners, and those before and after."""
    vectors, rings, cells = source.rings
    lengths = np.diff(rings)
    one = np.diff(cells) == 1
    # Corners with equal bits, except for the sign of 0, are the same.
    first, number = groups_of(vectors + 0.0)
    ring = np.flatnonzero(one)
    of = cells[:-1][ring]
    lengths = lengths[of]
    cell = np.repeat(ring, lengths)
    within = np.arange(len(cell)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    at = np.repeat(rings[of], lengths) + within
    node = number[at]
    # Drop repeated corners.
    kept = node != node[_shifted(cell, 1)]
    cell, node = cell[kept], node[kept]
    before, after = node[_shifted(cell, 1)], node[_shifted(cell, -1)]
    turned = np.zeros(source.ncells, dtype=bool)
    turned[source.report.reversed] = True
    back = turned[cell]
    before, after = np.where(back, after, before), np.where(back, before, after)
    kept = ~_repeated(cell, node, source.ncells, used)[cell]
    return cell[kept], node[kept], before[kept], after[kept], vectors[first]


def _shifted(cell: Rows, by: int) -> Rows:
    """Return for each corner the row of the one before (1) or after (-1) in its cell."""
    rows = np.arange(len(cell))
    if not len(cell):
        return rows
    starts = np.flatnonzero(np.concatenate(([True], cell[1:] != cell[:-1])))
    ends = np.append(starts[1:], len(cell)) - 1
    found = rows - by
    if by > 0:
        found[starts] = ends
    else:
        found[ends] = starts
    return found


def _repeated(cell: Rows, node: Rows, count: int, used: Bools | None) -> Bools:
    """Return which cells have the same corners as another one that counts instead."""
    order = np.lexsort((node, cell))
    sizes = np.bincount(cell, minlength=count)
    most = int(sizes.max(initial=0))
    table = np.full((count, most), -1, dtype=np.int64)
    within = np.arange(len(cell)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    table[cell[order], within] = node[order]
    mine = np.flatnonzero(sizes)
    if used is not None:
        mine = mine[np.argsort(~used[mine], kind="stable")]
    first, _ = groups_of(table[mine])
    found = np.ones(count, dtype=bool)
    found[mine[first]] = False
    return found


def _candidates(pieces: _Pieces, queries: Floats, workers: int | None) -> tuple[Rows, Rows]:
    """Return queries and pieces that may contain them, which share area with a small triangle."""
    corners = pieces.corners
    sizes = np.where(corners[:, 3] < 0, 3, 4)
    flat = corners[np.arange(4) < sizes[:, None]]
    starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int64)
    cells = np.arange(len(sizes) + 1, dtype=np.int64)
    none = np.zeros(len(sizes), dtype=np.bool_)
    grid = _core.CellGrid.polygons(pieces.places[flat], starts, cells, none)
    middle = units_of(queries, workers)
    u, v = _tangents(middle)
    angles = 2 * np.pi * np.arange(3) / 3
    ways = np.cos(angles)[:, None] * u[:, None] + np.sin(angles)[:, None] * v[:, None]
    needles = (middle[:, None] + _NEEDLE * ways).reshape(-1, 3)
    count = np.arange(len(queries) + 1, dtype=np.int64)
    small = _core.CellGrid.polygons(
        needles, 3 * count, count, np.zeros(len(queries), dtype=np.bool_)
    )
    found = small.overlaps(grid, as_workers(workers))
    rows = np.repeat(np.arange(len(queries)), np.diff(found.indptr))
    return rows, found.indices.astype(np.int64)


def _tangents(units: Floats) -> tuple[Floats, Floats]:
    """Return two directions along the sphere at each unit vector."""
    helper = np.eye(3)[np.abs(units).argmin(axis=1)]
    u = np.cross(helper, units)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    return u, np.cross(units, u)


def _weighted(
    pieces: _Pieces, queries: Floats, rows: Rows, at: Rows, workers: int | None
) -> _Found:
    """Return the weights of queries in the first of their candidates that contains them."""
    four = pieces.corners[at, 3] >= 0
    found = []
    for kind, work in ((four, _in_four), (~four, _in_three)):
        corners = pieces.corners[at[kind]]
        inside, weights = work(pieces.places, queries[rows[kind]], corners, workers)
        found.append((rows[kind][inside], at[kind][inside], corners[inside], weights[inside]))
    row, piece = (np.concatenate([each[k] for each in found]) for k in (0, 1))
    corners, weights = (np.concatenate([each[k] for each in found]) for k in (2, 3))
    order = np.lexsort((piece, row))
    row, corners, weights = row[order], corners[order], weights[order]
    first = np.ones(len(row), dtype=bool)
    first[1:] = row[1:] != row[:-1]
    row, corners, weights = row[first], corners[first], weights[first]
    there = corners >= 0
    return _Found(np.repeat(row, there.sum(axis=1)), corners[there], weights[there])


def _signs(places: Floats, queries: Floats, a: Rows, b: Rows) -> Rows:
    """Return on which side of arcs queries are, exactly: 1 on the left."""
    return turns(places[a], places[b], queries).astype(np.int64)


def _projected(places: Floats, queries: Floats, corners: Rows, workers: int | None) -> Floats:
    """Return corners projected around queries, which are at the origin, (k, c, 2)."""
    units = units_of(queries, workers)
    u, v = _tangents(units)
    ends = units_of(places[corners.ravel()], workers).reshape(*corners.shape, 3) - units[:, None]
    return np.stack((np.einsum("kci,ki->kc", ends, u), np.einsum("kci,ki->kc", ends, v)), axis=-1)


def _in_three(
    places: Floats, queries: Floats, corners: Rows, workers: int | None
) -> tuple[Bools, Floats]:
    """Return which queries are in triangles, and the weights of corners, (k, 4)."""
    three = corners[:, :3]
    a, b, c = three.T
    turn = turns(places[a], places[b], places[c]).astype(np.int64)
    # The areas opposite each corner, with the opposite sign in clockwise triangles.
    signs = turn[:, None] * np.column_stack(
        [_signs(places, queries, *pair) for pair in ((b, c), (c, a), (a, b))]
    )
    inside = (turn != 0) & (signs >= 0).all(axis=1)
    flat = _projected(places, queries, three, workers)
    one, two = np.roll(flat, -1, axis=1), np.roll(flat, -2, axis=1)
    parts = turn[:, None] * (one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])
    parts = np.where(signs > 0, np.maximum(parts, np.finfo(float).tiny), 0.0)
    total = parts.sum(axis=1, keepdims=True)
    weights = np.divide(parts, total, out=np.zeros_like(parts), where=total > 0)
    return inside, np.pad(weights, ((0, 0), (0, 1)))


def _in_four(
    places: Floats, queries: Floats, corners: Rows, workers: int | None
) -> tuple[Bools, Floats]:
    """Return which queries are in quadrilaterals, and the weights of corners, (k, 4)."""
    at = [corners[:, k] for k in range(4)]
    turn = np.column_stack(
        [turns(*(places[at[(k + j) % 4]] for j in (-1, 0, 1))) for k in range(4)]
    ).astype(np.int64)
    clockwise = turn.sum(axis=1) < 0
    corners = np.where(clockwise[:, None], corners[:, [0, 3, 2, 1]], corners)
    turn = np.where(clockwise[:, None], -turn[:, [0, 3, 2, 1]], turn)
    convex = np.all(turn > 0, axis=1)
    at = [corners[:, k] for k in range(4)]
    sides = np.column_stack([_signs(places, queries, at[k], at[(k + 1) % 4]) for k in range(4)])
    inside = convex & np.all(sides >= 0, axis=1)
    weights = np.zeros((len(corners), 4))
    rows = np.flatnonzero(inside)
    flat = _projected(places, queries[rows], corners[rows], workers)
    s, t, solved = _inverse(flat, sides[rows])
    weights[rows] = np.column_stack(((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t))
    rest = np.concatenate((rows[~solved], np.flatnonzero(~convex)))
    if len(rest):
        reflex = np.any(turn[rest][:, [1, 3]] < 0, axis=1)
        inside[rest], weights[rest] = _halves(places, queries[rest], corners[rest], reflex, workers)
    order = np.where(clockwise[:, None], [0, 3, 2, 1], [0, 1, 2, 3])
    return inside, np.take_along_axis(weights, order, axis=1)


def _halves(
    places: Floats, queries: Floats, corners: Rows, other: Bools, workers: int | None
) -> tuple[Bools, Floats]:
    """Return the same, but linear in the triangles on both sides of a diagonal.

    It joins corners 0 and 2, or it is the `other` one.
    """
    inside = np.zeros(len(corners), dtype=bool)
    weights = np.zeros((len(corners), 4))
    none = np.full((len(corners), 1), -1)
    for half in (0, 2):
        where = (other[:, None].astype(np.int64) + half + np.arange(3)) % 4
        own = np.concatenate((np.take_along_axis(corners, where, axis=1), none), axis=1)
        here, parts = _in_three(places, queries, own, workers)
        rows = np.flatnonzero(here & ~inside)
        weights[rows[:, None], where[rows]] = parts[rows, :3]
        inside[rows] = True
    return inside, weights


def _inverse(flat: Floats, sides: Rows) -> tuple[Floats, Floats, Bools]:
    """Return where the origin is in quadrilaterals, (k, 4, 2), and whether that was found.

    Uses at most `_STEPS` steps of Newton's method from the middle. If exact signs put the query on
    a side, a coordinate is exactly 0 or 1.
    """
    origin = flat[:, 0]
    e, f = flat[:, 1] - origin, flat[:, 3] - origin
    g = origin - flat[:, 1] + flat[:, 2] - flat[:, 3]
    s, t = np.full(len(flat), 0.5), np.full(len(flat), 0.5)
    solved = np.zeros(len(flat), dtype=bool)
    for _ in range(_STEPS):
        along, up = e + t[:, None] * g, f + s[:, None] * g
        value = origin + s[:, None] * e + t[:, None] * up
        det = along[:, 0] * up[:, 1] - along[:, 1] * up[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            ds = (value[:, 1] * up[:, 0] - value[:, 0] * up[:, 1]) / det
            dt = (value[:, 0] * along[:, 1] - value[:, 1] * along[:, 0]) / det
        usable = np.isfinite(ds) & np.isfinite(dt)
        solved = usable & (np.maximum(np.abs(ds), np.abs(dt)) < _SMALL)
        s, t = (np.where(usable, x + dx, x) for x, dx in ((s, ds), (t, dt)))
        if solved.all():
            break
    solved &= (np.minimum(s, t) > -_OUTSIDE) & (np.maximum(s, t) < 1 + _OUTSIDE)
    s, t = np.clip(s, 0, 1), np.clip(t, 0, 1)
    t = np.where(sides[:, 0] == 0, 0.0, np.where(sides[:, 2] == 0, 1.0, t))
    s = np.where(sides[:, 3] == 0, 0.0, np.where(sides[:, 1] == 0, 1.0, s))
    return s, t, solved
