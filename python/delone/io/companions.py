"""Files that are read with a named one: same name, same folder, and not links to elsewhere.

The user names one file. Other files in its folder may come from somebody else, and a symbolic link
there could lead anywhere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

__all__ = ["require_companion", "require_companions"]


def require_companions(path: Path, endings: Sequence[str]) -> None:
    """Reject companions that are links; an ending is a suffix (".dbf") or is appended ("-wal")."""
    for ending in endings:
        beside = _beside(path, ending)
        if beside.is_symlink():
            require_companion(path, beside)


def require_companion(path: Path, beside: Path) -> None:
    """Reject a companion that is a link to anything but the companion of the file itself.

    A file that is a link may have companions that are links to those of its target.
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
