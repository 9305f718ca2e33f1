"""Coarser and smoother tetrahedra: `TetMesh.coarsen` and `TetMesh.smooth`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_choice, as_limit
from delone._tiling.sizes import chosen
from delone.solids.tetmesh import improving
from delone.solids.tetmesh.improving import Points
from delone.solids.tetmesh.report import ImproveReport
from delone.solids.tetmesh.walls import Kept

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._tiling.space.quality import TetQuality
    from delone.solids.tetmesh.report import Changed

__all__ = ["METHODS", "coarsened", "mesh_of", "smoothed"]

METHODS = ("lloyd", "odt", "laplace")
_GOAL = 20.0


def coarsened(mesh: Any, marked: ArrayLike | None, min_angle: float | None) -> Any:
    """Return a mesh with fewer points; see ``TetMesh.coarsen``."""
    goal = _goal(mesh, min_angle)
    rows = slice(None) if marked is None else chosen(marked, mesh.nsimplex, "tetrahedra")
    given = mesh.npoints - mesh.nadded
    removable = np.zeros(mesh.npoints, dtype=bool)
    removable[mesh.simplices[rows]] = True
    removable[:given] = False
    kept = Kept.of_mesh(mesh)
    arrays = mesh.points, mesh.simplices, kept.labels
    of_points = Points(np.empty(0, dtype=bool), removable, given)
    found = improving.coarsened(arrays, of_points, goal)
    return mesh_of(mesh, kept, *found) if found[0].counts.removed else mesh


def smoothed(
    mesh: Any, how: tuple[int, str], fixed: ArrayLike | None, min_angle: float | None
) -> Any:
    """Return a mesh whose interior points have moved; `how` is (max_iter, method)."""
    limit, method = how
    how_often = as_limit(limit, name="max_iter")
    target = as_choice(method, METHODS, name="method")
    held = improving.as_held(fixed, mesh.npoints)
    goal = _goal(mesh, min_angle)
    kept = Kept.of_mesh(mesh)
    arrays = mesh.points, mesh.simplices, kept.labels
    of_points = Points(held, np.empty(0, dtype=bool), mesh.npoints)
    return mesh_of(mesh, kept, *improving.smoothed(arrays, of_points, goal, (target, how_often)))


def mesh_of(mesh: Any, kept: Kept, made: Changed, judged: ImproveReport, after: TetQuality) -> Any:
    """Return the mesh made from a TetMesh, with the same input faces."""
    names = "face_source", "face_markers", "holes"
    better = type(mesh)._of(
        {
            "points": made.points,
            "simplices": made.simplices,
            "neighbors": made.neighbors,
            "region": kept.own[made.labels],
            # Their corners may be added points that come after removed ones.
            "input_faces": made.renumbered(mesh.input_faces),
            **{name: getattr(mesh, name) for name in names},
        },
        judged,
        len(made.points) - (mesh.npoints - mesh.nadded),
        mesh._workers,
    )
    better._cache["quality"] = after
    return better


def _goal(mesh: Any, given: float | None) -> float:
    """Return the bound on angles: the given one, or else the goal of the mesh."""
    if given is not None:
        return improving.as_goal(given)
    report = mesh.report
    improvement = report if isinstance(report, ImproveReport) else None
    improvement = getattr(report, "improvement", improvement)
    return _GOAL if improvement is None else float(improvement.min_angle)
