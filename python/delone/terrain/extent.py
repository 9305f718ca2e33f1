"""Where a surface is: inside boundaries, outside holes, or on islands.

Rings are segments of the triangulation, so each triangle is inside or outside a ring as a whole.
This follows from the segments between it and the outside, without coordinates, so it is exact even
for rings that rounding has bent.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._base.counting import counted
from delone._tiling.plane.topology import triangles_among
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.membership import inside
from delone.errors import CrossingSegmentsError
from delone.terrain.gathering import BOUNDARY, HOLE, HULL, ISLAND, off_ground

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats
    from delone.terrain.gathering import Lines
    from delone.terrain.lines import Ring

__all__ = ["Part", "inside_of_rings", "refuse_crossing_rings", "within", "without_outer"]


class Part(NamedTuple):
    """A triangulation, heights of its rows, its triangles of the surface, and soft segments."""

    mesh: ConstrainedDelaunay
    z: Floats
    kept: Bools
    soft: Bools


def inside_of_rings(
    rings: list[Ring], *, workers: int | None = None
) -> tuple[ConstrainedDelaunay, Bools]:
    """Triangulate rings, and return which triangles are inside the polygons."""
    lengths = [len(ring.points) - 1 for ring in rings]
    ends = np.cumsum(np.array(lengths) + 1) - 1
    row = np.delete(np.arange(ends[-1] + 1), ends)
    mesh = ConstrainedDelaunay(
        np.concatenate([ring.points[:, :2] for ring in rings]),
        np.column_stack((row, row + 1)),
        crossing="split",
        workers=workers,
        planar=True,
    )
    polygons = np.repeat([ring.polygon for ring in rings], lengths).astype(np.int32)
    return mesh, inside(mesh, polygons)


def refuse_crossing_rings(what: str, *several: list[Ring]) -> None:
    """Reject polygons whose own rings cross. Those of different polygons may: they are a union."""
    rings = [(kind, ring) for kind, rings in enumerate(several) for ring in rings]
    if not rings:
        return
    mesh, _ = inside_of_rings([ring for _, ring in rings])
    lengths = [len(ring.points) - 1 for _, ring in rings]
    keys = np.array([(kind, ring.polygon) for kind, ring in rings])
    owner = np.repeat(keys, lengths, axis=0)
    crossings = mesh.report.crossings
    crossings = crossings[(owner[crossings[:, 0]] == owner[crossings[:, 1]]).all(axis=1)]
    if not len(crossings):
        return
    places = mesh.points[crossings[:, 2]]
    x, y = places[0]
    raise CrossingSegmentsError(
        f"{what} cross at {counted(len(places), 'place')}, first ({x:.10g}, {y:.10g})",
        pairs=crossings[:, :2],
        points=places,
    )


def within(mesh: ConstrainedDelaunay, lines: Lines) -> Bools:
    """Which triangles are part of the surface."""
    outer, hole, island, hull = (
        inside(mesh, np.where(lines.kinds == kind, lines.polygons, -1).astype(np.int32))
        for kind in (BOUNDARY, HOLE, ISLAND, HULL)
    )
    limited, convex = (bool((lines.kinds == kind).any()) for kind in (BOUNDARY, HULL))
    found: Bools = ((outer | (not limited)) & ~hole) | island
    return found & hull if convex else found


def without_outer(part: Part, lines: Lines) -> Part:
    """Leave out the rows that have no heights: points of rings outside the hull of all heights.

    The triangles of the surface stay the same.
    """
    mesh, z, kept, soft = part
    used = mesh.duplicate_of == np.arange(mesh.npoints)
    bad = used & np.isnan(z)
    if not bad.any():
        return part
    off = np.unique(mesh.simplices[kept])
    off = off[bad[off]]
    if len(off):
        raise off_ground(*mesh.points[off[0]].tolist())
    rows = np.flatnonzero(used & ~bad)
    number = np.full(mesh.npoints, -1, dtype=np.int32)
    number[rows] = np.arange(len(rows), dtype=np.int32)
    start, source = mesh.segment_source
    ours = np.add.reduceat((lines.kinds[source] != HULL).astype(np.int64), start[:-1]) > 0
    on = ~bad[mesh.segments].any(axis=1)
    wanted = number[mesh.simplices[kept]]
    # The hull consists of segments only if triangles next to it would otherwise change.
    for some in (on & ours, on):
        made = ConstrainedDelaunay(
            mesh.points[rows], number[mesh.segments[some]], workers=mesh.workers, planar=True
        )
        found = triangles_among(made.simplices, wanted)
        if np.count_nonzero(found) == len(wanted):
            break
    return Part(made, z[rows], found, soft[some])
