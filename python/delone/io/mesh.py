"""Meshes: VTU, PLY, OBJ, STL and MSH by meshio (extra ``mesh``).

What meshio would set memory aside for is compared with the size of the file first. Doubles stay
doubles: a binary STL file has single precision only, so it is written where that is exact, and as
text with all digits where it is not.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import re
import warnings
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_points, as_simplices
from delone._values import as_values
from delone.errors import DeloneError, FileFormatError, InputError
from delone.exchange.meshio import TAGS, to_meshio
from delone.extras import require
from delone.io.content import content
from delone.io.counts import announced
from delone.io.facets import facet_triangles
from delone.io.markup import refuse_document_type
from delone.io.pointset import PointSet
from delone.io.registry import MeshFile

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from delone.exchange.parts import HasParts
    from delone.io.content import Content

__all__ = ["read_mesh", "read_points", "require_libraries", "write_mesh"]

_MODULES = {".vtu": "vtu", ".ply": "ply", ".obj": "obj", ".stl": "stl", ".msh": "gmsh"}
_DIMENSIONS = {"triangle": 2, "tetra": 3}
_POLYGONS = ("triangle", "quad", "polygon")
# These hold triangles, and no lines or tetrahedra.
_PLAIN = (".ply", ".obj", ".stl")
_HEAD, _TAIL = 1 << 16, 1 << 12
_COUNTS = {
    ".ply": re.compile(rb"^element +\w+ +(\d+)", re.MULTILINE),
    ".vtu": re.compile(rb'NumberOf(?:Points|Cells)="\s*(\d+)'),
}
_RELATIVE = re.compile(rb"^[ \t]*f[ \t][^\r\n]*-\d", re.MULTILINE)


def read_points(
    path: Path, *, columns: Sequence[str | int] | None, attributes: Sequence[str]
) -> PointSet:
    """Read the vertices of a mesh; see `delone.io.read_points`."""
    if columns is not None:
        raise FileFormatError(f"{path}: coordinates of a mesh are x, y and z, not to be chosen")
    mesh = _read(path)
    missing = [name for name in attributes if name not in mesh.point_data]
    if missing:
        raise FileFormatError(f"{path} has no values {missing[0]!r} of points")
    points, z = _coordinates(mesh, path, least=0)
    further = {name: np.asarray(mesh.point_data[name]) for name in attributes}
    return PointSet(points=points, z=z, attributes=further, source=str(path))


def read_mesh(path: Path, *, split: bool = False) -> MeshFile:
    """Read the triangles of a mesh; see `delone.io.read_mesh`. With `split`, also polygons."""
    mesh = _read(path)
    if any(block.type == "tetra" for block in mesh.cells):
        return _tetrahedra(mesh, path)
    points, z = _coordinates(mesh, path)
    others = {block.type for block in mesh.cells} - {"triangle", "vertex", "line"}
    if split and others and all(kind.startswith(_POLYGONS) for kind in others):
        return _polygons(mesh, path)
    if others:
        raise FileFormatError(
            f"{path} contains {', '.join(sorted(others))} cells, not only triangles"
        )
    if not any(block.type == "triangle" for block in mesh.cells):
        raise FileFormatError(f"{path} contains no triangles")
    simplices = _simplices(mesh, "triangle", len(points), path)
    return MeshFile(points=points, simplices=simplices, z=z, source=str(path))


def _polygons(mesh: Any, path: Path) -> MeshFile:
    """The triangles of a mesh and those of its polygons, in the order of the file."""
    plane, z = _coordinates(mesh, path)
    heights = np.zeros(len(plane)) if z is None else z
    points = np.column_stack((plane, heights))
    faces: list[list[int]] = []
    nothing = np.empty((0, 3))
    for block in mesh.cells:
        if block.type in ("vertex", "line"):
            continue
        corners = np.asarray(block.data)
        if corners.dtype.kind not in "iu" or corners.min() < 0 or corners.max() >= len(points):
            raise FileFormatError(f"{path} names points that there are not")
        for polygon in corners.tolist():
            faces += facet_triangles(points, [polygon], nothing, str(path))
    simplices = as_simplices(np.array(faces), len(points), 2)
    return MeshFile(points=plane, simplices=simplices, z=heights, source=str(path))


def _simplices(mesh: Any, kind: str, npoints: int, path: Path) -> NDArray[np.int32]:
    """The corners of all cells of a kind."""
    blocks = [np.asarray(block.data) for block in mesh.cells if block.type == kind]
    try:
        # uint64 does not mix with int32, and indices are small anyway.
        corners = np.concatenate(blocks).astype(np.int64)
        return as_simplices(corners, npoints, _DIMENSIONS[kind])
    except OverflowError as error:
        # Of numbers that no integer of NumPy holds, meshio makes objects.
        raise FileFormatError(f"{path} names points that there are not: {error}") from error
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error


def _tetrahedra(mesh: Any, path: Path) -> MeshFile:
    """The tetrahedra of a 3-D mesh; faces and edges are left out."""
    plane, z = _coordinates(mesh, path)
    others = {block.type for block in mesh.cells} - {"tetra", "triangle", "vertex", "line"}
    if others or z is None:
        found = ", ".join(sorted(others)) or "flat points"
        raise FileFormatError(f"{path} contains {found} beside its tetrahedra")
    simplices = _simplices(mesh, "tetra", len(plane), path)
    points = np.ascontiguousarray(np.column_stack((plane, z)))
    return MeshFile(points=points, simplices=simplices, source=str(path))


def _coordinates(
    mesh: Any, path: Path, *, least: int = 1
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    points = np.asarray(mesh.points)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or len(points) < least:
        raise FileFormatError(f"{path} contains no points")
    try:
        plane = as_points(np.ascontiguousarray(points[:, :2]))
        z = as_values(points[:, 2], len(points)) if points.shape[1] == 3 else None
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error
    return plane, z


def _read(path: Path) -> Any:
    suffix = path.suffix.lower()
    meshio = require("meshio", extra="mesh", what=f"reading {suffix}")
    # The module of the format: the general reader prints, and ends the interpreter on an error.
    module = importlib.import_module(f"meshio.{_MODULES[suffix]}")
    if suffix == ".vtu":
        refuse_document_type(path)
    _check_claim(path, suffix)
    claimed = _announced(path) if suffix == ".ply" else {}
    if claimed.get("vertex") == 0:
        # meshio reads no such file as text; and nothing else can be in it.
        return meshio.Mesh(np.empty((0, 3)), [])
    try:
        # meshio speaks to the user itself, by rich, where it should raise or warn.
        quiet = io.StringIO()
        with (
            contextlib.redirect_stdout(quiet),
            contextlib.redirect_stderr(quiet),
            warnings.catch_warnings(),
        ):
            warnings.simplefilter("ignore")
            mesh = module.read(_absolute(path) if suffix == ".obj" else path)
    except (DeloneError, FileNotFoundError, PermissionError, MemoryError):
        raise
    except (Exception, SystemExit) as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise FileFormatError(f"{path} is truncated or not a {suffix} file: {reason}") from error
    found = {"vertex": len(mesh.points), "face": sum(len(block.data) for block in mesh.cells)}
    for item, count in found.items():
        if count != claimed.get(item, count):
            raise FileFormatError(
                f"{path} announces {claimed[item]} items of type {item} and holds {count}: "
                "it is cut short"
            )
    return mesh


def _announced(path: Path) -> dict[str, int]:
    """Return how many elements of each type a PLY file announces.

    meshio never stops looking for the end of a header.
    """
    with path.open("rb") as file:
        head, end, _ = file.read(_HEAD).partition(b"end_header")
    if not (head.startswith(b"ply") and end):
        raise FileFormatError(f"{path} is truncated or not a .ply file: its header is incomplete")
    items = re.findall(rb"^element +(\w+) +(\d+) *\r?$", head, re.MULTILINE)
    return {name.decode("ascii"): announced(count, str(path)) for name, count in items}


def _absolute(path: Path) -> Path | IO[str]:
    """Return an OBJ file whose faces count vertices from the first, as meshio takes them.

    A negative index counts back from the last vertex above its face.
    """
    content = path.read_bytes()
    if not _RELATIVE.search(content):
        return path
    lines, vertices = content.decode("utf-8", errors="replace").splitlines(), 0
    for number, line in enumerate(lines):
        word, *fields = line.split() or [""]
        if word == "v":
            vertices += 1
        elif word == "f":
            # Of vertex/texture/normal the vertex alone is read.
            corners = [int(field.partition("/")[0]) for field in fields]
            counted = [i + vertices + 1 if i < 0 else i for i in corners]
            lines[number] = " ".join(["f", *map(str, counted)])
    return io.StringIO("\n".join(lines) + "\n")


def _check_claim(path: Path, suffix: str) -> None:
    """Refuse a file that is cut short.

    Its header announces more items than it has bytes, or its last line is missing.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        claims = _claims(file, suffix, size)
        file.seek(max(0, size - _TAIL))
        tail = file.read()
    worst = max(claims, default=0)
    if worst > size:
        raise FileFormatError(
            f"{path} announces {worst} items and has only {size} bytes: it is cut short"
        )
    if suffix == ".msh":
        end = "$End"
    elif suffix == ".stl" and _is_text_stl(path):
        end = "endsolid"
    else:
        return
    last = tail.rstrip().rpartition(b"\n")[2].lstrip()
    if not last.startswith(end.encode()):
        raise FileFormatError(f"{path} has no {end} at its end: it is cut short")


def _claims(file: IO[bytes], suffix: str, size: int) -> list[int]:
    head = file.read(_HEAD)
    if suffix in _COUNTS:
        return [announced(n, file.name) for n in _COUNTS[suffix].findall(head)]
    if suffix == ".stl" and not head.lstrip().startswith(b"solid") and len(head) >= 84:
        count = int.from_bytes(head[80:84], "little")
        return [0 if 84 + 50 * count <= size else max(count, size + 1)]
    if suffix == ".msh":
        return _gmsh_claims(head, file)
    return []


def _is_text_stl(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(_HEAD).lstrip().startswith(b"solid")


# A node of a binary MSH file of version 2.
_NODE = np.dtype([("number", "<i4"), ("place", "<f8", 3)])


def _gmsh_claims(head: bytes, file: IO[bytes]) -> list[int]:
    """Return the counts behind $Nodes and $Elements, and the largest number of a node.

    meshio sets memory aside for both.
    """
    found = re.match(rb"\s*\$MeshFormat\s+(\d)[\d.]*\s+1\s", head)
    # Version 2 writes counts as text, binary or not.
    old = found is not None and found[1] == b"2"
    binary = found is not None and not old
    claims: list[int] = []
    for section in re.finditer(rb"\$(?:Nodes|Elements)\r?\n", head):
        rest = head[section.end() : section.end() + 32]
        if binary and len(rest) == 32:
            claims += [int(n) for n in np.frombuffer(rest, "<u8", 2)]
            if section[0].startswith(b"$Nodes"):
                file.seek(0)
                claims.append(_largest_node(file.read(), section.end()))
        elif not binary:
            claims += [int(n) for n in rest.split(b"\n")[0].split()[:2] if n.isdigit()]
            if old and section[0].startswith(b"$Nodes") and claims:
                file.seek(section.end() + rest.find(b"\n") + 1)
                claims.append(_largest_numbered(file.read()[: _NODE.itemsize * claims[-1]]))
    return claims


def _largest_numbered(records: bytes) -> int:
    """Return the largest number of a node in records of a binary MSH file of version 2."""
    whole = len(records) // _NODE.itemsize
    return int(np.frombuffer(records, _NODE, whole)["number"].max(initial=0))


def _largest_node(content: bytes, at: int) -> int:
    """Return the largest number of a node in a binary MSH file of version 4.1."""
    largest = 0
    blocks, at = int.from_bytes(content[at : at + 8], "little"), at + 32
    for _ in range(blocks):
        # Three integers, the number of nodes, their numbers, their coordinates.
        count, at = int.from_bytes(content[at + 12 : at + 20], "little"), at + 20
        # Beyond the end, where bytes are missing and count as zero, the loop ends too.
        if at + 32 * count > len(content):
            return max(count, len(content) + 1)
        if count:
            largest = max(largest, int(np.frombuffer(content, "<u8", count, at).max()))
        at += 32 * count
    return largest


def require_libraries(suffix: str) -> None:
    """Import what writing needs."""
    require("meshio", extra="mesh", what="writing meshes")


def write_mesh(
    path: Path,
    triangulation: HasParts,
    *,
    z: ArrayLike | None = None,
    crs: str | None = None,
    edges: bool = False,
    attributes: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Write simplices and segments, or edges as lines, with heights as the third coordinate."""
    suffix = path.suffix.lower()
    if edges and suffix in _PLAIN:
        raise FileFormatError(f"{suffix} files cannot store edges; use .vtu, .msh or .gpkg")
    found = content(triangulation, z=z, edges=edges, attributes=attributes)
    if found.given and suffix in (".obj", ".stl"):
        raise FileFormatError(f"{suffix} files cannot store attributes; use .vtu or .ply")
    made = to_meshio(found.bare() if suffix in _PLAIN else found.whole())
    if suffix == ".msh" and TAGS[0] in made.cell_data:
        _write_tagged(path, made, found)
        return
    for tag in TAGS:
        made.cell_data.pop(tag, None)
    if found.heights is not None and suffix == ".vtu":
        made.point_data.setdefault("z", made.points[:, 2].copy())
    _write(path, suffix, made)


def _write_tagged(path: Path, mesh: Any, found: Content) -> None:
    """Write triangles and segments to an MSH file, with regions and markers as its tags.

    Version 4 needs the CAD entities of points; meshio reads values of mixed cells in neither.
    """
    if found.of_simplices:
        raise FileFormatError(".msh files of meshes cannot store attributes of triangles; use .vtu")
    mesh.cell_data = {tag: mesh.cell_data[tag] for tag in TAGS}
    mesh.point_data = dict(found.of_points)
    module = importlib.import_module("meshio.gmsh")
    module.write(path, mesh, "2.2", binary=True)


def _write(path: Path, suffix: str, mesh: Any) -> None:
    module = importlib.import_module(f"meshio.{_MODULES[suffix]}")
    with np.errstate(all="ignore"):
        if suffix == ".stl":
            single = mesh.points.astype(np.float32)
            module.write(path, mesh, binary=bool((single == mesh.points).all()))
        elif suffix == ".msh":
            module.write(path, mesh, "4.1", binary=True)
        else:
            module.write(path, mesh)
