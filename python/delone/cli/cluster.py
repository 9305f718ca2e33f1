"""The command ``cluster``: which points of a file are close together, as labels."""

from __future__ import annotations

from contextlib import ExitStack
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np
import typer

from delone import __version__, cluster
from delone._base.atomic import replacing
from delone.cli.exits import Exit, Failure, protect_inputs, reading, writing
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
from delone.cli.report import Stopwatch
from delone.cli.rows import ROW_SUFFIXES, carried, read_rows, ready_rows, renaming, write_rows
from delone.cli.show import show_figures, spinner
from delone.cli.solid import is_space

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.cli.show import Row

__all__ = ["cluster_points"]


class Method(StrEnum):
    """The methods."""

    HDBSCAN = "hdbscan"
    DBSCAN = "dbscan"
    SINGLE = "single-linkage"


class Selection(StrEnum):
    """How HDBSCAN selects clusters."""

    EOM = "eom"
    LEAF = "leaf"


class Labels(NamedTuple):
    """The label and the other results of each point."""

    labels: NDArray[np.int32]
    others: dict[str, NDArray[Any]]


# The methods that each option belongs to.
_OWN = {
    "--min-cluster-size": (Method.HDBSCAN,),
    "--min-samples": (Method.HDBSCAN, Method.DBSCAN),
    "--selection": (Method.HDBSCAN,),
    "--epsilon": (Method.HDBSCAN,),
    "--single-cluster": (Method.HDBSCAN,),
    "--eps": (Method.DBSCAN,),
    "--height": (Method.SINGLE,),
    "--n-clusters": (Method.SINGLE,),
}
# The arguments that options set, where their names differ.
_NAMES = {
    "--selection": "cluster_selection_method",
    "--epsilon": "cluster_selection_epsilon",
    "--single-cluster": "allow_single_cluster",
}


def cluster_points(
    source: PointsInput,
    *,
    method: Annotated[Method, typer.Option(help="The method.")] = Method.HDBSCAN,
    output: Annotated[
        list[Path] | None, outputs("File of points with labels", ROW_SUFFIXES)
    ] = None,
    min_cluster_size: Annotated[
        int | None, typer.Option(help="hdbscan: smallest size of a cluster; 5 by default.")
    ] = None,
    min_samples: Annotated[
        int | None,
        typer.Option(
            help="hdbscan, dbscan: number of points nearby, including the point itself, that "
            "makes a point dense; by default the value of --min-cluster-size, or 5."
        ),
    ] = None,
    selection: Annotated[
        Selection | None,
        typer.Option(
            help="hdbscan: eom for the most stable clusters, leaf for the smallest; eom by default."
        ),
    ] = None,
    epsilon: Annotated[
        float | None, typer.Option(help="hdbscan: do not split clusters at distances below this.")
    ] = None,
    single_cluster: Annotated[
        bool | None,
        typer.Option("--single-cluster", help="hdbscan: all points may form one cluster."),
    ] = None,
    eps: Annotated[
        float | None, typer.Option(help="dbscan: the maximum distance between neighbors.")
    ] = None,
    height: Annotated[
        float | None, typer.Option(help="single-linkage: the longest edge within a cluster.")
    ] = None,
    n_clusters: Annotated[
        int | None, typer.Option(help="single-linkage: the number of clusters.")
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
    """Find clusters of points, and write the points with their labels; noise is -1.

    The output has all columns of the input.
    """
    given = {
        "--min-cluster-size": min_cluster_size,
        "--min-samples": min_samples,
        "--selection": selection,
        "--epsilon": epsilon,
        "--single-cluster": single_cluster,
        "--eps": eps,
        "--height": height,
        "--n-clusters": n_clusters,
    }
    _require_own(method, given)
    space = space_or_plane(in_space, in_plane)
    require_known(crs)
    with writing():
        protect_inputs(output or (), source)
        for path in output or ():
            ready_rows(path, "labels")
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(quiet=quiet), watch.stage("read"):
            which = {"columns": columns, "classes": classes, "layer": layer}
            survey = read_rows(source, which, crs, planar=planar, quiet=quiet)
        say(f"clustering {len(survey):,} points")
        points = survey.points
        if is_space(source, space, survey) and survey.z is not None:
            points = np.column_stack((survey.points, survey.z))
        with watch.stage("cluster"):
            found = _found(method, points, _options(given, workers))
        own = {"label": found.labels, **found.others}
        others, renamed = carried(survey, list(own))
        if output:
            note(renaming(renamed), quiet=quiet)
        with writing(), ExitStack() as stack:
            for path in output or ():
                say(f"writing {path.name}")
                with watch.stage(f"write {path.name}"):
                    target = stack.enter_context(replacing(path))
                    write_rows(target, survey, others, own, layer="labels")
    sizes = np.bincount(found.labels[found.labels >= 0])
    figures: dict[str, Any] = {
        "delone": __version__,
        "input": str(source),
        "crs": survey.crs,
        "method": str(method),
        "points": len(points),
        "clusters": len(sizes),
        "noise": int((found.labels < 0).sum()),
        "largest": int(sizes.max(initial=0)),
        "smallest": int(sizes.min()) if len(sizes) else 0,
        "columns": list(others),
        "renamed": renamed,
        **watch.ending(output, len(points)),
    }
    show_figures(str(source), figures, _rows, as_json=as_json, quiet=quiet)


def _require_own(method: Method, given: dict[str, Any]) -> None:
    """Reject options of other methods, and require those without a default."""
    require_own("--method", method, given, _OWN)
    if method is Method.DBSCAN and given["--eps"] is None:
        raise Failure("--method dbscan needs --eps, the distance between neighbors", Exit.USAGE)
    if method is Method.SINGLE and (given["--height"] is None) == (given["--n-clusters"] is None):
        needs = "needs --height or --n-clusters, and not both"
        raise Failure(f"--method single-linkage {needs}", Exit.USAGE)


def _options(given: dict[str, Any], workers: int | None) -> dict[str, Any]:
    """The arguments of a method of `cluster`."""
    options: dict[str, Any] = {"workers": workers, "planar": True}
    for name, value in given.items():
        if value is not None:
            argument = _NAMES.get(name, name.removeprefix("--").replace("-", "_"))
            options[argument] = str(value) if isinstance(value, StrEnum) else value
    return options


def _found(method: Method, points: NDArray[np.float64], options: dict[str, Any]) -> Labels:
    """Labels by a method. Notes about degrees have already been printed."""
    if method is Method.HDBSCAN:
        model = cluster.HDBSCAN(**options).fit(points)
        return Labels(model.labels_, {"probability": model.probabilities_})
    if method is Method.DBSCAN:
        dense = cluster.DBSCAN(**options).fit(points)
        is_core = np.zeros(len(points), dtype=bool)
        is_core[dense.core_sample_indices_] = True
        return Labels(dense.labels_, {"core": is_core})
    own = {name: options.pop(name) for name in ("height", "n_clusters") if name in options}
    merges = cluster.single_linkage(points, **options)
    return Labels(merges.labels(**own), {})


def _rows(figures: dict[str, Any]) -> list[Row]:
    names = {
        "points": "points",
        "clusters": "clusters",
        "noise": "noise",
        "largest": "largest cluster",
        "smallest": "smallest cluster",
    }
    rows = [("method", figures["method"])]
    rows += [(title, f"{figures[name]:,}") for name, title in names.items()]
    return rows
