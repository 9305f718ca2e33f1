"""The command ``tile``: out-of-core triangulation."""

from __future__ import annotations

import contextlib
import logging
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from delone import __version__, distributed
from delone._base.extras import require
from delone._base.georeference import is_geographic
from delone.cli.exits import Exit, Failure, os_message, reading
from delone.cli.options import Classes, Json, Quiet, class_numbers, split
from delone.cli.referenced import Crs, Planar, note_degrees, require_known
from delone.cli.show import memory_text, print_json, print_rows
from delone.distributed.run.executors import Processes
from delone.errors import DeloneError, OutputError
from delone.io import input_suffixes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from delone.distributed import Plan, Progress, TiledDelaunay

__all__ = ["tile"]


def tile(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="INPUT...",
            help="Files, globs, folders of Parquet files: " + " ".join(input_suffixes()),
        ),
    ],
    *,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FOLDER",
            help="New folder, or the folder of an interrupted run to resume.",
        ),
    ] = None,
    tile_points: Annotated[int, typer.Option(help="Points per tile, on average.")] = 2_000_000,
    workers: Annotated[
        int, typer.Option(help="Processes on this machine; 1 means only this one, with all cores.")
    ] = 1,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler: tcp://host:8786.")
    ] = None,
    columns: Annotated[
        str | None, typer.Option(help="Columns of x, y and z, by name or by number from 0.")
    ] = None,
    classes: Classes = None,
    attributes: Annotated[
        str | None, typer.Option(help="Columns to keep at the vertices: intensity,gps_time.")
    ] = None,
    nan: Annotated[str, typer.Option(help="Rows with NaN or infinity: raise or drop.")] = "raise",
    resume: Annotated[
        bool, typer.Option(help="Resume an interrupted run of the same input.")
    ] = True,
    crs: Crs = None,
    planar: Planar = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Print the required resources, and do nothing else.")
    ] = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Triangulate more points than fit in memory, in tiles that form one triangulation."""
    options: dict[str, Any] = {
        "tile_points": tile_points,
        "columns": split(columns),
        "classes": class_numbers(classes),
        "attributes": split(attributes) or (),
    }
    require_known(crs)
    if workers < 1:
        raise Failure(f"--workers must be at least 1, got {workers}", Exit.USAGE)
    with reading(quiet=quiet):
        if dry_run:
            _print_plan(distributed.plan(sources, workers=workers, **options), as_json)
            return
    if output is None:
        raise Failure("give the output folder: --output", Exit.USAGE)
    start = time.perf_counter()
    with _executor(scheduler, workers) as executor, _live(quiet or as_json) as tell:
        try:
            tin = distributed.triangulate(
                sources,
                output,
                executor=executor,
                resume=resume,
                nan=nan,
                progress=tell,
                crs=crs,
                # A note below replaces the warning.
                planar=True,
                **options,
            )
        except OSError as error:
            raise _blamed(error, output) from error
        except DeloneError as error:
            # Workers or the scheduler disappeared, which is not a bug.
            if type(error) is DeloneError:
                raise Failure(str(error), Exit.OUTPUT) from error
            raise
    left, bottom, right, top = tin.bounds
    note_degrees(
        str(output),
        None if tin.crs is None or not is_geographic(tin.crs) else tin.crs,
        np.array([(left, bottom), (right, top)]),
        quiet=planar or quiet,
    )
    _report(tin, output, time.perf_counter() - start, as_json=as_json, quiet=quiet)


@contextlib.contextmanager
def _executor(scheduler: str | None, workers: int) -> Iterator[Any]:
    """The executor."""
    if scheduler is None:
        yield Processes(workers) if workers > 1 else "serial"
        return
    library = require("distributed", extra="dask", what="--scheduler")
    # Problems with the scheduler are reported in one line, not in a traceback.
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client = library.Client(scheduler, timeout=10)
    except (OSError, ValueError) as error:
        raise Failure(f"no Dask scheduler answers at {scheduler}", Exit.USAGE) from error
    with client:
        yield client


@contextlib.contextmanager
def _live(silent: bool) -> Iterator[Callable[[Progress], None] | None]:
    """Show the progress of a run on a terminal."""
    if silent or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console, Group
    from rich.live import Live
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    columns = (
        TextColumn("{task.description}"),
        BarColumn(bar_width=_BAR),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
    )
    bars, counters = Bars(*columns), Bars(TextColumn("{task.description}"))
    with Live(Group(bars, counters), console=Console(stderr=True), transient=True):
        task, line = bars.add_task("beginning", total=None), counters.add_task("")

        def tell(progress: Progress) -> None:
            description, more = _words(progress)
            bars.update(
                task,
                description=description,
                completed=progress.done,
                total=progress.total or None,
            )
            counters.update(line, description=more)

        yield tell


# With the longest stage, a million tasks and the time, no line is longer than 80 columns.
_BAR = 30
_STAGES = {
    "look": "scanning the input",
    "deal": "distributing points to tiles",
    "begin": "triangulating tiles",
    "answer": "answering",
    "proceed": "inserting",
    "finish": "writing tiles",
}


def _words(progress: Progress) -> tuple[str, str]:
    """Texts for progress: the stage, and tiles, rounds, foreign points, memory."""
    stage = progress.stage.partition("-")[0]
    said = _STAGES.get(stage, "beginning")
    if stage in ("answer", "proceed"):
        said += f", round {progress.turn}"
    parts = [f"{progress.ntiles:,} tiles"] if progress.ntiles else []
    if progress.open:
        parts.append(f"{progress.open:,} open")
    if progress.foreign:
        parts.append(f"{progress.foreign:,} foreign points")
    if progress.memory:
        parts.append(memory_text(progress.memory))
    return said, " · ".join(parts)


def _blamed(error: OSError, output: Path) -> BaseException:
    """Distinguish errors in the input from errors in the output, by the file."""
    if isinstance(error, OutputError):
        return Failure(os_message(error), Exit.OUTPUT)
    if isinstance(error, DeloneError):
        return error
    name = str(error.filename or "")
    inside = name.startswith((str(output), str(output.absolute())))
    return Failure(os_message(error), Exit.OUTPUT if inside else Exit.INPUT)


def _print_plan(plan: Plan, as_json: bool) -> None:
    if as_json:
        # By the same name as in the report of a run.
        figures = asdict(plan)
        print_json({"delone": __version__, "tiles": figures.pop("ntiles"), **figures})
        return
    rows = [
        ("points", f"{plan.points:,}"),
        ("tiles", f"{plan.ntiles:,}"),
        ("tasks", f"{plan.tasks:,}"),
        ("foreign points", f"{plan.foreign:,} per tile"),
        ("memory", f"{memory_text(plan.worker_memory)} per worker"),
        ("disk", f"{memory_text(plan.disk)} while it runs, {memory_text(plan.output)} after"),
        ("time", f"{plan.seconds:,.0f} s, plus decompression"),
    ]
    print_rows("required", rows)


def _report(
    tin: TiledDelaunay, output: Path, seconds: float, *, as_json: bool, quiet: bool
) -> None:
    names = ("points", "dropped", "duplicates", "triangles", "rounds", "given", "memory", "crs")
    figures = {name: tin.manifest[name] for name in names}
    if as_json:
        print_json(
            {"delone": __version__, "output": str(output), "tiles": tin.ntiles, **figures}
            | {"seconds": seconds}
        )
    elif not quiet:
        share = figures["given"] / max(figures["points"], 1)
        rows = [
            ("points", f"{figures['points']:,}"),
            ("duplicates", f"{figures['duplicates']:,}"),
            ("dropped", f"{figures['dropped']:,}"),
            ("triangles", f"{figures['triangles']:,}"),
            ("tiles", f"{tin.ntiles:,}"),
            ("rounds", f"{figures['rounds']:,}"),
            ("foreign points", f"{figures['given']:,}, {share:.3%}"),
            ("peak memory", f"{memory_text(figures['memory'])} per process"),
            ("seconds", f"{seconds:.1f}"),
            ("written", str(output)),
        ]
        print_rows("tiles", rows)
