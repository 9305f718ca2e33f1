"""Options shared by several commands, and the parsing of their lists."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from delone.cli.exits import Exit, Failure
from delone.io import input_suffixes, output_suffixes

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

__all__ = [
    "Chord",
    "Classes",
    "Columns",
    "Flat",
    "Input",
    "Json",
    "Layer",
    "MeshOutput",
    "Order",
    "PlaneColumns",
    "PointsInput",
    "Quiet",
    "Solid",
    "SolidColumns",
    "Workers",
    "class_numbers",
    "outputs",
    "require_files",
    "require_own",
    "space_or_plane",
    "split",
]


def outputs(what: str, suffixes: Iterable[str]) -> Any:
    """Return the option --output for a command that writes files of one kind."""
    text = f"{what} (can be repeated): " + " ".join(suffixes)
    return typer.Option("--output", "-o", metavar="OUTPUT", help=text)


PointsInput = Annotated[
    Path, typer.Argument(metavar="INPUT", help="File of points: " + " ".join(input_suffixes()))
]
Input = Annotated[
    Path,
    typer.Argument(
        metavar="INPUT",
        help="File of points, lines or polygons: " + " ".join(input_suffixes()),
    ),
]
Chord = Annotated[
    float | None,
    typer.Option(
        help="DXF, LandXML alignments: maximum distance of chords from arcs and other curves."
    ),
]
Columns = Annotated[
    str | None,
    typer.Option(
        help="Columns of x, y and z, by name or by number from 0: lon,lat,depth or 0,1,2."
    ),
]
SolidColumns = Annotated[
    str | None, typer.Option(help="Columns of x, y and z, by name or by number from 0.")
]
PlaneColumns = Annotated[
    str | None, typer.Option(help="Columns of x and y, by name or by number from 0.")
]
Classes = Annotated[
    str | None,
    typer.Option(help="Keep only points of these classes (LAS, LAZ, EPT), such as 2 or 2,6."),
]
Layer = Annotated[str | None, typer.Option(help="Layer, if the file has several.")]
MeshOutput = Annotated[list[Path] | None, outputs("File to write", output_suffixes())]
Order = Annotated[
    int, typer.Option(help="Order of the elements in files: 1, or 2 with a node on each edge.")
]
Workers = Annotated[int | None, typer.Option(help="Threads; by default one per core.")]
# Two options, because a pair of switches would silently use the last one given.
Solid = Annotated[bool, typer.Option("--3d", help="Treat points as 3-D, with z as a coordinate.")]
Flat = Annotated[
    bool,
    typer.Option(
        "--2d",
        help="Treat points as 2-D. By default, PLY files that contain only points are 3-D point "
        "clouds.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print only errors.")]


def split(text: str | None) -> list[str] | None:
    """Return the parts between commas."""
    return None if text is None else [part.strip() for part in text.split(",")]


def numbers(text: str, option: str, kind: type = float) -> list[Any]:
    """Return the finite numbers between commas."""
    try:
        found = [kind(part) for part in text.split(",")]
    except ValueError:
        found = [math.nan]
    if not all(map(math.isfinite, found)):
        raise Failure(f"{option} takes numbers, got {text!r:.80}", Exit.USAGE)
    return found


def space_or_plane(solid: bool, flat: bool) -> bool | None:
    """Return the choice of --3d and --2d: True, False, or None for neither."""
    if solid and flat:
        raise Failure("--3d and --2d contradict each other: give one of them", Exit.USAGE)
    return solid or (False if flat else None)


def require_files(edges: bool, output: Sequence[Path] | None) -> None:
    """Reject --edges without a file to write them to."""
    if edges and not output:
        raise Failure("--edges is for the files of --output", Exit.USAGE)


def require_own(
    option: str, chosen: str, given: Mapping[str, Any], own: Mapping[str, Sequence[str]]
) -> None:
    """Reject options that are given although they belong to other choices of an option."""
    for name, value in given.items():
        if value is not None and chosen not in own[name]:
            raise Failure(
                f"{name} is for {option} {', '.join(own[name])}, not {chosen}", Exit.USAGE
            )


def class_numbers(text: str | None) -> list[int] | None:
    """Return the value of --classes."""
    try:
        return None if text is None else [int(part) for part in text.split(",")]
    except ValueError:
        raise Failure(
            f"--classes takes numbers such as 2 or 2,6; got {text!r:.80}", Exit.USAGE
        ) from None
