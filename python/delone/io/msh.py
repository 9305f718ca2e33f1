"""MSH files of version 4.1 with physical groups, binary: names, entities, nodes, elements, values.

meshio writes version-4 entities only if each has its own nodes. Here, each group of cells is an
entity with its number, and nodes keep their order, as part of the first entity.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = ["Group", "write"]

# Gmsh's number of an element type, its dimension, and its nodes in VTK's order.
_KINDS: dict[str, tuple[int, int, tuple[int, ...]]] = {
    "line": (1, 1, (0, 1)),
    "line3": (8, 1, (0, 1, 2)),
    "triangle": (2, 2, (0, 1, 2)),
    "triangle6": (9, 2, (0, 1, 2, 3, 4, 5)),
    "tetra": (4, 3, (0, 1, 2, 3)),
    "tetra10": (11, 3, (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)),
}


class Group(NamedTuple):
    """Cells of one kind that form one physical group, and an entity with the same number."""

    name: str
    number: int  # from 1 on
    kind: str  # as meshio has it
    cells: NDArray[np.integer[Any]]
    rows: NDArray[np.int64]  # of the mesh

    @property
    def ndim(self) -> int:
        """The dimension of the cells."""
        return _KINDS[self.kind][1]


def write(
    path: Path,
    points: Floats,
    groups: list[Group],
    of_points: Mapping[str, NDArray[Any]],
    of_cells: Mapping[str, NDArray[Any]],
) -> None:
    """Write points, (n, 3), groups of cells, point values, and values of cells of one kind."""
    groups = sorted(
        (group for group in groups if len(group.cells)),
        key=lambda group: (group.ndim, group.number),
    )
    names = [f'{group.ndim} {group.number} "{group.name}"' for group in groups]
    top = groups[-1]
    with path.open("wb") as file:
        file.write(b"$MeshFormat\n4.1 1 8\n" + _integers(1) + b"\n$EndMeshFormat\n")
        lines = "\n".join([str(len(names)), *names])
        file.write(f"$PhysicalNames\n{lines}\n$EndPhysicalNames\n".encode())
        file.write(b"$Entities\n" + _entities(points, groups) + b"\n$EndEntities\n")
        n = len(points)
        file.write(b"$Nodes\n" + _sizes(1, n, 1, n) + _integers(top.ndim, top.number, 0))
        file.write(
            _sizes(n) + np.arange(1, n + 1, dtype="<u8").tobytes() + points.astype("<f8").tobytes()
        )
        file.write(b"\n$EndNodes\n$Elements\n")
        count = sum(len(group.cells) for group in groups)
        file.write(_sizes(len(groups), count, 1, count))
        first = 1
        for group in groups:
            number, ndim, order = _KINDS[group.kind]
            file.write(_integers(ndim, group.number, number) + _sizes(len(group.cells)))
            numbers = np.arange(first, first + len(group.cells))
            corners = np.asarray(group.cells, dtype=np.int64)[:, order] + 1
            file.write(np.column_stack((numbers, corners)).astype("<u8").tobytes())
            first += len(group.cells)
        file.write(b"\n$EndElements\n")
        for name, own in of_points.items():
            file.write(_values("NodeData", name, own))
        # Elements are numbered in the order of their groups.
        rows = np.concatenate([group.rows for group in groups])
        for name, own in of_cells.items():
            file.write(_values("ElementData", name, own[rows]))


def _entities(points: Floats, groups: list[Group]) -> bytes:
    """The entities of each dimension: number, bounding box, its single group, and no sides."""
    found = [_sizes(*(sum(group.ndim == ndim for group in groups) for ndim in range(4)))]
    for group in groups:
        places = points[np.unique(group.cells)]
        box = np.concatenate((places.min(axis=0), places.max(axis=0)))
        found += [_integers(group.number), box.astype("<f8").tobytes()]
        found += [_sizes(1), _integers(group.number), _sizes(0)]
    return b"".join(found)


def _values(section: str, name: str, values: NDArray[Any]) -> bytes:
    """A view of values: one string, one time, and three counts before the rows."""
    word = name.replace('"', "")
    head = f'${section}\n1\n"{word}"\n1\n0.0\n3\n0\n1\n{len(values)}\n'
    rows = np.empty(len(values), dtype=[("row", "<i4"), ("value", "<f8")])
    rows["row"], rows["value"] = np.arange(1, len(values) + 1), values
    return head.encode() + rows.tobytes() + f"\n$End{section}\n".encode()


def _integers(*numbers: int) -> bytes:
    return np.array(numbers, dtype="<i4").tobytes()


def _sizes(*numbers: int) -> bytes:
    return np.array(numbers, dtype="<u8").tobytes()
