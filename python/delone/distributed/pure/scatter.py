"""Distribution of the source: each point goes to its tile, and copies go to initial halos."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.distributed.pure.rows import coordinates, widen

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats
    from delone.distributed.pure.layout import Layout
    from delone.distributed.pure.rows import Rows

__all__ = ["scatter"]


def scatter(rows: Rows, layout: Layout) -> tuple[Rows, dict[str, Any]]:
    """Sort the rows of a piece by tile, own rows first, then copies for halos; and the ranges.

    ``own`` and ``halo`` are lists of tile, start and stop; each run is in the order of the source.
    ``boxes`` are left, bottom, right and top of own runs, ignoring corners of the hull, which all
    tiles know; None if there are no others.
    """
    if rows.dtype != layout.type:
        rows = widen(rows, layout.type)
    corner = _corners(rows, layout.hull)
    tile = layout.tiles.locate(coordinates(rows))
    # A radix sort, as long as tile numbers fit into 16 bits.
    narrow = tile.astype(np.uint16) if len(layout.tiles) <= 1 << 16 else tile
    order = np.argsort(narrow, kind="stable")
    own, tile, corner = rows.take(order), tile.take(order), corner.take(order)
    first = np.flatnonzero(np.diff(tile, prepend=-1))
    # No run, and so no end, in a piece without rows.
    ends = np.append(first, len(tile))[1:]
    runs = [[int(tile[a]), int(a), int(b)] for a, b in zip(first, ends, strict=True)]
    columns = own["x"].copy(), own["y"].copy()
    boxes = []
    copies: dict[int, list[NDArray[np.int64]]] = {}
    for number, start, stop in runs:
        x, y = (column[start:stop] for column in columns)
        low, high = np.array([x.min(), y.min()]), np.array([x.max(), y.max()])
        boxes.append(_box(x, y, ~corner[start:stop]))
        near = (layout.strips[:, :2] <= high).all(axis=1) & (layout.strips[:, 2:] >= low).all(
            axis=1
        )
        for other in np.flatnonzero(near).tolist():
            if other != number:
                strip = layout.strips[other]
                within = (x >= strip[0]) & (x <= strip[2]) & (y >= strip[1]) & (y <= strip[3])
                copies.setdefault(other, []).append(start + np.flatnonzero(within))
    halo, parts, end = [], [own], len(own)
    for other in sorted(copies):
        chosen = np.concatenate(copies[other])
        chosen = chosen[np.argsort(own["id"][chosen], kind="stable")]
        if len(chosen):
            halo.append([other, end, end + len(chosen)])
            parts.append(own.take(chosen))
            end += len(chosen)
    return np.concatenate(parts), {"own": runs, "halo": halo, "boxes": boxes}


def _corners(rows: Rows, hull: Rows) -> Bools:
    """Which rows, in the order of the source, are corners of the hull."""
    corner = np.zeros(len(rows), dtype=bool)
    place = np.searchsorted(rows["id"], hull["id"])
    place = place[place < len(rows)]
    corner[place[np.isin(rows["id"][place], hull["id"])]] = True
    return corner


def _box(x: Floats, y: Floats, counts: Bools) -> list[float] | None:
    """Left, bottom, right and top of the points selected by `counts`."""
    if not counts.any():
        return None
    if not counts.all():
        x, y = x[counts], y[counts]
    return [float(x.min()), float(y.min()), float(x.max()), float(y.max())]
