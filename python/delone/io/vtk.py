"""Legacy VTK files, text or binary: points, cells, point values, markers and regions.

PolyData and unstructured grids are read, in the layout before version 5 and in that of 5.1. What a
file declares is compared with the bytes that follow before memory is allocated.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._base.files import corrupt
from delone.errors import FileFormatError
from delone.io.cells import ReadMesh
from delone.io.counts import announced
from delone.io.numbered import parsed
from delone.io.vtu import POLYGON, cells_of, numbers_of

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Rows

__all__ = ["read"]

_TYPES = {
    **{"double": ">f8", "float": ">f4", "long": ">i8", "unsigned_long": ">u8", "int": ">i4"},
    **{"unsigned_int": ">u4", "short": ">i2", "unsigned_short": ">u2", "char": ">i1"},
    **{"unsigned_char": ">u1", "vtkidtype": ">i4"},
    # Version 5 names these types by their number of bits.
    **{f"vtktypeint{bits}": f">i{bits // 8}" for bits in (8, 16, 32, 64)},
    **{f"vtktypeuint{bits}": f">u{bits // 8}" for bits in (8, 16, 32, 64)},
}
_HEAD = re.compile(
    rb"# vtk DataFile Version [^\n]*\n[^\n]*\n\s*(ASCII|BINARY)\s+DATASET\s+(\w+)", re.IGNORECASE
)
_WORD = re.compile(rb"\s*(\S+)")
# A line of letters ends text numbers.
_LETTERS = re.compile(rb"\n\s*(?!nan\b|inf)[A-Za-z]", re.IGNORECASE)
_BLANK = re.compile(rb"\n\s*\n|\Z")
# The cell types of PolyData: lines of any length are lines.
_POLYDATA = {"VERTICES": 1, "LINES": 3, "POLYGONS": POLYGON, "TRIANGLE_STRIPS": 6}
# Values with a fixed number of components.
_VECTORS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9}


class _List(NamedTuple):
    """Cells as a list of corners, and where each ends."""

    corners: Rows
    ends: Rows


def read(path: Path) -> ReadMesh:
    """Read the points and cells of a file."""
    return _Reader(path).whole()


class _Reader:
    """A file, and the position up to which it has been read."""

    def __init__(self, path: Path) -> None:
        self._path, self._content = path, path.read_bytes()
        head = _HEAD.match(self._content)
        if head is None:
            raise FileFormatError(f"{path} is not a legacy .vtk file: it has no DATASET after it")
        self._at, self._binary = head.end(), head[1].upper() == b"BINARY"
        self._kind = head[2].decode("utf-8", errors="replace").upper()
        if self._kind not in ("POLYDATA", "UNSTRUCTURED_GRID"):
            raise FileFormatError(
                f"{path} has the dataset {self._kind:.40}; POLYDATA and UNSTRUCTURED_GRID are read"
            )

    def whole(self) -> ReadMesh:
        """Read all sections, up to values of a kind that is not read."""
        points, cells, grid = np.empty((0, 3)), [], None
        types = np.empty(0, dtype=np.int64)
        values: dict[str, dict[str, NDArray[np.float64]]] = {"POINT_DATA": {}, "CELL_DATA": {}}
        while (word := self._word()) is not None:
            if word == "POINTS":
                count = self._count()
                points = self._array(3 * count, self._type()).reshape(-1, 3).astype(np.float64)
            elif word == "CELLS":
                grid = self._cells()
            elif word == "CELL_TYPES":
                types = self._integers(self._count(), ">i4")
            elif word in _POLYDATA:
                own = self._cells()
                kinds = np.full(len(own.ends), _POLYDATA[word])
                cells += cells_of(own.corners, own.ends, kinds, self._path)
            elif word in values:
                count = self._count()
                values[word] |= self._values(count)
            elif word == "METADATA":
                self._skip()
            else:
                break
        if grid is not None:
            cells = cells_of(grid.corners, grid.ends, types, self._path)
        if any(len(each) != len(points) for each in values["POINT_DATA"].values()):
            raise FileFormatError(f"{self._path} has different numbers of points and of values")
        return ReadMesh(
            points=points,
            cells=cells,
            point_data=values["POINT_DATA"],
            **numbers_of(cells, values["CELL_DATA"], self._path),
        )

    def _cells(self) -> _List:
        """Read cells in either layout: a count before the corners of each, or offsets first."""
        count, size = self._count(), self._count()
        at = self._at
        if self._word() != "OFFSETS":
            self._at = at
            return self._counted(self._integers(size, ">i4"), count)
        offsets = self._integers(count, self._type())
        if self._word() != "CONNECTIVITY":
            raise self._corrupt("its cells have offsets and no corners")
        corners = self._integers(size, self._type())
        if count == 0 or offsets[0] != 0:
            raise self._corrupt("its offsets do not match its corners")
        return _List(corners, offsets[1:])

    def _counted(self, flat: Rows, count: int) -> _List:
        """Separate corners from the counts before them."""
        width = len(flat) // count - 1 if count else 0
        if len(flat) == count * (width + 1) and (flat[:: width + 1] == width).all():
            # All cells have the same number of corners.
            rows = flat.reshape(count, -1)[:, 1:]
            return _List(rows.ravel(), width * np.arange(1, count + 1))
        starts: list[int] = []
        at, values = 0, flat.tolist()
        # A count below 0 ends the walk before the end of the values.
        while len(starts) < count and at < len(values) and values[at] >= 0:
            starts.append(at)
            at += 1 + values[at]
        if at != len(values) or len(starts) != count:
            raise self._corrupt("its counts do not match its corners")
        heads = np.array(starts, dtype=np.int64)
        ends = np.cumsum(flat[heads]) if count else np.empty(0, dtype=np.int64)
        return _List(np.delete(flat, heads), ends)

    def _values(self, count: int) -> dict[str, NDArray[np.float64]]:
        """Read point or cell values by name, up to anything else."""
        found: dict[str, NDArray[np.float64]] = {}
        while True:
            at = self._at
            word = self._word()
            if word == "SCALARS":
                name, kind = self._needed(), self._type()
                width = self._components()
                found[name] = self._table(count, width, kind)
            elif word in _VECTORS:
                name, kind = self._needed(), self._type()
                found[name] = self._table(count, _VECTORS[word], kind)
            elif word == "FIELD":
                self._needed()
                for _ in range(self._count()):
                    name, width, rows = self._needed(), self._count(), self._count()
                    found[name] = self._table(rows, width, self._type())
                    self._skip_metadata()
            elif word == "METADATA":
                self._skip()
            else:
                self._at = at
                return found

    def _components(self) -> int:
        """Read the number of components of scalars, which may be left out, and their table."""
        at, word = self._at, self._needed()
        width = 1
        if word.isdecimal():
            width = announced(word, str(self._path))
            at, word = self._at, self._needed()
        if word == "LOOKUP_TABLE":
            self._needed()
        else:
            self._at = at
        return width

    def _table(self, rows: int, width: int, kind: str) -> NDArray[np.float64]:
        made = self._array(rows * width, kind).astype(np.float64)
        return made if width == 1 else made.reshape(rows, width)

    def _skip_metadata(self) -> None:
        at = self._at
        if self._word() == "METADATA":
            self._skip()
        else:
            self._at = at

    def _skip(self) -> None:
        """Skip a section that ends at a blank line."""
        found = _BLANK.search(self._content, self._at)
        self._at = found.end() if found else len(self._content)

    def _word(self) -> str | None:
        found = _WORD.match(self._content, self._at)
        if found is None:
            return None
        self._at = found.end()
        return found[1].decode("utf-8", errors="replace")

    def _needed(self) -> str:
        word = self._word()
        if word is None:
            raise self._corrupt("it ends too soon")
        return word

    def _count(self) -> int:
        word = self._needed()
        if not (word.isascii() and word.isdecimal()):
            raise self._corrupt(f"it has {word!r:.40} where a count is needed")
        return announced(word, str(self._path))

    def _type(self) -> str:
        word = self._needed()
        if word.lower() not in _TYPES:
            raise FileFormatError(f"{self._path} has numbers of the type {word!r:.40}")
        return _TYPES[word.lower()]

    def _integers(self, count: int, kind: str) -> Rows:
        found = self._array(count, kind)
        made: Rows = found.astype(np.int64)
        if found.dtype.kind == "f" and (made != found).any():
            raise self._corrupt("its cells have corners that are not integers")
        return made

    def _array(self, count: int, kind: str) -> NDArray[np.float64] | Rows:
        """Read numbers: bytes after the end of the line, or words."""
        if not self._binary:
            found = _LETTERS.search(self._content, self._at)
            end = found.start() if found else len(self._content)
            numbers = parsed(self._content[self._at : end], self._path)
            self._at = end
            if len(numbers) != count:
                raise self._corrupt(f"it declares {count} numbers and has {len(numbers)}")
            return numbers
        start = self._content.find(b"\n", self._at) + 1
        end = start + count * np.dtype(kind).itemsize
        if (start == 0 and count) or end > len(self._content):
            raise self._corrupt(f"it declares {count} numbers and ends before these")
        self._at = end if start else self._at
        read: Rows = np.frombuffer(self._content[start:end], kind)
        return read

    def _corrupt(self, what: str) -> FileFormatError:
        return corrupt(self._path, what)
