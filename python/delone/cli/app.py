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
from delone._base.counting import agreed
from delone.cli.commands import Commands, options_of
from delone.cli.exits import MEANINGS, Exit, Failure, code_of, os_message
from delone.cli.wording import CALLED, as_options
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
app.callback()(_options)


def run(arguments: Sequence[str]) -> int:
    """Run the command and return its exit code; errors are one line on standard error."""
    # Only the main thread may set signal handlers.
    main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGTERM, _terminated) if main else None
    _prepare_streams()
    called = CALLED.set(arguments)
    try:
        # typer reports errors in the command line itself, and Ctrl-C must not become its Abort.
        code = typer.main.get_command(app).main(
            args=list(arguments), prog_name="delone", standalone_mode=False
        )
        sys.stdout.flush()
        # typer converts Ctrl-C to this code.
        if code == Exit.INTERRUPTED:
            return _said(KeyboardInterrupt(), arguments)
        return code if isinstance(code, int) else Exit.OK
    except BaseException as error:
        return _said(error, arguments)
    finally:
        CALLED.reset(called)
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


def _said(error: BaseException, arguments: Sequence[str]) -> int:
    """Report an error and return the exit code."""
    if _is_closed_pipe(error):
        # No message, like a program killed by SIGPIPE.
        _dropped_stdout()
        return Exit.PIPE
    if isinstance(error, OSError) and not isinstance(error, OutputError | MissingExtraError):
        # File errors were handled before, so this one comes from standard output.
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
        # Its own words are those of the command; those of a file error may not be.
        message, code = str(error), error.code
        message = as_options(message, options_of(arguments), keep=arguments, words=False)
    elif isinstance(error, MemoryError):
        message, code = str(error) or "there is not enough memory", Exit.MEMORY
        message = as_options(message, options_of(arguments), keep=arguments)
    else:
        message, code = _explained(error, arguments)
    if message:
        # Standard error may be closed as well.
        with contextlib.suppress(OSError):
            print(f"delone: {' '.join(message.split())}", file=sys.stderr)
    return code


def _explained(error: BaseException, arguments: Sequence[str]) -> tuple[str, Exit]:
    """Return the message and the exit code of an error of the package, or of a bug."""
    code = code_of(error)
    if isinstance(error, OutputError):
        message = os_message(error)
    else:
        message = as_options(str(error), options_of(arguments), keep=arguments)
    if isinstance(error, NonFiniteError) and not re.search(r"first: \d|infinite: row \d", message):
        more = ", ..." if error.count > len(error.rows) else ""
        noun = agreed(error.count, "row", "rows")
        message += f" ({noun} {', '.join(map(str, error.rows.tolist()))}{more})"
    message += "".join(f"; {note}" for note in getattr(error, "__notes__", ()))
    if code == Exit.INTERNAL:
        message = f"{type(error).__name__}: {message} (a bug in delone; please report it)"
    return message, code


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
