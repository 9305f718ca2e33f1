"""Find the simplices of a triangulation that share a circumsphere, exactly.

The core's circumcenters are within 4 units in the last place of the exact ones. So if the centers
of adjacent simplices are farther apart, their spheres are different. The other simplices are
compared with exact arithmetic: for each group of simplices that are connected by close centers, one
sphere is computed, and the corners of the group are tested against it.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from delone._tiling.higher.rational import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices, Rows

__all__ = ["components", "cospherical"]

# Computed centers of the same sphere differ by at most 8 units in the last place. Each unit is at
# most 2^-52 of a coordinate, or the smallest double.
_APART, _LEAST = 2.0**-48, 2.0**-1070


def cospherical(points: Floats, simplices: Indices, neighbors: Indices, centers: Floats) -> Rows:
    """Return for each simplex the first one with the same circumsphere, (m,).

    The triangulation is Delaunay, so simplices with the same circumsphere are connected.
    """
    t, k = np.nonzero(neighbors > np.arange(len(simplices))[:, None])
    u = neighbors[t, k]
    with np.errstate(invalid="ignore"):
        size = np.maximum(np.abs(centers[t]), np.abs(centers[u]))
        apart = (np.abs(centers[t] - centers[u]) > size * _APART + _LEAST).any(axis=1)
    close = np.flatnonzero(~apart)
    label = components(len(simplices), t[close], u[close].astype(np.int64))
    order = np.argsort(label, kind="stable")
    starts = np.flatnonzero(np.append(True, np.diff(label[order]) > 0))
    sizes = np.diff(np.append(starts, len(order)))
    for start, count in zip(starts[sizes > 1].tolist(), sizes[sizes > 1].tolist(), strict=True):
        left = order[start : start + count]
        # Terminates: each pass removes at least the first, which is on its own sphere.
        while len(left):
            corners = np.unique(simplices[left])
            on = corners[_on_sphere(points[simplices[left[0]]], points[corners])]
            same = np.isin(simplices[left], on).all(axis=1)
            label[left[same]] = left[0]
            left = left[~same]
    return label


def components(count: int, a: Rows, b: Rows) -> Rows:
    """Return for each number below `count` the smallest one in its connected component."""
    label = np.arange(count)
    # Terminates, because labels only decrease.
    while True:
        low = np.minimum(label[a], label[b])
        new = label.copy()
        np.minimum.at(new, a, low)
        np.minimum.at(new, b, low)
        new = new[new]
        if (new == label).all():
            return label
        label = new


def _on_sphere(simplex: Floats, points: Floats) -> NDArray[np.bool_]:
    """Return which points are on the sphere through the corners of a simplex, exactly."""
    origin, *others = _integers(np.concatenate((simplex[:1], simplex[1:], points)))
    steps = [[x - y for x, y in zip(point, origin, strict=True)] for point in others]
    lifted = [(step, sum(x * x for x in step)) for step in steps]
    d = len(origin)
    # Twice the center is the c with c . a = |a|^2 for all corners a.
    center = kernel([[*map(Fraction, step), Fraction(-size)] for step, size in lifted[:d]])[:-1]
    unit = int(np.lcm.reduce([x.denominator for x in center], dtype=object))
    whole = [int(x * unit) for x in center]
    on = [
        sum(x * y for x, y in zip(step, whole, strict=True)) == size * unit
        for step, size in lifted[d:]
    ]
    return np.array(on)


def _integers(points: Floats) -> list[list[int]]:
    """Return coordinates as integer multiples of a common unit."""
    pairs = [[x.as_integer_ratio() for x in point] for point in points.tolist()]
    # Denominators are powers of two.
    unit = max(below for point in pairs for _, below in point)
    return [[above * (unit // below) for above, below in point] for point in pairs]
