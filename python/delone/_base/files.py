"""Errors about files that are missing, truncated, or lack required contents."""

from __future__ import annotations

import json
import os
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from delone.errors import DeloneError, DtypeError, FileFormatError, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = [
    "corrupt",
    "cut_short",
    "existing",
    "loaded",
    "no_curves",
    "no_folder",
    "no_layers",
    "not_a_path",
    "not_regular",
    "path_of",
    "reading_as",
    "require_there",
    "unread",
    "without",
]


def existing(path: str | os.PathLike[str]) -> Path:
    """Return the path of a file that exists and is not empty."""
    file = path_of(path)
    require_there(file)
    if file.is_dir():
        raise FileFormatError(no_folder(file))
    if not file.is_file():
        # Files are read twice: their format and sizes are checked before they are read.
        raise FileFormatError(f"{file} is a pipe or device; write its contents to a file first")
    if file.stat().st_size == 0:
        raise FileFormatError(f"{file} is empty")
    return file


def path_of(path: str | os.PathLike[str], *, name: str = "path") -> Path:
    """Return a path; anything else raises an error."""
    if not isinstance(path, str | os.PathLike):
        raise not_a_path(path, name)
    return Path(path)


def require_there(path: Path) -> None:
    """Reject a path that does not exist."""
    if not path.exists():
        raise FileNotFoundError(f"{path}: no such file")


def no_folder(path: object) -> str:
    """Return the message for a folder that is given in place of a file."""
    return f"{path} is a folder, not a file"


def not_regular(path: object) -> OSError:
    """Return the error for a pipe or a device."""
    return OSError(f"{path} is not a regular file")


def not_a_path(path: object, name: str) -> DtypeError:
    """Return the error for an argument that is not a path."""
    return DtypeError(f"{name} must be a string or a path-like object, got {path!r:.60}")


def no_curves(path: Path) -> InputError:
    """Return the error for `chord` in a format without curves."""
    return InputError(f"{path}: chord is for DXF files, which have curves")


def no_layers(path: Path) -> FileFormatError:
    """Return the error for the name of a layer in a format without layers."""
    return FileFormatError(f"{path}: {path.suffix.lower()} files have no layers")


def without(path: object, what: str) -> FileFormatError:
    """Return the error for a file without points, triangles or the like."""
    return FileFormatError(f"{path} contains no {what}")


def cut_short(path: object, declared: object, contained: object) -> FileFormatError:
    """Return the error for a file that contains less than it declares."""
    return FileFormatError(f"{path} declares {declared} and contains {contained}: it is truncated")


def unread(path: object, kind: str, error: object) -> FileFormatError:
    """Return the error for a file that a library cannot read as a kind such as "NumPy"."""
    reason = str(error).partition("\n")[0] or type(error).__name__
    return FileFormatError(f"{path} is truncated or not a {kind} file: {reason:.200}")


def corrupt(path: object, what: object) -> FileFormatError:
    """Return the error for a file whose contents contradict each other."""
    return FileFormatError(f"{path} is truncated or corrupt: {what!s:.100}")


def loaded(
    content: bytes, path: object, look: Callable[[list[tuple[str, Any]]], Any] | None = None
) -> Any:
    """Return the contents of a JSON file; `look` converts the members of each object."""
    try:
        return json.loads(content, object_pairs_hook=look)
    except FileFormatError:
        raise
    except (ValueError, RecursionError) as error:
        raise FileFormatError(f"{path} is not JSON: {str(error)[:100]}") from error


@contextmanager
def reading_as(path: object, kind: str) -> Iterator[None]:
    """Convert what a library raises for a damaged file to FileFormatError."""
    try:
        yield
    except (DeloneError, FileNotFoundError, PermissionError, MemoryError):
        raise
    except Exception as error:
        raise unread(path, kind, error) from error
