"""Splitting of arcs that cross: each crossing becomes a new direction.

The crossing of two arcs is computed in integers from the given vectors, and each coordinate is
rounded once, relative to the largest. The parts of the arcs pass through the rounded direction, so
they bend by the rounding error and may then cross arcs that close to them. These are split in the
same way, round by round, until no arcs cross.
"""

from __future__ import annotations

from functools import cmp_to_key
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone.errors import BudgetExceededError, CrossingSegmentsError
from delone.sphere.exact import cross, dot, whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Split", "in_order", "split"]

# Maximum number of rounds in which parts of arcs cross again, each within the rounding error.
_ROUNDS = 40


class Split(NamedTuple):
    """A constrained triangulation whose crossing arcs were split."""

    # (n + a, 3): the given vectors, then the crossings.
    vectors: Floats
    made: _core.ConstrainedTriangulation


class _Parts(NamedTuple):
    """The arcs so far."""

    vectors: Floats
    # (k, 2): the parts of arcs, by arc and along it.
    rows: Indices
    # (k,): the arc of each.
    owner: Indices
    # (c, 3): pairs of arcs, and the row of the vector where they cross.
    crossings: Indices


def split(vectors: Floats, rows: Indices, max_points: int, workers: int) -> Split:
    """Return the triangulation of arcs with a vertex at each crossing."""
    count = len(rows)
    none = np.empty((0, 3), dtype=np.int32)
    parts = _Parts(vectors, rows, np.arange(count, dtype=np.int32), none)
    for _ in range(_ROUNDS):
        try:
            made = _core.sphere_constrained(parts.vectors, parts.rows, workers)
        except CrossingSegmentsError as error:
            parts = _parted(parts, error.pairs)
            found = len(parts.vectors) - len(vectors)
            if found > max_points:
                raise BudgetExceededError(
                    f"found {found} crossings, more than the limit of {max_points} vertices: "
                    "allow more, or make the input simpler",
                    limit=max_points,
                    found=found,
                ) from None
            continue
        merged = _without_repeats(parts, made, len(vectors))
        if merged is None:
            return Split(parts.vectors, _of_rows(made, parts, len(vectors)))
        parts = merged
    raise CrossingSegmentsError(
        "parts of segments cross again and again where they are nearly parallel: move them apart"
    )


def _parted(parts: _Parts, pairs: NDArray[np.integer]) -> _Parts:
    """Split the parts that cross at their crossings; other parts are not visited."""
    vectors, rows = parts.vectors, parts.rows
    places = _crossings(vectors, rows, pairs)
    # Pairs that cross at the same place share one vector, ordered by the first such pair.
    number: dict[tuple[float, ...], int] = {}
    at = np.array([number.setdefault(x, len(number)) for x in places], dtype=np.int32)
    at += np.int32(len(vectors))
    vectors = np.concatenate((vectors, np.array(list(number))))
    arcs = np.sort(parts.owner[pairs], axis=1).astype(np.int32)
    crossings = np.concatenate((parts.crossings, np.column_stack((arcs, at))))
    stops = np.unique(np.column_stack((pairs.ravel(), np.repeat(at, 2))), axis=0)
    part, stop = _along(vectors, rows, stops)
    # A part with s stops becomes s + 1 rows; the k-th stop is the head of the k-th of them.
    size = np.ones(len(rows), dtype=np.int64)
    size += np.bincount(part, minlength=len(rows))
    new, owner = np.repeat(rows, size, axis=0), np.repeat(parts.owner, size)
    place = (np.cumsum(size) - size)[part] + _ranks(part)
    new[place, 1] = stop
    new[place + 1, 0] = stop
    return _Parts(vectors, new, owner, crossings)


def _crossings(
    vectors: Floats, rows: Indices, pairs: NDArray[np.integer]
) -> list[tuple[float, ...]]:
    """Return where the parts of each pair cross: coordinates over the largest one, rounded.

    Everything is computed in integers; each vector and each normal is converted once.
    """
    ends = {part: tuple(rows[part].tolist()) for part in np.unique(pairs).tolist()}
    used = sorted({v for pair in ends.values() for v in pair})
    exact = dict(zip(used, map(whole, vectors[used].tolist()), strict=True))
    normal = {part: cross(exact[u], exact[v]) for part, (u, v) in ends.items()}
    found = []
    for s, t in pairs.tolist():
        a, b = (exact[v] for v in ends[s])
        # The vector product of both normals is p b - q a; inside the arc it is p > 0, q < 0.
        n = normal[t]
        p, q = dot(a, n), dot(b, n)
        x = [p * j - q * i for i, j in zip(a, b, strict=True)]
        top = max(map(abs, x)) * (1 if p > 0 else -1)
        found.append(tuple(k / top + 0.0 for k in x))
    return found


def _along(
    vectors: Floats, rows: Indices, stops: NDArray[np.integer]
) -> tuple[NDArray[np.integer], NDArray[np.integer]]:
    """Return parts and their stops, ascending by part, and along each in order.

    Stops are sorted by rounded angles. Then each pair of neighbors is checked, and if one is out of
    order, the stops of the part are sorted exactly.
    """
    part, stop = stops.T
    a, b = (_scaled(vectors[rows[part, k]]) for k in (0, 1))
    p = vectors[stop]
    normal = np.cross(a, b)
    ahead = np.cross(normal, a) / np.linalg.norm(normal, axis=1, keepdims=True)
    angle = np.arctan2(np.einsum("ij,ij->i", ahead, p), np.einsum("ij,ij->i", a, p))
    order = np.lexsort((angle, part))
    part, stop, normal, p = part[order], stop[order], normal[order], p[order]
    second = np.flatnonzero(part[1:] == part[:-1]) + 1
    value = np.einsum("ij,ij->i", normal[second], np.cross(p[second - 1], p[second]))
    # Coordinates are at most 1, so their products are off by less than 132 units of 2^-53.
    unsure = np.unique(part[second[~(value > 2.0**-44)]])
    for each in unsure.tolist():
        low, high = np.searchsorted(part, (each, each + 1))
        stop[low:high] = in_order(vectors, rows[each].tolist(), stop[low:high].tolist())
    return part, stop


def _scaled(vectors: Floats) -> Floats:
    """Return vectors with a largest coordinate of 1, rounded."""
    # Scale by a power of two first, because a quotient of tiny numbers may be far from exact.
    _, exponent = np.frexp(np.abs(vectors).max(axis=1, keepdims=True))
    near = np.ldexp(vectors, -exponent)
    scaled: Floats = near / np.abs(near).max(axis=1, keepdims=True)
    return scaled


def in_order(vectors: Floats, ends: list[int], stops: list[int]) -> list[int]:
    """Return the rows of crossings of an arc in their order along it, exactly."""
    u, v = vectors[ends].tolist()
    normal = cross(whole(u), whole(v))
    place = {w: whole(vectors[w].tolist()) for w in stops}
    # Stops at the same angle, off the plane of the arc, are ordered by coordinates.
    forward = 1 if u < v else -1

    def before(s: int, t: int) -> int:
        turn = dot(normal, cross(place[s], place[t]))
        if turn == 0:
            return forward if vectors[s].tolist() > vectors[t].tolist() else -forward
        return -1 if turn > 0 else 1

    return sorted(place, key=cmp_to_key(before))


def _ranks(groups: NDArray[np.integer]) -> NDArray[np.int64]:
    """Return, for each entry of an ascending array, how many equal ones precede it."""
    first = np.flatnonzero(np.diff(groups, prepend=-1))
    ranks: NDArray[np.int64] = np.arange(len(groups)) - np.repeat(
        first, np.diff(np.append(first, len(groups)))
    )
    return ranks


def _without_repeats(
    parts: _Parts, made: _core.ConstrainedTriangulation, count: int
) -> _Parts | None:
    """Drop crossings with the direction of an earlier row; None if there are none."""
    later = made.duplicates[made.duplicates[:, 0] >= count]
    if not len(later):
        return None
    number = np.arange(len(parts.vectors), dtype=np.int32)
    number[later[:, 0]] = later[:, 1]
    stays = np.ones(len(number), dtype=bool)
    stays[later[:, 0]] = False
    new = (np.cumsum(stays) - 1).astype(np.int32)[number]
    rows = new[parts.rows]
    # A part without length disappears, unless it was given that way.
    kept = (rows[:, 0] != rows[:, 1]) | (parts.rows < count).all(axis=1)
    crossings = parts.crossings.copy()
    crossings[:, 2] = new[crossings[:, 2]]
    return _Parts(parts.vectors[stays], rows[kept], parts.owner[kept], crossings)


def _of_rows(
    made: _core.ConstrainedTriangulation, parts: _Parts, count: int
) -> _core.ConstrainedTriangulation:
    """Return the triangulation with the rows of arcs instead of those of their parts."""
    start, source = made.source_start, parts.owner[made.source]
    piece = np.repeat(np.arange(len(start) - 1), np.diff(start))
    # A bent row may contain a subsegment twice.
    first = np.ones(len(source), dtype=bool)
    first[1:] = (piece[1:] != piece[:-1]) | (source[1:] != source[:-1])
    starts = np.concatenate(([0], np.cumsum(np.bincount(piece[first], minlength=len(start) - 1))))
    through = made.through[made.through[:, 1] < count]
    through = np.column_stack((parts.owner[through[:, 0]], through[:, 1]))
    return _core.ConstrainedTriangulation(
        made.added,
        made.simplices,
        made.neighbors,
        made.constrained,
        made.duplicates,
        made.segments,
        starts.astype(np.int64),
        source[first].astype(np.int32),
        made.forward[first],
        np.unique(parts.owner[made.zero]).astype(np.int32),
        np.unique(through, axis=0).astype(np.int32),
        np.unique(parts.crossings, axis=0).astype(np.int32),
    )
