"""The tasks of a run.

Each reads files of earlier ones and writes its own; the summary that it returns is small, and noted
last: a task that has its note is done.

Every task may be done again, by whom ever, at any time, and writes the same.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone.distributed.certify import Questions, corners_of
from delone.distributed.files import Store
from delone.distributed.hull import extreme_rows
from delone.distributed.layout import Layout, gather
from delone.distributed.merge import Border, advance, belongs, cut_out
from delone.distributed.output import write_tile
from delone.distributed.rows import coordinates
from delone.distributed.scatter import scatter
from delone.distributed.sources import Choice, Piece
from delone.distributed.usage import peak_memory

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from delone.distributed.layout import Slices

    Summary = dict[str, Any]

__all__ = ["MOST", "TASKS", "note_of", "perform"]

# Points that a tile tells of each circle. One makes rounds, many are sent in vain.
MOST = 4


def note_of(stage: str, key: int) -> str:
    """Return the name of the note that a task leaves."""
    return f"work/done/{stage}/{key:06}.json"


def perform(root: str, stage: str, key: int, arguments: Sequence[Any]) -> Summary:
    """Do a task, unless its note is there, and return its summary."""
    store = Store(root)
    found: Summary | None = store.noted(note_of(stage, key))
    if found is None:
        start = time.perf_counter()
        found = TASKS[stage.partition("-")[0]](store, key, *arguments)
        found |= {"seconds": time.perf_counter() - start, "memory": peak_memory()}
        store.note(note_of(stage, key), found)
    return found


def look(store: Store, key: int, piece: Piece, choice: Choice, share: float) -> Summary:
    """Look at a piece: its box, its extreme points, a sample, rows that are not finite.

    What is slow to read is written down for the next look.
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
    """Rows with finite coordinates, and the numbers of the others."""
    finite = np.isfinite(rows["x"]) & np.isfinite(rows["y"])
    return (rows, rows["id"][:0]) if finite.all() else (rows[finite], rows["id"][~finite])


def deal(store: Store, key: int, piece: Piece, choice: Choice) -> Summary:
    """Deal the points of a piece to the tiles; see `scatter`."""
    layout = Layout.load(store)
    staged = f"work/pieces/{key:06}.npy"
    rows = piece.read(choice) if piece.kind == "npy" else store.load(staged)
    rows, _ = _finite(rows)
    dealt, slices = scatter(rows, layout)
    store.save(f"work/parts/{key:06}.npy", dealt)
    return slices


def begin(store: Store, key: int, slices: Slices, threads: int) -> Summary:
    """Triangulate what a tile knows; keep what is certain, and ask about the rest."""
    layout = Layout.load(store)
    known = layout.known(store, key)
    rows, own = gather(store, slices, layout.hull)
    points = coordinates(rows)
    simplices, neighbors, twins, _ = _core.triangulate2(points, "auto", threads)
    foreign = rows[own:]
    owner = np.full(len(rows), key, dtype=np.int32)
    owner[own:] = layout.tiles.locate(points[own:])
    lowest, highest = _ends(simplices)
    needed = lowest < own
    certain = needed & known.certain(points, simplices, threads=threads)
    doubtful = np.flatnonzero(needed & ~certain)
    questions = known.questions(points, simplices[doubtful])
    asked = np.zeros(len(doubtful), dtype=bool)
    asked[questions.triangle] = True
    certain[doubtful[~asked]] = True
    # Who may be in conflict with a triangle of another tile: vertices that are not closed, and
    # neighbours of points of others.
    told = np.zeros(len(rows), dtype=bool)
    told[simplices[(needed & ~certain) | (highest >= own)]] = True
    store.save(f"work/told/{key:06}.npy", rows[:own][told[:own]])
    # All triangles without foreign corners belong to the tile.
    shared = certain & (highest >= own)
    mine = certain & ~shared
    mine[shared] = belongs(simplices[shared], owner, key)
    store.save(f"work/certain/{key:06}.npy", simplices[mine])
    summary = {"foreign": len(foreign), "twins": int((twins[:, 0] < own).sum()), "asked": []}
    if asked.any():
        vertices, edges = cut_out(simplices, neighbors, certain)
        pending = np.searchsorted(vertices, simplices[doubtful[asked]]).astype(np.int32)
        border = Border(rows[vertices], owner[vertices], edges, pending)
        number = np.cumsum(asked) - 1
        questions = Questions(number[questions.triangle], questions.tile)
        none = np.empty((0, 3), dtype=np.uint64)
        summary["asked"] = _ask(store, 0, key, border, questions, none, rows[:0])
    return summary


def _ends(simplices: Any) -> tuple[Any, Any]:
    """The least and the greatest vertex of each triangle, by columns: the axis is too short."""
    a, b, c = simplices.T
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def answer(store: Store, key: int, turn: int, askers: Sequence[int]) -> Summary:
    """Answer what other tiles have asked a tile in a round."""
    told = store.load(f"work/told/{key:06}.npy")
    points = coordinates(told)
    numbers, refuted, starts = [], [], []
    for asker in askers:
        with np.load(store.path(f"work/border/{turn:04}/{asker:06}.npz")) as asked:
            mine = asked["triangle"][asked["tile"] == key]
            corners = asked["corners"][mine]
        ends, rows, _ = _core.deepest2(points, corners, MOST, 1)
        numbers.append(np.unique(rows))
        refuted.append(mine[np.diff(ends) > 0])
        starts.append((len(numbers[-1]), len(refuted[-1])))
    arrays = {
        "askers": np.array(askers, dtype=np.int64),
        "counts": np.array(starts, dtype=np.int64).reshape(-1, 2),
        "rows": told[np.concatenate(numbers)],
        "refuted": np.concatenate(refuted),
    }
    store.save_all(f"work/answers/{turn:04}/{key:06}.npz", arrays)
    return {"told": len(arrays["rows"])}


def proceed(store: Store, key: int, turn: int, asked: Sequence[int]) -> Summary:
    """Take in the answers of a round, and ask about what is new."""
    layout = Layout.load(store)
    found = store.load_all(f"work/border/{turn:04}/{key:06}.npz")
    border = Border(found["rows"], found["owner"], found["edges"], found["pending"])
    news, refuted = [border.rows[:0]], np.zeros(len(border.pending), dtype=bool)
    for tile in asked:
        with np.load(store.path(f"work/answers/{turn:04}/{tile:06}.npz")) as told:
            place = int(np.flatnonzero(told["askers"] == key)[0])
            before, after = told["counts"][:place].sum(axis=0), told["counts"][: place + 1]
            end = after.sum(axis=0)
            news.append(told["rows"][before[0] : end[0]])
            refuted[told["refuted"][before[1] : end[1]]] = True
    known = layout.known(store, key)
    left, rows, certain, questions = advance(border, known, np.concatenate(news), refuted)
    owner = known.tiles.locate(coordinates(rows))
    mine = certain[belongs(certain, owner, key)]
    kept = np.concatenate([found["kept"], rows["id"][mine]])
    seen = np.concatenate([found["seen"], rows[np.unique(mine)]])
    if left is None or questions is None:
        store.save_all(f"work/closed/{key:06}.npz", {"kept": kept, "seen": seen})
        return {"foreign": len(rows) - len(border.rows), "asked": []}
    tiles = _ask(store, turn + 1, key, left, questions, kept, seen)
    return {"foreign": len(rows) - len(border.rows), "asked": tiles}


def _ask(  # noqa: PLR0917
    store: Store,
    turn: int,
    key: int,
    border: Border,
    questions: Questions,
    kept: Any,
    seen: Any,
) -> list[int]:
    """Write down a border with its questions; return the tiles that are asked."""
    arrays = {
        "rows": border.rows,
        "owner": border.owner,
        "edges": border.edges,
        "pending": border.pending,
        "corners": corners_of(coordinates(border.rows), border.pending),
        "triangle": questions.triangle,
        "tile": questions.tile,
        "kept": kept,
        "seen": seen,
    }
    store.save_all(f"work/border/{turn:04}/{key:06}.npz", arrays)
    tiles: list[int] = np.unique(questions.tile).tolist()
    return tiles


def finish(store: Store, key: int, slices: Slices, is_closed: bool) -> Summary:
    """Write the vertices and triangles of a tile."""
    layout = Layout.load(store)
    rows, own = gather(store, slices, layout.hull)
    certain = store.load(f"work/certain/{key:06}.npy")
    late = store.load_all(f"work/closed/{key:06}.npz") if is_closed else None
    return write_tile(store, key, rows, own, certain, late)


TASKS: dict[str, Callable[..., Summary]] = {
    "look": look,
    "deal": deal,
    "begin": begin,
    "answer": answer,
    "proceed": proceed,
    "finish": finish,
}
