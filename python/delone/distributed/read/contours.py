"""Contours of a tiled triangulation: the same lines as in one piece.

Work is divided by level, not by area: a line of a level depends on the triangles that this level
crosses, wherever they are. So the triangles of a few levels are gathered from all tiles and drawn
together, and no line has to be joined. A line has about one point for each triangle, so these
triangles need little more memory than the line itself. Lines are kept on disk until those of all
levels are drawn.

Two things depend on more than one level. Where rounded lines would cross, points are merged in the
cell between two levels, so triangles are also drawn with the level below and the one above.
Triangles thinner than the resolution of coordinates may be left out at the outline, so all thin
triangles and their neighbors are in each part, and what is left out in one part is left out in all.
"""

from __future__ import annotations

import math
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_count
from delone._base.counting import counted
from delone._tiling.plane import slivers, topology
from delone.distributed.read.folder import TileFolder
from delone.distributed.read.parts import Piece, heights_of, joined, piece_of
from delone.distributed.read.tasks import mapped
from delone.distributed.read.tile import read_columns
from delone.distributed.store.output import tile_names
from delone.errors import BudgetExceededError
from delone.terrain.contouring import Contours, Drawn, Finish, finished, levels_of
from delone.terrain.slivers import at_the_outline

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats, Rows
    from delone.distributed.read.tile import Tile

__all__ = ["CROSSINGS", "contours", "parts"]

# Crossings of triangles and levels that are drawn together, each with about 250 bytes of memory.
CROSSINGS = 1_000_000
# Triangles of a tile whose edges are compared together.
_TRIANGLES = 1 << 18


class _State(NamedTuple):
    """What is left out, and how lines in thin triangles are drawn; see `delone.terrain.slivers`."""

    dropped: Rows
    collapsed: Rows
    far: bool


class _Scan(NamedTuple):
    """What one pass over the tiles finds."""

    crossings: Rows  # for each level, the triangles that it crosses
    thin: Rows  # the edges of thin triangles


class _Part(NamedTuple):
    """A file with the lines of some levels, or what prevents drawing them."""

    lines: str
    tangled: Rows
    outer: Rows


def contours(  # noqa: PLR0917
    tin: TileFolder,
    given: tuple[ArrayLike | None, float | None, float, int],
    finish: Finish,
    max_points: int,
    value: str,
    executor: Any,
) -> Contours:
    """Return the contours of all tiles."""
    levels, marked, scan = _wanted(tin, given, finish, max_points, value)
    with _drawn(tin, value, levels, scan, executor) as (files, dropped):
        outline = _outline(tin, dropped) if finish.simplify else None
        drawing = _together(files, len(dropped), outline)
    return finished(drawing, (levels, marked), finish, None, tin.crs, None)


def parts(  # noqa: PLR0917
    tin: TileFolder,
    given: tuple[ArrayLike | None, float | None, float, int],
    finish: Finish,
    max_points: int,
    value: str,
    executor: Any,
) -> Iterator[Contours]:
    """Return the contours of all tiles, a few levels at a time."""
    # Levels and limits are checked before the first lines are requested.
    wanted = _wanted(tin, given, finish, max_points, value)
    return _parts(tin, finish, wanted, value, executor)


def _parts(
    tin: TileFolder,
    finish: Finish,
    wanted: tuple[Floats, Bools, _Scan],
    value: str,
    executor: Any,
) -> Iterator[Contours]:
    levels, marked, scan = wanted
    with _drawn(tin, value, levels, scan, executor) as (files, dropped):
        # At least once, so that files with no lines have their columns.
        for some in [[file] for file in files] or [[]]:
            drawing = _together(some, len(dropped), None)
            yield finished(drawing, (levels, marked), finish, None, tin.crs, None)


def _wanted(
    tin: TileFolder,
    given: tuple[ArrayLike | None, float | None, float, int],
    finish: Finish,
    max_points: int,
    value: str,
) -> tuple[Floats, Bools, _Scan]:
    """Return levels, which of them are index contours, and the crossing triangles."""
    tin._require(value)
    most = as_count(max_points, name="max_points") // finish.factor
    levels, marked = levels_of(partial(_extremes, tin, value), *given)
    scan = _scan(tin, value, levels)
    found = int(scan.crossings.sum())
    if found > most:
        raise BudgetExceededError(
            f"{counted(len(levels), 'level')} would give contours of at least {found:,} points, "
            f"more than {most:,}: choose fewer levels, or raise max_points",
            limit=most,
            found=found,
        )
    return levels, marked, scan


def _outline(tin: TileFolder, dropped: Rows) -> Floats:
    """Return the edges at the outline of all tiles without some triangles, (k, 2, 2)."""
    keys = [np.empty(0, dtype=np.int64)]
    ends = [np.empty((0, 2, 2))]
    for tile in tin.tiles():
        left = ~_among(tin.starts[tile.number] + np.arange(len(tile.simplices)), dropped)
        simplices = np.ascontiguousarray(tile.simplices[left])
        beyond = topology.neighbors(simplices, len(tile.points))
        edges = topology.boundary_edges(simplices, beyond)
        keys.append(_numbers(tin, tile.ids[edges]))
        ends.append(tile.points[edges])
    # An edge between two tiles is in both.
    _, first, counts = np.unique(np.concatenate(keys), return_index=True, return_counts=True)
    found: Floats = np.concatenate(ends)[first[counts == 1]]
    return found


def _together(files: list[str], left_out: int, outline: Floats | None) -> Drawn:
    """Combine the lines of files."""
    none = np.empty(0, dtype=np.int64)
    sizes, numbers = [none], [none]
    for file in files:
        with np.load(file) as arrays:
            sizes.append(np.diff(arrays["starts"]))
            numbers.append(arrays["level"])
    starts = np.concatenate(([0], np.cumsum(np.concatenate(sizes))))
    points, at = np.empty((int(starts[-1]), 2)), 0
    for file in files:
        with np.load(file) as arrays:
            some = arrays["points"]
        points[at : at + len(some)] = some
        at += len(some)
    return Drawn(points, starts, np.concatenate(numbers).astype(np.int32), left_out, outline)


def _extremes(tin: TileFolder, value: str) -> tuple[float, float]:
    """The smallest and the largest value; each point is a corner of a triangle."""
    low, high = math.inf, -math.inf
    for number in range(tin.ntiles):
        path = tin.store.path(tile_names(number)[0])
        z = read_columns(path, {value: "biuf"})[value]
        if len(z):
            low, high = min(low, float(z.min())), max(high, float(z.max()))
    return low, high


def _ranks(tile: Tile, value: str, levels: Floats) -> tuple[Rows, Rows]:
    """The levels that each triangle crosses: the first, and the one after the last."""
    ranks = np.searchsorted(levels, heights_of(tile, value), side="right")[tile.simplices]
    return ranks.min(axis=1, initial=len(levels)), ranks.max(axis=1, initial=0)


def _scan(tin: TileFolder, value: str, levels: Floats) -> _Scan:
    """Count crossings, and find the edges of thin triangles."""
    steps = np.zeros(len(levels) + 1, dtype=np.int64)
    thin = [np.empty(0, dtype=np.int64)]
    for tile in tin.tiles():
        first, last = _ranks(tile, value, levels)
        crossed = first < last
        steps += np.bincount(first[crossed], minlength=len(steps))
        steps -= np.bincount(last[crossed], minlength=len(steps))
        thin.append(_edges(tin, tile, _thin(tile)).ravel())
    return _Scan(np.cumsum(steps)[:-1], np.unique(np.concatenate(thin)))


def _thin(tile: Tile) -> Rows:
    """The triangles that are thin."""
    a, b, c = (tile.points[corner] for corner in tile.simplices.T)
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    # Few remain; computing the areas of all triangles without rounding errors would take much
    # longer.
    slack = 1024 * np.spacing(np.abs(tile.points).max(initial=0.0))
    most = np.abs(ux) + np.abs(uy) + np.abs(vx) + np.abs(vy)
    some = np.flatnonzero(~(np.abs(ux * vy - uy * vx) > slack * most))
    found: Rows = some[slivers.shapes(tile.points, tile.simplices[some]).thin]
    return found


def _edges(tin: TileFolder, tile: Tile, some: Any = slice(None)) -> Rows:
    """The edges of triangles, (m, 3), by the rows of their ends in the source."""
    return _numbers(tin, tile.ids[tile.simplices[some]][:, [[1, 2], [2, 0], [0, 1]]])


def _numbers(tin: TileFolder, edges: Rows) -> Rows:
    """Return a number for each edge, (..., 2), of rows in the source."""
    ends = np.sort(edges, axis=-1)
    found: Rows = ends[..., 0] * np.int64(tin.manifest["rows"]) + ends[..., 1]
    return found


@contextmanager
def _drawn(
    tin: TileFolder, value: str, levels: Floats, scan: _Scan, executor: Any
) -> Iterator[tuple[list[str], Rows]]:
    """Draw the lines of all levels, part by part, until none of them is tangled.

    The results are files, one for each part, and the triangles that are left out.
    """
    ranges = _ranges(scan.crossings)
    # On a cluster, other machines must be able to read the files.
    place = None if isinstance(executor, str) else tin.path
    with TemporaryDirectory(prefix=".contours-", dir=place) as folder:
        dealt = [
            (str(tin.path), value, number, (levels, ranges), scan.thin, folder)
            for number in range(tin.ntiles)
        ]
        for _ in mapped(executor, _deal, dealt):
            pass
        files = [
            [str(Path(folder, f"{part}-{number}.npz")) for number in range(tin.ntiles)]
            for part in range(len(ranges))
        ]
        yield _untangled(levels, list(zip(ranges, files, strict=True)), executor)


def _untangled(
    levels: Floats, ranges: list[tuple[tuple[int, int], list[str]]], executor: Any
) -> tuple[list[str], Rows]:
    """Draw lines, and return their files with the triangles that are left out.

    Each round leaves out or collapses at least one triangle, or is the first that merges points
    that are far apart, as in `delone.terrain.slivers.drawn`.
    """
    none = np.empty(0, dtype=np.int64)
    state = _State(none, none, False)
    while True:
        tasks = [(levels, wanted, files, state) for wanted, files in ranges]
        parts = list(mapped(executor, _lines, tasks))
        tangled = np.unique(np.concatenate([none, *(part.tangled for part in parts)]))
        if not len(tangled):
            return [part.lines for part in parts], state.dropped
        outer = np.unique(np.concatenate([none, *(part.outer for part in parts)]))
        if len(outer):
            state = state._replace(dropped=np.union1d(state.dropped, outer))
        elif not state.far:
            state = state._replace(far=True)
        else:
            state = state._replace(collapsed=np.union1d(state.collapsed, tangled))


def _ranges(crossings: Rows) -> list[tuple[int, int]]:
    """Ranges of levels that are drawn together: one level, or several with few crossings."""
    found, start, count = [], 0, 0
    for k, number in enumerate(crossings.tolist()):
        if k > start and count + number > CROSSINGS:
            found.append((start, k))
            start, count = k, 0
        count += number
    return [*found, (start, len(crossings))] if len(crossings) else []


def _deal(  # noqa: PLR0917
    path: str,
    value: str,
    number: int,
    of: tuple[Floats, list[tuple[int, int]]],
    thin: Rows,
    folder: str,
) -> None:
    """Write the triangles of a tile that each range of levels needs."""
    levels, ranges = of
    tin = TileFolder._at(path)
    tile = tin.tile(number)
    first, last = _ranks(tile, value, levels)
    beside = np.zeros(len(first), dtype=bool)
    for start in range(0, len(first) if len(thin) else 0, _TRIANGLES):
        some = slice(start, start + _TRIANGLES)
        beside[some] = _among(_edges(tin, tile, some), thin).any(axis=1)
    for part, (low, high) in enumerate(ranges):
        needed = (first < high) & (last > low) & (first < last)
        piece = piece_of(tin, tile, value, needed | beside)
        np.savez(Path(folder, f"{part}-{number}.npz"), **piece._asdict())


def _lines(levels: Floats, wanted: tuple[int, int], files: list[str], state: _State) -> _Part:
    """Draw the lines of a range of levels."""
    low, high = wanted
    pieces = []
    for file in files:
        with np.load(file) as arrays:
            piece = Piece(**arrays)
        left = ~_among(piece.numbers, state.dropped)
        pieces.append(piece._replace(corners=piece.corners[left], numbers=piece.numbers[left]))
    patch = joined(pieces)
    del pieces, piece
    sheet = patch.sheet()
    # With the level below and the one above.
    start, stop = max(low - 1, 0), min(high + 1, len(levels))
    collapsed = _among(patch.numbers, state.collapsed)
    # The number of points was counted before.
    made = _core.contour_lines2(sheet, levels[start:stop], 2**31 - 1, collapsed, state.far, 1)
    # All pieces are in the same folder.
    lines = str(Path(files[0]).with_name(f"lines-{low}.npz"))
    if len(made.tangled):
        outer = at_the_outline(sheet, made.tangled)
        return _Part(lines, patch.numbers[made.tangled], patch.numbers[outer])
    of = made.levels.astype(np.int64) + start
    begin, end = np.searchsorted(of, [low, high]).tolist()
    first, last = made.starts[[begin, end]].tolist()
    starts = made.starts[begin : end + 1] - first
    np.savez(lines, points=made.points[first:last], starts=starts, level=of[begin:end])
    nothing = np.empty(0, dtype=np.int64)
    return _Part(lines, nothing, nothing)


def _among(values: Rows, known: Rows) -> Bools:
    """Which values are in a sorted array."""
    if not len(known):
        return np.zeros(values.shape, dtype=bool)
    at = np.minimum(np.searchsorted(known, values), len(known) - 1)
    found: Bools = known[at] == values
    return found
