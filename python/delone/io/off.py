"""OFF files: points and polygons as text, read and written without a library.

Colors and normals are left out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._base.arrays import as_points, as_simplices
from delone._base.files import without
from delone.errors import FileFormatError, InputError
from delone.io.content import content
from delone.io.facets import facet_triangles
from delone.io.meshfile import MeshFile
from delone.io.numbered import Lines, as_rows, refuse_columns
from delone.io.pointset import PointSet

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from delone._base.types import Floats
    from delone.exchange.parts import HasParts
    from delone.io.content import Wanted

__all__ = ["read_mesh", "read_points", "write_mesh"]

_HEADS = ("OFF", "COFF", "NOFF", "CNOFF")


def read_points(
    path: Path, *, columns: Sequence[str | int] | None, attributes: Sequence[str]
) -> PointSet:
    """Read the vertices; see `delone.io.read_points`."""
    refuse_columns(path, columns, attributes)
    points, _, _ = _opened(path)
    return PointSet(points=points[:, :2].copy(), z=points[:, 2].copy(), source=str(path))


def read_mesh(path: Path) -> MeshFile:
    """Read triangles, and triangles of polygons; see `delone.io.read_mesh`."""
    points, count, lines = _opened(path)
    lines.require(count)
    faces: list[list[int]] = []
    nothing = np.empty((0, 3))
    for _ in range(count):
        corners, _ = lines.polygon()
        polygon = as_rows(np.array(corners), 0, path, len(points)).tolist()
        if len(polygon) < 3:
            raise FileFormatError(f"{path} has a face with {len(polygon)} corners")
        faces += facet_triangles(points, [polygon], nothing, str(path))
    if not faces:
        raise without(path, "triangles")
    try:
        simplices = as_simplices(np.array(faces), len(points), 2)
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error
    return MeshFile(
        points=points[:, :2].copy(), simplices=simplices, z=points[:, 2].copy(), source=str(path)
    )


def _opened(path: Path) -> tuple[Floats, int, Lines]:
    """Return the points, (n, 3), the number of faces, and the lines of these."""
    lines = Lines(path)
    word = lines.word()
    if word not in _HEADS:
        raise FileFormatError(
            f"{path} is not an OFF file of 3-D points: it starts with {word!r:.20}"
        )
    npoints, count, *_ = lines.counts(2)
    rows = lines.rows(npoints, 3)
    if not npoints:
        raise without(path, "points")
    try:
        return as_points(rows, ndim=3), count, lines
    except InputError as error:
        raise FileFormatError(f"{path}: {error}") from error


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write triangles, with heights as the third coordinate."""
    wanted.refuse(".off files", "edges", "attributes")
    found = content(triangulation, z=wanted.z).bare()
    points = np.zeros((len(found.points), 3))
    points[:, : found.points.shape[1]] = found.points
    lines = ["OFF", f"{len(points)} {len(found.simplices)} 0"]
    lines += [" ".join(map(repr, row)) for row in points.tolist()]
    lines += [" ".join(map(str, (3, *row))) for row in found.simplices.tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
