"""Merging of points that are closer than a distance to each other or to a line: `snap`.

The points that are kept are chosen by coordinates, not by rows. Of points that are closer to each
other, the first in the order of x, y and height is kept, unless it is close to one that is already
kept; all others move to the nearest one that is kept. So no point moves farther than the distance,
and no two points that are kept are closer to each other. Only positions change: heights that meet
at one place are compared like those of duplicates.

Lines come before points: their points are merged first, and their ends move onto other lines.
Then points move to those of lines, and points that are near a line but not near a point of it
become part of it. Points of rings stay.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._base.counting import counted
from delone.errors import BudgetExceededError

if TYPE_CHECKING:
    from typing import Any

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows

__all__ = ["Moves", "merged", "near_segments", "onto"]

# Maximum number of pairs of points in adjacent cells that are compared: about 2 GB.
_MOST = 40_000_000
# Maximum number of cells for which segments are cut, per segment and point.
_PIECES = 4


class Moves(NamedTuple):
    """New positions of points, and which points have moved."""

    places: Floats  # (n, 2)
    moved: Bools


def merged(places: Floats, order: NDArray[Any], limit: float, fixed: Bools | None = None) -> Moves:
    """Merge places that are closer to each other than `limit`, in an order; `fixed` ones stay.

    `order` contains the rank of each place: of two close ones, the lower is kept.
    """
    a, b = _near(places, limit)
    if not len(a):
        return Moves(places, np.zeros(len(places), dtype=bool))
    first = np.where(order[a] < order[b], a, b)
    second = np.where(order[a] < order[b], b, a)
    stays = np.zeros(len(places), dtype=bool) if fixed is None else fixed.copy()
    goes = np.zeros(len(places), dtype=bool)
    goes[second[stays[first] & ~stays[second]]] = True
    goes[first[stays[second] & ~stays[first]]] = True
    involved = np.zeros(len(places), dtype=bool)
    involved[a], involved[b] = True, True
    # Each round decides at least the first undecided one, so this terminates.
    while True:
        undecided = involved & ~stays & ~goes
        if not undecided.any():
            break
        both = undecided[first] & undecided[second]
        waits = np.zeros(len(places), dtype=bool)
        waits[second[both]] = True
        new = undecided & ~waits
        stays |= new
        goes[second[new[first] & ~stays[second]]] = True
        goes[first[new[second] & ~stays[first]]] = True
    return _to_nearest(places, order, a, b, stays, goes)


def _to_nearest(  # noqa: PLR0917
    places: Floats, order: NDArray[Any], a: Rows, b: Rows, stays: Bools, goes: Bools
) -> Moves:
    """Move places to the nearest one that stays; of several, to the first in the order."""
    source = np.concatenate((a, b))
    target = np.concatenate((b, a))
    rows = goes[source] & stays[target]
    source, target = source[rows], target[rows]
    way = places[source] - places[target]
    best = np.lexsort((order[target], np.hypot(*way.T), source))
    source, target = source[best], target[best]
    first = np.flatnonzero(np.diff(source, prepend=-1))
    found = places.copy()
    found[source[first]] = places[target[first]]
    return Moves(found, goes & (found != places).any(axis=1))


def onto(places: Floats, targets: Floats, limit: float) -> Moves:
    """Move places that are closer than `limit` to a target to the nearest target."""
    both = np.concatenate((targets, places))
    a, b = _near(both, limit)
    ours = np.concatenate((a[b >= len(targets)], b[a >= len(targets)]))
    others = np.concatenate((b[b >= len(targets)], a[a >= len(targets)]))
    rows = ours < len(targets)
    target, source = ours[rows], others[rows]
    # In the order of coordinates where two are equally near.
    rank = _ranks(targets)
    best = np.lexsort((rank[target], np.hypot(*(both[source] - both[target]).T), source))
    target, source = target[best], source[best]
    first = np.flatnonzero(np.diff(source, prepend=-1))
    found = places.copy()
    found[source[first] - len(targets)] = targets[target[first]]
    near = np.zeros(len(places), dtype=bool)
    near[source[first] - len(targets)] = True
    return Moves(found, near)


def _ranks(places: Floats) -> NDArray[np.int64]:
    rank = np.empty(len(places), dtype=np.int64)
    rank[np.lexsort(places.T[::-1])] = np.arange(len(places))
    return rank


def _near(places: Floats, limit: float) -> tuple[Rows, Rows]:
    """Return all pairs of places that are closer than `limit`, each once."""
    cell = _cells(places, limit)
    key, order, start, stop = _sorted(cell)
    found: list[tuple[Rows, Rows]] = [(np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64))]
    total = 0
    if not len(key):
        return found[0]
    # The cell itself, and half of those around it: the other half covers this one.
    for across, up in ((0, 0), (1, -1), (1, 0), (1, 1), (0, 1)):
        wanted = key + (across << 32) + up
        at = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
        there = key[at] == wanted
        mine, other = np.flatnonzero(there), at[there]
        sizes = (stop - start)[mine] * (stop - start)[other]
        total += int(sizes.sum())
        if total > _MOST:
            raise BudgetExceededError(
                f"snap={limit:g} is so large that {counted(total, 'pair')} of points are near each "
                "other: it is for points that should be one; simplify leaves out others",
                limit=_MOST,
                found=total,
            )
        pair = np.repeat(np.arange(len(mine)), sizes)
        place = np.arange(len(pair)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        width = (stop - start)[other][pair]
        a = order[start[mine][pair] + place // np.maximum(width, 1)]
        b = order[start[other][pair] + place % np.maximum(width, 1)]
        if (across, up) == (0, 0):
            a, b = a[a < b], b[a < b]
        close = np.hypot(*(places[a] - places[b]).T) < limit
        found.append((a[close], b[close]))
    a, b = (np.concatenate(column) for column in zip(*found, strict=True))
    return a, b


def _cells(places: Floats, size: float) -> NDArray[np.int64]:
    """Return the column and row of places in a grid of cells of at least a given size."""
    if not len(places):
        return np.empty((0, 2), dtype=np.int64)
    low = places.min(axis=0)
    extent = float((places.max(axis=0) - low).max())
    # A little larger than the distance, so that rounding moves nothing beyond the next cell.
    size = max(size * (1 + 2.0**-20), extent / 2.0**30)
    found: NDArray[np.int64] = np.floor((places - low) / size).astype(np.int64)
    return found


def _key(cell: NDArray[np.int64]) -> NDArray[np.int64]:
    found: NDArray[np.int64] = ((cell[..., 0] + 1) << 32) | (cell[..., 1] + 1)
    return found


def _sorted(cell: NDArray[np.int64]) -> tuple[NDArray[np.int64], Rows, Rows, Rows]:
    """Return the keys of occupied cells, rows in their order, and where each begins and ends."""
    keys = _key(cell)
    order = np.argsort(keys, kind="stable")
    key, start = np.unique(keys[order], return_index=True)
    return key, order, start, np.append(start[1:], len(order))


def near_segments(places: Floats, ends: Floats, limit: float) -> tuple[Rows, Rows, Floats, Floats]:
    """Return places that are closer than `limit` to the interior of a segment.

    `ends` contains the ends of the segments, (s, 2, 2). The result is rows of places and, for each,
    the nearest segment, the fraction along it, and the distance.
    """
    nothing = np.empty(0, dtype=np.int64)
    if not len(places) or not len(ends):
        return nothing, nothing, np.empty(0), np.empty(0)
    along = ends[:, 1] - ends[:, 0]
    length = np.hypot(*along.T)
    both = np.concatenate((places, ends.reshape(-1, 2)))
    extent = float((both.max(axis=0) - both.min(axis=0)).max())
    size = max(limit, float(length.sum()) / (_PIECES * (len(places) + len(ends))), extent / 2.0**30)
    # Pieces no longer than a cell, so that each is in few cells.
    count = np.maximum(1, np.ceil(length / size)).astype(np.int64)
    segment = np.repeat(np.arange(len(ends)), count)
    number = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)
    middle = ends[segment, 0] + ((number + 0.5) / count[segment])[:, None] * along[segment]
    cell = _cells(np.concatenate((places, middle)), 2 * size)
    key, order, start, stop = _sorted(cell[: len(places)])
    row, candidate = [nothing], [nothing]
    for across in (-1, 0, 1):
        for up in (-1, 0, 1):
            wanted = _key(cell[len(places) :] + np.array([across, up]))
            at = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
            there = np.flatnonzero(key[at] == wanted)
            sizes = (stop - start)[at[there]]
            place = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
            row.append(order[np.repeat(start[at[there]], sizes) + place])
            candidate.append(np.repeat(segment[there], sizes))
    rows, segments = np.concatenate(row), np.concatenate(candidate)
    away = places[rows] - ends[segments, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (away * along[segments]).sum(axis=1) / (along[segments] ** 2).sum(axis=1)
        distance = (
            np.abs(away[:, 0] * along[segments, 1] - away[:, 1] * along[segments, 0])
            / length[segments]
        )
    near = (distance < limit) & (share > 0) & (share < 1)
    rows, segments, share, distance = (each[near] for each in (rows, segments, share, distance))
    # If two segments are equally near, the first in the order of their ends.
    _, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    sides = np.sort(number.reshape(-1, 2), axis=1)
    rank = np.empty(len(ends), dtype=np.int64)
    rank[np.lexsort((sides[:, 1], sides[:, 0]))] = np.arange(len(ends))
    best = np.lexsort((rank[segments], distance, rows))
    first = best[np.flatnonzero(np.diff(rows[best], prepend=-1))]
    return rows[first], segments[first], share[first], distance[first]
