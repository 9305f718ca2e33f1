"""Files that appear whole or not at all: written beside the target, then renamed."""

from __future__ import annotations

import os
import secrets
import stat
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["check_target", "replacing"]


def check_target(path: str | os.PathLike[str]) -> Path:
    """Refuse a target that cannot be written, before any work is spent on it.

    Parameters
    ----------
    path : str or path-like
        The file to be written.

    Returns
    -------
    Path
        The file itself where `path` is a symbolic link to it.

    Raises
    ------
    OSError
        The folder is missing or read-only, or the target is there and is no regular file.

    Examples
    --------
    >>> from delone.atomic import check_target
    >>> check_target("mesh.vtu").name
    'mesh.vtu'
    """
    # A rename would replace the link, not the file that it stands for.
    target = Path(os.path.realpath(path))
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{path}: the folder {target.parent} does not exist")
    if target.is_dir():
        raise IsADirectoryError(f"{path} is a folder; give the name of a file")
    if target.exists() and not target.is_file():
        raise OSError(f"{path} is not a regular file")
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise PermissionError(f"{path}: the folder {target.parent} cannot be written to")
    return target


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary name beside the target, which becomes the target at the end.

    Parameters
    ----------
    path : str or path-like
        The file to be written. What it held before stays until the new file is whole.

    Yields
    ------
    Path
        A fresh name in the same folder with the same suffix, to be written by the caller.

    Raises
    ------
    OSError
        The target cannot be written. Whatever the caller raises passes through; nothing that
        begins with the temporary name is left then.

    Notes
    -----
    A rename within one folder is atomic, so a reader sees the old file or the new one.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.atomic import replacing
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with replacing(Path(folder) / "a.txt") as beside:
    ...         _ = beside.write_text("whole")
    ...     (Path(folder) / "a.txt").read_text()
    'whole'
    """
    target = check_target(path)
    stem = f".{target.stem[:100]}-{secrets.token_hex(6)}"
    beside = target.with_name(stem + target.suffix)
    try:
        yield beside
        if not beside.exists():
            raise OSError(f"{path}: nothing was written")
        if target.exists():
            # A private file stays private.
            beside.chmod(stat.S_IMODE(target.stat().st_mode))
        # Windows refuses to rename over a file that is open elsewhere; that error says so.
        os.replace(beside, target)
    finally:
        # Libraries may leave companions (journals, indices) under the same stem.
        for left in target.parent.glob(stem + "*"):
            left.unlink(missing_ok=True)
