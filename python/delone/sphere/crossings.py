"""Arcs that cross, split: each crossing becomes a direction of its own.

Where two arcs cross is computed in integers from the given vectors, and each coordinate rounded
once, relative to the largest. The parts of the arcs pass through the rounded direction, so they
bend by the rounding error, and may then cross others that were as near: these are split in the same
way, round by round, until none cross.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cmp_to_key
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone.errors import BudgetExceededError, CrossingSegmentsError
from delone.sphere.exact import cross, dot, whole

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

    from delone.sphere.exact import Vector

__all__ = ["Split", "split"]

# Rounds in which parts of arcs cross again: each takes place within the rounding error.
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
    # Pairs of arcs, and the row of the vector where they cross.
    crossings: set[tuple[int, int, int]]


def split(vectors: Floats, rows: Indices, max_points: int, workers: int) -> Split:
    """Return the triangulation of arcs with a vertex at each crossing."""
    count = len(rows)
    parts = _Parts(vectors, rows, np.arange(count, dtype=np.int32), set())
    for _ in range(_ROUNDS):
        try:
            made = _core.sphere_constrained(parts.vectors, parts.rows, workers)
        except CrossingSegmentsError as error:
            parts = _parted(parts, error.pairs.tolist())
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


def _parted(parts: _Parts, pairs: list[list[int]]) -> _Parts:
    """Split the parts that cross where they do."""
    vectors, rows, owner = parts.vectors, parts.rows.tolist(), parts.owner.tolist()
    known: dict[tuple[float, ...], int] = {}
    added: list[tuple[float, ...]] = []
    stops: dict[int, list[int]] = defaultdict(list)
    crossings = set(parts.crossings)
    for s, t in pairs:
        a, b, c, d = (whole(vectors[v].tolist()) for v in (*rows[s], *rows[t]))
        x = _crossing(a, b, c, d)
        at = known.setdefault(x, len(vectors) + len(added))
        if at == len(vectors) + len(added):
            added.append(x)
        stops[s].append(at)
        stops[t].append(at)
        crossings.add((min(owner[s], owner[t]), max(owner[s], owner[t]), at))
    vectors = np.concatenate((vectors, np.array(added)))
    ends, of = [], []
    for part, (u, v) in enumerate(rows):
        inside = _along(vectors, u, v, stops[part]) if part in stops else []
        chain = [u, *inside, v]
        ends += list(pairwise(chain))
        of += [owner[part]] * (len(chain) - 1)
    return _Parts(vectors, np.array(ends, np.int32), np.array(of, np.int32), crossings)


def _along(vectors: Floats, u: int, v: int, stops: list[int]) -> list[int]:
    """Return the rows of crossings of an arc in their order along it, each once."""
    if len(stops) == 1:
        return stops
    a, b = (whole(vectors[w].tolist()) for w in (u, v))
    normal = cross(a, b)
    place = {w: whole(vectors[w].tolist()) for w in stops}

    def before(s: int, t: int) -> int:
        turn = dot(normal, cross(place[s], place[t]))
        return (turn < 0) - (turn > 0)

    return sorted(place, key=cmp_to_key(before))


def _crossing(a: Vector, b: Vector, c: Vector, d: Vector) -> tuple[float, ...]:
    """Return the direction inside both arcs: each coordinate by the largest, rounded."""
    first = cross(a, b)
    x = cross(first, cross(c, d))
    # Inside the arc a b it is left of a and right of b, seen along it.
    ahead = dot(first, cross(a, x)) > 0
    top = max(map(abs, x)) * (1 if ahead else -1)
    return tuple(k / top + 0.0 for k in x)


def _without_repeats(
    parts: _Parts, made: _core.ConstrainedTriangulation, count: int
) -> _Parts | None:
    """Drop crossings that are the same direction as an earlier row; None if there are none."""
    later = made.duplicates[made.duplicates[:, 0] >= count]
    if not len(later):
        return None
    number = np.arange(len(parts.vectors), dtype=np.int32)
    number[later[:, 0]] = later[:, 1]
    stays = np.ones(len(number), dtype=bool)
    stays[later[:, 0]] = False
    new = (np.cumsum(stays) - 1).astype(np.int32)[number]
    rows = new[parts.rows]
    # Of a part without length nothing is left; those that were given so stay.
    kept = (rows[:, 0] != rows[:, 1]) | (parts.rows < count).all(axis=1)
    crossings = {(s, t, int(new[at])) for s, t, at in parts.crossings}
    return _Parts(parts.vectors[stays], rows[kept], parts.owner[kept], crossings)


def _of_rows(
    made: _core.ConstrainedTriangulation, parts: _Parts, count: int
) -> _core.ConstrainedTriangulation:
    """Return the triangulation with the rows of arcs in place of those of their parts."""
    start, source = made.source_start, parts.owner[made.source]
    piece = np.repeat(np.arange(len(start) - 1), np.diff(start))
    # A row that is bent may have a subsegment twice.
    first = np.ones(len(source), dtype=bool)
    first[1:] = (piece[1:] != piece[:-1]) | (source[1:] != source[:-1])
    starts = np.concatenate(([0], np.cumsum(np.bincount(piece[first], minlength=len(start) - 1))))
    through = made.through[made.through[:, 1] < count]
    through = np.column_stack((parts.owner[through[:, 0]], through[:, 1]))
    crossings = np.array(sorted(parts.crossings), dtype=np.int32).reshape(-1, 3)
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
        crossings,
    )
