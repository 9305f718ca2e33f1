"""Meshes for solvers: XDMF and INP (Abaqus) by meshio (extra ``mesh``), and SU2.

Triangles and the segments of a mesh are written, segments with their markers: as named parts of the
boundary in SU2, as values in XDMF.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._values import as_values
from delone.errors import FileFormatError
from delone.extras import require
from delone.io.heights import split_attributes, with_heights
from delone.refine.meshed import Mesh as QualityMesh

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from delone.io.registry import Mesh

__all__ = ["require_libraries", "write_mesh"]

_MODULES = {".xdmf": "xdmf", ".inp": "abaqus"}


def require_libraries(suffix: str) -> None:
    """Import what writing needs."""
    require("meshio", extra="mesh", what="writing meshes")
    if suffix == ".xdmf":
        # meshio imports it for XDMF files that have all data in their text, too.
        require("h5py", extra="mesh", what="writing XDMF files")


def write_mesh(
    path: Path,
    triangulation: Mesh,
    *,
    z: ArrayLike | None = None,
    crs: str | None = None,
    edges: bool = False,
    attributes: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Write triangles, and of a mesh its segments."""
    meshio = require("meshio", extra="mesh", what="writing meshes")
    suffix = path.suffix.lower()
    if edges:
        raise FileFormatError(f"{suffix} files hold triangles, not edges; use .vtu, .msh or .gpkg")
    given = {name: np.asarray(values) for name, values in (attributes or {}).items()}
    if given and suffix != ".xdmf":
        raise FileFormatError(f"{suffix} files hold no attributes; use .vtu or .xdmf")
    of_points, of_cells = split_attributes(given, triangulation.npoints, triangulation.nsimplex)
    heights = as_values(z, triangulation.npoints)
    if suffix == ".su2":
        if heights is not None:
            raise FileFormatError(".su2 files of the plane hold no heights")
        path.write_text(_su2(triangulation), encoding="utf-8")
        return
    points = with_heights(triangulation.points, heights)
    cells, data = _cells(triangulation, suffix)
    if of_cells:
        # Values are of triangles; lines get NaN.
        lines = [np.full(len(block[1]), np.nan) for block in cells[1:]]
        data |= {name: [values, *lines] for name, values in of_cells.items()}
    made = meshio.Mesh(points, cells, point_data=of_points, cell_data=data)
    module = importlib.import_module(f"meshio.{_MODULES[suffix]}")
    if suffix == ".xdmf":
        # Everything in the one file: no second one beside it.
        module.write(path, made, data_format="XML")
    else:
        module.write(path, made)


def _cells(triangulation: Mesh, suffix: str) -> tuple[list[Any], dict[str, list[Any]]]:
    cells: list[Any] = [("triangle", triangulation.simplices)]
    if not isinstance(triangulation, QualityMesh):
        return cells, {}
    markers = triangulation.segment_markers
    cells.append(("line", triangulation.segments))
    if suffix == ".xdmf":
        region = triangulation.region
        return cells, {
            "region": [region, np.full(len(markers), -1, dtype=np.int32)],
            "marker": [np.zeros(len(region), dtype=np.int32), markers],
        }
    return cells, {}


def _su2(triangulation: Mesh) -> str:
    """The text of an SU2 file; its markers are the parts of the boundary."""
    lines = ["NDIME= 2", f"NELEM= {triangulation.nsimplex}"]
    for t, (a, b, c) in enumerate(triangulation.simplices.tolist()):
        lines.append(f"5 {a} {b} {c} {t}")
    lines.append(f"NPOIN= {triangulation.npoints}")
    for i, (x, y) in enumerate(triangulation.points.tolist()):
        lines.append(f"{x!r} {y!r} {i}")
    parts = _boundary(triangulation)
    lines.append(f"NMARK= {len(parts)}")
    for marker, pairs in parts.items():
        lines += [f"MARKER_TAG= {marker}", f"MARKER_ELEMS= {len(pairs)}"]
        lines += [f"3 {a} {b}" for a, b in pairs.tolist()]
    return "\n".join(lines) + "\n"


def _boundary(triangulation: Mesh) -> dict[int, NDArray[np.int32]]:
    """The edges of the boundary by their markers."""
    if not isinstance(triangulation, QualityMesh):
        return {0: triangulation.convex_hull}
    n = triangulation.npoints
    pairs, markers = triangulation.segments, triangulation.segment_markers
    rim = np.isin(_keys(pairs, n), _keys(triangulation.boundary_edges, n))
    return {marker: pairs[rim & (markers == marker)] for marker in np.unique(markers[rim]).tolist()}


def _keys(pairs: NDArray[np.int32], npoints: int) -> NDArray[np.int64]:
    found: NDArray[np.int64] = pairs.min(axis=1).astype(np.int64) * npoints + pairs.max(axis=1)
    return found
