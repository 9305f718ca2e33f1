"""Exit codes, and the errors that they stand for."""

from __future__ import annotations

import os
import warnings
from contextlib import contextmanager
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec

from delone.cli.wording import without_layer
from delone.errors import (
    BudgetExceededError,
    BusyError,
    ConflictingValuesError,
    CrossingFacesError,
    CrossingSegmentsError,
    CrowdedFacesError,
    DanglingFacesError,
    DegenerateInputError,
    DirectionError,
    FileFormatError,
    InputError,
    InternalError,
    MissingExtraError,
    NonFiniteError,
    OpenSurfaceError,
    OutputError,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

Given = ParamSpec("Given")
# Number of pairs of rows whose lines are named; for single rows, errors list ten.
_FIRST = 10

__all__ = [
    "MEANINGS",
    "Exit",
    "Failure",
    "code_of",
    "os_message",
    "protect_inputs",
    "reading",
    "writing",
]


class Exit(IntEnum):
    """The exit codes of the command."""

    OK = 0
    NOT_DELAUNAY = 1
    USAGE = 2
    INPUT = 3
    DEGENERATE = 4
    OUTPUT = 5
    MISSING_EXTRA = 6
    MEMORY = 7
    INTERNAL = 70
    INTERRUPTED = 130
    PIPE = 141
    TERMINATED = 143


MEANINGS = {
    Exit.OK: "success",
    Exit.NOT_DELAUNAY: "check: the mesh is not a Delaunay triangulation, or the surface is invalid",
    Exit.USAGE: "the command line is wrong",
    Exit.INPUT: "the input is missing, truncated or of unknown format",
    Exit.DEGENERATE: "no triangulation: too few points, collinear points, NaN or infinity, "
    "latitudes beyond a pole, "
    "duplicates with different values, crossings that are errors, vertices beyond a limit",
    Exit.OUTPUT: "the output cannot be written; no file was written, unless the message says so",
    Exit.MISSING_EXTRA: "an optional library is not installed",
    Exit.MEMORY: "there is not enough memory",
    Exit.INTERNAL: "a bug in delone; please report it",
    Exit.INTERRUPTED: "interrupted by Ctrl-C; nothing was written",
    Exit.PIPE: "standard output was closed by its reader, as head does; files of -o are complete",
    Exit.TERMINATED: "terminated; nothing was written",
}


class Failure(Exception):  # noqa: N818
    """Terminates the command with a one-line message for the user and an exit code."""

    def __init__(self, message: str, code: Exit) -> None:
        super().__init__(message)
        self.code = code


def protect_inputs(outputs: Iterable[Path], *inputs: Path) -> None:
    """Reject outputs that would replace an input, or each other, after following links."""
    read = {os.path.realpath(path): path for path in inputs}
    written: set[str] = set()
    for path in outputs:
        real = os.path.realpath(path)
        if real in read:
            raise Failure(f"{path}: the output would replace the input {read[real]}", Exit.USAGE)
        if real in written:
            raise Failure(f"{path}: two outputs are the same file", Exit.USAGE)
        written.add(real)


def require_suffix(path: Path, suffixes: Iterable[str], what: str) -> None:
    """Reject a path whose suffix is not one of those for the output."""
    if path.suffix.lower() not in suffixes:
        raise Failure(f"{path}: {what} can only be written to {' '.join(suffixes)}", Exit.USAGE)


def code_of(error: BaseException) -> Exit:
    """Return the exit code of an error that is not about a file; an unexpected error is a bug."""
    codes: tuple[tuple[type[BaseException], Exit], ...] = (
        (MissingExtraError, Exit.MISSING_EXTRA),
        (DegenerateInputError, Exit.DEGENERATE),
        (NonFiniteError, Exit.DEGENERATE),
        (DirectionError, Exit.DEGENERATE),
        (ConflictingValuesError, Exit.DEGENERATE),
        (CrossingFacesError, Exit.DEGENERATE),
        (CrossingSegmentsError, Exit.DEGENERATE),
        (CrowdedFacesError, Exit.DEGENERATE),
        (DanglingFacesError, Exit.DEGENERATE),
        (OpenSurfaceError, Exit.DEGENERATE),
        (BudgetExceededError, Exit.DEGENERATE),
        (BusyError, Exit.OUTPUT),
        (OutputError, Exit.OUTPUT),
        (InternalError, Exit.INTERNAL),
        (FileFormatError, Exit.INPUT),
        (InputError, Exit.USAGE),
    )
    return next((code for kind, code in codes if isinstance(error, kind)), Exit.INTERNAL)


def os_message(error: OSError) -> str:
    """Return the name of the file and the system's message in one line."""
    if error.errno is None:
        # delone's own messages already contain the name.
        return str(error)
    return ": ".join(str(part) for part in (error.filename, error.strerror) if part is not None)


@contextmanager
def reading(*, quiet: bool = False, layer: str | None = "--layer") -> Iterator[None]:
    """Treat file errors as errors in the input, and print warnings as notes.

    `layer` is the option for the layer of the file; None if it must have only one.
    """
    # The help shows the exit codes without importing the readers.
    from delone.cli.notes import noting

    with _blaming(Exit.INPUT, layer), noting(quiet=quiet):
        yield


@contextmanager
def writing() -> Iterator[None]:
    """Treat file errors as errors in the output."""
    with _blaming(Exit.OUTPUT), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@contextmanager
def _blaming(code: Exit, layer: str | None = "--layer") -> Iterator[None]:
    try:
        yield
    except FileFormatError as error:
        said = str(error) if layer == "--layer" else without_layer(str(error), layer)
        raise Failure(said, code) from error
    except OutputError as error:
        raise Failure(os_message(error), Exit.OUTPUT) from error
    except (MissingExtraError, BlockingIOError):
        raise
    except OSError as error:
        raise Failure(os_message(error), code) from error
