"""Files that a command writes: checked before any work, and complete before they replace others."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any

from delone._base.atomic import check_target, replacing
from delone.cli.exits import writing
from delone.io.writing import writer

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from delone.cli.report import Stopwatch

__all__ = ["ready", "write_all"]


def ready(path: Path, *, space: bool = False, order: int = 1) -> Callable[..., None]:
    """Return the function that writes a mesh to a file, after checking that it can be written."""
    write = writer(path, space=space, order=order)
    check_target(path)
    return write


def write_all(
    writers: Mapping[Path, Callable[..., None]],
    thing: Any,
    watch: Stopwatch,
    say: Callable[[str], object],
    **options: Any,
) -> None:
    """Write all files next to their targets, and rename them once all are complete."""
    with writing(), contextlib.ExitStack() as stack:
        for path, write in writers.items():
            say(f"writing {path.name}")
            with watch.stage(f"write {path.name}"):
                write(stack.enter_context(replacing(path)), thing, **options)
