"""Facets of the hull of dual points, merged where half-spaces meet exactly in one point.

Dual points are rounded, so their hull has several simplices where the boundaries of more than d
half-spaces meet in one point. Whether d + 1 boundaries do is decided by the sign of a determinant
of the half-spaces themselves: in floating point if that is certain, otherwise in integers. Adjacent
simplices whose half-spaces meet in one point form one facet. A simplex whose own half-spaces share
a line exists only because of rounding, and belongs to an adjacent facet.
"""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from delone._types import Bools, Floats, Indices, Rows

__all__ = ["Dual", "Facets", "first_of_equal", "rounded"]

# Determinants of up to four rows of numbers of at most 1, with one in each row off by less than
# 1e-14: these errors change a determinant by less than 3e-13, and so does the rounding of
# elimination.
_CERTAIN = 1e-12
# If the determinant of the normals is larger, the intersection loses less than five digits.
_STEEP = 1e-5


class Facets(NamedTuple):
    """Facets of the dual hull."""

    # The half-spaces of each facet, counter-clockwise as seen from outside.
    vertices: list[tuple[int, ...]]
    # For each facet, a simplex whose half-spaces meet in one point or are parallel.
    simplex: Rows


class Dual:
    """The simplices of the hull of dual points.

    `rows`, (k, d + 1), are half-spaces ``a @ x + b <= 0``; `slack`, (k,), is ``a @ p + b`` at the
    interior point p, with a relative error below 1e-14. `simplices`, (m, d), are rows of
    half-spaces, triangles counter-clockwise from outside; `neighbors`, (m, d), share all vertices
    but one.
    """

    def __init__(
        self,
        rows: Floats,
        point: Floats,
        slack: Floats,
        simplices: Indices,
        neighbors: Indices,
    ) -> None:
        self._rows, self._point = rows, point
        self._simplices, self._neighbors = simplices, neighbors
        # Moving the origin to p and scaling rows and a column preserve the signs of determinants.
        with np.errstate(all="ignore"):
            size = np.abs(rows[:, :-1]).max(axis=1)
            exponent = np.frexp(np.where(size > 0, size, np.abs(slack)))[1]
            offset = np.ldexp(slack, -exponent)
            self._unit = 2.0 ** np.frexp(np.abs(offset[simplices]).max())[1]
            normals = np.ldexp(rows[:, :-1], -exponent[:, None])
            self._filter = np.column_stack((normals, offset / self._unit))

    def facets(self, *, triangulated: bool) -> Facets:
        """Merge simplices into facets, in the order of their first simplices.

        `triangulated` splits facets of more than three half-spaces into triangles again.
        """
        flat = self._flat()
        label = self._labels(flat)
        extreme = self._extreme(label)
        groups = defaultdict(list)
        for simplex, of in enumerate(label.tolist()):
            groups[of].append(simplex)
        vertices: list[tuple[int, ...]] = []
        places = []
        for of, simplices in groups.items():
            ring = [row for row in self._around(simplices, label) if row in extreme]
            cells = [tuple(ring)]
            if triangulated:
                cells = [(ring[0], *ring[k : k + 2]) for k in range(1, len(ring) - 1)] or cells
            vertices += cells
            places += [of] * len(cells)
        return Facets(vertices, np.array(places, dtype=np.int64))

    def _flat(self) -> Bools:
        """Find triangles whose half-spaces share a line; there are none in 2-D."""
        flat = np.zeros(len(self._simplices), dtype=bool)
        if self._simplices.shape[1] == 2:
            return flat
        minors = [
            np.abs(np.linalg.det(self._filter[self._simplices][..., list(columns)]))
            for columns in combinations(range(4), 3)
        ]
        for t in np.flatnonzero(~(np.max(minors, axis=0) > _CERTAIN)).tolist():
            matrix = [_exact(self._rows[row]) for row in self._simplices[t].tolist()]
            flat[t] = all(
                _determinant([[row[k] for k in columns] for row in matrix]) == 0
                for columns in combinations(range(4), 3)
            )
        return flat

    def _labels(self, flat: Bools) -> Rows:
        """Label simplices by facet, with the first simplex that is not flat."""
        t, k = np.nonzero(self._neighbors > np.arange(len(self._simplices))[:, None])
        u = self._neighbors[t, k]
        both = ~flat[t] & ~flat[u]
        t, k, u = t[both], k[both], u[both]
        shared = self._simplices[t].sum(axis=1) - self._simplices[t, k]
        apex = self._simplices[u].sum(axis=1) - shared
        near = _signs(self._filter, self._rows, np.column_stack((self._simplices[t], apex))) == 0
        label = np.arange(len(self._simplices))
        for a, b in zip(t[near].tolist(), u[near].tolist(), strict=True):
            one, other = _root(label, a), _root(label, b)
            label[max(one, other)] = min(one, other)
        for a in np.flatnonzero(~flat).tolist():
            label[a] = _root(label, a)
        self._adopt(label, flat.copy())
        return label

    def _adopt(self, label: Rows, open_: Bools) -> None:
        """Assign flat simplices to an adjacent facet; ends, as each round assigns at least one."""
        while open_.any():
            before = int(np.count_nonzero(open_))
            for t in np.flatnonzero(open_).tolist():
                beside = [u for u in self._neighbors[t].tolist() if not open_[u]]
                if beside:
                    label[t], open_[t] = label[beside[0]], False
            if np.count_nonzero(open_) == before:
                break

    def _extreme(self, label: Rows) -> set[int]:
        """The half-spaces that are not redundant: each has at least d facets."""
        count = self._simplices.shape[1]
        pairs = np.column_stack((self._simplices.ravel(), np.repeat(label, count)))
        row, times = np.unique(np.unique(pairs, axis=0)[:, 0], return_counts=True)
        return set(row[times >= count].tolist())

    def _around(self, simplices: list[int], label: Rows) -> list[int]:
        """The half-spaces around a facet, without those between two of its simplices."""
        if len(simplices) == 1:
            return [int(row) for row in self._simplices[simplices[0]]]
        after: dict[int, int] = {}
        if self._simplices.shape[1] == 2:
            after = dict(self._simplices[simplices].tolist())
            start = (after.keys() - {*after.values()}).pop()
            ring = [start]
            while ring[-1] in after:
                ring.append(after[ring[-1]])
            return ring
        for t in simplices:
            for k, u in enumerate(self._neighbors[t].tolist()):
                if label[u] != label[t]:
                    tail, head = (int(self._simplices[t, (k + i) % 3]) for i in (1, 2))
                    after[tail] = head
        ring = [min(after)]
        # Ends: the rim of a facet is one cycle.
        while (following := after[ring[-1]]) != ring[0] and len(ring) <= len(after):
            ring.append(following)
        return ring

    def corners(self, simplices: Rows) -> Floats:
        """The intersections, (c, d), of simplices that are not flat; infinite where unbounded."""
        rows = self._simplices[simplices]
        found = np.full(rows.shape, np.inf)
        normals = self._filter[..., :-1]
        # The origin is inside the plane of a facet if the normals have the facet's orientation.
        real = np.flatnonzero(_signs(normals, self._rows[:, :-1], rows) > 0)
        rows = rows[real]
        steep = np.abs(np.linalg.det(normals[rows])) > _STEEP
        right = -self._filter[rows[steep], -1:]
        step = np.linalg.solve(normals[rows[steep]], right)[..., 0]
        found[real[steep]] = self._point + step * self._unit
        for i in np.flatnonzero(~steep).tolist():
            found[real[i]] = _meeting([_exact(self._rows[row]) for row in rows[i].tolist()])
        return found


def _root(label: Rows, at: int) -> int:
    while label[at] != at:  # ends: labels go down
        at = int(label[at])
    return at


def first_of_equal(rows: Floats) -> Rows:
    """The rows of half-spaces, none all zero, that are not positive multiples of earlier rows."""
    # Quotients are correctly rounded, so those of multiples are equal; others may be as well.
    quotients = rows / np.abs(rows).max(axis=1, keepdims=True)
    _, group = np.unique(quotients, axis=0, return_inverse=True)
    group = group.reshape(-1)
    crowded = np.bincount(group)[group] > 1
    keep = np.ones(len(rows), dtype=bool)
    seen: set[tuple[Fraction, ...]] = set()
    for i in np.flatnonzero(crowded).tolist():
        exact = _exact(rows[i])
        unit = max(map(abs, exact))
        key = tuple(x / unit for x in exact)
        keep[i] = key not in seen
        seen.add(key)
    return np.flatnonzero(keep)


def _signs(scaled: Floats, rows: Floats, chosen: NDArray[np.integer]) -> NDArray[np.int64]:
    """Signs of the determinants of chosen rows."""
    with np.errstate(all="ignore"):
        value = np.linalg.det(scaled[chosen])
        sign = np.where(value > 0, 1, -1)
    for i in np.flatnonzero(~(np.abs(value) > _CERTAIN)).tolist():
        exact = _determinant([_exact(rows[row]) for row in chosen[i].tolist()])
        sign[i] = (exact > 0) - (exact < 0)
    return sign


def _exact(row: Floats) -> list[Fraction]:
    return [Fraction(x) for x in row.tolist()]


def _determinant(matrix: Sequence[Sequence[Fraction]]) -> Fraction:
    """Expansion by minors of the first row, of at most four."""
    if len(matrix) == 1:
        return matrix[0][0]
    total = Fraction(0)
    for k, first in enumerate(matrix[0]):
        if first:
            rest = [[*row[:k], *row[k + 1 :]] for row in matrix[1:]]
            total += (-first if k % 2 else first) * _determinant(rest)
    return total


def _meeting(rows: list[list[Fraction]]) -> list[float]:
    """The intersection of boundaries, each coordinate rounded once."""
    normals = [row[:-1] for row in rows]
    below = _determinant(normals)
    return [
        rounded(_determinant([[*row[:k], -row[-1], *row[k + 1 : -1]] for row in rows]) / below)
        for k in range(len(rows))
    ]


def rounded(exact: Fraction) -> float:
    """The nearest double, or infinity beyond the range."""
    try:
        return float(exact)
    except OverflowError:
        return float("inf") if exact > 0 else float("-inf")
