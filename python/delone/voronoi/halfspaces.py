"""The intersection of half-spaces, exactly: whether it has volume and is bounded, and its corners.

A half-space a x + b y + c z + d <= 0 becomes a half-space through the origin in four dimensions,
with a coordinate t in addition to x, y and z, and the intersection, with t >= 0, a cone. Its
extreme rays with t > 0 are the corners, those with t = 0 the directions in which it is unbounded.
The rays come from the double description method (T. S. Motzkin, H. Raiffa, G. L. Thompson and R. M.
Thrall, "The double description method", in: Contributions to the Theory of Games II, 1953; K.
Fukuda and A. Prodon, "Double description method revisited", 1996), in integers: doubles multiplied
by powers of two.

Half-spaces are inserted in a shuffled order, so that k of them create and remove O(k) rays in
expectation; each is compared with all rays, O(k^2) in total, mostly in floating point. Many planes
through one corner cost more: O(k^3) in the worst case.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from delone._base.types import Floats

    Row = tuple[int, ...]

__all__ = ["common_part"]

# Products of values whose sum is at most 8: if they are larger, their floating-point sign is
# correct.
_CERTAIN = 1e-14
# The number of the half-space t >= 0; the others are numbered from 0.
_END = -1
_AXES: list[Row] = [(1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)]


@dataclass(slots=True)
class _Ray:
    """A vector of coprime integers, and the half-spaces that have it on their boundary."""

    at: Row
    on: frozenset[int]


def common_part(halfspaces: Floats) -> tuple[Floats, list[list[int]], list[int]]:
    """Return the corners and faces of the intersection of half-spaces, and the row of each face.

    Rows are a x + b y + c z + d <= 0, finite, (a, b, c) not 0. Corners ascend, correctly rounded;
    faces are counter-clockwise as seen from outside, the smallest corner first; rows ascend, and
    equal ones are listed once, by the first.
    """
    first: dict[Row, int] = {}
    for number, row in enumerate(halfspaces.tolist()):
        first.setdefault(_integers(row), number)
    rows = {number: row for row, number in first.items()}
    rays = _rays(rows)
    ends = [ray for ray in rays if ray.at[3]]
    if not ends:
        raise InputError("the half-spaces of clip have no point in common")
    if frozenset.intersection(*(ray.on for ray in rays)):
        raise InputError("the half-spaces of clip have no volume in common: it is flat")
    free = [ray.at for ray in rays if not ray.at[3]]
    if free:
        largest = max(map(abs, free[0]))
        direction = ", ".join(f"{x / largest:.6g}" for x in free[0][:3])
        raise InputError(
            f"the intersection of the half-spaces of clip is unbounded in the direction "
            f"({direction})"
        )
    return _polyhedron(rows, ends)


def _integers(row: Iterable[float]) -> Row:
    """Return the coprime integers of which the numbers of a row are a multiple."""
    parts = [x.as_integer_ratio() for x in row]
    unit = max(below for _, below in parts)
    return _coprime(above * (unit // below) for above, below in parts)


def _coprime(numbers: Iterable[int]) -> Row:
    found = tuple(numbers)
    common = math.gcd(*found)
    return tuple(x // common for x in found)


def _product(row: Row, at: Row) -> int:
    return sum(x * y for x, y in zip(row, at, strict=True))


def _normal(a: Row, b: Row, c: Row) -> Row:
    """Return the 4-D vector orthogonal to three others, zero if these are linearly dependent."""
    found = []
    for k in range(4):
        (a0, a1, a2), (b0, b1, b2), (c0, c1, c2) = (v[:k] + v[k + 1 :] for v in (a, b, c))
        minor = a0 * (b1 * c2 - b2 * c1) - a1 * (b0 * c2 - b2 * c0) + a2 * (b0 * c1 - b1 * c0)
        found.append(-minor if k % 2 else minor)
    return tuple(found)


def _rays(halfspaces: dict[int, Row]) -> list[_Ray]:
    """Return the extreme rays of the cone.

    If the normals do not span 3-D, the cone contains lines and has no extreme rays; half-spaces
    along the axes cut these lines in half. That does not change whether there are points or volume,
    and an unbounded direction remains.
    """
    rows: dict[int, Row] = {_END: (0, 0, 0, -1)} | halfspaces
    rows |= {-2 - k: row for k, row in enumerate(_AXES[:3])}
    basis: list[int] = []
    # t >= 0 comes first, and the axes only if nothing else is left.
    for number in [_END, *halfspaces, -2, -3, -4]:
        if len(basis) < 4 and _independent([rows[i] for i in (*basis, number)]):
            basis.append(number)
    cone = _Cone()
    for number in basis:
        others = [i for i in basis if i != number]
        normal = _normal(*(rows[i] for i in others))
        outside = _product(rows[number], normal) > 0
        cone.add(_Ray(_coprime(-x if outside else x for x in normal), frozenset(others)))
    order = [number for number in halfspaces if number not in basis]
    random.Random(0).shuffle(order)
    for number in order:
        cone.cut(number, rows[number])
    return cone.left()


def _independent(rows: list[Row]) -> bool:
    """Tell whether up to four vectors are independent; all but the last are."""
    for fill in combinations(_AXES, 4 - len(rows)):
        a, b, c, d = rows + list(fill)
        if _product(d, _normal(a, b, c)):
            return True
    return False


class _Cone:
    """Extreme rays, and which of them lie on the boundary of each half-space."""

    def __init__(self) -> None:
        self._rays: list[_Ray | None] = []
        self._near: Floats = np.zeros((64, 4))
        self._of: dict[int, set[int]] = {}
        # Numbers of removed rays, for reuse.
        self._free: list[int] = []

    def left(self) -> list[_Ray]:
        return [ray for ray in self._rays if ray is not None]

    def add(self, ray: _Ray) -> None:
        if self._free:
            number = self._free.pop()
            self._rays[number] = ray
        else:
            number = len(self._rays)
            self._rays.append(ray)
        if number == len(self._near):
            self._near = np.concatenate((self._near, np.zeros_like(self._near)))
        self._near[number] = _unit(ray.at)
        for i in ray.on:
            self._of.setdefault(i, set()).add(number)

    def cut(self, number: int, row: Row) -> None:
        """Cut off what lies outside a half-space."""
        near = self._near[: len(self._rays)] @ _unit(row)
        within = near < -_CERTAIN
        beyond: list[int] = np.flatnonzero(near > _CERTAIN).tolist()
        for i in np.flatnonzero(np.abs(near) <= _CERTAIN).tolist():
            ray = self._rays[i]
            if ray is None:
                continue
            value = _product(row, ray.at)
            if value < 0:
                within[i] = True
            elif value > 0:
                beyond.append(i)
            else:
                ray.on |= {number}
                self._of.setdefault(number, set()).add(i)
        new = [
            self._between(number, row, i, j) for j in beyond for i in self._beside(j) if within[i]
        ]
        for j in beyond:
            for i in self._ray(j).on:
                self._of[i].discard(j)
            self._rays[j] = None
            self._near[j] = 0
        self._free += beyond
        for ray in new:
            self.add(ray)

    def _ray(self, i: int) -> _Ray:
        ray = self._rays[i]
        assert ray is not None
        return ray

    def _beside(self, j: int) -> list[int]:
        """Return the rays adjacent to one: no other ray is on all boundaries that both are on."""
        on = self._ray(j).on
        seen: dict[int, int] = {}
        for i in on:
            for other in self._of[i]:
                seen[other] = seen.get(other, 0) + 1
        found = []
        for i, times in seen.items():
            if i == j or times < 2:
                continue
            both = on & self._ray(i).on
            fewest = min((self._of[k] for k in both), key=len)
            if not any(k not in (i, j) and both <= self._ray(k).on for k in fewest):
                found.append(i)
        return found

    def _between(self, number: int, row: Row, i: int, j: int) -> _Ray:
        within, beyond = self._ray(i), self._ray(j)
        v, w = -_product(row, within.at), _product(row, beyond.at)
        at = _coprime(w * x + v * y for x, y in zip(within.at, beyond.at, strict=True))
        return _Ray(at, (within.on & beyond.on) | {number})


def _unit(numbers: Row) -> list[float]:
    """Return a vector in doubles whose largest component is 1."""
    largest = max(map(abs, numbers))
    return [x / largest for x in numbers]


def _polyhedron(
    rows: dict[int, Row], rays: list[_Ray]
) -> tuple[Floats, list[list[int]], list[int]]:
    """Return corners and faces of a bounded polyhedron from its rays."""
    try:
        corners = np.array([[x / ray.at[3] for x in ray.at[:3]] for ray in rays]) + 0.0
    except OverflowError:
        raise InputError("a corner of clip is beyond the range of doubles") from None
    order = _ascending(corners, rays)
    corners, rays = corners[order], [rays[i] for i in order]
    of: dict[int, set[int]] = {number: set() for number in rows}
    for corner, ray in enumerate(rays):
        for number in ray.on:
            of[number].add(corner)
    # Half-spaces that touch only an edge or a corner have no face.
    made = {number: mine for number, mine in sorted(of.items()) if len(mine) > 2}
    faces = []
    for number, mine in made.items():
        beside = {i for corner in mine for i in rays[corner].on} & made.keys() - {number}
        turn = _around([mine & made[i] for i in beside])
        a, b, c = (rays[i].at for i in turn[:3])
        # Vectors from a, times positive numbers.
        p, q = ([y * a[3] - x * to[3] for x, y in zip(a, to, strict=True)] for to in (b, c))
        normal = (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
        outward = sum(x * y for x, y in zip(rows[number][:3], normal, strict=True)) > 0
        faces.append(turn if outward else [turn[0], *turn[:0:-1]])
    return corners, faces, list(made)


def _ascending(corners: Floats, rays: list[_Ray]) -> list[int]:
    """Return the order of corners by exact coordinates, which decide if doubles are equal."""
    if len(np.unique(corners[:, 0])) == len(corners):
        found: list[int] = np.argsort(corners[:, 0]).tolist()
        return found
    exact = [tuple(Fraction(x, ray.at[3]) for x in ray.at[:3]) for ray in rays]
    return sorted(range(len(rays)), key=exact.__getitem__)


def _around(edges: list[set[int]]) -> list[int]:
    """Return the cycle of edges, which are pairs of corners; sets of another size are skipped."""
    beside: dict[int, list[int]] = {}
    for edge in edges:
        if len(edge) == 2:
            p, q = edge
            beside.setdefault(p, []).append(q)
            beside.setdefault(q, []).append(p)
    start = min(beside)
    turn, now = [start], beside[start][0]
    while now != start:
        turn.append(now)
        p, q = beside[now]
        now = q if p == turn[-2] else p
    return turn
