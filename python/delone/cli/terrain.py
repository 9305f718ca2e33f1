"""The commands ``contours``, ``profile`` and ``volume``, for surfaces of points with heights."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import __version__
from delone.atomic import replacing
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.options import Classes, Json, Layer, Quiet, Workers, class_numbers, split
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.report import Stopwatch, peak_memory
from delone.cli.show import print_json, print_report, spinner
from delone.cli.tables import TABLE_SUFFIXES, ready_table, write_table
from delone.extras import require
from delone.io import input_suffixes, read_geometries, read_points
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["contours", "profile", "volume"]

Survey = Annotated[
    Path,
    typer.Argument(
        metavar="INPUT", help="File of points with heights: " + " ".join(input_suffixes())
    ),
]
Columns = Annotated[
    str | None, typer.Option(help="Columns of x, y and z, by name or by number from 0.")
]
Breaklines = Annotated[
    Path | None, typer.Option(help="File of lines that edges follow, with or without heights.")
]
Boundary = Annotated[Path | None, typer.Option(help="File of polygons where the surface ends.")]
MaxEdge = Annotated[
    float | None, typer.Option(help="Remove outer triangles with a longer outer edge.")
]
Duplicates = Annotated[
    str,
    typer.Option(help="Height of duplicates with different heights: raise, min, max, mean."),
]
Crossing = Annotated[
    str,
    typer.Option(help="Height where lines of different heights meet: raise, min, max, mean."),
]
Output = Annotated[
    list[Path] | None,
    typer.Option(
        "--output",
        "-o",
        metavar="OUTPUT",
        help="File to write, once or more: " + " ".join(TABLE_SUFFIXES),
    ),
]


@dataclass(frozen=True, kw_only=True)
class _Options:
    """How a surface is made of files."""

    columns: str | None
    classes: str | None
    layer: str | None
    breaklines: Path | None
    boundary: Path | None
    max_edge: float | None
    duplicates: str
    crossing: str
    crs: str | None
    planar: bool
    workers: int | None
    quiet: bool

    @classmethod
    def among(cls, given: dict[str, Any]) -> _Options:
        """Select the options among the arguments of a command."""
        return cls(**{each.name: given[each.name] for each in fields(cls)})

    def inputs(self) -> list[Path]:
        """The files of lines."""
        return [path for path in (self.breaklines, self.boundary) if path is not None]


def contours(
    source: Survey,
    *,
    interval: Annotated[float | None, typer.Option(help="Distance of the levels.")] = None,
    levels: Annotated[
        str | None, typer.Option(help="The levels instead of an interval: 10,12.5,15.")
    ] = None,
    base: Annotated[float, typer.Option(help="A level from which the interval counts.")] = 0.0,
    index: Annotated[int, typer.Option(help="Mark each so many levels as index contours.")] = 5,
    smooth: Annotated[int, typer.Option(help="Rounds of corner cutting, 0 to 5.")] = 0,
    bands: Annotated[
        bool, typer.Option("--bands", help="Write polygons between levels instead of lines.")
    ] = False,
    output: Output = None,
    breaklines: Breaklines = None,
    boundary: Boundary = None,
    max_edge: MaxEdge = None,
    duplicates: Duplicates = "raise",
    crossing: Crossing = "raise",
    columns: Columns = None,
    classes: Classes = None,
    layer: Layer = None,
    crs: Crs = None,
    planar: Planar = False,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compute contour lines, or the polygons between them, of points with heights."""
    wanted = None if levels is None else _numbers(levels, "--levels")
    if bands and smooth:
        raise Failure("--smooth is for lines, not for --bands", Exit.USAGE)
    options = _Options.among(locals())
    _check(output or [], source, options, "contours")
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        tin = _surface(source, options, watch, say)
        say("computing contours")
        with watch.stage("contours"):
            found: Any
            if bands:
                found = tin.bands(wanted, interval=interval, base=base)
            else:
                found = tin.contours(
                    wanted, interval=interval, base=base, index=index, smooth=smooth
                )
        _write(found.to_geopandas, output or [], watch, "bands" if bands else "contours")
    what = "polygons" if bands else "lines"
    figures = _figures(source, tin, output) | {
        what: len(found),
        "levels": len(np.unique(found.low if bands else found.level)),
        "coordinates": len(found.points),
        "stages": watch.rows(tin.npoints),
    }
    _print(source, figures, as_json=as_json, quiet=quiet)


def profile(
    source: Survey,
    line: Annotated[Path, typer.Argument(metavar="LINE", help="File with one line.")],
    *,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="OUTPUT", help="File to write: .csv, .png, .svg, .pdf."
        ),
    ] = None,
    breaklines: Breaklines = None,
    boundary: Boundary = None,
    max_edge: MaxEdge = None,
    duplicates: Duplicates = "raise",
    crossing: Crossing = "raise",
    columns: Columns = None,
    classes: Classes = None,
    layer: Layer = None,
    crs: Crs = None,
    planar: Planar = False,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compute the heights along a line: a table of distances and heights, or a plot of them."""
    options = _Options.among(locals())
    if output is not None and output.suffix.lower() not in (".csv", ".png", ".svg", ".pdf"):
        raise Failure(f"{output}: a profile can be written to .csv .png .svg .pdf", Exit.USAGE)
    with writing():
        protect_inputs([] if output is None else [output], source, line, *options.inputs())
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        with reading():
            along = read_geometries(line)
        tin = _surface(source, options, watch, say)
        with watch.stage("profile"):
            found = tin.profile(along)
        if output is not None:
            with writing(), replacing(output) as target, watch.stage(f"write {output.name}"):
                _write_profile(found, target)
    figures = _figures(source, tin, [] if output is None else [output]) | {
        "length": float(found.distance[-1]) if len(found) else 0.0,
        "profile_points": len(found),
        "lowest": float(np.nanmin(found.z)) if np.isfinite(found.z).any() else None,
        "highest": float(np.nanmax(found.z)) if np.isfinite(found.z).any() else None,
        "stages": watch.rows(tin.npoints),
    }
    _print(source, figures, as_json=as_json, quiet=quiet)


def volume(
    source: Survey,
    other: Annotated[
        str, typer.Argument(metavar="OTHER", help="File of the surface to reach, or a height.")
    ],
    *,
    region: Annotated[
        Path | None, typer.Option(help="File of polygons to which the volume is limited.")
    ] = None,
    breaklines: Breaklines = None,
    boundary: Boundary = None,
    max_edge: MaxEdge = None,
    duplicates: Duplicates = "raise",
    crossing: Crossing = "raise",
    columns: Columns = None,
    classes: Classes = None,
    layer: Layer = None,
    crs: Crs = None,
    planar: Planar = False,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compute the volumes to cut and to fill between a surface and a height or another surface.

    Lines and boundary are those of the first surface.
    """
    options = _Options.among(locals())
    require_known(crs)
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        with reading():
            within = None if region is None else read_geometries(region)
        tin = _surface(source, options, watch, say)
        goal = _goal(other, options, watch, say)
        say("computing volumes")
        with watch.stage("volume"):
            found = tin.volume(goal, region=within)
    figures = _figures(source, tin, []) | {
        "cut": found.cut,
        "fill": found.fill,
        "net": found.net,
        "cut_area": found.cut_area,
        "fill_area": found.fill_area,
        "area": found.area,
        "stages": watch.rows(tin.npoints),
    }
    _print(source, figures, as_json=as_json, quiet=quiet)


def _numbers(text: str, option: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise Failure(f"{option} takes numbers, got {text!r}", Exit.USAGE) from None


def _check(output: list[Path], source: Path, options: _Options, what: str) -> None:
    require_known(options.crs)
    with writing():
        protect_inputs(output, source, *options.inputs())
        for path in output:
            ready_table(path, what)


def _surface(source: Path, options: _Options, watch: Stopwatch, say: Callable[[str], None]) -> TIN:
    """Read points and lines, and triangulate them."""
    say(f"reading {source.name}")
    with reading(), watch.stage("read"):
        survey = read_points(
            source,
            columns=split(options.columns),
            classes=class_numbers(options.classes),
            layer=options.layer,
        )
        lines = None if options.breaklines is None else read_geometries(options.breaklines)
        rim = None if options.boundary is None else read_geometries(options.boundary)
    if survey.z is None:
        raise Failure(f"{source}: no column has heights: name it with --columns x,y,z", Exit.USAGE)
    survey = referenced(survey, options.crs, planar=options.planar, quiet=options.quiet)
    say(f"triangulating {len(survey):,} points")
    with watch.stage("triangulate"):
        return TIN.from_points(
            survey,
            breaklines=lines,
            boundary=rim,
            max_edge=options.max_edge,
            duplicates=options.duplicates,
            crossing=options.crossing,
            planar=True,
            workers=options.workers,
        )


def _goal(
    other: str, options: _Options, watch: Stopwatch, say: Callable[[str], None]
) -> float | TIN:
    """Return the height or surface that is to be reached."""
    if not Path(other).exists():
        try:
            return float(other)
        except ValueError:
            raise Failure(f"{other}: neither a file nor a height", Exit.INPUT) from None
    return _surface(Path(other), replace(options, breaklines=None, boundary=None), watch, say)


def _write(table: Callable[[], Any], output: list[Path], watch: Stopwatch, layer: str) -> None:
    if not output:
        return
    with writing(), ExitStack() as stack:
        rows = table()
        for path in output:
            with watch.stage(f"write {path.name}"):
                write_table(rows, stack.enter_context(replacing(path)), layer=layer)


def _write_profile(found: Any, path: Path) -> None:
    if path.suffix.lower() == ".csv":
        table = np.column_stack((found.distance, found.z, found.points))
        np.savetxt(path, table, fmt="%.17g", delimiter=",", header="distance,z,x,y", comments="")
        return
    pyplot = require("matplotlib.pyplot", extra="plot", what="drawing")
    figure, ax = pyplot.subplots(figsize=(9, 3), layout="constrained")
    found.plot(ax)
    figure.savefig(path, format=path.suffix[1:].lower())
    pyplot.close(figure)


def _figures(source: Path, tin: TIN, output: list[Path] | None) -> dict[str, Any]:
    return {
        "delone": __version__,
        "input": str(source),
        "crs": tin.crs,
        "points": tin.npoints,
        "triangles": tin.nsimplex,
        "outputs": [str(path) for path in output or ()],
        "peak_memory_bytes": peak_memory(),
    }


def _print(source: Path, figures: dict[str, Any], *, as_json: bool, quiet: bool) -> None:
    if as_json:
        print_json(figures)
        return
    if quiet:
        return
    left_out = {"delone", "input", "crs", "stages", "outputs", "peak_memory_bytes"}
    rows = []
    for name, value in figures.items():
        if name not in left_out and value is not None:
            text = f"{value:,}" if isinstance(value, int) else f"{value:.10g}"
            rows.append((name.replace("_", " "), text))
    print_report(str(source), rows, figures)
