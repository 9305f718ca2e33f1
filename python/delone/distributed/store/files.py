"""Files of a run: writes are atomic, and notes record which tasks are done.

Every change of the file system is one step of `Store`. A run may be stopped between any two steps,
for any reason, and another one resumes it. Data are written first, the note of a task last.
"""

from __future__ import annotations

import hashlib
import json
import os
import secrets
import shutil
import zipfile
import zlib
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.atomic import FULL
from delone._base.bounded import archived, read_array, require_claim
from delone.errors import FileFormatError, OutputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

__all__ = ["Store", "digest", "step"]


def step(what: str) -> None:
    """Mark a point between two changes of the file system; tests stop a run here."""


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Explain what to do about a full disk."""
    try:
        yield
    except OSError as error:
        if error.errno not in FULL:
            raise
        raise OutputError(
            error.errno,
            "the disk is full; make room and run the same again: it resumes where it stopped",
            str(path),
        ) from error


@contextmanager
def _corrupt_is_an_error(path: Path) -> Iterator[None]:
    """Convert errors of reading an array to `FileFormatError`."""
    try:
        yield
    except FileFormatError:
        raise
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise FileFormatError(
            f"{path} is truncated: {error}; remove the output folder and start again"
        ) from error


class Store:
    """A folder of files that are written atomically."""

    def __init__(self, root: str | os.PathLike[str]) -> None:
        self.root = Path(root)

    def path(self, name: str) -> Path:
        """Return the path of a file; a path that leaves the folder through a link is rejected."""
        path = self.root / name
        real, inside = os.path.realpath(path), os.path.realpath(self.root)
        if os.path.commonpath((real, inside)) != inside:
            raise FileFormatError(
                f"{path} is a link to another folder, which is not followed: copy the files here"
            )
        return path

    def exists(self, name: str) -> bool:
        """Return whether a file exists."""
        return self.path(name).exists()

    @contextmanager
    def writing(self, name: str) -> Iterator[Path]:
        """Yield a temporary name next to a file, which is renamed to it at the end."""
        target = self.path(name)
        with _explained(target):
            step(f"before the folder of {name}")
            target.parent.mkdir(parents=True, exist_ok=True)
            step(f"before {name}")
            # Without listing the folder, which may have a million files.
            temporary = target.with_name(f".{target.stem}-{secrets.token_hex(6)}{target.suffix}")
            try:
                yield temporary
                step(f"before the renaming of {name}")
                os.replace(temporary, target)
            finally:
                temporary.unlink(missing_ok=True)
            step(f"after {name}")

    def save(self, name: str, array: NDArray[Any]) -> None:
        """Write one array."""
        with self.writing(name) as temporary, temporary.open("wb") as file:
            _write_array(file, array)

    def load(self, name: str, *, mapped: bool = False) -> NDArray[Any]:
        """Read one array, or map it into memory."""
        path = self.path(name)
        with _corrupt_is_an_error(path):
            with path.open("rb") as file:
                require_claim(file, path.stat().st_size, str(path))
            array: NDArray[Any] = np.load(path, mmap_mode="r" if mapped else None)
        return array

    def save_all(self, name: str, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write arrays by name."""
        with self.writing(name) as temporary, temporary.open("wb") as file:
            np.savez(file, allow_pickle=False, **arrays)

    def load_all(self, name: str, *wanted: str) -> dict[str, NDArray[Any]]:
        """Read arrays by name: some, or all."""
        path = self.path(name)
        with _corrupt_is_an_error(path), archived(path) as found:
            entries = {entry.filename.removesuffix(".npy"): entry for entry in found.infolist()}
            return {key: read_array(found, entries[key], str(path)) for key in wanted or entries}

    def note(self, name: str, content: Mapping[str, Any]) -> None:
        """Write a JSON note."""
        with self.writing(name) as temporary:
            temporary.write_text(json.dumps(content, indent=1), encoding="utf-8")

    def noted(self, name: str) -> Any:
        """Read a note; None if there is none."""
        try:
            found = json.loads(self.path(name).read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except (ValueError, RecursionError) as error:
            raise FileFormatError(f"{self.path(name)} is truncated or not JSON: {error}") from error
        if found is None:
            raise FileFormatError(f"{self.path(name)} is corrupt: it contains null")
        return found

    def sweep(self, pattern: str) -> None:
        """Remove temporary files of killed processes."""
        step(f"before the sweep of {pattern}")
        for left in self.root.glob(pattern):
            left.unlink(missing_ok=True)

    def remove(self, name: str) -> None:
        """Remove a folder and its contents, if it exists."""
        step(f"before the removal of {name}")
        if self.exists(name):
            shutil.rmtree(self.path(name))
        step(f"after the removal of {name}")


def _write_array(file: Any, array: NDArray[Any]) -> None:
    """Write an array as npy with plain writes, whose errors are informative."""
    array = np.ascontiguousarray(array)
    np.lib.format.write_array_header_2_0(file, np.lib.format.header_data_from_array_1_0(array))
    if array.nbytes:
        file.write(array.reshape(-1).view(np.uint8).data)


def digest(path: Path) -> str:
    """Return the SHA-256 of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
