"""Plain files, and files compressed with gzip, xz or bzip2, by the last suffix."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import zlib
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any

from delone._base.bounded import EXPANSION, largest
from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["SUFFIXES", "Bounded", "corrupt_is_an_error", "opened", "require_expansion"]

_OPENERS: dict[str, Any] = {".gz": gzip.open, ".xz": lzma.open, ".bz2": bz2.open}
_TORN = (EOFError, gzip.BadGzipFile, lzma.LZMAError, zlib.error)
SUFFIXES = tuple(_OPENERS)
_PIECE = 1 << 20


def opened(path: Path) -> IO[bytes]:
    """Open a file for reading bytes, decompressed."""
    opener = _OPENERS.get(path.suffix.lower(), open)
    file: IO[bytes] = opener(path, "rb")
    return file


class Bounded(io.RawIOBase):
    """A file, closed with this one, that raises if it contains far more than its size suggests.

    That is, a line of more than `longest_line` bytes or, in a compressed file, more than 8 MiB and
    more than 200 times its size.
    """

    def __init__(self, file: IO[bytes], path: Path, *, longest_line: int | None = None) -> None:
        self._file, self._path, self._longest_line = file, path, longest_line
        packed = path.suffix.lower() in SUFFIXES
        self._most = largest(path.stat().st_size, text=True) if packed else None
        self._read = self._line = 0

    def readable(self) -> bool:
        """Return True."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Read some bytes and check the limits."""
        data = self._file.read(len(buffer))
        buffer[: len(data)] = data
        self._read += len(data)
        if self._most is not None and self._read > self._most:
            raise FileFormatError(
                f"{self._path} is more than {EXPANSION} times larger when decompressed, "
                f"over {self._most:,} bytes; if this is expected, decompress it first"
            )
        self._look_at_lines(data)
        return len(data)

    def _look_at_lines(self, data: bytes) -> None:
        end = max(data.rfind(b"\n"), data.rfind(b"\r"))
        self._line = len(data) - 1 - end if end >= 0 else self._line + len(data)
        if self._longest_line is not None and self._line > self._longest_line:
            raise FileFormatError(
                f"{self._path} has a line of more than {self._longest_line:,} bytes: it is not "
                "a table of points"
            )

    def close(self) -> None:
        """Close the underlying file as well."""
        self._file.close()
        super().close()


def require_expansion(path: Path) -> None:
    """Reject a compressed file that contains far more than its size suggests.

    All of it is decompressed, but not parsed, because parsing takes a hundred times longer.
    """
    if path.suffix.lower() in SUFFIXES:
        with Bounded(opened(path), path) as file:
            buffer = bytearray(_PIECE)
            # Terminates at the end of the file, or with an error at the limit.
            while file.readinto(buffer):
                pass


@contextmanager
def corrupt_is_an_error(source: str) -> Iterator[None]:
    """Convert decompression errors to `FileFormatError`."""
    try:
        yield
    except _TORN as error:
        raise FileFormatError(
            f"{source} is truncated or not compressed as its name says: {error}"
        ) from error
    except OSError as error:
        if error.errno is not None:
            raise
        # bz2 raises a plain OSError for a stream that is not bzip2.
        raise FileFormatError(f"{source} is not compressed as its name says: {error}") from error
