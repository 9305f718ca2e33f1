"""Periodic sites: enough copies that queries in one period see the infinite set.

Queries are moved into one period, the window. An edge of a periodic Delaunay triangulation is no
longer than a period in its direction: for a longer edge from p to q, q minus a period would
lie in every circle through p and q on one of its sides, and p plus a period on the other. So each
triangle at the window has its corners less than a period away from it, and copies one period
further on each side make its neighborhood that of the infinite set. Natural neighbors are as far
away as the empty circles are wide; those count when the copies are counted.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._tiling import measures
from delone.errors import InputError, LimitError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows
    from delone.periodic import PeriodicDelaunay

__all__ = ["Repeated", "repeated"]

# Triangles at the window are correct with one period on each side, and their neighbors with two.
_LEAST = 2
# The influence of a site on globally estimated gradients at least halves from each ring of
# neighbors to the next; after this many rings it is below the default tolerance.
_RINGS = 36


class Repeated(NamedTuple):
    """A window of one period, and the offsets of the copies around it."""

    periods: tuple[float | None, float | None]
    low: Floats  # the lower corner of the window
    moves: Floats  # the offset of each copy, (k, 2); that of the first is zero
    duplicate_of: NDArray[np.int32]  # for each site, the first row with the same coordinates

    def copies(self, sites: Floats) -> Floats:
        """All k copies of n sites, (n * k, 2); those of a site are adjacent, itself first."""
        # With this order, copies at equal distances are ordered as their sites.
        with np.errstate(over="ignore"):
            found: Floats = (sites[:, None] + self.moves).reshape(-1, 2)
        if not np.isfinite(found).all():
            raise LimitError("a copy of a site lies beyond the range of doubles")
        return found

    def sites(self, count: int) -> Rows:
        """The site of each copy of `count` sites."""
        return np.repeat(np.arange(count), len(self.moves))

    def unmoved(self, count: int) -> Rows:
        """The copy with offset zero, for each of `count` copies."""
        every = len(self.moves)
        return np.arange(count) // every * every

    def wrapped(self, queries: Floats) -> Floats:
        """Queries moved into the window by whole periods, unless they are not finite.

        The same array if nothing is moved.
        """
        moved = queries
        for axis, length in enumerate(self.periods):
            if length is None:
                continue
            low, along = self.low[axis], queries[:, axis]
            away = np.isfinite(along) & ((along < low) | (along > low + length))
            if away.any():
                moved = queries.copy() if moved is queries else moved
                moved[away, axis] = low + np.mod(along[away] - low, length)
        return moved


def repeated(mesh: PeriodicDelaunay, *, far: bool = False, rings: bool = False) -> Repeated:
    """The copies that the sites of a periodic triangulation need.

    `far`: natural neighbors are needed, which are as far away as empty circles are wide. `rings`:
    gradients are estimated globally, from many rings of neighbors.
    """
    if mesh.weights is not None:
        raise InputError(
            "a periodic triangulation with weights has hidden sites and no natural neighbors: "
            "interpolate on delone.PeriodicDelaunay(points, periods) without weights"
        )
    low = mesh.points.min(axis=0)
    width = _widest(mesh) if far else 0.0
    counts = [
        0 if length is None else _count(mesh, axis, width, rings)
        for axis, length in enumerate(mesh.periods)
    ]
    steps: Any = np.meshgrid(*(np.arange(-k, k + 1) for k in counts), indexing="ij")
    steps = np.stack(steps, axis=-1).reshape(-1, 2)
    # The nearest first, so that the first copy has offset zero.
    steps = steps[np.argsort(np.abs(steps).sum(axis=1), kind="stable")]
    lengths = np.array([length or 0.0 for length in mesh.periods])
    with np.errstate(over="ignore"):
        moves = steps * lengths
    return Repeated(mesh.periods, low, moves, mesh.duplicate_of)


def _count(mesh: PeriodicDelaunay, axis: int, width: float, rings: bool) -> int:
    """Number of copies on each side along an axis."""
    length = mesh.periods[axis]
    assert length is not None
    count = max(_LEAST, math.ceil(width / length) + 1)
    if rings:
        other = mesh.periods[1 - axis] or float(np.ptp(mesh.points[:, 1 - axis]))
        across = math.sqrt(mesh.npoints * length / other) if other else mesh.npoints
        # At the border of a strip rings are wide.
        count = max(count, _LEAST + 1, math.ceil(_RINGS / max(across, 1.0)))
    return count


def _widest(mesh: PeriodicDelaunay) -> float:
    """The diameter of the widest circle in which a query may lie.

    Where there is one period, a circle around a point beyond the strip of the sites meets the strip
    between two sites of its border, which are not farther apart than the period.
    """
    corners = mesh.corners
    count = 3 * mesh.nsimplex
    numbers = np.arange(count, dtype=np.int32).reshape(-1, 3)
    center = measures.circumcenters(corners.reshape(-1, 2), numbers)
    radius = np.hypot(*(center - corners[:, 0]).T)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    inside = np.ones(len(radius), dtype=bool)
    for axis, length in enumerate(mesh.periods):
        if length is None:
            inside &= (center[:, axis] >= low[axis]) & (center[:, axis] <= high[axis])
    return 2 * float(radius[inside].max(initial=0.0))
