"""Which triangles and regions are inside of polygons whose sides are segments."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.constrained import coverage

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.constrained.segmented import Segmented

    Bools = NDArray[np.bool_]
    Indices = NDArray[np.int32]
    Rows = NDArray[np.int64]

__all__ = ["containing", "inside"]


def containing(mesh: Segmented, polygons: Indices) -> Rows:
    """Return pairs of a region of `mesh.region` and a polygon that contains it, (k, 2), ascending.

    `polygons` has the polygon of each row of segments, -1 for rows that are sides of none. The
    sides of each polygon must be closed rings; even-odd rule. For meshes of the whole hull.
    """
    component = mesh._component()
    region = np.empty(int(component.max()) + 1, dtype=np.int64)
    region[component] = mesh.region
    found = coverage.containing(mesh._made, mesh.npoints, polygons, component)
    pairs = [
        (at, polygon)
        for at, polygons in zip(region.tolist(), found, strict=True)
        for polygon in polygons
    ]
    return np.array(sorted(pairs), dtype=np.int64).reshape(-1, 2)


def inside(mesh: Segmented, polygons: Indices) -> Bools:
    """Return which triangles of the hull are inside of some polygon.

    `polygons` has the polygon of each row of segments, -1 for rows that are sides of none. The
    sides of each polygon must be closed rings; even-odd rule.
    """
    if not (polygons >= 0).any():
        return np.zeros(len(mesh._made.simplices), dtype=bool)
    component = mesh._component()
    within = coverage.containing(mesh._made, mesh.npoints, polygons, component)
    found: Bools = np.array([bool(each) for each in within])[component]
    return found
