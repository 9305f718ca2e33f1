"""The report of a mesh: added points by cause, angles reached, and triangles below the bound.

Small angles remain where two input lines meet at a small angle: between the lines, and next to the
circles around the corner on which both are split (triangles that the rule of Miller, Pav and
Walkington leaves unrefined). Needles between lines that would take more points than the budget
allows are also left unrefined. Lines that must not be split and a limit on points leave other small
angles.

G. L. Miller, S. E. Pav and N. J. Walkington (2005), "When and why Delaunay refinement algorithms
work", International Journal of Computational Geometry & Applications 15.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.counting import counted, listed
from delone._base.immutable import ReadOnly
from delone._tiling import measures
from delone._tiling.plane import quality

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.refine.domains import Lines

__all__ = ["CAUSES", "MeshReport", "judged", "reported"]

CAUSES = ("corner", "needle", "fixed", "budget", "other")
_CORNER, _NEEDLE, _FIXED, _BUDGET, _OTHER = range(5)
# Distances from a corner count as equal if their relative difference is smaller, as in the core.
_SAME_SHELL = 1e-3
_SHOWN = 5
# In degrees; needles are far thinner, unless they were split from outside.
_THIN = 0.1


@dataclass(frozen=True, eq=False, kw_only=True)
class MeshReport(ReadOnly):
    """The quality of a mesh; truthy if the bound on angles is met everywhere.

    Parameters
    ----------
    min_angle : float
        The requested bound, in degrees.
    smallest_angle, largest_angle : float
        The extreme angles of the mesh, in degrees.
    below : ndarray of int64, shape (k,)
        The triangles with an angle below the bound, compared exactly, ascending.
    corner : ndarray of int64, shape (k,)
        For each of these, the corner of the input that is responsible, a row of points; -1 if none
        is.
    cause : ndarray of str, shape (k,)
        For each of these, ``"corner"``, ``"needle"`` (in or next to one of `needles`), ``"fixed"``
        (a segment that must not be split), ``"budget"`` (the limit on points) or ``"other"`` (lines
        that are too close to each other for doubles, or points that were removed or moved later).
    needles : ndarray of float64, shape (q, 2)
        A position in each needle that was left unrefined, ascending. In a needle, lines are so
        close to each other, over such a length, that good angles would take more than the fraction
        of `max_points` for needles.
    on_segments, for_angles, for_sizes : int
        Numbers of points that were added on segments, inside for angles, and inside for sizes.
    exhausted : bool
        Whether the limit on points was reached.

    Attributes
    ----------
    ok : bool
        True if no triangle has an angle below the bound and the limit was not reached.
    added : int
        Total number of added points.

    Examples
    --------
    >>> import delone
    >>> needle = [(0, 0), (10, 0), (10, 1)], [(0, 1), (1, 2), (2, 0)]
    >>> report = delone.mesh(needle).report
    >>> set(report.corner.tolist()), set(report.cause.tolist())
    ({0}, {'corner'})
    """

    min_angle: float
    smallest_angle: float
    largest_angle: float
    below: NDArray[np.int64]
    corner: NDArray[np.int64]
    cause: NDArray[np.str_]
    needles: Floats
    on_segments: int
    for_angles: int
    for_sizes: int
    exhausted: bool

    @property
    def ok(self) -> bool:
        """True if no triangle has an angle below the bound and the limit was not reached."""
        return not len(self.below) and not self.exhausted

    @property
    def added(self) -> int:
        """Total number of added points."""
        return self.on_segments + self.for_angles + self.for_sizes

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        reached = f"{self.smallest_angle:.4g} to {self.largest_angle:.4g}"
        lines = [
            f"angles from {reached} degrees, requested at least {self.min_angle:.4g}",
            f"{counted(self.added, 'point')} added: {self.on_segments} on segments, "
            f"{self.for_angles} for angles, {self.for_sizes} for sizes",
        ]
        for cause, what in _SENTENCES.items():
            rows = self.below[self.cause == cause]
            if len(rows):
                noun = counted(len(rows), "triangle")
                lines.append(f"{noun} below the bound {what}: {listed(rows, _SHOWN)}")
        corners = np.unique(self.corner[self.corner >= 0])
        if len(corners):
            noun = counted(len(corners), "responsible corner")
            lines.append(f"{noun}: {listed(corners, _SHOWN)}")
        if len(self.needles):
            noun = counted(len(self.needles), "needle")
            shown = listed([f"({x:.6g}, {y:.6g})" for x, y in self.needles.tolist()], _SHOWN)
            lines.append(f"{noun} left unrefined (too many points needed): {shown}")
        if self.exhausted:
            lines.append("stopped at the limit on points")
        return "\n".join(lines)


_SENTENCES = {
    "corner": "at sharp corners",
    "needle": "in or next to needles",
    "fixed": "at fixed segments",
    "budget": "because of the limit on points",
    "other": "for other reasons",
}


def reported(
    points: Floats,
    simplices: Indices,
    sides: Indices,
    on: Indices,
    lines: Lines,
    *,
    min_angle: float,
    counts: NDArray[np.int64],
    needles: Callable[[], Indices],
) -> MeshReport:
    """Create the report of a mesh.

    `counts` are points added on segments, for angles and for sizes, and whether the limit was
    reached. `needles` is called only if there may be some, and returns the needle of each triangle,
    or -1.
    """
    rows, angles = judged(points, simplices, min_angle)
    corner = _responsible(points, simplices[rows], sides[rows], on, lines)
    # Lines that must not be split also keep vertices away from triangles that do not touch them.
    rest = _BUDGET if counts[3] else _FIXED if lines.frozen.any() else _OTHER
    cause = np.where(corner >= 0, _CORNER, rest)
    positions = np.empty((0, 2))
    if (cause != _CORNER).any() or angles[0] < _THIN:
        needle = needles()
        inside = needle[rows] >= 0
        cause[inside], corner[inside] = _NEEDLE, -1
        near = np.zeros(len(points), dtype=bool)
        near[simplices[needle >= 0]] = True
        # From one bad triangle to the next; few of them are outside needles.
        while (more := (cause >= _FIXED) & near[simplices[rows]].any(axis=1)).any():
            cause[more] = _NEEDLE
            near[simplices[rows[more]]] = True
        positions = _positions(points, simplices, needle)
    return MeshReport(
        min_angle=min_angle,
        smallest_angle=angles[0],
        largest_angle=angles[1],
        below=rows,
        corner=corner,
        cause=np.array(CAUSES)[cause],
        needles=positions,
        on_segments=int(counts[0]),
        for_angles=int(counts[1]),
        for_sizes=int(counts[2]),
        exhausted=bool(counts[3]),
    )


def judged(
    points: Floats, simplices: Indices, min_angle: float
) -> tuple[NDArray[np.int64], tuple[float, float]]:
    """Return the triangles below a bound, ascending, and the extreme angles; 180 and 0 if none.

    Linear. Angles are computed only for the few triangles that may have the extreme ones; `quality`
    handles triangles whose squares are beyond the range of doubles.
    """
    cosine = quality.squared_cosine(min_angle)
    judged = _core.judge2(points, simplices, cosine)
    rows, beyond = judged.below.astype(np.int64), judged.beyond
    if len(beyond):
        more = beyond[quality.below(points, simplices[beyond], min_angle)]
        rows = np.union1d(rows, more.astype(np.int64))
    measures = quality.measured(points, simplices[np.concatenate((judged.extremes, beyond))])
    smallest = float(measures.smallest_angle.min(initial=180.0))
    return rows, (smallest, float(measures.largest_angle.max(initial=0.0)))


def _positions(points: Floats, simplices: Indices, needle: Indices) -> Floats:
    """Return the center of the largest triangle of each needle, sorted by coordinates."""
    rows = np.flatnonzero(needle >= 0)
    corners = points[simplices[rows]]
    areas = measures.sizes(points, simplices[rows])
    centers = (corners / 3).sum(axis=1)
    rank = np.lexsort((centers[:, 1], centers[:, 0], areas, needle[rows]))
    last = np.flatnonzero(np.diff(needle[rows][rank], append=-1))
    positions = centers[rank[last]]
    found: Floats = positions[np.lexsort((positions[:, 1], positions[:, 0]))]
    return found


def _responsible(
    points: Floats, simplices: Indices, sides: Indices, on: Indices, lines: Lines
) -> NDArray[np.int64]:
    """Return the corner of the input that is responsible for each triangle, or -1."""
    found = np.full(len(simplices), -1, dtype=np.int64)
    if not len(simplices):
        return found
    row = np.arange(len(simplices))
    apex = quality.smallest_corners(points, simplices)
    left, right = (apex + 1) % 3, (apex + 2) % 3
    between = (sides[row, left] >= 0) & (sides[row, right] >= 0)
    found[between] = simplices[row, apex][between]
    u, v = simplices[row, left], simplices[row, right]
    shared = _shared_end(on[u], on[v], lines.ends)
    c = points[shared]
    d, e = (np.hypot(*(points[w] - c).T) for w in (u, v))
    sharp = np.hypot(*(points[u] - points[v]).T) < np.minimum(d, e)
    spans = (shared >= 0) & sharp & (np.abs(d - e) <= _SAME_SHELL * np.maximum(d, e))
    found[~between & spans] = shared[~between & spans]
    return found


def _shared_end(s: Indices, r: Indices, ends: Indices) -> NDArray[np.int64]:
    """Return the common vertex of two lines, or -1."""
    shared = np.full(len(s), -1, dtype=np.int64)
    if not len(ends):
        return shared
    two = (s >= 0) & (r >= 0) & (s != r)
    for i in (1, 0):
        for j in (1, 0):
            same = two & (ends[s, i] == ends[r, j])
            shared[same] = ends[s, i][same]
    return shared
