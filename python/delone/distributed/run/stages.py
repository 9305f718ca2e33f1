"""The tasks of a run.

Each task reads files of earlier ones and writes its own. Its summary is small and stored in a note,
which is written last: a task with a note is done.

Every task is idempotent: any worker may repeat it at any time, and it writes the same files.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone.distributed.pure.certify import corners_of
from delone.distributed.pure.hull import extreme_rows
from delone.distributed.pure.merge import Border, advance, belongs, cut_out
from delone.distributed.pure.rows import coordinates
from delone.distributed.pure.scatter import scatter
from delone.distributed.run.sources import Choice, Piece
from delone.distributed.run.usage import peak_memory
from delone.distributed.store.files import Store
from delone.distributed.store.layout import gather, known_to, load_layout
from delone.distributed.store.output import write_tile

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from delone.distributed.store.layout import Slices

    Summary = dict[str, Any]

__all__ = ["MOST", "TASKS", "note_of", "perform"]

# Points that a tile returns per circle: with one, there are more rounds; with many, most are
# useless.
MOST = 16


def note_of(stage: str, key: int) -> str:
    """Return the name of the note of a task."""
    return f"work/done/{stage}/{key:06}.json"


def perform(root: str, stage: str, key: int, arguments: Sequence[Any]) -> Summary:
    """Perform a task, unless its note exists, and return its summary."""
    store = Store(root)
    found: Summary | None = store.noted(note_of(stage, key))
    if found is None:
        start = time.perf_counter()
        found = TASKS[stage.partition("-")[0]](store, key, *arguments)
        found |= {"seconds": time.perf_counter() - start, "memory": peak_memory()}
        store.note(note_of(stage, key), found)
    return found


def look(store: Store, key: int, piece: Piece, choice: Choice, share: float) -> Summary:
    """Scan a piece: its box, its extreme points, a sample, rows that are not finite.

    Data that are slow to read are stored for the next stage.
    """
    staged = f"work/pieces/{key:06}.npy"
    rows = store.load(staged) if piece.kind == "array" else piece.read(choice)
    rows, bad = _finite(rows)
    points = coordinates(rows)
    if piece.kind not in ("array", "npy"):
        store.save(staged, rows)
    dice = np.random.default_rng([5, key])
    chosen = dice.random(len(rows)) < share if share < 1 else np.ones(len(rows), dtype=bool)
    arrays = {"sample": points[chosen], "hull": extreme_rows(rows)}
    store.save_all(f"work/looks/{key:06}.npz", arrays)
    return {"rows": len(rows), "bad": bad[:10].tolist(), "bad_count": len(bad)}


def _finite(rows: Any) -> tuple[Any, Any]:
    """Rows with finite coordinates and heights, and the numbers of the others."""
    finite = np.isfinite(rows["x"]) & np.isfinite(rows["y"])
    if "z" in rows.dtype.names:
        finite &= np.isfinite(rows["z"])
    return (rows, rows["id"][:0]) if finite.all() else (rows[finite], rows["id"][~finite])


def deal(store: Store, key: int, piece: Piece, choice: Choice) -> Summary:
    """Distribute the points of a piece to the tiles; see `scatter`."""
    layout = load_layout(store)
    staged = f"work/pieces/{key:06}.npy"
    rows = piece.read(choice) if piece.kind == "npy" else store.load(staged)
    rows, _ = _finite(rows)
    dealt, slices = scatter(rows, layout)
    store.save(f"work/parts/{key:06}.npy", dealt)
    return slices


def begin(store: Store, key: int, slices: Slices, threads: int) -> Summary:
    """Triangulate the points that a tile knows; keep the certain triangles, query the rest."""
    layout = load_layout(store)
    known = known_to(store, layout, key)
    rows, own = gather(store, slices, layout, key)
    points = coordinates(rows)
    made = _core.triangulate2(points, "auto", threads)
    simplices, neighbors, twins = made.simplices, made.neighbors, made.duplicates
    owner = np.full(len(rows), key, dtype=np.int32)
    owner[own:] = layout.tiles.locate(points[own:])
    # Nearly all triangles are certain and have only own corners; the following is for the rest.
    certain = known.certain(points, simplices, own, threads=threads)
    rest = np.flatnonzero(~certain)
    some = simplices.take(rest, axis=0)
    triangle, tile = known.questions(points, simplices, rest[(some < own).any(axis=1)])
    certain[rest] = (some < own).any(axis=1)
    certain[triangle] = False
    # Vertices that may be in conflict with a triangle of another tile: those that are not closed,
    # and neighbors of points of other tiles.
    told = np.zeros(len(rows), dtype=bool)
    told[some[(some >= own).any(axis=1)]] = told[simplices[triangle]] = True
    store.save(f"work/told/{key:06}.npy", rows.take(np.flatnonzero(told[:own])))
    # A triangle without foreign corners belongs to the tile.
    mine = certain.copy()
    mine[rest] &= belongs(some, owner, key)
    written = simplices.take(np.flatnonzero(mine), axis=0)
    if len(triangle):
        store.save(f"work/certain/{key:06}.npy", written)
        border = cut_out(rows, owner, simplices, neighbors, certain)
        kept = np.empty((0, 3), dtype=np.uint64)
        _ask(store, 0, key, border, corners_of(points, simplices[triangle]), tile, kept, rows[:0])
    else:
        # A tile without queries is finished.
        del points, simplices, neighbors
        summary = write_tile(store, key, rows, own, written, None, threads)
        store.note(note_of("finish", key), summary | {"memory": peak_memory()})
    return {
        "foreign": len(rows) - own,
        "twins": int((twins[:, 0] < own).sum()),
        "asked": np.unique(tile).tolist(),
    }


def answer(store: Store, key: int, turn: int, askers: Sequence[int]) -> Summary:
    """Answer the queries of other tiles to a tile in a round."""
    told = store.load(f"work/told/{key:06}.npy")
    points = coordinates(told)
    numbers, is_all = [], []
    for asker in askers:
        asked = store.load_all(f"work/border/{turn:04}/{asker:06}.npz", "corners", "tile")
        corners = asked["corners"][asked["tile"] == key]
        found = _core.deepest2(points, corners, MOST, 1)
        numbers.append(np.unique(found.rows))
        is_all.append(found.complete.all())
    arrays = {
        "askers": np.array(askers, dtype=np.int64),
        "ends": np.cumsum([0, *map(len, numbers)]),
        "rows": told[np.concatenate(numbers)],
        "all": np.array(is_all, dtype=bool),
    }
    store.save_all(f"work/answers/{turn:04}/{key:06}.npz", arrays)
    return {"told": len(arrays["rows"])}


def proceed(store: Store, key: int, turn: int, asked: Sequence[int]) -> Summary:
    """Insert the answers of a round, and query about new triangles."""
    layout = load_layout(store)
    found = store.load_all(f"work/border/{turn:04}/{key:06}.npz")
    border = Border(found["rows"], found["owner"], found["edges"])
    news, partial = [], []
    for tile in asked:
        told = store.load_all(f"work/answers/{turn:04}/{tile:06}.npz")
        place = int(np.flatnonzero(told["askers"] == key)[0])
        news.append(told["rows"][slice(*told["ends"][place : place + 2])])
        if not told["all"][place]:
            partial.append(tile)
    known = known_to(store, layout, key)
    fresh = np.concatenate(news)
    left, rows, certain, corners, tiles = advance(border, known, fresh, partial)
    owner = known.tiles.locate(coordinates(rows))
    mine = certain[belongs(certain, owner, key)]
    kept = np.concatenate([found["kept"], rows["id"][mine]])
    seen = np.concatenate([found["seen"], rows[np.unique(mine)]])
    if left is None:
        store.save_all(f"work/closed/{key:06}.npz", {"kept": kept, "seen": seen})
    else:
        _ask(store, turn + 1, key, left, corners, tiles, kept, seen)
    return {"foreign": len(fresh), "asked": np.unique(tiles).tolist()}


def _ask(  # noqa: PLR0917
    store: Store,
    turn: int,
    key: int,
    border: Border,
    corners: Any,
    tile: Any,
    kept: Any,
    seen: Any,
) -> None:
    """Store a border and the queries about it."""
    arrays = {
        "rows": border.rows,
        "owner": border.owner,
        "edges": border.edges,
        "corners": corners,
        "tile": tile,
        "kept": kept,
        "seen": seen,
    }
    store.save_all(f"work/border/{turn:04}/{key:06}.npz", arrays)


def finish(store: Store, key: int, slices: Slices, threads: int) -> Summary:
    """Write the vertices and triangles of a tile that queried others."""
    layout = load_layout(store)
    rows, own = gather(store, slices, layout, key)
    certain = store.load(f"work/certain/{key:06}.npy")
    late = store.load_all(f"work/closed/{key:06}.npz")
    return write_tile(store, key, rows, own, certain, late, threads)


TASKS: dict[str, Callable[..., Summary]] = {
    "look": look,
    "deal": deal,
    "begin": begin,
    "answer": answer,
    "proceed": proceed,
    "finish": finish,
}
