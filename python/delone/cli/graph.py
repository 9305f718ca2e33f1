"""The command ``graph``: which points of a file are neighbors, as lines."""

from __future__ import annotations

from contextlib import ExitStack
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np
import typer

from delone import __version__, graphs
from delone._base.atomic import check_target, replacing
from delone._base.counting import counted
from delone._base.extras import require
from delone.cli.exits import Exit, Failure, protect_inputs, reading, require_suffix, writing
from delone.cli.notes import note
from delone.cli.options import (
    Classes,
    Flat,
    Json,
    Layer,
    PointsInput,
    Quiet,
    Solid,
    SolidColumns,
    Workers,
    outputs,
    require_own,
    space_or_plane,
)
from delone.cli.referenced import Crs, Planar, require_known
from delone.cli.report import Stopwatch, finite_or_none
from delone.cli.rows import ROW_SUFFIXES, carried, read_rows, ready_rows, renaming, write_rows
from delone.cli.show import show_figures, spinner
from delone.cli.solid import is_space
from delone.cli.tables import TABLE_SUFFIXES, write_table

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone.cli.show import Row
    from delone.graphs import Graph
    from delone.io import PointSet

__all__ = ["graph"]

_SUFFIXES = (*TABLE_SUFFIXES, ".csv", ".npz")


class Rows(NamedTuple):
    """The points with the columns of the input, the columns that were renamed, and the rows."""

    survey: PointSet
    columns: dict[str, NDArray[Any]]
    renamed: dict[str, str]
    own: dict[str, NDArray[Any]]

    def write(self, path: Path) -> None:
        """Write the points as the layer ``nodes``."""
        write_rows(path, self.survey, self.columns, self.own, layer="nodes")


class Kind(StrEnum):
    """The graphs."""

    DELAUNAY = "delaunay"
    GABRIEL = "gabriel"
    RELATIVE = "relative-neighborhood"
    URQUHART = "urquhart"
    BETA = "beta"
    TREE = "spanning-tree"
    NEAREST = "nearest"
    INFLUENCE = "influence"


class Boundary(StrEnum):
    """Whether points on the outline of a region belong to it."""

    CLOSED = "closed"
    OPEN = "open"


class Region(StrEnum):
    """The regions of beta skeletons."""

    LUNE = "lune"
    CIRCLE = "circle"


# The kinds that each option belongs to.
_OWN = {
    "--boundary": (Kind.GABRIEL, Kind.BETA, Kind.INFLUENCE),
    "--beta": (Kind.BETA,),
    "--region": (Kind.BETA,),
    "-k": (Kind.NEAREST,),
}


def graph(
    source: PointsInput,
    *,
    kind: Annotated[Kind, typer.Option(help="The graph.")] = Kind.DELAUNAY,
    output: Annotated[list[Path] | None, outputs("File of edges", _SUFFIXES)] = None,
    nodes: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FILE",
            help="File to write (can be repeated): the points with all columns and their rows, to "
            "which v0 and v1 of edges refer: " + " ".join(ROW_SUFFIXES),
        ),
    ] = None,
    boundary: Annotated[
        Boundary | None,
        typer.Option(
            help="gabriel, beta, influence: whether points on the outline of a region belong to "
            "it; closed by default."
        ),
    ] = None,
    beta: Annotated[float | None, typer.Option(help="beta: the parameter, from 1 to 2.")] = None,
    region: Annotated[
        Region | None, typer.Option(help="beta: the region; lune by default.")
    ] = None,
    k: Annotated[int | None, typer.Option("-k", help="nearest: the number of neighbors.")] = None,
    max_length: Annotated[float | None, typer.Option(help="Remove edges longer than this.")] = None,
    percentile: Annotated[
        float | None,
        typer.Option(help="Remove edges longer than this percentile of the lengths, up to 100."),
    ] = None,
    classes: Classes = None,
    columns: SolidColumns = None,
    layer: Layer = None,
    in_space: Solid = False,
    in_plane: Flat = False,
    crs: Crs = None,
    planar: Planar = False,
    workers: Workers = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Compute a graph of neighbors, such as a spanning tree, and write its edges as lines.

    Points that have columns are written as well: to a second layer of a GeoPackage, or by --nodes.
    """
    given = {"--boundary": boundary, "--beta": beta, "--region": region, "-k": k}
    _require_own(kind, given)
    if max_length is not None and percentile is not None:
        raise Failure("--max-length and --percentile: give one of them", Exit.USAGE)
    space = space_or_plane(in_space, in_plane)
    require_known(crs)
    with writing():
        protect_inputs([*(output or ()), *(nodes or ())], source)
        for path in output or ():
            _ready(path)
        for path in nodes or ():
            ready_rows(path, "nodes")
        if len({*(output or ()), *(nodes or ())}) < len(output or ()) + len(nodes or ()):
            raise Failure("--output and --nodes: give each file once", Exit.USAGE)
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            which = {"columns": columns, "classes": classes, "layer": layer}
            survey = read_rows(source, which, crs, planar=planar, quiet=quiet)
        say(f"computing the graph of {len(survey):,} points")
        points = survey.points
        if is_space(source, space, survey) and survey.z is not None:
            points = np.column_stack((survey.points, survey.z))
        with watch.stage("graph"):
            found = _MAKE[kind](points, _options(given, workers))
            if max_length is not None or percentile is not None:
                found = found.prune(max_length=max_length, percentile=percentile)
        own = {"row": np.arange(len(survey))}
        table = Rows(survey, *carried(survey, list(own)), own)
        _tell(table, output or [], nodes or [], quiet=quiet)
        with writing(), ExitStack() as stack:
            for path in (*(output or ()), *(nodes or ())):
                say(f"writing {path.name}")
                with watch.stage(f"write {path.name}"):
                    target = stack.enter_context(replacing(path))
                    if path in (nodes or ()):
                        table.write(target)
                    else:
                        _write_one(found, table, target)
    figures: dict[str, Any] = {
        "delone": __version__,
        "input": str(source),
        "crs": survey.crs,
        "kind": found.kind,
        "points": found.npoints,
        "duplicates": len(found.duplicates),
        "edges": found.nedges,
        "components": found.ncomponents,
        "isolated": int((found.degrees == 0).sum()) - len(found.duplicates),
        "length": finite_or_none(float(found.lengths.sum())),
        "longest": finite_or_none(float(found.lengths.max(initial=0.0))),
        "columns": list(table.columns),
        "renamed": table.renamed,
        **watch.ending((*(output or ()), *(nodes or ())), found.npoints),
    }
    show_figures(str(source), figures, _rows, as_json=as_json, quiet=quiet)


# For each kind: the function, with the options that it accepts.
_MAKE: dict[Kind, Callable[[Any, dict[str, Any]], Graph]] = {
    Kind.DELAUNAY: lambda points, options: graphs.delaunay_graph(points, **options),
    Kind.GABRIEL: lambda points, options: graphs.gabriel(points, **options),
    Kind.RELATIVE: lambda points, options: graphs.relative_neighborhood(points, **options),
    Kind.URQUHART: lambda points, options: graphs.urquhart(points, **options),
    Kind.BETA: lambda points, options: graphs.beta_skeleton(points, **options),
    Kind.TREE: lambda points, options: graphs.minimum_spanning_tree(points, **options),
    Kind.NEAREST: lambda points, options: graphs.nearest_neighbors(points, **options),
    Kind.INFLUENCE: lambda points, options: graphs.sphere_of_influence(points, **options),
}


def _require_own(kind: Kind, given: dict[str, Any]) -> None:
    """Reject options of other kinds, and require those without a default."""
    require_own("--kind", kind, given, _OWN)
    if kind is Kind.BETA and given["--beta"] is None:
        raise Failure("--kind beta needs --beta, a number from 1 to 2", Exit.USAGE)
    if kind is Kind.NEAREST and given["-k"] is None:
        raise Failure("--kind nearest needs -k, the number of neighbors", Exit.USAGE)


def _options(given: dict[str, Any], workers: int | None) -> dict[str, Any]:
    """The arguments of a function of `graphs`."""
    names = {"--boundary": "boundary", "--beta": "beta", "--region": "kind", "-k": "k"}
    options = {names[name]: value for name, value in given.items() if value is not None}
    plain = {name: str(x) if isinstance(x, StrEnum) else x for name, x in options.items()}
    # Notes about degrees have already been printed.
    return plain | {"workers": workers, "planar": True}


def _ready(path: Path) -> None:
    """Check that a file can be written before any work is done."""
    suffix = path.suffix.lower()
    require_suffix(path, _SUFFIXES, "edges")
    if suffix not in (".csv", ".npz"):
        require("geopandas", extra="geo", what="writing edges")
    if suffix == ".parquet":
        require("pyarrow.parquet", extra="geo", what="writing Parquet files")
    check_target(path)


def _tell(table: Rows, output: list[Path], nodes: list[Path], *, quiet: bool) -> None:
    """Print notes: which columns were renamed, and which are not written to any file."""
    with_nodes = [path for path in output if path.suffix.lower() == ".gpkg"]
    if table.columns and (nodes or with_nodes):
        note(renaming(table.renamed), quiet=quiet)
    elif table.columns and output:
        what = counted(len(table.columns), "further column")
        note(
            f"{table.survey.source} has {what}, which edges do not have: v0 and v1 are its rows, "
            f"and --nodes FILE writes the points with all columns",
            quiet=quiet,
        )


def _write_one(found: Graph, table: Rows, path: Path) -> None:
    """Write edges in place; the suffix determines the format."""
    suffix = path.suffix.lower()
    if suffix == ".npz":
        found.save(path)
    elif suffix == ".csv":
        with path.open("w", encoding="utf-8", newline="\n") as file:
            file.write("v0,v1,length\n")
            rows = zip(*found.edges.T.tolist(), found.lengths.tolist(), strict=True)
            file.writelines(f"{a},{b},{length!r}\n" for a, b, length in rows)
    else:
        write_table(found.to_geopandas(crs=table.survey.crs), path, layer="edges")
        if suffix == ".gpkg" and table.columns:
            table.write(path)


def _rows(figures: dict[str, Any]) -> list[Row]:
    names = ("points", "duplicates", "edges", "components", "isolated")
    rows = [("graph", figures["kind"])]
    rows += [(name, f"{figures[name]:,}") for name in names]
    for name, title in (("length", "total length"), ("longest", "longest edge")):
        value = figures[name]
        rows.append((title, "beyond range" if value is None else f"{value:.10g}"))
    return rows
