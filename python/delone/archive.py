"""Triangulations in files: NumPy's .npz archives, checked before they are believed.

An archive holds one array for each name in `_LAYOUT` and the version of this layout. Reading takes
nothing on trust: what zip and array headers claim is compared with the bytes that are there, every
index with what it counts, and the triangles with each other, so that the walks of the core end and
stay inside. What is not checked is whether triangles are Delaunay: ``validate()`` does that.
"""

from __future__ import annotations

import struct
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from delone import predicates
from delone.atomic import replacing
from delone.errors import FileFormatError
from delone.topology import boundary_edges, boundary_next, is_mutual

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from numpy.typing import NDArray

__all__ = ["read", "write"]

_FORMAT = "delone.Delaunay"
_VERSION = 1
# Names of the arrays, their dtypes and numbers of columns.
_LAYOUT: dict[str, tuple[np.dtype[Any], int]] = {
    "points": (np.dtype("<f8"), 2),
    "simplices": (np.dtype("<i4"), 3),
    "neighbors": (np.dtype("<i4"), 3),
    "duplicates": (np.dtype("<i4"), 2),
}


def write(path: str | os.PathLike[str], arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write a triangulation to a file, whole or not at all.

    Parameters
    ----------
    path : str or path-like
        The file; what is there is replaced at the end, in one step.
    arrays : mapping of str to ndarray
        The arrays `points`, `simplices`, `neighbors` and `duplicates`.

    Raises
    ------
    OSError
        The file cannot be written, or is no regular file.
    """
    columns: dict[str, Any] = {name: arrays[name] for name in _LAYOUT}
    with replacing(_path(path)) as beside, beside.open("wb") as file:
        np.savez(file, format=np.array(_FORMAT), version=np.array(_VERSION), **columns)


def read(path: str | os.PathLike[str]) -> dict[str, NDArray[Any]]:
    """Read a triangulation from a file.

    Parameters
    ----------
    path : str or path-like
        A file that `write` made.

    Returns
    -------
    dict of str to ndarray
        What was given to `write`.

    Raises
    ------
    FileFormatError
        The file is torn, of another kind or version, or its arrays contradict each other.
    OSError
        The file cannot be read.
    """
    source = _path(path)
    # Opening a pipe would wait for whoever writes to it.
    if source.exists() and not source.is_file() and not source.is_dir():
        raise OSError(f"{source} is not a regular file")
    with source.open("rb") as file:
        return _parsed(file, source)


def _path(path: str | os.PathLike[str]) -> Path:
    try:
        return Path(path)
    except TypeError:
        kind = type(path).__name__
        raise TypeError(f"path must be a string or a path-like object, got {kind}") from None


def _parsed(file: IO[bytes], path: Path) -> dict[str, NDArray[Any]]:
    try:
        with zipfile.ZipFile(file) as archive:
            _check_kind(archive)
            arrays = {name: _array(archive, name) for name in _LAYOUT}
        _check(**arrays)
    except _DAMAGE as error:
        raise FileFormatError(f"{path}: {_REFUSAL}: {error}") from error
    except _ContradictionError as error:
        raise FileFormatError(f"{path}: {_REFUSAL}: {error}") from None
    return arrays


# What damage makes zipfile raise: OSError where it seeks below zero, RuntimeError for a
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
_REFUSAL = "no delone triangulation, or a torn one"


class _ContradictionError(Exception):
    """What a file says cannot be."""


def _require(condition: bool | np.bool_, message: str) -> None:
    if not condition:
        raise _ContradictionError(message)


def _check_kind(archive: zipfile.ZipFile) -> None:
    found = _scalar(archive, "format")
    _require(found == _FORMAT, f"its format is {found!r}, not {_FORMAT!r}")
    version = _scalar(archive, "version")
    _require(version == _VERSION, f"its version is {version!r}, this release reads {_VERSION}")


def _scalar(archive: zipfile.ZipFile, name: str) -> Any:
    with _member(archive, name) as file:
        shape, dtype = _header(file, name)
        _require(shape == () and dtype.kind in "Ui" and dtype.itemsize <= 256, f"{name} is odd")
        data = file.read(dtype.itemsize)
    _require(len(data) == dtype.itemsize, f"{name} is cut short")
    return np.frombuffer(data, dtype=dtype)[0].item()


def _array(archive: zipfile.ZipFile, name: str) -> Any:
    wanted, columns = _LAYOUT[name]
    with _member(archive, name) as file:
        shape, dtype = _header(file, name)
        _require(dtype == wanted, f"{name} has dtype {dtype}, not {wanted}")
        _require(
            len(shape) == 2 and shape[1] == columns, f"{name} has shape {shape}, not (n, {columns})"
        )
        # Reads what is there, whatever the header claims; zipfile compares the checksum.
        data = file.read()
    claimed = shape[0] * columns * wanted.itemsize
    _require(len(data) == claimed, f"{name} has {len(data)} bytes, its header says {claimed}")
    native = wanted.newbyteorder("=")
    return np.frombuffer(data, dtype=wanted).reshape(shape).astype(native, copy=False)


def _member(archive: zipfile.ZipFile, name: str) -> IO[bytes]:
    try:
        return archive.open(f"{name}.npy")
    except KeyError:
        raise _ContradictionError(f"it has no array {name}") from None


def _header(file: IO[bytes], name: str) -> tuple[tuple[int, ...], np.dtype[Any]]:
    try:
        version = np.lib.format.read_magic(file)
        _require(version == (1, 0), f"{name} is an array file of version {version}")
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(file)
    # NumPy parses the header as Python, so a damaged one raises whatever its parser does.
    except (ValueError, SyntaxError, TypeError, tokenize.TokenError) as error:
        raise _ContradictionError(f"{name}: {error}") from error
    _require(not fortran or len(shape) < 2, f"{name} is in Fortran order")
    return shape, dtype


def _check(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    duplicates: NDArray[np.int32],
) -> None:
    """Check everything that methods rely upon, in linear time."""
    n, m = len(points), len(simplices)
    _require(np.isfinite(points).all(), "a coordinate is not finite")
    _require(m > 0 and neighbors.shape == simplices.shape, "it has no neighbours of triangles")
    _check_range("simplices", simplices, 0, n)
    _check_range("neighbors", neighbors, -1, m)
    _check_range("duplicates", duplicates, 0, n)
    _check_duplicates(points, simplices, duplicates)
    _require(is_mutual(simplices, neighbors).all(), "neighbours are not mutual")
    turns = predicates.orient2d(*(points[simplices[:, k]] for k in range(3)))
    _require((turns > 0).all(), "a triangle is not counter-clockwise")
    boundary = boundary_edges(simplices, neighbors)
    _require(len(boundary) > 0, "it has no boundary")
    cycle = boundary_next(boundary, int(boundary[0, 0]))
    _require(len(cycle) == len(boundary), "the boundary is not one cycle")
    expected = 2 * (n - len(duplicates)) - len(boundary) - 2
    _require(m == expected, f"it has {m} triangles, {expected} are expected")


def _check_range(name: str, indices: NDArray[np.int32], lowest: int, end: int) -> None:
    inside = indices.size == 0 or (indices.min() >= lowest and indices.max() < end)
    _require(inside, f"{name} has an index outside {lowest} to {end - 1}")


def _check_duplicates(
    points: NDArray[np.float64], simplices: NDArray[np.int32], duplicates: NDArray[np.int32]
) -> None:
    row, first = duplicates.T
    _require((row[1:] > row[:-1]).all() and (first < row).all(), "duplicates are out of order")
    _require((points[row] == points[first]).all(), "a duplicate lies elsewhere")
    vertex = np.zeros(len(points), dtype=bool)
    vertex[simplices] = True
    other = np.ones(len(points), dtype=bool)
    other[row] = False
    _require((vertex == other).all(), "vertices and duplicates are not all the points")
