"""First moments of cells on the sphere and of the parts that cells of two grids share.

The integral of x over a region is half the line integral of x cross dx along its boundary: an angle
times a normal for an arc of a great circle, sines of longitudes for a part of a parallel. Regions
are cut by the half-spaces of a convex cell, all pairs at once (Sutherland and Hodgman, "Reentrant
polygon clipping", Communications of the ACM 17, 1974); cells that are not convex are signed fans of
triangles. Rounding moves a moment by its last digits, and never decides which cells share area:
that is known from `Overlaps`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone.sphere import rings as rings_of
from delone.sphere.coordinates import units_of

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows
    from delone.sphere.grid import Grid

__all__ = ["moments_of_cells", "moments_of_parts"]

# Number of pairs of cells that are cut at once.
_LOT = 1 << 16
# Steps to find where an arc meets a parallel; each doubles the digits or halves the interval.
_STEPS = 60
_NODES, _GAUSS = np.polynomial.legendre.leggauss(8)
# A height above all points of the sphere.
_ABOVE = 2.0


class _Pieces(NamedTuple):
    """Consecutive rings: corners, and whether the side after each is on a parallel."""

    corners: Floats
    parallel: Bools
    starts: Rows
    # The cell of each ring, ascending, and whether its integral is added or subtracted.
    cells: Rows
    signs: Floats


class _Planes(NamedTuple):
    """The half-spaces of each piece in sequence: inward normals, and a point on each plane."""

    normals: Floats
    places: Floats
    parallel: Bools
    starts: Rows
    cells: Rows
    signs: Floats


def moments_of_cells(grid: Grid, centers: Floats) -> Floats:
    """Return the integrals of x - center over cells, without the part along the center."""
    pieces = _pieces(grid)
    found = _integrals(pieces, centers[pieces.cells]) * pieces.signs[:, None]
    return _tangential(_sums(pieces.cells, found, grid.ncells), centers)


def moments_of_parts(
    source: Grid, target: Grid, sources: Rows, targets: Rows, centers: Floats
) -> Floats:
    """Return for pairs of cells the integrals of x - center over what they share.

    `centers` are unit vectors near the pairs; the part along them is left out.
    """
    # Cells between meridians and parallels do the cutting, because cutting arcs is easier.
    turned = source.edges == "parallel" and target.edges != "parallel"
    cut, cutting = (target, source) if turned else (source, target)
    first, second = (targets, sources) if turned else (sources, targets)
    pieces, planes = _pieces(cut), _planes(cutting)
    found = np.zeros((len(first), 3))
    for start in range(0, len(first), _LOT):
        lot = slice(start, start + _LOT)
        # Each ring of one cell with each convex piece of the other.
        pair, ring = _expanded(pieces.cells, first[lot])
        rows, piece = _expanded(planes.cells, second[lot][pair])
        pair, ring = pair[rows], ring[rows]
        left = _cut(_chosen(pieces, ring), planes, piece)
        signs = planes.signs[piece[left.cells]]
        values = _integrals(left, centers[lot][pair[left.cells]]) * signs[:, None]
        count = len(found[lot])
        found[lot] = _sums(pair[left.cells], values, count)
    return _tangential(found, centers)


def _tangential(vectors: Floats, centers: Floats) -> Floats:
    along = (vectors * centers).sum(axis=1, keepdims=True)
    found: Floats = vectors - along * centers
    return found


def _sums(rows: Rows, values: Floats, count: int) -> Floats:
    """Return the sums of the vectors of each row."""
    return np.stack([np.bincount(rows, values[:, k], count) for k in range(3)], axis=1)


def _ragged(starts: Rows, counts: Rows) -> Rows:
    """Return starts, starts + 1, ... for each run, one run after another."""
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    found: Rows = np.repeat(starts, counts) + within
    return found


def _expanded(cells: Rows, wanted: Rows) -> tuple[Rows, Rows]:
    """Return for each piece of each wanted cell the row of the cell, and the piece."""
    first = np.searchsorted(cells, wanted, side="left")
    counts = np.searchsorted(cells, wanted, side="right") - first
    return np.repeat(np.arange(len(wanted)), counts), _ragged(first, counts)


def _starts(counts: Rows) -> Rows:
    return np.concatenate(([0], np.cumsum(counts))).astype(np.int64)


def _chosen(pieces: _Pieces, rows: Rows) -> _Pieces:
    """Return copies of rings, numbered by their place in `rows`."""
    counts = np.diff(pieces.starts)[rows]
    at = _ragged(pieces.starts[rows], counts)
    numbers = np.arange(len(rows))
    signs = np.ones(len(rows))
    return _Pieces(pieces.corners[at], pieces.parallel[at], _starts(counts), numbers, signs)


def _pieces(grid: Grid) -> _Pieces:
    """Return the rings of a grid, outer ones counterclockwise and holes clockwise."""
    if grid.edges == "parallel":
        boxes = _boxes(grid._arrays)
        corners = np.empty((len(boxes.cells), 4, 3))
        for k, (side, level) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
            corners[:, k, :2] = boxes.sides[:, side] * boxes.radii[:, level, None]
            corners[:, k, 2] = boxes.heights[:, level]
        starts = 4 * np.arange(len(corners) + 1, dtype=np.int64)
        parallel = np.tile([True, False, True, False], len(corners))
        return _Pieces(corners.reshape(-1, 3), parallel, starts, boxes.cells, np.ones(len(corners)))
    vectors, starts, cells, holes = grid._arrays
    units = units_of(vectors, None)
    count = len(starts) - 1
    known = _core.CellGrid.polygons(
        vectors, starts, np.arange(count + 1, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    ).check(False, as_workers(None))
    number = np.repeat(np.arange(len(cells) - 1), np.diff(cells))
    counts = np.diff(starts)
    kept = (counts > 2) & (known.faults != 1) & (grid.areas > 0)[number]
    rings = np.flatnonzero(kept)
    back = (known.turned != holes)[rings]
    at = _ragged(starts[rings], counts[rings])
    # Backward: the last corner first.
    first, length = (np.repeat(x, counts[rings]) for x in (starts[rings], counts[rings]))
    at = np.where(np.repeat(back, counts[rings]), 2 * first + length - 1 - at, at)
    return _Pieces(
        units[at],
        np.zeros(len(at), dtype=bool),
        _starts(counts[rings]),
        number[rings],
        np.ones(len(rings)),
    )


class _Boxes(NamedTuple):
    """Cells between meridians and parallels, wide ones in columns."""

    # Horizontal directions of the western and eastern meridian, (n, 2, 2).
    sides: Floats
    # Heights of the southern and northern parallel, and their radii, (n, 2).
    heights: Floats
    radii: Floats
    cells: Rows


def _boxes(arrays: tuple[Any, ...]) -> _Boxes:
    tangents, _, meridians, _, _ = arrays
    row, west, east, _ = rings_of._runs(arrays)
    counts = (east - west).astype(np.int64)
    at = _ragged(west, counts)
    units = meridians / np.hypot(meridians[:, 0], meridians[:, 1])[:, None]
    tangent = tangents[np.repeat(row, counts)]
    pole = np.isinf(tangent)
    tangent = np.where(pole, 0.0, tangent)
    radii = np.where(pole, 0.0, 1 / np.hypot(1.0, tangent))
    heights = np.where(pole, np.sign(tangents[np.repeat(row, counts)]), tangent * radii)
    cells = np.repeat(np.arange(len(row)), counts)
    return _Boxes(np.stack((units[at], units[at + 1]), axis=1), heights, radii, cells)


def _planes(grid: Grid) -> _Planes:
    """Return the half-spaces of the convex pieces of a grid."""
    if grid.edges == "parallel":
        boxes = _boxes(grid._arrays)
        count = len(boxes.cells)
        normals, places = np.zeros((2, count, 4, 3))
        # First east of one meridian and west of the other, then between parallels.
        for k, sign in ((0, 1.0), (1, -1.0)):
            normals[:, k, 0] = -sign * boxes.sides[:, k, 1]
            normals[:, k, 1] = sign * boxes.sides[:, k, 0]
            normals[:, 2 + k, 2] = sign
            height = boxes.heights[:, k]
            places[:, 2 + k, 2] = np.where(np.abs(height) == 1, -sign * _ABOVE, height)
        parallel = np.tile([False, False, True, True], count)
        starts = 4 * np.arange(count + 1, dtype=np.int64)
        return _Planes(
            normals.reshape(-1, 3), places.reshape(-1, 3), parallel, starts, boxes.cells,
            np.ones(count),
        )  # fmt: skip
    pieces = _pieces(grid)
    alone = np.bincount(pieces.cells, minlength=grid.ncells) == 1
    alone[grid.report.concave] = False
    whole = alone[pieces.cells]
    convex = _chosen(pieces, np.flatnonzero(whole))
    corners, counts = [convex.corners], [np.diff(convex.starts)]
    cells, signs = [pieces.cells[whole]], [np.ones(int(whole.sum()))]
    others = _chosen(pieces, np.flatnonzero(~whole))
    sizes = np.diff(others.starts)
    if len(sizes):
        # Triangles from the first corner of each ring.
        second = _ragged(others.starts[:-1] + 1, sizes - 2)
        apex = others.corners[np.repeat(others.starts[:-1], sizes - 2)]
        triangles = np.stack((apex, others.corners[second], others.corners[second + 1]), axis=1)
        turns = (apex * np.cross(triangles[:, 1] - apex, triangles[:, 2] - apex)).sum(axis=1)
        back = turns < 0
        triangles[back] = triangles[back][:, ::-1]
        corners.append(triangles.reshape(-1, 3))
        counts.append(np.full(len(triangles), 3))
        cells.append(np.repeat(pieces.cells[~whole], sizes - 2))
        signs.append(np.where(back, -1.0, 1.0))
    number = np.concatenate(cells)
    every = _Pieces(
        np.concatenate(corners), np.zeros(0, dtype=bool), _starts(np.concatenate(counts)),
        number, np.concatenate(signs),
    )  # fmt: skip
    order = np.argsort(number, kind="stable")
    lengths = np.diff(every.starts)[order]
    at = _ragged(every.starts[order], lengths)
    starts = _starts(lengths)
    a = every.corners[at]
    # By differences, so that short sides keep their digits.
    normals = np.cross(a, a[_following(starts)] - a)
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, size, out=np.zeros_like(normals), where=size > 0)
    return _Planes(
        normals, a, np.zeros(len(a), dtype=bool), starts, number[order], every.signs[order]
    )


def _following(starts: Rows) -> Rows:
    """Return the corner after each one, around each ring."""
    counts = np.diff(starts)
    found = np.arange(1, starts[-1] + 1)
    used = counts > 0
    found[starts[1:][used] - 1] = starts[:-1][used]
    return found


def _cut(pieces: _Pieces, planes: _Planes, chosen: Rows) -> _Pieces:
    """Return the part of each ring inside its convex piece; rings without one are dropped."""
    number = planes.starts[chosen + 1] - planes.starts[chosen]
    split = False
    for k in range(int(number.max(initial=0))):
        counts = np.diff(pieces.starts)
        plane = planes.starts[chosen[pieces.cells]] + k
        has = k < number[pieces.cells]
        plane = np.where(has, plane, 0)
        if not split and bool((planes.parallel[plane] & has).any()):
            # From here on, no arc reaches a parallel twice.
            pieces, split = _with_tops(pieces), True
            counts = np.diff(pieces.starts)
        each = np.repeat(plane, counts)
        away = (planes.normals[each] * (pieces.corners - planes.places[each])).sum(axis=1)
        away = np.where(np.repeat(has, counts), away, 1.0)
        pieces = _halved(pieces, away, planes.parallel[each], planes.places[each, 2])
    return pieces


def _halved(pieces: _Pieces, away: Floats, level: Bools, heights: Floats) -> _Pieces:
    """Return the parts of rings at positive distances, by the distances of corners."""
    after = _following(pieces.starts)
    inside = away >= 0
    crossing = np.flatnonzero(inside != inside[after])
    # The corners inside, each followed by the crossing of its side, if there is one.
    number = np.repeat(np.arange(len(pieces.cells)), np.diff(pieces.starts))
    made = np.empty((len(inside), 2, 3))
    made[:, 0] = pieces.corners
    along = np.empty((len(inside), 2), dtype=bool)
    along[:, 0] = pieces.parallel
    # Where a ring leaves the half-space, it continues along the plane.
    along[:, 1] = np.where(inside, level, pieces.parallel)
    a, b = pieces.corners[crossing], pieces.corners[after[crossing]]
    ends = away[crossing], away[after[crossing]]
    # NaN for planes through the center.
    at = np.where(level, heights, np.nan)[crossing]
    made[crossing, 1] = _meeting((a, b), ends, pieces.parallel[crossing], at)
    kept = np.stack((inside, inside != inside[after]), axis=1)
    counts = np.bincount(number, kept.sum(axis=1), len(pieces.cells)).astype(np.int64)
    used = counts > 0
    return _Pieces(
        made[kept], along[kept], _starts(counts[used]), pieces.cells[used], pieces.signs[used]
    )


def _meeting(
    sides: tuple[Floats, Floats], away: tuple[Floats, Floats], parallel: Bools, heights: Floats
) -> Floats:
    """Return where sides cross planes; heights are NaN for planes through the center."""
    a, b = sides
    low, high = np.abs(away[0]), np.abs(away[1])
    t = low / np.where(low + high > 0, low + high, 1.0)
    chord = np.linalg.norm(b - a, axis=1) ** 2
    level = np.isfinite(heights)
    if level.any():
        # The chord is inside the sphere, so the point on the arc is found iteratively.
        rows = np.flatnonzero(level)
        x, y, z, c = a[rows, 2], b[rows, 2], heights[rows], chord[rows]
        lower, upper = np.zeros(len(rows)), np.ones(len(rows))
        u = t[rows]
        rising = y >= x
        for _ in range(_STEPS):
            size = np.sqrt(1 - u * (1 - u) * c)
            value = x + u * (y - x) - z * size
            slope = (y - x) + z * c * (1 - 2 * u) / (2 * size)
            past = (value > 0) == rising
            upper, lower = np.where(past, u, upper), np.where(past, lower, u)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = u - value / slope
            # Newton's step, or halving where that leaves the interval.
            good = (step >= lower) & (step <= upper)
            new = np.where(good, step, (lower + upper) / 2)
            if bool((np.abs(new - u) <= 2.0**-52).all()):
                break
            u = new
        t[rows] = u
    found: Floats = a + t[:, None] * (b - a)
    found /= np.linalg.norm(found, axis=1, keepdims=True)
    # Between two points of a parallel, only the longitude changes.
    radius = np.hypot(a[:, 0], a[:, 1])
    width = np.hypot(found[:, 0], found[:, 1])
    scale = np.divide(radius, width, out=np.ones(len(a)), where=width > 0)
    flat = np.column_stack((found[:, :2] * scale[:, None], a[:, 2]))
    return np.where(parallel[:, None], flat, found)


def _with_tops(pieces: _Pieces) -> _Pieces:
    """Return rings with a corner where an arc is nearest to a pole, between its ends."""
    a = pieces.corners
    b = a[_following(pieces.starts)]
    normal = np.cross(a, b - a)
    # The northernmost place on the circle of each arc.
    top = np.column_stack(
        (
            -normal[:, 0] * normal[:, 2],
            -normal[:, 1] * normal[:, 2],
            normal[:, 0] ** 2 + normal[:, 1] ** 2,
        )
    )
    size = np.linalg.norm(top, axis=1, keepdims=True)
    top = np.divide(top, size, out=np.zeros_like(top), where=size > 0)
    # Whether heights rise at both ends: the top is between them if it differs.
    rise = (np.cross(normal, a)[:, 2], np.cross(normal, b)[:, 2])
    between = (rise[0] * rise[1] < 0) & ~pieces.parallel
    top = np.where((rise[0] < 0)[:, None], -top, top)
    kept = np.stack((np.ones(len(a), dtype=bool), between), axis=1)
    number = np.repeat(np.arange(len(pieces.cells)), np.diff(pieces.starts))
    counts = np.bincount(number, kept.sum(axis=1), len(pieces.cells)).astype(np.int64)
    corners = np.stack((a, top), axis=1)[kept]
    parallel = np.stack((pieces.parallel, pieces.parallel), axis=1)[kept]
    return _Pieces(corners, parallel, _starts(counts), pieces.cells, pieces.signs)


def _integrals(pieces: _Pieces, centers: Floats) -> Floats:
    """Return the integrals of x over rings, as seen from a center near each."""
    counts = np.diff(pieces.starts)
    number = np.repeat(np.arange(len(counts)), counts)
    c = centers[number]
    after = _following(pieces.starts)
    p = pieces.corners - c
    # Exactly on the sphere, so that small rings lose no digits.
    p += (-(p * p).sum(axis=1) / 2 - (p * c).sum(axis=1))[:, None] * c
    q = p[after]
    chord = np.linalg.norm(q - p, axis=1)
    half = np.arcsin(np.minimum(chord / 2, 1.0))
    sine = np.sin(2 * half)
    # The angle over its sine, less one.
    more = np.divide(2 * half - sine, sine, out=np.zeros(len(p)), where=sine > 1e-3)
    small = 4 * half * half
    more = np.where(sine > 1e-3, more, small / 6 + 7 * small * small / 360)
    terms = more[:, None] * np.cross(c, q - p) + (1 + more)[:, None] * np.cross(p, q)
    rows = np.flatnonzero(pieces.parallel)
    if len(rows):
        a, b = pieces.corners[rows], pieces.corners[after[rows]]
        turn = np.arctan2(
            a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]
        )
        total = np.zeros((len(rows), 3))
        for node, weight in zip(_NODES, _GAUSS, strict=True):
            w = turn * (1 + node) / 2
            # The path from the first corner, in half angles, and its derivative.
            cosine, sine = -2 * np.sin(w / 2) ** 2, np.sin(w)
            x = cosine * a[:, 0] - sine * a[:, 1]
            y = sine * a[:, 0] + cosine * a[:, 1]
            zero = np.zeros(len(rows))
            way = np.column_stack((x, y, zero))
            speed = np.column_stack((-(y + a[:, 1]), x + a[:, 0], zero))
            total += (weight * turn / 2)[:, None] * np.cross(p[rows] + way, speed)
        terms[rows] = total
    return _sums(number, terms / 2, len(counts))
