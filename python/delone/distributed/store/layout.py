"""The layout of a run on disk, the extents of its tiles, and the initial rows of a tile."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from delone.distributed.pure.certify import Known
from delone.distributed.pure.layout import Layout
from delone.distributed.pure.rows import coordinates, first_of_each
from delone.distributed.pure.tiles import Tiles

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from delone.distributed.pure.rows import Rows
    from delone.distributed.store.files import Store

# Runs of rows: piece, start, stop; own rows and those of the halo.
Slices: TypeAlias = tuple[list[list[int]], list[list[int]]]

__all__ = ["Slices", "collect", "gather", "known_to", "load_layout", "save_layout"]

_FILE = "work/layout.npz"
_EXTENTS = "work/extents.npy"


def save_layout(store: Store, layout: Layout) -> None:
    """Write the layout of a run."""
    tiles = layout.tiles
    arrays: dict[str, NDArray[Any]] = {
        "axis": tiles.axis,
        "cut": tiles.cut,
        "children": tiles.children,
        "cells": tiles.cells,
        "strips": layout.strips,
        "hull": layout.hull,
    }
    store.save_all(_FILE, arrays)


def load_layout(store: Store) -> Layout:
    """Read the layout of a run."""
    found = store.load_all(_FILE)
    tiles = Tiles(found["axis"], found["cut"], found["children"], found["cells"])
    return Layout(tiles, found["strips"], found["hull"])


def known_to(store: Store, layout: Layout, tile: int) -> Known:
    """Return what a tile knows about the other tiles."""
    return Known(tile, layout.strips[tile], layout.tiles, store.load(_EXTENTS))


def collect(
    store: Store, tiles: int, dealt: Iterable[tuple[int, dict[str, Any]]]
) -> tuple[list[Slices], NDArray[np.int64]]:
    """Regroup the summaries of pieces by tile: the runs of each tile, and its number of points.

    The boxes of the points of all tiles, without corners of the hull, are stored as well.
    """
    slices: list[Slices] = [([], []) for _ in range(tiles)]
    counts = np.zeros(tiles, dtype=np.int64)
    extents = np.tile([np.inf, np.inf, -np.inf, -np.inf], (tiles, 1))
    for piece, summary in dealt:
        for (tile, start, stop), box in zip(summary["own"], summary["boxes"], strict=True):
            slices[tile][0].append([piece, start, stop])
            counts[tile] += stop - start
            if box is None:
                continue
            np.minimum(extents[tile, :2], box[:2], out=extents[tile, :2])
            np.maximum(extents[tile, 2:], box[2:], out=extents[tile, 2:])
        for tile, start, stop in summary["halo"]:
            slices[tile][1].append([piece, start, stop])
    if not store.exists(_EXTENTS):
        store.save(_EXTENTS, extents)
    return slices, counts


def gather(store: Store, slices: Slices, layout: Layout, tile: int) -> tuple[Rows, int]:
    """Return the initial rows of a tile, its own first, and the number of its own.

    Own rows are in the order of the source, then halo and hull in theirs: of rows with equal
    coordinates, the first is the first of the source.
    """
    own, halo = slices
    hull = layout.hull
    other = layout.tiles.locate(coordinates(hull)) != tile
    beside = first_of_each(np.concatenate([*(_run(store, *run) for run in halo), hull[other]]))
    count = sum(stop - start for _, start, stop in own)
    rows = np.empty(count + len(beside), dtype=layout.type)
    end = 0
    # One file at a time is mapped, because its pages count as memory.
    for run in own:
        some = _run(store, *run)
        rows[end : end + len(some)] = some
        end += len(some)
    rows[count:] = beside
    return rows, count


def _run(store: Store, piece: int, start: int, stop: int) -> Rows:
    return store.load(f"work/parts/{piece:06}.npy", mapped=True)[start:stop]
