"""Files that a command writes: checked before any work, and complete before they replace others."""

from __future__ import annotations

import contextlib
import secrets
import shutil
from typing import TYPE_CHECKING, Any

from delone._base.atomic import check_target, replacing
from delone.cli.exits import Failure, writing
from delone.errors import DeloneError
from delone.io.writing import writer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path

    from delone.cli.report import Stopwatch

__all__ = ["ready", "staged", "write_all"]


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


@contextlib.contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Yield a temporary folder, and at the end move its files to a folder, the page as the last.

    The temporary folder is inside the folder, which may be a link or another disk: the files become
    complete there before any old one is replaced, and after an error all old ones are unchanged.
    """
    temporary = folder / f".delone-{secrets.token_hex(6)}"
    try:
        with writing():
            temporary.mkdir()
        yield temporary
        with writing(), contextlib.ExitStack() as stack:
            # What is entered first is renamed last.
            for made in sorted(temporary.iterdir(), key=lambda path: path.suffix != ".html"):
                shutil.move(made, stack.enter_context(replacing(folder / made.name)))
    except (Failure, DeloneError) as error:
        error.args = tuple(
            each.replace(str(temporary), str(folder)) if isinstance(each, str) else each
            for each in error.args
        )
        raise
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
