"""Which polygon contains each region of the sphere.

Crossing an odd number of a polygon's rings switches between its inside and its outside, as in the
plane. But no region of a sphere is outside of all: which of the two sides is the inside, the
direction of the outer rings tells, or the smaller area.
"""

from __future__ import annotations

import math
import warnings
from collections import defaultdict, deque
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.constrained.coverage import closed_rings
from delone.counting import agreed, counted
from delone.errors import InputError
from delone.georeference import caller_level
from delone.plane.topology import edge_keys, half_edges
from delone.sphere.sides import Origin, PolygonWarning

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._core import ConstrainedTriangulation

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Rows = NDArray[np.int64]
    Walls = list[tuple[int, int, frozenset[int]]]

__all__ = ["Origin", "Rings", "first_polygon"]


# Areas within this of half the sphere, in steradians, are half: they are sums of rounded ones.
_HALF = 1e-9


class Rings(NamedTuple):
    """The rings of polygons."""

    origin: Origin
    # (s, 2): the vertices of the rows of segments.
    ends: Indices
    # The inside is left of outer rings ("ccw"), right of them ("cw"), or where it is "smaller".
    winding: str


def first_polygon(
    made: ConstrainedTriangulation,
    areas: Floats,
    component: Indices,
    rings: Rings,
) -> Indices:
    """Return the first geometry whose rings contain each component (even-odd rule), or -1.

    Takes O(m log m), plus for each component time in proportion to the polygons that overlap in it.
    """
    origin, ends, winding = rings
    count = int(component.max(initial=-1)) + 1
    closed = closed_rings(ends, origin.geometries, origin.rings)
    if not closed.any():
        return np.full(count, -1, dtype=np.int32)
    # The last component is what no triangle covers.
    left, right = _beside(made, component, count)
    crossed = _odd(made, origin.geometries, closed)
    walls: Walls = list(zip(left.tolist(), right.tolist(), crossed, strict=True))
    rim = component[((made.neighbors < 0) & ~made.constrained).any(axis=1)]
    walls += [(c, count, frozenset()) for c in np.unique(rim).tolist()]
    inside = _toggled(walls, count + 1)
    size: Floats = np.bincount(component, weights=areas, minlength=count + 1).astype(np.float64)
    size[count] = max(4 * math.pi - float(areas.sum()), 0.0)
    outer = _outer(made, origin, closed)
    if winding == "smaller":
        area = _areas(inside, size)
        half = {each for each, own in area.items() if abs(own - 2 * math.pi) < _HALF}
        turned = frozenset(each for each, own in area.items() if own > 2 * math.pi) - half
        turned |= _turned(inside, left, right, [each for each in outer if each[1] in half], "ccw")
    else:
        turned = _turned(inside, left, right, outer, winding)
        _warn_of_large([geometries ^ turned for geometries in inside], size)
    first = [min(inside[c] ^ turned, default=-1) for c in range(count)]
    return np.array(first, dtype=np.int32)


def _beside(
    made: ConstrainedTriangulation, component: Indices, outside: int
) -> tuple[Indices, Indices]:
    """Return the components to the left and right of each subsegment."""
    triangle, corner = np.nonzero(made.constrained)
    tail, head = half_edges(made.simplices, triangle, corner)
    npoints = int(made.simplices.max(initial=0)) + 1
    keys = edge_keys(made.segments[:, 0], made.segments[:, 1], npoints)
    order = np.argsort(keys)
    row = order[np.searchsorted(keys[order], edge_keys(tail, head, npoints))]
    ahead = made.segments[row, 0] == tail
    left = np.full(len(keys), outside, dtype=np.int32)
    right = left.copy()
    left[row[ahead]] = component[triangle[ahead]]
    right[row[~ahead]] = component[triangle[~ahead]]
    return left, right


def _odd(
    made: ConstrainedTriangulation, geometries: Indices, closed: Bools
) -> list[frozenset[int]]:
    """Return for each subsegment the geometries with an odd number of sides there."""
    found: list[frozenset[int]] = []
    source, start = made.source, made.source_start.tolist()
    of = np.where(closed, geometries, -1)[source].tolist()
    for first, end in pairwise(start):
        odd: set[int] = set()
        for geometry in of[first:end]:
            odd ^= {geometry}
        found.append(frozenset(odd - {-1}))
    return found


def _toggled(walls: Walls, count: int) -> list[frozenset[int]]:
    """Return the geometries whose rings are crossed on the way from the first component to each."""
    beyond: dict[int, list[tuple[int, frozenset[int]]]] = defaultdict(list)
    for one, other, geometries in walls:
        beyond[one].append((other, geometries))
        beyond[other].append((one, geometries))
    nothing: frozenset[int] = frozenset()
    inside = [nothing] * count
    seen = [False] * count
    for start in range(count):
        queue = deque([] if seen[start] else [start])
        seen[start] = True
        while queue:
            here = queue.popleft()
            for there, geometries in beyond[here]:
                if not seen[there]:
                    seen[there] = True
                    inside[there] = inside[here] ^ geometries
                    queue.append(there)
    return inside


def _outer(
    made: ConstrainedTriangulation, origin: Origin, closed: Bools
) -> list[tuple[int, int, bool]]:
    """Return the subsegments that an outer ring covers once: the geometry, and the direction."""
    count = np.diff(made.source_start)
    row = np.repeat(np.arange(len(count)), count)
    wanted = np.flatnonzero(closed[made.source] & origin.outer[made.source])
    geometry = origin.geometries[made.source[wanted]]
    # A side that a geometry has twice, such as a cut along the date line, tells nothing.
    pairs = np.column_stack((row[wanted], geometry))
    _, first, times = np.unique(pairs, axis=0, return_index=True, return_counts=True)
    at = wanted[first[times == 1]]
    forward, of = made.forward[at], origin.geometries[made.source[at]]
    return list(zip(row[at].tolist(), of.tolist(), forward.tolist(), strict=True))


def _turned(
    inside: list[frozenset[int]],
    left: Indices,
    right: Indices,
    outer: list[tuple[int, int, bool]],
    winding: str,
) -> frozenset[int]:
    """Return the geometries whose inside is what `inside` takes for their outside.

    Most sides decide: a border that crosses itself has loops that run the other way.
    """
    votes: dict[int, int] = defaultdict(int)
    for row, geometry, forward in outer:
        within = left[row] if forward == (winding == "ccw") else right[row]
        votes[geometry] += -1 if geometry in inside[within] else 1
    torn = sorted(geometry for geometry, count in votes.items() if count == 0)
    if torn:
        first = ", ".join(map(str, torn[:10]))
        raise InputError(
            f"outer rings of {len(torn)} {agreed(len(torn), 'geometry', 'geometries')} run in both "
            f'directions, first {first}: turn rings, or pass winding="smaller"'
        )
    return frozenset(geometry for geometry, count in votes.items() if count > 0)


def _areas(inside: list[frozenset[int]], size: Floats) -> dict[int, float]:
    """Return the area of each geometry, rounded."""
    area: dict[int, float] = defaultdict(float)
    for geometries, own in zip(inside, size.tolist(), strict=True):
        for geometry in geometries:
            area[geometry] += own
    return area


def _warn_of_large(inside: list[frozenset[int]], size: Floats) -> None:
    """Warn of geometries that cover more than half of the sphere, because of their winding."""
    area = _areas(inside, size)
    large = sorted(each for each, own in area.items() if own > 2 * math.pi + _HALF)
    if large:
        share = area[large[0]] / (4 * math.pi)
        warnings.warn(
            f"{counted(len(large), 'geometry')} "
            f"{agreed(len(large), 'covers', 'cover')} more than half of the sphere, first "
            f"{large[0]} with {share:.1%}: do its outer rings run the other way? "
            'winding="smaller" takes the smaller side',
            PolygonWarning,
            stacklevel=caller_level(),
        )
