"""Domains to be meshed: a triangulated convex hull with labeled regions and constraint lines.

A `Domain` is both the input and the output of the core, so refinement can be repeated. A line is
the part of an input segment between two consecutive input vertices; the subsegments into which it
is split refer to it by its row. A mesh is converted back to a domain by triangulating it again: the
triangles to the left of a subsegment keep their region.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone._arrays import as_workers
from delone.plane import topology

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone.constrained.segmented import Segmented

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Progress = Callable[[int, float], object]

__all__ = [
    "Counts",
    "Domain",
    "Lines",
    "needles_in",
    "of_constrained",
    "refined",
    "sides_at",
    "sides_of",
    "triangulated",
    "unit_of",
]

# Tail and head of the half-edge opposite vertex k, counter-clockwise.
_TAIL = [1, 2, 0]
_HEAD = [2, 0, 1]
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
    # (m, 3): the line under the edge opposite each vertex, or -1.
    sides: Indices
    lines: Lines


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

    Parameters
    ----------
    base : ConstrainedDelaunay
        The triangulation.
    region : ndarray of int32, shape (m,)
        The region of each of its triangles.
    segment_markers : ndarray of int32, shape (s,)
        A marker for each of its input segments.
    point_markers : ndarray of int32, shape (n,)
        A marker for each of its input points.
    frozen : ndarray of bool, shape (s,)
        Which of its input segments must not be split.

    Returns
    -------
    Domain
        Hull edges that bound the domain without a segment are lines without a source.
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
    hull = np.column_stack((simplices[:, _TAIL][bare], simplices[:, _HEAD][bare]))
    start, rows = made.source_start, made.source
    ends = np.concatenate((made.segments, hull))
    last = np.full(len(hull), start[-1], dtype=np.int64)
    owner = np.repeat(np.arange(len(start) - 1), np.diff(start))
    fixed = np.zeros(len(ends), dtype=bool)
    fixed[owner[frozen[rows]]] = True
    markers = np.zeros(len(ends), dtype=np.int32)
    # The marker is that of the first row that has one: the last value assigned remains.
    marked = np.flatnonzero(segment_markers[rows])[::-1]
    markers[owner[marked]] = segment_markers[rows[marked]]
    geometries = np.full(len(ends), -1, dtype=np.int32)
    geometries[: len(start) - 1] = base.geometry_of_segment[rows[start[:-1]]]
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
        sides=sides_at(simplices, made.constrained | bare, (ends, np.arange(len(ends)))),
        lines=lines,
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
    """Let the core refine a domain.

    Parameters
    ----------
    domain : Domain
        The domain to refine.
    caps : ndarray of float64, shape (m,)
        The largest allowed area of each triangle; triangles that replace it inherit it.
    min_angle : float
        The bound in degrees, below 60.
    max_points : int
        Maximum number of added points.
    circles : bool, optional
        Whether to empty the diametral circles of subsegments, so that all triangles are Delaunay.
    sizes_yield : bool, optional
        Whether triangles may stay too large if only points close to a frozen line would make them
        smaller.
    progress : callable, optional
        Called from time to time with the number of added points and the smallest angle.

    Returns
    -------
    domain : Domain
        The refined domain; its first points are those of the input.
    counts : Counts
        The added points.
    """
    lines = domain.lines
    kinds = circles, sizes_yield
    made = _made(domain, caps, (min_angle, max_points), kinds, progress)
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
        sides=made.sides,
    )
    counts = Counts(made.for_segments, made.for_angles, made.for_sizes, made.exhausted)
    return new, counts


def needles_in(domain: Domain, min_angle: float) -> tuple[Indices, Indices]:
    """Find the needles of a domain that refinement leaves as they are.

    Parameters
    ----------
    domain : Domain
        The refined domain.
    min_angle : float
        The bound in degrees, below 60.

    Returns
    -------
    simplices : ndarray of int32, shape (m, 3)
        The triangles of the domain, possibly in another order.
    needle : ndarray of int32, shape (m,)
        The number of the needle that contains each triangle, or -1.
    """
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
    """Call the core.

    `bounds` are the smallest angle and the maximum number of added points, `kinds` whether
    diametral circles are emptied, and whether sizes yield to segments.
    """
    lines = domain.lines
    segments, line = sides_of(domain.simplices, domain.neighbors, domain.sides)
    return _core.refine2(
        domain.points,
        domain.simplices,
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
    """Return a unit of length in which areas do not overflow or underflow.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.

    Returns
    -------
    float
        A power of two; 1 unless all coordinates are very small or some are very large, and also if
        scaling would round other coordinates.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.refine.domains import unit_of
    >>> unit_of(np.array([(0.0, 3.0)])), unit_of(np.array([(0.0, 2.0**-600)])) == 2.0**-599
    (1.0, True)
    """
    largest = float(np.abs(points).max(initial=0.0))
    if largest == 0 or _USUAL[0] <= largest <= _USUAL[1]:
        return 1.0
    # The unit and its inverse are doubles.
    unit = math.ldexp(1.0, min(max(math.frexp(largest)[1], -1022), 1022))
    return unit if np.array_equal(points / unit * unit, points) else 1.0


def sides_of(simplices: Indices, neighbors: Indices, sides: Indices) -> tuple[Indices, Indices]:
    """Return the subsegments among the edges of triangles, each once, and their lines.

    Parameters
    ----------
    simplices, neighbors : ndarray of int32, shape (m, 3)
        Triangles.
    sides : ndarray of int32, shape (m, 3)
        The line under the edge opposite each vertex, or -1.

    Returns
    -------
    segments : ndarray of int32, shape (q, 2)
        Vertices.
    line : ndarray of int32, shape (q,)
        Lines.
    """
    once = (sides >= 0) & (neighbors < np.arange(len(simplices), dtype=np.int32)[:, None])
    t, k = np.nonzero(once)
    tail, head = simplices[t, np.take(_TAIL, k)], simplices[t, np.take(_HEAD, k)]
    return np.column_stack((tail, head)), sides[t, k]


def triangulated(
    points: Floats, segments: Indices, edges: Indices, labels: Indices, workers: int | None
) -> tuple[_core.ConstrainedTriangulation, Indices]:
    """Triangulate points and subsegments, and restore the labels of the triangles.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    segments : ndarray of int32, shape (q, 2)
        Subsegments.
    edges : ndarray of int32, shape (e, 2)
        Directed subsegments with a labeled triangle to their left.
    labels : ndarray of int32, shape (e,)
        The labels of these triangles.
    workers : int or None
        Number of threads.

    Returns
    -------
    made : ConstrainedTriangulation
        The result of the core.
    label : ndarray of int32, shape (m,)
        The label of each triangle of the hull; -1 in components without such an edge.
    """
    count = as_workers(workers)
    # In this unit, triangles have the same order, in which sums are taken, as with usual
    # magnitudes.
    points = points / unit_of(points)
    made, _ = _core.constrained2(points, segments, False, False, 0, "auto", count)
    simplices, constrained = made.simplices, made.constrained
    component = _core.components2(made.neighbors, constrained)
    t, k = np.nonzero(constrained)
    n = np.int64(len(points))
    keys = simplices[t, np.take(_TAIL, k)] * n + simplices[t, np.take(_HEAD, k)]
    known = edges[:, 0] * n + edges[:, 1]
    order = np.argsort(known)
    place = np.minimum(np.searchsorted(known, keys, sorter=order), len(known) - 1)
    partner = order[place]
    same = known[partner] == keys
    of_component = np.full(int(component.max(initial=-1)) + 1, -1, dtype=np.int32)
    of_component[component[t[same]]] = labels[partner[same]]
    return made, of_component[component]


def sides_at(
    simplices: Indices, constrained: Bools, segments: tuple[Indices, NDArray[np.integer]]
) -> Indices:
    """Return the line under each edge of triangles.

    Parameters
    ----------
    simplices : ndarray of int32, shape (m, 3)
        Triangles.
    constrained : ndarray of bool, shape (m, 3)
        Which edges are subsegments.
    segments : tuple
        The subsegments, (q, 2), and their lines, (q,).

    Returns
    -------
    ndarray of int32, shape (m, 3)
        The line under the edge opposite each vertex, or -1.
    """
    ends, line = segments
    sides = np.full(simplices.shape, -1, dtype=np.int32)
    if not len(ends):
        return sides
    n = int(simplices.max()) + 1
    t, k = np.nonzero(constrained)
    tail, head = simplices[t, np.take(_TAIL, k)], simplices[t, np.take(_HEAD, k)]
    keys = topology.edge_keys(ends[:, 0], ends[:, 1], n)
    order = np.argsort(keys)
    at = np.searchsorted(keys, topology.edge_keys(tail, head, n), sorter=order)
    sides[t, k] = line[order[at]]
    return sides
