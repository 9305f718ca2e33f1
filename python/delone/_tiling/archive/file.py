"""Writing and reading .npz files: atomic, without pickles, bounded by the size of the file."""

from __future__ import annotations

import struct
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from delone._base.atomic import replacing
from delone._base.bounded import archived, pieces
from delone._base.files import not_a_path, not_regular
from delone._tiling.archive.checks import ContradictionError, require
from delone._tiling.archive.kinds import KINDS, Kind
from delone.errors import FileFormatError

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from numpy.typing import NDArray

__all__ = ["read", "refusal", "write"]

_VERSION = 1
# Bytes, four for each character: no WKT is as long, nor the heights of 100,000 lakes.
_LONGEST_TEXT = 1 << 24


def write(path: str | os.PathLike[str], arrays: Mapping[str, NDArray[Any]], name: str) -> None:
    """Write the arrays of an object of a class to a file, atomically; texts have shape ()."""
    kind = next(kind for kind in KINDS[name] if kind.fits(arrays))
    texts = {name: arrays[name] for name in kind.texts if name in arrays}
    columns: dict[str, Any] = {name: arrays[name] for name in kind.layout} | texts
    with replacing(_path(path)) as beside, beside.open("wb") as file:
        np.savez(file, format=np.array(kind.format), version=np.array(_VERSION), **columns)


def read(path: str | os.PathLike[str], name: str) -> dict[str, NDArray[Any]]:
    """Read the arrays of an object, as given to `write`; damage raises FileFormatError."""
    source = _path(path)
    # Opening a pipe would block until something writes to it.
    if source.exists() and not source.is_file() and not source.is_dir():
        raise not_regular(source)
    with source.open("rb") as file:
        return _parsed(file, source, KINDS[name])


def _path(path: str | os.PathLike[str]) -> Path:
    try:
        return Path(path)
    except TypeError:
        raise not_a_path(path, "path") from None


def _parsed(file: IO[bytes], path: Path, kinds: tuple[Kind, ...]) -> dict[str, NDArray[Any]]:
    try:
        with archived(path, file) as archive:
            kind = _kind(archive, kinds)
            arrays = {name: _array(archive, name, *kind.layout[name]) for name in kind.layout}
            present = [name for name in kind.texts if f"{name}.npy" in archive.namelist()]
            texts = {name: _scalar(archive, name, _LONGEST_TEXT) for name in present}
        kind.check(**arrays)
    except FileFormatError:
        raise
    except _DAMAGE as error:
        raise refusal(path, error) from error
    except ContradictionError as error:
        raise refusal(path, error) from None
    return arrays | {name: np.array(str(text)) for name, text in texts.items()}


# What zipfile raises for damaged files: OSError where it seeks below zero, RuntimeError for a
# member that claims to be encrypted.
_DAMAGE = (
    zipfile.BadZipFile,
    zlib.error,
    EOFError,
    NotImplementedError,
    RuntimeError,
    OSError,
    ValueError,
    ArithmeticError,
    LookupError,
    struct.error,
)


def refusal(path: str | os.PathLike[str], why: Exception) -> FileFormatError:
    """Return the error to raise for a file whose arrays are wrong."""
    return FileFormatError(
        f"{path}: not a file that `save` wrote for this class, or truncated: {why}"
    )


def _kind(archive: zipfile.ZipFile, kinds: tuple[Kind, ...]) -> Kind:
    found = _scalar(archive, "format")
    fitting = [kind for kind in kinds if kind.format == found]
    wanted = " or ".join(repr(kind.format) for kind in kinds)
    require(bool(fitting), f"its format is {found!r}, not {wanted}")
    version = _scalar(archive, "version")
    require(version == _VERSION, f"its version is {version!r}, this release reads {_VERSION}")
    return fitting[0]


def _scalar(archive: zipfile.ZipFile, name: str, most: int = 256) -> Any:
    with _member(archive, name) as file:
        shape, dtype = _header(file, name)
        require(shape == () and dtype.kind in "Ui" and dtype.itemsize <= most, f"{name} is invalid")
        data = file.read(dtype.itemsize)
    require(len(data) == dtype.itemsize, f"{name} is cut short")
    return np.frombuffer(data, dtype=dtype)[0].item()


def _array(archive: zipfile.ZipFile, name: str, kind: str, columns: int) -> Any:
    wanted = np.dtype(kind)
    with _member(archive, name) as file:
        shape, dtype = _header(file, name)
        require(dtype == wanted, f"{name} has dtype {dtype}, not {wanted}")
        fits = len(shape) == 2 and shape[1] == columns if columns else len(shape) == 1
        axes = f"(n, {columns})" if columns else "(n,)"
        require(fits, f"{name} has shape {shape}, not {axes}")
        claimed = shape[0] * (columns or 1) * wanted.itemsize
        there = archive.getinfo(f"{name}.npy").file_size - file.tell()
        require(there == claimed, f"{name} has {there} bytes, its header says {claimed}")
        # At the end zipfile compares the checksum.
        data = pieces(file, there)
    require(len(data) == claimed, f"{name} is cut short")
    native = wanted.newbyteorder("=")
    return data.view(wanted).reshape(shape).astype(native, copy=False)


def _member(archive: zipfile.ZipFile, name: str) -> IO[bytes]:
    try:
        return archive.open(f"{name}.npy")
    except KeyError:
        raise ContradictionError(f"it has no array {name}") from None


def _header(file: IO[bytes], name: str) -> tuple[tuple[int, ...], np.dtype[Any]]:
    try:
        version = np.lib.format.read_magic(file)
        require(version == (1, 0), f"{name} is an array file of version {version}")
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(file)
    # NumPy parses the header as Python, so a damaged header raises whatever its parser raises.
    except (ValueError, SyntaxError, TypeError, tokenize.TokenError) as error:
        raise ContradictionError(f"{name}: {error}") from error
    require(not fortran or len(shape) < 2, f"{name} is in Fortran order")
    return shape, dtype
