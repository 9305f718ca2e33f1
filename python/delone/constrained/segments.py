"""The input report of constrained triangulations: segments and seeds.

Nothing that can be handled is an error: rows that repeat, overlap, have zero length or pass through
vertices are accepted and reported here. The core finds most of this; repeated and overlapping rows
follow from its arrays.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.immutable import ReadOnly
from delone._tiling.plane.topology import among

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Indices
    from delone._core import ConstrainedTriangulation

__all__ = ["SegmentArrays", "SegmentReport"]

_SHOWN = 5


def _none() -> Indices:
    return np.empty(0, dtype=np.int32)


def _no_pairs() -> Indices:
    return np.empty((0, 2), dtype=np.int32)


def _no_triples() -> Indices:
    return np.empty((0, 3), dtype=np.int32)


@dataclass(frozen=True, eq=False, kw_only=True)
class SegmentReport(ReadOnly):
    """Input report of a constrained triangulation: duplicates, overlaps, crossings.

    Truthy if there is nothing to report: each row of `segments` is one subsegment, no two points
    coincide, and each seed lies in a different region. Every field is an array of findings, which
    is empty if there are none. A "row" is a row of the input array.

    Parameters
    ----------
    duplicates : ndarray of int32, shape (k, 2)
        Rows of points, and the first row with the same coordinates, which is the vertex.
    zero : ndarray of int32, shape (k,)
        Rows of segments of zero length: both ends have the same coordinates.
    repeated : ndarray of int32, shape (k, 2)
        Rows of segments, and the first row with the same two ends, in either direction.
    overlaps : ndarray of int32, shape (k, 2)
        Rows of segments, and the first row with which they share a subsegment without having the
        same two ends. A row may be in several pairs.
    through : ndarray of int32, shape (k, 2)
        Rows of segments, and vertices (rows of points) that lie on them between their ends.
    crossings : ndarray of int32, shape (k, 3)
        Two rows of segments that cross, and the vertex at the crossing.
    steiner : ndarray of int32, shape (k, 2)
        Rows of segments, and vertices on their paths that are neither their own crossings nor
        points exactly on them: vertices that make the triangulation conforming, and vertices
        through which a rounded row passes because it is too close to them to be distinguished from
        them.
    holes_outside, regions_outside : ndarray of int32, shape (k,)
        Rows of seeds that lie in no triangle, for regions also in a removed triangle. They have no
        effect.
    holes_on_segment, regions_on_segment : ndarray of int32, shape (k,)
        Rows of seeds that lie on a segment, and therefore in no region. They have no effect.
    regions_repeated : ndarray of int32, shape (k, 2)
        Rows of seeds, and the earlier row that labels their region.
    open_ends : ndarray of int32, shape (k,)
        With ``boundary="outline"``, vertices outside at which only one segment ends: there the
        outline is open, and what it was meant to enclose is outside.

    Attributes
    ----------
    ok : bool
        True if there is nothing to report.

    Examples
    --------
    >>> from delone import ConstrainedDelaunay
    >>> square = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)]
    >>> mesh = ConstrainedDelaunay(square, [(0, 2), (4, 0), (3, 3)], holes=[(5, 5)])
    >>> bool(mesh.report)
    False
    >>> print(mesh.report)
    1 row of segments has zero length: 2
    1 row of segments overlaps another: 1-0
    1 vertex lies on a segment (row-vertex): 0-4
    1 hole seed lies outside: 0
    """

    duplicates: Indices = field(default_factory=_no_pairs)
    zero: Indices = field(default_factory=_none)
    repeated: Indices = field(default_factory=_no_pairs)
    overlaps: Indices = field(default_factory=_no_pairs)
    through: Indices = field(default_factory=_no_pairs)
    crossings: Indices = field(default_factory=_no_triples)
    steiner: Indices = field(default_factory=_no_pairs)
    holes_outside: Indices = field(default_factory=_none)
    holes_on_segment: Indices = field(default_factory=_none)
    regions_outside: Indices = field(default_factory=_none)
    regions_on_segment: Indices = field(default_factory=_none)
    regions_repeated: Indices = field(default_factory=_no_pairs)
    open_ends: Indices = field(default_factory=_none)

    def __post_init__(self) -> None:
        for each in fields(self):
            array = np.array(getattr(self, each.name), dtype=np.int32)
            object.__setattr__(self, each.name, array)
        super().__post_init__()

    @property
    def ok(self) -> bool:
        """True if there is nothing to report."""
        return all(len(getattr(self, each.name)) == 0 for each in fields(self))

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        lines = []
        for name, (one, many) in _SENTENCES.items():
            found = getattr(self, name)
            if len(found):
                sentence = one if len(found) == 1 else many
                lines.append(f"{len(found)} {sentence}: {_list(found)}")
        return "\n".join(lines) or "nothing to report"


_SENTENCES = {
    "duplicates": ("point repeats an earlier row", "points repeat earlier rows"),
    "zero": ("row of segments has zero length", "rows of segments have zero length"),
    "repeated": ("row of segments repeats another", "rows of segments repeat others"),
    "overlaps": ("row of segments overlaps another", "pairs of rows of segments overlap"),
    "through": (
        "vertex lies on a segment (row-vertex)",
        "vertices lie on segments (row-vertex)",
    ),
    "crossings": (
        "crossing was split (row-row-vertex)",
        "crossings were split (row-row-vertex)",
    ),
    "steiner": (
        "vertex was added to the path of a segment (row-vertex)",
        "vertices were added to the paths of segments (row-vertex)",
    ),
    "holes_outside": ("hole seed lies outside", "hole seeds lie outside"),
    "holes_on_segment": ("hole seed lies on a segment", "hole seeds lie on segments"),
    "regions_outside": ("region seed lies outside", "region seeds lie outside"),
    "regions_on_segment": (
        "region seed lies on a segment",
        "region seeds lie on segments",
    ),
    "regions_repeated": (
        "region seed lies in a region that already has a label",
        "region seeds lie in regions that already have labels",
    ),
    "open_ends": ("end of an outline is open, at vertex", "ends of outlines are open, at vertices"),
}


def _list(found: Indices) -> str:
    shown = [
        "-".join(map(str, each)) if isinstance(each, list) else str(each)
        for each in found[:_SHOWN].tolist()
    ]
    return ", ".join(shown) + (", ..." if len(found) > _SHOWN else "")


def open_ends(segments: Indices, simplices: Indices, npoints: int) -> Indices:
    """Return vertices of no triangle at which only one segment ends, ascending."""
    degree = np.bincount(segments.ravel(), minlength=npoints)
    degree[simplices] = 0
    return np.flatnonzero(degree == 1).astype(np.int32)


class SegmentArrays:
    """The segments, or arcs, of a constrained triangulation: those given, and their parts."""

    __slots__ = ()

    _given: Any
    _made: ConstrainedTriangulation

    @property
    def input_segments(self) -> Indices:
        """The input segments or arcs, (s, 2)."""
        given: Indices = self._given.segments
        return given

    @property
    def segments(self) -> Indices:
        """The subsegments, (q, 2), in the order of the first row that covers them, and along it.

        Each once, in the direction of that row, including those in holes and outside the
        outline.
        """
        return self._made.segments

    @property
    def segment_source(self) -> tuple[NDArray[np.int64], Indices]:
        """The rows that cover subsegments as compressed rows (indptr, indices).

        Subsegment i is part of the rows ``indices[indptr[i]:indptr[i + 1]]`` of `input_segments`,
        ascending. There is more than one if rows repeat or overlap.
        """
        return self._made.source_start, self._made.source

    @property
    def segment_forward(self) -> Bools:
        """For each index of `segment_source`, whether the row has the direction of the subsegment.

        True if the row reaches ``segments[i, 0]`` before ``segments[i, 1]``; always true for the
        first row of each subsegment.
        """
        return self._made.forward

    @property
    def geometry_of_segment(self) -> Indices:
        """The geometry that each of `input_segments` came from, (s,); -1 for arrays."""
        geometries: Indices = self._given.origin.geometries
        return geometries


def repeated_rows(ends: Indices) -> Indices:
    """Return the rows with the same two ends as an earlier one, and the first such row, ascending.

    In `ends`, (s, 2), equal points have the same vertex. Rows of zero length are not included.
    """
    low, high = ends.min(axis=1, initial=2**31 - 1), ends.max(axis=1, initial=-1)
    order = np.lexsort((high, low))
    low, high = low[order], high[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (low[1:] != low[:-1]) | (high[1:] != high[:-1])
    # The sort is stable, so the first of equal rows comes first.
    first = order[np.flatnonzero(new)][np.cumsum(new) - 1]
    later = ~new & (low != high)
    pairs = np.column_stack((order[later], first[later]))
    return pairs[np.argsort(pairs[:, 0])].astype(np.int32)


def listed(made: Any, ends: Indices) -> dict[str, Indices]:
    """Return the fields of a report that the input segments have in the plane and on the sphere.

    In `ends`, (s, 2), equal points have the same vertex.
    """
    repeated = repeated_rows(ends)
    return {
        "duplicates": made.duplicates,
        "zero": made.zero,
        "repeated": repeated,
        "overlaps": overlapping_rows(made.source_start, made.source, repeated),
        "through": made.through,
        "crossings": made.crossings,
    }


def overlapping_rows(start: NDArray[np.int64], source: Indices, repeated: Indices) -> Indices:
    """Return pairs of a row and the first row that covers a common subsegment, ascending.

    Each pair comes once, and pairs with equal ends (`repeated`) do not. The sources are compressed
    rows, ascending for each subsegment.
    """
    if len(source) == 0:
        return _no_pairs()
    first = np.repeat(source[start[:-1]], np.diff(start))
    same = np.arange(int(source.max(initial=-1)) + 1, dtype=np.int32)
    same[repeated[:, 0]] = repeated[:, 1]
    other = same[source] != same[first]
    pairs = np.column_stack((source[other], first[other]))
    return np.unique(pairs, axis=0).astype(np.int32)


def steiner_rows(
    segments: Indices,
    start: NDArray[np.int64],
    source: Indices,
    known: Indices,
    ends: Indices,
) -> Indices:
    """Return row and vertex, ascending, where a path has neither a crossing nor a point on it.

    `known`, (c, 2), contains these crossings and points with their rows; `ends` the ends of each
    row.
    """
    row = np.repeat(source, 2)
    vertex = np.repeat(segments, np.diff(start), axis=0).ravel()
    inside = (vertex != ends[row, 0]) & (vertex != ends[row, 1])
    pairs = np.unique(np.column_stack((row[inside], vertex[inside])), axis=0)
    end = int(vertex.max(initial=0)) + 1
    keys, others = (a[:, 0].astype(np.int64) * end + a[:, 1] for a in (pairs, known))
    return pairs[~among(keys, others)].astype(np.int32)
