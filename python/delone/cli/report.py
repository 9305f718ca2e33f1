"""The figures of a triangulation, as plain numbers for JSON.

Counts are taken from the arrays, not from formulas, so that comparing them with 2n - h - 2 and 3n -
h - 3 is meaningful.
"""

from __future__ import annotations

import math
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from delone import ConstrainedDelaunay
from delone import Mesh as QualityMesh
from delone.predicates import orient2d
from delone.validation import smallest_angle

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from delone import Delaunay

    Mesh: TypeAlias = Delaunay | ConstrainedDelaunay | QualityMesh

__all__ = ["Stopwatch", "finite_or_none", "geometry", "peak_memory", "repeated_rows", "summary"]

_FIRST_DUPLICATES = 5


class Stopwatch:
    """Seconds of the stages of a command, in order."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Measure the time of a block."""
        start = time.perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start

    def rows(self, points: int, *, others: Mapping[str, int] | None = None) -> list[dict[str, Any]]:
        """Return seconds and points per second by stage; `others` gives other numbers of points."""
        counts = dict.fromkeys(self.seconds, points) | dict(others or {})
        return [
            {
                "name": name,
                "seconds": round(seconds, 6),
                "points_per_second": round(counts[name] / seconds) if seconds > 0 else None,
            }
            for name, seconds in self.seconds.items()
        ]

    def ending(
        self,
        outputs: Iterable[Path] | None,
        points: int,
        *,
        others: Mapping[str, int] | None = None,
    ) -> dict[str, Any]:
        """Return the last figures of a command: stages, outputs and memory."""
        return {
            "stages": self.rows(points, others=others),
            "outputs": [str(path) for path in outputs or ()],
            "peak_memory_bytes": peak_memory(),
        }


def summary(triangulation: Mesh) -> dict[str, Any]:
    """Return counts, those expected from Euler's formula, duplicates, and measures.

    If triangles have been removed, there are no expected numbers.
    """
    n, m = triangulation.npoints, triangulation.nsimplex
    repeated = repeated_rows(triangulation)
    distinct = n - repeated["count"]
    rim = int(np.count_nonzero(triangulation.neighbors < 0))
    edges = (3 * m - rim) // 2 + rim
    whole = _is_whole(triangulation)
    h = rim if whole else len(triangulation.convex_hull)
    used = distinct if whole else len(np.unique(triangulation.simplices))
    angle = smallest_angle(triangulation.points, triangulation.simplices)
    return {
        "points": n,
        "distinct": distinct,
        "duplicates": repeated,
        "hull_vertices": h,
        "triangles": {"count": m, "expected": 2 * distinct - h - 2 if whole else None},
        "edges": {"count": edges, "expected": 3 * distinct - h - 3 if whole else None},
        "mean_degree": 2 * edges / used,
        "smallest_angle_degrees": finite_or_none(angle),
        "area": finite_or_none(area(triangulation)),
        "bounds": [*triangulation.min_bound.tolist(), *triangulation.max_bound.tolist()],
    }


def geometry(points: NDArray[np.float64], simplices: NDArray[np.int32]) -> dict[str, Any]:
    """Return the counts of arbitrary triangles and their smallest angle."""
    clockwise = orient2d(*(points[column] for column in simplices.T)) < 0
    turned = np.where(clockwise[:, None], simplices[:, ::-1], simplices)
    return {
        "points": len(points),
        "triangles": len(simplices),
        "smallest_angle_degrees": finite_or_none(smallest_angle(points, turned)),
    }


def _is_whole(triangulation: Mesh) -> bool:
    """Return whether no triangle of the convex hull has been removed."""
    if isinstance(triangulation, ConstrainedDelaunay | QualityMesh):
        return np.array_equal(triangulation.boundary, triangulation.convex_hull)
    return True


def area(triangulation: Mesh) -> float:
    """Return the area of all triangles."""
    ring = triangulation.points[triangulation.hull]
    with np.errstate(all="ignore"):
        if not _is_whole(triangulation):
            return float(triangulation.areas.sum())
        x, y = (ring - ring[0]).T
        return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def repeated_rows(triangulation: Mesh) -> dict[str, Any]:
    """Return the number of duplicates, and the first ones with their coordinates."""
    of = triangulation.duplicate_of
    repeated = np.flatnonzero(of != np.arange(len(of)))
    rows = repeated[:_FIRST_DUPLICATES]
    places = triangulation.points[rows].tolist()
    first = [
        {"row": row, "same_as": same, **dict(zip("xyz", place, strict=False))}
        for row, same, place in zip(rows.tolist(), of[rows].tolist(), places, strict=True)
    ]
    return {"count": len(repeated), "first": first}


def peak_memory() -> int | None:
    """Return the peak memory of this process in bytes, None if the system does not report it."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return int(peak) if sys.platform == "darwin" else int(peak) * 1024


def finite_or_none(value: float) -> float | None:
    """Return a number that JSON can represent: None for NaN and infinity."""
    return value if math.isfinite(value) else None
