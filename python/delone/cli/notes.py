"""Notes on standard error: what the user should know although the command continues."""

from __future__ import annotations

import sys
import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING

from delone._base.georeference import CRSWarning
from delone._base.units import UnitsWarning
from delone.cli.wording import CALLED, as_options
from delone.io import LeftOutWarning

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["note", "noting"]


def note(message: str | None, *, quiet: bool = False) -> None:
    """Print a note on standard error, if there is one."""
    if message is not None and not quiet:
        # Imported here, because the list of commands imports what the commands import.
        from delone.cli.commands import options_of

        arguments = CALLED.get()
        said = as_options(message, options_of(arguments), keep=arguments, words=False)
        print(f"delone: note: {' '.join(said.split())}", file=sys.stderr)


@contextmanager
def noting(*, quiet: bool = False) -> Iterator[None]:
    """Print warnings about units, reference systems and what is left out as notes.

    A plain ``UserWarning`` also becomes a note; all others are passed on.
    """
    kinds = (UnitsWarning, CRSWarning, LeftOutWarning)
    with warnings.catch_warnings(record=True) as caught:
        for kind in (*kinds, UserWarning):
            warnings.simplefilter("always", kind)
        yield
    for each in caught:
        if issubclass(each.category, kinds) or each.category is UserWarning:
            note(str(each.message), quiet=quiet)
        else:
            warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)
