"""Points in tables: Parquet, GeoParquet, Arrow and Feather with pyarrow (extra ``geo``).

Only the columns of the coordinates are read. A Parquet file with geometries is read as GeoParquet.
"""

from __future__ import annotations

import json
import sys
from contextlib import contextmanager
from decimal import Decimal, localcontext
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_points
from delone._base.extras import require
from delone._base.files import no_layers, unread
from delone._base.values import as_values
from delone.errors import DeloneError, FileFormatError, InputError
from delone.io.pointset import PointSet, choose_columns, find_column
from delone.io.systems import check_system
from delone.io.vector import from_frame, geometries_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone.io.geometryset import GeometrySet

# Decimal digits that every double keeps, and the largest power of ten that is a double.
_DIGITS, _LARGEST_EXACT_POWER = 15, 22
# The number of digits that fit into 128 bits, and a bit more than fit into 256.
_WIDEST, _DIGITS_OF_DECIMALS = 38, 100

__all__ = ["holds_geometries", "look", "read_geometries", "read_points", "read_range"]


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    everything: bool = False,
) -> PointSet:
    """Read points from a table; see `delone.io.read_points`."""
    wanted = None if everything else attributes
    with _corrupt_is_an_error(path):
        if path.suffix.lower() == ".parquet":
            return _parquet(path, columns, wanted)
        return _feather(path, columns, wanted)


def holds_geometries(path: Path) -> bool:
    """Return whether a file is GeoParquet."""
    with _corrupt_is_an_error(path):
        if path.suffix.lower() != ".parquet":
            return False
        parquet = require("pyarrow.parquet", extra="geo", what="reading Parquet")
        with parquet.ParquetFile(path) as file:
            return b"geo" in (file.schema_arrow.metadata or {})


def read_geometries(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    layer: str | None,
    attributes: Sequence[str] = (),
    everything: bool = False,
) -> GeometrySet:
    """Read points, lines and areas from GeoParquet; see `delone.io.read_geometries`."""
    if layer is not None:
        raise no_layers(path)
    if not holds_geometries(path):
        raise FileFormatError(f"{path} is a table without geometries")
    with _corrupt_is_an_error(path):
        wanted = None if everything else attributes
        frame = _frame(path)
        return geometries_of(frame, columns=columns, source=str(path), attributes=wanted)


def look(
    path: Path, *, columns: Sequence[str | int] | None, attributes: Sequence[str]
) -> tuple[int, bool]:
    """Return the number of rows of a Parquet file without geometries, and whether it has heights.

    Raise an error for columns that the file does not have.
    """
    with _corrupt_is_an_error(path):
        parquet = require("pyarrow.parquet", extra="geo", what="reading Parquet")
        with parquet.ParquetFile(path) as file:
            kept = _coordinates(file.schema_arrow, columns, path)
            _known(file.schema_arrow, attributes, path)
            return int(file.metadata.num_rows), len(kept) == 3


def read_range(
    path: Path,
    start: int,
    stop: int,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
) -> PointSet:
    """Read the rows from `start` to before `stop` of a Parquet file without geometries.

    In addition, at most one row group is in memory.
    """
    with _corrupt_is_an_error(path):
        arrow = require("pyarrow", extra="geo", what="reading Parquet")
        parquet = require("pyarrow.parquet", extra="geo", what="reading Parquet")
        with parquet.ParquetFile(path) as file:
            kept = _coordinates(file.schema_arrow, columns, path)
            names = _known(file.schema_arrow, attributes, path)
            wanted = list(dict.fromkeys([*kept, *names]))
            parts, end = [], 0
            for group in range(file.num_row_groups):
                begin, end = end, end + int(file.metadata.row_group(group).num_rows)
                if begin < stop and start < end:
                    part = file.read_row_group(group, columns=wanted)
                    low = max(0, start - begin)
                    parts.append(part.slice(low, min(stop, end) - begin - low))
            return _from_table(arrow.concat_tables(parts), kept, names, str(path))


@contextmanager
def _corrupt_is_an_error(path: Path) -> Iterator[None]:
    require("pyarrow", extra="geo", what=f"reading {path.suffix}")
    source = str(path)
    try:
        yield
    except InputError as error:
        raise FileFormatError(f"{source}: {error}") from error
    except (DeloneError, FileNotFoundError, PermissionError):
        raise
    except MemoryError as error:
        # Compressed columns begin with their size, which nothing in the file verifies.
        raise MemoryError(
            f"{source} declares more than fits into memory; it may be corrupt"
        ) from error
    except Exception as error:
        raise unread(source, path.suffix, error) from error


def _parquet(
    path: Path, columns: Sequence[str | int] | None, attributes: Sequence[str] | None
) -> PointSet:
    parquet = require("pyarrow.parquet", extra="geo", what="reading Parquet")
    with parquet.ParquetFile(path) as file:
        schema = file.schema_arrow
        if b"geo" not in (schema.metadata or {}):
            kept = _coordinates(schema, columns, path)
            names = _wanted(schema, attributes, kept, path)
            return _from_table(file.read(columns=[*kept, *names]), kept, names, str(path))
    return from_frame(_frame(path), columns=columns, attributes=attributes, source=str(path))


def _frame(path: Path) -> Any:
    """Read GeoParquet whose reference systems refer to nothing else."""
    parquet = require("pyarrow.parquet", extra="geo", what="reading Parquet")
    geopandas = require("geopandas", extra="geo", what="reading GeoParquet")
    with path.open("rb") as file:
        with parquet.ParquetFile(file) as table:
            columns = json.loads(table.schema_arrow.metadata[b"geo"])["columns"]
        for column in columns.values():
            check_system(column.get("crs"), str(path))
        file.seek(0)
        # An open file, because geopandas looks for URLs in names.
        return geopandas.read_parquet(file)


def _feather(
    path: Path, columns: Sequence[str | int] | None, attributes: Sequence[str] | None
) -> PointSet:
    arrow = require("pyarrow", extra="geo", what="reading Arrow")
    with arrow.memory_map(str(path)) as mapped:
        try:
            table = arrow.ipc.open_file(mapped).read_all()
        except arrow.ArrowInvalid:
            mapped.seek(0)
            table = arrow.ipc.open_stream(mapped).read_all()
        kept = _coordinates(table.schema, columns, path)
        names = _wanted(table.schema, attributes, kept, path)
        return _from_table(table, kept, names, str(path))


def _coordinates(schema: Any, columns: Sequence[str | int] | None, path: Path) -> list[str]:
    """The names of the columns of x, y and, if there is one, z, which hold numbers."""
    types = require("pyarrow.types", extra="geo", what="reading tables")
    tests = (types.is_integer, types.is_floating, types.is_decimal)
    numbers = [field.name for field in schema if any(test(field.type) for test in tests)]
    return [numbers[i] for i in choose_columns(numbers, columns, str(path), named=True)]


def _wanted(
    schema: Any, attributes: Sequence[str] | None, kept: Sequence[str], path: Path
) -> list[str]:
    """Return the names of the attributes: by default all columns that are not coordinates."""
    if attributes is not None:
        return _known(schema, attributes, path)
    return [name for name in schema.names if name not in kept]


def _known(schema: Any, attributes: Sequence[str], path: Path) -> list[str]:
    names = list(schema.names)
    return [names[find_column(names, name, str(path))] for name in attributes]


def _from_table(table: Any, kept: list[str], attributes: list[str], source: str) -> PointSet:
    x, y, *z = (_column(table, name) for name in kept)
    for name in attributes:
        if table.column(name).null_count:
            _refuse_large_integers(table.column(name), name)
    return PointSet(
        points=as_points(np.column_stack((x, y))),
        z=as_values(z[0], len(x)) if z else None,
        attributes={name: np.array(table.column(name).to_numpy()) for name in attributes},
        source=source,
        columns=tuple(kept),
    )


def _column(table: Any, name: str) -> NDArray[Any]:
    """Return a column as doubles; missing values are NaN, so that errors name their rows."""
    column = table.column(name)
    _refuse_large_integers(column, name)
    types = require("pyarrow.types", extra="geo", what="reading tables")
    if types.is_decimal(column.type):
        return _nearest_doubles(column, name)
    values: NDArray[Any] = column.to_numpy()
    return values.astype(np.float64, copy=False)


def _nearest_doubles(column: Any, name: str) -> NDArray[np.float64]:
    """Return the doubles nearest to the decimals; pyarrow's cast would round twice.

    Raises for digits that doubles cannot distinguish; 15 digits always work.
    """
    arrow = require("pyarrow", extra="geo", what="reading tables")
    scale = column.type.scale
    parts = [np.empty(0)]
    for chunk in column.chunks:
        there = chunk.is_valid().to_numpy(zero_copy_only=False)
        found = np.full(len(chunk), np.nan)
        few, digits = _few_digits(arrow, chunk)
        few &= there
        if 0 <= scale <= _LARGEST_EXACT_POWER:
            # Both are doubles, so the quotient is rounded only once.
            found[few] = digits[few] / 10.0**scale
            there &= ~few
        for row in np.flatnonzero(there).tolist():
            found[row] = _nearest_double(chunk[row].as_py(), scale, name)
        parts.append(found)
    return np.concatenate(parts)


def _few_digits(arrow: Any, chunk: Any) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Return which decimals have at most 15 digits, and their digits as integers."""
    none = np.zeros(len(chunk), dtype=bool), np.zeros(len(chunk), dtype=np.int64)
    if not len(chunk) or chunk.type.precision > _WIDEST:
        return none
    wide = chunk.cast(arrow.decimal128(_WIDEST, chunk.type.scale))
    words = np.frombuffer(wide.buffers()[1], dtype=np.int64).reshape(-1, 2)
    words = words[wide.offset : wide.offset + len(wide)]
    low, high = words.T if sys.byteorder == "little" else words[:, ::-1].T
    few: NDArray[np.bool_] = (high == low >> 63) & (low < 10**_DIGITS) & (low > -(10**_DIGITS))
    return few, low


def _nearest_double(value: Decimal, scale: int, name: str) -> float:
    nearest = float(value)
    with localcontext(prec=_DIGITS_OF_DECIMALS):
        back = Decimal(nearest).quantize(Decimal((0, (1,), -scale)))
    if back != value:
        raise InputError(
            f"column {name!r:.40} has the value {value}, with more digits than a double keeps: "
            "round the column to fewer digits, or subtract an offset"
        )
    return nearest


def _refuse_large_integers(column: Any, name: str) -> None:
    """Reject integers beyond 2**53 that become doubles: coordinates, and columns with gaps."""
    types = require("pyarrow.types", extra="geo", what="reading tables")
    if not types.is_integer(column.type):
        return
    values = column.drop_null().to_numpy()
    if len(values) and (int(values.max()) > 1 << 53 or int(values.min()) < -(1 << 53)):
        raise InputError(
            f"column {name!r:.40} has integers beyond 2**53, which a double cannot represent"
        )
