"""Validation of constrained triangulations, with the numbers of the elements that are wrong.

The core checks the triangles as it checks those of `Delaunay`; pairs of triangles with a subsegment
between them are then exempt from being locally Delaunay. What remains is whether subsegments, flags
of edges and input rows are consistent, which takes comparisons of integers and signs of exact
predicates.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from delone import _core
from delone._tiling.plane.topology import among, edge_keys
from delone.validation import ValidationReport, fault, not_across

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices

    Rows = NDArray[np.integer]

__all__ = ["ConstrainedReport", "OfSegments"]


@dataclass(frozen=True, eq=False, kw_only=True)
class OfSegments:
    """What reports on triangulations with segments share, in the plane and on the sphere."""

    flags: Rows = fault("triangle has wrong flags", "triangles have wrong flags")
    absent: Rows = fault("subsegment is not an edge", "subsegments are not edges", width=2)
    uncovered: Rows = fault("row of segments is not covered", "rows of segments are not covered")
    bent: Rows = fault("vertex bends a row of segments", "vertices bend rows of segments", width=2)


# The fields of the last base come first.
@dataclass(frozen=True, eq=False, kw_only=True)
class ConstrainedReport(OfSegments, ValidationReport):
    """The result of ``ConstrainedDelaunay.validate()``: truthy if it is correct.

    Every field is an array of faulty elements, which is empty if there are none. Triangles are
    those of the whole convex hull: if some were removed, the numbers are not those of `simplices`.
    The fields of `ValidationReport` mean the same as there, but `delaunay` and `ties` leave out
    pairs of triangles with a subsegment between them.

    Parameters
    ----------
    orientation, edges, neighbors, hull, missing, repeats, delaunay, ties, count : ndarray of int
        As in `ValidationReport`.
    flags : ndarray of int, shape (k,)
        Triangles with an edge that is flagged as part of a segment but is not, or the reverse.
    absent : ndarray of int, shape (k, 2)
        Subsegments that are not edges of triangles.
    uncovered : ndarray of int, shape (k,)
        Rows of segments whose subsegments do not form a path from one end to the other.
    bent : ndarray of int, shape (k, 2)
        Rows of segments, and vertices on their paths that are not exactly on the row. Rows that
        pass through crossings or added vertices may bend, because these are rounded; so may rows
        that a bent row crosses, and all rows of a conforming triangulation.

    Attributes
    ----------
    ok : bool
        True if there are no faults.

    Examples
    --------
    >>> from delone import ConstrainedDelaunay
    >>> report = ConstrainedDelaunay([(0, 0), (1, 0), (0, 1)], [(0, 1)]).validate()
    >>> report.ok, len(report.uncovered)
    (True, 0)
    """

    _SUBJECT: ClassVar[str] = "a canonical constrained Delaunay triangulation"


def validate(
    points: Floats,
    made: _core.ConstrainedTriangulation,
    ends: Indices,
    *,
    conforming: bool = False,
) -> ConstrainedReport:
    """Check the arrays of a constrained triangulation; `ends`, (s, 2), are those of input segments.

    Rows of a conforming triangulation are split: rounding may move such vertices off the row.
    """
    simplices, neighbors = made.simplices, made.neighbors
    faults = _core.validate(points, simplices, neighbors)
    edges = edge_keys(simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]], len(points))
    segments = edge_keys(made.segments[:, 0], made.segments[:, 1], len(points))
    wanted = among(edges, segments)
    return ConstrainedReport._of(
        faults,
        delaunay=not_across(faults.delaunay, neighbors, wanted),
        ties=not_across(faults.ties, neighbors, wanted),
        flags=np.flatnonzero((wanted != made.constrained).any(axis=1)),
        absent=made.segments[~among(segments, edges.ravel())],
        uncovered=uncovered_rows(made, ends, len(points)),
        **({} if conforming else {"bent": _bent(points, made, ends)}),
    )


def _directed(made: _core.ConstrainedTriangulation) -> tuple[Indices, Indices, Indices]:
    """Return row, tail and head of each subsegment in the direction of each of its rows."""
    steps = np.repeat(made.segments, np.diff(made.source_start), axis=0)
    forward = made.forward
    tail = np.where(forward, steps[:, 0], steps[:, 1])
    head = np.where(forward, steps[:, 1], steps[:, 0])
    return made.source, tail, head


def uncovered_rows(made: _core.ConstrainedTriangulation, ends: Indices, npoints: int) -> Indices:
    """Return the rows whose subsegments do not form a simple path from end to end.

    Each vertex except the first must be the head of exactly one subsegment, and each except the
    last the tail of exactly one. Then the subsegments are one path and possibly cycles; cycles
    would be bent. `ends` are those of the rows, and `npoints` counts the vertices of `made`.
    """
    row, tail, head = _directed(made)
    rows = np.arange(len(ends))
    long = ends[:, 0] != ends[:, 1]
    into = np.concatenate((_pair(row, head, npoints), _pair(rows[long], ends[long, 0], npoints)))
    out = np.concatenate((_pair(row, tail, npoints), _pair(rows[long], ends[long, 1], npoints)))
    into, out = np.sort(into), np.sort(out)
    wrong = np.zeros(len(ends), dtype=bool)
    for keys, others in ((into, out), (out, into)):
        wrong[keys[1:][keys[1:] == keys[:-1]] // npoints] = True
        wrong[keys[~among(keys, others)] // npoints] = True
    return np.flatnonzero(wrong).astype(np.int32)


def _pair(row: NDArray[np.integer], vertex: Indices, npoints: int) -> NDArray[np.int64]:
    return row.astype(np.int64) * npoints + vertex


def _bent(points: Floats, made: _core.ConstrainedTriangulation, ends: Indices) -> Indices:
    def is_off(first: Indices, last: Indices, vertex: Indices) -> Bools:
        off: Bools = _core.orient2d(points[first], points[last], points[vertex]) != 0
        # On the line, but not between the ends.
        low = np.minimum(points[first], points[last])
        high = np.maximum(points[first], points[last])
        return off | ((points[vertex] < low) | (points[vertex] > high)).any(axis=1)

    return bent_rows(made, ends, len(points), len(points) - len(made.added), is_off)


def bent_rows(
    made: _core.ConstrainedTriangulation,
    ends: Indices,
    npoints: int,
    ninput: int,
    is_off: Callable[[Indices, Indices, Indices], Bools],
) -> Indices:
    """Return vertices off their row, for rows without a reason to bend.

    Reasons are a crossing, an added vertex, and a row with one of these that bends at the same
    vertex: bent pieces may cross rows that their segments do not meet. Of the `npoints` vertices of
    `made`, those from `ninput` on were added; given `ends` of rows and a vertex for each, `is_off`
    tells whether it is not between them.
    """
    row, tail, head = _directed(made)
    off = is_off(ends[row, 0], ends[row, 1], head)
    may_bend = np.zeros(len(ends), dtype=bool)
    # A crossing may have been rounded to an existing vertex.
    may_bend[made.crossings[:, :2]] = True
    may_bend[row[np.maximum(tail, head) >= ninput]] = True
    count = -1
    while count < (count := int(may_bend.sum())):
        met = np.zeros(npoints, dtype=bool)
        met[tail[may_bend[row]]] = met[head[may_bend[row]]] = True
        may_bend[row[off & met[head]]] = True
    off &= ~may_bend[row]
    return np.unique(np.column_stack((row[off], head[off])), axis=0)
