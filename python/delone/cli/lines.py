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

__all__ = ["naming_lines"]

Given = ParamSpec("Given")
# Number of pairs of rows whose lines are named; for single rows, errors list ten.
_FIRST = 10


def naming_lines(command: Callable[Given, None]) -> Callable[Given, None]:
    """Make a command add the lines of its text file to errors that name rows.

    The file is its argument ``source`` or ``sources``.
    """

    @functools.wraps(command)
    def called(*args: Given.args, **kwargs: Given.kwargs) -> None:
        try:
            command(*args, **kwargs)
        except (NonFiniteError, ConflictingValuesError, DirectionError) as error:
            given = kwargs.get("source", kwargs.get("sources"))
            files = given if isinstance(given, list | tuple) else [given]
            # Each once: a row may be in several pairs.
            rows = list(dict.fromkeys(np.ravel(error.rows[:_FIRST]).tolist()))
            if rows and len(files) == 1 and isinstance(files[0], str | Path) and is_text(files[0]):
                # The message is also correct without lines.
                with suppress(FileFormatError, OSError):
                    lines = ", ".join(map(str, line_numbers(files[0], rows)))
                    noun = agreed(len(rows), "line", "lines")
                    error.add_note(f"{noun} {lines} of {files[0]}")
            raise

    return called
