"""FESOM meshes in text files, and cells around the nodes of meshes: the median dual."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_simplices
from delone._base.files import path_of
from delone.errors import FileFormatError, InputError
from delone.sphere.coordinates import units_of

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from delone._base.types import Bools, Floats, Rows
    from delone.sphere.grid_report import GridReport

__all__ = ["median_dual", "read_text"]


def read_text(folder: str | os.PathLike[str]) -> tuple[Floats, Rows]:
    """Return longitudes and latitudes in degrees, and triangles, of nod2d.out and elem2d.out."""
    place = path_of(folder, name="folder")
    nodes = _table(place / "nod2d.out", 4)
    triangles = _table(place / "elem2d.out", 3)
    order = nodes[:, 0] - 1
    if not np.array_equal(np.sort(order), np.arange(len(nodes))):
        raise FileFormatError(f"nod2d.out: nodes must have the numbers 1 to {len(nodes)}")
    lonlat = np.empty((len(nodes), 2))
    lonlat[order.astype(np.int64)] = nodes[:, 1:3]
    numbers = (triangles - 1).astype(np.int64)
    return lonlat, as_simplices(numbers, len(lonlat), 2, name="elem2d.out").astype(np.int64)


def _table(path: Path, columns: int) -> Floats:
    """Return the rows of a file whose first line is the number of rows."""
    try:
        with path.open(encoding="utf-8") as file:
            count = int(file.readline())
            found = np.loadtxt(file, ndmin=2)
    except ValueError as error:
        raise FileFormatError(f"{path.name} must be a table of numbers: {error}") from error
    if found.shape != (count, columns):
        raise FileFormatError(
            f"{path.name} must have {count} rows of {columns} numbers, got {found.shape}"
        )
    return found


def median_dual(
    vectors: Floats, corners: Rows, starts: Rows, report: GridReport
) -> tuple[Any, ...]:
    """Return the arrays of the core for cells around the nodes of polygons.

    Polygons are rows of `corners`, as compressed rows, with the `report` of a grid of them: some
    run clockwise, and some have no area and are left out. The corners of a cell are the middles of
    the polygons and of the edges around its node, and at the boundary the node itself.
    """
    places = units_of(vectors, None)
    corners, starts = _distinct(corners, starts)
    sums = np.zeros((len(starts) - 1, 3))
    lengths = np.diff(starts)
    of = np.repeat(np.arange(len(lengths)), lengths)
    for axis in range(3):
        sums[:, axis] = np.bincount(of, places[corners, axis], len(lengths))
    sums[lengths == 0] = 1.0
    middles = units_of(sums, None) if len(sums) else sums
    after, before = _beside(corners, starts)
    turned = np.isin(of, report.reversed)
    after, before = np.where(turned, before, after), np.where(turned, after, before)
    used = ~np.isin(of, report.empty)
    wedges = _Wedges(*(array[used] for array in (corners, after, before, of)))
    return _joined(places, middles, wedges.ordered(len(places)), len(places))


def _distinct(corners: Rows, starts: Rows) -> tuple[Rows, Rows]:
    """Return polygons without corners that repeat the previous one."""
    kept = _beside(corners, starts)[1] != corners
    if kept.all():
        return corners, starts
    counts = np.concatenate(([0], np.cumsum(kept)))
    return corners[kept], counts[starts]


def _beside(corners: Rows, starts: Rows) -> tuple[Rows, Rows]:
    """Return the corner after and the corner before each, around its polygon."""
    first, end = (each[np.diff(starts) > 0] for each in (starts[:-1], starts[1:]))
    after, before = np.roll(corners, -1), np.roll(corners, 1)
    after[end - 1], before[first] = corners[first], corners[end - 1]
    return after, before


class _Wedges(NamedTuple):
    """Corners of counterclockwise polygons, as wedges around nodes."""

    # The node, and those of the edges to its right and left, seen from the node.
    node: Rows
    right: Rows
    left: Rows
    # The polygon.
    of: Rows

    def ordered(self, count: int) -> _Wedges:
        """Return them sorted by node, then by right edge, which no two may share."""
        keys = self.node * count + self.right
        order = np.argsort(keys, kind="stable")
        same = np.flatnonzero(np.diff(keys[order]) == 0)
        if len(same):
            # The first polygon that overlaps one before it.
            at = same[np.argmin(order[same + 1])]
            one, other = order[at], order[at + 1]
            raise InputError(
                f"cells {self.of[one]} and {self.of[other]} overlap: both are on the same side of "
                f"the edge between nodes {self.node[one]} and {self.right[one]}"
            )
        return _Wedges(*(array[order] for array in self))

    def following(self, count: int) -> Rows:
        """Return the wedge to the left of each ordered wedge, -1 at the boundary."""
        keys, wanted = self.node * count + self.right, self.node * count + self.left
        at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        found: Rows = np.where(keys[at] == wanted, at, -1)
        return found


def _chained(wedges: _Wedges, count: int) -> tuple[Rows, Rows, Bools]:
    """Return the wedges chain by chain, where chains start, and which begin at a boundary.

    Chains at the boundary start there and come first; all others close.
    """
    follows = wedges.following(count)
    inner = np.zeros(len(follows), dtype=bool)
    inner[follows[follows >= 0]] = True
    rest = np.ones(len(follows), dtype=bool)
    first = np.flatnonzero(~inner)
    heads, opened = 0, len(first)
    found = [(first[:0], first[:0])]
    while rest.any():
        at, chain = first, np.arange(len(first)) + heads
        heads += len(first)
        # One step along all chains at once, until they end or close.
        while len(at):
            found.append((chain, at))
            rest[at] = False
            at = follows[at]
            on = at >= 0
            on[on] = rest[at[on]]
            at, chain = at[on], chain[on]
        left = np.flatnonzero(rest)
        first = left[np.unique(wedges.node[left], return_index=True)[1]]
    chains, entries = (np.concatenate(parts) for parts in zip(*found, strict=True))
    # Stable: steps of a chain remain in their order.
    starts = np.concatenate(([0], np.cumsum(np.bincount(chains, minlength=heads))))
    return entries[np.argsort(chains, kind="stable")], starts, np.arange(heads) < opened


def _joined(places: Floats, middles: Floats, wedges: _Wedges, count: int) -> tuple[Any, ...]:
    """Return the rings around nodes."""
    entries, starts, opened = _chained(wedges, count)
    lengths = np.diff(starts)
    # Two corners for each wedge; at a boundary also the node, and the last edge.
    sizes = 2 * lengths + 2 * opened
    rings = np.concatenate(([0], np.cumsum(sizes)))
    chain = np.repeat(np.arange(len(lengths)), lengths)
    at = rings[chain] + opened[chain] + 2 * (np.arange(len(entries)) - starts[chain])
    found = np.empty((rings[-1], 3))
    node, right, left, of = (array[entries] for array in wedges)
    found[at] = places[node] + places[right]
    found[at + 1] = middles[of]
    last = starts[1:][opened] - 1
    found[rings[:-1][opened]] = places[node[last]]
    found[rings[1:][opened] - 1] = places[node[last]] + places[left[last]]
    return _by_node(units_of(found, None), rings, node[starts[:-1]], count)


def _by_node(corners: Floats, rings: Rows, node: Rows, count: int) -> tuple[Any, ...]:
    """Return rings in the order of their nodes, as the arrays of the core."""
    order = np.argsort(node, kind="stable")
    sizes = np.diff(rings)[order]
    starts = np.concatenate(([0], np.cumsum(sizes)))
    moved = np.repeat(rings[:-1][order] - starts[:-1], sizes) + np.arange(starts[-1])
    cells = np.concatenate(([0], np.cumsum(np.bincount(node, minlength=count))))
    return corners[moved], starts, cells, np.zeros(len(order), dtype=np.bool_)
