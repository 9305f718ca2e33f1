"""What the command line says of reference systems, and what it says of degrees."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from delone.cli.exits import Exit, Failure
from delone.georeference import degrees_in, is_known, may_be_degrees, message_of_degrees, same_crs
from delone.io import GeometrySet, PointSet
from delone.io.referencing import left_out

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Crs", "Planar", "note", "note_degrees", "referenced", "require_known"]

Crs = Annotated[
    str | None,
    typer.Option(
        help="The reference system of the input, as EPSG:28992, where the file has none or a wrong "
        "one; nothing is transformed."
    ),
]
Planar = Annotated[
    bool,
    typer.Option(
        "--planar", help="Longitudes and latitudes are meant as coordinates of a plane: no note."
    ),
]

Survey = TypeVar("Survey", bound=PointSet | GeometrySet)


def require_known(crs: str | None) -> None:
    """Refuse a reference system that nobody knows, before any work is spent.

    Parameters
    ----------
    crs : str or None
        What --crs says.

    Raises
    ------
    Failure
        pyproj does not know it.
    """
    if crs is not None and not is_known(crs):
        raise Failure(f"--crs {crs}: no reference system that pyproj knows", Exit.USAGE)


def referenced(
    survey: Survey,
    crs: str | None,
    *,
    planar: bool,
    quiet: bool,
    outputs: Iterable[Path] = (),
    known: Sequence[str] = (),
) -> Survey:
    """Give a survey the system of the command line, and say what is to be said.

    Parameters
    ----------
    survey : PointSet or GeometrySet
        What was read.
    crs : str or None
        What --crs says.
    planar : bool
        Whether --planar is given.
    quiet : bool
        Whether nothing is to be said.
    outputs : iterable of Path, optional
        Files to be written.
    known : sequence of str, optional
        The suffixes of files that have a reference system.

    Returns
    -------
    PointSet or GeometrySet
        With the reference system.
    """
    if crs is not None:
        if survey.crs is not None and not same_crs(survey.crs, crs):
            note(
                f"{survey.source} says {survey.crs.partition(chr(10))[0]:.60}, --crs {crs} counts; "
                "coordinates stay as they are",
                quiet=quiet,
            )
        for path in outputs:
            note(left_out(path, crs, known), quiet=quiet)
        survey = replace(survey, crs=crs)
    by = degrees_in(survey)
    if by is not None and not planar:
        found = survey.coordinates() if isinstance(survey, GeometrySet) else survey
        note_degrees(survey.source, by, found.points, quiet=quiet)
    return survey


def note_degrees(
    source: str, by: str | None, coordinates: NDArray[np.float64], *, quiet: bool
) -> None:
    """Say that coordinates are longitudes and latitudes.

    Parameters
    ----------
    source : str
        The file.
    by : str or None
        By what they are known; None for nothing to say.
    coordinates : ndarray of float64, shape (n, 2)
        The coordinates.
    quiet : bool
        Whether nothing is to be said.
    """
    if by is not None and may_be_degrees(coordinates):
        sentence = message_of_degrees(f"{source}: coordinates", by)
        note(sentence.replace("planar=True", "--planar"), quiet=quiet)


def note(message: str | None, *, quiet: bool = False) -> None:
    """Print a line on standard error that is no error.

    Parameters
    ----------
    message : str or None
        The line; None for nothing.
    quiet : bool, optional
        Whether nothing is to be said.
    """
    if message is not None and not quiet:
        print(f"delone: note: {' '.join(message.split())}", file=sys.stderr)
