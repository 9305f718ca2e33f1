"""Points and triangles in NumPy files, npy and npz.

A header is trusted only if the bytes that it declares exist: its shape is compared with the size of
the file or of the archive member, and that with the size of the archive. Pickled objects are never
loaded.
"""

from __future__ import annotations

import tokenize
import zipfile
import zlib
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_points, as_simplices
from delone._base.bounded import archived, read_array, require_claim
from delone._base.files import unread
from delone._base.values import as_values
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import FileFormatError, InputError
from delone.io.heights import split_attributes
from delone.io.meshfile import MeshFile
from delone.io.numbered import as_markers
from delone.io.pointset import PointSet, choose_columns, find_column
from delone.regular import RegularTriangulation

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from delone.exchange.parts import HasParts
    from delone.io.content import Wanted

__all__ = ["is_constrained", "read_mesh", "read_points", "write_mesh"]

# Why a file of this class is not read as a mesh.
_WITHOUT = {
    "delone.PeriodicDelaunay": (
        "is a PeriodicDelaunay: its triangles continue across the periods, so points and rows of "
        "them do not describe them; read it with PeriodicDelaunay.load"
    ),
    "delone.ConvexHull": (
        "is a ConvexHull: it has a surface, not triangles of a triangulation; read it with "
        "ConvexHull.load"
    ),
    "delone.Voronoi": "is a Voronoi: it has cells, not triangles; read it with Voronoi.load",
}


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    layer: str | None,
    everything: bool = False,
) -> PointSet:
    """Read points from an npy or npz file; see `delone.io.read_points`."""
    source = str(path)
    wanted = None if everything else attributes
    with _corrupt_is_an_error(source):
        if path.suffix.lower() == ".npy":
            if layer is not None:
                raise FileFormatError(f"{source}: an npy file has one array and no layers")
            with path.open("rb") as file:
                require_claim(file, path.stat().st_size, source)
            return _from_table(np.load(path, mmap_mode="r"), columns, wanted, source)
        with archived(path) as archive:
            return _from_archive(archive, columns, wanted, layer, source)


def read_mesh(path: Path) -> MeshFile:
    """Read triangles from an npz file; see `delone.io.read_mesh`."""
    source = str(path)
    if is_constrained(path):
        return _kept(path)
    with _corrupt_is_an_error(source), archived(path) as archive:
        names = _names(archive)
        if not {"points", "simplices"} <= names:
            return _computed(archive, path)
        points = as_points(_member(archive, "points"), name="points")
        simplices = as_simplices(_member(archive, "simplices"), len(points), points.shape[1])
        neighbors = _member(archive, "neighbors") if "neighbors" in names else None
        z = _member(archive, "z") if "z" in names else None
        region = faces = face_markers = None
        solid = points.shape[1] == 3
        if solid and "region" in names:
            region = _numbers(archive, "region", len(simplices))
        if solid and "input_faces" in names:
            faces = as_simplices(_member(archive, "input_faces"), len(points), 2)
            if "face_markers" in names:
                face_markers = _numbers(archive, "face_markers", len(faces))
    return MeshFile(
        points=points,
        simplices=simplices,
        neighbors=neighbors,
        z=z,
        source=source,
        region=region,
        faces=faces,
        face_markers=face_markers,
    )


def _numbers(archive: zipfile.ZipFile, name: str, count: int) -> NDArray[np.int32]:
    """Read one number for each of `count` cells."""
    values = _member(archive, name)
    if values.shape != (count,) or values.dtype.kind not in "iu":
        raise FileFormatError(
            f"{archive.filename}: array {name!r:.20} has {values.dtype!s:.20} of shape "
            f"{values.shape!s:.40}, not {count} integers"
        )
    return as_markers(values.astype(np.float64)[:, None], Path(str(archive.filename)), name).ravel()


def _computed(archive: zipfile.ZipFile, path: Path) -> MeshFile:
    """Read the triangles of a class whose file contains only its input."""
    names = _names(archive)
    # As in "delone.ConvexHull 3-D".
    kind = str(_member(archive, "format")).split()[0] if "format" in names else ""
    if kind != "delone.RegularTriangulation":
        why = _WITHOUT.get(kind, "contains no triangles (arrays points and simplices)")
        raise FileFormatError(f"{path} {why}")
    mesh = RegularTriangulation.load(path)
    z = _member(archive, "z") if "z" in names else None
    return MeshFile(
        points=mesh.points,
        simplices=mesh.simplices,
        neighbors=mesh.neighbors,
        z=as_values(z, mesh.npoints),
        source=str(path),
    )


def is_constrained(path: Path) -> bool:
    """Return whether a file was written by `ConstrainedDelaunay.save`."""
    if path.suffix.lower() != ".npz":
        return False
    with _corrupt_is_an_error(str(path)), archived(path) as archive:
        return {"points", "simplices", "constrained"} <= _names(archive)


def _kept(path: Path) -> MeshFile:
    """Read a constrained triangulation without the triangles that have been removed."""
    mesh = ConstrainedDelaunay.load(path)
    with _corrupt_is_an_error(str(path)), archived(path) as archive:
        z = _member(archive, "z") if "z" in _names(archive) else None
    return MeshFile(
        points=mesh.points,
        simplices=mesh.simplices,
        neighbors=mesh.neighbors,
        z=as_values(z, mesh.npoints),
        source=str(path),
    )


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write a triangulation, with heights, to an npz file."""
    if wanted.edges:
        raise FileFormatError(
            f"{path.suffix} files contain the whole triangulation; edges cannot be written alone"
        )
    crs = wanted.crs
    heights = as_values(wanted.z, triangulation.npoints)
    further = {name: np.asarray(values) for name, values in (wanted.attributes or {}).items()}
    split_attributes(further, triangulation.npoints, triangulation.nsimplex)
    own: set[str] = set()
    saved: Any = triangulation
    if hasattr(saved, "_with_crs"):
        # It has its own writer.
        saved, crs, own = saved._with_crs(crs), None, {"crs"}
    saved.save(path)
    if heights is not None:
        further["z"] = heights
    if crs is not None:
        further["crs"] = np.array(crs)
    with zipfile.ZipFile(path, "a") as archive:
        taken = (_names(archive) | own) & set(further)
        if taken:
            raise FileFormatError(
                f"{taken.pop()!r:.80} is the name of an array of the file; rename the attribute"
            )
        for name, array in further.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                np.lib.format.write_array(member, array, allow_pickle=False)


@contextmanager
def _corrupt_is_an_error(source: str) -> Iterator[None]:
    try:
        yield
    except (FileFormatError, FileNotFoundError, PermissionError):
        raise
    except InputError as error:
        raise FileFormatError(f"{source}: {error}") from error
    except MemoryError as error:
        # Sizes in headers have already been compared with the file.
        reason = str(error) or "allocation failed"
        raise MemoryError(f"{source} needs more memory than is available: {reason}") from error
    # Python's own parser reads NumPy's headers and raises its own errors; sizes beyond the limit of
    # a memory map overflow; an encrypted member raises RuntimeError.
    except (
        ValueError, OverflowError, EOFError, OSError, SyntaxError, TypeError, RuntimeError,
        KeyError, tokenize.TokenError, zipfile.BadZipFile, zlib.error,
    ) as error:  # fmt: skip
        reason = str(error).partition("\n")[0]
        if "allow_pickle" in reason or "Python objects" in reason:
            reason = "it contains Python objects, which are not loaded"
        raise unread(source, "NumPy", reason) from error


def _from_table(
    table: NDArray[Any],
    columns: Sequence[str | int] | None,
    attributes: Sequence[str] | None,
    source: str,
) -> PointSet:
    """Extract points from one array: (n, 2 or more), or records with named fields.

    By default all other columns are attributes.
    """
    named = table.dtype.names
    if named is None and (table.ndim != 2 or table.shape[1] < 2):
        raise FileFormatError(
            f"{source} contains an array of shape {table.shape}, not (n, 2) or more"
        )
    if named is not None and table.ndim != 1:
        raise FileFormatError(f"{source} contains records of shape {table.shape}, not (n,)")
    names = list(named or map(str, range(table.shape[1])))
    chosen = choose_columns(names, columns, source, named=named is not None)

    def column(i: int) -> NDArray[Any]:
        return table[names[i]] if named else table[:, i]

    for i in chosen:
        if column(i).ndim != 1:
            shape = column(i).shape[1:]
            raise FileFormatError(
                f"{source}: {names[i]!r:.80} has shape {shape} in each row, not one number"
            )

    # In the default case, one slice avoids reading the rows of a wide table twice.
    plain = named is None and chosen[:2] == [0, 1]
    xy = table[:, :2] if plain else np.column_stack([column(i) for i in chosen[:2]])
    z = as_values(column(chosen[2]), len(table)) if len(chosen) == 3 else None
    if attributes is None:
        attributes = [name for i, name in enumerate(names) if i not in chosen]
    further = {name: np.array(column(find_column(names, name, source))) for name in attributes}
    # Points are copied, as a mapped file may be replaced while they are in use.
    points = np.array(as_points(xy, ndim=2), subok=False)
    called = tuple(named[i] for i in chosen) if named else ()
    return PointSet(points=points, z=z, attributes=further, source=source, columns=called)


def _from_archive(
    archive: zipfile.ZipFile,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str] | None,
    layer: str | None,
    source: str,
) -> PointSet:
    names = _names(archive)
    if layer is not None or "points" in names:
        wanted = layer if layer is not None else "points"
        if wanted not in names:
            raise _no_array(archive, wanted)
        others = attributes if attributes is None else ()
        survey = _from_table(_member(archive, wanted), columns, others, source)
        z = survey.z
        if z is None and "z" in names and columns is None and layer is None:
            z = as_values(_member(archive, "z"), len(survey))
        further = dict(survey.attributes)
        if attributes is None:
            further |= _as_long(archive, len(survey), without=(wanted, "z"))
        further |= {name: _member(archive, name) for name in attributes or ()}
        crs = _member(archive, "crs") if "crs" in names else None
        return PointSet(
            points=survey.points,
            z=z,
            attributes=further,
            crs=str(crs) if crs is not None and crs.dtype.kind == "U" else None,
            source=source,
            columns=survey.columns,
        )
    ordered = _ordered_names(archive)
    if len(ordered) == 1:
        return _from_table(_member(archive, ordered[0]), columns, attributes, source)
    chosen = choose_columns(ordered, columns, source, named=True)
    members = [_member(archive, ordered[i]) for i in chosen]
    if len({array.shape for array in members}) != 1:
        raise FileFormatError(f"{source}: the arrays of coordinates have different shapes")
    arrays = [array.reshape(-1) for array in members]
    further = {name: _member(archive, name) for name in attributes or ()}
    if attributes is None:
        further = _as_long(archive, len(arrays[0]), without=[ordered[i] for i in chosen])
    return PointSet(
        points=as_points(np.column_stack(arrays[:2])),
        z=as_values(arrays[2], len(arrays[0])) if len(arrays) == 3 else None,
        attributes=further,
        source=source,
        columns=tuple(ordered[i] for i in chosen),
    )


def _as_long(
    archive: zipfile.ZipFile, rows: int, *, without: Sequence[str]
) -> dict[str, NDArray[Any]]:
    """Return the arrays with one number for each point."""
    names = [name for name in _ordered_names(archive) if name not in without]
    found = {name: _member(archive, name) for name in names}
    return {name: array for name, array in found.items() if array.shape == (rows,)}


def _ordered_names(archive: zipfile.ZipFile) -> list[str]:
    return [name[:-4] for name in archive.namelist() if name.endswith(".npy")]


def _names(archive: zipfile.ZipFile) -> set[str]:
    return set(_ordered_names(archive))


def _listed(names: set[str]) -> str:
    return "its arrays are " + ", ".join(sorted(names)) if names else "it contains no arrays"


def _no_array(archive: zipfile.ZipFile, name: str) -> FileFormatError:
    found = _listed(_names(archive))
    return FileFormatError(f"{archive.filename} has no array {name!r:.80}: {found}")


def _member(archive: zipfile.ZipFile, name: str) -> NDArray[Any]:
    """Read one array, after comparing its header with the size of the member."""
    try:
        entry = archive.getinfo(f"{name}.npy")
    except KeyError:
        raise _no_array(archive, name) from None
    return read_array(archive, entry, f"{archive.filename}: array {name!r}")
