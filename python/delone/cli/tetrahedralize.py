"""The command `tetrahedralize`: a closed surface to tetrahedra."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import RefinementReport, TetMesh, __version__, improve, tetrahedralize
from delone.cli.exits import Exit, Failure, protect_inputs, writing
from delone.cli.faces import read_parts
from delone.cli.options import Json, MeshOutput, Order, Quiet, Workers
from delone.cli.outputs import ready, write_all
from delone.cli.report import Stopwatch, finite_or_none
from delone.cli.show import show_figures, spinner
from delone.cli.solid import improvement_figures, improvement_rows
from delone.errors import (
    BudgetExceededError,
    CrossingFacesError,
    CrowdedFacesError,
    DanglingFacesError,
    DegenerateInputError,
    NonFiniteError,
    OpenSurfaceError,
)
from delone.io.registry import mesh_suffixes

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from delone import RecoveryReport
    from delone.cli.show import Row

_UNORIENTED = (".smesh", ".poly", ".face")
__all__ = ["fill"]

_STAGES = {
    "check": "checking the surface",
    "recover": "recovering faces",
    "select": "selecting what is inside",
    "refine": "adding points for sizes and shapes",
    "done": "done",
}
# The surface is at fault, not the command line.
_OF_SURFACE = (
    BudgetExceededError,
    CrossingFacesError,
    CrowdedFacesError,
    DanglingFacesError,
    DegenerateInputError,
    NonFiniteError,
    OpenSurfaceError,
)
_COUNTS = ("missing_edges", "missing_faces", "flips")
_ROWS = ("duplicate_points", "subdivided", "repeated", "degenerate", "dangling", "outside", "recut")
_FIRST = 10


def fill(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="INPUT", help="File of a closed surface: " + " ".join(mesh_suffixes())
        ),
    ],
    *,
    output: MeshOutput = None,
    inside: Annotated[
        str | None,
        typer.Option(
            help="What to fill: winding (winding numbers other than 0), parity (odd numbers) or "
            "enclosed (all regions); by default winding, but enclosed for .smesh, .poly and .face."
        ),
    ] = None,
    boundary: Annotated[
        str,
        typer.Option(help="What to keep: faces, or surface (triangles in one plane are replaced)."),
    ] = "faces",
    imprint: Annotated[
        bool,
        typer.Option("--imprint", help="First cut triangles where they cross, overlap or touch."),
    ] = False,
    tolerance: Annotated[
        float | None,
        typer.Option(
            help="How far the mesh may be from the surface of the file, in its unit. With "
            "--imprint, join vertices, edges and faces that are closer; with --boundary surface "
            "and sizes or bounds on shapes, join triangles that are this close to one plane."
        ),
    ] = None,
    hole: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y,Z",
            help="Leave the region around a point empty, instead of the holes of the file; "
            "repeatable.",
        ),
    ] = None,
    region: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X,Y,Z,LABEL",
            help="Label the region around a point, instead of those of the file; repeatable.",
        ),
    ] = None,
    size: Annotated[
        float | None, typer.Option(help="Target edge length, in the unit of the file.")
    ] = None,
    max_volume: Annotated[
        float | None, typer.Option(help="Largest volume of a tetrahedron.")
    ] = None,
    radius_edge: Annotated[
        float | None,
        typer.Option(help="Maximum ratio of circumradius to shortest edge; 2 if sizes are given."),
    ] = None,
    min_angle: Annotated[
        float | None,
        typer.Option(
            help="Goal for the smallest dihedral angle in degrees; 20 if sizes are given."
        ),
    ] = None,
    max_points: Annotated[
        int | None,
        typer.Option(
            help="Maximum number of added points; by default a million for filling, or ten per "
            "face if that is more, and two million for sizes and angles."
        ),
    ] = None,
    better: Annotated[
        bool,
        typer.Option(
            "--improve", help="Remove slivers; all triangles are kept. Implied by sizes and angles."
        ),
    ] = False,
    order: Order = 1,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Fill a closed surface with tetrahedra; by default, its triangles are kept exactly.

    Holes, regions and face markers in .smesh and .poly files are used.

    With ``--boundary surface``, triangles in one plane are replaced, which adds fewer points, and
    they are divided where sizes and ``--radius-edge`` require it. Sizes, ``--radius-edge`` and
    ``--min-angle`` add points inside.

    With ``--imprint``, bodies may overlap or be in contact: their triangles are cut where they
    meet, at rounded points.

    A PNG file shows the tetrahedra behind a cut.
    """
    with writing():
        protect_inputs(output or (), source)
        writers = {path: ready(path, space=True, order=order) for path in output or ()}
    options: dict[str, Any] = {
        "boundary": boundary,
        "imprint": imprint,
        "tolerance": tolerance,
        # Faces in TetGen files can have any orientation.
        "inside": inside or ("enclosed" if source.suffix.lower() in _UNORIENTED else "winding"),
        "holes": _numbers(hole, "--hole", 3),
        "regions": _numbers(region, "--region", 4),
        "size": size,
        "max_volume": max_volume,
        "radius_edge": radius_edge,
        "min_angle": min_angle,
        "max_points": max_points,
        "workers": workers,
    }
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with watch.stage("read"):
            points, given = read_parts(source, quiet=quiet)
            faces = given.simplices
        options["face_markers"] = given.markers
        for name in ("holes", "regions"):
            # Seeds on the command line replace those in the file, as in Python.
            if options[name] is None:
                options[name] = getattr(given, name)
        with watch.stage("tetrahedralize"):
            mesh = _filled(source, (points, faces), options, say)
        gained: dict[str, Any] = {}
        figures = _figures(mesh)
        if isinstance(mesh.report, RefinementReport):
            if mesh.report.improvement is not None:
                gained = {"improvement": improvement_figures(mesh.report.improvement)}
        elif better:
            say("improving")
            with watch.stage("improve"):
                mesh = improve(mesh)
            gained = {"improvement": improvement_figures(mesh.report)}
        write_all(writers, mesh, watch, say, z=None, crs=None, edges=False)
    figures = {
        "delone": __version__,
        "input": str(source),
        "faces": len(faces),
        "file_holes": 0 if given.holes is None else len(given.holes),
        "file_regions": 0 if given.regions is None else len(given.regions),
        "face_markers": [] if given.markers is None else np.unique(given.markers).tolist(),
        **figures,
        **gained,
        **watch.ending(writers, mesh.npoints),
    }
    show_figures(str(source), figures, _rows, as_json=as_json, quiet=quiet)


def _numbers(given: Sequence[str] | None, option: str, columns: int) -> list[list[float]] | None:
    """Return the numbers of an option, one list for each time it is given."""
    if not given:
        return None
    found = []
    for text in given:
        try:
            numbers = [float(part) for part in text.split(",")]
        except ValueError:
            numbers = []
        if len(numbers) != columns or not all(map(math.isfinite, numbers)):
            raise Failure(
                f"{option} takes {columns} numbers with commas, got {text!r:.80}", Exit.USAGE
            )
        found.append(numbers)
    return found


def _filled(
    source: Path, surface: tuple[Any, Any], options: dict[str, Any], say: Callable[[str], object]
) -> TetMesh:
    def told(stage: str, done: float) -> None:
        say(f"{_STAGES[stage]} ({done:.0%})")

    try:
        return tetrahedralize(*surface, progress=told, **options)
    except _OF_SURFACE as error:
        raise Failure(f"{source}: {error}", Exit.DEGENERATE) from error


def _figures(mesh: TetMesh) -> dict[str, Any]:
    report: Any = mesh.report
    recovery, refinement = report, {}
    if isinstance(report, RefinementReport):
        recovery = report.recovery
        refinement = {"refinement": _refinement(report)}
    quality = mesh.quality()
    labels, counts = np.unique(mesh.region, return_counts=True)
    with np.errstate(over="ignore"):
        volume = float(mesh.volumes.sum())
    return {
        "points": mesh.npoints,
        "added": mesh.nadded,
        "tetrahedra": mesh.nsimplex,
        "regions": dict(zip(map(str, labels.tolist()), counts.tolist(), strict=True)),
        "volume": finite_or_none(volume),
        "smallest_dihedral": float(quality.smallest_dihedral.min()),
        "largest_dihedral": float(quality.largest_dihedral.max()),
        "kept": recovery.ok,
        **{name: int(getattr(recovery, name)) for name in _COUNTS},
        **{
            name: _listed(getattr(recovery, name)) for name in _ROWS if len(getattr(recovery, name))
        },
        "report": str(recovery),
        **_imprint(recovery),
        **refinement,
    }


def _imprint(report: RecoveryReport) -> dict[str, Any]:
    """Return the figures on faces that were cut where they meet, if any."""
    if not len(report.imprinted):
        return {}
    return {"imprint": {"parts": len(report.imprinted), "distance": report.imprint_distance}}


def _refinement(report: RefinementReport) -> dict[str, Any]:
    counts = ("on_segments", "on_facets", "for_sizes", "for_shapes")
    return {
        **{name: getattr(report, name) for name in counts},
        "radius_edge": finite_or_none(report.radius_edge),
        "largest_radius_edge": finite_or_none(report.largest_radius_edge),
        "largest_size_ratio": report.largest_size_ratio,
        "too_large": _listed(report.too_large),
        "above_ratio": _listed(report.above_ratio),
        "surface_distance": report.surface_distance,
        "exhausted": report.exhausted,
    }


def _listed(rows: Any) -> dict[str, Any]:
    return {"count": len(rows), "first": rows[:_FIRST].tolist()}


def _rows(figures: dict[str, Any]) -> list[Row]:
    volume, regions = figures["volume"], figures["regions"]
    rows = [
        ("faces", f"{figures['faces']:,}"),
        ("points", f"{figures['points']:,}"),
        ("tetrahedra", f"{figures['tetrahedra']:,}"),
        ("regions", ", ".join(f"{label} ({count:,})" for label, count in regions.items())),
        ("volume", "beyond range" if volume is None else f"{volume:,.6g}"),
        ("report", figures["report"]),
    ]
    if "refinement" in figures:
        rows += _refinement_rows(figures["refinement"])
        distance = figures["refinement"]["surface_distance"]
        if distance:
            rows.append(("distance from the surface", f"at most {distance:.2g}"))
    if "improvement" in figures:
        return rows + improvement_rows(figures["improvement"])
    small, large = figures["smallest_dihedral"], figures["largest_dihedral"]
    return [*rows, ("dihedral angles", f"{small:.4g} to {large:.4g} degrees")]


def _refinement_rows(figures: dict[str, Any]) -> list[Row]:
    large, above = figures["too_large"]["count"], figures["above_ratio"]["count"]
    rows = [
        (
            "points on the surface",
            f"{figures['on_facets']:,} on faces, {figures['on_segments']:,} on edges",
        ),
        (
            "points inside",
            f"{figures['for_sizes']:,} for sizes, {figures['for_shapes']:,} for shapes",
        ),
        (
            "larger than the size",
            f"{large:,}, up to {figures['largest_size_ratio']:.3g} times" if large else "none",
        ),
        ("above the radius-edge ratio", f"{above:,}" if above else "none"),
    ]
    if figures["exhausted"]:
        rows.append(("stopped by", "the limit on points, --max-points"))
    return rows
