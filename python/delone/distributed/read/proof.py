"""Exact validation of a tiled triangulation, with one tile in memory at a time.

Triangles are counter-clockwise, each edge has one triangle on either side or lies on the boundary,
and the boundary is one convex cycle: therefore the triangles tile the hull. There are 2 n - 2 - h
of them for n distinct points and h on the boundary: therefore each point is a vertex. Each inner
edge is locally Delaunay with ties by coordinates: therefore the triangulation is Delaunay and
canonical (B. Delaunay, "Sur la sphère vide", 1934). Besides one tile, memory is needed for the
edges and vertices that tiles have in common, and a byte for each row in a window of all rows.

The manifest is compared with the files: hashes, counts, boxes, numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone.distributed.read.tile import read_columns, read_tile
from delone.distributed.store.files import digest
from delone.distributed.store.output import box_of, tile_names
from delone.errors import FileFormatError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows
    from delone.distributed.read.folder import TileFolder
    from delone.distributed.read.tile import Tile

__all__ = ["TiledReport", "prove"]

# Rows that are checked together for points that two tiles own: 256 MB.
_WINDOW = 1 << 28


@dataclass(frozen=True)
class TiledReport:
    """The result of the check of a tiled triangulation.

    Parameters
    ----------
    faults : tuple of str
        The faults and where they are; empty if everything is correct.

    Examples
    --------
    >>> from delone.distributed import TiledReport
    >>> bool(TiledReport()), str(TiledReport())
    (True, 'right')
    """

    faults: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether everything is correct."""
        return not self.faults

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        return "\n".join(self.faults) or "right"


class _Edges(NamedTuple):
    """Edges of tiles with a triangle of the tile on one side only."""

    # (k, 2): the rows of the source at both ends.
    ends: Rows
    # (k,): the tile.
    tile: Rows
    # (k, 3, 2): where the ends and the apex of the triangle are.
    points: Floats

    def at(self, rows: NDArray[Any]) -> _Edges:
        """Return some of them."""
        return _Edges(self.ends[rows], self.tile[rows], self.points[rows])


class _Vertices(NamedTuple):
    """Vertices of tiles that other tiles own."""

    # (k,): the row of the source.
    id: Rows
    # (k, 2): where it is.
    point: Floats
    # (k,): the tile that has it.
    tile: Rows
    # (k,): the tile that owns it.
    owner: Rows

    def at(self, rows: NDArray[Any]) -> _Vertices:
        """Return some of them."""
        return _Vertices(self.id[rows], self.point[rows], self.tile[rows], self.owner[rows])


def prove(tin: TileFolder) -> TiledReport:
    """Check a triangulation; see `TiledDelaunay.validate`."""
    faults: list[str] = []
    none, nowhere = np.empty(0, dtype=np.int64), np.empty((0, 2))
    edges = [_Edges(none.reshape(0, 2), none, nowhere.reshape(0, 3, 2))]
    foreign = [_Vertices(none, nowhere, none, none)]
    tree = tin._tree()
    sums = _Sums(points=0, triangles=0, distinct=0)
    spans: dict[int, tuple[int, int]] = {}
    all_read = True
    for number in range(tin.ntiles):
        faults += _hashes(tin, number)
        try:
            tile = read_tile(tin.store, tin.manifest, number)
        except FileFormatError as error:
            faults.append(f"tile {number} cannot be read: {error}")
            all_read = False
            continue
        owner = tree.locate(tile.points).astype(np.int64)
        faults += _figures(tile, tin.manifest["tiles"][number])
        faults += _inner(tile, owner)
        edges.append(_open_edges(tile))
        foreign.append(_foreign(tile, owner))
        sums.triangles += len(tile.simplices)
        sums.points += (own := int(tile.owned.sum()))
        sums.distinct += len(np.unique(tile.points[tile.owned] + 0.0, axis=0))
        if own:
            spans[number] = int(tile.ids[tile.owned].min()), int(tile.ids[tile.owned].max())
    boundary = _between(_Edges(*map(np.concatenate, zip(*edges, strict=True))), faults)
    faults += _owned_twice(tin, spans)
    faults += _copies(tin, _Vertices(*map(np.concatenate, zip(*foreign, strict=True))))
    if not all_read:
        # The sums of the other tiles prove nothing.
        return TiledReport(tuple(faults))
    h, corners = _around(boundary, faults)
    if sums.triangles != 2 * sums.distinct - 2 - h:
        right = 2 * sums.distinct - 2 - h
        faults.append(f"{sums.triangles} triangles instead of {right}: a point is missing")
    faults += _totals(tin.manifest, sums, corners)
    return TiledReport(tuple(faults))


@dataclass
class _Sums:
    """Totals of all tiles."""

    points: int
    triangles: int
    distinct: int


def _hashes(tin: TileFolder, number: int) -> list[str]:
    """Find the files of a tile that differ from those written."""
    faults = []
    for name, key in zip(tile_names(number), ("vertices", "triangles"), strict=True):
        try:
            if digest(tin.store.path(name)) != tin.manifest["tiles"][number][f"{key}_sha256"]:
                faults.append(f"{name} is not the file that was written")
        except FileNotFoundError:
            faults.append(f"{name} is missing")
    return faults


def _figures(tile: Tile, known: dict[str, Any]) -> list[str]:
    """Compare the manifest's figures of a tile with its files."""
    own = tile.points[tile.owned]
    found = {
        "points": len(own),
        "foreign": len(tile.points) - len(own),
        "triangles": len(tile.simplices),
        "box": box_of(own) if len(own) else None,
        "extent": box_of(tile.points) if len(tile.simplices) else None,
    }
    return [
        f"tile {tile.number}: {name} is {value} instead of {known[name]} in the manifest"
        for name, value in found.items()
        if value != known[name]
    ]


def _totals(manifest: dict[str, Any], sums: _Sums, corners: int) -> list[str]:
    """Compare the manifest's totals with the tiles."""
    boxes = np.array([tile["box"] for tile in manifest["tiles"]])
    found = {
        "points": sums.points,
        "triangles": sums.triangles,
        "duplicates": sums.points - sums.distinct,
        "hull": corners,
        "bounds": [*boxes[:, :2].min(axis=0).tolist(), *boxes[:, 2:].max(axis=0).tolist()],
    }
    if manifest["run"]["classes"] is None:
        found["rows"] = sums.points + manifest["dropped"]
    return [
        f"the manifest says {name} {manifest[name]} instead of {value}"
        for name, value in found.items()
        if value != manifest[name]
    ]


def _owned_twice(tin: TileFolder, spans: dict[int, tuple[int, int]]) -> list[str]:
    """Find rows that two tiles own, in one window of rows at a time."""
    faults = []
    last = max((high for _, high in spans.values()), default=-1)
    for start in range(0, last + 1, _WINDOW):
        inside = {t: s for t, s in spans.items() if s[0] < start + _WINDOW and s[1] >= start}
        seen = np.zeros(min(_WINDOW, last + 1 - start), dtype=bool)
        for number in inside:
            found = read_columns(tin.store.path(tile_names(number)[0]), {"id": "iu", "owned": "b"})
            ids = found["id"][found["owned"]].astype(np.int64) - start
            ids = ids[(ids >= 0) & (ids < len(seen))]
            if seen[ids].any():
                row = start + int(ids[seen[ids]][0])
                faults.append(f"row {row} is a point of tile {number} and of another tile")
            seen[ids] = True
    return faults


def _inner(tile: Tile, owner: Rows) -> list[str]:
    """Check a single tile: orientation, owners, inner edges."""
    found = []
    points, simplices = tile.points, tile.simplices
    a, b, c = (np.ascontiguousarray(points[simplices[:, k]]) for k in range(3))
    wrong = np.flatnonzero(_core.orient2d(a, b, c) <= 0)
    if len(wrong):
        found.append(f"tile {tile.number}: triangle {wrong[0]} is not counter-clockwise")
    if len(simplices) and (owner[simplices].min(axis=1) != tile.number).any():
        found.append(f"tile {tile.number} has a triangle of another tile")
    if (owner[tile.owned] != tile.number).any():
        found.append(f"tile {tile.number} has a point of another tile")
    if len(np.unique(tile.ids)) != len(tile.ids):
        found.append(f"tile {tile.number} has a vertex twice")
    t, k = np.nonzero((neighbors := _neighbors(tile, found)) >= 0)
    beyond = neighbors[t, k]
    once = t < beyond
    t, k, beyond = t[once], k[once], beyond[once]
    u, v = simplices[t, (k + 1) % 3], simplices[t, (k + 2) % 3]
    other = simplices[beyond]
    # One corner of each is enough: a triangle with a repeated corner would contain the edge in both
    # directions, one of which is that of its neighbor, so the neighborhood would be invalid.
    q = other[(other != u[:, None]) & (other != v[:, None])]
    a, b, c, d = (np.ascontiguousarray(points[w]) for w in (u, v, simplices[t, k], q))
    wrong = np.flatnonzero(_core.incircle(a, b, c, d, True) > 0)
    if len(wrong):
        pair = f"{t[wrong[0]]} and {beyond[wrong[0]]}"
        found.append(f"tile {tile.number}: the edge of triangles {pair} is not Delaunay")
    return found


def _neighbors(tile: Tile, found: list[str]) -> NDArray[np.int32]:
    try:
        return _core.neighbors2(tile.simplices, len(tile.points))
    except ValueError as error:
        found.append(f"tile {tile.number}: {error}")
        return np.full(tile.simplices.shape, -1, dtype=np.int32)


def _open_edges(tile: Tile) -> _Edges:
    """The edges of a tile with a triangle of the tile on one side only."""
    simplices = tile.simplices
    t, k = np.nonzero(_neighbors(tile, []) < 0)
    rows = np.stack([simplices[t, (k + j) % 3] for j in (1, 2, 0)], axis=1)
    ends = tile.ids[rows[:, :2]].astype(np.int64)
    return _Edges(ends, np.full(len(t), tile.number), tile.points[rows])


def _between(edges: _Edges, faults: list[str]) -> _Edges:
    """Match edges across tiles, check those that meet, and return the boundary."""
    ends = np.sort(edges.ends, axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    edges, ends = edges.at(order), ends[order]
    same = (ends[1:] == ends[:-1]).all(axis=1)
    first = np.flatnonzero(same)
    if (same[1:] & same[:-1]).any():
        faults.append("an edge has more than two triangles")
    one, two = edges.at(first), edges.at(first + 1)
    folded = np.flatnonzero((one.ends != two.ends[:, ::-1]).any(axis=1))
    if len(folded):
        tiles = one.tile[folded[0]], two.tile[folded[0]]
        faults.append(f"triangles of tiles {tiles[0]} and {tiles[1]} overlap")
    u, v, p = (np.ascontiguousarray(one.points[:, k]) for k in range(3))
    wrong = np.flatnonzero(_core.incircle(u, v, p, two.points[:, 2].copy(), True) > 0)
    if len(wrong):
        tiles = one.tile[wrong[0]], two.tile[wrong[0]]
        faults.append(f"an edge between tiles {tiles[0]} and {tiles[1]} is not Delaunay")
    alone = np.ones(len(ends), dtype=bool)
    alone[first] = alone[first + 1] = False
    return edges.at(alone)


def _around(boundary: _Edges, faults: list[str]) -> tuple[int, int]:
    """Check that the boundary is one convex cycle; return how many points and corners it has."""
    count = len(boundary.ends)
    after = dict(boundary.ends.tolist())
    at = dict(zip(boundary.ends[:, 0].tolist(), boundary.points[:, 0], strict=True))
    if len(after) != count or not count:
        faults.append("the boundary meets itself")
        return count, 0
    start = min(after, key=lambda v: tuple(at[v]))
    cycle, v = [start], after[start]
    while v != start and v in after and len(cycle) <= len(after):
        cycle.append(v)
        v = after[v]
    if v != start or len(cycle) != len(after):
        faults.append("the boundary is not a single cycle: there is a hole")
        return count, 0
    points = np.array([at[v] for v in cycle])
    ahead, beyond = np.roll(points, -1, axis=0), np.roll(points, -2, axis=0)
    # A total turn of 360 degrees: x increases once and decreases once.
    order = np.lexsort((np.arange(len(points)), points[:, 1], points[:, 0]))
    top = int(order[-1])
    rises = [tuple(p) < tuple(q) for p, q in zip(points, ahead, strict=True)]
    if rises != [i < top for i in range(len(points))]:
        faults.append("the boundary winds more than once")
    turns = _core.orient2d(points, ahead, beyond)
    if (turns < 0).any():
        faults.append("the boundary is not convex")
    return len(points), int((turns > 0).sum())


def _foreign(tile: Tile, owner: Rows) -> _Vertices:
    beside = np.flatnonzero(~tile.owned)
    ids, here = tile.ids[beside].astype(np.int64), np.full(len(beside), tile.number)
    return _Vertices(ids, tile.points[beside], here, owner[beside])


def _copies(tin: TileFolder, foreign: _Vertices) -> list[str]:
    """Check that vertices of other tiles are what their owners say."""
    faults = []
    for number in np.unique(foreign.owner).tolist():
        try:
            tile = read_tile(tin.store, tin.manifest, number)
        except FileFormatError:
            # Already reported.
            continue
        copies = foreign.at(foreign.owner == number)
        ids, points = tile.ids[tile.owned], tile.points[tile.owned]
        if not len(ids):
            continue
        order = np.argsort(ids)
        at = order[np.minimum(np.searchsorted(ids, copies.id, sorter=order), len(ids) - 1)]
        wrong = (ids[at] != copies.id) | (points[at] != copies.point).any(axis=1)
        if wrong.any():
            k = np.flatnonzero(wrong)[0]
            faults.append(
                f"vertex {copies.id[k]} of tile {copies.tile[k]} differs from that of tile {number}"
            )
    return faults
