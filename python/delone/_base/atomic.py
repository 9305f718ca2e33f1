"""Atomic writing of files.

All failures to write a file are converted to one type of error, which names the file.
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

from delone._base.files import no_folder, not_regular, path_of
from delone.errors import DeloneError, OutputError

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["FULL", "check_target", "replacing"]

# Advice for errors that mean that the disk is full.
FULL = {
    errno.ENOSPC: "free some space or write to another disk",
    errno.EDQUOT: "your quota on this disk is used up",
    errno.EFBIG: "the file system, or the limit of ulimit -f, does not allow a larger file",
}
# Formats of several files: the other files that belong to a file, with the same stem.
_PARTS = {
    ".shp": (".shx", ".dbf", ".prj", ".cpg"),
    ".mif": (".mid",),
}
# Indices of other programs, which would not match the new file.
_STALE = {".shp": (".sbn", ".sbx", ".qix")}
# Characters of the target's name in the temporary name: file systems allow 255 bytes.
_RECOGNIZABLE = 100
# Bytes written to find out whether the disk is full.
_PROBE = 1 << 20


def check_target(path: str | os.PathLike[str]) -> Path:
    """Return the file to be written, behind symbolic links; an OSError if it cannot be written."""
    # A rename would replace the link, not the file that it points to.
    target = Path(os.path.realpath(path_of(path)))
    if target.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), str(path))
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{path}: the folder {target.parent} does not exist")
    if target.is_dir():
        raise IsADirectoryError(no_folder(path))
    if target.exists() and not target.is_file():
        raise not_regular(path)
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise PermissionError(f"{path}: the folder {target.parent} is not writable")
    return target


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary name next to the target, and rename it to the target at the end.

    A rename within one folder is atomic: a reader sees the old file or the new one. On failure, no
    file remains whose name begins with the temporary name, and an OutputError names the target.
    """
    target = check_target(path)
    # Only plain characters: some libraries cut a name at ";" or treat it as a pattern.
    start = re.sub(r"[^A-Za-z0-9_-]", "_", target.stem[:_RECOGNIZABLE])
    stem = f".{start}-{secrets.token_hex(6)}"
    temporary = target.with_name(stem + target.suffix)
    try:
        yield temporary
        if not temporary.exists():
            raise OutputError(f"{path}: nothing was written")
        if target.exists():
            # A private file remains private.
            temporary.chmod(stat.S_IMODE(target.stat().st_mode))
        _replace_parts(temporary, target)
        # Windows cannot replace a file that is open elsewhere; its error says so.
        os.replace(temporary, target)
    except MemoryError:
        raise
    except Exception as error:
        refusal = _refusal(error, temporary, str(path))
        if refusal is None:
            if isinstance(error, DeloneError):
                error.args = (_named(str(error), temporary, str(path)), *error.args[1:])
            raise
        raise refusal from error
    finally:
        # Libraries may leave companion files (journals, indices) with the same stem.
        for left in target.parent.iterdir():
            if left.name.startswith(stem):
                left.unlink(missing_ok=True)


def _replace_parts(temporary: Path, target: Path) -> None:
    """Rename the other files of a format of several files; remove old ones without a new one."""
    kind = target.suffix.lower()
    for suffix in (*_PARTS.get(kind, ()), *_STALE.get(kind, ())):
        made, old = temporary.with_suffix(suffix), target.with_suffix(suffix)
        if made.exists():
            os.replace(made, old)
        else:
            old.unlink(missing_ok=True)


def _refusal(error: Exception, temporary: Path, path: str) -> OutputError | None:
    """Convert an exception during writing to an error that names the file; None to keep it.

    Libraries hide the error number, or raise another error while they close the file. Therefore the
    preceding exceptions in the chain are examined, and then the disk is tested.
    """
    if isinstance(error, DeloneError) and not isinstance(error, OutputError):
        return None
    if isinstance(error, OutputError) and error.errno is None:
        message = _named(str(error), temporary, path)
        return None if message == str(error) else OutputError(message)
    number = _number_of_full(error, temporary)
    if number is not None:
        return OutputError(number, f"{os.strerror(number)}: {FULL[number]}", path)
    if isinstance(error, OSError):
        if error.errno is not None:
            ours = error.filename is None or _is_temporary(error.filename, temporary)
            return OutputError(error.errno, error.strerror, path) if ours else None
    elif type(error).__module__.partition(".")[0] in {"builtins", "numpy", "delone"}:
        return None
    reason = str(error).partition("\n")[0] or type(error).__name__
    return OutputError(f"{path} cannot be written: {_named(reason, temporary, path)}")


def _named(message: str, temporary: Path, path: str) -> str:
    """Return a message with the name of the target, with its folder or without."""
    return message.replace(str(temporary), path).replace(temporary.name, Path(path).name)


def _number_of_full(error: BaseException, temporary: Path) -> int | None:
    """Return the number of the error if the cause is a full disk, otherwise None."""
    each: BaseException | None = error
    while each is not None:
        if isinstance(each, OSError) and each.errno in FULL:
            return each.errno if _is_temporary(each.filename or temporary, temporary) else None
        each = each.__cause__ or each.__context__
    try:
        # An incomplete file is removed anyway.
        with temporary.open("ab") as file:
            file.write(bytes(_PROBE))
    except OSError as full:
        return full.errno if full.errno in FULL else None
    return None


def _is_temporary(name: object, temporary: Path) -> bool:
    """Return whether a name is that of the temporary file or of a companion file."""
    found = os.fsdecode(name) if isinstance(name, str | bytes | os.PathLike) else ""
    return Path(found).name.startswith(temporary.stem)
