"""How rings of cells nest: holes are inside their outer rings, and parts do not overlap.

The sides of a cell do not cross, so two of its rings are nested or apart. The core decides by exact
signs which rings share area, and the area determines which of two nested rings is the inner one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.counting import agreed, counted

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone._base.types import Bools, Floats, Rows

    Arrays = tuple[Floats, Rows, Rows, Bools]

__all__ = ["badly_nested", "nesting_problem"]

# What the core reports for a ring without area.
_EMPTY = 1
# Rings of a cell overlap if they share more of the smaller one than this; less is a rounding error.
_SHARED = 1e-12


def nesting_problem(rows: Rows, what: str = "cell") -> str:
    """Return the text of an error for cells whose rings nest in a wrong way."""
    return (
        f"{counted(len(rows), what)} {agreed(len(rows), 'has', 'have')} a hole that is not inside "
        f"its outer ring, or holes or parts that overlap, first {what} {rows[0]}: "
        'shapely.make_valid with method="structure" repairs such polygons, or removes their area'
    )


def badly_nested(
    arrays: Arrays, build: Callable[..., Any], workers: int, *, left_out: Rows | None = None
) -> Rows:
    """Return cells with a hole that is not inside its outer ring, or with overlapping parts.

    `build` makes cells of the core. In each cell, holes follow their outer ring. Rings without area
    are ignored, as are the cells `left_out`.
    """
    _, _, cells, holes = arrays
    several = np.diff(cells) > 1
    if left_out is not None:
        several[left_out] = False
    if not several.any():
        return np.zeros(0, dtype=np.int64)
    number = np.repeat(np.arange(len(several)), np.diff(cells))
    rings = np.flatnonzero(several[number])
    hollow, number = holes[rings], number[rings]
    part = np.cumsum(~hollow) - 1
    wrong = np.concatenate((
        number[hollow][_misplaced(arrays, rings, part, build, workers)],
        _overlapping(arrays, rings, number, build, workers),
    ))  # fmt: skip
    return np.unique(wrong)


def _misplaced(
    arrays: Arrays, rings: Rows, part: Rows, build: Callable[..., Any], workers: int
) -> Bools:
    """Return which holes are not inside the outer ring of their part, or overlap another hole."""
    hollow = arrays[3][rings]
    own = part[hollow]
    found = np.zeros(len(own), dtype=np.bool_)
    if not len(own):
        return found
    outer, inner = (_alone(arrays, rings[chosen], build) for chosen in (~hollow, hollow))
    known, around = inner.check(False, workers), outer.check(False, workers)
    shared = inner.overlaps(outer, workers)
    hole = np.repeat(np.arange(len(own)), np.diff(shared.indptr))
    # A hole around its outer ring shares less than all of its area.
    whole = shared.areas >= (1 - _SHARED) * known.areas[hole]
    inside = np.zeros(len(own), dtype=np.bool_)
    inside[hole[whole & (own[hole] == shared.indices)]] = True
    # Also in an outer ring without area.
    found |= ~inside & (known.faults == 0) & (around.faults[own] <= _EMPTY)
    first, second = _pairs(inner, known.areas, own, workers)
    found[first] = found[second] = True
    return found


def _overlapping(
    arrays: Arrays, rings: Rows, number: Rows, build: Callable[..., Any], workers: int
) -> Rows:
    """Return the cells, not all different, of parts that overlap."""
    first = np.flatnonzero(~arrays[3][rings])
    owner = number[first]
    # Parts of cells that have several.
    kept = np.bincount(owner)[owner] > 1
    if not kept.any():
        return np.zeros(0, dtype=np.int64)
    counts = np.diff(np.append(first, len(rings)))[kept]
    chosen = rings[np.repeat(kept, np.diff(np.append(first, len(rings))))]
    parts = _taken(arrays, chosen, np.append(0, np.cumsum(counts)), arrays[3][chosen], build)
    areas = parts.check(False, workers).areas
    return owner[kept][_pairs(parts, areas, owner[kept], workers)[0]]


def _pairs(cells: Any, areas: Floats, owner: Rows, workers: int) -> tuple[Rows, Rows]:
    """Return pairs of cells of one owner that overlap, the smaller row first."""
    shared = cells.overlaps(cells, workers)
    first = np.repeat(np.arange(len(owner)), np.diff(shared.indptr))
    second = np.asarray(shared.indices)
    chosen = (first < second) & (owner[first] == owner[second])
    first, second = first[chosen], second[chosen]
    small = np.minimum(areas[first], areas[second])
    more = shared.areas[chosen] > _SHARED * small
    return first[more], second[more]


def _alone(arrays: Arrays, rings: Rows, build: Callable[..., Any]) -> Any:
    """Return some of the rings as cells of the core, none of them a hole."""
    each = np.arange(len(rings) + 1, dtype=np.int64)
    return _taken(arrays, rings, each, np.zeros(len(rings), dtype=np.bool_), build)


def _taken(
    arrays: Arrays, rings: Rows, starts: Rows, holes: Bools, build: Callable[..., Any]
) -> Any:
    """Return some of the rings as cells of the core that start at `starts`."""
    places, ends, _, _ = arrays
    counts = np.diff(ends)[rings]
    first = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
    at = np.arange(first[-1]) + np.repeat(ends[rings] - first[:-1], counts)
    return build(places[at], first, starts.astype(np.int64), np.ascontiguousarray(holes))
