"""PLY: vertices and faces with any further elements and properties, read without a library.

Text and both binary forms. Rows with lists are read at once where the lists of all rows have the
same length, and one by one otherwise. Each count is compared with the bytes that follow.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import FileFormatError
from delone.io.cells import ReadMesh, grouped
from delone.io.counts import announced
from delone.io.numbered import parsed

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["read"]

_TYPES = {
    **{"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2"},
    **{"ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4"},
    **{"float": "f4", "float32": "f4", "double": "f8", "float64": "f8"},
    **{"int64": "i8", "uint64": "u8"},
}
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_CORNERS = ("vertex_indices", "vertex_index")
_HEAD = 1 << 16
# Numbers in text are doubles, which represent all integers below this one exactly.
_LARGEST = float(1 << 53)
# Elements that also represent surfaces, in another form.
_STRIPS = ("tristrips", "multi_res_tristrips")


@dataclass(kw_only=True)
class _Element:
    """What the header says of one kind of item."""

    name: str
    count: int
    # Name, type, and for lists the type of the length.
    properties: list[tuple[str, str, str]] = field(default_factory=list)


def _longer(path: Path) -> FileFormatError:
    return FileFormatError(f"{path} is corrupt: it has more than it declares")


def read(path: Path) -> ReadMesh:
    """Read the points and polygons of a file."""
    content = path.read_bytes()
    order, elements, start = _header(content, path)
    rows = _Text(content[start:], path) if not order else _Binary(content, start, order, path)
    points, faces = np.empty((0, 3)), list[list[int]]()
    values: dict[str, NDArray[Any]] = {}
    for element in elements:
        if element.name in _STRIPS and element.count:
            raise FileFormatError(f"{path} has triangle strips, which are not read; convert it")
        columns = rows.take(element)
        if element.name == "vertex":
            points, values = _vertices(columns, path)
        elif element.name == "face" and element.count:
            faces = _faces(columns, path)
    rows.finish()
    return ReadMesh(points=points, cells=grouped(faces), point_data=values)


def _vertices(
    columns: dict[str, Any], path: Path
) -> tuple[NDArray[np.float64], dict[str, NDArray[Any]]]:
    axes = [name for name in "xyz" if name in columns]
    if axes[:2] != ["x", "y"] or any(isinstance(columns[name], list) for name in axes):
        raise FileFormatError(f"{path} has vertices without x and y")
    points = np.column_stack([np.asarray(columns[name], dtype=np.float64) for name in axes])
    others = {
        name: column
        for name, column in columns.items()
        if name not in axes and not isinstance(column, list)
    }
    return points, others


def _faces(columns: dict[str, Any], path: Path) -> list[list[int]]:
    corners = next((columns[name] for name in _CORNERS if name in columns), None)
    if not isinstance(corners, list):
        raise FileFormatError(f"{path} has faces without {_CORNERS[0]}")
    # Empty polygons do not count.
    return [row for row in corners if row]


def _header(content: bytes, path: Path) -> tuple[str, list[_Element], int]:
    """Return the order of bytes ("" for text), the elements, and where they begin."""
    end = content.find(b"end_header", 0, _HEAD)
    line_end = content.find(b"\n", end)
    if not content.startswith(b"ply") or end < 0 or line_end < 0:
        raise FileFormatError(f"{path} is truncated or not a .ply file: its header is incomplete")
    order: str | None = None
    elements: list[_Element] = []
    for line in content[:end].decode("ascii", errors="replace").splitlines()[1:]:
        words = line.split()
        if not words or words[0] in ("comment", "obj_info"):
            continue
        match words:
            case ["format", kind, "1.0"] if kind in _FORMATS:
                order = _FORMATS[kind]
            case ["element", name, digits] if digits.isascii() and digits.isdecimal():
                elements.append(_Element(name=name, count=announced(digits, str(path))))
            case ["property", "list", length, kind, name] if (
                elements and _TYPES.get(length, "f")[0] in "iu" and kind in _TYPES
            ):
                elements[-1].properties.append((name, _TYPES[kind], _TYPES[length]))
            case ["property", kind, name] if elements and kind in _TYPES:
                elements[-1].properties.append((name, _TYPES[kind], ""))
            case _:
                raise FileFormatError(f"{path} has a line {line.strip()!r:.60} in its header")
    if order is None:
        raise FileFormatError(f"{path} does not say its format: ascii or binary")
    return order, elements, line_end + 1


class _Rows:
    """The numbers of a file in order, from which items are read."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def short(self, element: _Element) -> FileFormatError:
        """Return the error for a file that ends before its items do."""
        return FileFormatError(
            f"{self.path} declares {element.count} items of type {element.name!r:.40} and holds "
            "fewer: it is truncated"
        )

    def take(self, element: _Element) -> dict[str, Any]:
        """Return the columns of all items: arrays, and lists of lists."""
        if not element.count or not element.properties:
            return {name: [] if length else np.empty(0) for name, _, length in element.properties}
        lengths = self._lengths(element)
        table = self._alike(element, lengths)
        if table is not None:
            found = [
                self._cast(table[f"p{k}"], kind)
                for k, (_, kind, _) in enumerate(element.properties)
            ]
            return {
                name: column.tolist() if length else column
                for column, (name, _, length) in zip(found, element.properties, strict=True)
            }
        columns: list[list[Any]] = [[] for _ in element.properties]
        for _ in range(element.count):  # each row reads at least one number, or the file ends
            for column, (_, kind, length) in zip(columns, element.properties, strict=True):
                column.append(self._one(element, kind, length))
        return {
            name: column if length else np.array(column)
            for column, (name, kind, length) in zip(columns, element.properties, strict=True)
        }

    def _cast(self, numbers: NDArray[Any], kind: str) -> NDArray[Any]:
        """Return numbers in the type that the header declares, if they have one."""
        if kind[0] == "f":
            with np.errstate(over="ignore"):
                return numbers.astype(kind)
        if numbers.dtype.kind == "f":
            whole = (np.abs(numbers) < _LARGEST) & (numbers == np.floor(numbers))
            if not whole.all():
                raise FileFormatError(
                    f"{self.path} has {numbers[~whole][0]:.17g} where an integer is declared"
                )
            return numbers.astype(np.int64)
        return numbers.astype(kind)

    def _lengths(self, element: _Element) -> list[int]:
        """Return the lengths of the lists of the next item, without reading it."""
        raise NotImplementedError

    def _alike(self, element: _Element, lengths: list[int]) -> Any:
        """Return a table of all items if their lists have these lengths, else None."""
        raise NotImplementedError

    def _one(self, element: _Element, kind: str, length: str) -> Any:
        """Return the next number, or list of numbers."""
        raise NotImplementedError


class _Text(_Rows):
    """The numbers of a text file."""

    def __init__(self, body: bytes, path: Path) -> None:
        super().__init__(path)
        self._values = parsed(body, path)
        self._at = 0

    def _count(self, element: _Element, at: int) -> int:
        number = float(self._values[at]) if at < len(self._values) else -1.0
        if not 0 <= number <= len(self._values) - at - 1 or number != int(number):
            raise self.short(element)
        return int(number)

    def _lengths(self, element: _Element) -> list[int]:
        at, found = self._at, []
        for _, _, length in element.properties:
            found.append(self._count(element, at) if length else 1)
            at += found[-1] + bool(length)
        return found

    def _alike(self, element: _Element, lengths: list[int]) -> Any:
        width = sum(lengths) + sum(bool(length) for _, _, length in element.properties)
        end = self._at + element.count * width
        lists = any(length for _, _, length in element.properties)
        if end > len(self._values):
            if lists:
                return None
            raise self.short(element)
        table, at, found = self._values[self._at : end].reshape(-1, width), 0, {}
        for k, ((_, _, length), count) in enumerate(zip(element.properties, lengths, strict=True)):
            if length:
                if (table[:, at] != count).any():
                    return None
                at += 1
            found[f"p{k}"] = table[:, at : at + count] if length else table[:, at]
            at += count
        self._at = end
        return found

    def _one(self, element: _Element, kind: str, length: str) -> Any:
        count = self._count(element, self._at) if length else 1
        self._at += bool(length)
        found = self._values[self._at : self._at + count]
        if len(found) < count:
            raise self.short(element)
        self._at += count
        found = self._cast(found, kind)
        return found.tolist() if length else found[0]

    def finish(self) -> None:
        """Reject content after the declared items."""
        if self._at < len(self._values):
            raise _longer(self.path)


class _Binary(_Rows):
    """The numbers of a binary file."""

    def __init__(self, content: bytes, start: int, order: str, path: Path) -> None:
        super().__init__(path)
        self._content, self._at, self._order = content, start, order

    def _number(self, element: _Element, kind: str, at: int) -> Any:
        if at + np.dtype(kind).itemsize > len(self._content):
            raise self.short(element)
        return np.frombuffer(self._content, self._order + kind, 1, at)[0]

    def _lengths(self, element: _Element) -> list[int]:
        at, found = self._at, []
        for _, kind, length in element.properties:
            count = int(self._number(element, length, at)) if length else 1
            at += (np.dtype(length).itemsize if length else 0) + count * np.dtype(kind).itemsize
            if count < 0 or at > len(self._content):
                raise self.short(element)
            found.append(count)
        return found

    def _alike(self, element: _Element, lengths: list[int]) -> Any:
        fields: list[Any] = []
        for k, ((_, kind, length), n) in enumerate(zip(element.properties, lengths, strict=True)):
            if length:
                fields.append((f"n{k}", self._order + length))
            fields.append((f"p{k}", self._order + kind, *([(n,)] if length else [])))
        row = np.dtype(fields)
        lists = any(length for _, _, length in element.properties)
        if element.count * row.itemsize > len(self._content) - self._at:
            if lists:
                return None
            raise self.short(element)
        table = np.frombuffer(self._content, row, element.count, self._at)
        for k, ((_, _, length), n) in enumerate(zip(element.properties, lengths, strict=True)):
            if length and (table[f"n{k}"] != n).any():
                return None
        self._at += element.count * row.itemsize
        return table

    def _one(self, element: _Element, kind: str, length: str) -> Any:
        count = 1
        if length:
            count = int(self._number(element, length, self._at))
            self._at += np.dtype(length).itemsize
        end = self._at + count * np.dtype(kind).itemsize
        if count < 0 or end > len(self._content):
            raise self.short(element)
        found = np.frombuffer(self._content, self._order + kind, count, self._at)
        self._at = end
        return found.tolist() if length else found[0]

    def finish(self) -> None:
        """Reject content after the declared items."""
        if self._content[self._at :].strip():
            raise _longer(self.path)
