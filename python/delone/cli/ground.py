"""The command ``ground``: find the ground points of a lidar file, and write their classes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from delone import __version__
from delone._base.atomic import check_target, replacing
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
from delone.cli.notes import noting
from delone.cli.options import Json, Quiet, Workers
from delone.cli.referenced import Crs, Planar, referenced, require_known
from delone.cli.report import Stopwatch, peak_memory
from delone.cli.show import spinner
from delone.cli.surfaces import print_figures
from delone.io import PointSet, read_points
from delone.io.las_classes import write_classes
from delone.terrain import ground

__all__ = ["find_ground"]

_SUFFIXES = (".las", ".laz")
# Classes of the ASPRS: other, ground, noise below, noise above.
_OTHER, _GROUND, _LOW, _HIGH = 1, 2, 7, 18


def find_ground(
    source: Annotated[
        Path, typer.Argument(metavar="INPUT", help="File of lidar points: .las .laz")
    ],
    *,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="OUTPUT", help="File to write: .las .laz"),
    ] = None,
    cell: Annotated[
        float | None,
        typer.Option(help="Width of cells, larger than any building; 20 m by default."),
    ] = None,
    angle: Annotated[float, typer.Option(help="Largest angle at the corners, in degrees.")] = 6.0,
    distance: Annotated[
        float | None, typer.Option(help="Largest distance from the triangle; 1.4 m by default.")
    ] = None,
    no_mirror: Annotated[
        bool, typer.Option("--no-mirror", help="Do not test mirror images of points.")
    ] = False,
    edge: Annotated[
        float | None,
        typer.Option(
            help="Do not insert points into triangles with shorter edges; 1 m by default."
        ),
    ] = None,
    thickness: Annotated[
        float | None, typer.Option(help="Noise in the heights of the ground; 0.1 m by default.")
    ] = None,
    low: Annotated[
        float | None, typer.Option(help="Gap above low outliers; 1 m by default.")
    ] = None,
    max_iter: Annotated[int, typer.Option(help="Maximum number of passes.")] = 50,
    crs: Crs = None,
    planar: Planar = False,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Find the ground among lidar points, and write their classes.

    Ground points get class 2, and outliers below the ground get class 7. Other points that had
    class 2 get class 1, and all others keep their class. Points of the noise classes 7 and 18, and
    withheld points, are not changed.
    """
    require_known(crs)
    for path in (source, *([] if output is None else [output])):
        if path.suffix.lower() not in _SUFFIXES:
            raise Failure(f"{path}: lidar files are {' '.join(_SUFFIXES)}", Exit.USAGE)
    if output is not None:
        with writing():
            protect_inputs([output], source)
            check_target(output)
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            survey = read_points(source, attributes=["classification", "withheld"])
        survey = referenced(survey, crs, planar=planar, quiet=quiet)
        classes = np.array(survey.attributes["classification"], dtype=np.uint8)
        used = ~(np.isin(classes, (_LOW, _HIGH)) | np.array(survey.attributes["withheld"], bool))
        say(f"looking for the ground among {np.count_nonzero(used):,} points")
        with watch.stage("ground"), noting(quiet=quiet):
            found = ground(
                _part(survey, used),
                cell=cell,
                angle=angle,
                distance=distance,
                mirror=not no_mirror,
                edge=edge,
                thickness=thickness,
                low=low,
                max_iter=max_iter,
                planar=True,
                workers=workers,
            )
        before = classes[used] == _GROUND
        own = np.where(before, _OTHER, classes[used])
        own[found.mask], own[found.outliers] = _GROUND, _LOW
        classes[used] = own
        if output is not None:
            say(f"writing {output.name}")
            packed = output.suffix.lower() == ".laz"
            with writing(), watch.stage(f"write {output.name}"), replacing(output) as temporary:
                write_classes(source, temporary, classes, packed=packed)
    figures: dict[str, Any] = {
        "delone": __version__,
        "input": str(source),
        "crs": survey.crs,
        "points": len(survey),
        "points_left_alone": int(np.count_nonzero(~used)) or None,
        "ground": int(np.count_nonzero(found.mask)),
        "low_outliers": int(np.count_nonzero(found.outliers)),
        "seeds": found.seeds,
        "passes": len(found.added),
        "converged": str(found.converged).lower(),
    }
    if before.any():
        other = found.compare(before)
        figures |= {
            "kappa_with_the_classes_of_the_input": other.kappa,
            "type_1_error": other.type_1,
            "type_2_error": other.type_2,
        }
    figures |= {
        "outputs": [] if output is None else [str(output)],
        "output_bytes": 0 if output is None else output.stat().st_size,
        "peak_memory_bytes": peak_memory(),
        "stages": watch.rows(len(survey)),
    }
    print_figures(source, figures, as_json=as_json, quiet=quiet)


def _part(survey: PointSet, rows: Any) -> PointSet:
    """Return some of the points, with their reference system."""
    z = None if survey.z is None else survey.z[rows]
    return replace(survey, points=survey.points[rows], z=z, attributes={})
