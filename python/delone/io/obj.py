"""OBJ: vertices and faces, read without a library.

Texture coordinates and normals, of which there may be any number, are left out; so are materials,
groups, lines and points. Faces may count vertices from the first (1) or back from the last (-1).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.errors import FileFormatError
from delone.io.cells import ReadMesh, grouped

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["read"]

# Curves and surfaces that are not polygons.
_CURVED = ("curv", "curv2", "surf")
# Rows have 32 bits.
_LARGEST = 1 << 31
# The numbers of a vertex: x, y and z; a weight or colors may follow.
_PLAIN, _WEIGHTED, _COLORED = (2, 3), 4, (6, 7)


def read(path: Path) -> ReadMesh:
    """Read the points and polygons of a file."""
    points: list[list[float]] = []
    polygons: list[list[int]] = []
    lines = path.read_text(encoding="utf-8", errors="replace").replace("\\\n", " ").split("\n")
    for number, line in enumerate(lines, 1):
        word, *fields = line.split() or [""]
        try:
            if word == "v":
                points.append(_place(fields))
            elif word == "f":
                polygons.append([_row(field, len(points)) for field in fields])
            elif word in _CURVED:
                raise ValueError(f"a {word}, which is not a polygon")
            if word == "f" and len(fields) < 3:
                raise ValueError(f"a face with {len(fields)} corners")
        except ValueError as error:
            raise FileFormatError(
                f"{path} is truncated or not a .obj file: line {number} has {error!s:.80}"
            ) from error
    widths = {len(point) for point in points}
    if len(widths) > 1:
        raise FileFormatError(f"{path} has vertices with 2 and with 3 coordinates")
    found = np.array(points, dtype=np.float64).reshape(len(points), max(widths, default=3))
    return ReadMesh(points=found, cells=grouped(polygons))


def _place(fields: list[str]) -> list[float]:
    """Return the coordinates of a vertex, without its colors."""
    numbers = [float(field) for field in fields]
    if len(numbers) == _WEIGHTED and numbers[3] != 1:
        raise ValueError(f"a vertex with the weight {numbers[3]:g}; only 1 is read")
    if len(numbers) not in (*_PLAIN, _WEIGHTED, *_COLORED):
        raise ValueError(f"a vertex with {len(numbers)} numbers")
    return numbers[:3]


def _row(field: str, count: int) -> int:
    """Return the row of a corner, given as vertex/texture/normal below `count` vertices."""
    index = int(field.partition("/")[0])
    if index == 0 or index < -count or index > _LARGEST:
        raise ValueError(f"a corner with the number {index}")
    return index - 1 if index > 0 else count + index
