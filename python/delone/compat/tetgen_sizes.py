"""Background meshes of the package ``tetgen``: tetrahedra with a target size at each point.

The input is a PyVista grid, three arrays, or TetGen's files .node, .ele and .mtr.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_points, as_simplices, require_finite
from delone.errors import DtypeError, FileFormatError, InputError
from delone.io import read_mesh
from delone.io.companions import require_companion
from delone.io.numbered import Numbers
from delone.solids.tetmesh.improvement import improve

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.solids.tetmesh.tetmesh import TetMesh

__all__ = ["background"]

_ARRAY = "target_size"
# The cell type of a tetrahedron in VTK.
_TETRAHEDRON = 10


def background(bgmesh: Any, filename: str | os.PathLike[str]) -> tuple[TetMesh, ArrayLike] | None:
    """Return the background mesh, if there is one, and the length at each of its points.

    `bgmesh` is a grid, or ``(points, simplices, lengths)``; `filename` has no suffix.
    """
    if bgmesh is not None and filename:
        raise InputError("give bgmesh or bgmeshfilename, not both")
    if bgmesh is not None:
        given = bgmesh if isinstance(bgmesh, tuple) else _of_grid(bgmesh)
        if len(given) != 3:
            raise InputError(f"bgmesh must be (points, simplices, lengths), got {len(given)} items")
        points, simplices, lengths = given
        return _checked(points, simplices, lengths, "bgmesh")
    if not filename:
        return None
    try:
        stem = Path(os.fspath(filename))
    except TypeError:
        raise DtypeError(f"bgmeshfilename must be a path, got {filename!r:.80}") from None
    if not stem.name:
        raise InputError(f"bgmeshfilename must end with the name of files, got {filename!r:.80}")
    return _of_files(stem)


def _of_grid(grid: Any) -> tuple[ArrayLike, ArrayLike, ArrayLike]:
    """Return the points, tetrahedra and lengths of a PyVista grid."""
    if not (hasattr(grid, "cells_dict") and hasattr(grid, "point_data")):
        raise DtypeError(
            "bgmesh must be a pyvista.UnstructuredGrid of tetrahedra, or (points, simplices, "
            f"lengths), got {type(grid).__name__}"
        )
    cells = grid.cells_dict
    others = sorted(int(kind) for kind in cells if kind != _TETRAHEDRON)
    if others or _TETRAHEDRON not in cells:
        found = f"cells of VTK's types {others}" if others else "no cells"
        raise InputError(f"bgmesh must have tetrahedra only, got {found}: call its triangulate()")
    if _ARRAY not in grid.point_data:
        raise InputError(f'bgmesh must have the point data "{_ARRAY}", the size at each point')
    return grid.points, cells[_TETRAHEDRON], grid.point_data[_ARRAY]


def _of_files(stem: Path) -> tuple[TetMesh, ArrayLike]:
    """Read ``stem.node``, ``stem.ele`` and ``stem.mtr``."""
    node, ele, sizes = (stem.with_name(f"{stem.name}.{end}") for end in ("node", "ele", "mtr"))
    for beside in (ele, sizes):
        require_companion(node, beside)
    mesh = read_mesh(ele)
    numbers = Numbers(sizes)
    count, columns = numbers.head(2)
    if columns != 1 or count != len(mesh.points):
        raise FileFormatError(
            f"{sizes}: {count} points with {columns} values, but a background mesh has one size "
            f"for each of its {len(mesh.points)} points"
        )
    lengths = numbers.take(count, 1)[:, 0]
    if not numbers.ended:
        raise FileFormatError(f"{sizes} has more than one number for each of its {count} points")
    return _checked(mesh.points, mesh.simplices, lengths, str(stem))


def _checked(
    points: ArrayLike, simplices: ArrayLike, lengths: ArrayLike, name: str
) -> tuple[TetMesh, ArrayLike]:
    """Return a mesh of positively oriented tetrahedra; flat ones are left out."""
    places = as_points(points, ndim=3)
    require_finite(places)
    rows = np.array(as_simplices(simplices, len(places), 3))
    signs = _signs(places, rows)
    # The input may have either orientation.
    rows[signs < 0] = rows[signs < 0][:, [1, 0, 2, 3]]
    rows = np.ascontiguousarray(rows[signs != 0])
    if not len(rows):
        raise InputError(f"{name} has no tetrahedron with a volume")
    try:
        mesh = improve((places, rows), flips=False, smooth=False, max_iter=0)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    return mesh, lengths


def _signs(points: Floats, simplices: Indices) -> NDArray[np.int8]:
    corners = (np.ascontiguousarray(points[simplices[:, k]]) for k in range(4))
    return _core.orient3d(*corners)
