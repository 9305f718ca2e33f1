"""One tile in memory, read from its two files.

Parquet declares the names and types of columns; this module checks that they are those of a tile,
and that corners, numbers and coordinates are in range. `proof` checks consistency between tiles.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.extras import require
from delone.distributed.store.output import tile_names
from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows
    from delone.distributed.store.files import Store

__all__ = ["Tile", "read_columns", "read_tile", "read_vertices"]

_WHAT = "reading tiles"
# Columns that are not attributes, with the kinds of their NumPy dtypes.
_VERTICES = {"id": "iu", "x": "f", "y": "f", "owned": "b"}
_TRIANGLES = dict.fromkeys("abc", "iu")


@dataclass(frozen=True, eq=False)
class Tile:
    """One tile in memory.

    Parameters
    ----------
    number : int
        The number of the tile.
    points : ndarray of float64, shape (n, 2)
        Its vertices: its own points, then points of other tiles.
    ids : ndarray of int64, shape (n,)
        Their rows in the source.
    owned : ndarray of bool, shape (n,)
        Whether the tile owns each point.
    simplices : ndarray of int32, shape (m, 3)
        Its triangles as rows of `points`, counter-clockwise.
    attributes : dict of str to ndarray
        Heights ``z`` and further columns, one value for each vertex.

    Examples
    --------
    >>> import tempfile
    >>> from delone import datasets, distributed
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     tin = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
    ...     tile = tin.tile(0)
    >>> tile.owned.tolist() == [True] * 100 + [False] * (len(tile.points) - 100)
    True
    """

    number: int
    points: Floats
    ids: Rows
    owned: NDArray[np.bool_]
    simplices: NDArray[np.int32]
    attributes: dict[str, NDArray[Any]]

    def _locator(self) -> _core.Locator2:
        """Return the point location index of the triangles."""
        neighbors = _core.neighbors2(self.simplices, len(self.points))
        return _core.Locator2(self.points, self.simplices, neighbors)


def read_tile(store: Store, manifest: Mapping[str, Any], number: int) -> Tile:
    """Read a tile, without comparing its figures with the manifest; errors name the wrong file."""
    of_triangles = store.path(tile_names(number)[1])
    names = [*(["z"] if manifest["heights"] else []), *manifest["attributes"]]
    points, vertices = read_vertices(store, manifest, number, names)
    triangles = read_columns(of_triangles, _TRIANGLES)
    simplices = np.stack([triangles[name] for name in "abc"], axis=1)
    held = (simplices >= 0) & (simplices < len(points))
    _require(held, of_triangles, "a, b or c", "is not a row of the vertices")
    return Tile(
        number,
        points,
        vertices["id"].astype(np.int64),
        vertices["owned"],
        simplices.astype(np.int32, copy=False),
        {name: vertices[name] for name in names},
    )


def read_vertices(
    store: Store, manifest: Mapping[str, Any], number: int, names: Sequence[str]
) -> tuple[Floats, dict[str, NDArray[Any]]]:
    """Read the vertices of a tile and some of their attributes, without its triangles."""
    path = store.path(tile_names(number)[0])
    found = read_columns(path, _VERTICES | dict.fromkeys(names, "biuf"))
    points = np.stack([found.pop("x"), found.pop("y")], axis=1).astype(np.float64, copy=False)
    _require(np.isfinite(points), path, "x or y", "is not finite")
    ids = found["id"]
    _require((ids >= 0) & (ids < manifest["rows"]), path, "id", "is not a row of the source")
    return points, found


def read_columns(path: Path, wanted: Mapping[str, str | Sequence[str]]) -> dict[str, NDArray[Any]]:
    """Read columns of a Parquet file of the output, each of a given NumPy kind, without gaps."""
    arrow = require("pyarrow", extra="dask", what=_WHAT)
    parquet = require("pyarrow.parquet", extra="dask", what=_WHAT)
    try:
        with parquet.ParquetFile(path) as file:
            names = file.schema_arrow.names
            if missing := [name for name in wanted if names.count(name) != 1]:
                raise FileFormatError(f"{path} has no column {missing[0]!r:.80}, or two")
            table = file.read(columns=list(wanted))
            columns = {name: table[name].to_numpy() for name in wanted}
            gaps = [name for name in wanted if table[name].null_count]
    except FileNotFoundError:
        raise FileFormatError(f"{path} is missing") from None
    except (FileFormatError, PermissionError):
        raise
    except (OSError, ValueError, arrow.ArrowException) as error:
        reason = str(error).partition("\n")[0]
        raise FileFormatError(f"{path} is truncated: {reason}") from error
    for name, kinds in wanted.items():
        if name in gaps or columns[name].dtype.kind not in kinds:
            found = "has gaps" if name in gaps else f"has dtype {columns[name].dtype}"
            raise FileFormatError(
                f"{path}: column {name!r:.80} {found}, which is invalid in a tile"
            )
    return columns


def _require(right: NDArray[np.bool_], path: Path, column: str, fault: str) -> None:
    """Reject a file and name the first invalid row."""
    if not right.all():
        rows = np.flatnonzero(~right.reshape(len(right), -1).all(axis=1))
        raise FileFormatError(f"{path}: {column} of row {rows[0]} {fault}")
