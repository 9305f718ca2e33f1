"""Domains to be meshed: a triangulated convex hull with labeled regions and constraint lines.

A `Domain` is both the input and the output of the core, so refinement can be repeated. A line is
the part of an input segment between two consecutive input vertices; the subsegments into which it
is split refer to it by its row. A mesh is converted back to a domain by retriangulation: the
triangles to the left of a subsegment keep their region.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._tiling.plane import topology

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.constrained.segmented import Segmented

    # Called with the number of added points and the smallest angle.
    Progress = Callable[[int, float], object]

__all__ = [
    "Counts",
    "Domain",
    "Lines",
    "Pieces",
    "extended",
    "labels_beside",
    "needles_in",
    "of_constrained",
    "refined",
    "sides_in",
    "sides_of",
    "started",
    "triangulated",
    "unit_of",
]

# Products of four coordinate differences are doubles if the largest coordinate is in this range, as
# in the core.
_USUAL = 1e-60, 1e60


class Lines(NamedTuple):
    """The straight lines between input vertices, and their attributes."""

    # (l, 2): vertices.
    ends: Indices
    # (l + 1,) and (.,): the rows of segments that cover each line, and whether they have its
    # direction.
    start: NDArray[np.int64]
    source: Indices
    forward: Bools
    # (l,)
    frozen: Bools
    markers: Indices
    # The geometry of the first row that covers each line; -1 without one.
    geometries: Indices


class Pieces(NamedTuple):
    """The subsegments of a domain, each once, in any order."""

    # (q, 2): vertices.
    segments: Indices
    # (q,): the line that each is part of.
    line: Indices

    @classmethod
    def of(cls, made: _core.ConstrainedTriangulation) -> Self:
        """Return the subsegments of a triangulation of lines; of lines that overlap, the first."""
        return cls(made.segments, made.source[made.source_start[:-1]])


class Domain(NamedTuple):
    """Triangles of a convex hull, some of which are the domain."""

    points: Floats
    # (n,): the input row of each point; -1 for added points.
    point_source: Indices
    point_markers: Indices
    # (n,): the line that each point was added on, or -1.
    on: Indices
    simplices: Indices
    neighbors: Indices
    # (m,): rows of `regions`; -1 outside.
    labels: Indices
    regions: Indices
    lines: Lines
    # The subsegments; or, as the core returns them, (m, 3): the line under the edge opposite each
    # vertex, or -1.
    walls: Pieces | Indices


class Counts(NamedTuple):
    """Numbers of added points by cause, and whether the limit was reached."""

    segment: int = 0
    angle: int = 0
    size: int = 0
    exhausted: bool = False

    def plus(self, other: Counts) -> Counts:
        """Return the sums; `exhausted` is that of the later counts."""
        return Counts(
            self.segment + other.segment,
            self.angle + other.angle,
            self.size + other.size,
            other.exhausted,
        )

    @property
    def total(self) -> int:
        """Number of all added points."""
        return self.segment + self.angle + self.size


def of_constrained(
    base: Segmented,
    *,
    region: Indices,
    segment_markers: Indices,
    point_markers: Indices,
    frozen: Bools,
) -> Domain:
    """Return the domain of a constrained triangulation: the triangles that it keeps.

    `region` belongs to these triangles, markers and `frozen` (not to be split) to its input
    segments and points. Hull edges that bound the domain without a segment become lines without a
    source.
    """
    made, points = base._made, base.points
    simplices = made.simplices
    labels = np.full(len(simplices), -1, dtype=np.int32)
    inside = slice(None) if base._number is None else base._number[:-1] >= 0
    regions, labels[inside] = np.unique(region, return_inverse=True)
    given = len(points) - base.nadded
    source = np.arange(len(points), dtype=np.int32)
    source[given:] = -1
    bare = (made.neighbors < 0) & ~made.constrained & (labels[:, None] >= 0)
    hull = np.column_stack(topology.half_edges(simplices, *np.nonzero(bare)))
    start, rows = made.source_start, made.source
    ends = np.concatenate((made.segments, hull))
    last = np.full(len(hull), start[-1], dtype=np.int64)
    owner = np.repeat(np.arange(len(start) - 1), np.diff(start))
    fixed = np.zeros(len(ends), dtype=bool)
    fixed[owner[frozen[rows]]] = True
    markers = np.zeros(len(ends), dtype=np.int32)
    # The marker is that of the first row that has one: the last assigned value remains.
    marked = np.flatnonzero(segment_markers[rows])[::-1]
    markers[owner[marked]] = segment_markers[rows[marked]]
    geometries = np.full(len(ends), -1, dtype=np.int32)
    geometries[: len(start) - 1] = base._given.origin.geometries[rows[start[:-1]]]
    lines = Lines(
        ends, np.concatenate((start, last)), rows, made.forward, fixed, markers, geometries
    )
    of_points = np.zeros(len(points), dtype=np.int32)
    of_points[:given] = point_markers
    return Domain(
        points=points,
        point_source=source,
        point_markers=_inherited(of_points, ends, markers),
        on=np.full(len(points), -1, dtype=np.int32),
        simplices=simplices,
        neighbors=made.neighbors,
        labels=labels,
        regions=regions.astype(np.int32),
        lines=lines,
        walls=Pieces(ends, np.arange(len(ends), dtype=np.int32)),
    )


def _inherited(of_points: Indices, ends: Indices, markers: Indices) -> Indices:
    """Give each point without a marker that of the first line that ends there and has one."""
    found = of_points.copy()
    marked = np.flatnonzero(markers)[::-1]
    found[ends[marked].ravel()] = np.repeat(markers[marked], 2)
    found[of_points != 0] = of_points[of_points != 0]
    return found


def refined(
    domain: Domain,
    caps: Floats,
    min_angle: float,
    max_points: int,
    *,
    circles: bool = False,
    sizes_yield: bool = False,
    progress: Progress | None = None,
) -> tuple[Domain, Counts]:
    """Let the core refine a domain, whose points come first in the result.

    `caps` are maximum areas, which new triangles inherit. `circles` empties diametral circles of
    subsegments: all triangles become Delaunay. `sizes_yield` drops sizes that need points close to
    a frozen line.
    """
    kinds = circles, sizes_yield
    return extended(domain, _made(domain, caps, (min_angle, max_points), kinds, progress))


def started(
    domain: Domain, samples: tuple[Floats, Floats], min_angle: float, kinds: tuple[bool, bool]
) -> _core.Refinement2:
    """Pass a domain to the core for a refinement in rounds.

    `samples` are positions and the largest areas there, `kinds` are (circles, sizes_yield).
    """
    lines = domain.lines
    segments, line = _pieces(domain)
    return _core.Refinement2(
        (domain.points, domain.simplices, domain.neighbors, domain.labels, segments, lines.frozen),
        (line, lines.ends, domain.on),
        samples,
        min_angle,
        *kinds,
    )


def extended(domain: Domain, made: _core.RefinedMesh) -> tuple[Domain, Counts]:
    """Return the domain that the core made from another one, and the numbers of added points."""
    lines = domain.lines
    added, on = made.added, made.on
    markers = np.where(on >= 0, lines.markers[on] if len(lines.markers) else 0, 0)
    new = domain._replace(
        points=np.concatenate((domain.points, added)),
        point_source=np.concatenate((domain.point_source, np.full(len(added), -1, np.int32))),
        point_markers=np.concatenate((domain.point_markers, markers.astype(np.int32))),
        on=np.concatenate((domain.on, on)),
        simplices=made.simplices,
        neighbors=made.neighbors,
        labels=made.labels,
        walls=made.sides,
    )
    counts = Counts(made.for_segments, made.for_angles, made.for_sizes, made.exhausted)
    return new, counts


def needles_in(domain: Domain, min_angle: float) -> tuple[Indices, Indices]:
    """Return the triangles of a refined domain, reordered, and the needle of each, or -1."""
    caps = np.full(len(domain.simplices), math.inf)
    # If no point may be added, the core only looks for needles.
    made = _made(domain, caps, (min_angle, 0))
    return made.simplices, made.needles


def _made(
    domain: Domain,
    caps: Floats,
    bounds: tuple[float, int],
    kinds: tuple[bool, bool] = (False, False),
    progress: Progress | None = None,
) -> _core.RefinedMesh:
    """Call the core; `bounds` are (min_angle, max_points), `kinds` (circles, sizes_yield)."""
    lines = domain.lines
    segments, line = _pieces(domain)
    return _core.refine2(
        domain.points,
        domain.simplices,
        domain.neighbors,
        domain.labels,
        np.ascontiguousarray(caps, dtype=np.float64),
        segments,
        lines.frozen,
        *bounds,
        (line, lines.ends, domain.on),
        *kinds,
        progress,
    )


def unit_of(points: Floats) -> float:
    """Return a unit of length, a power of two, in which areas do not overflow or underflow.

    1 unless all coordinates are very small or some are very large, and also if scaling would round
    other coordinates.
    """
    largest = float(np.abs(points).max(initial=0.0))
    if largest == 0 or _USUAL[0] <= largest <= _USUAL[1]:
        return 1.0
    # The unit and its inverse are doubles.
    unit = math.ldexp(1.0, min(max(math.frexp(largest)[1], -1022), 1022))
    return unit if np.array_equal(points / unit * unit, points) else 1.0


def _pieces(domain: Domain) -> Pieces:
    """Return the subsegments of a domain."""
    walls = domain.walls
    if isinstance(walls, Pieces):
        return walls
    return sides_of(domain.simplices, domain.neighbors, walls)


def sides_of(simplices: Indices, neighbors: Indices, sides: Indices) -> Pieces:
    """Return the subsegments under edges of triangles."""
    once = (sides >= 0) & (neighbors < np.arange(len(simplices), dtype=np.int32)[:, None])
    t, k = np.nonzero(once)
    return Pieces(np.column_stack(topology.half_edges(simplices, t, k)), sides[t, k])


def triangulated(
    points: Floats, segments: Indices, edges: Indices, labels: Indices, workers: int | None
) -> tuple[_core.ConstrainedTriangulation, Indices]:
    """Triangulate points and subsegments; return what the core returns and labels of its triangles.

    `edges`, (e, 2), are directed subsegments whose left triangle has one of `labels`, (e,). The
    label is -1 in components without such an edge.
    """
    count = as_workers(workers)
    # In this unit, triangles, and therefore sums, have the same order as with usual magnitudes.
    points = points / unit_of(points)
    made, *_ = _core.constrained2(points, segments, False, False, 0, "auto", count)
    walls = made.simplices, made.neighbors, made.constrained
    return made, labels_beside(walls, edges, labels, len(points))


def labels_beside(
    walls: tuple[Indices, Indices, Bools], edges: Indices, labels: Indices, npoints: int
) -> Indices:
    """Return labels of triangles from labels of directed edges; each is to the left of its edge.

    `walls` are triangles, their neighbors, and which of their sides separate components. The label
    is -1 in components without one of `edges`, (e, 2).
    """
    simplices, neighbors, constrained = walls
    component = _core.components2(neighbors, constrained)
    t, k = np.nonzero(constrained)
    sides = np.column_stack(topology.half_edges(simplices, t, k))
    partner = _core.facet_rows(np.ascontiguousarray(edges, np.int32), sides, npoints, True)
    same = partner >= 0
    of_component = np.full(int(component.max(initial=-1)) + 1, -1, dtype=np.int32)
    of_component[component[t[same]]] = labels[partner[same]]
    return of_component[component]


def sides_in(domain: Domain) -> Indices:
    """Return the line under the edge opposite each vertex of a domain, (m, 3), or -1."""
    walls, simplices = domain.walls, domain.simplices
    if not isinstance(walls, Pieces):
        return walls
    edges = np.stack((simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]]), axis=2).reshape(-1, 2)
    rows = _core.facet_rows(walls.segments, edges, len(domain.points), False)
    return np.append(walls.line, np.int32(-1))[rows].reshape(-1, 3)
