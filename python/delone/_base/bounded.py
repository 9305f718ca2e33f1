"""Bounded reading: how far a compressed file may expand, and NumPy's npz files within that limit.

The sizes in the directory of an archive are compared with the size of the file before anything is
read, and so are the sizes in the headers of arrays before memory is allocated. A directory may lie:
members are read in pieces, and never beyond the size that was compared.
"""

from __future__ import annotations

import zipfile
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["EXPANSION", "archived", "header", "largest", "pieces", "read_array", "require_claim"]

# Tables of numbers compress by a factor of 3 to 20, and constant grids by 100. The second limit is
# what a file of a few bytes may contain in any case.
EXPANSION, _ALWAYS = 200, 1 << 26
# Text takes a hundred times longer to parse than to decompress: for it the second limit is lower.
_ALWAYS_TEXT = 1 << 23
# The methods that NumPy uses. With others, Python decompresses a piece without a limit.
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_PIECE = 1 << 20


def largest(size: int, *, text: bool = False) -> int:
    """Return the number of bytes to which a compressed file of a size may expand."""
    return max(_ALWAYS_TEXT if text else _ALWAYS, EXPANSION * size)


@contextmanager
def archived(path: Path, file: IO[bytes] | None = None) -> Iterator[zipfile.ZipFile]:
    """Open a zip archive, or an open file, if its expansion is limited."""
    with zipfile.ZipFile(file or path) as archive:
        entries = archive.infolist()
        most = largest(path.stat().st_size)
        if sum(entry.file_size for entry in entries) > most:
            raise FileFormatError(
                f"{path} is more than {EXPANSION} times larger when decompressed, over {most:,} "
                "bytes; if this is expected, write it without compression (numpy.savez)"
            )
        for entry in entries:
            if entry.compress_type not in _METHODS:
                raise FileFormatError(f"{path}: {entry.filename!r:.80} is not stored or deflated")
        yield archive


def pieces(file: IO[bytes], size: int) -> NDArray[np.uint8]:
    """Return the next bytes of a file, `size` or fewer, never decompressing many more at a time."""
    data = np.empty(size, dtype=np.uint8)
    done = 0
    while done < size and (piece := file.read(min(_PIECE, size - done))):
        data[done : done + len(piece)] = np.frombuffer(piece, dtype=np.uint8)
        done += len(piece)
    return data[:done]


def read_array(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, what: str) -> NDArray[Any]:
    """Read one array, after comparing its header with the size of the member."""
    with archive.open(entry) as file:
        require_claim(file, entry.file_size, what)
    with archive.open(entry) as file:
        # NumPy reads pieces of 256 KiB.
        array: NDArray[Any] = np.lib.format.read_array(file, allow_pickle=False)
    return array


def require_claim(file: IO[bytes], size: int, what: str) -> None:
    """Compare the shape in a header with the number of bytes that follow."""
    shape, dtype = header(file)
    claimed, there = dtype.itemsize, size - file.tell()
    for length in shape:  # Python's integers do not overflow
        claimed *= length
    if not 0 <= claimed <= there:
        raise FileFormatError(
            f"{what} declares shape {shape}, {claimed} bytes, and contains {there}: it is truncated"
        )
    # Pickled objects have other sizes; they are rejected later, by name.
    if claimed < there and not dtype.hasobject:
        raise FileFormatError(
            f"{what} declares shape {shape}, {claimed} bytes, and {there - claimed} more follow: "
            "one array is read, and nothing is silently dropped"
        )


def header(file: IO[bytes]) -> tuple[tuple[int, ...], np.dtype[Any]]:
    """Read the header of an array: its shape and dtype."""
    version = np.lib.format.read_magic(file)
    # Version 3 differs from 2 in the encoding of field names only.
    read = (
        np.lib.format.read_array_header_1_0
        if version == (1, 0)
        else np.lib.format.read_array_header_2_0
    )
    shape, _, dtype = read(file)
    return shape, dtype
