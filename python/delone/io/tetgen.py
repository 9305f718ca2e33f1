"""TetGen's formats: 3-D points, tetrahedra, faces, and surfaces of polygons with holes.

A .node file contains points, .ele tetrahedra, .face triangles with markers; .smesh and .poly
contain facets, points in holes, and points in regions with their numbers. A file without points
takes them from the .node file next to it. Facets with more than three corners become triangles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_points
from delone._base.files import without
from delone.errors import FileFormatError, InputError
from delone.exchange.parts import boundary
from delone.io.companions import require_companion
from delone.io.content import content
from delone.io.facets import facet_triangles
from delone.io.meshfile import MeshFile
from delone.io.numbered import (
    Lines,
    Numbers,
    as_markers,
    as_rows,
    first_number,
    require_dimension,
    require_nodes,
    table,
)

if TYPE_CHECKING:
    from pathlib import Path

    from delone._base.types import Floats, Indices
    from delone.exchange.parts import HasParts
    from delone.io.content import Wanted

__all__ = ["SECOND", "is_solid", "read_mesh", "read_nodes", "write_mesh"]

# The nodes of a second-order element, by their positions in VTK's order.
SECOND = (0, 1, 2, 3, 9, 7, 4, 5, 8, 6)


def is_solid(path: Path) -> bool:
    """Return whether the points of a file, or of the .node file next to it, have 3 coordinates."""
    found = _dimension(path)
    if found is None and path.suffix.lower() != ".node" and _node(path).exists():
        found = _dimension(_node(path))
    return found == 3


def _dimension(path: Path) -> int | None:
    """Return the number of coordinates of the points in a file; None if there are none."""
    if path.suffix.lower() in (".ele", ".face"):
        return None
    with path.open("rb") as file:
        for line in file:
            words = line.partition(b"#")[0].split()
            if words:
                return (
                    int(words[1]) if words[0] != b"0" and words[1:2] in ([b"2"], [b"3"]) else None
                )
    return None


def _node(path: Path) -> Path:
    node = path.with_suffix(".node")
    require_companion(path, node)
    return node


def read_nodes(path: Path) -> Floats:
    """Read the points, (n, 3), of a file or of the .node file next to it."""
    if path.suffix.lower() in (".ele", ".face"):
        return _nodes_beside(path)[0]
    points, _, _ = _opened(path)
    return points


def _nodes_beside(path: Path) -> tuple[Floats, int]:
    """Return the points of the .node file next to another, and the number of the first."""
    node = _node(path)
    require_nodes(node, path)
    points, first, _ = _opened(node)
    return points, first


def _opened(path: Path) -> tuple[Floats, int, Lines]:
    """Return points, the number of the first, and what follows them in the file."""
    lines = Lines(path)
    count, dimension, *_ = lines.counts(2)
    if not count and path.suffix.lower() != ".node":
        return *_nodes_beside(path), lines
    require_dimension(dimension, 3, path)
    rows = lines.rows(count, 4)
    first = first_number(rows[:, 0], path)
    try:
        return as_points(np.ascontiguousarray(rows[:, 1:]), ndim=3), first, lines
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error


def read_mesh(path: Path) -> MeshFile:
    """Read tetrahedra, or triangles in 3-D; see `delone.io.read_mesh`."""
    suffix = path.suffix.lower()
    if suffix == ".ele":
        points, first = _nodes_beside(path)
        numbers = Numbers(path)
        count, corners, attributes = numbers.head(3)
        if count and corners not in (4, 10):
            raise FileFormatError(f"{path} contains elements of {corners} nodes, not 4 or 10")
        rows = numbers.take(count, 1 + corners + attributes)
        # The further nodes of an element are on its edges.
        tetrahedra = as_rows(rows[:, 1:5], first, path, len(points))
        if not count:
            raise without(path, "tetrahedra")
        region = rows[:, 1 + corners : 2 + corners]
        whole = attributes and (region == np.floor(region)).all()
        return MeshFile(
            points=points,
            simplices=tetrahedra,
            source=str(path),
            region=as_markers(region, path, "region").ravel() if whole else None,
        )
    if suffix == ".face":
        return _faces(path)
    return _facets(path)


def _surface(path: Path, points: Floats, faces: Indices, **further: Any) -> MeshFile:
    if not len(faces):
        raise without(path, "triangles")
    plane, z = points[:, :2].copy(), points[:, 2].copy()
    return MeshFile(points=plane, simplices=faces, z=z, source=str(path), **further)


def _faces(path: Path) -> MeshFile:
    """Read triangles with markers; what follows them in a line is left out."""
    points, first = _nodes_beside(path)
    lines = Lines(path)
    count, marked, *_ = [*lines.counts(1), 0]
    rows = lines.rows(count, 5 if marked else 4)
    faces = as_rows(rows[:, 1:4], first, path, len(points))
    markers = as_markers(rows[:, 4:5], path)[:, 0] if marked else None
    return _surface(path, points, faces, markers=markers)


def _facets(path: Path) -> MeshFile:
    """Read facets, holes and regions of a .smesh or .poly file."""
    if path.suffix.lower() == ".poly" and not is_solid(path):
        raise FileFormatError(f"{path} contains segments in 2-D, not triangles")
    points, first, lines = _opened(path)
    count, marked, *_ = [*lines.counts(1), 0]
    lines.require(count)
    read = _polygons if path.suffix.lower() == ".poly" else _polygon
    faces: list[list[int]] = []
    markers: list[float] = []
    for _ in range(count):
        polygons, holes, marker = read(lines)
        rows = [as_rows(np.array(p), first, path, len(points)).tolist() for p in polygons]
        made = facet_triangles(points, rows, holes, str(path))
        faces += made
        markers += [marker] * len(made)
    return _surface(
        path,
        points,
        np.array(faces, dtype=np.int32).reshape(-1, 3),
        markers=as_markers(np.array(markers)[:, None], path)[:, 0] if marked and faces else None,
        holes=_seeds(lines, 4)[:, 1:] if not lines.ended else None,
        regions=_seeds(lines, 5)[:, 1:] if not lines.ended else None,
    )


def _polygon(lines: Lines) -> tuple[list[list[float]], Floats, float]:
    """Return the facet of a .smesh file: one polygon without holes, and its marker."""
    corners, rest = lines.polygon()
    _require_corners(corners, lines)
    return [corners], np.empty((0, 3)), rest[0] if rest else 0.0


def _polygons(lines: Lines) -> tuple[list[list[float]], Floats, float]:
    """Return the facet of a .poly file: polygons, seeds of holes, and its marker."""
    count, holes, marker, *_ = [*lines.counts(1), 0, 0]
    if not 0 < count <= lines.left or holes < 0:
        raise FileFormatError(f"{lines.path} has a facet of {count} polygons and {holes} holes")
    polygons = [lines.polygon()[0] for _ in range(count)]
    _require_corners(polygons[0], lines)
    return polygons, lines.rows(holes, 4)[:, 1:], float(marker)


def _require_corners(polygon: list[float], lines: Lines) -> None:
    if len(polygon) < 3:
        raise FileFormatError(f"{lines.path} has a facet with {len(polygon)} corners")


def _seeds(lines: Lines, columns: int) -> Floats:
    """Return numbered points, (k, columns), with a region number as the last of five columns."""
    (count, *_) = lines.counts(1)
    return lines.rows(count, columns)


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write one of the files; triangles are those of the input, or of the boundary."""
    suffix = path.suffix.lower()
    wanted.refuse(f"{suffix} files", "edges", "attributes")
    parts = content(triangulation, z=wanted.z, order=wanted.order).whole()
    points = np.zeros((len(parts.points), 3))
    points[:, : parts.points.shape[1]] = parts.points
    if suffix == ".ele":
        region = parts.of_simplices.get("region", np.empty((len(parts.simplices), 0)))
        region = region.reshape(len(parts.simplices), -1)
        width = parts.simplices.shape[1]
        nodes = parts.simplices if width == 4 else parts.simplices[:, SECOND]
        head = f"{len(nodes)} {width} {region.shape[1]}"
        text = table(head, (nodes, region))
    elif suffix == ".node":
        text = table(f"{len(points)} 3 0 0", (points,))
    else:
        faces, markers = _triangles(triangulation, parts.simplices)
        if suffix == ".face":
            text = table(f"{len(faces)} 1", (faces, markers[:, None]))
        else:
            lines = []
            for face, marker in zip(faces.tolist(), markers.tolist(), strict=True):
                corners = " ".join(map(str, (3, *face)))
                lines += (
                    [f"1 0 {marker}", corners] if suffix == ".poly" else [f"{corners} {marker}"]
                )
            seeds = region_seeds(triangulation, points, faces)
            holes = getattr(triangulation, "holes", np.empty((0, 3))).tolist()
            lines += [str(len(holes))]
            lines += [" ".join(map(repr, (i, *place))) for i, place in enumerate(holes)]
            text = table(f"{len(points)} 3 0 0", (points,))
            text += "\n".join([f"{len(faces)} 1", *lines, str(len(seeds)), *seeds]) + "\n"
    path.write_text(text, encoding="utf-8")


def region_seeds(mesh: Any, points: Floats, faces: Indices) -> list[str]:
    """Return lines with a point in each part of a mesh, between faces, that has a region number.

    It is the center of the part's largest tetrahedron. Without numbers there are none.
    """
    region, neighbors = getattr(mesh, "region", None), getattr(mesh, "neighbors", None)
    corners = mesh.simplices
    if region is None or neighbors is None or corners.shape[1] != 4 or (region < 0).all():
        return []
    walls = set(map(tuple, np.sort(faces, axis=1).tolist()))
    part = np.arange(len(corners))
    pairs = [np.empty((0, 2), dtype=np.int64)]
    for i in range(4):
        t = np.flatnonzero(neighbors[:, i] > part)
        sides = np.sort(np.delete(corners[t], i, axis=1), axis=1).tolist()
        free = np.array([tuple(side) not in walls for side in sides], dtype=bool)
        pairs.append(np.column_stack((t, neighbors[t, i]))[free])
    one, other = np.concatenate(pairs).T
    while True:  # terminates: part numbers only decrease
        least = np.minimum(part[one], part[other])
        before = part.copy()
        np.minimum.at(part, one, least)
        np.minimum.at(part, other, least)
        part = part[part]
        if np.array_equal(part, before):
            break
    a, b, c, d = (points[column] for column in corners.T)
    size = np.abs(np.einsum("ij,ij->i", a - d, np.cross(b - d, c - d)))
    order = np.lexsort((-size, part))
    largest = order[np.unique(part[order], return_index=True)[1]]
    centers = points[corners].mean(axis=1)
    return [
        " ".join(map(repr, (i, *centers[t].tolist(), int(region[t]))))
        for i, t in enumerate(largest[region[largest] >= 0].tolist())
    ]


def _triangles(mesh: Any, simplices: Indices) -> tuple[Indices, Indices]:
    """Return the triangles of a surface, of the input, or of the boundary, with their markers."""
    if len(getattr(mesh, "input_faces", ())):
        return mesh.input_faces, mesh.face_markers
    faces = boundary(simplices) if simplices.shape[1] == 4 else simplices
    return faces, np.zeros(len(faces), dtype=np.int32)
