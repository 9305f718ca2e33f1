"""Sizes of tetrahedra: numbers, regions, functions and background meshes become edge lengths.

A size is the edge of the largest regular tetrahedron allowed. Varying sizes are evaluated in
rounds, at the centers of new tetrahedra, and at further positions in large ones, so that small
sizes between the centers of the first tetrahedra are found.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.numbers import as_positive
from delone._tiling.sizes import checked, evaluator, is_number, require_region, rounded
from delone.errors import BudgetExceededError

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["Lengths", "length_of"]

# Average volume of tetrahedra, as a fraction of the largest allowed, and tetrahedra per point.
_SHARE = 0.55
_PER_POINT = 5.8
# Tetrahedra with edges longer than this fraction of the mesh are sampled at a lattice of positions.
_LARGE = 1 / 16
_LATTICE = 6


def length_of(volume: Any) -> Any:
    """Return the edge of the regular tetrahedron with a volume."""
    return np.cbrt(6 * math.sqrt(2) * volume)


def _positions() -> Floats:
    """Return barycentric coordinates of the lattice of positions in a tetrahedron, (k, 4)."""
    steps = product(range(1, _LATTICE), repeat=3)
    inner = [(*abc, _LATTICE - sum(abc)) for abc in steps if sum(abc) < _LATTICE]
    return np.array(inner, dtype=np.float64) / _LATTICE


class Lengths:
    """The requested sizes, by position and region.

    Corners, volumes and sizes are divided by `unit`, a power of two, and its cube; callers and
    their functions use the original coordinates.
    """

    def __init__(
        self,
        size: Any,
        max_volume: Any,
        regions: Indices,
        scale: tuple[float, float],
        further: Callable[[Floats], Floats] | None = None,
    ) -> None:
        extent, unit = scale
        self._by_region: dict[int, float] = {}
        self._everywhere = math.inf
        self._functions = [] if further is None else [further]
        self._large = _LARGE * extent
        self._unit = unit
        known = set(regions.tolist())
        self._set(
            max_volume, known, "max_volume", lambda v: float(length_of(v / unit / unit / unit))
        )
        if size is None or isinstance(size, Mapping) or is_number(size):
            self._set(size, known, "size", lambda length: length / unit)
        else:
            self._functions.append(evaluator(size, 3))

    def _set(
        self, given: Any, known: set[int], name: str, length: Callable[[float], float]
    ) -> None:
        if given is None:
            return
        if not isinstance(given, Mapping):
            self._everywhere = min(self._everywhere, length(as_positive(given, name=name)))
            return
        for region, value in given.items():
            require_region(region, known, name)
            own = length(as_positive(value, name=f"{name} of region {region}"))
            self._by_region[region] = min(self._by_region.get(region, math.inf), own)

    @property
    def varies(self) -> bool:
        """Whether sizes vary within a region."""
        return bool(self._functions)

    def at(self, corners: Floats, labels: Indices) -> Floats:
        """Return the requested size at each tetrahedron: the smallest in it; corners (k, 4, 3)."""
        sizes = self._constant(labels)
        if not self.varies or not len(corners):
            return sizes
        sizes = np.minimum(sizes, self._evaluated(corners.mean(axis=1)))
        # Every edge is one of a cycle through the corners, or one of both diagonals.
        ends = corners[:, [1, 2, 3, 0, 2, 3]] - corners[:, [0, 1, 2, 3, 0, 1]]
        large = np.flatnonzero(np.linalg.norm(ends, axis=2).max(axis=1) > self._large)
        if len(large):
            sizes[large] = np.minimum(sizes[large], self._inside(corners[large]).min(axis=1))
        return sizes

    def _constant(self, labels: Indices) -> Floats:
        sizes = np.full(len(labels), self._everywhere)
        for region, length in self._by_region.items():
            at = labels == region
            sizes[at] = np.minimum(sizes[at], length)
        return sizes

    def _evaluated(self, positions: Floats) -> Floats:
        given = positions * self._unit
        sizes = [checked(function(given), given) for function in self._functions]
        smallest: Floats = np.min(sizes, axis=0) / self._unit
        return smallest

    def _inside(self, corners: Floats) -> Floats:
        """Return the sizes at a lattice of positions in each tetrahedron, (m, k)."""
        positions = np.einsum("kc,mcx->mkx", _positions(), corners)
        return self._evaluated(positions.reshape(-1, 3)).reshape(positions.shape[:2])

    def estimate(self, corners: Floats, labels: Indices, volumes: Floats) -> float:
        """Return an estimate of the number of tetrahedra that the sizes require."""
        sizes = self._constant(labels)[:, None]
        if self.varies:
            sizes = np.minimum(sizes, self._inside(corners))
        with np.errstate(divide="ignore", over="ignore"):
            inverse = (sizes**-3.0).mean(axis=1)
        return float((volumes * inverse).sum()) * 6 * math.sqrt(2) / _SHARE

    def require_within(
        self, corners: Floats, labels: Indices, volumes: Floats, max_points: int
    ) -> None:
        """Raise an error if tetrahedra as large as allowed need far more points than the limit."""
        simplices = self.estimate(corners, labels, volumes)
        about = max((simplices - len(corners)) / _PER_POINT, 0.0)
        if about * _SHARE > max_points:
            raise BudgetExceededError(
                f"the sizes require about {rounded(simplices)} tetrahedra, that is about "
                f"{rounded(about)} added points, more than max_points={max_points:,}",
                limit=max_points,
                found=int(min(about, 2**62)),
            )
