"""VTU: points, cells, point values, markers and regions, read with Python's XML parser.

Arrays are text, or binary, inline or appended, raw or in base64, uncompressed or compressed by zlib
or LZMA. What an array declares is compared with the bytes that follow before memory is allocated,
and it is decompressed to at most the declared size.
"""

from __future__ import annotations

import base64
import itertools
import lzma
import re
import zlib
from typing import TYPE_CHECKING, Any, TypedDict
from xml.etree import ElementTree

import numpy as np

from delone._base.bounded import largest
from delone._base.files import corrupt, unread
from delone.errors import FileFormatError
from delone.io.cells import POLYGONS, SOLIDS, Cells, ReadMesh, name_of_polygon
from delone.io.markup import decoded, refuse_document_type
from delone.io.numbered import as_markers

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["POLYGON", "cells_of", "numbers_of", "read"]

_TYPES = {
    **{"Float32": "f4", "Float64": "f8", "Int8": "i1", "Int16": "i2", "Int32": "i4"},
    **{"Int64": "i8", "UInt8": "u1", "UInt16": "u2", "UInt32": "u4", "UInt64": "u8"},
}
_HEADERS = {"UInt32": "u4", "UInt64": "u8"}
_ORDERS = {"LittleEndian": "<", "BigEndian": ">"}
# Names of VTK's cell types; 7 is a polygon.
_NAMES = {
    **{1: "vertex", 3: "line", 4: "polyline", 5: "triangle", 6: "triangle strip", 8: "pixel"},
    **{9: "quad", 10: "tetra", 11: "voxel", 12: "hexahedron", 13: "wedge", 14: "pyramid"},
    **{21: "line3", 22: "triangle6", 23: "quad8", 24: "tetra10", 42: "polyhedron"},
}
POLYGON = 7
_APPENDED = re.compile(rb"<AppendedData[^>]*\sencoding\s*=\s*[\"']raw[\"'][^>]*>\s*_")
_END = b"</AppendedData>"
# An LZMA dictionary of the highest preset takes 65 MiB.
_MEMORY = 1 << 28


def read(path: Path) -> ReadMesh:
    """Read the points and cells of all pieces of a file."""
    refuse_document_type(path)
    root, raw = _tree(path)
    if root.tag != "VTKFile" or root.get("type") != "UnstructuredGrid":
        raise FileFormatError(
            f"{path} is not a .vtu file: it is {root.get('type', root.tag)!r:.60}, not a VTKFile "
            "of an UnstructuredGrid"
        )
    arrays = _Arrays(root, raw, path)
    pieces = [_piece(piece, arrays, path) for piece in root.findall("UnstructuredGrid/Piece")]
    if not pieces:
        raise FileFormatError(f"{path} has no Piece")
    before = np.cumsum([0, *(len(piece.points) for piece in pieces)]).tolist()
    cells = [
        Cells(block.type, block.data + start)
        for piece, start in zip(pieces, before, strict=False)
        for block in piece.cells
    ]
    shared = set.intersection(*(set(piece.point_data) for piece in pieces))
    values = {
        name: np.concatenate([piece.point_data[name] for piece in pieces])
        for name in pieces[0].point_data
        if name in shared
    }
    points = np.concatenate([piece.points for piece in pieces])
    return ReadMesh(
        points=points,
        cells=cells,
        point_data=values,
        markers=_joined([piece.markers for piece in pieces]),
        regions=_joined([piece.regions for piece in pieces]),
    )


def _joined(numbers: list[NDArray[np.int32] | None]) -> NDArray[np.int32] | None:
    """Return the numbers of all pieces; None where one has none."""
    found = [each for each in numbers if each is not None]
    return np.concatenate(found) if len(found) == len(numbers) else None


def _tree(path: Path) -> tuple[Any, bytes | None]:
    """Return the elements of a file, and its raw data, which are not XML."""
    with decoded(path) as (file, encoding):
        content = file.read()
    found, raw = _APPENDED.search(content), None
    if found:
        end = content.rfind(_END)
        if end < found.end():
            raise FileFormatError(f"{path} is truncated: its appended data have no end")
        content, raw = content[: found.end()] + content[end:], content[found.end() : end]
    try:
        return ElementTree.fromstring(content, ElementTree.XMLParser(encoding=encoding)), raw
    except (ElementTree.ParseError, LookupError, ValueError) as error:
        raise unread(path, ".vtu", error) from error


def _piece(piece: Any, arrays: _Arrays, path: Path) -> ReadMesh:
    counts = [piece.get(name, "") for name in ("NumberOfPoints", "NumberOfCells")]
    place = piece.find("Points/DataArray")
    points = np.empty((0, 3)) if place is None else arrays.table(place)
    own = {each.get("Name", ""): each for each in piece.findall("Cells/DataArray")}
    if place is None or not {"connectivity", "offsets", "types"} <= own.keys():
        raise FileFormatError(
            f"{path} is truncated: a Piece declares {counts[0]:.20} points and {counts[1]:.20} "
            "cells and has no Points or no Cells"
        )
    corners, ends, types = (
        arrays.integers(own[name]) for name in ("connectivity", "offsets", "types")
    )
    if [each.strip().lstrip("0") or "0" for each in counts] != [str(len(points)), str(len(types))]:
        raise FileFormatError(
            f"{path} declares {counts[0]:.20} points and {counts[1]:.20} cells and has "
            f"{len(points)} and {len(types)}: it is truncated"
        )
    cells = cells_of(corners, ends, types, path)
    values = {
        each.get("Name", ""): arrays.table(each) for each in piece.findall("PointData/DataArray")
    }
    values = {name: found[:, 0] if found.shape[1] == 1 else found for name, found in values.items()}
    if any(len(found) != len(points) for found in values.values()):
        raise FileFormatError(f"{path} is corrupt: the numbers of points and of values differ")
    named = {each.get("Name"): each for each in piece.findall("CellData/DataArray")}
    of_cells = {name: arrays.table(named[name]) for name in ("marker", "region") if name in named}
    return ReadMesh(
        points=points.astype(np.float64),
        cells=cells,
        point_data=values,
        **numbers_of(cells, of_cells, path),
    )


class Numbers(TypedDict):
    """The markers of polygons and the regions of tetrahedra, as `ReadMesh` has them."""

    markers: NDArray[np.int32] | None
    regions: NDArray[np.int32] | None


def numbers_of(cells: list[Cells], values: Mapping[str, NDArray[Any]], path: Path) -> Numbers:
    """Return the cell values named marker and region.

    They are those of triangles and polygons, and of tetrahedra, in their order. Vectors do not
    count.
    """
    return {
        "markers": _own(cells, POLYGONS, values.get("marker"), "marker", path),
        "regions": _own(cells, SOLIDS, values.get("region"), "region", path),
    }


def _own(
    cells: list[Cells],
    kinds: tuple[str, ...],
    values: NDArray[Any] | None,
    what: str,
    path: Path,
) -> NDArray[np.int32] | None:
    """Return the values of the cells of some kinds as integers."""
    if values is None or values.shape[1:] not in ((), (1,)):
        return None
    count = sum(len(block.data) for block in cells)
    if len(values) != count:
        raise FileFormatError(f"{path} is corrupt: it has {count} cells and {len(values)} {what}s")
    start, found = 0, [np.empty((0, 1))]
    for block in cells:
        stop = start + len(block.data)
        if block.type in kinds:
            found.append(values[start:stop].reshape(-1, 1).astype(np.float64))
        start = stop
    return as_markers(np.concatenate(found), path, what).ravel()


def cells_of(
    corners: NDArray[np.int64], ends: NDArray[np.int64], types: NDArray[np.int64], path: Path
) -> list[Cells]:
    """Return blocks of cells of one type and number of corners, in the order of the file."""
    sizes = np.diff(ends, prepend=0)
    if len(ends) != len(types) or (sizes < 0).any() or (len(ends) and ends[-1] != len(corners)):
        raise FileFormatError(
            f"{path} is corrupt: the offsets of its cells do not match their corners"
        )
    if not len(types):
        return []
    changes = 1 + np.flatnonzero((np.diff(types) != 0) | (np.diff(sizes) != 0))
    bounds = [0, *changes.tolist(), len(types)]
    found = []
    for start, stop in itertools.pairwise(bounds):
        kind, size = int(types[start]), int(sizes[start])
        block = corners[ends[stop - 1] - size * (stop - start) : ends[stop - 1]]
        name = name_of_polygon(size) if kind == POLYGON else _NAMES.get(kind, f"VTK type {kind}")
        found.append(Cells(name, block.reshape(stop - start, size)))
    return found


class _Arrays:
    """The arrays of a file: how they are written, and how much may be decompressed."""

    def __init__(self, root: Any, raw: bytes | None, path: Path) -> None:
        self.path = path
        header, order = root.get("header_type", "UInt32"), root.get("byte_order", "LittleEndian")
        if header not in _HEADERS or order not in _ORDERS:
            raise FileFormatError(f"{path} has the header {header!r:.20} or order {order!r:.20}")
        self._order = _ORDERS[order]
        self._header = np.dtype(self._order + _HEADERS[header])
        self._compressor = root.get("compressor")
        self._left = largest(path.stat().st_size)
        self._raw = raw
        appended = root.find("AppendedData")
        text = "" if appended is None or raw is not None else (appended.text or "").strip()
        self._appended = text.removeprefix("_")

    def table(self, element: Any) -> NDArray[Any]:
        """Return an array by its components, (n, k)."""
        digits = element.get("NumberOfComponents") or "1"
        values = self._values(element)
        width = int(digits) if digits.isascii() and digits.isdecimal() and len(digits) < 9 else 0
        if not width or len(values) % width:
            raise FileFormatError(
                f"{self.path} is truncated: {len(values)} numbers are not rows of {digits:.20}"
            )
        return values.reshape(-1, width)

    def integers(self, element: Any) -> NDArray[np.int64]:
        """Return an array of integers."""
        values = self._values(element)
        if values.dtype.kind not in "iu" or (values > np.iinfo(np.int64).max).any():
            raise FileFormatError(f"{self.path} has cells whose corners are not integers")
        return values.astype(np.int64)

    def _values(self, element: Any) -> NDArray[Any]:
        kind, form = element.get("type"), element.get("format", "ascii")
        if kind not in _TYPES:
            raise FileFormatError(f"{self.path} has an array of the type {kind!r:.20}")
        try:
            if form == "ascii":
                return np.array((element.text or "").split(), dtype=_TYPES[kind])
            content = self._content(element, form)
            return np.frombuffer(content, self._order + _TYPES[kind])
        except (ValueError, OverflowError, zlib.error, lzma.LZMAError) as error:
            if isinstance(error, FileFormatError):
                raise
            raise corrupt(self.path, error) from error

    def _content(self, element: Any, form: str) -> bytes:
        """Return the bytes of a binary array."""
        if form == "binary":
            return self._unpacked(_base64((element.text or "").strip()))
        offset = element.get("offset", "")
        if form != "appended" or not (offset.strip().isascii() and offset.strip().isdecimal()):
            raise FileFormatError(f"{self.path} has an array of the format {form!r:.20}")
        if len(offset) > len(str(self._left)):
            raise self._short()
        at = int(offset)
        if self._raw is None:
            return self._unpacked(_base64(self._appended, at))
        return self._unpacked(_raw(self._raw, at))

    def _unpacked(self, take: Callable[[int, bool], bytes]) -> bytes:
        """Return the bytes of an array; `take` returns the next ones, from a new part or not."""
        size = self._header.itemsize
        (first,) = self._numbers(take(size, False), 1)
        if self._compressor is None:
            return self._whole(take(first, True), first)
        claimed = take(2 * size, False)
        block, last = self._numbers(claimed, 2)
        # The size of every block takes this many bytes.
        lengths = self._numbers(take(first * size, False), first)
        sizes = [block] * first
        if last and first:
            sizes[-1] = last
        self._left -= sum(sizes)
        if self._left < 0:
            raise FileFormatError(f"{self.path} contains far more than its size suggests")
        packed, at, found = self._whole(take(sum(lengths), True), sum(lengths)), 0, []
        for length, expected in zip(lengths, sizes, strict=True):
            found.append(self._inflated(packed[at : at + length], expected))
            at += length
        return b"".join(found)

    def _inflated(self, packed: bytes, expected: int) -> bytes:
        """Decompress a block, to no more than one byte beyond what it declares."""
        if self._compressor == "vtkZLibDataCompressor":
            found = zlib.decompressobj().decompress(packed, expected + 1)
        elif self._compressor == "vtkLZMADataCompressor":
            found = lzma.LZMADecompressor(memlimit=_MEMORY).decompress(packed, expected + 1)
        else:
            raise FileFormatError(
                f"{self.path} is compressed by {self._compressor!r:.40}; write it with ZLib or LZMA"
            )
        return self._whole(found, expected)

    def _numbers(self, content: bytes, count: int) -> list[int]:
        whole = self._whole(content, count * self._header.itemsize)
        return [int(n) for n in np.frombuffer(whole, self._header).tolist()]

    def _whole(self, content: bytes, size: int) -> bytes:
        if len(content) != size:
            raise self._short()
        return content

    def _short(self) -> FileFormatError:
        return FileFormatError(f"{self.path} is truncated: an array is shorter than it declares")


def _raw(content: bytes, at: int) -> Callable[[int, bool], bytes]:
    """Return a function that returns the next bytes."""

    def take(count: int, _: bool) -> bytes:
        nonlocal at
        at += count
        return content[at - count : at]

    return take


def _base64(text: str, at: int = 0) -> Callable[[int, bool], bytes]:
    """Return a function that returns the next decoded bytes.

    The header of an array may be encoded by itself, and then its data begin in a new part.
    """
    begun, position = at, 0

    def take(count: int, part: bool) -> bytes:
        nonlocal begun, position
        padded = text[begun : begun + _characters(position)].endswith("=")
        if part and (padded or position % 3 == 0):
            begun, position = begun + _characters(position), 0
        # Whole groups of four characters are three bytes each.
        first = position // 3
        group = text[begun + 4 * first : begun + _characters(position + count)]
        skipped = position - 3 * first
        position += count
        return base64.b64decode(group)[skipped : skipped + count]

    return take


def _characters(count: int) -> int:
    """Return how many characters encode a number of bytes."""
    return -(-count // 3) * 4
