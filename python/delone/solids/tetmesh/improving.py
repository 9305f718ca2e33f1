"""The call of the core that improves tetrahedra, for `improve` and for refined meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_number
from delone._tiling.space import quality
from delone.errors import InputError, ShapeError
from delone.solids.tetmesh import report

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone._base.types import Bools, Floats, Indices
    from delone._core import ImprovedMesh
    from delone._tiling.space.quality import TetQuality
    from delone.solids.tetmesh.report import ImproveReport

__all__ = ["as_goal", "improved"]

# The dihedral angle of the regular tetrahedron, acos(1/3).
_LARGEST_GOAL = 70.528


def as_goal(value: float) -> float:
    """Return a goal for the smallest dihedral angle."""
    goal = as_number(value, name="min_angle")
    if not 0 <= goal <= _LARGEST_GOAL:
        raise InputError(f"min_angle must be from 0 to {_LARGEST_GOAL}, got {value!r:.80}")
    return goal


def improved(
    mesh: tuple[Floats, Indices, Indices],
    held: Bools,
    goal: float,
    *,
    kinds: tuple[bool, bool, bool] = (True, True, False),
    limits: tuple[bool, int, int] = (False, 30, 0),
    progress: Callable[[int, int], object] | None = None,
) -> tuple[ImprovedMesh, ImproveReport, TetQuality]:
    """Improve ``(points, simplices, labels)``; return the mesh, its report and its measures.

    `held` are points that must not move, or empty; `kinds` are (flips, smooth, exude), and `limits`
    whether coplanar faces of the boundary may be flipped, the maximum number of passes, and that of
    added points.
    """
    points, simplices, labels = mesh
    try:
        made = _core.improve3(points, simplices, labels, held, goal, *kinds, *limits, progress)
    except ShapeError as error:
        raise InputError(*error.args) from None
    before = quality.measured(points, simplices)
    free = np.zeros(len(made.points) - len(held), dtype=bool)
    held = np.concatenate((held, free))
    judged, after = report.report(before, made, held, goal)
    return made, judged, after
