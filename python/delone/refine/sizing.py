"""Size functions: numbers, regions, callables, background meshes and rasters become areas.

A size is an edge length; the cap (largest area) is that of the equilateral triangle with that edge.
Varying sizes are evaluated at the centers of triangles, in rounds: in one round no triangle is
required to become smaller than a quarter of its area, so that a small size at one position does not
spread over a large triangle. Small sizes between the centers of the first, large triangles are
found by a lattice of samples over the domain, which also gives an estimate of the number of
triangles before the start.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.numbers import as_positive
from delone._tiling import measures
from delone._tiling.sizes import checked, evaluator, formatted, is_number, require_region, rounded
from delone.errors import BudgetExceededError, LimitError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.refine.domains import Domain

__all__ = ["EQUILATERAL", "Sizing"]

EQUILATERAL = math.sqrt(3) / 4
# Number of samples along the longer side of the domain's bounding box.
_LATTICE = 128
# Average area of triangles, as a fraction of the cap.
_SHARE = 0.77


class Sizing:
    """The largest allowed area of a triangle, by position and region.

    Domains, areas and positions are divided by `unit`, a power of two; callers and their functions
    use the original coordinates. A size is a LimitError if its square underflows or, without a
    unit, overflows.
    """

    def __init__(self, max_area: Any, size: Any, regions: Indices, unit: float = 1.0) -> None:
        self._by_region = np.full(len(regions), math.inf)
        self._evaluate: Callable[[Floats], Floats] | None = None
        self._unit = unit
        self._set(max_area, regions, "max_area", lambda area: area / unit / unit)
        if isinstance(size, Mapping) or size is None or is_number(size):
            self._set(size, regions, "size", lambda length: _equilateral(length / unit))
        else:
            self._evaluate = evaluator(size)

    def _set(self, given: Any, regions: Indices, name: str, area: Callable[[float], float]) -> None:
        if given is None:
            return
        if not isinstance(given, Mapping):
            self._by_region = np.minimum(self._by_region, self._cap(given, name, area))
            return
        known = set(regions.tolist())
        for region, value in given.items():
            require_region(region, known, name)
            at = np.flatnonzero(regions == region)
            cap = self._cap(value, f"{name} of region {region}", area)
            self._by_region[at] = np.minimum(self._by_region[at], cap)

    def _cap(self, value: Any, name: str, area: Callable[[float], float]) -> float:
        number = as_positive(value, name=name)
        cap = area(number)
        if cap == 0 or (self._unit == 1 and math.isinf(cap) and math.isfinite(number)):
            raise LimitError(_out_of_range(f"{name} {value!r:.80}"))
        return cap

    @property
    def varies(self) -> bool:
        """Whether sizes vary within a region."""
        return self._evaluate is not None

    def at(self, positions: Floats, labels: Indices) -> Floats:
        """Return the areas allowed at positions with given labels."""
        caps = self._by_region[labels]
        if self._evaluate is None or not len(positions):
            return caps
        scaled = positions * self._unit
        sizes = checked(self._evaluate(scaled), scaled)
        with np.errstate(over="ignore", under="ignore"):
            areas = _equilateral(sizes / self._unit)
        # With a unit, no triangle is as large as an area that overflows, so it may be infinite.
        large = np.isinf(areas) & np.isfinite(sizes) & (self._unit == 1)
        lost = np.flatnonzero((areas == 0) | large)
        if lost.size:
            raise LimitError(
                _out_of_range(f"size {sizes[lost[0]]} at {formatted(scaled[lost[0]])}")
            )
        found: Floats = np.minimum(caps, areas)
        return found

    def caps(self, domain: Domain) -> Floats:
        """Return the largest area of each triangle, infinite outside, if sizes do not vary."""
        inside = np.flatnonzero(domain.labels >= 0)
        caps = np.full(len(domain.labels), math.inf)
        caps[inside] = self._by_region[domain.labels[inside]]
        return caps

    def samples(self, domain: Domain, workers: int | None) -> Samples | None:
        """Evaluate sizes on a lattice over a domain; None if sizes do not vary."""
        return Samples(self, domain, workers) if self.varies else None

    def estimate(self, domain: Domain, samples: Samples | None) -> float:
        """Return an estimate of the number of triangles that the sizes alone require."""
        inside = np.flatnonzero(domain.labels >= 0)
        areas = measures.sizes(domain.points, domain.simplices[inside])
        caps = self.at(_centers(domain, inside), domain.labels[inside])
        if not np.isfinite(areas[np.isfinite(caps)]).all():
            raise LimitError(_out_of_range("the area of the domain"))
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            inverse = 1 / caps
            if samples is not None:
                inverse = samples.mean_inverse(domain, inside, inverse)
            # Regions without a cap do not count, even if their area is infinite.
            return float(np.where(inverse > 0, areas * inverse, 0).sum()) / _SHARE

    def require_within(self, domain: Domain, samples: Samples | None, max_points: int) -> None:
        """Raise an error if even triangles as large as allowed need more points than the limit."""
        if samples is None and self._is_ample(domain, max_points):
            return
        triangles = self.estimate(domain, samples)
        least = triangles * _SHARE / 2 - len(domain.points)
        if least > max_points:
            about = max(triangles / 2 - len(domain.points), 0)
            raise BudgetExceededError(
                f"the sizes require about {rounded(triangles)} triangles, that is about "
                f"{rounded(about)} added points, more than max_points={max_points:,}",
                limit=max_points,
                found=int(min(least, 2**62)),
            )

    def _is_ample(self, domain: Domain, max_points: int) -> bool:
        """Whether the smallest triangles could fill the bounding box within half of the limit."""
        least = float(self._by_region.min(initial=math.inf))
        with np.errstate(over="ignore"):
            width, height = np.ptp(domain.points, axis=0).tolist()
        return math.isfinite(width * height) and width * (height / least) < max_points


class Samples:
    """The allowed areas on a lattice over a domain."""

    def __init__(self, sizing: Sizing, domain: Domain, workers: int | None) -> None:
        self._workers = as_workers(workers)
        inside = domain.points[np.unique(domain.simplices[domain.labels >= 0])]
        low, high = inside.min(axis=0), inside.max(axis=0)
        step = float((high - low).max()) / _LATTICE
        axes = [
            a + (np.arange(max(1, math.ceil((b - a) / step))) + 0.5) * step
            for a, b in zip(low.tolist(), high.tolist(), strict=True)
        ]
        x, y = (grid.ravel() for grid in np.meshgrid(*axes))
        self.positions = np.column_stack((x, y))
        triangle = self._triangles(domain)
        kept = (triangle >= 0) & (domain.labels[triangle] >= 0)
        self.positions = np.ascontiguousarray(self.positions[kept])
        self.areas = sizing.at(self.positions, domain.labels[triangle[kept]])

    def _triangles(self, domain: Domain) -> Indices:
        return _core.find_simplex2(
            domain.points, domain.simplices, domain.neighbors, self.positions, self._workers
        )

    def mean_inverse(self, domain: Domain, inside: NDArray[np.intp], own: Floats) -> Floats:
        """Return the mean inverse area in triangles, including the value at their centers."""
        total, count = np.zeros(len(domain.simplices)), np.zeros(len(domain.simplices))
        if len(self.positions):
            triangle = self._triangles(domain)
            np.add.at(total, triangle, 1 / self.areas)
            np.add.at(count, triangle, 1)
        mean: Floats = (total[inside] + own) / (count[inside] + 1)
        return mean


def _centers(domain: Domain, inside: NDArray[np.intp]) -> Floats:
    corners = domain.points[domain.simplices[inside]]
    return np.ascontiguousarray((corners / 3).sum(axis=1))


def _equilateral(length: Any) -> Any:
    return EQUILATERAL * length * length


def _out_of_range(what: str) -> str:
    return f"{what}: its square is beyond the range of doubles; scale the coordinates"
