"""Sites on one great circle, or fewer than three: their cells, and the nearest, exactly."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.sphere.cells import Cells, lunes
from delone.sphere.exact import cross, dot, whole

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices
    from delone.sphere.exact import Vector

__all__ = ["cells_of_few", "first_rows", "nearest_of_few"]

# A bound on the error of cosines of rounded unit vectors: three products of numbers off by 2**-54.
_DOUBT = 2.0**-48
# Number of cosines computed at a time.
_AT_ONCE = 1 << 20


def cells_of_few(chain: Indices, vectors: Floats, points: Floats) -> Cells:
    """Return the cells of sites that have no triangulation.

    `chain` has the rows of the sites, in order around the circle if there are three or more;
    `points` are the unit vectors of all rows.
    """
    if len(chain) > 2:
        return lunes(chain, points, _around(chain, vectors, points), 0)
    if len(chain) == 2:
        return lunes(chain, points, _axis(*(whole(vectors[row].tolist()) for row in chain)), 0)
    # The only cell is the whole sphere.
    cell = np.full(len(points), -1, dtype=np.int32)
    cell[chain] = 0
    none = np.empty((0, 2), dtype=np.int32)
    return Cells(
        vertices=np.empty((0, 3)),
        sites=none,
        ends=none,
        cell=cell,
        starts=np.zeros(2, dtype=np.int32),
        entries=np.empty(0, dtype=np.int32),
        around=None,
        measures=(np.empty(0), np.empty((0, 2))),
        simplex_vertex=np.empty(0, dtype=np.int32),
    )


def _around(chain: Indices, vectors: Floats, points: Floats) -> Floats:
    """Return the unit normal of a great circle from which sites in order are counter-clockwise."""
    circle = points[chain]
    sines = np.linalg.norm(np.cross(circle[0], circle), axis=1)
    # Integers are exact for any site; the largest sine has the smallest rounding error.
    first, far = (whole(vectors[chain[k]].tolist()) for k in (0, int(sines.argmax())))
    normal = cross(first, far)
    if not any(normal):
        # The other sites are so close to the first one, or its opposite, that unit vectors agree.
        others = (whole(vectors[row].tolist()) for row in chain[1:])
        normal = next(n for n in (cross(first, other) for other in others) if any(n))
    three = [whole(vectors[row].tolist()) for row in chain[:3]]
    turns = [dot(normal, cross(three[k - 1], three[k])) for k in range(3)]
    # At most one of the three angles around the circle is half a turn or more.
    ahead = sum((turn > 0) - (turn < 0) for turn in turns) > 0
    x, y, z = normal
    return _rounded(normal if ahead else (-x, -y, -z))


def _axis(a: Vector, b: Vector) -> Floats:
    """Return the unit axis of the shorter rotation from one direction to another."""
    normal = cross(a, b)
    if not any(normal):
        # Opposite directions: any perpendicular axis will do.
        least = min(range(3), key=lambda k: abs(a[k]))
        unit = (int(least == 0), int(least == 1), int(least == 2))
        normal = cross(a, unit)
    return _rounded(normal)


def _rounded(vector: Vector) -> Floats:
    """Return the unit vector of integers."""
    size = max(map(abs, vector))
    unit = np.array([x / size for x in vector])
    found: Floats = unit / np.linalg.norm(unit) + 0.0
    return found


def nearest_of_few(chain: Indices, vectors: Floats, points: Floats, queries: Floats) -> Indices:
    """Return the nearest site to each query, a unit vector, exactly; of several, the smallest row.

    Queries that are NaN or of length zero get -1. Cosines of rounded unit vectors decide if they
    differ by more than their errors; otherwise integers do.
    """
    rows = np.sort(chain)
    found = np.full(len(queries), -1, dtype=np.int32)
    size = np.abs(queries).max(axis=1, initial=0)
    given = np.flatnonzero((size > 0) & np.isfinite(queries).all(axis=1))
    exact: dict[int, Vector] = {}
    step = max(_AT_ONCE // len(rows), 1)
    for start in range(0, len(given), step):
        block = given[start : start + step]
        places = queries[block] / size[block, None]
        places /= np.linalg.norm(places, axis=1, keepdims=True)
        cosines = places @ points[rows].T
        best = cosines.max(axis=1)
        close = cosines >= best[:, None] - _DOUBT
        found[block] = rows[close.argmax(axis=1)]
        for at in np.flatnonzero(close.sum(axis=1) > 1).tolist():
            query = whole(queries[block[at]].tolist())
            candidates = rows[close[at]].tolist()
            for row in candidates:
                exact.setdefault(row, whole(vectors[row].tolist()))
            nearest = candidates[0]
            for row in candidates[1:]:
                if _is_closer(exact[row], exact[nearest], query):
                    nearest = row
            found[block[at]] = nearest
    return found


def _is_closer(a: Vector, b: Vector, query: Vector) -> bool:
    """Whether the angle from a query to one direction is smaller than that to another."""
    # The cosines are x / |a| and y / |b| times a common length, so signed squares are compared.
    x, y = dot(a, query), dot(b, query)
    return x * abs(x) * dot(b, b) > y * abs(y) * dot(a, a)


def first_rows(vectors: Floats, cell: Indices) -> Indices:
    """Return the first row with the direction of each row; rows without a cell are duplicates."""
    found = np.arange(len(vectors), dtype=np.int32)
    if (cell >= 0).all():
        return found
    first: dict[Vector, int] = {}
    for row, vector in enumerate(vectors.tolist()):
        found[row] = first.setdefault(whole(vector), row)
    return found
