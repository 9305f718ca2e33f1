"""Predict the size of triangulations and hulls in four to eight dimensions.

Two estimates need only the number of points. For uniform points, the expected number of simplices
per point is known (J. Møller, "Lectures on random Voronoi tessellations", 1994). The number of
facets is at most that of a cyclic polytope (P. McMullen, "The maximum numbers of faces of a convex
polytope", 1970). If the smaller of the two needs only a small fraction of the memory, no sample is
needed. Otherwise samples of increasing size are triangulated, and the sizes of the last two are
extrapolated.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.counting import gigabytes, grouped
from delone._base.numbers import as_positive
from delone.errors import DegenerateInputError
from delone.memory import TooLargeError, free_memory

if TYPE_CHECKING:
    from typing import Any

    from delone._base.types import Floats

__all__ = ["peak_bytes", "require_room", "sample_size"]

# Bytes of a row number, and of a coordinate.
_ROW, _COORDINATE = 4, 8
# The core keeps a record per simplex, and the array of records grows by doubling.
_GROWTH = 2.5
# Inputs that are expected to need less than this fraction of the limit are not sampled.
_SMALL = 1 / 8
# Samples have up to half of the points, and the last has this many simplices: a few seconds.
_MOST = 100_000
# A sample is made smaller if more simplices than this are expected.
_PREDICTED = 1_000_000
# Minimum number of sample points per corner of a simplex.
_FEW = 3


def peak_bytes(simplices: int, d: int) -> int:
    """Return the peak memory of computing this many simplices, including the result."""
    record = _COORDINATE * (d + 2) + 2 * _ROW * (d + 2)
    return int(simplices * (_GROWTH * record + 2 * _ROW * (d + 1)))


def require_room(
    points: Floats, max_bytes: int | None, *, hull: bool = False, limited: bool = True
) -> None:
    """Raise TooLargeError if a triangulation, or a hull, would need more than `max_bytes`.

    The default is the free memory. Classes that are not `limited` have no argument `max_bytes`.
    """
    n, d = points.shape
    limit = free_memory() if max_bytes is None else _as_bytes(max_bytes)
    if limit is None or peak_bytes(_expected(n, d, hull=hull), d) <= _SMALL * limit:
        return
    found = _extrapolated(points, hull=hull)
    if found is None or peak_bytes(found, d) <= limit:
        return
    what = ("facets", "hull") if hull else ("simplices", "triangulation")
    needed = peak_bytes(found, d)
    known = f"max_bytes is {gigabytes(limit)}" if max_bytes else f"{gigabytes(limit)} is free"
    advice = (
        "use fewer points or coordinates"
        if hull
        else "use fewer points or coordinates, or for interpolation "
        'delone.interpolate.Linear(method="lazy"), which needs no triangulation'
    )
    if limited:
        advice += f", or pass max_bytes to {'ConvexHull' if hull else 'Delaunay'}"
    raise TooLargeError(
        f"the {what[1]} of {grouped(n)} points in {d}-D would have about {grouped(found)} "
        f"{what[0]} and take {gigabytes(needed)}, but {known}; {advice}",
        simplices=found,
        nbytes=needed,
        limit=limit,
    )


def _as_bytes(max_bytes: Any) -> int:
    return int(min(as_positive(max_bytes, name="max_bytes"), 2.0**63))


def sample_size(size: int, d: int, *, hull: bool = False) -> int:
    """Return a number of points, at most `size`, that takes a few seconds to triangulate."""
    # Terminates, because few points have few simplices.
    while size > _FEW * (d + 1) and _expected(size, d, hull=hull) > _PREDICTED:
        size = size * 3 // 4
    return size


def _expected(n: int, d: int, *, hull: bool) -> int:
    """Return the expected number for uniform points, or the maximum for any points if smaller."""
    # Points on a sphere have as many hull facets as points in (d - 1)-D have simplices.
    typical = n * _per_point(d - 1 if hull else d)
    return int(min(typical, _cyclic(n, d if hull else d + 1)))


def _per_point(d: int) -> float:
    """Return the number of simplices per point of many uniform points in d dimensions."""
    logarithm = (
        (d + 1) * math.log(2)
        + (d - 1) / 2 * math.log(math.pi)
        + math.lgamma((d * d + 1) / 2)
        - math.lgamma(d * d / 2)
        + d * (math.lgamma((d + 2) / 2) - math.lgamma((d + 1) / 2))
    )
    return math.exp(logarithm) / (d * d * (d + 1))


def _cyclic(n: int, d: int) -> int:
    """Return the number of facets of a cyclic polytope."""
    if d % 2:
        return 2 * math.comb(max(0, n - (d + 1) // 2), d // 2)
    return math.comb(max(0, n - d // 2), d // 2) + math.comb(max(0, n - d // 2 - 1), d // 2 - 1)


def _extrapolated(points: Floats, *, hull: bool) -> int | None:
    """Predict the number of simplices from samples; None if points are too few or degenerate.

    If the number of points doubles, the number of simplices grows by a power of two. The exponent
    decreases toward 1 with the fraction of points near the boundary, which is n^(-1/d).
    """
    n, d = points.shape
    order = np.random.default_rng(0).permutation(n)
    # Half of the points, a quarter and so on, as long as these are enough; smallest first.
    sizes = [n // 2**k for k in range(1, n.bit_length()) if n // 2**k >= _FEW * (d + 1)][::-1]
    counts: list[int] = []
    for size in sizes:
        sample = points[order[:size]]
        try:
            made = _core.hull_n(sample) if hull else _core.triangulate_n(sample)
        except DegenerateInputError:
            return None
        counts.append(len(made.simplices))
        if counts[-1] > _MOST and len(counts) > 1:
            break
    if len(counts) < 2:
        return None
    size, counts = sizes[len(counts) - 1], counts[-2:]
    power = math.log2(counts[1] / counts[0])
    share, doublings = 2 ** (-1 / d), math.log2(n / size)
    excess = (power - 1) * (1 - share**doublings) / (1 - share)
    # The maximum for any set of points.
    most = _cyclic(n, d if hull else d + 1)
    return int(min(counts[1] * 2.0 ** max(0.0, doublings + excess), float(min(most, 10**300))))
