"""Which polygons have which areas inside.

A polygon's rings change its inside to its outside wherever an odd number of them runs. So one walk
over the areas between segments, from the outside in, finds the polygons of each, without any
coordinate: crossings and overlaps of rings are subsegments by then, and what rounding bent is still
closed.
"""

from __future__ import annotations

from collections import defaultdict, deque
from typing import TYPE_CHECKING

import numpy as np

from delone.plane.topology import edge_keys

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._core import ConstrainedTriangulation

    Bools = NDArray[np.bool_]
    Indices = NDArray[np.int32]
    Rows = NDArray[np.int64]

__all__ = ["closed_rings", "first_polygon"]


def closed_rings(ends: Indices, geometries: Indices, rings: Bools) -> Bools:
    """Tell which rows of segments are sides of rings that are closed.

    Parameters
    ----------
    ends : ndarray of int32, shape (s, 2)
        Vertices of the segments, of equal points always the same one.
    geometries : ndarray of int32, shape (s,)
        The geometry of each.
    rings : ndarray of bool, shape (s,)
        Whether it was made as the side of a ring.

    Returns
    -------
    ndarray of bool, shape (s,)
        False for all sides of a geometry one of whose vertices has an odd number of them: a side is
        missing there, and the geometry has no inside.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.constrained.coverage import closed_rings
    >>> ends = np.array([(0, 1), (1, 2), (2, 0), (0, 3), (3, 4)])
    >>> closed_rings(ends, np.array([0, 0, 0, 1, 1]), np.ones(5, dtype=bool)).tolist()
    [True, True, True, False, False]
    """
    if not rings.any():
        return rings
    count = int(ends.max()) + 1
    keys = geometries[rings, None].astype(np.int64) * count + ends[rings]
    places, sides = np.unique(keys, return_counts=True)
    torn = np.zeros(int(geometries.max()) + 1, dtype=bool)
    torn[places[sides % 2 == 1] // count] = True
    closed: Bools = rings & ~torn[geometries]
    return closed


def first_polygon(
    made: ConstrainedTriangulation,
    npoints: int,
    geometries: Indices,
    component: Indices,
    sides: Bools,
) -> Indices:
    """Return for each component the first polygon that has it inside.

    Parameters
    ----------
    made : ConstrainedTriangulation
        Triangles of the whole hull, and subsegments with their rows.
    npoints : int
        Number of points, added ones included.
    geometries : ndarray of int32, shape (s,)
        The geometry of each row of segments.
    component : ndarray of int32, shape (m,)
        Component of each triangle.
    sides : ndarray of bool, shape (s,)
        Which rows of segments are sides of closed rings.

    Returns
    -------
    ndarray of int32, shape (c,)
        The smallest number of a geometry by whose rings, by the even-odd rule, the component is
        inside; -1 where there is none.

    Notes
    -----
    O(m log m), and for each component as much as polygons overlap in it.
    """
    count = int(component.max(initial=-1)) + 1
    walls = _walls(made, npoints, component, count)
    crossed = _polygons_of_subsegments(made, geometries, sides, walls[:, 2])
    beyond: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for one, other, subsegment in walls.tolist():
        beyond[one].append((other, subsegment))
        beyond[other].append((one, subsegment))
    nothing: frozenset[int] = frozenset()
    inside = {count: nothing}
    queue = deque(inside)
    while queue:
        here = queue.popleft()
        for there, subsegment in beyond[here]:
            if there not in inside:
                inside[there] = inside[here] ^ crossed.get(subsegment, nothing)
                queue.append(there)
    first = [min(inside[c], default=-1) for c in range(count)]
    return np.array(first, dtype=np.int32)


def _polygons_of_subsegments(
    made: ConstrainedTriangulation, geometries: Indices, sides: Bools, wanted: Rows
) -> dict[int, frozenset[int]]:
    """The polygons of which an odd number of sides covers some subsegments."""
    source, start = made.source, made.source_start
    crossed = {}
    for at in wanted[wanted >= 0].tolist():
        rows = source[start[at] : start[at + 1]]
        odd: set[int] = set()
        for geometry in geometries[rows[sides[rows]]].tolist():
            odd ^= {geometry}
        crossed[at] = frozenset(odd)
    return crossed


def _walls(made: ConstrainedTriangulation, npoints: int, component: Indices, outside: int) -> Rows:
    """Return pairs of adjacent components, each once, and a subsegment between them."""
    simplices, neighbors, constrained = made.simplices, made.neighbors, made.constrained
    triangle, corner = np.nonzero(constrained)
    # The rim of the hull is a wall to the outside, with or without a subsegment.
    rim = component[np.nonzero((neighbors < 0) & ~constrained)[0]]
    other = neighbors[triangle, corner]
    tail, head = (simplices[triangle, (corner + i) % 3] for i in (1, 2))
    keys = edge_keys(made.segments[:, 0], made.segments[:, 1], npoints)
    order = np.argsort(keys)
    subsegment = order[np.searchsorted(keys[order], edge_keys(tail, head, npoints))]
    there = np.where(other < 0, outside, component[other])
    here = component[triangle]
    low = np.concatenate((np.minimum(here, there), rim))
    high = np.concatenate((np.maximum(here, there), np.full(len(rim), outside)))
    subsegment = np.concatenate((subsegment, np.full(len(rim), -1)))
    _, first = np.unique(low.astype(np.int64) * (outside + 1) + high, return_index=True)
    walls = np.column_stack((low, high, subsegment))[first]
    between: Rows = walls[walls[:, 0] != walls[:, 1]]
    return between
