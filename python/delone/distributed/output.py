"""The files of a tile: its vertices and its triangles, as Parquet by pyarrow (extra ``dask``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.distributed.files import digest
from delone.distributed.rows import coordinates, first_of_each
from delone.io.extras import require

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from delone.distributed.files import Store
    from delone.distributed.rows import Rows

    Indices = NDArray[np.int32]

__all__ = ["tile_names", "write_tile"]

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
) -> dict[str, Any]:
    """Write what has become certain of a tile.

    Parameters
    ----------
    store : Store
        Where.
    tile : int
        The number of the tile.
    rows : ndarray of records
        What the tile knew at first, its own rows in front.
    own : int
        How many these are.
    certain : ndarray of int32, shape (m, 3)
        Triangles of the first round, as positions in `rows`.
    late : dict or None
        Triangles of later rounds, ``kept``, as numbers in the source, and the ``seen`` rows of
        their vertices.
    """
    vertices, triangles = _joined(rows, own, certain, late)
    points = coordinates(vertices)
    names = tile_names(tile)
    _write_table(store, names[0], _columns(vertices, own))
    _write_table(store, names[1], {n: triangles[:, k].copy() for k, n in enumerate("abc")})
    return {
        "points": own,
        "foreign": len(vertices) - own,
        "triangles": len(triangles),
        # The vertices of triangles may lie far out of the box of the tile's points.
        "box": _box(points[:own]),
        "extent": _box(points) if len(triangles) else None,
        "vertices_sha256": digest(store.path(names[0])),
        "triangles_sha256": digest(store.path(names[1])),
    }


def _joined(
    rows: Rows, own: int, certain: Indices, late: dict[str, NDArray[Any]] | None
) -> tuple[Rows, Indices]:
    """All vertices, own rows first, foreign ones in the order of the source; all triangles."""
    used = np.zeros(len(rows), dtype=bool)
    # Corners of other tiles are few, and own ones stay where they are.
    other = certain >= own
    used[certain[other]] = True
    beside = rows[used]
    if late is not None:
        seen = late["seen"]
        mine = rows["id"][:own]
        beside = np.concatenate([beside, seen[~np.isin(seen["id"], mine)]])
    beside = first_of_each(beside)
    vertices = np.concatenate([rows[:own], beside])
    place = np.arange(len(rows), dtype=np.int32)
    place[used] = own + np.searchsorted(beside["id"], rows["id"][used])
    triangles = certain.copy()
    triangles[other] = place[certain[other]]
    if late is not None:
        triangles = np.concatenate([triangles, _numbered(late["kept"], vertices["id"], own)])
    return vertices, triangles


def _numbered(ids: NDArray[np.uint64], known: NDArray[np.uint64], own: int) -> Indices:
    """The positions of numbers among known ones, which ascend up to `own` and again from there."""
    mine, beside = known[:own], known[own:]
    at = np.searchsorted(mine, ids)
    is_mine = mine[np.minimum(at, own - 1)] == ids
    found: Indices = np.where(is_mine, at, own + np.searchsorted(beside, ids)).astype(np.int32)
    return found


def _columns(vertices: Rows, own: int) -> dict[str, NDArray[Any]]:
    names = vertices.dtype.names or ()
    columns = {name: np.ascontiguousarray(vertices[name]) for name in names}
    return columns | {"owned": np.arange(len(vertices)) < own}


def _write_table(store: Store, name: str, columns: dict[str, NDArray[Any]]) -> None:
    arrow = require("pyarrow", extra="dask", what=_WHAT)
    parquet = require("pyarrow.parquet", extra="dask", what=_WHAT)
    table = arrow.table(columns)
    with store.writing(name) as beside:
        # Coordinates and numbers hardly ever come again: a dictionary of them is lost work.
        _write_parquet(parquet, table, beside)


def _write_parquet(parquet: Any, table: Any, path: Path) -> None:
    parquet.write_table(
        table, path, use_dictionary=False, compression="lz4", row_group_size=1 << 20
    )


def _box(points: NDArray[np.float64]) -> list[float]:
    x, y = points.T
    return [float(x.min()), float(y.min()), float(x.max()), float(y.max())]
