"""Atomic writing: files appear complete or not at all.

Whatever keeps a file from being written ends as one kind of error here, which names the file.
"""

from __future__ import annotations

import errno
import os
import re
import secrets
import stat
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from delone.errors import DeloneError, OutputError

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["FULL", "check_target", "replacing"]

# What to do about a disk that takes no more.
FULL = {
    errno.ENOSPC: "free some space or write to another disk",
    errno.EDQUOT: "your quota on this disk is used up",
    errno.EFBIG: "the file system, or the limit of ulimit -f, allows no larger file",
}
# Characters of the name of the target in the temporary name: file systems allow 255 bytes in all.
_RECOGNIZABLE = 100
# Bytes written to learn whether the disk is full.
_PROBE = 1 << 20


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
    OutputError
        The disk is full, or the system or a library cannot write the file. The error names the
        target, not the temporary file.
    OSError
        The target cannot be written to, as `check_target` says.

    Notes
    -----
    A rename within one folder is atomic, so a reader sees the old file or the new one. Other
    exceptions of the caller pass through. In either case, no file is left that begins with the
    temporary name.

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
    # Plain characters alone: some libraries cut a name at ";" or take it for a pattern.
    start = re.sub(r"[^A-Za-z0-9_-]", "_", target.stem[:_RECOGNIZABLE])
    stem = f".{start}-{secrets.token_hex(6)}"
    beside = target.with_name(stem + target.suffix)
    try:
        yield beside
        if not beside.exists():
            raise OutputError(f"{path}: nothing was written")
        if target.exists():
            # A private file stays private.
            beside.chmod(stat.S_IMODE(target.stat().st_mode))
        # Windows refuses to rename over a file that is open elsewhere; that error says so.
        os.replace(beside, target)
    except MemoryError:
        raise
    except Exception as error:
        refusal = _refusal(error, beside, str(path))
        if refusal is None:
            raise
        raise refusal from error
    finally:
        # Libraries may leave companions (journals, indices) under the same stem.
        for left in target.parent.iterdir():
            if left.name.startswith(stem):
                left.unlink(missing_ok=True)


def _refusal(error: Exception, beside: Path, path: str) -> OutputError | None:
    """Turn what was raised while a file was written into an error that names the file.

    Libraries hide the number of the error, or raise another error while they close the file. So
    the errors before it are looked at, and then the disk is asked.
    """
    if isinstance(error, DeloneError) and not isinstance(error, OutputError):
        return None
    if isinstance(error, OutputError) and error.errno is None:
        message = str(error).replace(str(beside), path)
        return None if message == str(error) else OutputError(message)
    number = _number_of_full(error, beside)
    if number is not None:
        return OutputError(number, f"{os.strerror(number)}: {FULL[number]}", path)
    if isinstance(error, OSError):
        if error.errno is not None:
            ours = error.filename is None or _is_beside(error.filename, beside)
            return OutputError(error.errno, error.strerror, path) if ours else None
    elif type(error).__module__.partition(".")[0] in {"builtins", "numpy", "delone"}:
        return None
    reason = str(error).partition("\n")[0] or type(error).__name__
    return OutputError(f"{path} cannot be written: {reason.replace(str(beside), path)}")


def _number_of_full(error: BaseException, beside: Path) -> int | None:
    """Return the number of the error where the cause is a full disk, None otherwise."""
    each: BaseException | None = error
    while each is not None:
        if isinstance(each, OSError) and each.errno in FULL:
            return each.errno if _is_beside(each.filename or beside, beside) else None
        each = each.__cause__ or each.__context__
    try:
        # What is torn is removed anyway.
        with beside.open("ab") as file:
            file.write(bytes(_PROBE))
    except OSError as full:
        return full.errno if full.errno in FULL else None
    return None


def _is_beside(name: object, beside: Path) -> bool:
    """Tell whether a name is that of the temporary file or of a companion of it."""
    found = os.fsdecode(name) if isinstance(name, str | bytes | os.PathLike) else ""
    return Path(found).name.startswith(beside.stem)
