"""How rings of cells on the sphere nest: holes are inside outer rings, and parts do not overlap.

Cells within a hemisphere are compared by the areas that their rings share. For cells that are
divided into triangles, the regions between their rings form a tree, which needs no areas.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone.areal.nested import badly_nested, nesting_problem
from delone.constrained.coverage import beside, containing, odd_pairs
from delone.errors import DirectionError

if TYPE_CHECKING:
    from delone._base.types import Bools, Indices, Rows
    from delone.sphere.constrained import ConstrainedDelaunay

__all__ = ["nested", "refuse", "require_nested"]


def require_nested(arrays: tuple[Any, ...], left_out: Rows, workers: int | None) -> None:
    """Reject cells with a hole that is not inside its outer ring, or with overlapping parts.

    The cells `left_out` are checked elsewhere.
    """
    build = _core.CellGrid.polygons
    refuse(badly_nested(arrays, build, as_workers(workers), left_out=left_out))


def refuse(rows: Rows) -> None:
    """Raise an error if there are cells whose rings nest in a wrong way."""
    if len(rows):
        raise DirectionError(nesting_problem(rows), rows=rows[:10].tolist(), count=len(rows))


def nested(mesh: ConstrainedDelaunay, chosen: Bools, rings: Indices, holes: Bools) -> bool:
    """Whether each hole of a cell is inside its outer ring, and no parts overlap.

    The segments of `mesh` are the sides of the cell, and `chosen` marks the components of the mesh
    that are in it; `rings` has the ring of each segment, and `holes` marks rings that are holes.

    Components that the same rings separate from the first one are in one region. Rings do not
    cross, so each separates two regions: a region in the cell and one outside of it. Therefore all
    is right if the rings around each region in the cell are an outer ring and holes of it.
    """
    made, component = mesh._made, mesh._component
    around: list[list[int]] = [[] for _ in chosen]
    for at, ring in containing(made, rings, component, from_outside=False).tolist():
        around[at].append(ring)
    numbers: dict[tuple[int, ...], int] = {}
    region = np.array([numbers.setdefault(tuple(each), len(numbers)) for each in around])
    # Rings beside components in the cell, and whether no other ring has the same side.
    row, ring = odd_pairs(made.source_start, made.source, rings).T
    alone = np.tile(np.bincount(row)[row] == 1, 2)
    place = beside(made, component)[row].T.ravel()
    ring, inside = np.tile(ring, 2), chosen[place]
    part = np.cumsum(~holes) - 1
    keys = region[place] * np.int64(len(holes)) + part[ring]
    found = np.unique(keys[inside & alone])
    # A region has one part, whose outer ring is beside it.
    single = len(np.unique(found // len(holes))) == len(found)
    return single and bool(np.isin(found, keys[inside & ~holes[ring]]).all())
