"""The command ``voronoi``: cells of the sites in a file, clipped to an outline, with attributes."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import Voronoi, __version__
from delone._base.arrays import as_workers
from delone._base.atomic import replacing
from delone._base.extras import require
from delone.cli.constraints import geometries_of
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.options import Json, Layer, PlaneColumns, Quiet, Workers, outputs, split
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.report import Stopwatch, finite_or_none
from delone.cli.show import show_figures, spinner
from delone.cli.tables import TABLE_SUFFIXES, ready_table, write_table
from delone.errors import DegenerateInputError, FileFormatError, InputError, NonFiniteError
from delone.io import input_suffixes, read_points
from delone.io.gdal import DRIVERS
from delone.io.vector import attribute_names

if TYPE_CHECKING:
    from delone.cli.show import Row
    from delone.io import PointSet

__all__ = ["voronoi"]

_AREAS = (3, 6)  # shapely's type numbers of Polygon and MultiPolygon


def voronoi(
    source: Annotated[
        Path, typer.Argument(metavar="INPUT", help="File of sites: " + " ".join(input_suffixes()))
    ],
    *,
    output: Annotated[list[Path] | None, outputs("File of cells", TABLE_SUFFIXES)] = None,
    clip: Annotated[
        str,
        typer.Option(help="A file of polygons; XMIN,YMIN,XMAX,YMAX; or box (of the sites)."),
    ] = "box",
    fix: Annotated[bool, typer.Option("--fix", help="Repair an invalid outline.")] = False,
    weights: Annotated[
        str | None, typer.Option(help="Column of weights, for the cells of a power diagram.")
    ] = None,
    attributes: Annotated[
        str | None,
        typer.Option(help="Columns to keep; by default all columns, for a file of geometries."),
    ] = None,
    columns: PlaneColumns = None,
    layer: Layer = None,
    crs: Crs = None,
    planar: Planar = False,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Clip the Voronoi cells of sites to an outline, and write them with their attributes."""
    require_known(crs)
    if fix and not Path(clip).exists():
        raise Failure(f"--fix is for outlines in files, not for --clip {clip}", Exit.USAGE)
    with writing():
        protect_inputs(output or (), source, Path(clip))
        for path in output or ():
            ready_table(path, "cells")
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            sites = _sites(source, split(columns), layer, split(attributes), weights)
            sites = referenced(sites, crs, planar=planar, quiet=quiet)
            outline = _outline(clip, sites.crs, quiet=quiet)
        say(f"computing {len(sites):,} cells")
        with watch.stage("diagram"):
            diagram = _diagram(sites, outline, clip, fix=fix, weights=weights, workers=workers)
        with watch.stage("clip"):
            areas = diagram.cell_areas
        _write(diagram, sites, output or [], watch)
    distinct = np.unique(diagram.duplicate_of)
    figures: dict[str, Any] = {
        "delone": __version__,
        "input": str(source),
        "crs": sites.crs,
        "sites": diagram.npoints,
        "distinct": len(distinct),
        "hidden": len(diagram.hidden),
        "empty": int((areas[np.setdiff1d(distinct, diagram.hidden)] == 0).sum()),
        "vertices": len(diagram.vertices),
        "ridges": len(diagram.ridge_points),
        "area": finite_or_none(float(areas[distinct].sum())),
        **watch.ending(output, diagram.npoints),
    }
    show_figures(str(source), figures, _rows, as_json=as_json, quiet=quiet)


def _rows(figures: dict[str, Any]) -> list[Row]:
    names = ("sites", "distinct", "hidden", "empty", "vertices", "ridges")
    rows = [(name, f"{figures[name]:,}") for name in names if figures[name] or name != "hidden"]
    if figures["area"] is not None:
        rows.append(("area", f"{figures['area']:.10g}"))
    return rows


def _sites(
    source: Path,
    columns: list[str] | None,
    layer: str | None,
    attributes: list[str] | None,
    weights: str | None,
) -> PointSet:
    names = _all_attributes(source, layer) if attributes is None else attributes
    if weights is not None and weights not in names:
        names = [*names, weights]
    return read_points(source, columns=columns, layer=layer, attributes=names)


def _all_attributes(source: Path, layer: str | None) -> list[str]:
    """The names of all attributes of a file of geometries; none for other files."""
    if source.suffix.lower() not in DRIVERS or not source.exists():
        return []
    return attribute_names(source, layer=layer)


def _outline(clip: str, crs: str | None, *, quiet: bool) -> Any:
    """The value of --clip: a word, four numbers, or the union of all areas in a file."""
    if clip == "box":
        return clip
    parts = clip.split(",")
    if len(parts) == 4:
        try:
            return [float(part) for part in parts]
        except ValueError:
            pass
    shapely = require("shapely", extra="geo", what="reading an outline")
    if not Path(clip).exists():
        raise Failure(f"{clip}: neither a file, nor box, nor four numbers", Exit.INPUT)
    with reading(quiet=quiet, layer=None):
        found = geometries_of(Path(clip))
    geometries = found.geometries[~shapely.is_missing(found.geometries)]
    if not len(geometries) or not np.isin(shapely.get_type_id(geometries), _AREAS).all():
        raise FileFormatError(f"{clip} contains something other than polygons")
    if crs is not None and found.crs is not None and not _same_system(found.crs, crs):
        raise FileFormatError(
            f"{clip} is in {found.crs}, but the sites are in {crs}: transform one of them"
        )
    return geometries[0] if len(geometries) == 1 else _joined(shapely, geometries)


def _same_system(one: str, other: str) -> bool:
    pyproj = require("pyproj", extra="geo", what="comparing reference systems")
    try:
        return bool(pyproj.CRS.from_user_input(one) == pyproj.CRS.from_user_input(other))
    except pyproj.exceptions.CRSError:
        return False


def _joined(shapely: Any, geometries: Any) -> Any:
    """All areas as one geometry; invalid parts remain so and are reported later."""
    if shapely.is_valid(geometries).all():
        return shapely.union_all(geometries)
    return shapely.multipolygons(shapely.get_parts(geometries))


def _diagram(
    sites: PointSet,
    outline: Any,
    clip: str,
    *,
    fix: bool,
    weights: str | None,
    workers: int | None,
) -> Voronoi:
    heavy = None if weights is None else sites.attributes[weights]
    as_workers(workers)  # all other errors are about the outline
    try:
        return Voronoi(sites.points, clip=outline, fix=fix, weights=heavy, workers=workers)
    except (DegenerateInputError, NonFiniteError):
        raise
    except InputError as error:
        raise Failure(f"{clip}: {error}", Exit.INPUT) from error


def _write(diagram: Voronoi, sites: PointSet, output: list[Path], watch: Stopwatch) -> None:
    if not output:
        return
    with writing(), ExitStack() as stack:
        carried = dict(sites.attributes) or {"site": np.arange(diagram.npoints)}
        table = diagram.to_geopandas(carried, crs=sites.crs)
        for path in output:
            with watch.stage(f"write {path.name}"):
                target = stack.enter_context(replacing(path))
                write_table(table, target, layer="cells", multi=True)
