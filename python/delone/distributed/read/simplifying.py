"""Simplification of a tiled triangulation: each tile separately, without cracks between tiles.

Tiles meet along the cuts of their tree, which are parallel to an axis. First, the profile of the
surface along each cut is simplified, using only the triangles along it. Points where a cut ends at
another one, or at the hull, are fixed. Then each tile inserts points between the lines around it.
These lines are kept, so both sides of a cut have the same edges. Points on a cut are within half of
the error of its line, which leaves room for rounding; all others are within the error, as without
tiles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_choice
from delone._base.counting import counted
from delone._base.thinning import thinned
from delone.distributed.read.assembling import Piece, assembled
from delone.distributed.read.fitting import fitting
from delone.distributed.read.folder import TileFolder
from delone.distributed.read.tasks import mapped
from delone.distributed.read.tile import read_vertices
from delone.distributed.read.volumes import profile
from delone.errors import DegenerateInputError, FileFormatError, InputError
from delone.terrain.building import Built
from delone.terrain.deviations import deviations
from delone.terrain.simplifying import KEEP, Ground, as_goal, simplified
from delone.terrain.tin import TIN

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.terrain.deviations import Deviations
    from delone.terrain.simplifying import Simplification

__all__ = ["prove", "simplify"]

_EPS = float(np.finfo(np.float64).eps)


class _Cut(NamedTuple):
    """A cut of the tree: the axis perpendicular to it, its position, and where it ends."""

    axis: int
    place: float
    low: float
    high: float

    def points(self, way: Floats) -> Floats:
        """Return positions along the cut."""
        across = np.full(len(way), self.place)
        return np.column_stack((across, way) if self.axis == 0 else (way, across))

    def on(self, points: Floats) -> Bools:
        """Return which points are on the cut."""
        way = points[:, 1 - self.axis]
        found: Bools = points[:, self.axis] == self.place
        return found & (way >= self.low) & (way <= self.high)


class _Task(NamedTuple):
    """Tiles with the profiles along the cuts between them."""

    of_tiles: list[tuple[str, str, int]]
    cuts: list[_Cut]
    lines: list[tuple[Floats, Bools]]
    cells: Floats
    sides: list[list[int]]

    def at(self, error: float) -> list[tuple[Any, ...]]:
        """Return the arguments for each tile, with lines simplified for an error."""
        simple = _simplified_lines(self.cuts, self.lines, error)
        return [
            (*tile, [_within(simple[k], cell) for k in some], error)
            for tile, some, cell in zip(self.of_tiles, self.sides, self.cells, strict=True)
        ]


def simplify(
    tin: TileFolder, goal: tuple[Any, Any], keep: str, value: str, executor: Any
) -> tuple[TIN, float]:
    """Return a surface within an error of all points, with cuts as edges, and this error.

    The goal is an error or a number of triangles; see `fitting`. Tiles have no breaklines, so all
    choices of what to keep are the same.
    """
    tin._require(value)
    as_choice(keep, KEEP, name="keep")
    error, most = as_goal(*goal)
    task = _task(tin, value, executor)
    if goal[0] is None:
        least, greatest = np.array(list(mapped(executor, _heights, task.of_tiles))).T
        heights = float(least.min()), float(greatest.max())

        def count(error: float, coarser: list[float]) -> Rows:
            found = mapped(executor, _counts, [(*one, coarser) for one in task.at(error)])
            total: Rows = np.stack(list(found)).sum(axis=0)
            return total

        error = fitting(count, heights, tin.npoints, most)
    pieces = list(mapped(executor, _simplified_tile, task.at(error)))
    return TIN._built(assembled(pieces, tin.crs), None), error


def _task(tin: TileFolder, value: str, executor: Any) -> _Task:
    """Compute the profiles along the cuts."""
    cuts, cells, sides = _layout(tin)
    of_tiles = [(str(tin.path), value, number) for number in range(tin.ntiles)]
    scans = [(*tile, [cuts[k] for k in some]) for tile, some in zip(of_tiles, sides, strict=True)]
    given = np.concatenate([np.empty((0, 3)), *mapped(executor, _on_cuts, scans)])
    of_cuts = [(str(tin.path), value, cut, given[cut.on(given)]) for cut in cuts]
    lines = list(mapped(executor, _profile, of_cuts))
    return _Task(of_tiles, cuts, _meeting(cuts, lines), cells, sides)


def prove(tin: TileFolder, surface: TIN, max_error: float, value: str = "z") -> list[Deviations]:
    """Compare the points of each tile with a surface, in exact arithmetic."""
    every = np.ones(surface.nsimplex, dtype=bool)
    points = (_own(tin, number, value) for number in range(tin.ntiles))
    return [deviations(surface, every, surface.z, some, max_error) for some in points]


def _layout(tin: TileFolder) -> tuple[list[_Cut], Floats, list[list[int]]]:
    """Return the cuts, the cells of the tiles within the bounds, and the cuts around each cell."""
    tree = tin._tree()
    cuts: list[_Cut | None] = [None] * len(tree.cut)
    cells = np.empty((tin.ntiles, 4))
    sides: list[list[int]] = [[] for _ in range(tin.ntiles)]
    whole = np.array(tin.bounds)
    around: tuple[int, ...] = (-1, -1, -1, -1)
    open_nodes = [(0 if len(tree.cut) else ~0, whole, around)]
    while open_nodes:  # each node is visited once
        node, cell, around = open_nodes.pop()
        if node < 0:
            cells[~node] = cell
            sides[~node] = [k for k in around if k >= 0]
            continue
        axis, place = int(tree.axis[node]), float(tree.cut[node])
        cuts[node] = _Cut(axis, place, float(cell[1 - axis]), float(cell[3 - axis]))
        for child, side in zip(tree.children[node].tolist(), (2 + axis, axis), strict=True):
            smaller, others = cell.copy(), list(around)
            smaller[side], others[side] = place, node
            open_nodes.append((child, smaller, tuple(others)))
    return [cut for cut in cuts if cut is not None], cells, sides


def _own(tin: TileFolder, number: int, value: str) -> Floats:
    """The points that a tile owns, (n, 3); of those that coincide, the first."""
    places, columns = read_vertices(tin.store, tin.manifest, number, [value])
    owned = columns["owned"]
    if np.count_nonzero(owned) != tin.manifest["tiles"][number]["points"]:
        raise FileFormatError(f"{tin.path}: tile {number} does not have the points of its manifest")
    ids = columns["id"][owned]
    # Negative zeros count as zeros.
    points = np.column_stack((places[owned], columns[value][owned].astype(np.float64))) + 0.0
    order = np.lexsort((ids, points[:, 1], points[:, 0]))
    same = (np.diff(points[order, :2], axis=0) == 0).all(axis=1)
    order = np.sort(np.concatenate((order[:1], order[1:][~same])))
    points = points[order]
    bad = np.flatnonzero(~np.isfinite(points[:, 2]))
    if len(bad):
        raise InputError(
            f"{value} is NaN or infinite at {counted(len(bad), 'point')} of tile {number}, first "
            f"in row {ids[order[bad[0]]]}: a simplified surface needs a value at each point"
        )
    return points


def _on_cuts(path: str, value: str, number: int, cuts: list[_Cut]) -> Floats:
    """The points of a tile that are on a cut."""
    points = _own(TileFolder._at(path), number, value)
    found = np.zeros(len(points), dtype=bool)
    for cut in cuts:
        found |= cut.on(points)
    return points[found]


def _within(line: Floats, cell: Floats) -> Floats:
    """The points of a line that are in a closed cell."""
    found: Floats = line[((line[:, :2] >= cell[:2]) & (line[:, :2] <= cell[2:])).all(axis=1)]
    return found


def _profile(path: str, value: str, cut: _Cut, own: Floats) -> Floats:
    """The heights of the surface along a cut, (n, 3), including all survey points on it."""
    ends = cut.points(np.array([cut.low, cut.high]))
    heights = profile(TileFolder._at(path), ends, value)
    table = np.column_stack((heights.points, heights.z))[~np.isnan(heights.z)]
    # The cut is parallel to an axis, so only the position along it is rounded.
    table[:, cut.axis] = cut.place
    both = np.concatenate((own, table[cut.on(table)]))
    _, first = np.unique(both[:, 1 - cut.axis], return_index=True)
    found: Floats = both[first]
    return found


def _meeting(cuts: list[_Cut], lines: list[Floats]) -> list[tuple[Floats, Bools]]:
    """Return the lines including the ends of other lines on them, and which points are such ends.

    Where lines meet, the height is that of the first one, which is nearer to the root.
    """
    ends = np.concatenate([np.empty((0, 3)), *(line[[0, -1]] for line in lines if len(line))])
    found: list[tuple[Floats, Bools]] = []
    height: dict[tuple[float, float], float] = {}
    for cut, line in zip(cuts, lines, strict=True):
        both = np.concatenate((line, ends[cut.on(ends)]))
        way, first = np.unique(both[:, 1 - cut.axis], return_index=True)
        joint = np.isin(way, both[len(line) :, 1 - cut.axis])
        points = both[first]
        for row in np.flatnonzero(joint).tolist():
            x, y, z = points[row].tolist()
            points[row, 2] = height.setdefault((x, y), z)
        found.append((points, joint))
    return found


def _simplified_lines(
    cuts: list[_Cut], lines: list[tuple[Floats, Bools]], error: float
) -> list[Floats]:
    """Return the points of lines that are kept: all others are within half of the error."""
    simple = []
    for cut, (points, fixed) in zip(cuts, lines, strict=True):
        slack = 8 * _EPS * float(np.abs(points[:, 2]).max(initial=0.0))
        # If rounding could matter, all points are kept.
        kept = thinned(points[:, 1 - cut.axis], points[:, 2], fixed, error / 2)
        simple.append(points if error / 2 <= slack else points[kept])
    return simple


def _heights(path: str, value: str, number: int) -> tuple[float, float]:
    """The least and the greatest height of the points of a tile."""
    z = _own(TileFolder._at(path), number, value)[:, 2]
    return float(z.min(initial=np.inf)), float(z.max(initial=-np.inf))


def _counts(  # noqa: PLR0917
    path: str, value: str, number: int, lines: list[Floats], error: float, coarser: list[float]
) -> Rows:
    """Return how many triangles a tile has for an error and for larger ones."""
    levels = _levels(path, value, number, lines, error)
    if levels is None:
        return np.zeros(len(coarser), dtype=np.int64)
    reached = np.minimum.accumulate(levels.errors)
    # The first level with at most this error.
    found: Rows = levels.triangles[np.searchsorted(-reached, -np.array(coarser))].astype(np.int64)
    return found


def _simplified_tile(
    path: str, value: str, number: int, lines: list[Floats], error: float
) -> Piece:
    """Simplify a tile between the lines around it."""
    levels = _levels(path, value, number, lines, error)
    if levels is None:
        none = np.empty((0, 3), dtype=np.int32)
        return Piece(np.empty((0, 3)), none, none)
    made: Built = levels.surface(max_error=error)
    # Points that coincide with a point of a line are not in any triangle.
    used = np.zeros(len(made.points), dtype=bool)
    used[made.simplices] = True
    row = (np.cumsum(used) - 1).astype(np.int32)
    points = np.column_stack((made.points[used], made.z[used]))
    return Piece(points, row[made.simplices], made.neighbors)


def _levels(
    path: str, value: str, number: int, lines: list[Floats], error: float
) -> Simplification | None:
    """Insert points of a tile until an error is reached; None if the tile has no area."""
    tin = TileFolder._at(path)
    border, segments = _edges(lines)
    # Points on a cut are within half of the error of its line, so they are never inserted.
    every = np.concatenate((border, _own(tin, number, value)))
    flat = np.ascontiguousarray(every[:, :2])
    if len(flat) < 3:
        return None
    try:
        corners, _ = _core.hull2(flat)
    except DegenerateInputError:
        return None  # the cell and the hull share no area
    fixed = np.arange(len(flat)) < len(border)
    fixed[corners] = True
    ground = Ground(
        flat,
        np.ascontiguousarray(every[:, 2]),
        np.flatnonzero(fixed),
        np.flatnonzero(~fixed),
        segments,
        np.ones(len(segments), dtype=bool),
        np.empty((0, 2), dtype=np.int32),
        tin.crs,
        None,
        None,
    )
    return simplified(ground, lambda built, _: built, error, None)


def _edges(lines: list[Floats]) -> tuple[Floats, Indices]:
    """Return the points of lines, each once, and the segments between them."""
    counts = np.array([0, *map(len, lines)], dtype=np.int64)
    points = np.concatenate([np.empty((0, 3)), *lines])
    _, first, same = np.unique(points[:, :2], axis=0, return_index=True, return_inverse=True)
    rows = np.delete(np.arange(len(points)), np.cumsum(counts)[1:][counts[1:] > 0] - 1)
    pairs = np.column_stack((rows, rows + 1)).astype(np.int64)
    return points[first], same.reshape(-1)[pairs].astype(np.int32)
