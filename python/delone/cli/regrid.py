"""Regridding of NetCDF files on the sphere: the command ``delone regrid``."""

from __future__ import annotations

import warnings
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import __version__, datasets, sphere
from delone._base.atomic import check_target, replacing
from delone._base.extras import require
from delone.cli.exits import Exit, Failure, protect_inputs, reading, require_suffix, writing
from delone.cli.notes import note
from delone.cli.options import Json, Quiet, Workers, outputs, split
from delone.cli.report import Stopwatch
from delone.cli.show import show_figures, spinner

if TYPE_CHECKING:
    from delone.cli.show import Row

__all__ = ["regrid"]

_SUFFIXES = (".nc", ".nc4", ".cdf")
_IMAGES = (".png", ".svg", ".pdf")


def regrid(
    source: Annotated[
        Path, typer.Argument(metavar="INPUT", help="NetCDF file with fields on a grid.")
    ],
    target: Annotated[
        str,
        typer.Argument(
            metavar="TARGET",
            help="NetCDF file with the target grid, or the name of a grid: 1x1 (degrees of "
            "longitude and latitude), healpix:64, healpix:64:nested, n80, o80 (Gaussian).",
        ),
    ],
    *,
    output: Annotated[list[Path] | None, outputs("File to write", _SUFFIXES + _IMAGES)] = None,
    method: Annotated[
        str,
        typer.Option(
            help="How values are combined. By shared areas: conservative (preserves integrals), "
            "normalized (means over the covered part), sum (amounts), majority (categories). "
            "Between centers: linear, bilinear, sibson, laplace, nearest, binned, "
            "inverse_distance."
        ),
    ] = "conservative",
    order: Annotated[
        int,
        typer.Option(
            help="For conservative and normalized: 1 for constant cells, 2 for cells with slopes."
        ),
    ] = 1,
    limiter: Annotated[
        bool,
        typer.Option(
            "--limiter", help="With --order 2: prevent values outside the range of neighbors."
        ),
    ] = False,
    neighbors: Annotated[
        int | None,
        typer.Option(help="For inverse_distance: the number of nearest cells; CDO uses 4."),
    ] = None,
    grid: Annotated[
        Path | None,
        typer.Option(help="File with the grid of INPUT, if it is not in INPUT itself."),
    ] = None,
    weights: Annotated[
        Path | None,
        typer.Option(
            help="ESMF or SCRIP map file with the weights, which also determines the method."
        ),
    ] = None,
    save_weights: Annotated[
        Path | None, typer.Option(help="Map file to write, in ESMF's layout.")
    ] = None,
    variables: Annotated[
        str | None, typer.Option(help="Variables to regrid, such as t2m,rain; by default all.")
    ] = None,
    skipna: Annotated[
        bool,
        typer.Option("--skipna", help="Ignore missing values; without this option they spread."),
    ] = False,
    min_fraction: Annotated[
        float,
        typer.Option(
            help="Target cells with values on a smaller fraction of their area are missing."
        ),
    ] = 0.0,
    fill: Annotated[
        float | None, typer.Option(help="The value of missing cells; by default NaN.")
    ] = None,
    dims: Annotated[
        str | None, typer.Option(help="Dimensions of the grid in INPUT, such as lat,lon.")
    ] = None,
    coords: Annotated[
        str | None,
        typer.Option(
            help="Longitude and latitude in INPUT if there are several, such as TLONG,TLAT."
        ),
    ] = None,
    infer_bounds: Annotated[
        bool,
        typer.Option("--infer-bounds", help="Infer missing cell bounds halfway between centers."),
    ] = False,
    cells: Annotated[
        str | None,
        typer.Option(
            help="For UGRID and FESOM meshes: whether fields of INPUT are at nodes or faces."
        ),
    ] = None,
    degrees: Annotated[
        bool | None,
        typer.Option("--degrees/--radians", help="The unit of angles without a units attribute."),
    ] = None,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Regrid the fields of a NetCDF file by the areas that cells share, exactly.

    Grids can be CF, UGRID, SCRIP, ESMF, MPAS, ICON, FESOM, Exodus, OASIS, GEOS-CS or HEALPix.
    Times, levels, attributes and float32 are kept; variables with only some of the grid's
    dimensions are left out with a note. Images show the first field on both grids, and the
    difference from the nearest source cells.
    """
    outputs = output or []
    written = [*outputs, *([save_weights] if save_weights else [])]
    named = Path(target)
    inputs = [path for path in (source, grid, weights, named if named.exists() else None) if path]
    with writing():
        protect_inputs(written, *inputs)
        for path in written:
            _require_suffix(path, _SUFFIXES + (_IMAGES if path is not save_weights else ()))
            check_target(path)
    pair = None if coords is None else _pair(coords)
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            whole = _opened(source)
            fields = _chosen(whole, split(variables), source)
            own = whole if grid is None else _opened(grid)
            wanted = _opened(named) if named.exists() else target
        say("finding weights")
        with reading(quiet=quiet), watch.stage("weights"):
            from delone.xarray import Regridder

            regridder = Regridder(
                own,
                wanted,
                method=method,
                order=order,
                limiter=limiter,
                neighbors=neighbors,
                weights=weights,
                dims=split(dims),
                coords=pair,
                infer_bounds=infer_bounds,
                cells=cells,
                degrees=degrees,
                workers=workers,
            )
        say("regridding")
        with reading(quiet=quiet), watch.stage("regrid"):
            options = {"skipna": skipna, "min_fraction": min_fraction, "fill": fill}
            found = _noted(regridder, fields, options, quiet=quiet)
        if outputs:
            _require_fields(regridder, fields, found)
        with writing(), ExitStack() as stack:
            # All files are complete before the first one is renamed.
            for path in written:
                with watch.stage(f"write {path.name}"):
                    place = stack.enter_context(replacing(path))
                    if path is save_weights:
                        regridder.weights.to_netcdf(
                            place, source=regridder.source, target=regridder.target
                        )
                    elif path.suffix.lower() in _IMAGES:
                        _draw(place, regridder, fields, found)
                    else:
                        unlimited = set(whole.encoding.get("unlimited_dims", ())) & set(found.dims)
                        found.to_netcdf(place, engine="netcdf4", unlimited_dims=unlimited)
        figures = _figures(source, regridder, fields, found) | {
            **watch.ending(written, regridder.target.ncells),
        }
    show_figures(str(source), figures, _rows, as_json=as_json, quiet=quiet)


def _require_suffix(path: Path, known: tuple[str, ...]) -> None:
    require_suffix(path, known, "the output")
    if path.suffix.lower() in _IMAGES:
        require("matplotlib", extra="plot", what="drawing")


def _pair(text: str) -> tuple[str, str]:
    names = split(text) or []
    if len(names) != 2:
        raise Failure(f"--coords takes a longitude and a latitude, got {text!r:.80}", Exit.USAGE)
    return names[0], names[1]


def _opened(path: Path) -> Any:
    """Return the dataset of a file; times remain numbers."""
    xarray = require("xarray", extra="xarray", what="reading NetCDF files")
    require("netCDF4", extra="xarray", what="reading NetCDF files")
    if not path.exists():
        raise Failure(f"{path}: No such file or directory", Exit.INPUT)
    try:
        return xarray.open_dataset(path, engine="netcdf4", decode_times=False)
    except (OSError, ValueError) as error:
        raise Failure(f"{path}: not a NetCDF file ({error})", Exit.INPUT) from error


def _chosen(fields: Any, names: list[str] | None, source: Path) -> Any:
    """Return the dataset with only some of its fields."""
    for name in names or ():
        if name not in fields.data_vars:
            known = ", ".join(map(str, fields.data_vars))
            raise Failure(f"{source}: no variable {name!r:.60}; it has {known:.300}", Exit.USAGE)
    return fields if names is None else fields[names]


def _noted(regridder: Any, fields: Any, options: dict[str, Any], *, quiet: bool) -> Any:
    """Return the fields on the target, with a note about those that are left out."""
    from delone.xarray import VariableWarning

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", VariableWarning)
        found = regridder(fields, **options)
    for each in caught:
        note(str(each.message), quiet=quiet)
    return found


def _require_fields(regridder: Any, fields: Any, found: Any) -> None:
    """Reject a dataset of which no variable is on the source grid."""
    if _regridded(regridder, fields, found):
        return
    shape = " x ".join(map(str, regridder.source.grid_shape))
    sizes = [
        f"{name!s:.60} has {' x '.join(f'{dim} {n}' for dim, n in part.sizes.items()) or 'none'}"
        for name, part in fields.data_vars.items()
    ]
    if not sizes:
        raise Failure("there are no fields to regrid: the file has no variables", Exit.INPUT)
    more = f" and {len(sizes) - 3} more" if len(sizes) > 3 else ""
    raise Failure(
        f"no field is on the grid of {shape} cells. Dimensions of variables: "
        f"{', '.join(sizes[:3])}{more}. Give those of the grid as --dims",
        Exit.USAGE,
    )


def _draw(path: Path, regridder: Any, fields: Any, found: Any) -> None:
    """Draw the first field, at index 0 of its other dimensions, on both grids.

    A third map shows what regridding changes: the result without the value of the nearest cell.
    Amounts and categories have no such difference.
    """
    figures = require("matplotlib.figure", extra="plot", what="drawing")
    names = _regridded(regridder, fields, found)
    before, after = fields[names[0]], found[names[0]]
    own = regridder.source_dims or before.dims[before.ndim - len(regridder.source.grid_shape) :]
    maps = 2 if regridder.weights.method in {"sum", "majority"} else 3
    figure = figures.Figure(figsize=(9.0, 4.4 * maps), dpi=140, layout="constrained")
    axes = figure.subplots(maps, 1)
    shown = []
    for ax, grid, array, dims in zip(
        axes[:2],
        (regridder.source, regridder.target),
        (before, after),
        (own, regridder.target_dims),
        strict=True,
    ):
        others = {dim: 0 for dim in array.dims if dim not in dims}
        values = array.isel(others).transpose(*dims).values
        title = f"{names[0]}, {grid.ncells:,} cells"
        grid.plot(ax, values=values, sides=False, coast=datasets.land(), title=title)
        shown.append(values)
    if maps == 3:
        _draw_change(axes[2], regridder, shown, names[0])
    figure.savefig(path, facecolor="white", format=path.suffix.lower().lstrip("."))


def _draw_change(ax: Any, regridder: Any, shown: list[Any], name: str) -> None:
    """Draw a field on the target without that of the nearest source cells."""
    near = sphere.Weights.between(regridder.source, regridder.target, "nearest")
    change = shown[1].astype(float) - near.apply(shown[0]).reshape(shown[1].shape)
    most = float(np.nanmax(np.abs(change), initial=0.0)) or 1.0
    title = f"{name}, difference from the nearest source cell"
    drawn = regridder.target.plot(
        ax, values=change, sides=False, coast=datasets.land(), cmap="RdBu_r", title=title
    )
    # Cells without a change are white.
    drawn.images[0].set_clim(-most, most)


def _regridded(regridder: Any, fields: Any, found: Any) -> list[str]:
    """Return the names of the fields on the target."""
    on_target = set(regridder.target_dims)
    return [
        str(name)
        for name, part in found.data_vars.items()
        if name in fields.data_vars and on_target <= set(part.dims)
    ]


def _figures(source: Path, regridder: Any, fields: Any, found: Any) -> dict[str, Any]:
    weights = regridder.weights
    covered = weights.target_areas[weights.fractions > 0].sum() / weights.target_areas.sum()
    return {
        "delone": __version__,
        "input": str(source),
        "method": weights.method,
        "source": _described(regridder.source),
        "target": _described(regridder.target),
        "masked": {
            "source": len(regridder.source.report.masked),
            "target": len(regridder.target.report.masked),
        },
        "weights": len(weights.values),
        "target_covered": float(covered),
        "variables": _regridded(regridder, fields, found),
    }


def _described(grid: sphere.Grid) -> dict[str, Any]:
    return {"cells": grid.ncells, "shape": list(grid.grid_shape), "sides": grid.edges}


def _rows(figures: dict[str, Any]) -> list[Row]:
    rows = []
    for name in ("source", "target"):
        side = figures[name]
        shape = " x ".join(f"{size:,}" for size in side["shape"])
        sides = "parallels" if side["sides"] == "parallel" else "arcs of great circles"
        masked = figures["masked"][name]
        text = f"{shape} cells, {sides}"
        rows.append((name, f"{text}, {masked:,} masked" if masked else text))
    return [
        *rows,
        ("method", figures["method"]),
        ("weights", f"{figures['weights']:,}"),
        ("covered", f"{100 * figures['target_covered']:.6g} % of the target's area has values"),
        ("variables", f"{', '.join(figures['variables']) or 'none'}"),
    ]
