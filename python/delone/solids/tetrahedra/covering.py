"""How often the faces of a surface cover their parts, and in which orientation.

Where faces repeat others or overlap in one plane, `resolve_touches` leaves one triangle of each
part. Winding numbers and parities depend on how many faces there were.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._tiling.space.locking import is_odd
from delone.solids.surface import resolve_touches
from delone.solids.tetmesh.recovery import RECOVERY_COUNTS, RecoveryReport

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone._core import RecoveryCounts
    from delone.solids.surface import ImprintedSurface, SurfaceCheck

__all__ = ["Parts", "counts_of", "of_imprint", "parts_of", "reported"]

_OVERLAPS = ("coplanar overlap", "folded")
_AXES = ((0, 1), (1, 2), (2, 0))


class Parts(NamedTuple):
    """A surface whose triangles meet in vertices and edges only."""

    # (k, 3): the first row of each vertex.
    faces: Indices
    # (k,): the first input face that contains each, ascending.
    source: Indices
    # (k,): how many input faces cover each, and how many more in its orientation than against it.
    number: Rows
    net: Rows


def parts_of(points: Floats, faces: Indices, check: SurfaceCheck, workers: int | None) -> Parts:
    """Return the parts of a surface without crossings; `check` lists all pairs."""
    faces = _first_rows(faces, check)
    special = (check.pairs, check.duplicate_faces, check.collinear, check.repeated_vertices)
    if any(map(len, special)):
        made, source = resolve_touches(points, faces, workers=workers)
        return Parts(made, source, *_cover(points, faces, made, source, check))
    one = np.ones(len(faces), dtype=np.int64)
    return Parts(faces, np.arange(len(faces), dtype=np.int32), one, one)


def _cover(
    points: Floats, faces: Indices, made: Indices, source: Indices, check: SurfaceCheck
) -> tuple[Rows, Rows]:
    """Return how many faces cover each part, and the sum of their orientations."""
    # Faces of the same vertices are one, which counts as often as there are.
    of = np.arange(len(faces))
    of[check.duplicate_faces[:, 0]] = check.duplicate_faces[:, 1]
    count = np.bincount(of, minlength=len(faces))
    ways = np.where(is_odd(faces) == is_odd(faces[of]), 1, -1)
    net = np.bincount(of, ways, minlength=len(faces)).astype(np.int64)
    found_count, found_net = count[source], net[source]
    part, other = _candidates(of, source, check)
    covers, way = _contains(points, faces[other], made[part])
    part, other, way = part[covers], other[covers], way[covers]
    np.add.at(found_count, part, count[other])
    np.add.at(found_net, part, way * net[other])
    return found_count, found_net


def _candidates(of: Rows, source: Indices, check: SurfaceCheck) -> tuple[Rows, Rows]:
    """Return parts and faces other than their sources that overlap these in one plane."""
    pairs = of[check.pairs[np.isin(check.kinds, _OVERLAPS)]]
    pairs = np.unique(np.concatenate((pairs, pairs[:, ::-1])), axis=0)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    start = np.searchsorted(pairs[:, 0], source)
    length = np.searchsorted(pairs[:, 0], source, side="right") - start
    part = np.repeat(np.arange(len(source)), length)
    # Positions within the run of each part.
    within = np.arange(len(part)) - np.repeat(np.cumsum(length) - length, length)
    return part, pairs[start[part] + within, 1]


def _contains(points: Floats, faces: Indices, parts: Indices) -> tuple[Bools, NDArray[np.int64]]:
    """Return whether faces contain parts in their planes, and 1 for the same orientation or -1.

    A part is inside a face or outside it, so its vertices decide.
    """
    covers = np.zeros(len(faces), dtype=bool)
    way = np.zeros(len(faces), dtype=np.int64)
    todo = np.arange(len(faces))
    for axes in _AXES:
        flat = np.ascontiguousarray(points[:, axes])
        of_face = _turn(flat, *faces[todo].T)
        rows, todo = todo[of_face != 0], todo[of_face == 0]
        sign = of_face[of_face != 0].astype(np.int64)
        way[rows] = sign * _turn(flat, *parts[rows].T)
        inside = np.ones(len(rows), dtype=bool)
        for k in range(3):
            for corner in parts[rows].T:
                a, b = faces[rows, k - 2], faces[rows, k - 1]
                inside &= sign * _turn(flat, a, b, corner) >= 0
        covers[rows] = inside
    return covers, way


def _turn(flat: Floats, a: Indices, b: Indices, c: Indices) -> NDArray[np.int8]:
    return _core.orient2d(flat[a], flat[b], flat[c])


def counts_of(counts: RecoveryCounts, nadded: int) -> dict[str, Any]:
    """Return the counts of a report; some of the points added may have been left out."""
    return {name: getattr(counts, name, nadded) for name in RECOVERY_COUNTS}


def of_imprint(cut: ImprintedSurface | None) -> dict[str, Any]:
    """Return the entries of a report on a surface that was cut at itself, if it was."""
    if cut is None:
        return {}
    return {"imprinted": cut.source.astype(np.int64), "imprint_distance": cut.largest_distance}


def reported(
    entries: dict[str, Any], faces: Indices, parts: Parts, there: Bools, check: SurfaceCheck
) -> RecoveryReport:
    """Return the report, with `entries`, of a mesh that has those parts which are `there`."""
    own = np.bincount(parts.source, minlength=len(faces))
    degenerate = np.union1d(check.collinear, check.repeated_vertices)
    whole = np.zeros(len(faces), dtype=bool)
    ascending = np.sort(_first_rows(faces, check)[parts.source], axis=1)
    whole[parts.source[(ascending == np.sort(parts.faces, axis=1)).all(axis=1)]] = True
    return RecoveryReport(
        **entries,
        duplicate_points=check.duplicate_points,
        subdivided=np.flatnonzero((own > 0) & ~whole),
        repeated=np.setdiff1d(np.flatnonzero(own == 0), degenerate),
        degenerate=degenerate,
        dangling=check.dangling,
        outside=np.unique(parts.source[~there]).astype(np.int64),
    )


def _first_rows(faces: Indices, check: SurfaceCheck) -> Indices:
    """Return faces whose vertices are the first rows with their coordinates."""
    first = np.arange(int(faces.max(initial=-1)) + 1, dtype=np.int32)
    rows, firsts = check.duplicate_points.T
    used = rows < len(first)
    first[rows[used]] = firsts[used]
    return first[faces]
