"""The command ``simplify``: a surface with fewer triangles, within an error of all points."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from delone.cli.exits import Exit, Failure, protect_inputs, writing
from delone.cli.options import outputs
from delone.cli.outputs import ready, write_all
from delone.cli.referenced import require_known
from delone.cli.report import Stopwatch
from delone.cli.show import spinner
from delone.cli.surfaces import (
    SurfaceOptions,
    Survey,
    figures_of,
    print_figures,
    surface,
    with_surface,
)
from delone.errors import InternalError
from delone.terrain.simplifying import KEEP

if TYPE_CHECKING:
    from delone.terrain import Simplification

__all__ = ["simplify"]


@with_surface
def simplify(
    source: Survey,
    *,
    max_error: Annotated[
        float | None,
        typer.Option(help="Largest vertical distance of a point from the new surface."),
    ] = None,
    max_triangles: Annotated[
        int | None, typer.Option(help="Number of triangles instead, with the smallest error.")
    ] = None,
    keep: Annotated[
        str, typer.Option(help="Edges that stay: " + ", ".join(KEEP) + ".")
    ] = "breaklines",
    prove: Annotated[
        bool, typer.Option("--prove", help="Prove the error by exact arithmetic.")
    ] = False,
    output: Annotated[list[Path] | None, outputs("Mesh to write", (".ply", ".xml", "..."))] = None,
    options: SurfaceOptions,
) -> None:
    """Leave out points of a surface, with a bound on the error at each of them.

    Lines and the outline stay.
    """
    if (max_error is None) == (max_triangles is None):
        raise Failure("give one of --max-error and --max-triangles", Exit.USAGE)
    require_known(options.crs)
    with writing():
        protect_inputs(output or [], source, *options.inputs())
        writers = {path: ready(path) for path in output or []}
    watch = Stopwatch()
    goal: dict[str, Any] = {"max_error": max_error, "max_triangles": max_triangles}
    with spinner(options.silent) as say:
        tin = surface(source, options, watch, say)
        say("simplifying")
        with watch.stage("simplify"):
            levels = tin.simplification(**goal, keep=keep)
            small = levels.surface(**goal)
        if prove:
            say("proving the error")
            with watch.stage("prove"):
                _prove(levels, goal)
        write_all(writers, small, watch, say, z=small.z, crs=small.crs)
    figures = figures_of(source, small, output) | {
        "points_before": tin.npoints,
        "triangles_before": tin.nsimplex,
        "error": float(levels.errors[levels.triangles == small.nsimplex].min()),
        "stages": watch.rows(tin.npoints),
    }
    print_figures(source, figures, as_json=options.as_json, quiet=options.quiet)


def _prove(levels: Simplification, goal: dict[str, Any]) -> None:
    found = levels.validate(**goal)
    if not found:
        raise InternalError(f"the error of the surface does not hold: {found}")
