"""Lidar points: LAS and LAZ with laspy and lazrs (extra ``las``).

Records are read in blocks, and only the requested part of each block is kept, so that the memory
needed beyond the coordinates is that of one block. Coordinates are scaled exactly as laspy does.
"""

from __future__ import annotations

import re
import struct
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.extras import require
from delone._base.files import unread
from delone.errors import DeloneError, FileFormatError
from delone.io.copc import is_copc, nodes_within
from delone.io.dem import as_bounds
from delone.io.pointset import PointSet
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

Box = tuple[float, float, float, float]

__all__ = ["describe", "look", "read_points", "read_range", "read_within", "require_some"]

_BLOCK = 1 << 19
# Writers put 50,000 points into a chunk; the decoder allocates memory for the whole chunk.
_LONGEST_CHUNK = 10_000_000
# Number of layers of the LAZ item types for point formats 6 and later: points, colors, near
# infrared, waveforms. Extra bytes have one layer each.
_LAYERED = 3
_LAYERS = {10: 9, 11: 1, 12: 2, 13: 1}
# Sizes in bytes, from the LAS specification 1.4, R15.
_LONGEST_HEADER, _RECORD_HEADER, _LONG_RECORD_HEADER = 375, 54, 60
# Size of the description of a dimension of extra bytes.
_EXTRA_BYTES = 192
# The minimum size of a header for each minor version; before 1.3 it is 227.
_HEADER, _HEADERS = 227, {3: 235, 4: 375}


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    classes: Sequence[int] | None,
    everything: bool = False,
    bounds: Sequence[float] | None = None,
) -> PointSet:
    """Read points from a LAS or LAZ file; see `delone.io.read_points`."""
    box = as_bounds(bounds)
    if columns is not None:
        raise FileFormatError(
            f"{path}: LAS files always have the coordinates x, y and z; columns cannot be chosen"
        )
    found = read_within(path, attributes, classes, box, everything=everything)
    require_some(path, len(found), classes, box)
    return found


def read_within(
    path: Path,
    attributes: Sequence[str],
    classes: Sequence[int] | None,
    box: Box | None,
    *,
    everything: bool = False,
    count: int | None = None,
) -> PointSet:
    """Read the points of some classes in a box, perhaps none, of a file with `count` points."""
    laspy = _laspy(path)
    _check_records(path)
    with _corrupt_is_an_error(path), laspy.open(path) as file:
        _check_claim(path, file)
        has = int(file.header.point_count)
        if count not in (None, has):
            raise FileFormatError(f"{path} has {has} points, and the octree says {count}")
        if everything:
            names = file.header.point_format.dimension_names
            attributes = [name for name in names if name not in ("X", "Y", "Z")]
        _check_names(path, file.header, attributes)
        points, z, further = _read(_source(path, file, box), classes, attributes, box)
        crs = _crs(path, file.header)
    return PointSet(points=points, z=z, attributes=further, crs=crs, source=str(path))


def require_some(path: Path, count: int, classes: Sequence[int] | None, box: Box | None) -> None:
    """Reject a choice that leaves none of the points of a file."""
    if not count and box is not None:
        raise FileFormatError(f"{path} contains no points inside bounds={box}" + _of(classes))
    if not count and classes is not None:
        wanted = ", ".join(map(str, classes))
        raise FileFormatError(
            f"{path} contains no points of class {wanted}; delone info lists its classes"
        )


def describe(path: Path) -> dict[str, Any]:
    """Return facts from the header: version, point format, scales, names of dimensions."""
    laspy = _laspy(path)
    _check_records(path)
    with _corrupt_is_an_error(path), laspy.open(path) as file:
        header = file.header
        return {
            "las_version": str(header.version),
            "point_format": int(header.point_format.id),
            "scales": [float(scale) for scale in header.scales],
            "dimensions": list(header.point_format.dimension_names),
        }


def look(path: Path, *, attributes: Sequence[str]) -> tuple[int, str | None]:
    """Return the number of points that a file has room for, and its reference system.

    Raises for attributes that the file does not have.
    """
    laspy = _laspy(path)
    _check_records(path)
    with _corrupt_is_an_error(path), laspy.open(path) as file:
        _check_claim(path, file)
        _check_names(path, file.header, attributes)
        return int(file.header.point_count), _crs(path, file.header)


def read_range(path: Path, start: int, stop: int, *, attributes: Sequence[str]) -> PointSet:
    """Read the records from `start` to before `stop` of a file that `look` has checked."""
    laspy = _laspy(path)
    with _corrupt_is_an_error(path), laspy.open(path) as file:
        if _has_chunks_of_any_size(file.header):
            block = _from_chunks(path, file.header, start, stop)
        else:
            file.seek(start)
            block = file.read_points(stop - start)
        if len(block) != stop - start:
            raise FileFormatError(f"{path} has no records {start + len(block)} to {stop}")
        x, y, z = _scaled(block)
        further = {name: np.array(block[name]) for name in attributes}
        return PointSet(points=np.column_stack([x, y]), z=z, attributes=further, source=str(path))


def _scaled(block: Any) -> tuple[NDArray[np.float64], ...]:
    """Coordinates of records; infinite or NaN results of bad scales are rejected later."""
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(block.x), np.asarray(block.y), np.asarray(block.z)


def _has_chunks_of_any_size(header: Any) -> bool:
    """Return whether the chunks have different numbers of points, as in COPC files."""
    if not header.are_points_compressed:
        return False
    lazrs = require("lazrs", extra="las", what="reading LAZ")
    return bool(lazrs.LazVlr(_laz_record(header)).uses_variable_size_chunks())


def _laz_record(header: Any) -> bytes:
    """The record that describes how the points are compressed."""
    record: bytes = header.vlrs.get("LasZipVlr")[0].record_data
    return record


def _from_chunks(path: Path, header: Any, start: int, stop: int) -> Any:
    """Decode the chunks that contain given records; the decoder's own seek is wrong here."""
    laspy = _laspy(path)
    lazrs = require("lazrs", extra="las", what="reading LAZ")
    record = _laz_record(header)
    table = _chunk_table(path, header)
    ends = np.cumsum(table, axis=0)
    first, last = np.searchsorted(ends[:, 0], [start, stop - 1], side="right").tolist()
    some = table[first : last + 1]
    before, skipped = (ends[first] - table[first]).tolist()
    with path.open("rb") as file:
        file.seek(int(header.offset_to_point_data) + 8 + skipped)
        data = file.read(int(some[:, 1].sum()))
    kind = header.point_format
    decoded = bytearray(int(some[:, 0].sum()) * int(kind.size))
    lazrs.decompress_points_with_chunk_table(data, record, decoded, list(map(tuple, some.tolist())))
    records = laspy.PackedPointRecord.from_buffer(decoded, kind).array[
        start - before : stop - before
    ]
    return laspy.ScaleAwarePointRecord(records, kind, scales=header.scales, offsets=header.offsets)


def _chunk_table(path: Path, header: Any) -> NDArray[np.int64]:
    """Return the numbers of points and bytes of the chunks that contain points, (k, 2)."""
    lazrs = require("lazrs", extra="las", what="reading LAZ")
    with path.open("rb") as file:
        file.seek(int(header.offset_to_point_data))
        vlr = lazrs.LazVlr(_laz_record(header))
        table = np.array(lazrs.read_chunk_table(file, vlr), dtype=np.int64).reshape(-1, 2)
    found: NDArray[np.int64] = table[table[:, 0] > 0]
    return found


def _laspy(path: Path) -> Any:
    laspy = require("laspy", extra="las", what="reading LAS")
    if path.suffix.lower() == ".laz":
        require("lazrs", extra="las", what="reading LAZ")
    return laspy


def _check_names(path: Path, header: Any, names: Sequence[str]) -> None:
    known = set(header.point_format.dimension_names)
    unknown = [name for name in names if name not in known]
    if unknown:
        raise FileFormatError(
            f"{path} has no {unknown[0]!r:.80}; it has {', '.join(sorted(known))}" + _unnamed(path)
        )


def _unnamed(path: Path) -> str:
    """Return why the extra bytes have no names, if the record about them is unreadable."""
    head = _head(path)
    (start,), (before, count) = (
        struct.unpack_from("<H", head, 94),
        struct.unpack_from("<II", head, 96),
    )
    with path.open("rb") as file:
        for _ in range(count):
            if start + _RECORD_HEADER > before:
                break
            file.seek(start)
            user, number, length = struct.unpack_from("<2x16sHH", file.read(_RECORD_HEADER))
            if (user.rstrip(b"\0"), number) == (b"LASF_Spec", 4) and length % _EXTRA_BYTES:
                return (
                    f"; its record of extra bytes has {length} bytes, not a multiple of "
                    f"{_EXTRA_BYTES}, so they have no names, and are in ExtraBytes"
                )
            start += _RECORD_HEADER + length
    return ""


@contextmanager
def _corrupt_is_an_error(path: Path) -> Iterator[None]:
    try:
        yield
    except (DeloneError, FileNotFoundError, PermissionError, KeyboardInterrupt, MemoryError):
        raise
    except BaseException as error:
        # A panic of the Rust decoder is not an Exception; everything else must propagate.
        if not isinstance(error, Exception) and type(error).__name__ != "PanicException":
            raise
        reason = str(error).partition("\n")[0] or type(error).__name__
        if "Incoherent point size" in reason:
            has, says = [*re.findall(r"\d+", reason), "other", "other"][:2]
            raise FileFormatError(
                f"{path}: its record of extra bytes describes points of {says} bytes, but points "
                f"have {has}: remove or repair that record (LASF_Spec, number 4), such as with "
                "laspy or PDAL"
            ) from error
        raise unread(path, "LAS", error) from error


def _check_records(path: Path) -> None:
    """Compare the numbers of records before and after the points with the space for them.

    A reader that trusts a count of four billion records loops for minutes.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(_LONGEST_HEADER).ljust(_LONGEST_HEADER, b"\0")
        if head[:4] != b"LASF":
            raise FileFormatError(f"{path} is not a LAS file: it does not begin with LASF")
        _check_version(path, head)
        before, count = struct.unpack_from("<II", head, 96)
        wrong = before > size or count * _RECORD_HEADER > before
        if head[25] >= 4:
            start, count = struct.unpack_from("<QI", head, 235)
            wrong = wrong or _end_of_records(file, start, count, size) > size
    if wrong:
        raise FileFormatError(f"{path} is truncated: it has no room for the records it declares")


def _check_version(path: Path, head: bytes) -> None:
    """Reject a header whose version is wrong, because its counts would be elsewhere."""
    minor, (size,) = head[25], struct.unpack_from("<H", head, 94)
    least = _HEADERS.get(minor, _HEADER)
    if size < least:
        raise FileFormatError(
            f"{path}: its header says LAS 1.{minor} and has {size} bytes, not {least} or more: "
            "the version or the size is wrong"
        )
    if struct.unpack_from("<I", head, 96)[0] < size:
        raise FileFormatError(f"{path} is corrupt: its points begin within its header")


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(_LONGEST_HEADER).ljust(_LONGEST_HEADER, b"\0")


def _check_both_counts(path: Path) -> None:
    """Compare the 32-bit and 64-bit counts that headers have from version 1.4 on."""
    head = _head(path)
    (old,), (count,) = struct.unpack_from("<I", head, 107), struct.unpack_from("<Q", head, 247)
    if head[25] >= 4 and old not in (0, count):
        raise FileFormatError(
            f"{path} declares {old} points in one field of its header and {count} in another"
        )


def _end_of_points(path: Path) -> int:
    """Return the last possible end of the point records: where something else begins."""
    size, head = path.stat().st_size, _head(path)
    begin, ends = int.from_bytes(head[96:100], "little"), [size]
    if head[25] >= 3:
        ends.append(struct.unpack_from("<Q", head, 227)[0])  # waveforms
    if head[25] >= 4:
        ends.append(struct.unpack_from("<Q", head, 235)[0])  # long records
    return min((end for end in ends if begin <= end <= size), default=begin)


def _end_of_records(file: IO[bytes], start: int, count: int, size: int) -> int:
    """Follow the extended records after the points, as far as they are in the file."""
    for _ in range(count):
        if start + _LONG_RECORD_HEADER > size:
            return size + 1
        file.seek(start + 20)
        start += _LONG_RECORD_HEADER + int.from_bytes(file.read(8), "little")
    return start if count else 0


def _check_claim(path: Path, file: Any) -> None:
    """Compare the number of records in the header with what the file can contain."""
    header = file.header
    count = int(header.point_count)
    if header.are_points_compressed:
        least, held = _compressed_records(path, header)
        if count < least:
            raise FileFormatError(
                f"{path} declares {count} points and contains {least} or more: its header is wrong"
            )
    else:
        record = int(header.point_format.size)
        held = (_end_of_points(path) - int(header.offset_to_point_data)) // record
        if count < held:
            raise FileFormatError(
                f"{path} declares {count} points and contains {held}: its header is wrong"
            )
    if count > held:
        raise FileFormatError(
            f"{path} declares {count} points and has room for {held}: it is truncated"
        )
    _check_both_counts(path)


def _compressed_records(path: Path, header: Any) -> tuple[int, int]:
    """Return the smallest and the largest number of records in the chunks of a LAZ file."""
    lazrs = require("lazrs", extra="las", what="reading LAZ")
    record = _laz_record(header)
    vlr = lazrs.LazVlr(record)
    if not vlr.uses_variable_size_chunks() and vlr.chunk_size() > _LONGEST_CHUNK:
        raise FileFormatError(f"{path} is corrupt: chunks of {vlr.chunk_size()} points")
    with path.open("rb") as file:
        size = path.stat().st_size
        file.seek(int(header.offset_to_point_data))
        (table,) = struct.unpack("<q", file.read(8))
        if not header.offset_to_point_data < table <= size - 8:
            raise FileFormatError(f"{path} is truncated: its chunk table is missing")
        file.seek(table)
        _, chunks = struct.unpack("<II", file.read(8))
        # A chunk begins with one uncompressed record.
        if chunks > size // vlr.item_size() + 1:
            raise FileFormatError(f"{path} is corrupt: it declares {chunks} chunks")
        file.seek(int(header.offset_to_point_data))
        held = lazrs.read_chunk_table(file, vlr)
        # The decoder allocates memory for these sizes.
        if sum(int(length) for _, length in held) > size:
            raise FileFormatError(f"{path} is truncated: its chunks are longer than the file")
        start = int(header.offset_to_point_data) + 8
        # Writers that end a chunk at the end of the file add an empty one.
        _check_layers(file, record, start, [int(length) for points, length in held if points])
    if vlr.uses_variable_size_chunks():
        count = sum(int(points) for points, _ in held)
        return count, count
    # The last chunk may be short, and some writers add an empty one after it.
    full = sum(length > 0 for _, length in held) - 1
    return max(0, full * int(vlr.chunk_size()) + 1), int(chunks * vlr.chunk_size())


def _check_layers(file: IO[bytes], record: bytes, start: int, lengths: Sequence[int]) -> None:
    """Compare the sizes of the layers at the head of each chunk with the length of the chunk.

    Formats 6 and later store dimensions in separate layers, whose sizes the decoder trusts.
    """
    compressor, items = struct.unpack_from("<H30xH", record)
    if compressor != _LAYERED:
        return
    kinds = [struct.unpack_from("<HH", record, 34 + 6 * i) for i in range(items)]
    layers = sum(_LAYERS.get(kind, size) for kind, size in kinds)
    # One uncompressed record, the number of records, the sizes.
    before = sum(size for _, size in kinds) + 4
    for length in lengths:
        file.seek(start + before)
        sizes = np.frombuffer(file.read(4 * layers), dtype="<u4")
        if before + 4 * layers + int(sizes.sum(dtype=np.int64)) > length:
            raise FileFormatError(f"{file.name} is corrupt: a chunk is shorter than its layers")
        start += length


class _Source(NamedTuple):
    """Records in blocks, and how many there are at most."""

    most: int
    blocks: Iterator[Any]


def _of(classes: Sequence[int] | None) -> str:
    return "" if classes is None else f" of class {', '.join(map(str, classes))}"


def _source(path: Path, file: Any, box: Box | None) -> _Source:
    """Return the records of a file; for a COPC file, only those of nodes that meet a box."""
    header = file.header
    if box is None or not is_copc(header):
        return _Source(int(header.point_count), file.chunk_iterator(_BLOCK))
    table = _chunk_table(path, header)
    ends = np.cumsum(table, axis=0)
    starts = int(header.offset_to_point_data) + 8 + ends[:, 1] - table[:, 1]
    some = np.flatnonzero(nodes_within(path, header, starts, box))
    blocks = (_from_chunks(path, header, *(ends[k, 0] - (table[k, 0], 0)).tolist()) for k in some)
    return _Source(int(table[some, 0].sum()), blocks)


def _read(
    source: _Source,
    classes: Sequence[int] | None,
    attributes: Sequence[str],
    box: Box | None,
) -> tuple[NDArray[np.float64], NDArray[np.float64], dict[str, NDArray[Any]]]:
    # Pages of these arrays that are never written cost nothing, so no second copy is needed.
    points, z = np.empty((source.most, 2)), np.empty(source.most)
    further: dict[str, list[NDArray[Any]]] = {name: [] for name in attributes}
    end = 0
    for block in source.blocks:
        x, y, heights = _scaled(block)
        keep: Any = slice(None)
        if classes is not None:
            keep = np.isin(np.asarray(block["classification"]), list(classes))
        if box is not None:
            left, bottom, right, top = box
            inside = (x >= left) & (x <= right) & (y >= bottom) & (y <= top)
            keep = inside if classes is None else keep & inside
        x, y, heights = x[keep], y[keep], heights[keep]
        start, end = end, end + len(x)
        points[start:end, 0], points[start:end, 1], z[start:end] = x, y, heights
        for name, parts in further.items():
            parts.append(np.array(block[name])[keep])
    if classes is None and box is None and end != source.most:
        raise FileFormatError(f"the header declares {source.most} points, but there are {end}")
    points.resize((end, 2), refcheck=False)
    z.resize(end, refcheck=False)
    # Blocks without points still have the right type.
    return points, z, {name: np.concatenate(parts) for name, parts in further.items() if parts}


def _crs(path: Path, header: Any) -> str | None:
    """Return the reference system as authority and code, or as WKT; None if there is none."""
    names = [
        str(record.string)
        for record in header.vlrs
        if type(record).__name__ == "WktCoordinateSystemVlr"
    ]
    for name in names:
        check_system(name.rstrip("\0"), str(path))
    try:
        crs = header.parse_crs()
    except Exception:  # pyproj is not needed for the points, and records are often invalid
        crs = None
    if crs is not None:
        return str(crs.to_string())
    return next((name.rstrip("\0") for name in names if name), None)
