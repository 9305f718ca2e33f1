"""Meshes for solvers: XDMF, MED, INP, VTK and Medit by meshio (extra ``mesh``), and SU2.

Triangles or tetrahedra are written, and the segments of a mesh with their markers: as named parts
of the boundary in SU2, as values in XDMF, as groups in MED, which also stores regions, and as node
sets and surfaces in INP.
"""

from __future__ import annotations

import importlib
import re
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import FileFormatError
from delone.exchange.meshio import TAGS, to_meshio
from delone.exchange.parts import boundary, boundary_segments, kind_of
from delone.io.content import content

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from delone.exchange.parts import HasParts, Parts
    from delone.io.content import Wanted

__all__ = ["require_libraries", "write_mesh"]

_MODULES = {
    ".xdmf": "xdmf", ".med": "med", ".inp": "abaqus", ".vtk": "vtk", ".mesh": "medit",
}  # fmt: skip
# Formats with point and cell values.
_VALUED = (".xdmf", ".vtk")
# The sides of Abaqus elements by the local numbers of their nodes, in the order S1, S2, ...
_ABAQUS_SIDES = {
    3: ((0, 1), (1, 2), (2, 0)),
    4: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
}
# The nodes of tetrahedra in MED files, whose first face is seen from outside, in VTK's order.
_MED_ORDERS = {"tetra": (0, 2, 1, 3), "tetra10": (0, 2, 1, 3, 6, 5, 4, 7, 9, 8)}
# The element types that Gmsh writes as well, by meshio's names.
_ABAQUS_TYPES = {"R3D3": "CPS3", "C3D10MH": "C3D10"}
# The element types of surfaces in 3-D.
_SHELLS = {"R3D3": "S3", "CPE6": "STRI65"}
# The maximum length of a number in an INP file.
_CHARACTERS = 20
_ELEMENT = re.compile(r"^(\*ELEMENT, TYPE=)(\w+)$", re.MULTILINE)
# SU2's numbers for cell types, which are VTK's.
_LINE, _TRIANGLE, _TETRAHEDRON = 3, 5, 10


def require_libraries(suffix: str) -> None:
    """Import what writing needs."""
    require("meshio", extra="mesh", what="writing meshes")
    if suffix in (".xdmf", ".med"):
        # meshio imports it even for XDMF files that contain all data as text.
        require("h5py", extra="mesh", what=f"writing {suffix[1:].upper()} files")


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write triangles or tetrahedra and, for a mesh, its segments."""
    suffix = path.suffix.lower()
    wanted.refuse(f"{suffix} files", "edges", use=".vtu, .msh or .gpkg")
    if suffix not in _VALUED:
        wanted.refuse(f"{suffix} files", "attributes", use=".vtu or .xdmf")
    found = content(triangulation, z=wanted.z, attributes=wanted.attributes, order=wanted.order)
    if suffix == ".su2":
        if found.heights is not None:
            raise FileFormatError(".su2 files of 2-D meshes cannot store heights; use .vtu")
        path.write_text(_su2(found.own), encoding="utf-8")
        return
    made = to_meshio(found.whole())
    module = importlib.import_module(f"meshio.{_MODULES[suffix]}")
    _OWN_WRITERS[suffix](path, made, module)


def _write_xdmf(path: Path, mesh: Any, module: Any) -> None:
    _drop(mesh, *TAGS)
    # Everything in one file, without a second one for the data.
    module.write(path, mesh, data_format="XML")


def _write_vtk(path: Path, mesh: Any, module: Any) -> None:
    _drop(mesh, *TAGS)
    # meshio's name for 32-bit integers differs from VTK's.
    mesh.cell_data = {name: [_wide(own) for own in each] for name, each in mesh.cell_data.items()}
    mesh.point_data = {name: _wide(values) for name, values in mesh.point_data.items()}
    module.write(path, mesh)


def _wide(values: NDArray[Any]) -> NDArray[Any]:
    return values.astype(np.int64) if values.dtype.kind in "iub" else values


def _write_medit(path: Path, mesh: Any, module: Any) -> None:
    mesh.point_data, mesh.cell_data = {}, _references(mesh)
    module.write(path, mesh)


def _write_med(path: Path, mesh: Any, module: Any) -> None:
    tags, mesh.cell_tags = _families(mesh)
    mesh.point_data, mesh.cell_data = {}, tags
    for block in mesh.cells:
        block.data = block.data[:, _MED_ORDERS.get(block.type, slice(None))]
    # HDF5 does not report a full disk as an OSError.
    buffer = BytesIO()
    module.write(buffer, mesh)
    path.write_bytes(buffer.getvalue())


def _write_inp(path: Path, mesh: Any, module: Any) -> None:
    """Write elements with element sets for regions, and facets as surfaces and node sets.

    Facets are not elements: solvers reject elements without a section.
    """
    surfaces = _surfaces(mesh)
    mesh.cell_sets, mesh.point_sets = _sets(mesh), _node_sets(mesh)
    mesh.point_data, mesh.cell_data = {}, {}
    mesh.cells = mesh.cells[:1]
    module.write(path, mesh)
    text = path.read_text(encoding="utf-8")
    head, _, rest = text.partition("*NODE\n")
    rest = rest[rest.index("*ELEMENT") :]
    nodes = [
        ", ".join([str(i), *map(_fitted, place)]) for i, place in enumerate(mesh.points.tolist(), 1)
    ]
    # meshio writes element types for rigid bodies, beams and incompressible solids.
    types = {**_ABAQUS_TYPES, **(_SHELLS if mesh.points[:, 2].any() else {})}
    rest = _ELEMENT.sub(lambda line: line[1] + types.get(line[2], line[2]), rest)
    path.write_text("\n".join([f"{head}*NODE", *nodes, rest]) + surfaces, encoding="utf-8")


def _fitted(number: float) -> str:
    """Return a number in 20 characters, the maximum of the format, with 13 digits or more."""
    text = repr(number)
    digits = 17
    while len(text) > _CHARACTERS:  # terminates: one digit less each time
        digits -= 1
        mantissa, _, exponent = f"{number:.{digits - 1}e}".partition("e")
        text = f"{mantissa}e{int(exponent)}"
    return text


def _drop(mesh: Any, *names: str) -> None:
    for name in names:
        mesh.cell_data.pop(name, None)


_OWN_WRITERS: dict[str, Callable[[Path, Any, Any], None]] = {
    ".xdmf": _write_xdmf,
    ".vtk": _write_vtk,
    ".mesh": _write_medit,
    ".med": _write_med,
    ".inp": _write_inp,
}


def _families(mesh: Any) -> tuple[dict[str, list[NDArray[np.int64]]], dict[int, list[str]]]:
    """The groups of an MED file: regions of cells and markers of lines, with negative numbers.

    Where there is no region, or the marker is 0, the number is 0: no group.
    """
    tags = [np.zeros(len(block.data), dtype=np.int64) for block in mesh.cells]
    names: dict[int, list[str]] = {}
    for name, where, none in (("region", 0, -1), ("marker", 1, 0)):
        values = mesh.cell_data.get(name, ())
        for block, value in list(enumerate(values))[where : where + 1]:
            for own in np.setdiff1d(value, none).tolist():
                number = -1 - len(names)
                names[number] = [f"{name} {own}"]
                tags[block][value == own] = number
    return {"cell_tags": tags}, names


def _references(mesh: Any) -> dict[str, list[NDArray[np.int64]]]:
    """The references of a Medit file: regions of cells and markers of facets.

    0 stands for no region; if there is a region 0, all region numbers are one greater.
    """
    found = [np.zeros(len(block.data), dtype=np.int64) for block in mesh.cells]
    if "region" in mesh.cell_data:
        region = np.asarray(mesh.cell_data["region"][0]).astype(np.int64)
        has_both = (region == 0).any() and (region < 0).any()
        found[0] = region + 1 if has_both else np.maximum(region, 0)
    if "marker" in mesh.cell_data and len(found) > 1:
        found[1] = np.asarray(mesh.cell_data["marker"][1]).astype(np.int64)
    return {"medit:ref": found}


def _sets(mesh: Any) -> dict[str, list[NDArray[np.int64]]]:
    """The element sets of an INP file: regions, by name."""
    region = np.asarray(mesh.cell_data.get("region", [np.empty(0)])[0])
    return {
        f"region_{own}": [np.flatnonzero(region == own)]
        for own in np.setdiff1d(region, -1).tolist()
    }


def _node_sets(mesh: Any) -> dict[str, NDArray[np.int64]]:
    """The node sets of an INP file: the nodes of facets, by marker."""
    if "marker" not in mesh.cell_data or len(mesh.cells) < 2:
        return {}
    marker, facets = np.asarray(mesh.cell_data["marker"][1]), mesh.cells[1].data
    return {
        f"marker_{own}": np.unique(facets[marker == own]).astype(np.int64)
        for own in np.setdiff1d(marker, 0).tolist()
    }


def _surfaces(mesh: Any) -> str:
    """The surfaces of an INP file: for each marker, the element sides that are its facets.

    A wall between two elements is a side of the first one.
    """
    if "marker" not in mesh.cell_data or len(mesh.cells) < 2:
        return ""
    simplices, facets = (np.asarray(block.data) for block in mesh.cells[:2])
    sides = _ABAQUS_SIDES[4 if mesh.cells[0].type.startswith("tetra") else 3]
    corners = np.concatenate([simplices[:, side] for side in sides])
    # Nodes in the middle of edges follow the corners.
    both = np.sort(np.concatenate((corners, facets[:, : len(sides[0])])), axis=1)
    # The first row of each facet: np.unique returns first occurrences.
    _, first, place = np.unique(both, axis=0, return_index=True, return_inverse=True)
    number = first[place.reshape(-1)[len(corners) :]]
    side, element = np.divmod(number, len(simplices))
    marker = np.asarray(mesh.cell_data["marker"][1])
    lines = []
    for own in np.setdiff1d(marker[number < len(corners)], 0).tolist():
        lines.append(f"*SURFACE, TYPE=ELEMENT, NAME=surface_{own}")
        rows = np.flatnonzero((marker == own) & (number < len(corners)))
        rows = rows[np.lexsort((side[rows], element[rows]))]
        lines += [f"{element[row] + 1}, S{side[row] + 1}" for row in rows.tolist()]
    return "".join(f"{line}\n" for line in lines)


def _su2(parts: Parts) -> str:
    """The text of an SU2 file; its markers are the parts of the boundary."""
    kind_of(parts, what="an SU2 file", kinds=("triangles", "tetrahedra"))
    ndim = parts.points.shape[1]
    cell, side = (_TRIANGLE, _LINE) if ndim == 2 else (_TETRAHEDRON, _TRIANGLE)
    lines = [f"NDIME= {ndim}", f"NELEM= {len(parts.simplices)}"]
    for t, corners in enumerate(parts.simplices.tolist()):
        lines.append(" ".join(map(str, (cell, *corners, t))))
    lines.append(f"NPOIN= {len(parts.points)}")
    for i, place in enumerate(parts.points.tolist()):
        lines.append(" ".join([*map(repr, place), str(i)]))
    sides = _sides(parts)
    lines.append(f"NMARK= {len(sides)}")
    for marker, rows in sides.items():
        lines += [f"MARKER_TAG= {marker}", f"MARKER_ELEMS= {len(rows)}"]
        lines += [" ".join(map(str, (side, *row))) for row in rows.tolist()]
    return "\n".join(lines) + "\n"


def _sides(parts: Parts) -> dict[int, NDArray[np.int32]]:
    """The facets of the boundary by their markers."""
    marker = parts.of_segments.get("marker")
    if parts.segments is None or marker is None:
        return {0: boundary(parts.simplices)}
    pairs, rows = boundary_segments(parts)
    marker = marker[rows]
    return {value: pairs[marker == value] for value in np.unique(marker).tolist()}
