"""Triangulation of longitudes and latitudes on the sphere: the command ``delone sphere``."""

from __future__ import annotations

import math
import warnings
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from delone import __version__, datasets, sphere
from delone._base.atomic import check_target
from delone._base.extras import require
from delone._base.georeference import is_geographic
from delone.cli.exits import Exit, Failure, protect_inputs, reading, require_suffix, writing
from delone.cli.notes import note
from delone.cli.options import (
    Classes,
    Columns,
    Json,
    Layer,
    Quiet,
    Workers,
    class_numbers,
    outputs,
    require_files,
    split,
)
from delone.cli.outputs import write_all
from delone.cli.referenced import Crs, require_known
from delone.cli.report import Stopwatch
from delone.cli.show import show_figures, spinner
from delone.io import input_suffixes, read_points
from delone.io.writing import writer

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone.cli.show import Row
    from delone.io import PointSet

__all__ = ["globe"]

_SUFFIXES = (".vtu", ".ply", ".obj", ".stl", ".msh", ".xdmf", ".inp")
# Formats that store values of points.
_WITH_VALUES = (".vtu", ".ply", ".msh")
_IMAGES = (".png", ".svg", ".pdf")
_FIRST = 5


def globe(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="INPUT",
            help="File of longitudes and latitudes: " + " ".join(input_suffixes()),
        ),
    ],
    *,
    output: Annotated[list[Path] | None, outputs("File to write", _SUFFIXES + _IMAGES)] = None,
    columns: Columns = None,
    classes: Classes = None,
    layer: Layer = None,
    radians: Annotated[
        bool, typer.Option("--radians", help="Longitudes and latitudes are in radians.")
    ] = False,
    edges: Annotated[
        bool, typer.Option("--edges", help="Write edges instead of triangles.")
    ] = False,
    view: Annotated[
        str | None,
        typer.Option(
            metavar="LON,LAT",
            help="Images: longitude and latitude of the center, in degrees; by default the mean "
            "direction.",
        ),
    ] = None,
    workers: Workers = None,
    crs: Crs = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Triangulate longitudes and latitudes on the sphere, report, and write meshes.

    The points of a mesh are on the unit sphere, in the order of the file. Heights are values at the
    points, in .vtu, .ply and .msh. Images show the globe with the coast; triangles are colored by
    their mean heights.
    """
    require_known(crs)
    center = _view(view)
    require_files(edges, output)
    with writing():
        protect_inputs(output or (), source)
        writers = {path: _ready(path, center) for path in output or ()}
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            survey = read_points(
                source, columns=split(columns), classes=class_numbers(classes), layer=layer
            )
        _require_angles(survey, crs)
        say(f"triangulating {len(survey):,} points")
        with watch.stage("triangulate"):
            mesh = _triangulated(survey, radians=radians, workers=workers, quiet=quiet)
        values = _values(survey)
        held = {
            path: partial(write, attributes=_held(path, values, edges=edges))
            for path, write in writers.items()
        }
        write_all(held, mesh, watch, say, edges=edges)
        say("measuring")
        with watch.stage("measure"):
            measures = _measures(mesh)
        figures = {
            "delone": __version__,
            "input": str(source),
            "crs": crs or survey.crs,
            **measures,
            **watch.ending(writers, mesh.npoints),
        }
    show_figures(str(source), figures, _rows, as_json=as_json, quiet=quiet)


def _view(text: str | None) -> tuple[float, float] | None:
    """The longitude and latitude of the center of an image."""
    if text is None:
        return None
    try:
        lon, lat = (float(part) for part in text.split(","))
    except ValueError:
        lon = lat = math.nan
    if not (math.isfinite(lon) and abs(lat) <= 90):
        raise Failure(f"--view takes a longitude and a latitude; got {text!r:.80}", Exit.USAGE)
    return lon, lat


def _ready(path: Path, center: tuple[float, float] | None) -> Callable[..., None]:
    suffix = path.suffix.lower()
    if suffix in _IMAGES:
        figures = require("matplotlib.figure", extra="plot", what="drawing")
        check_target(path)
        return partial(_draw, figures=figures, center=center)
    require_suffix(path, _SUFFIXES + _IMAGES, "the sphere")
    write = writer(path, surface=True)
    check_target(path)
    return write


def _draw(
    path: Path,
    mesh: sphere.Delaunay,
    *,
    figures: Any,
    center: tuple[float, float] | None,
    attributes: dict[str, Any] | None,
    edges: bool,
) -> None:
    """Draw the front half of the globe, colored by height unless only edges are wanted."""
    name, heights = next(iter((attributes or {}).items()), ("", None))
    values = None if heights is None or edges else heights[mesh.simplices].mean(axis=1)
    figure = figures.Figure(figsize=(8.0, 8.0), dpi=160, layout="constrained")
    ax = figure.add_subplot()
    mesh.plot(
        ax,
        values=values,
        view=center,
        coast=datasets.land(),
        title=f"{mesh.npoints:,} points, {mesh.nsimplex:,} triangles",
    )
    if values is not None:
        ax.figure.axes[-1].set_ylabel(name)
    figure.savefig(path, facecolor="white")


def _require_angles(survey: PointSet, crs: str | None) -> None:
    """Reject a reference system whose coordinates are not longitudes and latitudes."""
    system = crs or survey.crs
    if system is not None and not is_geographic(system):
        name = system.partition("\n")[0]
        raise Failure(
            f"{survey.source}: {name:.60} has no longitudes and latitudes; triangulate its plane "
            "with delone triangulate, or transform the points to EPSG:4326",
            Exit.USAGE,
        )


def _triangulated(
    survey: PointSet, *, radians: bool, workers: int | None, quiet: bool
) -> sphere.Delaunay:
    """Triangulate, with a note instead of the warning about mixed conventions."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", sphere.LongitudeWarning)
        mesh = sphere.Delaunay(lonlat=survey.points, degrees=not radians, workers=workers)
    for each in caught:
        note(f"{survey.source}: {each.message}", quiet=quiet)
    return mesh


def _values(survey: PointSet) -> dict[str, Any]:
    """The heights, keyed by the name of their column."""
    if survey.z is None:
        return {}
    return {survey.columns[2] if len(survey.columns) > 2 else "z": survey.z}


def _held(path: Path, values: dict[str, Any], *, edges: bool) -> dict[str, Any] | None:
    return None if edges or path.suffix.lower() not in (*_WITH_VALUES, *_IMAGES) else values


def _measures(mesh: sphere.Delaunay) -> dict[str, Any]:
    """Counts, the counts expected from Euler's formula, duplicates, and the area."""
    distinct = mesh.npoints - len(mesh.duplicates)
    whole, hull = mesh.covers_sphere, len(mesh.boundary)
    # Euler: vertices - edges + triangles is 2 on the sphere, and 1 for a hull.
    triangles, edges = 2 * distinct - hull - 2, 3 * distinct - hull - 3
    places = mesh.lonlat[mesh.duplicates[:_FIRST, 0]].tolist()
    return {
        "points": mesh.npoints,
        "distinct": distinct,
        "duplicates": {
            "count": len(mesh.duplicates),
            "first": [
                {"row": row, "same_as": same, "lon": lon, "lat": lat}
                for (row, same), (lon, lat) in zip(
                    mesh.duplicates[:_FIRST].tolist(), places, strict=True
                )
            ],
        },
        "whole_sphere": whole,
        "boundary_edges": hull,
        "triangles": {"count": mesh.nsimplex, "expected": triangles - 2 * whole},
        "edges": {"count": len(mesh.edges), "expected": edges - 3 * whole},
        "share_of_sphere": float(mesh.areas.sum()) / (4 * math.pi),
    }


def _rows(figures: dict[str, Any]) -> list[Row]:
    whole = figures["whole_sphere"]
    hull = figures["boundary_edges"]
    share = f"{figures['share_of_sphere']:.6g} of the sphere"
    covers = "the whole sphere" if whole else f"{share}, inside {hull:,} arcs"
    return [
        ("points read", f"{figures['points']:,}"),
        ("distinct", f"{figures['distinct']:,}"),
        ("duplicates", _duplicates(figures["duplicates"])),
        ("covers", covers),
        ("triangles", _against(figures["triangles"], "2n - 4" if whole else "2n - h - 2")),
        ("edges", _against(figures["edges"], "3n - 6" if whole else "3n - h - 3")),
    ]


def _against(counted: dict[str, int], formula: str) -> str:
    count, expected = counted["count"], counted["expected"]
    verdict = "=" if count == expected else f"IS NOT {expected:,} ="
    return f"{count:,} {verdict} {formula}"


def _duplicates(found: dict[str, Any]) -> str:
    lines = [f"{found['count']:,}"]
    for each in found["first"]:
        place = f"{each['lon']:.9g}, {each['lat']:.9g}"
        lines.append(f"row {each['row']} is row {each['same_as']} at ({place})")
    if found["count"] > len(found["first"]):
        lines.append("...")
    return "\n".join(lines)
