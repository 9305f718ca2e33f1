"""Exact validation of a mesh file: the command ``delone check``."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import ConstrainedDelaunay, ConstrainedReport
from delone.cli.exits import Exit, Failure, reading
from delone.cli.faces import check_faces
from delone.cli.options import Json, Quiet
from delone.cli.report import Stopwatch, geometry
from delone.cli.show import print_json, print_rows, print_text, spinner
from delone.cli.solid import space_measures
from delone.errors import InputError
from delone.io import read_mesh
from delone.io.arrays import is_constrained
from delone.io.registry import mesh_suffixes
from delone.validation import SpaceReport, ValidationReport, validate

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone.io import MeshFile

__all__ = ["check"]

_FIRST = 10


def check(
    mesh: Annotated[
        Path,
        typer.Argument(
            metavar="MESH", help="File of triangles or tetrahedra: " + " ".join(mesh_suffixes())
        ),
    ],
    *,
    canonical: Annotated[
        bool,
        typer.Option(
            "--canonical", help="Require delone's choice of diagonals among cocircular points."
        ),
    ] = False,
    surface: Annotated[
        bool,
        typer.Option(
            "--surface",
            help="3-D: check instead that triangles do not cross and enclose a region.",
        ),
    ] = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Prove exactly that triangles are Delaunay, or name the faults and exit with 1."""
    if surface and canonical:
        raise Failure("--canonical is for triangulations, not for --surface", Exit.USAGE)
    with spinner(quiet or as_json) as say:
        if surface:
            figures, lines = check_faces(mesh, say=say, quiet=quiet)
        else:
            figures, lines = _figures(mesh, canonical=canonical, say=say, quiet=quiet)
    if as_json:
        print_json(figures)
    elif not quiet:
        counts = ("points", "triangles", "tetrahedra", "faces")
        names = [name for name in counts if name in figures]
        print_rows(str(mesh), [(name, f"{figures[name]:,}") for name in names])
        print_text("\n".join(lines))
    if not figures["ok"]:
        raise typer.Exit(Exit.NOT_DELAUNAY)


def _figures(
    path: Path, *, canonical: bool, say: Callable[[str], None], quiet: bool
) -> tuple[dict[str, Any], list[str]]:
    """Prove that triangles are Delaunay, or name the faults: figures, with ``ok``, and lines.

    Files of `ConstrainedDelaunay.save` are checked as constrained triangulations. With `canonical`,
    a different choice among cocircular points is a fault. `say` is called with the current step.
    """
    watch = Stopwatch()
    say(f"reading {path.name}")
    with reading(quiet=quiet), watch.stage("read"):
        mesh = read_mesh(path)
    solid = mesh.points.shape[1] == 3
    say(f"checking {len(mesh.simplices):,} {'tetrahedra' if solid else 'triangles'}")
    with watch.stage("check"):
        report = _checked(mesh, path)
    faults = {each.name: getattr(report, each.name) for each in fields(report)}
    faults = {name: culprits for name, culprits in faults.items() if culprits.size}
    # Which of several equal rows is the vertex, and which diagonal divides a cocircular polygon, is
    # delone's own choice; other programs may choose differently.
    delaunay = set(faults) <= {"ties", "repeats"}
    figures = {
        "input": str(path),
        "ok": delaunay and not (canonical and faults),
        "delaunay": delaunay,
        "canonical": not faults,
        **(space_measures if solid else geometry)(mesh.points, mesh.simplices),
        "faults": {name: _fault(name, culprits) for name, culprits in faults.items()},
        "stages": watch.rows(len(mesh.points)),
    }
    return figures, _lines(report, mesh, delaunay)


def _checked(mesh: MeshFile, path: Path) -> ValidationReport:
    if is_constrained(path):
        with reading():
            return ConstrainedDelaunay.load(path).validate()
    try:
        return validate(mesh.points, mesh.simplices, neighbors=mesh.neighbors)
    except InputError as error:
        raise Failure(f"{mesh.source}: {error}", Exit.INPUT) from error


def _fault(name: str, culprits: NDArray[np.int64]) -> dict[str, Any]:
    if name == "count":
        return {"expected": int(culprits[0]), "found": int(culprits[1])}
    return {"count": len(culprits), "first": culprits[:_FIRST].tolist()}


def _lines(report: ValidationReport, mesh: MeshFile, delaunay: bool) -> list[str]:
    if report.ok:
        return [f"{report}, proven exactly"]
    if delaunay:
        lines = ["a Delaunay triangulation, proven exactly, but not the canonical one:"]
        if ties := len(report.ties):
            solid = mesh.points.shape[1] == 3
            what = "tetrahedra share a sphere" if solid else "triangles share a circle"
            lines.append(f"  {ties:,} pairs of {what} and have different diagonals")
        if repeats := len(report.repeats):
            lines.append(f"  {repeats:,} vertices are not the first row with their coordinates")
        return lines
    lines = str(report).replace("a canonical", "a", 1).splitlines()
    # The row numbers of a ConstrainedReport refer to all triangles of the hull.
    shown = not isinstance(report, ConstrainedReport | SpaceReport)
    return lines + _coordinates(report, mesh) if shown else lines


def _coordinates(report: ValidationReport, mesh: MeshFile) -> list[str]:
    """Return the coordinates of the corners of the first faults."""
    triangles = np.concatenate(
        (report.delaunay[:3].reshape(-1), report.orientation[:3], report.neighbors[:3])
    )
    seen = list(dict.fromkeys(triangles.tolist()))[:6]
    return [
        f"  triangle {t}: "
        + ", ".join(
            f"{v} ({mesh.points[v, 0]!s}, {mesh.points[v, 1]!s})" for v in mesh.simplices[t]
        )
        for t in seen
    ]
