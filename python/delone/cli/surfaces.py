"""Surfaces through points and lines in files: the options and the reading that commands share."""

from __future__ import annotations

import functools
import inspect
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

from delone import __version__
from delone.cli.constraints import geometries_of
from delone.cli.exits import Exit, Failure, reading
from delone.cli.lines import ROWS, name_lines
from delone.cli.notes import noting
from delone.cli.options import Chord, Classes, Json, Layer, Quiet, Workers, class_numbers, split
from delone.cli.referenced import Crs, Planar, referenced
from delone.cli.report import Stopwatch, peak_memory
from delone.cli.show import print_json, print_report
from delone.io import (
    GeometrySet,
    PointSet,
    SurfaceFile,
    input_suffixes,
    read_points,
    read_raster,
    read_surface,
)
from delone.io.dem import is_raster
from delone.io.netcdf import is_netcdf
from delone.io.registry import holds_surface, is_lidar
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from delone.distributed import TiledDelaunay

__all__ = [
    "SurfaceOptions",
    "Survey",
    "curves_of",
    "figures_of",
    "four_of",
    "is_landxml",
    "other_surface",
    "print_figures",
    "require_surface",
    "surface",
    "with_surface",
]

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
    Path | None, typer.Option(help="File of breaklines, with or without heights.")
]
SoftBreaklines = Annotated[
    Path | None,
    typer.Option(help="File of soft breaklines, where --smooth may round contour lines."),
]
Boundary = Annotated[Path | None, typer.Option(help="File of polygons that bound the surface.")]
MaxEdge = Annotated[
    float | None, typer.Option(help="Remove outer triangles with a longer outer edge.")
]
Voids = Annotated[
    bool,
    typer.Option("--voids", help="Also remove inner triangles with an edge above --max-edge."),
]
Duplicates = Annotated[
    str,
    typer.Option(help="Height of duplicates with different heights: raise, min, max, mean."),
]
Crossing = Annotated[
    str,
    typer.Option(help="Height where lines of different heights meet: raise, min, max, mean."),
]
Tolerance = Annotated[
    float,
    typer.Option(help="Heights at one position that differ by at most this count as equal."),
]
Snap = Annotated[
    float,
    typer.Option(help="Merge points that are closer than this to a line or to each other."),
]
Level = Annotated[
    Path | None,
    typer.Option(help="File of polygons in which the surface is level, such as lakes."),
]
Units = Annotated[
    str | None,
    typer.Option(help="The unit of heights, if the file does not declare it: m, ft, us-ft."),
]
Retriangulate = Annotated[
    bool,
    typer.Option(
        "--retriangulate",
        help="Triangulate the points and lines of a LandXML or DXF file, not its faces.",
    ),
]
Step = Annotated[
    int, typer.Option(help="Rasters (.tif, .asc, .nc): read only every N-th row and column.")
]
Nodata = Annotated[
    float | None,
    typer.Option(help="Rasters: the value of cells without a height; nan if no value marks them."),
]
Window = Annotated[
    str | None,
    typer.Option(
        help="Rasters, lidar: read only what is inside left,bottom,right,top; fast for COPC, EPT."
    ),
]
EastingFirst = Annotated[
    bool,
    typer.Option(
        "--easting-first", help="Read the first number of LandXML coordinates as the easting."
    ),
]


@dataclass(frozen=True, kw_only=True)
class SurfaceOptions:
    """How to make a surface from files, and what to print: each field is an option of commands."""

    breaklines: Breaklines = None
    soft_breaklines: SoftBreaklines = None
    boundary: Boundary = None
    max_edge: MaxEdge = None
    voids: Voids = False
    duplicates: Duplicates = "raise"
    crossing: Crossing = "raise"
    tolerance: Tolerance = 0.0
    snap: Snap = 0.0
    level: Level = None
    chord: Chord = None
    step: Step = 1
    nodata: Nodata = None
    window: Window = None
    columns: Columns = None
    classes: Classes = None
    layer: Layer = None
    retriangulate: Retriangulate = False
    easting_first: EastingFirst = False
    crs: Crs = None
    units: Units = None
    planar: Planar = False
    workers: Workers = None
    as_json: Json = False
    quiet: Quiet = False

    @property
    def silent(self) -> bool:
        """Whether no progress is shown."""
        return self.quiet or self.as_json

    def inputs(self) -> list[Path]:
        """The files of lines."""
        lines = (self.breaklines, self.soft_breaklines, self.boundary, self.level)
        return [path for path in lines if path is not None]


def with_surface(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the surface options, which it receives together as `options`."""
    hints = get_type_hints(SurfaceOptions, include_extras=True)
    shared = {
        each.name: inspect.Parameter(
            each.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=each.default,
            annotation=hints[each.name],
        )
        for each in fields(SurfaceOptions)
    }
    signature = inspect.signature(command, eval_str=True)
    own = {name: each for name, each in signature.parameters.items() if name != "options"}

    @functools.wraps(command)
    def run(**given: Any) -> None:
        options = SurfaceOptions(**{name: given.pop(name) for name in shared})
        command(**given, options=options)

    parameters = own | shared
    # What typer reads.
    run.__signature__ = signature.replace(parameters=list(parameters.values()))  # type: ignore[attr-defined]
    run.__annotations__ = {name: each.annotation for name, each in parameters.items()}
    return run


def require_surface(options: SurfaceOptions, allowed: Sequence[str], why: str) -> None:
    """Reject options that change how a surface is made, where none is made."""
    for each in fields(SurfaceOptions):
        if each.name not in allowed and getattr(options, each.name) != each.default:
            raise Failure(f"--{each.name.replace('_', '-')} {why}", Exit.USAGE)


def curves_of(path: Path, chord: float | None, *, aligned: bool = False) -> dict[str, Any]:
    """Return --chord as a reader option for DXF files, which have curves; nothing for others.

    LandXML files have curves if their alignments are read.
    """
    return {"chord": chord} if _is_drawing(path) or (aligned and is_landxml(path)) else {}


def is_landxml(path: Path) -> bool:
    """Return whether the suffix is that of LandXML."""
    return path.suffix.lower() in (".xml", ".landxml")


def _is_drawing(path: Path) -> bool:
    return path.suffix.lower() == ".dxf"


def surface(
    source: Path,
    options: SurfaceOptions,
    watch: Stopwatch,
    say: Callable[[str], None],
    *,
    others: Sequence[Path] = (),
    aligned: bool = False,
    layer: str = "--layer",
) -> TIN:
    """Read points and lines, or a surface, and triangulate them.

    Format options may be meant for `others`, which will also be read with them; `aligned` says that
    one of these has alignments with curves. `layer` is the option for the layer of the source.
    """
    say(f"reading {source.name}")
    files = (source, *options.inputs(), *others)
    if options.chord is not None and not (aligned or any(map(_is_drawing, files))):
        raise Failure(
            "--chord is for DXF files and for alignments, and the inputs contain neither",
            Exit.USAGE,
        )
    _require_kinds((source, *others), options)
    if options.voids and options.max_edge is None:
        raise Failure("--voids needs --max-edge: longer edges span a void", Exit.USAGE)
    lined: dict[str, Any] = {"max_edge": options.max_edge, "voids": options.voids}
    survey: PointSet | SurfaceFile
    with reading(quiet=options.quiet, layer=layer), watch.stage("read"):
        if is_raster(source) and source.exists():
            survey = _read_raster(source, options)
        elif source.exists() and holds_surface(source):
            survey = _read_surface(source, options)
        else:
            survey = read_points(
                source,
                columns=split(options.columns),
                classes=class_numbers(options.classes),
                layer=options.layer,
                bounds=four_of(options.window) if options.window and is_lidar(source) else None,
            )
        for name in ("breaklines", "soft_breaklines", "boundary", "level"):
            path = getattr(options, name)
            lined[name] = None if path is None else _lines(path, options)
    if isinstance(survey, PointSet) and survey.z is None:
        raise Failure(
            f"{source}: no column contains heights: name it with --columns x,y,z", Exit.USAGE
        )
    survey = referenced(survey, options.crs, planar=options.planar, quiet=options.quiet)
    say(f"triangulating {len(survey.points):,} points")
    policies = ("duplicates", "crossing", "tolerance", "snap", "units", "workers")
    lined |= {name: getattr(options, name) for name in policies}
    with watch.stage("triangulate"), noting(quiet=options.quiet):
        if isinstance(survey, PointSet):
            return TIN.from_points(survey, planar=True, **lined)
        return TIN.from_surface(survey, faces=not options.retriangulate, planar=True, **lined)


def _require_kinds(files: Sequence[Path], options: SurfaceOptions) -> None:
    """Reject options for kinds of files that none of the files is of."""
    rasters = "rasters: .tif .tiff .asc .nc"
    for option, given, holds, kinds in (
        ("--step", options.step != 1, is_raster, rasters),
        ("--nodata", options.nodata is not None, is_raster, rasters),
        (
            "--window",
            options.window is not None,
            _has_window,
            "rasters and lidar: .tif .tiff .asc .nc .las .laz ept.json",
        ),
        ("--retriangulate", options.retriangulate, holds_surface, "LandXML and DXF files"),
        ("--easting-first", options.easting_first, is_landxml, "LandXML files"),
    ):
        if given and not any(map(holds, files)):
            raise Failure(f"{files[0]}: {option} is for {kinds}", Exit.USAGE)


def other_surface(
    file: Path,
    options: SurfaceOptions,
    watch: Stopwatch,
    say: Callable[[str], None],
    *,
    layer: str = "--layer",
) -> TIN:
    """Read a surface to compare with the first one; lines in other files do not apply to it."""
    own: dict[str, Any] = {"chord": options.chord if _is_drawing(file) else None}
    if not is_raster(file):
        own |= {"step": 1, "nodata": None}
    if not _has_window(file):
        own["window"] = None
    own["retriangulate"] = options.retriangulate and holds_surface(file)
    own["easting_first"] = options.easting_first and is_landxml(file)
    own |= dict.fromkeys(("breaklines", "soft_breaklines", "boundary", "level"))
    alone = replace(options, **own)
    try:
        return surface(file, alone, watch, say, layer=layer)
    except ROWS as error:
        name_lines(error, file, other=True)
        raise


def _has_window(file: Path) -> bool:
    return is_raster(file) or is_lidar(file)


def _read_raster(source: Path, options: SurfaceOptions) -> PointSet:
    if options.columns is not None or options.classes is not None:
        raise Failure(f"{source}: rasters have neither columns nor classes", Exit.USAGE)
    return read_raster(
        source,
        band=band_of(source, options.layer),
        step=options.step,
        bounds=None if options.window is None else four_of(options.window),
        nodata=options.nodata,
    )


def band_of(path: Path, layer: str | None) -> int | str | None:
    """Return the number of a band, or the name of a NetCDF variable."""
    if layer is None or is_netcdf(path):
        return layer
    if not layer.isdecimal():
        raise Failure(f"{path}: the layer of a raster is the number of a band", Exit.USAGE)
    return int(layer)


def height_of(text: str) -> float | None:
    """Return a number, or None for a file."""
    if text and Path(text).exists():
        return None
    try:
        return float(text)
    except ValueError:
        shown = text or "an empty string"
        raise Failure(f"{shown}: neither a file nor a height", Exit.INPUT) from None


def four_of(text: str) -> list[float]:
    """Return the numbers of --window."""
    try:
        found = [float(part) for part in text.split(",")]
    except ValueError:
        found = []
    if len(found) != 4:
        raise Failure(f"--window takes left,bottom,right,top; got {text!r:.80}", Exit.USAGE)
    return found


def _read_surface(source: Path, options: SurfaceOptions) -> SurfaceFile:
    if options.columns is not None or options.classes is not None:
        raise Failure(f"{source}: surfaces have neither columns nor classes", Exit.USAGE)
    order = "enz" if options.easting_first else None
    curved = curves_of(source, options.chord)
    return read_surface(source, layer=options.layer, order=order, **curved)


def _lines(path: Path, options: SurfaceOptions) -> GeometrySet:
    # The layer is that of the points.
    with reading(quiet=options.quiet, layer=None):
        return geometries_of(path, **curves_of(path, options.chord))


def figures_of(source: Path, tin: TIN | TiledDelaunay, output: list[Path] | None) -> dict[str, Any]:
    """Return what commands report about a surface and the files written."""
    return {
        "delone": __version__,
        "input": str(source),
        "crs": tin.crs,
        "units": tin.units if isinstance(tin, TIN) else None,
        "points": tin.npoints,
        "triangles": tin.nsimplex,
        **(_adjustments_of(tin) if isinstance(tin, TIN) else {"tiles": tin.ntiles}),
        "outputs": [str(path) for path in output or ()],
        "output_bytes": sum(path.stat().st_size for path in output or ()),
        "peak_memory_bytes": peak_memory(),
    }


def _adjustments_of(tin: TIN) -> dict[str, Any]:
    """Return what --snap and --level have changed in the input."""
    found = tin.adjustments
    if found is None:
        return {}
    return {
        "points_moved": found.points_moved,
        "points_of_lines_moved": found.line_points_moved,
        "largest_move": found.largest_move,
        "points_left_out_in_level_polygons": found.points_leveled if len(found.levels) else None,
        "level_polygons": len(found.levels) or None,
    }


def print_figures(
    source: Path,
    figures: dict[str, Any],
    *,
    as_json: bool,
    quiet: bool,
    of: Mapping[str, str | None] | None = None,
    more: Sequence[tuple[str, str]] = (),
) -> None:
    """Print figures as a table, some of them with units (`of`), and `more` rows, or as JSON."""
    if as_json:
        print_json(figures)
        return
    if quiet:
        return
    left_out = {"delone", "input", "crs", "units", "stages", "outputs", "peak_memory_bytes"}
    left_out |= {"volume_units", "area_units"}
    if not figures["outputs"]:
        left_out.add("output_bytes")
    rows = []
    for name, value in figures.items():
        if name not in left_out and value is not None and not isinstance(value, list):
            form = {float: ".10g", int: ","}.get(type(value), "")
            unit = (of or {}).get(name)
            text = f"{value:{form}}" + (f" {unit}" if unit else "")
            rows.append((name.replace("_", " "), text))
    print_report(str(source), [*rows, *more], figures)
