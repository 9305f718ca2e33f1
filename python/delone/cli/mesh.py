"""The command `mesh`: polygons or closed lines to a mesh with bounded angles."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from delone import Mesh, __version__, mesh
from delone.cli.constraints import geometries_of, not_finite
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.options import Chord, Json, Layer, MeshOutput, Order, Quiet
from delone.cli.outputs import ready, write_all
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.report import Stopwatch, summary
from delone.cli.show import print_json, print_report
from delone.errors import CrossingSegmentsError, NonFiniteError
from delone.io.writing import WITH_CRS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from delone.io import GeometrySet

__all__ = ["make_mesh"]

_FIRST = 3


def make_mesh(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="INPUT",
            help="File of polygons, with optional lines and points inside, or of closed lines.",
        ),
    ],
    *,
    output: MeshOutput = None,
    min_angle: Annotated[
        float, typer.Option(help="Minimum angle in degrees: at least 0, below 60.")
    ] = 30.0,
    max_area: Annotated[float | None, typer.Option(help="Maximum area of triangles.")] = None,
    size: Annotated[float | None, typer.Option(help="Target length of edges.")] = None,
    max_points: Annotated[
        int | None, typer.Option(help="Maximum number of added points; by default 5,000,000.")
    ] = None,
    smooth: Annotated[int, typer.Option(help="Number of smoothing rounds after refinement.")] = 0,
    delaunay: Annotated[
        bool, typer.Option("--delaunay", help="Make triangles Delaunay across segments as well.")
    ] = False,
    freeze: Annotated[
        bool, typer.Option("--freeze-boundary", help="Add no points on the boundary.")
    ] = False,
    order: Order = 1,
    chord: Chord = None,
    layer: Layer = None,
    crs: Crs = None,
    planar: Planar = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Mesh polygons, or areas enclosed by lines, with triangles that have no small angles.

    Plots show the mesh and the histogram of its angles.
    """
    require_known(crs)
    with writing():
        protect_inputs(output or (), source)
        writers = {path: ready(path, order=order) for path in output or ()}
    watch = Stopwatch()
    with reading(quiet=quiet), watch.stage("read"):
        survey = geometries_of(source, layer=layer, chord=chord)
    survey = referenced(survey, crs, planar=planar, quiet=quiet, outputs=writers, known=WITH_CRS)
    options: dict[str, Any] = {
        "min_angle": min_angle,
        "max_area": max_area,
        "size": size,
        "max_points": max_points,
        "smooth": smooth,
        "delaunay": delaunay,
        "fixed": "boundary" if freeze else False,
    }
    with _bar(quiet or as_json) as tell:
        found = _meshed(survey, options, tell)
    watch.seconds |= found.stages
    write_all(writers, found, watch, lambda _: None, crs=survey.crs)
    figures: dict[str, Any] = {
        "delone": __version__,
        "input": str(source),
        "crs": survey.crs,
        **summary(found),
        "mesh": _figures(found),
        **watch.ending(
            writers,
            found.npoints,
            others=dict.fromkeys(("read", "triangulate"), found.npoints - found.nadded),
        ),
    }
    if as_json:
        print_json(figures)
    elif not quiet:
        rows = [("points", f"{found.npoints:,}"), ("triangles", f"{found.nsimplex:,}")]
        rows.append(("quality", str(found.report)))
        print_report(str(source), rows, figures)


def _meshed(survey: GeometrySet, options: dict[str, Any], tell: Any) -> Mesh:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            return mesh(survey.geometries, progress=tell, **options)
    except CrossingSegmentsError as error:
        raise Failure(f"{survey.source}: {error}", Exit.DEGENERATE) from error
    except NonFiniteError as error:
        raise not_finite(survey, error) from error


def _figures(found: Mesh) -> dict[str, Any]:
    report = found.report
    corners = sorted(set(report.corner[report.corner >= 0].tolist()))
    return {
        "min_angle": report.min_angle,
        "smallest_angle": report.smallest_angle,
        "largest_angle": report.largest_angle,
        "below": len(report.below),
        "corners": {"count": len(corners), "first": found.points[corners[:_FIRST]].tolist()},
        "needles": {"count": len(report.needles), "first": report.needles[:_FIRST].tolist()},
        "on_segments": report.on_segments,
        "for_angles": report.for_angles,
        "for_sizes": report.for_sizes,
        "exhausted": report.exhausted,
    }


@contextmanager
def _bar(silent: bool) -> Iterator[Callable[[int, float], object] | None]:
    """Show progress on standard error, if that is a terminal."""
    console = Console(stderr=True)
    if silent or not console.is_terminal:
        yield None
        return
    columns = (
        TextColumn("meshing"),
        BarColumn(),
        TextColumn("{task.fields[added]:,} points added, worst angle {task.fields[angle]:.2f}°"),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=console, transient=True) as progress:
        # The total is not known in advance.
        task = progress.add_task("mesh", total=None, added=0, angle=0.0)

        def tell(added: int, angle: float) -> None:
            progress.update(task, added=added, angle=angle)

        yield tell
