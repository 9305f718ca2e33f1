"""The arrays of a mesh: triangles of a domain, and the lines under their segments.

A mesh contains only its own triangles. To change it, the whole convex hull is retriangulated as a
`Domain`, which includes the triangles outside, and the core refines that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.counting import counted
from delone._base.immutable import kept, sealed
from delone._tiling.plane import topology
from delone._tiling.triangulation import HullTiling
from delone.refine import domains
from delone.refine.domains import Counts, Domain, Lines, Pieces
from delone.refine.report import reported

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.exchange.parts import Parts
    from delone.refine.report import MeshReport

__all__ = ["MeshState"]


class MeshState(HullTiling):
    """The state of a `delone.Mesh`, and attributes derived from its segments."""

    __slots__ = (
        "_bound",
        "_counts",
        "_ends",
        "_forward",
        "_frozen",
        "_line_geometries",
        "_line_markers",
        "_on",
        "_point_markers",
        "_point_source",
        "_region",
        "_sides",
        "_source",
        "_start",
    )

    _ARRAYS = (*HullTiling._ARRAYS, *(name[1:] for name in __slots__))

    _bound: Floats
    _counts: NDArray[np.int64]
    _ends: Indices
    _forward: Bools
    _frozen: Bools
    _line_geometries: Indices
    _line_markers: Indices
    _on: Indices
    _point_markers: Indices
    _point_source: Indices
    _region: Indices
    _sides: Indices
    _source: Indices
    _start: NDArray[np.int64]

    @classmethod
    def _of(
        cls,
        domain: Domain,
        counts: Counts,
        min_angle: float,
        stages: dict[str, float],
        workers: int | None,
    ) -> Self:
        """Create a mesh from a domain, without triangles outside and unused points."""
        inside = np.flatnonzero(domain.labels >= 0)
        number = np.full(len(domain.labels) + 1, -1, dtype=np.int32)
        number[inside] = np.arange(len(inside), dtype=np.int32)
        used = np.zeros(len(domain.points), dtype=bool)
        used[domain.simplices[inside]] = True
        row = (np.cumsum(used) - 1).astype(np.int32)
        sides = domains.sides_in(domain)[inside]
        lines, line = _only_used(domain.lines, sides, row)
        arrays: dict[str, NDArray[Any]] = {
            "points": domain.points[used],
            "simplices": row[domain.simplices[inside]],
            "neighbors": number[domain.neighbors[inside]],
            "region": domain.regions[domain.labels[inside]],
            "sides": line[sides],
            "on": line[domain.on[used]],
            "point_source": domain.point_source[used],
            "point_markers": domain.point_markers[used],
            "ends": lines.ends,
            "start": lines.start,
            "source": lines.source,
            "forward": lines.forward,
            "frozen": lines.frozen,
            "line_markers": lines.markers,
            "line_geometries": lines.geometries,
            "bound": np.array([min_angle]),
            "counts": np.array([*counts], dtype=np.int64),
        }
        return cls._from_arrays(arrays, stages, workers)

    @property
    def _lines(self) -> Lines:
        return Lines(
            self._ends,
            self._start,
            self._source,
            self._forward,
            self._frozen,
            self._line_markers,
            self._line_geometries,
        )

    def _tiling(self) -> tuple[Indices, Indices]:
        return self._whole[0], self._whole[1]

    @property
    @kept
    def _number(self) -> Indices:
        return topology.rows_among(self._whole[0], self._simplices)

    @property
    @kept
    def _whole(self) -> tuple[Indices, Indices, Indices]:
        """Triangles of the whole hull: vertices, neighbors, rows of regions."""
        edges, label = self._directed
        made, labels = domains.triangulated(
            self._points, self.segments, edges, label, self._workers
        )
        return made.simplices, made.neighbors, labels

    @property
    def _directed(self) -> tuple[Indices, Indices]:
        """The directed subsegments with a triangle to the left, and the row of its region."""
        t, k = np.nonzero(self._sides >= 0)
        label = np.searchsorted(self._regions, self._region[t]).astype(np.int32)
        return np.column_stack(topology.half_edges(self._simplices, t, k)), label

    @property
    @kept
    def _regions(self) -> Indices:
        return sealed(np.unique(self._region))

    def _domain(self) -> Domain:
        """Return the mesh as a domain, the input of the core."""
        simplices, neighbors, labels = self._whole
        return Domain(
            points=self._points,
            point_source=self._point_source,
            point_markers=self._point_markers,
            on=self._on,
            simplices=simplices,
            neighbors=neighbors,
            labels=labels,
            regions=self._regions,
            lines=self._lines,
            walls=Pieces(*self._ordered),
        )

    @property
    def region(self) -> Indices:
        """The region of each triangle, (m,).

        With region seeds, their label, or -1 without one; with geometries, the number of the
        geometry; otherwise, as in `ConstrainedDelaunay.region`.
        """
        return self._region

    @property
    def point_source(self) -> Indices:
        """The input row of each point, (n,); -1 for added points."""
        return self._point_source

    @property
    def point_markers(self) -> Indices:
        """The marker of each point, (n,): its own, or that of a segment that it lies on, or 0."""
        return self._point_markers

    @property
    def nadded(self) -> int:
        """Number of added points."""
        return int(np.count_nonzero(self._point_source < 0))

    @property
    @kept
    def constrained(self) -> Bools:
        """Whether the edge opposite each vertex is part of a segment, (m, 3)."""
        return sealed(self._sides >= 0)

    @property
    @kept
    def _ordered(self) -> tuple[Indices, Indices]:
        """The subsegments in the order of their lines and along them, and their lines."""
        segments, line = domains.sides_of(self._simplices, self._neighbors, self._sides)
        first, last = (self._points[self._ends[line, i]] for i in (0, 1))
        step = last - first
        axis = (np.abs(step[:, 0]) < np.abs(step[:, 1])).astype(np.intp)
        row = np.arange(len(line))
        sign = np.where(step[row, axis] < 0, -1.0, 1.0)
        tail, head = (sign * self._points[segments[:, i]][row, axis] for i in (0, 1))
        turned = tail > head
        segments[turned] = segments[turned][:, ::-1]
        order = np.lexsort((np.minimum(tail, head), line))
        return sealed(np.ascontiguousarray(segments[order])), sealed(line[order])

    @property
    def segments(self) -> Indices:
        """The edges that are part of a segment, (q, 2), in the order of the input and along it.

        Each once, in the direction of the first row that covers it.
        """
        return self._ordered[0]

    @property
    def _segment_line(self) -> Indices:
        return self._ordered[1]

    @property
    @kept
    def segment_source(self) -> tuple[NDArray[np.int64], Indices]:
        """The input rows that cover `segments`, as compressed rows (indptr, indices).

        ``segments[i]`` is part of the rows ``indices[indptr[i]:indptr[i + 1]]`` of the input
        segments, or of none if it is a boundary edge that is not on a segment.
        """
        line = self._segment_line
        counts = np.diff(self._start)[line]
        indptr = np.concatenate(([0], np.cumsum(counts)))
        offset = np.arange(indptr[-1]) - np.repeat(indptr[:-1], counts)
        return sealed(indptr), sealed(self._source[np.repeat(self._start[line], counts) + offset])

    @property
    @kept
    def segment_markers(self) -> Indices:
        """The marker of each of `segments`, (q,): that of its row, 0 without one.

        If geometries are meshed and no markers are given, each ring and line has its own: 1 for the
        first, 2 for the second, and so on.
        """
        return sealed(self._line_markers[self._segment_line])

    @property
    @kept
    def geometry_of_segment(self) -> Indices:
        """The geometry that each of `segments` came from, (q,); -1 for arrays.

        For a segment that several geometries share, it is the first one. `segment_markers`
        distinguishes the rings of one geometry.
        """
        return sealed(self._line_geometries[self._segment_line])

    @property
    @kept
    def report(self) -> MeshReport:
        """Added points by cause, angles reached, and triangles below the bound."""
        return reported(
            self._points,
            self._simplices,
            self._sides,
            self._on,
            self._lines,
            min_angle=float(self._bound[0]),
            counts=self._counts,
            needles=self._needles,
        )

    def _needles(self) -> Indices:
        """Return the needle that contains each triangle, or -1."""
        simplices, needle = domains.needles_in(self._domain(), float(self._bound[0]))
        return needle[topology.rows_among(self._simplices, simplices)[:-1]]

    @property
    @kept
    def _inner(self) -> Bools:
        """Points that were added inside: neither on a line nor, like crossings, at its end."""
        found = (self._point_source < 0) & (self._on < 0)
        found[self._ends] = False
        return sealed(found)

    @property
    @kept
    def _below(self) -> NDArray[np.int64]:
        """Triangles below the bound."""
        return self.report.below

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        return Parts(
            self._points,
            self._simplices,
            of_points={"marker": self._point_markers},
            of_simplices={"region": self._region},
            segments=self.segments,
            of_segments={"marker": self.segment_markers},
            crs=self.crs,
        )

    def _saved(self) -> dict[str, NDArray[Any]]:
        return self._arrays() | {"duplicates": np.empty((0, 2), dtype=np.int32)}

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls._from_arrays({name: arrays[name] for name in cls._ARRAYS})

    def _described(self) -> str:
        points = f"{counted(self.npoints, 'point')} ({self.nadded} added)"
        return f"{points}: {counted(self.nsimplex, 'triangle')}"


def _only_used(lines: Lines, sides: Indices, row: Indices) -> tuple[Lines, Indices]:
    """Keep the lines under edges, and return the new row of each line; the last entry is -1."""
    used = np.zeros(len(lines.ends) + 1, dtype=bool)
    used[sides] = True
    used = used[:-1]
    line = np.full(len(used) + 1, -1, dtype=np.int32)
    line[:-1][used] = np.arange(np.count_nonzero(used), dtype=np.int32)
    counts = np.diff(lines.start)
    covered = np.repeat(used, counts)
    start = np.concatenate(([0], np.cumsum(counts[used])))
    return Lines(
        row[lines.ends[used]],
        start.astype(np.int64),
        lines.source[covered],
        lines.forward[covered],
        lines.frozen[used],
        lines.markers[used],
        lines.geometries[used],
    ), line
