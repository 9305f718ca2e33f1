"""Facets of the cone that half-spaces span, exactly: which boundaries meet in the corners.

A half-space ``a @ x + b <= 0`` is the vector (a, b) with d + 1 components. Facets of the cone of
these vectors are corners of the intersection: the plane of a facet has a normal (x t, t), which is
0 on the vectors of half-spaces whose boundaries pass through x, and negative on all others. Dual
points, ``-a / (a @ p + b)``, are a section of the cone; they must be rounded, and the vectors need
not be.

The cone is found as a convex hull in one dimension more, that of the vectors and the origin: facets
through the origin are those of the cone. All coordinates are given doubles, times powers of two, so
the hull of the core decides exactly which boundaries meet in one point. A redundant half-space that
touches a corner or an edge may be a vertex of that hull, but not of the cone: all facets that
contain it contain another vector as well.
"""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core, predicates
from delone._tiling.higher.rational import kernel
from delone._tiling.higher.topology import distinct
from delone.errors import DegenerateInputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from delone._base.types import Floats, Indices, Rows

__all__ = ["Corners", "Facets", "cone_facets", "corners", "first_of_equal", "rounded"]

# With rows of length 1 and a larger determinant, the smallest singular value is at least 0.6 times
# as large, as the others have a product of at most 1.65: a solution loses fewer than six digits.
_STEEP = 1e-5
# The most coordinates of the core's own hulls in space.
_SPACE = 3
# With 10,000 unit normals in 3-D, 8 layers take a quarter of the time of one, and more do not help.
_LAYERS = 8


class Facets(NamedTuple):
    """Facets of a cone, ascending by their half-spaces."""

    # The half-spaces of each facet: in 2-D and 3-D counter-clockwise as seen from outside, else
    # ascending.
    vertices: list[tuple[int, ...]]
    # Of each facet d independent half-spaces, (f, d): the determinant of their normals is positive
    # where the facet is a corner.
    simplex: Rows
    # The sign of that determinant, exactly, (f,).
    sign: Indices


class Corners(NamedTuple):
    """The points of facets."""

    # (f, d); infinite where a facet is not a corner.
    points: Floats
    # Outer unit normals and offsets of the facets of dual points, (f, d + 1).
    equations: Floats


def cone_facets(rows: Floats, slack: Floats, *, triangulated: bool) -> Facets:
    """Return the facets of the cone of half-spaces, which `triangulated` splits into simplices.

    `slack` is ``a @ p + b`` of each at a point p, negative. DegenerateInputError if there is no
    corner.
    """
    kept = first_of_equal(rows)
    d = rows.shape[1] - 1
    points = np.concatenate((np.zeros((1, d + 1)), _leveled(rows[kept], slack[kept])))
    simplices, plane, inside = _hull(points)
    through = np.flatnonzero((simplices == 0).any(axis=1))
    cone = np.flatnonzero(np.isin(plane, plane[through]))
    # Planes through the origin, numbered; vectors in each, ascending; simplices there with the
    # origin.
    number = np.full(int(plane.max()) + 1, -1)
    planes, first = np.unique(plane[through], return_index=True)
    number[planes] = np.arange(len(planes))
    listed = _vectors_of(simplices[cone], number[plane[cone]], len(planes))
    fans = _turned(simplices[through], d)
    extreme = _without_redundant(listed, d)
    rings: dict[int, tuple[int, ...]] = {}
    if d < _SPACE:
        own = number[plane[through]]
        rings = {k: _ends(fans[own == k]) for k, facet in enumerate(listed) if len(facet) > d}
    elif d == _SPACE:
        crowded = [k for k, facet in enumerate(listed) if len(facet) > d]
        rings = _rings(points, extreme, crowded, inside[through[first]])
    simplex = fans[first]
    sign = _signs(points[:, :-1], simplex)
    vertices: list[tuple[int, ...]] = []
    places: list[int] = []
    faces = [frozenset(facet) for facet in extreme] if triangulated and d > _SPACE else []
    for k, facet in enumerate(extreme):
        cells = [rings.get(k, tuple(simplex[k].tolist()) if d <= _SPACE else facet)]
        if triangulated and len(facet) > d:
            ring = cells[0]
            cells = [(ring[0], *pair) for pair in pairwise(ring[1:])]
            if d > _SPACE:
                cells = _pulled(faces[k], faces, d)
        vertices += cells
        places += [k] * len(cells)
    row = [-1, *kept.tolist()]
    named = [tuple([row[v] for v in facet]) for facet in vertices]
    order = sorted(range(len(named)), key=[*map(sorted, named)].__getitem__)
    place = np.array(places, dtype=np.int64)[order]
    return Facets([named[k] for k in order], kept[simplex[place] - 1], sign[place])


def corners(rows: Floats, point: Floats, slack: Floats, found: Facets) -> Corners:
    """Return the points of facets, and the planes of their dual points, by rounding."""
    # The origin moves to p: steps from there are short where the half-spaces are far from 0.
    with np.errstate(all="ignore"):
        exponent = np.frexp(np.abs(rows[:, :-1]).max(axis=1))[1]
        normals = np.ldexp(rows[:, :-1], -exponent[:, None])
        length = np.sqrt((normals * normals).sum(axis=1))
        normals = normals / length[:, None]
        offset = np.ldexp(slack, -exponent) / length
        matrix, right = normals[found.simplex], offset[found.simplex]
        unit = 2.0 ** np.frexp(np.abs(right).max(initial=0.0))[1]
        steep = np.abs(np.linalg.det(matrix)) > _STEEP
    steep &= np.isfinite(right).all(axis=1)
    shape = len(found.simplex), len(point)
    points, steps = np.full(shape, np.inf), np.zeros(shape)
    steps[steep] = np.linalg.solve(matrix[steep], -right[steep, :, None] / unit)[..., 0] * unit
    points[steep] = point + steps[steep]
    height = np.where(found.sign > 0, 1.0, -1.0)
    for k in np.flatnonzero(~steep & (found.sign != 0)).tolist():
        points[k], steps[k] = _meeting(rows[found.simplex[k]], point)
    steps *= height[:, None]
    for k in np.flatnonzero(found.sign == 0).tolist():
        steps[k], height[k] = _parallel(rows[found.simplex[k]], normals, found.simplex[k]), 0.0
    points[found.sign <= 0] = np.inf
    with np.errstate(all="ignore"):
        large = np.maximum(np.abs(steps).max(axis=1), 5e-324)
        scaled = steps / large[:, None]
        size = np.sqrt((scaled * scaled).sum(axis=1))
        equations = np.column_stack((scaled / size[:, None], -height / large / size))
    return Corners(points, equations)


def _parallel(rows: Floats, normals: Floats, simplex: Indices) -> Floats:
    """Return a direction in which an intersection is unbounded, along all of d boundaries."""
    exact = [[*map(Fraction, row)] for row in rows.tolist()]
    normal = [each[:-1] for each in exact]
    found = kernel(normal)
    # On one side are all half-spaces.
    direction = np.array([float(x / max(map(abs, found))) for x in found])
    away = normals @ direction
    away[simplex] = 0.0
    return direction if np.abs(away.min()) > np.abs(away.max()) else -direction


def _leveled(rows: Floats, slack: Floats) -> Floats:
    """Return rows times powers of two, with their ends near each other, where that is exact."""
    exponent = np.frexp(np.abs(slack))[1].astype(np.int64)
    # In layers: ends in one plane, as those of unit normals at one distance, would take integers.
    exponent += np.random.default_rng(0).integers(0, _LAYERS, len(rows))
    with np.errstate(all="ignore"):
        found = np.ldexp(rows, -exponent[:, None])
        back = np.ldexp(found, exponent[:, None])
    found = np.where((back == rows).all(axis=1, keepdims=True), found, rows)
    return np.ascontiguousarray(found) + 0.0


def _hull(points: Floats) -> tuple[Indices, Indices, Indices]:
    """Return simplices, the plane of each, and in more than 3-D a point off it."""
    if points.shape[1] > _SPACE:
        many = _core.hull_n(points)
        return many.simplices, many.facet_of, many.inside
    found = _core.hull3(points)
    if found is None:
        raise DegenerateInputError("all half-spaces are parallel to a line", reason="flat")
    return found.simplices, found.facet_of, found.simplices[:, 0]


def _vectors_of(simplices: Indices, plane: Indices, count: int) -> list[list[int]]:
    """Return the vectors in each plane, ascending, without the origin."""
    width = int(simplices.max()) + 1
    keys = distinct(np.repeat(plane, simplices.shape[1]) * width + simplices.reshape(-1))
    owner, vector = np.divmod(keys, width)
    owner, vector = owner[vector > 0], vector[vector > 0]
    ends = np.searchsorted(owner, np.arange(count + 1)).tolist()
    listed = vector.tolist()
    return [listed[start:end] for start, end in pairwise(ends)]


def _turned(simplices: Indices, d: int) -> Rows:
    """Return the vectors of simplices with the origin, turned as `Facets` says."""
    at = (simplices == 0).argmax(axis=1)
    others = simplices[simplices != 0].reshape(len(simplices), d)
    # Bringing the origin to the front takes `at` exchanges. In space triangles are
    # counter-clockwise as seen from outside; in more dimensions a point inside in front of them has
    # to pass d vectors.
    odd = (at + (d % 2 if d >= _SPACE else 0)) % 2 == 1
    others[odd, -2:] = others[odd, :-3:-1]
    found: Rows = others.astype(np.int64)
    return found


def _signs(normals: Floats, simplex: Rows) -> Indices:
    """Return the signs of the determinants of normals, exactly."""
    d = normals.shape[1]
    origin = np.zeros((1, d))
    if d > _SPACE:
        both = np.ascontiguousarray(np.concatenate((origin, normals[1:])))
        rows = np.column_stack((np.zeros(len(simplex), np.int64), simplex)).astype(np.int32)
        many: Indices = _core.orientations_n(both, rows, 1)
        return many
    orient: Any = predicates.orient2d if d < _SPACE else predicates.orient3d
    found: Indices = orient(origin, *(normals[simplex[:, k]] for k in range(d))).astype(np.int32)
    return found


def _without_redundant(listed: list[list[int]], d: int) -> list[tuple[int, ...]]:
    """Return facets without vectors that are in the middle of them, or of their faces.

    The facets that contain such a vector have another in common; a vector of a facet with d has
    none.
    """
    simple = {v for facet in listed if len(facet) == d for v in facet}
    doubtful = {v for facet in listed if len(facet) > d for v in facet} - simple
    if not doubtful:
        return [*map(tuple, listed)]
    of = defaultdict(list)
    for k, facet in enumerate(listed):
        for v in doubtful.intersection(facet) if len(facet) > d else ():
            of[v].append(k)
    sets = {k: set(listed[k]) for facets in of.values() for k in facets}
    redundant = set()
    for v, facets in of.items():
        left = set(sets[min(facets, key=lambda k: len(sets[k]))]) - {v}
        for k in facets:
            if not left:
                break
            left &= sets[k]
        if left:
            redundant.add(v)
    return [tuple(v for v in facet if v not in redundant) for facet in listed]


def _ends(fan: Rows) -> tuple[int, ...]:
    """Return the first and the last vector of a plane, from pairs that follow each other."""
    after = dict(fan.tolist())
    return (after.keys() - {*after.values()}).pop(), ({*after.values()} - after.keys()).pop()


def _rings(
    points: Floats, facets: list[tuple[int, ...]], chosen: list[int], inside: Indices
) -> dict[int, tuple[int, ...]]:
    """Return the vectors around chosen facets, counter-clockwise as seen from outside."""
    rings: dict[int, tuple[int, ...]] = {}
    of = defaultdict(list)
    for k, facet in enumerate(facets) if chosen else ():
        for v in facet:
            of[v].append(k)
    for k in chosen:
        facet = facets[k]
        # Two vectors are neighbors in a facet if they share another facet.
        sides: dict[int, list[int]] = defaultdict(list)
        for v in facet:
            for other in of[v]:
                if other != k:
                    sides[other].append(v)
        beside: dict[int, list[int]] = defaultdict(list)
        for u, v in (pair for pair in sides.values() if len(pair) == 2):
            beside[u].append(v)
            beside[v].append(u)
        ring = [facet[0], beside[facet[0]][0]]
        # Ends: the sides of a facet are one cycle.
        while len(ring) < len(facet):
            u, v = beside[ring[-1]]
            ring.append(v if u == ring[-2] else u)
        rings[k] = tuple(ring)
    if rings:
        corners = [(0, *ring[:3], inside[k]) for k, ring in rings.items()]
        turns = _core.orientations_n(points, np.array(corners, dtype=np.int32), 1)
        for k, turn in zip(list(rings), turns.tolist(), strict=True):
            if turn > 0:
                rings[k] = (rings[k][0], *rings[k][:0:-1])
    return rings


def _pulled(
    face: frozenset[int], others: Iterable[frozenset[int]], size: int
) -> list[tuple[int, ...]]:
    """Return simplices of a face of the cone: from its first vector to the faces that miss it."""
    if len(face) == size:
        return [tuple(sorted(face))]
    meets = {face & other for other in others if not face <= other}
    sides = [each for each in meets if len(each) >= size - 1 and not any(each < m for m in meets)]
    apex = min(face)
    return [
        (apex, *cell)
        for side in sorted(sides, key=sorted)
        if apex not in side
        for cell in _pulled(side, sides, size - 1)
    ]


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
        exact = [*map(Fraction, rows[i].tolist())]
        unit = max(map(abs, exact))
        key = tuple(x / unit for x in exact)
        keep[i] = key not in seen
        seen.add(key)
    return np.flatnonzero(keep)


def _meeting(rows: Floats, point: Floats) -> tuple[list[float], list[float]]:
    """The intersection of d boundaries, and the step to it, each coordinate rounded once."""
    exact = [[*map(Fraction, row)] for row in rows.tolist()]
    *where, last = kernel(exact)
    found = [x / last for x in where]
    steps = [x - Fraction(y) for x, y in zip(found, point.tolist(), strict=True)]
    return [*map(rounded, found)], [*map(rounded, steps)]


def rounded(exact: Fraction) -> float:
    """The nearest double, or infinity beyond the range."""
    try:
        return float(exact)
    except OverflowError:
        return float("inf") if exact > 0 else float("-inf")
