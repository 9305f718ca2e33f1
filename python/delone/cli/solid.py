"""Points in space: when the command takes them for that, their triangulation and its figures.

Heights are values over the plane unless something says otherwise, for surveys of the ground have
them, too. A PLY file of points and nothing else is a cloud in space; any other file is taken for
one by ``--3d``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import Delaunay, improve
from delone.cli.exits import Exit, Failure
from delone.cli.report import finite_or_none
from delone.counting import counted
from delone.errors import FileFormatError
from delone.io import PointSet, read_mesh

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from delone import ImproveReport, TetMesh
    from delone.cli.show import Row
    from delone.io import GeometrySet

__all__ = [
    "improved",
    "improvement_figures",
    "improvement_rows",
    "is_space",
    "space_measures",
    "space_rows",
    "space_summary",
    "triangulated_space",
]

_FIRST_DUPLICATES = 5
# The goal of an improvement, in degrees, and its most passes, where the command line has none.
_GOAL = 20.0
_PASSES = 30
# What holds a Delaunay triangulation of space, but no other tetrahedra.
_DELAUNAY_ONLY = (".npz",)


def is_space(source: Path, wanted: bool | None, survey: PointSet | GeometrySet) -> bool:
    """Tell whether the points of a file are to be triangulated in space.

    Parameters
    ----------
    source : Path
        The file.
    wanted : bool or None
        What the command line says; None for nothing.
    survey : PointSet or GeometrySet
        What was read.

    Returns
    -------
    bool
        As wanted; otherwise whether it is a PLY file of points alone, with three coordinates.

    Raises
    ------
    Failure
        Space is wanted, but there are no heights, or no points.
    """
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
    """Triangulate points with their heights as third coordinate.

    Parameters
    ----------
    survey : PointSet
        Points with heights.
    **options
        `method` and `workers`.

    Returns
    -------
    Delaunay
        In space.
    """
    assert survey.z is not None
    return Delaunay(np.column_stack((survey.points, survey.z)), **options)


def improved(
    mesh: Delaunay,
    outputs: Iterable[Path],
    say: Callable[[str], object],
    *,
    min_angle: float | None,
    passes: int | None,
) -> TetMesh:
    """Make tetrahedra better before they are written.

    Parameters
    ----------
    mesh : Delaunay
        In space.
    outputs : iterable of Path
        The files to be written.
    say : callable
        Called with what is going on.
    min_angle : float or None
        The goal for dihedral angles, in degrees.
    passes : int or None
        The most passes.

    Returns
    -------
    TetMesh
        What `delone.improve` makes of them.

    Raises
    ------
    Failure
        A file is of a format for Delaunay triangulations only.
    """
    for path in outputs:
        if path.suffix.lower() in _DELAUNAY_ONLY:
            raise Failure(f"{path}: --improve writes no such files; use .vtu or .msh", Exit.USAGE)
    most = _PASSES if passes is None else passes
    say("improving")

    def told(number: int, below: int) -> None:
        say(f"improving: {counted(below, 'tetrahedron')} below the goal after pass {number}")

    goal = _GOAL if min_angle is None else min_angle
    return improve(mesh, min_angle=goal, max_passes=most, progress=told)


def improvement_figures(report: ImproveReport) -> dict[str, Any]:
    """Return what an improvement did.

    Parameters
    ----------
    report : ImproveReport
        Its report.

    Returns
    -------
    dict
        Angles before and after, tetrahedra below the goal by cause.
    """
    causes, counts = np.unique(report.cause, return_counts=True)
    return {
        "goal": report.min_angle,
        "smallest_dihedral": {"before": report.smallest_before, "after": report.smallest_after},
        "largest_dihedral": {"before": report.largest_before, "after": report.largest_after},
        "below": dict(zip(causes.tolist(), counts.tolist(), strict=True)),
        "edge_removals": report.edge_removals,
        "face_removals": report.face_removals,
        "moves": report.moves,
        "passes": report.passes,
        "exhausted": report.exhausted,
    }


def improvement_rows(figures: dict[str, Any]) -> list[Row]:
    """Return the rows of the report of an improvement.

    Parameters
    ----------
    figures : dict
        As `improvement_figures` returns them.

    Returns
    -------
    list of tuple of str
        Names and values.
    """
    small, large = figures["smallest_dihedral"], figures["largest_dihedral"]
    below = ", ".join(f"{count:,} ({cause})" for cause, count in figures["below"].items())
    return [
        ("smallest dihedral", f"{small['before']:.4g} before, {small['after']:.4g} after"),
        ("largest dihedral", f"{large['before']:.4g} before, {large['after']:.4g} after"),
        (f"below {figures['goal']:g} degrees", below or "none"),
        ("edges removed", f"{figures['edge_removals']:,}"),
        ("faces removed", f"{figures['face_removals']:,}"),
        ("vertices moved", f"{figures['moves']:,} times in {counted(figures['passes'], 'pass')}"),
        *_ended(figures),
    ]


def _ended(figures: dict[str, Any]) -> list[Row]:
    """Say that the limit on passes ended an improvement that was still gaining."""
    if not figures["exhausted"]:
        return []
    return [("ended by", f"--max-passes {figures['passes']}: more passes may gain more")]


def space_summary(mesh: Delaunay) -> dict[str, Any]:
    """Return the counts and measures of a triangulation in space.

    Parameters
    ----------
    mesh : Delaunay
        What to report upon.

    Returns
    -------
    dict
        Counts, duplicates, what Euler's formula says, mean degree, volume.
    """
    n, m, repeats = mesh.npoints, mesh.nsimplex, mesh.coplanar
    distinct, edges, faces = n - len(repeats), len(mesh.edges), len(mesh.faces)
    with np.errstate(over="ignore"):
        volume = float(mesh.volumes.sum())
    first = [
        {"row": row, "same_as": same, "x": x, "y": y, "z": z}
        for (row, _, same), (x, y, z) in zip(
            repeats[:_FIRST_DUPLICATES].tolist(),
            mesh.points[repeats[:_FIRST_DUPLICATES, 0]].tolist(),
            strict=True,
        )
    ]
    return {
        "points": n,
        "distinct": distinct,
        "duplicates": {"count": len(repeats), "first": first},
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
    """Return the measures of any tetrahedra.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        Coordinates.
    simplices : ndarray of int32, shape (m, 4)
        Tetrahedra.

    Returns
    -------
    dict
        Counts.
    """
    return {"points": len(points), "tetrahedra": len(simplices)}


def space_rows(figures: dict[str, Any]) -> list[Row]:
    """Return the rows of the report of a triangulation in space.

    Parameters
    ----------
    figures : dict
        As `space_summary` returns them.

    Returns
    -------
    list of tuple of str
        Names and values.
    """
    duplicates, volume = figures["duplicates"], figures["volume"]
    lines = [f"{duplicates['count']:,}"]
    lines += [
        f"row {d['row']} is row {d['same_as']} at ({d['x']!r}, {d['y']!r}, {d['z']!r})"
        for d in duplicates["first"]
    ]
    if duplicates["count"] > len(duplicates["first"]):
        lines.append("...")
    count, expected = figures["tetrahedra"]["count"], figures["tetrahedra"]["expected"]
    verdict = "=" if count == expected else f"IS NOT {expected:,} ="
    return [
        ("points read", f"{figures['points']:,}"),
        ("distinct", f"{figures['distinct']:,}"),
        ("duplicates", "\n".join(lines)),
        ("hull vertices", f"{figures['hull_vertices']:,}"),
        ("hull faces", f"{figures['hull_faces']:,}"),
        ("tetrahedra", f"{count:,} {verdict} n - edges + faces - 1"),
        ("edges", f"{figures['edges']['count']:,}"),
        ("faces", f"{figures['faces']['count']:,}"),
        ("mean degree", f"{figures['mean_degree']:.4f}"),
        ("volume", "beyond range" if volume is None else f"{volume:,.6g}"),
    ]
