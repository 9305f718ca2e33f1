"""The files of a tile: its vertices and its triangles, as Parquet with pyarrow (extra ``dask``)."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.distributed.pure.rows import coordinates, first_of_each
from delone.distributed.store.files import digest

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Indices
    from delone.distributed.pure.rows import Rows
    from delone.distributed.store.files import Store

__all__ = ["box_of", "tile_names", "write_tile"]

_WHAT = "triangulating in tiles"


def tile_names(tile: int) -> tuple[str, str]:
    """Return the names of the files of a tile: vertices and triangles."""
    return f"vertices/tile={tile:06}.parquet", f"triangles/tile={tile:06}.parquet"


def write_tile(  # noqa: PLR0917
    store: Store,
    tile: int,
    rows: Rows,
    own: int,
    certain: Indices,
    late: dict[str, NDArray[Any]] | None,
    threads: int,
) -> dict[str, Any]:
    """Write the certain triangles of a tile, whose own rows come first in `rows`.

    `certain`, (m, 3), contains positions in `rows` and is overwritten. `late` contains triangles of
    later rounds: `kept`, as numbers in the source, and the `seen` rows of their vertices.
    """
    vertices, triangles = _joined(rows, own, certain, late)
    points = coordinates(vertices)
    sides = {name: triangles[:, k].copy() for k, name in enumerate("abc")}
    with ThreadPoolExecutor(min(2, threads)) as pool:
        hashes = pool.map(
            partial(_write_table, store), tile_names(tile), (_columns(vertices, own), sides)
        )
        vertices_hash, triangles_hash = hashes
    return {
        "points": own,
        "foreign": len(vertices) - own,
        "triangles": len(triangles),
        # Vertices of triangles may lie far outside the box of the points of the tile.
        "box": box_of(points[:own]),
        "extent": box_of(points) if len(triangles) else None,
        "vertices_sha256": vertices_hash,
        "triangles_sha256": triangles_hash,
    }


def _joined(
    rows: Rows, own: int, certain: Indices, late: dict[str, NDArray[Any]] | None
) -> tuple[Rows, Indices]:
    """All vertices, own rows first, foreign ones in the order of the source; all triangles."""
    used = np.zeros(len(rows), dtype=bool)
    # Corners of other tiles are few, and own ones keep their positions.
    corners = certain.reshape(-1)
    other = np.flatnonzero(corners >= own)
    used[corners[other]] = True
    beside = rows[used]
    if late is not None:
        seen = late["seen"]
        beside = np.concatenate([beside, seen[_places(rows["id"][:own], seen["id"]) < 0]])
    beside = first_of_each(beside)
    vertices = np.concatenate([rows[:own], beside])
    corners[other] = own + np.searchsorted(beside["id"], rows["id"][corners[other]])
    if late is None:
        return vertices, certain
    return vertices, np.concatenate([certain, _numbered(late["kept"], vertices["id"], own)])


def _numbered(ids: NDArray[np.uint64], known: NDArray[np.uint64], own: int) -> Indices:
    """The positions of numbers among known ones, which ascend up to `own` and again after it."""
    mine = _places(known[:own], ids)
    found: Indices = np.where(mine >= 0, mine, own + np.searchsorted(known[own:], ids))
    return found.astype(np.int32)


def _places(known: NDArray[np.uint64], ids: NDArray[np.uint64]) -> NDArray[np.int64]:
    """The positions of numbers among known ones, which ascend; -1 for missing ones.

    Binary search, not sorting or hashing: few numbers are looked up among all of a tile.
    """
    at = np.searchsorted(known, ids)
    return np.where(known[np.minimum(at, len(known) - 1)] == ids, at, -1)


def _columns(vertices: Rows, own: int) -> dict[str, NDArray[Any]]:
    names = vertices.dtype.names or ()
    columns = {name: np.ascontiguousarray(vertices[name]) for name in names}
    return columns | {"owned": np.arange(len(vertices)) < own}


def _write_table(store: Store, name: str, columns: dict[str, NDArray[Any]]) -> str:
    """Write a table; return its hash."""
    arrow = require("pyarrow", extra="dask", what=_WHAT)
    parquet = require("pyarrow.parquet", extra="dask", what=_WHAT)
    table = arrow.table({name: _as_arrow(arrow, column) for name, column in columns.items()})
    with store.writing(name) as temporary:
        # Coordinates and numbers rarely repeat, so dictionary encoding would be useless.
        parquet.write_table(
            table, temporary, use_dictionary=False, compression="lz4", row_group_size=1 << 20
        )
    return digest(store.path(name))


def _as_arrow(arrow: Any, column: NDArray[Any]) -> Any:
    """Wrap a column in place: `arrow.array` would import pandas, which takes longer than a tile."""
    kind = arrow.from_numpy_dtype(column.dtype)
    bits = np.packbits(column, bitorder="little") if column.dtype == bool else column
    return arrow.Array.from_buffers(kind, len(column), [None, arrow.py_buffer(bits)])


def box_of(points: NDArray[np.float64]) -> list[float]:
    """Return left, bottom, right and top of points."""
    x, y = points.T
    return [float(x.min()), float(y.min()), float(x.max()), float(y.max())]
