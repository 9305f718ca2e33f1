"""The rows of a file of points with all their columns, as commands write them back.

Columns that a command adds keep their names. A column of the file with the same name, or one that
the format reserves, is written as ``input_`` and its name, and a note says so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.atomic import check_target
from delone._base.counting import counted
from delone._base.extras import require
from delone.cli.exits import require_suffix
from delone.cli.options import class_numbers, split
from delone.cli.referenced import referenced
from delone.cli.tables import TABLE_SUFFIXES, ready_table, write_table
from delone.io import read_points

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone.io import PointSet

__all__ = ["ROW_SUFFIXES", "carried", "read_rows", "ready_rows", "renaming", "write_rows"]

ROW_SUFFIXES = (*TABLE_SUFFIXES, ".csv")
# Columns that GeoPackage or GeoPandas reserve.
_OF_TABLES = ("fid", "geom", "geometry")


def read_rows(
    source: Path, which: Mapping[str, str | None], crs: str | None, *, planar: bool, quiet: bool
) -> PointSet:
    """Read points with all their columns, according to the options of a command.

    `which` contains the options ``columns``, ``classes`` and ``layer``.
    """
    survey = read_points(
        source,
        attributes="all",
        columns=split(which["columns"]),
        classes=class_numbers(which["classes"]),
        layer=which["layer"],
    )
    return referenced(survey, crs, planar=planar, quiet=quiet)


def ready_rows(path: Path, what: str) -> None:
    """Check that rows of `what` can be written to a file before any work is done."""
    require_suffix(path, ROW_SUFFIXES, what)
    if path.suffix.lower() == ".csv":
        check_target(path)
    else:
        ready_table(path, what)


def carried(survey: PointSet, own: Sequence[str]) -> tuple[dict[str, NDArray[Any]], dict[str, str]]:
    """Return the columns of a survey to be written in addition to `own`, and which were renamed.

    Values with several numbers in each row, such as normals, become several columns.
    """
    flat: dict[str, NDArray[Any]] = {}
    for name, values in survey.attributes.items():
        if values.ndim == 1:
            flat[name] = values
        else:
            parts = values.reshape(len(values), -1).T
            flat |= {_free(f"{name}_{i}", flat): part for i, part in enumerate(parts)}
    # SQLite ignores case.
    kept = {name.casefold() for name in (*own, *_coordinates(survey), *_OF_TABLES)}
    found: dict[str, NDArray[Any]] = {}
    renamed = {}
    for name, values in flat.items():
        new = name
        if name.casefold() in kept:
            new = _free(f"input_{name}", [*flat, *found])
            renamed[name] = new
        elif name.casefold() in {other.casefold() for other in found}:
            new = _free(f"{name}_2", [*flat, *found])
            renamed[name] = new
        found[new] = values
    return found, renamed


def renaming(renamed: Mapping[str, str]) -> str | None:
    """Return the note about renamed columns, if there are any."""
    if not renamed:
        return None
    pairs = ", ".join(f"{old!r:.60} as {new!r:.70}" for old, new in renamed.items())
    what = counted(len(renamed), "column")
    return f"{what} of the input would have the name of another column; written: {pairs}"


def _free(name: str, taken: Sequence[str] | Mapping[str, Any]) -> str:
    """Return a name that is not taken, ignoring case."""
    used = {other.casefold() for other in taken}
    while name.casefold() in used:  # terminates: the name grows, and finitely many names are taken
        name += "_"
    return name


def _coordinates(survey: PointSet) -> list[str]:
    """The names of the coordinate columns in a table: those in the file, if it has names."""
    names = list("xy" if survey.z is None else "xyz")
    called = list(survey.columns)
    if len(called) == len(names) and len({name.casefold() for name in called}) == len(names):
        return called
    return names


def write_rows(
    path: Path,
    survey: PointSet,
    columns: Mapping[str, NDArray[Any]],
    own: Mapping[str, NDArray[Any]],
    *,
    layer: str,
) -> None:
    """Write points with columns of the input and of the command; the suffix is the format."""
    places = [*survey.points.T] if survey.z is None else [*survey.points.T, survey.z]
    if path.suffix.lower() != ".csv":
        geopandas = require("geopandas", extra="geo", what=f"writing {layer}")
        shapes = geopandas.points_from_xy(*places)
        table = geopandas.GeoDataFrame({**columns, **own}, geometry=shapes, crs=survey.crs)
        write_table(table, path, layer=layer)
        return
    values_of = {name: _plain(values) for name, values in {**columns, **own}.items()}
    names = [_quoted(name) for name in (*_coordinates(survey), *values_of)]
    lists = [*(place.tolist() for place in places), *values_of.values()]
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write(",".join(names) + "\n")
        file.writelines(",".join(map(_field, row)) + "\n" for row in zip(*lists, strict=True))


def _plain(values: NDArray[Any]) -> list[Any]:
    """Return values as Python numbers and text; booleans become 0 and 1, and times ISO strings."""
    if values.dtype.kind == "M":
        return list(np.datetime_as_string(values).tolist())
    found: list[Any] = (values * 1 if values.dtype.kind == "b" else values).tolist()
    return found


def _field(value: Any) -> str:
    """Write a value so that reading returns the same: numbers with all digits, text in quotes."""
    if isinstance(value, int | float):
        return repr(value)
    if value is None:
        return ""
    return _quoted(str(value))


def _quoted(word: str) -> str:
    if any(mark in word for mark in ',"\r\n') or word != word.strip():
        return '"' + word.replace('"', '""') + '"'
    return word
