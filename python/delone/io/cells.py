"""The points and cells of a mesh file, before it is decided which of them are needed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

__all__ = ["POLYGONS", "SOLIDS", "Cells", "ReadMesh", "grouped", "name_of_polygon"]

# Types of cells that are polygons, which have markers.
POLYGONS = ("triangle", "quad", "polygon")
# Types of cells that have regions.
SOLIDS = ("tetra",)


class Cells(NamedTuple):
    """Cells of one type, named as meshio names them."""

    type: str
    data: NDArray[Any]


@dataclass(frozen=True, eq=False, kw_only=True)
class ReadMesh:
    """Points, cells in the order of the file, point values, and cell numbers.

    Markers are those of polygons, regions those of tetrahedra, in the order of their cells.
    """

    points: NDArray[np.float64]
    cells: list[Cells]
    point_data: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    markers: NDArray[np.int32] | None = None
    regions: NDArray[np.int32] | None = None


def grouped(polygons: Sequence[Sequence[int]]) -> list[Cells]:
    """Return polygons as cells; consecutive ones with the same number of corners form one block."""
    found: list[Cells] = []
    start = 0
    for end in range(1, len(polygons) + 1):
        count = len(polygons[start])
        if end == len(polygons) or len(polygons[end]) != count:
            data = np.array(polygons[start:end], dtype=np.int64).reshape(-1, count)
            found.append(Cells(name_of_polygon(count), data))
            start = end
    return found


def name_of_polygon(count: int) -> str:
    """Return the name of a planar cell with this number of corners."""
    return {1: "vertex", 2: "line", 3: "triangle", 4: "quad"}.get(count, "polygon")
