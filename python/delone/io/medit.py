"""Medit's MESH files as text: sections with a word, a count and rows of numbers, read by delone.

Polygons and tetrahedra keep their references. Sections with other names are left out.
"""

from __future__ import annotations

import itertools
import re
from typing import TYPE_CHECKING

import numpy as np

from delone.errors import FileFormatError
from delone.io.cells import POLYGONS, SOLIDS, Cells, ReadMesh
from delone.io.numbered import as_markers, as_rows, parsed, read_text

if TYPE_CHECKING:
    from pathlib import Path

    from delone._base.types import Floats

__all__ = ["read"]

_KINDS = {
    **{"Edges": ("line", 2), "Triangles": ("triangle", 3), "Quadrilaterals": ("quad", 4)},
    **{"Tetrahedra": ("tetra", 4), "Hexahedra": ("hexahedron", 8)},
    **{"Prisms": ("wedge", 6), "Pyramids": ("pyramid", 5)},
}
_WORD = re.compile(r"(?<!\S)[A-Za-z]\w*")


def read(path: Path) -> ReadMesh:
    """Read the points and cells of a file."""
    text = "\n".join(read_text(path))
    words = list(_WORD.finditer(text))
    if not words or words[0][0] != "MeshVersionFormatted" or words[0].start():
        raise FileFormatError(f"{path} does not begin with MeshVersionFormatted")
    if words[-1][0] != "End":
        raise FileFormatError(f"{path} has no End at its end: it is cut short")
    ndim, points = 0, np.empty((0, 3))
    cells, markers, regions = [], [], []
    for word, following in itertools.pairwise(words):
        name = word[0]
        if name not in ("Dimension", "Vertices", *_KINDS):
            continue
        numbers = parsed(text[word.end() : following.start()].encode(), path)
        if name == "Dimension":
            ndim = int(numbers[0]) if numbers.tolist() in ([2.0], [3.0]) else 0
        elif name == "Vertices":
            points = _rows(numbers, ndim + 1, name, path)[:, :ndim]
        else:
            kind, width = _KINDS[name]
            rows = _rows(numbers, width + 1, name, path)
            corners = as_rows(rows[:, :width].ravel(), 1, path, len(points)).reshape(-1, width)
            cells.append(Cells(kind, corners))
            if kind in POLYGONS:
                markers.append(as_markers(rows[:, width:], path).ravel())
            elif kind in SOLIDS:
                regions.append(as_markers(rows[:, width:], path, "region").ravel())
    if ndim == 0:
        raise FileFormatError(f"{path} has no Dimension of 2 or 3")
    return ReadMesh(
        points=points,
        cells=cells,
        markers=np.concatenate(markers) if markers else None,
        regions=np.concatenate(regions) if regions else None,
    )


def _rows(numbers: Floats, width: int, name: str, path: Path) -> Floats:
    """Return the numbers after a count as rows, whose number must match it."""
    count = numbers[0] if len(numbers) else -1.0
    if count < 0 or count != len(numbers[1:]) / width:
        raise FileFormatError(
            f"{path} declares {count:g} {name} and has {len(numbers[1:])} numbers of them, "
            f"{width} each: it is truncated or corrupt"
        )
    return numbers[1:].reshape(-1, width)
