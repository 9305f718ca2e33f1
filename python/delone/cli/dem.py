"""The command ``dem``: rasters of heights, slopes and hillshades, of tiles or of a survey."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import __version__, distributed
from delone._base.atomic import check_target
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.options import numbers
from delone.cli.outputs import write_all
from delone.cli.referenced import require_known
from delone.cli.report import Stopwatch
from delone.cli.show import print_json, print_rows, spinner
from delone.cli.surfaces import (
    SurfaceOptions,
    figures_of,
    print_figures,
    surface,
    with_surface,
)
from delone.cli.tiled import refuse_for_tiles
from delone.io import input_suffixes, raster_suffixes
from delone.io.raster import raster_writer

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone.interpolate import Grid
    from delone.terrain import TIN

__all__ = ["dem"]

_LIGHT = {"azimuth": 315.0, "altitude": 45.0, "z_factor": 1.0}


@with_surface
def dem(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="INPUT",
            help="Output of delone tile, or file of points with heights: "
            + " ".join(input_suffixes()),
        ),
    ],
    *,
    resolution: Annotated[
        str, typer.Option("--resolution", "-r", help="Size of a cell: 1 or 0.5,0.25.")
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            metavar="OUTPUT",
            help="GeoTIFF, or for a file of points: " + " ".join(raster_suffixes()),
        ),
    ],
    hillshade: Annotated[
        bool, typer.Option("--hillshade", help="Brightness, 0 to 1, instead of heights.")
    ] = False,
    slope: Annotated[
        bool, typer.Option("--slope", help="Slope in degrees instead of heights.")
    ] = False,
    aspect: Annotated[
        bool,
        typer.Option("--aspect", help="Downhill direction, degrees clockwise from north."),
    ] = False,
    azimuth: Annotated[
        float | None,
        typer.Option(help="Direction of the light for --hillshade, in degrees; by default 315."),
    ] = None,
    altitude: Annotated[
        float | None,
        typer.Option(help="Angle of the light above the horizon, in degrees; by default 45."),
    ] = None,
    z_factor: Annotated[
        float | None, typer.Option(help="Factor for heights in --hillshade; by default 1.")
    ] = None,
    bounds: Annotated[
        str | None,
        typer.Option(help="Left, bottom, right, top; by default the bounding box of the points."),
    ] = None,
    value: Annotated[str, typer.Option(help="Column of tiles with the values.")] = "z",
    options: SurfaceOptions,
) -> None:
    """Make a raster of the surface through points: its heights, slope, aspect or hillshade.

    The surface is linear between the points. A folder of tiles has no breaklines, and its raster
    may show a column other than the heights.
    """
    given = locals() | vars(options)
    cells = _numbers(resolution, "--resolution", (1, 2))
    box = None if bounds is None else _numbers(bounds, "--bounds", (4,))
    light = {name: given[name] for name in _LIGHT if given[name] is not None}
    what = _measure(given, light)
    require_known(options.crs)
    size = (cells[0], cells[-1])
    if source.is_dir():
        refuse_for_tiles(given)
        shown = {"what": "value" if what == "height" else what, **light}
        _of_tiles(source, size, output, (value, shown), options)
        return
    if value != "z":
        raise Failure("--value is for tiles; name the heights with --columns x,y,z", Exit.USAGE)
    with writing():
        protect_inputs([output], source, *options.inputs())
        writers = {output: (raster_writer(output), check_target(output))[0]}
    watch = Stopwatch()
    with spinner(options.silent) as say:
        tin = surface(source, options, watch, say)
        with watch.stage(what):
            found = _raster(tin, what, {"resolution": size, "bounds": box} | light, say)
        unit = {"height": tin.units, "slope": "degrees", "aspect": "degrees"}.get(what)
        write_all(writers, found, watch, say, name=what, crs=tin.crs, units=unit)
    figures = figures_of(source, tin, [output]) | _figures(found, what)
    figures["stages"] = watch.rows(tin.npoints)
    print_figures(source, figures, as_json=options.as_json, quiet=options.quiet)


def _measure(given: dict[str, Any], light: dict[str, Any]) -> str:
    """Return what is to be computed."""
    chosen = [name for name in ("hillshade", "slope", "aspect") if given[name]]
    if len(chosen) > 1:
        options = " and ".join(f"--{name}" for name in chosen)
        raise Failure(f"{options} are separate rasters: run the command once for each", Exit.USAGE)
    if light and chosen != ["hillshade"]:
        options = ", ".join(f"--{name.replace('_', '-')}" for name in light)
        raise Failure(f"{options}: only for --hillshade", Exit.USAGE)
    return chosen[0] if chosen else "height"


def _of_tiles(
    folder: Path,
    cells: tuple[float, float],
    output: Path,
    of: tuple[str, dict[str, Any]],
    options: SurfaceOptions,
) -> None:
    value, shown = of
    with writing():
        check_target(output)
    with reading(quiet=options.quiet):
        found = distributed.open(folder)
    with spinner(options.silent) as say, writing():
        say(f"interpolating {found.ntiles:,} tiles")
        found.to_raster(cells, output, values=value, crs=options.crs, **shown)
    if options.as_json:
        print_json({"delone": __version__, "input": str(folder), "outputs": [str(output)]})
    elif not options.quiet:
        print_rows(str(folder), [("cell", " x ".join(map(str, cells))), ("written", str(output))])


def _raster(tin: TIN, what: str, options: dict[str, Any], say: Callable[[str], None]) -> Grid:
    say(f"computing the {what}")
    return tin.raster(
        what,
        progress=lambda share: say(f"computing the {what}: {share:.0%} done"),
        **{name: given for name, given in options.items() if given is not None},
    )


def _figures(found: Grid, what: str) -> dict[str, Any]:
    known = found.values[np.isfinite(found.values)]
    return {
        "columns": len(found.x),
        "rows": len(found.y),
        "values": what,
        "without_value": int(found.values.size - known.size),
        "least": float(known.min()) if known.size else None,
        "greatest": float(known.max()) if known.size else None,
    }


def _numbers(text: str, option: str, counts: tuple[int, ...]) -> list[float]:
    words = {(1, 2): "one or two numbers", (4,): "four numbers"}[counts]
    found = numbers(text, option)
    if len(found) not in counts:
        raise Failure(f"{option} takes {words}, got {text!r:.80}", Exit.USAGE)
    return found
