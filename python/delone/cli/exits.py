"""Exit codes, and the errors that they stand for."""

from __future__ import annotations

import os
import re
import warnings
from contextlib import contextmanager
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec

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
    from collections.abc import Iterable, Iterator, Mapping

Given = ParamSpec("Given")
# Number of pairs of rows whose lines are named; for single rows, errors list ten.
_FIRST = 10

__all__ = [
    "MEANINGS",
    "Exit",
    "Failure",
    "as_options",
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


_ATTRIBUTE = re.compile(r"; `error\.\w+` (?:ha|list|contain)[^;]*")
_QUOTES = str.maketrans("", "", "'\"")
# The value of an argument in a message: texts with "or" between them, a word, or nothing.
_VALUE = r"""(?:=((?:["'][\w-]+["'](?:, | or )?)+|\w+)?)?"""
# Arguments that messages mention and that are options of some commands only.
_ANYWHERE = ("crossing", "duplicates", "extrapolate", "inside", "max_points", "nan")


def as_options(message: str, options: Mapping[str, str] | None = None) -> str:
    """Rewrite Python arguments in a message as options: ``nan='drop'`` as ``--nan drop``.

    `options` has the option of each argument: ``max_edge`` is ``--max-edge``. An argument is a word
    with an equals sign or an underscore, or the first word of what is wrong with it. The parts that
    attributes of the exception contain are left out.
    """
    known = {name: f"--{name.replace('_', '-')}" for name in _ANYWHERE} | dict(options or {})
    names = "|".join(sorted(map(re.escape, known), key=len, reverse=True))
    plain = _ATTRIBUTE.sub("", message)
    plain = re.sub(rf"(?<![\w.-])({names}){_VALUE}", lambda found: _option(found, known), plain)
    return re.sub(r"(--[\w-]+ must be )None \([^)]*\) or ", r"\1", plain)


def _option(found: re.Match[str], known: Mapping[str, str]) -> str:
    """Return the option for an argument, or the text itself if it is an ordinary word."""
    name, value = found[1], found[2]
    option = known[name]
    rest = found.string[found.end() :]
    if "=" in found[0]:
        if value == "False":
            return option.replace("--", "--no-", 1)
        return option if value in (None, "True") else f"{option} {value.translate(_QUOTES)}"
    before = found.string[: found.start()]
    starts = not before or before.endswith((": ", "; "))
    whole = not re.match(r"\w", rest)
    if whole and ("_" in name or (starts and re.match(r" must |: ", rest))):
        return option
    return found[0]


def os_message(error: OSError) -> str:
    """Return the name of the file and the system's message in one line."""
    if error.errno is None:
        # delone's own messages already contain the name.
        return str(error)
    return ": ".join(str(part) for part in (error.filename, error.strerror) if part is not None)


@contextmanager
def reading(*, quiet: bool = False) -> Iterator[None]:
    """Treat file errors as errors in the input, and print warnings as notes."""
    # The help shows the exit codes without importing the readers.
    from delone.cli.notes import noting

    with _blaming(Exit.INPUT), noting(quiet=quiet):
        yield


@contextmanager
def writing() -> Iterator[None]:
    """Treat file errors as errors in the output."""
    with _blaming(Exit.OUTPUT), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@contextmanager
def _blaming(code: Exit) -> Iterator[None]:
    try:
        yield
    except FileFormatError as error:
        raise Failure(str(error), code) from error
    except OutputError as error:
        raise Failure(os_message(error), Exit.OUTPUT) from error
    except (MissingExtraError, BlockingIOError):
        raise
    except OSError as error:
        raise Failure(os_message(error), code) from error
