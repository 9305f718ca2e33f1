"""The lines of a text file for the rows that an error names."""

from __future__ import annotations

import functools
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec

import numpy as np

from delone._base.counting import agreed
from delone.errors import (
    ConflictingValuesError,
    DirectionError,
    FileFormatError,
    NonFiniteError,
)
from delone.io.reading import line_numbers
from delone.io.registry import is_text

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["ROWS", "name_lines", "naming_lines"]

Given = ParamSpec("Given")
# Number of pairs of rows whose lines are named; for single rows, errors list ten.
_FIRST = 10
RowsError = NonFiniteError | ConflictingValuesError | DirectionError
# The errors that name rows.
ROWS = (NonFiniteError, ConflictingValuesError, DirectionError)


def naming_lines(command: Callable[Given, None]) -> Callable[Given, None]:
    """Make a command add the lines of its text file to errors that name rows.

    The file is its argument ``source`` or ``sources``.
    """

    @functools.wraps(command)
    def called(*args: Given.args, **kwargs: Given.kwargs) -> None:
        try:
            command(*args, **kwargs)
        except ROWS as error:
            given = kwargs.get("source", kwargs.get("sources"))
            files = given if isinstance(given, list | tuple) else [given]
            if len(files) == 1 and isinstance(files[0], str | Path):
                name_lines(error, files[0])
            raise

    return called


def name_lines(error: RowsError, file: str | Path, *, other: bool = False) -> None:
    """Add the lines of a text file to an error that names rows, unless it has a file already.

    If the file is not the first one of the command (`other`), it is named even if it has no lines.
    """
    # Each once: a row may be in several pairs.
    rows = list(dict.fromkeys(np.ravel(error.rows[:_FIRST]).tolist()))
    if not rows or getattr(error, "__notes__", None):
        return
    # The message is also correct without lines.
    with suppress(FileFormatError, OSError):
        if is_text(file):
            lines = ", ".join(map(str, line_numbers(file, rows)))
            error.add_note(f"{agreed(len(rows), 'line', 'lines')} {lines} of {file}")
            return
    if other:
        error.add_note(f"the rows are those of {file}")
