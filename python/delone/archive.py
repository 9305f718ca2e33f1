"""Saving and loading: triangulations in NumPy's .npz archives, checked when they are read.

An archive holds one array for each name in the layout of its kind, and the version of the layouts.
Reading takes nothing on trust: what zip and array headers claim is compared with the bytes that are
there, every index with what it counts, and the triangles with each other, so that the walks of the
core end and stay inside. What is not checked is whether triangles are Delaunay: ``validate()`` does
that.
"""

from __future__ import annotations

import struct
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._arrays import as_workers
from delone.atomic import replacing
from delone.errors import FileFormatError
from delone.plane.topology import among, boundary_edges, boundary_next, edge_keys
from delone.space import topology as space

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

__all__ = ["CONSTRAINED", "DELAUNAY", "DELAUNAY3", "MESH", "Kind", "read", "write"]

_VERSION = 1
# Bytes, four for each character: no WKT is as long.
_LONGEST_CRS = 1 << 18


class Kind(NamedTuple):
    """A kind of archive."""

    format: str
    # Names of the arrays, their dtypes and numbers of columns; 0 for arrays of one axis.
    layout: Mapping[str, tuple[str, int]]
    check: Callable[..., None]


def write(
    path: str | os.PathLike[str],
    arrays: Mapping[str, NDArray[Any]],
    kind: Kind | None = None,
    *,
    crs: str | None = None,
) -> None:
    """Write a triangulation to a file, whole or not at all.

    Parameters
    ----------
    path : str or path-like
        The file; what is there is replaced at the end, in one step.
    arrays : mapping of str to ndarray
        The arrays of the layout.
    kind : Kind, optional
        The kind of archive, by default `DELAUNAY`.
    crs : str, optional
        The reference system of the coordinates.

    Raises
    ------
    OSError
        The file cannot be written, or is no regular file.
    """
    kind = kind or DELAUNAY
    columns: dict[str, Any] = {name: arrays[name] for name in kind.layout}
    if crs is not None:
        columns["crs"] = np.array(crs)
    with replacing(_path(path)) as beside, beside.open("wb") as file:
        np.savez(file, format=np.array(kind.format), version=np.array(_VERSION), **columns)


def read(
    path: str | os.PathLike[str], kinds: Kind | Sequence[Kind] = ()
) -> dict[str, NDArray[Any]]:
    """Read a triangulation from a file.

    Parameters
    ----------
    path : str or path-like
        A file that `write` made.
    kinds : Kind or sequence of Kind, optional
        The kinds of archives that are welcome, by default `DELAUNAY`.

    Returns
    -------
    dict of str to ndarray
        What was given to `write`; where a constrained triangulation has a reference
        system, it as ``crs``.

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
        wanted = (kinds,) if isinstance(kinds, Kind) else tuple(kinds)
        return _parsed(file, source, wanted or (DELAUNAY,))


def _path(path: str | os.PathLike[str]) -> Path:
    try:
        return Path(path)
    except TypeError:
        kind = type(path).__name__
        raise TypeError(f"path must be a string or a path-like object, got {kind}") from None


def _parsed(file: IO[bytes], path: Path, kinds: tuple[Kind, ...]) -> dict[str, NDArray[Any]]:
    try:
        with zipfile.ZipFile(file) as archive:
            kind = _kind(archive, kinds)
            arrays = {name: _array(archive, name, *kind.layout[name]) for name in kind.layout}
            known = kind is CONSTRAINED and "crs.npy" in archive.namelist()
            crs = _scalar(archive, "crs", _LONGEST_CRS) if known else None
        kind.check(**arrays)
    except _DAMAGE as error:
        raise FileFormatError(f"{path}: {_REFUSAL}: {error}") from error
    except _ContradictionError as error:
        raise FileFormatError(f"{path}: {_REFUSAL}: {error}") from None
    return arrays if crs is None else arrays | {"crs": np.array(str(crs))}


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


def _kind(archive: zipfile.ZipFile, kinds: tuple[Kind, ...]) -> Kind:
    found = _scalar(archive, "format")
    fitting = [kind for kind in kinds if kind.format == found]
    wanted = " or ".join(repr(kind.format) for kind in kinds)
    _require(bool(fitting), f"its format is {found!r}, not {wanted}")
    version = _scalar(archive, "version")
    _require(version == _VERSION, f"its version is {version!r}, this release reads {_VERSION}")
    return fitting[0]


def _scalar(archive: zipfile.ZipFile, name: str, most: int = 256) -> Any:
    with _member(archive, name) as file:
        shape, dtype = _header(file, name)
        _require(shape == () and dtype.kind in "Ui" and dtype.itemsize <= most, f"{name} is odd")
        data = file.read(dtype.itemsize)
    _require(len(data) == dtype.itemsize, f"{name} is cut short")
    return np.frombuffer(data, dtype=dtype)[0].item()


def _array(archive: zipfile.ZipFile, name: str, kind: str, columns: int) -> Any:
    wanted = np.dtype(kind)
    with _member(archive, name) as file:
        shape, dtype = _header(file, name)
        _require(dtype == wanted, f"{name} has dtype {dtype}, not {wanted}")
        fits = len(shape) == 2 and shape[1] == columns if columns else len(shape) == 1
        axes = f"(n, {columns})" if columns else "(n,)"
        _require(fits, f"{name} has shape {shape}, not {axes}")
        # Reads what is there, whatever the header claims; zipfile compares the checksum.
        data = file.read()
    claimed = shape[0] * (columns or 1) * wanted.itemsize
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
    _check_sound(points, simplices, neighbors)
    boundary = boundary_edges(simplices, neighbors)
    _require(len(boundary) > 0, "it has no boundary")
    cycle = boundary_next(boundary, int(boundary[0, 0]))
    _require(len(cycle) == len(boundary), "the boundary is not one cycle")
    expected = 2 * (n - len(duplicates)) - len(boundary) - 2
    _require(m == expected, f"it has {m} triangles, {expected} are expected")


def _check_space(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    duplicates: NDArray[np.int32],
) -> None:
    """The same for tetrahedra."""
    n, m = len(points), len(simplices)
    _require(np.isfinite(points).all(), "a coordinate is not finite")
    _require(m > 0 and neighbors.shape == simplices.shape, "it has no neighbours of tetrahedra")
    _check_range("simplices", simplices, 0, n)
    _check_range("neighbors", neighbors, -1, m)
    _check_range("duplicates", duplicates, 0, n)
    _check_duplicates(points, simplices, duplicates)
    _check_sound(points, simplices, neighbors)
    boundary = space.boundary_faces(simplices, neighbors)
    _require(len(boundary) > 3, "it has no boundary")
    # Each edge of a closed surface is there once in either direction.
    tail, head = boundary.ravel().astype(np.int64), boundary[:, [1, 2, 0]].ravel().astype(np.int64)
    keys, reverse = np.sort(tail * n + head), np.sort(head * n + tail)
    closed = (keys == reverse).all() and (keys[1:] > keys[:-1]).all()
    _require(closed, "the boundary is not one closed surface")


def _check_sound(
    points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
) -> None:
    """Check that neighbors are mutual and simplices positively oriented; their range is known."""
    flat = points.shape[1] == 2
    check = _core.fault2 if flat else _core.fault3
    fault = check(points, simplices, neighbors, as_workers(None))
    if fault is None:
        return
    kind, row = fault
    turn = "is not counter-clockwise" if flat else "is not positively oriented"
    wrong = "has neighbors that are not mutual" if kind == "neighbors" else turn
    raise _ContradictionError(f"{'triangle' if flat else 'tetrahedron'} {row} {wrong}")


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


def _check_constrained(**arrays: NDArray[Any]) -> None:
    """Check the triangles as those of `Delaunay`, and that segments fit them."""
    triangles = {name: arrays[name] for name in DELAUNAY.layout}
    _check(**triangles)
    _check_options(arrays["options"])
    points, constrained = arrays["points"], arrays["constrained"]
    n, m = len(points), len(arrays["simplices"])
    _require(constrained.shape == (m, 3), "it has no flags of edges")
    ninput = n - len(arrays["added"])
    _require(
        ninput > 0 and (arrays["added"] == points[ninput:]).all(), "added points lie elsewhere"
    )
    _check_range("input", arrays["input"], 0, ninput)
    _check_range("segments", arrays["segments"], 0, n)
    _check_flags(arrays)
    _check_sources(arrays)
    rows = len(arrays["input"])
    for name, indices, end in (
        ("zero", arrays["zero"], rows),
        ("through", arrays["through"][:, 0], rows),
        ("through", arrays["through"][:, 1], n),
        ("crossings", arrays["crossings"][:, :2], rows),
        ("crossings", arrays["crossings"][:, 2], n),
    ):
        _check_range(name, indices, 0, end)
    seeds = np.concatenate((arrays["holes"], arrays["regions"]))
    _require(np.isfinite(seeds).all(), "a seed is not finite")
    geometries, rings, parts = (arrays[name] for name in ("geometries", "rings", "parts"))
    matched = len(geometries) == len(rings) == len(parts) == rows
    _require(matched, "geometries and segments do not match")
    _require((geometries[rings] >= 0).all(), "the side of a ring has no geometry")
    _check_range("parts", parts, -1, 2**31 - 1)
    _require(len(arrays["regions"]) == len(arrays["labels"]), "seeds and labels do not match")


def _check_options(options: NDArray[np.int64]) -> None:
    _require(
        len(options) == 5 and (options[:4] >= 0).all() and (options[:4] <= (2, 1, 1, 1)).all(),
        "its options are odd",
    )
    _require(0 <= options[4] < 2**31, "its options are odd")


def _check_flags(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Check that the flagged edges are the subsegments, each once."""
    simplices, segments, n = arrays["simplices"], arrays["segments"], len(arrays["points"])
    edges = edge_keys(simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]], n)
    keys = np.sort(edge_keys(segments[:, 0], segments[:, 1], n))
    _require((keys[1:] > keys[:-1]).all(), "a subsegment is there twice")
    _require((among(edges, keys) == arrays["constrained"]).all(), "flags of edges are wrong")
    _require(among(keys, edges.ravel()).all(), "a subsegment is no edge")


def _check_sources(arrays: Mapping[str, NDArray[Any]]) -> None:
    start, source = arrays["source_start"], arrays["source"]
    _require(
        len(start) == len(arrays["segments"]) + 1 and start[0] == 0 and start[-1] == len(source),
        "sources of segments are out of range",
    )
    _require((np.diff(start) > 0).all(), "a segment has no source")
    _require(len(arrays["forward"]) == len(source), "directions of segments are out of range")
    _check_range("source", source, 0, len(arrays["input"]))


def _check_mesh(**arrays: NDArray[Any]) -> None:
    """Check triangles that need not fill a hull, and lines under their edges."""
    points, simplices, neighbors = arrays["points"], arrays["simplices"], arrays["neighbors"]
    n, m, lines = len(points), len(simplices), len(arrays["ends"])
    _require(np.isfinite(points).all(), "a coordinate is not finite")
    _require(m > 0 and neighbors.shape == simplices.shape, "it has no neighbours of triangles")
    _require(arrays["sides"].shape == simplices.shape, "it has no sides of triangles")
    for name, indices, least, end in (
        ("simplices", simplices, 0, n),
        ("neighbors", neighbors, -1, m),
        ("sides", arrays["sides"], -1, lines),
        ("on", arrays["on"], -1, lines),
        ("ends", arrays["ends"], 0, n),
        ("point_source", arrays["point_source"], -1, 2**31),
        ("source", arrays["source"], 0, 2**31),
        ("counts", arrays["counts"], 0, 2**63),
    ):
        _check_range(name, indices, least, end)
    for wanted, names in (
        (m, ("region",)),
        (n, ("on", "point_source", "point_markers")),
        (lines, ("frozen", "line_markers", "line_geometries")),
        (len(arrays["source"]), ("forward",)),
        (lines + 1, ("start",)),
        (4, ("counts",)),
        (1, ("bound",)),
        (0, ("duplicates",)),
    ):
        for name in names:
            _require(len(arrays[name]) == wanted, f"{name} has not {wanted} entries")
    start = arrays["start"]
    _require(start[0] == 0 and start[-1] == len(arrays["source"]), "sources are out of range")
    _require((np.diff(start) >= 0).all(), "sources are out of order")
    _require((arrays["bound"] >= 0).all() and (arrays["bound"] < 60).all(), "its bound is odd")
    vertex = np.zeros(n, dtype=bool)
    vertex[simplices] = True
    _require(vertex.all(), "a point is no vertex")
    _check_sides(arrays)


def _check_sides(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Check that triangles are mutual and agree on the lines and regions between them."""
    points, simplices, neighbors = arrays["points"], arrays["simplices"], arrays["neighbors"]
    sides, region = arrays["sides"], arrays["region"]
    _check_sound(points, simplices, neighbors)
    inner = neighbors >= 0
    _require((sides[~inner] >= 0).all(), "the boundary has an edge on no line")
    t, k = np.nonzero(inner)
    across = neighbors[t, k]
    back = (neighbors[across] == t[:, None]) & (
        simplices[across] != simplices[t, (k + 1) % 3][:, None]
    ) & (simplices[across] != simplices[t, (k + 2) % 3][:, None])  # fmt: skip
    other = sides[across, back.argmax(axis=1)]
    _require((other == sides[t, k]).all(), "two triangles do not agree on the line between")
    same = (region[across] == region[t]) | (other >= 0)
    _require(same.all(), "a region ends where no line is")


_TRIANGLES = {
    "points": ("<f8", 2),
    "simplices": ("<i4", 3),
    "neighbors": ("<i4", 3),
    "duplicates": ("<i4", 2),
}
_TETRAHEDRA = {
    "points": ("<f8", 3),
    "simplices": ("<i4", 4),
    "neighbors": ("<i4", 4),
    "duplicates": ("<i4", 2),
}
DELAUNAY = Kind("delone.Delaunay", _TRIANGLES, _check)
DELAUNAY3 = Kind("delone.Delaunay of space", _TETRAHEDRA, _check_space)
CONSTRAINED = Kind(
    "delone.ConstrainedDelaunay",
    _TRIANGLES
    | {
        "constrained": ("|b1", 3),
        "added": ("<f8", 2),
        "segments": ("<i4", 2),
        "source_start": ("<i8", 0),
        "source": ("<i4", 0),
        "forward": ("|b1", 0),
        "zero": ("<i4", 0),
        "through": ("<i4", 2),
        "crossings": ("<i4", 3),
        "input": ("<i4", 2),
        "geometries": ("<i4", 0),
        "rings": ("|b1", 0),
        "parts": ("<i4", 0),
        "holes": ("<f8", 2),
        "regions": ("<f8", 2),
        "labels": ("<i4", 0),
        "options": ("<i8", 0),
    },
    _check_constrained,
)
MESH = Kind(
    "delone.Mesh",
    _TRIANGLES
    | {
        "region": ("<i4", 0),
        "sides": ("<i4", 3),
        "on": ("<i4", 0),
        "point_source": ("<i4", 0),
        "point_markers": ("<i4", 0),
        "ends": ("<i4", 2),
        "start": ("<i8", 0),
        "source": ("<i4", 0),
        "forward": ("|b1", 0),
        "frozen": ("|b1", 0),
        "line_markers": ("<i4", 0),
        "line_geometries": ("<i4", 0),
        "bound": ("<f8", 0),
        "counts": ("<i8", 0),
    },
    _check_mesh,
)
