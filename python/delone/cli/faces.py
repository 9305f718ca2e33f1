"""Exact check of a 3-D surface in a file: the figures of ``delone check --surface``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import NonFiniteError, SurfaceCheck, check_surface
from delone.cli.exits import Exit, Failure, reading
from delone.cli.report import Stopwatch, finite_or_none
from delone.io import read_mesh

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from delone.io import MeshFile

__all__ = ["check_faces", "read_faces", "read_parts"]

_FIRST = 10
# Attributes of the result that list the rows of faults.
_FAULTS = (
    "boundary",
    "nonmanifold_edges",
    "misoriented_edges",
    "nonmanifold_vertices",
    "repeated_vertices",
    "collinear",
    "duplicate_faces",
    "duplicate_points",
    "dangling",
)


def read_faces(path: Path, *, quiet: bool) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Read the points, (n, 3), and triangles of a 3-D surface."""
    points, mesh = read_parts(path, quiet=quiet)
    return points, mesh.simplices


def read_parts(path: Path, *, quiet: bool) -> tuple[NDArray[np.float64], MeshFile]:
    """Read the points, (n, 3), and triangles of a surface, its markers, holes and regions."""
    with reading(quiet=quiet):
        mesh = read_mesh(path, polygons="split")
    if mesh.simplices.shape[1] != 3:
        raise Failure(f"{path}: a surface has triangles, not tetrahedra", Exit.USAGE)
    if mesh.z is None:
        raise Failure(f"{path}: a surface has points with three coordinates", Exit.USAGE)
    return np.column_stack((mesh.points, mesh.z)), mesh


def check_faces(
    path: Path, *, say: Callable[[str], None], quiet: bool
) -> tuple[dict[str, Any], list[str]]:
    """Check a surface exactly: figures, with ``ok``, and lines. `say` gets the current step."""
    watch = Stopwatch()
    say(f"reading {path.name}")
    with watch.stage("read"):
        points, faces = read_faces(path, quiet=quiet)
    say(f"checking {len(faces):,} faces")
    with watch.stage("check"):
        try:
            found = check_surface(points, faces)
        except NonFiniteError as error:
            raise Failure(f"{path}: {error}", Exit.DEGENERATE) from error
    figures = {
        "input": str(path),
        "ok": found.ok,
        "points": len(points),
        "faces": found.nfaces,
        "edges": found.nedges,
        "closed": found.closed,
        "oriented": found.oriented,
        "manifold": found.manifold,
        "components": found.ncomponents,
        "regions": found.nregions,
        "volume": finite_or_none(found.volume),
        "volume_sign": found.volume_sign,
        "pairs": _pairs(found),
        "faults": {name: _fault(rows) for name in _FAULTS if len(rows := getattr(found, name))},
        "stages": watch.rows(len(points)),
    }
    return figures, str(found).splitlines()


def _fault(rows: NDArray[np.int64]) -> dict[str, Any]:
    return {"count": len(rows), "first": rows[:_FIRST].tolist()}


def _pairs(found: SurfaceCheck) -> dict[str, Any]:
    # Crossing faces are named first.
    first = np.argsort(~found.crossing, kind="stable")[:_FIRST]
    return {
        "count": found.npairs,
        "crossing": found.ncrossing,
        "kinds": {kind: count for kind, count in found.counts.items() if count},
        "first": [
            {
                "faces": found.pairs[row].tolist(),
                "kind": str(found.kinds[row]),
                "crossing": bool(found.crossing[row]),
            }
            for row in first.tolist()
        ],
    }
