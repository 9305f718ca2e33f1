"""Meshes: VTU, PLY, OBJ, STL and MSH, written and partly read by meshio (extra ``mesh``).

Legacy VTK and Medit files are read here as well, and written by `fem`.

What meshio would allocate memory for is first compared with the size of the file. Doubles stay
doubles: a binary STL file has single precision only, so it is written where that is exact, and as
text with all digits where it is not.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_points, as_simplices
from delone._base.extras import require
from delone._base.files import unread, without
from delone._base.values import as_values
from delone.errors import DeloneError, FileFormatError, InputError
from delone.exchange.meshio import TAGS, region_tags, to_meshio
from delone.io import gmsh_groups, medit, msh, obj, ply, vtk, vtu
from delone.io.cells import POLYGONS, SOLIDS, Cells, ReadMesh
from delone.io.content import content
from delone.io.facets import facet_triangles
from delone.io.gmsh import needed_sections
from delone.io.meshfile import MeshFile
from delone.io.pointset import PointSet

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone.exchange.parts import HasParts
    from delone.io.content import Content, Wanted

__all__ = ["read_mesh", "read_points", "require_libraries", "write_mesh"]

_MODULES = {".vtu": "vtu", ".ply": "ply", ".obj": "obj", ".stl": "stl", ".msh": "gmsh"}
_DIMENSIONS = {"triangle": 2, "tetra": 3}
# These can store triangles, but not lines or tetrahedra.
_PLAIN = (".ply", ".obj", ".stl")
_HEAD, _TAIL = 1 << 16, 1 << 12
# These are read without meshio, which fails on common properties and counts.
_OWN = {
    **{".ply": ply.read, ".obj": obj.read, ".vtu": vtu.read, ".vtk": vtk.read, ".mesh": medit.read}
}


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    everything: bool = False,
) -> PointSet:
    """Read the vertices of a mesh; see `delone.io.read_points`."""
    if columns is not None:
        raise FileFormatError(f"{path}: coordinates of a mesh are x, y and z, not to be chosen")
    mesh = _read(path, None if everything else attributes)
    if everything:
        attributes = [str(name) for name in mesh.point_data]
    missing = [name for name in attributes if name not in mesh.point_data]
    if missing:
        raise FileFormatError(f"{path} has no values {missing[0]!r:.80} of points")
    points, z = _coordinates(mesh, path, least=0)
    further = {name: np.asarray(mesh.point_data[name]) for name in attributes}
    return PointSet(points=points, z=z, attributes=further, source=str(path))


def read_mesh(path: Path, *, split: bool = False) -> MeshFile:
    """Read the triangles of a mesh; see `delone.io.read_mesh`. With `split`, also polygons."""
    mesh = _read(path, marked=True)
    if second := {block.type for block in mesh.cells} & {"line3", "triangle6", "tetra10"}:
        raise FileFormatError(
            f"{path} contains elements of second order ({', '.join(sorted(second))}), which are "
            "not read; write those of first order"
        )
    if any(block.type == "tetra" for block in mesh.cells):
        return _tetrahedra(mesh, path)
    points, z = _coordinates(mesh, path)
    others = {block.type for block in mesh.cells} - {"triangle", "vertex", "line"}
    if split and others and all(kind.startswith(POLYGONS) for kind in others):
        return _polygons(mesh, path)
    if others:
        flat = all(kind.startswith(POLYGONS) for kind in others)
        raise FileFormatError(
            f"{path} contains {', '.join(sorted(others)):.80} cells, not only triangles"
            + ('; polygons="split" divides them' if flat else "")
        )
    if not any(block.type == "triangle" for block in mesh.cells):
        raise without(path, "triangles")
    simplices = _simplices(mesh, "triangle", len(points), path)
    return MeshFile(points=points, simplices=simplices, z=z, source=str(path), markers=mesh.markers)


def _polygons(mesh: ReadMesh, path: Path) -> MeshFile:
    """The triangles of a mesh and those of its polygons, in the order of the file."""
    plane, z = _coordinates(mesh, path)
    heights = np.zeros(len(plane)) if z is None else z
    points = np.column_stack((plane, heights))
    faces: list[list[int]] = []
    counts: list[int] = []
    nothing = np.empty((0, 3))
    for block in mesh.cells:
        if block.type in ("vertex", "line"):
            continue
        corners = np.asarray(block.data)
        if corners.dtype.kind not in "iu" or corners.min() < 0 or corners.max() >= len(points):
            raise FileFormatError(f"{path} names points that there are not")
        for polygon in corners.tolist():
            made = facet_triangles(points, [polygon], nothing, str(path))
            faces += made
            counts.append(len(made))
    simplices = as_simplices(np.array(faces), len(points), 2)
    markers = None if mesh.markers is None else np.repeat(mesh.markers, counts)
    return MeshFile(points=plane, simplices=simplices, z=z, source=str(path), markers=markers)


def _simplices(mesh: ReadMesh, kind: str, npoints: int, path: Path) -> NDArray[np.int32]:
    """The corners of all cells of a kind."""
    blocks = [np.asarray(block.data) for block in mesh.cells if block.type == kind]
    try:
        # uint64 does not mix with int32, and indices are small anyway.
        corners = np.concatenate(blocks).astype(np.int64)
        return as_simplices(corners, npoints, _DIMENSIONS[kind])
    except OverflowError as error:
        # meshio returns numbers that exceed NumPy's integers as objects.
        raise FileFormatError(f"{path} refers to points that do not exist: {error}") from error
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error


def _tetrahedra(mesh: ReadMesh, path: Path) -> MeshFile:
    """The tetrahedra of a 3-D mesh, and its triangles as faces; edges are left out."""
    plane, z = _coordinates(mesh, path)
    others = {block.type for block in mesh.cells} - {"tetra", "triangle", "vertex", "line"}
    if others or z is None:
        found = ", ".join(sorted(others)) or "flat points"
        raise FileFormatError(f"{path} contains {found} besides its tetrahedra")
    simplices = _simplices(mesh, "tetra", len(plane), path)
    points = np.ascontiguousarray(np.column_stack((plane, z)))
    marked = any(block.type == "triangle" for block in mesh.cells)
    return MeshFile(
        points=points,
        simplices=simplices,
        source=str(path),
        region=mesh.regions,
        faces=_simplices(mesh, "triangle", len(points), path) if marked else None,
        face_markers=mesh.markers if marked else None,
    )


def _coordinates(
    mesh: ReadMesh, path: Path, *, least: int = 1
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    points = np.asarray(mesh.points)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or len(points) < least:
        raise without(path, "points")
    try:
        plane = as_points(np.ascontiguousarray(points[:, :2]))
        z = as_values(points[:, 2], len(points)) if points.shape[1] == 3 else None
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error
    return plane, z


def _read(path: Path, attributes: Sequence[str] | None = (), *, marked: bool = False) -> ReadMesh:
    """Return points, cells and point values of a file: all, or the named ones of an MSH file.

    None means all of an MSH file as well. With `marked`, triangles and tetrahedra of an MSH file
    have the numbers of their groups, as those of other files have them in any case.
    """
    suffix = path.suffix.lower()
    if suffix in _OWN:
        return _OWN[suffix](path)
    require("meshio", extra="mesh", what=f"reading {suffix}")
    # The module of the format: the general reader prints, and ends the interpreter on an error.
    module = importlib.import_module(f"meshio.{_MODULES[suffix]}")
    needed = _whole_stl(path) if suffix == ".stl" else needed_sections(path, attributes)
    try:
        # meshio prints messages with rich where it should raise or warn.
        quiet = io.StringIO()
        with (
            needed as part,
            contextlib.redirect_stdout(quiet),
            contextlib.redirect_stderr(quiet),
            warnings.catch_warnings(),
        ):
            warnings.simplefilter("ignore")
            mesh = module.read(part)
    except (DeloneError, FileNotFoundError, PermissionError, MemoryError):
        raise
    except (Exception, SystemExit) as error:
        raise unread(path, suffix, error) from error
    cells = [Cells(block.type, block.data) for block in mesh.cells]
    markers = regions = None
    wanted = all(block.type in (*POLYGONS, *SOLIDS, "vertex", "line") for block in cells)
    if marked and suffix == ".msh" and wanted:
        markers, regions = gmsh_groups.numbers(mesh, path)
    return ReadMesh(
        points=mesh.points,
        cells=cells,
        point_data=mesh.point_data,
        markers=markers,
        regions=regions,
    )


@contextlib.contextmanager
def _whole_stl(path: Path) -> Iterator[Path]:
    """Yield an STL file, unless it is truncated.

    It is binary if its size matches the number after its 80-byte header, whatever word the header
    begins with; many programs write "solid" there.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(_HEAD)
        file.seek(max(0, size - _TAIL))
        tail = file.read()
    count = int.from_bytes(head[80:84], "little")
    binary = len(head) >= 84 and 84 + 50 * count == size
    if not binary and not head.lstrip().startswith(b"solid"):
        raise FileFormatError(
            f"{path} declares {count} triangles, {84 + 50 * count} bytes, and has {size}: "
            "it is truncated or not a .stl file"
        )
    if not binary and not tail.rstrip().rpartition(b"\n")[2].lstrip().startswith(b"endsolid"):
        raise FileFormatError(f"{path} has no endsolid at its end: it is truncated")
    yield path


def require_libraries(suffix: str) -> None:
    """Import what writing needs."""
    require("meshio", extra="mesh", what="writing meshes")


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write simplices and segments, or edges as lines, with heights as the third coordinate."""
    suffix = path.suffix.lower()
    if suffix in _PLAIN:
        wanted.refuse(f"{suffix} files", "edges", use=".vtu, .msh or .gpkg")
    if suffix in (".obj", ".stl"):
        wanted.refuse(f"{suffix} files", "attributes", use=".vtu or .ply")
    found = content(
        triangulation,
        z=wanted.z,
        edges=wanted.edges,
        attributes=wanted.attributes,
        order=wanted.order,
    )
    made = to_meshio(found.bare() if suffix in _PLAIN else found.whole())
    if suffix == ".msh" and TAGS[0] in made.cell_data:
        # meshio does not read values of mixed cells in any version.
        if found.of_simplices:
            raise FileFormatError(
                ".msh files of meshes cannot store attributes of triangles; use .vtu"
            )
        _write_tagged(path, made, found, {}, wanted.version or "2.2")
        return
    if suffix == ".msh" and made.cells[0].type in ("tetra", "tetra10"):
        region = made.cell_data.get("region")
        if region is not None:
            values = {name: each[0] for name, each in made.cell_data.items()}
            made.cell_data |= {tag: [region_tags(region[0])] for tag in TAGS}
            _write_tagged(path, made, found, values, wanted.version or "2.2")
            return
    for tag in TAGS:
        made.cell_data.pop(tag, None)
    if found.heights is not None and suffix == ".vtu":
        made.point_data.setdefault("z", made.points[:, 2].copy())
    _write(path, suffix, made, wanted.version or "4.1")


def _write_tagged(
    path: Path, mesh: Any, found: Content, of_cells: Mapping[str, NDArray[Any]], version: str
) -> None:
    """Write simplices and segments to an MSH file, with regions and markers as its groups.

    Cell values are those of simplices, in a mesh without segments.
    """
    # Points have the markers of their segments, which become groups here.
    mesh.point_data = {
        name: values
        for name, values in mesh.point_data.items()
        if name in {**found.of_points, **found.of_nodes}
    }
    if version == "4.1":
        msh.write(path, mesh.points, _groups(mesh), mesh.point_data, of_cells)
        return
    mesh.field_data = {
        group.name: np.array([group.number, group.ndim]) for group in _groups(mesh, unmarked=False)
    }
    mesh.cell_data = {tag: mesh.cell_data[tag] for tag in TAGS}
    mesh.cell_data |= {name: [values] for name, values in of_cells.items()}
    module = importlib.import_module("meshio.gmsh")
    module.write(path, mesh, "2.2", binary=True)


def _groups(mesh: Any, *, unmarked: bool = True) -> list[msh.Group]:
    """Return the physical groups of a mesh: cells with the same region or marker.

    Facets without a marker, whose number is 0, form a group with the number after the largest one;
    with ``unmarked=False``, they are not in any group.
    """
    found = []
    for name, block in (("region", 0), ("marker", 1))[: len(mesh.cells)]:
        values, tags = mesh.cell_data.get(name), mesh.cell_data[TAGS[0]][block]
        own = np.zeros(len(tags), dtype=np.int64) if values is None else np.asarray(values[block])
        cells = mesh.cells[block]
        for value in np.unique(own).tolist():
            rows = np.flatnonzero(own == value)
            tag = int(tags[rows[0]])
            if tag or unmarked:
                number = tag or int(tags.max()) + 1
                named = gmsh_groups.group_name(name, value)
                found.append(msh.Group(named, number, cells.type, cells.data[rows], rows))
    return found


def _write(path: Path, suffix: str, mesh: Any, version: str) -> None:
    module = importlib.import_module(f"meshio.{_MODULES[suffix]}")
    with np.errstate(all="ignore"):
        if suffix == ".stl":
            single = mesh.points.astype(np.float32)
            module.write(path, mesh, binary=bool((single == mesh.points).all()))
        elif suffix == ".msh":
            module.write(path, mesh, version, binary=True)
        else:
            module.write(path, mesh)
