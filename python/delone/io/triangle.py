"""Triangle's formats, .node, .ele and .poly, read and written without a library.

If points have three coordinates, the formats are TetGen's (`delone.io.tetgen`).

Numbers that start at 1 become rows from 0. Files are written with rows from 0 and all digits of the
coordinates. A .poly file without points takes them from the .node file next to it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_points, as_simplices
from delone._base.files import path_of, without
from delone.errors import FileFormatError, InputError
from delone.exchange.parts import boundary
from delone.exchange.second import of_order
from delone.io import tetgen
from delone.io.companions import require_companion
from delone.io.content import content
from delone.io.meshfile import MeshFile
from delone.io.numbered import (
    Numbers,
    as_markers,
    as_rows,
    first_number,
    refuse_columns,
    require_dimension,
    require_nodes,
    table,
)
from delone.io.pointset import PointSet

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats
    from delone.exchange.parts import HasParts, Parts
    from delone.io.content import Content, Wanted

__all__ = ["read_mesh", "read_points", "read_triangle", "write_mesh"]

# The nodes of a second-order triangle, by their positions in VTK's order.
_SECOND = (0, 1, 2, 4, 5, 3)


def read_triangle(path: str | os.PathLike[str]) -> dict[str, NDArray[Any]]:
    """Read a Triangle .node, .ele or .poly file, with the .node file that it needs.

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
    file = path_of(path)
    suffix = file.suffix.lower()
    if suffix not in (".node", ".ele", ".poly"):
        raise FileFormatError(f"{file} is not a .node, .ele or .poly file")
    numbers = Numbers(file)
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
    require_companion(file, node)
    require_nodes(node, file)
    return _vertices(Numbers(node))


def _vertices(numbers: Numbers) -> tuple[dict[str, NDArray[Any]], int]:
    count, dimension, attributes, markers = numbers.head(4)
    if count:
        require_dimension(dimension, 2, numbers.path)
    rows = numbers.take(count, 3 + attributes + markers)
    found: dict[str, NDArray[Any]] = {"vertices": rows[:, 1:3].copy()}
    if attributes:
        found["vertex_attributes"] = rows[:, 3 : 3 + attributes].copy()
    if markers:
        found["vertex_markers"] = as_markers(rows[:, -1:], numbers.path)
    return found, first_number(rows[:, 0], numbers.path)


def _triangles(numbers: Numbers, first: int, file: Path, n: int) -> dict[str, NDArray[Any]]:
    count, corners, attributes = numbers.head(3)
    if count and corners not in (3, 6):
        raise FileFormatError(f"{file} contains triangles of {corners} nodes, not 3 or 6")
    table = numbers.take(count, 1 + corners + attributes)
    found: dict[str, NDArray[Any]] = {"triangles": as_rows(table[:, 1:4], first, file, n)}
    if attributes:
        found["triangle_attributes"] = table[:, 4:].copy()
    return found


def _segments(numbers: Numbers, first: int, file: Path, n: int) -> dict[str, NDArray[Any]]:
    count, markers = numbers.head(2)
    table = numbers.take(count, 3 + markers)
    found: dict[str, NDArray[Any]] = {"segments": as_rows(table[:, 1:3], first, file, n)}
    if markers:
        found["segment_markers"] = as_markers(table[:, 3:4], numbers.path)
    (count,) = numbers.head(1)
    if count:
        found["holes"] = numbers.take(count, 3)[:, 1:].copy()
    if not numbers.ended:
        (count,) = numbers.head(1)
        if count:
            found["regions"] = numbers.take(count, 5)[:, 1:].copy()
    return found


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    everything: bool = False,
) -> PointSet:
    """Read the points of a file; see `delone.io.read_points`."""
    refuse_columns(path, columns, attributes)
    if tetgen.is_solid(path):
        places = tetgen.read_nodes(path)
        return PointSet(points=places[:, :2].copy(), z=places[:, 2].copy(), source=str(path))
    found = read_triangle(path)
    further = {}
    if everything:
        values = found.get("vertex_attributes", np.empty((0, 0)))
        further = {f"attribute_{i}": column.copy() for i, column in enumerate(values.T)}
        if "vertex_markers" in found:
            further["marker"] = found["vertex_markers"].reshape(-1)
    return PointSet(points=_points(found, path), attributes=further, source=str(path))


def _points(found: dict[str, NDArray[Any]], path: Path) -> Floats:
    try:
        return as_points(found["vertices"], ndim=2)
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error


def read_mesh(path: Path) -> MeshFile:
    """Read triangles, or TetGen's tetrahedra; see `delone.io.read_mesh`."""
    if tetgen.is_solid(path):
        return tetgen.read_mesh(path)
    found = read_triangle(path)
    points = _points(found, path)
    if "triangles" not in found:
        raise without(path, "triangles")
    return MeshFile(
        points=points, simplices=as_simplices(found["triangles"], len(points), 2), source=str(path)
    )


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write one of the files: points with heights as an attribute, triangles, or segments."""
    suffix = path.suffix.lower()
    wanted.refuse(f"{suffix} files", "edges", "attributes")
    if triangulation.points.shape[1] == 3:
        tetgen.write_mesh(path, triangulation, wanted)
        return
    found = content(triangulation, z=wanted.z, order=wanted.order)
    if suffix == ".ele":
        text = _elements(of_order(found.own, wanted.order))
    else:
        text = _nodes(found)
        if suffix == ".poly":
            text += _poly(found.own)
    path.write_text(text, encoding="utf-8")


def _elements(parts: Parts) -> str:
    """Triangles and, for a mesh, their regions."""
    count, extra = len(parts.simplices), np.empty((len(parts.simplices), 0))
    if "marker" in parts.of_segments:
        extra = parts.of_simplices["region"][:, None]
    corners = parts.simplices if parts.order == 1 else parts.simplices[:, _SECOND]
    return table(f"{count} {corners.shape[1]} {extra.shape[1]}", (corners, extra))


def _nodes(found: Content) -> str:
    own = found.own
    if found.heights is not None:
        own = own._replace(of_points={**own.of_points, "height": found.heights})
    own = of_order(own, found.order)
    points, marker = own.points, own.of_points.get("marker")
    values: list[NDArray[Any]] = [points]
    if found.heights is not None:
        values.append(own.of_points["height"][:, None])
    if marker is not None:
        values.append(marker[:, None])
    flags = f"{int(found.heights is not None)} {int(marker is not None)}"
    return table(f"{len(points)} 2 {flags}", values)


def _poly(parts: Parts) -> str:
    """Segments, and no seeds of holes: a triangulation does not say what is outside."""
    pairs = boundary(parts.simplices) if parts.segments is None else parts.segments
    markers = parts.of_segments.get("marker", np.zeros(len(pairs), dtype=np.int32))
    return table(f"{len(pairs)} 1", (pairs, markers[:, None])) + "0\n"
