"""Files as they are, or out of gzip, xz and bzip2; the last suffix tells which."""

from __future__ import annotations

import bz2
import gzip
import lzma
import zlib
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any

from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["SUFFIXES", "opened", "torn_is_an_error"]

_OPENERS: dict[str, Any] = {".gz": gzip.open, ".xz": lzma.open, ".bz2": bz2.open}
_TORN = (EOFError, gzip.BadGzipFile, lzma.LZMAError, zlib.error)
SUFFIXES = tuple(_OPENERS)


def opened(path: Path) -> IO[bytes]:
    """Open a file for reading bytes.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    file object
        What it holds, decompressed.
    """
    opener = _OPENERS.get(path.suffix.lower(), open)
    file: IO[bytes] = opener(path, "rb")
    return file


@contextmanager
def torn_is_an_error(source: str) -> Iterator[None]:
    """Take what decompression raises for an error of the file.

    Parameters
    ----------
    source : str
        The file, for the message.

    Raises
    ------
    FileFormatError
        The file is cut short, damaged or not compressed.
    """
    try:
        yield
    except _TORN as error:
        raise FileFormatError(
            f"{source} is torn or not compressed as its name says: {error}"
        ) from error
    except OSError as error:
        if error.errno is not None:
            raise
        # bz2 has no class of its own for a stream that is none.
        raise FileFormatError(f"{source} is not compressed as its name says: {error}") from error
