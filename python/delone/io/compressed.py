"""Files as they are, or out of gzip, xz and bzip2; the last suffix tells which."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import zlib
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any

from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["SUFFIXES", "Bounded", "opened", "torn_is_an_error"]

_OPENERS: dict[str, Any] = {".gz": gzip.open, ".xz": lzma.open, ".bz2": bz2.open}
_TORN = (EOFError, gzip.BadGzipFile, lzma.LZMAError, zlib.error)
SUFFIXES = tuple(_OPENERS)
# Tables of numbers become 3 to 20 times smaller, grids of one value 100 times; what a file of a few
# bytes may hold in any case.
_EXPANSION, _ALWAYS = 200, 1 << 26


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


class Bounded(io.RawIOBase):
    """A file of which no more is read than its size makes likely.

    Parameters
    ----------
    file : file object
        What `opened` returns; it is closed with this one.
    path : Path
        The file.
    longest_line : int, optional
        The largest number of bytes without the end of a line.

    Raises
    ------
    FileFormatError
        While it is read: a line is longer, or what a compressed file holds is larger than 64 MiB
        and 200 times as large as the file.
    """

    def __init__(self, file: IO[bytes], path: Path, *, longest_line: int | None = None) -> None:
        self._file, self._path, self._longest_line = file, path, longest_line
        packed = path.suffix.lower() in SUFFIXES
        self._most = max(_ALWAYS, _EXPANSION * path.stat().st_size) if packed else None
        self._read = self._line = 0

    def readable(self) -> bool:
        """Tell that it is for reading."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Read some bytes, and look at how many they are."""
        data = self._file.read(len(buffer))
        buffer[: len(data)] = data
        self._read += len(data)
        if self._most is not None and self._read > self._most:
            raise FileFormatError(
                f"{self._path} is more than {_EXPANSION} times larger when it is decompressed, "
                f"over {self._most:,} bytes; if that is right, decompress it first"
            )
        self._look_at_lines(data)
        return len(data)

    def _look_at_lines(self, data: bytes) -> None:
        end = max(data.rfind(b"\n"), data.rfind(b"\r"))
        self._line = len(data) - 1 - end if end >= 0 else self._line + len(data)
        if self._longest_line is not None and self._line > self._longest_line:
            raise FileFormatError(
                f"{self._path} has a line of more than {self._longest_line:,} bytes: it is no "
                "table of points"
            )

    def close(self) -> None:
        """Close the file, too."""
        self._file.close()
        super().close()


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
