"""Files of a run: each appears whole or not at all, and a note tells which task is done.

Every change of the file system is one step of `Store`; between any two of them a run may end, by
whatever cause, and another one goes on from there. Data come first, the note of a task last.
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

from delone.atomic import FULL
from delone.errors import FileFormatError, OutputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

__all__ = ["Store", "digest", "step"]


def step(what: str) -> None:
    """Stand between two changes of the file system; tests stop a run here."""


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Say of a full disk what to do about it."""
    try:
        yield
    except OSError as error:
        if error.errno not in FULL:
            raise
        raise OutputError(
            error.errno,
            "the disk is full; make room and run the same again: it goes on where it stopped",
            str(path),
        ) from error


@contextmanager
def _torn_is_an_error(path: Path) -> Iterator[None]:
    """Call an array that cannot be read a fault of its file."""
    try:
        yield
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise FileFormatError(
            f"{path} is torn: {error}; remove the folder of the output and begin again"
        ) from error


class Store:
    """A folder of files that are written at once.

    Parameters
    ----------
    root : str or path-like
        The folder.
    """

    def __init__(self, root: str | os.PathLike[str]) -> None:
        self.root = Path(root)

    def path(self, name: str) -> Path:
        """Return the path of a file."""
        return self.root / name

    def exists(self, name: str) -> bool:
        """Tell whether a file is there."""
        return self.path(name).exists()

    @contextmanager
    def writing(self, name: str) -> Iterator[Path]:
        """Give a temporary name beside a file, which becomes the file at the end."""
        target = self.path(name)
        with _explained(target):
            step(f"before the folder of {name}")
            target.parent.mkdir(parents=True, exist_ok=True)
            step(f"before {name}")
            # No look at the folder, which may have a million files.
            beside = target.with_name(f".{target.stem}-{secrets.token_hex(6)}{target.suffix}")
            try:
                yield beside
                step(f"before the renaming of {name}")
                os.replace(beside, target)
            finally:
                beside.unlink(missing_ok=True)
            step(f"after {name}")

    def save(self, name: str, array: NDArray[Any]) -> None:
        """Write one array."""
        with self.writing(name) as beside, beside.open("wb") as file:
            _write_array(file, array)

    def load(self, name: str, *, mapped: bool = False) -> NDArray[Any]:
        """Read one array, or map it."""
        with _torn_is_an_error(self.path(name)):
            array: NDArray[Any] = np.load(self.path(name), mmap_mode="r" if mapped else None)
        return array

    def save_all(self, name: str, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write arrays by name."""
        with self.writing(name) as beside, beside.open("wb") as file:
            np.savez(file, allow_pickle=False, **arrays)

    def load_all(self, name: str, *wanted: str) -> dict[str, NDArray[Any]]:
        """Read arrays by name: some, or all."""
        with _torn_is_an_error(self.path(name)), np.load(self.path(name)) as found:
            return {key: found[key] for key in wanted or found.files}

    def note(self, name: str, content: Mapping[str, Any]) -> None:
        """Write what JSON can say."""
        with self.writing(name) as beside:
            beside.write_text(json.dumps(content, indent=1), encoding="utf-8")

    def noted(self, name: str) -> Any:
        """Read a note; None where there is none."""
        try:
            found = json.loads(self.path(name).read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except (ValueError, RecursionError) as error:
            raise FileFormatError(f"{self.path(name)} is torn: {error}") from error
        if found is None:
            raise FileFormatError(f"{self.path(name)} is torn: it says null")
        return found

    def sweep(self, pattern: str) -> None:
        """Remove what killed processes have left beside files."""
        step(f"before the sweep of {pattern}")
        for left in self.root.glob(pattern):
            left.unlink(missing_ok=True)

    def remove(self, name: str) -> None:
        """Remove a folder with all that is in it, if it is there."""
        step(f"before the removal of {name}")
        if self.exists(name):
            shutil.rmtree(self.path(name))
        step(f"after the removal of {name}")


def _write_array(file: Any, array: NDArray[Any]) -> None:
    """Write an array as npy by plain writes, whose errors say what is wrong."""
    array = np.ascontiguousarray(array)
    np.lib.format.write_array_header_2_0(file, np.lib.format.header_data_from_array_1_0(array))
    if array.nbytes:
        file.write(array.reshape(-1).view(np.uint8).data)


def digest(path: Path) -> str:
    """Return the SHA-256 of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
