"""Cells between meridians and parallels in one list, each with its own bounds.

Reduced grids are stored this way in files with CF conventions. Cells between the same parallels
become one row for the core, from west to east. A cell that overlaps another one in its row becomes
a separate row.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.counting import agreed, counted
from delone.errors import InputError
from delone.sphere.rings import WIDE, tangents_of

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows

__all__ = ["as_boxes", "rows_of"]

_TURN = 360.0


def as_boxes(lon: Floats, lat: Floats, middle: Floats, names: tuple[str, str]) -> Floats:
    """Return the west, east, south and north of cells, (n, 4), from their bounds in degrees.

    Two meridians have two intervals between them; a cell is in the one that contains its `middle`.
    Latitudes must not be beyond the poles.
    """
    if not len(lon):
        raise InputError(f"{names[0]} and {names[1]} are empty: there are no cells")
    west, east = lon.min(axis=1), lon.max(axis=1)
    with np.errstate(invalid="ignore"):
        inside = (middle - west) % _TURN <= east - west
    west, east = np.where(inside, west, east), np.where(inside, east, west + _TURN)
    south, north = lat.min(axis=1), lat.max(axis=1)
    wrong = (lon[:, 0] == lon[:, 1]) | ~((east > west) & (east - west <= _TURN) & (north > south))
    if wrong.any():
        rows = np.flatnonzero(wrong)
        raise InputError(
            f"{names[0]} and {names[1]}: {counted(len(rows), 'cell')} "
            f"{agreed(len(rows), 'has', 'have')} no width, no height, a bound that is not a "
            f"number, or more than one turn; first cell {rows[0]}: leave such cells out"
        )
    return np.column_stack((west, east, south, north))


class _Listed(NamedTuple):
    """Cells row by row, from west to east."""

    # West, east, south and north.
    boxes: Floats
    # West from 0 to 360 degrees, and east as the next bound after it.
    start: Floats
    end: Floats
    # The row of each, and its number in the input.
    row: Rows
    number: Rows

    def taken(self, order: Rows) -> _Listed:
        """Return the cells in a different order."""
        return _Listed._make(array[order] for array in self)


def rows_of(boxes: Floats, merge: tuple[float, float]) -> tuple[tuple[Any, ...], int]:
    """Return the arrays for the core, and how many bounds were moved to those of their neighbors.

    Meridians and parallels closer than `merge`, in degrees, become one. In grids with smaller
    cells, the limit is a quarter of the smallest cell.
    """
    near, close = (
        min(limit, float((boxes[:, k + 1] - boxes[:, k]).min()) / 4)
        for k, limit in zip((0, 2), merge, strict=True)
    )
    parallels, moved = _merged(boxes[:, 2:], close)
    start = boxes[:, 0] % _TURN
    end = start + (boxes[:, 1] - boxes[:, 0])
    number = np.arange(len(boxes))
    cells = _Listed(np.column_stack((boxes[:, :2], parallels)), start, end, number, number)
    cells = cells.taken(np.lexsort((start, parallels[:, 1], parallels[:, 0])))
    row = _row_numbers(cells, near)
    cells = cells._replace(row=row).taken(np.argsort(row, kind="stable"))
    boxes, start, end, row, _ = cells
    joined = np.zeros(len(row), dtype=bool)
    joined[1:] = (row[1:] == row[:-1]) & (np.abs(start[1:] - end[:-1]) <= near)
    moved += int((joined[1:] & ((boxes[1:, 0] - boxes[:-1, 1]) % _TURN != 0)).sum())
    # Rows that go all the way around end where they begin.
    first = np.flatnonzero(np.append(True, row[1:] != row[:-1]))
    last = np.append(first[1:], len(row)) - 1
    around = np.abs(end[last] - start[first] - _TURN) <= near
    moved += int((around & ((boxes[last, 1] - boxes[first, 0]) % _TURN != 0)).sum())
    boxes[last[around], 1] = boxes[first[around], 0]
    return _arrays(cells, first, joined), moved


def _merged(parallels: Floats, near: float) -> tuple[Floats, int]:
    """Return latitudes moved to the next smaller one within `near`, and how many were moved."""
    values, at = np.unique(parallels, return_inverse=True)
    first = np.append(True, np.diff(values) > near)
    kept = values[first][np.cumsum(first) - 1]
    found = kept[at].reshape(parallels.shape)
    return found, int((found != parallels).sum())


def _row_numbers(cells: _Listed, near: float) -> Rows:
    """Return a row for each cell, such that those of one row do not overlap."""
    parallels, start, end = cells.boxes[:, 2:], cells.start, cells.end
    fresh = np.ones(len(start), dtype=bool)
    fresh[1:] = (parallels[1:] != parallels[:-1]).any(axis=1)
    group = np.cumsum(fresh) - 1
    first = np.flatnonzero(fresh)
    # How far east the earlier cells reach; the shift keeps groups apart.
    shift = 4 * _TURN * group
    reach = np.maximum.accumulate(end + shift)
    alone = end > start[first][group] + _TURN + near
    alone[1:] |= start[1:] + shift[1:] < reach[:-1] - near
    alone[first] = False
    found = np.where(alone, len(first) + np.arange(len(start)), group)
    return np.unique(found, return_inverse=True)[1].astype(np.int64)


def _arrays(cells: _Listed, first: Rows, joined: Bools) -> tuple[Any, ...]:
    """Return the arrays for the core; `joined` marks cells that begin where the one before ends."""
    count = len(joined)
    # Each cell has a meridian in the east, and in the west unless it is joined. Each meridian has
    # the number of the cell east of it, if there is one.
    edges = np.column_stack((cells.start, cells.end)).ravel()
    numbers = np.column_stack((cells.number, np.full(count, -1))).ravel()
    numbers[1:-1:2] = np.where(joined[1:], cells.number[1:], -1)
    kept = np.column_stack((~joined, np.ones(count, dtype=bool))).ravel()
    angles = cells.boxes[:, :2].ravel()[kept]
    meridians, of = _cut(edges[kept], angles, np.repeat(cells.row, 2)[kept])
    per_row = np.bincount(np.repeat(cells.row, 2)[kept][of])
    starts = np.concatenate(([0], np.cumsum(per_row))).astype(np.int64)
    tangents = tangents_of(cells.boxes[first, 2:].ravel()).reshape(-1, 2)
    return tangents, starts, meridians, numbers[kept][of].astype(np.int32), count


def _cut(edges: Floats, angles: Floats, row: Rows) -> tuple[Floats, Rows]:
    """Return directions of meridians, with further ones in wide gaps, and the edge of each."""
    width = np.append(np.diff(edges), 0.0)
    width[np.append(row[1:] != row[:-1], True)] = 0.0
    parts = np.maximum(np.ceil(width / WIDE), 1).astype(np.int64)
    of = np.repeat(np.arange(len(edges)), parts)
    within = np.arange(len(of)) - np.repeat(np.cumsum(parts) - parts, parts)
    lon = angles[of] + within * (width / parts)[of]
    places = np.column_stack((lon, np.zeros(len(lon))))
    directions = _core.sphere_directions(places, True, as_workers(None))[:, :2]
    return np.ascontiguousarray(directions), of
