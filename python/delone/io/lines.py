"""Lines with columns as a layer of a GeoPackage, written as blocks of Arrow arrays.

GDAL takes geometries as WKB (OGC Simple Features 1.2.1, section 8): a header of nine bytes, then
the coordinates. The bytes of all lines of a block are made at once, without an object for each.
"""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.extras import require
from delone.io.vector import plain_name, require_index, system_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows

__all__ = ["LineBlock", "write_line_layer"]

# Points in a block: 6 MB of WKB.
_BLOCK = 1 << 18
# The type of a line with heights, and its header: byte order, type, number of points.
_LINE_Z = 1002
_HEADER = np.dtype([("order", "u1"), ("type", "<u4"), ("count", "<u4")])
_POINT = np.dtype(("<f8", 3))
# The file has a temporary name until it is complete, so neither the journal nor the disk's cache
# matters before.
_UNSAFE = {"OGR_SQLITE_SYNCHRONOUS": "OFF", "OGR_SQLITE_JOURNAL": "OFF"}


class LineBlock(NamedTuple):
    """Some lines, each at one height, and their columns."""

    points: Floats  # (p, 2), one line after another
    starts: Rows  # the start of each line, and the end of the last
    z: Floats  # the height of each line
    columns: Mapping[str, NDArray[Any]]

    def in_blocks(self) -> Iterator[LineBlock]:
        """Yield the lines in blocks of about `_BLOCK` points, at least one line in each."""
        count = len(self.starts) - 1
        marks = np.arange(_BLOCK, int(self.starts[-1]), _BLOCK)
        cuts = np.unique(np.searchsorted(self.starts[1:], marks, side="right"))
        for first, last in zip((0, *cuts), (*cuts, count), strict=True):
            if first < last:
                begin, end = self.starts[first], self.starts[last]
                rows = slice(first, last)
                yield LineBlock(
                    self.points[begin:end],
                    self.starts[first : last + 1] - begin,
                    self.z[rows],
                    {name: values[rows] for name, values in self.columns.items()},
                )


def write_line_layer(
    path: Path,
    parts: Iterable[LineBlock],
    *,
    layer: str,
    crs: str | None,
    dtypes: Mapping[str, str],
) -> None:
    """Write lines with heights to a GeoPackage in place, and verify that all of it is in the file.

    `dtypes` has the NumPy type of each column. Only one of the parts is in memory at a time.
    """
    pyogrio = require("pyogrio", extra="geo", what="writing geometries")
    pa = require("pyarrow", extra="geo", what="writing geometries")
    types = {name: pa.from_numpy_dtype(dtype) for name, dtype in dtypes.items()}
    schema = pa.schema({"geom": pa.large_binary()} | types)
    failed: list[BaseException] = []
    blocks = _batches(pa, parts, schema, failed)
    with _settings(pyogrio), warnings.catch_warnings():
        # A survey without a reference system is common and needs no warning.
        warnings.filterwarnings("ignore", message=".*crs.*")
        system = _for_gdal(crs, path)
        try:
            pyogrio.write_arrow(
                pa.RecordBatchReader.from_batches(schema, blocks),
                plain_name(path),
                layer=layer,
                driver="GPKG",
                geometry_name="geom",
                geometry_type="LineString Z",
                crs=system,
            )
        finally:
            # GDAL would report an error of the parts as one of the file.
            if failed:
                raise failed[0]
    require_index(pyogrio, plain_name(path), layer)


def _for_gdal(crs: str | None, path: Path) -> str | None:
    """Return a reference system as pyogrio hands it to GDAL."""
    system = system_of(crs, path.suffix.lower())
    if system is None:
        return None
    code = system.to_epsg()
    return f"EPSG:{code}" if code else str(system.to_wkt("WKT1_GDAL"))


def _batches(
    pa: Any, parts: Iterable[LineBlock], schema: Any, failed: list[BaseException]
) -> Iterator[Any]:
    """Yield record batches; an error, such as Ctrl-C, is added to `failed`."""
    try:
        for part in parts:
            for block in part.in_blocks():
                yield _batch(pa, block, schema)
    except BaseException as error:
        failed.append(error)
        raise


def _batch(pa: Any, block: LineBlock, schema: Any) -> Any:
    """Return lines as a record batch."""
    count = len(block.z)
    content, ends = line_wkb(block.points, block.starts, block.z)
    buffers = [None, pa.py_buffer(ends), pa.py_buffer(content)]
    geometries = pa.Array.from_buffers(pa.large_binary(), count, buffers)
    columns = [pa.array(block.columns[name]) for name in schema.names[1:]]
    return pa.record_batch([geometries, *columns], schema=schema)


def line_wkb(points: Floats, starts: Rows, z: Floats) -> tuple[NDArray[np.uint8], Rows]:
    """Return the WKB of lines, one after another, and the start of each and the end of the last."""
    count, lines = np.diff(starts), np.arange(len(z))
    at = _HEADER.itemsize * np.arange(len(starts)) + _POINT.itemsize * (starts - starts[0])
    content = np.empty(int(at[-1]), dtype=np.uint8)
    header = np.empty(len(z), dtype=_HEADER)
    header["order"], header["type"], header["count"] = 1, _LINE_Z, count
    _put(content, at[:-1], header)
    line = np.repeat(lines, count)
    found = np.empty((len(points), 3), dtype="<f8")
    found[:, :2], found[:, 2] = points, z[line]
    place = _HEADER.itemsize * (line + 1) + _POINT.itemsize * np.arange(len(points))
    _put(content, place, found.view("V24").ravel())
    return content, at.astype(np.int64)


def _put(content: NDArray[np.uint8], at: Rows, values: NDArray[Any]) -> None:
    """Copy values to places in bytes, without alignment."""
    size = values.dtype.itemsize
    if len(values):
        shape = (len(content) - size + 1,)
        windows = np.ndarray(shape, dtype=f"V{size}", buffer=content, strides=(1,))
        windows[at] = values.view(f"V{size}")


@contextmanager
def _settings(pyogrio: Any) -> Iterator[None]:
    """Set GDAL's options for files that are not yet complete, and restore them."""
    before = {name: pyogrio.get_gdal_config_option(name) for name in _UNSAFE}
    pyogrio.set_gdal_config_options(_UNSAFE)
    try:
        yield
    finally:
        pyogrio.set_gdal_config_options(before)
