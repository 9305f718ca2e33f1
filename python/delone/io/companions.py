"""Files that are read beside a named one: of the same name, in the same folder, and no links away.

The user names one file. What lies beside it may come from somebody else, and a symbolic link there
would lead to any file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

__all__ = ["require_companion", "require_companions"]


def require_companions(path: Path, endings: Sequence[str]) -> None:
    """Reject links beside a file; an ending is a suffix (".dbf") or follows the name ("-wal")."""
    for ending in endings:
        beside = _beside(path, ending)
        if beside.is_symlink():
            require_companion(path, beside)


def require_companion(path: Path, beside: Path) -> None:
    """Reject a companion that is a link to anything but the companion of the file itself.

    A file that is a link may have companions that are links to the files beside its target.
    """
    if not beside.is_symlink():
        return
    ending = beside.suffix if beside.stem == path.stem else beside.name.removeprefix(path.name)
    if beside.resolve() != _beside(path.resolve(), ending):
        raise FileFormatError(
            f"{beside} is a link to another file, which is not followed: copy that file here"
        )


def _beside(path: Path, ending: str) -> Path:
    if ending.startswith("."):
        return path.with_suffix(ending)
    return path.with_name(path.name + ending)
