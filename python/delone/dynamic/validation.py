"""Validation of live triangulations with segments: of their arrays, not those of a new build.

The core checks the current triangles; pairs with a segment between them need not be locally
Delaunay. A new `ConstrainedDelaunay` of the same points and segments determines which edges
segments must consist of, and where they cross. If exactly these edges are constrained, the locally
Delaunay triangles are unique.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone import _core
from delone._base.duplicates import first_rows
from delone._tiling.plane.topology import among, edge_keys
from delone.constrained import ConstrainedDelaunay
from delone.constrained.validation import ConstrainedReport
from delone.validation import fault, not_across

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats
    from delone.validation import Sentences

    Handles = NDArray[np.int64]

__all__ = ["DynamicReport", "validate"]


@dataclass(frozen=True, eq=False, kw_only=True)
class DynamicReport(ConstrainedReport):
    """The result of ``Dynamic.validate()`` with segments: truthy if the current state is correct.

    Every field is an array of faulty elements, which is empty if there are none. Triangles and
    points are rows of the current arrays. The fields of `ConstrainedReport` mean the same as there;
    `uncovered` contains the handles of segments, `absent` the edges of segments that are not edges
    of triangles, and `bent` is always empty, because each edge is known.

    Parameters
    ----------
    orientation, edges, neighbors, hull, missing, repeats, delaunay, ties, count : ndarray of int
        As in `ValidationReport`.
    flags, absent, uncovered, bent : ndarray of int
        As in `ConstrainedReport`.
    surplus : ndarray of int, shape (k,)
        Rows of points that are not crossings of segments, and were not inserted.
    crossings : ndarray of int, shape (k, 3)
        Rows of ``Dynamic.crossings`` that are wrong or missing; for a missing one, the handle is -1
        if there is no point.

    Attributes
    ----------
    ok : bool
        True if there are no faults.

    Examples
    --------
    >>> from delone import Dynamic
    >>> live = Dynamic([(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 2), (1, 3)], crossing="split")
    >>> report = live.validate()
    >>> report.ok, len(report.surplus)
    (True, 0)
    """

    surplus: NDArray[np.integer] = fault(
        "point is not a crossing of segments", "points are not crossings of segments"
    )
    crossings: NDArray[np.integer] = fault("crossing is wrong", "crossings are wrong", width=3)

    _SAID: ClassVar[Sentences] = {
        "uncovered": ("segment is not covered", "segments are not covered")
    }


def validate(made: Any, own: Any, *, split: bool, workers: int | None) -> DynamicReport:
    """Check the arrays `made` of a live triangulation with the segments `own`."""
    points, simplices, neighbors = made.points, made.simplices, made.neighbors
    faults = _core.validate(points, simplices, neighbors)
    given = np.flatnonzero(~np.isin(made.handles, own.added))
    ends = np.searchsorted(made.handles[given], own.ends).astype(np.int32)
    fresh = ConstrainedDelaunay(
        points[given],
        ends,
        crossing="split" if split else "raise",
        workers=workers,
        planar=True,
    )
    place = _places(fresh.points, points)
    # The edges that must exist, if both of their ends exist.
    wanted = place[fresh.segments]
    there: Bools = np.asarray((wanted >= 0).all(axis=1))
    found = wanted[there]
    keys = edge_keys(found[:, 0], found[:, 1], len(points))
    edges = edge_keys(simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]], len(points))
    marked = edges[made.constrained]
    missed: Bools = ~there
    missed[there] = ~among(keys, marked.ravel())
    known = np.zeros(len(points), dtype=bool)
    known[given] = True
    known[place[place >= 0]] = True
    return DynamicReport._of(
        faults,
        delaunay=not_across(faults.delaunay, neighbors, made.constrained),
        ties=not_across(faults.ties, neighbors, made.constrained),
        flags=np.flatnonzero((among(edges, keys) != made.constrained).any(axis=1)),
        absent=found[~among(keys, edges.ravel())],
        uncovered=own.handles[_sources(fresh, missed)],
        surplus=np.flatnonzero(~known),
        crossings=_wrong_crossings(fresh, place, made.handles, own),
    )


def _places(fresh: Floats, points: Floats) -> NDArray[np.int64]:
    """Return for each point of a new triangulation the first row of the same point; -1 if none."""
    first = np.asarray(first_rows(np.concatenate((points, fresh))))[len(points) :]
    found: NDArray[np.int64] = np.where(first < len(points), first, -1).astype(np.int64)
    return found


def _sources(fresh: ConstrainedDelaunay, missed: Bools) -> NDArray[np.int64]:
    """Return the rows of the segments that have one of these subsegments."""
    start, source = fresh.segment_source
    return np.unique(source[np.repeat(missed, np.diff(start))]).astype(np.int64)


def _wrong_crossings(
    fresh: ConstrainedDelaunay, place: NDArray[np.int64], handles: Handles, own: Any
) -> NDArray[np.int64]:
    """Return the crossings that only one of the two has."""
    rows = place[fresh.report.crossings[:, 2]]
    expected = np.column_stack(
        (own.handles[fresh.report.crossings[:, :2]], np.where(rows >= 0, handles[rows], -1))
    )
    both = set(map(tuple, expected.tolist())) ^ set(map(tuple, own.crossings.tolist()))
    return np.array(sorted(both), dtype=np.int64).reshape(-1, 3)
