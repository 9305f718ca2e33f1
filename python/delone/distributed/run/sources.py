"""Sources of points: arrays, LAS and LAZ, Parquet, npy, and any file that `delone.io` reads.

A source is split into pieces of about a million rows, based on the headers of files, before any
point is read. Rows are numbered consecutively through all files.
"""

from __future__ import annotations

import glob
import hashlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from delone._base.arrays import as_points
from delone._base.files import existing
from delone.distributed.pure.rows import make_rows
from delone.errors import FileFormatError, InputError
from delone.io import PointSet, las, parquet, read_points

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone.distributed.pure.rows import Rows

    Given: TypeAlias = str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | ArrayLike

__all__ = ["PIECE", "Choice", "Piece", "Source", "find"]

# Rows of a piece: its records take about 32 MB.
PIECE = 1 << 20
_LAS = (".las", ".laz")


@dataclass(frozen=True)
class Choice:
    """Which data to read from each file; see `delone.io.read_points`."""

    columns: tuple[str | int, ...] | None = None
    classes: tuple[int, ...] | None = None
    attributes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Piece:
    """A range of rows of a file, with the size and time of the file when it was scanned."""

    path: str
    kind: str
    start: int
    stop: int
    first: int
    stamp: tuple[int, int] = (0, 0)

    def read(self, choice: Choice) -> Rows:
        """Return the rows, with their numbers in the source."""
        self._check()
        found = self._points(choice)
        self._check()
        attributes = {name: _number(found, name) for name in choice.attributes}
        rows = make_rows(self.first + self.start, found.points, found.z, attributes)
        if choice.classes is not None:
            rows = rows[np.isin(_number(found, "classification"), choice.classes)]
        return rows

    def _check(self) -> None:
        path = Path(self.path)
        if not path.exists() or _stamp(path) != self.stamp:
            raise FileFormatError(f"{path} has changed since it was scanned")

    def _points(self, choice: Choice) -> PointSet:
        path = Path(self.path)
        if self.kind == "las":
            names = list(choice.attributes)
            if choice.classes is not None and "classification" not in names:
                names.append("classification")
            return las.read_range(path, self.start, self.stop, attributes=names)
        if self.kind == "parquet":
            return parquet.read_range(
                path, self.start, self.stop, columns=choice.columns, attributes=choice.attributes
            )
        if self.kind == "npy":
            some = np.array(np.load(path, mmap_mode="r")[self.start : self.stop], order="C")
            z = some[:, 2] if some.shape[1] == 3 else None
            return PointSet(points=some[:, :2], z=z, source=str(path))
        return read_points(path, columns=choice.columns, attributes=choice.attributes)


@dataclass(frozen=True, eq=False)
class Source:
    """All pieces of a source, in the order of their rows, and how many rows the files declare.

    `identity` must not change if a run is resumed: names, sizes and times of files, or a hash.
    `array` contains the points themselves, with heights in a third column.
    """

    pieces: tuple[Piece, ...]
    count: int
    crs: str | None
    identity: dict[str, Any]
    array: NDArray[np.float64] | None = None


def find(source: Given, choice: Choice) -> Source:
    """Examine a source without reading its points; errors are those of `delone.io.read_points`."""
    paths = _paths(source)
    if paths is None:
        return _of_array(source, choice)
    pieces: list[Piece] = []
    systems: dict[str | None, str] = {}
    flat: dict[bool, str] = {}
    count = 0
    files: list[list[str | int]] = []
    for path in paths:
        existing(path)
        # Before the scan, so that changes during it are detected later.
        stamp = _stamp(path)
        files.append([os.path.abspath(path), *stamp])
        kind, rows, crs, heights = _look(path, choice)
        systems.setdefault(crs, str(path))
        flat.setdefault(heights, str(path))
        size = PIECE if kind != "file" else max(rows, 1)
        cuts = range(0, rows, size)
        pieces += [Piece(str(path), kind, i, min(i + size, rows), count, stamp) for i in cuts]
        count += rows
    if len(systems) > 1:
        (one, first), (other, second), *_ = systems.items()
        raise InputError(
            f"mixed reference systems: {first} has {one or 'none'}, {second} has "
            f"{other or 'none'}; transform all files to one system"
        )
    if len(flat) > 1:
        raise InputError(f"{flat[True]} has heights and {flat[False]} has none: choose columns")
    return Source(tuple(pieces), count, next(iter(systems), None), {"files": files})


def _stamp(path: Path) -> tuple[int, int]:
    """Size and modification time of a file."""
    stat = path.stat()
    return stat.st_size, stat.st_mtime_ns


def _paths(source: Given) -> list[Path] | None:
    """Files in order; None if the source is not made of files."""
    if isinstance(source, str | os.PathLike):
        found = _matching(source)
    elif isinstance(source, list | tuple) and source:
        if not all(isinstance(part, str | os.PathLike) for part in source):
            return None
        found = [path for part in source for path in _matching(part)]
    else:
        return None
    seen: set[str] = set()
    for path in found:
        name = os.path.realpath(path)
        if name in seen:
            raise InputError(f"{path} occurs twice in the source")
        seen.add(name)
    return found


def _matching(part: str | os.PathLike[str]) -> list[Path]:
    path = Path(part).expanduser()
    if path.is_dir():
        found = sorted(p for p in path.rglob("*.parquet") if not p.name.startswith((".", "_")))
        if not found:
            raise InputError(
                f"{path} contains no Parquet files; use a glob for files of other formats"
            )
        return found
    if glob.has_magic(str(path)) and not path.exists():
        found = sorted(Path(name) for name in glob.glob(str(path), recursive=True))
        if not found:
            raise InputError(f"no file matches {part}")
        return found
    return [path]


def _look(path: Path, choice: Choice) -> tuple[str, int, str | None, bool]:
    """Kind, rows and reference system of a file, and whether it has heights."""
    suffix = path.suffix.lower()
    if suffix in _LAS:
        if choice.columns is not None:
            raise FileFormatError(f"{path}: LAS files always have the coordinates x, y and z")
        return "las", *las.look(path, attributes=choice.attributes), True
    if choice.classes is not None:
        raise FileFormatError(f"{path}: tiles can select classes from LAS and LAZ files only")
    if suffix == ".parquet" and not parquet.holds_geometries(path):
        rows, z = parquet.look(path, columns=choice.columns, attributes=choice.attributes)
        return "parquet", rows, None, z
    if suffix == ".npy" and (shape := _mappable(path, choice)) is not None:
        return "npy", shape[0], None, shape[1] == 3
    survey = read_points(path, columns=choice.columns, attributes=choice.attributes)
    return "file", len(survey), survey.crs, survey.z is not None


def _mappable(path: Path, choice: Choice) -> tuple[int, int] | None:
    """The shape of an array that can be read in parts; None if it is not a plain table."""
    if choice.columns is not None or choice.attributes:
        return None
    try:
        array = np.load(path, mmap_mode="r")
    except ValueError:
        return None
    fits = array.ndim == 2 and array.shape[1] in (2, 3) and array.dtype == np.float64
    fits = fits and array.offset + array.nbytes == path.stat().st_size
    return array.shape if fits else None


def _of_array(source: Any, choice: Choice) -> Source:
    if choice.columns is not None or choice.classes is not None or choice.attributes:
        raise InputError("columns, classes and attributes are for files, not for arrays")
    points = as_points(source)
    identity = {
        "array": hashlib.sha256(points.reshape(-1).view(np.uint8).data).hexdigest(),
        "shape": list(points.shape),
    }
    n = len(points)
    pieces = tuple(Piece("", "array", i, min(i + PIECE, n), 0) for i in range(0, n, PIECE))
    return Source(pieces, n, None, identity, points)


def _number(found: PointSet, name: str) -> NDArray[Any]:
    """An attribute, whose values must be numbers, because records have a fixed size."""
    names = [other for other in found.attributes if other.casefold() == name.casefold()]
    if name not in found.attributes and len(names) != 1:
        raise FileFormatError(
            f"{found.source} has no column {name!r:.80}; attributes are given by name"
        )
    values = np.asarray(found.attributes[name if name in found.attributes else names[0]])
    if values.dtype.kind not in "biuf" or values.ndim != 1:
        what = f"{values.dtype}, several per row" if values.ndim > 1 else values.dtype
        raise FileFormatError(f"{found.source}: {name!r:.80} is not one number per row ({what})")
    return values
