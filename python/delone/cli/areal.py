"""The command ``areal``: transfer columns from one layer of polygons to another."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np
import typer

from delone import Overlaps, __version__
from delone._base.atomic import check_target, replacing
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.georeference import is_geographic, same_crs
from delone.cli.constraints import geometries_of
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.notes import note
from delone.cli.options import Json, Quiet, Workers, outputs, split
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.report import Stopwatch, finite_or_none
from delone.cli.show import show_figures, spinner
from delone.cli.tables import TABLE_SUFFIXES, ready_table, write_table

if TYPE_CHECKING:
    from delone.cli.show import Row
    from delone.io import GeometrySet

__all__ = ["areal"]

_IMAGES = (".png", ".svg", ".pdf")
_SUFFIXES = (".csv", *TABLE_SUFFIXES, *_IMAGES)
# Percentiles of values at the ends of the colors of a map.
_SPREAD = (2, 98)
# The column for the covered fraction of each cell.
_COVERED = "covered"


class _Result(NamedTuple):
    """What is written and reported."""

    source: GeometrySet
    target: GeometrySet
    overlaps: Overlaps
    methods: dict[str, str]
    found: dict[str, Any]


def _columns(method: str, what: str) -> Any:
    return typer.Option(f"--{method}", metavar="A,B", help=f"Columns with {what}.")


def areal(
    source: Annotated[
        Path, typer.Argument(metavar="SOURCE", help="File of polygons with known values.")
    ],
    target: Annotated[
        Path, typer.Argument(metavar="TARGET", help="File of polygons to transfer values to.")
    ],
    *,
    output: Annotated[list[Path] | None, outputs("Layer, table or map to write", _SUFFIXES)] = None,
    sums: Annotated[
        str | None, _columns("sum", "amounts, such as inhabitants, that are divided by area")
    ] = None,
    normalized: Annotated[
        str | None, _columns("normalized", "states and rates: means over the covered part")
    ] = None,
    conservative: Annotated[
        str | None, _columns("conservative", "densities: integrals over the area of a target cell")
    ] = None,
    majority: Annotated[
        str | None, _columns("majority", "categories: what covers most of a target cell")
    ] = None,
    skipna: Annotated[
        bool, typer.Option("--skipna", help="Ignore missing values, which otherwise propagate.")
    ] = False,
    min_fraction: Annotated[
        float,
        typer.Option(
            help="Target cells with values on a smaller fraction of their area are missing."
        ),
    ] = 0.0,
    layer: Annotated[str | None, typer.Option(help="Layer of SOURCE, if it has several.")] = None,
    target_layer: Annotated[
        str | None, typer.Option(help="Layer of TARGET, if it has several.")
    ] = None,
    crs: Crs = None,
    target_crs: Annotated[
        str | None, typer.Option(help="Like --crs, for TARGET; by default the system of SOURCE.")
    ] = None,
    project: Annotated[
        str | None,
        typer.Option(
            help="Equal-area system in which areas are computed, such as EPSG:6933; TARGET keeps "
            "its own system in the output."
        ),
    ] = None,
    planar: Planar = False,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Transfer columns between layers of polygons by the areas that they share, exactly.

    The polygons of TARGET are written with all their columns, the transferred ones, and the
    fraction that SOURCE covers. Maps show the first column on both layers.
    """
    methods = _methods(
        {
            "sum": sums,
            "normalized": normalized,
            "conservative": conservative,
            "majority": majority,
        }
    )
    for system in (crs, target_crs, project):
        require_known(system)
    _ready(output or [], source, target, methods)
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            muted = planar or project is not None
            one = _layer(source, layer, crs, planar=muted, quiet=quiet)
            with reading(quiet=quiet, layer="--target-layer"):
                two = _layer(target, target_layer, target_crs, planar=muted, quiet=quiet)
            _require_columns(one, methods)
            layers = _layers(one, two, project, planar=planar)
        say("computing areas")
        with reading(quiet=quiet), watch.stage("areas"):
            overlaps = Overlaps(*layers, workers=workers)
        with reading(quiet=quiet), watch.stage("transfer"):
            found = overlaps.transfer(
                one.attributes, methods, skipna=skipna, min_fraction=min_fraction
            )
        result = _Result(one, two, overlaps, methods, found)
        _write(output or [], result, watch, quiet=quiet)
    figures = _figures(result) | {
        **watch.ending(output, len(two)),
    }
    show_figures(f"{source} on {target}", figures, _rows, as_json=as_json, quiet=quiet)


def _methods(given: dict[str, str | None]) -> dict[str, str]:
    """Return the method of each column, in the order of methods."""
    found: dict[str, str] = {}
    for method, text in given.items():
        for name in split(text) or ():
            if name in found:
                raise Failure(
                    f"column {name!r:.60} has two methods: {found[name]} and {method}", Exit.USAGE
                )
            found[name] = method
    if _COVERED in found:
        raise Failure(
            f"the output has a column {_COVERED}, the covered fraction: rename that column of the "
            f"source",
            Exit.USAGE,
        )
    return found


def _ready(output: list[Path], source: Path, target: Path, methods: dict[str, str]) -> None:
    """Check that files can be written before any work is done."""
    with writing():
        protect_inputs(output, source, target)
        for path in output:
            suffix = path.suffix.lower()
            if suffix == ".csv":
                check_target(path)
            elif suffix in _IMAGES:
                require("matplotlib", extra="plot", what="drawing")
                require("geopandas", extra="geo", what="drawing maps")
                check_target(path)
                if not methods:
                    raise Failure(f"{path}: a map needs a column, such as --sum", Exit.USAGE)
            else:
                ready_table(path, "polygons", also=" ".join((".csv", *_IMAGES)))


def _layer(
    path: Path, name: str | None, crs: str | None, *, planar: bool, quiet: bool
) -> GeometrySet:
    """Return a layer with all columns; print a note if coordinates look like degrees."""
    layer = geometries_of(path, layer=name, attributes="all")
    system = layer.crs if crs is None else crs
    # Layers that declare degrees are rejected later.
    known = system is not None and is_geographic(system)
    return referenced(layer, crs, planar=planar or known, quiet=quiet)


def _require_columns(layer: GeometrySet, methods: dict[str, str]) -> None:
    for name in methods:
        if name not in layer.attributes:
            known = ", ".join(map(str, layer.attributes)) or "none"
            raise Failure(
                f"{layer.source}: no column {name!r:.60}; its columns: {known:.300}", Exit.USAGE
            )


def _layers(
    one: GeometrySet, two: GeometrySet, project: str | None, *, planar: bool
) -> tuple[Any, Any]:
    """Return the geometries of both layers, with the systems in which areas are computed."""
    geopandas = require("geopandas", extra="geo", what="layers of polygons")
    series = [geopandas.GeoSeries(each.geometries, crs=each.crs) for each in (one, two)]
    if project is not None:
        for each in (one, two):
            if each.crs is None:
                raise Failure(
                    f"{each.source}: --project needs the reference system, and the file has none: "
                    "give --crs or --target-crs",
                    Exit.USAGE,
                )
        return series[0].to_crs(project), series[1].to_crs(project)
    for each in (one, two):
        if not planar and each.crs is not None and is_geographic(each.crs):
            raise Failure(
                f"{each.source} is in longitudes and latitudes, where areas are not those of a "
                "plane: give --project with an equal-area system, such as EPSG:6933, or --planar",
                Exit.USAGE,
            )
    if planar:
        if one.crs is not None and two.crs is not None and not same_crs(one.crs, two.crs):
            raise Failure("--planar needs layers in one reference system", Exit.USAGE)
        return series[0].set_crs(None, allow_override=True), series[1].set_crs(
            None, allow_override=True
        )
    return series[0], series[1]


def _write(output: list[Path], result: _Result, watch: Stopwatch, *, quiet: bool) -> None:
    """Write the target with its columns and those that were transferred."""
    if not output:
        return
    own, found = result.target, result.found
    columns: dict[str, Any] = {}
    for name, values in own.attributes.items():
        free = name
        # Terminates, because there are finitely many names.
        while free in columns or free in (*found, _COVERED, "geometry"):
            free = f"target_{free}"
        if free != name and any(path.suffix.lower() not in _IMAGES for path in output):
            note(
                f"the column {name!r:.80} of the target is {free!r:.80} in the output", quiet=quiet
            )
        columns[free] = values
    columns |= found | {_COVERED: result.overlaps.covered_target}
    with writing(), ExitStack() as stack:
        geopandas = require("geopandas", extra="geo", what="tables of polygons")
        system = own.crs or result.source.crs
        table = geopandas.GeoDataFrame(columns, geometry=own.geometries, crs=system)
        for path in output:
            with watch.stage(f"write {path.name}"):
                place = stack.enter_context(replacing(path))
                suffix = path.suffix.lower()
                if suffix in _IMAGES:
                    _draw(place, suffix, result)
                elif suffix == ".csv":
                    table.drop(columns="geometry").to_csv(place, index=False)
                else:
                    write_table(table, place, layer="areal", multi=True)


def _draw(path: Path, suffix: str, result: _Result) -> None:
    """Draw the first column on both layers: amounts by area, so that colors compare."""
    figures = require("matplotlib.figure", extra="plot", what="drawing")
    geopandas = require("geopandas", extra="geo", what="drawing maps")
    overlaps = result.overlaps
    layers = result.source, result.target
    name, method = next(iter(result.methods.items()))
    both = [np.asarray(result.source.attributes[name]), np.asarray(result.found[name])]
    title = name
    if method == "sum":
        title = f"{name} by area"
        with np.errstate(divide="ignore", invalid="ignore"):
            both = [
                np.where(areas > 0, values.astype(float) / areas, np.nan)
                for values, areas in zip(
                    both, (overlaps.source_areas, overlaps.target_areas), strict=True
                )
            ]
    known = [x for values in both for x in values.tolist() if x is not None and x == x]  # noqa: PLR0124
    options: dict[str, Any]
    if method == "majority":
        options = {"categorical": True, "legend": True, "categories": sorted(set(known), key=str)}
    else:
        # Otherwise, a few cells with extreme values would leave a single color for all others.
        low, high = np.percentile(known, _SPREAD) if known else (0.0, 1.0)
        options = {"vmin": low, "vmax": high}
    figure = figures.Figure(figsize=(11.0, 5.2), dpi=140, layout="constrained")
    both_axes = figure.subplots(1, 2)
    for ax, layer, values, what in zip(both_axes, layers, both, ("source", "target"), strict=True):
        table = geopandas.GeoDataFrame({"shown": values}, geometry=layer.geometries, crs=layer.crs)
        table.plot(
            "shown", ax=ax, edgecolor="white", linewidth=0.3,
            missing_kwds={"color": "0.85", "label": "no value"}, **options,
        )  # fmt: skip
        ax.set_aspect("equal")
        ax.set_title(f"{title}, {what}: {counted(len(table), 'cell')}")
    if method != "majority":
        shades = require("matplotlib.cm", extra="plot", what="drawing").ScalarMappable()
        shades.set_clim(low, high)
        figure.colorbar(shades, ax=both_axes, extend="both")
    figure.savefig(path, facecolor="white", format=suffix.lstrip("."))


def _figures(result: _Result) -> dict[str, Any]:
    one, overlaps = result.source, result.overlaps
    report = overlaps.report
    covered = [
        _share(areas, shares)
        for areas, shares in (
            (overlaps.source_areas, overlaps.covered_source),
            (overlaps.target_areas, overlaps.covered_target),
        )
    ]
    sides: dict[str, Any] = {
        side: {
            "cells": len(getattr(overlaps, f"{side}_areas")),
            "covered": share,
            **{
                what: len(getattr(report, f"{side}_{what}"))
                for what in ("outside", "partly", "repeatedly", "empty")
            },
        }
        for side, share in zip(("source", "target"), covered, strict=True)
    }
    columns = []
    for name, method in result.methods.items():
        column: dict[str, Any] = {"name": name, "method": method}
        values = np.asarray(result.found[name])
        if values.dtype.kind == "f":
            column["missing"] = int(np.isnan(values).sum())
            if method == "sum":
                given = np.array([_number(x) for x in one.attributes[name].tolist()])
                column["source_total"] = finite_or_none(float(np.nansum(given)))
                column["target_total"] = finite_or_none(float(np.nansum(values)))
        else:
            column["missing"] = sum(x is None for x in values.tolist())
        columns.append(column)
    return {
        "delone": __version__,
        "input": one.source,
        "target_input": result.target.source,
        "crs": overlaps.crs,
        "pairs": report.npairs,
        **sides,
        "columns": columns,
    }


def _number(value: Any) -> float:
    """Return a number of a column; NaN for missing ones."""
    return float(value) if isinstance(value, bool | int | float) else float("nan")


def _share(areas: Any, shares: Any) -> float | None:
    """Return the covered fraction of the total area of all cells."""
    total = float(areas.sum())
    used = areas > 0
    return float((areas[used] * shares[used]).sum() / total) if total else None


def _rows(figures: dict[str, Any]) -> list[Row]:
    rows: list[Row] = []
    for side in ("source", "target"):
        known = figures[side]
        text = counted(known["cells"], "polygon")
        if known["covered"] is not None:
            text += f", {100 * known['covered']:.6g} % of the area covered"
        ends = {
            "outside": "outside",
            "partly": "partly covered",
            "repeatedly": "covered more than once",
            "empty": "without area",
        }
        text += "".join(f", {known[what]:,} {end}" for what, end in ends.items() if known[what])
        rows.append((side, text))
    rows.append(("pairs", f"{figures['pairs']:,}"))
    for column in figures["columns"]:
        text = column["method"]
        if "source_total" in column and None not in (
            column["source_total"],
            column["target_total"],
        ):
            text += f", total {column['source_total']:.10g}, of which {column['target_total']:.10g}"
            text += " is on the target"
        if column["missing"]:
            text += f", {column['missing']:,} missing"
        rows.append((column["name"], text))
    return rows
