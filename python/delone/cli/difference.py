"""The command ``difference``: a raster of heights minus a raster, a surface or a height."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from delone import __version__, terrain
from delone._base.atomic import check_target
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.notes import noting
from delone.cli.outputs import write_all
from delone.cli.referenced import require_known
from delone.cli.report import Stopwatch, peak_memory
from delone.cli.show import spinner
from delone.cli.surfaces import (
    SurfaceOptions,
    band_of,
    four_of,
    height_of,
    print_figures,
    require_surface,
    surface,
    with_surface,
)
from delone.cli.wording import without_layer
from delone.errors import FileFormatError, InputError
from delone.io import raster_suffixes
from delone.io.dem import is_raster
from delone.io.raster import raster_writer

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone.terrain import Difference

__all__ = ["difference"]

# Options of surfaces that apply to rasters.
_OF_RASTERS = ("nodata", "window", "layer", "crs", "units", "planar", "workers", "as_json", "quiet")


@with_surface
def difference(
    source: Annotated[
        Path, typer.Argument(metavar="DEM", help="Raster of heights: .tif .tiff .asc .nc")
    ],
    other: Annotated[
        str,
        typer.Argument(
            metavar="OTHER", help="What to subtract: a raster, points, a surface, or a height."
        ),
    ],
    *,
    output: Annotated[
        list[Path] | None,
        typer.Option(
            "--output",
            "-o",
            metavar="OUTPUT",
            help="Raster or picture of the differences (can be repeated): "
            + " ".join(raster_suffixes()),
        ),
    ] = None,
    as_surface: Annotated[
        bool,
        typer.Option(
            "--surface", help="Interpolate OTHER, a raster with different cells, linearly."
        ),
    ] = False,
    other_layer: Annotated[
        str | None, typer.Option(help="Layer, band or variable of OTHER, if not that of --layer.")
    ] = None,
    options: SurfaceOptions,
) -> None:
    """Subtract a raster, a surface or a height from a raster of heights, cell by cell.

    Two rasters must have the same cells. Lines and a boundary belong to OTHER, as a surface.
    """
    quiet = options.quiet
    require_known(options.crs)
    if not is_raster(source):
        raise Failure(f"{source}: not a raster of heights: .tif .tiff .asc .nc", Exit.USAGE)
    with writing():
        protect_inputs(output or [], source, Path(other))
        writers = {path: _writer(path) for path in output or []}
        for path in writers:
            check_target(path)
    watch = Stopwatch()
    box = None if options.window is None else four_of(options.window)
    bands = {"band": band_of(source, options.layer), "bounds": box, "nodata": options.nodata}
    with spinner(options.silent) as say:
        goal: Any = height_of(other)
        if goal is not None or is_raster(Path(other)):
            _require_effect(other, options, as_surface=as_surface, height=goal is not None)
        elif as_surface:
            raise Failure(f"{other}: --surface is for rasters, and this is a surface", Exit.USAGE)
        if goal is None and is_raster(Path(other)) and not as_surface:
            goal = Path(other)
            bands["other_band"] = band_of(goal, other_layer or options.layer)
        elif goal is None:
            # A window applies to the first raster; the surface is the whole second one.
            own = replace(options, layer=other_layer, window=None)
            if not is_raster(Path(other)):
                own = replace(own, nodata=None)
            goal = surface(Path(other), own, watch, say, layer="--other-layer")
        say("computing the difference")
        with reading(quiet=quiet), noting(quiet=quiet), watch.stage("difference"):
            found = _difference(source, goal, crs=options.crs, units=options.units, **bands)
        write_all(writers, found, watch, say, name="difference", crs=found.crs, units=found.units)
    figures = _figures(source, other, found, output or [])
    figures["stages"] = watch.rows(found.values.size)
    of = dict.fromkeys(("cut", "fill", "net"), found.volume_units) | {"area": found.area_units}
    of |= dict.fromkeys(("least", "greatest", "mean", "root_mean_square"), found.units)
    print_figures(source, figures, as_json=options.as_json, quiet=quiet, of=of)


def _require_effect(other: str, options: SurfaceOptions, *, as_surface: bool, height: bool) -> None:
    """Reject options for surfaces if OTHER is a height, or a raster that remains one."""
    if height and as_surface:
        raise Failure(f"{other}: --surface is for rasters, and this is a height", Exit.USAGE)
    if not as_surface:
        kind = "a height" if height else "a raster: give --surface as well"
        require_surface(options, _OF_RASTERS, f"is for surfaces, and {other} is {kind}")


def _difference(source: Path, goal: Any, **options: Any) -> Difference:
    """Return the difference; errors about different cells name options."""
    try:
        return terrain.difference(source, goal, **options)
    except FileFormatError as error:
        said = str(error)
        own = said.startswith(f"{goal} ") and isinstance(goal, Path)
        raise Failure(without_layer(said, "--other-layer") if own else said, Exit.INPUT) from error
    except InputError as error:
        text = str(error).replace(
            "a surface of the other, difference(dem, TIN.from_raster(other))",
            "the other one as a --surface",
        )
        if text == str(error):
            raise
        raise Failure(text, Exit.USAGE) from error


def _writer(path: Path) -> Callable[..., None]:
    """Return what writes a raster, or draws a picture in which cut and fill have colors."""
    write = raster_writer(path)
    return _draw if path.suffix.lower() in (".png", ".svg") else write


def _draw(path: Path, found: Difference, *, name: str, crs: str | None, units: str | None) -> None:
    from delone.plot.raster import draw_difference

    del name
    draw_difference(path, found.values, found.x, found.y, units=units, crs=crs)


def _figures(source: Path, other: str, found: Difference, output: list[Path]) -> dict[str, Any]:
    known = found.count > 0
    try:
        volumes = {name: getattr(found, name) for name in ("cut", "fill", "net", "area")}
    except InputError:  # cells in degrees have no area
        volumes = {}
    return {
        "delone": __version__,
        "input": str(source),
        "other": other,
        "crs": found.crs,
        "units": found.units,
        "columns": len(found.x),
        "rows": len(found.y),
        "cells_compared": found.count,
        "cells_without_height": found.missing,
        "cells_without_height_of_other": found.missing_other,
        "least": found.min if known else None,
        "greatest": found.max if known else None,
        "mean": found.mean if known else None,
        "root_mean_square": found.rms if known else None,
        **volumes,
        "volume_units": found.volume_units,
        "area_units": found.area_units,
        "outputs": [str(path) for path in output],
        "output_bytes": sum(path.stat().st_size for path in output),
        "peak_memory_bytes": peak_memory(),
    }
