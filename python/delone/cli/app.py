"""The command line as a whole, and the conversion of errors to one line and an exit code."""

from __future__ import annotations

import contextlib
import io
import os
import re
import signal
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from delone import __version__
from delone.cli.commands import Commands
from delone.cli.exits import MEANINGS, Exit, Failure, as_options, code_of, os_message
from delone import ConstrainedDelaunay, Delaunay, __version__
from delone.cli import cells, cluster, dem, field, graph, outline, terrain, tiles
from delone.cli.check import check_mesh
from delone.cli.constraints import Constraints, constraint_figures, read_input, triangulated
from delone.cli.exits import (
    MEANINGS,
    Exit,
    Failure,
    as_options,
    code_of,
    naming_lines,
    os_message,
    protect_inputs,
    reading,
    writing,
)
from delone.cli.exploring import explore
from delone.cli.faces import check_faces
from delone.cli.info import describe
from delone.cli.meshing import make_mesh
from delone.cli.options import (
    Classes,
    Flat,
    Json,
    Layer,
    MeshOutput,
    Quiet,
    Solid,
    Workers,
    class_numbers,
    space_or_plane,
    split,
)
from delone.cli.outputs import ready, write_all
from delone.cli.referenced import Crs, Planar, note, referenced, require_known
from delone.cli.report import Stopwatch, peak_memory, summary
from delone.cli.show import (
    print_json,
    print_report,
    print_rows,
    print_text,
    space_rows,
    spinner,
    triangulation_rows,
)
from delone.cli.solid import (
    improved,
    improvement_figures,
    improvement_rows,
    is_space,
    space_summary,
    triangulated_space,
)
from delone.counting import agreed
from delone.errors import MissingExtraError, NonFiniteError, OutputError

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["app", "run"]

# The mark \b preserves the line breaks of a paragraph.
_CODES = "\b\nExit codes:\n" + "\n".join(
    f"  {code.value:>3}  {text}" for code, text in MEANINGS.items()
)

app = typer.Typer(
    name="delone",
    cls=Commands,
    help="Exact, canonical and fast Delaunay triangulation of a file: points, lines, polygons.",
    epilog=_CODES,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def _version(wanted: bool) -> None:
    if wanted:
        print(f"delone {__version__}")
        raise typer.Exit


def _options(
    *,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Exact, canonical and fast Delaunay triangulation of a file."""


# Called, not used as a decorator: the function above remains a plain function.
def triangulate(
    source: Input,
    *,
    output: MeshOutput = None,
    classes: Classes = None,
    columns: Columns = None,
    layer: Layer = None,
    method: Annotated[
        str, typer.Option(help="Algorithm; the result does not depend on it.")
    ] = "auto",
    workers: Workers = None,
    edges: Annotated[
        bool, typer.Option("--edges", help="Write edges instead of triangles.")
    ] = False,
    crossing: Annotated[
        str | None,
        typer.Option(
            help="Where lines cross: split (add a vertex, the default) or raise (an error)."
        ),
    ] = None,
    outline: Annotated[
        bool,
        typer.Option(
            "--outline", help="Remove triangles outside polygons, or outside closed lines."
        ),
    ] = False,
    conforming: Annotated[
        bool,
        typer.Option("--conforming", help="Add vertices until all segments are Delaunay edges."),
    ] = False,
    max_points: Annotated[
        int | None, typer.Option(help="Maximum number of vertices added to lines and polygons.")
    ] = None,
    in_space: Solid = False,
    in_plane: Flat = False,
    better: Annotated[
        bool,
        typer.Option("--improve", help="3-D: remove slivers; points inside may move."),
    ] = False,
    min_angle: Annotated[
        float | None,
        typer.Option(
            metavar="DEGREES", help="Goal of --improve for dihedral angles; 20 by default."
        ),
    ] = None,
    crs: Crs = None,
    planar: Planar = False,
    max_iter: Annotated[
        int | None,
        typer.Option(
            min=0,
            metavar="N",
            help="Maximum number of passes of --improve over the tetrahedra; 30 by default.",
        ),
    ] = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Triangulate the points of a file, report, and write meshes and plots.

    Lines and the sides of polygons become edges of the triangulation. Heights are values at the
    points; with --3d they are the third coordinate, and tetrahedra are written to .vtu, .msh, .npz,
    .xdmf, .inp, .su2 and .png.
    """
    space = space_or_plane(in_space, in_plane)
    if min_angle is not None and not better:
        raise Failure("--min-angle is the goal of --improve: give --improve as well", Exit.USAGE)
    require_known(crs)
    if max_iter is not None and not better:
        raise Failure("--max-iter is the limit of --improve: give --improve as well", Exit.USAGE)
    with writing():
        protect_inputs(output or (), source)
        writers = {path: ready(path) for path in output or ()}
    watch = Stopwatch()
    with spinner(quiet or as_json) as say:
        say(f"reading {source.name}")
        with reading(), watch.stage("read"):
            survey = read_input(
                source, columns=split(columns), classes=class_numbers(classes), layer=layer
            )
        survey = referenced(
            survey, crs, planar=planar, quiet=quiet, outputs=writers, known=WITH_CRS
        )
        say(f"triangulating {len(survey):,} {_what(survey)}")
        constraints = Constraints(crossing, outline, conforming, max_points)
        solid = is_space(source, space, survey)
        if solid and isinstance(survey, PointSet):
            constraints.require_none(survey.source)
            with writing():
                writers = {path: writer(path, space=True) for path in writers}
            mesh: Mesh = triangulated_space(survey, method=method, workers=workers)
            z = None
            if space is None and not better:
                note(
                    f"{source}: three columns: 3-D tetrahedra; --2d triangulates the surface",
                    quiet=quiet,
                )
        else:
            mesh, z = triangulated(survey, constraints, method=method, workers=workers)
        watch.seconds |= mesh.stages
        written: Mesh | TetMesh = mesh
        gained: dict[str, Any] = {}
        if better:
            if not (solid and isinstance(mesh, Delaunay)):
                raise Failure("--improve is for tetrahedra: give --3d", Exit.USAGE)
            with watch.stage("improve"):
                tetrahedra = improved(mesh, writers, say, min_angle=min_angle, passes=max_iter)
            written, gained = tetrahedra, {"improvement": improvement_figures(tetrahedra.report)}
        write_all(writers, written, watch, say, z=z, crs=survey.crs, edges=edges)
        say("reporting")
        figures: dict[str, Any] = {
            "delone": __version__,
            "input": str(source),
            "crs": survey.crs,
            **(space_summary(mesh) if isinstance(mesh, Delaunay) and solid else summary(mesh)),
            **_of_constraints(mesh, survey),
            **gained,
            "stages": watch.rows(mesh.npoints),
            "outputs": [str(path) for path in writers],
            "peak_memory_bytes": peak_memory(),
        }
    if as_json:
        print_json(figures)
    elif not quiet:
        rows = space_rows(figures) if solid else triangulation_rows(figures)
        rows += improvement_rows(figures["improvement"]) if better else []
        print_report(str(source), rows, figures)


def check(
    mesh: Annotated[
        Path,
        typer.Argument(
            metavar="MESH", help="File of triangles or tetrahedra: " + " ".join(mesh_suffixes())
        ),
    ],
    *,
    canonical: Annotated[
        bool,
        typer.Option(
            "--canonical", help="Require delone's choice of diagonals among cocircular points."
        ),
    ] = False,
    surface: Annotated[
        bool,
        typer.Option(
            "--surface",
            help="3-D: check instead that triangles do not cross and enclose a region.",
        ),
    ] = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Prove exactly that triangles are Delaunay, or name the faults and exit with 1."""
    if surface and canonical:
        raise Failure("--canonical is for triangulations, not for --surface", Exit.USAGE)
    with spinner(quiet or as_json) as say:
        if surface:
            figures, lines = check_faces(mesh, say=say)
        else:
            figures, lines = check_mesh(mesh, canonical=canonical, say=say)
    if as_json:
        print_json(figures)
    elif not quiet:
        counts = ("points", "triangles", "tetrahedra", "faces")
        names = [name for name in counts if name in figures]
        print_rows(str(mesh), [(name, f"{figures[name]:,}") for name in names])
        print_text("\n".join(lines))
    if not figures["ok"]:
        raise typer.Exit(Exit.NOT_DELAUNAY)


def info(
    source: Input,
    *,
    classes: Classes = None,
    columns: Columns = None,
    layer: Layer = None,
    in_space: Solid = False,
    in_plane: Flat = False,
    crs: Crs = None,
    as_json: Json = False,
) -> None:
    """Describe the contents of a file without triangulating it."""
    space = space_or_plane(in_space, in_plane)
    require_known(crs)
    with spinner(as_json) as say:
        say(f"reading {source.name}")
        figures, rows = describe(
            source,
            columns=split(columns),
            classes=class_numbers(classes),
            layer=layer,
            space=space,
            crs=crs,
        )
    if as_json:
        print_json(figures)
    else:
        print_rows(str(source), rows)


# Called, not used as decorators: the functions above remain plain functions.
app.callback()(_options)


def run(arguments: Sequence[str]) -> int:
    """Run the command and return its exit code; errors are one line on standard error."""
    # Only the main thread may set signal handlers.
    main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGTERM, _terminated) if main else None
    _prepare_streams()
    try:
        # typer reports errors of the command line itself, and Ctrl-C must not become its Abort.
        code = typer.main.get_command(app).main(
            args=list(arguments), prog_name="delone", standalone_mode=False
        )
        sys.stdout.flush()
        # typer converts Ctrl-C to this code.
        if code == Exit.INTERRUPTED:
            return _said(KeyboardInterrupt())
        return code if isinstance(code, int) else Exit.OK
    except BaseException as error:
        return _said(error)
    finally:
        if before is not None:
            signal.signal(signal.SIGTERM, before)


def _prepare_streams() -> None:
    """Make sure that standard output exists and accepts every character."""
    if sys.stdout is None:
        sys.stdout = Path(os.devnull).open("w")  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def _dropped_stdout() -> None:
    """Discard output that cannot be printed; the interpreter would retry when it exits."""
    with contextlib.suppress(OSError):
        sys.stdout.close()
    sys.stdout = Path(os.devnull).open("w")  # noqa: SIM115


def _said(error: BaseException) -> int:
    """Report an error and return the exit code."""
    if _is_closed_pipe(error):
        # No message, like a program killed by SIGPIPE.
        _dropped_stdout()
        return Exit.PIPE
    if isinstance(error, OSError) and not isinstance(error, OutputError | MissingExtraError):
        # Errors of files were handled before: this one is of standard output.
        _dropped_stdout()
        why = f"the report cannot be printed: {error.strerror}; files of -o, if any, are complete"
        error = Failure(why, Exit.OUTPUT)
    if isinstance(error, SystemExit):
        return error.code if isinstance(error.code, int) else Exit.USAGE
    usage = getattr(error, "format_message", None)
    if usage is not None:
        message, code = usage(), Exit(getattr(error, "exit_code", Exit.USAGE))
    elif isinstance(error, KeyboardInterrupt | typer.Abort):
        message, code = "interrupted", Exit.INTERRUPTED
    elif isinstance(error, Failure):
        message, code = str(error), error.code
    elif isinstance(error, MemoryError):
        message, code = str(error) or "there is not enough memory", Exit.MEMORY
    else:
        code = code_of(error)
        message = os_message(error) if isinstance(error, OutputError) else as_options(str(error))
        if isinstance(error, NonFiniteError) and not re.search(
            r"first: \d|infinite: row \d", message
        ):
            more = ", ..." if error.count > len(error.rows) else ""
            noun = agreed(error.count, "row", "rows")
            message += f" ({noun} {', '.join(map(str, error.rows.tolist()))}{more})"
        message += "".join(f"; {note}" for note in getattr(error, "__notes__", ()))
        if code == Exit.INTERNAL:
            message = f"{type(error).__name__}: {message} (a bug in delone; please report it)"
    if message:
        # Standard error may be closed as well.
        with contextlib.suppress(OSError):
            print(f"delone: {' '.join(message.split())}", file=sys.stderr)
    return code


def _is_closed_pipe(error: BaseException) -> bool:
    """Return whether the reader of standard output has closed it.

    When typer prints help, it converts that to an exit with 1.
    """
    if isinstance(error, Failure):
        return error.code == Exit.PIPE
    cause = error.__context__ if isinstance(error, SystemExit) else error
    return isinstance(cause, BrokenPipeError)


def _terminated(number: int, frame: object) -> NoReturn:
    # As an exception, so that temporary files are removed on exit.
    raise SystemExit(Exit.TERMINATED)
