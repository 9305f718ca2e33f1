"""3-D input of the command: detection, triangulation and figures.

Heights are values at 2-D points unless requested otherwise, because surveys of the ground also have
them. A PLY file that contains only points is read as a 3-D point cloud, and so is any other file if
``--3d`` is given.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import Delaunay, improve
from delone._base.counting import counted
from delone.cli.exits import Exit, Failure
from delone.cli.report import finite_or_none, repeated_rows
from delone.errors import FileFormatError
from delone.io import PointSet, read_mesh

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from delone import TetMesh
    from delone.cli.show import Row
    from delone.io import GeometrySet

__all__ = [
    "improved",
    "improvement_figures",
    "improvement_rows",
    "is_space",
    "space_measures",
    "space_summary",
    "triangulated_space",
]

# Defaults of the command for the goal, in degrees, and for the maximum number of passes.
_GOAL = 20.0
_PASSES = 30
# Formats for 3-D Delaunay triangulations, not for other tetrahedra.
_DELAUNAY_ONLY = (".npz",)


def is_space(source: Path, wanted: bool | None, survey: PointSet | GeometrySet) -> bool:
    """Return `wanted` if given, else whether the file is PLY with only points, in 3-D."""
    if wanted is None:
        return (
            source.suffix.lower() == ".ply"
            and isinstance(survey, PointSet)
            and survey.z is not None
            and _has_no_faces(source)
        )
    if wanted and (not isinstance(survey, PointSet) or survey.z is None):
        raise Failure(f"{source}: --3d needs points with three coordinates", Exit.USAGE)
    return wanted


def _has_no_faces(source: Path) -> bool:
    try:
        read_mesh(source)
    except FileFormatError:
        return True
    return False


def triangulated_space(survey: PointSet, **options: Any) -> Delaunay:
    """Triangulate points with their heights as third coordinate, with `method` and `workers`."""
    assert survey.z is not None
    return Delaunay(np.column_stack((survey.points, survey.z)), **options)


def improved(
    mesh: Delaunay,
    outputs: Iterable[Path],
    say: Callable[[str], object],
    *,
    min_angle: float | None,
    passes: int | None,
    most_points: int | None,
) -> TetMesh:
    """Improve tetrahedra until dihedral angles reach `min_angle`, in degrees.

    Outputs of a format for Delaunay triangulations only are rejected.
    """
    for path in outputs:
        if path.suffix.lower() in _DELAUNAY_ONLY:
            raise Failure(
                f"{path}: --improve cannot write this format; use .vtu or .msh", Exit.USAGE
            )
    most = _PASSES if passes is None else passes
    say("improving")

    def told(number: int, below: int) -> None:
        say(f"improving: {counted(below, 'tetrahedron')} below the goal after pass {number}")

    goal = _GOAL if min_angle is None else min_angle
    return improve(mesh, min_angle=goal, max_points=most_points or 0, max_iter=most, progress=told)


def improvement_figures(report: Any) -> dict[str, Any]:
    """Return angles before and after, and the tetrahedra below the goal by cause."""
    causes, counts = np.unique(report.cause, return_counts=True)
    return {
        "goal": report.min_angle,
        "smallest_dihedral": {"before": report.smallest_before, "after": report.smallest_after},
        "largest_dihedral": {"before": report.largest_before, "after": report.largest_after},
        "below": dict(zip(causes.tolist(), counts.tolist(), strict=True)),
        "edge_removals": report.edge_removals,
        "face_removals": report.face_removals,
        "moves": report.moves,
        "points_added": report.points_added,
        "passes": report.passes,
        "exhausted": report.exhausted,
    }


def improvement_rows(figures: dict[str, Any]) -> list[Row]:
    """Return the rows of the report from `improvement_figures`."""
    small, large = figures["smallest_dihedral"], figures["largest_dihedral"]
    below = ", ".join(f"{count:,} ({cause})" for cause, count in figures["below"].items())
    return [
        ("smallest dihedral", f"{small['before']:.4g} before, {small['after']:.4g} after"),
        ("largest dihedral", f"{large['before']:.4g} before, {large['after']:.4g} after"),
        (f"below {figures['goal']:g} degrees", below or "none"),
        ("edges removed", f"{figures['edge_removals']:,}"),
        ("faces removed", f"{figures['face_removals']:,}"),
        ("vertices moved", f"{figures['moves']:,} times in {counted(figures['passes'], 'pass')}"),
        ("vertices added", f"{figures['points_added']:,}"),
        *_ended(figures),
    ]


def _ended(figures: dict[str, Any]) -> list[Row]:
    """Return a note if the limit on passes stopped an improvement that was still progressing."""
    if not figures["exhausted"]:
        return []
    return [
        ("stopped by", f"the limit on passes ({figures['passes']}); more may improve the result")
    ]


def space_summary(mesh: Delaunay) -> dict[str, Any]:
    """Return counts, the count expected from Euler's formula, duplicates, and measures."""
    n, m, edges, faces = mesh.npoints, mesh.nsimplex, len(mesh.edges), len(mesh.faces)
    distinct = n - len(mesh.coplanar)
    with np.errstate(over="ignore"):
        volume = float(mesh.volumes.sum())
    return {
        "points": n,
        "distinct": distinct,
        "duplicates": repeated_rows(mesh),
        "hull_vertices": len(mesh.hull),
        "hull_faces": len(mesh.convex_hull),
        # Euler: vertices - edges + faces - tetrahedra = 1.
        "tetrahedra": {"count": m, "expected": distinct - edges + faces - 1},
        "edges": {"count": edges, "expected": None},
        "faces": {"count": faces, "expected": None},
        "mean_degree": 2 * edges / distinct,
        "volume": finite_or_none(volume),
        "bounds": [*mesh.min_bound.tolist(), *mesh.max_bound.tolist()],
    }


def space_measures(points: NDArray[np.float64], simplices: NDArray[np.int32]) -> dict[str, Any]:
    """Return the counts of arbitrary tetrahedra."""
    return {"points": len(points), "tetrahedra": len(simplices)}
