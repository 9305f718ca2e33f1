"""The formats of Triangle, .node, .ele and .poly, read and written without a library.

Numbers that start at 1 become rows from 0. Files are written with rows from 0 and all digits of the
coordinates. A .poly file without points takes them from the .node file next to it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_points, as_simplices
from delone.errors import FileFormatError, InputError
from delone.exchange.parts import boundary
from delone.io.content import content
from delone.io.pointset import PointSet
from delone.io.registry import MeshFile

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone.exchange.parts import HasParts, Parts
    from delone.io.content import Content

    Floats = NDArray[np.float64]

__all__ = ["read_mesh", "read_points", "read_triangle", "require_libraries", "write_mesh"]


# Point numbers and markers have 32 bits.
_LARGEST = 1 << 31


class _Numbers:
    """The numbers of a file, without its comments, in order."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            text = path.read_text(encoding="utf-8")
            words = " ".join(line.partition("#")[0] for line in text.splitlines()).split()
            self._values = np.array(words, dtype=np.float64)
        except (UnicodeDecodeError, ValueError) as error:
            raise FileFormatError(
                f"{path} contains something other than numbers: {error}"
            ) from error
        self._at = 0

    def take(self, rows: int, columns: int) -> Floats:
        end = self._at + rows * columns
        if rows < 0 or columns < 0 or end > len(self._values):
            raise FileFormatError(f"{self.path} is truncated: it declares more than it contains")
        found = self._values[self._at : end].reshape(rows, columns)
        self._at = end
        return found

    def head(self, count: int) -> list[int]:
        found = self.take(1, count)[0]
        if not np.isfinite(found).all() or (found != np.floor(found)).any() or (found < 0).any():
            raise FileFormatError(f"{self.path} has no counts where they are expected")
        return [int(n) for n in found]

    @property
    def ended(self) -> bool:
        return self._at >= len(self._values)


def read_triangle(path: str | os.PathLike[str]) -> dict[str, NDArray[Any]]:
    """Read a .node, .ele or .poly file of Triangle, with the .node file that it needs.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    dict of ndarray
        Arrays with the keys of `delone.compat.triangle.triangulate`.

    Raises
    ------
    FileFormatError
        The file is truncated, or contains something else.
    FileNotFoundError
        The file, or the .node file next to it, is missing.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.io.triangle import read_triangle
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "a.node"
    ...     _ = file.write_text("3 2 0 0  1 0 0  2 4 0  3 0 4")
    ...     read_triangle(file)["vertices"].tolist()
    [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]]
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in (".node", ".ele", ".poly"):
        raise FileFormatError(f"{file} is not a .node, .ele or .poly file")
    numbers = _Numbers(file)
    if suffix == ".node":
        return _vertices(numbers)[0]
    if suffix == ".ele":
        found, first = _beside(file)
        return found | _triangles(numbers, first, file, len(found["vertices"]))
    found, first = _vertices(numbers)
    if not len(found.get("vertices", ())):
        found, first = _beside(file)
    return found | _segments(numbers, first, file, len(found["vertices"]))


def _beside(file: Path) -> tuple[dict[str, NDArray[Any]], int]:
    node = file.with_suffix(".node")
    if not node.exists():
        raise FileNotFoundError(f"{node}: no such file; {file.name} needs it for its points")
    return _vertices(_Numbers(node))


def _vertices(numbers: _Numbers) -> tuple[dict[str, NDArray[Any]], int]:
    count, dimension, attributes, markers = numbers.head(4)
    if count and dimension != 2:
        raise FileFormatError(f"{numbers.path}: points have {dimension} coordinates, not two")
    table = numbers.take(count, 3 + attributes + markers)
    found: dict[str, NDArray[Any]] = {"vertices": table[:, 1:3].copy()}
    if attributes:
        found["vertex_attributes"] = table[:, 3 : 3 + attributes].copy()
    if markers:
        found["vertex_markers"] = _markers(table[:, -1:], numbers.path)
    return found, _first(table[:, 0], numbers.path)


def _first(numbers: Floats, path: Path) -> int:
    """Return the number of the first point; the others follow consecutively."""
    if not len(numbers):
        return 0
    first = float(numbers[0])
    if not 0 <= first < _LARGEST or first != int(first):
        raise FileFormatError(f"{path}: the first point has the number {first:.17g}")
    wrong = np.flatnonzero(numbers != first + np.arange(len(numbers)))
    if len(wrong):
        row = int(wrong[0])
        raise FileFormatError(
            f"{path}: points are not numbered consecutively: row {row} has the number "
            f"{numbers[row]:.17g}, not {int(first) + row}"
        )
    return int(first)


def _markers(numbers: Floats, path: Path) -> NDArray[np.int32]:
    good = (np.abs(numbers) < _LARGEST) & (numbers == np.floor(numbers))
    if not good.all():
        row = int(np.flatnonzero(~good.all(axis=1))[0])
        raise FileFormatError(
            f"{path}: the marker in row {row} is {numbers[row, 0]:.17g}, not a 32-bit integer"
        )
    return numbers.astype(np.int32)


def _triangles(numbers: _Numbers, first: int, file: Path, n: int) -> dict[str, NDArray[Any]]:
    count, corners, attributes = numbers.head(3)
    if count and corners != 3:
        raise FileFormatError(f"{file} contains triangles of {corners} nodes, not three")
    table = numbers.take(count, 1 + corners + attributes)
    found: dict[str, NDArray[Any]] = {"triangles": _indices(table[:, 1:4], first, file, n)}
    if attributes:
        found["triangle_attributes"] = table[:, 4:].copy()
    return found


def _segments(numbers: _Numbers, first: int, file: Path, n: int) -> dict[str, NDArray[Any]]:
    count, markers = numbers.head(2)
    table = numbers.take(count, 3 + markers)
    found: dict[str, NDArray[Any]] = {"segments": _indices(table[:, 1:3], first, file, n)}
    if markers:
        found["segment_markers"] = _markers(table[:, 3:4], numbers.path)
    (count,) = numbers.head(1)
    if count:
        found["holes"] = numbers.take(count, 3)[:, 1:].copy()
    if not numbers.ended:
        (count,) = numbers.head(1)
        if count:
            found["regions"] = numbers.take(count, 5)[:, 1:].copy()
    return found


def _indices(numbers: Floats, first: int, file: Path, n: int) -> NDArray[np.int32]:
    rows = numbers - first
    if (rows != np.floor(rows)).any() or (rows < 0).any() or (rows >= n).any():
        raise FileFormatError(f"{file} refers to points that do not exist")
    return rows.astype(np.int32)


def read_points(
    path: Path, *, columns: Sequence[str | int] | None, attributes: Sequence[str]
) -> PointSet:
    """Read the points of a file; see `delone.io.read_points`."""
    if columns is not None or attributes:
        raise FileFormatError(f"{path}: the columns of these files cannot be chosen")
    return PointSet(points=_points(read_triangle(path), path), source=str(path))


def _points(found: dict[str, NDArray[Any]], path: Path) -> Floats:
    try:
        return as_points(found["vertices"], ndim=2)
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error


def read_mesh(path: Path) -> MeshFile:
    """Read triangles; see `delone.io.read_mesh`."""
    found = read_triangle(path)
    points = _points(found, path)
    if "triangles" not in found:
        raise FileFormatError(f"{path} contains no triangles")
    return MeshFile(
        points=points, simplices=as_simplices(found["triangles"], len(points), 2), source=str(path)
    )


def require_libraries(suffix: str) -> None:
    """Do nothing: no library is needed."""


def write_mesh(
    path: Path,
    triangulation: HasParts,
    *,
    z: ArrayLike | None = None,
    crs: str | None = None,
    edges: bool = False,
    attributes: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Write one of the files: points with heights as an attribute, triangles, or segments."""
    if edges or attributes:
        raise FileFormatError(f"{path.suffix} files can store neither edges nor named attributes")
    suffix = path.suffix.lower()
    found = content(triangulation, z=z)
    if suffix == ".ele":
        text = _elements(found.own)
    else:
        text = _nodes(found)
        if suffix == ".poly":
            text += _poly(found.own)
    path.write_text(text, encoding="utf-8")


def _elements(parts: Parts) -> str:
    """Triangles, and the regions of those of a mesh."""
    count, extra = len(parts.simplices), np.empty((len(parts.simplices), 0))
    if "marker" in parts.of_segments:
        extra = parts.of_simplices["region"][:, None]
    return _table(f"{count} 3 {extra.shape[1]}", (parts.simplices, extra))


def _nodes(found: Content) -> str:
    points, marker = found.own.points, found.own.of_points.get("marker")
    values: list[NDArray[Any]] = [points]
    if found.heights is not None:
        values.append(found.heights[:, None])
    if marker is not None:
        values.append(marker[:, None])
    flags = f"{int(found.heights is not None)} {int(marker is not None)}"
    return _table(f"{len(points)} 2 {flags}", values)


def _poly(parts: Parts) -> str:
    """Segments and seeds of holes, none: what is outside of triangles is not told."""
    pairs = boundary(parts.simplices) if parts.segments is None else parts.segments
    markers = parts.of_segments.get("marker", np.zeros(len(pairs), dtype=np.int32))
    return _table(f"{len(pairs)} 1", (pairs, markers[:, None])) + "0\n"


def _table(head: str, columns: Sequence[NDArray[Any]]) -> str:
    lists = [block.tolist() for block in columns]
    lines = [head]
    for i, rows in enumerate(zip(*lists, strict=True)):
        lines.append(" ".join([str(i), *(repr(value) for row in rows for value in row)]))
    return "\n".join(lines) + "\n"
