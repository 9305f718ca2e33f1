"""The commands ``interpolate`` (to rasters) and ``crossval`` (comparison of methods)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import __version__
from delone._base.arrays import as_choice
from delone._base.atomic import check_target
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.options import Classes, Json, Layer, Quiet, Workers, numbers, outputs, split
from delone.cli.outputs import write_all
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.report import Stopwatch, finite_or_none
from delone.cli.show import print_json, print_rows, show_figures, spinner
from delone.interpolate import Grid, Interpolator, cross_validate, grid, interpolator
from delone.interpolate.methods import METHODS
from delone.io import PointSet, raster_suffixes, read_points
from delone.io.raster import WITH_CRS, raster_writer

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = ["crossval", "interpolate"]

Source = Annotated[Path, typer.Argument(metavar="INPUT", help="File of points with values.")]
Value = Annotated[
    str | None, typer.Option(help="Column of the values, by name; by default the height column.")
]
Columns = Annotated[
    str | None, typer.Option(help="Columns of x, y and z, by name or by number from 0.")
]
Duplicates = Annotated[
    str,
    typer.Option(
        help="Duplicates with different values: raise (an error), mean, first, last, min, max."
    ),
]
Nan = Annotated[
    str,
    typer.Option(
        help="NaN among the values: raise (an error), drop or (not for rasters) propagate."
    ),
]
Gradients = Annotated[
    str | None, typer.Option(help="Gradients of the smooth methods: global, local or plane.")
]

_NAMES = " ".join(METHODS)
_COMPARED = "linear,nearest,sibson,laplace"
_SMOOTH = ("clough-tocher", "sibson1", "farin")


def interpolate(
    source: Source,
    *,
    value: Value = None,
    method: Annotated[str, typer.Option(help=f"Method: {_NAMES}.")] = "sibson",
    size: Annotated[
        str | None, typer.Option("--grid", help="Columns and rows of the raster, such as 500x400.")
    ] = None,
    resolution: Annotated[
        str | None,
        typer.Option(help="Size of a cell in units of the points, such as 0.01 or 0.02,0.01."),
    ] = None,
    bounds: Annotated[
        str | None,
        typer.Option(help="Left, bottom, right, top; by default the bounding box of the points."),
    ] = None,
    output: Annotated[list[Path] | None, outputs("File to write", raster_suffixes())] = None,
    extrapolate: Annotated[
        str, typer.Option(help="Outside the hull: nan, nearest or linear.")
    ] = "nan",
    tolerance: Annotated[
        float,
        typer.Option(help="Nodes at most this far outside the hull count as inside."),
    ] = 0.0,
    max_distance: Annotated[
        float | None,
        typer.Option(help="No value at more than this distance from the nearest point."),
    ] = None,
    duplicates: Duplicates = "raise",
    nan: Nan = "raise",
    gradients: Gradients = None,
    columns: Columns = None,
    classes: Classes = None,
    layer: Layer = None,
    workers: Workers = None,
    crs: Crs = None,
    units: Annotated[
        str | None, typer.Option(help="Unit of the values, for GeoTIFF and NetCDF, such as m.")
    ] = None,
    planar: Planar = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Interpolate the values of points to a raster, and write it to files and plots."""
    where = _raster_options(size, resolution, bounds)
    require_known(crs)
    with writing():
        protect_inputs(output or (), source)
        writers = {path: (raster_writer(path), check_target(path))[0] for path in output or ()}
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        survey, values, name = _read(
            source, value, columns, classes, layer, watch, say, quiet=quiet
        )
        survey = referenced(
            survey, crs, planar=planar, quiet=quiet, outputs=writers, known=WITH_CRS
        )
        say(f"triangulating {len(survey):,} points")
        options: dict[str, Any] = {"extrapolate": extrapolate, "tolerance": tolerance}
        options |= {"duplicates": duplicates, "nan": nan, "workers": workers}
        with watch.stage("triangulate"):
            made = _made(method, survey, values, gradients, options)
        with watch.stage("interpolate"):
            found = grid(
                made, **where, max_distance=max_distance, progress=_told(say, "interpolating")
            )
        write_all(writers, found, watch, say, name=name, crs=survey.crs, units=units)
        figures = _figures(source, survey, made, method, found) | {
            "max_distance": max_distance,
            **watch.ending(
                writers,
                found.values.size,
                others=dict.fromkeys(("read", "triangulate"), len(survey)),
            ),
        }
    show_figures(str(source), figures, _rows, as_json=as_json, quiet=quiet)


def crossval(
    source: Source,
    *,
    value: Value = None,
    methods: Annotated[
        list[str] | None,
        typer.Option(
            "--method",
            help=f"Methods to compare, separated by commas or as repeated options; by default "
            f"{_COMPARED}. "
            f"Available: {_NAMES}.",
        ),
    ] = None,
    folds: Annotated[
        int | None, typer.Option(help="Number of random folds; by default leave one out.")
    ] = None,
    seed: Annotated[
        int | None, typer.Option(help="Seed of the random folds; by default 0.")
    ] = None,
    duplicates: Duplicates = "raise",
    nan: Nan = "raise",
    gradients: Gradients = None,
    columns: Columns = None,
    classes: Classes = None,
    layer: Layer = None,
    workers: Workers = None,
    crs: Crs = None,
    planar: Planar = False,
    as_json: Json = False,
) -> None:
    """Predict each value from the others, and report the error of each method."""
    # Each method once, in the order given.
    named = ",".join(methods or [_COMPARED]).split(",")
    names = list(dict.fromkeys(name.strip() for name in named))
    for name in names:
        as_choice(name, tuple(METHODS), name="--method")
    if seed is not None and folds is None:
        raise Failure("--seed is for random --folds", Exit.USAGE)
    if gradients is not None and not set(names) & set(_SMOOTH):
        raise _no_gradients(", ".join(names))
    require_known(crs)
    watch = Stopwatch()
    found: dict[str, dict[str, Any]] = {}
    with spinner(as_json) as say:
        survey, values, _ = _read(source, value, columns, classes, layer, watch, say)
        referenced(survey, crs, planar=planar, quiet=False)
        for name in names:
            options: dict[str, Any] = {}
            if gradients is not None and name in _SMOOTH:
                options["gradients"] = gradients
            with watch.stage(name):
                result = cross_validate(
                    survey.points,
                    values,
                    name,
                    folds=folds,
                    seed=seed or 0,
                    duplicates=duplicates,
                    nan=nan,
                    workers=workers,
                    progress=_told(say, name),
                    **options,
                )
            found[name] = {
                "rmse": finite_or_none(float(result.rmse)),
                "mae": finite_or_none(float(result.mae)),
                "predicted": result.count,
            }
    if as_json:
        stages = watch.rows(len(survey))
        print_json(
            {"delone": __version__, "input": str(source), "methods": found, "stages": stages}
        )
        return
    left_out = f"one of {folds} parts" if folds else "one"
    rows = [("points", f"{len(survey):,}"), ("left out", left_out)]
    rows += [
        (name, f"rmse {each['rmse']:.6g}, mae {each['mae']:.6g}, {each['predicted']:,} predicted")
        if each["predicted"]
        else (name, "nothing predicted")
        for name, each in found.items()
    ]
    print_rows(str(source), rows)


def _told(say: Callable[[str], None], name: str) -> Callable[[float], None]:
    return lambda share: say(f"{name}: {share:.0%} done")


def _read(  # noqa: PLR0917
    source: Path,
    value: str | None,
    columns: str | None,
    classes: str | None,
    layer: str | None,
    watch: Stopwatch,
    say: Callable[[str], None],
    *,
    quiet: bool = False,
) -> tuple[PointSet, NDArray[Any], str]:
    """Points, values and the name of the values."""
    say(f"reading {source.name}")
    with reading(quiet=quiet), watch.stage("read"):
        survey = read_points(
            source,
            columns=split(columns),
            classes=None if classes is None else numbers(classes, "--classes", int),
            layer=layer,
            attributes=() if value is None else (value,),
        )
    if value is not None:
        return survey, np.asarray(survey.attributes[value]), value
    if survey.z is None:
        raise Failure(f"{source}: which column should be interpolated? Give --value", Exit.USAGE)
    return survey, survey.z, "z"


def _made(
    method: str,
    survey: PointSet,
    values: NDArray[Any],
    gradients: str | None,
    options: dict[str, Any],
) -> Interpolator:
    if gradients is not None:
        options["gradients"] = gradients
        if method not in _SMOOTH:
            raise _no_gradients(method)
    return interpolator(survey.points, values, method, **options)


def _no_gradients(names: str) -> Failure:
    return Failure(f"--gradients is for {', '.join(_SMOOTH)}, not {names}", Exit.USAGE)


def _raster_options(size: str | None, resolution: str | None, bounds: str | None) -> dict[str, Any]:
    if (size is None) == (resolution is None):
        raise Failure("give the raster as --grid 500x400 or as --resolution 0.01", Exit.USAGE)
    found: dict[str, Any] = {}
    if size is not None:
        found["shape"] = tuple(numbers(size.replace("x", ","), "--grid", int))
        if len(found["shape"]) != 2:
            raise Failure(
                f"--grid takes columns and rows, such as 500x400; got {size!r:.80}", Exit.USAGE
            )
    if resolution is not None:
        cells = numbers(resolution, "--resolution")
        if len(cells) > 2:
            raise Failure(
                f"--resolution takes one or two numbers, got {resolution!r:.80}", Exit.USAGE
            )
        found["resolution"] = cells[0] if len(cells) == 1 else tuple(cells)
    if bounds is not None:
        found["bounds"] = numbers(bounds, "--bounds")
    return found


def _figures(
    source: Path, survey: PointSet, made: Interpolator, method: str, found: Grid
) -> dict[str, Any]:
    known = found.values[np.isfinite(found.values)]
    return {
        "delone": __version__,
        "input": str(source),
        "crs": survey.crs,
        "points": len(survey),
        "sites": made.triangulation.npoints - len(made.triangulation.coplanar),
        "method": method,
        "columns": len(found.x),
        "rows": len(found.y),
        "cell": list(found.cell_size),
        "extent": list(found.extent),
        "without_value": int(found.values.size - known.size),
        "least": float(known.min()) if known.size else None,
        "greatest": float(known.max()) if known.size else None,
    }


def _why_none(figures: dict[str, Any]) -> str:
    """Say why cells have no value."""
    limit = figures["max_distance"]
    beyond = "" if limit is None else f" or farther than {limit:.6g} from any point"
    return f"outside the hull{beyond}"


def _rows(figures: dict[str, Any]) -> list[tuple[str, str]]:
    cells = figures["columns"] * figures["rows"]
    rows = [
        ("points read", f"{figures['points']:,}"),
        ("sites", f"{figures['sites']:,}"),
        ("method", figures["method"]),
        ("raster", f"{figures['columns']:,} x {figures['rows']:,} = {cells:,} cells"),
        ("cell", " x ".join(f"{side:.6g}" for side in figures["cell"])),
        ("without a value", f"{figures['without_value']:,} cells, {_why_none(figures)}"),
    ]
    if figures["least"] is not None:
        rows.append(("values", f"{figures['least']:.6g} to {figures['greatest']:.6g}"))
    return rows
