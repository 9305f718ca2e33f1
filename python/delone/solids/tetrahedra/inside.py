"""Which cells between the faces of a surface are inside.

A cell is what is connected without crossing a face. Crossing a face changes the winding number by
the orientations of the faces there, and the parity by their number. Cells are reached from the
outside in layers: each gets its number from cells of the layer before. Walls between cells of one
layer and faces inside a cell are not checked, so they may be given once and in any orientation. If
faces repeat others, each counts; if that leads to a contradiction, they count once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.errors import InputError

if TYPE_CHECKING:
    from delone._base.types import Bools, Indices, Rows
    from delone._tiling.space.locking import Sides
    from delone.solids.tetrahedra.covering import Parts

__all__ = ["RULES", "inner_cells"]

RULES = ("winding", "parity", "enclosed")


class _Steps(NamedTuple):
    """Faces between cells: stepping from `behind` to `into` adds `change`; the outside is last."""

    into: Rows
    behind: Rows
    change: Rows
    # A face of each.
    face: Indices


def inner_cells(rule: str, cell: Indices, neighbors: Indices, sides: Sides, parts: Parts) -> Bools:
    """Return which cells are inside by a rule; `cell`, (m,), is that of each tetrahedron."""
    count = int(cell.max(initial=-1)) + 1
    if rule == "enclosed":
        return np.ones(count, dtype=bool)
    parity = rule == "parity"
    of_face = parts.number if parity else parts.net
    for change in (of_face, np.sign(of_face)):
        steps = _steps(cell, neighbors, sides, change, parity=parity)
        number, conflict = _numbers(steps, count, parity=parity)
        if not len(conflict):
            found: Bools = number != 0
            return found
    raise _undefined(parts.source[conflict], parity=parity)


def _steps(
    cell: Indices, neighbors: Indices, sides: Sides, of_face: Rows, *, parity: bool
) -> _Steps:
    """Return the different steps between cells through faces, each with one of these."""
    tetrahedron, corner = np.nonzero(sides.face >= 0)
    face = sides.face[tetrahedron, corner]
    across = neighbors[tetrahedron, corner]
    outside = int(cell.max(initial=-1)) + 1
    into = cell[tetrahedron].astype(np.int64)
    behind = np.where(across < 0, outside, cell[across]).astype(np.int64)
    # Where the normal points out, the tetrahedron is on the inner side.
    change = of_face[face] if parity else sides.out[tetrahedron, corner] * of_face[face]
    # Whole rows by one number each: pairs of cells, then pairs with changes.
    _, pair = np.unique(into * (outside + 1) + behind, return_inverse=True)
    least = int(change.min(initial=0))
    span = int(change.max(initial=0)) - least + 1
    _, first = np.unique(pair * span + (change - least), return_index=True)
    return _Steps(into[first], behind[first], change[first].astype(np.int64), face[first])


def _numbers(steps: _Steps, count: int, *, parity: bool) -> tuple[Rows, Indices]:
    """Return the winding number of each cell, or its parity, and two faces that contradict."""
    number = np.zeros(count + 1, dtype=np.int64)
    known = np.zeros(count + 1, dtype=bool)
    known[count] = True
    # Each round reaches at least one more cell, because all are connected to the outside.
    while not known.all():
        rows = np.flatnonzero(known[steps.behind] & ~known[steps.into])
        if not len(rows):
            break
        into = steps.into[rows]
        wanted = number[steps.behind[rows]] + steps.change[rows]
        if parity:
            wanted %= 2
        order = np.argsort(into, kind="stable")
        into, wanted, rows = into[order], wanted[order], rows[order]
        conflict = np.flatnonzero((into[1:] == into[:-1]) & (wanted[1:] != wanted[:-1]))
        if len(conflict):
            at = conflict[0]
            return number[:count], steps.face[rows[at : at + 2]]
        number[into] = wanted
        known[into] = True
    return number[:count], np.empty(0, dtype=np.int32)


def _undefined(faces: Indices, *, parity: bool) -> InputError:
    a, b = faces.tolist()
    if parity:
        return InputError(
            f"the parity of a region differs between the faces {a} and {b}: what is inside is not "
            'defined; use inside="enclosed", and holes for what is empty'
        )
    return InputError(
        f"the winding number of a region differs between the faces {a} and {b}: they are not "
        'oriented alike, see check_surface; reverse one, or use inside="parity" or '
        'inside="enclosed"'
    )
