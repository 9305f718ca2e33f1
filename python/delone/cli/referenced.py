"""Reference systems on the command line, and notes on coordinates in degrees."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from delone._base.georeference import (
    beyond_degrees,
    degrees_in,
    is_known,
    may_be_degrees,
    message_of_degrees,
    same_crs,
)
from delone.cli.exits import Exit, Failure
from delone.cli.notes import note
from delone.io import GeometrySet, PointSet, SurfaceFile
from delone.io.referencing import left_out

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Crs", "Planar", "note_degrees", "referenced", "require_known"]

Crs = Annotated[
    str | None,
    typer.Option(
        help="The reference system of the input, such as EPSG:28992, if the file has none or a "
        "wrong one; nothing is transformed."
    ),
]
Planar = Annotated[
    bool,
    typer.Option("--planar", help="Treat longitudes and latitudes as planar, without a note."),
]

Survey = TypeVar("Survey", bound=PointSet | GeometrySet | SurfaceFile)


def require_known(crs: str | None) -> None:
    """Reject a --crs that pyproj does not recognize, before any work is done."""
    if crs is not None and not is_known(crs):
        raise Failure(f"--crs {crs}: not a reference system known to pyproj", Exit.USAGE)


def referenced(
    survey: Survey,
    crs: str | None,
    *,
    planar: bool,
    quiet: bool,
    outputs: Iterable[Path] = (),
    known: Sequence[str] = (),
) -> Survey:
    """Set the reference system of a survey to that of --crs, if given, and print notes.

    `known` has the suffixes of the formats that can store one.
    """
    if crs is not None:
        if survey.crs is not None and not same_crs(survey.crs, crs):
            note(
                f"{survey.source} says {survey.crs.partition(chr(10))[0]:.60}, but --crs {crs} "
                "is used; coordinates are unchanged",
                quiet=quiet,
            )
        for path in outputs:
            note(left_out(path, crs, known), quiet=quiet)
        survey = replace(survey, crs=crs)
    by = degrees_in(survey)
    if by is not None and (crs is not None or not planar):
        found = survey.all_points() if isinstance(survey, GeometrySet) else survey
        if crs is not None:
            _refuse_beyond_poles(survey.source, crs, found.points)
        note_degrees(survey.source, None if planar else by, found.points, quiet=quiet)
    return survey


def _refuse_beyond_poles(source: str, crs: str, coordinates: NDArray[np.float64]) -> None:
    """Reject a --crs in degrees for coordinates that are not; files may declare one by mistake."""
    if may_be_degrees(coordinates):
        return
    x, y = coordinates[beyond_degrees(coordinates)][0].tolist()
    raise Failure(
        f"--crs {crs} is for degrees, longitudes first, and {source} contains ({x:.10g}, {y:.10g})",
        Exit.DEGENERATE,
    )


def note_degrees(
    source: str, by: str | None, coordinates: NDArray[np.float64], *, quiet: bool
) -> None:
    """Print a note that coordinates, (n, 2), are longitudes and latitudes, unless `by` is None."""
    if by is not None and may_be_degrees(coordinates):
        note(message_of_degrees(f"{source}: coordinates", by), quiet=quiet)
