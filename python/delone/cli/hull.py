"""The command ``hull``: a convex or concave hull, or an alpha shape, of the points in a file."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import AlphaComplex, Delaunay, __version__, concave_hull
from delone._base.atomic import replacing
from delone._base.extras import require
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.options import (
    Classes,
    Json,
    Layer,
    PlaneColumns,
    PointsInput,
    Quiet,
    Workers,
    class_numbers,
    outputs,
    split,
)
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.report import Stopwatch, finite_or_none
from delone.cli.show import show_figures, spinner
from delone.cli.tables import TABLE_SUFFIXES, ready_table, write_table
from delone.io import read_points

if TYPE_CHECKING:
    from delone.alpha.shape import Kept
    from delone.cli.show import Row

__all__ = ["hull"]

_BEST = "optimal"


def hull(
    source: PointsInput,
    *,
    output: Annotated[list[Path] | None, outputs("File of the outline", TABLE_SUFFIXES)] = None,
    concave: Annotated[
        bool, typer.Option("--concave", help="One polygon, with long edges carved away.")
    ] = False,
    max_edge: Annotated[
        float | None, typer.Option(help="concave: remove edges longer than this.")
    ] = None,
    ratio: Annotated[
        float | None,
        typer.Option(
            help="concave: from 0 (remove as much as possible) to 1 (keep the convex hull)."
        ),
    ] = None,
    holes: Annotated[bool, typer.Option("--holes", help="concave: carve holes, too.")] = False,
    alpha: Annotated[
        str | None,
        typer.Option(
            help="Keep triangles whose circles have at most this squared radius; or optimal: the "
            "smallest one for which one polygon without holes contains all points."
        ),
    ] = None,
    classes: Classes = None,
    columns: PlaneColumns = None,
    layer: Layer = None,
    crs: Crs = None,
    planar: Planar = False,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compute the outline of points, and write its polygons."""
    limit = _alpha(alpha)
    _require_matching(concave=concave, holes=holes, max_edge=max_edge, ratio=ratio, alpha=limit)
    require_known(crs)
    with writing():
        protect_inputs(output or (), source)
        for path in output or ():
            ready_table(path, "outlines")
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            survey = read_points(
                source, columns=split(columns), classes=class_numbers(classes), layer=layer
            )
            survey = referenced(survey, crs, planar=planar, quiet=quiet)
        say(f"computing the outline of {len(survey):,} points")
        with watch.stage("outline"):
            mesh = Delaunay(survey.points, workers=workers, planar=True)
            if limit is not None:
                found: Kept = _shape(mesh, limit)
            elif max_edge is None and ratio is None:
                found = concave_hull(mesh, ratio=1.0)
            else:
                found = concave_hull(mesh, max_edge=max_edge, ratio=ratio, holes=holes)
        _write(found, survey.crs, output or [], watch)
    outside = len(np.unique(mesh.simplices)) - len(np.unique(mesh.simplices[found.is_kept]))
    figures: dict[str, Any] = {
        "delone": __version__,
        "input": str(source),
        "crs": survey.crs,
        "points": mesh.npoints,
        "outside": outside,
        "polygons": found.nparts,
        "edges": len(found.boundary),
        "area": finite_or_none(found.area),
        "length": finite_or_none(found.perimeter),
        "alpha": getattr(found, "alpha", None),
        **watch.ending(output, mesh.npoints),
    }
    show_figures(str(source), figures, _rows, as_json=as_json, quiet=quiet)


def _alpha(text: str | None) -> float | str | None:
    if text is None or text == _BEST:
        return text
    try:
        found = float(text)
    except ValueError:
        found = -1.0
    if not found >= 0:
        raise Failure(
            f"--alpha {text}: not a squared radius of at least 0, nor {_BEST}", Exit.USAGE
        )
    return found


def _require_matching(
    *,
    concave: bool,
    holes: bool,
    max_edge: float | None,
    ratio: float | None,
    alpha: float | str | None,
) -> None:
    """Reject options that contradict each other."""
    has_limit = max_edge is not None or ratio is not None
    if concave and ((max_edge is None) == (ratio is None)):
        raise Failure("--concave needs either --max-edge or --ratio", Exit.USAGE)
    if (has_limit or holes) and not concave:
        raise Failure("--max-edge, --ratio and --holes are for --concave", Exit.USAGE)
    if concave and alpha is not None:
        raise Failure("--concave and --alpha: give one of them", Exit.USAGE)
    if ratio is not None and not 0 <= ratio <= 1:
        raise Failure(f"--ratio {ratio:g}: not from 0 to 1", Exit.USAGE)
    if max_edge is not None and not max_edge >= 0:
        raise Failure(f"--max-edge {max_edge:g}: not a length of at least 0", Exit.USAGE)


def _shape(mesh: Delaunay, alpha: float | str) -> Kept:
    complex = AlphaComplex(mesh)
    return complex.shape(complex.optimal() if isinstance(alpha, str) else alpha)


def _write(found: Kept, crs: str | None, output: list[Path], watch: Stopwatch) -> None:
    if not output:
        return
    geopandas = require("geopandas", extra="geo", what="writing outlines")
    polygons = found.polygons()
    columns = {"polygon": np.arange(len(polygons))}
    with writing(), ExitStack() as stack:
        table = geopandas.GeoDataFrame(columns, geometry=list(polygons), crs=crs)
        for path in output:
            with watch.stage(f"write {path.name}"):
                write_table(table, stack.enter_context(replacing(path)), layer="outline")


def _rows(figures: dict[str, Any]) -> list[Row]:
    rows = [(name, f"{figures[name]:,}") for name in ("points", "outside", "polygons", "edges")]
    for name in ("area", "length", "alpha"):
        value = figures[name]
        if value is not None:
            rows.append((name, f"{value:.10g}"))
    return rows
