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
    with_surface,
)
from delone.cli.tiled import surface_or_tiles
from delone.distributed.read import simplifying
from delone.errors import InternalError
from delone.terrain import TIN
from delone.terrain.simplifying import KEEP

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone.distributed import TiledDelaunay
    from delone.terrain.deviations import Deviations

__all__ = ["simplify"]

_KEEP = KEEP[0]


@with_surface
def simplify(
    source: Survey,
    *,
    max_error: Annotated[
        float | None,
        typer.Option(help="Largest vertical distance of a point from the new surface."),
    ] = None,
    max_triangles: Annotated[
        int | None, typer.Option(help="Maximum number of triangles, instead of --max-error.")
    ] = None,
    keep: Annotated[str, typer.Option(help="Edges that stay: " + ", ".join(KEEP) + ".")] = _KEEP,
    prove: Annotated[
        bool, typer.Option("--prove", help="Prove the error by exact arithmetic.")
    ] = False,
    output: Annotated[list[Path] | None, outputs("Mesh to write", (".ply", ".xml", "..."))] = None,
    options: SurfaceOptions,
) -> None:
    """Simplify a surface, with a bound on the error at each point that is left out.

    Lines and the outline are kept.
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
        tin = surface_or_tiles(source, options, watch, say)
        say("simplifying")
        if isinstance(tin, TIN):
            small, error = _one_piece(tin, goal, keep, watch, say, prove=prove)
        else:
            small, error = _tiles(tin, goal, keep, watch, say, prove=prove)
        write_all(writers, small, watch, say, z=small.z, crs=small.crs)
    figures = figures_of(source, small, output) | {
        "points_before": tin.npoints,
        "triangles_before": tin.nsimplex,
        "error": error,
        "stages": watch.rows(tin.npoints),
    }
    print_figures(source, figures, as_json=options.as_json, quiet=options.quiet)


def _one_piece(
    tin: TIN,
    goal: dict[str, Any],
    keep: str,
    watch: Stopwatch,
    say: Callable[[str], None],
    *,
    prove: bool,
) -> tuple[TIN, float | None]:
    """Return the simplified surface and its error."""
    with watch.stage("simplify"):
        levels = tin.simplification(**goal, keep=keep)
        small = levels.surface(**goal)
    if prove:
        say("proving the error")
        with watch.stage("prove"):
            _require([levels.validate(**goal)])
    return small, float(levels.errors[levels.triangles == small.nsimplex].min())


def _tiles(
    tin: TiledDelaunay,
    goal: dict[str, Any],
    keep: str,
    watch: Stopwatch,
    say: Callable[[str], None],
    *,
    prove: bool,
) -> tuple[TIN, float | None]:
    """Return the simplified surface of tiles, and its error if it is proven, else the bound."""
    with watch.stage("simplify"):
        limits = goal["max_error"], goal["max_triangles"]
        small, error = simplifying.simplify(tin, limits, keep, "z", "serial")
    if not prove:
        return small, error
    say("proving the error")
    with watch.stage("prove"):
        found = simplifying.prove(tin, small, error)
        _require(found)
    return small, max(float(each.distances.max(initial=0.0)) for each in found)


def _require(found: list[Deviations]) -> None:
    bad = [each for each in found if not each]
    if bad:
        raise InternalError(f"the bound on the error does not hold: {bad[0]}")
