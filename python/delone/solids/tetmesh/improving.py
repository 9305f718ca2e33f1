"""The calls of the core that improve, coarsen and smooth tetrahedra, with their report."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone._base.numbers import as_between, as_nonnegative
from delone._base.values import as_marks
from delone._tiling.space import quality
from delone.errors import InputError, ShapeError
from delone.solids.tetmesh import report
from delone.solids.tetmesh.report import Changed

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats, Indices
    from delone._core import ImprovedMesh
    from delone._tiling.space.quality import TetQuality
    from delone.solids.tetmesh.report import ImproveReport

__all__ = ["Points", "as_goal", "as_held", "as_tolerance", "coarsened", "improved", "smoothed"]

# The dihedral angle of the regular tetrahedron, acos(1/3).
_LARGEST_GOAL = 70.528


def as_goal(value: float) -> float:
    """Return a goal for the smallest dihedral angle."""
    return as_between(value, 0, _LARGEST_GOAL, name="min_angle")


def as_tolerance(value: float, boundary: str) -> float:
    """Return how far the surface may move, for a checked `boundary`."""
    nearby = as_nonnegative(value, name="tolerance", finite=True)
    if nearby and boundary != "surface":
        raise InputError('tolerance needs boundary="surface"')
    return nearby


def as_held(fixed: ArrayLike | None, count: int) -> Bools:
    """Return the mask of points that must not move; empty for None."""
    if fixed is None:
        return np.empty(0, dtype=bool)
    return as_marks(fixed, count, name="fixed", of="points")


class Points(NamedTuple):
    """Which points may move and which may be removed: masks, or empty arrays for none."""

    # Those that must not move.
    held: Bools
    # Those that may be removed.
    removable: Bools
    # Points from this row on were added; if they are removed, their rows are left out.
    added: int

    @classmethod
    def free(cls, count: int) -> Points:
        """Return masks for points that may all move, and none of which may be removed."""
        none = np.empty(0, dtype=bool)
        return cls(none, none, count)


def improved(
    mesh: tuple[Floats, Indices, Indices],
    of_points: Points,
    goal: float,
    *,
    kinds: tuple[bool, bool, bool] = (True, True, False),
    surface: tuple[bool, float] = (False, 0.0),
    limits: tuple[int, int] = (30, 0),
    progress: Callable[[int, int], object] | None = None,
) -> tuple[Changed, ImproveReport, TetQuality]:
    """Improve ``(points, simplices, labels)``; return the mesh, its report and its measures.

    `kinds` are (flips, smooth, exude), `surface` whether only the surface of the boundary is kept,
    and within which distance, and `limits` the maximum numbers of passes and of added points.
    """
    held, removable, _ = of_points
    return _judged(
        mesh,
        of_points,
        goal,
        lambda: _core.improve3(*mesh, held, removable, goal, *kinds, *surface, *limits, progress),
    )


def coarsened(
    mesh: tuple[Floats, Indices, Indices], of_points: Points, goal: float
) -> tuple[Changed, ImproveReport, TetQuality]:
    """Remove points of ``(points, simplices, labels)``, no two of which are neighbors."""
    removable = of_points.removable
    return _judged(mesh, of_points, goal, lambda: _core.coarsen3(*mesh, removable, goal))


def smoothed(
    mesh: tuple[Floats, Indices, Indices], of_points: Points, goal: float, how: tuple[str, int]
) -> tuple[Changed, ImproveReport, TetQuality]:
    """Move points of ``(points, simplices, labels)``; `how` is (method, rounds)."""
    held = of_points.held
    return _judged(mesh, of_points, goal, lambda: _core.smooth3(*mesh, held, goal, *how))


def _judged(
    mesh: tuple[Floats, Indices, Indices],
    of_points: Points,
    goal: float,
    change: Callable[[], ImprovedMesh],
) -> tuple[Changed, ImproveReport, TetQuality]:
    points, simplices, _ = mesh
    try:
        made = Changed.of(change(), of_points.added)
    except ShapeError as error:
        raise InputError(*error.args) from None
    before = quality.measured(points, simplices)
    held = np.zeros(len(made.left), dtype=bool)
    held[: len(of_points.held)] = of_points.held
    judged, after = report.report(before, made, held[made.left], goal)
    return made, judged, after
